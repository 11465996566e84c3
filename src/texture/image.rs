//! Textures: images in flash, in the formats of [`TexelFormat`], and small tiles for the fastest loop. The constructors
//! check sizes, so reading a texel cannot fail.

use super::texel::{OPAQUE, TexelFormat, expand};
use crate::color::{PixelFormat, pack_rgb565};
use embedded_graphics_core::geometry::Size;

/// A rectangle of texels.
///
/// Shaders ask only for columns and rows that are inside of it. An implementation may return anything for others.
pub trait Texture {
    /// Returns the number of columns and of rows, from 1 to 65,535 each.
    fn size(&self) -> Size;

    /// Returns red, green, blue and alpha of the texel at a column and a row.
    fn rgba(&self, x: u32, y: u32) -> [u8; 4];

    /// Returns the texel as a pixel of format `P`; `None` if it is transparent.
    fn pixel<P: PixelFormat>(&self, x: u32, y: u32) -> Option<P::Raw>;

    /// Set if [`rgb565`](Self::rgb565) returns all texels exactly.
    const IS_RGB565: bool = false;

    /// Set if no texel is transparent.
    const IS_OPAQUE: bool = Self::IS_RGB565;

    /// Returns the texel as RGB565.
    #[inline]
    fn rgb565(&self, x: u32, y: u32) -> u16 {
        let [r, g, b, _] = self.rgba(x, y);
        pack_rgb565([r, g, b])
    }

    /// Returns the pixel at a position in the texture. Both coordinates are fractions of its sides in 0.16: u in the
    /// lower half of the word, v in the upper half.
    #[inline(always)]
    fn fetch<P: PixelFormat>(&self, vu: u32) -> Option<P::Raw> {
        let Size { width, height } = self.size();
        self.pixel::<P>((vu & 0xFFFF).wrapping_mul(width) >> 16, (vu >> 16).wrapping_mul(height) >> 16)
    }
}

/// Error in the bytes or the sizes of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TextureError {
    /// An image without columns or without rows.
    Empty {
        /// Columns and rows.
        size: Size,
    },
    /// More than 65,535 columns or rows.
    TooLarge {
        /// Columns and rows.
        size: Size,
    },
    /// A mip chain without levels.
    NoLevels,
    /// The number of bytes does not fit the size.
    Length {
        /// Number of bytes.
        found: usize,
        /// Number of bytes that an image of this size has.
        expected: usize,
    },
    /// An image's size does not fit another image: alpha beside colours, or a level of a mip chain.
    Size {
        /// Columns and rows of that image.
        found: Size,
        /// Columns and rows that fit.
        expected: Size,
    },
}

#[cfg(feature = "defmt")]
impl defmt::Format for TextureError {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}", defmt::Debug2Format(self));
    }
}

impl core::fmt::Display for TextureError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Empty { size } => {
                write!(f, "{} x {} texels: a texture has at least one column and one row", size.width, size.height)
            }
            Self::TooLarge { size } => {
                write!(f, "{} x {} texels: a texture has at most 65,535 columns and rows", size.width, size.height)
            }
            Self::NoLevels => f.write_str("a mip chain has at least one level"),
            Self::Length { found, expected } => write!(f, "{found} bytes, but the size takes {expected}"),
            Self::Size { found, expected } => {
                let [[w, h], [width, height]] = [found, expected].map(|size| [size.width, size.height]);
                write!(f, "{w} x {h} texels instead of {width} x {height}")
            }
        }
    }
}

impl core::error::Error for TextureError {}

/// An image of any size. Its bytes are those of an embedded-graphics `ImageRaw`.
///
/// ```
/// use zstrip::embedded_graphics_core::geometry::Size;
/// use zstrip::texture::{Image, Rgb565Texel, TextureError};
/// static BYTES: [u8; 8] = [0xF8, 0x00, 0x07, 0xE0, 0x00, 0x1F, 0xFF, 0xFF];
/// let image = Image::new(&BYTES, Size::new(2, 2), Rgb565Texel)?;
/// let wider = Image::new(&BYTES, Size::new(3, 2), Rgb565Texel);
/// assert_eq!(wider.err(), Some(TextureError::Length { found: 8, expected: 12 }));
/// # let _ = image;
/// # Ok::<(), TextureError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Image<'a, F> {
    data: &'a [u8],
    width: u16,
    height: u16,
    /// Bytes per row.
    stride: usize,
    format: F,
}

impl<'a, F: TexelFormat> Image<'a, F> {
    /// Creates an image from its bytes, its size, and the format of its texels.
    ///
    /// # Errors
    /// If there are no columns or no rows, or more than 65,535; or if the number of bytes does not fit the size.
    ///
    /// A format of a number of bits that [`TexelFormat::BITS`] does not allow does not compile:
    /// ```compile_fail
    /// use zstrip::{embedded_graphics_core::geometry::Size, texture::{Image, PaletteTexel}};
    /// let image = Image::new(&[0; 3], Size::new(8, 1), PaletteTexel::<3>(&[]));
    /// ```
    pub const fn new(data: &'a [u8], size: Size, format: F) -> Result<Self, TextureError> {
        if size.width == 0 || size.height == 0 {
            return Err(TextureError::Empty { size });
        }
        let (width, height) = (size.width as u16, size.height as u16);
        if width as u32 != size.width || height as u32 != size.height {
            return Err(TextureError::TooLarge { size });
        }
        const { assert!(matches!(F::BITS, 1 | 2 | 4 | 8 | 16 | 24), "texels have 1, 2, 4, 8, 16 or 24 bits") };
        // Below 2³⁴, which `usize` may not hold. If the length is right, it does.
        let stride = (width as u64 * F::BITS as u64).div_ceil(8);
        let expected = stride * height as u64;
        if data.len() as u64 != expected {
            let expected = if expected > usize::MAX as u64 { usize::MAX } else { expected as usize };
            return Err(TextureError::Length { found: data.len(), expected });
        }
        Ok(Self { data, width, height, stride: stride as usize, format })
    }

    /// Returns the bits of a texel. Outside of the image, it returns some texel or 0; the arithmetic wraps there.
    #[inline(always)]
    fn texel(&self, x: u32, y: u32) -> u32 {
        let (x, row) = (x as usize, (y as usize).wrapping_mul(self.stride));
        match F::BITS {
            16 => match self.data.get(row.wrapping_add(x.wrapping_mul(2))..) {
                Some([high, low, ..]) => u32::from(u16::from_be_bytes([*high, *low])),
                _ => 0,
            },
            24 => match self.data.get(row.wrapping_add(x.wrapping_mul(3))..) {
                Some([r, g, b, ..]) => u32::from_be_bytes([0, *r, *g, *b]),
                _ => 0,
            },
            8 => self.data.get(row.wrapping_add(x)).copied().unwrap_or(0).into(),
            bits => {
                let first = x.wrapping_mul(bits);
                let byte = u32::from(self.data.get(row.wrapping_add(first / 8)).copied().unwrap_or(0));
                // The first texel of a byte is in its upper bits.
                byte >> (8 - bits - first % 8) & ((1 << bits) - 1)
            }
        }
    }
}

impl<F: TexelFormat> Texture for Image<'_, F> {
    #[inline(always)]
    fn size(&self) -> Size {
        Size::new(self.width.into(), self.height.into())
    }

    #[inline(always)]
    fn rgba(&self, x: u32, y: u32) -> [u8; 4] {
        self.format.rgba(self.texel(x, y))
    }

    #[inline(always)]
    fn pixel<P: PixelFormat>(&self, x: u32, y: u32) -> Option<P::Raw> {
        self.format.pixel::<P>(self.texel(x, y))
    }

    const IS_RGB565: bool = F::IS_RGB565;

    #[inline(always)]
    fn rgb565(&self, x: u32, y: u32) -> u16 {
        self.format.rgb565(self.texel(x, y))
    }
}

/// A texture of RGB565 for the fastest loop: its sides are powers of two, and known to the compiler.
///
/// ```
/// use zstrip::texture::Tile;
/// static TEXELS: [[u16; 4]; 2] = [[0xF800, 0, 0xF800, 0], [0, 0xF800, 0, 0xF800]];
/// static TILE: Tile<'static, 4, 2> = Tile::new(&TEXELS);
/// ```
/// Other sides do not compile.
/// ```compile_fail
/// let tile = zstrip::texture::Tile::new(&[[0; 3]; 2]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Tile<'a, const W: usize, const H: usize>(&'a [[u16; W]; H]);

impl<'a, const W: usize, const H: usize> Tile<'a, W, H> {
    /// Creates a tile from rows of texels, in the processor's byte order.
    #[must_use]
    pub const fn new(texels: &'a [[u16; W]; H]) -> Self {
        const { assert!(W.is_power_of_two() && H.is_power_of_two(), "the sides of a tile are powers of two") };
        const { assert!(W <= 1 << 15 && H <= 1 << 15, "the sides of a tile are at most 32,768") };
        Self(texels)
    }
}

impl<const W: usize, const H: usize> Texture for Tile<'_, W, H> {
    #[inline(always)]
    fn size(&self) -> Size {
        Size::new(W as u32, H as u32)
    }

    #[inline(always)]
    fn rgba(&self, x: u32, y: u32) -> [u8; 4] {
        expand(self.rgb565(x, y))
    }

    #[inline(always)]
    fn pixel<P: PixelFormat>(&self, x: u32, y: u32) -> Option<P::Raw> {
        Some(P::from_rgb565(self.rgb565(x, y)))
    }

    const IS_RGB565: bool = true;

    /// Returns the texel as RGB565. The tile repeats outside of its sides.
    #[inline(always)]
    fn rgb565(&self, x: u32, y: u32) -> u16 {
        // The indices are always in range, and the compiler sees that.
        self.0.get(y as usize % H).and_then(|row| row.get(x as usize % W)).copied().unwrap_or(0)
    }

    #[inline(always)]
    fn fetch<P: PixelFormat>(&self, vu: u32) -> Option<P::Raw> {
        let (columns, rows) = (W.trailing_zeros(), H.trailing_zeros());
        if columns + rows > 16 || rows > 8 || rows == 0 {
            return self.pixel::<P>(vu >> (16 - columns), vu >> 16 >> (16 - rows));
        }
        // The upper bits of u and of v are kept, and those of u are moved up next to those of v: that is the texel's
        // number.
        let bits = vu & (!(u32::MAX >> rows) | (0xFFFF ^ 0xFFFF >> columns));
        let number = (bits | bits << (16 - rows)) >> (32 - rows - columns);
        // The number is always in range, and the compiler sees that.
        Some(P::from_rgb565(self.0.as_flattened().get(number as usize).copied().unwrap_or(0)))
    }
}

/// A texture with alpha beside its colours. Alpha has 4 bits per texel, from 0, transparent, to 15, opaque. Two texels
/// share a byte, with the first one in the upper bits.
#[derive(Clone, Copy, Debug)]
pub struct WithAlpha<'a, T> {
    texture: T,
    alpha: Image<'a, crate::texture::PaletteTexel<'a, 4>>,
}

impl<'a, T: Texture> WithAlpha<'a, T> {
    /// Combines a texture with the bytes of its alpha. Each row of alpha starts at a whole byte.
    ///
    /// # Errors
    /// If the number of bytes does not fit the texture's size.
    pub fn new(texture: T, alpha: &'a [u8]) -> Result<Self, TextureError> {
        let alpha = Image::new(alpha, texture.size(), crate::texture::PaletteTexel(&[]))?;
        Ok(Self { texture, alpha })
    }
}

impl<T: Texture> Texture for WithAlpha<'_, T> {
    #[inline(always)]
    fn size(&self) -> Size {
        self.texture.size()
    }

    #[inline(always)]
    fn rgba(&self, x: u32, y: u32) -> [u8; 4] {
        let [r, g, b, _] = self.texture.rgba(x, y);
        [r, g, b, (self.alpha.texel(x, y) * 17) as u8]
    }

    #[inline(always)]
    fn pixel<P: PixelFormat>(&self, x: u32, y: u32) -> Option<P::Raw> {
        let [r, g, b, a] = self.rgba(x, y);
        if a >= OPAQUE { Some(P::pack([r, g, b])) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::super::texel::{PaletteTexel, Rgb565Texel, Rgb888Texel};
    use super::*;
    use embedded_graphics_core::pixelcolor::Rgb888;

    #[test]
    fn images_check_their_length() {
        let size = Size::new(0, 4);
        assert_eq!(Image::new(&[], size, Rgb565Texel).err(), Some(TextureError::Empty { size }));
        let size = Size::new(1, 1 << 16);
        assert_eq!(Image::new(&[], size, Rgb565Texel).err(), Some(TextureError::TooLarge { size }));
        let expected = TextureError::Length { found: 5, expected: 4 };
        // Nine texels of one bit take two bytes.
        assert_eq!(Image::new(&[0; 5], Size::new(9, 2), PaletteTexel::<1>(&[])).err(), Some(expected));
        assert!(Image::new(&[0; 4], Size::new(9, 2), PaletteTexel::<1>(&[])).is_ok());
        let colors = Image::new(&[0; 12], Size::new(2, 2), Rgb888Texel).expect("an image");
        assert_eq!(WithAlpha::new(colors, &[0; 3]).err(), Some(TextureError::Length { found: 3, expected: 2 }));
    }

    #[test]
    fn texels_are_where_image_raw_has_them() {
        let palette: [[u8; 3]; 16] = core::array::from_fn(|k| [k as u8; 3]);
        let four =
            Image::new(&[0x12, 0x30, 0x45, 0x60], Size::new(3, 2), PaletteTexel::<4>(&palette)).expect("an image");
        let found: [u8; 6] = core::array::from_fn(|k| four.rgba(k as u32 % 3, k as u32 / 3)[0]);
        assert_eq!(found, [1, 2, 3, 4, 5, 6]);
        let two = Image::new(&[0b0001_1011], Size::new(4, 1), PaletteTexel::<2>(&palette)).expect("an image");
        assert_eq!([0, 1, 2, 3].map(|x| two.rgba(x, 0)[0]), [0, 1, 2, 3]);
        let alpha = WithAlpha::new(four, &[0x8F, 0x70, 0x00, 0x00]).expect("an image");
        assert_eq!([0, 1, 2].map(|x| alpha.rgba(x, 0)), [[1, 1, 1, 136], [2, 2, 2, 255], [3, 3, 3, 119]]);
        assert_eq!(alpha.pixel::<Rgb888>(0, 0), Some([1, 1, 1]));
        assert_eq!(alpha.pixel::<Rgb888>(2, 0), None);
    }

    #[test]
    fn tiles_and_images_are_the_same() {
        let texels: [[u16; 8]; 4] =
            core::array::from_fn(|y| core::array::from_fn(|x| ((8 * y + x) as u16).wrapping_mul(0x0843)));
        let mut bytes = [0; 64];
        for (pair, texel) in bytes.chunks_exact_mut(2).zip(texels.iter().flatten()) {
            pair.copy_from_slice(&texel.to_be_bytes());
        }
        let (tile, image) = (Tile::new(&texels), Image::new(&bytes, Size::new(8, 4), Rgb565Texel).expect("an image"));
        for k in 0..32 * 256 {
            let vu = u32::wrapping_mul(k, 0x0123_4567);
            assert_eq!(tile.fetch::<Rgb888>(vu), image.fetch::<Rgb888>(vu), "{vu:x}");
            let (x, y) = (k % 8, k / 8 % 4);
            assert_eq!(tile.rgba(x, y), image.rgba(x, y));
        }
    }
}
