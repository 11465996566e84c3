//! Fixed-point numbers, binary angles, vectors and matrices. A program meets [`Scalar`] first, a number of 16.16;
//! models are placed by [`Affine`], cameras made by [`Projective::perspective`].
//!
//! Everything here is integer arithmetic with a stated rounding; most of it is `const`. Vectors and matrices
//! saturate. A `Scalar`'s own operators overflow as integers do: they panic where overflow checks are on (debug
//! builds) and wrap where they are off (release builds); [`SaturatingScalar`] does neither.

mod affine;
mod angle;
mod division;
mod error;
mod exponential;
mod format;
mod inverse_sqrt;
mod long;
#[cfg(feature = "micromath")]
mod micromath;
mod precision;
mod projective;
/// The tests' generator of random numbers.
#[cfg(test)]
#[path = "../../tests/reference/rng.rs"]
#[allow(dead_code, reason = "the crate's own tests use only part of it")]
pub(crate) mod random;
mod reciprocal;
mod root;
mod vector;

pub use affine::Affine;
pub use angle::Angle16;
pub(crate) use division::{divide, divide_modulo, divided};
pub use error::ProjectionError;
pub(crate) use exponential::exp_negative;
pub use format::{Pixels, SaturatingScalar, Scalar, Wide};
pub(crate) use inverse_sqrt::{inverse_sqrt, unit_vector, unit_vector_of_any_length};
#[cfg(feature = "micromath")]
pub use micromath::FloatError;
pub use precision::{DepthPrecision, PrecisionError};
pub use projective::Projective;
pub(crate) use reciprocal::{
    CoarseDivisor, Divisor, SMALL_CORE, ShortDivisor, byte_zeros, leading_zeros, leading_zeros_long, mul_high,
    mul_high_outlined, mul_high_signed, mul_long, mul_wide, reciprocal,
};
pub(crate) use root::isqrt;
pub use vector::Vec3;
