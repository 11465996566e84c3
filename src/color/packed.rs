//! Dithering while pixels are packed, for formats of 2 to 6 bits a channel: channels of 8 bits and some are added to a
//! threshold that depends on the place, and cut.
//!
//! All three channels lie in one word, as Gouraud shading steps them, and so do the thresholds: one addition a pixel. Between
//! 4 levels or more, light is close enough to linear that levels, not light, can be mixed.

/// Makes room above the channels for what dithering adds.
///
/// # Format
/// Channels of 8.16, 0.5..=254.5 and at most 0.39 off. With b bits that stay, s = 2^(8 - b) and c - 1/2 in 0..=254, the result
/// is 1/2 + (c - 1/2) (1 - 2⁻ᵇ + 2⁻⁷), for which 254 becomes 256 - s and up to 0.6 more: white is the last level without
/// any help, black plus the largest addend, (s - 1) 63/64, the first one, and nothing exceeds 256.
#[inline(always)]
pub(crate) fn spread(dither: Option<[u32; 3]>, c: [i32; 3]) -> [i32; 3] {
    let spread = |channel: usize, c: i32| spread_step(dither, channel, c.wrapping_sub(1 << 15)).wrapping_add(1 << 15);
    if dither.is_some() { [spread(0, c[0]), spread(1, c[1]), spread(2, c[2])] } else { c }
}

/// [`spread`] of a channel's change.
#[inline(always)]
pub(crate) fn spread_step(dither: Option<[u32; 3]>, channel: usize, step: i32) -> i32 {
    match dither {
        Some(bits) => step.wrapping_sub(step >> bits.get(channel).copied().unwrap_or(0)).wrapping_add(step >> 7),
        None => step,
    }
}

/// Returns what is added to packed channels of which `bits` stay, for a threshold of `rank`/64: an entry of
/// [`PixelFormat::dither`](crate::color::PixelFormat::dither).
pub const fn dither_word(rank: u8, bits: [u32; 3]) -> u32 {
    // (s - 1) rank / 64 in 8.3, 8.2, 8.3.
    let [r, g, b] = bits;
    pack(addend(rank, r, 3), addend(rank, g, 2), addend(rank, b, 3))
}

/// (2^(8 - `bits`) - 1) `rank` / 64 with fractional bits, rounded down.
const fn addend(rank: u8, bits: u32, fraction: u32) -> i32 {
    (((1 << (8 - bits)) - 1) * rank as i32) << fraction >> 6
}

/// A colour of 8 bits a channel in one word, with room for what dithering adds.
#[inline(always)]
pub(crate) fn packed_channels(dither: Option<[u32; 3]>, rgb: [u8; 3]) -> u32 {
    let [r, g, b] = rgb;
    let channels = spread(dither, [squeeze(i32::from(r) << 8), squeeze(i32::from(g) << 8), squeeze(i32::from(b) << 8)]);
    word(channels)
}

/// Channels are interpolated as (c + 1/2) 255 / 256: so they stay half a step away from both ends of their 8 bits, which
/// leaves [`packed_span`] room for its errors.
pub(crate) const fn squeeze(c: i32) -> i32 {
    let c = (c << 8) + (1 << 15);
    c - (c >> 8)
}

/// The integer nearest to the channel that was squeezed.
pub(crate) const fn unsqueeze(c: i32) -> u8 {
    ((c + (c >> 8)) >> 16) as u8
}

/// Channels in one word of the records.
#[inline]
pub(crate) fn store(rgb: &[i32; 3], words: &mut [u32]) {
    let [r, g, b] = *rgb;
    let packed = ((r + (1 << 13)) >> 14) << 22 | ((g + (1 << 12)) >> 13) << 11 | (b + (1 << 12)) >> 13;
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

/// A word of three channels: red 8.3 in the upper 11 bits, blue 8.3 in the next 11, green 8.2 in the lower 10.
///
/// It stands for red 2²¹ + blue 2¹⁰ + green, so steps of either sign may be added as words, as long as each channel stays
/// in range.
#[inline(always)]
pub(crate) const fn pack(r: i32, g: i32, b: i32) -> u32 {
    ((r as u32) << 21).wrapping_add((b as u32) << 10).wrapping_add(g as u32)
}

/// The word of channels in 8.16, cut.
#[inline(always)]
pub(crate) const fn word([r, g, b]: [i32; 3]) -> u32 {
    pack(r >> 13, g >> 14, b >> 13)
}
