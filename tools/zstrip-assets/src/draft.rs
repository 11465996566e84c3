//! Meshes as readers hand them on, before they are repaired and ordered.

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::{Error, Kind, Place};
use crate::files::Files;
use crate::image::Images;
use crate::model::{Import, Vertices};
use crate::options::Options;
use crate::report::{Note, Report};

/// The group of faces that have no smoothing group: they are smooth up to the crease angle.
pub(crate) const NO_GROUP: u32 = u32::MAX;

/// The group of faces that look flat.
pub(crate) const FLAT_GROUP: u32 = 0;

/// Triangles of one material.
#[derive(Default)]
pub(crate) struct Draft {
    pub name: String,
    pub material: Option<usize>,
    /// A normal of 0, 0, 0 is a missing one.
    pub vertices: Vertices,
    /// All indices are in range.
    pub triangles: Vec<[u32; 3]>,
    /// A smoothing group per triangle, or nothing.
    pub groups: Vec<u32>,
}

/// A file as it was read.
#[derive(Default)]
pub(crate) struct Scene {
    pub drafts: Vec<Draft>,
    /// All but the meshes. Nodes number drafts.
    pub import: Import,
    /// True where options move vertices, and false where they move a node above all others.
    pub is_static: bool,
}

/// Everything that a reader needs beside the bytes of the file.
pub(crate) struct Context<'o> {
    pub options: &'o Options,
    pub files: Files,
    pub images: Images,
    pub report: Report,
    /// The length in drafts of a unit of the file.
    pub unit: f64,
    numbers: u64,
    ignored: BTreeMap<String, usize>,
}

/// The most numbers whatever the limits are, so that those of vertices fit 32 bits.
const MOST_NUMBERS: u64 = 1 << 31;

/// Kinds of ignored things that are told apart.
const MOST_IGNORED: usize = 24;

/// The first letters of ignored things, by which they are told apart.
const IGNORED_LETTERS: usize = 40;

impl<'o> Context<'o> {
    pub fn new(options: &'o Options, files: Files) -> Self {
        let numbers = options.limits.numbers.min(MOST_NUMBERS);
        let images = Images::default();
        Self { options, files, images, report: Report::default(), unit: 1.0, numbers, ignored: BTreeMap::new() }
    }

    /// Returns an error in the model's file.
    pub fn error(&self, place: Place, kind: Kind, message: impl Into<String>) -> Error {
        Error::new(&self.files.model, place, kind, message)
    }

    /// Reads an image that the options name, and returns its number.
    pub fn read_texture(&mut self, path: &Path) -> Result<usize, Error> {
        let bytes = self.files.read_named(path)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        // No file of a model is named by the path from here, so the key is its own.
        let key = format!("option {}", path.display());
        let number = self.images.of_file(&key, &name, &self.options.limits, || Ok(bytes.into()));
        number.map_err(|message| Error::new(path, Place::File, Kind::Unsupported, message))
    }

    /// Takes `count` numbers from what the limits allow, before memory for them is taken.
    pub fn take_numbers(&mut self, count: u64, place: impl FnOnce() -> Place) -> Result<(), Error> {
        match self.numbers.checked_sub(count) {
            Some(left) => self.numbers = left,
            None => {
                let (limit, left) = (self.options.limits.numbers, self.numbers);
                let message = format!("{count} numbers more, where {left} of the limit of {limit} are left");
                return Err(self.error(place(), Kind::Limit, message));
            }
        }
        Ok(())
    }

    /// Counts a part of the file that means nothing here.
    pub fn ignore(&mut self, what: &str) {
        let what = what.char_indices().nth(IGNORED_LETTERS).map_or(what, |(end, _)| &what[..end]);
        if let Some(count) = self.ignored.get_mut(what) {
            *count += 1;
        } else if self.ignored.len() < MOST_IGNORED {
            self.ignored.insert(what.to_owned(), 1);
        } else {
            *self.ignored.entry("others".to_owned()).or_default() += 1;
        }
    }

    /// Puts all that was ignored into the report.
    pub fn report_ignored(&mut self) {
        for (what, count) in std::mem::take(&mut self.ignored) {
            self.report.add(Note::Ignored { what, count });
        }
    }
}
