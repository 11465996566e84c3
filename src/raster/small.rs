//! Small triangles: edges and planes in 32 bits.
//!
//! A triangle is small if its vertices are within 60 px of each other in x and within 25 px in y. Nearly all triangles
//! of a mesh are. Positions on its edges are kept in 6.26, relative to the column that the leftmost vertex is in.
//!
//! As for any [`Edge`](super::edge::Edge), a row's first pixel is ⌈X⌉ for X = (x - 128) / 256, a multiple of 1 / D px
//! with D = 256 dy. ⌊X + 1 - δ⌋ is the same for 0 < δ ≤ 1 / D, which is 2¹⁸ / dy units of 2⁻²⁶ px.

use crate::math::{SMALL_CORE, ShortDivisor, leading_zeros, reciprocal};

/// Fractional bits of positions.
const FRACTION: u32 = 26;

/// Largest extent in x, 24.8.
pub(crate) const WIDTH: i32 = 60 << 8;
/// Largest extent in y, 24.8.
pub(crate) const HEIGHT: i32 = 25 << 8;

/// The state of an edge of a small triangle at a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShortEdge {
    /// The position plus one pixel, less δ; modulo 2⁶ px.
    pub(crate) x: u32,
    /// Change of the position per row, modulo 2⁶ px.
    pub(crate) step: u32,
}

impl ShortEdge {
    /// Makes the edge that begins at `x`, relative to the first column, and goes `dx` to the right and `dy` down. `p`
    /// is the height of a row's centres below its beginning.
    ///
    /// # Format
    /// 24.8: 0 ≤ x < 61 · 2⁸, |dx| ≤ 60 · 2⁸, dy ≤ 25 · 2⁸, 0 ≤ p < dy. Without rows, dy ≤ 0, positions are anything.
    ///
    /// Errors in units of 2⁻²⁶ px. H = dy / 2⁸ is the height in pixels, and row k is at p / 2⁸ + k < H. The position is
    /// too small by δ, which has to be in 0 < δ ≤ 2¹⁸ / dy = 2¹⁰ / H.
    ///
    /// | | step is too small by | start | all rows | subtracted | δ | allowed |
    /// |---|---|---|---|---|---|---|
    /// | division | 0..=1 | p / 2⁸ times that, and 0..1 | 0..H + 1 | 1 | 1..27 | 40 |
    /// | reciprocal, 16 ≤ H ≤ 25 | -0.21..=1.21 | as above | -5.3..=32 | 7 | 1.7..39 | 40 |
    /// | reciprocal, 8 ≤ H < 16 | -0.42..=1.42 | as above | -6.8..=24 | 7 | 0.2..31 | 64 |
    /// | reciprocal, 4 ≤ H < 8 | -0.84..=1.84 | as above | -6.8..=16 | 7 | 0.2..23 | 128 |
    /// | reciprocal, H < 4, in units of h | -0.84..=1.84 | as above | -3.4..=8.4 | 7 | 3.6..15.4 | 128 |
    ///
    /// By division: dx 2²⁶ / dy in two digits, q 2⁹ + r, both cut towards zero, |r| < 2⁹, and 1 less if dx < 0. By
    /// reciprocal: h of [`ShortDivisor`] is the quotient in units of 2^(z - 21), rounded down to whole units of 2⁻²⁶ px
    /// where z ≤ 21. p q and dx 2¹⁷ are below 2³¹.
    #[inline(always)]
    pub(crate) fn new(x: i32, dx: i32, dy: i32, p: i32) -> Self {
        if SMALL_CORE { Self::outlined(x, dx, dy, p) } else { Self::inlined(x, dx, dy, p) }
    }

    /// Makes an edge as [`new`](Self::new) does, out of line.
    #[inline(never)]
    pub(crate) fn outlined(x: i32, dx: i32, dy: i32, p: i32) -> Self {
        Self::inlined(x, dx, dy, p)
    }

    #[inline(always)]
    fn inlined(x: i32, dx: i32, dy: i32, p: i32) -> Self {
        if dy <= 0 {
            return Self { x: 0, step: 0 };
        }
        // Plus half a pixel: minus a half for the centre that it is compared with, plus the one that it is ahead.
        let start = ((x + 128) as u32) << (FRACTION - 8);
        if SMALL_CORE { Self::by_reciprocal(start, dx, dy, p) } else { Self::by_division(start, dx, dy, p) }
    }

    #[inline(always)]
    fn by_division(start: u32, dx: i32, dy: i32, p: i32) -> Self {
        let n = dx << 17;
        let q = n.wrapping_div(dy);
        let rest = n.wrapping_sub(q.wrapping_mul(dy));
        let r = (rest << 9).wrapping_div(dy) + (dx >> 31);
        let step = ((q << 9) as u32).wrapping_add(r as u32);
        let along = ((p.wrapping_mul(q) << 1) as u32).wrapping_add((p.wrapping_mul(r) >> 8) as u32);
        Self { x: start.wrapping_add(along).wrapping_sub(1), step }
    }

    #[inline(always)]
    fn by_reciprocal(start: u32, dx: i32, dy: i32, p: i32) -> Self {
        let divisor = ShortDivisor::of_13_bits(dy as u32);
        let (up, mut h) = (divisor.shift() as i32 - 21, divisor.divide(dx));
        // Of 4 px and more, no unit is finer than 2⁻²⁶ px. (The masks tell the compiler that shifts are in range.)
        h >>= (-up).max(0) & 3;
        let along = (h >> 8).wrapping_mul(p).wrapping_add(((h & 0xFF) * p) >> 8).wrapping_sub(7);
        let up = up.max(0) & 15;
        Self { x: start.wrapping_add((along << up) as u32), step: (h << up) as u32 }
    }

    /// Returns the column of the first pixel whose centre is on the edge or to the right of it.
    #[inline(always)]
    pub(crate) const fn column(&self) -> u32 {
        self.x >> FRACTION
    }

    /// Moves the edge to a column, if it is to the right of it: for a single row.
    #[inline(always)]
    pub(crate) const fn limit(&mut self, column: u32) {
        if self.column() > column {
            self.x = column << FRACTION;
        }
    }

    /// Returns the edge a number of rows further down.
    #[inline(always)]
    pub(crate) const fn below(self, rows: u32) -> Self {
        Self { x: self.x.wrapping_add(self.step.wrapping_mul(rows)), step: self.step }
    }

    /// Goes one row down.
    #[inline(always)]
    pub(crate) const fn step(&mut self) {
        self.x = self.x.wrapping_add(self.step);
    }
}

/// The part of plane equations that all values on a small triangle share.
///
/// Its corners a, b, c go round against the clock on the screen, with y up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShortPlanes {
    /// b - a and c - a, 24.8.
    pub(crate) b: (i32, i32),
    pub(crate) c: (i32, i32),
    /// The centre of the pixel that planes begin at, relative to a: in the row and the column that are drawn first.
    pub(crate) to: (i32, i32),
    /// 2⁶³ / (area << shift). The shift puts the top bit of the area, which is twice the triangle's, into bit 31.
    pub(crate) reciprocal: u32,
    pub(crate) shift: u32,
}

impl ShortPlanes {
    /// Returns the reciprocal of an area that is not 0, and the shift that normalizes it.
    #[inline(always)]
    pub(crate) fn inverse(area: u32) -> (u32, u32) {
        let shift = leading_zeros(area) & 31;
        (reciprocal(area << shift), shift)
    }

    /// Returns the numerators of the gradients of a value that is larger by `b` and `c` at these corners. The gradients
    /// are 256 times these by the area.
    #[inline(always)]
    pub(crate) fn numerators(&self, b: i32, c: i32) -> (i32, i32) {
        let minor = |p: i32, q: i32| c.wrapping_mul(p).wrapping_sub(b.wrapping_mul(q));
        (minor(self.b.1, self.c.1), minor(self.b.0, self.c.0).wrapping_neg())
    }

    /// Returns the change from the first corner to the first pixel of a plane with these gradients below 2²⁸, modulo
    /// 2³². It is too small by less than 128 units.
    #[inline(always)]
    pub(crate) fn offset(&self, dx: i32, dy: i32) -> i32 {
        let (x, y) = self.to;
        let part = ((dx >> 6) * (x & 0xFF) + (dy >> 6) * (y & 0xFF)) >> 2;
        dx.wrapping_mul(x >> 8).wrapping_add(dy.wrapping_mul(y >> 8)).wrapping_add(part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    /// Checks 0 < δ ≤ 2¹⁸ / dy in exact arithmetic, at the rows of an edge from a height `first` on. The error is
    /// linear from row to row, so the first and the last row have the extremes.
    fn check(x: i32, dx: i32, dy: i32, first: i32) {
        let start = ((x + 128) as u32) << (FRACTION - 8);
        let last = (dy - 1 - first) / 256;
        for edge in [ShortEdge::by_division(start, dx, dy, first), ShortEdge::by_reciprocal(start, dx, dy, first)] {
            for row in [0, last] {
                let p = i128::from(first + 256 * row);
                // One pixel more than the position of the row's centres, times dy.
                let exact = (i128::from(x + 128) * i128::from(dy) + p * i128::from(dx)) << (FRACTION - 8);
                let at = edge.x.wrapping_add(edge.step.wrapping_mul(row as u32));
                let error = exact - i128::from(at) * i128::from(dy);
                // Positions are modulo 2⁶ px: within the triangle's columns, they are never off by as much.
                let error = (error + (i128::from(dy) << 31)).rem_euclid(i128::from(dy) << 32) - (i128::from(dy) << 31);
                assert!(0 < error && error <= 1 << 18, "{x} {dx} / {dy} at {first}, row {row}: {error}");
                // ⌈X⌉ = -⌊-X⌋.
                let n = i128::from(x - 128) * i128::from(dy) + p * i128::from(dx);
                let pixel = -(-n).div_euclid(256 * i128::from(dy));
                assert_eq!(i128::from(at >> FRACTION), pixel, "{x} {dx} / {dy} at {first}, row {row}");
            }
        }
    }

    /// Every height, with widths and starts of all kinds: whole multiples and their neighbours, half pixels, random
    /// ones.
    #[test]
    fn short_edges_are_exact_for_every_height() {
        let mut rng = Rng::new(7);
        for dy in 1..=HEIGHT {
            for case in 0..40 {
                let dx = match case % 5 {
                    0 => rng.between(-2, 2) * dy + rng.between(-2, 2),
                    1 => rng.between(-60, 60) * 128,
                    2 => rng.between(-dy, dy),
                    3 => [-WIDTH, WIDTH][case & 1],
                    _ => rng.between(-WIDTH, WIDTH),
                };
                let dx = dx.clamp(-WIDTH, WIDTH);
                let (low, high) = (0.max(-dx), (WIDTH + 255).min(WIDTH + 255 - dx));
                let x = rng.between(low, high) & if case % 3 == 0 { !127 } else { !0 };
                let first = [0, rng.between(0, dy - 1), rng.between(0, (dy - 1).min(255))][case % 3];
                check(x.max(low), dx, dy, first);
            }
        }
    }

    /// Every height and every width: 196 million edges. In a release build, this takes some seconds.
    #[test]
    #[ignore = "takes minutes without optimization"]
    fn short_edges_are_exact_for_every_height_and_width() {
        for dy in 1..=HEIGHT {
            for dx in -WIDTH..=WIDTH {
                let x = if dx < 0 { -dx } else { 0 };
                check(x, dx, dy, 0);
                check(x + 128, dx, dy, (dy - 1).min(255));
            }
        }
    }
}
