//! Fuzz targets of the readers of `zstrip-assets`. Each writes its input into files, imports them with small limits and
//! with options that the input chooses, and writes what was imported as a container.
//!
//! What must hold: there is no panic; memory stays within the bound of [`Limits`]; indices and numbers of an import are
//! right; errors of the writer are not its own mistakes. `ci/fuzz` runs them.
//!
//! | target | files |
//! |---|---|
//! | [`obj`] | `a.obj`, and behind a byte 0, `a.mtl`; an image is beside them |
//! | [`stl`] | `a.stl` |
//! | [`ply`] | `a.ply`; an image is beside it |
//! | [`gltf`] | a GLB, where the input begins as one; otherwise the JSON of one, and behind a byte 0, its binary part |
//! | [`images`] | the texture of a triangle |

#[path = "../../../../fuzz/src/hash.rs"]
mod hash;
mod memory;
#[path = "../../../../fuzz/src/replay.rs"]
pub mod replay;
#[path = "../../../../tests/reference/rng.rs"]
#[allow(dead_code, reason = "the replay uses only part of it")]
mod rng;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use zstrip_assets::{
    Center, Image, Import, Limits, Normals, Options, UpAxis, Winding, WriteError, WriteOptions, import, write,
};

use hash::Hash;
use rng::Rng;

/// A name, and a function from any bytes to a hash of the results.
pub type Target = (&'static str, fn(&[u8]) -> u64);

/// All targets.
pub const TARGETS: [Target; 5] = [("obj", obj), ("stl", stl), ("ply", ply), ("gltf", gltf), ("images", images)];

/// The most bytes of an input; longer ones are cut.
const LONGEST: usize = 1 << 14;

/// Bytes that a reader takes for any file, and that few notes take.
const ANYWAY: u64 = 1 << 20;

/// Limits under which no file takes more than a few MB.
const LIMITS: Limits =
    Limits { file_bytes: 1 << 15, numbers: 1 << 15, json_values: 1 << 11, image_side: 256, texels: 1 << 14 };

/// Imports an OBJ file and its MTL.
pub fn obj(input: &[u8]) -> u64 {
    let (options, input) = options(input);
    let (obj, mtl) = halves(input);
    run("obj", &[("a.obj", obj), ("a.mtl", mtl), ("a.png", PNG)], &options)
}

/// Imports an STL file.
pub fn stl(input: &[u8]) -> u64 {
    let (options, input) = options(input);
    run("stl", &[("a.stl", input)], &options)
}

/// Imports a PLY file.
pub fn ply(input: &[u8]) -> u64 {
    let (options, input) = options(input);
    run("ply", &[("a.ply", input), ("a.png", PNG)], &options)
}

/// Imports a GLB file, whose sizes are right unless the input has them.
pub fn gltf(input: &[u8]) -> u64 {
    let (options, input) = options(input);
    if input.starts_with(b"glTF") {
        return run("gltf", &[("a.glb", input)], &options);
    }
    let (json, binary) = halves(input);
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, binary) = (padded(json, b' '), padded(binary, 0));
    let length = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
    let mut glb = b"glTF\x02\0\0\0".to_vec();
    glb.extend((28 + json.len() as u32 + binary.len() as u32).to_le_bytes());
    for (kind, part) in [(b"JSON", json), (b"BIN\0", binary)] {
        glb.extend(length(&part).iter().chain(kind).chain(&part));
    }
    run("gltf", &[("a.glb", &glb)], &options)
}

/// Imports an image, as the texture of a triangle.
pub fn images(input: &[u8]) -> u64 {
    let (options, input) = options(input);
    let obj = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n";
    let mtl = b"newmtl a\nmap_Kd a.png\nmap_d a.png\n";
    run("images", &[("a.obj", obj), ("a.mtl", mtl), ("a.png", input)], &options)
}

/// An image of 4 × 4 texels.
const PNG: &[u8] =
    b"\x89PNG\x0d\x0a\x1a\x0a\x00\x00\x00\x0dIHDR\x00\x00\x00\x04\x00\x00\x00\x04\x08\x06\x00\x00\x00\xa9\xf1\x9e~\
    \x00\x00\x00+IDATx\xda\x15\xc81\x01\x000\x0c\xc3\xb0\x00+0\x9f\x05\x15~\x9b{\xe8Q\x92}#T%c\x08u.0\x84\xcaE\
    \x0d\xa1\xea\x039\xc8#1\x09\x03\x0c\x07\x00\x00\x00\x00IEND\xaeB`\x82";

/// The bytes before the first byte 0, and those behind it.
fn halves(input: &[u8]) -> (&[u8], &[u8]) {
    let end = input.iter().position(|byte| *byte == 0).unwrap_or(input.len());
    (&input[..end], input.get(end + 1..).unwrap_or_default())
}

/// Takes options from the first byte of an input.
fn options(input: &[u8]) -> (Options, &[u8]) {
    let (first, rest) = input[..input.len().min(LONGEST)].split_first().unwrap_or((&0, &[]));
    let is = |bit: u32| first >> bit & 1 == 1;
    let options = Options {
        up: is(0).then_some(UpAxis::Z),
        scale: if is(1) { 0.01 } else { 1.0 },
        center: if is(2) { Center::Ground } else { Center::Keep },
        winding: if is(3) { Winding::FromNormals } else { Winding::Keep },
        normals: if is(4) { Normals::Flat } else { Normals::Keep },
        weld_distance: if is(5) { 0.1 } else { 0.0 },
        max_triangles: is(6).then_some(2),
        max_vertices: if is(7) { 4 } else { 65_535 },
        limits: LIMITS,
        ..Options::default()
    };
    (options, rest)
}

/// The folder of this process, in that of the system's temporary files. It stays: statics are not dropped.
fn folder() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| tempfile::Builder::new().prefix("zstrip-fuzz-").tempdir().expect("a folder").keep())
}

/// Imports the first of some files, checks the import, and writes it.
fn run(target: &str, files: &[(&str, &[u8])], options: &Options) -> u64 {
    let folder = folder().join(target);
    std::fs::create_dir_all(&folder).expect("a folder");
    for (name, bytes) in files {
        std::fs::write(folder.join(name), bytes).expect("a file");
    }
    let path = folder.join(files[0].0);
    let (result, most) = memory::most(|| import(&path, options));
    let Limits { file_bytes, numbers, json_values, texels, .. } = LIMITS;
    let bound = 8 * file_bytes + 64 * numbers + 300 * json_values + 4 * texels + ANYWAY;
    assert!(most as u64 <= bound, "{most} bytes were allocated, and the limits allow {bound}");
    let mut hash = Hash::default();
    match result {
        Ok((import, report)) => {
            check(&import);
            hash.bytes(report.to_string().as_bytes());
            match write(&import, &WriteOptions { max_texture: 32, ..WriteOptions::default() }) {
                Ok(written) => hash.bytes(&written.bytes),
                Err(error @ WriteError::ReadBack(_)) => panic!("{error}"),
                Err(error) => hash.bytes(error.to_string().as_bytes()),
            }
        }
        Err(error) => {
            assert!(!error.message.is_empty());
            hash.bytes(error.message.as_bytes());
        }
    }
    hash.0
}

/// Checks what the documentation of [`Import`] promises.
fn check(import: &Import) {
    for mesh in &import.meshes {
        let (vertices, count) = (&mesh.vertices, mesh.vertices.positions.len());
        assert!(!mesh.triangles.is_empty() && count <= 65_535);
        assert!(mesh.triangles.as_flattened().iter().all(|v| (*v as usize) < count), "an index");
        assert_eq!(mesh.clusters.iter().map(|cluster| cluster.count).sum::<usize>(), mesh.triangles.len());
        for length in [vertices.uvs.len(), vertices.colors.len(), vertices.joints.len(), vertices.weights.len()] {
            assert!(length == 0 || length == count, "{length} of {count}");
        }
        assert_eq!(vertices.normals.len(), count);
        assert!(vertices.positions.as_flattened().iter().all(|x| x.is_finite()), "a position");
        assert!(mesh.material.is_none_or(|material| material < import.materials.len()));
    }
    for (k, node) in import.nodes.iter().enumerate() {
        assert!(node.parent.is_none_or(|parent| parent < k));
        assert!(node.meshes.iter().all(|mesh| *mesh < import.meshes.len()));
    }
    for Image { width, height, texels, .. } in &import.images {
        assert_eq!(texels.len() as u64, 4 * u64::from(*width) * u64::from(*height));
    }
}
