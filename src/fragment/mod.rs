//! Span → pixels: the depth test, the fragment stage's seam, and the shaders that come with the crate.

mod depth;
mod fill;
mod flat;
mod gouraud;
mod perspective;
mod pixel;
mod sample;
mod shader;
mod texel;
mod texture;
mod texture_span;
mod textured;

pub use depth::{AnyDepth, Compare, DepthState, DepthTest, LessWrite, NoDepth};
pub use fill::fill;
pub use flat::Flat;
pub use gouraud::Gouraud;
pub use perspective::Corrected;
pub use pixel::PixelFormat;
pub use sample::{Bilinear, Clamp, Filter, Mirror, Nearest, Repeat, Wrap};
pub use shader::{Fragment, Fragments, Shader, Steps};
pub use texel::{
    Gray8Texel, Keyed, MaskTexel, PaletteTexel, Rgb565LeTexel, Rgb565Texel, Rgb888Texel, Rgba, TexelFormat,
};
pub use texture::{Image, Texture, TextureError, Tile, WithAlpha};
pub use textured::{LitTexture, Textured};
