//! Dithering while pixels are packed, for formats of 2 to 6 bits per channel. Channels have 8 bits and a fraction. A
//! threshold that depends on the pixel's position is added to them, and the sum is cut.
//!
//! All three channels lie in one word, as Gouraud shading steps them, and so do the thresholds: that takes one addition
//! per pixel. With 4 levels or more per channel, light is close enough to linear from one level to the next that the
//! levels themselves can be mixed, instead of their light.

/// Scales channels down, which makes room above them for the dither addends.
///
/// # Format
/// Channels c are 8.16, within 0.5..=254.5, and at most 0.39 off. Let b be the bits that stay, and s = 2^(8 - b) one
/// step. Then c - 1/2 is within 0..=254, and the result is 1/2 + (c - 1/2) (1 - 2⁻ᵇ + 2⁻⁷).
///
/// - White, c - 1/2 = 254, becomes 256 - s and up to 0.6 more: it is the last level without any addend.
/// - Black plus the largest addend, (s - 1) 63/64, is still the first level.
/// - No channel plus an addend exceeds 256.
#[inline(always)]
pub(crate) fn spread(dither: Option<[u32; 3]>, c: [i32; 3]) -> [i32; 3] {
    let spread = |channel: usize, c: i32| spread_step(dither, channel, c.wrapping_sub(1 << 15)).wrapping_add(1 << 15);
    if dither.is_some() { [spread(0, c[0]), spread(1, c[1]), spread(2, c[2])] } else { c }
}

/// Does to the change of a channel what [`spread`] does to the channel.
#[inline(always)]
pub(crate) fn spread_step(dither: Option<[u32; 3]>, channel: usize, step: i32) -> i32 {
    match dither {
        Some(bits) => {
            step.wrapping_sub(step.wrapping_shr(bits.get(channel).copied().unwrap_or(0))).wrapping_add(step >> 7)
        }
        None => step,
    }
}

/// Returns the word that is added to packed channels that keep `bits`, for a threshold of `rank`/64: an entry of
/// [`PixelFormat::dither`](crate::color::PixelFormat::dither).
pub const fn dither_word(rank: u8, bits: [u32; 3]) -> u32 {
    // The addends (s - 1) rank / 64 in 8.3, 8.2 and 8.3, where s = 2^(8 - bits) is one step.
    let [r, g, b] = bits;
    pack(addend(rank, r, 3), addend(rank, g, 2), addend(rank, b, 3))
}

/// Computes (2^(8 - `bits`) - 1) · `rank` / 64 with `fraction` fractional bits, rounded down.
const fn addend(rank: u8, bits: u32, fraction: u32) -> i32 {
    (((1 << (8 - bits)) - 1) * rank as i32) << fraction >> 6
}

/// Packs a colour of 8 bits per channel into one word, with room for the dither addends.
#[inline(always)]
pub(crate) fn packed_channels(dither: Option<[u32; 3]>, rgb: [u8; 3]) -> u32 {
    let [r, g, b] = rgb;
    let channels = spread(dither, [squeeze(i32::from(r) << 8), squeeze(i32::from(g) << 8), squeeze(i32::from(b) << 8)]);
    word(channels)
}

/// Converts a channel from 8.8 to the form in which channels are interpolated: (c + 1/2) 255 / 256 in 8.16.
///
/// The result stays half a step away from both ends of the 8 bits. That leaves the loops of `span/packed.rs` room for
/// their errors.
pub(crate) const fn squeeze(c: i32) -> i32 {
    let c = (c << 8) + (1 << 15);
    c - (c >> 8)
}

/// Undoes [`squeeze`]: returns the channel rounded to the nearest integer, for values that `squeeze` returns. Others
/// wrap.
pub(crate) const fn unsqueeze(c: i32) -> u8 {
    (c.wrapping_add(c >> 8) >> 16) as u8
}

/// Packs squeezed channels into one word of the records: red in 8.2, green and blue in 8.3.
#[inline]
pub(crate) fn store(rgb: &[i32; 3], words: &mut [u32]) {
    let [r, g, b] = *rgb;
    let eighths = |c: i32| c.wrapping_add(1 << 12) >> 13;
    let packed = (r.wrapping_add(1 << 13) >> 14) << 22 | eighths(g) << 11 | eighths(b);
    if let [word] = words {
        *word = packed as u32;
    }
}

/// Unpacks what [`store`] packed.
#[inline]
pub(crate) fn load(words: &[u32]) -> [i32; 3] {
    let word = words.first().copied().unwrap_or(0);
    let channel = |bits: u32| (bits << 13) as i32;
    [channel(word >> 22 << 1), channel((word >> 11) & 0x7FF), channel(word & 0x7FF)]
}

/// Packs three channels into one word: red 8.3 in the upper 11 bits, blue 8.3 in the next 11, green 8.2 in the lower
/// 10.
///
/// The word is the sum red 2²¹ + blue 2¹⁰ + green. So the steps of all channels, positive or negative, can be packed
/// and added as words too, as long as each channel stays in range.
#[inline(always)]
pub(crate) const fn pack(r: i32, g: i32, b: i32) -> u32 {
    ((r as u32) << 21).wrapping_add((b as u32) << 10).wrapping_add(g as u32)
}

/// Packs channels in 8.16 into one word; surplus bits are cut.
#[inline(always)]
pub(crate) const fn word([r, g, b]: [i32; 3]) -> u32 {
    pack(r >> 13, g >> 14, b >> 13)
}
