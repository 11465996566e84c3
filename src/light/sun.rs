//! The sun: an ambient light and one directional light on matte surfaces (Lambert), the cheapest light there is.

use super::lit_color::{LitColor, WHITE};
use super::material::Matte;
use super::normal::{cosine, long};
use super::uneven::{NormalMatrix, turned};
use crate::color::{channels, round};
use crate::math::{Affine, Vec3};
use embedded_graphics_core::pixelcolor::Rgb888;

/// An ambient light and a directional one, with colours, for [`Matte`] surfaces.
///
/// Highlights and surfaces that are lit on both sides take a [`Lighting`](crate::light::Lighting).
///
/// ```
/// use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, WebColors};
/// use zstrip::light::{Material, Sun};
/// use zstrip::math::{Affine, Angle16, Vec3};
/// use zstrip::shader::Gouraud;
/// let sun = Sun::new(Vec3::from_ints(4, 7, 6), Rgb888::CSS_LIGHT_YELLOW, Rgb888::CSS_DIM_GRAY);
/// let model = Affine::rotation_y(Angle16::from_degrees(30));
/// let shader = Gouraud::new(sun.on(&Material::matte(Rgb888::CSS_ORANGE), &model));
/// // scene.draw(&mesh, &(camera * model), &shader);
/// # let _ = shader;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sun {
    /// Unit vector towards the light, 2.14; zero for no directional light.
    direction: [i16; 3],
    /// Brightness per channel, 256 = full.
    diffuse: [u16; 3],
    ambient: [u16; 3],
}

/// Converts channels to brightness: 255 becomes 256.
const fn levels([r, g, b]: [u8; 3]) -> [u16; 3] {
    [r as u16 + (r >> 7) as u16, g as u16 + (g >> 7) as u16, b as u16 + (b >> 7) as u16]
}

/// Multiplies the brightness of light by a colour: 8.8, at most 255 · 256.
#[inline]
const fn product(level: [u16; 3], color: [u8; 3]) -> [u16; 3] {
    [
        level[0].wrapping_mul(color[0] as u16),
        level[1].wrapping_mul(color[1] as u16),
        level[2].wrapping_mul(color[2] as u16),
    ]
}

/// Multiplies the brightness of light by that of a material, rounded: at most 256.
const fn dimmed(level: [u16; 3], color: [u8; 3]) -> [u16; 3] {
    let by = levels(color);
    // The product is at most 2¹⁶, which needs 17 bits.
    [
        ((level[0] as u32 * by[0] as u32 + 128) >> 8) as u16,
        ((level[1] as u32 * by[1] as u32 + 128) >> 8) as u16,
        ((level[2] as u32 * by[2] as u32 + 128) >> 8) as u16,
    ]
}

/// Returns the unit vector in a direction, 2.14, rounded; zero for the zero vector.
const fn unit(direction: Vec3) -> [i16; 3] {
    match direction.normalized() {
        Some(unit) => {
            let [x, y, z] = unit.to_bits();
            [((x + 2) >> 2) as i16, ((y + 2) >> 2) as i16, ((z + 2) >> 2) as i16]
        }
        None => [0; 3],
    }
}

/// Shifts the matrix of a model until its largest entry is at least 1/2, as in any rotation. The entries of a model
/// that is scaled far down would otherwise leave few bits of a direction.
const fn enlarged(model: &Affine) -> Affine {
    let rows = model.to_rows();
    let mut widest = 1;
    let mut k = 0;
    while k < 3 {
        widest |= rows[k][0].unsigned_abs() | rows[k][1].unsigned_abs() | rows[k][2].unsigned_abs();
        k += 1;
    }
    // The top bit of 1/2 is bit 15.
    let shift = widest.leading_zeros().saturating_sub(16);
    Affine::from_rows(shifted(rows[0], shift), shifted(rows[1], shift), shifted(rows[2], shift), Vec3::ZERO)
}

/// Shifts the first three entries of a row to the left.
const fn shifted(row: [i32; 4], shift: u32) -> Vec3 {
    Vec3::from_bits([row[0] << shift, row[1] << shift, row[2] << shift])
}

impl Sun {
    /// Returns the light of `color` that comes from `direction`, a vector of any length that points *towards* the
    /// light, and the ambient light.
    ///
    /// A zero vector leaves the ambient light alone.
    #[must_use]
    pub fn new(direction: Vec3, color: impl Into<Rgb888>, ambient: impl Into<Rgb888>) -> Self {
        Self::from_channels(direction, channels(color.into()), channels(ambient.into()))
    }

    /// Returns the light for constants, as [`new`](Self::new) does: colours are red, green and blue.
    #[must_use]
    pub const fn from_channels(direction: Vec3, color: [u8; 3], ambient: [u8; 3]) -> Self {
        Self { direction: unit(direction), diffuse: levels(color), ambient: levels(ambient) }
    }

    /// Puts the light on a material of a mesh that `model` brings into the light's space (world or eye space).
    ///
    /// `model` may be any transform. One that does more than rotate, move, mirror and scale evenly takes some 70
    /// instructions more per normal, because it turns normals otherwise than positions. Call it once per draw.
    #[must_use]
    pub const fn on(&self, material: &Matte, model: &Affine) -> Sunlit {
        let [x, y, z] = self.direction;
        let direction = Vec3::from_bits([(x as i32) << 2, (y as i32) << 2, (z as i32) << 2]);
        let normals = NormalMatrix::new(model);
        let direction = match normals {
            None => unit(enlarged(model).inverse_rigid().transform_vector(direction)),
            // Normals are brought to the light.
            Some(_) => self.direction,
        };
        let vertex_colors = material.vertex_colors;
        let (ambient, diffuse) = if vertex_colors {
            (dimmed(self.ambient, material.ambient), dimmed(self.diffuse, material.diffuse))
        } else {
            (product(self.ambient, material.ambient), product(self.diffuse, material.diffuse))
        };
        Sunlit { direction, ambient, diffuse, vertex_colors, normals }
    }
}

/// A [`Matte`] material under a [`Sun`], in the object space of a mesh; made by [`Sun::on`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// Aligned, so that it is copied word by word instead of by a call.
#[repr(align(4))]
pub struct Sunlit {
    direction: [i16; 3],
    /// Light of a channel, 8.8; with vertex colours the factor of a vertex's channel, 256 = 1.
    ambient: [u16; 3],
    diffuse: [u16; 3],
    vertex_colors: bool,
    /// Brings normals to the light, if the light could not be brought to them.
    normals: Option<NormalMatrix>,
}

impl Sunlit {
    /// Returns whether the colours of the mesh's vertices take part.
    #[inline(always)]
    pub(crate) const fn has_vertex_colors(&self) -> bool {
        self.vertex_colors
    }

    /// Multiplies the factors by the colour of a vertex.
    #[inline]
    pub(crate) fn colored(&self, color: [u8; 3]) -> Self {
        let (ambient, diffuse) = (product(self.ambient, color), product(self.diffuse, color));
        Self { direction: self.direction, ambient, diffuse, vertex_colors: false, normals: None }
    }

    /// Returns the unit normal to shade for a unit normal of the mesh.
    #[inline(always)]
    pub(crate) fn turned(&self, normal: [i16; 3]) -> [i16; 3] {
        turned(&self.normals, normal)
    }

    /// Returns the colour for a normal from [`turned`](Self::turned): ambient + diffuse · max(0, n · l), at most 255.
    ///
    /// # Format
    /// Normal 2.14; the result is within 1/64 of the exact value for the same 2.14 vectors. n · l: 2²⁸ and a little.
    #[inline]
    pub(crate) fn shade(&self, normal: [i16; 3]) -> LitColor {
        let cosine = cosine(long(normal), long(self.direction));
        let channel =
            |k: usize| (i32::from(self.ambient[k]) + ((i32::from(self.diffuse[k]) * cosine) >> 14)).min(WHITE);
        LitColor::from_bits([channel(0), channel(1), channel(2)])
    }

    /// Returns the rounded colour for a normal from [`turned`](Self::turned): red, green and blue
    /// in a word, blue lowest.
    #[inline(never)]
    pub(crate) fn shade_word(&self, normal: [i16; 3]) -> u32 {
        let [r, g, b] = self.shade(normal).to_bits();
        u32::from(round(r)) << 16 | u32::from(round(g)) << 8 | u32::from(round(b))
    }
}
