//! Conversions from floats: `micromath` vectors and quaternions and `f32` matrices become fixed-point ones.
//!
//! This is the only file that knows floats. It takes them apart and does not calculate with them: a float is an
//! integer times a power of two. So conversions are exact up to one rounding, and link no float routine.

use super::affine::Affine;
use super::projective::Projective;
use super::vector::Vec3;
use core::fmt;
use micromath::Quaternion;
use micromath::vector::F32x3;

/// An error in floats to be converted. Components are numbered in reading order: row by row, from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FloatError {
    /// A component is infinite or not a number.
    NotFinite {
        /// Number of the component.
        index: usize,
        /// Value of the component.
        value: f32,
    },
    /// A component is too large for its fixed-point format.
    OutOfRange {
        /// Number of the component.
        index: usize,
        /// Value of the component.
        value: f32,
    },
    /// All four components of a quaternion are zero, so that it stands for no rotation.
    ZeroQuaternion,
}

impl fmt::Display for FloatError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { index, value } => write!(f, "component {index} is {value}, not a finite number"),
            Self::OutOfRange { index, value } => write!(f, "component {index} is {value}, out of range"),
            Self::ZeroQuaternion => f.write_str("the quaternion is zero"),
        }
    }
}

impl core::error::Error for FloatError {}

/// A finite float as mantissa · 2^exponent, the mantissa below 2²⁴.
#[derive(Clone, Copy, Default)]
struct Parts {
    mantissa: i64,
    exponent: i32,
}

impl Parts {
    fn of(index: usize, value: f32) -> Result<Self, FloatError> {
        let bits = value.to_bits();
        let biased = (bits >> 23 & 0xFF) as i32;
        let fraction = i64::from(bits & 0x7F_FFFF);
        let (magnitude, exponent) = match biased {
            0xFF => return Err(FloatError::NotFinite { index, value }),
            // Zero and subnormal numbers lack the leading one.
            0 => (fraction, -149),
            _ => (fraction | 1 << 23, biased - 150),
        };
        let mantissa = if bits >> 31 == 0 { magnitude } else { -magnitude };
        Ok(Self { mantissa, exponent })
    }

    /// Returns the float in units of 2^-`fraction_bits`, rounded to nearest, halves up. Returns `None` where it may
    /// not fit 63 bits.
    fn fixed(self, fraction_bits: i32) -> Option<i64> {
        let shift = self.exponent + fraction_bits;
        if self.mantissa == 0 {
            Some(0)
        } else if shift >= 0 {
            // 24 bits of mantissa.
            if shift > 63 - 24 { None } else { Some(self.mantissa << shift) }
        } else {
            let down = (-shift).min(40);
            Some((self.mantissa + (1 << (down - 1))) >> down)
        }
    }
}

/// Converts one component to raw 16.16, rounded to nearest.
fn scalar(index: usize, value: f32) -> Result<i32, FloatError> {
    let fixed = Parts::of(index, value)?.fixed(16);
    fixed.and_then(|bits| i32::try_from(bits).ok()).ok_or(FloatError::OutOfRange { index, value })
}

/// Converts one component to raw 32.32, rounded to nearest.
fn wide(index: usize, value: f32) -> Result<i64, FloatError> {
    Parts::of(index, value)?.fixed(32).ok_or(FloatError::OutOfRange { index, value })
}

/// Converts a vector, each component rounded to the nearest 2⁻¹⁶.
///
/// # Errors
/// When a component is not finite, or not within ±32,768.
///
/// ```
/// use micromath::vector::F32x3;
/// use zstrip::math::{FloatError, Vec3};
/// assert_eq!(Vec3::try_from(F32x3 { x: 1.5, y: -0.25, z: 0.0 }), Ok(Vec3::from_milli(1500, -250, 0)));
/// let wrong = Vec3::try_from(F32x3 { x: 0.0, y: 1e9, z: 0.0 });
/// assert_eq!(wrong, Err(FloatError::OutOfRange { index: 1, value: 1e9 }));
/// ```
impl TryFrom<F32x3> for Vec3 {
    type Error = FloatError;

    fn try_from(v: F32x3) -> Result<Self, FloatError> {
        Ok(Self::from_bits([scalar(0, v.x)?, scalar(1, v.y)?, scalar(2, v.z)?]))
    }
}

/// Converts three rows of a matrix, with the translation as fourth column, each entry rounded to the nearest 2⁻¹⁶.
///
/// # Errors
/// When an entry is not finite, or not within ±32,768.
impl TryFrom<[[f32; 4]; 3]> for Affine {
    type Error = FloatError;

    fn try_from(rows: [[f32; 4]; 3]) -> Result<Self, FloatError> {
        let mut bits = [[0; 4]; 3];
        for (i, (bits, row)) in bits.iter_mut().zip(rows).enumerate() {
            for (j, (bit, value)) in bits.iter_mut().zip(row).enumerate() {
                *bit = scalar(4 * i + j, value)?;
            }
        }
        let [x, y, z] = bits.map(|row| Vec3::from_bits([row[0], row[1], row[2]]));
        let translation = Vec3::from_bits(bits.map(|row| row[3]));
        Ok(Self::from_rows(x, y, z, translation))
    }
}

/// Converts four rows of a matrix, each entry rounded to the nearest 2⁻³².
///
/// Clip space is that of [`Projective`], 0 ≤ z ≤ w: a matrix made for OpenGL maps depth to -w..w instead.
///
/// # Errors
/// When an entry is not finite, or not below 2³¹ in magnitude.
impl TryFrom<[[f32; 4]; 4]> for Projective {
    type Error = FloatError;

    fn try_from(rows: [[f32; 4]; 4]) -> Result<Self, FloatError> {
        let mut bits = [[0; 4]; 4];
        for (i, (bits, row)) in bits.iter_mut().zip(rows).enumerate() {
            for (j, (bit, value)) in bits.iter_mut().zip(row).enumerate() {
                *bit = wide(4 * i + j, value)?;
            }
        }
        Ok(Self::from_rows(bits))
    }
}

/// Converts a quaternion of any length to the rotation that it stands for. `new(w, x, y, z)` has the real part w
/// first.
///
/// # Format
/// Components are rounded to 21 bits of the largest one, which moves an entry by at most 4 · 2⁻²⁰. Entries are
/// rounded to 2⁻¹⁶ after that. So each is within 2⁻¹⁶ of the exact rotation. The sum of the squares and the
/// numerators are at most 2⁴⁴, which leaves room for the 17 bits by which numerators are shifted up.
///
/// # Errors
/// When a component is not finite, or all are zero.
impl TryFrom<Quaternion> for Affine {
    type Error = FloatError;

    fn try_from(q: Quaternion) -> Result<Self, FloatError> {
        let [w, x, y, z] = q.to_array();
        let parts = [Parts::of(0, w)?, Parts::of(1, x)?, Parts::of(2, y)?, Parts::of(3, z)?];
        // `top` is the exponent of the power of two just above the largest component. The common scale makes that
        // power 2²¹.
        let bits = |p: &Parts| p.exponent + 64 - p.mantissa.unsigned_abs().leading_zeros() as i32;
        let Some(top) = parts.iter().filter(|p| p.mantissa != 0).map(bits).max() else {
            return Err(FloatError::ZeroQuaternion);
        };
        let [w, x, y, z] = parts.map(|p| p.fixed(21 - top).unwrap_or(0));
        let (ww, xx, yy, zz) = (w * w, x * x, y * y, z * z);
        let norm = ww + xx + yy + zz;
        // Returns n / norm in 16.16, rounded to nearest.
        let entry = |n: i64| ((n << 17) + norm).div_euclid(2 * norm) as i32;
        let row = |a, b, c| Vec3::from_bits([entry(a), entry(b), entry(c)]);
        Ok(Self::from_rows(
            row(ww + xx - yy - zz, 2 * (x * y - w * z), 2 * (x * z + w * y)),
            row(2 * (x * y + w * z), ww - xx + yy - zz, 2 * (y * z - w * x)),
            row(2 * (x * z - w * y), 2 * (y * z + w * x), ww - xx - yy + zz),
            Vec3::ZERO,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    const ULP: f64 = 1.0 / 65_536.0;

    fn vector(x: f32, y: f32, z: f32) -> Result<Vec3, FloatError> {
        Vec3::try_from(F32x3 { x, y, z })
    }

    /// Returns a generator of numbers in -1..1.
    fn numbers(seed: u64) -> impl FnMut() -> f32 {
        let mut rng = Rng::new(seed);
        move || 2.0 * rng.unit() as f32 - 1.0
    }

    #[test]
    fn components_are_rounded_to_nearest() {
        let mut next = numbers(1);
        for n in 0..10_000 {
            let value = next() * [1e-6, 1.0, 300.0, 32_767.0][n % 4];
            let bits = scalar(0, value).unwrap();
            let error = (f64::from(bits) * ULP - f64::from(value)).abs();
            assert!(error <= ULP / 2.0, "{value} became {bits}/65536");
            let bits = wide(0, value).unwrap();
            let error = (bits as f64 / 2f64.powi(32) - f64::from(value)).abs();
            assert!(error <= 2f64.powi(-33), "{value} became {bits}/2^32");
        }
    }

    #[test]
    fn ends_of_the_ranges() {
        assert_eq!(scalar(0, -32_768.0), Ok(i32::MIN));
        assert_eq!(scalar(0, 32_767.998), Ok(0x7FFF_FF80));
        assert_eq!(scalar(7, 32_768.0), Err(FloatError::OutOfRange { index: 7, value: 32_768.0 }));
        assert!(scalar(0, -32_768.004).is_err());
        assert_eq!(wide(0, 2_147_483_520.0), Ok(0x7FFF_FF80 << 32));
        assert!(wide(0, 2_147_483_648.0).is_err());
        assert!(wide(0, f32::MAX).is_err());
        for tiny in [0.0, -0.0, f32::MIN_POSITIVE, -f32::from_bits(1)] {
            assert_eq!((scalar(0, tiny), wide(0, tiny)), (Ok(0), Ok(0)));
        }
    }

    #[test]
    fn not_finite_components_are_named() {
        assert!(matches!(vector(0.0, f32::NAN, 0.0), Err(FloatError::NotFinite { index: 1, value }) if value.is_nan()));
        for value in [f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(vector(0.0, 0.0, value), Err(FloatError::NotFinite { index: 2, value }));
            let mut rows = [[0.0; 4]; 3];
            rows[1][3] = value;
            assert_eq!(Affine::try_from(rows), Err(FloatError::NotFinite { index: 7, value }));
            let mut rows = [[0.0; 4]; 4];
            rows[3][2] = value;
            assert_eq!(Projective::try_from(rows), Err(FloatError::NotFinite { index: 14, value }));
            let q = Quaternion::new(1.0, 0.0, 0.0, value);
            assert_eq!(Affine::try_from(q), Err(FloatError::NotFinite { index: 3, value }));
        }
        assert_eq!(Affine::try_from(Quaternion::new(0.0, -0.0, 0.0, 0.0)), Err(FloatError::ZeroQuaternion));
    }

    #[test]
    fn out_of_range_components_are_named() {
        let value = -1e6;
        let mut rows = [[0.0; 4]; 3];
        rows[2][0] = value;
        assert_eq!(Affine::try_from(rows), Err(FloatError::OutOfRange { index: 8, value }));
        let value = 1e10;
        let mut rows = [[0.0; 4]; 4];
        rows[2][3] = value;
        assert_eq!(Projective::try_from(rows), Err(FloatError::OutOfRange { index: 11, value }));
    }

    #[test]
    fn errors_say_which_and_what() {
        let error = vector(f32::NAN, 0.0, 0.0).unwrap_err();
        assert_eq!(std::format!("{error}"), "component 0 is NaN, not a finite number");
        let error = vector(0.0, 0.0, 40_000.0).unwrap_err();
        assert_eq!(std::format!("{error}"), "component 2 is 40000, out of range");
    }

    #[test]
    fn matrices_keep_their_entries_in_place() {
        let rows = [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0], [9.0, 10.0, 11.0, -12.5]];
        let affine = Affine::try_from(rows).unwrap();
        assert_eq!(affine.to_rows(), rows.map(|row| row.map(|v| (v * 65_536.0) as i32)));
        let rows = [rows[0], rows[1], rows[2], [0.0, 0.0, -1.0, 0.0]];
        let projective = Projective::try_from(rows).unwrap();
        assert_eq!(projective.to_rows(), rows.map(|row| row.map(|v| (f64::from(v) * 2f64.powi(32)) as i64)));
    }

    #[test]
    fn a_quarter_turn_is_exact() {
        let q = Quaternion::new(1.0, 0.0, 1.0, 0.0);
        assert_eq!(Affine::try_from(q), Ok(Affine::rotation_y(crate::math::Angle16::from_degrees(90))));
    }

    #[test]
    fn quaternions_of_any_length_are_within_2_to_minus_16() {
        let mut next = numbers(2);
        let mut worst = 0.0_f64;
        for n in 0..20_000 {
            let length = [1.0, 1e-30, 1e30, f32::MIN_POSITIVE, 1e38][n % 5];
            let squash = [1.0, 1e-3][n / 5 % 2];
            let q = [next(), next() * squash, next(), next()].map(|c| c * length);
            let Ok(found) = Affine::try_from(Quaternion::new(q[0], q[1], q[2], q[3])) else {
                assert_eq!(q, [0.0; 4]);
                continue;
            };
            let [w, x, y, z] = q.map(f64::from);
            let s = 2.0 / (w * w + x * x + y * y + z * z);
            let exact = [
                [1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
                [s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x)],
                [s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y)],
            ];
            for (row, exact) in found.to_rows().iter().zip(exact) {
                assert_eq!(row[3], 0);
                for (bits, exact) in row.iter().zip(exact) {
                    let error = (f64::from(*bits) * ULP - exact).abs();
                    assert!(error <= ULP, "{q:?}: {error} off");
                    worst = worst.max(error);
                }
            }
        }
        std::println!("worst entry is off by {:.3} of 2^-16", worst / ULP);
    }
}
