//! RGB565: packing, unpacking, and arithmetic on all three channels at once. Formats and textures share these
//! functions.

/// Packs red, green, blue into 5, 6, 5 bits; surplus bits are cut.
#[inline(always)]
pub(crate) const fn pack_rgb565(rgb: [u8; 3]) -> u16 {
    (rgb[0] as u16 & 0xF8) << 8 | (rgb[1] as u16 & 0xFC) << 3 | rgb[2] as u16 >> 3
}

/// Unpacks 5, 6, 5 bits to 8 each; the upper bits are repeated below.
#[inline(always)]
pub(crate) const fn unpack_rgb565(raw: u16) -> [u8; 3] {
    let (r, g, b) = (raw >> 11, raw >> 5 & 0x3F, raw & 0x1F);
    [(r << 3 | r >> 2) as u8, (g << 2 | g >> 4) as u8, (b << 3 | b >> 2) as u8]
}

/// Mask of the channels in a word that has five more bits of room for each: green 6 bits from bit 21, red 5 from 11,
/// blue 5 from 0.
const SPREAD: u32 = 0x07E0_F81F;

/// Spreads the channels over a word, with room between them.
#[inline(always)]
pub(crate) const fn spread_rgb565(raw: u16) -> u32 {
    (raw as u32 | (raw as u32) << 16) & SPREAD
}

/// Undoes [`spread_rgb565`].
#[inline(always)]
pub(crate) const fn fold_rgb565(word: u32) -> u16 {
    (word | word >> 16) as u16
}

/// Returns the mean of 2, 4, 8, 9 or 16 colours from the sum of them, [spread](spread_rgb565): each channel rounded to
/// nearest.
///
/// # Format
/// Sums are at most 16 · 63, 10 bits, and 16 · 31, 9 bits, and the half that rounds is at most 8: they fit. A ninth is
/// 7,282 / 2¹⁶, exact for sums below 2¹³.
#[inline(always)]
pub(super) const fn mean_rgb565(sum: u32, count: u32) -> u16 {
    const UNITS: u32 = 1 << 21 | 1 << 11 | 1;
    let sum = sum.wrapping_add(UNITS.wrapping_mul(count >> 1));
    if count == 9 {
        let (g, r, b) = (sum >> 21, sum >> 11 & 0x3FF, sum & 0x7FF);
        return ((((r * 7282) >> 16) << 11) | (((g * 7282) >> 16) << 5) | ((b * 7282) >> 16)) as u16;
    }
    fold_rgb565(sum >> (count.trailing_zeros() & 31) & SPREAD)
}

/// Mixes two spread colours: `weight` 32nds of `a` and the rest of `b`, each channel rounded to nearest.
///
/// # Format
/// Each channel is multiplied by 32 in all, and 16 is added to round: at most 63 · 32 + 16 = 2,032 in green's 11 bits,
/// and 1,008 in the 10 bits of red and of blue.
#[inline(always)]
pub(crate) const fn mix_spread_rgb565(a: u32, b: u32, weight: u32) -> u32 {
    // One difference of words serves all channels: borrows between channels cancel in the sum, modulo 2³².
    let sum = (b << 5).wrapping_add(a.wrapping_sub(b).wrapping_mul(weight)).wrapping_add(0x0200_8010);
    sum >> 5 & SPREAD
}

/// Mixes two colours: `weight` 256ths of `a`, rounded to 32nds, and the rest of `b`. One product serves all channels.
#[inline(always)]
pub(super) const fn mix_rgb565(a: u16, b: u16, weight: u32) -> u16 {
    fold_rgb565(mix_spread_rgb565(spread_rgb565(a), spread_rgb565(b), weight.wrapping_add(4) >> 3))
}

/// Adds two colours; a channel that overflows becomes all ones.
#[inline(always)]
pub(super) const fn add_rgb565(a: u16, b: u16) -> u16 {
    let sum = spread_rgb565(a) + spread_rgb565(b);
    let carries = sum & 0x0801_0020;
    let full = carries - ((carries & 0x0001_0020) >> 5) - ((carries & 0x0800_0000) >> 6);
    fold_rgb565((sum | full) & SPREAD)
}
