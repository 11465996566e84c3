//! Where finished strips go.

use crate::color::PixelFormat;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::Point;
use embedded_graphics_core::primitives::Rectangle;

/// A finished strip: whole rows of the screen, from left to right and from top to bottom.
#[derive(Clone, Copy, Debug)]
pub struct StripPixels<'a, P: PixelFormat> {
    area: Rectangle,
    pixels: &'a [P::Raw],
}

impl<'a, P: PixelFormat> StripPixels<'a, P> {
    pub(crate) const fn new(area: Rectangle, pixels: &'a [P::Raw]) -> Self {
        Self { area, pixels }
    }

    /// The part of the screen it covers.
    pub const fn area(&self) -> Rectangle {
        self.area
    }

    /// Its pixels, as many as the area has.
    pub const fn pixels(&self) -> &'a [P::Raw] {
        self.pixels
    }

    /// Its pixels as bytes: ready for a display's bus, in formats made for it such as
    /// [`Rgb565Be`](crate::color::Rgb565Be).
    pub fn bytes(&self) -> &'a [u8] {
        bytemuck::cast_slice(self.pixels)
    }

    /// Its pixels as embedded-graphics colours.
    pub fn colors(&self) -> impl Iterator<Item = P::Color> + use<'a, P> {
        self.pixels.iter().map(|raw| P::to_color(*raw))
    }
}

/// Takes the strips of a frame, from top to bottom. A closure will do.
pub trait StripSink<P: PixelFormat> {
    /// What can go wrong; it ends the frame.
    type Error;

    /// Takes a strip; called once for each.
    ///
    /// # Errors
    /// The sink's own; the frame stops and hands it on.
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
    /// From the display's own corner on.
    pub const fn new(display: &'d mut D) -> Self {
        Self::at(display, Point::zero())
    }

    /// As a rectangle of the display with its corner at `top_left`; what is off the display is the display's to leave out.
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
