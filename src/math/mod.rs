//! The numbers: fixed-point formats, binary angles, vectors, matrices, reciprocals, inverse roots and powers.
//!
//! Everything here is exact integer arithmetic with a stated rounding; most of it is `const`.

mod affine;
mod angle;
mod division;
mod error;
mod exponential;
mod format;
mod inverse_sqrt;
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
pub use exponential::exp_negative;
pub use format::{Pixels, Scalar, Wide};
pub use inverse_sqrt::{inverse_sqrt, unit_vector};
#[cfg(feature = "micromath")]
pub use micromath::FloatError;
pub use precision::{DepthPrecision, PrecisionError};
pub use projective::Projective;
pub use reciprocal::{CoarseDivisor, Divisor, ShortDivisor, mul_high, mul_high_apart, mul_high_signed, reciprocal};
pub(crate) use reciprocal::{SMALL_CORE, byte_zeros, leading_zeros, leading_zeros_long, product};
pub use root::isqrt;
pub use vector::Vec3;
