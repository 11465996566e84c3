//! Text that can be turned and scaled: embedded-graphics draws into a small buffer of opacities, which is a texture in
//! any colour.

use crate::color::{PixelFormat, channels};
use crate::texture::{OPAQUE, Texture, TextureError};
use core::convert::Infallible;
use embedded_graphics_core::Pixel;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{OriginDimensions, Size};
use embedded_graphics_core::pixelcolor::{BinaryColor, Rgb888};

/// A buffer of opacities, one byte per pixel, that embedded-graphics draws text and shapes into. As a
/// [`Tinted`] texture, it is drawn as a [`Sprite`](crate::shape::Sprite): turned, scaled, in any colour.
///
/// ```
/// use zstrip::embedded_graphics_core::geometry::Size;
/// use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};
/// use zstrip::shader::{Alpha, Blend};
/// use zstrip::shape::{Sprite, Stencil};
/// use zstrip::texture::Bilinear;
/// let mut bytes = [0; 60 * 10];
/// let mut stencil = Stencil::new(&mut bytes, Size::new(60, 10))?;
/// // Text::with_baseline("speed", Point::zero(), style, Baseline::Top).draw(&mut stencil);
/// let text = stencil.tinted(Rgb888::WHITE);
/// let sprite = Sprite::new(&text).filter(Bilinear);
/// // canvas.fill_with(&sprite, &Blend::new(sprite, Alpha), 0, &mut buffer);
/// # let _ = Blend::new(sprite, Alpha);
/// # Ok::<(), zstrip::texture::TextureError>(())
/// ```
#[derive(Debug)]
pub struct Stencil<'b> {
    bytes: &'b mut [u8],
    size: Size,
}

impl<'b> Stencil<'b> {
    /// Makes a buffer without any opacity of bytes, row by row.
    ///
    /// # Errors
    /// If there are no columns or no rows, or more than 65,535; or if the number of bytes does not fit the size.
    pub fn new(bytes: &'b mut [u8], size: Size) -> Result<Self, TextureError> {
        check(bytes.len(), size)?;
        bytes.fill(0);
        Ok(Self { bytes, size })
    }

    /// Returns the texture of a colour that is as opaque as the buffer says.
    #[must_use]
    pub fn tinted(&self, color: impl Into<Rgb888>) -> Tinted<'_> {
        Tinted { bytes: self.bytes, size: self.size, color: channels(color.into()) }
    }
}

/// Checks a size, and that a number of bytes fits it.
fn check(found: usize, size: Size) -> Result<(), TextureError> {
    if size.width == 0 || size.height == 0 {
        return Err(TextureError::Empty { size });
    }
    if size.width.max(size.height) > 65_535 {
        return Err(TextureError::TooLarge { size });
    }
    let expected = usize::try_from(u64::from(size.width) * u64::from(size.height)).unwrap_or(usize::MAX);
    if found != expected {
        return Err(TextureError::Length { found, expected });
    }
    Ok(())
}

impl OriginDimensions for Stencil<'_> {
    fn size(&self) -> Size {
        self.size
    }
}

impl DrawTarget for Stencil<'_> {
    type Color = BinaryColor;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<BinaryColor>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(point, color) in pixels {
            // Negative numbers become larger than any size.
            let (x, y) = (point.x as u32, point.y as u32);
            if x < self.size.width {
                let at = (y as usize).checked_mul(self.size.width as usize).and_then(|row| row.checked_add(x as usize));
                if let Some(byte) = at.and_then(|at| self.bytes.get_mut(at)) {
                    *byte = if color.is_on() { 255 } else { 0 };
                }
            }
        }
        Ok(())
    }
}

/// A texture of one colour, whose opacity is that of a [`Stencil`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tinted<'b> {
    bytes: &'b [u8],
    size: Size,
    color: [u8; 3],
}

impl<'b> Tinted<'b> {
    /// Makes a texture of opacities that are kept elsewhere, one byte per texel.
    ///
    /// # Errors
    /// Those of [`Stencil::new`].
    pub fn new(bytes: &'b [u8], size: Size, color: impl Into<Rgb888>) -> Result<Self, TextureError> {
        check(bytes.len(), size)?;
        Ok(Self { bytes, size, color: channels(color.into()) })
    }

    /// Returns the texture in another colour.
    #[must_use]
    pub fn in_color(self, color: impl Into<Rgb888>) -> Tinted<'b> {
        Self { color: channels(color.into()), ..self }
    }

    #[inline(always)]
    fn opacity(&self, x: u32, y: u32) -> u8 {
        self.bytes
            .get((y as usize).wrapping_mul(self.size.width as usize).wrapping_add(x as usize))
            .copied()
            .unwrap_or(0)
    }
}

impl Texture for Tinted<'_> {
    #[inline(always)]
    fn size(&self) -> Size {
        self.size
    }

    #[inline(always)]
    fn rgba(&self, x: u32, y: u32) -> [u8; 4] {
        let [r, g, b] = self.color;
        [r, g, b, self.opacity(x, y)]
    }

    #[inline(always)]
    fn pixel<P: PixelFormat>(&self, x: u32, y: u32) -> Option<P::Raw> {
        (self.opacity(x, y) >= OPAQUE).then(|| P::pack(self.color))
    }
}
