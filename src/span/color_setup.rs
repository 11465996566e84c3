//! Set-up of triangles whose varyings are colours, once per triangle, for each kind of pixel format.

use super::span::TriangleSetup;
use crate::color::{PixelFormat, pack, spread_step};
use core::sync::atomic::{Ordering, compiler_fence};

/// Number of pixels over which a word of channels is stepped before its rounding is corrected.
pub(super) const GROUP: usize = 4;

/// Data of a triangle whose varyings are colours: three channels in 8.16, squeezed to 0.5..=254.5.
///
/// The shaders of this crate compute it for their own spans. Each kind of pixel format uses a part of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct ColorSetup {
    /// The mask of [`PixelFormat::packed_mask`], computed once.
    pub(super) mask: u32,
    /// Change of a word of channels from pixel to pixel; in formats of greys, the change of luma.
    pub(super) step: u32,
    /// Word that is added after a group of four pixels, within eight pixels of a run: it corrects the rounding of their
    /// steps.
    pub(super) correction: u32,
    /// Word that is added in the middle of a run, after eight pixels, in place of `correction`.
    pub(super) middle: u32,
    /// The channels at the screen's origin. They are moved so that cutting them rounds, and so that the errors of the
    /// steps cancel in the middle of a run.
    pub(super) at_origin: [i32; 3],
}

impl ColorSetup {
    /// Sets up a triangle for pixels of format `P`.
    #[inline]
    pub(crate) fn new<P: PixelFormat>(triangle: &TriangleSetup<'_, [i32; 3]>) -> Self {
        if P::PACKED {
            Self::packed::<P>(triangle.at_origin, triangle.d_dx)
        } else if P::IS_LUMA {
            Self { step: weighted(*triangle.d_dx), ..Self::default() }
        } else {
            Self::default()
        }
    }

    /// Creates the data of spans of one colour.
    #[inline]
    pub(super) fn constant<P: PixelFormat>(rgb: [i32; 3]) -> Self {
        Self { at_origin: rgb, step: 0, correction: 0, middle: 0, mask: P::packed_mask() }
    }

    #[inline(always)]
    fn packed<P: PixelFormat>(rgb: &[i32; 3], d_dx: &[i32; 3]) -> Self {
        // Without a loop: at `opt-level = "s"` it would stay a loop, and go through memory.
        let ([mut r, mut g, mut b], [dr, dg, db]) = (*rgb, *d_dx);
        let [r_one, r_four, r_eight] = round_steps::<P>(0, &mut r, dr);
        let [b_one, b_four, b_eight] = round_steps::<P>(2, &mut b, db);
        let [g_one, g_four, g_eight] = round_steps::<P>(1, &mut g, dg);
        let (step, four, eight) =
            (pack(r_one, g_one, b_one), pack(r_four, g_four, b_four), pack(r_eight, g_eight, b_eight));
        let correction = four.wrapping_sub(step.wrapping_mul(GROUP as u32));
        let middle = eight.wrapping_sub(four << 1).wrapping_add(correction);
        Self { at_origin: [r, g, b], step, correction, middle, mask: P::packed_mask() }
    }
}

/// Returns the changes of a channel over one, four and eight pixels, rounded to units of the word. Moves `value` as
/// [`ColorSetup::at_origin`] describes.
#[inline(always)]
fn round_steps<P: PixelFormat>(channel: usize, value: &mut i32, step: i32) -> [i32; 3] {
    let step = spread_step(P::DITHER, channel, step);
    let (half, bits) = if channel == 1 { (1 << 13, 14) } else { (1 << 12, 13) };
    let units = |change: i32| change.wrapping_add(half) >> bits;
    let one = units(step);
    let four = units(step.wrapping_mul(GROUP as i32));
    let eight = units(step.wrapping_mul(2 * GROUP as i32));
    let kept = (one + one + one + four + eight) << bits;
    let lost = step.wrapping_mul(15).wrapping_sub(kept);
    *value = value.wrapping_add(half + (lost >> 1));
    // Channel by channel: all three at once would need more registers than there are.
    compiler_fence(Ordering::SeqCst);
    [one, four, eight]
}

/// Computes the luma of three channels that Gouraud shading has squeezed, or of their changes, modulo 2³².
///
/// # Format
/// From 8.16 to 8.24, including the half that rounds. Channels are (c + 1/2) 255 / 256, and the weights add up to 257 /
/// 256. For a grey the sum is (c + 1/2) (1 - 2⁻¹⁶), which is c when it is cut.
#[inline(always)]
pub(super) const fn weighted([r, g, b]: [i32; 3]) -> u32 {
    let sum = r.wrapping_mul(77).wrapping_add(g.wrapping_mul(151)).wrapping_add(b.wrapping_mul(29));
    sum as u32
}
