//! Edges of a mesh, each once, for drawing its wireframe: a mesh comes in, pairs of vertex numbers go out, in
//! ascending order and without doubles.

use super::mesh::Mesh;
use core::fmt;

/// The error of [`edges`] when the edges of a mesh do not fit the room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct EdgesError {
    /// Number of edges that there is room for.
    pub room: usize,
}

impl fmt::Display for EdgesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the mesh has more edges than the room given, {}; three a triangle are enough", self.room)
    }
}

impl core::error::Error for EdgesError {}

/// Finds the edges of a mesh, each once, however many triangles share it. An edge is the numbers of its two vertices,
/// the lower one first. Edges come in ascending order.
///
/// It is `const`, so that edges may lie in flash beside their mesh. It uses no memory but `room`. As many places as
/// there are edges are enough, though three places per triangle are faster. Diagonals of
/// [quads](crate::mesh::Topology::Quads) are not edges.
///
/// ```
/// use zstrip::mesh::{Lines, Mesh, MeshData, Positions, edges};
/// use zstrip::math::Vec3;
/// static CORNERS: [Vec3; 4] = [Vec3::ZERO; 4];
/// static INDICES: [u16; 6] = [0, 1, 2, 2, 1, 3];
/// static MESH: Mesh<'static> =
///     Mesh::constant(MeshData { indices: Some(&INDICES), ..MeshData::new(Positions::Exact(&CORNERS)) });
/// let mut room = [[0; 2]; 6];
/// let edges = edges(&MESH, &mut room)?;
/// assert_eq!(edges, [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]]);
/// assert_eq!(Lines::of_mesh(&MESH, edges)?.count(), 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If `room` is too short.
pub const fn edges<'e>(mesh: &Mesh<'_>, room: &'e mut [[u16; 2]]) -> Result<&'e mut [[u16; 2]], EdgesError> {
    let quads = matches!(mesh.data().topology, crate::mesh::Topology::Quads);
    // `count` entries are in the list. The first `sorted` of them are in order and single; the others may be doubles.
    let (mut count, mut sorted) = (0, 0);
    let mut triangle = 0;
    while let Some([a, b, c]) = mesh.triangle(triangle) {
        let mut side = 0;
        while side < 3 {
            let (from, to) = match side {
                0 => (a, b),
                1 => (b, c),
                _ => (c, a),
            };
            // A quad is (0, 1, 2) and (0, 2, 3): the diagonal is the last side of the first triangle, and the first
            // side of the second.
            let diagonal = quads && side == if triangle & 1 == 0 { 2 } else { 0 };
            side += 1;
            let edge = if from < to { [from, to] } else { [to, from] };
            if diagonal || from == to || holds(room, sorted, edge) {
                continue;
            }
            if count == room.len() {
                count = each_once(room, count);
                sorted = count;
                if holds(room, sorted, edge) {
                    continue;
                }
            }
            if count >= room.len() {
                return Err(EdgesError { room: room.len() });
            }
            room[count] = edge;
            count += 1;
        }
        triangle += 1;
    }
    count = each_once(room, count);
    // `each_once` returns no more than it was given.
    Ok(if count <= room.len() { room.split_at_mut(count).0 } else { room })
}

/// Returns true if the first `sorted` entries, which are in ascending order, hold an edge.
const fn holds(list: &[[u16; 2]], sorted: usize, edge: [u16; 2]) -> bool {
    let (mut low, mut high) = (0, sorted);
    while low < high {
        let middle = low + (high - low) / 2;
        if key(get(list, middle)) < key(edge) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low < sorted && key(get(list, low)) == key(edge)
}

const fn key([a, b]: [u16; 2]) -> u32 {
    (a as u32) << 16 | b as u32
}

/// Returns an entry; past the end, the edge (0, 0), which no mesh has.
const fn get(list: &[[u16; 2]], at: usize) -> [u16; 2] {
    if at < list.len() { list[at] } else { [0; 2] }
}

/// Sorts the first `count` entries, removes doubles, and returns the number that is left.
///
/// # Source
/// Williams 1964, "Heapsort": it sorts in place, and is fast for any order.
const fn each_once(list: &mut [[u16; 2]], count: usize) -> usize {
    let list = if count < list.len() { list.split_at_mut(count).0 } else { list };
    let mut root = list.len() / 2;
    while root > 0 {
        root -= 1;
        let item = list[root];
        sink(list, root, item);
    }
    let mut end = list.len();
    while end > 1 {
        end -= 1;
        let (heap, rest) = list.split_at_mut(end);
        if let ([greatest, ..], [last, ..]) = (&*heap, rest) {
            let item = *last;
            *last = *greatest;
            sink(heap, 0, item);
        }
    }
    let (mut kept, mut at) = (0, 0);
    while at < list.len() {
        if kept == 0 || key(list[kept - 1]) != key(list[at]) {
            list[kept] = list[at];
            kept += 1;
        }
        at += 1;
    }
    kept
}

/// Puts an item into a heap at `root` or below it, where the entries below `root` are in heap order.
///
/// The compiler interprets this function for edges in flash, so the loop does little per round.
const fn sink(heap: &mut [[u16; 2]], mut root: usize, item: [u16; 2]) {
    let sunk = key(item);
    let mut child = 2 * root + 1;
    while child < heap.len() {
        let [a, b] = heap[child];
        let mut greater = (a as u32) << 16 | b as u32;
        if child + 1 < heap.len() {
            let [a, b] = heap[child + 1];
            let right = (a as u32) << 16 | b as u32;
            if greater < right {
                child += 1;
                greater = right;
            }
        }
        if sunk >= greater {
            break;
        }
        heap[root] = heap[child];
        root = child;
        child = 2 * root + 1;
    }
    if root < heap.len() {
        heap[root] = item;
    }
}

#[cfg(test)]
mod tests {
    use super::super::data::{MeshData, Positions, Topology};
    use super::*;
    use crate::math::Vec3;
    use crate::math::random::Rng;
    use std::collections::BTreeSet;
    use std::vec;
    use std::vec::Vec;

    static CORNERS: [Vec3; 60] = [Vec3::ZERO; 60];

    fn mesh(topology: Topology, indices: &[u16]) -> Mesh<'_> {
        Mesh::new(MeshData { topology, indices: Some(indices), ..MeshData::new(Positions::Exact(&CORNERS)) }).unwrap()
    }

    #[test]
    fn each_edge_is_found_once_in_any_room_that_holds_them() {
        let mut rng = Rng::new(3);
        let mut next = |bound: u32| rng.below(bound.into()) as u32;
        for case in 0..200 {
            let vertices = 3 + next(57);
            let indices: Vec<u16> = (0..3 * next(100)).map(|_| next(vertices) as u16).collect();
            let mesh = mesh(Topology::Triangles, &indices);
            let mut expected = BTreeSet::new();
            for triangle in indices.chunks(3) {
                for [a, b] in [[0, 1], [1, 2], [2, 0]].map(|[a, b]| [triangle[a], triangle[b]]) {
                    if a != b {
                        expected.insert([a.min(b), a.max(b)]);
                    }
                }
            }
            let expected: Vec<_> = expected.into_iter().collect();
            for places in [expected.len(), expected.len() + 5, 3 * mesh.triangle_count()] {
                let mut room = vec![[9; 2]; places];
                assert_eq!(edges(&mesh, &mut room).expect("room"), expected, "case {case}, {places} places");
            }
            if let Some(less) = expected.len().checked_sub(1) {
                let mut room = vec![[9; 2]; less];
                assert_eq!(edges(&mesh, &mut room).err(), Some(EdgesError { room: less }), "case {case}");
            }
        }
    }

    #[test]
    fn quads_have_no_diagonals() {
        let mut room = [[0; 2]; 20];
        let mesh = mesh(Topology::Quads, &[0, 1, 2, 3, 1, 4, 5, 2]);
        assert_eq!(edges(&mesh, &mut room).unwrap(), [[0, 1], [0, 3], [1, 2], [1, 4], [2, 3], [2, 5], [4, 5]]);
    }
}
