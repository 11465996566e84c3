//! Triangles → spans, row by row from the top.
//!
//! ```text
//!        a            a, b, c by height; the long edge goes from a to c, the short side bends at b. Rows whose centres
//!       / \           lie in a.y..b.y are between the long edge and ab, those in b.y..c.y between the long edge and bc:
//!      /   b          a centre on the upper end of an edge belongs to it, one on the lower end does not, which is the
//!     / ,-'           top-left rule for horizontal edges.
//!    c-'
//! ```

use super::Edge;
use crate::geometry::ScreenVertex;
use core::ops::Range;

/// A half-open rectangle of pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PixelRect {
    /// Columns.
    pub x: Range<i32>,
    /// Rows.
    pub y: Range<i32>,
}

impl PixelRect {
    /// Whether no pixel is in it.
    #[inline]
    pub const fn is_empty(&self) -> bool {
        self.x.start >= self.x.end || self.y.start >= self.y.end
    }

    /// The pixels that are in both.
    #[inline]
    pub fn intersection(&self, other: &Self) -> Self {
        Self {
            x: self.x.start.max(other.x.start)..self.x.end.min(other.x.end),
            y: self.y.start.max(other.y.start)..self.y.end.min(other.y.end),
        }
    }
}

/// The first pixel whose centre is at or behind a 24.8 coordinate.
#[inline]
pub const fn first_centre(coordinate: i32) -> i32 {
    (coordinate + 127) >> 8
}

/// The pixels whose centres lie in the bounding box of a triangle; no other can be covered.
#[inline]
pub fn pixel_rect(v: &[ScreenVertex; 3]) -> PixelRect {
    let [a, b, c] = v;
    PixelRect {
        x: first_centre(a.x.min(b.x).min(c.x))..first_centre(a.x.max(b.x).max(c.x)),
        y: first_centre(a.y.min(b.y).min(c.y))..first_centre(a.y.max(b.y).max(c.y)),
    }
}

/// Walks the spans of a triangle inside a rectangle from top to bottom: calls `span(y, columns)` for each that is not
/// empty.
///
/// `area` is the triangle's [`signed_area`](crate::geometry::signed_area), vertices are within ±32,767 px. Coverage is
/// exact: as if computed with infinite precision, with the top-left rule, for either winding.
///
/// ```
/// use zstrip::geometry::{ScreenVertex, signed_area};
/// use zstrip::raster::{PixelRect, spans};
/// let [a, b, c] = [[0, 0], [0, 2], [2, 0]].map(|[x, y]| ScreenVertex::new(x * 256, y * 256, 0));
/// let mut found = Vec::new();
/// spans(&[a, b, c], signed_area(&a, &b, &c), &PixelRect { x: 0..8, y: 0..8 }, |y, x| found.push((y, x)));
/// assert_eq!(found, [(0, 0..1)]);
/// ```
#[inline]
pub fn spans(v: &[ScreenVertex; 3], area: i64, clip: &PixelRect, mut span: impl FnMut(i32, Range<i32>)) {
    let outline = Outline::new(v, area, &clip.y);
    let (mut left, mut right) = (outline.left, outline.right);
    for y in outline.top..outline.end {
        if y == outline.bend {
            (left, right) = outline.below(left, right);
        }
        let x = left.pixel().max(clip.x.start)..right.pixel().min(clip.x.end);
        if x.start < x.end {
            span(y, x);
        }
        left.step();
        right.step();
    }
}

/// A triangle between its edges: those of the first row, and the one that takes the place of one of them at the bend.
#[derive(Debug)]
pub struct Outline {
    /// The first row.
    pub top: i32,
    /// The first row below the bend, if there are rows above it.
    pub bend: i32,
    /// The row behind the last.
    pub end: i32,
    /// The edges at the first row; both have to be stepped once a row.
    pub left: Edge,
    /// See `left`.
    pub right: Edge,
    /// The edge below the bend.
    short: Edge,
    /// Whether the bend is to the right of the long edge.
    bend_right: bool,
}

impl Outline {
    /// The rows of a triangle that are in `clip`. Other parameters are those of [`spans`].
    #[inline(never)]
    pub fn new(v: &[ScreenVertex; 3], area: i64, clip: &Range<i32>) -> Self {
        let [mut a, mut b, mut c] = v.each_ref();
        // The sign of the area, changed by each exchange.
        let mut bend_right = area > 0;
        if b.y < a.y {
            (a, b) = (b, a);
            bend_right = !bend_right;
        }
        if c.y < b.y {
            (b, c) = (c, b);
            bend_right = !bend_right;
            if b.y < a.y {
                (a, b) = (b, a);
                bend_right = !bend_right;
            }
        }
        let top = first_centre(a.y).max(clip.start);
        let end = if area == 0 { top } else { first_centre(c.y).min(clip.end) };
        if top >= end {
            // Edges from a point to itself are empty.
            (b, c) = (a, a);
        }
        let mut bend = first_centre(b.y);
        let first = if bend > top {
            (a, b)
        } else {
            bend = i32::MIN;
            (b, c)
        };
        let (left, right) = if bend_right { ((a, c), first) } else { (first, (a, c)) };
        Self {
            top,
            bend,
            end,
            left: Edge::new(left.0, left.1, top),
            right: Edge::new(right.0, right.1, top),
            short: if bend > top && bend < end { Edge::new(b, c, bend) } else { Edge::EMPTY },
            bend_right,
        }
    }

    /// The edges at the bend, from those that have been stepped down to it.
    #[inline(always)]
    pub fn below(&self, left: Edge, right: Edge) -> (Edge, Edge) {
        if self.bend_right { (left, self.short) } else { (self.short, right) }
    }
}
