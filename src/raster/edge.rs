//! An edge of a triangle, walked from row to row: exact, with one addition and one comparison a row.
//!
//! The pixel where a span begins, or the one behind its end, is the first whose centre is not left of the edge:
//! pixel = ⌈(x - 128) / 256⌉ with x the edge's position, in 1/256 px, at the height of the row's pixel centres. A centre
//! exactly on the edge belongs to the span to its right, which is the top-left rule for edges that are not horizontal.

use crate::geometry::small;
use crate::math::divided;
use core::hint::black_box;
use core::num::NonZeroU32;

/// The state of an edge at a row.
///
/// With the edge from `a` down to `b`, D = 256 (b.y - a.y), and N / D = (x - 128) / 256 its exact position in pixels at
/// this row, `pixel` = ⌈N / D⌉ and `error` = `pixel` D - N, in 0..D. A row down, N grows by 256 dx = q D + 256 r.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    pixel: i32,
    error: u32,
    /// ⌊dx / dy⌋.
    quotient: i32,
    /// 256 (dx mod dy).
    remainder: u32,
    /// D, at most 2³² - 2⁹.
    denominator: u32,
}

/// `num / den` and the remainder, for quotients below 2³².
#[inline]
pub(super) fn divide(num: u64, den: NonZeroU32) -> (u32, u32) {
    match u32::try_from(num) {
        Ok(num) => divided(num, den),
        Err(_) => long_divide((num >> 32) as u32, num as u32, den),
    }
}

/// The same bit by bit, `high` being below `den`: rare, and no 64-bit division to link.
#[cold]
#[inline(never)]
fn long_divide(high: u32, low: u32, den: NonZeroU32) -> (u32, u32) {
    let (mut rest, mut low) = (high, low);
    for _ in 0..32 {
        // The bit that leaves `rest` at the top makes it larger than any divisor.
        let carry = rest >> 31;
        rest = rest << 1 | low >> 31;
        low <<= 1;
        if carry != 0 || rest >= den.get() {
            rest = rest.wrapping_sub(den.get());
            low |= 1;
        }
    }
    (low, rest)
}

/// `num / den`, rounded down, and the remainder, for small quotients: mostly -1 and 0.
///
/// The compiler takes loops that add or subtract the same once a round for a division, and makes one of them, unless it does
/// not know what they do.
#[inline]
fn few(num: i32, den: i32) -> (i32, i32) {
    let (mut quotient, mut rest) = (0, num);
    while rest < 0 {
        rest = black_box(rest + den);
        quotient -= 1;
    }
    while rest >= den {
        rest = black_box(rest - den);
        quotient += 1;
    }
    (quotient, rest)
}

impl Edge {
    /// An edge with nothing to walk.
    pub const EMPTY: Self = Self { pixel: 0, error: 0, quotient: 0, remainder: 0, denominator: 0 };

    /// The edge from `a` down to `b`, at pixel row `row`; `EMPTY` unless `b` is below `a`.
    ///
    /// # Format
    /// Points (x, y) in 24.8, at most ±32,767 px; `row` is one the edge crosses: 0 ≤ p < dy for its height p below `a`.
    /// dx = q dy + r with 0 ≤ r < dy ≤ 2²⁴, and the position at p is a.x + p q + p r / dy: p q stays within dx ± dy,
    /// p r below 2⁴⁸ (and mostly below 2³²).
    #[inline(never)]
    pub fn new(a: (i32, i32), b: (i32, i32), row: i32) -> Self {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let p = 256 * row + 128 - a.1;
        // The usual edge: short, not flatter than 1 in 4, and begun at its upper end.
        if small(dx) & (dy > 0) & ((dy as u32) < 1 << 15) & ((p as u32) < 256) && dx.abs() <= 4 * dy {
            return Self::walked(a.0, dx, dy, p);
        }
        Self::divided(a, b, row)
    }

    /// [`new`](Self::new) without a division, for quotients of -4..=4.
    ///
    /// # Format
    /// |dx|, dy < 2¹⁵, so D < 2²³; p < 2⁸. N is taken from the pixel of `x`: (-128..128) dy + p dx, below 9/2 D.
    #[inline]
    fn walked(x: i32, dx: i32, dy: i32, p: i32) -> Self {
        let d = dy << 8;
        let (quotient, r) = few(dx, dy);
        let (pixels, error) = few((128 - (x & 0xFF)) * dy - p * dx, d);
        let pixel = (x >> 8) - pixels;
        Self { pixel, error: error as u32, quotient, remainder: (r << 8) as u32, denominator: d as u32 }
    }

    /// [`new`](Self::new) for any edge.
    #[inline(never)]
    fn divided(a: (i32, i32), b: (i32, i32), row: i32) -> Self {
        let dx = b.0 - a.0;
        let Ok(dy) = u32::try_from(b.1 - a.1) else {
            return Self::EMPTY;
        };
        let Some(dy) = NonZeroU32::new(dy) else {
            return Self::EMPTY;
        };
        // Floor division of a signed number: for dx < 0, ⌊dx / dy⌋ = -⌊(-dx - 1) / dy⌋ - 1 = !⌊!dx / dy⌋.
        let sign = dx >> 31;
        let magnitude = (dx ^ sign) as u32;
        let (quotient, rest) = divided(magnitude, dy);
        let quotient = quotient as i32 ^ sign;
        let r = if sign < 0 { dy.get() - 1 - rest } else { rest };

        let p = 256 * row + 128 - a.1;
        let (k, fraction) = divide(u64::from(p as u32) * u64::from(r), dy);
        // N / dy = whole + fraction / dy, all in 1/256 px.
        let whole = a.0 - 128 + p.wrapping_mul(quotient).wrapping_add(k as i32);
        let pixel = (whole + 255 + i32::from(fraction > 0)) >> 8;
        // In 0..D although the terms may wrap: the missing part of a pixel, 0..=256 of 1/256 px, less the fraction.
        let error = dy.get().wrapping_mul((256 * pixel - whole) as u32).wrapping_sub(fraction);
        Self { pixel, error, quotient, remainder: r << 8, denominator: dy.get() << 8 }
    }

    /// The first pixel whose centre is on the edge or to the right of it.
    #[inline]
    pub const fn pixel(&self) -> i32 {
        self.pixel
    }

    /// Goes one row down.
    #[inline]
    pub const fn step(&mut self) {
        self.pixel = self.pixel.wrapping_add(self.quotient);
        let (error, borrow) = self.error.overflowing_sub(self.remainder);
        self.error = error;
        if borrow {
            self.error = error.wrapping_add(self.denominator);
            self.pixel = self.pixel.wrapping_add(1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_division_is_division() {
        let mut state = 9_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state ^ state >> 31
        };
        for _ in 0..20_000 {
            let den = NonZeroU32::new((next() >> (32 + next() % 31)) as u32 | 1).expect("odd");
            let num = (u64::from(den.get()) * (next() >> (32 + next() % 32))) + next() % u64::from(den.get());
            let expected = ((num / u64::from(den.get())) as u32, (num % u64::from(den.get())) as u32);
            assert_eq!(long_divide((num >> 32) as u32, num as u32, den), expected, "{num} / {den}");
        }
    }

    #[test]
    fn walking_and_dividing_give_the_same_edge() {
        let mut state = 7_u32;
        let mut next = |low: i32, high: i32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            low + ((u64::from(state >> 8) * (high - low) as u64) >> 24) as i32
        };
        let mut walked = 0;
        for _ in 0..200_000 {
            let size = [3, 100, 2000, 32_768][next(0, 4) as usize];
            let a = (next(-100_000, 100_000), next(-100_000, 100_000));
            let b = (a.0 + next(-size, size), a.1 + next(1, size));
            let row = (a.1 + 127) >> 8;
            if 256 * row + 128 >= b.1 {
                continue;
            }
            let (dx, dy, p) = (b.0 - a.0, b.1 - a.1, 256 * row + 128 - a.1);
            if dx.abs() <= 4 * dy {
                walked += 1;
                assert_eq!(Edge::walked(a.0, dx, dy, p), Edge::divided(a, b, row), "{a:?} {b:?}");
            }
        }
        assert!(walked > 50_000, "{walked}");
    }
}
