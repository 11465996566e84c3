//! Means of colours: by their numbers, or by their light.

use super::dither::LIGHT;
use super::format::PixelFormat;
use core::marker::PhantomData;

/// A way to take the mean of colours: [`MeanOfCodes`] or [`MeanOfLight`].
pub trait Mean: sealed::Sealed {
    /// Set if channels are added up as they are.
    #[doc(hidden)]
    const IS_OF_CODES: bool;

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
    const IS_OF_CODES: bool = true;

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
    const IS_OF_CODES: bool = false;

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

/// A sum of pixels: of up to 16.
pub(crate) struct PixelSum<P, M> {
    /// The sum of [summands](PixelFormat::summand), if the format has them.
    word: u32,
    channels: [u32; 3],
    how: PhantomData<(P, M)>,
}

impl<P: PixelFormat, M: Mean> PixelSum<P, M> {
    const IN_A_WORD: bool = P::SUMS && M::IS_OF_CODES;

    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self { word: 0, channels: [0; 3], how: PhantomData }
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, pixel: P::Raw) {
        if Self::IN_A_WORD {
            self.word = self.word.wrapping_add(P::summand(pixel));
            return;
        }
        for (sum, channel) in self.channels.iter_mut().zip(P::unpack(pixel)) {
            *sum += M::amount(channel);
        }
    }

    /// Returns the mean of 2, 4, 8, 9 or 16 pixels, each channel rounded to nearest: to the levels of the format if
    /// they are added up in one word, otherwise to 8 bits.
    #[inline(always)]
    pub(crate) fn mean(self, count: u32) -> P::Raw {
        if Self::IN_A_WORD {
            return P::of_sum(self.word, count);
        }
        // Sums are below 2²⁰: for them, ⌈2³² / 9⌉ / 2³² is as good as a ninth.
        let divided = |sum: u32| match count {
            9 => ((u64::from(sum) * 0x1C71_C71D) >> 32) as u32,
            _ => sum >> (count.trailing_zeros() & 31),
        };
        P::pack(self.channels.map(|sum| M::code(divided(sum + (count >> 1)))))
    }
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
