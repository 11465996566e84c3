//! Lights of all kinds: ambient, directional, point lights that fade with distance, and where they are seen from.
//!
//! All of it is given in eye space, or in any other that a model matrix leads to, and is taken to a mesh's own space once a
//! draw by [`Lighting::on`], because normals and positions are given there.

use super::lit_material::{LitColors, LitDirection, LitMaterial, LitPoint, LitViewer, short};
use super::local_space::ToLocal;
use super::material::Material;
use crate::math::{Affine, Scalar, Vec3, unit_vector};
use crate::mesh::Bounds;
use embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};

/// Light from far away: the same direction everywhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DirectionalLight {
    /// Towards the light, of any length; a zero vector gives no light.
    pub direction: Vec3,
    /// Its colour: red, green, blue.
    pub color: [u8; 3],
}

impl DirectionalLight {
    /// From a direction that points *towards* the light and a colour.
    pub fn new(direction: Vec3, color: impl Into<Rgb888>) -> Self {
        Self { direction, color: channels(color.into()) }
    }
}

/// Light from a point, which fades: by (1 - d² / range²)² at distance d, which is 1 at the light, has no corner, and is 0
/// from `range` on, where nothing has to be computed any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointLight {
    /// Where it is.
    pub position: Vec3,
    /// Its colour: red, green, blue.
    pub color: [u8; 3],
    /// How far it reaches.
    pub range: Scalar,
}

impl PointLight {
    /// From its place, a colour, and how far it reaches.
    pub fn new(position: Vec3, color: impl Into<Rgb888>, range: Scalar) -> Self {
        Self { position, color: channels(color.into()), range }
    }
}

/// Where highlights are seen from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Viewer {
    /// From far away in a direction, for all of a mesh: the cheap way.
    Toward(Vec3),
    /// From a point.
    At(Vec3),
}

/// An ambient light, `D` directional ones, `P` point lights, and the viewer.
///
/// ```
/// use zstrip::embedded_graphics_core::pixelcolor::Rgb888;
/// use zstrip::light::{DirectionalLight, Lighting, PointLight, Viewer};
/// use zstrip::math::{Scalar, Vec3};
/// let lighting = Lighting {
///     ambient: [30, 30, 40],
///     directional: [DirectionalLight::new(Vec3::from_ints(4, 7, 6), Rgb888::new(220, 220, 210))],
///     points: [PointLight::new(Vec3::from_ints(0, 1, -3), Rgb888::new(255, 80, 20), Scalar::from_num(5))],
///     viewer: Viewer::At(Vec3::ZERO), // the eye, in eye space
/// };
/// # let _ = lighting;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lighting<const D: usize, const P: usize> {
    /// Light from everywhere: red, green, blue.
    pub ambient: [u8; 3],
    /// Lights far away.
    pub directional: [DirectionalLight; D],
    /// Lights close by.
    pub points: [PointLight; P],
    /// The eye.
    pub viewer: Viewer,
}

impl<const D: usize> Lighting<D, 0> {
    /// Directional lights, seen from along the z axis: in eye space, from far in front of the screen.
    pub fn directional(ambient: impl Into<Rgb888>, directional: [DirectionalLight; D]) -> Self {
        Self { ambient: channels(ambient.into()), directional, points: [], viewer: Viewer::Toward(Vec3::Z) }
    }
}

/// Red, green, blue.
fn channels(color: Rgb888) -> [u8; 3] {
    [color.r(), color.g(), color.b()]
}

/// The product of two colours, 8.8, cut: 255 · 255 becomes 255.
fn product(a: [u8; 3], b: [u8; 3]) -> [u16; 3] {
    let channel = |a: u8, b: u8| (u32::from(a) * u32::from(b) * 256 / 255) as u16;
    [channel(a[0], b[0]), channel(a[1], b[1]), channel(a[2], b[2])]
}

impl<const D: usize, const P: usize> Lighting<D, P> {
    /// The lights on a material, as a mesh sees them that `model` brings into the lights' space and whose positions are in
    /// `bounds` ([`Mesh::bounds`](crate::mesh::Mesh::bounds)).
    ///
    /// `model` may rotate, move and scale evenly. Some thousand instructions: where a frame's closure runs often, make it
    /// outside.
    ///
    /// # Format
    /// Directions within 2⁻¹⁴; positions of lights within 2⁻¹⁵ of the extent of the mesh, and at most 16,384 extents away.
    #[must_use]
    pub fn on(&self, material: &Material, model: &Affine, bounds: &Bounds) -> LitMaterial<D, P> {
        let space = ToLocal::new(model, bounds);
        let colors = |light: [u8; 3]| LitColors {
            diffuse: product(material.diffuse, light),
            specular: product(material.specular, light),
        };
        let (toward, viewer) = match self.viewer {
            Viewer::Toward(direction) => {
                let direction = space.direction(direction);
                (direction, LitViewer::Toward(short(direction)))
            }
            Viewer::At(position) => {
                let position = space.position(position);
                let bits = widest(position).max(1 << 15);
                // With the mesh's own 2¹⁵ and the sign, differences fit 15 bits.
                let shift = 18 - bits.leading_zeros().min(18);
                (unit_vector(position.map(|c| c >> shift)), LitViewer::At { position, shift: shift as u8 })
            }
        };
        LitMaterial {
            ambient: product(material.ambient, self.ambient),
            directional: self.directional.map(|light| {
                let direction = space.direction(light.direction);
                let [l, v] = [direction, toward];
                LitDirection {
                    direction: short(direction),
                    half: short(unit_vector([l[0] + v[0], l[1] + v[1], l[2] + v[2]].map(|c| c >> 1))),
                    colors: colors(light.color),
                }
            }),
            points: self.points.map(|light| {
                LitPoint::new(space.position(light.position), space.length(light.range), colors(light.color))
            }),
            viewer,
            shininess: if material.specular == [0; 3] { 0 } else { material.shininess },
            two_sided: material.two_sided,
            vertex_colors: material.vertex_colors,
            space: space.local(),
        }
    }
}

/// A word as wide as the widest magnitude.
fn widest(v: [i32; 3]) -> u32 {
    v[0].unsigned_abs() | v[1].unsigned_abs() | v[2].unsigned_abs()
}
