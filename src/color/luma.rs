//! Luma of a colour: the one quantity that grey pixels keep of three channels, and that is interpolated in their place.

/// Computes the luma of red, green and blue with the weights of BT.601 in 1/256 (77, 150, 29); the fraction is cut.
#[inline(always)]
pub const fn luma([r, g, b]: [u8; 3]) -> u8 {
    ((77 * r as u32 + 150 * g as u32 + 29 * b as u32) >> 8) as u8
}
