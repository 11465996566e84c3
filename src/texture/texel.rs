//! Texel formats: the meaning of the bits of an image.

use crate::color::{PixelFormat, pack_rgb565, unpack_rgb565};

/// Least alpha of a texel that is drawn at all.
pub(crate) const OPAQUE: u8 = 128;

/// Format of the texels of an [`Image`](crate::texture::Image): `BITS` bits each, in the order of embedded-graphics'
/// `ImageRaw`.
///
/// Each row starts at a whole byte. If texels share a byte, the first texel is in the upper bits. If a texel has
/// several bytes, its upper byte comes first.
pub trait TexelFormat: Copy {
    /// Bits per texel: 1, 2, 4, 8, 16 or 24.
    const BITS: usize;

    /// Set if [`rgb565`](Self::rgb565) is exact: for texels of 16 bits, none of them transparent.
    const IS_RGB565: bool = false;

    /// Decodes a texel to red, green, blue and alpha, 8 bits each.
    fn rgba(&self, texel: u32) -> [u8; 4];

    /// Decodes a texel to RGB565.
    #[inline(always)]
    fn rgb565(&self, texel: u32) -> u16 {
        let [r, g, b, _] = self.rgba(texel);
        pack_rgb565([r, g, b])
    }

    /// Decodes a texel to a pixel; `None` if it is transparent.
    #[inline(always)]
    fn pixel<P: PixelFormat>(&self, texel: u32) -> Option<P::Raw> {
        if Self::IS_RGB565 {
            return Some(P::from_rgb565(self.rgb565(texel)));
        }
        let [r, g, b, a] = self.rgba(texel);
        if a >= OPAQUE { Some(P::pack([r, g, b])) } else { None }
    }
}

/// 16 bits, the upper byte first, as in `ImageRaw<Rgb565>`.
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

/// 16 bits, the lower byte first, as in `ImageRaw<Rgb565, LittleEndian>`.
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

/// Unpacks RGB565 to 8 bits per channel, the upper bits repeated below; alpha is 255.
#[inline(always)]
pub(super) const fn expand(raw: u16) -> [u8; 4] {
    let [r, g, b] = unpack_rgb565(raw);
    [r, g, b, 255]
}

/// Red, green and blue, a byte each, as in `ImageRaw<Rgb888>`.
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

/// 8 bits of grey, as in `ImageRaw<Gray8>`.
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

/// Indices into a palette, `BITS` bits each: 8, 4, 2 or 1. An index past the end of the palette is transparent.
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

/// A mask of one bit per texel: 1 has the colour, 0 is transparent.
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

/// Makes one value of another format, the `key`, transparent. The key is compared with the texel's bits as they are in
/// the image.
#[derive(Clone, Copy, Debug)]
pub struct Keyed<F> {
    /// Format of all other values.
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
