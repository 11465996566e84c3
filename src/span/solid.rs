//! Spans of one colour.
//!
//! The plain loop:
//!
//! ```text
//! for each pixel:
//!     if z >> 16 passes against the stored depth:
//!         store z >> 16
//!         color = value
//!     z += dz_dx
//! ```
//! The departures from it, with what each gained on a Cortex-M0+ and a Cortex-M4 when it was made. Gains are
//! instructions per pixel of a quad that fills the screen:
//!
//! 1. **Without a depth test, a span is filled** with whole words: see `color/fill.rs`.
//! 2. **Spans of nine pixels and more have a function of their own**, where the loop gets the registers that it needs:
//!    14.14 → 9.72 and 12.77 → 10.08. On small cores it draws runs of 16 pixels, first depths and then colours; on
//!    others four pixels at a time.
//! 3. **Short spans stay in the caller**, because a line draws each of its pixels as a span. A pixel of a thin line:
//!    40.4 → 36.4 and 35.1 → 26.1.

use super::brush::{Brush, BrushRows};
use super::color_setup::ColorSetup;
use super::depth::{DepthTest, RUN, count_passing_prefix};
use super::packed::packed_span;
use super::span::{Primitive, Span};
use crate::color::{PixelFormat, fill, squeeze, unpacked};
use crate::math::SMALL_CORE;
use crate::raster::ShortPlanes;
use core::hint::black_box;

/// Least number of pixels for which a call is worth its cost.
const LONG: usize = 9;

/// Draws a span in the colour that its primitive's word holds.
#[inline]
pub(crate) fn flat_span<P: PixelFormat, D: DepthTest>(span: Span<'_, P, [i32; 0], (), D::Depth>, test: D) {
    let flat = span.primitive.flat;
    if P::DITHER.is_some() {
        return dithered_span(unpacked(flat), span, test);
    }
    let Span { color, depth, z, primitive, .. } = span;
    let value = P::pack(unpacked(flat));
    if !D::ENABLED {
        return fill(color, value);
    }
    value_span(color, depth, z, primitive.dz_dx, value, test);
}

/// Stores one value wherever the depth test passes.
#[inline(always)]
fn value_span<R: Copy, D: DepthTest>(
    color: &mut [R],
    depth: &mut [D::Depth],
    mut z: u32,
    dz_dx: i32,
    value: R,
    test: D,
) {
    if color.len() >= LONG {
        return tested_span(color, depth, z, dz_dx, value, test);
    }
    for (color, depth) in color.iter_mut().zip(depth) {
        let near = (z >> 16) as u16;
        if test.passes(near, *depth) {
            test.write(near, depth);
            *color = value;
        }
        z = z.wrapping_add_signed(dz_dx);
    }
}

/// Draws a small triangle of one value.
pub(crate) struct ValueBrush<R>(pub(crate) R);

impl<P: PixelFormat, D: DepthTest> Brush<P, D> for ValueBrush<P::Raw> {
    const PLANES: bool = false;

    type Rows = Self;

    #[inline(always)]
    fn set_up(&self, _: &ShortPlanes, _: bool, _: (i32, i32), _: i32) -> Option<Self> {
        Some(Self(self.0))
    }

    #[inline(always)]
    fn resume(&self, _: &[u32], _: (i32, i32)) -> Self {
        Self(self.0)
    }
}

impl<P: PixelFormat, D: DepthTest> BrushRows<P, D> for ValueBrush<P::Raw> {
    const WORDS: Option<usize> = Some(0);
    const IS_FLAT: bool = true;

    #[inline(always)]
    fn beside(&self, _: (i32, i32)) -> Self {
        Self(self.0)
    }

    #[inline(always)]
    fn save(&self, _: u32, _: &mut [u32]) {}

    #[inline(always)]
    fn next_row(&mut self) {}

    #[inline(always)]
    fn span(&self, color: &mut [P::Raw], depth: &mut [D::Depth], z: u32, dz_dx: i32, _: i32, test: D) {
        value_span(color, depth, z, dz_dx, self.0, test);
    }
}

/// Draws a span of one colour, in a dithered format.
pub(crate) fn dithered_span<P: PixelFormat, D: DepthTest>(
    rgb: [u8; 3],
    span: Span<'_, P, [i32; 0], (), D::Depth>,
    test: D,
) {
    let Span { color, depth, z, primitive: &Primitive { dz_dx, flat, side, .. }, position } = span;
    let [r, g, b] = rgb;
    let varyings = [squeeze(i32::from(r) << 8), squeeze(i32::from(g) << 8), squeeze(i32::from(b) << 8)];
    let setup = ColorSetup::constant::<P>(varyings);
    let primitive = &Primitive { dz_dx, ..Primitive::constant(varyings, flat, side, setup) };
    packed_span::<P, D>(Span { color, depth, z, primitive, position }, test);
}

/// Stores one value wherever the depth test passes, in a long span. Out of line: next to other code, the loops would
/// not get the registers that they need.
#[inline(never)]
fn tested_span<R: Copy, D: DepthTest>(
    mut color: &mut [R],
    depth: &mut [D::Depth],
    mut z: u32,
    mut dz_dx: i32,
    value: R,
    test: D,
) {
    let Some(mut depth) = depth.get_mut(..color.len()) else { return };
    while SMALL_CORE && color.len() >= RUN {
        let Some((colors, rest)) = core::mem::take(&mut color).split_first_chunk_mut::<RUN>() else { return };
        color = rest;
        let Some((depths, rest)) = core::mem::take(&mut depth).split_first_chunk_mut::<RUN>() else { return };
        depth = rest;
        run16(test, &mut z, dz_dx, value, colors, depths);
    }
    while !SMALL_CORE && color.len() >= 4 {
        // Unrolled by hand: at `opt-level = "s"` a loop would stay a loop.
        let Some(([a, b, c, d], rest)) = core::mem::take(&mut color).split_first_chunk_mut::<4>() else { return };
        color = rest;
        let Some(([az, bz, cz, dz], rest)) = core::mem::take(&mut depth).split_first_chunk_mut::<4>() else { return };
        depth = rest;
        if !draw(test, &mut z, dz_dx, value, a, az) {
            // The black box hides that the step stays the same. The compiler would otherwise prepare all multiples of
            // it, and spill them.
            dz_dx = black_box(dz_dx);
        }
        draw(test, &mut z, dz_dx, value, b, bz);
        draw(test, &mut z, dz_dx, value, c, cz);
        draw(test, &mut z, dz_dx, value, d, dz);
    }
    for (color, depth) in color.iter_mut().zip(depth) {
        draw(test, &mut z, dz_dx, value, color, depth);
    }
}

/// Draws a run, first its depths and then its colours.
#[inline(always)]
fn run16<R: Copy, D: DepthTest>(
    test: D,
    z: &mut u32,
    dz_dx: i32,
    value: R,
    colors: &mut [R; RUN],
    depths: &mut [D::Depth; RUN],
) {
    let passed = count_passing_prefix(test, depths, *z, dz_dx);
    if passed == RUN {
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = colors;
        (*a, *b, *c, *d, *e, *f, *g, *h) = (value, value, value, value, value, value, value, value);
        (*i, *j, *k, *l, *m, *n, *o, *p) = (value, value, value, value, value, value, value, value);
        *z = z.wrapping_add_signed(dz_dx.wrapping_mul(RUN as i32));
        return;
    }
    for (k, (color, depth)) in colors.iter_mut().zip(depths).enumerate() {
        if k < passed {
            *color = value;
            *z = z.wrapping_add_signed(dz_dx);
        } else {
            draw(test, z, dz_dx, value, color, depth);
        }
    }
}

/// Draws a pixel if it passes the depth test, and steps to the next one. Returns whether it passed.
#[inline(always)]
fn draw<R: Copy, D: DepthTest>(
    test: D,
    z: &mut u32,
    dz_dx: i32,
    value: R,
    color: &mut R,
    depth: &mut D::Depth,
) -> bool {
    let near = (*z >> 16) as u16;
    let passes = test.passes(near, *depth);
    if passes {
        test.write(near, depth);
        *color = value;
    }
    *z = z.wrapping_add_signed(dz_dx);
    passes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use crate::span::{DepthLess, naive};

    #[test]
    fn spans_are_those_pixel_by_pixel() {
        let mut rng = Rng::new(1);
        for case in 0..2000 {
            let (z, dz_dx) = (20_000 << 16, rng.next_u32() as i32 >> 20);
            let length = if case % 2 == 0 { RUN } else { rng.below(70) as usize };
            let case = naive::Case { length, z, dz_dx, background: 0_u16 };
            naive::compare(
                DepthLess,
                case,
                &mut rng,
                |depth| depth,
                |_| Some(7),
                &mut [
                    ("run by run", &mut |color, depth| {
                        let mut z = z;
                        for (color, depth) in color.chunks_mut(RUN).zip(depth.chunks_mut(RUN)) {
                            if let (Ok(color), Ok(depth)) = ((&mut *color).try_into(), (&mut *depth).try_into()) {
                                run16(DepthLess, &mut z, dz_dx, 7, color, depth);
                                continue;
                            }
                            for (color, depth) in color.iter_mut().zip(depth) {
                                draw(DepthLess, &mut z, dz_dx, 7, color, depth);
                            }
                        }
                    }),
                    ("a long span", &mut |color, depth| tested_span(color, depth, z, dz_dx, 7, DepthLess)),
                ],
            );
        }
    }
}
