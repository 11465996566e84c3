//! Grey pixels: three channels are one quantity, their luma, and interpolated as one.

use super::color_setup::{ColorSetup, weighted};
use super::depth::DepthTest;
use super::span::Span;
use crate::color::PixelFormat;

/// Draws a span of greys, with one addition per pixel. The step in its setup is the luma of the channels' changes.
///
/// # Format
/// The planes of the channels are exact modulo 2³² but for what rounding their gradients takes, and so is their sum: the
/// luma is as near to the exact one as the channels are, below 2⁻³ of 255, and rounded to nearest.
#[inline(never)]
pub(crate) fn luma_span<P: PixelFormat, D: DepthTest>(span: Span<'_, P, [i32; 3], ColorSetup, D::Depth>, test: D) {
    let mut luma = weighted(span.varyings());
    let Span { color, depth, mut z, primitive, .. } = span;
    let (dz_dx, step) = (primitive.dz_dx, primitive.setup.step);
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
