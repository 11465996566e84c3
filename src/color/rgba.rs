//! Colours with an opacity, which a shader hands to blending.

use super::format::{PixelFormat, mix};
use embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};

/// Red, green, blue and alpha (255 is opaque), 8 bits each. A shader is asked for colours in this format when they are
/// to be blended with the pixels that are there.
///
/// A shader that is written for all formats serves this format too, and is opaque. To give alpha, implement
/// `Shader<Rgba8888>`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rgba8888;

impl PixelFormat for Rgba8888 {
    type Raw = [u8; 4];
    type Color = Rgb888;

    #[inline(always)]
    fn pack([r, g, b]: [u8; 3]) -> [u8; 4] {
        [r, g, b, 255]
    }

    #[inline(always)]
    fn unpack([r, g, b, _]: [u8; 4]) -> [u8; 3] {
        [r, g, b]
    }

    const ALPHA: bool = true;

    #[inline(always)]
    fn pack_rgba(rgba: [u8; 4], _: (i32, i32)) -> [u8; 4] {
        rgba
    }

    /// Mixes red, green and blue; alpha is that of `a`.
    #[inline(always)]
    fn mix(a: [u8; 4], b: [u8; 4], weight: u32) -> [u8; 4] {
        let [r, g, b] = mix(Self::unpack(a), Self::unpack(b), weight);
        [r, g, b, a[3]]
    }

    fn from_color(color: Rgb888) -> [u8; 4] {
        Self::pack([color.r(), color.g(), color.b()])
    }

    fn to_color([r, g, b, _]: [u8; 4]) -> Rgb888 {
        Rgb888::new(r, g, b)
    }
}
