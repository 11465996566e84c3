//! Reads STL, the text and the binary kind.
//!
//! `stl_io` parses both. It is given one line at a time, so that errors know their line; in lower case, as some
//! programs write upper case; and with a header that says of which kind the file is, because many binary files begin
//! with the letters of text ones. Normals of the file are those of triangles, so they are made anew from corners; they
//! only tell which side the file thinks is the front.

use std::io::{Cursor, Read, Seek, SeekFrom};

use crate::draft::{Context, Draft, Scene};
use crate::error::{Error, Kind, Place};
use crate::geometry::{dot, face_normal};
use crate::model::{Import, Node};
use crate::options::Winding;
use crate::report::Note;

/// Bytes before the first triangle of a binary file: a header and a count.
const HEADER: usize = 84;

/// Bytes of a triangle in a binary file.
const FACET: usize = 50;

/// Numbers that a triangle takes.
const NUMBERS: u64 = 12;

pub(crate) fn read(bytes: Vec<u8>, context: &mut Context) -> Result<Scene, Error> {
    let mut draft = Draft::default();
    match binary_count(&bytes) {
        Some(count) => read_binary(bytes, count, &mut draft, context)?,
        None if bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) => {
            read_text(&bytes, &mut draft, context)?;
        }
        None => return Err(wrong_size(&bytes, context)),
    }
    let nodes = vec![Node { meshes: vec![0], ..Node::default() }];
    Ok(Scene { drafts: vec![draft], import: Import { nodes, ..Import::default() }, is_static: true })
}

/// The count of triangles in a binary file, if the file holds as many. Some programs write a few bytes more.
fn binary_count(bytes: &[u8]) -> Option<usize> {
    let count = u32::from_le_bytes(*bytes.get(HEADER - 4..)?.first_chunk()?) as usize;
    let (found, needed) = (bytes.len() - HEADER, count.checked_mul(FACET)?);
    let is_text = bytes.starts_with(b"solid") && bytes[..HEADER].contains(&b'\n') && found != needed;
    (found >= needed && found - needed < FACET && !is_text).then_some(count)
}

/// The error of a file that is of neither kind.
fn wrong_size(bytes: &[u8], context: &Context) -> Error {
    let (place, message) = match bytes.get(HEADER - 4..).and_then(|rest| rest.first_chunk()) {
        None => {
            (Place::File, format!("{} bytes, where a binary STL has {HEADER} at least; export it again", bytes.len()))
        }
        Some(count) => {
            let needed = u64::from(u32::from_le_bytes(*count)) * FACET as u64 + HEADER as u64;
            let found = bytes.len();
            (Place::Byte(80), format!("the header asks for {needed} bytes, and the file has {found}; export it again"))
        }
    };
    context.error(place, Kind::Syntax, message)
}

fn read_binary(mut bytes: Vec<u8>, count: usize, draft: &mut Draft, context: &mut Context) -> Result<(), Error> {
    context.take_numbers(count as u64 * NUMBERS, || Place::Byte(80))?;
    // The reader takes a file that begins with "solid " for text.
    bytes[..80].fill(b' ');
    let facets =
        stl_io::create_stl_reader(&mut Cursor::new(bytes)).and_then(Iterator::collect::<std::io::Result<Vec<_>>>);
    let facets = facets.map_err(|error| context.error(Place::File, Kind::Syntax, error.to_string()))?;
    for (k, facet) in facets.iter().enumerate() {
        if !facet.vertices.iter().all(|v| v.0.iter().all(|x| x.is_finite())) {
            let message = format!("triangle {k} has a corner that is not finite; export it again");
            return Err(context.error(Place::Byte(HEADER + k * FACET), Kind::NonFinite, message));
        }
        add(facet, draft, context);
    }
    Ok(())
}

fn read_text(bytes: &[u8], draft: &mut Draft, context: &mut Context) -> Result<(), Error> {
    let mut lines = Lines { bytes, start: (0, 0), at: 0, line: 0, pending: Vec::new() };
    // A file may hold several solids, one after the other.
    while lines.skip_to_solid().map_err(|line| {
        let message = "a line that does not begin with \"solid\", where a solid should begin; export it again";
        context.error(Place::Line(line), Kind::Syntax, message)
    })? {
        let first = lines.line + 1;
        let mut facets = Vec::new();
        let failure = match stl_io::create_stl_reader(&mut lines) {
            Ok(mut reader) => reader.find_map(|facet| facet.map(|facet| facets.push(facet)).err()),
            Err(error) => Some(error),
        };
        if let Some(error) = failure {
            let kind = if error.to_string().contains("finite") { Kind::NonFinite } else { Kind::Syntax };
            return Err(context.error(Place::Line(lines.line), kind, format!("{error}; export it again")));
        }
        context.take_numbers(facets.len() as u64 * NUMBERS, || Place::Line(first))?;
        facets.iter().for_each(|facet| add(facet, draft, context));
    }
    Ok(())
}

fn add(facet: &stl_io::Triangle, draft: &mut Draft, context: &mut Context) {
    let corners = facet.vertices.map(|vertex| vertex.0);
    let first = draft.vertices.len() as u32;
    draft.vertices.positions.extend(corners);
    let mut triangle = [first, first + 1, first + 2];
    let normal = facet.normal.0.map(f64::from);
    let flip = context.options.winding == Winding::Flip;
    let front = face_normal(if flip { [corners[0], corners[2], corners[1]] } else { corners });
    if normal.iter().all(|x| x.is_finite()) && front.is_some_and(|front| dot(front, normal) < 0.0) {
        if context.options.winding == Winding::FromNormals {
            triangle.swap(1, 2);
            context.report.add(Note::Flipped { triangles: 1 });
        } else {
            context.report.add(Note::Opposed { triangles: 1 });
        }
    }
    draft.triangles.push(triangle);
}

/// The lines of a text file from the beginning of a solid. A call of `read` gives one line at most.
struct Lines<'a> {
    bytes: &'a [u8],
    /// The byte at which the solid begins, and how many lines are before it.
    start: (usize, usize),
    /// The byte at which the next line begins.
    at: usize,
    /// The number of lines read so far.
    line: usize,
    /// The part of a line that the last call had no room for.
    pending: Vec<u8>,
}

impl<'a> Lines<'a> {
    /// The next line, with its end.
    fn next_line(&self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        &rest[..rest.iter().position(|byte| *byte == b'\n').map_or(rest.len(), |end| end + 1)]
    }

    /// Goes on to the next solid; returns whether there is one, or the number of a line that is something else.
    fn skip_to_solid(&mut self) -> Result<bool, usize> {
        self.pending.clear();
        loop {
            let line = self.next_line();
            if line.is_empty() {
                return Ok(false);
            }
            if !line.trim_ascii().is_empty() {
                let is_solid = line.trim_ascii().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
                self.start = (self.at, self.line);
                return if is_solid { Ok(true) } else { Err(self.line + 1) };
            }
            self.at += line.len();
            self.line += 1;
        }
    }
}

impl Read for Lines<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.pending.is_empty() {
            let line = self.next_line();
            // The reader wants a name after "solid", and only UTF-8.
            self.pending = match line {
                [] => Vec::new(),
                _ if self.at == self.start.0 => b"solid x\n".to_vec(),
                _ => String::from_utf8_lossy(line).to_ascii_lowercase().into_bytes(),
            };
            self.at += line.len();
            self.line += usize::from(!line.is_empty());
        }
        let count = self.pending.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.pending[..count]);
        self.pending.drain(..count);
        Ok(count)
    }
}

impl Seek for Lines<'_> {
    /// Goes back to the beginning of the solid, which is the one place that the reader asks for.
    fn seek(&mut self, _: SeekFrom) -> std::io::Result<u64> {
        (self.at, self.line) = self.start;
        self.pending.clear();
        Ok(0)
    }
}
