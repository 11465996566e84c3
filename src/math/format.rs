//! The fixed-point formats of the public interface, named once.

use fixed::types::{I16F16, I24F8, I32F32};

/// Object and world coordinates, lengths, factors: 16.16, -32768 to 32767.99998 in steps of 2⁻¹⁶.
pub type Scalar = I16F16;

/// Entries of a [`Projective`](crate::math::Projective) matrix: 32.32.
pub type Wide = I32F32;

/// Positions and lengths on the screen, in pixels: 24.8, that is whole pixels and 256ths of one, ±8,388,607.99.
///
/// Drawing is exact within ±32,767 px of the screen's top left corner. Whole pixels are written `Pixels::from_num(3)`, in
/// constants `Pixels::const_from_int(3)`; a pixel and a half is `Pixels::from_bits(384)`.
pub type Pixels = I24F8;
