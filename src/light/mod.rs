//! Lights, materials, and the surfaces that they make together.
//!
//! A material says what a surface does to light. Lights are given in world or eye space and put on a material once per
//! draw, in the object space of the mesh, where its normals are. The result is a
//! [`Surface`](crate::shader::Surface), which a shader asks for colours:
//!
//! ```text
//! Sun      .on(&matte,    &model)               ─► Sunlit             ┐            ┌ Flat::new(surface)     per face
//! Lighting .on(&material, &model, mesh.bounds())─► LitMaterial<D, P>  ├► Surface ─►┼ Gouraud::new(surface)  per vertex
//!                                                  Unlit              ┘            └ Textured::lit(surface) per vertex
//!                                                  LitMaterial<D, P> ─► Phong::new, PhongNear::new        per fragment
//! ```
//!
//! # Which light, which shader
//!
//! | wanted | light | shader | instructions per pixel, M0+ / M4 |
//! |---|---|---|--:|
//! | no light | [`Unlit`] | [`Flat`], [`Gouraud`] | 9 / 10, 18 / 14 |
//! | one sun, matte | [`Sun`] | [`Flat`], [`Gouraud`] | 9 / 10, 18 / 14 |
//! | lamps, several suns, highlights | [`Lighting`] | [`Flat`], [`Gouraud`] | 9 / 10, 18 / 14 |
//! | a texture under any of these | any | [`Textured::lit`], nearest | 195 / 125 |
//! | highlights smaller than triangles | [`Lighting`], 1 directional | [`Phong`] | 269 / 212 |
//! | lamps nearer than triangles are long | [`Lighting`], 1 lamp | [`PhongNear`] | 634 / 489 |
//!
//! The [table of `shader`](crate::shader#cost-per-pixel) has more of these figures. Per face or per vertex, a [`Sun`]
//! takes one scalar product and three products of channels. A [`Lighting`] takes as much per directional light. A point
//! light takes a reciprocal square root, too, and another one for its highlight. So prefer the sun where it is enough.
//!
//! # A texture, vertex colours and a lamp
//!
//! ```
//! use zstrip::light::{Lighting, Material, PointLight, Viewer};
//! use zstrip::math::{Affine, Scalar, Vec3};
//! use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
//! use zstrip::shader::Textured;
//! use zstrip::texture::Tile;
//! use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor, WebColors};
//!
//! static CORNERS: [Vec3; 4] =
//!     [Vec3::from_ints(-1, -1, 0), Vec3::from_ints(1, -1, 0), Vec3::from_ints(1, 1, 0), Vec3::from_ints(-1, 1, 0)];
//! static TOWARDS_US: [[i16; 3]; 4] = [[0, 0, zstrip::light::NORMAL_ONE]; 4];
//! /// Red, green, blue: dirt at the lower corners, which the texture does not show.
//! static DIRT: [[u8; 3]; 4] = [[120, 100, 80], [120, 100, 80], [255; 3], [255; 3]];
//! static UVS: [[Scalar; 2]; 4] =
//!     [[Scalar::ZERO, Scalar::ONE], [Scalar::ONE, Scalar::ONE], [Scalar::ONE, Scalar::ZERO], [Scalar::ZERO; 2]];
//! static WALL: Mesh<'static> = Mesh::constant(MeshData {
//!     topology: Topology::Quads,
//!     normals: Some(&TOWARDS_US),
//!     colors: Some(&DIRT),
//!     uvs: Some(&UVS),
//!     ..MeshData::new(Positions::Exact(&CORNERS))
//! });
//! static BRICKS: Tile<'static, 2, 2> = Tile::new(&[[0xA145, 0x8A08], [0x8A08, 0xA145]]);
//!
//! let lighting = Lighting {
//!     ambient: Rgb888::new(30, 30, 40),
//!     directional: [],
//!     points: [PointLight::new(Vec3::from_milli(500, 500, -2000), Rgb888::CSS_ORANGE, Scalar::from_num(4))],
//!     viewer: Viewer::At(Vec3::ZERO),
//! };
//! let model = Affine::translation(Vec3::from_ints(0, 0, -3));
//! let paint = Material::matte(Rgb888::WHITE).vertex_colors();
//! // Texture × colour of the material × colours of the vertices × light.
//! let shader = Textured::new(&BRICKS).lit(lighting.on(&paint, &model, WALL.bounds()));
//! // scene.draw(&WALL, &(camera * model), &shader);
//! # let _ = shader;
//! ```
//!
//! [`Flat`]: crate::shader::Flat
//! [`Gouraud`]: crate::shader::Gouraud
//! [`Phong`]: crate::shader::Phong
//! [`PhongNear`]: crate::shader::PhongNear
//! [`Textured::lit`]: crate::shader::Textured::lit

mod lighting;
mod lit_color;
mod lit_material;
mod local_space;
mod material;
mod normal;
mod sun;
mod uneven;
mod unlit;

pub use lighting::{DirectionalLight, Lighting, PointLight, Viewer};
pub use lit_color::LitColor;
pub use lit_material::LitMaterial;
pub use material::{Material, Matte};
pub use normal::NORMAL_ONE;
pub(crate) use normal::long;
pub use sun::{Sun, Sunlit};
pub(crate) use uneven::{NormalMatrix, turned};
pub use unlit::Unlit;
