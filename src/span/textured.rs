//! Spans of repeating textures, with nearest texels: the fastest loop for textures.
//!
//! The plain loop, over u q, v q and q = 1 / w, which are linear on the screen:
//!
//! ```text
//! for each pixel:
//!     if z >> 16 passes against the stored depth:
//!         color = texel(uq / q, vq / q)
//!         store z >> 16, unless the texel is transparent
//!     z += dz_dx;  uq += duq;  vq += dvq;  q += dq
//! ```
//! The departures from it, with what each gained on a Cortex-M0+ and a Cortex-M4 when it was made. Gains are
//! instructions per pixel of W3, a tilted quad:
//!
//! 1. **Coordinates are divided every 16 pixels**, or at another [step](crate::span::Shader::STEP), at columns of the
//!    screen that are multiples of it. In between u and v are linear, both in one word:
//!
//!    ```text
//!    bits   31 .. 16   15 .. 0
//!              v          u        fractions of the texture; a carry from u adds 2⁻¹⁶ to v
//!    ```
//!    Steps are rounded to 2⁻¹⁶, so a pixel of a run is off by at most 2⁻¹³.
//! 2. **Runs of 16 pixels are drawn in two passes** on small cores, first depths and then texels. Each pass has its
//!    values in registers: 33.5 → 31.3.
//! 3. **q, u q and v q are normalized once per span**, and the word and the step of a run are computed out of line:
//!    30.6 → 29.0 and 20.7 → 20.2.
//! 4. **Texels of a run are fetched out of line**, and the last pixels of a span are drawn in two passes too: 29.0 →
//!    27.3.
//! 5. **Dividing takes two instructions, and scaling too**, where the core has long products: 19.7 → 18.9 on a
//!    Cortex-M4.
//! 6. **One comparison tells that a span is straight**, its stepper is written once, runs of 16 pixels come one after
//!    another, and the colours of shorter ones are unrolled: 31.1 → 28.9 and 22.3 → 21.4.

use super::depth::{DepthTest, RUN, count_passing_prefix, untested_short_tail};
use super::span::Span;
use super::uv_stepper::UvStepper;
use crate::color::PixelFormat;
use crate::math::SMALL_CORE;
use crate::texture::Texture;
use crate::vertex::Varyings;

/// Number of pixels from one division to the next, unless another one is chosen.
pub(crate) const STEP: usize = RUN;

/// Draws a span of a repeating texture. The first two varyings are u and v in 16.16. The stepper is that of the span.
#[inline(never)]
pub(crate) fn texture_span<P: PixelFormat, T: Texture, D: DepthTest, V: Varyings, U>(
    texture: &T,
    span: Span<'_, P, V, U, D::Depth>,
    test: D,
    stepper: &mut UvStepper,
) {
    let Span { color, depth, z, .. } = span;
    let length = color.len().min(depth.len());
    let Some(mut color) = color.get_mut(..length) else { return };
    let Some(mut depth) = depth.get_mut(..length) else { return };
    stepper.z = z;
    // Moves on to the first column. The first run may begin between two of them.
    stepper.next_run();
    let step = 1 << (stepper.log_step & 31);
    let mut short = (step - stepper.back as usize) & (step - 1);
    loop {
        if short > 0 {
            let pixels = short.min(color.len());
            let Some((colors, rest)) = core::mem::take(&mut color).split_at_mut_checked(pixels) else { return };
            color = rest;
            let Some((depths, rest)) = core::mem::take(&mut depth).split_at_mut_checked(pixels) else { return };
            depth = rest;
            short_run::<P, T, D>(texture, test, stepper, colors, depths);
        }
        // The last run may end between two columns. Runs of another length than 16 are all drawn above.
        short = step;
        if step == RUN {
            let whole = color.len() / RUN * RUN;
            let Some((colors, rest)) = core::mem::take(&mut color).split_at_mut_checked(whole) else { return };
            color = rest;
            let Some((depths, rest)) = core::mem::take(&mut depth).split_at_mut_checked(whole) else { return };
            depth = rest;
            for (colors, depths) in colors.chunks_exact_mut(RUN).zip(depths.chunks_exact_mut(RUN)) {
                let (Ok(colors), Ok(depths)) = (colors.try_into(), depths.try_into()) else { return };
                if SMALL_CORE && T::IS_OPAQUE {
                    whole_run_in_two_passes::<P, T, D>(texture, test, stepper, colors, depths);
                } else {
                    whole_run_in_one_pass::<P, T, D>(texture, test, stepper, colors, depths);
                }
            }
        }
        if color.is_empty() {
            return;
        }
    }
}

/// Draws a run of 16 pixels of an opaque texture, first depths and then colours. Each loop has all of its values in
/// registers.
#[inline(always)]
fn whole_run_in_two_passes<P: PixelFormat, T: Texture, D: DepthTest>(
    texture: &T,
    test: D,
    stepper: &mut UvStepper,
    colors: &mut [P::Raw; RUN],
    depths: &mut [D::Depth; RUN],
) {
    let passed = count_passing_prefix(test, depths, stepper.z, stepper.dz_dx);
    let (vu, step) = stepper.next_run();
    if passed == RUN {
        color_run16::<P, T>(texture, colors, vu, step);
        stepper.z = stepper.z.wrapping_add_signed(stepper.dz_dx.wrapping_mul(RUN as i32));
    } else {
        partial::<P, T, D>(texture, test, stepper, (vu, step), passed, colors, depths);
    }
}

/// Draws a run of 16 pixels, pixel by pixel. Out of line: the word and the step of the run take all registers.
#[inline(never)]
fn whole_run_in_one_pass<P: PixelFormat, T: Texture, D: DepthTest>(
    texture: &T,
    test: D,
    stepper: &mut UvStepper,
    colors: &mut [P::Raw; RUN],
    depths: &mut [D::Depth; RUN],
) {
    let (vu, step) = stepper.next_run_on::<SMALL_CORE, true>();
    let mut cursor = TexelCursor { z: stepper.z, dz_dx: stepper.dz_dx, vu, step };
    cursor.run16::<P, T, D>(texture, test, colors, depths);
    stepper.z = cursor.z;
}

/// Draws a run of fewer than 16 pixels, or of another length. Out of line, because a span has two of them.
#[inline(never)]
fn short_run<P: PixelFormat, T: Texture, D: DepthTest>(
    texture: &T,
    test: D,
    stepper: &mut UvStepper,
    colors: &mut [P::Raw],
    depths: &mut [D::Depth],
) {
    let pixels = colors.len();
    let Some(depths) = depths.get_mut(..pixels) else { return };
    let (mut vu, step) = stepper.next_run();
    // Only the first run may begin between two columns.
    vu = vu.wrapping_add(step.wrapping_mul(core::mem::take(&mut stepper.back)));
    if SMALL_CORE && T::IS_OPAQUE {
        short_run_in_two_passes::<P, T, D>(texture, test, stepper, (vu, step), colors, depths);
    } else if SMALL_CORE {
        partial::<P, T, D>(texture, test, stepper, (vu, step), 0, colors, depths);
    } else {
        let mut cursor = TexelCursor { z: stepper.z, dz_dx: stepper.dz_dx, vu, step };
        cursor.tail::<P, T, D>(texture, test, colors, depths);
        stepper.z = cursor.z;
    }
}

/// Draws a run of an opaque texture, first depths and then colours, if it is shorter than 16 pixels.
#[inline(always)]
fn short_run_in_two_passes<P: PixelFormat, T: Texture, D: DepthTest>(
    texture: &T,
    test: D,
    stepper: &mut UvStepper,
    (vu, step): (u32, u32),
    colors: &mut [P::Raw],
    depths: &mut [D::Depth],
) {
    let (pixels, mut passed) = (colors.len(), 0);
    if pixels < RUN {
        passed = pixels.saturating_sub(untested_short_tail(test, depths, stepper.z, stepper.dz_dx));
        if passed == pixels {
            color_short::<P, T>(texture, colors, vu, step);
            stepper.z = stepper.z.wrapping_add_signed(stepper.dz_dx.wrapping_mul(pixels as i32));
            return;
        }
    }
    partial::<P, T, D>(texture, test, stepper, (vu, step), passed, colors, depths);
}

/// Draws a run; its first `passed` depths have passed already, and are stored.
#[inline(never)]
fn partial<P: PixelFormat, T: Texture, D: DepthTest>(
    texture: &T,
    test: D,
    stepper: &mut UvStepper,
    (vu, step): (u32, u32),
    passed: usize,
    colors: &mut [P::Raw],
    depths: &mut [D::Depth],
) {
    let Some((first, colors)) = colors.split_at_mut_checked(passed) else { return };
    let Some(depths) = depths.get_mut(passed..) else { return };
    color_short::<P, T>(texture, first, vu, step);
    let vu = vu.wrapping_add(step.wrapping_mul(passed as u32));
    let z = stepper.z.wrapping_add_signed(stepper.dz_dx.wrapping_mul(passed as i32));
    let mut cursor = TexelCursor { z, dz_dx: stepper.dz_dx, vu, step };
    cursor.tail::<P, T, D>(texture, test, colors, depths);
    stepper.z = cursor.z;
}

/// Colours pixels, and steps the word to the pixel after them. Unrolled by hand: at `opt-level = "s"` a loop would stay
/// a loop.
macro_rules! color {
    ($texture:ident, $vu:ident, $step:ident, $($color:ident)*) => {
        $(
            // Steps first: the fetch may then overwrite the old word, which need not be copied.
            let here = $vu;
            $vu = $vu.wrapping_add($step);
            if let Some(pixel) = $texture.fetch::<P>(here) {
                *$color = pixel;
            }
        )*
    };
}

/// Colours a run of 16 pixels.
#[inline(never)]
fn color_run16<P: PixelFormat, T: Texture>(texture: &T, colors: &mut [P::Raw; RUN], mut vu: u32, step: u32) {
    let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = colors;
    color!(texture, vu, step, a b c d e f g h i j k l m n o p);
    let _ = vu;
}

/// Colours fewer pixels than a run has.
#[inline(never)]
fn color_short<P: PixelFormat, T: Texture>(texture: &T, mut colors: &mut [P::Raw], mut vu: u32, step: u32) {
    macro_rules! color_first {
        ($($color:ident)*) => {
            let Some(([$($color),*], rest)) = core::mem::take(&mut colors).split_first_chunk_mut() else { return };
            colors = rest;
            color!(texture, vu, step, $($color)*);
        };
    }
    if colors.len() >= 8 {
        color_first!(a b c d e f g h);
    }
    if colors.len() >= 4 {
        color_first!(a b c d);
    }
    if colors.len() >= 2 {
        color_first!(a b);
    }
    if !colors.is_empty() {
        color_first!(a);
    }
    let _ = (colors, vu);
}

/// State of the loops over a textured span: all that changes from pixel to pixel.
#[derive(Clone, Copy)]
struct TexelCursor {
    z: u32,
    dz_dx: i32,
    vu: u32,
    step: u32,
}

impl TexelCursor {
    /// Draws a run pixel by pixel.
    #[inline(always)]
    fn run16<P: PixelFormat, T: Texture, D: DepthTest>(
        &mut self,
        texture: &T,
        test: D,
        colors: &mut [P::Raw; RUN],
        depths: &mut [D::Depth; RUN],
    ) {
        // Unrolled by hand: at `opt-level = "s"` a loop would stay a loop.
        macro_rules! draw {
            ($($color:ident $depth:ident)*) => {
                let [$($color),*] = colors;
                let [$($depth),*] = depths;
                $( self.draw::<P, T, D>(texture, test, $color, $depth); )*
            };
        }
        draw!(a az b bz c cz d dz e ez f fz g gz h hz i iz j jz k kz l lz m mz n nz o oz p pz);
    }

    /// Draws pixels one by one, in pairs on larger cores.
    #[inline(always)]
    fn tail<P: PixelFormat, T: Texture, D: DepthTest>(
        &mut self,
        texture: &T,
        test: D,
        mut colors: &mut [P::Raw],
        mut depths: &mut [D::Depth],
    ) {
        while !SMALL_CORE && colors.len() >= 2 {
            let Some(([a, b], rest)) = core::mem::take(&mut colors).split_first_chunk_mut::<2>() else { return };
            colors = rest;
            let Some(([az, bz], rest)) = core::mem::take(&mut depths).split_first_chunk_mut::<2>() else { return };
            depths = rest;
            self.draw::<P, T, D>(texture, test, a, az);
            self.draw::<P, T, D>(texture, test, b, bz);
        }
        for (color, stored) in colors.iter_mut().zip(depths) {
            self.draw::<P, T, D>(texture, test, color, stored);
        }
    }

    /// Draws a pixel and steps to the next one.
    #[inline(always)]
    fn draw<P: PixelFormat, T: Texture, D: DepthTest>(
        &mut self,
        texture: &T,
        test: D,
        color: &mut P::Raw,
        stored: &mut D::Depth,
    ) {
        let (depth, vu) = ((self.z >> 16) as u16, self.vu);
        self.z = self.z.wrapping_add_signed(self.dz_dx);
        self.vu = vu.wrapping_add(self.step);
        if !D::ENABLED || test.passes(depth, *stored) {
            if T::IS_OPAQUE {
                test.write(depth, stored);
            }
            if let Some(pixel) = texture.fetch::<P>(vu) {
                if !T::IS_OPAQUE {
                    test.write(depth, stored);
                }
                *color = pixel;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::depth::{Compare, DepthDyn, DepthLess, DepthOff, DepthState};
    use super::super::naive;
    use super::*;
    use crate::math::random::Rng;
    use crate::texture::Tile;
    use embedded_graphics_core::pixelcolor::Rgb565;

    /// Compares all loops with the plain one, over an opaque tile.
    fn compare<D: DepthTest<Depth: PartialEq + core::fmt::Debug>>(test: D, stored: impl Fn(u16) -> D::Depth) {
        let texels: [[u16; 8]; 4] =
            core::array::from_fn(|y| core::array::from_fn(|x| ((8 * y + x) as u16).wrapping_mul(0x0843)));
        let tile = &Tile::new(&texels);
        let mut rng = Rng::new(1);
        for _ in 0..1000 {
            let (z, dz_dx) = (20_000 << 16, rng.next_u32() as i32 >> 20);
            let mut uv = || rng.next_u32() as i32 >> 8;
            let (uv, duv) = ([uv(), uv()], [uv(), uv()]);
            let (vu, step) = UvStepper::straight(uv, duv).next_run();
            let begun = || {
                let mut stepper = UvStepper::straight(uv, duv);
                (stepper.z, stepper.dz_dx) = (z, dz_dx);
                stepper
            };
            let mut cursor = TexelCursor { z, dz_dx, vu, step };
            let pixel = |k: usize| tile.fetch::<Rgb565>(vu.wrapping_add(step.wrapping_mul(k as u32)));
            let case = naive::Case { length: RUN, z, dz_dx, background: 0x1234_u16 };
            naive::compare(
                test,
                case,
                &mut rng,
                &stored,
                pixel,
                &mut [
                    ("a run in one pass", &mut |color, depth| {
                        let (Ok(color), Ok(depth)) = (color.try_into(), depth.try_into()) else { return };
                        whole_run_in_one_pass::<Rgb565, _, D>(tile, test, &mut begun(), color, depth);
                    }),
                    ("a run in two passes", &mut |color, depth| {
                        let (Ok(color), Ok(depth)) = (color.try_into(), depth.try_into()) else { return };
                        whole_run_in_two_passes::<Rgb565, _, D>(tile, test, &mut begun(), color, depth);
                    }),
                ],
            );
            let case = naive::Case { length: rng.below(RUN as u64 + 1) as usize, ..case };
            naive::compare(
                test,
                case,
                &mut rng,
                &stored,
                pixel,
                &mut [
                    ("a tail", &mut |color, depth| cursor.tail::<Rgb565, _, D>(tile, test, color, depth)),
                    ("a short run", &mut |color, depth| {
                        short_run::<Rgb565, _, D>(tile, test, &mut begun(), color, depth);
                    }),
                    ("a short run in two passes", &mut |color, depth| {
                        let word = (vu, step);
                        short_run_in_two_passes::<Rgb565, _, D>(tile, test, &mut begun(), word, color, depth);
                    }),
                ],
            );
        }
    }

    #[test]
    fn spans_are_those_pixel_by_pixel() {
        compare(DepthLess, |depth| depth);
        compare(DepthDyn::new(DepthState { compare: Compare::Greater, write: false }), |depth| depth);
        compare(DepthOff, |_| ());
    }
}
