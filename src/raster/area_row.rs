//! Areas in a row: the edges of a row come in, and the pieces of them that are between inside and outside go out, into
//! [`Cells`] that add up the covered part of each pixel.
//!
//! The covered part of a pixel is a sum over edges: an edge with the area on its right adds the part of the pixel that
//! is right of it, and one with the area on its left takes that part away. This holds where no two of the edges cross
//! and the winding number is 0 or 1 (or 0 or -1), which is so in most rows of most outlines: the row is *plain*. Any
//! other row is cut, at the ends of edges and where they cross, into slabs in which their order does not change. There,
//! only the edges between inside and outside count, whatever the fill rule is.
//!
//! ```text
//!    \      /  slab 1: a, b
//! ----\----/-----------------       where another edge begins or ends
//!      \  /    slab 2: a, b
//! ------\/-------------------       where a and b cross
//!      / \     slab 3: b, a
//! ```

use super::area_cells::Cells;
use super::area_edge::{AreaEdge, Piece, fraction};
use crate::math::mul_high;
use core::ops::Range;

/// Rule by which winding numbers are inside of an area.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FillRule {
    /// All but 0 are inside: contours that go round the same way are united.
    #[default]
    NonZero,
    /// Odd ones are inside: a contour in another one is a hole, whichever way it goes round.
    EvenOdd,
}

impl FillRule {
    #[inline(always)]
    const fn contains(self, winding: i32) -> bool {
        match self {
            Self::NonZero => winding != 0,
            Self::EvenOdd => winding & 1 != 0,
        }
    }
}

/// Slabs that are cut in a row where edges cross. After that, slabs are of one height, and edges may cross in them.
const EXACT_SLABS: u32 = 256;

/// Height of those slabs: 1/128 px.
const ROUGH: i32 = 512;

/// Returns an edge by its place in an order.
#[inline(always)]
fn edge_of<'e>(edges: &'e [AreaEdge], order: &[u32], at: usize) -> &'e AreaEdge {
    // The numbers are those of edges, so there always is one.
    order.get(at).and_then(|number| edges.get(*number as usize)).unwrap_or(const { &AreaEdge::NONE })
}

/// The edges of a row, by their numbers, and the cells that they fill.
pub(super) struct Row<'r, 'c> {
    pub(super) edges: &'r mut [AreaEdge],
    /// Numbers of the edges in the row.
    pub(super) order: &'r mut [u32],
    pub(super) cells: &'r mut Cells<'c>,
    /// Height of the row's upper border, 16.16 px.
    pub(super) top: i32,
    pub(super) rule: FillRule,
}

impl Row<'_, '_> {
    #[inline(always)]
    fn edge(&self, at: usize) -> &AreaEdge {
        edge_of(self.edges, self.order, at)
    }

    #[inline(always)]
    fn edge_mut(&mut self, at: usize) -> Option<&mut AreaEdge> {
        self.order.get(at).and_then(|number| self.edges.get_mut(*number as usize))
    }

    /// Sorts some edges by a key, and those of equal keys by their numbers, if `TIES` is set. They are nearly sorted,
    /// as they were in the row before.
    #[inline(always)]
    fn sort<const TIES: bool>(&mut self, start: usize, end: usize, key: impl Fn(&AreaEdge) -> i32) {
        for k in start + 1..end {
            let (Some(number), own) = (self.order.get(k).copied(), key(self.edge(k))) else { return };
            let mut at = k;
            while at > start {
                let previous = self.order.get(at - 1).copied().unwrap_or(0);
                let of_previous = key(self.edge(at - 1));
                if of_previous < own || of_previous == own && (!TIES || previous < number) {
                    break;
                }
                if let Some(place) = self.order.get_mut(at) {
                    *place = previous;
                }
                at -= 1;
            }
            if let Some(place) = self.order.get_mut(at) {
                *place = number;
            }
        }
    }

    /// Fills the cells of a row between two heights, group by group.
    ///
    /// Edges of a group overlap each other in x, and no others. No edge crosses the gap between two groups, so the
    /// winding number in the gap is the same at all heights: it is that at the upper border.
    #[inline(never)]
    pub(super) fn fill(&mut self, from: i32, to: i32) {
        let (top, count) = (self.top, self.order.len());
        for k in 0..count {
            if let Some(edge) = self.edge_mut(k) {
                let piece = edge.piece(top);
                (edge.low, edge.high) = (piece.left(), piece.right());
            }
        }
        if count == 2 && self.fill_between(from, to) {
            return;
        }
        // Whatever the rows above were, the order is the same.
        self.sort::<true>(0, count, |edge| edge.low);
        let (mut first, mut winding) = (0, 0);
        while first < count {
            let (mut end, mut right, mut after) = (first, i32::MIN, winding);
            let left = self.edge(first).low;
            while end < count {
                let edge = self.edge(end);
                if end > first && edge.low > right {
                    break;
                }
                right = right.max(edge.high);
                if edge.top <= top + from {
                    after += edge.winding();
                }
                end += 1;
            }
            self.cells.add_range(left, right);
            if self.is_plain(first..end, winding, from..to) {
                let Self { edges, order, cells, .. } = self;
                for k in first..end {
                    let edge = edge_of(edges, order, k);
                    let piece = edge.piece(top);
                    if piece.start < piece.end {
                        cells.add(&piece, edge, edge.low != 0);
                    }
                }
            } else {
                self.slabs(first..end, winding, from..to);
            }
            (first, winding) = (end, after);
        }
    }

    /// Fills the cells of a row of one convex contour: edges of one direction are on the left, and those of the other
    /// one on the right. No two of them cross.
    #[inline(never)]
    pub(super) fn fill_convex(&mut self) {
        let Self { edges, order, cells, top, .. } = self;
        let (mut down, mut up) = ((i32::MAX, i32::MIN), (i32::MAX, i32::MIN));
        for k in 0..order.len() {
            let edge = edge_of(edges, order, k);
            let piece = edge.piece(*top);
            let (left, right) = if piece.from < piece.to { (piece.from, piece.to) } else { (piece.to, piece.from) };
            if edge.winding() > 0 {
                down = (down.0.min(left), down.1.max(right));
                cells.add(&piece, edge, true);
            } else if piece.start < piece.end {
                up = (up.0.min(left), up.1.max(right));
                cells.add(&piece, edge, false);
            }
        }
        let (left, right) = if down.0 < up.0 { (down, up) } else { (up, down) };
        if left.1 < right.0 {
            cells.add_range(left.0, left.1);
            cells.add_range(right.0, right.1);
        } else {
            cells.add_range(left.0, left.1.max(right.1));
        }
    }

    /// Fills the cells of a row of contours that do not cross, where winding numbers are 0 and 1, or 0 and -1. So edges
    /// of one direction have the inside on their right, those of the other one on their left, and only the ranges of
    /// cells need an order.
    #[inline(never)]
    pub(super) fn fill_apart(&mut self) {
        let (top, count) = (self.top, self.order.len());
        for k in 0..count {
            let Self { edges, order, cells, .. } = self;
            let Some(edge) = order.get(k).and_then(|number| edges.get_mut(*number as usize)) else { break };
            let piece = edge.piece(top);
            let (left, right) = if piece.from < piece.to { (piece.from, piece.to) } else { (piece.to, piece.from) };
            (edge.low, edge.high) = (left, right);
            if piece.start < piece.end {
                cells.add(&piece, edge, edge.winding() > 0);
            }
        }
        self.sort::<false>(0, count, |edge| edge.low);
        let Self { edges, order, cells, .. } = self;
        for k in 0..count {
            let edge = edge_of(edges, order, k);
            if edge.top < edge.bottom {
                cells.add_range(edge.low, edge.high);
            }
        }
    }

    /// Fills the cells between two edges, if that is all there is: both are as high as the row, and do not cross.
    #[inline(always)]
    fn fill_between(&mut self, from: i32, to: i32) -> bool {
        let Self { edges, order, cells, top, .. } = self;
        let (a, b) = (edge_of(edges, order, 0), edge_of(edges, order, 1));
        let (start, end) = (*top + from, *top + to);
        let is_high = a.top.max(b.top) <= start && a.bottom.min(b.bottom) >= end;
        if !is_high || a.winding() + b.winding() != 0 {
            return false;
        }
        let ((mut a, mut left), (mut b, mut right)) = ((a, a.piece(*top)), (b, b.piece(*top)));
        if left.from > right.from {
            core::mem::swap(&mut a, &mut b);
            core::mem::swap(&mut left, &mut right);
        }
        if left.to > right.to {
            return false;
        }
        cells.add(&left, a, true);
        cells.add(&right, b, false);
        if a.high < b.low {
            cells.add_range(a.low, a.high);
            cells.add_range(b.low, b.high);
        } else {
            cells.add_range(a.low, b.high);
        }
        true
    }

    /// Returns whether edges are sorted from left to right at each height, and the winding number is 0 or 1, or 0 or
    /// -1, at each height of the row. May be false for a row where it is so. Notes in `low` which edges have the inside
    /// on their right.
    ///
    /// Heights that are inside, right of the edges so far, are one range. An edge of the winding that has made it adds
    /// to it at either end, and one of the other winding takes away from it at either end.
    fn is_plain(&mut self, group: Range<usize>, before: i32, heights: Range<i32>) -> bool {
        let (mut start, mut end, mut winding) = match before {
            0 => (0, 0, 0),
            1 | -1 => (heights.start, heights.end, before),
            _ => return false,
        };
        let mut right = i32::MIN;
        for k in group.clone() {
            let edge = self.edge(k);
            let (piece, own) = (edge.piece(self.top), edge.winding());
            if piece.start == piece.end {
                continue;
            }
            if edge.low < right && !self.is_sorted(group.start..k, &piece) {
                return false;
            }
            right = right.max(edge.high);
            let inside = start == end || own == winding;
            if let Some(edge) = self.edge_mut(k) {
                edge.low = i32::from(inside);
            }
            if start == end {
                (start, end, winding) = (piece.start, piece.end, own);
            } else if inside {
                if piece.end == start {
                    start = piece.start;
                } else if piece.start == end {
                    end = piece.end;
                } else {
                    return false;
                }
            } else if piece.start == start && piece.end <= end {
                start = piece.end;
            } else if piece.end == end && piece.start >= start {
                end = piece.start;
            } else {
                return false;
            }
        }
        true
    }

    /// Returns whether an edge is right of all edges before it, at each height that they share.
    fn is_sorted(&self, others: Range<usize>, piece: &Piece) -> bool {
        // A long list is not worth it.
        if others.len() > 16 {
            return false;
        }
        let left = piece.left();
        for k in others {
            let other = self.edge(k);
            if other.high <= left {
                continue;
            }
            let other = other.piece(self.top);
            let (start, end) = (piece.start.max(other.start), piece.end.min(other.end));
            if start < end && (other.at(start) > piece.at(start) || other.at(end) > piece.at(end)) {
                return false;
            }
        }
        true
    }

    /// Fills the cells slab by slab, between two heights in the row, from the edges of a group. `before` is the winding
    /// number on its left.
    #[inline(never)]
    fn slabs(&mut self, group: Range<usize>, before: i32, heights: Range<i32>) {
        let (mut height, mut left) = (heights.start, EXACT_SLABS);
        while height < heights.end {
            let mut next = heights.end;
            for k in group.clone() {
                let piece = self.edge(k).piece(self.top);
                if piece.start > height {
                    next = next.min(piece.start);
                } else if piece.end > height {
                    next = next.min(piece.end);
                }
            }
            if left == 0 {
                next = next.min(height + ROUGH);
            }
            let end = self.place(group.clone(), height, next);
            if left > 0 {
                left -= 1;
                self.sort::<true>(group.start, end, |edge| edge.high);
                self.sort::<false>(group.start, end, |edge| edge.low);
                let crossing = self.first_crossing(group.start..end, height, next);
                if crossing < next {
                    next = crossing;
                    self.place(group.start..end, height, next);
                }
            } else {
                self.sort::<false>(group.start, end, |edge| (edge.low >> 1) + (edge.high >> 1));
            }
            let mut winding = before;
            let Self { edges, order, cells, rule, .. } = self;
            for k in group.start..end {
                let edge = edge_of(edges, order, k);
                let was_inside = rule.contains(winding);
                winding += edge.winding();
                let inside = rule.contains(winding);
                if inside != was_inside {
                    let piece = Piece { start: height, end: next, from: edge.low, to: edge.high };
                    cells.add(&piece, edge, inside);
                }
            }
            height = next;
        }
    }

    /// Computes the places of the edges of a group at both ends of a slab, and puts these edges first. Their order
    /// stays as it is. Returns their end.
    fn place(&mut self, group: Range<usize>, height: i32, next: i32) -> usize {
        let (mut end, top) = (group.start, self.top);
        for k in group {
            let Some(edge) = self.edge_mut(k) else { break };
            let piece = edge.piece(top);
            if piece.start <= height && piece.end > height {
                (edge.low, edge.high) = (piece.at(height), piece.at(next));
                let (Some(first), Some(number)) = (self.order.get(end).copied(), self.order.get(k).copied()) else {
                    break;
                };
                if let Some(place) = self.order.get_mut(k) {
                    *place = first;
                }
                if let Some(place) = self.order.get_mut(end) {
                    *place = number;
                }
                end += 1;
            }
        }
        end
    }

    /// Returns the height of the first crossing in a slab, or its end. The edges that cross first are neighbours.
    fn first_crossing(&self, group: Range<usize>, height: i32, next: i32) -> i32 {
        let mut first = next;
        for k in group.start + 1..group.end {
            let (a, b) = (self.edge(k - 1), self.edge(k));
            if a.high > b.high {
                // Both are at most 2³¹.
                let (before, after) = (b.low.wrapping_sub(a.low) as u32, a.high.wrapping_sub(b.high) as u32);
                let part = fraction(before >> 1, (before >> 1) + (after >> 1) + 1);
                let part = if before < 1 << 30 && after < 1 << 30 { fraction(before, before + after) } else { part };
                let way = mul_high((next - height) as u32, part) as i32;
                first = first.min(height + way.max(1));
            }
        }
        first
    }

    /// Fills the cells from crossings: vertical edges of one height.
    pub(super) fn crossings(&mut self, height: i32, winding: &mut i32) {
        for edge in &*self.edges {
            let was_inside = self.rule.contains(*winding);
            *winding = winding.wrapping_add(edge.winding());
            let inside = self.rule.contains(*winding);
            if inside != was_inside {
                let piece = Piece { start: 0, end: height, from: edge.x, to: edge.x };
                self.cells.add(&piece, edge, inside);
            }
        }
    }
}
