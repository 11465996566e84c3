//! Small triangles → pixels: set-up, edges, rows and pixels in one function with few live values. Vertices are read
//! where the vertex stage left them, and a brush draws the spans.
//!
//! The plain loop:
//!
//! ```text
//! depth, brush: planes through the corners
//! left, right: edges from the highest corner
//! for each row:
//!     draw left..right
//!     at the bend: a new edge on one side
//! ```
//! Some brushes draw tall triangles, too, whose edges are made anew every 16 rows.
//!
//! A triangle is small or not by its vertices and the columns of the viewport alone; neither strips nor records take
//! part in the decision. Coverage and depth are, bit for bit, those of the way that large triangles take.

use super::brush::{Brush, BrushRows, SmallResult, SmallTarget, SmallTriangle, subslice};
use super::carried::{
    CARRIED, STATE_UNIT, TriangleAtRow, column_and_slopes, count_row, edge_from_bend, edges_and_depth, goes_on,
    set_edges_and_depth, take_rows,
};
use super::depth::DepthTest;
use super::depth_bias::{BiasSteps, DepthBias};
use super::sample::Sample;
use super::sampled::draw_sampled_rows;
use super::sampled_edges::SampledTriangle;
use crate::color::PixelFormat;
use crate::raster::{
    HEIGHT, SUM, ShortEdge, ShortPlanes, TALL, WIDTH, edge_at, first_centre, gradients, moves, sampled, tall_edges,
};
use crate::vertex::PackedVertex;
use core::ops::Range;

impl<P: PixelFormat, D: DepthTest> SmallTriangle<'_, '_, P, D> {
    /// Draws the triangle with a brush, if it is small.
    #[inline(always)]
    pub(crate) fn draw<B: Brush<P, D>>(self, brush: &B) -> SmallResult {
        let [a, b, c] = self.v;
        if D::SAMPLED && B::SHIFTS {
            return draw_small::<P, D, B, false, true>(self.target, a, b, c, brush, self.test);
        }
        if D::SAMPLED {
            return draw_samples(self.target, [a, b, c], brush, self.test);
        }
        match self.state {
            None => {
                let result = draw_small::<P, D, B, false, false>(self.target, a, b, c, brush, self.test);
                if B::TALL && result == SmallResult::Large && is_tall([a, b, c]) {
                    return draw_small::<P, D, B, true, false>(self.target, a, b, c, brush, self.test);
                }
                result
            }
            Some(state) => {
                if D::CARRIES {
                    go_on(self.target, state, brush, self.test);
                }
                SmallResult::Drawn
            }
        }
    }
}

/// Returns whether a triangle has the height of a tall one.
#[inline(always)]
fn is_tall([a, b, c]: [&[u32; 2]; 3]) -> bool {
    let height = |v: &[u32; 2]| PackedVertex(*v).y() - PackedVertex(*a).y();
    (HEIGHT + 1..=TALL).contains(&height(b).max(height(c)))
}

/// Draws a triangle with its highest corner first, if it is small, at each sample: an ordinary triangle that is moved.
///
/// Moves change nothing that decides whether a triangle is small, but for the columns of the viewport. These are
/// compared with the columns of all samples first. So all samples are drawn, or none.
#[inline(never)]
fn draw_samples<P: PixelFormat, D: DepthTest, B: Brush<P, D>>(
    target: &mut SmallTarget<'_, P::Raw>,
    v: [&[u32; 2]; 3],
    brush: &B,
    test: D,
) -> SmallResult {
    let SmallTarget { color, depth, samples, sample, first, columns, rows, screen, clockwise_fronts, bias, .. } =
        target;
    let count = sample.count();
    let [a, b, c] = v.map(|words| PackedVertex(*words).x());
    let all = sampled(a.min(b).min(c), a.max(b).max(c), count);
    if all.start < columns.start || all.end > columns.end {
        return SmallResult::Large;
    }
    let length = color.len();
    let mut result = SmallResult::Empty;
    for (sample, (x, y)) in moves(count).iter().enumerate() {
        let color = match sample.checked_sub(1) {
            None => &mut **color,
            Some(further) => subslice(samples, further.wrapping_mul(length), length).unwrap_or_default(),
        };
        let depth = subslice(depth, sample.wrapping_mul(length), length).unwrap_or_default();
        // The move changes no depth, because it leaves out the lowest byte of both words.
        let [a, b, c] = v.map(|[to_x, to_y]| [to_x.wrapping_add_signed(x << 8), to_y.wrapping_add_signed(y << 8)]);
        let target = &mut SmallTarget {
            color,
            depth,
            samples: &mut [],
            sample: Sample::new(sample, count),
            first: *first,
            columns: columns.clone(),
            rows: rows.clone(),
            screen: *screen,
            clockwise_fronts: *clockwise_fronts,
            bias: *bias,
            state: None,
        };
        match draw_small::<P, D, B, false, false>(target, &a, &b, &c, brush, test) {
            SmallResult::Large => return SmallResult::Large,
            SmallResult::Drawn => result = SmallResult::Drawn,
            SmallResult::Outside if result == SmallResult::Empty => result = SmallResult::Outside,
            SmallResult::Outside | SmallResult::Empty => {}
        }
    }
    result
}

/// Draws a triangle with its highest corner first, if it is small. Edges of a tall one are made anew every 16 rows.
/// `SAMPLED` says that pixels have several samples.
///
/// # Format
/// Differences of depths are below 2¹⁶, and sides at most 60 · 2⁸: determinants are below 2 · 65,535 · 60 · 2⁸ < 2³¹.
/// The planes' gradients are below 2²⁸.
#[inline(never)]
fn draw_small<P: PixelFormat, D: DepthTest, B: Brush<P, D>, const IS_TALL: bool, const SAMPLED: bool>(
    target: &mut SmallTarget<'_, P::Raw>,
    a: &[u32; 2],
    b: &[u32; 2],
    c: &[u32; 2],
    brush: &B,
    test: D,
) -> SmallResult {
    let (a, b, c) = (PackedVertex(*a), PackedVertex(*b), PackedVertex(*c));
    let (ax, ay) = (a.x(), a.y());
    let (mut by, mut cy) = (b.y() - ay, c.y() - ay);
    let highest = if IS_TALL { TALL } else { HEIGHT };
    if (by as u32 > highest as u32) | (cy as u32 > highest as u32) {
        return SmallResult::Large;
    }
    let (mut bx, mut cx) = (b.x() - ax, c.x() - ax);
    let (least, most) = (bx.min(cx).min(0), bx.max(cx).max(0));
    let first = |coordinate| if SAMPLED { sampled(coordinate, 0, 2).start } else { first_centre(coordinate) };
    let after = |coordinate| if SAMPLED { sampled(0, coordinate, 2).end } else { first_centre(coordinate) };
    let (start, past) = (first(ax + least), after(ax + most));
    if most - least > WIDTH || start < target.columns.start || past > target.columns.end {
        return SmallResult::Large;
    }
    if IS_TALL && most - least + by.max(cy) > SUM {
        return SmallResult::Large;
    }
    let (top, end) = (first(ay), after(ay + by.max(cy)));
    let area = bx * cy - cx * by;
    if start >= past || top >= end || area == 0 {
        return SmallResult::Empty;
    }
    let row = top.max(target.rows.start);
    if row >= end.min(target.rows.end) {
        return SmallResult::Outside;
    }
    // Edges of samples to the left of the centre begin further left, by at most 112 / 256 px.
    let column = (ax + least - if SAMPLED { 112 } else { 0 }) >> 8;
    let (z, mut bz, mut cz) = (a.z(), b.z(), c.z());
    // From here on, b is on the left and c on the right.
    let swapped = area > 0;
    if swapped {
        (bx, by, bz, cx, cy, cz) = (cx, cy, cz, bx, by, bz);
    }
    // Depth at the first pixel, with the half that rounds.
    let (dz_b, dz_c) = (bz - z, cz - z);
    let mut depth = ((z << 16) as u32).wrapping_add(1 << 15);
    let (mut dz_dx, mut dz_dy) = (0, 0);
    let (right, down) = (column - (ax >> 8), row - (ay >> 8));
    let to = (128 - (ax & 0xFF), 128 - (ay & 0xFF));
    let mut planes =
        ShortPlanes { b: (bx, by), c: (cx, cy), to: (to.0 + 256 * right, to.1 + 256 * down), reciprocal: 0, shift: 0 };
    if B::PLANES || dz_b | dz_c != 0 {
        (planes.reciprocal, planes.shift) = ShortPlanes::inverse(area.unsigned_abs());
        let (n, m) = planes.numerators(dz_b, dz_c);
        // 2²⁴ n / area.
        let Some((dx, dy)) = gradients(n, m, planes.reciprocal, planes.shift as i32 - 7) else {
            // Nearly all of these are seen edge on, and have no pixel.
            let rows = row..end.min(target.rows.end);
            let covers = if SAMPLED {
                covers_samples([bx, by, cx, cy], (ax - (column << 8), ay), &rows, target.sample.count())
            } else {
                IS_TALL || covers_pixels([bx, by, cx, cy], ax - (column << 8), 256 * row + 128 - ay, rows.len())
            };
            return if covers { SmallResult::Large } else { SmallResult::Drawn };
        };
        (dz_dx, dz_dy) = (dx, dy);
        // As `Gradients` has it: from the vertex to the centre of its pixel, and from there on.
        let offset = ((dx >> 6) * to.0 + (dy >> 6) * to.1) >> 2;
        // Samples go from the vertex to places of their own.
        if !SAMPLED {
            depth = depth
                .wrapping_add(offset as u32)
                .wrapping_add_signed(dx.wrapping_mul(right))
                .wrapping_add_signed(dy.wrapping_mul(down));
        }
    }
    if let Some(bias) = &target.bias {
        depth = depth.wrapping_add(biased(bias, [z, bz, cz], dz_dx, dz_dy));
    }
    let Some(mut rows) = brush.set_up(&planes, swapped, (column, row), dz_dx) else { return SmallResult::Large };
    if SAMPLED {
        let triangle = SampledTriangle {
            sides: [bx, by, cx, cy],
            a: (ax, ay),
            place: (column, row),
            past: (past, end),
            depth,
            dz: (dz_dx, dz_dy),
        };
        return draw_sampled_rows(target, &triangle, &mut rows, test);
    }
    let sides = core::hint::black_box([bx, by, cx, cy]);
    let start = ax - (column << 8);
    let p = 256 * row + 128 - ay;
    let (left_end, right_end) =
        (first_centre(ay + by).min(target.rows.end), first_centre(ay + cy).min(target.rows.end));
    let (mut left, mut right) = (ShortEdge::new(start, bx, by, p), ShortEdge::new(start, cx, cy, p));
    if D::CARRIES
        && !IS_TALL
        && end > target.rows.end
        && let Some(length) = B::Rows::WORDS
    {
        let below = target.rows.end - row;
        let triangle = TriangleAtRow { sides, x: start, p, column, edges: [left, right], depth, dz: (dz_dx, dz_dy) };
        if let Some(left) = &mut target.state
            && let Some((words, state)) = left.words.split_first_chunk_mut()
        {
            triangle.store(below, words);
            rows.save(below as u32, state);
            left.length = (CARRIED + length).next_multiple_of(STATE_UNIT);
        }
    }
    let width = usize::from(target.screen.0);
    let mut at = width.wrapping_mul((row - i32::from(target.first)) as usize).wrapping_add(column as usize);
    // Both get one length, so that the compiler knows a span inside of one to be inside of the other.
    let mut nothing = [(); usize::MAX];
    let (colors, depths) = (&mut *target.color, D::slots(target.depth, &mut nothing));
    let length = colors.len().min(depths.len());
    let (Some(colors), Some(depths)) = (colors.get_mut(..length), depths.get_mut(..length)) else {
        return SmallResult::Drawn;
    };
    // A single row may be shorter than the screen. (The first column may be -1, without a pixel in it.)
    let limit = if length < width { (length as i32 - column).clamp(0, 63) as u32 } else { 63 };
    right.limit(limit);
    // Rows before the bend, and those from there on.
    let bend = left_end.min(right_end) - row;
    let (mut count, mut rest) = (bend, left_end.max(right_end) - row - bend);
    let all = count + rest;
    if IS_TALL {
        (count, rest) = (0, all);
    }
    loop {
        if count <= 0 {
            if rest <= 0 {
                return SmallResult::Drawn;
            }
            let [bx, by, cx, cy] = sides;
            if IS_TALL {
                ([left, right], count) = tall_edges([bx, by, cx, cy], start, p + 256 * (all - rest), rest);
                right.limit(limit);
                rest -= count;
                continue;
            }
            (count, rest) = (count + rest, 0);
            let p = p + 256 * bend.max(0);
            if right_end < left_end {
                right = ShortEdge::outlined(start + cx, bx - cx, by - cy, p - cy);
                right.limit(limit);
            } else {
                left = ShortEdge::outlined(start + bx, cx - bx, cy - by, p - by);
            }
        }
        let columns = left.column()..right.column();
        if draw_span(&rows, target.sample, (colors, depths), at, columns, (depth, dz_dx), test).is_none() {
            return SmallResult::Drawn;
        }
        left.step();
        right.step();
        at = at.wrapping_add(width);
        depth = depth.wrapping_add_signed(dz_dy);
        rows.next_row();
        count -= 1;
    }
}

/// Draws the rows of a triangle from the strip above that are in this strip, and leaves its state below them.
#[inline(never)]
fn go_on<P: PixelFormat, D: DepthTest, B: Brush<P, D>>(
    target: &mut SmallTarget<'_, P::Raw>,
    state: &mut [u32],
    brush: &B,
    test: D,
) {
    let Some((words, state)) = state.split_first_chunk_mut::<CARRIED>() else { return };
    let (mut left, mut right, mut depth) = edges_and_depth(words);
    let (column, dz_dx, dz_dy) = column_and_slopes(words);
    let mut rows = brush.resume(state, (column, target.rows.start));
    let width = usize::from(target.screen.0);
    let mut at =
        width.wrapping_mul((target.rows.start - i32::from(target.first)) as usize).wrapping_add(column as usize);
    // Both get one length, so that the compiler knows a span inside of one to be inside of the other.
    let mut nothing = [(); usize::MAX];
    let (colors, depths) = (&mut *target.color, D::slots(target.depth, &mut nothing));
    let length = colors.len().min(depths.len());
    let (Some(colors), Some(depths)) = (colors.get_mut(..length), depths.get_mut(..length)) else { return };
    let mut count = take_rows(words, target.rows.end - target.rows.start);
    while count > 0 {
        if let Some((edge, is_right)) = edge_from_bend(words) {
            *if is_right { &mut right } else { &mut left } = edge;
        }
        let columns = left.column()..right.column();
        if draw_span(&rows, target.sample, (colors, depths), at, columns, (depth, dz_dx), test).is_none() {
            break;
        }
        left.step();
        right.step();
        at = at.wrapping_add(width);
        depth = depth.wrapping_add_signed(dz_dy);
        rows.next_row();
        count_row(words);
        count -= 1;
    }
    if goes_on(words) {
        set_edges_and_depth(words, left, right, depth);
        rows.save(0, state);
    }
}

/// Draws the span of a row in which the first column is pixel `at`. `depth` is the depth there, and its change. Returns
/// `None` if the target ends before the span does.
#[inline(always)]
fn draw_span<P: PixelFormat, D: DepthTest, R: BrushRows<P, D>>(
    rows: &R,
    sample: Sample,
    (colors, depths): (&mut [P::Raw], &mut [D::Depth]),
    at: usize,
    columns: Range<u32>,
    (depth, dz_dx): (u32, i32),
    test: D,
) -> Option<()> {
    let Range { start: from, end: past } = columns;
    if from < past {
        let (start, length) = (at.wrapping_add(from as usize), (past - from) as usize);
        let depths = subslice(depths, start, length)?;
        let colors = subslice(colors, start, length)?;
        let z = depth.wrapping_add_signed(dz_dx.wrapping_mul(from as i32));
        if D::SAMPLED {
            rows.span_at(sample, colors, depths, (z, dz_dx), from as i32, test);
        } else {
            rows.span(colors, depths, z, dz_dx, from as i32, test);
        }
    }
    Some(())
}

/// Returns whether a triangle that is not tall covers a pixel in some rows. Its highest corner is at `x`, relative to
/// the first column; the others are relative to it, with that on the left first. The first row's centres are `p` below
/// it. All in 24.8.
#[inline(never)]
fn covers_pixels(sides: [i32; 4], x: i32, p: i32, rows: usize) -> bool {
    let [_, by, _, cy] = sides;
    let (mut y, end) = (p, p + 256 * rows as i32);
    while y < end {
        // Down to the bend, or from there on.
        let bend = by.min(cy);
        let stop = if y < bend { bend.min(end) } else { end };
        let (mut left, mut right) = (edge_at(sides, x, y, false), edge_at(sides, x, y, true));
        while y < stop {
            if left.column() < right.column() {
                return true;
            }
            left.step();
            right.step();
            y += 256;
        }
    }
    false
}

/// Returns whether a triangle that is not tall covers a sample in some rows. Its highest corner is at `a`, with x
/// relative to the first column; the others are relative to it, with that on the left first. All in 24.8.
#[inline(never)]
fn covers_samples(sides: [i32; 4], a: (i32, i32), rows: &Range<i32>, samples: usize) -> bool {
    let [_, by, _, cy] = sides;
    moves(samples).iter().any(|to_centre| {
        let (x, y) = (a.0 + to_centre.0, a.1 + to_centre.1);
        let (row, end) = (first_centre(y).max(rows.start), first_centre(y + by.max(cy)).min(rows.end));
        covers_pixels(sides, x, 256 * row + 128 - y, (end - row).max(0) as usize)
    })
}

/// Returns what a bias adds to the depths of a triangle with these depths, 16.16.
#[inline(never)]
pub(crate) fn biased((steps, bias): &(BiasSteps, DepthBias), [a, b, c]: [i32; 3], dz_dx: i32, dz_dy: i32) -> u32 {
    let depths = a.min(b).min(c) as u16..a.max(b).max(c) as u16;
    (steps(*bias, depths, dz_dx, dz_dy) as u32) << 16
}
