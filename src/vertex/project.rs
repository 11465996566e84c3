//! Clip space → screen: vertices in clip space come in, are divided by w and snapped to 1/256 px, and go out as
//! [`ScreenVertex`].

use super::clip::{ClipVertex, Outcode};
use crate::math::{Divisor, SMALL_CORE, Scalar, byte_zeros, leading_zeros_long, mul_high, reciprocal};
use core::num::NonZeroU32;
use embedded_graphics_core::geometry::Point;

/// A vertex on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScreenVertex {
    /// Distance to the right of the screen's left edge, 24.8 px; at most ±32,767 px.
    pub x: i32,
    /// Distance down from the screen's top edge, 24.8 px; at most ±32,767 px.
    pub y: i32,
    /// Depth, 0 near, 65,535 far.
    pub z: u16,
}

impl ScreenVertex {
    /// Makes a vertex from raw 24.8 coordinates and depth.
    #[must_use]
    pub const fn new(x: i32, y: i32, z: u16) -> Self {
        Self { x, y, z }
    }

    /// Returns the pixel that the vertex lies in.
    #[must_use]
    pub const fn pixel(&self) -> Point {
        Point::new(self.x >> 8, self.y >> 8)
    }
}

/// Result of projecting a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projected {
    /// The vertex is on the screen, or at least within the guard band.
    OnScreen(ScreenVertex),
    /// The vertex is outside of the planes in this outcode.
    NeedsClip(Outcode),
}

/// Returns the outcode of a vertex in clip space, or projects and snaps it, if the outcode is empty.
pub fn projected(vertex: &ClipVertex) -> Projected {
    let code = Outcode::of(vertex);
    let placed = if code.0 == 0 { project(vertex) } else { None };
    placed.map_or(Projected::NeedsClip(code), Projected::OnScreen)
}

/// Returns twice the signed area of a triangle. It is negative for a front face (counter-clockwise with y up), because
/// y points down on the screen.
///
/// # Format
/// Differences of 24.8 coordinates are at most 2²⁴, and the result is below 2⁵⁰ in units of 2⁻¹⁶ px². Exact.
#[inline]
#[must_use]
pub fn signed_area(a: &ScreenVertex, b: &ScreenVertex, c: &ScreenVertex) -> i64 {
    let (bx, by) = (b.x - a.x, b.y - a.y);
    let (cx, cy) = (c.x - a.x, c.y - a.y);
    // Nearly all triangles: 2¹⁵ · 2¹⁵ · 2 fits 32 bits.
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

/// Returns whether a difference of coordinates is within -2¹⁵..2¹⁵, so that a product of two differences fits 31 bits.
#[inline]
pub(crate) fn small(difference: i32) -> bool {
    (difference + (1 << 15)) as u32 >> 16 == 0
}

/// Divides a vertex by w and snaps it; `None` unless w > 0.
///
/// x and y must lie in the guard band, and z in 0..=w. All three are clamped, because rounding in the clipper may leave
/// them slightly outside.
///
/// # Format
/// Positions are within 2⁻⁴ of 1/256 px, plus rounding to nearest. w is normalized to 2³¹..2³² (the cut bits are worth
/// 2⁻³¹), and x to 2⁻²⁵ of w. x / w spans 2²³ steps on the guard band, is computed in units of 2⁻⁷ step, and is off by
/// less than 5 units.
/// Depth is 65,535 z / w, rounded to nearest, and within 2⁻¹² of a step besides the rounding.
#[inline(never)]
#[must_use]
pub fn project(v: &ClipVertex) -> Option<ScreenVertex> {
    if v.w <= 0 {
        return None;
    }
    // w' = w 2^shift / 2³². x' keeps 7 bits of headroom for the guard band: x 2^shift / 2³⁹, at most w' / 2.
    let shift = leading_zeros_long(v.w as u64) as i32;
    let normalized = |c: i64| shift_signed(c, shift - 32);
    let w = normalized(v.w) as u32;
    // 2²³ - 1 steps: half of w, less the 2²³rd part of that half.
    let limit = ((w >> 1) - (w >> 24)) as i32;
    let position = |c: i64| clamped(shift_signed(c, shift - 39), limit);
    Some(divide(position(v.x), position(v.y), normalized(v.z.clamp(0, v.w)) as u32, w))
}

/// Returns `value` 2^`up`, rounded down.
#[inline(never)]
const fn shift_signed(value: i64, up: i32) -> i64 {
    if up >= 0 { value << up } else { value >> -up }
}

/// Returns `value`, but no more than `limit` in either direction.
#[inline(never)]
fn clamped(value: i64, limit: i32) -> i32 {
    // `Ord::clamp` is not used: it can panic, if its limits are in the wrong order.
    value.max((-limit).into()).min(limit.into()) as i32
}

/// Returns 1 / w of a vertex, on a scale that all vertices of a draw share; 0 unless w > 0.
///
/// # Format
/// The result is mantissa · 2^exponent. The lower 6 bits hold the exponent, and the upper 26 bits the mantissa with its
/// top bit set. The relative error is below 2⁻²⁵.
#[inline]
pub fn inverse_w(v: &ClipVertex) -> u32 {
    if v.w <= 0 {
        return 0;
    }
    let exponent = leading_zeros_long(v.w as u64);
    reciprocal(((v.w << (exponent - 1)) >> 31) as u32) & !63 | exponent
}

/// Returns 1 / w as [`inverse_w`] does, bit by bit, for 2²⁶ ≤ w < 2³¹.
#[inline(always)]
pub(super) fn inverse_w_short(w: i32) -> u32 {
    let zeros = zeros_short(w);
    reciprocal((w as u32) << zeros) & !63 | (32 + zeros)
}

/// Returns the leading zeros of a number in 2²⁶..2³¹, 1 to 5. The mask tells the compiler that no shift is by more than
/// 31.
#[inline(always)]
const fn zeros_short(w: i32) -> u32 {
    7 & if SMALL_CORE { byte_zeros((w >> 24) as u8) } else { (w as u32).leading_zeros() }
}

/// Projects 32-bit clip coordinates with 2²⁶ ≤ w ≤ 2³⁰ + 1, |x| and |y| at most that large, and 0 ≤ z ≤ w. The result
/// equals that of [`project`], bit by bit.
#[inline]
pub(super) fn project_short([x, y, z, w]: [i32; 4]) -> ScreenVertex {
    let zeros = zeros_short(w);
    divide(x >> (7 - zeros), y >> (7 - zeros), (z as u32) << zeros, (w as u32) << zeros)
}

/// Divides x and y, which have 7 bits less than w and z, and z by a w in 2³¹..2³².
#[inline(always)]
fn divide(x: i32, y: i32, z: u32, w: u32) -> ScreenVertex {
    let divisor = Divisor::of_normalized(w);
    let position = |c: i32| (divisor.divide_normalized(c) + 64) >> 7;
    ScreenVertex { x: position(x), y: position(y), z: sixteen_bits(divisor.fraction_normalized(z)) }
}

/// Growth of depth with distance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthScale {
    /// Depth grows as z / w does. It is exact on the screen, and most of its steps lie near to the eye. See
    /// [`DepthPrecision`](crate::math::DepthPrecision).
    #[default]
    Perspective,
    /// Depth grows evenly from the near to the far plane of a perspective camera, at vertices.
    ///
    /// Between vertices, depth is interpolated linearly on the screen as always, which is not even in distance. Halfway
    /// on the screen between distances a and b, the interpolated depth is that of (a + b) / 2. The surface seen there
    /// is at 2 a b / (a + b), which is nearer by (b - a)² / 2 (a + b). Faces that share an edge agree on its depth.
    /// Small faces, and faces towards the viewer, are off by little; large floors should be divided. Depths drawn in
    /// one scale cannot be compared with depths drawn in the other.
    Uniform {
        /// The camera's far distance, in the units that the camera was made with. If it is not above 0, depth is as in
        /// perspective.
        far: Scalar,
    },
}

#[cfg(feature = "defmt")]
impl defmt::Format for DepthScale {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}", defmt::Debug2Format(self));
    }
}

/// Depth as 65,535 z / far. z of clip space, far (w - near) / (far - near), is even in distance as long as it is not
/// divided.
#[derive(Clone, Copy, Debug)]
pub(super) struct UniformDepth {
    /// 2⁶³ / far, with far normalized to 2³¹..2³².
    reciprocal: NonZeroU32,
    /// Exponent: normalized far times two to this power is the w of the far plane in clip space.
    exponent: i32,
    /// Always [`rounded`](Self::rounded). As a function pointer, it is linked only by programs that make a
    /// `UniformDepth`.
    depth: fn(&Self, i64) -> u16,
}

impl UniformDepth {
    /// Makes the scale for clip coordinates that are raw 32.32 times 2^`scale`; `None` unless `far` is above 0.
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

    /// Returns the depth for a z in clip space.
    pub(super) fn depth(&self, z: i64) -> u16 {
        (self.depth)(self, z)
    }

    /// Returns the depth for a z in clip space, rounded to nearest.
    ///
    /// # Format
    /// z is cut to 32 bits, and the reciprocal is good to 2⁻²⁹: the result is within 2⁻¹² of a step besides the
    /// rounding.
    fn rounded(&self, z: i64) -> u16 {
        if z <= 0 {
            return 0;
        }
        let zeros = leading_zeros_long(z as u64);
        let high = (((z as u64) << zeros) >> 32) as u32;
        // z / far as 1.31, after the shift that undoes the powers of two.
        let down = self.exponent - 32 + zeros as i32;
        let fraction = if down < 0 { 1 << 31 } else { mul_high(high, self.reciprocal.get()) >> down.min(31) };
        sixteen_bits(fraction.min(1 << 31))
    }
}

/// Returns 65,535 times a fraction in 1.31, at most 1, rounded to nearest.
///
/// # Format
/// Fractions up to 2¹⁴ - 2 units above 1 count as 1.
#[inline]
fn sixteen_bits(fraction: u32) -> u16 {
    // As 16.15: 2¹⁶ f - f, and a half. The result is rounded down, so the subtracted f is rounded up.
    ((fraction + (1 << 14) - ((fraction + 0xFFFF) >> 16)) >> 15) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    /// The largest coordinate that the rasterizer takes, in 24.8: just above 32,767 px.
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
            assert_eq!(inverse_w_short(w), inverse_w(&long), "{w}");
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
