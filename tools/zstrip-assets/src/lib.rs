//! Converts 3-D files for zstrip: OBJ, STL, PLY, glTF and GLB, with PNG, JPEG and BMP.
//!
//! [`build()`] does it in a build script. [`import()`] and [`write()`] are its two halves.
//!
//! [`import()`] reads a file, repairs it, and gives it back as plain data, an [`Import`], with a [`Report`] of what was
//! repaired, dropped or noticed. It is for programs on a host, such as `build.rs`; nothing of it runs on the
//! microcontroller.
//!
//! ```
//! use zstrip_assets::{Options, UpAxis, import};
//!
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("square.obj");
//! std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")?;
//! let (model, report) = import(&path, &Options::default())?;
//! assert_eq!(model.meshes[0].triangles.len(), 2);
//! println!("{report}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # From a file to meshes
//!
//! | step | in | out | file |
//! |---|---|---|---|
//! | read | bytes | polygons, materials, nodes, skins, keys | `obj.rs`, `mtl.rs`, `stl.rs`, `ply.rs`, `gltf/`, `image.rs` |
//! | triangulate | polygons | triangles | `triangulate.rs` |
//! | place | up axis, scale, center | vertices, or a node above all others | `place.rs` |
//! | clean | triangles | triangles that show something, and face the right way | `clean.rs` |
//! | weld | vertices | vertices that differ | `weld.rs` |
//! | simplify | triangles, a budget | fewer triangles | `simplify.rs` |
//! | normals | faces | a normal per vertex | `normals.rs` |
//! | cluster | triangles | clusters, meshes of at most 65,535 vertices | `cluster.rs` |
//! | levels of detail | meshes | meshes of fewer triangles, with measured errors | `lods.rs`, `distance.rs` |
//!
//! # From meshes to a container
//!
//! | step | in | out | file |
//! |---|---|---|---|
//! | check | an import | one without numbers that lead nowhere | `write/check.rs` |
//! | nodes | transforms | translations, rotations, scales | `write/nodes.rs` |
//! | textures | images | texels of few bits, in levels | `write/textures.rs` |
//! | cut | triangles that cross a side of a texture that does not repeat | triangles on one side of it | `write/cut.rs` |
//! | wrap | coordinates of triangles that cross no side | coordinates within the texture | `write/wraps.rs` |
//! | parts | meshes | 16-bit positions, packed attributes, cones of clusters | `write/parts.rs`, `write/uvs.rs`, `write/clusters.rs` |
//! | skins | joints | those that move something, with boxes | `write/skins.rs` |
//! | clips | channels | few keys of 16 bits | `write/clips.rs` |
//! | verify | bytes | worst errors | `write/verify.rs` |
//! | save | bytes | a file that is whole or not there | `save.rs` |
//!
//! # Files of strangers
//!
//! Whatever a file holds, the result is an import or an [`Error`] that says where the file is wrong. Paths in it lead
//! to files beside it and nowhere else, and [`Limits`] bound the memory that it can take.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod clean;
mod cluster;
mod distance;
mod draft;
mod error;
mod files;
mod geometry;
mod gltf;
mod image;
mod lods;
mod model;
mod mtl;
mod normals;
mod obj;
mod options;
mod place;
mod ply;
mod pose;
#[cfg(feature = "cli")]
pub mod preview;
mod process;
mod report;
mod save;
mod script;
mod simplify;
mod source;
mod stl;
mod triangulate;
mod vertices;
mod weld;
mod words;
mod write;

use std::path::Path as FilePath;

pub use error::{Error, Kind, Place};
pub use model::{
    AlphaMode, Animation, Bounds, Channel, Cluster, Cone, Image, Import, Interpolation, Material, Mesh, Morph, Node,
    Path, Skin, Texture, Transform, Vertices, Wrap,
};
pub use options::{Center, Limits, Normals, Options, UpAxis, Winding};
pub use report::{Counts, Note, Report};
pub use save::save;
pub use script::{build, build_with};
pub use source::write_rust;
pub use write::{
    Errors, LevelReport, TextureKind, UvSize, WriteError, WriteNote, WriteOptions, WriteReport, Written, write,
};

use draft::Context;
use files::Files;

/// A stage of an import, for programs that show progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// The file is read and parsed.
    Reading,
    /// A mesh is repaired and ordered.
    Mesh {
        /// The number of the mesh, from 1 on.
        number: usize,
        /// The number of meshes.
        count: usize,
    },
}

/// The format of a file.
#[derive(Clone, Copy)]
enum Format {
    Obj,
    Stl,
    Ply,
    Gltf,
}

impl Format {
    /// The format by the file's first bytes, or else by its name.
    fn of(path: &FilePath, bytes: &[u8]) -> Option<Self> {
        let name = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match &name[..] {
            _ if bytes.starts_with(b"glTF") => Some(Self::Gltf),
            _ if bytes.starts_with(b"ply") && name != "obj" => Some(Self::Ply),
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "ply" => Some(Self::Ply),
            "gltf" | "glb" => Some(Self::Gltf),
            _ => None,
        }
    }
}

/// Reads a model, repairs it, and returns it with a report of what was repaired.
///
/// # Errors
///
/// The file cannot be read, is not what its format asks for, exceeds the limits, or has no triangle; or an option is
/// out of its range.
pub fn import(path: &FilePath, options: &Options) -> Result<(Import, Report), Error> {
    import_with_progress(path, options, &mut |_| {})
}

/// Does what [`import()`] does, and calls `progress` before each stage.
///
/// # Errors
///
/// Those of [`import()`].
pub fn import_with_progress(
    path: &FilePath,
    options: &Options,
    progress: &mut dyn FnMut(Progress),
) -> Result<(Import, Report), Error> {
    if let Some(fault) = options.fault() {
        return Err(Error::new(path, Place::File, Kind::Options, fault));
    }
    progress(Progress::Reading);
    let mut files = Files::new(path, options.limits.file_bytes);
    let bytes = files.read_model()?;
    let mut context = Context::new(options, files);
    let Some(format) = Format::of(path, &bytes) else {
        let message = "not a file of a known format; its name must end in .obj, .stl, .ply, .gltf or .glb";
        return Err(context.error(Place::File, Kind::Unsupported, message));
    };
    let (mut scene, custom) = match format {
        Format::Obj => (obj::read(&bytes, &mut context)?, UpAxis::Y),
        Format::Stl => (stl::read(bytes, &mut context)?, UpAxis::Z),
        Format::Ply => (ply::read(&bytes, &mut context)?, UpAxis::Y),
        Format::Gltf => (gltf::read(&bytes, &mut context)?, UpAxis::Y),
    };
    context.report_ignored();
    for draft in &scene.drafts {
        let before = &mut context.report.before;
        before.vertices += draft.vertices.len();
        before.triangles += draft.triangles.len();
        before.meshes += 1;
    }
    let up = options.up.unwrap_or(custom);
    if scene.is_static {
        place::place_vertices(&mut scene, up, &context)?;
        context.unit = options.scale;
    }

    let mut import = scene.import;
    let image = options.texture.as_deref().map(|path| context.read_texture(path)).transpose()?;
    import.images = std::mem::take(&mut context.images.list);
    // Drafts that a node shows together are parts of one shape.
    let mut groups = Vec::new();
    let mut drafts = scene.drafts.into_iter();
    let mut first = 0;
    for node in &import.nodes {
        if node.meshes.first() == Some(&first) {
            first += node.meshes.len();
            groups.push(drafts.by_ref().take(node.meshes.len()).collect::<Vec<_>>());
        }
    }
    groups.iter_mut().for_each(|group| process::repair(group, &mut context));
    let triangles: usize = groups.iter().flatten().map(|draft| draft.triangles.len()).sum();
    if triangles == 0 {
        let message = "no triangle that shows anything; export the model as a mesh of faces";
        return Err(context.error(Place::File, Kind::Empty, message));
    }
    // Each draft keeps the same part of its triangles.
    let share = |of: usize| options.max_triangles.map(|most| part(of, most, triangles));
    let count = groups.len();
    let (mut meshes_of_drafts, mut shapes) = (Vec::new(), Vec::new());
    for (k, group) in groups.into_iter().enumerate() {
        progress(Progress::Mesh { number: k + 1, count });
        let first = import.meshes.len();
        for meshes in process::finish(group, &share, &mut context) {
            meshes_of_drafts.push(import.meshes.len()..import.meshes.len() + meshes.len());
            import.meshes.extend(meshes);
        }
        shapes.push(first..import.meshes.len());
    }
    let meshes = import.meshes.len();
    if let Some(image) = image {
        paint(&mut import, image);
    }
    for node in &mut import.nodes {
        let count: usize = node.meshes.iter().map(|draft| meshes_of_drafts[*draft].len()).sum();
        context.take_numbers(2 * count as u64, || Place::File)?;
        node.meshes = node.meshes.iter().flat_map(|draft| meshes_of_drafts[*draft].clone()).collect();
    }
    lods::add(&mut import, &shapes, options, &mut context.report);
    if !scene.is_static {
        place::place_nodes(&mut import, up, &context)?;
    }

    let mut report = context.report;
    (report.files, report.missing) = (context.files.read, context.files.missing);
    report.add(Note::Mirrored { nodes: import.mirrored() });
    report.after = Counts {
        vertices: import.meshes[..meshes].iter().map(|mesh| mesh.vertices.len()).sum(),
        triangles: import.meshes[..meshes].iter().map(|mesh| mesh.triangles.len()).sum(),
        meshes,
    };
    report.bounds = import.bounds();
    Ok((import, report))
}

/// Returns how many triangles of a draft of `of` stay where `most` of `all` may: 1 or more.
fn part(of: usize, most: usize, all: usize) -> usize {
    // The product may need more bits than a `usize` has; the part is at most `of`.
    (of as u128 * most as u128 / all.max(most) as u128).max(1) as usize
}

/// Gives an image to all materials that have no texture, and a material to all meshes that have none.
fn paint(import: &mut Import, image: usize) {
    if import.meshes.iter().any(|mesh| mesh.material.is_none()) {
        let white = import.materials.len();
        import.materials.push(Material::default());
        import.meshes.iter_mut().for_each(|mesh| mesh.material = mesh.material.or(Some(white)));
    }
    let texture = Texture { image, wrap: [Wrap::Repeat; 2], nearest: false };
    import.materials.iter_mut().for_each(|material| material.texture = material.texture.or(Some(texture)));
}
