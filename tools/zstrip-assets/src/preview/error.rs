//! Reasons why a model cannot be shown.

use super::picture::MOST_SHEET;
use std::fmt;
use std::path::PathBuf;
use zstrip::math::ProjectionError;
use zstrip::model::{MemoryError, ModelError};

/// The reason why a model cannot be shown.
#[derive(Debug)]
pub enum PreviewError {
    /// A file cannot be read or written.
    Io(PathBuf, std::io::Error),
    /// A picture cannot be written.
    Image(PathBuf, String),
    /// The bytes are not a container.
    Model(ModelError),
    /// The model is beyond the range of numbers.
    Camera(ProjectionError),
    /// A panel that there cannot be: the number, and the numbers that it may be.
    Panel(&'static str, u32, std::ops::RangeInclusive<u32>),
    /// The model takes more memory than its own numbers say.
    Memory(MemoryError),
    /// The library did not draw the frame.
    Frame(String),
    /// A clock that no core has, in Hz.
    Clock(f64),
    /// A contact sheet of too many pixels: its width and its height.
    Sheet(u32, u32),
}

impl fmt::Display for PreviewError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(path, error) => write!(f, "{}: {error}", path.display()),
            Self::Image(path, error) => write!(f, "{}: {error}", path.display()),
            Self::Model(error) => write!(f, "not a container of a model: {error}"),
            Self::Camera(error) => write!(f, "no camera has the model on the screen: {error}"),
            Self::Panel(what, found, range) => {
                write!(f, "{what} of {found}; from {} to {} are possible", range.start(), range.end())
            }
            Self::Memory(error) => error.fmt(f),
            Self::Frame(error) => write!(f, "the frame was not drawn: {error}"),
            Self::Clock(hertz) => write!(f, "a clock of {} MHz; from 0.001 to 10000 are possible", hertz / 1e6),
            Self::Sheet(width, height) => {
                write!(
                    f,
                    "a contact sheet of {width} x {height} pixels; {MOST_SHEET} are the most: choose a smaller screen"
                )
            }
        }
    }
}

impl std::error::Error for PreviewError {}

impl From<ModelError> for PreviewError {
    fn from(error: ModelError) -> Self {
        Self::Model(error)
    }
}

impl From<ProjectionError> for PreviewError {
    fn from(error: ProjectionError) -> Self {
        Self::Camera(error)
    }
}

impl From<MemoryError> for PreviewError {
    fn from(error: MemoryError) -> Self {
        Self::Memory(error)
    }
}
