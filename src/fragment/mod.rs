//! Span → pixels: the depth test, the fragment stage's seam, and the shaders that come with the crate.

mod bias;
mod depth;
mod depth_only;
mod dither;
mod fill;
mod flat;
mod gouraud;
mod luma;
mod pixel;
mod shader;

pub use bias::DepthBias;
pub use depth::{AnyDepth, Compare, DepthState, DepthTest, LessWrite, NoDepth};
pub use depth_only::DepthOnly;
pub use dither::dither_word;
pub use fill::fill;
pub use flat::Flat;
pub use gouraud::Gouraud;
pub use luma::luma;
pub use pixel::PixelFormat;
pub use shader::{Fragment, Fragments, Shader, Steps};
