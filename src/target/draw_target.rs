//! 2-D drawing: an embedded-graphics target over the strip that is being drawn.
//!
//! Its bounding box is the whole screen, so that a drawing does not depend on strips; pixels outside of the current
//! strip are left out. Areas are cut before their pixels are looked at. [`Overlay::draw`] leaves out drawings that
//! have no pixel in the strip, and a single pixel costs a comparison.

use super::framebuffer::Framebuffer;
use crate::color::{PixelFormat, fill};
use crate::raster::PixelRect;
use crate::span::DepthTest;
use core::convert::Infallible;
use core::marker::PhantomData;
use core::ops::Range;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Dimensions, OriginDimensions, Point, Size};
use embedded_graphics_core::image::ImageDrawable;
use embedded_graphics_core::pixelcolor::PixelColor;
use embedded_graphics_core::primitives::Rectangle;
use embedded_graphics_core::{Drawable, Pixel};

/// A framebuffer's pixels in memory, and as colours.
type Raw<F> = <<F as Framebuffer>::Format as PixelFormat>::Raw;
type Color<F> = <<F as Framebuffer>::Format as PixelFormat>::Color;

/// A target for embedded-graphics, over the strip that is being drawn; from
/// [`Scene::overlay`](crate::scene::Scene::overlay) and [`Scene::at_depth`](crate::scene::Scene::at_depth).
///
/// Pixels outside of the scene's [viewport](crate::scene::Scene::set_viewport) are left as they are. The bounding box
/// is the whole screen, whatever the viewport is. While the closure is only recorded there are no pixels, and drawing
/// does nothing.
#[derive(Debug)]
pub struct Overlay<'o, F, D> {
    /// The strip's pixels; `None` while the closure is recorded.
    framebuffer: Option<&'o mut F>,
    /// Depths of the strip's rows, one row after the other; empty without a depth buffer, so that every test passes.
    depth: &'o mut [u16],
    first_row: i32,
    screen: (u16, u16),
    /// Area that may be drawn: never outside of the strip or of the viewport.
    clip: PixelRect,
    z: u16,
    test: D,
}

/// The strip that an overlay draws into.
pub(crate) struct OverlayTarget<'o, F> {
    pub(crate) framebuffer: &'o mut F,
    pub(crate) depth: &'o mut [u16],
    pub(crate) first_row: i32,
    /// Pixels that may be drawn: in the strip and in the viewport, and at least one. The columns of an empty rectangle
    /// could be in the wrong order, and would have no length.
    pub(crate) clip: PixelRect,
}

impl<'o, F: Framebuffer, D: DepthTest> Overlay<'o, F, D> {
    /// Makes an overlay over a strip of a screen, or one that draws nothing.
    pub(crate) fn new(target: Option<OverlayTarget<'o, F>>, screen: (u16, u16), z: u16, test: D) -> Self {
        match target {
            Some(OverlayTarget { framebuffer, depth, first_row, clip }) => {
                Self { framebuffer: Some(framebuffer), depth, first_row, screen, clip, z, test }
            }
            None => {
                let clip = PixelRect { x: 0..0, y: 0..0 };
                Self { framebuffer: None, depth: Default::default(), first_row: 0, screen, clip, z, test }
            }
        }
    }

    /// Tells if any pixel of an area is in the strip that is being drawn. If none is, a drawing that stays within the
    /// area can be left out.
    ///
    /// The answer changes from strip to strip, so it must not decide about meshes, which have to be drawn in each call
    /// of the closure.
    #[inline(never)]
    pub fn is_visible(&self, area: &Rectangle) -> bool {
        !self.clip.intersection(&PixelRect::of_area(area)).is_empty()
    }

    /// Draws a drawable if its bounding box touches the strip. For drawables that do not touch it, this is a lot
    /// cheaper than [`Drawable::draw`], which looks at all pixels of text, images and shapes.
    ///
    /// Pixels outside of the bounding box are not drawn. (In embedded-graphics 0.8, the box of underlined text ends
    /// at the underline: draw such text by [`Drawable::draw`].)
    pub fn draw<T: Drawable<Color = Color<F>> + Dimensions>(&mut self, drawable: &T) {
        let area = drawable.bounding_box();
        if self.is_visible(&area) {
            let clip = self.clip.intersection(&PixelRect::of_area(&area));
            let mut part = Overlay {
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

    /// Draws the part of an image that is in the strip, with the image's corner at `top_left`. (embedded-graphics'
    /// own `Image` passes over all pixels above the strip one by one.) Colours of another type are converted.
    pub fn draw_image<T: ImageDrawable<Color: Into<Color<F>>>>(&mut self, image: &T, top_left: Point) {
        let area = PixelRect::of_area(&Rectangle::new(top_left, image.size()));
        let part = self.clip.intersection(&area);
        if part.is_empty() {
            return;
        }
        let corner = Point::new(part.x.start, part.y.start);
        let size = Size::new((part.x.end - part.x.start) as u32, (part.y.end - part.y.start) as u32);
        let (x, y) = (corner.x.checked_sub(top_left.x), corner.y.checked_sub(top_left.y));
        let (Some(x), Some(y)) = (x, y) else {
            // Coordinates of embedded-graphics have no number for the part's corner in the image.
            let Ok(()) = image.draw(&mut Moved { overlay: self, origin: top_left, color: PhantomData });
            return;
        };
        let mut moved = Moved { overlay: self, origin: corner, color: PhantomData };
        let Ok(()) = image.draw_sub_image(&mut moved, &Rectangle::new(Point::new(x, y), size));
    }

    /// Fills the part of a rectangle that may be drawn: all samples of its pixels.
    #[inline(never)]
    fn fill(&mut self, rect: &PixelRect, color: Color<F>) {
        let part = self.clip.intersection(rect);
        let Self { framebuffer: Some(framebuffer), depth, first_row, screen, z, test, .. } = self else { return };
        if part.is_empty() {
            return;
        }
        let value = F::Format::from_color(color);
        let mut nothing = [(); usize::MAX];
        let pixels = if F::SAMPLES > 1 { framebuffer.samples().map_or(0, |[pixels, _]| pixels.len()) } else { 0 };
        for sample in 0..F::SAMPLES {
            framebuffer.select_sample(sample);
            let depth = depth.get_mut(pixels.wrapping_mul(sample)..).unwrap_or_default();
            for y in part.y.clone() {
                let row = colors(*framebuffer, y, &part.x);
                let stored = depths::<D>(depth, &mut nothing, y - *first_row, screen.0, &part.x);
                if D::ENABLED && !stored.is_empty() {
                    for (pixel, stored) in row.iter_mut().zip(stored) {
                        if passes(*test, *z, stored) {
                            *pixel = value;
                        }
                    }
                } else {
                    fill(row, value);
                }
            }
        }
        framebuffer.select_sample(0);
    }
}

/// An overlay with its origin elsewhere and its colours converted: the target that images draw on.
struct Moved<'m, 'o, F, D, C> {
    overlay: &'m mut Overlay<'o, F, D>,
    origin: Point,
    color: PhantomData<C>,
}

impl<F: Framebuffer, D: DepthTest, C> Dimensions for Moved<'_, '_, F, D, C> {
    fn bounding_box(&self) -> Rectangle {
        let back = Point::new(self.origin.x.saturating_neg(), self.origin.y.saturating_neg());
        Rectangle::new(back, self.overlay.bounding_box().size)
    }
}

/// Colours that are converted. Unlike those of [`Iterator::map`], they can be passed over without making each of them.
struct Converted<I, T>(I, PhantomData<T>);

impl<T, I: Iterator<Item: Into<T>>> Iterator for Converted<I, T> {
    type Item = T;

    #[inline]
    fn next(&mut self) -> Option<T> {
        self.0.next().map(Into::into)
    }

    #[inline]
    fn nth(&mut self, n: usize) -> Option<T> {
        self.0.nth(n).map(Into::into)
    }
}

/// Moves an area; `None` if its corner would be beyond 32 bits.
fn moved(area: &Rectangle, by: Point) -> Option<Rectangle> {
    Some(Rectangle::new(plus(area.top_left, by)?, area.size))
}

/// Adds two points; `None` if the sum is beyond 32 bits. A sum that wrapped round could be on the screen.
fn plus(a: Point, b: Point) -> Option<Point> {
    Some(Point::new(a.x.checked_add(b.x)?, a.y.checked_add(b.y)?))
}

impl<F: Framebuffer, D: DepthTest, C: PixelColor + Into<Color<F>>> DrawTarget for Moved<'_, '_, F, D, C> {
    type Color = C;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        let origin = self.origin;
        let moved = |Pixel(at, color)| Some(Pixel(plus(at, origin)?, C::into(color)));
        self.overlay.draw_iter(pixels.into_iter().filter_map(moved))
    }

    fn fill_contiguous<I: IntoIterator<Item = C>>(&mut self, area: &Rectangle, colors: I) -> Result<(), Infallible> {
        let Some(area) = moved(area, self.origin) else { return Ok(()) };
        self.overlay.fill_contiguous(&area, Converted(colors.into_iter(), PhantomData))
    }

    fn fill_solid(&mut self, area: &Rectangle, color: C) -> Result<(), Infallible> {
        let Some(area) = moved(area, self.origin) else { return Ok(()) };
        self.overlay.fill_solid(&area, color.into())
    }
}

/// Returns the pixels of a row of the strip, in a range of columns; fewer, if the framebuffer has fewer. No framebuffer
/// gets more: callers count on the difference to the range.
#[inline(never)]
fn colors<'r, F: Framebuffer>(framebuffer: &'r mut F, y: i32, columns: &Range<i32>) -> &'r mut [Raw<F>] {
    let length = (columns.end - columns.start) as usize;
    let pixels = framebuffer.span(y as u32, columns.start as usize, length);
    let length = length.min(pixels.len());
    pixels.get_mut(..length).unwrap_or_default()
}

/// Returns the stored depths of a range of columns in a row; nothing without a depth buffer.
#[inline(always)]
fn depths<'r, D: DepthTest>(
    depth: &'r mut [u16],
    nothing: &'r mut [()],
    row: i32,
    width: u16,
    columns: &Range<i32>,
) -> &'r mut [D::Depth] {
    let start = (row as usize).wrapping_mul(usize::from(width)).wrapping_add(columns.start as usize);
    let stored = D::slots(depth, nothing).get_mut(start..).unwrap_or_default();
    stored.get_mut(..(columns.end - columns.start) as usize).unwrap_or_default()
}

/// Passes over items, and returns whether there were as many. A count may have more bits than an index.
fn pass_over(items: &mut impl Iterator, mut count: u64) -> bool {
    while count > 0 {
        let step = usize::try_from(count).unwrap_or(usize::MAX);
        if items.nth(step - 1).is_none() {
            return false;
        }
        count -= step as u64;
    }
    true
}

/// Tests a depth against the stored one. A depth that passes is stored.
#[inline(always)]
fn passes<D: DepthTest>(test: D, z: u16, stored: &mut D::Depth) -> bool {
    let passes = test.passes(z, *stored);
    if passes {
        test.write(z, stored);
    }
    passes
}

impl<F: Framebuffer, D: DepthTest> DrawTarget for Overlay<'_, F, D> {
    type Color = Color<F>;
    type Error = Infallible;

    /// Draws pixels. One that follows another in a row costs two comparisons; the row is looked up once.
    fn draw_iter<I: IntoIterator<Item = Pixel<Self::Color>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        if F::SAMPLES > 1 {
            for Pixel(point, color) in pixels {
                let columns = point.x..point.x.saturating_add(1);
                self.fill(&PixelRect { x: columns, y: point.y..point.y.saturating_add(1) }, color);
            }
            return Ok(());
        }
        let Self { framebuffer: Some(framebuffer), depth, first_row, screen, clip, z, test } = self else {
            return Ok(());
        };
        let (left, top, height) = (clip.x.start, clip.y.start, (clip.y.end - clip.y.start).max(0) as u32);
        let mut nothing = [(); usize::MAX];
        let mut y = i32::MIN;
        let (mut row, mut stored): (&mut [_], &mut [_]) = Default::default();
        for Pixel(point, color) in pixels {
            if point.y != y {
                if point.y.wrapping_sub(top) as u32 >= height {
                    continue;
                }
                y = point.y;
                row = colors(*framebuffer, y, &clip.x);
                stored = depths::<D>(depth, &mut nothing, y - *first_row, screen.0, &clip.x);
            }
            // For columns to the left of the row, the difference wraps to a number beyond its end.
            let column = point.x.wrapping_sub(left) as usize;
            if let Some(pixel) = row.get_mut(column) {
                if !D::ENABLED || stored.get_mut(column).is_none_or(|stored| passes(*test, *z, stored)) {
                    *pixel = F::Format::from_color(color);
                }
            }
        }
        Ok(())
    }

    /// Fills an area. `Iterator::nth` passes over the colours of pixels that are not drawn, however many the area has
    /// of them.
    fn fill_contiguous<I: IntoIterator<Item = Self::Color>>(
        &mut self,
        area: &Rectangle,
        colors_of_all: I,
    ) -> Result<(), Infallible> {
        let all = PixelRect::of_area(area);
        let part = self.clip.intersection(&all);
        if part.is_empty() {
            return Ok(());
        }
        let width = area.size.width as usize;
        let mut nothing = [(); usize::MAX];
        let mut new = colors_of_all.into_iter();
        // Differences of 32-bit numbers need 32 bits without a sign, and the number of colours has 64 bits.
        let rows_above = part.y.start.wrapping_sub(all.y.start) as u32;
        let columns_left = part.x.start.wrapping_sub(all.x.start) as u32;
        let first = u64::from(rows_above) * u64::from(area.size.width) + u64::from(columns_left);
        if !pass_over(&mut new, first) {
            return Ok(());
        }
        let mut skip = 0_usize;
        for y in part.y {
            if skip > 0 && new.nth(skip - 1).is_none() {
                return Ok(());
            }
            if F::SAMPLES > 1 {
                for (x, color) in part.x.clone().zip(&mut new) {
                    self.fill(&PixelRect { x: x..x + 1, y: y..y + 1 }, color);
                }
                skip = width.wrapping_sub(part.x.len());
                continue;
            }
            let Self { framebuffer: Some(framebuffer), depth, first_row, screen, z, test, .. } = self else {
                return Ok(());
            };
            let row = colors(*framebuffer, y, &part.x);
            // Number of colours to pass over before the next row: those of the area's width that this row does not
            // draw.
            skip = width.wrapping_sub(row.len());
            let mut stored = depths::<D>(depth, &mut nothing, y - *first_row, screen.0, &part.x).iter_mut();
            for (pixel, color) in row.iter_mut().zip(&mut new) {
                if !D::ENABLED || stored.next().is_none_or(|stored| passes(*test, *z, stored)) {
                    *pixel = F::Format::from_color(color);
                }
            }
        }
        Ok(())
    }

    fn fill_solid(&mut self, area: &Rectangle, color: Self::Color) -> Result<(), Infallible> {
        self.fill(&PixelRect::of_area(area), color);
        Ok(())
    }
}

impl<F, D> OriginDimensions for Overlay<'_, F, D> {
    fn size(&self) -> Size {
        Size::new(u32::from(self.screen.0), u32::from(self.screen.1))
    }
}
