//! The slices that a mesh is made of, before they are checked.

use super::bounds::{Bounds, BoundsNode};
use crate::math::{Scalar, Vec3};

/// Positions of the vertices of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Positions<'a> {
    /// Fractions of a cube, 6 bytes per vertex: position = `offset` + `scale` · q / 32,768. This is the fastest and
    /// smallest format.
    Quantized {
        /// Fractions, 1.15.
        points: &'a [[i16; 3]],
        /// The distance from `offset` that the fraction 32,768 would stand for.
        scale: Scalar,
        /// The middle of the cube.
        offset: Vec3,
    },
    /// 16.16 coordinates, 12 bytes per vertex.
    Exact(&'a [Vec3]),
    /// Homogeneous 16.16 coordinates x, y, z, w, for points at infinity or vertices that are in clip space already.
    Homogeneous(&'a [[Scalar; 4]]),
}

impl Positions<'_> {
    /// Returns the stored numbers of a position. It returns 0 past the end, and 0 as the w of positions that have
    /// none.
    #[inline(never)]
    pub(crate) fn numbers(&self, index: usize) -> [i32; 4] {
        #[cfg(test)]
        LOOKED_UP.set(LOOKED_UP.get() + 1);
        match self {
            Self::Quantized { points, .. } => {
                let [x, y, z] = points.get(index).copied().unwrap_or_default();
                [x.into(), y.into(), z.into(), 0]
            }
            Self::Exact(points) => {
                let [x, y, z] = points.get(index).copied().unwrap_or_default().to_bits();
                [x, y, z, 0]
            }
            Self::Homogeneous(points) => points.get(index).copied().unwrap_or_default().map(Scalar::to_bits),
        }
    }
}

/// Topology of a mesh: the way in which vertices, or indices, form triangles. A counter-clockwise triangle (y up) is
/// a front face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Topology {
    /// Three vertices for each triangle.
    #[default]
    Triangles,
    /// Each vertex after the second makes a triangle with its two predecessors; every other triangle is turned round.
    Strip,
    /// Each vertex after the second makes a triangle with its predecessor and the first.
    Fan,
    /// Four vertices for each quad, corners in order; drawn as (0, 1, 2) and (0, 2, 3).
    Quads,
}

/// The slices of a mesh, before they are checked. Fill in the slices that there are:
///
/// ```
/// use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
/// use zstrip::math::{Scalar, Vec3};
/// static CORNERS: [[i16; 3]; 4] = [[-16384, -16384, 0], [16384, -16384, 0], [16384, 16384, 0], [-16384, 16384, 0]];
/// static SQUARE: Mesh<'static> = Mesh::constant(MeshData {
///     topology: Topology::Quads,
///     ..MeshData::new(Positions::Quantized { points: &CORNERS, scale: Scalar::ONE, offset: Vec3::ZERO })
/// });
/// assert_eq!(SQUARE.triangle_count(), 2);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshData<'a> {
    /// Vertex positions, at most 65,535.
    pub positions: Positions<'a>,
    /// Topology: the way in which vertices form triangles.
    pub topology: Topology,
    /// Vertex numbers in drawing order. Without them, vertices are drawn in the order in which they stand.
    pub indices: Option<&'a [u16]>,
    /// Unit normals per vertex, 2.14 ([`NORMAL_ONE`](crate::light::NORMAL_ONE) is 1).
    pub normals: Option<&'a [[i16; 3]]>,
    /// Unit normals per triangle, 2.14, for flat shading. Without them, they are computed from the positions.
    pub face_normals: Option<&'a [[i16; 3]]>,
    /// Colours per vertex: red, green and blue, a byte each, as they lie in flash.
    pub colors: Option<&'a [[u8; 3]]>,
    /// Texture coordinates per vertex, u to the right and v down, 1 = the whole texture.
    pub uvs: Option<&'a [[Scalar; 2]]>,
    /// Bounds, if they are known: they save a pass over the positions.
    pub bounds: Option<Bounds>,
    /// A hierarchy of bounds over the triangles. [`BoundsNode`] lists the rules that it must keep.
    ///
    /// A hierarchy saves time and never changes the picture. It plays no part where bounds do not tell the place of
    /// triangles: with [`Positions::Homogeneous`], and with a shader that moves vertices
    /// ([`VertexShader::DISPLACES`](crate::vertex::VertexShader::DISPLACES)).
    pub hierarchy: Option<&'a [BoundsNode]>,
}

impl<'a> MeshData<'a> {
    /// Makes a list of triangles with positions and nothing else.
    #[must_use]
    pub const fn new(positions: Positions<'a>) -> Self {
        Self {
            positions,
            topology: Topology::Triangles,
            indices: None,
            normals: None,
            face_normals: None,
            colors: None,
            uvs: None,
            bounds: None,
            hierarchy: None,
        }
    }
}

#[cfg(test)]
std::thread_local! {
    /// Number of times that a test has looked up a position.
    pub(crate) static LOOKED_UP: core::cell::Cell<u32> = const { core::cell::Cell::new(0) };
}
