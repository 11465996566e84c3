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
//! So neither colours nor texels come from outside of the triangle, and a pixel inside of it has equal samples. A pixel
//! whose centre is not covered gets the colour next to it or, farther from the centres, one of a sample. Moved edges
//! are parallel, so one division serves all of them. A band is as high as there is room for colours; most triangles
//! have one band.
//!
//! Brushes of one colour need no colours in between. Brushes whose pixels depend on those that are there, as under
//! blending, and those with transparent pixels shade each sample: at the centre or, where that is not covered, at the
//! sample.

use super::brush::{BrushRows, SmallResult, SmallTarget, subslice};
use super::depth::DepthTest;
use super::sample::Sample;
use crate::color::PixelFormat;
use crate::raster::{ShortEdge, ShortSlope, first_centre, moves};
use bytemuck::Zeroable;
use core::hint::black_box;
use core::ops::Range;

/// Most rows in which a triangle has samples: of 25 px, and one more at either end.
const ROWS: usize = 27;

/// Most pixels of a band that are shaded before they are drawn. They are as wide as the triangle, up to 65 px.
const COLORS: usize = 192;
/// That number for triangles with fewer pixels: to clear the memory takes as long as to draw some of them.
const FEW_COLORS: usize = 48;

/// Least number of pixels for which a call is worth its cost.
const LONG: usize = 6;

/// A small triangle that is set up.
pub(super) struct SampledTriangle {
    /// x and y of the corners on the left and on the right, relative to the highest one, 24.8.
    pub(super) sides: [i32; 4],
    /// The highest corner, 24.8.
    pub(super) a: (i32, i32),
    /// The first column and row that any sample may be in, and the column and row after the last ones.
    pub(super) place: (i32, i32),
    pub(super) past: (i32, i32),
    /// Depth at the highest corner, and its changes to the right and down.
    pub(super) depth: u32,
    pub(super) dz: (i32, i32),
}

/// The edges of a triangle, for all samples.
struct Edges {
    /// Directions from the highest corner to those on the left and on the right, and between these.
    left: ShortSlope,
    right: ShortSlope,
    second: ShortSlope,
    /// The corner at the bend, relative to the highest one, 24.8, and whether it is on the right.
    bend: (i32, i32),
    bends_right: bool,
    /// The height of the triangle.
    height: i32,
    /// The highest corner, with x relative to the first column.
    a: (i32, i32),
}

/// The edges of a triangle that is moved for a sample, in some rows.
struct Moved {
    left: ShortEdge,
    right: ShortEdge,
    /// The first row.
    row: i32,
    /// Numbers of rows before the bend, which may be negative, and from there on.
    count: i32,
    rest: i32,
    /// The edge from the bend on begins at this place, and this far above the first row at the bend.
    second: (i32, i32),
}

impl Edges {
    fn new(triangle: &SampledTriangle) -> Self {
        let [bx, by, cx, cy] = triangle.sides;
        let bends_right = cy < by;
        let (bend, (dx, dy)) =
            if bends_right { ((cx, cy), (bx - cx, by - cy)) } else { ((bx, by), (cx - bx, cy - by)) };
        Self {
            left: ShortSlope::new(bx, by),
            right: ShortSlope::new(cx, cy),
            second: ShortSlope::new(dx, dy),
            bend,
            bends_right,
            height: by.max(cy),
            a: (triangle.a.0 - (triangle.place.0 << 8), triangle.a.1),
        }
    }

    /// Returns the edges in some rows, moved by so much; `None` if the triangle is in none of them.
    ///
    /// # Format
    /// A move is below 128: relative to the first column, x is in 0..62 · 2⁸.
    #[inline(always)]
    fn moved(&self, by: (i32, i32), rows: &Range<i32>) -> Option<Moved> {
        let (x, y) = (self.a.0 + by.0, self.a.1 + by.1);
        let row = first_centre(y).max(rows.start);
        let end = first_centre(y + self.height).min(rows.end);
        if row >= end {
            return None;
        }
        let p = 256 * row + 128 - y;
        let count = first_centre(y + self.bend.1).min(end) - row;
        let second = (x + self.bend.0, p + 256 * count.max(0) - self.bend.1);
        let (left, right) = (self.left.edge(x, p), self.right.edge(x, p));
        Some(Moved { left, right, row, count, rest: end - row - count, second })
    }
}

impl Moved {
    /// Goes on to the rows from the bend on. Returns `None` if there are none.
    #[inline(always)]
    fn bend(&mut self, edges: &Edges) -> Option<()> {
        if self.rest <= 0 {
            return None;
        }
        (self.count, self.rest) = (self.count + self.rest, 0);
        let (x, p) = self.second;
        let second = edges.second.edge(x, p);
        if edges.bends_right {
            self.right = second;
        } else {
            self.left = second;
        }
        Some(())
    }

    /// Goes one row down.
    #[inline(always)]
    const fn step(&mut self) {
        self.left.step();
        self.right.step();
        self.count -= 1;
    }
}

impl SampledTriangle {
    /// Returns the depth of a sample at the first column and at a row.
    ///
    /// # Format
    /// As that of the moved triangle, bit for bit: from the vertex to the centre of its pixel, and from there on.
    #[inline(always)]
    fn depth_at(&self, (x, y): (i32, i32), row: i32) -> u32 {
        let ((dx, dy), (ax, ay)) = (self.dz, (self.a.0 + x, self.a.1 + y));
        let to = (128 - (ax & 0xFF), 128 - (ay & 0xFF));
        let offset = ((dx >> 6) * to.0 + (dy >> 6) * to.1) >> 2;
        self.depth
            .wrapping_add(offset as u32)
            .wrapping_add_signed(dx.wrapping_mul(self.place.0 - (ax >> 8)))
            .wrapping_add_signed(dy.wrapping_mul(row - (ay >> 8)))
    }
}

/// Rows of a triangle, and the colours of their pixels.
struct Band<R, const N: usize> {
    rows: Range<i32>,
    /// Columns of each row that have a colour, one column more than their number. At first, these are the ones in which
    /// the centre is covered, and one more at either end, with the colour next to it.
    colored: [[u8; 2]; ROWS],
    /// Number of columns, one more at either end.
    width: usize,
    /// Colours, from the column before the first one of the first row on.
    colors: [R; N],
}

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

/// Finds the columns of a band in which centres are covered, and colours them.
#[inline(never)]
fn shade<P: PixelFormat, D: DepthTest, R: BrushRows<P, D>, const N: usize>(
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
    fn color_beside<P: PixelFormat<Raw = Raw>, D: DepthTest, R: BrushRows<P, D>>(
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
