//! Span → pixels: the depth test, the fragment stage's seam, and the shaders that come with the crate.

mod bias;
mod depth;
mod depth_only;
mod dither;
mod fill;
mod flat;
mod gouraud;
mod luma;
mod perspective;
mod pixel;
mod sample;
mod shader;
mod texel;
mod texture;
mod texture_span;
mod textured;

pub use bias::DepthBias;
pub use depth::{AnyDepth, Compare, DepthState, DepthTest, LessWrite, MAX_SPAN, NoDepth};
pub use depth_only::DepthOnly;
pub use dither::dither_word;
pub use fill::fill;
pub use flat::Flat;
pub use gouraud::Gouraud;
pub use luma::luma;
pub use perspective::Corrected;
pub use pixel::PixelFormat;
pub use sample::{Bilinear, Clamp, Filter, Mirror, Nearest, Repeat, Wrap};
pub use shader::{Fragment, Fragments, Shader, Steps};
pub use texel::{
    Gray8Texel, Keyed, MaskTexel, PaletteTexel, Rgb565LeTexel, Rgb565Texel, Rgb888Texel, Rgba, TexelFormat,
};
pub use texture::{Image, Texture, TextureError, Tile, WithAlpha};
pub use textured::{LitTexture, Textured};
