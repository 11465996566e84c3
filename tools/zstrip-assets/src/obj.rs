//! Reads OBJ.
//!
//! Why not by a crate: `tobj` names no line in its errors and divides concave polygons as fans; `obj` does not check
//! indices; `obj-rs` panics at curves and refuses colours of vertices.

use std::collections::{HashMap, HashSet};

use crate::draft::{Context, Draft, FLAT_GROUP, NO_GROUP, Scene};
use crate::error::{Error, Kind, Place};
use crate::model::{Import, Node};
use crate::mtl::Library;
use crate::report::Note;
use crate::triangulate::{MOST_CORNERS, Triangulator};

/// Libraries that a note names. Every missing material has a note.
const NAMED_LIBRARIES: usize = 4;

/// The first letters of a name, which notes have.
const NAME_LETTERS: usize = 60;

/// An index that a corner does not have.
const NONE: u32 = u32::MAX;

/// Numbers of the position, the texture coordinates and the normal of a corner.
type Corner = [u32; 3];

pub(crate) fn read(bytes: &[u8], context: &mut Context) -> Result<Scene, Error> {
    let mut reader = Reader::default();
    let mut lines = Lines::new(bytes);
    if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
        return Err(context.error(Place::Byte(0), Kind::Syntax, "UTF-16 text; save the file as UTF-8"));
    }
    while let Some((number, line)) = lines.next() {
        reader.line(number, &line, context)?;
    }
    context.report.add(Note::NotUtf8 { lines: lines.not_utf8 });
    Ok(reader.finish(context))
}

#[derive(Default)]
struct Reader {
    positions: Vec<[f32; 3]>,
    /// Colours of positions; white before the first one that has any.
    colors: Vec<[f32; 4]>,
    uvs: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    parts: Vec<Part>,
    /// Numbers of parts by name of the material.
    by_material: HashMap<String, usize>,
    part: Option<usize>,
    group: Option<u32>,
    library: Library,
    libraries: HashSet<String>,
    /// The names of the first libraries, for messages.
    first_libraries: Vec<String>,
    triangulator: Triangulator,
    /// The corners of the face at hand.
    face: Vec<Corner>,
}

/// The faces of one material.
#[derive(Default)]
struct Part {
    material: String,
    corners: Vec<Corner>,
    triangles: Vec<[u32; 3]>,
    groups: Vec<u32>,
}

impl Reader {
    fn line(&mut self, number: usize, line: &str, context: &mut Context) -> Result<(), Error> {
        let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let place = Place::Line(number);
        let mut values = |least: usize| {
            let found = numbers(rest).filter(|values| values.len() >= least);
            let found = found.ok_or_else(|| {
                let message = format!("{word} with {:?}, where {least} finite numbers are needed", rest.trim());
                let is_non_finite = rest.split_whitespace().any(|x| x.parse().is_ok_and(|x: f32| !x.is_finite()));
                let kind = if is_non_finite { Kind::NonFinite } else { Kind::Syntax };
                context.error(place.clone(), kind, message)
            })?;
            context.take_numbers(found.len() as u64, || place.clone())?;
            Ok::<_, Error>(found)
        };
        match word {
            "v" => {
                let v = values(3)?;
                self.positions.push([v[0], v[1], v[2]]);
                // Colours follow x, y, z, or x, y, z, w.
                if let Some([r, g, b]) = v.get(if v.len() >= 7 { 4..7 } else { 3..6 }) {
                    self.colors.resize(self.positions.len() - 1, [1.0; 4]);
                    self.colors.push([r, g, b, &1.0].map(|x| x.clamp(0.0, 1.0)));
                }
            }
            "vt" => {
                let v = values(1)?;
                self.uvs.push([v[0], 1.0 - v.get(1).unwrap_or(&0.0)]);
            }
            "vn" => {
                let v = values(3)?;
                self.normals.push([v[0], v[1], v[2]]);
            }
            "f" | "fo" => self.face(rest, place, context)?,
            "usemtl" => {
                let name = rest.trim();
                let next = self.parts.len();
                let part = *self.by_material.entry(name.to_owned()).or_insert(next);
                if part == next {
                    self.parts.push(Part { material: name.to_owned(), ..Part::default() });
                }
                self.part = Some(part);
            }
            "mtllib" => self.mtllib(rest.trim(), context),
            "s" => {
                let group = rest.trim();
                // Names are no part of the format; each of them could only be a group of its own.
                self.group =
                    Some(if group == "off" { FLAT_GROUP } else { group.parse().unwrap_or(1).min(NO_GROUP - 1) });
            }
            "" | "o" | "g" => {}
            _ => context.ignore(&format!("\"{word}\" lines")),
        }
        Ok(())
    }

    /// Reads a library, whose name may hold blanks, or several ones.
    fn mtllib(&mut self, names: &str, context: &mut Context) {
        let is_one = names.split_whitespace().all(|name| !name.ends_with(".mtl")) || names.matches(".mtl").count() == 1;
        let names: Vec<&str> = if is_one { vec![names] } else { names.split_whitespace().collect() };
        for name in names {
            if self.libraries.insert(name.to_owned()) {
                if self.first_libraries.len() < NAMED_LIBRARIES {
                    self.first_libraries.push(name.chars().take(NAME_LETTERS).collect());
                }
                self.library.read(name, context);
            }
        }
    }

    fn face(&mut self, text: &str, place: Place, context: &mut Context) -> Result<(), Error> {
        self.face.clear();
        for word in text.split_whitespace() {
            let corner = self
                .corner(word)
                .map_err(|(kind, message)| context.error(place.clone(), kind, format!("corner {word:?}: {message}")))?;
            self.face.push(corner);
        }
        let count = self.face.len();
        if count < 3 {
            context.ignore("faces of less than 3 corners");
            return Ok(());
        }
        if count > MOST_CORNERS {
            let message = format!("a polygon of {count} corners, where {MOST_CORNERS} are the limit; divide it");
            return Err(context.error(place, Kind::Limit, message));
        }
        context.take_numbers(6 * count as u64, || place)?;
        let part = *self.part.get_or_insert_with(|| {
            self.parts.push(Part::default());
            self.by_material.insert(String::new(), self.parts.len() - 1);
            self.parts.len() - 1
        });
        let part = &mut self.parts[part];
        let first = part.corners.len() as u32;
        let corners: Vec<_> = self.face.iter().map(|corner| self.positions[corner[0] as usize]).collect();
        let triangles = self.triangulator.divide(&corners);
        part.groups.extend(std::iter::repeat_n(self.group.unwrap_or(NO_GROUP), triangles.len()));
        part.triangles.extend(triangles.iter().map(|t| t.map(|k| first + k)));
        part.corners.append(&mut self.face);
        Ok(())
    }

    /// Parses `position/uv/normal`, of which the last two may be missing.
    fn corner(&self, word: &str) -> Result<Corner, (Kind, String)> {
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let names = ["position", "texture coordinates", "normal"];
        let mut corner = [NONE; 3];
        for (k, index) in word.split('/').enumerate() {
            if k == 3 {
                return Err((Kind::Syntax, "more than two slashes".to_owned()));
            }
            if index.is_empty() && k > 0 {
                continue;
            }
            let number: i64 = index.parse().map_err(|_| (Kind::Syntax, format!("{index:?} is not a number")))?;
            // Numbers below 0 count backwards from the last one so far.
            let at = if number < 0 { counts[k] as i64 + number } else { number - 1 };
            if at < 0 || at >= counts[k] as i64 {
                let message = format!("{} {number}, where {} came before this line", names[k], counts[k]);
                return Err((Kind::Index, message));
            }
            corner[k] = at as u32;
        }
        Ok(corner)
    }

    fn finish(mut self, context: &mut Context) -> Scene {
        self.triangulator.report(&mut context.report);
        if !self.colors.is_empty() {
            self.colors.resize(self.positions.len(), [1.0; 4]);
        }
        let mut import = Import::default();
        let mut drafts = Vec::new();
        for part in std::mem::take(&mut self.parts) {
            if part.triangles.is_empty() {
                continue;
            }
            let mut draft = self.draft(&part);
            match self.library.get(&part.material) {
                Some(material) => {
                    draft.material = Some(import.materials.len());
                    import.materials.push(material.clone());
                }
                None if part.material.is_empty() => {}
                None => {
                    let name: String = part.material.chars().take(NAME_LETTERS).collect();
                    let more = match self.libraries.len() - self.first_libraries.len() {
                        0 => String::new(),
                        more => format!(" and {more} more"),
                    };
                    let reason = format!("{name:?} is in none of the files {:?}{more}", self.first_libraries);
                    context.report.add(Note::MaterialMissing { reason });
                }
            }
            drafts.push(draft);
        }
        import.nodes = vec![Node { meshes: (0..drafts.len()).collect(), ..Node::default() }];
        Scene { drafts, import, is_static: true }
    }

    /// Makes vertices of corners: one for each position, texture coordinates and normal that occur together.
    fn draft(&self, part: &Part) -> Draft {
        let mut vertices: HashMap<Corner, u32> = HashMap::new();
        let mut order: Vec<Corner> = Vec::new();
        let mut number = |corner: &Corner| {
            *vertices.entry(*corner).or_insert_with(|| {
                order.push(*corner);
                order.len() as u32 - 1
            })
        };
        let numbers: Vec<u32> = part.corners.iter().map(&mut number).collect();
        let mut draft = Draft { name: part.material.clone(), groups: part.groups.clone(), ..Draft::default() };
        draft.triangles = part.triangles.iter().map(|t| t.map(|k| numbers[k as usize])).collect();
        let into = &mut draft.vertices;
        into.positions = order.iter().map(|corner| self.positions[corner[0] as usize]).collect();
        if !self.colors.is_empty() {
            into.colors = order.iter().map(|corner| self.colors[corner[0] as usize]).collect();
        }
        if order.iter().any(|corner| corner[1] != NONE) {
            into.uvs =
                order.iter().map(|corner| self.uvs.get(corner[1] as usize).copied().unwrap_or([0.0; 2])).collect();
        }
        if order.iter().any(|corner| corner[2] != NONE) {
            let normal = |corner: &Corner| self.normals.get(corner[2] as usize).copied().unwrap_or([0.0; 3]);
            into.normals = order.iter().map(normal).collect();
        }
        draft
    }
}

/// The numbers of a line, up to a comment, or none if one of them is not a finite number.
pub(crate) fn numbers(text: &str) -> Option<Vec<f32>> {
    let values = text.split_whitespace().map(|word| word.parse().ok().filter(|x: &f32| x.is_finite()));
    values.collect()
}

/// Logical lines of a file: without comments, and with lines that end in a backslash joined to the next one.
pub(crate) struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
    /// Lines that are not UTF-8; their strange letters are replaced.
    pub not_utf8: usize,
}

impl<'a> Lines<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes), number: 0, not_utf8: 0 }
    }

    /// Returns the next logical line: the number of the first of its lines, and the text without blanks around it.
    pub fn next(&mut self) -> Option<(usize, String)> {
        if self.rest.is_empty() {
            return None;
        }
        let first = self.number + 1;
        let mut text = String::new();
        loop {
            let end = self.rest.iter().position(|byte| *byte == b'\n').unwrap_or(self.rest.len());
            let line = &self.rest[..end];
            self.rest = self.rest.get(end + 1..).unwrap_or_default();
            self.number += 1;
            let line = String::from_utf8_lossy(line);
            self.not_utf8 += usize::from(matches!(line, std::borrow::Cow::Owned(_)));
            // A # within a word belongs to a name.
            let comment =
                line.char_indices().find(|(at, c)| *c == '#' && !line[..*at].ends_with(|c: char| !c.is_whitespace()));
            let line = comment.map_or(&line[..], |(at, _)| &line[..at]).trim();
            match line.strip_suffix('\\') {
                Some(part) if !self.rest.is_empty() => {
                    text.push_str(part);
                    text.push(' ');
                }
                _ => {
                    text.push_str(line);
                    return Some((first, text.trim().to_owned()));
                }
            }
        }
    }
}
