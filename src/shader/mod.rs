//! The shaders that come with the crate, ordinary users of the seam in [`span`](crate::span).
//!
//! | | |
//! |---|---|
//! | [`Flat`], [`Gouraud`] | the colour of a [`Surface`] under any light, per face or per vertex |
//! | [`Phong`], [`PhongNear`] | a [`LitMaterial`](crate::light::LitMaterial), lit per fragment |
//! | [`Textured`], [`Textured::lit`] | images, perspective-correct; on a [`Surface`] under any light |
//! | [`Matcap`] | the colour of the normal, from a picture |
//! | [`DepthOnly`] | no colour |
//! | [`Fogged`] | around any shader: fog |
//! | [`Blend`], [`AlphaTest`], [`AlphaToCoverage`], [`ScreenDoor`] | around any shader: transparency |
//!
//! [`light`](crate::light) says which light suits which shader.
//!
//! # Cost per pixel
//!
//! Instructions, on a screen of 320 × 240 in RGB565 that two triangles fill, depth test and set-up included; `ci/costs`
//! counts them. Light per face or per vertex costs nothing per pixel.
//!
//! | instructions per pixel | Cortex-M0+ | Cortex-M4 | RV32IMC |
//! |---|--:|--:|--:|
//! | `Flat` | 9 | 10 | 8 |
//! | `Gouraud` | 18 | 13 | 14 |
//! | `Matcap` | 46 | 25 | 22 |
//! | `Textured`, nearest, repeated, w constant | 23 | 18 | 21 |
//! | the same in perspective | 25 | 19 | 24 |
//! | mirrored | 87 | 58 | 66 |
//! | clamped | 96 | 56 | 69 |
//! | bilinear | 197 | 134 | 155 |
//! | nearest, RGB888 | 67 | 45 | 53 |
//! | bilinear, RGB888 | 330 | 190 | 249 |
//! | nearest, palette of 8 bits | 65 | 47 | 51 |
//! | nearest, lit | 96 | 62 | 72 |
//! | bilinear, lit | 404 | 237 | 334 |
//! | `Blend` of it, nearest, `Opacity` | 100 | 70 | 77 |
//! | `Phong`, 1 directional light, matte | 185 | 125 | 130 |
//! | the same, 2 directional lights | 263 | 183 | 171 |
//! | 1 directional light, glossy, shininess 32 | 260 | 208 | 198 |
//! | the same, shininess 255 | 296 | 228 | 234 |
//! | `PhongNear`, 1 point light, matte | 511 | 356 | 466 |
//! | the same, glossy, shininess 32 | 688 | 502 | 619 |
//! | the same, viewer near | 851 | 598 | 791 |
//! | `Blend` of `Flat`, `Opacity` | 39 | 28 | 25 |
//! | `Blend` of `Gouraud`, `Opacity` | 75 | 46 | 42 |
//! | the same, `Alpha` | 79 | 48 | 51 |
//! | the same, `Add` | 82 | 51 | 45 |
//! | the same, `AddAlpha` | 111 | 73 | 74 |
//! | the same, `Multiply` | 101 | 57 | 63 |
//! | `AlphaTest` of `Gouraud` | 66 | 34 | 30 |
//! | `ScreenDoor` of `Gouraud`, half of the pixels | 63 | 39 | 29 |
//! | `Fogged` `Flat` | 64 | 44 | 40 |
//! | `Fogged` `Gouraud` | 111 | 74 | 60 |

mod blend;
mod coverage;
mod depth_only;
mod discard;
mod flat;
mod fog;
mod gouraud;
mod matcap;
mod mipmap;
mod phong;
mod surface;
mod textured;
mod vertex_colors;

pub use blend::{Add, AddAlpha, Alpha, Blend, BlendMode, Multiply, Opacity, Replace};
pub use coverage::AlphaToCoverage;
pub use depth_only::DepthOnly;
pub use discard::{AlphaTest, ScreenDoor};
pub use flat::Flat;
pub use fog::{FogCurve, FogError, FogTable, Fogged};
pub use gouraud::Gouraud;
pub use matcap::Matcap;
pub use mipmap::{Levels, Mipmapped, OneLevel};
pub use phong::{Phong, PhongNear};
pub use surface::Surface;
pub use textured::{LitTexture, Textured};
pub use vertex_colors::VertexColors;
