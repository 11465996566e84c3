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
    pub fn is_empty(&self) -> bool {
        self.x.is_empty() || self.y.is_empty()
    }

    /// The pixels that are in both.
    pub fn intersection(&self, other: &Self) -> Self {
        Self {
            x: self.x.start.max(other.x.start)..self.x.end.min(other.x.end),
            y: self.y.start.max(other.y.start)..self.y.end.min(other.y.end),
        }
    }
}

/// The first pixel whose centre is at or behind a 24.8 coordinate.
#[inline]
const fn first_centre(coordinate: i32) -> i32 {
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

/// A row of covered pixels, never empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Span {
    /// Row.
    pub y: i32,
    /// Columns.
    pub x: Range<i32>,
}

/// Walks the spans of a triangle inside a rectangle from top to bottom.
///
/// Coverage is exact: as if computed with infinite precision, with the top-left rule, for either winding.
///
/// ```
/// use zstrip::geometry::ScreenVertex;
/// use zstrip::raster::{PixelRect, Span, Spans};
/// let corner = |x, y| ScreenVertex::new(x * 256, y * 256, 0);
/// let spans = Spans::new(&[corner(0, 0), corner(0, 2), corner(2, 0)], &PixelRect { x: 0..8, y: 0..8 });
/// assert!(spans.eq([Span { y: 0, x: 0..1 }]));
/// ```
#[derive(Clone, Debug)]
pub struct Spans {
    /// The long edge, and the current part of the short side.
    long: Edge,
    short: Edge,
    /// Second part of the short side: where it starts and ends.
    bend: ((i32, i32), (i32, i32)),
    long_is_left: bool,
    row: i32,
    /// First row of the second part.
    bend_row: i32,
    end_row: i32,
    columns: Range<i32>,
}

impl Spans {
    /// The spans of a triangle with vertices within ±32,767 px, clipped to a rectangle.
    pub fn new(v: &[ScreenVertex; 3], clip: &PixelRect) -> Self {
        let [mut a, mut b, mut c] = v.map(|v| (v.x, v.y));
        if b.1 < a.1 {
            (a, b) = (b, a);
        }
        if c.1 < b.1 {
            (b, c) = (c, b);
            if b.1 < a.1 {
                (a, b) = (b, a);
            }
        }
        // Which side of the long edge the bend is on: the sign of the area of a b c.
        let area = crate::geometry::signed_area(
            &ScreenVertex::new(a.0, a.1, 0),
            &ScreenVertex::new(b.0, b.1, 0),
            &ScreenVertex::new(c.0, c.1, 0),
        );
        let row = first_centre(a.1).max(clip.y.start);
        let end_row = first_centre(c.1).min(clip.y.end);
        let mut spans = Self {
            long: Edge::EMPTY,
            short: Edge::EMPTY,
            bend: (b, c),
            long_is_left: area > 0,
            row,
            bend_row: first_centre(b.1),
            end_row: if area == 0 { row } else { end_row },
            columns: clip.x.clone(),
        };
        if spans.row < spans.end_row {
            spans.long = Edge::new(a, c, row);
            spans.short = if row < spans.bend_row {
                Edge::new(a, b, row)
            } else {
                Edge::new(b, c, row)
            };
        }
        spans
    }
}

impl Iterator for Spans {
    type Item = Span;

    #[inline]
    fn next(&mut self) -> Option<Span> {
        while self.row < self.end_row {
            let y = self.row;
            let (long, short) = (self.long.pixel(), self.short.pixel());
            let (left, right) = if self.long_is_left {
                (long, short)
            } else {
                (short, long)
            };
            self.row += 1;
            self.long.step();
            if self.row != self.bend_row {
                self.short.step();
            } else if self.row < self.end_row {
                self.short = Edge::new(self.bend.0, self.bend.1, self.row);
            }
            let x = left.max(self.columns.start)..right.min(self.columns.end);
            if x.start < x.end {
                return Some(Span { y, x });
            }
        }
        None
    }
}
