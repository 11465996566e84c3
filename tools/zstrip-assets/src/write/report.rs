//! The report of the writer: sizes, worst errors, and what the container cannot hold.

use std::fmt;

use crate::model::Wrap;
use crate::words::{count, verb};

/// A container, and the report of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// The container.
    pub bytes: Vec<u8>,
    /// The report.
    pub report: WriteReport,
}

/// The report of [`write`](crate::write()).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WriteReport {
    /// Bytes of the container.
    pub bytes: usize,
    /// Sections that are not empty: name, items, bytes.
    pub sections: Vec<(&'static str, usize, usize)>,
    /// Bytes of textures, with their palettes and alpha; they are part of the section of bytes.
    pub texture_bytes: usize,
    /// Draws of the model, which is the number of places that `Model::place` takes.
    pub draws: usize,
    /// Words of 32 bits that a pose takes.
    pub pose_words: usize,
    /// Vertices of parts, each once, without levels of detail.
    pub vertices: usize,
    /// Triangles of them.
    pub triangles: usize,
    /// Parts, with levels of detail.
    pub parts: usize,
    /// Levels of detail, from fine to coarse.
    pub levels: Vec<LevelReport>,
    /// Clips: name, milliseconds, keys before, keys written.
    pub clips: Vec<(String, u32, usize, usize)>,
    /// The worst errors, of the container as it was read back.
    pub errors: Errors,
    /// Everything that was left out or changed.
    pub notes: Vec<WriteNote>,
}

/// A level of detail, of all parts that have it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LevelReport {
    /// Parts.
    pub parts: usize,
    /// Vertices.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// The largest error of a part, in units of its mesh.
    pub error: f64,
}

/// The worst differences between the container, as the library reads it, and the import, in 64-bit floats.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Largest distance of a position, in units of the model.
    pub position: f64,
    /// Largest difference of a coordinate, in steps of the 16-bit numbers: at most one half.
    pub position_steps: f64,
    /// Largest angle of a normal, in degrees.
    pub normal: f64,
    /// Largest difference of a texture coordinate, where 1 is the whole texture.
    pub uv: f64,
    /// That difference in texels of the texture as it was written.
    pub uv_texels: f64,
    /// Largest difference of a vertex colour, of 255.
    pub color: f64,
    /// Largest difference of a texel's channel, of 255, to the image after it was shrunk.
    pub texel: f64,
    /// Largest distance of a vertex in the model at rest, nodes and joints included, in units of the model.
    pub rest: f64,
    /// Largest distance of a vertex in the clips, in units of the model.
    pub pose: f64,
    /// Largest angle of a posed normal, in degrees.
    pub pose_normal: f64,
    /// Number of vertices that were compared in poses.
    pub posed_vertices: usize,
}

/// Something that the container cannot hold as it was, or that was left out.
#[derive(Clone, Debug, PartialEq)]
pub enum WriteNote {
    /// The alpha of vertex colours is left out.
    VertexAlpha {
        /// The number of vertices that are not opaque.
        vertices: usize,
    },
    /// Texture coordinates are left out, because nothing uses them.
    UnusedUvs {
        /// The number of parts.
        parts: usize,
    },
    /// A part has a texture and no texture coordinates.
    MissingUvs {
        /// The number of parts.
        parts: usize,
    },
    /// Triangles were cut at the sides of a texture that is clamped or mirrored beyond them.
    Cut {
        /// The number of the material in the import.
        material: usize,
        /// Its name.
        name: String,
        /// The number of triangles that were cut: those that cross a side, and neighbours that got points of the cut.
        /// Triangles of levels of detail count, too.
        triangles: usize,
        /// The number of triangles that they became.
        into: usize,
    },
    /// A texture that is to be clamped or mirrored beyond its sides repeats there: to cut its triangles at the sides
    /// would take too many triangles.
    Wrapped {
        /// The number of the material in the import.
        material: usize,
        /// Its name.
        name: String,
        /// The way along u and v.
        wrap: [Wrap; 2],
        /// The least and the largest u, and the least and the largest v.
        range: [[f32; 2]; 2],
    },
    /// A texture was shrunk or brought to sides that are powers of two.
    Resized {
        /// The name of the image.
        image: String,
        /// Columns and rows before.
        from: [u32; 2],
        /// Columns and rows after.
        to: [u32; 2],
    },
    /// A texture has more colours than its palette.
    Quantized {
        /// The name of the image.
        image: String,
        /// Its colours.
        colors: usize,
        /// Colours of the palette.
        palette: usize,
    },
    /// Joints that move no vertex were left out.
    UnusedJoints {
        /// The number of joints.
        joints: usize,
    },
    /// Keys of animation were closer to each other than 1/65,535 of the clip, and became one.
    KeysMerged {
        /// The number of keys that are gone.
        keys: usize,
    },
    /// Curves that are too steep for 16 bits became straight pieces.
    CurvesCut {
        /// The number of channels.
        channels: usize,
    },
    /// Weights of morph targets are beyond ±2, and were limited.
    WeightsLimited {
        /// The number of weights.
        weights: usize,
    },
    /// Channels were left out: their node has a matrix, or morph targets that no mesh has.
    ChannelsDropped {
        /// The number of channels.
        channels: usize,
    },
    /// A node has a matrix that shears, and became two nodes.
    Sheared {
        /// The number of nodes.
        nodes: usize,
    },
    /// A mesh has more triangles or vertices than a part, and became several.
    Divided {
        /// The number of the mesh in the import.
        mesh: usize,
        /// The number of parts.
        parts: usize,
    },
    /// The model is so small that 16.16 numbers show it coarsely.
    Small {
        /// Its largest size.
        size: f64,
        /// A factor that brings it to about 4 units.
        factor: f64,
    },
    /// Levels of detail of meshes were left out: the mesh is moved, or it or its level takes more than one part.
    NoLevels {
        /// The number of meshes.
        meshes: usize,
    },
    /// Parts moved by joints or morph targets are not culled by clusters.
    NoClusters {
        /// The number of parts.
        parts: usize,
    },
}

impl fmt::Display for WriteNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::VertexAlpha { vertices } => {
                write!(f, "alpha of {} left out; use the material's", count(*vertices, "vertex"))
            }
            Self::UnusedUvs { parts } => {
                write!(f, "texture coordinates of {} without texture left out", count(*parts, "part"))
            }
            Self::MissingUvs { parts } => {
                write!(f, "{} with a texture and no coordinates: one texel shows", count(*parts, "part"))
            }
            Self::Cut { material, name, triangles, into } => {
                let triangles = count(*triangles, "triangle");
                write!(f, "material {material} {name:?}: {triangles} cut into {into} at the sides of its texture")
            }
            Self::Wrapped { material, name, wrap, range } => {
                write!(f, "material {material} {name:?}: its texture repeats here")?;
                for ((axis, wrap), [low, high]) in ["u", "v"].iter().zip(wrap).zip(range) {
                    let way = match wrap {
                        Wrap::Repeat => continue,
                        Wrap::Mirror => "mirrored",
                        Wrap::Clamp => "clamped",
                    };
                    write!(f, ", and is {way} along {axis} in the file, where {axis} goes from {low:.3} to {high:.3}")?;
                }
                write!(f, "; keep coordinates within 0 to 1, or draw what is beyond into the image")
            }
            Self::Resized { image, from, to } => {
                write!(f, "image {image:?} resized from {}×{} to {}×{}", from[0], from[1], to[0], to[1])
            }
            Self::Quantized { image, colors, palette } => {
                write!(f, "image {image:?} brought from {colors} colours to {palette}")
            }
            Self::UnusedJoints { joints } => {
                let moves = verb(*joints, "moves", "move");
                write!(f, "{} that {moves} nothing left out of skins", count(*joints, "joint"))
            }
            Self::KeysMerged { keys } => write!(f, "{} closer than 1/65535 of a clip merged", count(*keys, "key")),
            Self::CurvesCut { channels } => {
                write!(f, "curves of {} cut into straight pieces", count(*channels, "channel"))
            }
            Self::WeightsLimited { weights } => {
                write!(f, "{} of morph targets limited to ±2", count(*weights, "weight"))
            }
            Self::ChannelsDropped { channels } => {
                let moves = verb(*channels, "it moves", "they move");
                write!(f, "{} left out: nothing that {moves}", count(*channels, "channel"))
            }
            Self::Sheared { nodes } => {
                let became =
                    verb(*nodes, "a sheared matrix became two nodes", "sheared matrices became two nodes each");
                write!(f, "{} with {became}", count(*nodes, "node"))
            }
            Self::Divided { mesh, parts } => write!(f, "mesh {mesh} divided into {}", count(*parts, "part")),
            Self::NoLevels { meshes } => {
                write!(f, "levels of detail of {} left out: moved, or more than one part", count(*meshes, "mesh"))
            }
            Self::Small { size, factor } => {
                // In digits that can be read, also of models of 10⁻³⁰ units.
                let factor = if *factor < 1e9 { factor.to_string() } else { format!("{factor:e}") };
                let is_tiny = *size < 1e-3;
                let size = if is_tiny { format!("{size:.1e}") } else { format!("{size:.4}") };
                write!(f, "the model is only {size} units large; a scale {factor} times as large makes it more exact")
            }
            Self::NoClusters { parts } => {
                write!(f, "{} without clusters: moved by joints or morph targets", count(*parts, "part"))
            }
        }
    }
}

impl WriteReport {
    /// Adds a note, unless it counts nothing.
    pub(super) fn note(&mut self, count: usize, note: impl FnOnce(usize) -> WriteNote) {
        if count > 0 {
            self.notes.push(note(count));
        }
    }
}

impl fmt::Display for WriteReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { bytes, vertices, triangles, parts, .. } = self;
        let (vertices, triangles, parts) =
            (count(*vertices, "vertex"), count(*triangles, "triangle"), count(*parts, "part"));
        writeln!(f, "container: {bytes} bytes, {vertices}, {triangles}, {parts}")?;
        for (k, LevelReport { parts, vertices, triangles, error }) in self.levels.iter().enumerate() {
            let (vertices, triangles, parts) =
                (count(*vertices, "vertex"), count(*triangles, "triangle"), count(*parts, "part"));
            writeln!(
                f,
                "level of detail {}: {vertices}, {triangles}, {parts}, off by {error:.6} units at most",
                k + 1
            )?;
        }
        for (name, items, bytes) in &self.sections {
            writeln!(f, "  {name:<16} {items:>8} items {bytes:>9} bytes")?;
        }
        writeln!(f, "textures: {} bytes", self.texture_bytes)?;
        let (places, words) = (count(self.draws, "place"), count(self.pose_words, "word"));
        writeln!(f, "RAM: {places}, {words} of a pose")?;
        for (name, duration, before, after) in &self.clips {
            writeln!(f, "clip {name:?}: {duration} ms, {after} of {}", count(*before, "key"))?;
        }
        let Errors { position, position_steps, normal, uv, uv_texels, color, texel, .. } = self.errors;
        writeln!(f, "worst errors, read back:")?;
        writeln!(f, "  positions {position:.6} units ({position_steps:.3} steps), normals {normal:.3}°")?;
        writeln!(f, "  texture coordinates {uv:.7} ({uv_texels:.4} texels)")?;
        writeln!(f, "  colours {color:.2} of 255, texels {texel:.2} of 255")?;
        let Errors { rest, pose, pose_normal, posed_vertices, .. } = self.errors;
        writeln!(f, "  at rest {rest:.6} units")?;
        if posed_vertices > 0 {
            let posed = count(posed_vertices, "vertex");
            writeln!(f, "  in clips {pose:.6} units, normals {pose_normal:.3}°, of {posed} posed")?;
        }
        self.notes.iter().try_for_each(|note| writeln!(f, "- {note}"))
    }
}

/// The reason why no container was written.
#[derive(Clone, Debug, PartialEq)]
pub enum WriteError {
    /// A number of the import is not finite.
    NotFinite {
        /// The place in the import.
        place: String,
    },
    /// A number is beyond the range of 16.16 numbers.
    Range {
        /// The place in the import.
        place: String,
        /// The number.
        found: f64,
        /// The largest one.
        most: f64,
    },
    /// There are more items than the container can number.
    TooMany {
        /// The items.
        what: &'static str,
        /// Their number.
        found: usize,
        /// The most.
        most: usize,
    },
    /// A number of another item, in the import, is that of none.
    Index {
        /// The place in the import.
        place: String,
        /// The number.
        found: usize,
        /// The number of items.
        count: usize,
    },
    /// A number of another item, in the import, is not above that of the item that has it.
    Order {
        /// The place in the import.
        place: String,
        /// The number.
        found: usize,
        /// The least number.
        least: usize,
    },
    /// The error of a level of detail is not a number, or below that of the level before.
    LevelError {
        /// The number of the mesh in the import.
        mesh: usize,
        /// The error.
        found: f64,
        /// The error of the level before.
        least: f64,
    },
    /// An attribute has another number of items than there are vertices or keys.
    Count {
        /// The place in the import.
        place: String,
        /// The number of items.
        found: usize,
        /// The number that is needed.
        needed: usize,
    },
    /// An image has no texels.
    EmptyImage {
        /// The place in the import.
        place: String,
        /// Columns and rows.
        size: [u32; 2],
    },
    /// An option is out of its range.
    Options(String),
    /// The library refuses the bytes. This is a mistake of this crate.
    ReadBack(String),
}

impl fmt::Display for WriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { place } => write!(f, "{place} is not a finite number; export the model anew"),
            Self::Range { place, found, most } => {
                let factor = most / 8.0 / found.abs();
                write!(f, "{place} is {found}, and {most} is the most; scale the model by {factor:.2e}")
            }
            Self::TooMany { what, found, most } => {
                write!(f, "{found} {what}, and {most} are the most; divide or simplify the model")
            }
            Self::Index { place, found, count } => write!(f, "{place} is {found}, and there are {count}"),
            Self::Order { place, found, least } => write!(f, "{place} is {found}, and must be {least} or above"),
            Self::LevelError { mesh, found, least } => {
                write!(
                    f,
                    "the error of meshes[{mesh}] is {found}, and must be {least} or above, as its level is coarser"
                )
            }
            Self::Count { place, found, needed } => write!(f, "{place} has {found} items, and needs {needed}"),
            Self::EmptyImage { place, size: [columns, rows] } => {
                write!(f, "{place} has {columns}×{rows} texels, and needs one column and one row at least")
            }
            Self::Options(fault) => write!(f, "{fault}"),
            Self::ReadBack(error) => write!(f, "the container cannot be read back: {error}; please report it"),
        }
    }
}

impl std::error::Error for WriteError {}
