//! The container of models, bit by bit: the structures that its sections consist of.
//!
//! A tool writes with these definitions what [`Model::from_bytes`](crate::model::Model::from_bytes) reads with them.
//! All numbers are little-endian. Structures have no padding, and are read where they lie. `docs/container.md` shows
//! the layout. It lists the rules that [`Model::from_bytes`](crate::model::Model::from_bytes) checks, and those that it
//! does not: a container that breaks one of these is drawn wrong, and nothing else happens.

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

/// A way to treat alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum AlphaMode {
    /// Alpha is ignored, that of the texture too.
    Opaque,
    /// Pixels whose alpha is below the cutoff are not drawn. Alpha is that of the texture times that of the material.
    Mask,
    /// Colours are blended by alpha with what is there, and depth is not written.
    Blend,
}

impl AlphaMode {
    /// Returns the mode of a number.
    #[must_use]
    pub const fn of(number: u8) -> Option<Self> {
        match number {
            0 => Some(Self::Opaque),
            1 => Some(Self::Mask),
            2 => Some(Self::Blend),
            _ => None,
        }
    }
}

/// A material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Material {
    /// Red, green, blue and alpha, which the texture and the colours of vertices are multiplied by.
    pub color: [u8; 4],
    /// Colour of highlights.
    pub specular: [u8; 3],
    /// Exponent of highlights, 0 for none.
    pub shininess: u8,
    /// Texture, or [`NONE`].
    pub texture: u16,
    /// Number of an [`AlphaMode`].
    pub alpha_mode: u8,
    /// The least alpha that is drawn in [`AlphaMode::Mask`].
    pub cutoff: u8,
    /// Bits: [`DOUBLE_SIDED`](Self::DOUBLE_SIDED), [`UNLIT`](Self::UNLIT).
    pub flags: u32,
}

impl Material {
    /// Bit of [`flags`](Self::flags): faces are drawn that show their back.
    pub const DOUBLE_SIDED: u32 = 1;
    /// Bit of [`flags`](Self::flags): light changes nothing.
    pub const UNLIT: u32 = 2;
}

/// A format of texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum TextureFormat {
    /// RGB565, 16 bits, the lower byte first. The first byte has an even number.
    Rgb565,
    /// Numbers of colours of a palette, 8 bits.
    Palette8,
    /// Numbers of colours of a palette, 4 bits.
    Palette4,
    /// Numbers of colours of a palette, 2 bits.
    Palette2,
    /// Numbers of colours of a palette, 1 bit.
    Palette1,
    /// Grey, 8 bits.
    Gray8,
    /// White, with 1 bit of alpha: 0 is transparent.
    Mask,
}

impl TextureFormat {
    /// Returns the format of a number.
    #[must_use]
    pub const fn of(number: u8) -> Option<Self> {
        match number {
            0 => Some(Self::Rgb565),
            1 => Some(Self::Palette8),
            2 => Some(Self::Palette4),
            3 => Some(Self::Palette2),
            4 => Some(Self::Palette1),
            5 => Some(Self::Gray8),
            6 => Some(Self::Mask),
            _ => None,
        }
    }

    /// Returns the number of bits of a texel.
    #[must_use]
    pub const fn bits(self) -> usize {
        match self {
            Self::Rgb565 => 16,
            Self::Palette8 | Self::Gray8 => 8,
            Self::Palette4 => 4,
            Self::Palette2 => 2,
            Self::Palette1 | Self::Mask => 1,
        }
    }

    /// Returns the number of bytes of an image: rows start at whole bytes. At most 2³³.
    #[must_use]
    pub const fn bytes(self, width: u16, height: u16) -> u64 {
        (width as u64 * self.bits() as u64).div_ceil(8) * height as u64
    }
}

/// A texture, which repeats beyond its sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Texture {
    /// Columns of the first level, at least 1.
    pub width: u16,
    /// Rows of the first level, at least 1.
    pub height: u16,
    /// Number of a [`TextureFormat`].
    pub format: u8,
    /// Number of levels, at least 1: each has half the sides of the level before, rounded down, at least 1.
    pub levels: u8,
    /// Number of colours of the palette, three bytes each; 0 for formats without one.
    pub colors: u16,
    /// First byte of the first level. The bytes of the other levels follow it, one level after the other.
    pub texels: u32,
    /// First byte of the palette.
    pub palette: u32,
    /// First byte of alpha: 4 bits per texel, in levels as the texels; or [`NONE_LONG`].
    pub alpha: u32,
}

/// A skin: joints that move vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Skin {
    /// First joint.
    pub first_joint: u32,
    /// Number of joints, from 1 to 256.
    pub joints: u32,
}

/// A joint of a skin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Joint {
    /// The inverse bind matrix after the part's scale and offset: it takes fractions of the cube, where 1 is 32,768, to
    /// the joint's space. Three rows, 16.16, the translation in the fourth column. So all parts of a skin have one
    /// scale and one offset.
    pub inverse_bind: [[i32; 4]; 3],
    /// Middle of a box around all vertices that the joint has an influence on, at rest, in fractions.
    pub center: [i16; 3],
    /// Half the size of that box, in fractions.
    pub half: [u16; 3],
    /// The node that the joint is.
    pub node: u16,
    /// 1 if the joint has an influence on any vertex, otherwise 0.
    pub used: u16,
}

/// The joints that move a vertex, by falling weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Influence {
    /// Numbers of joints in the skin.
    pub joints: [u8; 4],
    /// Weights of the second, third and fourth joint in 256ths, none above the one before. The first joint has what is
    /// left of 256.
    pub weights: [u8; 3],
    /// 0.
    pub zero: u8,
}

/// A morph target of a part: vertices that a weight moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Target {
    /// First delta: that after the last one of the target before.
    pub first_delta: u32,
    /// The first vertex of the part that the target moves.
    pub first_vertex: u16,
    /// Number of vertices, and of deltas.
    pub vertices: u16,
}

/// Move of a vertex by a morph target of weight 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Delta {
    /// Move of the position, in the part's fractions.
    pub point: [i16; 3],
    /// Move of the normal, 64 = 1.
    pub normal: [i8; 3],
    /// 0.
    pub zero: u8,
}

/// A clip of animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Clip {
    /// First channel. Channels of transforms come first, by the numbers of their nodes; those of weights follow.
    pub first_channel: u32,
    /// Number of channels.
    pub channels: u32,
    /// Duration in milliseconds, at least 1.
    pub duration: u32,
    /// First byte of the name, UTF-8, in [`SectionKind::Bytes`].
    pub name: u32,
    /// Bytes of the name.
    pub name_length: u32,
    /// Middle of the box around the model in all poses of the clip, 16.16.
    pub center: [i32; 3],
    /// Half the size of that box, 16.16, not negative.
    pub half: [i32; 3],
}

/// Times of keys that channels share: ascending, at least one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Timeline {
    /// First time: that after the last one of the timeline before.
    pub first_time: u32,
    /// Number of times.
    pub times: u32,
}

/// A property that a channel changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Path {
    /// Translation of a node: 3 numbers.
    Translation,
    /// Rotation of a node: 4 numbers.
    Rotation,
    /// Scale of a node: 3 numbers.
    Scale,
    /// Weights of morph targets.
    Weights,
}

impl Path {
    /// Returns the path of a number.
    #[must_use]
    pub const fn of(number: u8) -> Option<Self> {
        match number {
            0 => Some(Self::Translation),
            1 => Some(Self::Rotation),
            2 => Some(Self::Scale),
            3 => Some(Self::Weights),
            _ => None,
        }
    }
}

/// A way from key to key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Interpolation {
    /// A straight line; for rotations, an arc at an even pace.
    Linear,
    /// The value of the key before.
    Step,
    /// A cubic Hermite curve. A key has three values: the tangent before it, its value, the tangent after it. Tangents
    /// are multiplied by the time between the two keys that they are used for.
    Cubic,
}

impl Interpolation {
    /// Returns the interpolation of a number.
    #[must_use]
    pub const fn of(number: u8) -> Option<Self> {
        match number {
            0 => Some(Self::Linear),
            1 => Some(Self::Step),
            2 => Some(Self::Cubic),
            _ => None,
        }
    }

    /// Returns the number of values of a key.
    #[must_use]
    pub const fn values(self) -> usize {
        match self {
            Self::Linear | Self::Step => 1,
            Self::Cubic => 3,
        }
    }
}

/// Keys of one property.
///
/// Translations and scales are `offset` + `scale` · key / 32,768. Tangents have no offset. Rotations are quaternions
/// x, y, z, w of length 32,767, and weights are 2.14.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Channel {
    /// Timeline of the keys.
    pub timeline: u32,
    /// First value, in [`SectionKind::Keys`].
    pub first_key: u32,
    /// The number that 32,768 would stand for, 16.16.
    pub scale: i32,
    /// The number that 0 stands for, 16.16.
    pub offset: [i32; 3],
    /// Node, or the first weight.
    pub target: u16,
    /// Number of weights; 0 for other paths.
    pub weights: u16,
    /// Number of a [`Path`].
    pub path: u8,
    /// Number of an [`Interpolation`].
    pub interpolation: u8,
    /// 0.
    pub zero: u16,
}
