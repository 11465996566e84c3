//! Lambert lighting: an ambient and a directional light.

use crate::math::{Affine, Vec3};
use embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};

/// The number 1 in the 2.14 format of normals.
pub const NORMAL_ONE: i16 = 1 << 14;

/// An ambient light and a directional one, with colours.
///
/// ```
/// use embedded_graphics_core::pixelcolor::Rgb888;
/// use zstrip::light::Light;
/// use zstrip::math::Vec3;
/// let light = Light::new(Vec3::from_ints(4, 7, 6), Rgb888::new(217, 217, 217), Rgb888::new(38, 38, 38));
/// # let _ = light;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// Copied word by word, instead of by a call.
#[repr(align(4))]
pub struct Light {
    /// Unit vector to the light, 2.14; zero for no directional light.
    direction: [i16; 3],
    /// Brightness a channel, 256 = full.
    diffuse: [u16; 3],
    ambient: [u16; 3],
}

/// Brightness of a colour's channels, 255 becoming 256.
const fn levels([r, g, b]: [u8; 3]) -> [u16; 3] {
    [r as u16 + (r >> 7) as u16, g as u16 + (g >> 7) as u16, b as u16 + (b >> 7) as u16]
}

/// The unit vector in a direction, 2.14, rounded; zero for the zero vector.
const fn unit(direction: Vec3) -> [i16; 3] {
    match direction.normalized() {
        Some(unit) => {
            let [x, y, z] = unit.to_bits();
            [((x + 2) >> 2) as i16, ((y + 2) >> 2) as i16, ((z + 2) >> 2) as i16]
        }
        None => [0; 3],
    }
}

/// The matrix of a model, shifted until its largest entry is at least 1/2, as in any rotation: models that are scaled far
/// down would leave few bits of a direction.
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

const fn shifted(row: [i32; 4], shift: u32) -> Vec3 {
    Vec3::from_bits([row[0] << shift, row[1] << shift, row[2] << shift])
}

impl Light {
    /// A light that comes from `direction`, a vector of any length that points *towards* it, beside an ambient one.
    ///
    /// A zero vector leaves the ambient light alone.
    #[must_use]
    pub fn new(direction: Vec3, diffuse: Rgb888, ambient: Rgb888) -> Self {
        let channels = |color: Rgb888| [color.r(), color.g(), color.b()];
        Self::from_channels(direction, channels(diffuse), channels(ambient))
    }

    /// [`new`](Self::new) for constants: colours as red, green and blue.
    #[must_use]
    pub const fn from_channels(direction: Vec3, diffuse: [u8; 3], ambient: [u8; 3]) -> Self {
        Self { direction: unit(direction), diffuse: levels(diffuse), ambient: levels(ambient) }
    }

    /// The same light, given in world (or eye) space, as seen from object space: what a shader needs, as normals are in
    /// object space. `model` may rotate, move and scale evenly.
    #[must_use]
    pub const fn to_object(&self, model: &Affine) -> Self {
        let [x, y, z] = self.direction;
        let direction = Vec3::from_bits([(x as i32) << 2, (y as i32) << 2, (z as i32) << 2]);
        Self { direction: unit(enlarged(model).inverse_rigid().transform_vector(direction)), ..*self }
    }

    /// The colour of a surface with a unit normal, rounded from what [`on`](Self::on) and [`Lit::shade`] make of it: red, green
    /// and blue in a word, blue lowest.
    #[inline(never)]
    #[must_use]
    pub fn shade(&self, mut color: u32, normal: [i16; 3]) -> u32 {
        let cosine = cosine(normal, self.direction);
        let mut shaded = 0;
        // Spelled out: at `opt-level = "s"` a loop would stay a loop.
        let mut shade = |ambient: u16, diffuse: u16| {
            color <<= 8;
            let channel = (color >> 24) as i32;
            let lit = channel * i32::from(ambient) + ((channel * i32::from(diffuse) * cosine) >> 14);
            shaded = shaded << 8 | ((lit.min(WHITE) + 128) >> 8) as u32;
        };
        let ([red, green, blue], [r, g, b]) = (self.ambient, self.diffuse);
        shade(red, r);
        shade(green, g);
        shade(blue, b);
        shaded
    }

    /// Light on a surface of a colour: what is the same for all its normals, worked out once.
    #[must_use]
    pub fn on(&self, color: [u8; 3]) -> Lit {
        // At most 255 · 256.
        let times = |level: [u16; 3]| {
            let [r, g, b] = color.map(u16::from);
            [r.wrapping_mul(level[0]), g.wrapping_mul(level[1]), b.wrapping_mul(level[2])]
        };
        Lit { direction: self.direction, ambient: times(self.ambient), diffuse: times(self.diffuse) }
    }
}

/// A [`Light`] on a colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
// Copied word by word, instead of by a call.
#[repr(align(4))]
pub struct Lit {
    direction: [i16; 3],
    /// 8.8 a channel.
    ambient: [u16; 3],
    diffuse: [u16; 3],
}

/// n · l in 2.14 of two unit vectors, 0 if they are more than a right angle apart.
///
/// # Format
/// Components are in -2¹⁵..2¹⁵, those of the light at most 2¹⁴: the sum is below 2³¹.
#[inline]
fn cosine([x, y, z]: [i16; 3], [lx, ly, lz]: [i16; 3]) -> i32 {
    let sum = i32::from(x) * i32::from(lx) + i32::from(y) * i32::from(ly) + i32::from(z) * i32::from(lz);
    (sum >> 14).clamp(0, 1 << 14)
}

/// The brightest channel value, 255 in 8.8.
const WHITE: i32 = 255 << 8;

impl Lit {
    /// Red, green, blue for a unit normal: ambient + diffuse · max(0, n · l), at most 255.
    ///
    /// # Format
    /// Normal 2.14; result 8.8, within 1/64 of the exact value for the same 2.14 vectors. n · l: 2²⁸ and a little.
    #[inline]
    #[must_use]
    pub fn shade(&self, normal: [i16; 3]) -> [i32; 3] {
        let cosine = cosine(normal, self.direction);
        let channel =
            |k: usize| (i32::from(self.ambient[k]) + ((i32::from(self.diffuse[k]) * cosine) >> 14)).min(WHITE);
        [channel(0), channel(1), channel(2)]
    }
}
