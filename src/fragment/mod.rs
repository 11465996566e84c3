//! Span → pixels: the depth test, the fragment stage's seam, and the shaders that come with the crate.

mod alpha;
mod bias;
mod blend;
mod depth;
mod depth_only;
mod discard;
mod dither;
mod fill;
mod flat;
mod fog;
mod gouraud;
mod matcap;
mod pixel;
mod shaded;
mod shader;

pub use alpha::Rgba;
pub use bias::DepthBias;
pub use blend::{Add, AddAlpha, Alpha, Blend, BlendMode, Multiply, Opacity, Replace};
pub use depth::{AnyDepth, Compare, DepthState, DepthTest, LessWrite, NoDepth};
pub use depth_only::DepthOnly;
pub use discard::{AlphaTest, ScreenDoor};
pub use dither::dither_word;
pub use fill::fill;
pub use flat::Flat;
pub use fog::{FogCurve, FogTable, Fogged};
pub use gouraud::Gouraud;
pub use matcap::Matcap;
pub use pixel::PixelFormat;
pub use shaded::{PerFace, PerFragment, PerFragmentNear, PerVertex, Shaded};
pub use shader::{Fragment, Fragments, Shader, Steps};
