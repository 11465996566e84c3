//! Pixel formats that dither a colour while they pack it.

use super::dither::bayer;
use super::format::PixelFormat;
use super::packed::dither_word;
use core::marker::PhantomData;

/// Addends of an 8×8 matrix. Each row is repeated once, so that the eight addends from any column on are contiguous.
pub type DitherWords = [[u32; 16]; 8];

/// Makes the addends for a format that keeps these bits.
const fn words(bits: [u32; 3]) -> DitherWords {
    let mut words = [[0; 16]; 8];
    let mut k = 0;
    while k < 128 {
        words[k / 16][k % 16] = dither_word(bayer(k % 8, k / 16, 3), bits);
        k += 1;
    }
    words
}

pub(super) static WORDS_565: DitherWords = words([5, 6, 5]);
pub(super) static WORDS_332: DitherWords = words([3, 3, 2]);

/// A pixel format that [`Dithered`] can wrap.
pub trait Ditherable: PixelFormat {
    /// Bits of red, green and blue that the format keeps, at most 6 each.
    const BITS: [u32; 3];

    /// Addends for [`BITS`](Self::BITS).
    const WORDS: &'static DitherWords;
}

/// Wraps a pixel format so that a colour is dithered when a shader packs it, by a matrix of 8×8 pixels that is fixed to
/// the screen.
///
/// 16-bit pixels lose the bands that 32 levels per channel leave on a smooth surface. 8-bit pixels look as if they had
/// more levels.
///
/// ```
/// use embedded_graphics_core::pixelcolor::Rgb565;
/// use zstrip::color::PixelFormat;
/// use zstrip::color::{Dithered, Rgb565Be};
/// type Format = Dithered<Rgb565Be>; // Renderer::<Format>::new(...)
/// let red = |x| Format::to_color(Format::pack_at([5, 0, 0], (x, 0)));
/// assert_eq!([red(0), red(1)], [Rgb565::new(0, 0, 0), Rgb565::new(1, 0, 0)]); // 5 is between both
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Dithered<P>(PhantomData<P>);

impl<P: Ditherable> PixelFormat for Dithered<P> {
    type Raw = P::Raw;
    type Color = P::Color;

    #[inline(always)]
    fn pack(rgb: [u8; 3]) -> P::Raw {
        P::pack(rgb)
    }

    #[inline(always)]
    fn unpack(raw: P::Raw) -> [u8; 3] {
        P::unpack(raw)
    }

    #[inline(always)]
    fn from_rgb565(raw: u16) -> P::Raw {
        P::from_rgb565(raw)
    }

    #[inline(always)]
    fn mix(a: P::Raw, b: P::Raw, weight: u32) -> P::Raw {
        P::mix(a, b, weight)
    }

    #[inline(always)]
    fn add(a: P::Raw, b: P::Raw) -> P::Raw {
        P::add(a, b)
    }

    const SUMS: bool = P::SUMS;

    #[inline(always)]
    fn summand(raw: P::Raw) -> u32 {
        P::summand(raw)
    }

    #[inline(always)]
    fn of_sum(sum: u32, count: u32) -> P::Raw {
        P::of_sum(sum, count)
    }

    const DITHER: Option<[u32; 3]> = Some(P::BITS);

    #[inline(always)]
    fn dither((x, y): (i32, i32)) -> &'static [u32; 8] {
        let row = &P::WORDS[(y & 7) as usize];
        row.get((x & 7) as usize..).and_then(<[u32]>::first_chunk).unwrap_or(&[0; 8])
    }

    const PACKED: bool = true;

    #[inline(always)]
    fn packed_mask() -> u32 {
        P::packed_mask()
    }

    #[inline(always)]
    fn from_packed(word: u32, mask: u32) -> P::Raw {
        P::from_packed(word, mask)
    }

    fn from_color(color: P::Color) -> P::Raw {
        P::from_color(color)
    }

    fn to_color(raw: P::Raw) -> P::Color {
        P::to_color(raw)
    }
}
