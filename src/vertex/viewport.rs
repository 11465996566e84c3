//! The viewport: the rectangle of the screen that clip space is mapped to. A position and a size come in, and are
//! checked once: every [`Viewport`] lies well inside of the guard band.

use core::fmt;
use embedded_graphics_core::geometry::{Point, Size};

/// A rectangle of the screen in pixels. Its corner may lie outside the screen, up to [`MAX_OFFSET`](Self::MAX_OFFSET)
/// px away.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Viewport {
    x: i16,
    y: i16,
    width: u16,
    height: u16,
}

/// An error in the corner or the size of a viewport.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ViewportError {
    /// Width or height is zero.
    Empty {
        /// Width and height.
        size: Size,
    },
    /// Width or height is above [`Viewport::MAX_SIZE`].
    TooLarge {
        /// Width and height.
        size: Size,
    },
    /// The corner is more than [`Viewport::MAX_OFFSET`] px away from the screen's corner.
    TooFar {
        /// Position of the corner.
        top_left: Point,
    },
}

#[cfg(feature = "defmt")]
impl defmt::Format for ViewportError {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}", defmt::Debug2Format(self));
    }
}

impl fmt::Display for ViewportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty { size } => write!(f, "viewport of {}x{} px is empty", size.width, size.height),
            Self::TooLarge { size } => {
                write!(f, "viewport of {}x{} px is larger than {2}x{2}", size.width, size.height, Viewport::MAX_SIZE)
            }
            Self::TooFar { top_left } => {
                write!(f, "viewport at ({}, {}) is more than {} px away", top_left.x, top_left.y, Viewport::MAX_OFFSET)
            }
        }
    }
}

impl core::error::Error for ViewportError {}

impl Viewport {
    /// Largest width and height of a viewport and of a screen: gradients lose less than 2⁻³ of a step over it.
    pub const MAX_SIZE: u16 = 4096;

    /// Largest distance of the corner from the screen's corner, so that the viewport stays away from the guard band.
    pub const MAX_OFFSET: u16 = 8192;

    /// Makes the rectangle of `size` with its top left corner at `top_left`.
    ///
    /// # Errors
    /// When the rectangle is empty, larger than [`MAX_SIZE`](Self::MAX_SIZE), or farther away than
    /// [`MAX_OFFSET`](Self::MAX_OFFSET).
    pub const fn new(top_left: Point, size: Size) -> Result<Self, ViewportError> {
        let (Point { x, y }, Size { width, height }) = (top_left, size);
        if width == 0 || height == 0 {
            return Err(ViewportError::Empty { size });
        }
        if width > Self::MAX_SIZE as u32 || height > Self::MAX_SIZE as u32 {
            return Err(ViewportError::TooLarge { size });
        }
        if x.unsigned_abs() > Self::MAX_OFFSET as u32 || y.unsigned_abs() > Self::MAX_OFFSET as u32 {
            return Err(ViewportError::TooFar { top_left });
        }
        Ok(Self { x: x as i16, y: y as i16, width: width as u16, height: height as u16 })
    }

    /// Makes the rectangle that covers a whole screen.
    ///
    /// # Errors
    /// When the screen is empty or larger than [`MAX_SIZE`](Self::MAX_SIZE).
    pub const fn full(screen: Size) -> Result<Self, ViewportError> {
        Self::new(Point::new(0, 0), screen)
    }

    /// Returns the position of the top left corner, relative to the screen's corner.
    #[must_use]
    pub const fn top_left(&self) -> Point {
        Point::new(self.x as i32, self.y as i32)
    }

    /// Returns the width and the height.
    #[must_use]
    pub const fn size(&self) -> Size {
        Size::new(self.width as u32, self.height as u32)
    }

    pub(crate) const fn x(&self) -> i16 {
        self.x
    }

    pub(crate) const fn y(&self) -> i16 {
        self.y
    }

    pub(crate) const fn width(&self) -> u16 {
        self.width
    }

    pub(crate) const fn height(&self) -> u16 {
        self.height
    }
}
