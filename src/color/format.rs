//! The trait of pixel formats.

use super::luma::luma;
use super::packed::packed_channels;
use super::rgb565::unpack_rgb565;
use embedded_graphics_core::pixelcolor::{PixelColor, Rgb888};

/// Format of the colours in a framebuffer. Implemented by marker types, which for formats that embedded-graphics knows are
/// its own colour types.
pub trait PixelFormat {
    /// A pixel in memory, in the very bytes that [`Strip::bytes`](crate::target::StripPixels::bytes) hands out.
    type Raw: bytemuck::Pod;

    /// The embedded-graphics colour of this format.
    type Color: PixelColor + Into<Rgb888>;

    /// Packs red, green and blue of 8 bits; surplus bits are cut.
    fn pack(rgb: [u8; 3]) -> Self::Raw;

    /// Red, green and blue of a pixel in 8 bits, black 0 and white 255: channels of fewer bits are repeated in the lower
    /// ones. [`pack`](Self::pack) leads back to the same pixel.
    fn unpack(raw: Self::Raw) -> [u8; 3];

    /// Returns the grey of a pixel: its luma by the weights of BT.601, 77, 150 and 29 of 256.
    #[inline(always)]
    fn luma(raw: Self::Raw) -> u8 {
        luma(Self::unpack(raw))
    }

    /// A pixel is a grey of 8 bits, for which [`from_luma`](Self::from_luma) is a short way.
    const IS_LUMA: bool = false;

    /// The pixel of a grey.
    #[inline(always)]
    #[must_use]
    fn from_luma(luma: u8) -> Self::Raw {
        Self::pack([luma; 3])
    }

    /// From RGB565.
    #[inline(always)]
    #[must_use]
    fn from_rgb565(raw: u16) -> Self::Raw {
        Self::pack(unpack_rgb565(raw))
    }

    /// `a` · `weight` + `b` · (256 - `weight`), over 256 and rounded, in 8 bits a channel; for formats of 5 or 6 bits a
    /// channel by channels of as many, with `weight` rounded to 32nds: within 1.5 of their steps.
    #[inline(always)]
    fn mix(a: Self::Raw, b: Self::Raw, weight: u32) -> Self::Raw {
        Self::pack(mix(Self::unpack(a), Self::unpack(b), weight))
    }

    /// The sum of two colours, each channel at most full.
    #[inline(always)]
    fn add(a: Self::Raw, b: Self::Raw) -> Self::Raw {
        let ([ar, ag, ab], [br, bg, bb]) = (Self::unpack(a), Self::unpack(b));
        Self::pack([ar.saturating_add(br), ag.saturating_add(bg), ab.saturating_add(bb)])
    }

    /// There is an alpha channel: only in [`Rgba8888`](crate::color::Rgba8888), for colours that are about to be blended.
    const ALPHA: bool = false;

    /// [`pack_at`](Self::pack_at) of red, green, blue and alpha, which is kept if there is a channel for it.
    #[inline(always)]
    #[must_use]
    fn pack_rgba([r, g, b, _]: [u8; 4], position: (i32, i32)) -> Self::Raw {
        Self::pack_at([r, g, b], position)
    }

    /// Packs a colour for a pixel of the screen: dithered, if the format dithers.
    #[inline(always)]
    #[must_use]
    fn pack_at(rgb: [u8; 3], position: (i32, i32)) -> Self::Raw {
        match Self::DITHER {
            None => Self::pack(rgb),
            Some(_) => {
                let word = packed_channels(Self::DITHER, rgb).wrapping_add(Self::dither(position)[0]);
                Self::from_packed(word, Self::packed_mask())
            }
        }
    }

    /// Bits of red, green and blue that a dithered format keeps, up to 6.
    const DITHER: Option<[u32; 3]> = None;

    /// Returns what is added to packed channels, in the layout of [`from_packed`](Self::from_packed), at eight pixels from
    /// `position` on, which is repeated every eight rows and columns of the screen.
    #[inline(always)]
    #[must_use]
    fn dither(position: (i32, i32)) -> &'static [u32; 8] {
        let _ = position;
        &[0; 8]
    }

    /// [`from_packed`](Self::from_packed) is a short way to a pixel: true for formats of 5 or 6 bits a channel.
    const PACKED: bool = false;

    /// Returns the mask that [`from_packed`](Self::from_packed) wants at hand in a register.
    #[inline(always)]
    #[must_use]
    fn packed_mask() -> u32 {
        0
    }

    /// From channels in one word, eight bits each: red in the bits 24 to 31, blue in 13 to 20, green in 2 to 9.
    #[inline(always)]
    #[must_use]
    fn from_packed(word: u32, mask: u32) -> Self::Raw {
        let _ = mask;
        Self::pack([(word >> 24) as u8, (word >> 2) as u8, (word >> 13) as u8])
    }

    /// From embedded-graphics' colour.
    fn from_color(color: Self::Color) -> Self::Raw;

    /// To embedded-graphics' colour.
    fn to_color(raw: Self::Raw) -> Self::Color;
}

/// A mixture of two colours, `weight` 256ths of the first.
#[inline(always)]
pub(crate) fn mix([r, g, b]: [u8; 3], [s, t, u]: [u8; 3], weight: u32) -> [u8; 3] {
    let channel = |a: u8, b: u8| ((u32::from(a) * weight + u32::from(b) * (256 - weight) + 128) >> 8) as u8;
    [channel(r, s), channel(g, t), channel(b, u)]
}
