//! Lines and points: vertices as a mesh has them, and how they are joined.

use super::mesh::{Mesh, MeshData, MeshError, Topology};

/// How vertices, or indices, form lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Joined {
    /// Two a line.
    #[default]
    Pairs,
    /// Each vertex after the first makes a line with the one before it.
    Strip,
    /// The same, and the last one makes a line with the first.
    Loop,
}

/// Checked lines. Copying them copies references only.
///
/// ```
/// use zstrip::mesh::{Joined, Lines, MeshData, Positions};
/// use zstrip::math::Vec3;
/// static ENDS: [Vec3; 4] = [Vec3::ZERO, Vec3::from_ints(1, 0, 0), Vec3::from_ints(0, 1, 0), Vec3::from_ints(0, 0, 1)];
/// static COLORS: [[u8; 3]; 4] = [[255, 255, 255], [255, 0, 0], [0, 255, 0], [0, 0, 255]];
/// static AXES: Lines<'static> = Lines::constant(Joined::Pairs, MeshData {
///     indices: Some(&[0, 1, 0, 2, 0, 3]),
///     colors: Some(&COLORS),
///     ..MeshData::new(Positions::Exact(&ENDS))
/// });
/// assert_eq!(AXES.count(), 3);
/// assert_eq!(AXES.line(1), Some([0, 2]));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Lines<'a> {
    vertices: Mesh<'a>,
    indices: Option<&'a [u16]>,
    /// Indices, or vertices without them; from one line to the next, 1 or 2 of them.
    ends: usize,
    step: usize,
    count: usize,
}

/// The vertices alone, as a mesh without triangles.
const fn vertices<'a>(data: &MeshData<'a>) -> Result<Mesh<'a>, MeshError> {
    Mesh::new(MeshData {
        topology: Topology::Triangles,
        indices: Some(&[]),
        face_normals: None,
        hierarchy: None,
        ..*data
    })
}

impl<'a> Lines<'a> {
    /// Checks the slices against each other and finds the bounds, unless they are given. What `data` says of triangles (topology,
    /// face normals, hierarchy) is not used.
    ///
    /// # Errors
    /// The first thing found wrong, with the offending index or count.
    pub const fn new(joined: Joined, data: MeshData<'a>) -> Result<Self, MeshError> {
        let vertices = match vertices(&data) {
            Ok(vertices) => vertices,
            Err(error) => return Err(error),
        };
        let ends = match data.indices {
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
        let (count, whole) = match joined {
            Joined::Pairs => (ends / 2, ends % 2 == 0),
            Joined::Strip => (ends.saturating_sub(1), ends != 1),
            Joined::Loop => (ends, ends != 1),
        };
        if !whole {
            return Err(MeshError::Incomplete { indices: ends, unit: 2 });
        }
        let step = if matches!(joined, Joined::Pairs) { 2 } else { 1 };
        Ok(Self { vertices, indices: data.indices, ends, step, count })
    }

    /// [`new`](Self::new) for `const` and `static` lines: those that are wrong do not compile.
    ///
    /// # Panics
    /// When the lines are wrong. Called at run time instead of in a constant, prefer [`new`](Self::new).
    pub const fn constant(joined: Joined, data: MeshData<'a>) -> Self {
        match Self::new(joined, data) {
            Ok(lines) => lines,
            Err(MeshError::Index { .. }) => panic!("an index of lines is out of range"),
            Err(_) => panic!("attributes of lines do not match; Lines::new tells which"),
        }
    }

    /// Edges of a mesh, as [`edges`](crate::mesh::edges) finds them.
    ///
    /// # Errors
    /// When an edge does not belong to the mesh.
    pub const fn of_mesh(mesh: &Mesh<'a>, edges: &'a [[u16; 2]]) -> Result<Self, MeshError> {
        Self::new(
            Joined::Pairs,
            MeshData { indices: Some(edges.as_flattened()), bounds: Some(*mesh.bounds()), ..*mesh.data() },
        )
    }

    /// How many lines there are.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Vertex numbers of line `n`; `None` past the last.
    #[inline]
    pub fn line(&self, n: usize) -> Option<[u16; 2]> {
        if n >= self.count {
            return None;
        }
        let (from, mut to) = (n * self.step, n * self.step + 1);
        // Only a loop has a line that begins at the last end.
        if to == self.ends {
            to = 0;
        }
        match self.indices {
            Some(indices) => Some([*indices.get(from)?, *indices.get(to)?]),
            None => Some([from as u16, to as u16]),
        }
    }

    /// The vertices: a mesh without triangles.
    pub const fn vertices(&self) -> &Mesh<'a> {
        &self.vertices
    }
}

/// Checked points. Copying them copies references only.
///
/// ```
/// use zstrip::mesh::{MeshData, Points, Positions};
/// use zstrip::math::Vec3;
/// static STARS: [Vec3; 2] = [Vec3::from_ints(3, 2, -9), Vec3::from_ints(-4, 1, -8)];
/// static SKY: Points<'static> = Points::constant(MeshData::new(Positions::Exact(&STARS)));
/// assert_eq!(SKY.vertices().vertex_count(), 2);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    vertices: Mesh<'a>,
}

impl<'a> Points<'a> {
    /// One point for each vertex; neither indices nor what `data` says of triangles is used.
    ///
    /// # Errors
    /// The first thing found wrong, with the offending count.
    pub const fn new(data: MeshData<'a>) -> Result<Self, MeshError> {
        match vertices(&data) {
            Ok(vertices) => Ok(Self { vertices }),
            Err(error) => Err(error),
        }
    }

    /// [`new`](Self::new) for `const` and `static` points: those that are wrong do not compile.
    ///
    /// # Panics
    /// When the points are wrong. Called at run time instead of in a constant, prefer [`new`](Self::new).
    pub const fn constant(data: MeshData<'a>) -> Self {
        match Self::new(data) {
            Ok(points) => points,
            Err(_) => panic!("attributes of points do not match; Points::new tells which"),
        }
    }

    /// The vertices: a mesh without triangles.
    pub const fn vertices(&self) -> &Mesh<'a> {
        &self.vertices
    }
}

#[cfg(test)]
mod tests {
    use super::super::mesh::Positions;
    use super::*;
    use crate::math::Vec3;
    use std::vec::Vec;

    static ENDS: [Vec3; 4] = [Vec3::ZERO; 4];

    fn all(joined: Joined, indices: Option<&'static [u16]>) -> Result<Vec<[u16; 2]>, MeshError> {
        let lines = Lines::new(joined, MeshData { indices, ..MeshData::new(Positions::Exact(&ENDS)) })?;
        Ok((0..=lines.count()).filter_map(|n| lines.line(n)).collect())
    }

    #[test]
    fn pairs_strips_and_loops_join_their_vertices() {
        assert_eq!(all(Joined::Pairs, None), Ok([[0, 1], [2, 3]].into()));
        assert_eq!(all(Joined::Strip, None), Ok([[0, 1], [1, 2], [2, 3]].into()));
        assert_eq!(all(Joined::Loop, None), Ok([[0, 1], [1, 2], [2, 3], [3, 0]].into()));
        assert_eq!(all(Joined::Loop, Some(&[3, 1, 0])), Ok([[3, 1], [1, 0], [0, 3]].into()));
        assert_eq!(all(Joined::Strip, Some(&[])), Ok([].into()));
    }

    #[test]
    fn wrong_lines_are_errors_that_say_what_is_wrong() {
        assert_eq!(all(Joined::Pairs, Some(&[0, 1, 2])), Err(MeshError::Incomplete { indices: 3, unit: 2 }));
        assert_eq!(all(Joined::Loop, Some(&[2])), Err(MeshError::Incomplete { indices: 1, unit: 2 }));
        assert_eq!(all(Joined::Pairs, Some(&[0, 4])), Err(MeshError::Index { at: 1, index: 4, vertices: 4 }));
        let colors = Some(&[[0; 3]; 3][..]);
        let data = MeshData { colors, ..MeshData::new(Positions::Exact(&ENDS)) };
        assert_eq!(Lines::new(Joined::Pairs, data).err(), Some(MeshError::Colors { colors: 3, vertices: 4 }));
        assert_eq!(Points::new(data).err(), Some(MeshError::Colors { colors: 3, vertices: 4 }));
    }
}
