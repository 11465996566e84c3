//! The pixel formats of the crate: 16 bits, 8 bits, three bytes, and grey.

use super::dithered::{DitherWords, Ditherable, WORDS_332, WORDS_565};
use super::format::PixelFormat;
use super::luma::luma;
use super::rgb565::{add_rgb565, mean_rgb565, mix_rgb565, pack_rgb565, spread_rgb565, unpack_rgb565};
use crate::math::SMALL_CORE;
use core::convert::identity;
use embedded_graphics_core::pixelcolor::raw::RawU16;
use embedded_graphics_core::pixelcolor::{
    Bgr565, Bgr888, Gray8, GrayColor, IntoStorage, Rgb565, Rgb666, Rgb888, RgbColor,
};

/// Bits of green in RGB565.
const GREEN: u32 = 0x7E0;

/// Returns the mask that [`rgb565_from_packed`] expects. It is hidden from the compiler, which would otherwise make the
/// constant anew for each pixel, or keep two constants.
#[inline(always)]
fn packed_mask() -> u32 {
    core::hint::black_box(if SMALL_CORE { GREEN } else { !GREEN & 0xFFFF })
}

/// Packs RGB565 from channels in one word. Red and blue are as far apart in the word as in the pixel, so both are moved
/// by one shift. The bits between them are then replaced by green. On cores with few registers, that takes one mask and
/// no other constant.
#[inline(always)]
const fn rgb565_from_packed(word: u32, mask: u32) -> u16 {
    let red_blue = word >> 16;
    if SMALL_CORE {
        (red_blue ^ (red_blue ^ word << 1) & mask) as u16
    } else {
        (red_blue & mask | word << 1 & GREEN) as u16
    }
}

/// Packs red, green, blue as BGR565.
#[inline(always)]
const fn bgr565(rgb: [u8; 3]) -> u16 {
    pack_rgb565(reversed(rgb))
}

/// Unpacks red, green and blue of BGR565 to 8 bits each.
#[inline(always)]
const fn from_bgr565(raw: u16) -> [u8; 3] {
    reversed(unpack_rgb565(raw))
}

/// Packs BGR565 from channels in one word.
#[inline(always)]
const fn bgr565_from_packed(word: u32, _: u32) -> u16 {
    (word >> 27 | word >> 16 << 11 | word << 1 & GREEN) as u16
}

/// Converts RGB565 to BGR565, or back, by exchanging red and blue.
#[inline(always)]
const fn exchanged(raw: u16) -> u16 {
    raw >> 11 | raw & 0x7E0 | raw << 11
}

/// Implements a format of 16 bits. Arguments: its type; its embedded-graphics colour; its functions to pack 8 bits per
/// channel, to unpack them, to pack from channels in one word, and to convert from RGB565; and the functions that put
/// the 16 bits into memory order and take them back.
macro_rules! sixteen_bits {
    ($(#[$doc:meta])* $format:ty, $color:ty, ($pack:path, $unpack:path, $packed:path, $rgb:path), $store:path, $load:path) => {
        $(#[$doc])*
        impl PixelFormat for $format {
            type Raw = u16;
            type Color = $color;

            #[inline(always)]
            fn pack(rgb: [u8; 3]) -> u16 {
                $store($pack(rgb))
            }

            #[inline(always)]
            fn unpack(raw: u16) -> [u8; 3] {
                $unpack($load(raw))
            }

            #[inline(always)]
            fn from_rgb565(raw: u16) -> u16 {
                $store($rgb(raw))
            }

            #[inline(always)]
            fn mix(a: u16, b: u16, weight: u32) -> u16 {
                $store(mix_rgb565($load(a), $load(b), weight))
            }

            #[inline(always)]
            fn add(a: u16, b: u16) -> u16 {
                $store(add_rgb565($load(a), $load(b)))
            }

            const SUMS: bool = true;

            #[inline(always)]
            fn summand(raw: u16) -> u32 {
                spread_rgb565($load(raw))
            }

            #[inline(always)]
            fn of_sum(sum: u32, count: u32) -> u16 {
                $store(mean_rgb565(sum, count))
            }

            const PACKED: bool = true;

            #[inline(always)]
            fn packed_mask() -> u32 {
                packed_mask()
            }

            #[inline(always)]
            fn from_packed(word: u32, mask: u32) -> u16 {
                $store($packed(word, mask))
            }

            fn from_color(color: $color) -> u16 {
                $store(color.into_storage())
            }

            fn to_color(raw: u16) -> $color {
                <$color>::from(RawU16::new($load(raw)))
            }
        }

        impl Ditherable for $format {
            const WORDS: &'static DitherWords = &WORDS_565;
            const BITS: [u32; 3] = [5, 6, 5];
        }
    };
}

sixteen_bits!(
    /// 16-bit pixels in the processor's byte order.
    Rgb565,
    Rgb565,
    (pack_rgb565, unpack_rgb565, rgb565_from_packed, identity),
    identity,
    identity
);
sixteen_bits!(
    /// 16-bit pixels with blue in the upper bits, in the processor's byte order.
    Bgr565,
    Bgr565,
    (bgr565, from_bgr565, bgr565_from_packed, exchanged),
    identity,
    identity
);

/// RGB565 with the high byte first in memory. That is what displays expect on their SPI bus, so that
/// [`StripPixels::bytes`](crate::target::StripPixels::bytes) can be sent as it is.
#[derive(Clone, Copy, Debug)]
pub struct Rgb565Be;

sixteen_bits!(Rgb565Be, Rgb565, (pack_rgb565, unpack_rgb565, rgb565_from_packed, identity), u16::to_be, u16::from_be);

/// BGR565 with the high byte first in memory.
#[derive(Clone, Copy, Debug)]
pub struct Bgr565Be;

sixteen_bits!(Bgr565Be, Bgr565, (bgr565, from_bgr565, bgr565_from_packed, exchanged), u16::to_be, u16::from_be);

/// 8-bit pixels: 3 bits of red, 3 of green, 2 of blue, as displays with 256 colours take them. embedded-graphics has no
/// such colour, so [`Rgb888`] stands in for it.
#[derive(Clone, Copy, Debug)]
pub struct Rgb332;

impl PixelFormat for Rgb332 {
    type Raw = u8;
    type Color = Rgb888;

    #[inline(always)]
    fn pack([r, g, b]: [u8; 3]) -> u8 {
        r & 0xE0 | (g & 0xE0) >> 3 | b >> 6
    }

    #[inline(always)]
    fn unpack(raw: u8) -> [u8; 3] {
        let (r, g, b) = (raw & 0xE0, raw << 3 & 0xE0, raw & 3);
        [r | r >> 3 | r >> 6, g | g >> 3 | g >> 6, b * 0x55]
    }

    const PACKED: bool = true;

    fn from_color(color: Rgb888) -> u8 {
        Self::pack(Rgb888::from_color(color))
    }

    fn to_color(raw: u8) -> Rgb888 {
        Rgb888::to_color(Self::unpack(raw))
    }
}

impl Ditherable for Rgb332 {
    const WORDS: &'static DitherWords = &WORDS_332;
    const BITS: [u32; 3] = [3, 3, 2];
}

/// Exchanges the first and the last channel.
#[inline(always)]
const fn reversed([r, g, b]: [u8; 3]) -> [u8; 3] {
    [b, g, r]
}

/// Implements a format of three bytes. Arguments: its embedded-graphics colour; the bits per channel of that colour;
/// and the function that brings red, green and blue into the order of the bytes, which is its own inverse.
macro_rules! three_bytes {
    ($(#[$doc:meta])* $color:ident, $bits:literal, $order:path) => {
        $(#[$doc])*
        impl PixelFormat for $color {
            type Raw = [u8; 3];
            type Color = $color;

            #[inline(always)]
            fn pack([r, g, b]: [u8; 3]) -> [u8; 3] {
                const MASK: u8 = 0xFF << (8 - $bits);
                $order([r & MASK, g & MASK, b & MASK])
            }

            #[inline(always)]
            fn unpack(raw: [u8; 3]) -> [u8; 3] {
                let [r, g, b] = $order(raw);
                if $bits == 8 { [r, g, b] } else { [r | r >> ($bits & 7), g | g >> ($bits & 7), b | b >> ($bits & 7)] }
            }

            fn from_color(color: $color) -> [u8; 3] {
                $order([color.r() << (8 - $bits), color.g() << (8 - $bits), color.b() << (8 - $bits)])
            }

            fn to_color(raw: [u8; 3]) -> $color {
                let [r, g, b] = $order(raw);
                $color::new(r >> (8 - $bits), g >> (8 - $bits), b >> (8 - $bits))
            }
        }
    };
}

three_bytes!(
    /// 24-bit pixels: red, green, blue.
    Rgb888,
    8,
    identity
);
three_bytes!(
    /// 24-bit pixels: blue, green, red.
    Bgr888,
    8,
    reversed
);
three_bytes!(
    /// 18-bit pixels in three bytes: red, green, blue, each in the upper six bits, as displays take them on an SPI bus.
    Rgb666,
    6,
    identity
);

/// 8-bit grey: the luma of the colour with the weights of BT.601.
impl PixelFormat for Gray8 {
    type Raw = u8;
    type Color = Gray8;

    #[inline(always)]
    fn pack(rgb: [u8; 3]) -> u8 {
        luma(rgb)
    }

    #[inline(always)]
    fn unpack(raw: u8) -> [u8; 3] {
        [raw; 3]
    }

    #[inline(always)]
    fn luma(raw: u8) -> u8 {
        raw
    }

    const IS_LUMA: bool = true;

    #[inline(always)]
    fn from_luma(luma: u8) -> u8 {
        luma
    }

    fn from_color(color: Gray8) -> u8 {
        color.luma()
    }

    fn to_color(raw: u8) -> Gray8 {
        Gray8::new(raw)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that packing leads back to what was unpacked, that black is 0 and white 255, and that embedded-graphics'
    /// colours convert to the same channels.
    fn check<P: PixelFormat<Raw: PartialEq + core::fmt::Debug>>(
        raws: impl Iterator<Item = P::Raw>,
        rgb888: impl Fn(P::Color) -> Rgb888,
    ) {
        assert_eq!(P::unpack(P::pack([255; 3])), [255; 3]);
        assert_eq!(P::unpack(P::pack([0; 3])), [0; 3]);
        for raw in [0x1234, 0xFEDC, 0x07E0, 0x801F, 0xF801] {
            assert_eq!(P::from_rgb565(raw), P::pack(unpack_rgb565(raw)));
        }
        for raw in raws {
            assert_eq!(P::pack(P::unpack(raw)), raw);
            assert_eq!(P::from_color(P::to_color(raw)), raw);
            let oracle = rgb888(P::to_color(raw));
            for (channel, exact) in P::unpack(raw).into_iter().zip([oracle.r(), oracle.g(), oracle.b()]) {
                // The conversions of embedded-graphics round v 255 / 31; repeated bits are within 1 of that.
                assert!(channel.abs_diff(exact) <= 1, "{raw:?}: {channel}, {exact}");
            }
        }
    }

    #[test]
    fn packing_is_the_inverse_of_unpacking() {
        check::<Rgb565>(0..=u16::MAX, Rgb888::from);
        check::<Rgb565Be>(0..=u16::MAX, Rgb888::from);
        assert_eq!(Bgr565::from_packed(0x89AB_CDEF, packed_mask()), Bgr565::pack([0x89, 0x7B, 0x5E]));
        check::<Bgr565>(0..=u16::MAX, Rgb888::from);
        check::<Bgr565Be>(0..=u16::MAX, Rgb888::from);
        check::<Rgb332>(0..=u8::MAX, |color| color);
        check::<Gray8>(0..=u8::MAX, Rgb888::from);
        check::<Rgb888>((0..=255).flat_map(|v| [[v, 0, !v], [!v, v, 7]]), |color| color);
        check::<Bgr888>((0..=255).flat_map(|v| [[v, 0, !v], [!v, v, 7]]), Rgb888::from);
        check::<Rgb666>((0..64).flat_map(|v| [[v << 2, 0, 4], [8, v << 2, 252]]), Rgb888::from);
    }
}
