//! Channels of eight bits, apart and in a word.

use embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};

/// Red, green, blue.
pub(crate) fn channels(color: Rgb888) -> [u8; 3] {
    [color.r(), color.g(), color.b()]
}

/// 8.8 to 8 bits, to nearest; 255.0 is the largest value there is.
pub(crate) const fn round(channel: i32) -> u8 {
    ((channel + 128) >> 8) as u8
}

/// The word of a face of this colour.
pub(crate) const fn packed([r, g, b]: [u8; 3]) -> u32 {
    u32::from_be_bytes([0, r, g, b])
}

/// The colour of a face, from its word.
#[inline(always)]
pub(crate) const fn unpacked(face: u32) -> [u8; 3] {
    let [_, r, g, b] = face.to_be_bytes();
    [r, g, b]
}
