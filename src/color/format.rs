//! The trait of pixel formats: from channels, 8 bits each or packed in one word, to pixels in memory, and back. Packing
//! an unpacked pixel gives that pixel again.

use super::luma::luma;
use super::packed::packed_channels;
use super::rgb565::unpack_rgb565;
use embedded_graphics_core::pixelcolor::{PixelColor, Rgb888};

/// Format of the colours in a framebuffer. It is implemented by marker types. For formats that embedded-graphics knows,
/// the marker is embedded-graphics' own colour type.
pub trait PixelFormat {
    /// A pixel in memory, in the very bytes that [`StripPixels::bytes`](crate::target::StripPixels::bytes) hands out.
    type Raw: bytemuck::Pod;

    /// The embedded-graphics colour of this format.
    type Color: PixelColor + Into<Rgb888>;

    /// Packs red, green and blue of 8 bits each; surplus bits are cut.
    fn pack(rgb: [u8; 3]) -> Self::Raw;

    /// Unpacks red, green and blue of a pixel to 8 bits each: black is 0 and white 255. A channel of fewer bits is
    /// repeated in the lower bits. [`pack`](Self::pack) leads back to the same pixel.
    fn unpack(raw: Self::Raw) -> [u8; 3];

    /// Returns the grey of a pixel: its luma, with the weights of BT.601, which are 77, 150 and 29 of 256.
    #[inline(always)]
    fn luma(raw: Self::Raw) -> u8 {
        luma(Self::unpack(raw))
    }

    /// Set if a pixel is a grey of 8 bits, for which [`from_luma`](Self::from_luma) is the fastest way to pack it.
    const IS_LUMA: bool = false;

    /// Packs a grey.
    #[inline(always)]
    #[must_use]
    fn from_luma(luma: u8) -> Self::Raw {
        Self::pack([luma; 3])
    }

    /// Converts a pixel from RGB565.
    #[inline(always)]
    #[must_use]
    fn from_rgb565(raw: u16) -> Self::Raw {
        Self::pack(unpack_rgb565(raw))
    }

    /// Mixes two pixels: (`a` · `weight` + `b` · (256 - `weight`)) / 256, rounded, in 8 bits per channel. A weight is
    /// at most 256; a larger one gives some colour.
    ///
    /// Formats of 5 or 6 bits per channel mix in the bits that they have, with `weight` rounded to 32nds. Their result
    /// is within 1.5 steps of such a channel.
    #[inline(always)]
    fn mix(a: Self::Raw, b: Self::Raw, weight: u32) -> Self::Raw {
        Self::pack(mix(Self::unpack(a), Self::unpack(b), weight))
    }

    /// Adds two pixels; each channel stops at its maximum.
    #[inline(always)]
    fn add(a: Self::Raw, b: Self::Raw) -> Self::Raw {
        let ([ar, ag, ab], [br, bg, bb]) = (Self::unpack(a), Self::unpack(b));
        Self::pack([ar.saturating_add(br), ag.saturating_add(bg), ab.saturating_add(bb)])
    }

    /// True if a word holds the sums of up to 16 pixels' channels: see [`summand`](Self::summand).
    const SUMS: bool = false;

    /// Returns a word for the sum of up to 16 pixels, with room above each channel.
    #[inline(always)]
    #[must_use]
    fn summand(raw: Self::Raw) -> u32 {
        let _ = raw;
        0
    }

    /// Returns the mean of `count` pixels, each channel rounded to nearest, from the sum of their
    /// [summands](Self::summand). `count` is 2, 4, 8, 9 or 16.
    #[inline(always)]
    #[must_use]
    fn of_sum(sum: u32, count: u32) -> Self::Raw {
        let _ = (sum, count);
        Self::pack([0; 3])
    }

    /// Set if there is an alpha channel. Only [`Rgba8888`](crate::color::Rgba8888) has one, for colours that are about
    /// to be blended.
    const ALPHA: bool = false;

    /// Packs red, green, blue and alpha for a pixel of the screen, as [`pack_at`](Self::pack_at) does. Alpha is kept if
    /// the format has a channel for it.
    #[inline(always)]
    #[must_use]
    fn pack_rgba([r, g, b, _]: [u8; 4], position: (i32, i32)) -> Self::Raw {
        Self::pack_at([r, g, b], position)
    }

    /// Packs a colour for a pixel of the screen, dithered if the format dithers.
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

    /// Bits of red, green and blue that a dithered format keeps, at most 6 each; `None` if the format does not dither.
    const DITHER: Option<[u32; 3]> = None;

    /// Returns the dither addends of eight pixels, from `position` to the right. Each is added to channels that are
    /// packed in one word, in the layout of [`from_packed`](Self::from_packed). The pattern repeats every eight rows
    /// and columns of the screen.
    #[inline(always)]
    #[must_use]
    fn dither(position: (i32, i32)) -> &'static [u32; 8] {
        let _ = position;
        &[0; 8]
    }

    /// Set if [`from_packed`](Self::from_packed) is the fastest way to a pixel, as in formats of 16 bits: then Gouraud
    /// shading steps all three channels in one word.
    const PACKED: bool = false;

    /// Returns the mask that [`from_packed`](Self::from_packed) expects. A caller computes it once and keeps it in a
    /// register.
    #[inline(always)]
    #[must_use]
    fn packed_mask() -> u32 {
        0
    }

    /// Packs a pixel from channels in one word, eight bits each: red in bits 24 to 31, blue in 13 to 20, green in 2 to
    /// 9.
    #[inline(always)]
    #[must_use]
    fn from_packed(word: u32, mask: u32) -> Self::Raw {
        let _ = mask;
        Self::pack([(word >> 24) as u8, (word >> 2) as u8, (word >> 13) as u8])
    }

    /// Packs a colour of embedded-graphics.
    fn from_color(color: Self::Color) -> Self::Raw;

    /// Unpacks a pixel to a colour of embedded-graphics.
    fn to_color(raw: Self::Raw) -> Self::Color;
}

/// Mixes two colours: `weight` 256ths of the first one, and the rest of the second one.
#[inline(always)]
pub(crate) fn mix([r, g, b]: [u8; 3], [s, t, u]: [u8; 3], weight: u32) -> [u8; 3] {
    // Modulo 2³²: a weight beyond 256 gives some colour.
    let rest = 256_u32.wrapping_sub(weight);
    let channel = |a: u8, b: u8| {
        let sum = u32::from(a).wrapping_mul(weight).wrapping_add(u32::from(b).wrapping_mul(rest));
        (sum.wrapping_add(128) >> 8) as u8
    };
    [channel(r, s), channel(g, t), channel(b, u)]
}
