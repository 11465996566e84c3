//! Cells of a row: pieces of edges come in, and the covered part of each pixel goes out, exact but for roundings of
//! 2⁻¹⁰.
//!
//! A cell keeps the difference to its left neighbour, so that what is right of an edge, to the end of the row, takes no
//! time. Ranges of cells that may not be 0 are kept beside them.

use super::area_edge::{AreaEdge, Piece};
use crate::math::mul_high;

/// Cells of a row: the covered part of each pixel, in 2⁻¹⁶, less that of its left neighbour; and ranges of cells that
/// may not be 0.
#[derive(Debug)]
pub(super) struct Cells<'c> {
    /// One per pixel, and one more.
    pub(super) cover: &'c mut [i32],
    /// Ranges from left to right, none of which touches the next one: the start in the upper half of a word, the end in
    /// the lower half.
    pub(super) ranges: &'c mut [u32],
    pub(super) count: usize,
    /// The first column, and the number of columns.
    pub(super) left: i32,
    pub(super) width: i32,
}

/// Returns the start and the end of a range.
#[inline(always)]
pub(super) const fn start_and_end(range: u32) -> (i32, i32) {
    ((range >> 16) as i32, (range & 0xFFFF) as i32)
}

impl Cells<'_> {
    #[inline(always)]
    fn put(&mut self, column: i32, cover: i32) {
        if let Some(cell) = self.cover.get_mut(column as usize) {
            *cell = cell.wrapping_add(cover);
        }
    }

    /// Adds the range of cells that edges between two places may fill. It begins right of the start of the range before
    /// it. Without room for another range, the last one is made longer.
    #[inline(always)]
    pub(super) fn add_range(&mut self, left: i32, right: i32) {
        // The area to the right of a place in a column is added up in this column and in the next one.
        let start = ((left >> 16) - self.left).max(0);
        let end = ((right >> 16) - self.left + 2).max(1).min(self.width);
        if start >= end {
            return;
        }
        let is_full = self.count >= self.ranges.len();
        if let Some(last) = self.count.checked_sub(1).and_then(|last| self.ranges.get_mut(last)) {
            let (first, last_end) = start_and_end(*last);
            if start <= last_end || is_full {
                *last = (first << 16 | end.max(last_end)) as u32;
                return;
            }
        }
        if let Some(range) = self.ranges.get_mut(self.count) {
            *range = (start << 16 | end) as u32;
            self.count += 1;
        }
    }

    /// Makes one range of all cells, for a row that is filled part by part.
    pub(super) fn add_all(&mut self) {
        self.count = 0;
        self.add_range(self.left << 16, (self.left + self.width) << 16);
    }

    /// Adds what is right of a piece of an edge, of a height of 1 to 65,536; or takes it away.
    ///
    /// # Format
    /// Let H(x) be the height of the part of the piece that is left of x. The covered part of a column is the integral
    /// of H over it. H is linear along the piece, so that is H in the middle of each column but the first and the last
    /// ones. All of it is in 2⁻¹⁶; the cells of a piece add up to its height exactly.
    #[inline(always)]
    pub(super) fn add(&mut self, piece: &Piece, edge: &AreaEdge, inside: bool) {
        let height = piece.end - piece.start;
        let (left, right) = (piece.left() - (self.left << 16), piece.right() - (self.left << 16));
        let (first, last) = (left >> 16, right >> 16);
        if first != last {
            return self.add_long(left, right, height, (edge.rise, edge.is_flat()), inside);
        }
        if first >= self.width {
            return;
        }
        if first < 0 {
            return self.put(0, if inside { height } else { -height });
        }
        // Twice the mean distance from the column's right border, up to 2¹⁷.
        let distance = (2 << 16) - (left & 0xFFFF) - (right & 0xFFFF);
        let part = if height == 1 << 16 {
            distance >> 1
        } else {
            // 2¹⁵ times 2¹⁶.
            (((height >> 1) as u32).wrapping_mul((distance >> 1) as u32) >> 15) as i32
        };
        if inside {
            self.put(first, part);
            self.put(first + 1, height - part);
        } else {
            self.put(first, -part);
            self.put(first + 1, part - height);
        }
    }

    /// Adds what is right of a piece that crosses columns.
    #[inline(never)]
    fn add_long(&mut self, left: i32, right: i32, height: i32, (rise, flat): (u32, bool), inside: bool) {
        let (first, last) = (left >> 16, right >> 16);
        if first >= self.width {
            return;
        }
        let sign = if inside { 1 } else { -1 };
        if last < 0 {
            return self.put(0, sign * height);
        }
        // H, from the distance to the piece's left end. The distance is at most 1 px at a rise of 1 and more.
        let reach = |distance: i32| {
            let h = if flat {
                mul_high(distance as u32, rise)
            } else {
                mul_high((distance.min(1 << 16) as u32) << 15, rise) << 1
            };
            (h as i32).min(height)
        };
        let mut before = 0;
        let start = ((first + 1) << 16) - left;
        if first >= 0 {
            let h = reach(start);
            before = (((h >> 1) as u32).wrapping_mul(start as u32) >> 16) as i32;
            self.put(first, sign * before);
        }
        let (from, to) = ((first + 1).max(0), last.min(self.width));
        if from < to && flat {
            // In the middle of the column `from`, 0.32: below 1, as it is below the height.
            let distance = (from << 16) + (1 << 15) - left;
            let low = (distance as u32).wrapping_mul(rise) >> 16;
            let mut h = mul_high(distance as u32, rise) << 16 | low;
            for column in from..to {
                let cover = ((h >> 16) as i32).min(height);
                self.put(column, sign * (cover - before));
                before = cover;
                h = h.wrapping_add(rise);
            }
        } else if from < to {
            // At a rise of 1, roundings may let a piece end just behind the column.
            let cover = reach(((from << 16) + (1 << 15) - left).min(1 << 16));
            self.put(from, sign * (cover - before));
            before = cover;
        }
        if last < self.width {
            let rest = height - reach((last << 16) - left);
            // The piece rises by the rest over this part of the column.
            let part = (right & 0xFFFF) as u32;
            let cover = height - (((rest >> 1) as u32).wrapping_mul(part) >> 16) as i32;
            self.put(last, sign * (cover - before));
            self.put(last + 1, sign * (height - cover));
        }
    }
}
