//! Grey pixels: three channels are one quantity, their luma, and interpolated as one.

/// Luma of red, green and blue with the weights of BT.601 in 1/256 (77, 150, 29), cut.
#[inline(always)]
pub const fn luma([r, g, b]: [u8; 3]) -> u8 {
    ((77 * r as u32 + 150 * g as u32 + 29 * b as u32) >> 8) as u8
}
