//! Errors: which file, where in it, and which number or name is wrong.

use std::fmt;
use std::path::{Path, PathBuf};

/// A place in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line; the first one is 1.
    Line(usize),
    /// A byte; the first one is 0.
    Byte(usize),
    /// A value of a glTF document, such as `accessors[3].bufferView`.
    Json(String),
}

/// Kinds of errors, for programs that act on them. The text is in [`Error::message`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A file could not be read.
    Io,
    /// The file ends too early, or is not of its format.
    Syntax,
    /// An index points at nothing.
    Index,
    /// A number is infinite or not a number.
    NonFinite,
    /// Something that the model cannot be without is missing.
    Missing,
    /// A path leads out of the folder of the model.
    OutsideFolder,
    /// The file needs something that this crate cannot read.
    Unsupported,
    /// A limit of [`Limits`](crate::Limits) is exceeded.
    Limit,
    /// Nodes are their own ancestors, or have two parents.
    Hierarchy,
    /// The file holds no triangle.
    Empty,
    /// An option is out of its range.
    Options,
}

/// The reason why a model could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// The file that is at fault, which may be a material or a buffer that the model names.
    pub file: PathBuf,
    /// The place in that file.
    pub place: Place,
    /// The kind of the error.
    pub kind: Kind,
    /// The number found and the number needed, and how to repair the file.
    pub message: String,
}

impl Error {
    pub(crate) fn new(file: &Path, place: Place, kind: Kind, message: impl Into<String>) -> Self {
        Self { file: file.to_path_buf(), place, kind, message: message.into() }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, place, message, .. } = self;
        match place {
            Place::File => write!(f, "{}: {message}", file.display()),
            Place::Line(line) => write!(f, "{}:{line}: {message}", file.display()),
            Place::Byte(byte) => write!(f, "{}, byte {byte}: {message}", file.display()),
            Place::Json(path) => write!(f, "{}, {path}: {message}", file.display()),
        }
    }
}

impl std::error::Error for Error {}
