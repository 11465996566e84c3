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

use super::light::NORMAL_ONE;
use super::local_space::LocalSpace;
use crate::math::{Vec3, unit_vector};

/// A [`Material`](crate::light::Material) under a [`Lighting`](crate::light::Lighting), in a mesh's own space; made by
/// [`Lighting::on`](crate::light::Lighting::on).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LitMaterial<const D: usize, const P: usize> {
    /// Light from everywhere on the material, 8.8 a channel.
    pub(super) ambient: [u16; 3],
    pub(super) directional: [LitDirection; D],
    pub(super) points: [LitPoint; P],
    pub(super) viewer: LitViewer,
    /// 0 for no highlights.
    pub(super) shininess: u8,
    pub(super) two_sided: bool,
    pub(super) vertex_colors: bool,
    pub(super) space: LocalSpace,
}

/// A vector in 2.14.
type Short = [i16; 3];

/// A vector in 2.14, of length 1 or little more.
pub(super) const fn short([x, y, z]: [i32; 3]) -> Short {
    [x as i16, y as i16, z as i16]
}

/// The same in words.
#[inline(always)]
fn long([x, y, z]: Short) -> [i32; 3] {
    [i32::from(x), i32::from(y), i32::from(z)]
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

/// Where highlights are seen from: 2.14, or local units to be shifted so that the difference to any position has 15 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LitViewer {
    Toward(Short),
    At { position: [i32; 3], shift: u8 },
}

/// A point light on a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LitPoint {
    /// Local units, below 2²⁹, and the range in them.
    position: [i32; 3],
    range: i32,
    /// 2³⁰ / (the shifted range squared / 2¹⁴).
    inverse: u32,
    /// The shifted range, and shifts, one of them 0, that make it 2¹⁴ to 2¹⁵.
    scaled: u16,
    left: u8,
    right: u8,
    colors: LitColors,
}

/// The number 1 in 2.14.
const ONE: i32 = NORMAL_ONE as i32;

/// The brightest channel value, 255 in 8.8.
const WHITE: i32 = 255 << 8;

impl LitPoint {
    pub(super) fn new(position: [i32; 3], range: i32, colors: LitColors) -> Self {
        let range = range.max(1);
        let zeros = range.leading_zeros();
        let (left, right) = (zeros.saturating_sub(17).min(14), 17_u32.saturating_sub(zeros));
        let scaled = ((range << left) >> right) as u32;
        let inverse = (1_u32 << 30).checked_div(scaled.wrapping_mul(scaled) >> 14).unwrap_or(0);
        Self { position, range, inverse, scaled: scaled as u16, left: left as u8, right: right as u8, colors }
    }

    /// Puts the unit vector from `p` to the light into `direction`, 2.14; how much of it is left there, 2.14. 0 out of its range.
    ///
    /// # Format
    /// `p` in local units, below 2¹⁶. What is left is within 2⁻¹² of the exact value for the rounded positions.
    #[inline(never)]
    fn from(&self, p: &[i32; 3], direction: &mut [i32; 3]) -> i32 {
        let [x, y, z] = self.position;
        let [x, y, z] = [x.wrapping_sub(p[0]), y.wrapping_sub(p[1]), z.wrapping_sub(p[2])];
        let range = self.range;
        if x.abs() >= range || y.abs() >= range || z.abs() >= range {
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

/// `x` to the power of `n`, both numbers 2.14 in 0..=1.
///
/// # Format
/// By squaring and multiplying 0.16, rounded: off by at most (n + 2) 2⁻¹⁶ beside what `x` itself is off, which counts n
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

/// n · l of vectors in 2.14, cut to 2.14, between 0 and 1.
#[inline(always)]
fn cosine(n: &[i32; 3], l: [i32; 3]) -> i32 {
    let dot = n[0].wrapping_mul(l[0]).wrapping_add(n[1].wrapping_mul(l[1])).wrapping_add(n[2].wrapping_mul(l[2]));
    (dot >> 14).clamp(0, ONE)
}

/// A point of a surface that is looked at, and the sum of its light: what the surface's colour takes part in, and highlights.
/// Vectors 2.14, light 8.8.
struct Look<'n> {
    normal: &'n [i32; 3],
    viewer: [i32; 3],
    body: [i32; 3],
    shine: [i32; 3],
}

/// `sum += color · factor`, 2.14.
#[inline(always)]
fn add(sum: &mut [i32; 3], color: &[u16; 3], factor: i32) {
    sum[0] += (i32::from(color[0]) * factor) >> 14;
    sum[1] += (i32::from(color[1]) * factor) >> 14;
    sum[2] += (i32::from(color[2]) * factor) >> 14;
}

impl<const D: usize, const P: usize> LitMaterial<D, P> {
    /// Whether the mesh's colours take part.
    #[inline]
    #[must_use]
    pub const fn vertex_colors(&self) -> bool {
        self.vertex_colors
    }

    /// Whether normals of faces that show their back are turned round.
    #[inline]
    #[must_use]
    pub const fn is_two_sided(&self) -> bool {
        self.two_sided
    }

    /// The space of [`near`](Self::near)'s positions.
    #[inline]
    #[must_use]
    pub const fn space(&self) -> &LocalSpace {
        &self.space
    }

    /// The normal that is turned towards the viewer, seen from the point `p` (local units) of the surface: where a vertex
    /// belongs to faces on both sides.
    pub fn towards_viewer(&self, normal: [i32; 3], p: [i32; 3]) -> [i32; 3] {
        let [x, y, z] = self.viewer(&p);
        let dot =
            normal[0].wrapping_mul(x).wrapping_add(normal[1].wrapping_mul(y)).wrapping_add(normal[2].wrapping_mul(z));
        if dot < 0 { normal.map(i32::wrapping_neg) } else { normal }
    }

    #[inline(never)]
    fn viewer(&self, p: &[i32; 3]) -> [i32; 3] {
        match self.viewer {
            LitViewer::Toward(direction) => long(direction),
            LitViewer::At { position: e, shift } => {
                let shift = shift & 31;
                unit_vector([(e[0] - p[0]) >> shift, (e[1] - p[1]) >> shift, (e[2] - p[2]) >> shift])
            }
        }
    }

    /// Nothing but the ambient light.
    #[inline(always)]
    fn look<'n>(&self, normal: &'n [i32; 3]) -> Look<'n> {
        let [r, g, b] = self.ambient;
        Look { normal, viewer: [0; 3], body: [i32::from(r), i32::from(g), i32::from(b)], shine: [0; 3] }
    }

    /// Red, green, blue under the ambient and the directional lights, seen from far away, whatever the viewer is.
    ///
    /// # Format
    /// `normal` 2.14, of length 1; result 8.8, at most 255. `color` is that of the vertex, or white.
    #[inline]
    #[must_use]
    pub fn far(&self, normal: &[i32; 3], color: [u8; 3]) -> [i32; 3] {
        let mut look = self.look(normal);
        for light in &self.directional {
            self.add_far(&mut look, light);
        }
        self.total(&look, color)
    }

    #[inline(always)]
    fn add_far(&self, look: &mut Look<'_>, light: &LitDirection) {
        let facing = cosine(look.normal, long(light.direction));
        if facing > 0 {
            add(&mut look.body, &light.colors.diffuse, facing);
            if self.shininess != 0 {
                let shine = power(cosine(look.normal, long(light.half)), self.shininess);
                add(&mut look.shine, &light.colors.specular, shine);
            }
        }
    }

    /// Red, green, blue under all lights at the point `p` of the mesh, in units of [`space`](Self::space).
    ///
    /// # Format
    /// As [`far`](Self::far).
    #[inline(never)]
    #[must_use]
    pub fn near(&self, normal: &[i32; 3], p: &[i32; 3], color: [u8; 3]) -> [i32; 3] {
        self.near_here(normal, p, color)
    }

    /// The same in the function that asks for it.
    #[inline(always)]
    pub(crate) fn near_here(&self, normal: &[i32; 3], p: &[i32; 3], color: [u8; 3]) -> [i32; 3] {
        let mut look = self.look(normal);
        let seen_from_afar = matches!(self.viewer, LitViewer::Toward(_));
        if self.shininess != 0 {
            look.viewer = self.viewer(p);
        }
        for light in &self.directional {
            if seen_from_afar {
                self.add_far(&mut look, light);
            } else {
                self.add_near(&mut look, &long(light.direction), ONE, &light.colors);
            }
        }
        for light in &self.points {
            let mut direction = [0; 3];
            let fade = light.from(p, &mut direction);
            if fade > 0 {
                self.add_near(&mut look, &direction, fade, &light.colors);
            }
        }
        self.total(&look, color)
    }

    #[inline(never)]
    fn add_near(&self, look: &mut Look<'_>, direction: &[i32; 3], fade: i32, colors: &LitColors) {
        let facing = cosine(look.normal, *direction);
        if facing > 0 {
            add(&mut look.body, &colors.diffuse, (facing * fade) >> 14);
            if self.shininess != 0 {
                let (l, v) = (direction, &look.viewer);
                // Below 2¹⁵ even where both are the same.
                let half = |k: usize| l[k] + v[k] - ((l[k] + v[k]) >> 6);
                let half = unit_vector([half(0), half(1), half(2)]);
                let shine = power(cosine(look.normal, half), self.shininess);
                add(&mut look.shine, &colors.specular, (shine * fade) >> 14);
            }
        }
    }

    #[inline(always)]
    fn total(&self, look: &Look<'_>, color: [u8; 3]) -> [i32; 3] {
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
        [(r + shine[0]).min(WHITE), (g + shine[1]).min(WHITE), (b + shine[2]).min(WHITE)]
    }

    /// A position of the mesh in local units.
    #[inline]
    #[must_use]
    pub fn local(&self, position: Vec3) -> [i32; 3] {
        let [x, y, z] = self.space.fine(position);
        [x >> 14, y >> 14, z >> 14]
    }
}
