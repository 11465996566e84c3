//! Hierarchical traversal by blocks of 8×8 pixels: three vertices on the screen come in, and blocks with the pixels
//! that are covered go out, block by block from the top left.
//!
//! ```text
//!   +--------+   An edge function changes by a constant per column and per row. So it is greatest in a block at the
//!   | L   /  |   corner that is farthest along the edge's normal, and least at the opposite corner.
//!   |    /   |   If a function is negative at its greatest, no pixel of the block is covered: trivial reject.
//!   |   /    |   If no function is negative at its least, all pixels are: trivial accept.
//!   |  /   G |   Otherwise the block's pixels are looked at, one by one.
//!   +--------+   Here, an edge has its inside on the right: its function is greatest at G, and least at L.
//! ```
//! Blocks begin at columns and rows that are multiples of 8, wherever the rectangle begins.

use super::edge_function::{EdgeFunctions, Number, is_short, looked_at};
use super::triangle::PixelRect;
use crate::vertex::ScreenVertex;

/// Columns, and rows, of a block.
const SIDE: i32 = 8;

/// A block of 8×8 pixels, and which of them a triangle covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// The first column, a multiple of 8.
    pub x: i32,
    /// The first row, a multiple of 8.
    pub y: i32,
    /// Covered pixels of each row; bit 0 is the first column.
    pub rows: [u8; SIDE as usize],
}

impl Block {
    /// Returns whether all pixels are covered.
    #[inline]
    pub fn is_whole(&self) -> bool {
        self.rows == [0xFF; SIDE as usize]
    }
}

/// Finds the blocks of 8×8 pixels in which a triangle covers pixels inside of a rectangle, and calls `block` for each.
///
/// Takes the parameters of [`spans`](super::spans), and covers its pixels.
///
/// ```
/// use zstrip::vertex::ScreenVertex;
/// use zstrip::internals::{Block, PixelRect, blocks, signed_area};
/// let [a, b, c] = [[0, 0], [0, 3], [3, 0]].map(|[x, y]| ScreenVertex::new(x * 256, y * 256, 0));
/// let mut found = Vec::new();
/// blocks(&[a, b, c], signed_area(&a, &b, &c), &PixelRect { x: 0..8, y: 0..8 }, |block| found.push(*block));
/// assert_eq!(found, [Block { x: 0, y: 0, rows: [0b11, 0b1, 0, 0, 0, 0, 0, 0] }]);
/// ```
#[inline]
pub fn blocks(v: &[ScreenVertex; 3], area: i64, clip: &PixelRect, mut block: impl FnMut(&Block)) {
    let Some(rect) = looked_at(v, area, 1, clip) else { return };
    if is_short(v) {
        walk::<i32>(v, area, &rect, &mut block);
    } else {
        walk::<i64>(v, area, &rect, &mut block);
    }
}

#[inline(always)]
fn walk<T: Number>(v: &[ScreenVertex; 3], area: i64, rect: &PixelRect, found: &mut impl FnMut(&Block)) {
    let (left, top) = (rect.x.start & -SIDE, rect.y.start & -SIDE);
    let EdgeFunctions { mut at, right, down, .. } = EdgeFunctions::<T>::new(v, area > 0, (left, top));
    // From a block's first pixel to the corners at which functions are greatest and least, and to the next block.
    let (across, along) = (right.times(SIDE - 1), down.times(SIDE - 1));
    let greatest = across.only(|change| !change.is_negative()).plus(&along.only(|change| !change.is_negative()));
    let least = across.only(Number::is_negative).plus(&along.only(Number::is_negative));
    let (next, next_row) = (right.times(SIDE), down.times(SIDE));
    let mut y = top;
    while y < rect.y.end {
        let (mut corner, mut x) = (at, left);
        let mut any = false;
        while x < rect.x.end {
            if corner.plus(&greatest).covers() {
                let mut block = Block { x, y, rows: [0xFF; SIDE as usize] };
                if !corner.plus(&least).covers() {
                    let mut row = corner;
                    for bits in &mut block.rows {
                        let (mut pixel, mut covered) = (row, 0);
                        for k in 0..SIDE {
                            covered |= u8::from(pixel.covers()) << k;
                            pixel.add(&right);
                        }
                        *bits = covered;
                        row.add(&down);
                    }
                }
                if x < rect.x.start || x + SIDE > rect.x.end || y < rect.y.start || y + SIDE > rect.y.end {
                    cut(&mut block, rect);
                }
                if block.rows != [0; SIDE as usize] {
                    found(&block);
                }
                any = true;
            } else if any {
                // The blocks that are not rejected are next to each other.
                break;
            }
            corner.add(&next);
            x += SIDE;
        }
        at.add(&next_row);
        y += SIDE;
    }
}

/// Leaves only the pixels of a block that are in a rectangle.
#[inline(never)]
fn cut(block: &mut Block, rect: &PixelRect) {
    let before = (rect.x.start - block.x).clamp(0, SIDE);
    let after = (block.x + SIDE - rect.x.end).clamp(0, SIDE);
    let columns = ((0xFF_u32 << before) & (0xFF >> after)) as u8;
    for (y, bits) in (block.y..).zip(&mut block.rows) {
        *bits = if rect.y.contains(&y) { *bits & columns } else { 0 };
    }
}
