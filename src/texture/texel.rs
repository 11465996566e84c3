//! Texel formats: what the bits of an image mean.

use crate::color::{PixelFormat, unpack_rgb565};

/// Alpha from which on a texel is drawn at all.
pub(crate) const OPAQUE: u8 = 128;

/// Format of the texels of an [`Image`](crate::texture::Image): `BITS` bits each, in the order of embedded-graphics' `ImageRaw`. Rows
/// start at whole bytes; of texels that share a byte the first is in the upper bits, of those with more bytes the first byte
/// is the upper one.
pub trait TexelFormat: Copy {
    /// Bits a texel: 1, 2, 4, 8, 16 or 24.
    const BITS: usize;

    /// [`rgb565`](Self::rgb565) is exact: texels of 16 bits, none of them transparent.
    const IS_RGB565: bool = false;

    /// Decodes a texel, 8 bits per channel.
    fn rgba(&self, texel: u32) -> [u8; 4];

    /// Decodes a texel to RGB565.
    #[inline(always)]
    fn rgb565(&self, texel: u32) -> u16 {
        let [r, g, b, _] = self.rgba(texel);
        (r as u16 & 0xF8) << 8 | (g as u16 & 0xFC) << 3 | b as u16 >> 3
    }

    /// A pixel, unless the texel is transparent.
    #[inline(always)]
    fn pixel<P: PixelFormat>(&self, texel: u32) -> Option<P::Raw> {
        if Self::IS_RGB565 {
            return Some(P::from_rgb565(self.rgb565(texel)));
        }
        let [r, g, b, a] = self.rgba(texel);
        if a >= OPAQUE { Some(P::pack([r, g, b])) } else { None }
    }
}

/// 16 bits, the upper byte first: what `ImageRaw<Rgb565>` takes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rgb565Texel;

impl TexelFormat for Rgb565Texel {
    const BITS: usize = 16;
    const IS_RGB565: bool = true;

    #[inline(always)]
    fn rgba(&self, texel: u32) -> [u8; 4] {
        expand(texel as u16)
    }

    #[inline(always)]
    fn rgb565(&self, texel: u32) -> u16 {
        texel as u16
    }
}

/// 16 bits, the lower byte first: what `ImageRaw<Rgb565, LittleEndian>` takes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rgb565LeTexel;

impl TexelFormat for Rgb565LeTexel {
    const BITS: usize = 16;
    const IS_RGB565: bool = true;

    #[inline(always)]
    fn rgba(&self, texel: u32) -> [u8; 4] {
        expand(self.rgb565(texel))
    }

    #[inline(always)]
    fn rgb565(&self, texel: u32) -> u16 {
        (texel as u16).swap_bytes()
    }
}

/// RGB565 to 8 bits a channel, the upper bits repeated below.
#[inline(always)]
pub(super) const fn expand(raw: u16) -> [u8; 4] {
    let [r, g, b] = unpack_rgb565(raw);
    [r, g, b, 255]
}

/// Red, green and blue, a byte each: what `ImageRaw<Rgb888>` takes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rgb888Texel;

impl TexelFormat for Rgb888Texel {
    const BITS: usize = 24;

    #[inline(always)]
    fn rgba(&self, texel: u32) -> [u8; 4] {
        let [_, r, g, b] = texel.to_be_bytes();
        [r, g, b, 255]
    }
}

/// 8 bits of grey: what `ImageRaw<Gray8>` takes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Gray8Texel;

impl TexelFormat for Gray8Texel {
    const BITS: usize = 8;

    #[inline(always)]
    fn rgba(&self, texel: u32) -> [u8; 4] {
        let grey = texel as u8;
        [grey, grey, grey, 255]
    }
}

/// Numbers of colours in a palette, `BITS` bits each: 8, 4, 2 or 1. Numbers past its end are transparent.
#[derive(Clone, Copy, Debug)]
pub struct PaletteTexel<'p, const BITS: usize>(pub &'p [[u8; 3]]);

impl<const BITS: usize> TexelFormat for PaletteTexel<'_, BITS> {
    const BITS: usize = BITS;

    #[inline(always)]
    fn rgba(&self, texel: u32) -> [u8; 4] {
        match self.0.get(texel as usize) {
            Some([r, g, b]) => [*r, *g, *b, 255],
            None => [0; 4],
        }
    }
}

/// A mask of one bit: 1 has the colour, 0 is transparent.
#[derive(Clone, Copy, Debug)]
pub struct MaskTexel(pub [u8; 3]);

impl TexelFormat for MaskTexel {
    const BITS: usize = 1;

    #[inline(always)]
    fn rgba(&self, texel: u32) -> [u8; 4] {
        let [r, g, b] = self.0;
        if texel == 0 { [0; 4] } else { [r, g, b, 255] }
    }
}

/// Another format, of whose values one, `key`, is transparent: the texel's bits as they are in the image.
#[derive(Clone, Copy, Debug)]
pub struct Keyed<F> {
    /// What the other values mean.
    pub format: F,
    /// The transparent value.
    pub key: u32,
}

impl<F: TexelFormat> TexelFormat for Keyed<F> {
    const BITS: usize = F::BITS;

    #[inline(always)]
    fn rgba(&self, texel: u32) -> [u8; 4] {
        if texel == self.key { [0; 4] } else { self.format.rgba(texel) }
    }

    #[inline(always)]
    fn pixel<P: PixelFormat>(&self, texel: u32) -> Option<P::Raw> {
        if texel == self.key { None } else { self.format.pixel::<P>(texel) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_decode_their_bits() {
        assert_eq!(Rgb565Texel.rgba(0xF81F), [255, 0, 255, 255]);
        assert_eq!(Rgb565LeTexel.rgba(0x1FF8), [255, 0, 255, 255]);
        assert_eq!(Rgb888Texel.rgba(0x10_2030), [0x10, 0x20, 0x30, 255]);
        assert_eq!(Gray8Texel.rgba(77), [77, 77, 77, 255]);
        let palette = PaletteTexel::<4>(&[[1, 2, 3], [4, 5, 6]]);
        assert_eq!([0, 1, 2].map(|k| palette.rgba(k)), [[1, 2, 3, 255], [4, 5, 6, 255], [0; 4]]);
        assert_eq!([0, 1].map(|k| MaskTexel([7, 8, 9]).rgba(k)), [[0; 4], [7, 8, 9, 255]]);
        let keyed = Keyed { format: palette, key: 0 };
        assert_eq!([0, 1].map(|k| keyed.rgba(k)), [[0; 4], [4, 5, 6, 255]]);
        for raw in [0, 0x1234, 0xFFFF, 0x07E0] {
            let format = Keyed { format: Rgb565Texel, key: 0xF81F };
            assert_eq!(format.rgb565(raw), raw as u16);
        }
    }
}
