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

/// 16-bit pixels in the processor's byte order.
impl PixelFormat for Rgb565 {
    type Raw = u16;
    type Color = Rgb565;

    #[inline(always)]
    fn pack(rgb: [u8; 3]) -> u16 {
        rgb565(rgb)
    }

    const PACKED: bool = true;

    #[inline(always)]
    fn packed_mask() -> u32 {
        green_mask()
    }

    #[inline(always)]
    fn from_packed(word: u32, mask: u32) -> u16 {
        rgb565_from_packed(word, mask)
    }

    fn from_color(color: Rgb565) -> u16 {
        color.into_storage()
    }

    fn to_color(raw: u16) -> Rgb565 {
        Rgb565::from(RawU16::new(raw))
    }
}

/// RGB565 with the high byte first in memory: what displays expect on their SPI bus, so that
/// [`StripPixels::bytes`](crate::output::StripPixels::bytes) goes out as it is.
#[derive(Clone, Copy, Debug)]
pub struct Rgb565Be;

impl PixelFormat for Rgb565Be {
    type Raw = u16;
    type Color = Rgb565;

    #[inline(always)]
    fn pack(rgb: [u8; 3]) -> u16 {
        rgb565(rgb).to_be()
    }

    const PACKED: bool = true;

    #[inline(always)]
    fn packed_mask() -> u32 {
        green_mask()
    }

    #[inline(always)]
    fn from_packed(word: u32, mask: u32) -> u16 {
        rgb565_from_packed(word, mask).to_be()
    }

    fn from_color(color: Rgb565) -> u16 {
        color.into_storage().to_be()
    }

    fn to_color(raw: u16) -> Rgb565 {
        Rgb565::from(RawU16::new(u16::from_be(raw)))
    }
}

/// 24-bit pixels: red, green, blue.
impl PixelFormat for Rgb888 {
    type Raw = [u8; 3];
    type Color = Rgb888;

    #[inline(always)]
    fn pack(rgb: [u8; 3]) -> [u8; 3] {
        rgb
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

    fn from_color(color: Gray8) -> u8 {
        color.luma()
    }

    fn to_color(raw: u8) -> Gray8 {
        Gray8::new(raw)
    }
}
