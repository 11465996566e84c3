//! The seam between triangles and pixels: the depth test, and the trait that colours fragments. A program meets
//! [`DepthState`] first, in a [`State`](crate::scene::State); [`Shader`] is for shaders of one's own.

mod at_sample;
mod brush;
mod carried;
mod channels;
mod color_setup;
mod depth;
mod depth_bias;
mod interpolate;
mod lit_textured;
mod luma;
#[cfg(test)]
mod naive;
mod packed;
mod perspective;
mod planar;
mod sample;
mod sampled;
mod sampled_colors;
mod sampled_edges;
mod shader;
mod small;
mod solid;
mod span;
mod texels;
mod textured;
mod uv_stepper;

pub(crate) use at_sample::AtSample;
pub(crate) use brush::subslice;
pub use brush::{SmallResult, SmallTarget, SmallTriangle};
pub(crate) use carried::{CARRIED, LeftState, MOST_CARRIED, STATE_UNIT, face_of, goes_on};
pub(crate) use channels::ChannelBrush;
pub use color_setup::ColorSetup;
pub use depth::{Carrying, Compare, DepthDyn, DepthLess, DepthLessEqual, DepthOff, DepthState, DepthTest, Sampled};
pub(crate) use depth_bias::BiasSteps;
pub use depth_bias::DepthBias;
pub(crate) use interpolate::{interpolate, set_up_shader};
pub(crate) use lit_textured::{is_light_in_range, lit_texture_span};
pub(crate) use luma::luma_span;
pub(crate) use packed::packed_span;
pub use perspective::Corrected;
pub use sample::Sample;
pub(crate) use shader::draw_fragments;
pub use shader::{Shader, SpanOf};
pub(crate) use small::biased;
pub(crate) use solid::{ValueBrush, flat_span};
pub use span::{Fragment, Primitive, Span, TriangleSetup};
pub(crate) use texels::{Light, TexelSource};
pub(crate) use textured::{STEP, texture_span};
pub(crate) use uv_stepper::UvStepper;
