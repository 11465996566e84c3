//! An edge of a triangle, stepped from row to row: two vertices come in, and the exact pixel at which spans begin or
//! end goes out, for one addition of 64 bits per row.
//!
//! The first pixel of a span, and the first one after its end, is the first pixel whose centre is not left of the edge:
//! pixel = ⌈(x - 128) / 256⌉, where x is the edge's position, in 1/256 px, at the height of the row's pixel centres. A
//! centre exactly on the edge belongs to the span to its right. This is the top-left rule for edges that are not
//! horizontal.
//!
//! Let dy be the edge's height, and D = 256 dy. The position in pixels, (x - 128) / 256, is a multiple of 1 / D. So a
//! value that is too small by more than 0 and at most 1 / D is as good as the exact one: its ⌊ ⌋ + 1 is the ⌈ ⌉ of the
//! exact one. D is below 2³², and 45 bits after the point leave room for the rounding of one step in each of 4,096
//! rows.

use crate::math::{ShortDivisor, divide_modulo, leading_zeros_long, mul_high_outlined, reciprocal};
use crate::vertex::ScreenVertex;

/// The state of an edge at a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The position plus one pixel, minus an error within the bound of the module's documentation; 45 fractional bits.
    x: i64,
    /// Change of the position per row.
    step: i64,
}

/// Fractional bits of positions.
const FRACTION: u32 = 45;

/// Returns `value` 2^`by`, 0 < `by` < 32, computed in two words.
#[inline(always)]
const fn shift_to_words(value: i32, by: u32) -> i64 {
    // A shift of 64 bits would be a call on small cores.
    ((value >> (32 - by)) as i64) << 32 | ((value as u32) << by) as i64
}

impl Edge {
    /// An edge without rows.
    pub const EMPTY: Self = Self { x: 0, step: 0 };

    /// Makes the edge from `a` down to `b`, at pixel row `row`; `EMPTY` unless `b` is below `a`.
    ///
    /// # Format
    /// Points are in 24.8, at most ±32,767 px. The edge must cross `row`: 0 ≤ p < dy for the row's height p below `a`.
    ///
    /// The usual edge is less than 32 px high and 64 px wide, and dx dy is below 2²⁶. Its step is h 2^(z - 2) with the
    /// z of [`ShortDivisor`], and 1 / D, which is more than 2^(z + 5), is more than 128 units of h. On up to 32 rows, h
    /// is off by less than 0.55 per row and by less than 5 in all, and cut by less than 1 per row; the start is cut by
    /// 1. The sum of these errors is in -56..=23. 48 units are subtracted at the start, which makes the sum -104..=-25.
    #[inline]
    pub fn new(a: &ScreenVertex, b: &ScreenVertex, row: i32) -> Self {
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let p = 256 * row + 128 - a.y;
        let usual = (((dx + (1 << 14)) as u32) < 1 << 15) & (((dy - 1) as u32) < (1 << 13) - 1);
        if !usual || dx.unsigned_abs() * dy as u32 >= 1 << 26 {
            if dy <= 0 {
                return Self::EMPTY;
            }
            if dx.unsigned_abs() >> 17 != 0 || dy >> 19 != 0 {
                return Self::huge(a.x, dx, dy, p);
            }
            return Self::large(a.x, dx, dy, p);
        }
        let divisor = ShortDivisor::new(dy as u32);
        let by = divisor.shift() - 2;
        let h = divisor.divide(dx);
        let step = shift_to_words(h, by);
        let along = if p < 256 {
            // p h / 2⁸ as the sum of two products that fit 32 bits.
            shift_to_words((h >> 8) * p + (((h & 0xFF) * p) >> 8) - 48, by)
        } else {
            ((step * i64::from(p)) >> 8) - shift_to_words(48, by)
        };
        Self { x: Self::start(a.x) + along, step }
    }

    /// Returns a position of 24.8 plus half a pixel: minus half a pixel for the centre that it is compared with, plus
    /// the one pixel that positions are ahead.
    #[inline(always)]
    const fn start(x: i32) -> i64 {
        ((x + 128) as i64) << (FRACTION - 8)
    }

    /// Makes an edge as [`new`](Self::new) does, for larger edges. The quotient has two digits: the second one divides
    /// the remainder that the first one leaves.
    ///
    /// # Format
    /// |dx| < 2¹⁷ and dy < 2¹⁹. dx / dy is h 2^(z - 43), with h below 2²⁹ and off by less than 2. The remainder, in
    /// units of 2^(z - 43), is below 2 dy, so 32 bits hold it although its terms do not fit. The quotient of the
    /// remainder is cut to 2^(2z - 82), or to a unit. (An edge below 8/256 px has one row, for which the first digit is
    /// enough. The second digit of such an edge is not shifted to its place.) 2¹¹ rows lose less than 2¹² units, or
    /// 2^(z - 12) where edges are lower. This is within the half of 1 / D that is subtracted. |p step| is below |dx|
    /// 2⁴⁵.
    #[inline(never)]
    fn large(x: i32, dx: i32, dy: i32, p: i32) -> Self {
        let z = leading_zeros_long(dy as u64) - 32;
        let inverse = reciprocal((dy as u32) << z);
        let h = mul_high_outlined(dx << 12, inverse);
        let rest = (dx << (43 - z)).wrapping_sub(h.wrapping_mul(dy));
        let second = i64::from(mul_high_outlined(rest << 8, inverse)) << 20 >> (57 - 2 * (z as i32)).max(0);
        let step = (i64::from(h) << (z + 2)).wrapping_add(second);
        Self { x: Self::start(x).wrapping_add((step.wrapping_mul(p.into())) >> 8) - (1 << (z + 4)), step }
    }

    /// Makes an edge as [`new`](Self::new) does, for edges of any size, by long division that rounds down.
    ///
    /// # Format
    /// |p dx| < 2⁴⁸. The start and up to 4,095 steps are each too small by less than 1. Together with the 1 that is
    /// subtracted, this is within 1 / D = 2³⁷ / dy, which is more than 2¹³. The step of an edge with two rows, dy > 2⁸,
    /// is below 2⁶²; edges with fewer rows do not take their step.
    #[cold]
    #[inline(never)]
    fn huge(x: i32, dx: i32, dy: i32, p: i32) -> Self {
        // n 2^bits = (n 2^(bits - 32)) 2³²: the 96 bits of the dividend in two parts.
        let quotient =
            |n: i64, bits: u32| divide_modulo(n >> (64 - bits), (n << (bits - 32)) as u32, dy.unsigned_abs().into());
        let step = quotient(dx.into(), FRACTION);
        let along = quotient(i64::from(p) * i64::from(dx), FRACTION - 8);
        Self { x: Self::start(x).wrapping_add(along) - 1, step }
    }

    /// Returns the first pixel whose centre is on the edge or to the right of it.
    #[inline]
    pub const fn pixel(&self) -> i32 {
        (self.x >> FRACTION) as i32
    }

    /// Goes one row down.
    #[inline]
    pub const fn step(&mut self) {
        self.x = self.x.wrapping_add(self.step);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    fn at((x, y): (i32, i32)) -> ScreenVertex {
        ScreenVertex::new(x, y, 0)
    }

    /// Returns ⌈N / D⌉ in exact arithmetic.
    fn exact(a: (i32, i32), b: (i32, i32), row: i32) -> i32 {
        let [ax, ay, bx, by] = [a.0, a.1, b.0, b.1].map(i128::from);
        let (dx, dy) = (bx - ax, by - ay);
        let n = (ax - 128) * dy + (256 * i128::from(row) + 128 - ay) * dx;
        -((-n).div_euclid(256 * dy)) as i32
    }

    /// Edges of any size and any start. Half of them end on pixel centres, where positions are whole pixels.
    #[test]
    fn each_row_begins_at_the_exact_pixel() {
        let mut rng = Rng::new(7);
        let mut next = |low: i32, end: i32| rng.between(low, end - 1);
        let (mut rows, mut usual) = (0, 0);
        for case in 0..150_000 {
            let size = [3, 100, 600, 2000, 8192, 32_768, 200_000, (1 << 23) - 1][next(0, 8) as usize];
            let height = [3, 100, 600, 2000, 8192, 32_768, 200_000, (1 << 23) - 1][next(0, 8) as usize];
            let grid = if next(0, 2) == 0 { 1 } else { 128 };
            let snap = |v: i32| v / grid * grid;
            let far = (1 << 23) - 1;
            let near = next(1, 24);
            let a = (snap(next(-far >> near, far >> near)), snap(next(-far >> near, far >> near)));
            let b = (snap((a.0 + next(-size, size)).clamp(-far, far)), snap((a.1 + next(1, height + 1)).min(far)));
            let (first, end) = ((a.1 + 127) >> 8, (b.1 + 127) >> 8);
            if first >= end {
                continue;
            }
            usual += u32::from(end - first > 1);
            for start in [first, next(first, end)] {
                let mut edge = Edge::new(&at(a), &at(b), start);
                for row in start..end.min(start + 4096) {
                    if row - start < 70 || next(0, 50) == 0 {
                        rows += 1;
                        assert_eq!(edge.pixel(), exact(a, b, row), "case {case}: {a:?} {b:?} row {row} from {start}");
                    }
                    edge.step();
                }
            }
        }
        assert!(usual > 50_000 && rows > 1_000_000, "{usual} edges, {rows} rows");
    }

    /// Tests the steepest and the flattest edges of the short way, which come nearest to its bound.
    #[test]
    fn short_edges_are_exact_at_the_limits() {
        for dy in (1..1 << 13).step_by(7).chain((1 << 13) - 40..1 << 13) {
            let widest = ((1 << 26) / dy - 1).min((1 << 15) - 1);
            for dx in [-widest, 1 - widest, -dy, -1, 0, 1, dy / 3, dy, widest / 2, widest - 1, widest] {
                for ax in [-128, -1, 0, 5, 128] {
                    let (a, b) = ((ax, 100), (ax + dx, 100 + dy));
                    let mut edge = Edge::new(&at(a), &at(b), 0);
                    for row in 0..(b.1 + 127) >> 8 {
                        assert_eq!(edge.pixel(), exact(a, b, row), "{a:?} {b:?} row {row}");
                        edge.step();
                    }
                }
            }
        }
    }
}
