//! The fixed-point formats of the public interface, named once.

use fixed::types::{I16F16, I32F32};

/// Object and world coordinates, lengths, factors: 16.16, -32768 to 32767.99998 in steps of 2⁻¹⁶.
pub type Scalar = I16F16;

/// Entries of a [`Projective`](crate::math::Projective) matrix: 32.32.
pub type Wide = I32F32;
