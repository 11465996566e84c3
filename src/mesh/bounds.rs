//! Bounding boxes, and hierarchies of them.

use crate::math::Vec3;

/// The bounds of a mesh or of a part of it: an axis-aligned box, by its centre and half its size.
///
/// The numbers are 16.16. The half size is rounded up, so that nothing sticks out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds {
    /// Middle of the box.
    pub center: Vec3,
    /// Half the size of the box along each axis. Bounds with a negative half size hold nothing; a mesh refuses them.
    pub half: Vec3,
}

/// A node of a hierarchy of bounds, flattened in depth-first order.
///
/// A node that is out of view is skipped together with everything below it: the traversal goes on at `skip`. A node
/// whose `triangles` are not 0 is a leaf, and draws them. So the traversal needs no recursion and no stack.
///
/// ```text
///        0            nodes: 0 1 2 3 4
///       / \           skip:  5 4 3 4 5      (index of the next node that is not below)
///      1   4
///     / \
///    2   3
/// ```
///
/// A mesh refuses a hierarchy that breaks one of these rules:
///
/// - Each triangle is in one leaf. Leaves take the triangles in their order: the first leaf begins with triangle 0, and
///   each leaf begins where the leaf before it ends. So triangles are drawn in the order that they have without a
///   hierarchy.
/// - The box of a node holds all vertices of the triangles below it. No half size is negative.
/// - A subtree ends within the subtree of the node above it.
/// - There are at most twice as many nodes as triangles, and one. So testing nodes takes no more time than the
///   triangles may take.
///
/// ```
/// use zstrip::math::Vec3;
/// use zstrip::mesh::{Bounds, BoundsNode, Mesh, MeshData, Positions};
/// static POINTS: [Vec3; 6] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X, Vec3::Y, Vec3::from_ints(1, 1, 0)];
/// const ALL: Bounds = *Mesh::constant(MeshData::new(Positions::Exact(&POINTS))).bounds();
/// static NODES: [BoundsNode; 2] = [
///     BoundsNode { bounds: ALL, skip: 1, first_triangle: 0, triangles: 1 },
///     BoundsNode { bounds: ALL, skip: 2, first_triangle: 1, triangles: 1 },
/// ];
/// static MESH: Mesh<'static> =
///     Mesh::constant(MeshData { hierarchy: Some(&NODES), ..MeshData::new(Positions::Exact(&POINTS)) });
/// ```
/// A constant mesh whose second leaf had `first_triangle: 0` would not compile:
///
/// ```compile_fail
/// # use zstrip::math::Vec3;
/// # use zstrip::mesh::{Bounds, BoundsNode, Mesh, MeshData, Positions};
/// # static POINTS: [Vec3; 6] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X, Vec3::Y, Vec3::from_ints(1, 1, 0)];
/// # const ALL: Bounds = *Mesh::constant(MeshData::new(Positions::Exact(&POINTS))).bounds();
/// static NODES: [BoundsNode; 2] = [
///     BoundsNode { bounds: ALL, skip: 1, first_triangle: 0, triangles: 1 },
///     BoundsNode { bounds: ALL, skip: 2, first_triangle: 0, triangles: 1 },
/// ];
/// # static MESH: Mesh<'static> =
/// #     Mesh::constant(MeshData { hierarchy: Some(&NODES), ..MeshData::new(Positions::Exact(&POINTS)) });
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoundsNode {
    /// Bounds of everything below this node.
    pub bounds: Bounds,
    /// Index of the first node after this node's subtree; greater than the node's own index.
    pub skip: u16,
    /// First triangle of a leaf.
    pub first_triangle: u16,
    /// Number of triangles of a leaf; 0 for an inner node.
    pub triangles: u16,
}

impl BoundsNode {
    /// A node without triangles, to fill an array with.
    pub const EMPTY: Self =
        Self { bounds: Bounds { center: Vec3::ZERO, half: Vec3::ZERO }, skip: 0, first_triangle: 0, triangles: 0 };
}

/// Returns whether a half size is negative.
pub(super) const fn is_negative(bounds: &Bounds) -> bool {
    let [x, y, z] = bounds.half.to_bits();
    x < 0 || y < 0 || z < 0
}

/// Returns whether a box holds all of another box.
pub(super) const fn holds(outer: &Bounds, inner: &Bounds) -> bool {
    let (center, half) = (outer.center.to_bits(), outer.half.to_bits());
    let (inner_center, inner_half) = (inner.center.to_bits(), inner.half.to_bits());
    let mut axis = 0;
    while axis < 3 {
        let distance = (inner_center[axis] as i64 - center[axis] as i64).abs();
        if distance + inner_half[axis] as i64 > half[axis] as i64 {
            return false;
        }
        axis += 1;
    }
    true
}

/// Returns the box between two corners, given as 64-bit raw 16.16. Half its size is rounded up.
pub(super) const fn bounding_box(min: [i64; 3], max: [i64; 3]) -> Bounds {
    let mut center = [0; 3];
    let mut half = [0; 3];
    let mut k = 0;
    while k < 3 {
        center[k] = clamp_bits((min[k] + max[k]) >> 1);
        // The centre may have been clamped or rounded. The half size covers both ends, measured from the stored
        // centre.
        let (up, down) = (max[k] - center[k] as i64, center[k] as i64 - min[k]);
        half[k] = clamp_bits(if up > down { up } else { down });
        k += 1;
    }
    Bounds { center: Vec3::from_bits(center), half: Vec3::from_bits(half) }
}

const fn clamp_bits(value: i64) -> i32 {
    if value > i32::MAX as i64 {
        i32::MAX
    } else if value < i32::MIN as i64 {
        i32::MIN
    } else {
        value as i32
    }
}
