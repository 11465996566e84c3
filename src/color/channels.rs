//! Colours of three 8-bit channels: as an array of bytes, and packed into one word.

use embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};

/// Returns red, green and blue of a colour.
pub(crate) fn channels(color: Rgb888) -> [u8; 3] {
    [color.r(), color.g(), color.b()]
}

/// Rounds a channel from 8.8 to 8 bits, to nearest. The largest value that it takes is 255.0.
pub(crate) const fn round(channel: i32) -> u8 {
    ((channel + 128) >> 8) as u8
}

/// Packs a colour into the word of a face.
pub(crate) const fn packed([r, g, b]: [u8; 3]) -> u32 {
    u32::from_be_bytes([0, r, g, b])
}

/// Unpacks the colour of a face from its word.
#[inline(always)]
pub(crate) const fn unpacked(face: u32) -> [u8; 3] {
    let [_, r, g, b] = face.to_be_bytes();
    [r, g, b]
}
