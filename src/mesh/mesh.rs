//! Meshes: borrowed slices, checked once.
//!
//! After [`Mesh::new`] every index is in range and every attribute is as long as the positions, so that the frame path
//! needs no error for a mesh.

use super::bounds::{Bounds, BoundsNode, bounding_box, holds, is_negative};
use crate::math::{Scalar, Vec3};
use core::fmt;

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

/// A checked mesh. Copying it copies references only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mesh<'a> {
    data: MeshData<'a>,
    bounds: Bounds,
    triangles: u16,
}

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
        LOOKED_UP.set(LOOKED_UP.get() + 1);
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

/// Returns the coordinates of a vertex as they are stored.
const fn stored(positions: &Positions<'_>, vertex: usize) -> [i64; 3] {
    match positions {
        Positions::Quantized { points, .. } => {
            let [x, y, z] = points[vertex];
            [x as i64, y as i64, z as i64]
        }
        Positions::Exact(points) => {
            let [x, y, z] = points[vertex].to_bits();
            [x as i64, y as i64, z as i64]
        }
        Positions::Homogeneous(points) => {
            let [x, y, z, _] = points[vertex];
            [x.to_bits() as i64, y.to_bits() as i64, z.to_bits() as i64]
        }
    }
}

/// Returns the unit, in 2⁻³¹, and the origin, in raw 16.16. Stored coordinates times the unit, plus the origin, are
/// the exact position.
const fn unit_and_origin(positions: &Positions<'_>) -> (i64, [i64; 3]) {
    match positions {
        Positions::Quantized { scale, offset, .. } => {
            let [x, y, z] = offset.to_bits();
            (scale.to_bits() as i64, [x as i64, y as i64, z as i64])
        }
        Positions::Exact(_) | Positions::Homogeneous(_) => (1 << 15, [0; 3]),
    }
}

/// Returns the first vertex that is outside of the box.
const fn outside(positions: &Positions<'_>, vertices: usize, bounds: &Bounds) -> Option<usize> {
    let mut k = 0;
    while k < vertices {
        if is_outside(positions, k, bounds) {
            return Some(k);
        }
        k += 1;
    }
    None
}

/// Returns whether a vertex is outside of the box, with a tolerance for the rounding of quantized positions.
const fn is_outside(positions: &Positions<'_>, vertex: usize, bounds: &Bounds) -> bool {
    let (unit, origin) = unit_and_origin(positions);
    let (center, half) = (bounds.center.to_bits(), bounds.half.to_bits());
    let p = stored(positions, vertex);
    let mut axis = 0;
    while axis < 3 {
        let at = ((p[axis] * unit) >> 15) + origin[axis];
        if (at - center[axis] as i64).abs() > half[axis] as i64 + 1 {
            return true;
        }
        axis += 1;
    }
    false
}

/// Finds the box of all positions.
///
/// The compiler interprets this function for `static` meshes of many vertices, so its loops do little per round.
const fn find_bounds(positions: &Positions<'_>, vertices: usize) -> Bounds {
    if vertices == 0 {
        return bounding_box([0; 3], [0; 3]);
    }
    let (unit, origin) = unit_and_origin(positions);
    let (mut min, mut max) = (stored(positions, 0), stored(positions, 0));
    let mut k = 1;
    while k < vertices {
        let [x, y, z] = stored(positions, k);
        if x < min[0] {
            min[0] = x;
        }
        if x > max[0] {
            max[0] = x;
        }
        if y < min[1] {
            min[1] = y;
        }
        if y > max[1] {
            max[1] = y;
        }
        if z < min[2] {
            min[2] = z;
        }
        if z > max[2] {
            max[2] = z;
        }
        k += 1;
    }
    // The box is rounded outwards, since quantized positions are rounded wherever they are used.
    let mut axis = 0;
    while axis < 3 {
        min[axis] = ((min[axis] * unit) >> 15) + origin[axis];
        max[axis] = ((max[axis] * unit + 0x7FFF) >> 15) + origin[axis];
        axis += 1;
    }
    bounding_box(min, max)
}

#[cfg(test)]
std::thread_local! {
    /// Number of times that a test has looked up a position.
    pub(crate) static LOOKED_UP: core::cell::Cell<u32> = const { core::cell::Cell::new(0) };
}
