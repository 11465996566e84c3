//! Spans of grey pixels whose varyings are colours.
//!
//! The plain loop, over channels in 8.16:
//!
//! ```text
//! for each pixel:
//!     if z >> 16 passes against the stored depth:
//!         store z >> 16
//!         color = luma(r >> 16, g >> 16, b >> 16)
//!     z += dz_dx;  r += dr;  g += dg;  b += db
//! ```
//! The one departure: luma is a weighted sum of the channels, so it is itself linear on the screen. It is computed at
//! the first pixel and stepped from there, which replaces three products and two additions per pixel.

use super::color_setup::{ColorSetup, weighted};
use super::depth::DepthTest;
use super::span::Span;
use crate::color::PixelFormat;

/// Draws a span of grey pixels, with one addition per pixel. The step in the primitive's setup is the luma of the
/// channels' changes.
///
/// # Format
/// The planes of the channels are exact modulo 2³², except for the rounding of their gradients, and so is their
/// weighted sum. The luma is therefore as close to its exact value as the channels are to theirs: within 2⁻³, on the
/// scale of 0..=255. It is then rounded to nearest.
#[inline(never)]
pub(crate) fn luma_span<P: PixelFormat, D: DepthTest>(span: Span<'_, P, [i32; 3], ColorSetup, D::Depth>, test: D) {
    let mut luma = weighted(span.varyings());
    let Span { color, depth, mut z, primitive, .. } = span;
    let (dz_dx, step) = (primitive.dz_dx, primitive.setup.step);
    // Not unrolled: the compiler would keep multiples of both steps, and small cores have no registers for them.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::squeeze;
    use crate::math::random::Rng;
    use crate::span::{DepthLess, Primitive, TriangleSetup, naive};
    use crate::vertex::Side;
    use embedded_graphics_core::pixelcolor::Gray8;

    #[test]
    fn spans_are_those_pixel_by_pixel() {
        let mut rng = Rng::new(1);
        for _ in 0..1000 {
            let length = 1 + rng.below(70) as usize;
            let ends = [(); 3].map(|()| [rng.below(256), rng.below(256)].map(|c| squeeze((c << 8) as i32)));
            let d_dx = ends.map(|[a, b]| (b - a) / length as i32);
            let at_origin = ends.map(|[a, _]| a);
            let (side, dz_dx, z) = (Side::Front, rng.below(4096) as i32 - 2048, 20_000 << 16);
            let corners = [&at_origin; 3];
            let plane = Primitive { d_dx, ..Primitive::constant(at_origin, 0, side, ()) };
            let triangle = TriangleSetup::new(&plane, corners, 1, (0, 0));
            let setup = ColorSetup::new::<Gray8>(&triangle);
            let primitive = &Primitive { dz_dx, d_dx, ..Primitive::constant(at_origin, 0, side, setup) };
            let case = naive::Case { length, z, dz_dx, background: 77_u8 };
            naive::compare(
                DepthLess,
                case,
                &mut rng,
                |depth| depth,
                |k| Some((weighted(primitive.at((k as i32, 0))) >> 24) as u8),
                &mut [("luma", &mut |color, depth| {
                    luma_span(Span::<Gray8, _, _, _> { color, depth, z, position: (0, 0), primitive }, DepthLess);
                })],
            );
        }
    }
}
