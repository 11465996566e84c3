//! Errors of renderers that could not be built, and of frames that ended early.

use crate::vertex::ViewportError;
use core::convert::Infallible;
use core::fmt;
use embedded_graphics_core::geometry::Size;

/// The error of a renderer that could not be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RendererError {
    /// The screen is empty, or larger than [`Viewport::MAX_SIZE`](crate::vertex::Viewport::MAX_SIZE).
    Screen(ViewportError),
    /// The depth buffer does not hold one row.
    DepthTooShort {
        /// Pixels that the buffer holds.
        pixels: usize,
        /// Pixels of a row, times the samples of a pixel.
        needed: usize,
    },
    /// The size of the screen is not a multiple of the pixels that become one.
    NotAMultiple {
        /// Columns and rows of the finer screen.
        screen: Size,
        /// Pixels that become one, in each direction.
        scale: u32,
    },
    /// The buffer for the colours of samples does not hold those of one row.
    SamplesTooShort {
        /// Colours that the buffer holds.
        pixels: usize,
        /// Pixels of a row, times the samples of a pixel except the first.
        needed: usize,
    },
}

impl fmt::Display for RendererError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Screen(error) => write!(f, "screen: {error}"),
            Self::DepthTooShort { pixels, needed } => {
                write!(f, "depth buffer of {pixels} pixels, one row has {needed}")
            }
            Self::NotAMultiple { screen: Size { width, height }, scale } => {
                write!(f, "a screen of {width}x{height} is no multiple of {scale} in both directions")
            }
            Self::SamplesTooShort { pixels, needed } => {
                write!(f, "buffer for {pixels} colours of samples, one row has {needed} of them")
            }
        }
    }
}

impl core::error::Error for RendererError {}

#[cfg(feature = "defmt")]
impl defmt::Format for RendererError {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}", defmt::Debug2Format(self));
    }
}

/// The error of a frame that ended early, or of a strip that could not be drawn. `E` is the error of the sink.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FrameError<E = Infallible> {
    /// The sink, or the display, failed. The frame is over.
    Sink(E),
    /// The closure did not draw the same as in an earlier call for this frame. The frame is over.
    ///
    /// The calls that replay a band of records are compared with the call that recorded it. A change is noticed in
    ///
    /// - the number of draws of meshes, lines and points;
    /// - a draw's matrix, viewport, [`State`](crate::State), type of shader, type and width of stroke, size of points;
    /// - a mesh or lines, as far as these numbers tell: topology, format of positions, which slices there are, how many
    ///   vertices, triangles or lines, the bounds, and the first, the middle and the last triangle or line, each with
    ///   the position of a corner. Two meshes with equal contents are equal, wherever they lie.
    ///
    /// Other changes are not noticed. The frame then ends without an error, and the strips that are drawn after the
    /// change may show other things than those before it:
    ///
    /// - other numbers in the slices of a mesh;
    /// - other values of a shader of one type, such as its colour or its texture;
    /// - other shapes on a canvas or an overlay;
    /// - any change between two bands, and between strips that are drawn without records.
    SceneChanged {
        /// Number of the first draw that differed, counted from 0.
        draw: u32,
    },
    /// The colour buffer does not hold the strip, or not one row if the strip is the first of a frame. Nothing was
    /// drawn. The frame goes on with the next buffer that is long enough.
    BufferTooShort {
        /// Pixels that the buffer holds.
        pixels: usize,
        /// Pixels of the strip; for the first strip of a frame: pixels of a row.
        needed: usize,
    },
}

impl FrameError {
    /// Returns the error as that of a frame whose sink fails with an `E`.
    pub(super) fn widen<E>(self) -> FrameError<E> {
        match self {
            Self::Sink(never) => match never {},
            Self::SceneChanged { draw } => FrameError::SceneChanged { draw },
            Self::BufferTooShort { pixels, needed } => FrameError::BufferTooShort { pixels, needed },
        }
    }
}

impl<E: fmt::Display> fmt::Display for FrameError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sink(error) => write!(f, "display: {error}"),
            Self::SceneChanged { draw } => write!(f, "draw {draw} differs from the call before in the same frame"),
            Self::BufferTooShort { pixels, needed } => {
                write!(f, "colour buffer of {pixels} pixels, {needed} are needed")
            }
        }
    }
}

impl<E: fmt::Debug + fmt::Display> core::error::Error for FrameError<E> {}
