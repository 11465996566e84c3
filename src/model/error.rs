//! Errors in the bytes of a container, and in the memory that a pose or a placed model takes.

use super::container::SectionKind;
use crate::mesh::MeshError;
use core::fmt;

/// An error in the bytes of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ModelError {
    /// The bytes do not begin at a multiple of 4.
    Misaligned {
        /// Number of bytes past a multiple of 4.
        past: usize,
    },
    /// The bytes end too early.
    Short {
        /// Number of bytes.
        found: usize,
        /// Number of bytes that the container has: those of its header, if that is incomplete.
        needed: usize,
    },
    /// The bytes do not begin as a container does: they are something else, or in another byte order.
    Magic {
        /// The first four bytes.
        found: [u8; 4],
    },
    /// The version is another one.
    Version {
        /// The version of the bytes.
        found: u16,
        /// The version that this crate reads.
        needed: u16,
    },
    /// A section begins at no multiple of 4, or within the header, or ends past the container.
    Section {
        /// Kind of the section.
        section: SectionKind,
        /// First byte.
        offset: u32,
        /// Number of items.
        count: u32,
        /// Number of bytes of the container.
        length: u32,
    },
    /// A number of the header or of an item of a section is out of range.
    Number {
        /// Kind of the section; `None` for the header.
        section: Option<SectionKind>,
        /// Number of the item.
        item: usize,
        /// Name of the field.
        field: &'static str,
        /// The number.
        found: i64,
        /// The least number that is allowed.
        least: i64,
        /// The greatest number that is allowed. If it is below `least`, none is.
        most: i64,
    },
    /// Items of another section, or of a part, are not there: their range ends past the last item.
    Items {
        /// Kind of the section that speaks of them; `None` for the header.
        section: Option<SectionKind>,
        /// Number of the item that speaks of them.
        item: usize,
        /// Name of the field with the number of the first one.
        field: &'static str,
        /// Number of the first one.
        first: u32,
        /// Number of items from the first one on.
        count: u64,
        /// Number of items that there are.
        length: usize,
    },
    /// A vertex is outside of the box of its cluster or of a joint that moves it.
    Outside {
        /// Kind of section that the box is in.
        section: SectionKind,
        /// Number of the box.
        item: usize,
        /// Number of the part.
        part: usize,
        /// Number of the vertex in its part.
        vertex: usize,
    },
    /// The mesh of a part has a mistake.
    Mesh {
        /// Number of the part.
        part: usize,
        /// The mistake.
        error: MeshError,
    },
}

#[cfg(feature = "defmt")]
impl defmt::Format for ModelError {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}", defmt::Debug2Format(self));
    }
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Misaligned { past } => {
                write!(f, "the bytes begin {past} past a multiple of 4: put them into a static by include_model!")
            }
            Self::Short { found, needed } => write!(f, "{found} bytes, but the container has at least {needed}"),
            Self::Magic { found } => write!(f, "the bytes begin with {found:?}, a container with b\"ZSTM\""),
            Self::Version { found, needed } => {
                write!(f, "version {found} of the container, must be {needed}: write it anew")
            }
            Self::Section { section, offset, count, length } => write!(
                f,
                "section {section:?}: {count} items from byte {offset} on must begin at a multiple of 4 after the header, \
                 and end by byte {length}"
            ),
            Self::Number { section, item, field, found, least, most } => {
                write_place(f, section, item)?;
                if least == most {
                    write!(f, "{field} is {found}, must be {least}")
                } else if least > most {
                    write!(f, "{field} is {found}, but no number is allowed here")
                } else {
                    write!(f, "{field} is {found}, must be in {least}..={most}")
                }
            }
            Self::Items { section, item, field, first, count, length } => {
                write_place(f, section, item)?;
                write!(f, "{field} is {first}, and {count} from there on end past the last of {length}")
            }
            Self::Outside { section, item, part, vertex } => {
                write!(f, "the box of item {item} of {section:?} does not hold vertex {vertex} of part {part}")
            }
            Self::Mesh { part, error } => write!(f, "part {part}: {error}"),
        }
    }
}

/// Writes which item an error is in.
fn write_place(f: &mut fmt::Formatter<'_>, section: Option<SectionKind>, item: usize) -> fmt::Result {
    match section {
        Some(section) => write!(f, "{section:?}, item {item}: "),
        None => f.write_str("the header: "),
    }
}

impl core::error::Error for ModelError {}

/// An error in the memory that is lent to a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum MemoryError {
    /// The words for a pose are too few.
    Pose {
        /// Number of words.
        found: usize,
        /// Number of words that the model takes: [`Pose::words`](crate::model::Pose::words).
        needed: usize,
    },
    /// The places are too few.
    Places {
        /// Number of places.
        found: usize,
        /// Number of draws of the model: [`Model::draws`](crate::model::Model::draws).
        needed: usize,
    },
}

impl fmt::Display for MemoryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Pose { found, needed } => write!(f, "{found} words for a pose, but the model takes {needed}"),
            Self::Places { found, needed } => write!(f, "{found} places, but the model has {needed} draws"),
        }
    }
}

impl core::error::Error for MemoryError {}
