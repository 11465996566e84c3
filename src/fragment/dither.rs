//! Dithering while pixels are packed, for formats of 2 to 6 bits a channel: channels of 8 bits and some are added to a
//! threshold that depends on the place, and cut.
//!
//! All three channels lie in one word, as Gouraud shading steps them, and so do the thresholds: one addition a pixel. Between
//! 4 levels or more, light is close enough to linear that levels, not light, can be mixed.

use super::gouraud::squeeze;
use super::packed_span::{pack, packed_fragments, word};
use super::{DepthTest, Fragments, PixelFormat, Steps};

/// Makes room above the channels for what dithering adds.
///
/// # Format
/// Channels of 8.16, 0.5..=254.5 and at most 0.39 off. With b bits that stay, s = 2^(8 - b) and c - 1/2 in 0..=254, the result
/// is 1/2 + (c - 1/2) (1 - 2⁻ᵇ + 2⁻⁷), for which 254 becomes 256 - s and up to 0.6 more: white is the last level without
/// any help, black plus the largest addend, (s - 1) 63/64, the first one, and nothing exceeds 256.
#[inline(always)]
pub(super) fn spread<P: PixelFormat + ?Sized>(c: [i32; 3]) -> [i32; 3] {
    let spread = |channel: usize, c: i32| spread_step::<P>(channel, c.wrapping_sub(1 << 15)).wrapping_add(1 << 15);
    if P::DITHER.is_some() { [spread(0, c[0]), spread(1, c[1]), spread(2, c[2])] } else { c }
}

/// [`spread`] of a channel's change.
#[inline(always)]
pub(super) fn spread_step<P: PixelFormat + ?Sized>(channel: usize, step: i32) -> i32 {
    match P::DITHER {
        Some(bits) => step.wrapping_sub(step >> bits.get(channel).copied().unwrap_or(0)).wrapping_add(step >> 7),
        None => step,
    }
}

/// What is to be added to packed channels of which so many bits stay, for a threshold of `rank`/64: an entry of
/// [`PixelFormat::dither`].
pub const fn dither_word(rank: u8, bits: [u32; 3]) -> u32 {
    // (s - 1) rank / 64 in 8.3, 8.2, 8.3.
    let [r, g, b] = bits;
    pack(addend(rank, r, 3), addend(rank, g, 2), addend(rank, b, 3))
}

/// (2^(8 - `bits`) - 1) `rank` / 64 with fractional bits, rounded down.
const fn addend(rank: u8, bits: u32, fraction: u32) -> i32 {
    (((1 << (8 - bits)) - 1) * rank as i32) << fraction >> 6
}

/// A colour of 8 bits a channel with the first of some addends.
#[inline(always)]
pub(super) fn dithered<P: PixelFormat + ?Sized>(rgb: [u8; 3], addends: &[u32; 8]) -> P::Raw {
    let [r, g, b] = rgb;
    let channels = spread::<P>([squeeze(i32::from(r) << 8), squeeze(i32::from(g) << 8), squeeze(i32::from(b) << 8)]);
    P::from_packed(word(channels).wrapping_add(addends[0]), P::packed_mask())
}

/// A span of one colour, in a dithered format.
pub(super) fn dithered_span<P: PixelFormat, D: DepthTest>(
    rgb: [u8; 3],
    span: Fragments<'_, P, [i32; 0], D::Stored>,
    test: D,
) {
    let Fragments { color, depth, z, steps, position, .. } = span;
    let [r, g, b] = rgb;
    let varyings = [squeeze(i32::from(r) << 8), squeeze(i32::from(g) << 8), squeeze(i32::from(b) << 8)];
    let steps = &Steps::linear(steps.dz_dx, [0; 3], [0; 3], steps.side);
    packed_fragments::<P, D>(Fragments { color, depth, z, varyings, steps, position }, test);
}
