//! Meshes: borrowed slices, checked once.
//!
//! After [`Mesh::new`] every index is in range and every attribute is as long as the positions, so that the frame path
//! needs no error for a mesh.

use super::bounds::{Bounds, BoundsNode, holds, is_negative};
use super::data::{MeshData, Positions, Topology};
use super::error::MeshError;
use super::extent::{find_bounds, is_outside, outside};
use crate::math::{Scalar, Vec3};

/// A checked mesh. Copying it copies references only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mesh<'a> {
    data: MeshData<'a>,
    bounds: Bounds,
    triangles: u16,
}

/// Returns an error if there is a slice and its length is not `expected`.
macro_rules! check_length {
    ($slice:expr, $expected:expr, $error:ident { $found:ident, $count:ident }) => {
        if let Some(slice) = $slice {
            if slice.len() != $expected {
                return Err(MeshError::$error { $found: slice.len(), $count: $expected });
            }
        }
    };
}

impl<'a> Mesh<'a> {
    /// Checks the slices against each other and finds the bounds, unless they are given.
    ///
    /// # Errors
    /// The first mistake found, with the offending index or count.
    pub const fn new(data: MeshData<'a>) -> Result<Self, MeshError> {
        let vertices = match data.positions {
            Positions::Quantized { points, scale, .. } => {
                if scale.to_bits() <= 0 {
                    return Err(MeshError::Scale { scale });
                }
                points.len()
            }
            Positions::Exact(points) => points.len(),
            Positions::Homogeneous(points) => points.len(),
        };
        if vertices > u16::MAX as usize {
            return Err(MeshError::TooManyVertices { vertices });
        }
        let corners = match data.indices {
            Some(indices) => {
                let mut at = 0;
                while at < indices.len() {
                    if indices[at] as usize >= vertices {
                        return Err(MeshError::Index { at, index: indices[at], vertices });
                    }
                    at += 1;
                }
                indices.len()
            }
            None => vertices,
        };
        let (triangles, unit, whole) = match data.topology {
            Topology::Triangles => (corners / 3, 3, corners % 3 == 0),
            Topology::Quads => (corners / 4 * 2, 4, corners % 4 == 0),
            Topology::Strip | Topology::Fan => (corners.saturating_sub(2), 3, corners != 1 && corners != 2),
        };
        if !whole {
            return Err(MeshError::Incomplete { indices: corners, unit });
        }
        if triangles > u16::MAX as usize {
            return Err(MeshError::TooManyTriangles { triangles });
        }
        check_length!(data.normals, vertices, Normals { normals, vertices });
        check_length!(data.colors, vertices, Colors { colors, vertices });
        check_length!(data.uvs, vertices, Uvs { uvs, vertices });
        check_length!(data.face_normals, triangles, FaceNormals { face_normals, triangles });
        let bounds = match data.bounds {
            Some(bounds) if is_negative(&bounds) => return Err(MeshError::HalfSize { half: bounds.half }),
            Some(bounds) => match outside(&data.positions, vertices, &bounds) {
                Some(vertex) => return Err(MeshError::Bounds { vertex }),
                None => bounds,
            },
            None => find_bounds(&data.positions, vertices),
        };
        let mesh = Self { data, bounds, triangles: triangles as u16 };
        match data.hierarchy {
            Some(nodes) => match mesh.wrong_hierarchy(nodes) {
                Some(error) => Err(error),
                None => Ok(mesh),
            },
            None => Ok(mesh),
        }
    }

    /// Makes a mesh of slices that were checked before, and whose bounds are known.
    pub(crate) const fn of_checked(data: MeshData<'a>, bounds: Bounds, triangles: u16) -> Self {
        Self { data, bounds, triangles }
    }

    /// Makes a `const` or `static` mesh as [`new`](Self::new) does. A mesh with a mistake does not compile.
    ///
    /// # Panics
    /// When the mesh has a mistake. At run time, outside of constants, prefer [`new`](Self::new).
    #[must_use]
    pub const fn constant(data: MeshData<'a>) -> Self {
        match Self::new(data) {
            Ok(mesh) => mesh,
            Err(MeshError::Index { .. }) => panic!("a mesh index is out of range"),
            Err(MeshError::Incomplete { .. }) => panic!("the last primitive of a mesh is incomplete"),
            Err(MeshError::Hierarchy { .. } | MeshError::TooManyNodes { .. }) => {
                panic!("the nodes of a hierarchy do not form a tree")
            }
            Err(MeshError::Leaf { .. } | MeshError::LeftOut { .. }) => {
                panic!("a triangle is in no leaf of a hierarchy, or in two")
            }
            Err(MeshError::NodeBounds { .. } | MeshError::Bounds { .. } | MeshError::HalfSize { .. }) => {
                panic!("bounds do not hold what they stand for")
            }
            Err(_) => panic!("mesh attributes do not match; Mesh::new tells which"),
        }
    }

    /// Returns the first mistake in a hierarchy of the mesh.
    ///
    /// The box of a node holds its triangles if it holds the boxes of the nodes right below it, which hold theirs. Only
    /// where a box below sticks out, by rounding or because it is larger than it needs to be, triangles are looked at
    /// one by one. So each vertex is looked at about once, and not once per level of the tree.
    const fn wrong_hierarchy(&self, nodes: &[BoundsNode]) -> Option<MeshError> {
        let triangles = self.triangles as usize;
        if nodes.len() > 2 * triangles + 1 {
            return Some(MeshError::TooManyNodes { nodes: nodes.len(), triangles });
        }
        let (mut k, mut expected) = (0, 0);
        while k < nodes.len() {
            let node = &nodes[k];
            let (first, skip) = (node.first_triangle as usize, node.skip as usize);
            let past = first + node.triangles as usize;
            if skip <= k || skip > nodes.len() || past > triangles {
                return Some(MeshError::Hierarchy { node: k, nodes: nodes.len() });
            }
            if is_negative(&node.bounds) {
                return Some(MeshError::HalfSize { half: node.bounds.half });
            }
            if node.triangles > 0 {
                if first != expected {
                    return Some(MeshError::Leaf { node: k, first_triangle: first, expected });
                }
                expected = past;
                if let Some(vertex) = self.vertex_outside(first, past, &node.bounds) {
                    return Some(MeshError::NodeBounds { node: k, vertex });
                }
            }
            let mut below = k + 1;
            while below < skip {
                let end = nodes[below].skip as usize;
                if end <= below || end > skip {
                    return Some(MeshError::Hierarchy { node: below, nodes: nodes.len() });
                }
                if !holds(&node.bounds, &nodes[below].bounds) {
                    if let Some(vertex) = self.vertex_below(nodes, below, end, &node.bounds) {
                        return Some(MeshError::NodeBounds { node: k, vertex });
                    }
                }
                below = end;
            }
            k += 1;
        }
        if expected < triangles { Some(MeshError::LeftOut { triangle: expected, triangles }) } else { None }
    }

    /// Returns a vertex of the triangles of some nodes that is outside of a box.
    const fn vertex_below(&self, nodes: &[BoundsNode], mut k: usize, end: usize, bounds: &Bounds) -> Option<usize> {
        while k < end {
            let first = nodes[k].first_triangle as usize;
            let vertex = self.vertex_outside(first, first + nodes[k].triangles as usize, bounds);
            if vertex.is_some() {
                return vertex;
            }
            k += 1;
        }
        None
    }

    /// Returns a vertex of the triangles from `number` to `past` that is outside of a box.
    const fn vertex_outside(&self, mut number: usize, past: usize, bounds: &Bounds) -> Option<usize> {
        while number < past {
            let Some([a, b, c]) = self.triangle(number) else { return None };
            if is_outside(&self.data.positions, a as usize, bounds) {
                return Some(a as usize);
            }
            if is_outside(&self.data.positions, b as usize, bounds) {
                return Some(b as usize);
            }
            if is_outside(&self.data.positions, c as usize, bounds) {
                return Some(c as usize);
            }
            number += 1;
        }
        None
    }

    /// Returns the number of vertices.
    #[must_use]
    pub const fn vertex_count(&self) -> usize {
        match self.data.positions {
            Positions::Quantized { points, .. } => points.len(),
            Positions::Exact(points) => points.len(),
            Positions::Homogeneous(points) => points.len(),
        }
    }

    /// Returns the number of triangles that the strip, fan, quads or list consists of.
    #[must_use]
    pub const fn triangle_count(&self) -> usize {
        self.triangles as usize
    }

    /// Returns the slices that the mesh borrows.
    #[must_use]
    pub const fn data(&self) -> &MeshData<'a> {
        &self.data
    }

    /// Returns the box around all vertices, in object space. The w of homogeneous positions is ignored, so their box
    /// does not tell where they are drawn.
    #[must_use]
    pub const fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// Returns the vertex numbers of triangle `n` in drawing order, with the winding kept; `None` past the last
    /// triangle.
    #[inline]
    #[must_use]
    pub const fn triangle(&self, n: usize) -> Option<[u16; 3]> {
        // The usual kind of mesh, a list with indices, takes the shortest way.
        if let (Topology::Triangles, Some(indices)) = (self.data.topology, self.data.indices) {
            // The largest number stands for a product that does not fit.
            return match indices.split_at_checked(n.saturating_mul(3)) {
                Some((_, [a, b, c, ..])) => Some([*a, *b, *c]),
                _ => None,
            };
        }
        self.any_triangle(n)
    }

    /// Returns [`triangle`](Self::triangle) for a mesh of any topology, with or without indices.
    #[inline(never)]
    pub(crate) const fn any_triangle(&self, n: usize) -> Option<[u16; 3]> {
        if n >= self.triangles as usize {
            return None;
        }
        let at = match self.data.topology {
            Topology::Triangles => [3 * n, 3 * n + 1, 3 * n + 2],
            // Odd triangles of a strip swap their first two corners, so that all triangles face the same way.
            Topology::Strip => [n + (n & 1), n + 1 - (n & 1), n + 2],
            Topology::Fan => [0, n + 1, n + 2],
            Topology::Quads => {
                let first = n / 2 * 4;
                [first, first + 1 + (n & 1), first + 2 + (n & 1)]
            }
        };
        match self.data.indices {
            Some(indices) if at[0] < indices.len() && at[1] < indices.len() && at[2] < indices.len() => {
                Some([indices[at[0]], indices[at[1]], indices[at[2]]])
            }
            Some(_) => None,
            None => Some([at[0] as u16, at[1] as u16, at[2] as u16]),
        }
    }

    /// Returns the position of a vertex, rounded to 16.16 and saturated. `Homogeneous` positions lose their w.
    #[must_use]
    pub fn position(&self, vertex: usize) -> Vec3 {
        #[cfg(test)]
        super::data::LOOKED_UP.set(super::data::LOOKED_UP.get() + 1);
        match self.data.positions {
            Positions::Quantized { points, scale, offset } => {
                let q = points.get(vertex).copied().unwrap_or_default();
                let along =
                    |q: i16| Scalar::from_bits(((i64::from(q) * i64::from(scale.to_bits()) + (1 << 14)) >> 15) as i32);
                Vec3::new(along(q[0]), along(q[1]), along(q[2])) + offset
            }
            Positions::Exact(points) => points.get(vertex).copied().unwrap_or_default(),
            Positions::Homogeneous(points) => {
                let p = points.get(vertex).copied().unwrap_or_default();
                Vec3::new(p[0], p[1], p[2])
            }
        }
    }
}
