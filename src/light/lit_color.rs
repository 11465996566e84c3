//! Colours under light.

use crate::color::{channels, round};
use embedded_graphics_core::pixelcolor::Rgb888;

/// The brightest value of a channel: 255 in 8.8.
pub(super) const WHITE: i32 = 255 << 8;

/// A colour under light: red, green and blue, finer than 8 bits, because shaders interpolate them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LitColor([i32; 3]);

impl LitColor {
    /// Returns the colour of three channels in 8.8, red first; channels outside of 0..=255.0 are clamped.
    #[must_use]
    pub fn new(channels: [i32; 3]) -> Self {
        Self(channels.map(|c| c.clamp(0, WHITE)))
    }

    /// Returns the colour of channels that are at most 255.0.
    #[inline(always)]
    pub(super) const fn from_bits(channels: [i32; 3]) -> Self {
        Self(channels)
    }

    /// Returns the colour of three channels of 8 bits, red first.
    #[inline(always)]
    pub(crate) fn from_channels([r, g, b]: [u8; 3]) -> Self {
        Self([i32::from(r) << 8, i32::from(g) << 8, i32::from(b) << 8])
    }

    /// Returns red, green and blue in 8.8, each in 0..=255.0.
    #[must_use]
    #[inline(always)]
    pub const fn to_bits(self) -> [i32; 3] {
        self.0
    }

    /// Rounds to 8 bits per channel: red, green and blue.
    #[inline(always)]
    pub(crate) const fn rounded(self) -> [u8; 3] {
        let [r, g, b] = self.0;
        [round(r), round(g), round(b)]
    }
}

impl From<Rgb888> for LitColor {
    #[inline]
    fn from(color: Rgb888) -> Self {
        Self::from_channels(channels(color))
    }
}

impl From<LitColor> for Rgb888 {
    #[inline]
    fn from(color: LitColor) -> Self {
        let [r, g, b] = color.rounded();
        Self::new(r, g, b)
    }
}
