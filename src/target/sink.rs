//! Finished strips, and sinks that take them.

use crate::color::PixelFormat;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::Point;
use embedded_graphics_core::primitives::Rectangle;

/// A finished strip: whole rows of the screen, from left to right and from top to bottom.
///
/// It holds exactly the part of the colour buffer that has the strip's pixels. The last strip of a frame may have
/// fewer rows than the others; the buffer holds old pixels after them.
#[derive(Debug)]
pub struct StripPixels<'c, P: PixelFormat> {
    area: Rectangle,
    pixels: &'c mut [P::Raw],
}

impl<'c, P: PixelFormat> StripPixels<'c, P> {
    pub(crate) const fn new(area: Rectangle, pixels: &'c mut [P::Raw]) -> Self {
        Self { area, pixels }
    }

    /// Returns the part of the screen that the strip covers.
    #[must_use]
    pub const fn area(&self) -> Rectangle {
        self.area
    }

    /// Returns the pixels, as many as the area has.
    #[must_use]
    pub const fn pixels(&self) -> &[P::Raw] {
        self.pixels
    }

    /// Returns the pixels as bytes: ready for a display's bus, in formats made for it such as
    /// [`Rgb565Be`](crate::color::Rgb565Be).
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(self.pixels)
    }

    /// Returns the pixels as embedded-graphics colours.
    pub fn colors(&self) -> impl Iterator<Item = P::Color> + use<'_, 'c, P> {
        self.pixels.iter().map(|raw| P::to_color(*raw))
    }

    /// Gives back the part of the buffer that holds the strip, for as long as the buffer was lent: `'static` for a DMA
    /// transfer, if the buffer was handed over as `'static`.
    ///
    /// The rest of a longer buffer cannot be joined to it again. So a `'static` buffer is lent (`&mut *buffer`) where
    /// the last strip of a frame is shorter than the others, and only then moved into the transfer.
    #[must_use]
    pub const fn into_pixels(self) -> &'c mut [P::Raw] {
        self.pixels
    }

    /// Gives back the part of the buffer that holds the strip, as bytes.
    #[must_use]
    pub fn into_bytes(self) -> &'c mut [u8] {
        bytemuck::cast_slice_mut(self.pixels)
    }
}

/// Takes the strips of a frame, from top to bottom.
///
/// A closure will do. Where its error type is not known otherwise, it ends in `Ok::<(),
/// core::convert::Infallible>(())`.
pub trait StripSink<P: PixelFormat> {
    /// The error of a sink; it ends the frame.
    type Error;

    /// Takes a strip. It is called once per strip.
    ///
    /// # Errors
    /// The sink's own error. The frame ends and returns it.
    fn strip(&mut self, strip: &StripPixels<'_, P>) -> Result<(), Self::Error>;
}

impl<P: PixelFormat, E, F: FnMut(&StripPixels<'_, P>) -> Result<(), E>> StripSink<P> for F {
    type Error = E;

    fn strip(&mut self, strip: &StripPixels<'_, P>) -> Result<(), E> {
        self(strip)
    }
}

/// Any embedded-graphics display as a sink: strips arrive through `fill_contiguous`.
#[derive(Debug)]
pub struct OnDisplay<'d, D> {
    display: &'d mut D,
    top_left: Point,
}

impl<'d, D> OnDisplay<'d, D> {
    /// Makes a sink that draws from the display's own corner on.
    pub const fn new(display: &'d mut D) -> Self {
        Self::at(display, Point::zero())
    }

    /// Makes a sink that draws a rectangle of the display with its corner at `top_left`. The display has to leave out
    /// pixels that are off it.
    pub const fn at(display: &'d mut D, top_left: Point) -> Self {
        Self { display, top_left }
    }
}

impl<P: PixelFormat, D: DrawTarget<Color = P::Color>> StripSink<P> for OnDisplay<'_, D> {
    type Error = D::Error;

    fn strip(&mut self, strip: &StripPixels<'_, P>) -> Result<(), D::Error> {
        let Rectangle { top_left: Point { x, y }, size } = strip.area;
        let corner = Point::new(self.top_left.x.saturating_add(x), self.top_left.y.saturating_add(y));
        self.display.fill_contiguous(&Rectangle::new(corner, size), strip.colors())
    }
}
