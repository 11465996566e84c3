//! Span → pixels: the depth test, the fragment stage's seam, and the shaders that come with the crate.

mod alpha;
mod blend;
mod depth;
mod discard;
mod fill;
mod flat;
mod fog;
mod gouraud;
mod matcap;
mod pixel;
mod shaded;
mod shader;

pub use alpha::Rgba;
pub use blend::{Add, AddAlpha, Alpha, Blend, BlendMode, Multiply, Opacity, Replace};
pub use depth::{AnyDepth, Compare, DepthState, DepthTest, LessWrite, NoDepth};
pub use discard::{AlphaTest, ScreenDoor};
pub use fill::fill;
pub use flat::Flat;
pub use fog::{FogCurve, FogTable, Fogged};
pub use gouraud::Gouraud;
pub use matcap::Matcap;
pub use pixel::PixelFormat;
pub use shaded::{PerFace, PerFragment, PerFragmentNear, PerVertex, Shaded};
pub use shader::{Fragment, Fragments, Shader, Steps};
