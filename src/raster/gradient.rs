//! Plane equations: vertices and the values at them come in, and the change of depth and varyings per pixel goes out.
//!
//! A value that is v0, v1, v2 at the vertices is a plane over the screen. By Cramer's rule
//!
//! ```text
//! dv/dx = ((v1 - v0) (y2 - y0) - (v2 - v0) (y1 - y0)) / area        area = (x1 - x0) (y2 - y0) - (x2 - x0) (y1 - y0)
//! dv/dy = ((v2 - v0) (x1 - x0) - (v1 - v0) (x2 - x0)) / area
//! ```
//!
//! All values are kept modulo 2³². Inside the triangle the true value fits 32 bits. Sums and integer multiples of the
//! gradients are exact modulo 2³². So it does not matter that a gradient, or the plane outside of the triangle, does
//! not fit.
//! The only error is the rounding of the gradients, 2⁻¹⁶ per pixel in 16.16: below 2⁻³ over the largest viewport.

use crate::math::{
    SMALL_CORE, divide_modulo, leading_zeros, leading_zeros_long, mul_high_outlined, mul_high_signed, reciprocal,
};
use crate::vertex::{Plane64, ScreenVertex};

/// The part of the plane equations that is common to all values on a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Gradients {
    /// Vertices 1 and 2 relative to vertex 0; with the opposite sign where the area is below 0.
    x: [i32; 2],
    y: [i32; 2],
    /// The centre of the pixel at the origin, relative to vertex 0.
    to: (i32, i32),
    /// Twice the signed area; never 0.
    area: i64,
    /// 2⁶³ / (|area| << shift), where shift puts the top bit of |area| into bit 31; 0 for triangles of more than 512
    /// px.
    reciprocal: u32,
    shift: i32,
    /// Set if x and y are within -2¹⁵..2¹⁵.
    is_short: bool,
    /// The pixel at which planes are evaluated: the one that holds vertex 0, moved onto the screen for large triangles.
    origin: (i32, i32),
}

/// A plane: the values at pixel centres, modulo 2³².
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlaneEquation {
    /// Change from one pixel to the next on the right.
    pub dx: i32,
    /// Change from one row to the next.
    pub dy: i32,
    /// Value at the centre of the screen's first pixel. The value at pixel (x, y) is `base + dx x + dy y`.
    pub base: u32,
}

impl Gradients {
    /// Prepares the planes of a triangle with its [`signed_area`](crate::vertex::signed_area), which must not be 0, for
    /// a screen of `width` × `height` px.
    #[inline]
    pub fn new(v: &[ScreenVertex; 3], area: i64, (width, height): (u16, u16)) -> Self {
        let [a, b, c] = v;
        let (x, y, is_short);
        if area < 0 {
            (x, y) = ([a.x - b.x, a.x - c.x], [a.y - b.y, a.y - c.y]);
            is_short = within(1 << 15, [-x[0], -x[1], -y[0], -y[1]]);
        } else {
            (x, y) = ([b.x - a.x, c.x - a.x], [b.y - a.y, c.y - a.y]);
            is_short = within(1 << 15, [x[0], x[1], y[0], y[1]]);
        }
        let origin = (a.x >> 8, a.y >> 8);
        let to = (256 * origin.0 + 128 - a.x, 256 * origin.1 + 128 - a.y);
        let mut it = Self { x, y, to, area, reciprocal: 0, shift: 0, is_short, origin };
        if is_short {
            let magnitude = (area as i32).unsigned_abs();
            let shift = leading_zeros(magnitude);
            it.shift = shift as i32;
            it.reciprocal = reciprocal(magnitude << shift);
        } else if within(1 << 17, [b.x - a.x, c.x - a.x, b.y - a.y, c.y - a.y]) {
            // Areas up to 2³⁵. Only their upper 32 bits count, which loses 2⁻³¹.
            let magnitude = area.unsigned_abs();
            let zeros = leading_zeros_long(magnitude);
            it.shift = zeros as i32 - 32;
            it.reciprocal = reciprocal(((magnitude << zeros) >> 32) as u32);
        } else {
            // `min` and `max` instead of `clamp`, which would panic on an empty screen.
            it.origin = (origin.0.min(i32::from(width) - 1).max(0), origin.1.min(i32::from(height) - 1).max(0));
            it.to = (256 * it.origin.0 + 128 - a.x, 256 * it.origin.1 + 128 - a.y);
        }
        it
    }

    /// Returns the plane through the values at the three vertices times 2^`scale`, modulo 2³²; usually 16.16.
    ///
    /// # Format
    /// Values are arbitrary, and `scale` is up to 16. Evaluated at a pixel inside the triangle and on the screen, the
    /// result is within 2¹³ of the exact plane: 2⁻³ of a unit in 16.16.
    #[inline(never)]
    pub fn plane(&self, values: [i32; 3], scale: u32) -> PlaneEquation {
        let (v1, v2) = (values[1].wrapping_sub(values[0]), values[2].wrapping_sub(values[0]));
        if v1 | v2 == 0 {
            return PlaneEquation { dx: 0, dy: 0, base: (values[0] as u32) << scale };
        }
        // The usual case, small differences on a small triangle, fits 32 bits: 2¹⁴ · 2¹⁵ · 2.
        if self.is_short && moderate(v1) & moderate(v2) {
            let (a, b) = (v1 * self.y[1] - v2 * self.y[0], v2 * self.x[0] - v1 * self.x[1]);
            // 256 2^scale n / area = 2^(shift + 8 + scale) n reciprocal / 2⁶³.
            if let Some((dx, dy)) = gradients(a, b, self.reciprocal, self.shift + scale as i32 - 23) {
                return self.through_vertex_0(values[0], scale, dx, dy);
            }
        }
        self.plane_outlined(values, scale)
    }

    /// Returns the plane for all cases that [`plane`](Self::plane) does not handle itself.
    #[inline(never)]
    fn plane_outlined(&self, values: [i32; 3], scale: u32) -> PlaneEquation {
        let numerators = self.numerators(values);
        match self.gentle(&numerators, scale) {
            Some([dx, dy]) => self.through_vertex_0(values[0], scale, dx, dy),
            None => {
                let plane = self.steep(values[0], &numerators, scale);
                PlaneEquation { base: plane.base.wrapping_sub(self.origin_offset(plane.dx, plane.dy)), ..plane }
            }
        }
    }

    /// Returns the plane with the gradients `dx` and `dy` through vertex 0.
    ///
    /// # Format
    /// Both gradients are below 2²⁹, and the origin's centre is at most half a pixel from vertex 0: 2²⁹⁻⁶ · 2⁷ twice,
    /// below 2³¹. The cut bits are 2⁻¹¹ of a unit in 16.16.
    #[inline(always)]
    fn through_vertex_0(&self, v0: i32, scale: u32, dx: i32, dy: i32) -> PlaneEquation {
        let offset = ((dx >> 6) * self.to.0 + (dy >> 6) * self.to.1) >> 2;
        let base = ((v0 as u32) << scale).wrapping_add(offset as u32);
        PlaneEquation { dx, dy, base: base.wrapping_sub(self.origin_offset(dx, dy)) }
    }

    /// Returns the change of a plane with these gradients from the screen's corner to the origin.
    #[inline(always)]
    fn origin_offset(&self, dx: i32, dy: i32) -> u32 {
        dx.wrapping_mul(self.origin.0).wrapping_add(dy.wrapping_mul(self.origin.1)) as u32
    }

    /// Returns the plane of any triangle and any values.
    #[inline(always)]
    fn steep(&self, v0: i32, numerators: &[i64; 2], scale: u32) -> PlaneEquation {
        // The numbers were rounded down, and cutting their low bits rounds them down again: the result is rounded down.
        let mut plane = Plane64::ZERO;
        self.exact(v0, numerators, &mut plane);
        let cut = |value: i64| (value >> (32 - scale)) as u32;
        PlaneEquation { dx: cut(plane.dx) as i32, dy: cut(plane.dy) as i32, base: cut(plane.base) }
    }

    /// Returns the gradients times |area| / 256.
    ///
    /// # Format
    /// Differences of 33 bits times 2²⁵ are below 2⁵⁸, and their sums below 2⁵⁹.
    fn numerators(&self, [v0, v1, v2]: [i32; 3]) -> [i64; 2] {
        let v = [i64::from(v1) - i64::from(v0), i64::from(v2) - i64::from(v0)];
        [minor(&v, &self.y), -minor(&v, &self.x)]
    }

    /// Returns the gradients, 256 2^scale n / |area|, if both are below 2²⁸ (2¹² in 16.16).
    ///
    /// Below this bound, the reciprocal loses little enough: its relative error is below 2⁻²⁸, so less than 2⁻⁵ of a
    /// unit over 512 px in both directions, and one unit of 2⁻¹⁶ per pixel.
    ///
    /// 256 / |area| = 2^shift reciprocal / 2⁵⁵. n is normalized to n 2^up in 2³⁰..2³¹, or cut to this range (by less
    /// than 2⁻³⁰).
    fn gentle(&self, numerators: &[i64; 2], scale: u32) -> Option<[i32; 2]> {
        let mut gradients = [0; 2];
        for (gradient, n) in gradients.iter_mut().zip(numerators) {
            // Redundant sign bits. All but the last of them are shifted out.
            let zeros = leading_zeros_long((n ^ (n >> 63)) as u64);
            let normalized = (n << (zeros - 1) >> 32) as i32;
            let high = mul_high_outlined(normalized, self.reciprocal);
            // With up = zeros - 33: high 2³² 2^(shift + scale - up) / 2⁵⁵.
            let down = zeros as i32 - 10 - self.shift - scale as i32;
            if self.reciprocal == 0 || down < 0 {
                return None;
            }
            *gradient = high >> down.min(31);
            if (*gradient ^ *gradient >> 31) as u32 >> 28 != 0 {
                return None;
            }
        }
        Some(gradients)
    }

    /// Computes the plane from its gradients' numerators, with 32 fractional bits, modulo 2⁶⁴, and with its base at the
    /// origin. It divides by long division, for triangles that are larger or steep. Each of the plane's three numbers
    /// is rounded down.
    ///
    /// # Format
    /// The difference from vertex 0 to the origin is Σ n to, of up to 84 bits, made from two halves of each n.
    fn exact(&self, v0: i32, &[a, b]: &[i64; 2], plane: &mut Plane64) {
        let (x, y) = (i64::from(self.to.0), i64::from(self.to.1));
        let low = i64::from(a as u32) * x + i64::from(b as u32) * y;
        let high = (a >> 32) * x + (b >> 32) * y + (low >> 32);
        plane.base = (i64::from(v0) << 32).wrapping_add(self.divided(high, low as u32));
        plane.dx = self.divided(a >> 24, (a as u32) << 8);
        plane.dy = self.divided(b >> 24, (b as u32) << 8);
    }

    /// Returns (`high` 2³² + `low`) 2³² / |area|, rounded down, modulo 2⁶⁴.
    #[inline(always)]
    fn divided(&self, high: i64, low: u32) -> i64 {
        divide_modulo(high, low, self.area.unsigned_abs())
    }

    /// Sets `plane` to the plane through the values at the three vertices, with 32 fractional bits, modulo 2⁶⁴, by long
    /// division. Each of its three numbers is rounded down before the base is moved from the origin to the screen's
    /// corner.
    #[inline(never)]
    pub fn plane_wide(&self, values: [i32; 3], plane: &mut Plane64) {
        self.exact(values[0], &self.numerators(values), plane);
        let (x, y) = (i64::from(self.origin.0), i64::from(self.origin.1));
        plane.base = plane.base.wrapping_sub(plane.dx.wrapping_mul(x)).wrapping_sub(plane.dy.wrapping_mul(y));
    }
}

/// Returns ⌊n `reciprocal` 2^(`up` - 32)⌋ for two numerators n, if both results are below 2²⁸. The top bit of
/// `reciprocal` is set, and -32 < `up` < 32.
///
/// These are the results of [`Gradients::gentle`], bit for bit.
#[inline(always)]
pub(crate) fn gradients(a: i32, b: i32, reciprocal: u32, up: i32) -> Option<(i32, i32)> {
    let (dx, dy) = gradients_outlined(a, b, reciprocal, up);
    if dx == STEEP { None } else { Some((dx, dy)) }
}

/// Returns gradients as [`gradients`] does, inlined where the core has the registers.
#[inline(always)]
pub(crate) fn gradients_inlined(a: i32, b: i32, reciprocal: u32, up: i32) -> Option<(i32, i32)> {
    if SMALL_CORE {
        return gradients(a, b, reciprocal, up);
    }
    let (dx, dy) = gradients_or_steep(a, b, reciprocal, up);
    if dx == STEEP { None } else { Some((dx, dy)) }
}

/// Returns gradients as [`gradients`] does, or [`STEEP`] and 0. Two numbers are returned in registers.
///
/// Not inlined, because its registers would push the values that are live around it to the stack.
#[inline(never)]
fn gradients_outlined(a: i32, b: i32, reciprocal: u32, up: i32) -> (i32, i32) {
    gradients_or_steep(a, b, reciprocal, up)
}

/// Returns gradients as [`gradients`] does, or [`STEEP`] and 0.
#[inline(always)]
fn gradients_or_steep(a: i32, b: i32, reciprocal: u32, up: i32) -> (i32, i32) {
    let (dx, dy) = (high(a, reciprocal), high(b, reciprocal));
    let bits = ((dx ^ dx >> 31) | (dy ^ dy >> 31)) as u32;
    if up <= 0 {
        let down = -up & 31;
        return if bits >> down >> 28 == 0 { (dx >> down, dy >> down) } else { (STEEP, 0) };
    }
    // The result has bits of the low words, too.
    let low = |n: i32| (n as u32).wrapping_mul(reciprocal) >> ((32 - up) & 31);
    let (x, y) = ((dx << (up & 31)) as u32 | low(a), (dy << (up & 31)) as u32 | low(b));
    if up <= 28 && bits >> (28 - up) == 0 { (x as i32, y as i32) } else { (STEEP, 0) }
}

/// Stands for a gradient that is too large.
const STEEP: i32 = i32::MIN;

/// Returns the high word of a product with a number whose top bit is set, rounded down.
#[inline(always)]
pub(crate) fn high(a: i32, n: u32) -> i32 {
    if SMALL_CORE {
        mul_high_signed(a, n)
    } else {
        // One instruction, if n is taken as n - 2³².
        (((i64::from(a) * i64::from(n as i32)) >> 32) as i32).wrapping_add(a)
    }
}

/// Returns whether all numbers are within -`half`..`half`, where `half` is a power of two.
#[inline(always)]
fn within(half: i32, [a, b, c, d]: [i32; 4]) -> bool {
    (((a + half) | (b + half) | (c + half) | (d + half)) as u32) < 2 * half as u32
}

/// Returns whether a difference of values is within -2¹⁴..2¹⁴.
#[inline]
fn moderate(difference: i32) -> bool {
    (difference.wrapping_add(1 << 14)) as u32 >> 15 == 0
}

/// Returns the determinant of differences of values and of coordinates.
#[inline(never)]
fn minor(v: &[i64; 2], c: &[i32; 2]) -> i64 {
    v[0] * i64::from(c[1]) - v[1] * i64::from(c[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    /// Compares gradients in 32 bits with those of the long way, and with exact ones.
    #[test]
    fn short_gradients_are_those_of_the_long_way() {
        let mut rng = Rng::new(1);
        let (mut short, mut steep) = (0, 0);
        for case in 0..200_000 {
            let size = 1 << (2 + case % 13);
            let mut point = || ScreenVertex::new(rng.between(-size, size), rng.between(-size, size), 0);
            let v = [point(), point(), point()];
            let area = crate::vertex::signed_area(&v[0], &v[1], &v[2]);
            if area == 0 {
                continue;
            }
            let most = 1 << (1 + case / 13 % 14);
            let values = [0, rng.between(-most, most), rng.between(-most, most)];
            let scale = [16, 13, 3, 0][case % 4];
            let plan = Gradients::new(&v, area, (320, 240));
            let numerators = plan.numerators(values);
            let [a, b] = numerators.map(|n| i32::try_from(n).expect("32 bits"));
            let up = plan.shift + scale as i32 - 23;
            let found = gradients(a, b, plan.reciprocal, up);
            assert_eq!(found, plan.gentle(&numerators, scale).map(Into::into), "{v:?} {values:?} {scale}");
            let exact = numerators.map(|n| (i128::from(n) << (8 + scale)) as f64 / area.abs() as f64);
            match found {
                Some((x, y)) => {
                    short += 1;
                    for (found, exact) in [x, y].into_iter().zip(exact) {
                        let bound = 1.0 + exact.abs() * 2f64.powi(-28);
                        assert!((f64::from(found) - exact).abs() <= bound, "{found} {exact}");
                    }
                }
                None => {
                    steep += 1;
                    assert!(exact.iter().any(|exact| exact.abs() > 2f64.powi(27)), "{exact:?}");
                }
            }
        }
        assert!(short > 100_000 && steep > 1000, "{short}, {steep}");
    }

    #[test]
    fn both_cores_multiply_alike() {
        let mut rng = Rng::new(1);
        for case in 0..100_000 {
            let (a, n) = (rng.next_u32() as i32 >> (2 + case % 20), rng.next_u32() | 1 << 31);
            let exact = ((i64::from(a) * i64::from(n)) >> 32) as i32;
            assert_eq!((high(a, n), mul_high_signed(a, n)), (exact, exact), "{a} {n}");
        }
    }

    #[test]
    fn what_is_within_a_range_is_so_at_its_ends() {
        for at in 0..4 {
            for (value, expected) in [(-32_769, false), (-32_768, true), (0, true), (32_767, true), (32_768, false)] {
                let mut values = [7, -7, 0, 1];
                values[at] = value;
                assert_eq!(within(1 << 15, values), expected, "{values:?}");
            }
        }
    }
}
