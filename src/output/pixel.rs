//! The pixel formats.

use crate::fragment::PixelFormat;
use embedded_graphics_core::pixelcolor::raw::RawU16;
use embedded_graphics_core::pixelcolor::{Gray8, GrayColor, IntoStorage, Rgb565, Rgb888, RgbColor};

/// Red, green, blue to 5, 6, 5 bits.
#[inline(always)]
const fn rgb565(rgb: [u8; 3]) -> u16 {
    (rgb[0] as u16 & 0xF8) << 8 | (rgb[1] as u16 & 0xFC) << 3 | rgb[2] as u16 >> 3
}

/// The bits of green, hidden from the compiler: it would rather have two constants than one more exclusive or.
#[inline(always)]
fn green_mask() -> u32 {
    core::hint::black_box(0x7E0)
}

/// The same from channels in one word: red and blue lie as far apart there as here; green is exchanged for what lies
/// between them, which takes one mask.
#[inline(always)]
const fn rgb565_from_packed(word: u32, green: u32) -> u16 {
    let red_blue = word >> 16;
    (red_blue ^ (red_blue ^ word << 1) & green) as u16
}

/// 5, 6, 5 bits to 8, the upper ones repeated below.
#[inline(always)]
const fn from_rgb565(raw: u16) -> [u8; 3] {
    let (r, g, b) = (raw >> 11, raw >> 5 & 0x3F, raw & 0x1F);
    [(r << 3 | r >> 2) as u8, (g << 2 | g >> 4) as u8, (b << 3 | b >> 2) as u8]
}

/// Where green, red and blue lie in a word that has room for five more bits of each: 6 bits from bit 21, 5 from 11, 5 from 0.
const SPREAD: u32 = 0x07E0_F81F;

#[inline(always)]
const fn spread(raw: u16) -> u32 {
    (raw as u32 | (raw as u32) << 16) & SPREAD
}

#[inline(always)]
const fn folded(word: u32) -> u16 {
    (word | word >> 16) as u16
}

/// A mixture with `weight` 256ths of `a`, rounded to 32nds: one product for all channels.
///
/// # Format
/// Each channel times 32, and 16 that rounds: at most 63 · 32 + 16 = 2,032 of green's 11 bits, 1,008 of the others' 10.
#[inline(always)]
const fn mix_rgb565(a: u16, b: u16, weight: u32) -> u16 {
    let (a, b, weight) = (spread(a), spread(b), (weight + 4) >> 3);
    // Modulo 2³² it does not matter that a difference of two words is one of all channels.
    let sum = (b << 5).wrapping_add(a.wrapping_sub(b).wrapping_mul(weight)).wrapping_add(0x0200_8010);
    folded(sum >> 5 & SPREAD)
}

/// A sum, channels that overflow filled with ones.
#[inline(always)]
const fn add_rgb565(a: u16, b: u16) -> u16 {
    let sum = spread(a) + spread(b);
    let carries = sum & 0x0801_0020;
    let full = carries - ((carries & 0x0001_0020) >> 5) - ((carries & 0x0800_0000) >> 6);
    folded((sum | full) & SPREAD)
}

/// The two formats of RGB565, which differ in how the 16 bits come into memory, and back.
macro_rules! rgb565_format {
    ($(#[$doc:meta])* $format:ty, $store:path, $load:path) => {
        $(#[$doc])*
        impl PixelFormat for $format {
            type Raw = u16;
            type Color = Rgb565;

            #[inline(always)]
            fn pack(rgb: [u8; 3]) -> u16 {
                $store(rgb565(rgb))
            }

            #[inline(always)]
            fn unpack(raw: u16) -> [u8; 3] {
                from_rgb565($load(raw))
            }

            #[inline(always)]
            fn mix(a: u16, b: u16, weight: u32) -> u16 {
                $store(mix_rgb565($load(a), $load(b), weight))
            }

            #[inline(always)]
            fn add(a: u16, b: u16) -> u16 {
                $store(add_rgb565($load(a), $load(b)))
            }

            const PACKED: bool = true;

            #[inline(always)]
            fn packed_mask() -> u32 {
                green_mask()
            }

            #[inline(always)]
            fn from_packed(word: u32, mask: u32) -> u16 {
                $store(rgb565_from_packed(word, mask))
            }

            fn from_color(color: Rgb565) -> u16 {
                $store(color.into_storage())
            }

            fn to_color(raw: u16) -> Rgb565 {
                Rgb565::from(RawU16::new($load(raw)))
            }
        }
    };
}

rgb565_format!(
    /// 16-bit pixels in the processor's byte order.
    Rgb565,
    core::convert::identity,
    core::convert::identity
);

/// RGB565 with the high byte first in memory: what displays expect on their SPI bus, so that
/// [`StripPixels::bytes`](crate::output::StripPixels::bytes) goes out as it is.
#[derive(Clone, Copy, Debug)]
pub struct Rgb565Be;

rgb565_format!(Rgb565Be, u16::to_be, u16::from_be);

/// 24-bit pixels: red, green, blue.
impl PixelFormat for Rgb888 {
    type Raw = [u8; 3];
    type Color = Rgb888;

    #[inline(always)]
    fn pack(rgb: [u8; 3]) -> [u8; 3] {
        rgb
    }

    #[inline(always)]
    fn unpack(raw: [u8; 3]) -> [u8; 3] {
        raw
    }

    fn from_color(color: Rgb888) -> [u8; 3] {
        [color.r(), color.g(), color.b()]
    }

    fn to_color(raw: [u8; 3]) -> Rgb888 {
        Rgb888::new(raw[0], raw[1], raw[2])
    }
}

/// 8-bit grey: luma of the colour, with the weights of BT.601 in 1/256 (77, 150, 29), cut.
impl PixelFormat for Gray8 {
    type Raw = u8;
    type Color = Gray8;

    #[inline(always)]
    fn pack(rgb: [u8; 3]) -> u8 {
        ((rgb[0] as u32 * 77 + rgb[1] as u32 * 150 + rgb[2] as u32 * 29) >> 8) as u8
    }

    #[inline(always)]
    fn unpack(raw: u8) -> [u8; 3] {
        [raw; 3]
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

    /// Packing what was unpacked leads back, black is 0 and white 255, and embedded-graphics' colours convert alike.
    fn check<P: PixelFormat<Raw: PartialEq + core::fmt::Debug>>(
        raws: impl Iterator<Item = P::Raw>,
        rgb888: impl Fn(P::Color) -> Rgb888,
    ) {
        assert_eq!(P::unpack(P::pack([255; 3])), [255; 3]);
        assert_eq!(P::unpack(P::pack([0; 3])), [0; 3]);
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
        check::<Gray8>(0..=u8::MAX, Rgb888::from);
        check::<Rgb888>((0..=255).flat_map(|v| [[v, 0, !v], [!v, v, 7]]), |color| color);
    }
}
