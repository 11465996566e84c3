//! Structures of what moves a model: skins, morph targets, clips and their keys.

use bytemuck::{Pod, Zeroable};

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
    /// First byte of the name, UTF-8, in [`SectionKind::Bytes`](crate::model::container::SectionKind::Bytes).
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
    /// First value, in [`SectionKind::Keys`](crate::model::container::SectionKind::Keys).
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
