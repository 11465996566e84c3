//! Colours with an opacity: what a shader hands to blending.

use super::format::{PixelFormat, mix};
use embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};

/// Red, green, blue and alpha (255 = opaque), 8 bits each: the format in which a shader is asked for colours that are then
/// blended. Every shader for all formats is one for this one, and opaque; implement `Shader<Rgba8888>` to give alpha.
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

    /// Alpha is that of `a`.
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
