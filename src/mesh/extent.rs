//! The boxes of positions: found, and compared with those that are given.

use super::bounds::{Bounds, bounding_box};
use super::data::Positions;

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
pub(super) const fn outside(positions: &Positions<'_>, vertices: usize, bounds: &Bounds) -> Option<usize> {
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
pub(super) const fn is_outside(positions: &Positions<'_>, vertex: usize, bounds: &Bounds) -> bool {
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
pub(super) const fn find_bounds(positions: &Positions<'_>, vertices: usize) -> Bounds {
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
