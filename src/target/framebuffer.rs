//! What is drawn into: anything that has rows of pixels.

use crate::color::PixelFormat;
use core::fmt;

/// Rows of pixels to draw into.
///
/// The rasterizer asks for a row before it draws into it, draws into what it gets, and skips what lies behind its end. A row
/// outside of the buffer is an empty slice.
pub trait Framebuffer {
    /// The format of the pixels.
    type Format: PixelFormat;

    /// Whether there is a depth buffer beside it; without one, every depth test passes. A constant, so that a program links only
    /// the loops that it needs.
    const DEPTH: bool = true;

    /// Whether there may be records for it. Without them, the closure is called once a strip, and the code that records and
    /// replays is not linked.
    const RECORDS: bool = true;

    /// Row `y` of the screen, from column 0.
    fn row(&mut self, y: u32) -> &mut [<Self::Format as PixelFormat>::Raw];

    /// Up to `length` pixels of row `y` from `column` on: those that there are.
    #[inline]
    fn span(&mut self, y: u32, column: usize, length: usize) -> &mut [<Self::Format as PixelFormat>::Raw] {
        first(self.row(y).get_mut(column..).unwrap_or_default(), length)
    }

    /// The rows from `first_row` on, one after the other, if they lie in memory so, `width` pixels each, and no more than there
    /// are. Triangles and lines are drawn faster then.
    #[inline]
    fn rows(&mut self, first_row: u32, width: usize) -> Option<&mut [<Self::Format as PixelFormat>::Raw]> {
        let _ = (first_row, width);
        None
    }
}

/// The first `length` of some pixels, or all of them.
#[inline]
fn first<R>(pixels: &mut [R], length: usize) -> &mut [R] {
    let length = length.min(pixels.len());
    pixels.get_mut(..length).unwrap_or_default()
}

/// A horizontal strip of the screen, with a depth buffer and records beside it, or without.
#[derive(Debug)]
pub struct Strip<'a, P: PixelFormat, const DEPTH: bool = true, const RECORDS: bool = true> {
    pixels: &'a mut [P::Raw],
    width: usize,
    first_row: u32,
}

impl<'a, P: PixelFormat, const DEPTH: bool, const RECORDS: bool> Strip<'a, P, DEPTH, RECORDS> {
    /// Rows of `width` px from `first_row` on, one after the other in `pixels`.
    pub const fn new(pixels: &'a mut [P::Raw], width: u16, first_row: u32) -> Self {
        Self { pixels, width: width as usize, first_row }
    }
}

impl<P: PixelFormat, const DEPTH: bool, const RECORDS: bool> Framebuffer for Strip<'_, P, DEPTH, RECORDS> {
    type Format = P;

    const DEPTH: bool = DEPTH;

    const RECORDS: bool = RECORDS;

    // Out of line: in loops, rows are asked for one by one where the strip is short or narrow.
    #[inline(never)]
    fn row(&mut self, y: u32) -> &mut [P::Raw] {
        let row = y.checked_sub(self.first_row).and_then(|row| (row as usize).checked_mul(self.width));
        let rest = row.and_then(|start| self.pixels.get_mut(start..)).unwrap_or_default();
        first(rest, self.width)
    }

    /// The rasterizer stays within the width, so the row's own end need not be checked.
    #[inline]
    fn span(&mut self, y: u32, column: usize, length: usize) -> &mut [P::Raw] {
        let start = (y.wrapping_sub(self.first_row) as usize).wrapping_mul(self.width).wrapping_add(column);
        // In two steps, each a comparison; a range is checked at both ends at once, which small cores pay twice for.
        first(self.pixels.get_mut(start..).unwrap_or_default(), length)
    }

    #[inline]
    fn rows(&mut self, first_row: u32, width: usize) -> Option<&mut [P::Raw]> {
        let start = (first_row.wrapping_sub(self.first_row) as usize).wrapping_mul(self.width);
        if width == self.width { self.pixels.get_mut(start..) } else { None }
    }
}

/// A framebuffer that is drawn into without a depth buffer.
#[derive(Debug)]
pub struct WithoutDepth<F>(
    /// Where the pixels are.
    pub F,
);

impl<F: Framebuffer> Framebuffer for WithoutDepth<F> {
    type Format = F::Format;

    const DEPTH: bool = false;

    const RECORDS: bool = F::RECORDS;

    #[inline]
    fn row(&mut self, y: u32) -> &mut [<F::Format as PixelFormat>::Raw] {
        self.0.row(y)
    }

    #[inline]
    fn span(&mut self, y: u32, column: usize, length: usize) -> &mut [<F::Format as PixelFormat>::Raw] {
        self.0.span(y, column, length)
    }

    #[inline]
    fn rows(&mut self, first_row: u32, width: usize) -> Option<&mut [<F::Format as PixelFormat>::Raw]> {
        self.0.rows(first_row, width)
    }
}

/// A framebuffer in a slice, its rows `stride` pixels apart: a whole screen, or a window in a larger one.
#[derive(Debug)]
pub struct FrameSlice<'a, P: PixelFormat> {
    pixels: &'a mut [P::Raw],
    width: usize,
    height: u32,
    stride: usize,
}

/// What is wrong with a framebuffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FramebufferError {
    /// The slice is shorter than its rows need: how many pixels it has, and how many it needs.
    TooShort(usize, usize),
    /// The stride is below the width: stride and width.
    Stride(usize, u16),
}

impl fmt::Display for FramebufferError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TooShort(has, needs) => write!(f, "framebuffer of {has} pixels, {needs} are needed"),
            Self::Stride(stride, width) => write!(f, "stride of {stride} pixels is below the width of {width}"),
        }
    }
}

impl core::error::Error for FramebufferError {}

impl<'a, P: PixelFormat> FrameSlice<'a, P> {
    /// A whole screen without gaps between its rows.
    ///
    /// # Errors
    /// When the slice is too short.
    pub const fn new(pixels: &'a mut [P::Raw], width: u16, height: u16) -> Result<Self, FramebufferError> {
        Self::with_stride(pixels, width, height, width as usize)
    }

    /// Rows of `width` pixels that begin `stride` pixels apart.
    ///
    /// # Errors
    /// When the slice is too short or the stride is below the width.
    pub const fn with_stride(
        pixels: &'a mut [P::Raw],
        width: u16,
        height: u16,
        stride: usize,
    ) -> Result<Self, FramebufferError> {
        if stride < width as usize {
            return Err(FramebufferError::Stride(stride, width));
        }
        let needs =
            if height == 0 { 0 } else { (height as usize - 1).saturating_mul(stride).saturating_add(width as usize) };
        if pixels.len() < needs {
            return Err(FramebufferError::TooShort(pixels.len(), needs));
        }
        Ok(Self { pixels, width: width as usize, height: height as u32, stride })
    }
}

impl<P: PixelFormat> Framebuffer for FrameSlice<'_, P> {
    type Format = P;

    #[inline]
    fn row(&mut self, y: u32) -> &mut [P::Raw] {
        if y >= self.height {
            return &mut [];
        }
        // Not more than the length of the slice, as `with_stride` has checked.
        let start = y as usize * self.stride;
        first(self.pixels.get_mut(start..).unwrap_or_default(), self.width)
    }

    #[inline]
    fn rows(&mut self, first_row: u32, width: usize) -> Option<&mut [P::Raw]> {
        let rows = (first_row as usize).wrapping_mul(self.stride)..(self.height as usize).wrapping_mul(self.stride);
        if width == self.stride && width == self.width { self.pixels.get_mut(rows) } else { None }
    }
}
