//! Small triangles in pixels of several samples: set up once, and drawn into the pixels of each sample.
//!
//! The plain loop:
//!
//! ```text
//! for each row: the columns in which the centre is covered
//! for each sample:
//!     for each row, of the triangle moved so that the sample is at the centre:
//!         for each pixel:
//!             if z of the sample passes:
//!                 store it, and the colour at the centre or, if that is not covered, at the sample
//! ```
//! So neither colours nor texels come from outside of the triangle, and a pixel inside of it has equal samples: it is
//! that pixel already. Pixels are not shaded once and then copied to their samples: a copy under a depth test takes as
//! long as flat or Gouraud shading does, and blending needs the colours of each sample.

use super::brush::{BrushRows, SmallResult, SmallTarget, subslice};
use super::depth::DepthTest;
use crate::color::PixelFormat;
use crate::raster::{ShortEdge, first_centre, moves};
use core::ops::Range;

/// Most rows in which a triangle has samples: of 25 px, and one more at either end.
const ROWS: usize = 27;

/// A small triangle that is set up.
pub(super) struct SampledTriangle {
    /// x and y of the corners on the left and on the right, relative to the highest one, 24.8.
    pub(super) sides: [i32; 4],
    /// The highest corner, 24.8.
    pub(super) a: (i32, i32),
    /// The first column and row that any sample may be in, and the row after the last one.
    pub(super) place: (i32, i32),
    pub(super) end: i32,
    /// Depth at the highest corner, and its changes to the right and down.
    pub(super) depth: u32,
    pub(super) dz: (i32, i32),
}

impl SampledTriangle {
    /// Calls a function for each row in which a sample is covered, with the row's number from the first row on, and the
    /// columns from the first column on. `to_centre` moves the sample to the centre of its pixel.
    ///
    /// # Format
    /// A move is below 128: relative to the first column, x is in 0..62 · 2⁸.
    #[inline(always)]
    fn each_row(&self, to_centre: (i32, i32), mut span: impl FnMut(usize, Range<u32>)) {
        let [bx, by, cx, cy] = self.sides;
        let (x, y) = (self.a.0 + to_centre.0 - (self.place.0 << 8), self.a.1 + to_centre.1);
        let (first, end) = (self.place.1, self.end);
        let row = first_centre(y).max(first);
        let p = 256 * row + 128 - y;
        let (left_end, right_end) = (first_centre(y + by).min(end), first_centre(y + cy).min(end));
        // Rows before the bend, and those from there on.
        let (bend, all) = (left_end.min(right_end) - row, left_end.max(right_end) - row);
        if all <= 0 {
            return;
        }
        let (mut count, mut rest) = (bend, all - bend);
        let (mut left, mut right) = (ShortEdge::new(x, bx, by, p), ShortEdge::new(x, cx, cy, p));
        let mut number = (row - first) as usize;
        loop {
            if count <= 0 {
                if rest <= 0 {
                    return;
                }
                (count, rest) = (count + rest, 0);
                let p = p + 256 * bend.max(0);
                if right_end < left_end {
                    right = ShortEdge::outlined(x + cx, bx - cx, by - cy, p - cy);
                } else {
                    left = ShortEdge::outlined(x + bx, cx - bx, cy - by, p - by);
                }
            }
            let columns = left.column()..right.column();
            if columns.start < columns.end {
                span(number, columns);
            }
            left.step();
            right.step();
            number += 1;
            count -= 1;
        }
    }

    /// Returns the depth of a sample at the first column and row.
    ///
    /// # Format
    /// As that of the moved triangle, bit for bit: from the vertex to the centre of its pixel, and from there on.
    #[inline(always)]
    fn depth_at(&self, (x, y): (i32, i32)) -> u32 {
        let ((dx, dy), (ax, ay)) = (self.dz, (self.a.0 + x, self.a.1 + y));
        let to = (128 - (ax & 0xFF), 128 - (ay & 0xFF));
        let offset = ((dx >> 6) * to.0 + (dy >> 6) * to.1) >> 2;
        self.depth
            .wrapping_add(offset as u32)
            .wrapping_add_signed(dx.wrapping_mul(self.place.0 - (ax >> 8)))
            .wrapping_add_signed(dy.wrapping_mul(self.place.1 - (ay >> 8)))
    }
}

/// Draws the rows of a triangle.
#[inline(always)]
pub(super) fn draw_sampled_rows<P: PixelFormat, D: DepthTest, R: BrushRows<P, D>>(
    target: &mut SmallTarget<'_, P::Raw>,
    triangle: &SampledTriangle,
    rows: &R,
    test: D,
) -> SmallResult {
    let mut centres = [[0; 2]; ROWS];
    if !R::IS_FLAT {
        triangle.each_row((0, 0), |number, columns| {
            if let Some(centres) = centres.get_mut(number) {
                *centres = [columns.start as u8, columns.end as u8];
            }
        });
    }
    for sample in 0..usize::from(target.count) {
        draw_sample(target, triangle, rows, &centres, sample, test);
    }
    SmallResult::Drawn
}

/// Draws the rows of one sample. `centres` has the columns of each row in which the centre is covered.
#[inline(never)]
fn draw_sample<P: PixelFormat, D: DepthTest, R: BrushRows<P, D>>(
    target: &mut SmallTarget<'_, P::Raw>,
    triangle: &SampledTriangle,
    rows: &R,
    centres: &[[u8; 2]; ROWS],
    sample: usize,
    test: D,
) {
    let SmallTarget { color, depth, samples, count, first, screen, .. } = target;
    let (Some(to_centre), length) = (moves(usize::from(*count)).get(sample), color.len()) else { return };
    let color = match sample.checked_sub(1) {
        None => &mut **color,
        Some(further) => subslice(samples, further.wrapping_mul(length), length).unwrap_or_default(),
    };
    let mut nothing = [(); usize::MAX];
    let depth = D::slots(subslice(depth, sample.wrapping_mul(length), length).unwrap_or_default(), &mut nothing);
    // Both get one length, so that the compiler knows a span inside of one to be inside of the other.
    let length = color.len().min(depth.len());
    let (Some(color), Some(depth)) = (color.get_mut(..length), depth.get_mut(..length)) else { return };
    let width = usize::from(screen.0);
    let (column, row) = triangle.place;
    let mut at = width.wrapping_mul((row - i32::from(*first)) as usize).wrapping_add(column as usize);
    let (mut z, (dz_dx, dz_dy)) = (triangle.depth_at(*to_centre), triangle.dz);
    let (mut rows, mut next) = (rows.beside((0, 0)), 0);
    triangle.each_row(*to_centre, |number, columns| {
        while next < number {
            rows.next_row();
            (at, z, next) = (at.wrapping_add(width), z.wrapping_add_signed(dz_dy), next + 1);
        }
        let mut draw = |rows: &R, columns: Range<u32>| {
            let (from, count) = (columns.start, columns.end.wrapping_sub(columns.start) as usize);
            let start = at.wrapping_add(from as usize);
            if let (Some(color), Some(depth)) = (subslice(color, start, count), subslice(depth, start, count)) {
                let z = z.wrapping_add_signed(dz_dx.wrapping_mul(from as i32));
                rows.span(color, depth, z, dz_dx, from as i32, test);
            }
        };
        let [start, end] = centres.get(number).copied().unwrap_or_default().map(u32::from);
        if R::IS_FLAT || columns.start >= start && columns.end <= end {
            return draw(&rows, columns);
        }
        let beside = rows.beside((-to_centre.0, -to_centre.1));
        let (inner, outer) = (columns.start.max(start), columns.end.min(end));
        if inner >= outer {
            return draw(&beside, columns);
        }
        for (rows, columns) in [(&beside, columns.start..inner), (&rows, inner..outer), (&beside, outer..columns.end)] {
            if columns.start < columns.end {
                draw(rows, columns);
            }
        }
    });
}
