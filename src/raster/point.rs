//! Points → squares of pixels: a centre and a side come in, and a rectangle of pixels goes out.

use super::triangle::PixelRect;

/// Returns the pixels of a square: the pixels whose centres are inside of it, or on its left or top side.
///
/// ```
/// use zstrip::internals::{PixelRect, square};
/// assert_eq!(square((512, 512), 512), PixelRect { x: 1..3, y: 1..3 });
/// assert!(square((512, 512), 0).is_empty());
/// ```
///
/// # Format
/// The centre is in 24.8, at most ±32,767 px, and `side` in 24.8, up to 65,535 px. The result is exact: it holds the
/// centres in x - `side` / 2..x + `side` / 2. Coordinates are doubled, to below 2²⁶, so that `side` / 2 loses no bit.
#[inline]
pub const fn square(center: (i32, i32), side: u32) -> PixelRect {
    let side = (if side > 1 << 24 { 1 << 24 } else { side }) as i32;
    // The first pixel whose centre, 256 p + 128, is not less than c / 2.
    const fn first(c: i32) -> i32 {
        (c + 255) >> 9
    }
    PixelRect {
        x: first(2 * center.0 - side)..first(2 * center.0 + side),
        y: first(2 * center.1 - side)..first(2 * center.1 + side),
    }
}

/// Returns the pixels of a square as [`square`] does, wherever its centre is and however large it is.
pub const fn wide_square(center: (i32, i32), side: u32) -> PixelRect {
    const fn first(c: i64) -> i32 {
        // The sum of three numbers of 32 bits, divided by 2⁹, fits 32 bits.
        ((c + 255) >> 9) as i32
    }
    let (x, y, side) = (2 * center.0 as i64, 2 * center.1 as i64, side as i64);
    PixelRect { x: first(x - side)..first(x + side), y: first(y - side)..first(y + side) }
}
