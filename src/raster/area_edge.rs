//! Edges of areas: lines of an outline come in, anywhere, and the edges that a band of rows needs go out, each with its
//! places at the upper and the lower border of its row.
//!
//! Positions are 16.16 px here, so that the flattened curves of shapes lose nothing. Lines are cut at ±16,383 px, where
//! no screen reaches. What lies to the right of the columns that are drawn is left out.

use crate::math::{leading_zeros, mul_high, mul_high_signed, reciprocal};
use bytemuck::{Pod, Zeroable};
use core::ops::Range;

/// Rows that an edge is stepped over. A higher one is cut at rows that are multiples of this, from its own ends. So the
/// error of its step, 2⁻¹⁷ px, stays below 2⁻¹⁰ px, and an edge is the same in every strip.
const TALL: i32 = 128 << 16;

/// Width of a part of an edge that is taken for upright, 1/128 px. Its area is off by less than 1/1,000 px then.
const UPRIGHT: i32 = 1 << 9;

/// Largest coordinate, in 16.16 px.
const GUARD: i32 = 16_383 << 16;

/// An edge, from its upper to its lower end, in 16.16 px.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct AreaEdge {
    /// Heights of both ends.
    pub(super) top: i32,
    pub(super) bottom: i32,
    /// Place at the upper border of the current row, or at the upper end if that is in the row.
    pub(super) x: i32,
    /// Place at the lower border of the current row.
    next: i32,
    /// Place at the lower end.
    pub(super) last: i32,
    /// Change of the place from row to row.
    slope: i32,
    /// Change of height per column, without its sign: 0.32 if it is below 1, otherwise 16.16.
    pub(super) rise: u32,
    /// Change of the winding number from the left of the edge to its right, times 2; and 1 if the rise is below 1.
    turn: i32,
    /// Places at both ends of a slab, or the leftmost and the rightmost one in the row, see `area_row`.
    pub(super) low: i32,
    pub(super) high: i32,
}

/// Words of an edge.
pub(super) const EDGE_WORDS: usize = size_of::<AreaEdge>() / 4;

/// Part of an edge that is in one row: heights below the row's upper border, 0..=65,536, and the places there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) start: i32,
    pub(super) end: i32,
    pub(super) from: i32,
    pub(super) to: i32,
}

impl AreaEdge {
    /// An edge without a height.
    pub(super) const NONE: Self =
        Self { top: 0, bottom: 0, x: 0, next: 0, last: 0, slope: 0, rise: 0, turn: 0, low: 0, high: 0 };

    /// Returns the change of the winding number.
    #[inline(always)]
    pub(super) const fn winding(&self) -> i32 {
        self.turn >> 1
    }

    /// Returns whether the rise is 0.32.
    #[inline(always)]
    pub(super) const fn is_flat(&self) -> bool {
        self.turn & 1 != 0
    }

    /// Returns the part in the row whose upper border is at `row`.
    #[inline(always)]
    pub(super) fn piece(&self, row: i32) -> Piece {
        let (end, to) =
            if self.bottom - row <= 1 << 16 { (self.bottom - row, self.last) } else { (1 << 16, self.next) };
        Piece { start: (self.top - row).max(0), end, from: self.x, to }
    }

    /// Moves on to the next row.
    #[inline(always)]
    pub(super) const fn step(&mut self) {
        self.x = self.next;
        self.next = self.next.wrapping_add(self.slope);
    }
}

impl Piece {
    /// Returns the leftmost place.
    #[inline(always)]
    pub(super) fn left(&self) -> i32 {
        self.from.min(self.to)
    }

    /// Returns the rightmost place.
    #[inline(always)]
    pub(super) fn right(&self) -> i32 {
        self.from.max(self.to)
    }

    /// Returns the place at a height between both ends.
    pub(super) fn at(&self, height: i32) -> i32 {
        let (way, all) = (height - self.start, self.end - self.start);
        if way <= 0 {
            return self.from;
        }
        if way >= all {
            return self.to;
        }
        let part = if all == 1 << 16 { (way as u32) << 16 } else { fraction(way as u32, all as u32) };
        self.from + mul_high_signed(self.to - self.from, part)
    }
}

/// Returns `num / den` in 0.32, rounded down within 2⁻²⁹; just below 1, if it is 1 or more.
pub(super) fn fraction(num: u32, den: u32) -> u32 {
    if num >= den {
        return u32::MAX;
    }
    let shift = leading_zeros(den) & 31;
    mul_high(num << shift, reciprocal(den << shift)).min(0x7FFF_FFFF) << 1
}

/// Returns `num / den` in 16.16, for `num` above `den`; at most 2¹⁶.
fn ratio(num: u32, den: u32) -> u32 {
    let shift = leading_zeros(den) & 31;
    let quotient = mul_high(num, reciprocal(den << shift));
    match shift.checked_sub(15) {
        None => quotient >> (15 - shift),
        Some(up) if leading_zeros(quotient) >= up => quotient << (up & 31),
        Some(_) => u32::MAX,
    }
}

/// Edges of a band of rows, in memory that is lent.
#[derive(Debug)]
pub(crate) struct AreaEdges<'m> {
    pub(super) edges: &'m mut [AreaEdge],
    /// Number of edges that were added, and whether there were more than fit.
    pub(super) count: usize,
    pub(super) overflowed: bool,
    /// Set while all lines cross all of the part of a row that is wanted, nearly upright.
    pub(super) upright: bool,
    /// Heights between which edges are wanted, 16.16 px.
    pub(super) top: i32,
    pub(super) bottom: i32,
    /// Places between which pixels are drawn, 16.16 px.
    pub(super) left: i32,
    pub(super) right: i32,
    pub(super) wanted: Wanted,
}

/// Form in which edges are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    /// Whole edges, for a band of rows.
    Rows,
    /// Edges cut at `top` and `bottom`, both in one row.
    Part,
    /// Places right of one at which lines cross the middle between `top` and `bottom`: as many of the first ones as
    /// there is room for. Lines that cross in one place share an edge.
    Crossings { after: i32 },
}

type Place = [i64; 2];

impl AreaEdges<'_> {
    /// Returns whether two places are within ±8,192 px, as nearly all are: all their coordinates, plus that, are below
    /// 2³⁰.
    #[inline(always)]
    pub(crate) const fn are_near(a: Place, b: Place) -> bool {
        const fn above(c: i64) -> u64 {
            c.wrapping_add(1 << 29) as u64
        }
        (above(a[0]) | above(a[1]) | above(b[0]) | above(b[1])) >> 30 == 0
    }

    /// Adds a line of an outline, in 16.16 px. Its direction is that of the outline.
    #[inline]
    pub(crate) fn line(&mut self, from: Place, to: Place) {
        if Self::are_near(from, to) {
            self.near_line(from.map(|c| c as i32), to.map(|c| c as i32));
        } else if !self.misses(from[1].min(to[1]), from[1].max(to[1])) {
            self.far_line(from, to);
        }
    }

    /// Returns whether no edge between two heights is wanted.
    #[inline]
    pub(crate) fn misses(&self, top: i64, bottom: i64) -> bool {
        // Whatever comes after too many edges is traced in vain.
        self.overflowed && self.wanted == Wanted::Rows || bottom <= i64::from(self.top) || top >= i64::from(self.bottom)
    }

    /// Returns the columns and rows in which edges are wanted, 16.16 px.
    pub(crate) fn area(&self) -> [Range<i64>; 2] {
        // What is left of the crossings so far has crossed all of it.
        let left = if let Wanted::Crossings { after } = self.wanted { self.left.max(after) } else { self.left };
        [left.into()..self.right.into(), self.top.into()..self.bottom.into()]
    }

    /// Adds a line that leaves the guard.
    #[cold]
    #[inline(never)]
    fn far_line(&mut self, from: Place, to: Place) {
        // From top to bottom, so that a line is cut as its reverse is.
        let down = from[1] < to[1];
        let (mut a, mut b) = if down { (from, to) } else { (to, from) };
        let guard = i64::from(GUARD);
        if a[1] == b[1] || b[1] <= -guard || a[1] >= guard {
            return;
        }
        if a[1] < -guard {
            a = cut(a, b, 1, -guard);
        }
        if b[1] > guard {
            b = cut(a, b, 1, guard);
        }
        // At most three parts, of which those beyond the left and the right border are vertical there.
        let borders = if a[0] <= b[0] { [-guard, guard] } else { [guard, -guard] };
        let mut start = a;
        for border in borders {
            if (start[0] < border) != (b[0] < border) {
                let place = cut(start, b, 0, border);
                self.part_of_far_line(start, place, down);
                start = place;
            }
        }
        self.part_of_far_line(start, b, down);
    }

    fn part_of_far_line(&mut self, a: Place, b: Place, down: bool) {
        let guard = i64::from(GUARD);
        let inside = |p: Place| p.map(|c| c.min(guard).max(-guard) as i32);
        if down { self.near_line(inside(a), inside(b)) } else { self.near_line(inside(b), inside(a)) }
    }

    /// Adds a line that is inside of the guard.
    pub(crate) fn near_line(&mut self, from: [i32; 2], to: [i32; 2]) {
        let (a, b, turn) = if from[1] < to[1] { (from, to, 1) } else { (to, from, -1) };
        let is_in_vain = self.overflowed && self.wanted == Wanted::Rows;
        if b[1] <= self.top || a[1] >= self.bottom || a[0].min(b[0]) >= self.right || is_in_vain {
            return;
        }
        if a[1] == b[1] {
            return self.level(a, b);
        }
        if self.wanted != Wanted::Rows {
            return self.cut_line(a, b, turn);
        }
        let (width, height) = (b[0] - a[0], (b[1] - a[1]) as u32);
        if height <= TALL as u32 {
            return self.push(a, b, turn, (width, height));
        }
        // Heights of both ends of a part; the part begins in the band.
        let mut y = a[1].max(self.top & !(TALL - 1));
        let end = b[1].min(self.bottom);
        let place = |y: i32| [a[0] + mul_high_signed(width, fraction((y - a[1]) as u32, height)), y];
        let mut start = if y == a[1] { a } else { place(y) };
        while y < end {
            y = (y & !(TALL - 1)).wrapping_add(TALL).min(b[1]);
            let next = if y == b[1] { b } else { place(y) };
            if y > self.top {
                self.push(start, next, turn, (width, height));
            }
            start = next;
        }
    }

    /// Returns the place of the next edge, which begins at a height; `None` if the edge is not wanted any more.
    #[inline(always)]
    fn next_edge(&mut self, top: i32) -> Option<&mut AreaEdge> {
        if self.count >= self.edges.len() && !self.make_room(top) {
            return None;
        }
        let edge = self.edges.get_mut(self.count)?;
        self.count += 1;
        Some(edge)
    }

    /// Makes room for an edge that begins at a height: the band loses a quarter of its rows, and its edges below them,
    /// as often as it takes. So an outline is traced once for as many rows as fit. Returns whether the edge is still
    /// wanted.
    #[cold]
    #[inline(never)]
    fn make_room(&mut self, top: i32) -> bool {
        while self.count >= self.edges.len() {
            let rows = (self.bottom - self.top) >> 16;
            if self.wanted != Wanted::Rows || rows <= 1 {
                self.overflowed = true;
                return false;
            }
            self.bottom = self.top + ((rows - ((rows + 3) >> 2)) << 16);
            let mut kept = 0;
            for k in 0..self.count {
                let Some(edge) = self.edges.get(k).filter(|edge| edge.top < self.bottom) else { continue };
                if kept < k {
                    let edge = *edge;
                    if let Some(place) = self.edges.get_mut(kept) {
                        *place = edge;
                    }
                }
                kept += 1;
            }
            self.count = kept;
        }
        top < self.bottom
    }

    /// Adds a horizontal line. It bounds no area by itself, but in its row, it crosses gaps between other edges.
    fn level(&mut self, a: [i32; 2], b: [i32; 2]) {
        let is_between_rows = self.wanted == Wanted::Rows && a[1] & 0xFFFF == 0;
        if is_between_rows || matches!(self.wanted, Wanted::Crossings { .. }) {
            return;
        }
        let Some(edge) = self.next_edge(a[1]) else { return };
        *edge = AreaEdge { top: a[1], bottom: a[1], x: a[0], next: b[0], last: b[0], ..AreaEdge::default() };
    }

    /// Adds an edge. `width` and `height` are those of the line that it is a part of.
    #[inline(always)]
    fn push(&mut self, a: [i32; 2], b: [i32; 2], turn: i32, (width, height): (i32, u32)) {
        let band_top = self.top;
        let Some(edge) = self.next_edge(a[1]) else { return };
        let (rise, flat) = rise(a[0], b[0], width, height);
        *edge = AreaEdge { top: a[1], bottom: b[1], x: a[0], next: b[0], last: b[0], rise, ..AreaEdge::default() };
        edge.turn = 2 * turn + flat;
        let row = a[1] >> 16;
        let border = (row + 1) << 16;
        if width == 0 || b[1] <= border {
            return;
        }
        // Half a unit on average is lost in each step, so it is added here.
        edge.next = a[0] + mul_high_signed(b[0] - a[0], fraction((border - a[1]) as u32, (b[1] - a[1]) as u32));
        let shift = leading_zeros(height) & 31;
        // A line of less than one row's height is never stepped further than to its end.
        if let Some(down) = 15_u32.checked_sub(shift) {
            let half = (1_i32 << down) >> 1;
            edge.slope = (mul_high_signed(width, reciprocal(height << shift)).saturating_add(half)) >> down;
        }
        let skipped = (band_top >> 16) - row;
        if skipped > 0 {
            // Modulo 2³²; the result is inside of the guard.
            edge.x = edge.next.wrapping_add(edge.slope.wrapping_mul(skipped - 1));
            edge.next = edge.x.wrapping_add(edge.slope);
        }
    }

    /// Adds the part of a line that is between `top` and `bottom`, or its place in the middle.
    #[inline(never)]
    fn cut_line(&mut self, a: [i32; 2], b: [i32; 2], turn: i32) {
        let (width, height) = (b[0] - a[0], (b[1] - a[1]) as u32);
        let place = |y: i32| {
            if y <= a[1] {
                a
            } else if y >= b[1] {
                b
            } else {
                [a[0] + mul_high_signed(width, fraction((y - a[1]) as u32, height)), y]
            }
        };
        if let Wanted::Crossings { after } = self.wanted {
            let middle = (self.top + self.bottom) >> 1;
            if a[1] <= middle && b[1] > middle {
                self.crossing(place(middle)[0], turn, after);
            }
            return;
        }
        let (start, end) = (place(self.top), place(self.bottom));
        self.upright &= a[1] <= self.top && b[1] >= self.bottom && (start[0] - end[0]).abs() <= UPRIGHT;
        let Some(edge) = self.next_edge(start[1]) else { return };
        let (rise, flat) = rise(start[0], end[0], width, height);
        *edge = AreaEdge {
            top: start[1],
            bottom: end[1],
            x: start[0],
            next: end[0],
            last: end[0],
            rise,
            turn: 2 * turn + flat,
            ..AreaEdge::default()
        };
    }

    /// Adds a crossing to the sorted list of those after a place. The last ones make room.
    fn crossing(&mut self, x: i32, turn: i32, after: i32) {
        if x <= after {
            return;
        }
        if self.edges.last().is_some_and(|last| self.count >= self.edges.len() && x > last.x) {
            self.overflowed = true;
            return;
        }
        let mut at = 0;
        while let Some(edge) = self.edges.get_mut(at).filter(|edge| at < self.count && edge.x <= x) {
            if edge.x == x {
                edge.turn += 2 * turn;
                return;
            }
            at += 1;
        }
        if at >= self.edges.len() {
            self.overflowed = true;
            return;
        }
        if self.count < self.edges.len() {
            self.count += 1;
        } else {
            self.overflowed = true;
        }
        let mut new = AreaEdge { x, last: x, turn: 2 * turn, ..AreaEdge::default() };
        for edge in self.edges.iter_mut().take(self.count).skip(at) {
            core::mem::swap(edge, &mut new);
        }
    }
}

/// Returns the change of height per column of an edge that crosses a border between columns, and 1 if it is 0.32.
#[inline]
fn rise(from: i32, to: i32, width: i32, height: u32) -> (u32, i32) {
    let width = width.unsigned_abs();
    if width == 0 || from >> 16 == to >> 16 {
        (0, 0)
    } else if height <= width {
        (fraction(height, width), 1)
    } else {
        (ratio(height, width), 0)
    }
}

/// Returns the place at which a line from `a` to `b` reaches `border` in one of its coordinates, which is between those
/// of its ends: by halves, so that no long division is linked. Each of them loses less than a unit.
fn cut(mut a: Place, mut b: Place, axis: usize, border: i64) -> Place {
    let coordinate = |p: Place| if axis == 0 { p[0] } else { p[1] };
    let rising = coordinate(a) < coordinate(b);
    for _ in 0..48 {
        let middle = [(a[0] + b[0]) >> 1, (a[1] + b[1]) >> 1];
        if (coordinate(middle) < border) == rising {
            a = middle;
        } else {
            b = middle;
        }
    }
    if axis == 0 { [border, b[1]] } else { [b[0], border] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    /// Places of edges at the borders of rows are those of the line, wherever a band begins.
    #[test]
    fn edges_are_on_their_lines() {
        let mut rng = Rng::new(3);
        let mut worst = 0_f64;
        for case in 0..20_000 {
            let reach = [1 << 17, 1 << 22, 1 << 27, GUARD][case % 4];
            let mut c = || rng.between(-reach, reach);
            let (a, b) = ([c(), c()], [c(), c()]);
            let top = rng.between(-reach, reach) >> 16;
            let mut memory = [AreaEdge::default(); 40];
            let mut edges = AreaEdges {
                edges: &mut memory,
                count: 0,
                overflowed: false,
                upright: true,
                top: top << 16,
                bottom: (top + 300) << 16,
                left: i32::MIN,
                right: i32::MAX,
                wanted: Wanted::Rows,
            };
            edges.line(a.map(i64::from), b.map(i64::from));
            let count = edges.count;
            for edge in &mut memory[..count] {
                let mut row = edge.top.max(top << 16) & !0xFFFF;
                while row < edge.bottom.min((top + 300) << 16) {
                    let piece = edge.piece(row);
                    let exact = |y: i32| {
                        let part = f64::from(y - a[1]) / f64::from(b[1] - a[1]);
                        f64::from(a[0]) + (f64::from(b[0]) - f64::from(a[0])) * part
                    };
                    for (y, x) in [(piece.start, piece.from), (piece.end, piece.to)] {
                        let off = (f64::from(x) - exact(row + y)).abs() / 65_536.0;
                        assert!(off < 1.0 / 512.0, "case {case}: {a:?} {b:?}, band {top}, row {}: {off}", row >> 16);
                        worst = worst.max(off);
                    }
                    edge.step();
                    row += 1 << 16;
                }
            }
        }
        std::println!("worst 1/{:.0} px", 1.0 / worst);
    }
}
