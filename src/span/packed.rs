//! Spans whose three channels are interpolated linearly, in formats of at most 6 bits per channel.
//!
//! The plain loop, over channels in 8.16:
//!
//! ```text
//! for each pixel:
//!     if z >> 16 passes against the stored depth:
//!         store z >> 16
//!         color = pack(r >> 16, g >> 16, b >> 16)
//!     z += dz_dx;  r += dr;  g += dg;  b += db
//! ```
//! The departures from it, with what each gained on a Cortex-M0+ and a Cortex-M4 when it was made. W2 is a quad that
//! fills the screen, in instructions per pixel. W5 is a torus with short spans, in millions of instructions per frame.
//!
//! 1. **One word holds all channels**: one addition per pixel, and no shifts except those of the format. Together with
//!    a loop over rows of its own: W2 39.7 → 25.2 and 26.8 → 19.5.
//! 2. **Runs of 16 pixels are drawn in two passes**: first the depths and, if all pass, then the colours. Each pass has
//!    all of its values in registers: W2 25.4 → 19.3 and 19.0 → 14.7. If some pixels of a run fail, the run is drawn
//!    pixel by pixel.
//! 3. **Short spans have loops of their own**, unrolled by 8, 4, 2 and 1. They are out of line, and compute their
//!    channels themselves, because half of a torus's spans have at most three pixels: W5 2.89 → 2.46 and 2.06 → 1.75.
//!    Cores with many registers draw them in one pass, others in two.
//! 4. **The tail of a span is tested like a run**, without a loop: W5 2.490 → 2.462 on a Cortex-M0+.
//!
//! | pixels of a span | small cores | others |
//! |---|---|---|
//! | 1 | in the caller | in the caller |
//! | 2 to 15 | depths, then colours, each out of line | in one pass, out of line |
//! | 16 and more | runs of 16, depths and then colours; the tail as above | |

use super::color_setup::{ColorSetup, GROUP};
use super::depth::{DepthOff, DepthTest, count_passing_prefix, untested_short_tail};
use super::span::{Primitive, Span};
use crate::color::{PixelFormat, spread, spread_step, word};
use crate::math::SMALL_CORE;
use crate::vertex::Varyings;
use core::hint::black_box;

const RUN: usize = super::depth::RUN;

/// A primitive whose varyings are colours.
type Colored = Primitive<[i32; 3], ColorSetup>;

/// Packs the bits that a word of channels leaves out: the upper 9 or 10 of them for each channel. Above each channel is
/// one bit for the carry into the word.
///
/// ```text
/// bits   31      30 .. 21   20      19 .. 11   10      9 .. 0
///        carry   red        carry   blue       carry   green
/// ```
#[inline(always)]
const fn low([r, g, b]: [i32; 3]) -> u32 {
    (r as u32 >> 3 & 0x3FF) << 21 | (b as u32 >> 4 & 0x1FF) << 11 | g as u32 >> 4 & 0x3FF
}

/// Half of a unit of [`low`] in each channel, which is added to round to these units.
const LOW_HALVES: [i32; 3] = [4, 8, 8];

/// Shift that moves the carries of [`low`] to the units of the word that they are added to; [`UNITS`] are these units.
const CARRY: u32 = 10;
const UNITS: u32 = 1 << 21 | 1 << 10 | 1;

/// Number of pixels after which the word is computed anew from the planes. It is a multiple of a run's length, and of
/// the 8 columns after which dithering repeats.
const LONG: usize = 512;

/// Draws a span with one addition per pixel for all three channels, in formats of at most 6 bits per channel.
///
/// ```text
/// pixels      0 1 2 3   4 5 6 7   8 9 ..    12 ..     16 ..
/// word made   step      group     eight     group     run
/// ```
/// # Format
/// Steps of 1, 4 and 8 pixels are rounded to units of the word: 8.3, or 8.2 for green. Let x be the error of a step of
/// one pixel in these units. The step of 4 pixels is then off by d(4 x), the distance of 4 x from an integer, and the
/// step of 8 pixels by d(8 x). A pixel of a run is off by at most 3 |x| + d(4 x) + d(8 x). That is 33/16 for x = 7/16,
/// and less for any other x. Channels are moved so that the error is 0 in the middle of the run. The error that is left
/// is half of the sum: 0.26 for green, 0.13 for the others.
///
/// From run to run, words are stepped with 9 more bits: over [`LONG`] pixels that is off by less than 2⁻⁷. With the
/// rounding of the word, the error is below 0.39. Squeezed channels are off by at most 1/2, and those from the records
/// by 1/16 more (by 1/8 for red, which the word of a span holds in finer units than green). In all, a channel is within
/// 1 of 255 before its lower bits are cut. And 0.5..=254.5 is far enough from the ends that no channel runs into its
/// neighbour.
#[inline(always)]
pub(crate) fn packed_span<P: PixelFormat, D: DepthTest>(span: Span<'_, P, [i32; 3], ColorSetup, D::Depth>, test: D) {
    draw_span::<P, D, SMALL_CORE>(span, test);
}

/// Draws a span. Pixels that do not fill a run are drawn in one loop or, with `TWO_PASS`, in two: first depths and then
/// colours. Each of the two loops has its values and parameters in registers, even on a core with few.
#[inline(always)]
fn draw_span<P: PixelFormat, D: DepthTest, const TWO_PASS: bool>(
    span: Span<'_, P, [i32; 3], ColorSetup, D::Depth>,
    test: D,
) {
    let Span { color, depth, z, primitive, position } = span;
    let (x, y) = position;
    if let ([color], [depth]) = (&mut *color, &mut *depth) {
        // A single pixel: the tip of a triangle.
        let word = word_at::<P>(primitive, x, y);
        // On small cores, the triangle's mask would be kept on the stack, so they make a new one.
        let mask = if SMALL_CORE { P::packed_mask() } else { primitive.setup.mask };
        return SpanCursor { z, dz_dx: 0, word, step: 0, mask }.dot::<P, D>(test, position, color, depth);
    }
    // Short spans are passed only what they need.
    if color.len() >= RUN {
        draw_runs::<P, D, TWO_PASS>(test, depth, z, primitive, color, x, y);
    } else if !TWO_PASS {
        draw_short_at::<P, D>(test, depth, z, primitive, color, x, y);
    } else {
        match untested_short_tail(test, depth, z, primitive.dz_dx) {
            0 => color_short_at::<P>(color, primitive, x, y),
            untested => draw_partial_at::<P, D>(test, depth, z, primitive, color, x, y, untested),
        }
    }
}

/// Computes the word of a pixel. Out of line: a loop over rows would otherwise keep the values that this takes on its
/// stack.
#[inline(never)]
fn word_at<P: PixelFormat>(primitive: &Colored, x: i32, y: i32) -> u32 {
    word(channels_at::<P>(primitive, x, y))
}

/// Computes the moved channels of a pixel, scaled to leave room for dithering.
#[inline(always)]
fn channels_at<P: PixelFormat>(primitive: &Colored, x: i32, y: i32) -> [i32; 3] {
    let mut channels = primitive.setup.at_origin;
    channels.advance(&primitive.d_dy, y);
    channels.advance(&primitive.d_dx, x);
    spread(P::DITHER, channels)
}

/// Draws a span of at least one run.
#[inline(never)]
fn draw_runs<P: PixelFormat, D: DepthTest, const TWO_PASS: bool>(
    test: D,
    depth: &mut [D::Depth],
    z: u32,
    primitive: &Colored,
    mut color: &mut [P::Raw],
    x: i32,
    y: i32,
) {
    if color.len() > LONG {
        return draw_long::<P, D, TWO_PASS>(test, depth, z, primitive, color, x, y);
    }
    let first = channels_at::<P>(primitive, x, y);
    let addends = P::dither((x, y));
    let Some(mut depth) = depth.get_mut(..color.len()) else { return };
    let ColorSetup { step, correction, middle, .. } = primitive.setup;
    let mut cursor = SpanCursor { z, dz_dx: primitive.dz_dx, word: word(first), step, mask: primitive.setup.mask };
    let [dr, dg, db] = primitive.d_dx;
    let of_run = |channel, step| {
        spread_step(P::DITHER, channel, step).wrapping_mul(RUN as i32).wrapping_add(LOW_HALVES[channel])
    };
    let run = [of_run(0, dr), of_run(1, dg), of_run(2, db)];
    let (run, run_low) = (word(run), low(run));
    let mut lower = low(first);
    while color.len() >= RUN {
        let Some((colors, rest)) = core::mem::take(&mut color).split_first_chunk_mut::<RUN>() else { return };
        color = rest;
        let Some((depths, rest)) = core::mem::take(&mut depth).split_first_chunk_mut::<RUN>() else { return };
        depth = rest;
        let passed = count_passing_prefix(test, depths, cursor.z, cursor.dz_dx);
        if passed == RUN {
            cursor.colors::<P>([correction, middle], addends, colors);
        } else {
            draw_partial::<P, D>(test, depths, cursor.z, primitive, colors, cursor.word, addends, RUN - passed);
            // The black box hides that the step stays the same. The compiler would otherwise prepare all multiples of
            // it, and spill them.
            cursor.dz_dx = black_box(cursor.dz_dx);
        }
        cursor.z = cursor.z.wrapping_add_signed(cursor.dz_dx.wrapping_mul(RUN as i32));
        lower = lower.wrapping_add(run_low);
        let carries = lower >> CARRY & UNITS;
        lower = lower.wrapping_sub(carries << CARRY);
        cursor.word = cursor.word.wrapping_add(run).wrapping_add(carries);
    }
    if color.is_empty() {
        return;
    }
    if !TWO_PASS {
        return draw_short::<P, D>(test, depth, cursor.z, primitive, color, cursor.word, addends);
    }
    match untested_short_tail(test, depth, cursor.z, cursor.dz_dx) {
        0 => color_short::<P>(color, cursor.word, primitive, addends),
        untested => draw_partial::<P, D>(test, depth, cursor.z, primitive, color, cursor.word, addends, untested),
    }
}

/// Draws less than a run, from pixel (x, y) on.
#[inline(never)]
fn draw_short_at<P: PixelFormat, D: DepthTest>(
    test: D,
    depth: &mut [D::Depth],
    z: u32,
    primitive: &Colored,
    color: &mut [P::Raw],
    x: i32,
    y: i32,
) {
    let word = word(channels_at::<P>(primitive, x, y));
    draw_short::<P, D>(test, depth, z, primitive, color, word, P::dither((x, y)));
}

/// Draws less than a run, beginning with a word of channels.
#[inline(never)]
fn draw_short<P: PixelFormat, D: DepthTest>(
    test: D,
    depth: &mut [D::Depth],
    z: u32,
    primitive: &Colored,
    color: &mut [P::Raw],
    word: u32,
    addends: &[u32; 8],
) {
    let Some(depth) = depth.get_mut(..color.len()) else { return };
    SpanCursor::new(z, word, primitive).draw_short::<P, D>(test, primitive, addends, color, depth);
}

/// Colours less than a run, from pixel (x, y) on.
#[inline(never)]
fn color_short_at<P: PixelFormat>(color: &mut [P::Raw], primitive: &Colored, x: i32, y: i32) {
    let mut nothing = [(); usize::MAX];
    let Some(nothing) = nothing.get_mut(..color.len()) else { return };
    let word = word(channels_at::<P>(primitive, x, y));
    SpanCursor::new(0, word, primitive).draw_short::<P, DepthOff>(
        DepthOff,
        primitive,
        P::dither((x, y)),
        color,
        nothing,
    );
}

/// Colours less than a run, beginning with a word of channels.
#[inline(never)]
fn color_short<P: PixelFormat>(color: &mut [P::Raw], word: u32, primitive: &Colored, addends: &[u32; 8]) {
    let mut nothing = [(); usize::MAX];
    let Some(nothing) = nothing.get_mut(..color.len()) else { return };
    SpanCursor::new(0, word, primitive).draw_short::<P, DepthOff>(DepthOff, primitive, addends, color, nothing);
}

/// Draws less than a run, from pixel (x, y) on. All depths have passed and are stored, except for the last `untested`
/// ones.
#[expect(clippy::too_many_arguments, reason = "a structure in their place would have to be in memory")]
#[cold]
#[inline(never)]
fn draw_partial_at<P: PixelFormat, D: DepthTest>(
    test: D,
    depths: &mut [D::Depth],
    z: u32,
    primitive: &Colored,
    colors: &mut [P::Raw],
    x: i32,
    y: i32,
    untested: usize,
) {
    draw_partial_inlined::<P, D>(
        test,
        depths,
        z,
        primitive,
        colors,
        || word_at::<P>(primitive, x, y),
        P::dither((x, y)),
        untested,
    );
}

/// Draws at most a run, beginning with a word of channels. All depths have passed and are stored, except for the last
/// `untested` ones.
#[expect(clippy::too_many_arguments, reason = "a structure in their place would have to be in memory")]
#[cold]
#[inline(never)]
fn draw_partial<P: PixelFormat, D: DepthTest>(
    test: D,
    depths: &mut [D::Depth],
    z: u32,
    primitive: &Colored,
    colors: &mut [P::Raw],
    word: u32,
    addends: &[u32; 8],
    untested: usize,
) {
    draw_partial_inlined::<P, D>(test, depths, z, primitive, colors, || word, addends, untested);
}

#[expect(clippy::too_many_arguments, reason = "as above")]
#[inline(always)]
fn draw_partial_inlined<P: PixelFormat, D: DepthTest>(
    test: D,
    depths: &mut [D::Depth],
    z: u32,
    primitive: &Colored,
    colors: &mut [P::Raw],
    word: impl FnOnce() -> u32,
    addends: &[u32; 8],
    untested: usize,
) {
    let (dz_dx, passed) = (primitive.dz_dx, depths.len().wrapping_sub(untested));
    let mut z = z.wrapping_add_signed(dz_dx.wrapping_mul(passed as i32));
    if passed == 0 && all_hidden(test, depths, z, dz_dx) {
        return;
    }
    let (first, ColorSetup { step, correction, middle, mask, .. }) = (word(), primitive.setup);
    for (k, (color, depth)) in colors.iter_mut().zip(depths).enumerate() {
        if k >= passed {
            let near = (z >> 16) as u16;
            z = z.wrapping_add_signed(dz_dx);
            if !test.passes(near, *depth) {
                continue;
            }
            test.write(near, depth);
        }
        let mut word = first.wrapping_add(step.wrapping_mul(k as u32));
        if k >= GROUP {
            word = word.wrapping_add(correction);
        }
        if k >= 2 * GROUP {
            word = word.wrapping_add(middle);
        }
        if k >= 3 * GROUP {
            word = word.wrapping_add(correction);
        }
        *color = P::from_packed(word.wrapping_add(addend::<P>(addends, k)), mask);
    }
}

/// Returns whether no depth passes. If the first one does not pass, usually none does.
#[inline(always)]
fn all_hidden<D: DepthTest>(test: D, depths: &[D::Depth], mut z: u32, dz_dx: i32) -> bool {
    for depth in depths {
        if test.passes((z >> 16) as u16, *depth) {
            return false;
        }
        z = z.wrapping_add_signed(dz_dx);
    }
    true
}

/// Draws a long span in parts of [`LONG`] pixels.
#[cold]
#[inline(never)]
fn draw_long<P: PixelFormat, D: DepthTest, const TWO_PASS: bool>(
    test: D,
    depth: &mut [D::Depth],
    mut z: u32,
    primitive: &Colored,
    color: &mut [P::Raw],
    mut x: i32,
    y: i32,
) {
    for (color, depth) in color.chunks_mut(LONG).zip(depth.chunks_mut(LONG)) {
        draw_span::<P, D, TWO_PASS>(Span { color, depth, z, primitive, position: (x, y) }, test);
        z = z.wrapping_add_signed(primitive.dz_dx.wrapping_mul(LONG as i32));
        x = x.wrapping_add(LONG as i32);
    }
}

/// Returns the dither addend of a pixel of a run.
#[inline(always)]
fn addend<P: PixelFormat>(addends: &[u32; 8], pixel: usize) -> u32 {
    if P::DITHER.is_some() { addends.get(pixel % 8).copied().unwrap_or(0) } else { 0 }
}

/// State of the loops over packed channels: all that changes from pixel to pixel.
struct SpanCursor {
    z: u32,
    dz_dx: i32,
    word: u32,
    step: u32,
    mask: u32,
}

impl SpanCursor {
    #[inline(always)]
    fn new(z: u32, word: u32, primitive: &Colored) -> Self {
        Self { z, dz_dx: primitive.dz_dx, word, step: primitive.setup.step, mask: primitive.setup.mask }
    }

    /// Draws a single pixel.
    #[inline(always)]
    fn dot<P: PixelFormat, D: DepthTest>(
        mut self,
        test: D,
        position: (i32, i32),
        color: &mut P::Raw,
        depth: &mut D::Depth,
    ) {
        self.draw::<P, D>(test, P::dither(position)[0], color, depth);
    }

    /// Draws a pixel and steps to the next one.
    #[inline(always)]
    fn draw<P: PixelFormat, D: DepthTest>(&mut self, test: D, addend: u32, color: &mut P::Raw, depth: &mut D::Depth) {
        let z = (self.z >> 16) as u16;
        if !D::ENABLED || test.passes(z, *depth) {
            test.write(z, depth);
            *color = P::from_packed(self.word.wrapping_add(addend), self.mask);
        }
        self.z = self.z.wrapping_add_signed(self.dz_dx);
        self.word = self.word.wrapping_add(self.step);
    }

    /// Colours a run.
    #[inline(always)]
    fn colors<P: PixelFormat>(&self, [correction, middle]: [u32; 2], addends: &[u32; 8], colors: &mut [P::Raw; RUN]) {
        let mut word = self.word;
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = colors;
        macro_rules! color {
            ($($k:literal $color:ident)*) => { $(
                *$color = P::from_packed(word.wrapping_add(addend::<P>(addends, $k)), self.mask);
                word = word.wrapping_add(self.step);
            )* };
        }
        color!(0 a 1 b 2 c 3 d);
        word = word.wrapping_add(correction);
        color!(4 e 5 f 6 g 7 h);
        word = word.wrapping_add(middle);
        color!(8 i 9 j 10 k 11 l);
        word = word.wrapping_add(correction);
        color!(12 m 13 n 14 o 15 p);
        let _ = word;
    }

    /// Draws less than a run.
    #[inline(always)]
    fn draw_short<P: PixelFormat, D: DepthTest>(
        &mut self,
        test: D,
        primitive: &Colored,
        addends: &[u32; 8],
        mut color: &mut [P::Raw],
        mut depth: &mut [D::Depth],
    ) {
        // Unrolled by hand: at `opt-level = "s"` a loop would stay a loop.
        macro_rules! draw {
            ($first:ident $($k:literal $color:ident $depth:ident)*) => {
                let Some(([$($color),*], rest)) = core::mem::take(&mut color).split_first_chunk_mut() else { return };
                color = rest;
                let Some(([$($depth),*], rest)) = core::mem::take(&mut depth).split_first_chunk_mut() else { return };
                depth = rest;
                $( self.draw::<P, D>(test, addend::<P>(addends, $first + $k), $color, $depth); )*
            };
        }
        let mut first = 0;
        if color.len() >= 2 * GROUP {
            draw!(first 0 a az 1 b bz 2 c cz 3 d dz);
            self.word = self.word.wrapping_add(primitive.setup.correction);
            draw!(first 4 a az 5 b bz 6 c cz 7 d dz);
            if color.is_empty() {
                return;
            }
            self.word = self.word.wrapping_add(primitive.setup.middle);
        }
        if color.len() >= GROUP {
            draw!(first 0 a az 1 b bz 2 c cz 3 d dz);
            self.word = self.word.wrapping_add(primitive.setup.correction);
            first = GROUP;
        }
        if color.len() >= 2 {
            draw!(first 0 a az 1 b bz);
            first += 2;
        }
        if !color.is_empty() {
            draw!(first 0 a az);
        }
        let _ = (color, depth);
    }
}

#[cfg(test)]
mod tests {
    use super::super::depth::{Compare, DepthDyn, DepthLess, DepthState};
    use super::super::naive;
    use super::*;
    use crate::color::{Dithered, Rgb332, squeeze};
    use crate::math::random::Rng;
    use crate::span::TriangleSetup;
    use crate::vertex::Side;
    use core::fmt::Debug;
    use embedded_graphics_core::pixelcolor::Rgb565;

    /// Computes the colours of all pixels of a span by their definition.
    fn colors<P: PixelFormat>(primitive: &Colored, (x, y): (i32, i32), length: usize) -> std::vec::Vec<P::Raw> {
        let ColorSetup { step, correction, middle, .. } = primitive.setup;
        let addends = P::dither((x, y));
        let run = core::array::from_fn(|k| spread_step(P::DITHER, k, primitive.d_dx[k]) * RUN as i32 + LOW_HALVES[k]);
        let (mut of_run, mut lower, mut next) = (0, 0, 0);
        let color = |k: usize| {
            if k.is_multiple_of(LONG) {
                let first = channels_at::<P>(primitive, x + k as i32, y);
                (of_run, lower) = (word(first), low(first));
            } else if k.is_multiple_of(RUN) {
                lower += low(run);
                let carries = lower >> CARRY & UNITS;
                lower -= carries << CARRY;
                of_run = of_run.wrapping_add(word(run)).wrapping_add(carries);
            }
            next = match k % RUN {
                0 => of_run,
                4 | 12 => correction.wrapping_add(next),
                8 => middle.wrapping_add(next),
                _ => next,
            };
            let color = P::from_packed(next.wrapping_add(addends[k % 8]), P::packed_mask());
            next = next.wrapping_add(step);
            color
        };
        (0..length).map(color).collect()
    }

    /// Creates a triangle whose channels are `first` at pixel (x, y).
    fn primitive<P: PixelFormat>(
        first: [i32; 3],
        (x, y): (i32, i32),
        d_dx: [i32; 3],
        d_dy: [i32; 3],
        dz_dx: i32,
    ) -> Colored {
        let at_origin = core::array::from_fn(|k| {
            first[k].wrapping_sub(d_dx[k].wrapping_mul(x)).wrapping_sub(d_dy[k].wrapping_mul(y))
        });
        let (corners, side) = ([&at_origin; 3], Side::Front);
        let plane = Primitive { d_dx, ..Primitive::constant(at_origin, 0, side, ()) };
        let triangle = TriangleSetup::new(&plane, corners, 1, (0, 0));
        let setup = ColorSetup::new::<P>(&triangle);
        Primitive { dz_dx, d_dx, d_dy, ..Primitive::constant(at_origin, 0, side, setup) }
    }

    /// Compares spans of all lengths, in a format and under a depth test. All, some or none of their pixels pass.
    fn compare<P: PixelFormat<Raw: PartialEq + Debug>, D: DepthTest<Depth: PartialEq + Debug>>(
        test: D,
        stored: impl Fn(u16) -> D::Depth,
    ) {
        let (mut rng, mut depths) = (Rng::new(1), Rng::new(2));
        let mut random = |end: u32| rng.below(end.into()) as u32;
        for case in 0..2000 {
            let length = if case % 50 == 0 { random(1600) } else { random(70) } as usize;
            let position = (random(300) as i32, random(300) as i32);
            let ends = [0; 3].map(|_: i32| [random(256), random(256)].map(|c| squeeze((c << 8) as i32)));
            let d_dx = ends.map(|[a, b]| (b - a) / (length.max(2) as i32 - 1));
            let first = ends.map(|[a, _]| a);
            let d_dy = [(); 3].map(|()| random(1 << 20) as i32);
            let dz_dx = random(1 << 12) as i32 - 2048;
            let primitive = &primitive::<P>(first, position, d_dx, d_dy, dz_dx);
            assert_eq!(primitive.at(position), first);
            let (z, background) = (20_000 << 16, P::pack([1, 2, 3]));
            let colors = colors::<P>(primitive, position, length);
            naive::compare(
                test,
                naive::Case { length, z, dz_dx, background },
                &mut depths,
                &stored,
                |k| Some(colors[k]),
                &mut [
                    ("one pass", &mut |color, depth| {
                        draw_span::<P, D, false>(Span { color, depth, z, primitive, position }, test);
                    }),
                    ("two passes", &mut |color, depth| {
                        draw_span::<P, D, true>(Span { color, depth, z, primitive, position }, test);
                    }),
                ],
            );
        }
    }

    #[test]
    fn spans_are_those_pixel_by_pixel() {
        compare::<Rgb565, _>(DepthLess, |depth| depth);
        compare::<Dithered<Rgb565>, _>(DepthLess, |depth| depth);
        compare::<Rgb332, _>(DepthLess, |depth| depth);
        compare::<Rgb565, _>(DepthOff, |_| ());
        compare::<Dithered<Rgb332>, _>(DepthOff, |_| ());
        compare::<Rgb565, _>(DepthDyn::new(DepthState { compare: Compare::Greater, write: false }), |depth| depth);
    }

    /// Spans have any length and any colours at both ends, and some of their pixels are hidden.
    #[test]
    fn packed_channels_are_within_1_of_255() {
        let mut rng = Rng::new(1);
        let mut random = |end: u32| rng.below(end.into()) as u32;
        for case in 0..3000 {
            let length = if case % 50 == 0 { 2 + random(3000) } else { 2 + random(120) } as usize;
            let ends = [0; 3].map(|_: i32| [random(256), random(256)].map(|c| squeeze((c << 8) as i32)));
            let d_dx = ends.map(|[a, b]| (b - a) / (length as i32 - 1));
            let exact = |k: usize, x: usize| ends[k][0] + d_dx[k] * x as i32;
            let primitive = &primitive::<Rgb565>(ends.map(|[a, _]| a), (0, 0), d_dx, [0; 3], 1 << 10);
            let hidden = random(40) as usize + 1;
            let mut depth: std::vec::Vec<u16> =
                (0..length).map(|x| if x / hidden % 3 == 2 { 100 } else { 50_000 }).collect();
            let mut color = std::vec![0x1234; length];
            let span = Span { color: &mut color, depth: &mut depth, z: 200 << 16, primitive, position: (0, 0) };
            packed_span::<Rgb565, _>(span, DepthLess);
            for (x, (&pixel, &depth)) in color.iter().zip(&depth).enumerate() {
                if x / hidden % 3 == 2 {
                    assert_eq!((pixel, depth), (0x1234, 100), "{case}: {x}");
                    continue;
                }
                assert_eq!(usize::from(depth), 200 + (x << 10 >> 16), "{case}: {x}");
                for (k, (shift, bits)) in [(11, 5), (5, 6), (0, 5)].into_iter().enumerate() {
                    let found = i32::from(pixel) >> shift & ((1 << bits) - 1);
                    // The channel in 8.16, as if it had not been squeezed.
                    let c = (i64::from(exact(k, x)) * 256 / 255 - (1 << 15)) as i32;
                    let cut = |c: i32| (c >> 16).clamp(0, 255) >> (8 - bits);
                    assert!((cut(c - (1 << 16))..=cut(c + (1 << 16))).contains(&found), "{case}: {x}, channel {k}");
                }
            }
        }
    }
}
