//! Means of colours: by their numbers, or by their light.

use super::dither::LIGHT;
use super::format::PixelFormat;

/// A way to take the mean of colours: [`MeanOfCodes`] or [`MeanOfLight`].
pub trait Mean: sealed::Sealed {
    /// Returns what is added up for a channel: below 2¹⁶.
    #[doc(hidden)]
    fn amount(code: u8) -> u32;

    /// Returns the channel of which an amount is nearest.
    #[doc(hidden)]
    fn code(amount: u32) -> u8;
}

/// The mean of channels as numbers: fast, and what most programs do. An edge between black and white is darker than it
/// would look from afar.
#[derive(Clone, Copy, Debug)]
pub struct MeanOfCodes;

/// The mean of light: channels are sRGB, in which 188 is half of white's light. It takes a table of 512 bytes, and two
/// to three times as long as [`MeanOfCodes`] where colours differ.
#[derive(Clone, Copy, Debug)]
pub struct MeanOfLight;

impl Mean for MeanOfCodes {
    #[inline(always)]
    fn amount(code: u8) -> u32 {
        code.into()
    }

    #[inline(always)]
    fn code(amount: u32) -> u8 {
        amount as u8
    }
}

impl Mean for MeanOfLight {
    #[inline(always)]
    fn amount(code: u8) -> u32 {
        LIGHT[usize::from(code)].into()
    }

    /// Searches the table: light grows with the code.
    #[inline(never)]
    fn code(amount: u32) -> u8 {
        let (mut code, mut bit) = (0_u8, 128);
        while bit > 0 {
            if Self::amount(code | bit) <= amount {
                code |= bit;
            }
            bit >>= 1;
        }
        // The next one may be nearer.
        match code.checked_add(1) {
            Some(next) if 2 * amount > Self::amount(code) + Self::amount(next) => next,
            _ => code,
        }
    }
}

/// Returns the mean of pixels, each channel rounded to nearest: up to 2¹⁶ pixels.
///
/// `divide` divides a sum below 2³² by their number.
#[inline(always)]
pub(crate) fn mean<P: PixelFormat, M: Mean>(
    pixels: impl Iterator<Item = P::Raw>,
    count: u32,
    divide: impl Fn(u32) -> u32,
) -> P::Raw {
    let mut sum = [count >> 1; 3];
    for pixel in pixels {
        for (sum, channel) in sum.iter_mut().zip(P::unpack(pixel)) {
            *sum += M::amount(channel);
        }
    }
    P::pack(sum.map(|sum| M::code(divide(sum))))
}

mod sealed {
    pub trait Sealed {}

    impl Sealed for super::MeanOfCodes {}
    impl Sealed for super::MeanOfLight {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_of_light_are_the_nearest_ones() {
        for code in 0..=255 {
            assert_eq!(MeanOfLight::code(MeanOfLight::amount(code)), code);
        }
        for amount in 0..65_536 {
            let distance = |code: u8| MeanOfLight::amount(code).abs_diff(amount);
            let best = (0..=255).map(distance).min();
            assert_eq!(Some(distance(MeanOfLight::code(amount))), best, "{amount}");
        }
    }
}
