//! Unit vectors in 2.14, the format of normals.

/// The number 1 in the 2.14 format of normals.
pub const NORMAL_ONE: i16 = 1 << 14;

/// The number 1 in 2.14.
pub(super) const ONE: i32 = NORMAL_ONE as i32;

/// Converts a vector of 16-bit components to 32 bits.
#[inline(always)]
pub(crate) const fn long([x, y, z]: [i16; 3]) -> [i32; 3] {
    [x as i32, y as i32, z as i32]
}

/// Returns n · l of two unit vectors, cut to 2.14; 0 if they are more than a right angle apart.
///
/// # Format
/// Components of `n` are in -2¹⁵..2¹⁵, those of `l` at most 2¹⁴ and a little: the sum is below 2³¹.
#[inline(always)]
pub(super) fn cosine(n: [i32; 3], l: [i32; 3]) -> i32 {
    let dot = n[0].wrapping_mul(l[0]).wrapping_add(n[1].wrapping_mul(l[1])).wrapping_add(n[2].wrapping_mul(l[2]));
    (dot >> 14).clamp(0, ONE)
}
