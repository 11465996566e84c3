//! Plane equations: how depth and varyings change from pixel to pixel.
//!
//! A quantity that is v0, v1, v2 at the vertices is a plane over the screen. By Cramer's rule
//!
//! ```text
//! dv/dx = ((v1 - v0) (y2 - y0) - (v2 - v0) (y1 - y0)) / area        area = (x1 - x0) (y2 - y0) - (x2 - x0) (y1 - y0)
//! dv/dy = ((v2 - v0) (x1 - x0) - (v1 - v0) (x2 - x0)) / area
//! ```
//!
//! All values are kept modulo 2³². Inside the triangle the true value fits, and sums and integer multiples of the
//! gradients are exact modulo 2³², so it does not matter that a gradient, or the plane outside of the triangle, does not.
//! What is off is only the rounding of the gradients, 2⁻¹⁶ a pixel in 16.16: below 2⁻³ over the largest viewport.

use crate::geometry::{ScreenVertex, WidePlane, small};
use crate::math::{leading_zeros, mul_high_signed};

/// What all plane equations of a triangle share.
#[derive(Clone, Copy, Debug)]
pub struct Gradients {
    /// Vertices 1 and 2 as seen from vertex 0.
    x: [i32; 2],
    y: [i32; 2],
    /// The centre of the pixel at the origin as seen from vertex 0.
    to: (i32, i32),
    /// Twice the signed area; never 0.
    area: i64,
    /// Whether x and y are within -2¹⁵..2¹⁵.
    is_small: bool,
    /// 2⁶³ / (|area| << shift), and shift, which puts the top bit of |area| into bit 31; 0 for triangles of more than
    /// 512 px.
    reciprocal: u32,
    shift: i32,
    /// The pixel at which planes are evaluated: the one that holds vertex 0, for large triangles brought onto the screen.
    origin: (i32, i32),
}

/// A plane: values at pixel centres, modulo 2³².
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlaneEquation {
    /// Change from one pixel to the next on the right.
    pub dx: i32,
    /// Change from one row to the next.
    pub dy: i32,
    /// Value at the centre of the screen's first pixel: at pixel (x, y) it is `base + dx x + dy y`.
    pub base: u32,
}

impl Gradients {
    /// Of a triangle with its [`signed_area`](crate::geometry::signed_area), which must not be 0, for a screen of
    /// `width` × `height` px.
    #[inline]
    pub fn new(v: &[ScreenVertex; 3], area: i64, (width, height): (u16, u16)) -> Self {
        let x = [v[1].x - v[0].x, v[2].x - v[0].x];
        let y = [v[1].y - v[0].y, v[2].y - v[0].y];
        let mut origin = (v[0].x >> 8, v[0].y >> 8);
        let (mut reciprocal, mut shift) = (0, 0);
        let is_small = small(x[0]) & small(x[1]) & small(y[0]) & small(y[1]);
        if is_small {
            let magnitude = (area as i32).unsigned_abs();
            shift = leading_zeros(magnitude) as i32;
            reciprocal = crate::math::reciprocal(magnitude << shift);
        } else if medium(x[0]) & medium(x[1]) & medium(y[0]) & medium(y[1]) {
            // Areas up to 2³⁵, of which the upper 32 bits count: 2⁻³¹ is lost.
            let magnitude = area.unsigned_abs();
            let zeros = magnitude.leading_zeros();
            shift = zeros as i32 - 32;
            reciprocal = crate::math::reciprocal(((magnitude << zeros) >> 32) as u32);
        } else {
            // `clamp` would panic on an empty screen.
            origin = (origin.0.min(i32::from(width) - 1).max(0), origin.1.min(i32::from(height) - 1).max(0));
        }
        let to = (256 * origin.0 + 128 - v[0].x, 256 * origin.1 + 128 - v[0].y);
        Self { x, y, to, area, is_small, reciprocal, shift, origin }
    }

    /// The plane through the values at the three vertices times 2^`scale`, modulo 2³²; usually 16.16.
    ///
    /// # Format
    /// Any values, `scale` up to 16. Evaluated at a pixel inside the triangle and on the screen, the result is within 2¹³ of
    /// the exact plane: 2⁻³ of a unit in 16.16.
    #[inline(never)]
    pub fn plane(&self, values: [i32; 3], scale: u32) -> PlaneEquation {
        let plane = self.plane_at_origin(values, scale);
        let along = plane.dx.wrapping_mul(self.origin.0).wrapping_add(plane.dy.wrapping_mul(self.origin.1));
        PlaneEquation { base: plane.base.wrapping_sub(along as u32), ..plane }
    }

    /// The same, with its base at the origin.
    #[inline]
    fn plane_at_origin(&self, values: [i32; 3], scale: u32) -> PlaneEquation {
        let (v1, v2) = (values[1].wrapping_sub(values[0]), values[2].wrapping_sub(values[0]));
        let base = (values[0] as u32) << scale;
        if v1 | v2 == 0 {
            return PlaneEquation { dx: 0, dy: 0, base };
        }
        // Small differences on a small triangle, the usual case, take 32 bits: 2¹⁴ · 2¹⁵ · 2.
        let up = self.shift + scale as i32 - 23;
        if self.is_small && up <= 4 && moderate(v1) & moderate(v2) {
            let a = v1 * self.y[1] - v2 * self.y[0];
            let b = v2 * self.x[0] - v1 * self.x[1];
            let (a, b) = if self.area < 0 { (-a, -b) } else { (a, b) };
            let (dx, dy) = (mul_high_signed(a, self.reciprocal), mul_high_signed(b, self.reciprocal));
            // 256 2^scale n / area = 2^(shift + 8 + scale) n reciprocal / 2⁶³ = 2^up high; a unit of `high` is at most
            // 2⁴ / 2¹⁶, and 2⁻⁴ over the 128 px of a small triangle in both directions.
            let limit = 1 << (29 - up.max(0));
            if dx.abs() < limit && dy.abs() < limit {
                let (dx, dy) = if up >= 0 { (dx << up, dy << up) } else { (dx >> -up, dy >> -up) };
                return self.near(base, dx, dy);
            }
        }
        self.long(values, scale)
    }

    /// The plane by its gradients, which are below 2²⁹, at a pixel at most half a pixel from vertex 0.
    ///
    /// # Format
    /// 2²⁹⁻⁶ · 2⁷ twice: below 2³¹. The cut bits are 2⁻¹¹ of a unit in 16.16.
    #[inline]
    fn near(&self, base: u32, dx: i32, dy: i32) -> PlaneEquation {
        let offset = ((dx >> 6) * self.to.0 + (dy >> 6) * self.to.1) >> 2;
        PlaneEquation { dx, dy, base: base.wrapping_add(offset as u32) }
    }

    /// [`plane`](Self::plane) for any triangle and any values, in 64 bits.
    ///
    /// # Format
    /// Differences of 33 bits times 2²⁵, below 2⁵⁸; in sums below 2⁵⁹.
    #[inline(never)]
    fn long(&self, values: [i32; 3], scale: u32) -> PlaneEquation {
        let [v0, v1, v2] = values.map(i64::from);
        let (v1, v2) = (v1 - v0, v2 - v0);
        let [x1, x2] = self.x.map(i64::from);
        let [y1, y2] = self.y.map(i64::from);
        let (a, b) = (v1 * y2 - v2 * y1, v2 * x1 - v1 * x2);
        let base = (values[0] as u32) << scale;
        if self.reciprocal != 0 {
            if let (Some(dx), Some(dy)) = (self.gentle(a, scale), self.gentle(b, scale)) {
                return self.near(base, dx, dy);
            }
        }
        self.exact(base, a, b, scale)
    }

    /// 256 2^scale n / area, if it is below 2²⁹ (2¹³ in 16.16), which loses little enough to the reciprocal: relative
    /// error below 2⁻²⁸, so less than 2⁻⁵ of a unit over 512 px in both directions, and one unit of 2⁻¹⁶ a pixel.
    ///
    /// 256 / area = 2^shift reciprocal / 2⁵⁵; n is normalized to n 2^up in 2³⁰..2³¹, or cut to that (by less than
    /// 2⁻³⁰).
    fn gentle(&self, n: i64, scale: u32) -> Option<i32> {
        let n = if self.area < 0 { -n } else { n };
        // Redundant sign bits above bit 31: how far n can move up (or must move down) to fill an i32.
        let up = (n ^ (n >> 63)).leading_zeros() as i32 - 33;
        let normalized = if up >= 0 { n << up } else { n >> -up } as i32;
        let high = mul_high_signed(normalized, self.reciprocal);
        // high 2³² 2^(shift + scale - up) / 2⁵⁵.
        let down = 23 + up - self.shift - scale as i32;
        if down < 2 { None } else { Some(high >> down.min(31)) }
    }

    /// The same by exact division, for triangles that are larger or steep: rounded down, modulo 2³².
    #[inline(never)]
    fn exact(&self, base: u32, a: i64, b: i64, scale: u32) -> PlaneEquation {
        let area = self.area.unsigned_abs();
        let divided = |n: Wide, bits: u32| divide_modulo(if self.area < 0 { n.negated() } else { n }, area, bits);
        PlaneEquation {
            dx: divided(Wide::product(a, 1), 8 + scale) as i32,
            dy: divided(Wide::product(b, 1), 8 + scale) as i32,
            base: base.wrapping_add(divided(Wide::product(a, self.to.0).plus(Wide::product(b, self.to.1)), scale)),
        }
    }
}

impl Gradients {
    /// The plane through the values at the three vertices with 32 fractional bits, modulo 2⁶⁴, by long division; each of its
    /// three numbers is rounded down.
    #[inline(never)]
    pub fn plane_wide(&self, values: [i32; 3]) -> WidePlane {
        let [v0, v1, v2] = values.map(i64::from);
        let (v1, v2) = (v1 - v0, v2 - v0);
        let [x1, x2] = self.x.map(i64::from);
        let [y1, y2] = self.y.map(i64::from);
        let (a, b) = (v1 * y2 - v2 * y1, v2 * x1 - v1 * x2);
        let area = self.area.unsigned_abs();
        let divided = |n: Wide, bits: u32| {
            let n = if self.area < 0 { n.negated() } else { n };
            i64::from(divide_modulo(n, area, bits)) << 32 | i64::from(divide_modulo(n, area, bits + 32))
        };
        let (dx, dy) = (divided(Wide::product(a, 1), 8), divided(Wide::product(b, 1), 8));
        let base = (v0 << 32).wrapping_add(divided(Wide::product(a, self.to.0).plus(Wide::product(b, self.to.1)), 0));
        let (ox, oy) = (i64::from(self.origin.0), i64::from(self.origin.1));
        WidePlane { base: base.wrapping_sub(dx.wrapping_mul(ox)).wrapping_sub(dy.wrapping_mul(oy)), dx, dy }
    }
}

/// Whether a difference of coordinates is within -2¹⁷..2¹⁷: 512 px.
#[inline]
fn medium(difference: i32) -> bool {
    (difference + (1 << 17)) as u32 >> 18 == 0
}

/// Whether a difference of values is within -2¹⁴..2¹⁴.
#[inline]
fn moderate(difference: i32) -> bool {
    (difference.wrapping_add(1 << 14)) as u32 >> 15 == 0
}

/// A signed number of 96 bits: `high` 2³² + `low`.
#[derive(Clone, Copy)]
struct Wide {
    high: i64,
    low: u32,
}

impl Wide {
    /// |a| < 2⁶⁰, |b| < 2²⁶.
    fn product(a: i64, b: i32) -> Self {
        let low = i64::from(a as u32) * i64::from(b);
        Self { high: (a >> 32) * i64::from(b) + (low >> 32), low: low as u32 }
    }

    fn plus(self, other: Self) -> Self {
        let (low, carry) = self.low.overflowing_add(other.low);
        Self { high: self.high + other.high + i64::from(carry), low }
    }

    /// -n = !n + 1.
    fn negated(self) -> Self {
        let (low, carry) = (!self.low).overflowing_add(1);
        Self { high: !self.high + i64::from(carry), low }
    }
}

/// ⌊n 2^bits / den⌋ modulo 2³², 0 < den < 2⁵¹, `bits` up to 64.
///
/// Long division, bit by bit: it is rare, and wider divisions are code that small programs need not link.
#[inline(never)]
fn divide_modulo(n: Wide, den: u64, bits: u32) -> u32 {
    // ⌊-n / d⌋ = !⌊(n - 1) / d⌋, and !n = -n - 1 in all bits, those still to come included.
    let flip = (n.high >> 63) as u32;
    let words = [(n.high >> 32) as u32 ^ flip, n.high as u32 ^ flip, n.low ^ flip, flip, flip];
    let mut rest = 0_u64;
    let mut quotient = 0_u32;
    for (mut word, bits) in words.into_iter().zip([32, 32, 32, bits.min(32), bits.saturating_sub(32)]) {
        if word == 0 && rest == 0 && quotient == 0 {
            continue;
        }
        for _ in 0..bits {
            rest = rest << 1 | u64::from(word >> 31);
            word <<= 1;
            quotient <<= 1;
            if rest >= den {
                rest -= den;
                quotient |= 1;
            }
        }
    }
    quotient ^ flip
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_division_is_exact_modulo_2_to_32() {
        let mut state = 5_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state ^ state >> 29
        };
        for case in 0..20_000 {
            let (a, b) = (next() as i64 >> (4 + next() % 58), (next() as i64 >> (38 + next() % 24)) as i32);
            let (c, d) = (next() as i64 >> (4 + next() % 58), (next() as i64 >> (38 + next() % 24)) as i32);
            let den = (next() >> (13 + next() % 50)).max(1);
            let bits = (next() % 45) as u32;
            let exact = i128::from(a) * i128::from(b) + i128::from(c) * i128::from(d);
            let n = Wide::product(a, b).plus(Wide::product(c, d));
            let expected = (exact << bits).div_euclid(i128::from(den)) as u32;
            assert_eq!(divide_modulo(n, den, bits), expected, "case {case}: {exact} << {bits} / {den}");
            let expected = (-exact << bits).div_euclid(i128::from(den)) as u32;
            assert_eq!(divide_modulo(n.negated(), den, bits), expected, "case {case}: -{exact} << {bits} / {den}");
        }
    }
}
