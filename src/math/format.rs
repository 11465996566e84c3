//! The fixed-point formats of the public interface, named once.

use fixed::types::{I16F16, I24F8, I32F32};

/// Object and world coordinates, lengths and factors: 16.16, from -32768 to 32767.99998 in steps of 2⁻¹⁶.
///
/// Its operators are those of the crate `fixed`, and overflow as integers do. A sum, difference or product that does
/// not fit panics where overflow checks are on (debug builds), and wraps where they are off (release builds).
/// Division by 0 panics in both. [`Vec3`](crate::math::Vec3), [`Affine`](crate::math::Affine),
/// [`Projective`](crate::math::Projective) and [`SaturatingScalar`] saturate instead. `Scalar::checked_add` and its
/// kind return `None`.
pub type Scalar = I16F16;

/// A [`Scalar`] whose operators saturate: a sum beyond ±32,768 stops there, with no panic and no wrong sign.
///
/// ```
/// use zstrip::fixed::Saturating;
/// use zstrip::math::{SaturatingScalar, Scalar};
/// let speed: SaturatingScalar = Saturating(Scalar::from_num(20_000));
/// assert_eq!((speed + speed).0, Scalar::MAX);
/// ```
pub type SaturatingScalar = fixed::Saturating<Scalar>;

/// Entries of a [`Projective`](crate::math::Projective) matrix: 32.32.
pub type Wide = I32F32;

/// Positions and lengths on the screen, in pixels: 24.8, which is whole pixels and 256ths of a pixel, within
/// ±8,388,607.99.
///
/// Drawing is exact within ±32,767 px of the screen's top left corner. Write whole pixels as `Pixels::from_num(3)`,
/// in constants as `Pixels::const_from_int(3)`, and a pixel and a half as `Pixels::from_bits(384)`.
pub type Pixels = I24F8;
