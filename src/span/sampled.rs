//! Small triangles in pixels of several samples: set up once, shaded once per pixel, and tested at each sample.
//!
//! The plain loop:
//!
//! ```text
//! for each band of rows:
//!     for each row: colour the pixels whose centre is covered, and one more at either end
//!     for each sample:
//!         for each row, of the triangle moved so that the sample is at the centre:
//!             colour the pixels that have no colour yet, at the sample
//!             for each pixel:
//!                 if z of the sample passes:
//!                     store it and the pixel's colour
//! ```
//!
//! So neither colours nor texels come from outside of the triangle, and a pixel inside of it has equal samples. A pixel
//! whose centre is not covered gets the colour next to it or, farther from the centres, one of a sample. Moved edges
//! are parallel, so one division serves all of them. A band is as high as there is room for colours; most triangles
//! have one band. `sampled_colors.rs` has the colours of a band, and `sampled_edges.rs` the edges at samples.
//!
//! Brushes of one colour need no colours in between. Brushes whose pixels depend on those that are there, as under
//! blending, and those with transparent pixels shade each sample: at the centre or, where that is not covered, at the
//! sample.

use super::brush::{BrushRows, SmallResult, SmallTarget, subslice};
use super::depth::DepthTest;
use super::sample::Sample;
use super::sampled_colors::{Band, ROWS, shade};
use super::sampled_edges::{Edges, SampledTriangle};
use crate::color::PixelFormat;
use crate::raster::moves;
use bytemuck::Zeroable;
use core::hint::black_box;
use core::ops::Range;

/// Most pixels of a band that are shaded before they are drawn. They are as wide as the triangle, up to 65 px.
const COLORS: usize = 192;
/// That number for triangles with fewer pixels: to clear the memory takes as long as to draw some of them.
const FEW_COLORS: usize = 48;

/// Least number of pixels for which a call is worth its cost.
const LONG: usize = 6;

/// The pixels of one sample, and its move to the centre.
struct SamplePixels<'a, R, Z> {
    sample: Sample,
    color: &'a mut [R],
    depth: &'a mut [Z],
    to_centre: (i32, i32),
    /// Place of the triangle's first column in row 0 of the screen, modulo 2³², and the width of the screen.
    at: usize,
    width: usize,
}

/// Draws the rows of a triangle.
#[inline(never)]
pub(super) fn draw_sampled_rows<P: PixelFormat, D: DepthTest, R: BrushRows<P, D>>(
    target: &mut SmallTarget<'_, P::Raw>,
    triangle: &SampledTriangle,
    rows: &mut R,
    test: D,
) -> SmallResult {
    let edges = &Edges::new(triangle);
    let range = &(triangle.place.1..triangle.past.1.min(target.rows.end));
    if R::IS_FLAT {
        each_sample::<P, D>(target, triangle, |sample| {
            draw_sample::<P, D, R, 0>(sample, triangle, edges, rows, None, range, test);
        });
        return SmallResult::Drawn;
    }
    // One more at either end.
    let width = (triangle.past.0 - triangle.place.0) as usize + 2;
    if !R::SHADES || width.wrapping_mul(range.len()) <= FEW_COLORS {
        draw_bands::<P, D, R, FEW_COLORS>(target, triangle, edges, rows, (range, width), test);
    } else {
        draw_bands::<P, D, R, COLORS>(target, triangle, edges, rows, (range, width), test);
    }
    SmallResult::Drawn
}

/// Draws the rows of a triangle, in bands that are as high as there is room for their colours.
#[inline(never)]
fn draw_bands<P: PixelFormat, D: DepthTest, R: BrushRows<P, D>, const N: usize>(
    target: &mut SmallTarget<'_, P::Raw>,
    triangle: &SampledTriangle,
    edges: &Edges,
    rows: &mut R,
    (range, width): (&Range<i32>, usize),
    test: D,
) {
    let Range { start: mut row, end } = *range;
    let mut band = Band { rows: row..row, width, colored: [[0; 2]; ROWS], colors: [P::Raw::zeroed(); N] };
    let mut height = end - row;
    while R::SHADES && height > 1 && (height as usize).wrapping_mul(width) > N {
        height -= 1;
    }
    while row < end {
        band.rows = row..end.min(row + height);
        let range = &band.rows.clone();
        shade(edges, rows, &mut band);
        each_sample::<P, D>(target, triangle, |sample| {
            draw_sample::<P, D, R, N>(sample, triangle, edges, rows, Some(&mut band), range, test);
        });
        row = range.end;
        if row < end {
            range.clone().for_each(|_| rows.next_row());
            band.colored = [[0; 2]; ROWS];
        }
    }
}

/// Calls a function for each sample.
#[inline(always)]
fn each_sample<P: PixelFormat, D: DepthTest>(
    target: &mut SmallTarget<'_, P::Raw>,
    triangle: &SampledTriangle,
    mut draw: impl FnMut(&mut SamplePixels<'_, P::Raw, D::Depth>),
) {
    let SmallTarget { color, depth, samples, sample, first, screen, .. } = target;
    let count = sample.count();
    let (length, width) = (color.len(), usize::from(screen.0));
    let at = (triangle.place.0 as usize).wrapping_sub(width.wrapping_mul(usize::from(*first)));
    let mut nothing = [(); usize::MAX];
    let (mut color, mut further) = (&mut **color, &mut **samples);
    let mut depth = D::slots(depth, &mut nothing);
    for (number, to_centre) in moves(count).iter().enumerate() {
        let sample = Sample::new(number, count);
        let Some((own, rest)) = core::mem::take(&mut depth).split_at_mut_checked(length) else { return };
        depth = rest;
        draw(&mut SamplePixels { sample, color, depth: own, to_centre: *to_centre, at, width });
        (color, further) = core::mem::take(&mut further).split_at_mut_checked(length).unwrap_or_default();
    }
}

/// Draws the rows of one sample.
#[inline(always)]
fn draw_sample<P: PixelFormat, D: DepthTest, R: BrushRows<P, D>, const N: usize>(
    sample: &mut SamplePixels<'_, P::Raw, D::Depth>,
    triangle: &SampledTriangle,
    edges: &Edges,
    rows: &R,
    mut band: Option<&mut Band<P::Raw, N>>,
    range: &Range<i32>,
    test: D,
) {
    let to_centre = sample.to_centre;
    let Some(mut moved) = edges.moved(to_centre, range) else { return };
    let (mut z, (dz_dx, dz_dy)) = (triangle.depth_at(to_centre, moved.row), triangle.dz);
    let width = sample.width;
    let mut at = sample.at.wrapping_add(width.wrapping_mul(moved.row as usize));
    // Both get one length, so that the compiler knows a span inside of one to be inside of the other.
    let length = sample.color.len().min(sample.depth.len());
    let (Some(colors), Some(depths)) = (sample.color.get_mut(..length), sample.depth.get_mut(..length)) else { return };
    let mut number = (moved.row - range.start) as usize;
    loop {
        if moved.count <= 0 && moved.bend(edges).is_none() {
            return;
        }
        let (from, past) = (moved.left.column(), moved.right.column());
        if from < past {
            let (start, pixels) = (at.wrapping_add(from as usize), (past - from) as usize);
            let (Some(depth), Some(color)) = (subslice(depths, start, pixels), subslice(colors, start, pixels)) else {
                return;
            };
            let z = z.wrapping_add_signed(dz_dx.wrapping_mul(from as i32));
            match &mut band {
                None => rows.span(color, depth, z, dz_dx, from as i32, test),
                Some(band) => {
                    let [start, end] = band.colored.get(number).copied().unwrap_or_default();
                    let (start, end) = (u32::from(start), u32::from(end));
                    if R::SHADES {
                        if start > from + 1 || past >= end {
                            band.color_beside(rows, number, to_centre, from..past);
                        }
                        let cell = number.wrapping_mul(band.width).wrapping_add(from as usize + 1);
                        if let Some(colors) = subslice(&mut band.colors, cell, pixels) {
                            colors_span(colors, color, depth, z, dz_dx, test);
                        }
                    } else {
                        let centre = start..end.saturating_sub(2);
                        Uncolored { sample: sample.sample, color, depth, z, dz_dx, from, centre }
                            .draw(rows, number, to_centre, test);
                    }
                }
            }
        }
        moved.step();
        at = at.wrapping_add(width);
        z = z.wrapping_add_signed(dz_dy);
        number += 1;
    }
}

/// A span of a sample whose pixels are shaded by themselves.
struct Uncolored<'a, R, Z> {
    sample: Sample,
    color: &'a mut [R],
    depth: &'a mut [Z],
    z: u32,
    dz_dx: i32,
    /// The first column, and those whose centres are covered.
    from: u32,
    centre: Range<u32>,
}

impl<Raw: Copy, Z: Copy> Uncolored<'_, Raw, Z> {
    /// Draws the span, in a row of the band.
    #[inline(never)]
    fn draw<P: PixelFormat<Raw = Raw>, D: DepthTest<Depth = Z>, R: BrushRows<P, D>>(
        self,
        rows: &R,
        number: usize,
        (x, y): (i32, i32),
        test: D,
    ) {
        let Self { sample, mut color, mut depth, mut z, dz_dx, mut from, centre } = self;
        let past = from.wrapping_add(color.len() as u32);
        let (inner, outer) = (centre.start.max(from), centre.end.min(past));
        // Without a centre, all of it is beside.
        let ends = if inner < outer { [inner, outer, past] } else { [past, past, past] };
        for (end, is_inner) in ends.into_iter().zip([false, true, false]) {
            let pixels = end.wrapping_sub(from) as usize;
            if pixels == 0 {
                continue;
            }
            let Some((part, rest)) = color.split_at_mut_checked(pixels) else { return };
            let Some((depths, depth_rest)) = depth.split_at_mut_checked(pixels) else { return };
            let mut rows = rows.beside(if is_inner { (0, 0) } else { (-x, -y) });
            for _ in 0..number {
                rows.next_row();
            }
            rows.span_at(sample, part, depths, (z, dz_dx), from as i32, test);
            (color, depth, from) = (rest, depth_rest, end);
            z = z.wrapping_add_signed(dz_dx.wrapping_mul(pixels as i32));
        }
    }
}

/// Stores colours wherever the depth test passes.
#[inline(always)]
fn colors_span<R: Copy, D: DepthTest>(
    from: &[R],
    color: &mut [R],
    depth: &mut [D::Depth],
    mut z: u32,
    dz_dx: i32,
    test: D,
) {
    if from.len() >= LONG {
        return long_colors_span(from, color, depth, z, dz_dx, test);
    }
    for ((color, depth), from) in color.iter_mut().zip(depth).zip(from) {
        let near = (z >> 16) as u16;
        if test.passes(near, *depth) {
            test.write(near, depth);
            *color = *from;
        }
        z = z.wrapping_add_signed(dz_dx);
    }
}

/// Stores colours wherever the depth test passes, in a long span. Out of line: next to other code, the loop would not
/// get the registers that it needs.
#[inline(never)]
fn long_colors_span<R: Copy, D: DepthTest>(
    mut from: &[R],
    mut color: &mut [R],
    mut depth: &mut [D::Depth],
    mut z: u32,
    mut dz_dx: i32,
    test: D,
) {
    // Unrolled by hand: at `opt-level = "s"` a loop would stay a loop.
    macro_rules! draw {
        ($($color:ident $depth:ident $from:ident)*) => {
            let Some(([$($color),*], rest)) = core::mem::take(&mut color).split_first_chunk_mut() else { return };
            color = rest;
            let Some(([$($depth),*], rest)) = core::mem::take(&mut depth).split_first_chunk_mut() else { return };
            depth = rest;
            let Some(([$($from),*], rest)) = from.split_first_chunk() else { return };
            from = rest;
            $(
                let near = (z >> 16) as u16;
                if test.passes(near, *$depth) {
                    test.write(near, $depth);
                    *$color = *$from;
                } else {
                    // The black box hides that the step stays the same. The compiler would otherwise prepare all
                    // multiples of it, and spill them.
                    dz_dx = black_box(dz_dx);
                }
                z = z.wrapping_add_signed(dz_dx);
            )*
        };
    }
    let (Some(colors), Some(depths)) = (color.get_mut(..from.len()), depth.get_mut(..from.len())) else { return };
    (color, depth) = (colors, depths);
    while color.len() >= 4 {
        draw!(a az from_a b bz from_b c cz from_c d dz from_d);
    }
    if color.len() >= 2 {
        draw!(a az from_a b bz from_b);
    }
    if !color.is_empty() {
        draw!(a az from_a);
    }
    let _ = (color, depth, from, z, dz_dx);
}
