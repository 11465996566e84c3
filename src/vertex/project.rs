//! Clip space → screen: divide, and snap to 1/256 px.

use super::clip::ClipVertex;
use crate::math::{Divisor, SMALL_CORE, Scalar, byte_zeros, leading_zeros_long, mul_high, reciprocal};
use core::num::NonZeroU32;
use embedded_graphics_core::geometry::Point;

/// A vertex on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScreenVertex {
    /// To the right, 24.8 px from the screen's left edge; at most ±32,767 px.
    pub x: i32,
    /// Down, 24.8 px from the screen's top edge; at most ±32,767 px.
    pub y: i32,
    /// Depth, 0 near, 65,535 far.
    pub z: u16,
}

impl ScreenVertex {
    /// From raw 24.8 coordinates and depth.
    #[must_use]
    pub const fn new(x: i32, y: i32, z: u16) -> Self {
        Self { x, y, z }
    }

    /// The pixel it is in.
    #[must_use]
    pub const fn pixel(&self) -> Point {
        Point::new(self.x >> 8, self.y >> 8)
    }
}

/// Twice the signed area of a triangle: negative for a front face (counter-clockwise with y up), for y points down here.
///
/// # Format
/// Differences of 24.8 coordinates are at most 2²⁴, the result below 2⁵⁰ in units of 2⁻¹⁶ px². Exact.
#[inline]
#[must_use]
pub fn signed_area(a: &ScreenVertex, b: &ScreenVertex, c: &ScreenVertex) -> i64 {
    let (bx, by) = (b.x - a.x, b.y - a.y);
    let (cx, cy) = (c.x - a.x, c.y - a.y);
    // 2¹⁵ · 2¹⁵ · 2 needs no more than 32 bits: nearly all triangles.
    if small(bx) & small(by) & small(cx) & small(cy) {
        i64::from(bx * cy - cx * by)
    } else {
        wide_area((bx, by), (cx, cy))
    }
}

#[inline(never)]
fn wide_area(b: (i32, i32), c: (i32, i32)) -> i64 {
    i64::from(b.0) * i64::from(c.1) - i64::from(c.0) * i64::from(b.1)
}

/// Whether a difference of coordinates is within -2¹⁵..2¹⁵, so that products of two fit 31 bits.
#[inline]
pub(crate) fn small(difference: i32) -> bool {
    (difference + (1 << 15)) as u32 >> 16 == 0
}

/// Divides by w and snaps; `None` unless w > 0.
///
/// x, y must lie in the guard band and z in 0..=w (all are clamped, for what rounding in the clipper may leave over).
///
/// # Format
/// Positions: within 2⁻⁴ of 1/256 px, plus rounding to nearest. w is normalized to 2³¹..2³² (cut bits: 2⁻³¹), x to
/// 2⁻²⁵ of w, and x / w, on the guard band 2²³ steps, comes in units of 2⁻⁷ and is off by less than 5.
/// Depth: 65,535 z / w rounded to nearest, within 2⁻¹² of a step besides.
#[inline(never)]
#[must_use]
pub fn project(v: &ClipVertex) -> Option<ScreenVertex> {
    if v.w <= 0 {
        return None;
    }
    // w' = w 2^shift / 2³². x' keeps 7 bits of headroom for the guard band: x 2^shift / 2³⁹, at most w' / 2.
    let shift = leading_zeros_long(v.w as u64) as i32;
    let scaled = |c: i64| shifted(c, shift - 32);
    let w = scaled(v.w) as u32;
    // 2²³ - 1 steps: half of w, less its 2²³rd part.
    let limit = ((w >> 1) - (w >> 24)) as i32;
    let position = |c: i64| clamped(shifted(c, shift - 39), limit);
    Some(divide(position(v.x), position(v.y), scaled(v.z.clamp(0, v.w)) as u32, w))
}

/// `value` 2^`up`, rounded down.
#[inline(never)]
const fn shifted(value: i64, up: i32) -> i64 {
    if up >= 0 { value << up } else { value >> -up }
}

/// `value`, but no more than `limit` in either direction.
#[inline(never)]
fn clamped(value: i64, limit: i32) -> i32 {
    // `clamp` panics where the limits are the wrong way round.
    value.max((-limit).into()).min(limit.into()) as i32
}

/// 1 / w of a vertex, on a scale that all vertices of a draw share; 0 unless w > 0.
///
/// # Format
/// Mantissa · 2^exponent: the exponent in the lower 6 bits, the mantissa, with its top bit set, in the 26 above them;
/// relative error below 2⁻²⁵.
#[inline]
pub fn inverse_w(v: &ClipVertex) -> u32 {
    if v.w <= 0 {
        return 0;
    }
    let exponent = leading_zeros_long(v.w as u64);
    reciprocal(((v.w << (exponent - 1)) >> 31) as u32) & !63 | exponent
}

/// [`project`] of 32-bit clip coordinates with 2²⁶ ≤ w ≤ 2³⁰ + 1, |x|, |y| as much, and 0 ≤ z ≤ w: the same result, bit by bit.
#[inline]
pub(super) fn project_short([x, y, z, w]: [i32; 4]) -> ScreenVertex {
    // 1 to 5; the compiler knows then that no shift is by more than 31.
    let zeros = 7 & if SMALL_CORE { byte_zeros((w >> 24) as u8) } else { (w as u32).leading_zeros() };
    divide(x >> (7 - zeros), y >> (7 - zeros), (z as u32) << zeros, (w as u32) << zeros)
}

/// The division itself: x and y with 7 bits less than w and z, w in 2³¹..2³².
#[inline(always)]
fn divide(x: i32, y: i32, z: u32, w: u32) -> ScreenVertex {
    let divisor = Divisor::of_normalized(w);
    let position = |c: i32| (divisor.divide_normalized(c) + 64) >> 7;
    ScreenVertex { x: position(x), y: position(y), z: sixteen_bits(divisor.fraction_normalized(z)) }
}

/// How depth grows with distance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthScale {
    /// As z / w does: exact on the screen, most of it used up near to the eye. See
    /// [`DepthPrecision`](crate::math::DepthPrecision).
    #[default]
    Perspective,
    /// Evenly, from the near to the far plane of a perspective camera, at vertices.
    ///
    /// Between vertices it is interpolated linearly on the screen like any depth, which is not even in distance: halfway on the
    /// screen between distances a and b it is that of (a + b) / 2, where 2 a b / (a + b) is seen, (b - a)² / 2 (a + b) less.
    /// Faces that share an edge agree on it, and small faces, or those towards the viewer, are off by little; large floors
    /// should be divided. What is drawn in one scale does not compare with what is drawn in the other.
    Uniform {
        /// The camera's far distance, in the units that the camera was made for. Not above 0: as in perspective.
        far: Scalar,
    },
}

#[cfg(feature = "defmt")]
impl defmt::Format for DepthScale {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}", defmt::Debug2Format(self));
    }
}

/// Depth as 65,535 z / far: z of clip space, far (w - near) / (far - near), is even in distance before it is divided.
#[derive(Clone, Copy, Debug)]
pub(super) struct UniformDepth {
    /// 2⁶³ / far, far normalized to 2³¹..2³².
    reciprocal: NonZeroU32,
    /// Normalized far times two to this power is far's w in clip space.
    exponent: i32,
    /// [`rounded`](Self::rounded): a program links it where it makes one of these.
    depth: fn(&Self, i64) -> u16,
}

impl UniformDepth {
    /// For clip coordinates that are raw 32.32 times 2^`scale`.
    pub(super) const fn new(far: Scalar, scale: i32) -> Option<Self> {
        let far = far.to_bits();
        if far <= 0 {
            return None;
        }
        let zeros = far.leading_zeros();
        match NonZeroU32::new(reciprocal((far as u32) << zeros)) {
            Some(reciprocal) => Some(Self { reciprocal, exponent: 16 + scale - zeros as i32, depth: Self::rounded }),
            None => None,
        }
    }

    /// The depth of z in clip space.
    pub(super) fn depth(&self, z: i64) -> u16 {
        (self.depth)(self, z)
    }

    /// Rounded to nearest.
    ///
    /// # Format
    /// z is cut to 32 bits, the reciprocal good to 2⁻²⁹: within 2⁻¹² of a step besides the rounding.
    fn rounded(&self, z: i64) -> u16 {
        if z <= 0 {
            return 0;
        }
        let zeros = leading_zeros_long(z as u64);
        let high = (((z as u64) << zeros) >> 32) as u32;
        // z / far as 1.31, once the powers of two are made up for.
        let down = self.exponent - 32 + zeros as i32;
        let fraction = if down < 0 { 1 << 31 } else { mul_high(high, self.reciprocal.get()) >> down.min(31) };
        sixteen_bits(fraction.min(1 << 31))
    }
}

/// 65,535 times a fraction in 1.31, at most 1, rounded to nearest.
///
/// # Format
/// Fractions up to 2¹⁴ - 2 units above 1 count as 1.
#[inline]
fn sixteen_bits(fraction: u32) -> u16 {
    // As 16.15: 2¹⁶ f - f, and a half; rounded down, so what is taken away is rounded up.
    ((fraction + (1 << 14) - ((fraction + 0xFFFF) >> 16)) >> 15) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    /// The largest coordinate the rasterizer takes, in 24.8: just above 32,767 px.
    const LIMIT: i32 = (1 << 23) - 1;

    #[test]
    fn short_projection_is_the_same() {
        let mut rng = Rng::new(3);
        let mut next = |bound: i32| rng.below(bound as u64) as i32;
        for _ in 0..100_000 {
            let w = (1 << 26) + next((1 << 30) - (1 << 26));
            let w = if next(10) == 0 { 1 << (26 + next(4)) } else { w };
            let (x, y, z) = (next(i32::MAX) - (1 << 30), next(i32::MAX) - (1 << 30), next(w));
            let long = ClipVertex { x: x.into(), y: y.into(), z: z.into(), w: w.into() };
            assert_eq!(Some(project_short([x, y, z, w])), project(&long), "{x} {y} {z} {w}");
        }
    }

    /// Vertices outside of the guard band are projected before their outcode tells that the result is not needed.
    #[test]
    fn positions_far_outside_of_the_guard_band_stop_at_the_limit() {
        for w in [1, 3, 1 << 20, (1 << 49) - 1] {
            for far in [64 * w, 65 * w, 128 * w - 1, 128 * w] {
                let placed = project(&ClipVertex { x: far, y: -far, z: w, w });
                assert_eq!(placed, Some(ScreenVertex::new(LIMIT, -LIMIT, 65_535)), "w {w}, x {far}");
            }
        }
        assert_eq!(project(&ClipVertex::default()), None);
    }

    #[test]
    fn depth_is_rounded_to_nearest() {
        let mut worst = 0_f64;
        for w in [1, 7, 65_535, 65_536, (1 << 32) + 12_345, (1 << 55) - 1] {
            for k in 0..=4000 {
                let z = (i128::from(w) * k / 4000) as i64;
                let exact = 65_535.0 * z as f64 / w as f64;
                let placed = project(&ClipVertex { x: 0, y: 0, z, w }).expect("w is positive");
                worst = worst.max((f64::from(placed.z) - exact).abs());
            }
        }
        assert!(worst <= 0.5 + 1.0 / 4096.0, "worst {worst} steps");
    }
}
