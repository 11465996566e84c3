//! Span → pixels: the depth test, the fragment stage's seam, and the shaders that come with the crate.
//!
//! | | |
//! |---|---|
//! | [`Flat`], [`Gouraud`] | a colour a face or a vertex, under one light or none |
//! | [`Shaded`] | a [`Material`](crate::geometry::Material) under any lights, per face, vertex or fragment |
//! | [`Textured`], [`Textured::lit`] | images, perspective-correct |
//! | [`Matcap`] | the colour of the normal, from a picture |
//! | [`DepthOnly`] | no colour |
//! | [`Fogged`] | around any of them: fog |
//! | [`Blend`], [`AlphaTest`], [`ScreenDoor`] | around any of these: transparency |
//!
//! # What a pixel costs
//!
//! Instructions, on a screen of 320 × 240 in RGB565 that two triangles fill, depth test and set-up included; `ci/costs` counts
//! them.
//!
//! | instructions a pixel | Cortex-M0+ | Cortex-M4 |
//! |---|--:|--:|
//! | `Flat`; `Shaded` per face | 10 | 10 |
//! | `Gouraud`; `Shaded` per vertex | 19 | 14 |
//! | `Matcap` | 42 | 25 |
//! | `Textured`, nearest, repeated, w constant | 25 | 18 |
//! | the same in perspective | 28 | 19 |
//! | mirrored | 79 | 54 |
//! | clamped | 87 | 53 |
//! | bilinear | 195 | 132 |
//! | nearest, RGB888 | 65 | 42 |
//! | bilinear, RGB888 | 333 | 209 |
//! | nearest, palette of 8 bits | 65 | 45 |
//! | nearest, lit | 180 | 99 |
//! | bilinear, lit | 403 | 229 |
//! | `Blend` of it, nearest, `Opacity` | 95 | 73 |
//! | `Shaded` per fragment, 1 directional light, matte | 185 | 123 |
//! | the same, 2 directional lights | 254 | 189 |
//! | 1 directional light, glossy, shininess 32 | 265 | 208 |
//! | the same, shininess 255 | 301 | 228 |
//! | `Shaded` per fragment, near, 1 point light, matte | 375 | 277 |
//! | the same, glossy, shininess 32 | 554 | 442 |
//! | the same, viewer near | 648 | 509 |
//! | `Blend` of `Flat`, `Opacity` | 40 | 26 |
//! | `Blend` of `Gouraud`, `Opacity` | 81 | 51 |
//! | the same, `Alpha` | 83 | 41 |
//! | the same, `Add` | 87 | 52 |
//! | the same, `AddAlpha` | 118 | 66 |
//! | the same, `Multiply` | 101 | 59 |
//! | `AlphaTest` of `Gouraud` | 62 | 32 |
//! | `ScreenDoor` of `Gouraud`, half of the pixels | 62 | 37 |
//! | `Fogged` `Flat` | 67 | 44 |
//! | `Fogged` `Gouraud` | 112 | 67 |

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
mod luma;
mod matcap;
mod perspective;
mod pixel;
mod sample;
mod shaded;
mod shader;
mod texel;
mod texture;
mod texture_span;
mod textured;

pub use alpha::Rgba8888;
pub use bias::DepthBias;
pub use blend::{Add, AddAlpha, Alpha, Blend, BlendMode, Multiply, Opacity, Replace};
pub use depth::{AnyDepth, Compare, DepthState, DepthTest, LessWrite, MAX_SPAN, NoDepth};
pub use depth_only::DepthOnly;
pub use discard::{AlphaTest, ScreenDoor};
pub use dither::dither_word;
pub use fill::fill;
pub(crate) use fill::{clear, clear_words};
pub use flat::Flat;
pub use fog::{FogCurve, FogTable, Fogged};
pub use gouraud::Gouraud;
pub use luma::luma;
pub use matcap::Matcap;
pub use perspective::Corrected;
pub use pixel::PixelFormat;
pub use sample::{Bilinear, Clamp, Filter, Mirror, Nearest, Repeat, Wrap};
pub use shaded::{PerFace, PerFragment, PerFragmentNear, PerVertex, Shaded};
pub use shader::{Fragment, Fragments, Shader, Steps};
pub use texel::{Gray8Texel, Keyed, MaskTexel, PaletteTexel, Rgb565LeTexel, Rgb565Texel, Rgb888Texel, TexelFormat};
pub use texture::{Image, Texture, TextureError, Tile, WithAlpha};
pub use textured::{LitTexture, Textured};
