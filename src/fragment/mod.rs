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
//! | `Flat`; `Shaded` per face | 14 | 13 |
//! | `Gouraud`; `Shaded` per vertex | 25 | 19 |
//! | `Matcap` | 42 | 25 |
//! | `Shaded` per fragment, 1 directional light, matte | 194 | 130 |
//! | the same, 2 directional lights | 256 | 186 |
//! | 1 directional light, glossy, shininess 32 | 269 | 212 |
//! | the same, shininess 255 | 305 | 232 |
//! | `Shaded` per fragment, near, 1 point light, matte | 378 | 281 |
//! | the same, glossy, shininess 32 | 556 | 443 |
//! | the same, viewer near | 651 | 510 |
//! | `Blend` of `Flat`, `Opacity` | 44 | 24 |
//! | `Blend` of `Gouraud`, `Opacity` | 81 | 48 |
//! | the same, `Alpha` | 84 | 45 |
//! | the same, `Add` | 87 | 51 |
//! | the same, `AddAlpha` | 116 | 68 |
//! | the same, `Multiply` | 104 | 58 |
//! | `AlphaTest` of `Gouraud` | 69 | 37 |
//! | `ScreenDoor` of `Gouraud`, half of the pixels | 61 | 38 |
//! | `Fogged` `Flat` | 71 | 44 |
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
