//! Small triangles in pixels of several samples: each pixel is shaded once, and its colour is copied to the samples that
//! are covered and pass the depth test.
//!
//! The plain loop:
//!
//! ```text
//! for each sample, and for the centre:
//!     for each row: the columns between the edges, moved so that the sample is at the centre
//! for each row:
//!     shade the pixels whose centre is covered
//!     shade other pixels at their first covered sample
//!     for each sample:
//!         for each pixel: if z of the sample passes, store it, and copy the colour
//! ```
//! So neither colours nor texels come from outside of the triangle.

use super::depth::{DepthOff, DepthTest};
use super::small::{BrushRows, SmallResult, SmallTarget, subslice};
use crate::color::PixelFormat;
use crate::raster::{ShortEdge, first_centre};
use bytemuck::Zeroable;
use core::ops::Range;

/// Most samples of a pixel.
pub(crate) const MOST_SAMPLES: usize = 8;
/// Most rows in which a small triangle has samples: of 25 px, with a row more at either end.
const ROWS: usize = 27;
/// Most columns: of 60 px, with a column more at either end, and one that the leftmost corner is in.
const COLUMNS: usize = 63;

/// The first column of a span, and the one after the last. There are none if the second is not larger.
type Columns = [u8; 2];

/// Memory for the spans of a triangle.
pub struct SampledSpans<R> {
    /// Columns of each sample, by rows. Those of the centre follow those of the last sample.
    columns: [[Columns; ROWS]; MOST_SAMPLES + 1],
    /// Depths of the samples at the first column of the row.
    depths: [u32; MOST_SAMPLES],
    /// Colours of a row.
    colors: [R; COLUMNS],
}

impl<R: Zeroable + Copy> SampledSpans<R> {
    /// Memory with nothing in it.
    pub(crate) fn new() -> Self {
        Self { columns: [[[0; 2]; ROWS]; _], depths: [0; _], colors: [R::zeroed(); _] }
    }
}

/// A small triangle that is set up.
pub(super) struct SampledTriangle {
    /// x and y of the corners on the left and on the right, relative to the highest one, 24.8.
    pub(super) sides: [i32; 4],
    /// The highest corner, 24.8.
    pub(super) a: (i32, i32),
    /// The first column and row that any sample is in, and the row after the last one.
    pub(super) place: (i32, i32),
    pub(super) end: i32,
    /// Depth at the highest corner, and its changes to the right and down.
    pub(super) depth: u32,
    pub(super) dz: (i32, i32),
}

impl SampledTriangle {
    /// Finds the columns of a sample in each row from the first one on, `columns.len()` rows in all. `to_centre` moves
    /// the sample to the centre of its pixel.
    ///
    /// # Format
    /// A move is below 128: relative to the first column, x is in 0..62 · 2⁸.
    #[inline(never)]
    fn columns(&self, to_centre: (i32, i32), columns: &mut [Columns]) {
        let [bx, by, cx, cy] = self.sides;
        let (column, row) = self.place;
        let (x, y) = (self.a.0 + to_centre.0 - (column << 8), self.a.1 + to_centre.1 - (row << 8));
        // Rows and heights from here on are relative to the first row.
        let top = first_centre(y).max(0);
        let p = 256 * top + 128 - y;
        let (left_end, right_end) = (first_centre(y + by), first_centre(y + cy));
        let (bend, end) = (left_end.min(right_end), left_end.max(right_end));
        let (mut left, mut right) = (ShortEdge::new(x, bx, by, p), ShortEdge::new(x, cx, cy, p));
        for (number, columns) in (0..).zip(columns) {
            if number < top || number >= end {
                *columns = [0; 2];
                continue;
            }
            if number == bend.max(top) {
                let p = 256 * number + 128 - y;
                if right_end < left_end {
                    right = ShortEdge::outlined(x + cx, bx - cx, by - cy, p - cy);
                } else {
                    left = ShortEdge::outlined(x + bx, cx - bx, cy - by, p - by);
                }
            }
            *columns = [left.column() as u8, right.column() as u8];
            left.step();
            right.step();
        }
    }

    /// Returns the depth of a sample at the first column and row.
    ///
    /// # Format
    /// As that of the moved triangle, bit for bit: from the vertex to the centre of its pixel, and from there on.
    #[inline(always)]
    fn depth_at(&self, (x, y): (i32, i32), z: u32) -> u32 {
        let ((dx, dy), (ax, ay)) = (self.dz, (self.a.0 + x, self.a.1 + y));
        let to = (128 - (ax & 0xFF), 128 - (ay & 0xFF));
        let offset = ((dx >> 6) * to.0 + (dy >> 6) * to.1) >> 2;
        z.wrapping_add(offset as u32)
            .wrapping_add_signed(dx.wrapping_mul(self.place.0 - (ax >> 8)))
            .wrapping_add_signed(dy.wrapping_mul(self.place.1 - (ay >> 8)))
    }
}

/// Draws the rows of a triangle.
#[inline(always)]
pub(super) fn draw_sampled_rows<P: PixelFormat, D: DepthTest, R: BrushRows<P, D> + BrushRows<P, DepthOff>>(
    target: &mut SmallTarget<'_, P::Raw>,
    triangle: &SampledTriangle,
    mut rows: R,
    test: D,
) -> SmallResult {
    let SmallTarget { color, depth, samples, moves, spans: Some(spans), first, screen, rows: limits, .. } = target
    else {
        return SmallResult::Large;
    };
    let SampledSpans { columns, depths, colors } = &mut **spans;
    let ((column, row), (dz_dx, dz_dy)) = (triangle.place, triangle.dz);
    let count = (triangle.end.min(limits.end) - row) as usize;
    let places = moves.iter().copied().chain([(0, 0)]);
    for (to_centre, columns) in places.zip(&mut *columns) {
        triangle.columns(to_centre, columns.get_mut(..count).unwrap_or_default());
    }
    for (to_centre, z) in moves.iter().zip(&mut *depths) {
        *z = triangle.depth_at(*to_centre, triangle.depth);
    }
    let width = usize::from(screen.0);
    let mut at = width.wrapping_mul((row - *first) as usize).wrapping_add(column as usize);
    let (length, mut nothing) = (color.len(), [(); usize::MAX]);
    for number in 0..count {
        shade_row::<P, R>(&rows, columns, number, moves, colors);
        for (sample, (z, columns)) in depths.iter_mut().zip(&*columns).take(moves.len()).enumerate() {
            let [from, past] = columns.get(number).copied().unwrap_or_default().map(usize::from);
            if from < past {
                let plane = match sample.checked_sub(1) {
                    None => &mut **color,
                    Some(further) => subslice(samples, further.wrapping_mul(length), length).unwrap_or_default(),
                };
                let (start, length_of) = (at.wrapping_add(from), past - from);
                let depths = D::slots(depth, &mut nothing);
                let depths = subslice(depths, sample.wrapping_mul(length).wrapping_add(start), length_of);
                let (Some(color), Some(depths), Some(shaded)) =
                    (subslice(plane, start, length_of), depths, subslice(colors, from, length_of))
                else {
                    return SmallResult::Drawn;
                };
                copy_tested(color, depths, shaded, z.wrapping_add_signed(dz_dx.wrapping_mul(from as i32)), dz_dx, test);
            }
            *z = z.wrapping_add_signed(dz_dy);
        }
        at = at.wrapping_add(width);
        BrushRows::<P, D>::next_row(&mut rows);
    }
    SmallResult::Drawn
}

/// Shades the pixels of a row that have a covered sample.
#[inline(always)]
fn shade_row<P: PixelFormat, R: BrushRows<P, DepthOff>>(
    rows: &R,
    columns: &[[Columns; ROWS]; MOST_SAMPLES + 1],
    number: usize,
    moves: &[(i32, i32)],
    colors: &mut [P::Raw; COLUMNS],
) {
    let of = |sample: usize| -> Range<u8> {
        let [from, past] = columns.get(sample).and_then(|rows| rows.get(number)).copied().unwrap_or_default();
        from..past
    };
    let mut nothing = [(); COLUMNS];
    let centre = of(moves.len());
    let mut shade = |rows: &R, columns: Range<u8>| {
        let (from, length) = (usize::from(columns.start), columns.len());
        if let (Some(colors), Some(nothing)) = (subslice(colors, from, length), nothing.get_mut(..length)) {
            rows.span(colors, nothing, 0, 0, from as i32, DepthOff);
        }
    };
    if !centre.is_empty() {
        shade(rows, centre.clone());
    }
    for (sample, (x, y)) in moves.iter().enumerate() {
        let covered = of(sample);
        let beside = [covered.start..covered.end.min(centre.start), covered.start.max(centre.end)..covered.end];
        for mut part in if centre.is_empty() { [covered.clone(), 0..0] } else { beside } {
            // Pixels that an earlier sample covers, too, are shaded already.
            while part.start < part.end {
                if !(0..sample).any(|earlier| of(earlier).contains(&part.start)) {
                    let beside = rows.beside((-x, -y));
                    shade(beside.as_ref().unwrap_or(rows), part.start..part.start + 1);
                }
                part.start += 1;
            }
        }
    }
}

/// Copies colours to the samples whose depths pass.
#[inline(never)]
fn copy_tested<R: Copy, D: DepthTest>(
    color: &mut [R],
    depth: &mut [D::Depth],
    shaded: &[R],
    mut z: u32,
    dz_dx: i32,
    test: D,
) {
    for ((color, depth), shaded) in color.iter_mut().zip(depth).zip(shaded) {
        let near = (z >> 16) as u16;
        if test.passes(near, *depth) {
            test.write(near, depth);
            *color = *shaded;
        }
        z = z.wrapping_add_signed(dz_dx);
    }
}
