//! Lines and points: vertices like those of a mesh, and how they are joined, checked once.

use super::bounds::Bounds;
use super::data::{MeshData, Positions};
use super::error::MeshError;
use super::mesh::Mesh;
use crate::math::Scalar;

/// The vertices of lines or points, before they are checked. Fill in the slices that there are:
///
/// ```
/// use zstrip::math::Vec3;
/// use zstrip::mesh::{Points, Positions, Vertices};
/// static STARS: [Vec3; 2] = [Vec3::from_ints(3, 2, -9), Vec3::from_ints(-4, 1, -8)];
/// static COLORS: [[u8; 3]; 2] = [[255, 220, 200], [200, 220, 255]];
/// static SKY: Points<'static> =
///     Points::constant(Vertices { colors: Some(&COLORS), ..Vertices::new(Positions::Exact(&STARS)) });
/// assert_eq!(SKY.vertices().vertex_count(), 2);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Vertices<'a> {
    /// Positions, at most 65,535.
    pub positions: Positions<'a>,
    /// Unit normals per vertex, 2.14 ([`NORMAL_ONE`](crate::light::NORMAL_ONE) is 1).
    pub normals: Option<&'a [[i16; 3]]>,
    /// Colours per vertex: red, green and blue, a byte each, as they lie in flash.
    pub colors: Option<&'a [[u8; 3]]>,
    /// Texture coordinates per vertex, u to the right and v down, 1 = the whole texture.
    pub uvs: Option<&'a [[Scalar; 2]]>,
    /// Bounds, if they are known: they save a pass over the positions.
    pub bounds: Option<Bounds>,
}

impl<'a> Vertices<'a> {
    /// Makes vertices with positions and nothing else.
    #[must_use]
    pub const fn new(positions: Positions<'a>) -> Self {
        Self { positions, normals: None, colors: None, uvs: None, bounds: None }
    }

    /// Checks the slices, and returns them as a mesh without triangles.
    const fn mesh(&self) -> Result<Mesh<'a>, MeshError> {
        Mesh::new(MeshData {
            indices: Some(&[]),
            normals: self.normals,
            colors: self.colors,
            uvs: self.uvs,
            bounds: self.bounds,
            ..MeshData::new(self.positions)
        })
    }
}

/// Topology of lines: the way in which vertices, or indices, form lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineTopology {
    /// Two vertices for each line.
    #[default]
    Pairs,
    /// Each vertex after the first makes a line with its predecessor.
    Strip,
    /// A strip whose last vertex makes a line with the first.
    Loop,
}

/// Checked lines. Copying them copies references only.
///
/// ```
/// use zstrip::math::Vec3;
/// use zstrip::mesh::{LineTopology, Lines, Positions, Vertices};
/// static ENDS: [Vec3; 4] = [Vec3::ZERO, Vec3::from_ints(1, 0, 0), Vec3::from_ints(0, 1, 0), Vec3::from_ints(0, 0, 1)];
/// static COLORS: [[u8; 3]; 4] = [[255, 255, 255], [255, 0, 0], [0, 255, 0], [0, 0, 255]];
/// static AXES: Lines<'static> = Lines::constant(
///     Vertices { colors: Some(&COLORS), ..Vertices::new(Positions::Exact(&ENDS)) },
///     LineTopology::Pairs,
///     Some(&[0, 1, 0, 2, 0, 3]),
/// );
/// assert_eq!(AXES.count(), 3);
/// assert_eq!(AXES.line(1), Some([0, 2]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lines<'a> {
    vertices: Mesh<'a>,
    indices: Option<&'a [u16]>,
    /// Number of indices, or of vertices if there are no indices.
    ends: usize,
    /// Step from the first end of a line to that of the next: 1 or 2.
    step: usize,
    count: usize,
}

impl<'a> Lines<'a> {
    /// Checks the slices against each other and finds the bounds, unless they are given.
    ///
    /// `indices` are vertex numbers, joined as `topology` says. Without indices, vertices are joined in the order in
    /// which they stand.
    ///
    /// # Errors
    /// The first mistake found, with the offending index or count.
    pub const fn new(
        vertices: Vertices<'a>,
        topology: LineTopology,
        indices: Option<&'a [u16]>,
    ) -> Result<Self, MeshError> {
        let vertices = match vertices.mesh() {
            Ok(vertices) => vertices,
            Err(error) => return Err(error),
        };
        let ends = match indices {
            Some(indices) => {
                let mut at = 0;
                while at < indices.len() {
                    if indices[at] as usize >= vertices.vertex_count() {
                        return Err(MeshError::Index { at, index: indices[at], vertices: vertices.vertex_count() });
                    }
                    at += 1;
                }
                indices.len()
            }
            None => vertices.vertex_count(),
        };
        let (count, whole) = match topology {
            LineTopology::Pairs => (ends / 2, ends % 2 == 0),
            LineTopology::Strip => (ends.saturating_sub(1), ends != 1),
            LineTopology::Loop => (ends, ends != 1),
        };
        if !whole {
            return Err(MeshError::Incomplete { indices: ends, unit: 2 });
        }
        let step = if matches!(topology, LineTopology::Pairs) { 2 } else { 1 };
        Ok(Self { vertices, indices, ends, step, count })
    }

    /// Makes `const` and `static` lines as [`new`](Self::new) does. Lines with a mistake do not compile.
    ///
    /// # Panics
    /// When the lines have a mistake. At run time, outside of constants, prefer [`new`](Self::new).
    #[must_use]
    pub const fn constant(vertices: Vertices<'a>, topology: LineTopology, indices: Option<&'a [u16]>) -> Self {
        match Self::new(vertices, topology, indices) {
            Ok(lines) => lines,
            Err(MeshError::Index { .. }) => panic!("an index of lines is out of range"),
            Err(_) => panic!("attributes of lines do not match; Lines::new tells which"),
        }
    }

    /// Makes lines of a mesh's vertices and edges, as [`edges`](crate::mesh::edges()) finds them.
    ///
    /// # Errors
    /// When an edge does not belong to the mesh.
    pub const fn of_mesh(mesh: &Mesh<'a>, edges: &'a [[u16; 2]]) -> Result<Self, MeshError> {
        let MeshData { positions, normals, colors, uvs, .. } = *mesh.data();
        let vertices = Vertices { positions, normals, colors, uvs, bounds: Some(*mesh.bounds()) };
        Self::new(vertices, LineTopology::Pairs, Some(edges.as_flattened()))
    }

    /// Returns the number of lines.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Returns the vertex numbers of line `n`; `None` past the last.
    #[must_use]
    #[inline]
    pub fn line(&self, n: usize) -> Option<[u16; 2]> {
        if n >= self.count {
            return None;
        }
        let (from, mut to) = (n * self.step, n * self.step + 1);
        // Only a loop has a line that begins at the last end; it goes back to the first.
        if to == self.ends {
            to = 0;
        }
        match self.indices {
            Some(indices) => Some([*indices.get(from)?, *indices.get(to)?]),
            None => Some([from as u16, to as u16]),
        }
    }

    /// Returns the vertices: a mesh without triangles.
    #[must_use]
    pub const fn vertices(&self) -> &Mesh<'a> {
        &self.vertices
    }
}

/// Checked points. Copying them copies references only; [`Vertices`] has an example.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Points<'a> {
    vertices: Mesh<'a>,
}

impl<'a> Points<'a> {
    /// Checks the slices against each other and finds the bounds, unless they are given. Each vertex is a point.
    ///
    /// # Errors
    /// The first mistake found, with the offending count.
    pub const fn new(vertices: Vertices<'a>) -> Result<Self, MeshError> {
        match vertices.mesh() {
            Ok(vertices) => Ok(Self { vertices }),
            Err(error) => Err(error),
        }
    }

    /// Makes `const` and `static` points as [`new`](Self::new) does. Points with a mistake do not compile.
    ///
    /// # Panics
    /// When the points have a mistake. At run time, outside of constants, prefer [`new`](Self::new).
    #[must_use]
    pub const fn constant(vertices: Vertices<'a>) -> Self {
        match Self::new(vertices) {
            Ok(points) => points,
            Err(_) => panic!("attributes of points do not match; Points::new tells which"),
        }
    }

    /// Returns the vertices: a mesh without triangles.
    #[must_use]
    pub const fn vertices(&self) -> &Mesh<'a> {
        &self.vertices
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use std::vec::Vec;

    static ENDS: [Vec3; 4] = [Vec3::ZERO; 4];

    fn all(topology: LineTopology, indices: Option<&'static [u16]>) -> Result<Vec<[u16; 2]>, MeshError> {
        let lines = Lines::new(Vertices::new(Positions::Exact(&ENDS)), topology, indices)?;
        Ok((0..=lines.count()).filter_map(|n| lines.line(n)).collect())
    }

    #[test]
    fn pairs_strips_and_loops_join_their_vertices() {
        assert_eq!(all(LineTopology::Pairs, None), Ok([[0, 1], [2, 3]].into()));
        assert_eq!(all(LineTopology::Strip, None), Ok([[0, 1], [1, 2], [2, 3]].into()));
        assert_eq!(all(LineTopology::Loop, None), Ok([[0, 1], [1, 2], [2, 3], [3, 0]].into()));
        assert_eq!(all(LineTopology::Loop, Some(&[3, 1, 0])), Ok([[3, 1], [1, 0], [0, 3]].into()));
        assert_eq!(all(LineTopology::Strip, Some(&[])), Ok([].into()));
    }

    #[test]
    fn wrong_lines_are_errors_that_say_what_is_wrong() {
        assert_eq!(all(LineTopology::Pairs, Some(&[0, 1, 2])), Err(MeshError::Incomplete { indices: 3, unit: 2 }));
        assert_eq!(all(LineTopology::Loop, Some(&[2])), Err(MeshError::Incomplete { indices: 1, unit: 2 }));
        assert_eq!(all(LineTopology::Pairs, Some(&[0, 4])), Err(MeshError::Index { at: 1, index: 4, vertices: 4 }));
        let colors = Some(&[[0; 3]; 3][..]);
        let data = Vertices { colors, ..Vertices::new(Positions::Exact(&ENDS)) };
        assert_eq!(
            Lines::new(data, LineTopology::Pairs, None).err(),
            Some(MeshError::Colors { colors: 3, vertices: 4 })
        );
        assert_eq!(Points::new(data).err(), Some(MeshError::Colors { colors: 3, vertices: 4 }));
    }
}
