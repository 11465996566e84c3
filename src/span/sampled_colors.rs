//! The colours of a small triangle's pixels, shaded once for all samples.
//!
//! A pixel whose centre is covered is shaded there. Another one gets the colour next to it or, farther from the
//! centres, one of a sample: so no colour comes from outside of the triangle.

use super::brush::{BrushRows, subslice};
use super::depth::DepthTest;
use super::sampled_edges::Edges;
use crate::color::PixelFormat;
use core::ops::Range;

/// Most rows in which a triangle has samples: of 25 px, and one more at either end.
pub(super) const ROWS: usize = 27;

/// Rows of a triangle, and the colours of their pixels.
pub(super) struct Band<R, const N: usize> {
    pub(super) rows: Range<i32>,
    /// Columns of each row that have a colour, one column more than their number. At first, these are the ones in which
    /// the centre is covered, and one more at either end, with the colour next to it.
    pub(super) colored: [[u8; 2]; ROWS],
    /// Number of columns, one more at either end.
    pub(super) width: usize,
    /// Colours, from the column before the first one of the first row on.
    pub(super) colors: [R; N],
}

/// Finds the columns of a band in which centres are covered, and colours them.
#[inline(never)]
pub(super) fn shade<P: PixelFormat, D: DepthTest, R: BrushRows<P, D>, const N: usize>(
    edges: &Edges,
    rows: &R,
    band: &mut Band<P::Raw, N>,
) {
    let Band { rows: range, width, colored, colors } = band;
    let Some(mut moved) = edges.moved((0, 0), range) else { return };
    let mut rows = rows.beside((0, 0));
    let first = (moved.row - range.start) as usize;
    for _ in 0..first {
        rows.next_row();
    }
    let mut at = first.wrapping_mul(*width);
    for colored in colored.iter_mut().skip(first) {
        if moved.count <= 0 && moved.bend(edges).is_none() {
            return;
        }
        let (from, past) = (moved.left.column(), moved.right.column());
        if from < past {
            *colored = [from as u8, past as u8 + 2];
            if R::SHADES {
                let part = subslice(colors, at.wrapping_add(from as usize), (past - from) as usize + 2);
                color_with_ends(&rows, part.unwrap_or_default(), from);
            }
        }
        moved.step();
        rows.next_row();
        at = at.wrapping_add(*width);
    }
}

/// Colours pixels in a row from a column on. There is one more at either end, which gets the colour next to it.
#[inline(always)]
fn color_with_ends<P: PixelFormat, D: DepthTest, R: BrushRows<P, D>>(rows: &R, colors: &mut [P::Raw], from: u32) {
    let inner = colors.len().wrapping_sub(2);
    rows.shade(subslice(colors, 1, inner).unwrap_or_default(), from as i32);
    if let [before, first, ..] = colors {
        *before = *first;
    }
    if let [.., last, after] = colors {
        *after = *last;
    }
}

impl<Raw: Copy, const N: usize> Band<Raw, N> {
    /// Colours the pixels of a sample's span that have no colour yet, at the sample.
    #[inline(never)]
    pub(super) fn color_beside<P: PixelFormat<Raw = Raw>, D: DepthTest, R: BrushRows<P, D>>(
        &mut self,
        rows: &R,
        number: usize,
        (x, y): (i32, i32),
        columns: Range<u32>,
    ) {
        let mut rows = rows.beside((-x, -y));
        for _ in 0..number {
            rows.next_row();
        }
        let (Some(colored), Some(colors)) =
            (self.colored.get_mut(number), subslice(&mut self.colors, number.wrapping_mul(self.width), self.width))
        else {
            return;
        };
        // From here on, columns are one more than their number.
        let Range { start: from, end: past } = columns.start + 1..columns.end + 1;
        let [start, end] = *colored;
        let (start, end) = (u32::from(start), u32::from(end));
        if start >= end {
            let part = subslice(colors, from as usize - 1, (past - from) as usize + 2).unwrap_or_default();
            *colored = [from as u8 - 1, past as u8 + 1];
            return color_with_ends(&rows, part, from - 1);
        }
        let mut part = |columns: Range<u32>, color: Option<Raw>| {
            let length = columns.end.wrapping_sub(columns.start) as usize;
            let part = subslice(colors, columns.start as usize, length).unwrap_or_default();
            match color {
                Some(color) => part.iter_mut().for_each(|pixel| *pixel = color),
                None => rows.shade(part, columns.start as i32 - 1),
            }
            [part.first().copied(), part.last().copied()]
        };
        // Pixels between these and those that have a colour get the one next to them.
        if from < start {
            let end = past.min(start);
            let [_, last] = part(from..end, None);
            part(end..start, last);
            colored[0] = from as u8;
        }
        if past > end {
            let start = from.max(end);
            let [first, _] = part(start..past, None);
            part(end..start, first);
            colored[1] = past as u8;
        }
    }
}
