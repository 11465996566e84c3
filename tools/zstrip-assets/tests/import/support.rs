//! A folder for the files of a test, small files of each format, and random numbers.

use std::path::PathBuf;

use serde_json::{Value, json};
use zstrip_assets::{Error, Import, Mesh, Note, Options, Report, import};

/// A folder that is gone after the test.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file, and returns the folder to write more.
    pub fn with(self, name: &str, bytes: impl AsRef<[u8]>) -> Self {
        std::fs::write(self.path(name), bytes).expect("a file");
        self
    }

    pub fn import(&self, name: &str, options: &Options) -> Result<(Import, Report), Error> {
        import(&self.path(name), options)
    }
}

/// Imports one file with the default options.
pub fn read(name: &str, bytes: impl AsRef<[u8]>) -> Result<(Import, Report), Error> {
    read_with(name, bytes, &Options::default())
}

pub fn read_with(name: &str, bytes: impl AsRef<[u8]>, options: &Options) -> Result<(Import, Report), Error> {
    Folder::new().with(name, bytes).import(name, options)
}

/// The one mesh of an import.
pub fn only_mesh(import: &Import) -> &Mesh {
    assert_eq!(import.meshes.len(), 1);
    &import.meshes[0]
}

/// Whether a report has a note.
pub fn has(report: &Report, note: &Note) -> bool {
    report.notes.contains(note)
}

/// The corners of triangles as positions.
pub fn corners(mesh: &Mesh) -> Vec<[[f32; 3]; 3]> {
    mesh.triangles.iter().map(|t| t.map(|v| mesh.vertices.positions[v as usize])).collect()
}

/// Triangles as positions, each beginning at its least corner, in an order that files do not matter for.
pub fn sorted_corners(mesh: &Mesh) -> Vec<[[f32; 3]; 3]> {
    let mut all = corners(mesh);
    for triangle in &mut all {
        let least = (0..3).min_by(|a, b| triangle[*a].partial_cmp(&triangle[*b]).expect("numbers")).expect("a corner");
        triangle.rotate_left(least);
    }
    all.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    all
}

/// A PNG of one colour.
pub fn png(width: u32, height: u32) -> Vec<u8> {
    picture(width, height, image::ImageFormat::Png)
}

/// An image of one colour.
pub fn picture(width: u32, height: u32, format: image::ImageFormat) -> Vec<u8> {
    let image = image::RgbImage::from_pixel(width, height, image::Rgb([10, 20, 30]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).expect("an image");
    bytes.into_inner()
}

/// Random numbers by splitmix64.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, end: usize) -> usize {
        (self.bits() % end as u64) as usize
    }

    /// A number from 0 to 1.
    pub fn part(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A glTF document that grows, with one binary buffer.
pub struct Document {
    pub json: Value,
    pub bytes: Vec<u8>,
}

impl Document {
    /// A scene of one node, which shows a mesh of one primitive without attributes.
    pub fn new() -> Self {
        let json = json!({
            "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
            "meshes": [{ "primitives": [{ "attributes": {} }] }], "accessors": [], "bufferViews": []
        });
        Self { json, bytes: Vec::new() }
    }

    /// A triangle in the plane of x and y.
    pub fn triangle() -> Self {
        let mut document = Self::new();
        let positions = document.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        document.attribute("POSITION", positions);
        document
    }

    pub fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json.as_object_mut().expect("an object").entry(list).or_insert(json!([]));
        let list = list.as_array_mut().expect("a list");
        list.push(value);
        list.len() - 1
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }))
    }

    pub fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        let width = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let (min, max) = (vec![-1e9; width], vec![1e9; width]);
        let view = self.view(&bytes);
        let count = values.len() / width;
        let accessor = json!({
            "bufferView": view, "componentType": 5126, "count": count, "type": kind, "min": min, "max": max
        });
        self.push("accessors", accessor)
    }

    pub fn bytes(&mut self, kind: &str, count: usize, values: &[u8], normalized: bool) -> usize {
        let view = self.view(values);
        let accessor = json!({
            "bufferView": view, "componentType": 5121, "count": count, "type": kind, "normalized": normalized
        });
        self.push("accessors", accessor)
    }

    pub fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    pub fn attribute(&mut self, name: &str, accessor: usize) {
        self.primitive()["attributes"][name] = json!(accessor);
    }

    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let length = 12 + 8 + text.len() + 8 + self.bytes.len();
        let mut glb = b"glTF".to_vec();
        glb.extend([2, length as u32].into_iter().flat_map(u32::to_le_bytes));
        glb.extend((text.len() as u32).to_le_bytes());
        glb.extend(b"JSON");
        glb.extend(text);
        glb.extend((self.bytes.len() as u32).to_le_bytes());
        glb.extend(b"BIN\0");
        glb.extend(&self.bytes);
        glb
    }

    pub fn import(&self) -> Result<(Import, Report), Error> {
        read("model.glb", self.glb())
    }
}
