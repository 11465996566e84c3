//! Framebuffers: everything that has rows of pixels to draw into.

use super::choice::{DepthChoice, Further, RecordsChoice, WithoutDepth, WithoutRecords};
use crate::color::PixelFormat;
use core::fmt;
use core::marker::PhantomData;
use embedded_graphics_core::geometry::Size;

/// Rows of pixels to draw into.
///
/// The rasterizer asks for a row before it draws into it, draws into the slice it gets, and skips pixels after the
/// end of that slice. It asks only for rows of the strip that is being drawn. A row outside of the buffer is an empty
/// slice.
pub trait Framebuffer {
    /// The format of the pixels.
    type Format: PixelFormat;

    /// True if there is a depth buffer beside it. Without one, every depth test passes. A constant, so that a program
    /// links only the loops that it needs.
    const DEPTH: bool = true;

    /// True if there may be records for it. Without them, the closure is called once per strip, and the code that
    /// records and replays is not linked.
    const RECORDS: bool = true;

    /// True if the state of small triangles may be carried on from strip to strip, beside the records.
    const CARRIES: bool = false;

    /// True if hidden draws are left out, by coarse depths in the depth buffer.
    const OCCLUDES: bool = false;

    /// Number of samples per pixel: 1, 2, 4 or 8. The pixels of each sample are rows of their own. Only a [`Strip`] of
    /// a renderer [with samples](crate::frame::Renderer::with_samples) has more than one.
    const SAMPLES: usize = 1;

    /// Chooses the sample, from 0 to [`SAMPLES`](Self::SAMPLES) - 1, whose rows are asked for from now on. At first,
    /// and between draws, it is sample 0.
    #[inline]
    fn select_sample(&mut self, sample: usize) {
        let _ = sample;
    }

    /// Returns the number of the sample that is [chosen](Self::select_sample).
    #[inline]
    fn selected_sample(&mut self) -> usize {
        0
    }

    /// Returns all pixels of sample 0, and those of the other samples, one sample after the other, if each sample's
    /// rows of the current strip lie in memory one after the other, and nothing else with them. Small triangles are
    /// drawn faster then.
    #[inline]
    fn samples(&mut self) -> Option<[&mut [<Self::Format as PixelFormat>::Raw]; 2]> {
        None
    }

    /// Returns row `y` of the screen, from column 0.
    fn row(&mut self, y: u32) -> &mut [<Self::Format as PixelFormat>::Raw];

    /// Returns up to `length` pixels of row `y`, from `column` on: no more than the row has.
    #[inline]
    fn span(&mut self, y: u32, column: usize, length: usize) -> &mut [<Self::Format as PixelFormat>::Raw] {
        first(self.row(y).get_mut(column..).unwrap_or_default(), length)
    }

    /// Returns the rows from `first_row` on, if they lie in memory one after the other, `width` pixels each. Triangles
    /// and lines are drawn faster then, because rows need not be looked up one by one.
    #[inline]
    fn rows(&mut self, first_row: u32, width: usize) -> Option<&mut [<Self::Format as PixelFormat>::Raw]> {
        let _ = (first_row, width);
        None
    }
}

/// Returns the first `length` of some pixels, or all of them if there are fewer.
#[inline]
fn first<R>(pixels: &mut [R], length: usize) -> &mut [R] {
    let length = length.min(pixels.len());
    pixels.get_mut(..length).unwrap_or_default()
}

/// A horizontal strip of the screen, with a depth buffer and records beside it, or without.
///
/// A function for the scenes of any renderer takes `&mut Scene<'_, impl Framebuffer>`, and need not name this type.
#[derive(Debug)]
pub struct Strip<'a, P: PixelFormat, D: DepthChoice = WithoutDepth, R = WithoutRecords> {
    pixels: &'a mut [P::Raw],
    further: D::Further<'a, P::Raw>,
    width: usize,
    first_row: u32,
    choices: PhantomData<(D, R)>,
}

impl<'a, P: PixelFormat, D: DepthChoice, R: RecordsChoice> Strip<'a, P, D, R> {
    /// Makes a strip of rows of `width` px from `first_row` on, one after the other in `pixels`. Those of further
    /// samples are in `further`.
    pub(crate) const fn new(
        pixels: &'a mut [P::Raw],
        further: D::Further<'a, P::Raw>,
        width: usize,
        first_row: u32,
    ) -> Self {
        Self { pixels, further, width, first_row, choices: PhantomData }
    }

    /// Returns the pixels of the sample that is chosen.
    #[inline(always)]
    fn pixels(&mut self) -> &mut [P::Raw] {
        if D::SAMPLES == 1 {
            return self.pixels;
        }
        let length = self.pixels.len();
        let (samples, sample) = self.further.samples();
        match sample.checked_sub(1) {
            Some(further) => first(samples.get_mut(further.wrapping_mul(length)..).unwrap_or_default(), length),
            None => self.pixels,
        }
    }
}

impl<P: PixelFormat, D: DepthChoice, R: RecordsChoice> Framebuffer for Strip<'_, P, D, R> {
    type Format = P;

    const DEPTH: bool = D::DEPTH;

    const RECORDS: bool = R::RECORDS;

    const CARRIES: bool = R::CARRIES && D::SAMPLES == 1;

    const OCCLUDES: bool = D::OCCLUDES;

    const SAMPLES: usize = D::SAMPLES;

    #[inline]
    fn select_sample(&mut self, sample: usize) {
        if D::SAMPLES > 1 {
            self.further.select(sample);
        }
    }

    #[inline]
    fn selected_sample(&mut self) -> usize {
        if D::SAMPLES > 1 { self.further.samples().1 } else { 0 }
    }

    #[inline]
    fn samples(&mut self) -> Option<[&mut [P::Raw]; 2]> {
        Some([self.pixels, self.further.samples().0])
    }

    // Out of line, since loops ask for rows one by one only where the strip is short or narrow.
    #[inline(never)]
    fn row(&mut self, y: u32) -> &mut [P::Raw] {
        let row = y.checked_sub(self.first_row).and_then(|row| (row as usize).checked_mul(self.width));
        let width = self.width;
        let rest = row.and_then(|start| self.pixels().get_mut(start..)).unwrap_or_default();
        first(rest, width)
    }

    /// The rasterizer stays within the width, so the row's own end need not be checked.
    #[inline]
    fn span(&mut self, y: u32, column: usize, length: usize) -> &mut [P::Raw] {
        let start = (y.wrapping_sub(self.first_row) as usize).wrapping_mul(self.width).wrapping_add(column);
        // The slice is cut in two steps of one comparison each. Indexing by a range compares both ends at once, for
        // which small cores pay twice.
        first(self.pixels().get_mut(start..).unwrap_or_default(), length)
    }

    #[inline]
    fn rows(&mut self, first_row: u32, width: usize) -> Option<&mut [P::Raw]> {
        let start = (first_row.wrapping_sub(self.first_row) as usize).wrapping_mul(self.width);
        if width == self.width { self.pixels().get_mut(start..) } else { None }
    }
}

/// A framebuffer that is drawn into without a depth buffer.
#[derive(Debug)]
pub struct Depthless<F>(
    /// The framebuffer that holds the pixels.
    pub F,
);

impl<F: Framebuffer> Framebuffer for Depthless<F> {
    type Format = F::Format;

    const DEPTH: bool = false;

    const RECORDS: bool = F::RECORDS;

    const CARRIES: bool = F::CARRIES;

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

/// The error of a framebuffer that could not be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FramebufferError {
    /// The slice is shorter than its rows need.
    TooShort {
        /// Pixels that the slice holds.
        pixels: usize,
        /// Pixels from the first one of the first row to the last one of the last row.
        needed: usize,
    },
    /// The stride is below the width.
    Stride {
        /// Pixels from the beginning of a row to that of the next.
        stride: usize,
        /// Pixels of a row.
        width: u32,
    },
}

impl fmt::Display for FramebufferError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TooShort { pixels, needed } => write!(f, "framebuffer of {pixels} pixels, {needed} are needed"),
            Self::Stride { stride, width } => write!(f, "stride of {stride} pixels is below the width of {width}"),
        }
    }
}

impl core::error::Error for FramebufferError {}

impl<'a, P: PixelFormat> FrameSlice<'a, P> {
    /// Makes a framebuffer of a whole screen without gaps between its rows.
    ///
    /// # Errors
    /// When the slice is too short.
    pub const fn new(pixels: &'a mut [P::Raw], size: Size) -> Result<Self, FramebufferError> {
        Self::with_stride(pixels, size, size.width as usize)
    }

    /// Makes a framebuffer whose rows begin `stride` pixels apart.
    ///
    /// # Errors
    /// When the slice is too short or the stride is below the width.
    pub const fn with_stride(pixels: &'a mut [P::Raw], size: Size, stride: usize) -> Result<Self, FramebufferError> {
        let Size { width, height } = size;
        if (stride as u64) < width as u64 {
            return Err(FramebufferError::Stride { stride, width });
        }
        // `usize` may not hold the size.
        let needed = match height.checked_sub(1) {
            Some(others) => (others as u64).saturating_mul(stride as u64).saturating_add(width as u64),
            None => 0,
        };
        if (pixels.len() as u64) < needed {
            let needed = if needed > usize::MAX as u64 { usize::MAX } else { needed as usize };
            return Err(FramebufferError::TooShort { pixels: pixels.len(), needed });
        }
        Ok(Self { pixels, width: width as usize, height, stride })
    }
}

impl<P: PixelFormat> Framebuffer for FrameSlice<'_, P> {
    type Format = P;

    #[inline]
    fn row(&mut self, y: u32) -> &mut [P::Raw] {
        if y >= self.height {
            return &mut [];
        }
        // The product is at most the length of the slice, as `with_stride` has checked.
        let start = (y as usize).wrapping_mul(self.stride);
        first(self.pixels.get_mut(start..).unwrap_or_default(), self.width)
    }

    #[inline]
    fn rows(&mut self, first_row: u32, width: usize) -> Option<&mut [P::Raw]> {
        let rows = (first_row as usize).wrapping_mul(self.stride)..(self.height as usize).wrapping_mul(self.stride);
        if width == self.stride && width == self.width { self.pixels.get_mut(rows) } else { None }
    }
}
