//! Structures of what a model looks like: materials and textures.

use bytemuck::{Pod, Zeroable};

/// A way to treat alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum AlphaMode {
    /// Alpha is ignored, that of the texture too.
    Opaque,
    /// Pixels whose alpha is below the cutoff are not drawn. Alpha is that of the texture times that of the material.
    Mask,
    /// Colours are blended by alpha with what is there, and depth is not written.
    Blend,
}

impl AlphaMode {
    /// Returns the mode of a number.
    #[must_use]
    pub const fn of(number: u8) -> Option<Self> {
        match number {
            0 => Some(Self::Opaque),
            1 => Some(Self::Mask),
            2 => Some(Self::Blend),
            _ => None,
        }
    }
}

/// A material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Material {
    /// Red, green, blue and alpha, which the texture and the colours of vertices are multiplied by.
    pub color: [u8; 4],
    /// Colour of highlights.
    pub specular: [u8; 3],
    /// Exponent of highlights, 0 for none.
    pub shininess: u8,
    /// Texture, or [`NONE`](crate::model::container::NONE).
    pub texture: u16,
    /// Number of an [`AlphaMode`].
    pub alpha_mode: u8,
    /// The least alpha that is drawn in [`AlphaMode::Mask`].
    pub cutoff: u8,
    /// Bits: [`DOUBLE_SIDED`](Self::DOUBLE_SIDED), [`UNLIT`](Self::UNLIT).
    pub flags: u32,
}

impl Material {
    /// Bit of [`flags`](Self::flags): faces are drawn that show their back.
    pub const DOUBLE_SIDED: u32 = 1;
    /// Bit of [`flags`](Self::flags): light changes nothing.
    pub const UNLIT: u32 = 2;
}

/// A format of texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum TextureFormat {
    /// RGB565, 16 bits, the lower byte first. The first byte has an even number.
    Rgb565,
    /// Numbers of colours of a palette, 8 bits.
    Palette8,
    /// Numbers of colours of a palette, 4 bits.
    Palette4,
    /// Numbers of colours of a palette, 2 bits.
    Palette2,
    /// Numbers of colours of a palette, 1 bit.
    Palette1,
    /// Grey, 8 bits.
    Gray8,
    /// White, with 1 bit of alpha: 0 is transparent.
    Mask,
}

impl TextureFormat {
    /// Returns the format of a number.
    #[must_use]
    pub const fn of(number: u8) -> Option<Self> {
        match number {
            0 => Some(Self::Rgb565),
            1 => Some(Self::Palette8),
            2 => Some(Self::Palette4),
            3 => Some(Self::Palette2),
            4 => Some(Self::Palette1),
            5 => Some(Self::Gray8),
            6 => Some(Self::Mask),
            _ => None,
        }
    }

    /// Returns the number of bits of a texel.
    #[must_use]
    pub const fn bits(self) -> usize {
        match self {
            Self::Rgb565 => 16,
            Self::Palette8 | Self::Gray8 => 8,
            Self::Palette4 => 4,
            Self::Palette2 => 2,
            Self::Palette1 | Self::Mask => 1,
        }
    }

    /// Returns the number of bytes of an image: rows start at whole bytes. At most 2³³.
    #[must_use]
    pub const fn bytes(self, width: u16, height: u16) -> u64 {
        (width as u64 * self.bits() as u64).div_ceil(8) * height as u64
    }
}

/// A texture, which repeats beyond its sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Texture {
    /// Columns of the first level, at least 1.
    pub width: u16,
    /// Rows of the first level, at least 1.
    pub height: u16,
    /// Number of a [`TextureFormat`].
    pub format: u8,
    /// Number of levels, at least 1: each has half the sides of the level before, rounded down, at least 1.
    pub levels: u8,
    /// Number of colours of the palette, three bytes each; 0 for formats without one.
    pub colors: u16,
    /// First byte of the first level. The bytes of the other levels follow it, one level after the other.
    pub texels: u32,
    /// First byte of the palette.
    pub palette: u32,
    /// First byte of alpha: 4 bits per texel, in levels as the texels; or
    /// [`NONE_LONG`](crate::model::container::NONE_LONG).
    pub alpha: u32,
}
