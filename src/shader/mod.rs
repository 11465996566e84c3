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
//! | [`Blend`], [`AlphaTest`], [`ScreenDoor`] | around any shader: transparency |
//!
//! [`light`](crate::light) says which light suits which shader.
//!
//! # Cost per pixel
//!
//! Instructions, on a screen of 320 × 240 in RGB565 that two triangles fill, depth test and set-up included; `ci/costs`
//! counts them. Light per face or per vertex costs nothing per pixel.
//!
//! | instructions per pixel | Cortex-M0+ | Cortex-M4 |
//! |---|--:|--:|
//! | `Flat` | 9 | 10 |
//! | `Gouraud` | 18 | 14 |
//! | `Matcap` | 46 | 25 |
//! | `Textured`, nearest, repeated, w constant | 22 | 17 |
//! | the same in perspective | 24 | 18 |
//! | mirrored | 94 | 55 |
//! | clamped | 95 | 53 |
//! | bilinear | 208 | 131 |
//! | nearest, RGB888 | 64 | 40 |
//! | bilinear, RGB888 | 339 | 205 |
//! | nearest, palette of 8 bits | 63 | 45 |
//! | nearest, lit | 195 | 125 |
//! | bilinear, lit | 399 | 237 |
//! | `Blend` of it, nearest, `Opacity` | 105 | 66 |
//! | `Phong`, 1 directional light, matte | 193 | 127 |
//! | the same, 2 directional lights | 275 | 179 |
//! | 1 directional light, glossy, shininess 32 | 269 | 212 |
//! | the same, shininess 255 | 304 | 232 |
//! | `PhongNear`, 1 point light, matte | 457 | 343 |
//! | the same, glossy, shininess 32 | 634 | 489 |
//! | the same, viewer near | 732 | 560 |
//! | `Blend` of `Flat`, `Opacity` | 39 | 28 |
//! | `Blend` of `Gouraud`, `Opacity` | 82 | 55 |
//! | the same, `Alpha` | 86 | 51 |
//! | the same, `Add` | 94 | 59 |
//! | the same, `AddAlpha` | 111 | 76 |
//! | the same, `Multiply` | 107 | 60 |
//! | `AlphaTest` of `Gouraud` | 67 | 39 |
//! | `ScreenDoor` of `Gouraud`, half of the pixels | 66 | 42 |
//! | `Fogged` `Flat` | 64 | 44 |
//! | `Fogged` `Gouraud` | 121 | 73 |

mod blend;
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
