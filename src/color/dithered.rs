//! Pixel formats that are dithered while they are packed.

use super::dither::bayer;
use super::format::PixelFormat;
use super::packed::dither_word;
use core::marker::PhantomData;

/// Addends of eight rows and twice eight columns, so that eight of them are together from any column on.
pub type DitherWords = [[u32; 16]; 8];

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

/// A format that [`Dithered`] can be put around.
pub trait Ditherable: PixelFormat {
    /// Bits of red, green and blue, up to 6.
    const BITS: [u32; 3];

    /// Addends for these bits.
    const WORDS: &'static DitherWords;
}

/// A format whose pixels are dithered, by a matrix of 8×8 places of the screen, when a shader packs a colour: 16-bit pixels
/// without the bands that their 32 levels leave on a smooth surface, or 8-bit ones that look like more.
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
