//! Projective transforms: 4×4 matrices that take world or object space to clip space.

use super::affine::Affine;
use super::angle::Angle16;
use super::error::ProjectionError;
use super::format::{Scalar, Wide};
use super::long::Long;
use super::reciprocal::mul_long;
use super::vector::Vec3;
use core::ops::Mul;
use embedded_graphics_core::geometry::Size;

/// A 4×4 matrix of 32.32 entries, applied to column vectors; clip space is -w ≤ x, y ≤ w, 0 ≤ z ≤ w.
///
/// ```
/// use zstrip::embedded_graphics_core::geometry::Size;
/// use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
/// let near = Scalar::from_num(0.5);
/// let camera = Projective::perspective(Angle16::from_degrees(60), Size::new(320, 240), near, Scalar::from_num(100))?;
/// let view = Affine::look_at(Vec3::from_ints(0, 2, 5), Vec3::ZERO, Vec3::Y)?;
/// let mvp = camera * view * Affine::rotation_y(Angle16::from_degrees(30));
/// # let _ = mvp;
/// # Ok::<(), zstrip::math::ProjectionError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Projective {
    /// Four rows, raw 32.32.
    rows: [[i64; 4]; 4],
}

const ONE: i64 = 1 << 32;

/// Saturates `value` to 64 bits.
const fn saturate(value: i128) -> i64 {
    if value > i64::MAX as i128 {
        i64::MAX
    } else if value < i64::MIN as i128 {
        i64::MIN
    } else {
        value as i64
    }
}

/// Returns `num / den` in 32.32, rounded to nearest, for two numbers in one format; 0 for a zero `den`.
const fn ratio(num: i128, den: i128) -> i64 {
    let (num, den) = if den < 0 { (-num, -den) } else { (num, den) };
    match ((num << 33) + den).checked_div_euclid(2 * den) {
        Some(quotient) => saturate(quotient),
        None => 0,
    }
}

/// Returns `b[s] c[t] - b[t] c[s]`. It is below 2¹²⁷, since no product but that of two -2⁶³ reaches 2¹²⁶.
const fn minor_of(b: [i64; 4], c: [i64; 4], s: usize, t: usize) -> i128 {
    b[s] as i128 * c[t] as i128 - b[t] as i128 * c[s] as i128
}

impl Default for Projective {
    /// Returns [`IDENTITY`](Projective::IDENTITY).
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Projective {
    /// The transform that leaves everything where it is.
    pub const IDENTITY: Self = Self { rows: [[ONE, 0, 0, 0], [0, ONE, 0, 0], [0, 0, ONE, 0], [0, 0, 0, ONE]] };

    /// Makes a transform of rows of raw 32.32 bits.
    #[must_use]
    pub const fn from_rows(rows: [[i64; 4]; 4]) -> Self {
        Self { rows }
    }

    /// Returns the rows, raw 32.32.
    #[must_use]
    pub const fn to_rows(&self) -> [[i64; 4]; 4] {
        self.rows
    }

    /// Returns the rows by reference.
    pub(crate) const fn rows(&self) -> &[[i64; 4]; 4] {
        &self.rows
    }

    /// Returns the entry in `row` and `column`; `None` outside the matrix.
    #[must_use]
    pub fn entry(&self, row: usize, column: usize) -> Option<Wide> {
        self.rows.get(row)?.get(column).map(|&bits| Wide::from_bits(bits))
    }

    /// Makes a perspective camera at the origin that looks along -z.
    ///
    /// `field_of_view` is the vertical opening angle. `aspect` is the size of the screen or viewport, or any two
    /// numbers in the ratio of its width and height. Depth is 0 at distance `near` and 1 at `far`.
    ///
    /// # Errors
    /// When `near ≤ 0`, `near ≥ far`, the angle is not in 0..180°, or the aspect has a zero.
    #[inline(never)]
    pub const fn perspective(
        field_of_view: Angle16,
        aspect: Size,
        near: Scalar,
        far: Scalar,
    ) -> Result<Self, ProjectionError> {
        let (n, f) = (near.to_bits() as i128, far.to_bits() as i128);
        if n <= 0 {
            return Err(ProjectionError::NearNotPositive { near });
        }
        if n >= f {
            return Err(ProjectionError::NearNotBeforeFar { near, far });
        }
        if field_of_view.0 < 2 || field_of_view.0 >= 0x8000 {
            return Err(ProjectionError::FieldOfView { angle: field_of_view });
        }
        if aspect.width == 0 || aspect.height == 0 {
            return Err(ProjectionError::Aspect { width: aspect.width, height: aspect.height });
        }
        let half = Angle16(field_of_view.0 / 2);
        let (sin, cos) = (half.sin_q30() as i128, half.cos_q30() as i128);
        let x = ratio(cos * aspect.height as i128, sin * aspect.width as i128);
        let y = ratio(cos, sin);
        // z = far (-ze - near) / (far - near), w = -ze: z is 0 on the near plane, and w on the far plane.
        let a = ratio(f, n - f);
        let b = ratio(f * n, (n - f) << 16);
        Ok(Self { rows: [[x, 0, 0, 0], [0, y, 0, 0], [0, 0, a, b], [0, 0, -ONE, 0]] })
    }

    /// Makes an orthographic camera that looks along -z. It maps the box `left..right`, `bottom..top`, `-far..-near`
    /// to all of clip space.
    ///
    /// # Errors
    /// When two opposite sides coincide, or `near ≥ far`. `near` may be negative here.
    pub const fn orthographic(
        (left, right): (Scalar, Scalar),
        (bottom, top): (Scalar, Scalar),
        (near, far): (Scalar, Scalar),
    ) -> Result<Self, ProjectionError> {
        let (l, r) = (left.to_bits() as i128, right.to_bits() as i128);
        let (b, t) = (bottom.to_bits() as i128, top.to_bits() as i128);
        let (n, f) = (near.to_bits() as i128, far.to_bits() as i128);
        if l == r {
            return Err(ProjectionError::EmptyBox { low: left, high: right });
        }
        if b == t {
            return Err(ProjectionError::EmptyBox { low: bottom, high: top });
        }
        if n >= f {
            return Err(ProjectionError::NearNotBeforeFar { near, far });
        }
        Ok(Self {
            rows: [
                [ratio(2 << 16, r - l), 0, 0, ratio(-(r + l), r - l)],
                [0, ratio(2 << 16, t - b), 0, ratio(-(t + b), t - b)],
                [0, 0, ratio(-1 << 16, f - n), ratio(-n, f - n)],
                [0, 0, 0, ONE],
            ],
        })
    }

    /// Returns `self` after `first`: a `const` form of `self * first`. Entries are rounded to nearest and saturate.
    #[must_use]
    pub const fn compose(&self, first: &Self) -> Self {
        let mut rows = [[0; 4]; 4];
        let mut i = 0;
        while i < 4 {
            let mut j = 0;
            while j < 4 {
                let mut sum = 0_i128;
                let mut k = 0;
                while k < 4 {
                    // Products have 64 + 64 bits. A quarter of each keeps the sum of four within 128.
                    sum += (self.rows[i][k] as i128 * first.rows[k][j] as i128) >> 2;
                    k += 1;
                }
                rows[i][j] = saturate((sum + (1 << 29)) >> 30);
                j += 1;
            }
            i += 1;
        }
        Self { rows }
    }

    /// Returns the transform that undoes this one, for instance to go from the screen back to the world.
    ///
    /// Returns `None` if there is no inverse (the determinant is 0), or if one of its entries does not fit 32.32.
    ///
    /// # Format
    /// Each entry is that of the exact inverse of the stored entries, rounded to nearest: within 2⁻³³. Determinants
    /// are computed in 320 bits. This takes some thousand instructions, for a call per frame or per touch.
    ///
    /// # Source
    /// Cramer's rule.
    ///
    /// ```
    /// use zstrip::embedded_graphics_core::geometry::Size;
    /// use zstrip::math::{Angle16, Projective, Scalar, Vec3};
    /// let (near, far) = (Scalar::ONE, Scalar::from_num(9));
    /// let lens = Projective::perspective(Angle16::from_degrees(60), Size::new(4, 3), near, far)?;
    /// // The middle of the near plane in clip space. Its image is divided by its w afterwards.
    /// # Ok::<(), zstrip::math::ProjectionError>(())
    /// ```
    #[must_use]
    pub const fn inverse(&self) -> Option<Self> {
        let mut cofactors = [[Long::ZERO; 4]; 4];
        let mut i = 0;
        while i < 4 {
            let mut j = 0;
            while j < 4 {
                cofactors[i][j] = self.cofactor(i, j);
                j += 1;
            }
            i += 1;
        }
        let mut determinant = Long::ZERO;
        let mut j = 0;
        while j < 4 {
            determinant = determinant.plus(cofactors[0][j].times(self.rows[0][j]));
            j += 1;
        }
        if determinant.is_zero() {
            return None;
        }
        let mut rows = [[0; 4]; 4];
        let mut i = 0;
        while i < 4 {
            let mut j = 0;
            while j < 4 {
                // In raw bits: cofactor / 2⁹⁶ over determinant / 2¹²⁸, times 2³².
                rows[i][j] = match Long::ratio(cofactors[j][i], determinant) {
                    Some(entry) => entry,
                    None => return None,
                };
                j += 1;
            }
            i += 1;
        }
        Some(Self { rows })
    }

    /// Returns the signed determinant of the matrix without a row and a column.
    ///
    /// # Format
    /// Minors of 2×2 are below 2¹²⁷. The determinant is a sum of six products of a minor and an entry, below 2¹⁹³.
    const fn cofactor(&self, row: usize, column: usize) -> Long {
        // Cyclic order keeps the sign of 3×3 determinants. It makes the sign of 4×4 determinants (-1)^(row + column).
        let (a, b, c) = (self.rows[(row + 1) & 3], self.rows[(row + 2) & 3], self.rows[(row + 3) & 3]);
        let (p, q, r) = ((column + 1) & 3, (column + 2) & 3, (column + 3) & 3);
        let sum = Long::of(minor_of(b, c, q, r))
            .times(a[p])
            .plus(Long::of(minor_of(b, c, r, p)).times(a[q]))
            .plus(Long::of(minor_of(b, c, p, q)).times(a[r]));
        if (row + column) & 1 == 0 { sum } else { sum.negated() }
    }

    /// Returns `self` after an affine transform: a `const` form of `self * model`.
    #[inline(never)]
    #[must_use]
    pub const fn compose_affine(&self, model: &Affine) -> Self {
        let (a, mut rows) = (model.to_rows(), [[0; 4]; 4]);
        let mut i = 0;
        while i < 4 {
            let row = &self.rows[i];
            let mut j = 0;
            while j < 4 {
                // Products have 64 + 32 bits.
                let mut sum = if j == 3 { (row[3] as i128) << 16 } else { 0 };
                let mut k = 0;
                while k < 3 {
                    // Most entries of a lens are 0.
                    if row[k] != 0 {
                        sum += mul_long(row[k], a[k][j]);
                    }
                    k += 1;
                }
                rows[i][j] = saturate((sum + (1 << 15)) >> 16);
                j += 1;
            }
            i += 1;
        }
        Self { rows }
    }

    /// Returns the clip coordinates x, y, z, w of a point, rounded to nearest and saturating. Divided by w, they are
    /// the point's place in clip space.
    #[must_use]
    pub const fn transform_point(&self, point: Vec3) -> [Wide; 4] {
        let p = point.to_bits();
        let mut result = [Wide::ZERO; 4];
        let mut i = 0;
        while i < 4 {
            let r = &self.rows[i];
            // Products have 64 + 32 bits: no sum of four leaves 128.
            let sum = r[0] as i128 * p[0] as i128
                + r[1] as i128 * p[1] as i128
                + r[2] as i128 * p[2] as i128
                + ((r[3] as i128) << 16);
            result[i] = Wide::from_bits(saturate((sum + (1 << 15)) >> 16));
            i += 1;
        }
        result
    }

    /// Converts an affine transform to a 4×4 matrix.
    #[must_use]
    pub const fn from_affine(model: &Affine) -> Self {
        let a = model.to_rows();
        let mut rows = [[0; 4], [0; 4], [0; 4], [0, 0, 0, ONE]];
        let mut i = 0;
        while i < 3 {
            let mut j = 0;
            while j < 4 {
                rows[i][j] = (a[i][j] as i64) << 16;
                j += 1;
            }
            i += 1;
        }
        Self { rows }
    }
}

impl Mul for Projective {
    type Output = Self;
    fn mul(self, first: Self) -> Self {
        self.compose(&first)
    }
}

impl Mul<Affine> for Projective {
    type Output = Self;
    fn mul(self, first: Affine) -> Self {
        self.compose_affine(&first)
    }
}

impl From<Affine> for Projective {
    fn from(model: Affine) -> Self {
        Self::from_affine(&model)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::math::random::Rng;

    #[test]
    fn affine_transforms_are_composed_as_matrices_are() {
        let mut rng = Rng::new(6);
        for case in 0..5000 {
            let rows = core::array::from_fn(|_| {
                core::array::from_fn(|_| if rng.below(3) == 0 { 0 } else { rng.signed_bits(1 + case % 64) })
            });
            let lens = Projective::from_rows(rows);
            let mut vector = || Vec3::from_bits(core::array::from_fn(|_| rng.signed_bits(1 + case / 64 % 32) as i32));
            let model = Affine::from_rows(vector(), vector(), vector(), vector());
            assert_eq!(
                lens.compose_affine(&model),
                lens.compose(&Projective::from_affine(&model)),
                "{lens:?} {model:?}"
            );
        }
    }
}
