//! Span → pixels: the depth test, the fragment stage's seam, and the shaders that come with the crate.

mod depth;
mod fill;
mod flat;
mod gouraud;
mod matcap;
mod pixel;
mod shaded;
mod shader;

pub use depth::{AnyDepth, Compare, DepthState, DepthTest, LessWrite, NoDepth};
pub use fill::fill;
pub use flat::Flat;
pub use gouraud::Gouraud;
pub use matcap::Matcap;
pub use pixel::PixelFormat;
pub use shaded::{PerFace, PerFragment, PerFragmentNear, PerVertex, Shaded};
pub use shader::{Fragment, Fragments, Shader, Steps};
