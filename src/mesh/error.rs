//! Mistakes in the slices of meshes, lines and points.

use crate::math::{Scalar, Vec3};
use core::fmt;

/// An error in the slices of a mesh, of lines or of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshError {
    /// More than 65,535 vertices.
    TooManyVertices {
        /// Number of vertices.
        vertices: usize,
    },
    /// More than 65,535 triangles.
    TooManyTriangles {
        /// Number of triangles.
        triangles: usize,
    },
    /// The number of indices (of vertices, without indices) does not make up whole triangles, quads or lines.
    Incomplete {
        /// Number of indices.
        indices: usize,
        /// Indices of one triangle, quad or line. For a strip, fan or loop: the smallest number that it can have.
        unit: usize,
    },
    /// An index points past the last vertex.
    Index {
        /// Position in the index list.
        at: usize,
        /// The index.
        index: u16,
        /// Number of vertices.
        vertices: usize,
    },
    /// The number of normals is not that of the vertices.
    Normals {
        /// Number of normals.
        normals: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// The number of face normals is not that of the triangles.
    FaceNormals {
        /// Number of face normals.
        face_normals: usize,
        /// Number of triangles.
        triangles: usize,
    },
    /// The number of colours is not that of the vertices.
    Colors {
        /// Number of colours.
        colors: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// The number of texture coordinates is not that of the vertices.
    Uvs {
        /// Number of texture coordinates.
        uvs: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// The scale of quantized positions is not above 0.
    Scale {
        /// The scale.
        scale: Scalar,
    },
    /// A node of the hierarchy does not skip forward to a node or to the end, or skips past the end of a node above it,
    /// or its triangles are out of range.
    Hierarchy {
        /// Number of the node.
        node: usize,
        /// Number of nodes.
        nodes: usize,
    },
    /// The hierarchy has more nodes than twice the triangles, and one.
    TooManyNodes {
        /// Number of nodes.
        nodes: usize,
        /// Number of triangles.
        triangles: usize,
    },
    /// A leaf of the hierarchy does not begin with the triangle after those of the leaf before it. So some triangles
    /// are in no leaf, or in two.
    Leaf {
        /// Number of the leaf's node.
        node: usize,
        /// First triangle of the leaf.
        first_triangle: usize,
        /// The triangle that it must begin with.
        expected: usize,
    },
    /// The last leaf of the hierarchy ends before the last triangle, so that some triangles are in no leaf.
    LeftOut {
        /// The first triangle that is in no leaf.
        triangle: usize,
        /// Number of triangles.
        triangles: usize,
    },
    /// The bounds of a node of the hierarchy do not hold a vertex of a triangle in this node or below it.
    NodeBounds {
        /// Number of the node.
        node: usize,
        /// Number of the vertex.
        vertex: usize,
    },
    /// A vertex is outside of the given bounds.
    Bounds {
        /// Number of the vertex.
        vertex: usize,
    },
    /// A half size of the given bounds, or of a node's bounds, is negative.
    HalfSize {
        /// The half size.
        half: Vec3,
    },
}

#[cfg(feature = "defmt")]
impl defmt::Format for MeshError {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}", defmt::Debug2Format(self));
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TooManyVertices { vertices } => write!(f, "{vertices} vertices, at most 65535 are possible"),
            Self::TooManyTriangles { triangles } => write!(f, "{triangles} triangles, at most 65535 are possible"),
            Self::Incomplete { indices, unit } => {
                write!(f, "{indices} indices leave the last primitive incomplete, which takes {unit}")
            }
            Self::Index { at, index, vertices } => {
                write!(f, "index {index} at position {at} is out of range: there are {vertices} vertices")
            }
            Self::Normals { normals, vertices } => write!(f, "{normals} normals for {vertices} vertices"),
            Self::FaceNormals { face_normals, triangles } => {
                write!(f, "{face_normals} face normals for {triangles} triangles")
            }
            Self::Colors { colors, vertices } => write!(f, "{colors} colours for {vertices} vertices"),
            Self::Uvs { uvs, vertices } => write!(f, "{uvs} texture coordinates for {vertices} vertices"),
            Self::Scale { scale } => write!(f, "scale {scale} of the positions, must be above 0"),
            Self::Bounds { vertex } => write!(f, "the given bounds do not hold vertex {vertex}"),
            Self::HalfSize { half } => write!(f, "half size {half:?} of bounds is negative"),
            Self::TooManyNodes { nodes, triangles } => {
                write!(f, "{nodes} nodes of a hierarchy are too many for {triangles} triangles")
            }
            Self::Leaf { node, first_triangle, expected } => {
                write!(f, "leaf {node} of the hierarchy begins with triangle {first_triangle}, must be {expected}")
            }
            Self::LeftOut { triangle, triangles } => {
                write!(f, "triangle {triangle} of {triangles} is in no leaf of the hierarchy")
            }
            Self::NodeBounds { node, vertex } => {
                write!(f, "the bounds of node {node} of the hierarchy do not hold vertex {vertex}")
            }
            Self::Hierarchy { node, nodes } => write!(f, "node {node} of the hierarchy of {nodes} points out of range"),
        }
    }
}

impl core::error::Error for MeshError {}
