//! 2-D drawing into the strip: an embedded-graphics target over whatever is being drawn just now.
//!
//! Its bounding box is the whole screen, so that what is drawn does not depend on strips; pixels outside of the current
//! strip are left out. Areas are cut before their pixels are looked at, [`Canvas::draw`] leaves out what has no pixel in the
//! strip, and single pixels cost a comparison.

use super::Framebuffer;
use crate::fragment::{DepthTest, MAX_SPAN, PixelFormat, fill};
use crate::raster::PixelRect;
use core::convert::Infallible;
use core::ops::Range;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Dimensions, OriginDimensions, Size};
use embedded_graphics_core::primitives::Rectangle;
use embedded_graphics_core::{Drawable, Pixel};

/// What a framebuffer's pixels are in memory, and as colours.
type Raw<F> = <<F as Framebuffer>::Format as PixelFormat>::Raw;
type Color<F> = <<F as Framebuffer>::Format as PixelFormat>::Color;

/// A target for embedded-graphics, over the strip that is being drawn; from [`Scene::overlay`](crate::Scene::overlay) and
/// [`Scene::at_depth`](crate::Scene::at_depth).
///
/// While the closure is only recorded there are no pixels, and drawing does nothing.
#[derive(Debug)]
pub struct Canvas<'c, F, D> {
    /// None while the closure is recorded.
    framebuffer: Option<&'c mut F>,
    /// Depths of the strip's rows, one after the other; empty where there are none, so that every test passes.
    depth: &'c mut [u16],
    first_row: i32,
    screen: (u16, u16),
    /// Pixels that are drawn: never outside of the strip.
    clip: PixelRect,
    z: u16,
    test: D,
}

impl<'c, F: Framebuffer, D: DepthTest> Canvas<'c, F, D> {
    /// Over `rows` of a screen.
    pub(crate) fn new(
        target: Option<(&'c mut F, &'c mut [u16], Range<i32>)>,
        screen: (u16, u16),
        z: u16,
        test: D,
    ) -> Self {
        let (framebuffer, depth, rows) = match target {
            Some((framebuffer, depth, rows)) => (Some(framebuffer), depth, rows),
            None => (None, Default::default(), 0..0),
        };
        let clip = PixelRect { x: 0..i32::from(screen.0), y: rows };
        Self { framebuffer, depth, first_row: clip.y.start, screen, clip, z, test }
    }

    /// Whether any pixel of an area is drawn just now; where not, what draws nothing outside of it need not be drawn.
    ///
    /// The answer changes from strip to strip, so it must not decide about meshes, which have to be drawn each time.
    #[inline(never)]
    pub fn is_visible(&self, area: &Rectangle) -> bool {
        !self.clip.intersection(&pixels(area)).is_empty()
    }

    /// Draws what has no pixel outside of its bounding box, if that touches the strip: a lot cheaper than
    /// [`Drawable::draw`] for what does not, as text, images and shapes look at all of their pixels otherwise.
    ///
    /// Pixels outside of the bounding box are not drawn. (The box of underlined text, in embedded-graphics 0.8, ends at the
    /// underline: draw that as it is.)
    pub fn draw<T: Drawable<Color = Color<F>> + Dimensions>(&mut self, drawable: &T) {
        let area = drawable.bounding_box();
        if self.is_visible(&area) {
            let clip = self.clip.intersection(&pixels(&area));
            let mut part = Canvas {
                framebuffer: self.framebuffer.as_deref_mut(),
                depth: self.depth,
                clip,
                first_row: self.first_row,
                screen: self.screen,
                z: self.z,
                test: self.test,
            };
            let Ok(_) = drawable.draw(&mut part);
        }
    }
}

/// The pixels of an area; cut at what 32 bits hold.
fn pixels(area: &Rectangle) -> PixelRect {
    let Rectangle { top_left, size } = *area;
    PixelRect {
        x: top_left.x..top_left.x.saturating_add_unsigned(size.width),
        y: top_left.y..top_left.y.saturating_add_unsigned(size.height),
    }
}

impl<F: Framebuffer, D: DepthTest> Canvas<'_, F, D> {
    /// Columns of a row, which lie on the screen: the pixels that there are, and what is stored of their depths; none
    /// outside of the rows that are drawn, and no depths where there is no depth buffer.
    #[inline(never)]
    fn row<'r>(
        &'r mut self,
        nothing: &'r mut [(); MAX_SPAN],
        y: i32,
        columns: &Range<i32>,
    ) -> (&'r mut [Raw<F>], &'r mut [D::Stored]) {
        match &mut self.framebuffer {
            Some(framebuffer) if self.clip.y.contains(&y) => {
                let (column, length) = (columns.start as usize, columns.len());
                let row = (y - self.first_row) as usize * usize::from(self.screen.0);
                (framebuffer.span(y as u32, column, length), D::stored(self.depth, nothing, row + column, length))
            }
            _ => Default::default(),
        }
    }
}

/// Tests a depth against the stored one, and leaves it if it passes.
#[inline(always)]
fn passes<D: DepthTest>(test: D, z: u16, stored: &mut D::Stored) -> bool {
    let passes = test.passes(z, *stored);
    if passes {
        test.write(z, stored);
    }
    passes
}

impl<F: Framebuffer, D: DepthTest> DrawTarget for Canvas<'_, F, D> {
    type Color = Color<F>;
    type Error = Infallible;

    /// Pixels that follow one another in a row cost two comparisons each, and a row is looked up once.
    fn draw_iter<I: IntoIterator<Item = Pixel<Self::Color>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        if self.clip.is_empty() {
            return Ok(());
        }
        let (test, z, columns) = (self.test, self.z, self.clip.x.clone());
        let mut nothing = [(); MAX_SPAN];
        let mut y = self.clip.y.start;
        let (mut colors, mut depths) = self.row(&mut nothing, y, &columns);
        for Pixel(point, color) in pixels {
            if point.y != y {
                y = point.y;
                (colors, depths) = self.row(&mut nothing, y, &columns);
            }
            // What is left of the columns wraps to the far right.
            let column = point.x.wrapping_sub(columns.start) as usize;
            if let Some(pixel) = colors.get_mut(column) {
                if !D::ENABLED || depths.get_mut(column).is_none_or(|stored| passes(test, z, stored)) {
                    *pixel = F::Format::from_color(color);
                }
            }
        }
        Ok(())
    }

    /// Colours of pixels that are not drawn are passed over by `Iterator::nth`, which most images have a short way for.
    fn fill_contiguous<I: IntoIterator<Item = Self::Color>>(
        &mut self,
        area: &Rectangle,
        colors: I,
    ) -> Result<(), Infallible> {
        let all = pixels(area);
        let part = self.clip.intersection(&all);
        if part.is_empty() {
            return Ok(());
        }
        let (test, z, width) = (self.test, self.z, area.size.width as usize);
        let mut nothing = [(); MAX_SPAN];
        let mut colors = colors.into_iter();
        let rows_above = part.y.start.wrapping_sub(all.y.start) as usize;
        let columns_left = part.x.start.wrapping_sub(all.x.start) as usize;
        let mut skip = rows_above.saturating_mul(width).saturating_add(columns_left);
        for y in part.y {
            if skip > 0 && colors.nth(skip - 1).is_none() {
                return Ok(());
            }
            let (row, depths) = self.row(&mut nothing, y, &part.x);
            // Less than the whole area's width has been drawn, or all of it.
            skip = width.wrapping_sub(row.len());
            let mut depths = depths.iter_mut();
            for (pixel, color) in row.iter_mut().zip(&mut colors) {
                if !D::ENABLED || depths.next().is_none_or(|stored| passes(test, z, stored)) {
                    *pixel = F::Format::from_color(color);
                }
            }
        }
        Ok(())
    }

    #[inline(never)]
    fn fill_solid(&mut self, area: &Rectangle, color: Self::Color) -> Result<(), Infallible> {
        let part = self.clip.intersection(&pixels(area));
        if part.is_empty() {
            return Ok(());
        }
        let (test, z, value) = (self.test, self.z, F::Format::from_color(color));
        let mut nothing = [(); MAX_SPAN];
        for y in part.y {
            let (row, depths) = self.row(&mut nothing, y, &part.x);
            if D::ENABLED && !depths.is_empty() {
                for (pixel, stored) in row.iter_mut().zip(depths) {
                    if passes(test, z, stored) {
                        *pixel = value;
                    }
                }
            } else {
                fill(row, value);
            }
        }
        Ok(())
    }
}

impl<F, D> OriginDimensions for Canvas<'_, F, D> {
    fn size(&self) -> Size {
        Size::new(u32::from(self.screen.0), u32::from(self.screen.1))
    }
}
