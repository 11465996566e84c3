//! Span → pixels: the fragment stage's seam, the depth test, and the loops over pixels.

mod color_setup;
mod depth;
mod depth_bias;
mod luma;
#[cfg(test)]
mod naive;
mod packed;
mod perspective;
mod shader;
mod solid;
mod span;
mod textured;

pub use color_setup::ColorSetup;
pub use depth::{Compare, DepthDyn, DepthLess, DepthOff, DepthState, DepthTest};
pub use depth_bias::DepthBias;
pub(crate) use luma::luma_span;
pub(crate) use packed::packed_span;
pub use perspective::Corrected;
pub(crate) use shader::draw_fragments;
pub use shader::{Shader, SpanOf};
pub(crate) use solid::flat_span;
pub use span::{Fragment, Primitive, Span, TriangleSetup};
pub(crate) use textured::{STEP, texture_span};
