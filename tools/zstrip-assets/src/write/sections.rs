//! Sections of a container that grow, and the bytes that they become.

use bytemuck::{Pod, Zeroable, bytes_of, cast_slice};
use zstrip::model::container::{Header, MAGIC, NONE_LONG, Section, SectionKind, VERSION};

use super::report::WriteError;

/// Names of sections, in the order of their numbers.
pub(crate) const SECTION_NAMES: [&str; SectionKind::COUNT] = [
    "nodes",
    "parts",
    "clusters",
    "materials",
    "textures",
    "skins",
    "joints",
    "targets",
    "clips",
    "channels",
    "timelines",
    "positions",
    "normals",
    "colours",
    "uvs",
    "small uvs",
    "indices",
    "influences",
    "deltas",
    "times",
    "keys",
    "texels and names",
];

/// Bytes and number of items of each section.
#[derive(Default)]
pub(super) struct Sections([(Vec<u8>, usize); SectionKind::COUNT]);

impl Sections {
    /// Returns the number of items of a section.
    pub fn count(&self, kind: SectionKind) -> u32 {
        self.0[kind as usize].1 as u32
    }

    /// Appends items, and returns the number of the first one.
    pub fn add<T: Pod>(&mut self, kind: SectionKind, items: &[T]) -> u32 {
        let (bytes, count) = &mut self.0[kind as usize];
        let first = *count as u32;
        bytes.extend_from_slice(cast_slice(items));
        *count += items.len();
        first
    }

    /// Appends an attribute, and returns the number of its first item, or [`NONE_LONG`] if it is empty.
    pub fn add_some<T: Pod>(&mut self, kind: SectionKind, items: &[T]) -> u32 {
        if items.is_empty() { NONE_LONG } else { self.add(kind, items) }
    }

    /// Appends bytes at an even place, as texels of 16 bits need it.
    pub fn add_even(&mut self, bytes: &[u8]) -> u32 {
        if self.count(SectionKind::Bytes) % 2 == 1 {
            self.add(SectionKind::Bytes, &[0_u8]);
        }
        self.add(SectionKind::Bytes, bytes)
    }

    /// Returns names, items and bytes of the sections that are not empty.
    pub fn sizes(&self) -> Vec<(&'static str, usize, usize)> {
        let of = SECTION_NAMES.iter().zip(&self.0).map(|(name, (bytes, count))| (*name, *count, bytes.len()));
        of.filter(|(_, count, _)| *count > 0).collect()
    }

    /// Puts the sections behind a header, whose table is filled in.
    pub fn container(&self, header: Header) -> Result<Vec<u8>, WriteError> {
        let padded: usize = self.0.iter().map(|(bytes, _)| bytes.len().next_multiple_of(4)).sum();
        let length = size_of::<Header>() + padded;
        let most = u32::MAX as usize;
        if length > most {
            return Err(WriteError::TooMany { what: "texels and names", found: length, most });
        }
        let mut table = [Section::zeroed(); SectionKind::COUNT];
        let mut body = Vec::with_capacity(padded);
        for (place, (bytes, count)) in table.iter_mut().zip(&self.0) {
            *place = Section { offset: (size_of::<Header>() + body.len()) as u32, count: *count as u32 };
            body.extend_from_slice(bytes);
            body.resize(body.len().next_multiple_of(4), 0);
        }
        let sections = SectionKind::COUNT as u16;
        let header = Header { magic: MAGIC, version: VERSION, sections, length: length as u32, table, ..header };
        Ok([bytes_of(&header), &body].concat())
    }
}
