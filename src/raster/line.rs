//! Lines of one pixel's width: two ends come in, and pixels go out, by the diamond-exit rule of OpenGL and Vulkan.
//!
//! ```text
//!      ,'.              Each pixel has a diamond, |x| + |y| < 1/2 about its centre. A line draws the pixels whose
//!    ,'   `.            diamonds it meets, except for the pixel that it ends in. So a chain of lines draws the
//!  --+-----+--> line    pixel of each joint once. A line flatter than 45° meets at most one diamond per column:
//!    `.   ,'            the one of the row in which the line passes the column's centre. Only at the two ends of
//!      `.'              a line, the diamond itself has to be tested.
//! ```
//! Ties are decided as if both end points were moved by (-ε, -ε²): then no point lies on the border of a diamond, and
//! no line passes exactly between two rows.
//!
//! # Source
//! OpenGL 4.6, 14.5.1; Vulkan, "Basic Line Segment Rasterization"; Bresenham 1965 for the stepping.

use super::samples::first_centre;
use super::triangle::PixelRect;
use crate::math::divide;
use core::num::NonZeroU32;
use core::ops::Range;

/// The pixels of a line. The *major* axis is the one along which the line is longer (x if it is equally long along
/// both). The line draws one pixel per step along its major axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    steep: bool,
    /// Direction along the major and the minor axis: 1 or -1.
    direction: (i32, i32),
    /// Length along the major axis (`length`) and along the minor axis (`height`), in 24.8 px: `length` ≥ `height`, and
    /// at most 2²⁴.
    length: u32,
    height: u32,
    /// Number of pixels that the line draws.
    count: u32,
    /// Distance from the start to the centre of the first pixel, along the major axis, in 24.8 px: -128..=256. It is
    /// negative if the line starts after the centre of its first pixel.
    lead: i32,
    /// The first pixel, along the major and the minor axis, and the Bresenham error there, in 0..`length`.
    first: (i32, i32),
    error: u32,
}

/// Returns the pixel whose diamond a point may lie in: its number along one axis, and the distance from its centre to
/// the point, -127..=128.
#[inline]
const fn pixel_of(coordinate: i32) -> (i32, i32) {
    let pixel = (coordinate - 1) >> 8;
    (pixel, coordinate - (256 * pixel + 128))
}

/// Returns the pixel whose diamond holds a point (moved by (-ε, -ε²)): its row if `along_y` is set, otherwise its
/// column.
#[inline]
const fn diamond(point: (i32, i32), along_y: bool) -> Option<i32> {
    let ((column, x), (row, y)) = (pixel_of(point.0), pixel_of(point.1));
    let sum = x.abs() + y.abs();
    // On the border, moving by -ε leads inside from the right half. From the two tips in the middle, it does not.
    if sum < 128 || (sum == 128 && x > 0) { Some(if along_y { row } else { column }) } else { None }
}

impl Line {
    /// Makes the line from `a` to `b`.
    ///
    /// # Format
    /// Points (x, y) are in 24.8, at most ±32,767 px. The pixels are exact: as if computed with infinite precision.
    pub fn new(a: (i32, i32), b: (i32, i32)) -> Self {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let steep = dx.abs() < dy.abs();
        let (start, end, across) = if steep { (a.1, b.1, a.0) } else { (a.0, b.0, a.1) };
        let (along, aside) = if steep { (dy, dx) } else { (dx, dy) };
        let direction = (if along < 0 { -1 } else { 1 }, if aside < 0 { -1 } else { 1 });
        let (length, height) = (along.unsigned_abs(), aside.unsigned_abs());
        // Forward, pixels run from the first centre that is not before the start, up to the last one that is before the
        // end. A centre at the start is not before it, because the line begins ε earlier. Backward, it is the other way
        // round.
        let back = i32::from(along < 0);
        let first = diamond(a, steep).unwrap_or(first_centre(start) - back);
        let last = match diamond(b, steep) {
            Some(pixel) => pixel - direction.0,
            None => first_centre(end) - 1 + back,
        };
        let count = ((last - first) * direction.0 + 1).max(0) as u32;
        let lead = (256 * first + 128 - start) * direction.0;
        let mut line = Self { steep, direction, length, height, count, lead, first: (first, across >> 8), error: 0 };
        if count > 0 {
            line.place(across & 0xFF);
        }
        line
    }

    /// Finds the first pixel along the minor axis, and the error there, from the start's fraction of a pixel.
    ///
    /// At the centre of the first pixel, the line is at n / 256 `length` px from the row that the start is in, where
    /// n = `fraction` `length` ± `lead` `height`. Steps change n by multiples of 256, so its lower 8 bits do not
    /// matter.
    ///
    /// # Format
    /// n is within 2³⁴, and n / 256 within ±2²⁶. The first pixel is within three pixels of the start.
    #[inline]
    fn place(&mut self, fraction: i32) {
        let (length, height) = (self.length as i32, self.height as i32);
        // ε moves a flat line that goes right and down (or left and up) down. It moves any other line up or to the
        // left.
        let falls = !self.steep && self.height > 0 && self.direction.0 == self.direction.1;
        let tie = i32::from(!falls);
        let lead = self.lead * self.direction.1;
        let mut n = if length < 1 << 21 {
            (fraction * length + lead * height - tie) >> 8
        } else {
            let n = i64::from(fraction) * i64::from(length) + i64::from(lead) * i64::from(height) - i64::from(tie);
            (n >> 8) as i32
        };
        while n < 0 {
            n += length;
            self.first.1 -= 1;
        }
        while n >= length {
            n -= length;
            self.first.1 += 1;
        }
        // Backward, the error is counted from the other side of the pixel.
        self.error = (if self.direction.1 < 0 { length - 1 - n } else { n }) as u32;
    }

    /// Returns whether y is the major axis.
    #[inline]
    pub const fn is_steep(&self) -> bool {
        self.steep
    }

    /// Returns the length along the major axis, in 24.8 px.
    #[inline]
    pub const fn length(&self) -> u32 {
        self.length
    }

    /// Returns the distance from the start to the centre of the first pixel, along the major axis in 24.8 px: at least
    /// -128. It is negative if the line starts after that centre.
    #[inline]
    pub const fn lead(&self) -> i32 {
        self.lead
    }

    /// Returns the number of pixels.
    #[inline]
    pub const fn count(&self) -> u32 {
        self.count
    }

    /// Returns the line's pixels inside of a rectangle, in drawing order, and the number of the first of them in the
    /// whole line. The rectangle does not change which pixels a line has: the pixels outside of it are only left out.
    ///
    /// ```
    /// use zstrip::internals::{Line, PixelRect};
    /// let line = Line::new((128, 128), (896, 384)); // from pixel (0, 0) to (3, 1), centre to centre
    /// let (_, pixels) = line.pixels(&PixelRect { x: 0..8, y: 0..8 });
    /// assert_eq!(pixels.collect::<Vec<_>>(), [(0, 0), (1, 0), (2, 1)]);
    /// ```
    ///
    /// # Format
    /// The product of steps and height, both below 2²⁵, fits 64 bits.
    pub fn pixels(&self, clip: &PixelRect) -> (u32, LinePixels) {
        let (majors, minors) = if self.steep { (&clip.y, &clip.x) } else { (&clip.x, &clip.y) };
        let along = advance(self.first.0, self.direction.0, majors);
        let aside = advance(self.first.1, self.direction.1, minors);
        let end = self.count.min(along.end).min(self.until(aside.end));
        let skipped = along.start.max(self.until(aside.start)).min(end);
        let mut moved = 0;
        let mut error = self.error;
        if let (1.., Some(length)) = (skipped, NonZeroU32::new(self.length)) {
            (moved, error) = divide(self.error_after(skipped), length);
        }
        let (major, minor) =
            (self.first.0 + skipped as i32 * self.direction.0, self.first.1 + moved as i32 * self.direction.1);
        let straight = if self.steep { (0, self.direction.0) } else { (self.direction.0, 0) };
        let diagonal = if self.steep { self.direction.1 } else { self.direction.0 };
        let diagonal = (diagonal, if self.steep { self.direction.0 } else { self.direction.1 });
        let position = if self.steep { (minor, major) } else { (major, minor) };
        let left = end - skipped;
        let (height, length) = (self.height as i32, self.length as i32);
        let error = error as i32 - length;
        let pixels = LinePixels { position, straight, diagonal, error, height, length, left };
        (skipped, pixels)
    }

    /// Returns the number of steps until the line has moved `pixels` pixels aside, or of all its steps if it never
    /// does.
    fn until(&self, pixels: u32) -> u32 {
        // In all, the line moves aside by its height, and by less than one more pixel.
        if pixels > (self.height >> 8) + 1 {
            return self.count;
        }
        let way = u64::from(pixels) * u64::from(self.length);
        match NonZeroU32::new(self.height) {
            _ if pixels == 0 => 0,
            // In this case the quotient is not above the number of steps.
            Some(height) if way <= self.error_after(self.count) => {
                let (quotient, rest) = divide(way - u64::from(self.error), height);
                quotient + u32::from(rest > 0)
            }
            _ => self.count,
        }
    }

    /// Returns the error after `steps` steps, if `length` is never subtracted from it.
    fn error_after(&self, steps: u32) -> u64 {
        u64::from(self.error) + u64::from(steps) * u64::from(self.height)
    }
}

/// Returns the numbers of steps from `first`, in a direction, at which a range begins and ends.
#[inline]
fn advance(first: i32, direction: i32, range: &Range<i32>) -> Range<u32> {
    let (start, end) = if direction < 0 {
        (first - range.end + 1, first - range.start + 1)
    } else {
        (range.start - first, range.end - first)
    };
    start.max(0) as u32..end.max(0) as u32
}

/// An iterator over pixels of a line: one addition and one comparison per pixel.
#[derive(Clone, Copy, Debug)]
pub struct LinePixels {
    /// The next pixel.
    pub(crate) position: (i32, i32),
    /// Step along the major axis, and step along both axes.
    pub(crate) straight: (i32, i32),
    pub(crate) diagonal: (i32, i32),
    /// The error minus `length`, below 0. It grows by `height` per pixel. Where it would become 0 or more, the step is
    /// diagonal and `length` is subtracted again.
    pub(crate) error: i32,
    pub(crate) height: i32,
    pub(crate) length: i32,
    /// Number of pixels that are left.
    pub(crate) left: u32,
}

impl Iterator for LinePixels {
    type Item = (i32, i32);

    #[inline(always)]
    fn next(&mut self) -> Option<(i32, i32)> {
        if self.left == 0 {
            return None;
        }
        self.left -= 1;
        let (x, y) = self.position;
        self.error = self.error.wrapping_add(self.height);
        let mut step = self.straight;
        if self.error >= 0 {
            self.error = self.error.wrapping_sub(self.length);
            step = self.diagonal;
        }
        self.position = (x.wrapping_add(step.0), y.wrapping_add(step.1));
        Some((x, y))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left as usize, Some(self.left as usize))
    }
}

impl ExactSizeIterator for LinePixels {}
