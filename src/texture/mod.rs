//! Images in flash: how texels are kept, and how they are sampled. A program meets [`Image`] first, made of an
//! image's bytes and a [`TexelFormat`]; a [`Tile`] is the fast one, with sides that are powers of two.

mod image;
mod sample;
mod texel;

pub use image::{Image, Texture, TextureError, Tile, WithAlpha};
pub use sample::{Bilinear, Clamp, Filter, Mirror, Nearest, Repeat, Wrap};
pub(crate) use texel::OPAQUE;
pub use texel::{Gray8Texel, Keyed, MaskTexel, PaletteTexel, Rgb565LeTexel, Rgb565Texel, Rgb888Texel, TexelFormat};
