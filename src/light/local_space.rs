//! A mesh's own space, scaled so that its box fits 16 bits: where light falls on it.

use super::uneven::moved;
use crate::math::{Affine, Scalar, Vec3};
use crate::mesh::Bounds;

/// Object space, centred in the mesh's box. The longest half side of the box has 2¹⁴ to 2¹⁵ units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LocalSpace {
    center: [i32; 3],
    /// Shift that makes the longest half side, 16.16, 2²⁸ to 2²⁹.
    shift: i8,
}

/// The transform from the lights' space to a [`LocalSpace`].
pub(super) struct ToLocal {
    local: LocalSpace,
    /// The columns of the model matrix, made unit vectors, 16.16.
    columns: [[i32; 3]; 3],
    /// Factor by which the model scales, 16.16 and `extra` bits.
    scale: i64,
    extra: u32,
    translation: [i32; 3],
}

/// Multiplies by 2^`shift`, which is in -32..32; cut, and saturated at ±2²⁹.
fn shifted(value: i64, shift: i32) -> i32 {
    let limit = 1 << 29;
    let moved = if shift >= 0 {
        // Saturated before it can leave 64 bits.
        value.clamp(-(1 << 30), 1 << 30) << shift.min(32)
    } else {
        value >> (-shift).min(63)
    };
    moved.clamp(-limit, limit) as i32
}

impl LocalSpace {
    const fn shift(&self) -> i32 {
        self.shift as i32
    }

    /// Returns a position of the mesh in 2⁻¹⁴ local units: below 2²⁹.
    #[inline]
    pub(super) fn fine(&self, position: Vec3) -> [i32; 3] {
        let p = position.to_bits();
        let along = |k: usize| shifted(i64::from(p[k]) - i64::from(self.center[k]), self.shift());
        [along(0), along(1), along(2)]
    }
}

impl ToLocal {
    /// Makes the transform for a mesh in `bounds`, and lights in the space that `model` leads to.
    pub(super) fn new(model: &Affine, bounds: &Bounds) -> Self {
        let [x, y, z] = bounds.half.to_bits();
        let reach = (x.unsigned_abs() | y.unsigned_abs() | z.unsigned_abs()).max(1);
        let [[xx, xy, xz, tx], [yx, yy, yz, ty], [zx, zy, zz, tz]] = model.to_rows();
        let columns = [[xx, yx, zx], [xy, yy, zy], [xz, yz, zz]];
        let widest = columns.iter().flatten().fold(1, |all, c| all | c.unsigned_abs());
        // Columns of small scales are made longer, by up to 2¹²: their length would have few bits otherwise.
        let extra = (widest.leading_zeros().saturating_sub(15)).min(12);
        let longer = columns.map(|c| Vec3::from_bits([c[0] << extra, c[1] << extra, c[2] << extra]));
        Self {
            local: LocalSpace { center: bounds.center.to_bits(), shift: reach.leading_zeros() as i8 - 3 },
            columns: longer.map(|c| c.normalized().map_or([0; 3], |unit| unit.to_bits())),
            scale: i64::from(longer[0].length().to_bits().max(1)),
            extra,
            translation: [tx, ty, tz],
        }
    }

    /// Makes the transform for a mesh whose normals and positions `model` brings to the lights. Out of line, so that
    /// the box is not on the stack under what any model calls.
    #[inline(never)]
    pub(super) fn of_moved(model: &Affine, bounds: &Bounds) -> Self {
        Self::new(&Affine::IDENTITY, &moved(bounds, model))
    }

    /// Returns the space that the transform leads to.
    pub(super) const fn local(&self) -> LocalSpace {
        self.local
    }

    /// Multiplies the columns by a vector: 32.32.
    fn rotated(&self, v: [i64; 3]) -> [i64; 3] {
        self.columns.map(|c| i64::from(c[0]) * v[0] + i64::from(c[1]) * v[1] + i64::from(c[2]) * v[2])
    }

    /// Transforms a direction: 2.14, of length 1 or zero.
    pub(super) fn direction(&self, direction: Vec3) -> [i32; 3] {
        let Some(unit) = direction.normalized() else { return [0; 3] };
        let rotated = self.rotated(unit.to_bits().map(i64::from)).map(|c| (c >> 16) as i32);
        match Vec3::from_bits(rotated).normalized() {
            Some(unit) => unit.to_bits().map(|c| (c + 2) >> 2),
            None => [0; 3],
        }
    }

    /// Converts a length in the lights' space to local units.
    pub(super) fn length(&self, length: Scalar) -> i32 {
        self.scaled(i64::from(length.to_bits()) << 16)
    }

    /// Converts 32.32 of the lights' space to local units.
    fn scaled(&self, value: i64) -> i32 {
        // 32.32 by 16.16 and `extra` bits: below 2⁶³ for |value| < 2⁵¹.
        let quotient = (value << self.extra).checked_div(self.scale).unwrap_or(0);
        shifted(quotient, self.local.shift() - 14)
    }

    /// Transforms a point to local units, saturated at ±2²⁹.
    pub(super) fn position(&self, point: Vec3) -> [i32; 3] {
        let p = point.to_bits();
        let [tx, ty, tz] = self.translation.map(i64::from);
        let rotated = self.rotated([i64::from(p[0]) - tx, i64::from(p[1]) - ty, i64::from(p[2]) - tz]);
        let center = |k: usize| shifted(i64::from(self.local.center[k]), self.local.shift() - 14);
        [
            self.scaled(rotated[0]).wrapping_sub(center(0)),
            self.scaled(rotated[1]).wrapping_sub(center(1)),
            self.scaled(rotated[2]).wrapping_sub(center(2)),
        ]
    }
}
