//! Bounding boxes and spheres, and hierarchies of them.

use crate::math::{Scalar, Vec3};

/// An axis-aligned box by centre and half size; raw 16.16, the half size rounded up so that nothing sticks out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoundingBox {
    /// Middle of the box.
    pub center: Vec3,
    /// Half its size an axis; never negative.
    pub half: Vec3,
}

/// A sphere by centre and radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoundingSphere {
    /// Centre.
    pub center: Vec3,
    /// Radius; never negative. `Scalar::MAX` stands for any that is larger, too: such a sphere culls nothing.
    pub radius: Scalar,
}

/// What is known about where a mesh, or a part of it, lies: a box and a sphere, both hold all of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds {
    /// The box.
    pub aabb: BoundingBox,
    /// The sphere.
    pub sphere: BoundingSphere,
}

/// A node of a hierarchy of bounds, flattened in depth-first order.
///
/// A node that is out of view is skipped with everything below it: traversal goes on at `skip`. A node whose `triangles`
/// are not empty is a leaf that draws them. No recursion, no stack.
///
/// ```text
///        0            nodes: 0 1 2 3 4
///       / \           skip:  5 4 3 4 5      (index of the next node that is not below)
///      1   4
///     / \
///    2   3
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

/// The box between two corners, in 64-bit raw 16.16, its half size rounded up.
pub(super) const fn bounding_box(min: [i64; 3], max: [i64; 3]) -> BoundingBox {
    let mut center = [0; 3];
    let mut half = [0; 3];
    let mut k = 0;
    while k < 3 {
        center[k] = clamp_bits((min[k] + max[k]) >> 1);
        // The centre may have been clamped or rounded: cover both ends from where it is.
        let (up, down) = (max[k] - center[k] as i64, center[k] as i64 - min[k]);
        half[k] = clamp_bits(if up > down { up } else { down });
        k += 1;
    }
    BoundingBox { center: Vec3::from_bits(center), half: Vec3::from_bits(half) }
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

/// The sphere about `center` that reaches a squared distance, in 2⁻⁶², and one unit of 16.16 more, for positions that are
/// rounded; a point for 0.
pub(super) const fn sphere(center: Vec3, squared: u128) -> BoundingSphere {
    let radius = match squared {
        0 => 0,
        _ => (squared.isqrt() >> 15) + 2,
    };
    let radius = if radius > i32::MAX as u128 { i32::MAX } else { radius as i32 };
    BoundingSphere { center, radius: Scalar::from_bits(radius) }
}
