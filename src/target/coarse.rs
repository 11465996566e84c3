//! Coarse depths: the farthest depth of each block of a strip comes out of the strip's depths, so that whatever lies
//! behind a block's pixels can be left out.
//!
//! They lie in the depth buffer, after the depths of the strip: two numbers per block of 16 × 16 pixels. The first is a
//! bound of the block's depths, none of which is farther. It is made when a test asks for it, because most blocks are
//! never asked for. The second is the place of a pixel where the last test ended. The next test looks there first: as
//! long as this pixel is far enough, the test takes a few instructions, however many draws there are.
//!
//! Both hold as long as depths only become nearer. A draw that may write farther depths calls [`Coarse::forget`].

use crate::vertex::Extent;
use core::ops::Range;

/// Columns, and rows, of a block.
const BLOCK: usize = 16;

/// Returns how many numbers a depth buffer takes beside the depths of a strip, for
/// [`Renderer::with_occlusion`](crate::frame::Renderer::with_occlusion): two of 16 bits for each block of 16 × 16 px.
/// `width` and `rows` are those of a strip, in px.
///
/// A number that does not fit is `usize::MAX`.
#[must_use]
pub const fn occlusion_len(width: usize, rows: usize) -> usize {
    width.div_ceil(BLOCK).saturating_mul(rows.div_ceil(BLOCK)).saturating_mul(2)
}

/// The coarse depths of a strip, beside its depths.
pub(crate) struct Coarse<'s> {
    depths: &'s [u16],
    /// For each block, a depth that none in the block is farther than; and the place where the last test ended: 16
    /// times the row in the block plus the column.
    blocks: &'s mut [[u16; 2]],
    width: usize,
    rows: usize,
}

impl<'s> Coarse<'s> {
    /// Finds coarse depths in a depth buffer: they follow the depths of a strip of this size.
    pub(crate) fn new(buffer: &'s mut [u16], width: usize, rows: usize) -> Self {
        let (depths, rest) = buffer.split_at_mut_checked(width.wrapping_mul(rows)).unwrap_or_default();
        let blocks = rest.get_mut(..occlusion_len(width, rows)).unwrap_or_default();
        Self { depths, blocks: bytemuck::try_cast_slice_mut(blocks).unwrap_or_default(), width, rows }
    }

    /// Notes that depths may have become farther.
    pub(crate) fn forget(self) {
        self.blocks.fill([u16::MAX; 2]);
    }

    /// Returns whether all depths in a rectangle are below `limit`. Blocks count as a whole. The rectangle is not empty
    /// and lies in the strip.
    pub(crate) fn all_below(&mut self, limit: u32, columns: &Range<usize>, rows: &Range<usize>) -> bool {
        let across = self.width.div_ceil(BLOCK);
        for down in rows.start / BLOCK..rows.end.div_ceil(BLOCK) {
            for column in columns.start / BLOCK..columns.end.div_ceil(BLOCK) {
                let block = down.wrapping_mul(across).wrapping_add(column);
                if !self.is_below(limit, block, (BLOCK * column, BLOCK * down)) {
                    return false;
                }
            }
        }
        true
    }

    /// Returns whether all depths of a block are below `limit`. `corner` is the block's first column and row.
    #[inline(never)]
    fn is_below(&mut self, limit: u32, block: usize, (left, top): (usize, usize)) -> bool {
        let Some([farthest, place]) = self.blocks.get_mut(block) else { return false };
        if u32::from(*farthest) < limit {
            return true;
        }
        let (width, rows) = (self.width, self.rows);
        let at = |row: usize| (top + row).wrapping_mul(width).wrapping_add(left);
        let last = usize::from(*place);
        let first = (last / BLOCK) & (BLOCK - 1);
        let seen = self.depths.get(at(first).wrapping_add(last & (BLOCK - 1)));
        if first < rows - top && left + (last & (BLOCK - 1)) < width && seen.is_some_and(|d| u32::from(*d) >= limit) {
            return false;
        }
        let (columns, count) = ((width - left).min(BLOCK), (rows - top).min(BLOCK));
        let mut most = 0;
        // From the row of the place on, and then from the top: rows in front of it were below an earlier limit.
        let first = if first < count { first } else { 0 };
        for row in (first..count).chain(0..first) {
            let depths = self.depths.get(at(row)..).and_then(|rest| rest.get(..columns)).unwrap_or_default();
            let row_most = depths.iter().fold(0, |most, depth| u32::from(*depth).max(most));
            if row_most >= limit {
                let column = depths.iter().position(|depth| u32::from(*depth) >= limit).unwrap_or(0);
                *place = (BLOCK * row + column) as u16;
                return false;
            }
            most = row_most.max(most);
        }
        *farthest = most as u16;
        true
    }

    /// Returns whether all that has this extent lies behind what has been drawn: its fragments fail their test wherever
    /// the stored depth is below `limit`. `seen` are the pixels that may be drawn; `first` is the strip's first row.
    pub(crate) fn hides(&mut self, limit: u32, extent: &Extent, seen: (&Range<i32>, &Range<i32>), first: i32) -> bool {
        let cut = |part: &Range<i32>, all: &Range<i32>, first: i32| {
            let (start, end) = (part.start.max(all.start), part.end.min(all.end));
            (start < end).then(|| (start - first) as usize..(end - first) as usize)
        };
        match (cut(&extent.columns, seen.0, 0), cut(&extent.rows, seen.1, first)) {
            (Some(columns), Some(rows)) => self.all_below(limit, &columns, &rows),
            // No pixel of it may be drawn.
            _ => true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use std::vec;

    /// Depths become nearer at random, and rectangles are asked for: the answer is that of a look at all depths of all
    /// blocks that the rectangle touches.
    #[test]
    fn tests_of_blocks_are_looks_at_all_depths() {
        let (mut rng, mut answers) = (Rng::new(1), [0; 2]);
        for case in 0..60 {
            let (width, rows) = (1 + rng.below(70) as usize, 1 + rng.below(40) as usize);
            let mut buffer = vec![u16::MAX; width * rows + occlusion_len(width, rows)];
            let mut side = |length: usize| {
                let start = rng.below(length as u64) as usize;
                start..start + 1 + rng.below((length - start) as u64) as usize
            };
            for step in 0..400 {
                let (columns, lines, value) = (side(width), side(rows), side(0xFFFF).start as u16);
                if step % 97 == 96 {
                    // A draw that writes whatever it likes.
                    Coarse::new(&mut buffer, width, rows).forget();
                    lines.for_each(|y| buffer[width * y..][columns.clone()].fill(value));
                } else if step % 3 == 0 {
                    for depth in lines.flat_map(|y| columns.clone().map(move |x| width * y + x)) {
                        buffer[depth] = buffer[depth].min(value);
                    }
                } else {
                    let block = |range: &Range<usize>, all: usize| {
                        BLOCK * (range.start / BLOCK)..(BLOCK * range.end.div_ceil(BLOCK)).min(all)
                    };
                    let limit = if step % 5 == 0 { 65_535 } else { u32::from(value) + 1 };
                    let looked = block(&lines, rows)
                        .all(|y| block(&columns, width).all(|x| u32::from(buffer[width * y + x]) < limit));
                    let found = Coarse::new(&mut buffer, width, rows).all_below(limit, &columns, &lines);
                    assert_eq!(found, looked, "case {case}, step {step}: {width}x{rows}, {columns:?} {lines:?}");
                    answers[usize::from(found)] += 1;
                }
            }
        }
        assert!(answers.iter().all(|count| *count > 1000), "{answers:?}");
    }

    #[test]
    fn a_buffer_without_room_hides_nothing() {
        let mut buffer = [0; 20];
        let mut coarse = Coarse::new(&mut buffer, 5, 4);
        assert!(!coarse.all_below(65_536, &(0..5), &(0..4)));
        assert_eq!([occlusion_len(320, 16), occlusion_len(0, 16), occlusion_len(17, 17)], [40, 0, 8]);
    }
}
