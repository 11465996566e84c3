//! The container of models, bit by bit: the structures that its sections consist of.
//!
//! A tool writes with these definitions what [`Model::from_bytes`](crate::model::Model::from_bytes) reads with them.
//! All numbers are little-endian. Structures have no padding, and are read where they lie. `docs/container.md` shows
//! the layout. It lists the rules that [`Model::from_bytes`](crate::model::Model::from_bytes) checks, and those that it
//! does not: a container that breaks one of these is drawn wrong, and nothing else happens.

pub use super::animation_items::{Channel, Clip, Delta, Influence, Interpolation, Joint, Path, Skin, Target, Timeline};
pub use super::material_items::{AlphaMode, Material, Texture, TextureFormat};

use bytemuck::{Pod, Zeroable};

/// The first four bytes of a container.
pub const MAGIC: [u8; 4] = *b"ZSTM";

/// The version of the layout that this crate reads.
pub const VERSION: u16 = 1;

/// The number that stands for "none" in fields of 16 bits.
pub const NONE: u16 = u16::MAX;

/// The number that stands for "none" in fields of 32 bits.
pub const NONE_LONG: u32 = u32::MAX;

/// Kinds of sections, in the order of [`Header::table`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(usize)]
pub enum SectionKind {
    /// [`Node`]s.
    Nodes,
    /// [`Part`]s.
    Parts,
    /// [`Cluster`]s.
    Clusters,
    /// [`Material`]s.
    Materials,
    /// [`Texture`]s.
    Textures,
    /// [`Skin`]s.
    Skins,
    /// [`Joint`]s.
    Joints,
    /// [`Target`]s.
    Targets,
    /// [`Clip`]s.
    Clips,
    /// [`Channel`]s.
    Channels,
    /// [`Timeline`]s.
    Timelines,
    /// Positions, `[i16; 3]`: fractions, 1.15, of the cube of their part.
    Points,
    /// Normals, `[i8; 2]`: octahedral, see [`decode_normal`](crate::model::decode_normal).
    Normals,
    /// Colours of vertices, `[u8; 3]`: red, green, blue.
    Colors,
    /// Texture coordinates, `[u16; 2]`.
    Uvs,
    /// Texture coordinates, `[u8; 2]`.
    SmallUvs,
    /// Vertex numbers, `u16`, three for each triangle, counted from the part's first vertex.
    Indices,
    /// [`Influence`]s of joints on vertices.
    Influences,
    /// [`Delta`]s of morph targets.
    Deltas,
    /// Times of keys, `u16`: ticks, of which a clip has 65,535.
    Times,
    /// Values of keys and weights of morph targets, `i16`.
    Keys,
    /// Bytes: texels, palettes and names.
    Bytes,
}

impl SectionKind {
    /// Number of kinds.
    pub const COUNT: usize = 22;
}

/// A place of a section: bytes from the container's start, a multiple of 4; and the number of items.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Section {
    /// First byte.
    pub offset: u32,
    /// Number of items.
    pub count: u32,
}

/// The head of a container.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Header {
    /// [`MAGIC`].
    pub magic: [u8; 4],
    /// [`VERSION`].
    pub version: u16,
    /// [`SectionKind::COUNT`].
    pub sections: u16,
    /// Number of bytes of the container.
    pub length: u32,
    /// Number of draws: the sum of [`Node::parts`], at most 65,535.
    pub draws: u32,
    /// Number of words that a pose takes; see [`Pose::words`](crate::model::Pose::words).
    pub pose_words: u32,
    /// Number of weights of morph targets.
    pub weights: u32,
    /// The first of the weights that the rest pose has, in [`SectionKind::Keys`].
    pub rest_weights: u32,
    /// Middle of the box around the model at rest, 16.16.
    pub center: [i32; 3],
    /// Half the size of that box, 16.16, not negative.
    pub half: [i32; 3],
    /// Places of the sections.
    pub table: [Section; SectionKind::COUNT],
}

/// A node of the tree of transforms: scale, then rotation, then translation, then those of the parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Node {
    /// Number of the parent, below the node's own number; or [`NONE`].
    pub parent: u16,
    /// The first part that is drawn at this node.
    pub first_part: u16,
    /// Number of parts.
    pub parts: u16,
    /// Bytes of the name.
    pub name_length: u16,
    /// First byte of the name, UTF-8, in [`SectionKind::Bytes`].
    pub name: u32,
    /// Translation, 16.16.
    pub translation: [i32; 3],
    /// Rotation: a quaternion x, y, z, w of any length. The longest that fits is the most exact.
    pub rotation: [i16; 4],
    /// Factors along the axes, 16.16.
    pub scale: [i32; 3],
}

/// A part of a mesh: triangles of one material.
///
/// The vertices of all parts stand in [`SectionKind::Points`] one part after the other, and so do triangles, clusters
/// and morph targets in their sections.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Part {
    /// First position.
    pub first_vertex: u32,
    /// Number of vertices, at most 65,535.
    pub vertices: u32,
    /// First number of a vertex, in [`SectionKind::Indices`].
    pub first_index: u32,
    /// Number of triangles, at most 65,535.
    pub triangles: u32,
    /// First normal, or [`NONE_LONG`].
    pub first_normal: u32,
    /// First colour, or [`NONE_LONG`].
    pub first_color: u32,
    /// First pair of texture coordinates, in [`SectionKind::Uvs`] or [`SectionKind::SmallUvs`]; or [`NONE_LONG`].
    pub first_uv: u32,
    /// First influence of a joint. It is not used without a skin.
    pub first_influence: u32,
    /// First cluster.
    pub first_cluster: u32,
    /// First morph target.
    pub first_target: u32,
    /// Number of the first target's weight.
    pub first_weight: u32,
    /// First word of the part's posed vertices in the memory of a pose, or [`NONE_LONG`] for a part without skin and
    /// targets.
    pub pose: u32,
    /// The distance from `offset` that the fraction 32,768 would stand for, 16.16, above 0.
    pub scale: i32,
    /// Middle of the cube of positions, 16.16.
    pub offset: [i32; 3],
    /// Middle of the box around the positions, 16.16.
    pub center: [i32; 3],
    /// Half the size of that box, 16.16.
    pub half: [i32; 3],
    /// Texture coordinates that the stored number 0 stands for, 16.16.
    pub uv_offset: [i32; 2],
    /// Texels of the texture's first level in a unit of length, 24.8; 0 where it is not known.
    pub texels_per_unit: u32,
    /// Distance between this part and the finest part that it stands for, 16.16.
    pub error: u32,
    /// Number of clusters, or 0.
    pub clusters: u16,
    /// Number of morph targets.
    pub targets: u16,
    /// Material.
    pub material: u16,
    /// Skin, or [`NONE`].
    pub skin: u16,
    /// A coarser part of a higher number that can stand for this one, or [`NONE`].
    pub coarser: u16,
    /// Texture coordinates are `uv_offset` + (the stored number << `uv_shift`), 16.16; at most 15.
    pub uv_shift: u8,
    /// Bits of a texture coordinate: 16 or 8.
    pub uv_bits: u8,
}

/// Some triangles of a part that are culled at once.
///
/// A cluster is seen from its back from an eye e if (c - e) · a ≥ k |c - e| + r, where c is the middle and r half the
/// diagonal of the box, a is `axis` / 127, and k is `cutoff` / 127.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Cluster {
    /// Middle of the box, in the part's fractions.
    pub center: [i16; 3],
    /// Half the size of the box, in the part's fractions, rounded up.
    pub half: [u16; 3],
    /// First triangle, counted from that of the part: that after the last one of the cluster before.
    pub first_triangle: u16,
    /// Number of triangles, at least 1.
    pub triangles: u16,
    /// Middle of the normals.
    pub axis: [i8; 3],
    /// 127 for a cluster that is never seen from its back.
    pub cutoff: i8,
}
