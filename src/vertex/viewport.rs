//! The viewport: which rectangle of the screen clip space is mapped to.

use core::fmt;

/// A rectangle of the screen in pixels; the corner may lie outside the screen, up to 32,767 px away.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Viewport {
    x: i16,
    y: i16,
    width: u16,
    height: u16,
}

/// What is wrong with a viewport.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ViewportError {
    /// Width or height is zero: both.
    Empty(u16, u16),
    /// Width or height is above [`Viewport::MAX_SIZE`]: both.
    TooLarge(u16, u16),
    /// The corner is more than [`Viewport::MAX_OFFSET`] px off the screen: its position.
    TooFar(i16, i16),
}

impl fmt::Display for ViewportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Empty(w, h) => write!(f, "viewport of {w}x{h} px is empty"),
            Self::TooLarge(w, h) => {
                write!(f, "viewport of {w}x{h} px is larger than {0}x{0}", Viewport::MAX_SIZE)
            }
            Self::TooFar(x, y) => write!(f, "viewport at ({x}, {y}) is more than {} px away", Viewport::MAX_OFFSET),
        }
    }
}

impl core::error::Error for ViewportError {}

impl Viewport {
    /// Largest width and height of a viewport and of a screen: gradients lose less than 2⁻³ of a step over it.
    pub const MAX_SIZE: u16 = 4096;

    /// Largest distance of the corner from that of the screen, so that it cannot come near the guard band.
    pub const MAX_OFFSET: u16 = 8192;

    /// The rectangle with its top-left corner at `(x, y)`.
    ///
    /// # Errors
    /// When it is empty, larger than [`MAX_SIZE`](Self::MAX_SIZE), or farther away than
    /// [`MAX_OFFSET`](Self::MAX_OFFSET).
    pub const fn new(x: i16, y: i16, width: u16, height: u16) -> Result<Self, ViewportError> {
        if width == 0 || height == 0 {
            return Err(ViewportError::Empty(width, height));
        }
        if width > Self::MAX_SIZE || height > Self::MAX_SIZE {
            return Err(ViewportError::TooLarge(width, height));
        }
        if x.unsigned_abs() > Self::MAX_OFFSET || y.unsigned_abs() > Self::MAX_OFFSET {
            return Err(ViewportError::TooFar(x, y));
        }
        Ok(Self { x, y, width, height })
    }

    /// The whole of a screen.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub const fn full(width: u16, height: u16) -> Result<Self, ViewportError> {
        Self::new(0, 0, width, height)
    }

    /// Left edge.
    pub const fn x(&self) -> i16 {
        self.x
    }

    /// Top edge.
    pub const fn y(&self) -> i16 {
        self.y
    }

    /// Width in pixels.
    pub const fn width(&self) -> u16 {
        self.width
    }

    /// Height in pixels.
    pub const fn height(&self) -> u16 {
        self.height
    }
}
