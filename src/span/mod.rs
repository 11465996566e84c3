//! Span → pixels: the fragment stage's seam, the depth test, and the loops over pixels.

mod depth;
mod depth_bias;
mod luma;
mod packed;
mod perspective;
mod shader;
mod solid;
mod span;
mod textured;

pub use depth::{Compare, DepthDyn, DepthLess, DepthOff, DepthState, DepthTest, MAX_SPAN};
pub use depth_bias::DepthBias;
pub(crate) use luma::{luma_span, weighted};
pub(crate) use packed::{packed_fragments, packed_span, prepare};
pub use perspective::Corrected;
pub use shader::Shader;
pub(crate) use shader::fragments;
pub(crate) use solid::flat_span;
pub use span::{Fragment, Fragments, Steps, TriangleSpan};
pub(crate) use textured::{STEP, texture_span};
