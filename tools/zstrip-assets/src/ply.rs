//! Reads PLY: text, and binary of both byte orders.
//!
//! `ply-rs-bw` parses it, one element after the other, once this module has checked that the file can hold as many as
//! its header says.

use std::borrow::Cow;

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType};

use crate::draft::{Context, Draft, Scene};
use crate::error::{Error, Kind, Place};
use crate::model::{AlphaMode, Import, Material, Node, Texture, Wrap};
use crate::report::Note;
use crate::triangulate::{MOST_CORNERS, Triangulator};

pub(crate) fn read(bytes: &[u8], context: &mut Context) -> Result<Scene, Error> {
    // Text may end lines as Windows does; then so do headers of binary files, whose first line tells.
    let mut reader = Reader::new(bytes);
    let parser = Parser::<Element>::new();
    let header = parser.read_header(&mut reader).map_err(|error| failure(&error, None, context))?;
    let mut draft = Draft::default();
    let mut triangulator = Triangulator::default();
    let vertices = header.elements.get("vertex").map_or(0, |definition| definition.count);
    let mut faces = Faces { vertices, ..Faces::default() };
    for (name, definition) in &header.elements {
        let left = reader.get_ref().len();
        let at = bytes.len() - left;
        check_count(definition, left, &header, at, context)?;
        let elements = parser.read_payload_for_element(&mut reader, definition, &header).map_err(|error| {
            let at = bytes.len() - reader.get_ref().len();
            failure(&error, (header.encoding != Encoding::Ascii).then_some(at), context)
        })?;
        let place = |k: usize| element_place(header.encoding, definition, k, at, bytes);
        match &name[..] {
            "vertex" => add_vertices(&mut draft, definition, elements, &place, context)?,
            "face" => {
                if definition.properties.contains_key("red") {
                    context.ignore("colours of faces");
                }
                faces.polygons(elements, &place, context)?;
            }
            "tristrips" => faces.strips(elements, &place, context)?,
            _ => (0..definition.count.min(1)).for_each(|_| context.ignore(&format!("element \"{name}\""))),
        }
    }
    faces.put(&mut draft, &mut triangulator);
    triangulator.report(&mut context.report);
    let mut import = Import { nodes: vec![Node { meshes: vec![0], ..Node::default() }], ..Import::default() };
    if let Some(material) = material(&header, context) {
        import.materials.push(material);
        draft.material = Some(0);
    }
    Ok(Scene { drafts: vec![draft], import, is_static: true })
}

/// Checks that as many elements fit into what is left of the file, before memory is taken for them.
fn check_count(
    definition: &ElementDef,
    left: usize,
    header: &Header,
    at: usize,
    context: &mut Context,
) -> Result<(), Error> {
    let ElementDef { name, count, properties } = definition;
    let size = |kind: &PropertyType| match kind {
        PropertyType::Scalar(kind) | PropertyType::List(kind, _) => kind_size(kind),
    };
    // Text takes two letters for each property at least.
    let least = match header.encoding {
        Encoding::Ascii => (2 * properties.len()).saturating_sub(1),
        _ => properties.values().map(|property| size(&property.data_type)).sum(),
    };
    if *count > 0 && (least == 0 || *count > left / least) {
        let message = format!(
            "{count} × element {name:?} of {least} bytes at least, where {left} bytes are left; export the file again"
        );
        return Err(context.error(Place::Byte(at), Kind::Syntax, message));
    }
    context.take_numbers((*count as u64).saturating_mul(12), || Place::Byte(at))
}

fn kind_size(kind: &ply_rs_bw::ply::ScalarType) -> usize {
    use ply_rs_bw::ply::ScalarType::{Char, Double, Float, Int, Short, UChar, UInt, UShort};
    match kind {
        Char | UChar => 1,
        Short | UShort => 2,
        Int | UInt | Float => 4,
        Double => 8,
    }
}

/// The place of an element that was read: its line in text, or its first byte.
fn element_place(encoding: Encoding, definition: &ElementDef, k: usize, at: usize, bytes: &[u8]) -> Place {
    if encoding == Encoding::Ascii {
        return Place::Line(bytes[..at].iter().filter(|byte| **byte == b'\n').count() + k + 1);
    }
    // Lists have any length, so the elements before have to be walked over.
    let mut place = at;
    for property in (0..k).flat_map(|_| definition.properties.values()) {
        place += match &property.data_type {
            PropertyType::Scalar(kind) => kind_size(kind),
            PropertyType::List(count, kind) => {
                let size = kind_size(count);
                let digits = bytes.get(place..place + size).unwrap_or_default().iter();
                let add = |sum: usize, digit: &u8| sum << 8 | usize::from(*digit);
                let count =
                    if encoding == Encoding::BinaryBigEndian { digits.fold(0, add) } else { digits.rfold(0, add) };
                size + count * kind_size(kind)
            }
        };
    }
    Place::Byte(place)
}

fn failure(error: &ParseError, byte: Option<usize>, context: &Context) -> Error {
    let place = match (byte, error.line()) {
        (Some(byte), _) => Place::Byte(byte),
        (None, Some(line)) => Place::Line(line),
        (None, None) => Place::File,
    };
    // The error quotes the line, and then repeats all of it as the cause.
    let text = error.to_string();
    let (_, text) = text.split_once(": ").filter(|_| error.line().is_some()).unwrap_or(("", &text));
    let text = text.split("\n\tError").next().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ");
    let text: String = text.chars().take(200).collect();
    context.error(place, Kind::Syntax, format!("{text}; export the file again"))
}

/// One element: the attributes of a vertex, or the lists of a face.
#[derive(Default)]
struct Element {
    position: [f32; 3],
    normal: [f32; 3],
    uv: [f32; 2],
    color: [f32; 4],
    /// Corners, or the corners of strips with -1 between them.
    corners: Vec<i64>,
    /// u and v of each corner.
    corner_uvs: Vec<f32>,
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self { color: [1.0; 4], ..Self::default() }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if let Some(x) = property.to_f32_lossy() {
            if let Some((place, is_color)) = self.place(name) {
                let most = match property {
                    Property::UChar(_) => 255.0,
                    Property::UShort(_) => 65_535.0,
                    _ => 1.0,
                };
                *place = if is_color { x / most } else { x };
            }
            return PropertyAccessResult::Set;
        }
        match (name, property) {
            ("vertex_indices" | "vertex_index", list) => self.corners = integers(list),
            ("texcoord", Property::ListFloat(list)) => self.corner_uvs = list,
            ("texcoord", Property::ListDouble(list)) => self.corner_uvs = list.iter().map(|x| *x as f32).collect(),
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

impl Element {
    /// The number that a property of this name sets, and whether it is a colour.
    fn place(&mut self, name: &str) -> Option<(&mut f32, bool)> {
        let Self { position, normal, uv, color, .. } = self;
        Some(match name {
            "x" => (&mut position[0], false),
            "y" => (&mut position[1], false),
            "z" => (&mut position[2], false),
            "nx" => (&mut normal[0], false),
            "ny" => (&mut normal[1], false),
            "nz" => (&mut normal[2], false),
            "u" | "s" | "texture_u" => (&mut uv[0], false),
            "v" | "t" | "texture_v" => (&mut uv[1], false),
            "red" | "r" | "diffuse_red" => (&mut color[0], true),
            "green" | "g" | "diffuse_green" => (&mut color[1], true),
            "blue" | "b" | "diffuse_blue" => (&mut color[2], true),
            "alpha" | "a" => (&mut color[3], true),
            _ => return None,
        })
    }
}

/// The integers of a list; there are none in a list of floats.
fn integers(list: Property) -> Vec<i64> {
    fn wide<T: Into<i64>>(list: Vec<T>) -> Vec<i64> {
        list.into_iter().map(Into::into).collect()
    }
    match list {
        Property::ListChar(list) => wide(list),
        Property::ListUChar(list) => wide(list),
        Property::ListShort(list) => wide(list),
        Property::ListUShort(list) => wide(list),
        Property::ListInt(list) => wide(list),
        Property::ListUInt(list) => wide(list),
        _ => Vec::new(),
    }
}

fn add_vertices(
    draft: &mut Draft,
    definition: &ElementDef,
    elements: Vec<Element>,
    place: &dyn Fn(usize) -> Place,
    context: &Context,
) -> Result<(), Error> {
    let has = |names: &[&str]| names.iter().any(|name| definition.properties.contains_key(*name));
    if let Some(missing) = ["x", "y", "z"].iter().find(|name| !definition.properties.contains_key(**name)) {
        return Err(context.error(Place::File, Kind::Missing, format!("vertices without property {missing:?}")));
    }
    for (k, element) in elements.iter().enumerate() {
        let numbers = element.position.iter().chain(&element.normal).chain(&element.uv).chain(&element.color);
        if !numbers.clone().all(|x| x.is_finite()) {
            let message = format!("vertex {k} has a number that is not finite; export the file again");
            return Err(context.error(place(k), Kind::NonFinite, message));
        }
    }
    let into = &mut draft.vertices;
    into.positions = elements.iter().map(|e| e.position).collect();
    if has(&["nx"]) {
        into.normals = elements.iter().map(|e| e.normal).collect();
    }
    if has(&["u", "s", "texture_u"]) {
        into.uvs = elements.iter().map(|e| [e.uv[0], 1.0 - e.uv[1]]).collect();
    }
    if has(&["red", "r", "diffuse_red"]) {
        into.colors = elements.iter().map(|e| e.color.map(|x| x.clamp(0.0, 1.0))).collect();
    }
    Ok(())
}

/// Polygons, which may come before the vertices that they number.
#[derive(Default)]
struct Faces {
    /// The number of vertices, as the header says.
    vertices: usize,
    /// Corners of all polygons, all of which there are.
    corners: Vec<u32>,
    /// u and v of corners that have their own; it may end before the corners do.
    uvs: Vec<Option<[f32; 2]>>,
    /// The ends of polygons in the corners.
    ends: Vec<usize>,
}

impl Faces {
    fn polygons(
        &mut self,
        elements: Vec<Element>,
        place: &dyn Fn(usize) -> Place,
        context: &mut Context,
    ) -> Result<(), Error> {
        for (k, Element { corners, corner_uvs, .. }) in elements.into_iter().enumerate() {
            if corners.len() < 3 {
                context.ignore("faces of less than 3 corners");
                continue;
            }
            if corners.len() > MOST_CORNERS {
                let message = format!("a polygon of {} corners, where {MOST_CORNERS} are the limit", corners.len());
                return Err(context.error(place(k), Kind::Limit, message));
            }
            context.take_numbers(6 * corners.len() as u64, || place(k))?;
            if !corner_uvs.iter().all(|x| x.is_finite()) {
                return Err(context.error(place(k), Kind::NonFinite, "texture coordinates that are not finite"));
            }
            let first = self.corners.len();
            for corner in corners {
                self.corners.push(self.vertex(corner, || place(k), context)?);
            }
            if !corner_uvs.is_empty() {
                self.uvs.resize(first, None);
                self.uvs.extend(corner_uvs.as_chunks::<2>().0.iter().map(|[u, v]| Some([*u, 1.0 - v])));
                self.uvs.resize(self.corners.len(), None);
            }
            self.ends.push(self.corners.len());
        }
        Ok(())
    }

    fn strips(
        &mut self,
        elements: Vec<Element>,
        place: &dyn Fn(usize) -> Place,
        context: &mut Context,
    ) -> Result<(), Error> {
        for (k, element) in elements.into_iter().enumerate() {
            context.take_numbers(18 * element.corners.len() as u64, || place(k))?;
            for strip in element.corners.split(|corner| *corner == -1) {
                let vertices = strip.iter().map(|corner| self.vertex(*corner, || place(k), context));
                for (k, window) in vertices.collect::<Result<Vec<_>, _>>()?.windows(3).enumerate() {
                    // Every second triangle goes the other way around.
                    let [a, b] = if k % 2 == 0 { [0, 1] } else { [1, 0] };
                    self.corners.extend([window[a], window[b], window[2]]);
                    self.ends.push(self.corners.len());
                }
            }
        }
        Ok(())
    }

    /// Returns the number of a vertex, or an error if there is none of that number.
    fn vertex(&self, corner: i64, place: impl FnOnce() -> Place, context: &Context) -> Result<u32, Error> {
        let count = self.vertices;
        u32::try_from(corner).ok().filter(|vertex| (*vertex as usize) < count).ok_or_else(|| {
            let message = format!(
                "it names vertex {corner}, where the file has {count} vertices, 0 is the first; export it again"
            );
            context.error(place(), Kind::Index, message)
        })
    }

    fn put(mut self, draft: &mut Draft, triangulator: &mut Triangulator) {
        let has_uvs = !self.uvs.is_empty();
        if has_uvs {
            // Each corner becomes a vertex, as its texture coordinates may be its own; equal ones are welded later.
            draft.vertices = draft.vertices.select(&self.corners);
            self.uvs.resize(self.corners.len(), None);
            let of_vertex = |k: usize| draft.vertices.uvs.get(k).copied().unwrap_or_default();
            draft.vertices.uvs =
                self.uvs.iter().enumerate().map(|(k, uv)| uv.unwrap_or_else(|| of_vertex(k))).collect();
        }
        let mut begin = 0;
        for end in self.ends {
            let number = |k: usize| if has_uvs { k as u32 } else { self.corners[k] };
            let corners: Vec<_> = (begin..end).map(|k| draft.vertices.positions[number(k) as usize]).collect();
            let triangles = triangulator.divide(&corners);
            draft.triangles.extend(triangles.iter().map(|t| t.map(|k| number(begin + k as usize))));
            begin = end;
        }
    }
}

/// The material of the texture that a comment names, as MeshLab writes it.
fn material(header: &Header, context: &mut Context) -> Option<Material> {
    let file = header.comments.iter().find_map(|comment| comment.trim().strip_prefix("TextureFile "))?.trim();
    let Context { images, files, options, .. } = context;
    let read = || files.read_beside(file).map(Cow::Owned).map_err(|error| error.to_string());
    match images.of_file(file, file, &options.limits, read) {
        Ok(image) => {
            let texture = Texture { image, wrap: [Wrap::Repeat; 2], nearest: false };
            Some(Material { texture: Some(texture), alpha: AlphaMode::Opaque, ..Material::default() })
        }
        Err(reason) => {
            context.report.add(Note::TextureMissing { reason });
            None
        }
    }
}
