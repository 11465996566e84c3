//! The textures of a model: RGB565 for the fastest loop, and all other formats in one type.

use super::container::{NONE_LONG, Texture as TextureItem, TextureFormat};
use super::read::{Model, items};
use crate::color::PixelFormat;
use crate::texture::{Gray8Texel, Image, MaskTexel, PaletteTexel, TexelFormat, Texture};
use embedded_graphics_core::geometry::Size;

/// A texture of RGB565 in the processor's byte order, of any size.
#[derive(Clone, Copy, Debug)]
pub struct Texels<'a> {
    texels: &'a [u16],
    width: u16,
    height: u16,
}

impl Texture for Texels<'_> {
    #[inline(always)]
    fn size(&self) -> Size {
        Size::new(self.width.into(), self.height.into())
    }

    #[inline(always)]
    fn rgba(&self, x: u32, y: u32) -> [u8; 4] {
        let [r, g, b] = crate::color::unpack_rgb565(self.rgb565(x, y));
        [r, g, b, 255]
    }

    #[inline(always)]
    fn pixel<P: PixelFormat>(&self, x: u32, y: u32) -> Option<P::Raw> {
        Some(P::from_rgb565(self.rgb565(x, y)))
    }

    const IS_RGB565: bool = true;

    #[inline(always)]
    fn rgb565(&self, x: u32, y: u32) -> u16 {
        let at = y.wrapping_mul(self.width.into()).wrapping_add(x);
        self.texels.get(at as usize).copied().unwrap_or(0)
    }
}

/// A texture of any format of a container, with alpha if it has some. Each texel asks for its format.
#[derive(Clone, Copy, Debug)]
pub struct AnyTexels<'a> {
    kind: Kind<'a>,
    alpha: Option<Image<'a, PaletteTexel<'a, 4>>>,
    /// A factor of alpha, 255 = 1. `None` if alpha is ignored.
    opacity: Option<u8>,
}

#[derive(Clone, Copy, Debug)]
enum Kind<'a> {
    Rgb565(Texels<'a>),
    Palette8(Image<'a, PaletteTexel<'a, 8>>),
    Palette4(Image<'a, PaletteTexel<'a, 4>>),
    Palette2(Image<'a, PaletteTexel<'a, 2>>),
    Palette1(Image<'a, PaletteTexel<'a, 1>>),
    Gray8(Image<'a, Gray8Texel>),
    Mask(Image<'a, MaskTexel>),
}

impl AnyTexels<'_> {
    #[inline]
    fn colors(&self, x: u32, y: u32) -> [u8; 4] {
        match &self.kind {
            Kind::Rgb565(image) => image.rgba(x, y),
            Kind::Palette8(image) => image.rgba(x, y),
            Kind::Palette4(image) => image.rgba(x, y),
            Kind::Palette2(image) => image.rgba(x, y),
            Kind::Palette1(image) => image.rgba(x, y),
            Kind::Gray8(image) => image.rgba(x, y),
            // White, whatever alpha is.
            Kind::Mask(image) => {
                let [.., a] = image.rgba(x, y);
                [255, 255, 255, a]
            }
        }
    }
}

impl Texture for AnyTexels<'_> {
    #[inline]
    fn size(&self) -> Size {
        match &self.kind {
            Kind::Rgb565(image) => image.size(),
            Kind::Palette8(image) => image.size(),
            Kind::Palette4(image) => image.size(),
            Kind::Palette2(image) => image.size(),
            Kind::Palette1(image) => image.size(),
            Kind::Gray8(image) => image.size(),
            Kind::Mask(image) => image.size(),
        }
    }

    #[inline(never)]
    fn rgba(&self, x: u32, y: u32) -> [u8; 4] {
        let [r, g, b, mut a] = self.colors(x, y);
        let Some(opacity) = self.opacity else { return [r, g, b, u8::MAX] };
        if let Some(alpha) = &self.alpha {
            // Each colour of this palette is its number in 15ths.
            [a, ..] = alpha.rgba(x, y);
        }
        // The product / 255, rounded.
        let product = u32::from(a) * u32::from(opacity) + 128;
        [r, g, b, ((product + (product >> 8)) >> 8) as u8]
    }

    #[inline]
    fn pixel<P: PixelFormat>(&self, x: u32, y: u32) -> Option<P::Raw> {
        let [r, g, b, a] = self.rgba(x, y);
        if a >= crate::texture::OPAQUE { Some(P::pack([r, g, b])) } else { None }
    }
}

/// Sixteen steps of alpha.
static ALPHA: [[u8; 3]; 16] = {
    let (mut steps, mut k) = ([[0; 3]; 16], 0);
    while k < 16 {
        steps[k] = [k as u8 * 17; 3];
        k += 1;
    }
    steps
};

/// A texture of a model at one level.
#[derive(Clone, Copy, Debug)]
pub(super) enum LevelTexels<'a> {
    /// RGB565 without alpha.
    Rgb565(Texels<'a>),
    Other(AnyTexels<'a>),
}

impl<'a> LevelTexels<'a> {
    /// Returns the texture in the type of all formats, with a factor of alpha, 255 = 1; `None` if alpha is ignored.
    pub(super) const fn any(&self, opacity: Option<u8>) -> AnyTexels<'a> {
        match *self {
            Self::Rgb565(texels) => AnyTexels { kind: Kind::Rgb565(texels), alpha: None, opacity },
            Self::Other(texels) => AnyTexels { opacity, ..texels },
        }
    }
}

impl<'a> Model<'a> {
    /// Returns a level of a texture, with its alpha if that is asked for. The last level stands for those past it.
    pub(super) fn level(&self, texture: &TextureItem, level: u8, with_alpha: bool) -> Option<LevelTexels<'a>> {
        let level = level.min(texture.levels.saturating_sub(1));
        let (width, height) = texture.size(level);
        let format = TextureFormat::of(texture.format)?;
        let bytes = |first: u32, format: TextureFormat| {
            let first = first as usize + texture.bytes_before(format, level) as usize;
            self.bytes.get(first..).and_then(|rest| rest.get(..format.bytes(width, height) as usize))
        };
        let data = bytes(texture.texels, format)?;
        let size = Size::new(width.into(), height.into());
        let alpha = match texture.alpha {
            first if first == NONE_LONG || !with_alpha => None,
            first => Some(image(bytes(first, TextureFormat::Palette4)?, size, PaletteTexel(&ALPHA))?),
        };
        let palette = items(self.bytes, texture.palette, 3 * usize::from(texture.colors));
        let palette: &[[u8; 3]] = bytemuck::try_cast_slice(palette).ok()?;
        let kind = match format {
            TextureFormat::Rgb565 => {
                let texels = Texels { texels: bytemuck::try_cast_slice(data).ok()?, width, height };
                if alpha.is_none() {
                    return Some(LevelTexels::Rgb565(texels));
                }
                Kind::Rgb565(texels)
            }
            TextureFormat::Palette8 => Kind::Palette8(image(data, size, PaletteTexel(palette))?),
            TextureFormat::Palette4 => Kind::Palette4(image(data, size, PaletteTexel(palette))?),
            TextureFormat::Palette2 => Kind::Palette2(image(data, size, PaletteTexel(palette))?),
            TextureFormat::Palette1 => Kind::Palette1(image(data, size, PaletteTexel(palette))?),
            TextureFormat::Gray8 => Kind::Gray8(image(data, size, Gray8Texel)?),
            TextureFormat::Mask => Kind::Mask(image(data, size, MaskTexel([255; 3]))?),
        };
        Some(LevelTexels::Other(AnyTexels { kind, alpha, opacity: None }))
    }
}

/// Returns an image whose length was checked before.
fn image<F: TexelFormat>(data: &[u8], size: Size, format: F) -> Option<Image<'_, F>> {
    Image::new(data, size, format).ok()
}
