//! Grey pixels: three channels are one quantity, their luma, and interpolated as one.

use super::depth::DepthTest;
use super::span::Fragments;
use crate::color::PixelFormat;

/// Luma of three channels as Gouraud shading squeezes them, or of their changes, modulo 2³².
///
/// # Format
/// 8.16 to 8.24, with a half that rounds: channels are (c + 1/2) 255 / 256, and the weights add up to 257, which makes
/// (c + 1/2) (1 - 2⁻¹⁶) of a grey: c when it is cut.
#[inline(always)]
pub(crate) const fn weighted([r, g, b]: [i32; 3]) -> u32 {
    let sum = r.wrapping_mul(77).wrapping_add(g.wrapping_mul(151)).wrapping_add(b.wrapping_mul(29));
    sum as u32
}

/// Draws a span of greys, with one addition a pixel; `step` is the luma of the channels' changes.
///
/// # Format
/// The planes of the channels are exact modulo 2³² but for what rounding their gradients takes, and so is their sum: the
/// luma is as near to the exact one as the channels are, below 2⁻³ of 255, and rounded to nearest.
#[inline(never)]
pub(crate) fn luma_span<P: PixelFormat, D: DepthTest>(span: Fragments<'_, P, [i32; 3], D::Depth>, step: u32, test: D) {
    let Fragments { color, depth, mut z, varyings, steps, .. } = span;
    let dz_dx = steps.dz_dx;
    let mut luma = weighted(varyings);
    // Not unrolled: the compiler would keep multiples of both steps, for which small cores have no registers.
    for (color, stored) in color.iter_mut().zip(depth) {
        let depth = (z >> 16) as u16;
        if !D::ENABLED || test.passes(depth, *stored) {
            test.write(depth, stored);
            *color = P::from_luma((luma >> 24) as u8);
        }
        z = z.wrapping_add_signed(dz_dx);
        luma = luma.wrapping_add(step);
    }
}
