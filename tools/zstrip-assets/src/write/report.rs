//! The report of the writer: sizes, worst errors, and what the container cannot hold.

use std::fmt;

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
    /// Vertices, triangles and parts, each once.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// Parts.
    pub parts: usize,
    /// Clips: name, milliseconds, keys before, keys written.
    pub clips: Vec<(String, u32, usize, usize)>,
    /// The worst errors, of the container as it was read back.
    pub errors: Errors,
    /// Everything that was left out or changed.
    pub notes: Vec<WriteNote>,
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
    /// A texture is to be clamped or mirrored, and repeats.
    Wrapped {
        /// The number of the mesh in the import.
        mesh: usize,
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
    /// Parts moved by joints or morph targets are not culled by clusters.
    NoClusters {
        /// The number of parts.
        parts: usize,
    },
}

impl fmt::Display for WriteNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::VertexAlpha { vertices } => write!(f, "alpha of {vertices} vertices left out; use the material's"),
            Self::UnusedUvs { parts } => write!(f, "texture coordinates of {parts} parts without texture left out"),
            Self::MissingUvs { parts } => write!(f, "{parts} parts have a texture and no coordinates: one texel shows"),
            Self::Wrapped { mesh } => {
                write!(f, "mesh {mesh} goes beyond a texture that does not repeat; here it repeats")
            }
            Self::Resized { image, from, to } => {
                write!(f, "image {image:?} resized from {}×{} to {}×{}", from[0], from[1], to[0], to[1])
            }
            Self::Quantized { image, colors, palette } => {
                write!(f, "image {image:?} brought from {colors} colours to {palette}")
            }
            Self::UnusedJoints { joints } => write!(f, "{joints} joints that move nothing left out of skins"),
            Self::KeysMerged { keys } => write!(f, "{keys} keys closer than 1/65535 of their clip merged"),
            Self::CurvesCut { channels } => write!(f, "curves of {channels} channels cut into straight pieces"),
            Self::WeightsLimited { weights } => write!(f, "{weights} weights of morph targets limited to ±2"),
            Self::ChannelsDropped { channels } => write!(f, "{channels} channels left out: nothing that they move"),
            Self::Sheared { nodes } => write!(f, "{nodes} nodes with sheared matrices became two nodes each"),
            Self::Divided { mesh, parts } => write!(f, "mesh {mesh} divided into {parts} parts"),
            Self::Small { size, factor } => {
                // In digits that can be read, also of models of 10⁻³⁰ units.
                let factor = if *factor < 1e9 { factor.to_string() } else { format!("{factor:e}") };
                let is_tiny = *size < 1e-3;
                let size = if is_tiny { format!("{size:.1e}") } else { format!("{size:.4}") };
                write!(f, "the model is only {size} units large; a scale {factor} times as large makes it more exact")
            }
            Self::NoClusters { parts } => write!(f, "{parts} parts that joints or morph targets move have no clusters"),
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
        writeln!(f, "container: {bytes} bytes, {vertices} vertices, {triangles} triangles, {parts} parts")?;
        for (name, items, bytes) in &self.sections {
            writeln!(f, "  {name:<16} {items:>8} items {bytes:>9} bytes")?;
        }
        writeln!(f, "textures: {} bytes", self.texture_bytes)?;
        writeln!(f, "RAM: {} places, {} words of a pose", self.draws, self.pose_words)?;
        for (name, duration, before, after) in &self.clips {
            writeln!(f, "clip {name:?}: {duration} ms, {after} of {before} keys")?;
        }
        let Errors { position, position_steps, normal, uv, uv_texels, color, texel, .. } = self.errors;
        writeln!(f, "worst errors, read back:")?;
        writeln!(f, "  positions {position:.6} units ({position_steps:.3} steps), normals {normal:.3}°")?;
        writeln!(f, "  texture coordinates {uv:.7} ({uv_texels:.4} texels)")?;
        writeln!(f, "  colours {color:.2} of 255, texels {texel:.2} of 255")?;
        let Errors { rest, pose, pose_normal, posed_vertices, .. } = self.errors;
        writeln!(f, "  at rest {rest:.6} units")?;
        if posed_vertices > 0 {
            writeln!(f, "  in clips {pose:.6} units, normals {pose_normal:.3}°, of {posed_vertices} posed vertices")?;
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
