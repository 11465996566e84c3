//! A material under lights, ready to be asked for the colour of any normal: Blinn and Phong's sum, in 32-bit integers.
//!
//! ```text
//! colour = ambient + Σ fade (diffuse · max(0, n · l) + specular · max(0, n · h)^shininess, if n · l > 0)
//!
//!      h    n            n: normal                   h: halfway between l and v
//!   l   \   |   v        l: towards the light        fade: 1 of directional lights, (1 - d² / range²)² of point lights
//!     \  \  |  /         v: towards the viewer
//!      \  \ | /
//!   ----------------     each channel at most 255
//! ```

use super::lit_color::{LitColor, WHITE};
use super::local_space::LocalSpace;
use super::normal::{ONE, cosine, long};
use super::uneven::{NormalMatrix, turned};
use crate::math::{Affine, Vec3, unit_vector};

/// A [`Material`](crate::light::Material) under a [`Lighting`](crate::light::Lighting), in a mesh's own space; made by
/// [`Lighting::on`](crate::light::Lighting::on).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LitMaterial<const D: usize, const P: usize> {
    /// Light from everywhere on the material, 8.8 per channel.
    pub(super) ambient: [u16; 3],
    pub(super) directional: [LitDirection; D],
    pub(super) points: [LitPoint; P],
    pub(super) viewer: LitViewer,
    /// 0 for no highlights.
    pub(super) shininess: u8,
    pub(super) two_sided: bool,
    pub(super) vertex_colors: bool,
    pub(super) space: LocalSpace,
    /// Brings normals to the lights, if the lights could not be brought to them; and positions, by the model.
    pub(super) normals: Option<NormalMatrix>,
    pub(super) model: Affine,
}

/// A vector in 2.14.
type Short = [i16; 3];

/// Converts a vector in 2.14, of length 1 or little more, to 16 bits.
pub(super) const fn short([x, y, z]: [i32; 3]) -> Short {
    [x as i16, y as i16, z as i16]
}

/// A light's colours on a material, 8.8.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LitColors {
    pub(super) diffuse: [u16; 3],
    pub(super) specular: [u16; 3],
}

/// A directional light on a material: unit vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LitDirection {
    pub(super) direction: Short,
    /// Halfway to a far viewer.
    pub(super) half: Short,
    pub(super) colors: LitColors,
}

/// The viewer: a direction in 2.14, or a position in local units. Its difference to any position of the mesh has 15
/// bits after the shift.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LitViewer {
    Toward(Short),
    At { position: [i32; 3], shift: u8 },
}

/// A point light on a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LitPoint {
    /// Position and range in local units, below 2²⁹.
    position: [i32; 3],
    range: i32,
    /// 2³⁰ / (the shifted range squared / 2¹⁴).
    inverse: u32,
    /// The shifted range, 2¹⁴ to 2¹⁵, and the shifts that make it so: one of them is 0.
    scaled: u16,
    left: u8,
    right: u8,
    colors: LitColors,
}

impl LitPoint {
    pub(super) fn new(position: [i32; 3], range: i32, colors: LitColors) -> Self {
        let range = range.max(1);
        let zeros = range.leading_zeros();
        let (left, right) = (zeros.saturating_sub(17).min(14), 17_u32.saturating_sub(zeros));
        let scaled = ((range << left) >> right) as u32;
        let inverse = (1_u32 << 30).checked_div(scaled.wrapping_mul(scaled) >> 14).unwrap_or(0);
        Self { position, range, inverse, scaled: scaled as u16, left: left as u8, right: right as u8, colors }
    }

    /// Returns the fraction of the light that reaches the point `p`, 2.14; 0 out of the light's range. Puts the unit
    /// vector from `p` to the light into `direction`, 2.14.
    ///
    /// # Format
    /// `p` in local units, below 2¹⁶. The fraction is within 2⁻¹² of the exact value for the rounded positions.
    #[inline(never)]
    fn fade_at(&self, p: &[i32; 3], direction: &mut [i32; 3]) -> i32 {
        let [x, y, z] = self.position;
        let [x, y, z] = [x.wrapping_sub(p[0]), y.wrapping_sub(p[1]), z.wrapping_sub(p[2])];
        let range = self.range as u32;
        if x.unsigned_abs() >= range || y.unsigned_abs() >= range || z.unsigned_abs() >= range {
            return 0;
        }
        let near = |c: i32| (c << (self.left & 31)) >> (self.right & 31);
        let (x, y, z) = (near(x), near(y), near(z));
        // Each at most 2¹⁵: below 3 · 2³⁰.
        let squared = x.wrapping_mul(x).wrapping_add(y.wrapping_mul(y)).wrapping_add(z.wrapping_mul(z)) as u32;
        let scaled = u32::from(self.scaled);
        let Some(difference) = scaled.wrapping_mul(scaled).checked_sub(squared) else { return 0 };
        *direction = unit_vector([x, y, z]);
        // The difference / 2¹⁴ is at most what `inverse` divides by: below 2³⁰.
        let left = ((difference >> 14).wrapping_mul(self.inverse) >> 16) as i32;
        left.wrapping_mul(left) >> 14
    }
}

/// Raises `x` to the power of `n`; `x` and the result are 2.14 in 0..=1.
///
/// # Format
/// Squares and multiplies numbers of 0.16, rounded: off by at most (n + 2) 2⁻¹⁶. The error of `x` itself counts n
/// times.
#[inline]
pub(super) fn power(x: i32, n: u8) -> i32 {
    let mut base = ((x as u32) << 2).min(0xFFFF);
    let mut result = 0xFFFF_u32;
    let mut n = n;
    loop {
        if n & 1 != 0 {
            result = result.wrapping_mul(base).wrapping_add(1 << 15) >> 16;
        }
        n >>= 1;
        if n == 0 {
            return ((result + 2) >> 2) as i32;
        }
        base = base.wrapping_mul(base).wrapping_add(1 << 15) >> 16;
    }
}

/// A point of a surface that is looked at, and the sums of its light. Vectors 2.14, light 8.8.
///
/// `body` is multiplied by the colour of a vertex; `shine` has the highlights, which are not.
struct Look<'n> {
    normal: &'n [i32; 3],
    viewer: [i32; 3],
    body: [i32; 3],
    shine: [i32; 3],
}

/// Adds `color` · `factor`, 2.14, to `sum`.
#[inline(always)]
fn add(sum: &mut [i32; 3], color: &[u16; 3], factor: i32) {
    sum[0] += (i32::from(color[0]) * factor) >> 14;
    sum[1] += (i32::from(color[1]) * factor) >> 14;
    sum[2] += (i32::from(color[2]) * factor) >> 14;
}

impl<const D: usize, const P: usize> LitMaterial<D, P> {
    /// Returns whether the colours of the mesh's vertices take part.
    #[inline]
    pub(crate) const fn has_vertex_colors(&self) -> bool {
        self.vertex_colors
    }

    /// Returns whether normals of faces that show their back are turned.
    #[inline]
    pub(crate) const fn is_two_sided(&self) -> bool {
        self.two_sided
    }

    /// Returns whether the colour at a point depends on where the point is: point lights do, and highlights that are
    /// seen from close by.
    #[inline(always)]
    pub(crate) const fn depends_on_place(&self) -> bool {
        P > 0 || (D > 0 && self.shininess != 0 && self.is_seen_from_close_by())
    }

    /// Returns whether the direction to the viewer differs from point to point.
    #[inline(always)]
    pub(crate) const fn is_seen_from_close_by(&self) -> bool {
        matches!(self.viewer, LitViewer::At { .. })
    }

    /// Returns whether there are lights that a normal matters to.
    pub(crate) const HAS_LIGHTS: bool = D > 0 || P > 0;

    /// Returns a position of the mesh in 2⁻¹⁴ local units: below 2²⁹.
    #[inline]
    pub(crate) fn fine_position(&self, position: Vec3) -> [i32; 3] {
        match self.normals {
            None => self.space.fine(position),
            Some(_) => self.space.fine(self.model.transform_point(position)),
        }
    }

    /// Returns the unit normal to shade, 2.14, for a unit normal of the mesh. It is the normal itself if the model
    /// scales evenly.
    #[inline]
    #[must_use]
    pub fn turned(&self, normal: [i16; 3]) -> [i16; 3] {
        turned(&self.normals, normal)
    }

    /// Turns a normal towards the viewer, seen from the point `p` (local units) of the surface: for a vertex that
    /// belongs to faces on both sides.
    pub(crate) fn towards_viewer(&self, normal: [i32; 3], p: [i32; 3]) -> [i32; 3] {
        let [x, y, z] = self.viewer(&p);
        let dot =
            normal[0].wrapping_mul(x).wrapping_add(normal[1].wrapping_mul(y)).wrapping_add(normal[2].wrapping_mul(z));
        if dot < 0 { normal.map(i32::wrapping_neg) } else { normal }
    }

    /// Returns the unit vector from a point to the viewer, 2.14.
    #[inline(never)]
    fn viewer(&self, p: &[i32; 3]) -> [i32; 3] {
        match self.viewer {
            LitViewer::Toward(direction) => long(direction),
            LitViewer::At { position: e, shift } => {
                let shift = shift & 31;
                let along = |k: usize| e[k].wrapping_sub(p[k]) >> shift;
                unit_vector([along(0), along(1), along(2)])
            }
        }
    }

    /// Begins the sum of a point with the ambient light.
    #[inline(always)]
    fn look<'n>(&self, normal: &'n [i32; 3]) -> Look<'n> {
        let [r, g, b] = self.ambient;
        Look { normal, viewer: [0; 3], body: [i32::from(r), i32::from(g), i32::from(b)], shine: [0; 3] }
    }

    /// Returns the colour under the ambient and the directional lights, seen from far away. A [`Viewer::At`] looks from
    /// the direction in which it is from the middle of the mesh's box.
    ///
    /// `color` is that of the vertex, red first; it counts if the material has
    /// [`vertex_colors`](crate::light::Material::vertex_colors).
    ///
    /// # Format
    /// `normal` as [`turned`](Self::turned) returns it, 2.14, of length 1.
    ///
    /// [`Viewer::At`]: crate::light::Viewer::At
    #[inline]
    #[must_use]
    pub fn shade_distant(&self, normal: &[i32; 3], color: [u8; 3]) -> LitColor {
        let mut look = self.look(normal);
        for light in &self.directional {
            self.add_distant(&mut look, light);
        }
        self.total(&look, color)
    }

    /// Adds a directional light, seen from far away.
    #[inline(always)]
    fn add_distant(&self, look: &mut Look<'_>, light: &LitDirection) {
        let facing = cosine(*look.normal, long(light.direction));
        if facing > 0 {
            add(&mut look.body, &light.colors.diffuse, facing);
            if self.shininess != 0 {
                let shine = power(cosine(*look.normal, long(light.half)), self.shininess);
                add(&mut look.shine, &light.colors.specular, shine);
            }
        }
    }

    /// Returns the colour under all lights at the point `p` of the mesh, in [`local`](Self::local) units.
    ///
    /// `color` is that of the vertex, red first; it counts if the material has
    /// [`vertex_colors`](crate::light::Material::vertex_colors).
    ///
    /// # Format
    /// `normal` as [`turned`](Self::turned) returns it, 2.14, of length 1.
    #[inline(never)]
    #[must_use]
    pub fn shade_at(&self, normal: &[i32; 3], p: &[i32; 3], color: [u8; 3]) -> LitColor {
        self.shade_at_inlined(normal, p, color)
    }

    /// Returns the colour as [`shade_at`](Self::shade_at) does; inlined, for the loop over a span's fragments.
    #[inline(always)]
    pub(crate) fn shade_at_inlined(&self, normal: &[i32; 3], p: &[i32; 3], color: [u8; 3]) -> LitColor {
        let mut look = self.look(normal);
        let seen_from_afar = matches!(self.viewer, LitViewer::Toward(_));
        if self.shininess != 0 && self.depends_on_place() {
            look.viewer = self.viewer(p);
        }
        for light in &self.directional {
            if seen_from_afar {
                self.add_distant(&mut look, light);
            } else {
                self.add_from(&mut look, &long(light.direction), ONE, &light.colors);
            }
        }
        for light in &self.points {
            let mut direction = [0; 3];
            let fade = light.fade_at(p, &mut direction);
            if fade > 0 {
                self.add_from(&mut look, &direction, fade, &light.colors);
            }
        }
        self.total(&look, color)
    }

    /// Adds a light in any direction, of which `fade` is left; highlights are seen from `look.viewer`.
    #[inline(never)]
    fn add_from(&self, look: &mut Look<'_>, direction: &[i32; 3], fade: i32, colors: &LitColors) {
        let facing = cosine(*look.normal, *direction);
        if facing > 0 {
            add(&mut look.body, &colors.diffuse, (facing * fade) >> 14);
            if self.shininess != 0 {
                let (l, v) = (direction, &look.viewer);
                // Below 2¹⁵ even where both are the same.
                let half = |k: usize| l[k] + v[k] - ((l[k] + v[k]) >> 6);
                let half = unit_vector([half(0), half(1), half(2)]);
                let shine = power(cosine(*look.normal, half), self.shininess);
                add(&mut look.shine, &colors.specular, (shine * fade) >> 14);
            }
        }
    }

    /// Sums up the light of a point whose vertex has a colour.
    #[inline(always)]
    fn total(&self, look: &Look<'_>, color: [u8; 3]) -> LitColor {
        let Look { body, shine, .. } = look;
        let [r, g, b] = if self.vertex_colors {
            let times = |light: i32, c: u8| {
                // By 255: 1 / 256 + 1 / 256² of it.
                let part = light.wrapping_mul(i32::from(c)) >> 8;
                part + (part >> 8)
            };
            [times(body[0], color[0]), times(body[1], color[1]), times(body[2], color[2])]
        } else {
            *body
        };
        LitColor::from_bits([(r + shine[0]).min(WHITE), (g + shine[1]).min(WHITE), (b + shine[2]).min(WHITE)])
    }

    /// Returns a position of the mesh in local units, as [`shade_at`](Self::shade_at) takes it.
    #[inline]
    #[must_use]
    pub fn local(&self, position: Vec3) -> [i32; 3] {
        let [x, y, z] = self.fine_position(position);
        [x >> 14, y >> 14, z >> 14]
    }
}
