//! Small triangles: edges and planes in 32 bits.
//!
//! A triangle is small if its vertices are within 60 px of each other in x and within 25 px in y. Nearly all triangles
//! of a mesh are. Tall triangles, within 60 px in both and within 85 px in the sum of both, are small for some shaders.
//! Positions on edges are kept in 6.26, relative to the column that the leftmost vertex is in.
//!
//! As for any [`Edge`](super::edge::Edge), a row's first pixel is ⌈X⌉ for X = (x - 128) / 256, a multiple of 1 / D px
//! with D = 256 dy. ⌊X + 1 - δ⌋ is the same for 0 < δ ≤ 1 / D, which is 2¹⁸ / dy units of 2⁻²⁶ px.

use crate::math::{SMALL_CORE, ShortDivisor, divided, leading_zeros, reciprocal};
use core::num::NonZeroU32;

/// Fractional bits of positions.
const FRACTION: u32 = 26;

/// Largest extent in x, 24.8.
pub(crate) const WIDTH: i32 = 60 << 8;
/// Largest extent in y, 24.8, unless the triangle is tall.
pub(crate) const HEIGHT: i32 = 25 << 8;
/// Largest extent in y of a tall triangle, 24.8.
pub(crate) const TALL: i32 = 60 << 8;
/// Largest sum of both extents, 24.8: planes of a tall triangle are off by no more than those of other small ones.
pub(crate) const SUM: i32 = WIDTH + HEIGHT;
/// Most rows of a tall triangle that its edges are stepped over.
const TALL_ROWS: i32 = 16;

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

    /// Makes an edge of a tall triangle, as [`new`](Self::new) does.
    ///
    /// # Format
    /// 0 < dy ≤ 60 · 2⁸. With M = (x + 128) dy + p dx, which is 2⁸ dy times the position, 0 < M < 2²⁸, the start is
    /// ⌈M 2¹⁸ / dy⌉ - 1, and the step ⌊dx 2²⁶ / dy⌋. So 0 < δ ≤ 1 at first, and δ grows by less than 1 a row, while
    /// 2¹⁰ / H ≥ 17 is allowed: 16 rows are exact.
    #[inline(never)]
    fn tall(x: i32, dx: i32, dy: i32, p: i32) -> Self {
        let Some(den) = u32::try_from(dy).ok().and_then(NonZeroU32::new) else { return Self { x: 0, step: 0 } };
        // Digits of 18 bits, and of 17 and 9 bits: rests are below 2¹⁴.
        let (high, rest) = divided(((x + 128) * dy + p * dx) as u32, den);
        let (low, rest) = divided(rest << (FRACTION - 8), den);
        let start = (high << (FRACTION - 8)).wrapping_add(low).wrapping_sub((rest == 0).into());
        let (high, rest) = divided(dx.unsigned_abs() << 17, den);
        let (low, rest) = divided(rest << 9, den);
        let step = (high << 9).wrapping_add(low);
        // ⌊-n⌋ = -⌈n⌉
        let step = if dx < 0 { step.wrapping_add((rest != 0).into()).wrapping_neg() } else { step };
        Self { x: start, step }
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
        ShortSlope::by_division(dx, dy).by_division_from(start, p)
    }

    #[inline(always)]
    fn by_reciprocal(start: u32, dx: i32, dy: i32, p: i32) -> Self {
        ShortSlope::by_reciprocal(dx, dy).by_reciprocal_from(start, p)
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

/// The direction of an edge, which parallel edges share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShortSlope {
    /// The first digit of the quotient, and the second one; or a quotient, and its shift to the left.
    parts: (i32, i32),
}

impl ShortSlope {
    /// Makes the direction of edges that go `dx` to the right and `dy` down. Without rows, dy ≤ 0, it is anything.
    #[inline(never)]
    pub(crate) fn new(dx: i32, dy: i32) -> Self {
        match (dy > 0, SMALL_CORE) {
            (false, _) => Self { parts: (0, 0) },
            (true, true) => Self::by_reciprocal(dx, dy),
            (true, false) => Self::by_division(dx, dy),
        }
    }

    /// Returns the edge that begins at `x`, as [`ShortEdge::new`] does. It may be asked for at rows above its
    /// beginning, for which `p` is negative; it is exact from its beginning on.
    ///
    /// # Format
    /// p ≥ -2 · 2⁸. The start is cut by less than a unit, as below the beginning, and the error of a step is subtracted
    /// there as it is added below: at the beginning and from there on, δ is what the table of [`ShortEdge::new`] says.
    #[inline(always)]
    pub(crate) fn edge(self, x: i32, p: i32) -> ShortEdge {
        let start = ((x + 128) as u32) << (FRACTION - 8);
        if SMALL_CORE { self.by_reciprocal_from(start, p) } else { self.by_division_from(start, p) }
    }

    #[inline(always)]
    fn by_division(dx: i32, dy: i32) -> Self {
        let n = dx << 17;
        let q = n.wrapping_div(dy);
        let rest = n.wrapping_sub(q.wrapping_mul(dy));
        Self { parts: (q, (rest << 9).wrapping_div(dy) + (dx >> 31)) }
    }

    #[inline(always)]
    fn by_division_from(self, start: u32, p: i32) -> ShortEdge {
        let (q, r) = self.parts;
        let step = ((q << 9) as u32).wrapping_add(r as u32);
        let along = ((p.wrapping_mul(q) << 1) as u32).wrapping_add((p.wrapping_mul(r) >> 8) as u32);
        ShortEdge { x: start.wrapping_add(along).wrapping_sub(1), step }
    }

    #[inline(always)]
    fn by_reciprocal(dx: i32, dy: i32) -> Self {
        let divisor = ShortDivisor::of_13_bits(dy as u32);
        let (up, mut h) = (divisor.shift() as i32 - 21, divisor.divide(dx));
        // Of 4 px and more, no unit is finer than 2⁻²⁶ px. (The masks tell the compiler that shifts are in range.)
        h >>= (-up).max(0) & 3;
        Self { parts: (h, up.max(0) & 15) }
    }

    #[inline(always)]
    fn by_reciprocal_from(self, start: u32, p: i32) -> ShortEdge {
        let (h, up) = self.parts;
        let along = (h >> 8).wrapping_mul(p).wrapping_add(((h & 0xFF) * p) >> 8).wrapping_sub(7);
        ShortEdge { x: start.wrapping_add((along << up) as u32), step: (h << up) as u32 }
    }
}

/// Returns where the edge on the left or on the right of a triangle begins at a height `p` below its highest corner,
/// which is at `x`: there, or at the bend. The other corners are relative to it, with that on the left first, all in
/// 24.8. The results are x, dx, dy and p as [`ShortEdge::new`] takes them.
#[inline(always)]
fn begin([bx, by, cx, cy]: [i32; 4], x: i32, p: i32, is_right: bool) -> (i32, i32, i32, i32) {
    let ((ax, ay), (bx, by)) = if is_right { ((cx, cy), (bx, by)) } else { ((bx, by), (cx, cy)) };
    if p < ay { (x, ax, ay, p) } else { (x + ax, bx - ax, by - ay, p - ay) }
}

/// Returns the edge on the left or on the right of a triangle that is not tall, at a height `p` below its highest
/// corner, as [`begin`] has it. Edges are exact, wherever they begin.
#[inline(never)]
pub(crate) fn edge_at(sides: [i32; 4], x: i32, p: i32, is_right: bool) -> ShortEdge {
    let (x, dx, dy, p) = begin(sides, x, p, is_right);
    ShortEdge::outlined(x, dx, dy, p)
}

/// Returns both edges of a tall triangle, as [`edge_at`] does, and for how many of the next `rows` rows they are exact.
/// At most 16 rows are, so edges are made anew after them and at the bend.
#[inline(never)]
pub(crate) fn tall_edges(sides: [i32; 4], x: i32, p: i32, rows: i32) -> ([ShortEdge; 2], i32) {
    let [_, by, _, cy] = sides;
    let bend = (by.min(cy) - p + 255) >> 8;
    let count = if bend > 0 { rows.min(bend) } else { rows };
    let edge = |is_right| {
        let (x, dx, dy, p) = begin(sides, x, p, is_right);
        ShortEdge::tall(x, dx, dy, p)
    };
    ([edge(false), edge(true)], count.min(TALL_ROWS))
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
                check_row(edge.below(row as u32), x, dx, dy, first + 256 * row);
            }
        }
    }

    /// Checks an edge that is made up to two rows above its beginning, from its first row on.
    fn check_from_above(x: i32, dx: i32, dy: i32, first: i32) {
        let start = ((x + 128) as u32) << (FRACTION - 8);
        for rows in 1..=2 {
            let above = first - 256 * rows;
            let divided = ShortSlope::by_division(dx, dy).by_division_from(start, above);
            let multiplied = ShortSlope::by_reciprocal(dx, dy).by_reciprocal_from(start, above);
            for edge in [divided, multiplied] {
                for row in [0, (dy - 1 - first) / 256] {
                    check_row(edge.below((rows + row) as u32), x, dx, dy, first + 256 * row);
                }
            }
        }
    }

    /// Checks 0 < δ ≤ 2¹⁸ / dy of an edge at a row `p` below its beginning, and its pixel.
    fn check_row(edge: ShortEdge, x: i32, dx: i32, dy: i32, p: i32) {
        let (dy, p, dx) = (i128::from(dy), i128::from(p), i128::from(dx));
        // One pixel more than the position of the row's centres, times dy.
        let exact = (i128::from(x + 128) * dy + p * dx) << (FRACTION - 8);
        let error = exact - i128::from(edge.x) * dy;
        // Positions are modulo 2⁶ px: within the triangle's columns, they are never off by as much.
        let error = (error + (dy << 31)).rem_euclid(dy << 32) - (dy << 31);
        assert!(0 < error && error <= 1 << 18, "{x} {dx} / {dy}, at {p}: {error}");
        // ⌈X⌉ = -⌊-X⌋.
        let pixel = -(-(i128::from(x - 128) * dy + p * dx)).div_euclid(256 * dy);
        assert_eq!(i128::from(edge.column()), pixel, "{x} {dx} / {dy}, at {p}");
    }

    /// Checks all rows of a triangle with these sides, from each of some rows on, in exact arithmetic.
    fn check_triangle(sides: [i32; 4], x: i32, first: i32) {
        let [bx, by, cx, cy] = sides;
        let rows = (by.max(cy) - first + 255) >> 8;
        let mut done = 0;
        while done < rows {
            let (edges, count) = tall_edges(sides, x, first + 256 * done, rows - done);
            assert!(count > 0 && count <= rows - done);
            for row in 0..count {
                let p = first + 256 * (done + row);
                for (edge, (ax, ay), (bx, by)) in [(edges[0], (bx, by), (cx, cy)), (edges[1], (cx, cy), (bx, by))] {
                    let (x, dx, dy, p) = if p < ay { (x, ax, ay, p) } else { (x + ax, bx - ax, by - ay, p - ay) };
                    check_row(edge.below(row as u32), x, dx, dy, p);
                }
            }
            done += count;
        }
    }

    #[test]
    fn edges_of_tall_triangles_are_exact() {
        let seed = 8;
        let mut rng = Rng::new(seed);
        for case in 0..200_000 {
            let grid = [1, 128, 256][case % 3];
            let tall = rng.between(HEIGHT + 1, TALL) / grid * grid;
            let other = rng.between(0, tall) / grid * grid;
            let wide = WIDTH.min(SUM - tall);
            // Both corners, so that the three are within the width.
            let left = rng.between(-wide, wide);
            let right = rng.between(left.max(0), wide.min(wide + left)).max(left) / grid * grid;
            let left = left / grid * grid;
            let x = (-left).max(0) + rng.between(0, 255) / grid * grid;
            let sides = if case % 2 == 0 { [left, tall, right, other] } else { [left, other, right, tall] };
            let first = if case % 7 == 0 { rng.between(0, tall - 1) } else { rng.between(0, 255) };
            check_triangle(sides, x, first);
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
                if first < 256 {
                    check_from_above(x.max(low), dx, dy, first);
                }
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
