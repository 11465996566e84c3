//! Culling of whole objects: the planes of the view volume, tested against boxes and spheres.

use super::clip::Outcode;
use super::viewport::Viewport;
use crate::math::{Projective, Scalar};
use crate::mesh::{BoundingBox, BoundingSphere, Bounds};

/// A plane in the space that the matrix maps from; its inside is where it is not negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plane {
    /// Normal, pointing inside, of any length; at most 2²⁸.
    normal: [i32; 3],
    /// Offset, below 2⁶⁰: the value of the plane at the origin.
    offset: i64,
    /// At least the length of the normal.
    length: i32,
    /// By how much values may be off.
    slack: i64,
}

/// Where an object is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Containment {
    /// Surely outside: nothing of it can be seen.
    Outside,
    /// It may cross the border.
    Crossing,
    /// Surely inside of all planes.
    Inside,
}

/// The view volume as six planes: left, right, bottom, top, near, far.
///
/// Tests err on the side of [`Containment::Crossing`], never otherwise.
///
/// ```
/// use zstrip::mesh::BoundingSphere;
/// use zstrip::internals::{Containment, Frustum};
/// use zstrip::math::{Angle16, Projective, Scalar, Vec3};
/// let camera = Projective::perspective(Angle16::from_degrees(60), (4, 3), Scalar::ONE, Scalar::from_num(50))?;
/// let frustum = Frustum::new(&camera);
/// let behind = BoundingSphere { center: Vec3::from_ints(0, 0, 5), radius: Scalar::ONE };
/// assert_eq!(frustum.sphere(&behind), Containment::Outside);
/// # Ok::<(), zstrip::math::ProjectionError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frustum {
    planes: [Plane; 6],
}

/// A unit of rounding an axis of a normal (times 2³¹), and of the offset, cannot move a value by more than this.
const SLACK: i64 = 1 << 33;

impl Plane {
    /// The normal: points inside, of any length.
    pub const fn normal(&self) -> [i32; 3] {
        self.normal
    }

    /// The value at the origin; elsewhere it is that and the normal times the position in raw 16.16, positive inside.
    pub const fn offset(&self) -> i64 {
        self.offset
    }

    /// The plane `row · (x, y, z, 1) ≥ 0`, entries below 2⁶¹ with 32 fractional bits each, rounded down by up to `error`.
    #[inline(never)]
    fn new(row: [i64; 4], error: i32) -> Self {
        // Normal below 2²⁸ and offset (16 more fractional bits) below 2⁶⁰, by one common shift.
        let bits = |v: i64| 64 - v.unsigned_abs().leading_zeros() as i32;
        let normal_bits = bits(row[0]).max(bits(row[1])).max(bits(row[2]));
        let shift = (normal_bits - 28).max(bits(row[3]) + 16 - 60);
        let scaled = |v: i64, shift: i32| if shift >= 0 { v >> shift.min(63) } else { v << -shift };
        let normal = [scaled(row[0], shift) as i32, scaled(row[1], shift) as i32, scaled(row[2], shift) as i32];
        // The largest component and half the others are never shorter than the vector, and at most 1/4 longer.
        let [a, b, c] = normal.map(i32::abs);
        let largest = a.max(b).max(c);
        let length = largest + (a + b + c - largest) / 2 + 2;
        Self {
            normal,
            offset: scaled(row[3], shift - 16),
            length,
            // A unit for rounding here, beside those that came in, rounded up.
            slack: (scaled(i64::from(error), shift) + i64::from(error > 0) + 1).clamp(1, 1 << 28) * SLACK,
        }
    }

    /// Value of the plane at a point in raw 16.16: positive inside, off by less than `slack`.
    fn at(&self, p: [i32; 3]) -> i64 {
        // 2²⁸ · 2³¹ · 3 + 2⁶⁰ < 2⁶².
        let [a, b, c] = self.normal;
        i64::from(a) * i64::from(p[0]) + i64::from(b) * i64::from(p[1]) + i64::from(c) * i64::from(p[2]) + self.offset
    }

    #[inline(never)]
    fn contains(&self, center: [i32; 3], reach: i64) -> Containment {
        let value = self.at(center);
        if value + reach < -self.slack {
            Containment::Outside
        } else if value - reach > self.slack {
            Containment::Inside
        } else {
            Containment::Crossing
        }
    }
}

impl Frustum {
    /// The planes of clip space in the space `matrix` maps from: of world space for a camera, of object space for a
    /// product of camera and model.
    pub fn new(matrix: &Projective) -> Self {
        let sides = [[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1]];
        Self::combined(matrix, sides)
    }

    /// The part of the view volume that is seen through a rectangle of the screen.
    ///
    /// The rectangle is `x0..x1`, `y0..y1` in pixels; clip space is mapped to `viewport`.
    pub fn through(matrix: &Projective, viewport: &Viewport, x: (i32, i32), y: (i32, i32)) -> Self {
        // X = cx + hw x / w >= x0  <=>  W x + 2 (cx - x0) w >= 0, all times two; likewise the others, y downwards.
        let (width, height) = (i32::from(viewport.width()), i32::from(viewport.height()));
        let (cx2, cy2) = (2 * i32::from(viewport.x()) + width, 2 * i32::from(viewport.y()) + height);
        let sides = [
            [width, 0, 0, cx2 - 2 * x.0],
            [-width, 0, 0, 2 * x.1 - cx2],
            [0, height, 0, 2 * y.1 - cy2],
            [0, -height, 0, cy2 - 2 * y.0],
        ];
        Self::combined(matrix, sides)
    }

    /// Planes whose rows are sums of the matrix's rows: `sides` says how many of each; near and far are always the same.
    #[inline(never)]
    fn combined(matrix: &Projective, sides: [[i32; 4]; 4]) -> Self {
        let mut rows = matrix.to_rows();
        // To 43 bits, so that sums with factors of 16 bits fit.
        let largest = rows.iter().flatten().fold(0, |all, v| all | v.unsigned_abs());
        let shift = (64 - largest.leading_zeros()).saturating_sub(43);
        rows.iter_mut().flatten().for_each(|entry| *entry >>= shift);
        let [a, b, c, d] = sides;
        let planes = [a, b, c, d, [0, 0, 1, 0], [0, 0, -1, 1]].map(|factors| {
            let mut sum = [0_i64; 4];
            for (row, factor) in rows.iter().zip(factors) {
                for (sum, entry) in sum.iter_mut().zip(row) {
                    *sum += entry * i64::from(factor);
                }
            }
            let error = factors.iter().map(|f| f.abs()).sum();
            Plane::new(sum, if shift > 0 { error } else { 0 })
        });
        Self { planes }
    }

    /// Without its near or far plane, where `planes` says so: for what is drawn beyond them with its depth clamped.
    pub fn without(mut self, planes: Outcode) -> Self {
        let [_, _, _, _, near, far] = &mut self.planes;
        for (plane, bit) in [(near, Outcode::NEAR), (far, Outcode::FAR)] {
            if planes.0 & bit != 0 {
                // Everything is inside of it.
                *plane = Plane { normal: [0; 3], offset: 1 << 60, length: 0, slack: 0 };
            }
        }
        self
    }

    /// The planes: left, right, bottom, top, near, far.
    pub const fn planes(&self) -> &[Plane; 6] {
        &self.planes
    }

    /// Where a box is.
    pub fn aabb(&self, aabb: &BoundingBox) -> Containment {
        let (center, half) = (aabb.center.to_bits(), aabb.half.to_bits());
        self.all(center, |plane| {
            plane
                .normal
                .iter()
                .zip(half)
                .map(|(n, h)| i64::from(n.unsigned_abs()) * i64::from(h))
                .fold(0, i64::wrapping_add)
        })
    }

    /// Where a sphere is.
    pub fn sphere(&self, sphere: &BoundingSphere) -> Containment {
        // A radius that did not fit holds nothing for sure.
        if sphere.radius == Scalar::MAX {
            return Containment::Crossing;
        }
        let radius = i64::from(sphere.radius.to_bits());
        self.all(sphere.center.to_bits(), |plane| i64::from(plane.length) * radius)
    }

    /// Where something is that lies both in the sphere and in the box; the sphere is the quicker test.
    pub fn bounds(&self, bounds: &Bounds) -> Containment {
        match self.sphere(&bounds.sphere) {
            Containment::Crossing => self.aabb(&bounds.aabb),
            sure => sure,
        }
    }

    fn all(&self, center: [i32; 3], reach: impl Fn(&Plane) -> i64) -> Containment {
        let mut result = Containment::Inside;
        for plane in &self.planes {
            match plane.contains(center, reach(plane)) {
                Containment::Outside => return Containment::Outside,
                Containment::Crossing => result = Containment::Crossing,
                Containment::Inside => {}
            }
        }
        result
    }
}
