//! Affine transforms: a 3×3 matrix and a translation, for placing models and cameras.

use super::angle::Angle16;
use super::error::ProjectionError;
use super::format::Scalar;
use super::reciprocal::mul_wide;
use super::vector::{Vec3, saturate};
use core::ops::Mul;

/// An affine transform of column vectors, `p -> M p + t`; entries are 16.16.
///
/// `a * b` applies `b` first.
///
/// ```
/// use zstrip::math::{Affine, Angle16, Vec3};
/// let model = Affine::translation(Vec3::from_ints(0, 0, -3)) * Affine::rotation_y(Angle16::from_degrees(90));
/// assert_eq!(model.transform_point(Vec3::X), Vec3::from_ints(0, 0, -4));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Affine {
    /// Three rows of the matrix, raw 16.16, the translation in the fourth column.
    rows: [[i32; 4]; 3],
}

const ONE: i32 = 1 << 16;

impl Default for Affine {
    /// Returns [`IDENTITY`](Affine::IDENTITY).
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Affine {
    /// The transform that leaves everything where it is.
    pub const IDENTITY: Self = Self { rows: [[ONE, 0, 0, 0], [0, ONE, 0, 0], [0, 0, ONE, 0]] };

    /// Makes a transform of the three rows of its matrix and its translation.
    #[must_use]
    pub const fn from_rows(x: Vec3, y: Vec3, z: Vec3, translation: Vec3) -> Self {
        let t = translation.to_bits();
        let (x, y, z) = (x.to_bits(), y.to_bits(), z.to_bits());
        Self { rows: [[x[0], x[1], x[2], t[0]], [y[0], y[1], y[2], t[1]], [z[0], z[1], z[2], t[2]]] }
    }

    /// Moves by `offset`.
    #[must_use]
    pub const fn translation(offset: Vec3) -> Self {
        Self::from_rows(Vec3::X, Vec3::Y, Vec3::Z, offset)
    }

    /// Scales about the origin by one factor on all axes.
    #[must_use]
    pub const fn scale(factor: Scalar) -> Self {
        Self::scale_axes(Vec3::new(factor, factor, factor))
    }

    /// Scales about the origin by a factor per axis.
    #[must_use]
    pub const fn scale_axes(factors: Vec3) -> Self {
        let f = factors.to_bits();
        Self { rows: [[f[0], 0, 0, 0], [0, f[1], 0, 0], [0, 0, f[2], 0]] }
    }

    /// Rotates about the x axis, from y towards z.
    #[must_use]
    pub const fn rotation_x(angle: Angle16) -> Self {
        let (s, c) = (angle.sin().to_bits(), angle.cos().to_bits());
        Self { rows: [[ONE, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0]] }
    }

    /// Rotates about the y axis, from z towards x.
    #[must_use]
    pub const fn rotation_y(angle: Angle16) -> Self {
        let (s, c) = (angle.sin().to_bits(), angle.cos().to_bits());
        Self { rows: [[c, 0, s, 0], [0, ONE, 0, 0], [-s, 0, c, 0]] }
    }

    /// Rotates about the z axis, from x towards y.
    #[must_use]
    pub const fn rotation_z(angle: Angle16) -> Self {
        let (s, c) = (angle.sin().to_bits(), angle.cos().to_bits());
        Self { rows: [[c, -s, 0, 0], [s, c, 0, 0], [0, 0, ONE, 0]] }
    }

    /// Rotates counter-clockwise about `axis`, as seen from its tip. The result is the identity if the axis is zero.
    ///
    /// # Source
    /// Rodrigues' formula; entries within 2⁻¹⁴.
    #[must_use]
    pub const fn rotation(axis: Vec3, angle: Angle16) -> Self {
        let Some(unit) = axis.normalized() else {
            return Self::IDENTITY;
        };
        let n = unit.to_bits();
        let (s, c) = (angle.sin().to_bits() as i64, angle.cos().to_bits() as i64);
        let mut rows = [[0; 4]; 3];
        let mut i = 0;
        while i < 3 {
            let mut j = 0;
            while j < 3 {
                // The product is below 2³² · 2¹⁷.
                let outer = n[i] as i64 * n[j] as i64 * (ONE as i64 - c);
                rows[i][j] += ((outer + (1 << 31)) >> 32) as i32;
                j += 1;
            }
            rows[i][i] += c as i32;
            // The cross-product matrix: +n on (next, previous), -n on (previous, next).
            let (next, previous) = ((i + 1) % 3, (i + 2) % 3);
            let cross = ((n[i] as i64 * s + (1 << 15)) >> 16) as i32;
            rows[previous][next] += cross;
            rows[next][previous] -= cross;
            i += 1;
        }
        Self { rows }
    }

    /// Returns the view transform of a camera at `eye` that looks at `target`. It takes world coordinates to eye
    /// coordinates, in which the camera looks along -z.
    ///
    /// `up` may be of any length, and as close to the view direction as its numbers can tell: its part across the view
    /// is up on the screen.
    ///
    /// # Errors
    /// [`ProjectionError::DegenerateView`] if `eye == target`, or `up` is zero or exactly parallel to the view
    /// direction, along it or against it.
    ///
    /// # Format
    /// Products of two rows are within 2⁻¹⁴ of 0, and lengths within 2⁻¹³ of 1. Entries are within 2⁻¹² of the exact
    /// ones. If the difference of two coordinates of `eye` and `target` does not fit 16.16, differences lose one bit.
    pub const fn look_at(eye: Vec3, target: Vec3, up: Vec3) -> Result<Self, ProjectionError> {
        let back = difference(eye, target);
        let (Some(z), Some(unit_up)) = (back.normalized(), up.normalized()) else {
            return Err(ProjectionError::DegenerateView);
        };
        // The rounding of z turns x the more, the closer `up` is to it. Within 14.5 degrees (a cosine of 0.968), x
        // comes from the directions as they were given.
        let is_close = unit_up.dot(z).to_bits().unsigned_abs() > 63_455;
        let Some(x) = up.across(if is_close { back } else { z }) else {
            return Err(ProjectionError::DegenerateView);
        };
        let y = z.cross(x);
        let rotation = Self::from_rows(x, y, z, Vec3::ZERO);
        let moved = rotation.transform_vector(eye).to_bits();
        let t = Vec3::new(saturate(-(moved[0] as i64)), saturate(-(moved[1] as i64)), saturate(-(moved[2] as i64)));
        Ok(Self::from_rows(x, y, z, t))
    }

    /// Returns `self` after `first`: a `const` form of `self * first`. Entries are rounded to nearest, and saturate.
    ///
    /// Entries lose up to 2⁻¹⁷ each time. A rotation that is turned by small steps again and again needs
    /// [`orthonormalized`](Self::orthonormalized) from time to time: after 1,000 turns, products of two rows were
    /// seen to be 0.02 off.
    #[must_use]
    pub const fn compose(&self, first: &Self) -> Self {
        let mut rows = [[0; 4]; 3];
        let mut i = 0;
        while i < 3 {
            let mut j = 0;
            while j < 4 {
                let translation = if j == 3 { self.rows[i][3] as i64 } else { 0 };
                rows[i][j] = saturate(self.row_times(i, first.column(j)) + translation).to_bits();
                j += 1;
            }
            i += 1;
        }
        Self { rows }
    }

    /// Returns the inverse of a rigid transform (rotation and translation only): the transposed matrix.
    ///
    /// For a transform that scales or shears, the result is not the inverse.
    #[must_use]
    pub const fn inverse_rigid(&self) -> Self {
        let r = &self.rows;
        let t = Vec3::from_bits([r[0][3], r[1][3], r[2][3]]);
        let transposed = Self {
            rows: [[r[0][0], r[1][0], r[2][0], 0], [r[0][1], r[1][1], r[2][1], 0], [r[0][2], r[1][2], r[2][2], 0]],
        };
        let back = transposed.transform_vector(t).to_bits();
        let mut rows = transposed.rows;
        let mut i = 0;
        while i < 3 {
            rows[i][3] = saturate(-(back[i] as i64)).to_bits();
            i += 1;
        }
        Self { rows }
    }

    /// Returns the nearby transform whose rows are at right angles and of length 1: it undoes the drift of rotations
    /// that were composed many times. The translation stays, and so does a mirror.
    ///
    /// The first row keeps its direction, and the second row its plane with the first. Returns `None` if these two rows
    /// are parallel, or if one of them is zero.
    ///
    /// # Format
    /// Products of two rows are within 2⁻¹⁴ of 0, and lengths within 2⁻¹⁴ of 1.
    ///
    /// ```
    /// use zstrip::math::{Affine, Angle16};
    /// let (mut turned, step) = (Affine::IDENTITY, Affine::rotation_y(Angle16(100)));
    /// for _ in 0..100 {
    ///     turned = (step * turned).orthonormalized().unwrap_or(turned);
    /// }
    /// ```
    #[must_use]
    pub const fn orthonormalized(&self) -> Option<Self> {
        let r = &self.rows;
        let x = Vec3::from_bits([r[0][0], r[0][1], r[0][2]]);
        let y = Vec3::from_bits([r[1][0], r[1][1], r[1][2]]);
        let z = Vec3::from_bits([r[2][0], r[2][1], r[2][2]]);
        // Unit vectors first, so that products of short rows keep their bits.
        let (Some(x), Some(y)) = (x.normalized(), y.normalized()) else { return None };
        // Products of long vectors keep more bits: 2¹² of them, so that they stay below 2²⁹.
        let Some(normal) = longer(x).cross(y).normalized() else { return None };
        let Some(second) = longer(normal).cross(x).normalized() else { return None };
        let n = normal.to_bits();
        let third = if normal.dot(z).to_bits() < 0 { Vec3::from_bits([-n[0], -n[1], -n[2]]) } else { normal };
        Some(Self::from_rows(x, second, third, Vec3::from_bits([r[0][3], r[1][3], r[2][3]])))
    }

    /// Returns the transform that undoes this one.
    ///
    /// Returns `None` if there is no inverse (the determinant is 0), or if one of its entries does not fit 16.16. For
    /// rotations and translations [`inverse_rigid`](Self::inverse_rigid) is much shorter.
    ///
    /// # Format
    /// Each entry is that of the exact inverse of the stored entries, rounded to nearest: within 2⁻¹⁷. Minors are
    /// below 2⁶³, the determinant is below 2⁹⁶, and numerators are below 2¹¹⁴.
    ///
    /// # Source
    /// Cramer's rule.
    ///
    /// ```
    /// use zstrip::math::{Affine, Scalar, Vec3};
    /// let model = Affine::translation(Vec3::from_ints(1, 2, 3)) * Affine::scale(Scalar::from_num(4));
    /// let back = model.inverse().unwrap();
    /// assert_eq!(back * Vec3::from_ints(5, 2, 3), Vec3::X);
    /// assert_eq!(Affine::scale(Scalar::ZERO).inverse(), None);
    /// ```
    #[must_use]
    pub const fn inverse(&self) -> Option<Self> {
        let r = &self.rows;
        // Row i, column j of the adjugate: the minor without row j and column i, in cyclic order.
        let mut adjugate = [[0_i128; 3]; 3];
        let mut i = 0;
        while i < 3 {
            let mut j = 0;
            while j < 3 {
                let (a, b) = (&r[(j + 1) % 3], &r[(j + 2) % 3]);
                let (p, q) = ((i + 1) % 3, (i + 2) % 3);
                adjugate[i][j] = a[p] as i128 * b[q] as i128 - a[q] as i128 * b[p] as i128;
                j += 1;
            }
            i += 1;
        }
        let determinant =
            r[0][0] as i128 * adjugate[0][0] + r[0][1] as i128 * adjugate[1][0] + r[0][2] as i128 * adjugate[2][0];
        let mut rows = [[0; 4]; 3];
        let mut i = 0;
        while i < 3 {
            let a = &adjugate[i];
            let moved = a[0] * r[0][3] as i128 + a[1] * r[1][3] as i128 + a[2] * r[2][3] as i128;
            // In raw bits: minor / 2³² over determinant / 2⁴⁸, times 2¹⁶. The product with the translation has 16
            // more bits already.
            let numerators = [a[0] << 32, a[1] << 32, a[2] << 32, -(moved << 16)];
            let mut j = 0;
            while j < 4 {
                rows[i][j] = match quotient(numerators[j], determinant) {
                    Some(entry) => entry,
                    None => return None,
                };
                j += 1;
            }
            i += 1;
        }
        Some(Self { rows })
    }

    /// Returns `M p + t`, rounded to nearest, saturating.
    #[must_use]
    pub const fn transform_point(&self, point: Vec3) -> Vec3 {
        let p = point.to_bits();
        Vec3::new(
            saturate(self.row_times(0, p) + self.rows[0][3] as i64),
            saturate(self.row_times(1, p) + self.rows[1][3] as i64),
            saturate(self.row_times(2, p) + self.rows[2][3] as i64),
        )
    }

    /// Returns `M v`, rounded to nearest, for a direction `v`, which the translation does not move.
    #[must_use]
    pub const fn transform_vector(&self, vector: Vec3) -> Vec3 {
        let v = vector.to_bits();
        Vec3::new(saturate(self.row_times(0, v)), saturate(self.row_times(1, v)), saturate(self.row_times(2, v)))
    }

    /// Returns the rows, raw 16.16, with the translation as fourth column.
    #[must_use]
    pub const fn to_rows(&self) -> [[i32; 4]; 3] {
        self.rows
    }

    const fn column(&self, j: usize) -> [i32; 3] {
        [self.rows[0][j], self.rows[1][j], self.rows[2][j]]
    }

    /// Returns row `i` times `v`, 16.16, rounded to nearest: exactly.
    ///
    /// # Format
    /// The sum of three products of 62 bits would not fit 64 bits. So their quarters are added, and what the quarters
    /// leave over.
    const fn row_times(&self, i: usize, v: [i32; 3]) -> i64 {
        let r = &self.rows[i];
        let (a, b, c) = (mul_wide(r[0], v[0]), mul_wide(r[1], v[1]), mul_wide(r[2], v[2]));
        let left = ((a & 3) + (b & 3) + (c & 3)) >> 2;
        ((a >> 2) + (b >> 2) + (c >> 2) + left + (1 << 13)) >> 14
    }
}

/// Multiplies a unit vector by 2¹².
const fn longer(unit: Vec3) -> Vec3 {
    let [x, y, z] = unit.to_bits();
    Vec3::from_bits([x << 12, y << 12, z << 12])
}

/// Returns `a - b`, or half of it if one of its components does not fit 32 bits.
const fn difference(a: Vec3, b: Vec3) -> Vec3 {
    let (a, b) = (a.to_bits(), b.to_bits());
    let d = [a[0] as i64 - b[0] as i64, a[1] as i64 - b[1] as i64, a[2] as i64 - b[2] as i64];
    let fits = d[0] == d[0] as i32 as i64 && d[1] == d[1] as i32 as i64 && d[2] == d[2] as i32 as i64;
    let shift = !fits as u32;
    Vec3::from_bits([(d[0] >> shift) as i32, (d[1] >> shift) as i32, (d[2] >> shift) as i32])
}

/// Returns `num / den`, rounded to nearest; `None` if `den` is zero or the quotient does not fit 32 bits.
const fn quotient(num: i128, den: i128) -> Option<i32> {
    let (num, den) = if den < 0 { (-num, -den) } else { (num, den) };
    match (2 * num + den).checked_div_euclid(2 * den) {
        Some(quotient) if quotient >= i32::MIN as i128 && quotient <= i32::MAX as i128 => Some(quotient as i32),
        _ => None,
    }
}

impl Mul<Vec3> for Affine {
    type Output = Vec3;
    /// Returns [`transform_point`](Affine::transform_point).
    fn mul(self, point: Vec3) -> Vec3 {
        self.transform_point(point)
    }
}

impl Mul for Affine {
    type Output = Self;
    fn mul(self, first: Self) -> Self {
        self.compose(&first)
    }
}
