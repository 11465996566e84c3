//! Lights of all kinds: ambient, directional, point lights that fade with distance, and where they are seen from.
//!
//! All of it is given in eye space, or in any other space that a model matrix leads to. [`Lighting::on`] takes it to a
//! mesh's own space once per draw, because the normals and positions of vertices are given there.

use super::lit_material::{LitColors, LitDirection, LitMaterial, LitPoint, LitViewer, short};
use super::local_space::ToLocal;
use super::material::Material;
use super::uneven::NormalMatrix;
use crate::color::channels;
use crate::math::{Affine, Scalar, Vec3, unit_vector};
use crate::mesh::Bounds;
use embedded_graphics_core::pixelcolor::Rgb888;

/// A light from far away: its direction is one for all of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DirectionalLight {
    /// Vector towards the light, of any length; a zero vector gives no light.
    pub direction: Vec3,
    /// Colour of the light.
    pub color: Rgb888,
}

impl DirectionalLight {
    /// Returns the light of a colour from a direction that points *towards* the light.
    #[must_use]
    pub fn new(direction: Vec3, color: impl Into<Rgb888>) -> Self {
        Self { direction, color: color.into() }
    }
}

/// A light at a point, which fades with distance.
///
/// At distance d it has (1 - d² / range²)² of its brightness: 1 at the light, 0 from `range` on. The curve has no
/// corner there, and surfaces beyond `range` cost nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointLight {
    /// Position of the light.
    pub position: Vec3,
    /// Colour of the light.
    pub color: Rgb888,
    /// Distance from which on it gives no light.
    pub range: Scalar,
}

impl PointLight {
    /// Returns the light of a colour at a position, which reaches as far as `range`.
    #[must_use]
    pub fn new(position: Vec3, color: impl Into<Rgb888>, range: Scalar) -> Self {
        Self { position, color: color.into(), range }
    }
}

/// The place that highlights are seen from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Viewer {
    /// Far away in a direction, which is one for all of a mesh: the cheap way.
    Toward(Vec3),
    /// At a point.
    At(Vec3),
}

/// An ambient light, `D` directional ones, `P` point lights, and the viewer.
///
/// ```
/// use zstrip::embedded_graphics_core::pixelcolor::Rgb888;
/// use zstrip::light::{DirectionalLight, Lighting, PointLight, Viewer};
/// use zstrip::math::{Scalar, Vec3};
/// let lighting = Lighting {
///     ambient: Rgb888::new(30, 30, 40),
///     directional: [DirectionalLight::new(Vec3::from_ints(4, 7, 6), Rgb888::new(220, 220, 210))],
///     points: [PointLight::new(Vec3::from_ints(0, 1, -3), Rgb888::new(255, 80, 20), Scalar::from_num(5))],
///     viewer: Viewer::At(Vec3::ZERO), // the eye, in eye space
/// };
/// # let _ = lighting;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lighting<const D: usize, const P: usize> {
    /// Colour of the light from everywhere.
    pub ambient: Rgb888,
    /// Lights far away.
    pub directional: [DirectionalLight; D],
    /// Lights close by.
    pub points: [PointLight; P],
    /// The eye.
    pub viewer: Viewer,
}

impl<const D: usize> Lighting<D, 0> {
    /// Returns directional lights with a viewer far away on the z axis: in eye space, far in front of the screen.
    #[must_use]
    pub fn directional(ambient: impl Into<Rgb888>, directional: [DirectionalLight; D]) -> Self {
        Self { ambient: ambient.into(), directional, points: [], viewer: Viewer::Toward(Vec3::Z) }
    }
}

/// Multiplies two colours, 8.8, cut: 255 · 255 becomes 255.
fn product(a: [u8; 3], b: [u8; 3]) -> [u16; 3] {
    let channel = |a: u8, b: u8| (u32::from(a) * u32::from(b) * 256 / 255) as u16;
    [channel(a[0], b[0]), channel(a[1], b[1]), channel(a[2], b[2])]
}

impl<const D: usize, const P: usize> Lighting<D, P> {
    /// Puts the lights on a material of a mesh that `model` brings into the lights' space, and whose positions are in
    /// `bounds` ([`Mesh::bounds`](crate::mesh::Mesh::bounds)).
    ///
    /// `model` may be any transform. One that does more than rotate, move, mirror and scale evenly takes some hundred
    /// instructions more per vertex, because it turns normals otherwise than positions.
    ///
    /// This function takes some thousand instructions: call it outside of the closure that draws a frame, which runs
    /// once per strip where there are no records.
    ///
    /// # Format
    /// Directions within 2⁻¹⁴; positions of lights within 2⁻¹⁵ of the extent of the mesh, and at most 16,384 extents
    /// away.
    #[must_use]
    pub fn on(&self, material: impl Into<Material>, model: &Affine, bounds: &Bounds) -> LitMaterial<D, P> {
        self.put_on(&material.into(), model, bounds)
    }

    fn put_on(&self, material: &Material, model: &Affine, bounds: &Bounds) -> LitMaterial<D, P> {
        const { assert!(D < 1 << 13 && P < 1 << 13, "at most 8,191 lights of a kind: their sum fits 31 bits") };
        let normals = NormalMatrix::new(model);
        let space = match normals {
            None => ToLocal::new(model, bounds),
            Some(_) => ToLocal::of_moved(model, bounds),
        };
        let colors = |light: Rgb888| LitColors {
            diffuse: product(material.matte.diffuse, channels(light)),
            specular: product(material.specular, channels(light)),
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
            ambient: product(material.matte.ambient, channels(self.ambient)),
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
            vertex_colors: material.matte.vertex_colors,
            space: space.local(),
            normals,
            model: *model,
        }
    }
}

/// Returns a word that has as many bits as the widest magnitude.
fn widest(v: [i32; 3]) -> u32 {
    v[0].unsigned_abs() | v[1].unsigned_abs() | v[2].unsigned_abs()
}
