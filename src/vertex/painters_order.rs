//! The painter's algorithm: far triangles are drawn before near ones, for targets without RAM for depth and for
//! transparent surfaces.
//!
//! A mesh and a matrix come in, and the mesh's indices in drawing order go out. Triangles are sorted by their farthest
//! vertices, and then compared pair by pair with the tests of Newell, Newell and Sancha (1972), "A solution to the
//! hidden surface problem". All tests are made on the screen: projection maps planes to planes, and puts the eye at
//! depth minus infinity.

use super::project::{Projected, ScreenVertex};
use super::transform::Transform;
use super::viewport::Viewport;
use crate::math::Projective;
use crate::mesh::Mesh;
use core::fmt;

/// Sorts triangles by their farthest vertices, the farthest first. Triangles with equal depth come in an arbitrary, but
/// always equal, order.
///
/// # Source
/// Williams 1964, "Algorithm 232: heapsort".
fn far_to_near(triangles: &mut [SortScratch]) {
    for root in (0..triangles.len() / 2).rev() {
        sift(triangles, root, triangles.len());
    }
    for end in (1..triangles.len()).rev() {
        swap(triangles, 0, end);
        sift(triangles, 0, end);
    }
}

/// Lets a triangle sink until no triangle below it in the heap, which ends at `end`, is nearer.
fn sift(triangles: &mut [SortScratch], mut root: usize, end: usize) {
    let at = |triangles: &[SortScratch], k: usize| triangles.get(k).map_or(u16::MAX, |triangle| triangle.depths().1);
    loop {
        let left = 2 * root + 1;
        if left >= end {
            return;
        }
        let right = left + 1;
        let least = if right < end && at(triangles, right) < at(triangles, left) { right } else { left };
        if at(triangles, root) <= at(triangles, least) {
            return;
        }
        swap(triangles, root, least);
        root = least;
    }
}

fn swap(triangles: &mut [SortScratch], a: usize, b: usize) {
    if let Ok([a, b]) = triangles.get_disjoint_mut([a, b]) {
        core::mem::swap(a, b);
    }
}

/// Memory for one triangle that [`painters_order`] sorts. The caller lends a slice of them, filled with
/// `SortScratch::default()`.
#[derive(Clone, Copy, Debug, Default)]
pub struct SortScratch {
    corners: [u16; 3],
    /// Set once the triangle has been moved ahead of others in the list, which happens at most once.
    moved: bool,
    v: [ScreenVertex; 3],
}

impl SortScratch {
    /// Returns the depths of the nearest and of the farthest vertex.
    fn depths(&self) -> (u16, u16) {
        let [a, b, c] = &self.v;
        (a.z.min(b.z).min(c.z), a.z.max(b.z).max(c.z))
    }

    /// Tests 2 and 3: returns whether the two triangles are apart from left to right, or from top to bottom.
    fn is_beside(&self, other: &Self) -> bool {
        let apart = |coordinate: fn(&ScreenVertex) -> i32| {
            let range = |[a, b, c]: &[ScreenVertex; 3]| {
                let (a, b, c) = (coordinate(a), coordinate(b), coordinate(c));
                (a.min(b).min(c), a.max(b).max(c))
            };
            let ((low, high), (other_low, other_high)) = (range(&self.v), range(&other.v));
            high <= other_low || other_high <= low
        };
        apart(|v| v.x) || apart(|v| v.y)
    }

    /// Tests 4 and 5: returns whether all of this triangle lies on the far side (or on the near side) of the plane of
    /// another triangle, or on the plane.
    ///
    /// # Format
    /// Coordinates of 24.8 are cut to 20.4, differences to 21 bits, and differences of depth to 17. So the components
    /// of the normal are below 2³⁹, 2³⁹ and 2⁴³, and sums of products are below 2⁶³. Distances that cutting and the
    /// rounding of depth may cause count as on the plane.
    fn is_beyond(&self, plane: &Self, far: bool) -> bool {
        let [a, b, c] = &plane.v;
        let to = |v: &ScreenVertex| ((v.x >> 4) - (a.x >> 4), (v.y >> 4) - (a.y >> 4), i32::from(v.z) - i32::from(a.z));
        let minor = |a: i32, b: i32, c: i32, d: i32| i64::from(a) * i64::from(b) - i64::from(c) * i64::from(d);
        let ((bx, by, bz), (cx, cy, cz)) = (to(b), to(c));
        let (mut nx, mut ny, mut nz) = (minor(by, cz, bz, cy), minor(bz, cx, bx, cz), minor(bx, cy, by, cx));
        // The normal points away from the eye.
        if (nz < 0) == far {
            (nx, ny, nz) = (-nx, -ny, -nz);
        }
        let slack = nx.abs() + ny.abs() + 2 * nz.abs();
        self.v.iter().all(|v| {
            let (x, y, z) = to(v);
            nx * i64::from(x) + ny * i64::from(y) + nz * i64::from(z) >= -slack
        })
    }

    /// Returns whether this triangle may be drawn earlier than `other`, by any of the tests.
    fn is_behind(&self, other: &Self) -> bool {
        self.is_beside(other) || self.is_beyond(other, true) || other.is_beyond(self, false)
    }
}

/// An error of [`painters_order`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SortError {
    /// There are more triangles than lent places.
    TooShort {
        /// Number of places in the memory.
        found: usize,
        /// Number of triangles.
        expected: usize,
    },
    /// There is no room for three indices per triangle.
    IndicesTooShort {
        /// Number of indices that fit.
        found: usize,
        /// Three times the number of triangles.
        expected: usize,
    },
    /// The mesh has normals of faces, which would stay in the old order of the triangles.
    FaceNormals,
}

impl fmt::Display for SortError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TooShort { found, expected } => write!(f, "{found} places to sort {expected} triangles"),
            Self::IndicesTooShort { found, expected } => write!(f, "room for {found} indices, {expected} are needed"),
            Self::FaceNormals => f.write_str("a mesh with normals of faces cannot be sorted"),
        }
    }
}

impl core::error::Error for SortError {}

/// Result of [`painters_order`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SortReport {
    /// Number of indices written: three per triangle, back to front.
    pub indices: usize,
    /// Number of pairs of triangles for which no order is right: they go through one another, or belong to a ring of
    /// triangles in which each covers the next.
    pub unresolved: u32,
}

/// Sorts a mesh's triangles from back to front and writes their vertices' indices to `indices`.
///
/// The result is the index list of a mesh with [`Topology::Triangles`](crate::mesh::Topology::Triangles) and otherwise
/// the data of this mesh, which is drawn without depth ([`DepthState::OFF`](crate::span::DepthState::OFF)).
///
/// A vertex outside of the screen's guard band or depth range does not count: its triangle is placed by its other
/// vertices. Triangles without a vertex that counts come first.
///
/// In the worst case, every triangle is compared with every other one. This function is meant for some 100 triangles.
///
/// # Errors
/// When a slice is too short, or the mesh has normals of faces.
pub fn painters_order(
    mesh: &Mesh<'_>,
    mvp: &Projective,
    viewport: &Viewport,
    memory: &mut [SortScratch],
    indices: &mut [u16],
) -> Result<SortReport, SortError> {
    if mesh.data().face_normals.is_some() {
        return Err(SortError::FaceNormals);
    }
    let count = mesh.triangle_count();
    let (places, room) = (memory.len(), indices.len());
    let Some(triangles) = memory.get_mut(..count) else {
        return Err(SortError::TooShort { found: places, expected: count });
    };
    if room / 3 < count {
        return Err(SortError::IndicesTooShort { found: room, expected: 3 * count });
    }
    let transform = Transform::new(mvp, viewport, mesh, false);
    for (number, triangle) in triangles.iter_mut().enumerate() {
        let corners = mesh.triangle(number).unwrap_or_default();
        let mut seen = None;
        let mut v = corners.map(|k| match transform.project_vertex(&mesh.data().positions, usize::from(k)) {
            Projected::OnScreen(vertex) => {
                seen = Some(vertex);
                Some(vertex)
            }
            Projected::NeedsClip(_) => None,
        });
        let instead = seen.unwrap_or(ScreenVertex::new(0, 0, u16::MAX));
        v.iter_mut().for_each(|v| *v = Some(v.unwrap_or(instead)));
        *triangle = SortScratch { corners, moved: false, v: v.map(Option::unwrap_or_default) };
    }
    far_to_near(triangles);
    let mut order = SortReport { indices: 3 * count, unresolved: 0 };
    for next in 0..count {
        order.unresolved = order.unresolved.wrapping_add(place_next(triangles, next));
    }
    for (triangle, indices) in triangles.iter().zip(indices.chunks_exact_mut(3)) {
        if let [a, b, c] = indices {
            [*a, *b, *c] = triangle.corners;
        }
    }
    Ok(order)
}

/// Moves the triangle that is to be drawn next to place `next`. Returns the number of pairs that stay wrong.
fn place_next(triangles: &mut [SortScratch], next: usize) -> u32 {
    // The loop ends, because each triangle is moved at most once.
    'again: loop {
        let Some(first) = triangles.get(next).copied() else { return 0 };
        let mut unresolved = 0;
        for (k, other) in triangles.iter().enumerate().skip(next + 1) {
            // Test 1: all triangles from here on are nearer than `first`.
            if other.depths().1 <= first.depths().0 && !other.moved {
                break;
            }
            if first.is_behind(other) {
                continue;
            }
            if other.moved || !other.is_behind(&first) {
                unresolved += 1;
                continue;
            }
            for place in (next + 1..=k).rev() {
                swap(triangles, place - 1, place);
            }
            if let Some(moved) = triangles.get_mut(next) {
                moved.moved = true;
            }
            continue 'again;
        }
        return unresolved;
    }
}
