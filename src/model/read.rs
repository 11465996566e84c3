//! Bytes in, a [`Model`] out: sections are found and read where they lie. `check.rs` checks the numbers in them.

use super::container::{
    Channel, Clip, Cluster, Delta, Header, Influence, Joint, MAGIC, Material, NONE, NONE_LONG, Node, Part, Section,
    SectionKind, Skin, Target, Texture, TextureFormat, Timeline, VERSION,
};
use super::error::ModelError;
use super::range::in_range;
use crate::math::{Scalar, Vec3};
use crate::mesh::{Bounds, Mesh, MeshData, Positions};
use bytemuck::Pod;
use core::mem::offset_of;

/// A checked model in the bytes of a [container](crate::model::container). Copying it copies references only.
#[derive(Clone, Copy, Debug)]
pub struct Model<'a> {
    pub(super) header: &'a Header,
    pub(super) nodes: &'a [Node],
    pub(super) parts: &'a [Part],
    pub(super) clusters: &'a [Cluster],
    pub(super) materials: &'a [Material],
    pub(super) textures: &'a [Texture],
    pub(super) skins: &'a [Skin],
    pub(super) joints: &'a [Joint],
    pub(super) targets: &'a [Target],
    pub(super) clips: &'a [Clip],
    pub(super) channels: &'a [Channel],
    pub(super) timelines: &'a [Timeline],
    pub(super) points: &'a [[i16; 3]],
    pub(super) normals: &'a [[i8; 2]],
    pub(super) colors: &'a [[u8; 3]],
    pub(super) uvs: &'a [[u16; 2]],
    pub(super) small_uvs: &'a [[u8; 2]],
    pub(super) indices: &'a [u16],
    pub(super) influences: &'a [Influence],
    pub(super) deltas: &'a [Delta],
    pub(super) times: &'a [u16],
    pub(super) keys: &'a [i16],
    pub(super) bytes: &'a [u8],
}

/// Words of a node's transform, or of a joint's, in the memory of a pose.
pub(super) const MATRIX_WORDS: usize = 12;

/// Words before the posed vertices of a part in the memory of a pose: scale, offset, middle and half of the box.
pub(super) const POSED_HEAD: usize = 10;

/// Returns the number of words of that many vectors of three 16-bit numbers.
pub(super) const fn vector_words(vectors: usize) -> usize {
    3 * vectors.div_ceil(2)
}

/// Returns some items of a section.
pub(super) fn items<T>(all: &[T], first: u32, count: usize) -> &[T] {
    all.get(first as usize..).and_then(|rest| rest.get(..count)).unwrap_or_default()
}

/// Returns the little-endian number at a byte; 0 past the end.
const fn number_at(bytes: &[u8], at: usize) -> usize {
    match bytes.split_at_checked(at) {
        Some((_, [a, b, c, d, ..])) => u32::from_le_bytes([*a, *b, *c, *d]) as usize,
        _ => 0,
    }
}

/// Returns the number of words that a pose takes, from the bytes of a container.
pub(super) const fn pose_words(bytes: &[u8]) -> usize {
    number_at(bytes, offset_of!(Header, pose_words))
}

impl<'a> Model<'a> {
    /// Returns the number of draws that the bytes of a container speak of: for the size of an array in a constant, as
    /// [`place`](Self::place) takes it. [`from_bytes`](Self::from_bytes) checks it.
    #[must_use]
    pub const fn draws(bytes: &[u8]) -> usize {
        number_at(bytes, offset_of!(Header, draws))
    }

    /// Reads a model where it lies: nothing is copied. The bytes begin at a multiple of 4, as
    /// [`include_model`](crate::include_model) makes them; bytes past the container's end are ignored.
    ///
    /// # Errors
    /// The first mistake found, with the number found and the one that was needed. What this function accepts is drawn
    /// without errors. It takes some instructions per vertex and triangle: call it once, not per frame.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, ModelError> {
        let model = Self::of_sections(bytes)?;
        model.check()?;
        Ok(model)
    }

    /// Returns the box around the model at rest.
    #[must_use]
    pub const fn bounds(&self) -> Bounds {
        bounds_of(self.header.center, self.header.half)
    }

    /// Returns the number of triangles of the finest parts, counted once per draw.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        let parts = self.nodes.iter().flat_map(|node| items(self.parts, node.first_part.into(), node.parts.into()));
        parts.fold(0, |sum, part| sum.saturating_add(part.triangles as usize))
    }

    /// Returns the mesh of a part at rest, for draws of one's own: positions, indices, colours and bounds. Normals and
    /// texture coordinates are packed, and not in it.
    #[must_use]
    pub fn mesh(&self, part: usize) -> Option<Mesh<'a>> {
        self.parts.get(part).map(|part| self.mesh_of(part))
    }

    pub(super) fn mesh_of(&self, part: &Part) -> Mesh<'a> {
        Mesh::of_checked(self.mesh_data(part), bounds_of(part.center, part.half), part.triangles as u16)
    }

    /// Returns the number of a node by its name.
    #[must_use]
    pub fn node_named(&self, name: &str) -> Option<usize> {
        self.nodes.iter().position(|node| self.name(node.name, node.name_length.into()) == name.as_bytes())
    }

    /// Returns the bytes of a name.
    pub(super) fn name(&self, first: u32, length: usize) -> &'a [u8] {
        items(self.bytes, first, length)
    }

    fn of_sections(bytes: &'a [u8]) -> Result<Self, ModelError> {
        let past = bytes.as_ptr().align_offset(4);
        if past != 0 {
            return Err(ModelError::Misaligned { past: 4_usize.saturating_sub(past) });
        }
        let short = |needed: usize| ModelError::Short { found: bytes.len(), needed };
        let head = bytes.get(..size_of::<Header>()).and_then(|head| bytemuck::try_from_bytes::<Header>(head).ok());
        let Some(header) = head else {
            return Err(match bytes.first_chunk() {
                Some(magic) if *magic != MAGIC => ModelError::Magic { found: *magic },
                _ => short(size_of::<Header>()),
            });
        };
        if header.magic != MAGIC {
            return Err(ModelError::Magic { found: header.magic });
        }
        if header.version != VERSION || cfg!(target_endian = "big") {
            return Err(ModelError::Version { found: header.version, needed: VERSION });
        }
        let count = SectionKind::COUNT as i64;
        in_range(None, 0, "sections", header.sections.into(), count..=count)?;
        let Some(bytes) = bytes.get(..header.length as usize) else { return Err(short(header.length as usize)) };
        in_range(None, 0, "length", header.length.into(), size_of::<Header>() as i64..=u32::MAX.into())?;
        let from = Sections { bytes, header };
        Ok(Self {
            header,
            nodes: from.section(SectionKind::Nodes)?,
            parts: from.section(SectionKind::Parts)?,
            clusters: from.section(SectionKind::Clusters)?,
            materials: from.section(SectionKind::Materials)?,
            textures: from.section(SectionKind::Textures)?,
            skins: from.section(SectionKind::Skins)?,
            joints: from.section(SectionKind::Joints)?,
            targets: from.section(SectionKind::Targets)?,
            clips: from.section(SectionKind::Clips)?,
            channels: from.section(SectionKind::Channels)?,
            timelines: from.section(SectionKind::Timelines)?,
            points: from.section(SectionKind::Points)?,
            normals: from.section(SectionKind::Normals)?,
            colors: from.section(SectionKind::Colors)?,
            uvs: from.section(SectionKind::Uvs)?,
            small_uvs: from.section(SectionKind::SmallUvs)?,
            indices: from.section(SectionKind::Indices)?,
            influences: from.section(SectionKind::Influences)?,
            deltas: from.section(SectionKind::Deltas)?,
            times: from.section(SectionKind::Times)?,
            keys: from.section(SectionKind::Keys)?,
            bytes: from.section(SectionKind::Bytes)?,
        })
    }

    /// Returns the joints of a part's skin, and the number of the first one.
    pub(super) fn joints_of(&self, part: &Part) -> (&'a [Joint], usize) {
        match self.skins.get(usize::from(part.skin)) {
            Some(skin) => (items(self.joints, skin.first_joint, skin.joints as usize), skin.first_joint as usize),
            None => (&[], 0),
        }
    }

    /// Returns the clusters of a part.
    pub(super) fn clusters_of(&self, part: &Part) -> &'a [Cluster] {
        items(self.clusters, part.first_cluster, part.clusters.into())
    }

    /// Returns the slices of a part's mesh at rest, but for normals and texture coordinates, which are packed.
    pub(super) fn mesh_data(&self, part: &Part) -> MeshData<'a> {
        let vertices = part.vertices as usize;
        let (scale, offset) = (Scalar::from_bits(part.scale), Vec3::from_bits(part.offset));
        let points = items(self.points, part.first_vertex, vertices);
        let colors = (part.first_color != NONE_LONG).then(|| items(self.colors, part.first_color, vertices));
        MeshData {
            indices: Some(items(self.indices, part.first_index, 3 * part.triangles as usize)),
            colors,
            bounds: Some(bounds_of(part.center, part.half)),
            ..MeshData::new(Positions::Quantized { points, scale, offset })
        }
    }
}

impl Part {
    /// Returns whether a pose moves vertices of the part.
    pub(super) const fn is_posed(&self) -> bool {
        self.skin != NONE || self.targets > 0
    }

    /// Returns the number of words of the part's posed vertices.
    pub(super) const fn posed_words(&self) -> usize {
        let vectors = vector_words(self.vertices as usize);
        POSED_HEAD + if self.has_normals() { 2 * vectors } else { vectors }
    }

    pub(super) const fn has_normals(&self) -> bool {
        self.first_normal != NONE_LONG
    }
}

impl Texture {
    /// Returns the number of bytes of the levels before a level.
    pub(super) fn bytes_before(&self, format: TextureFormat, level: u8) -> u64 {
        let bytes = |level| {
            let (width, height) = self.size(level);
            format.bytes(width, height)
        };
        (0..level).map(bytes).sum()
    }

    /// Returns the number of columns and rows of a level.
    pub(super) fn size(&self, level: u8) -> (u16, u16) {
        let side = |length: u16| (length >> (level & 15)).max(1);
        (side(self.width), side(self.height))
    }
}

/// Returns the box with this middle and half size.
pub(super) const fn bounds_of(center: [i32; 3], half: [i32; 3]) -> Bounds {
    Bounds { center: Vec3::from_bits(center), half: Vec3::from_bits(half) }
}

/// The bytes that sections are taken from.
struct Sections<'a> {
    bytes: &'a [u8],
    header: &'a Header,
}

impl<'a> Sections<'a> {
    fn section<T: Pod>(&self, kind: SectionKind) -> Result<&'a [T], ModelError> {
        let Section { offset, count } = self.header.table.get(kind as usize).copied().unwrap_or_default();
        let error = ModelError::Section { section: kind, offset, count, length: self.header.length };
        let size = u64::from(count) * size_of::<T>() as u64;
        let Ok(size) = usize::try_from(size) else { return Err(error) };
        if offset % 4 != 0 || (offset as usize) < size_of::<Header>() {
            return Err(error);
        }
        let bytes = self.bytes.get(offset as usize..).and_then(|rest| rest.get(..size)).ok_or(error)?;
        bytemuck::try_cast_slice(bytes).map_err(|_| error)
    }
}
