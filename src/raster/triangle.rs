//! Triangles → spans: three vertices on the screen come in, and spans go out, row by row from the top.
//!
//! ```text
//!        a            a, b, c are sorted by height. The long edge goes from a to c, and the short side bends at b.
//!       / \           Rows whose centres lie in a.y..b.y are between the long edge and ab, and rows whose centres
//!      /   b          lie in b.y..c.y are between the long edge and bc. A centre on the upper end of an edge belongs
//!     / ,-'           to the edge, and a centre on the lower end does not: the top-left rule for horizontal edges.
//!    c-'
//! ```

use super::edge::Edge;
use super::samples::{first_centre, sampled};
use crate::vertex::ScreenVertex;
use core::ops::Range;
use embedded_graphics_core::primitives::Rectangle;

/// A half-open rectangle of pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PixelRect {
    /// Columns.
    pub x: Range<i32>,
    /// Rows.
    pub y: Range<i32>,
}

impl PixelRect {
    /// Returns the pixels of an area of embedded-graphics, cut at the ends of 32 bits.
    #[inline]
    pub fn of_area(area: &Rectangle) -> Self {
        let Rectangle { top_left, size } = *area;
        Self {
            x: top_left.x..top_left.x.saturating_add_unsigned(size.width),
            y: top_left.y..top_left.y.saturating_add_unsigned(size.height),
        }
    }

    /// Returns whether the rectangle has no pixels.
    #[inline]
    pub const fn is_empty(&self) -> bool {
        self.x.start >= self.x.end || self.y.start >= self.y.end
    }

    /// Returns the pixels that are in both rectangles.
    #[inline]
    pub fn intersection(&self, other: &Self) -> Self {
        Self {
            x: self.x.start.max(other.x.start)..self.x.end.min(other.x.end),
            y: self.y.start.max(other.y.start)..self.y.end.min(other.y.end),
        }
    }
}

/// Returns the pixels whose centres lie in the bounding box of a triangle or, with several samples per pixel, whose
/// samples may lie there. The triangle can cover no other pixels.
#[inline]
pub fn pixel_rect(v: &[ScreenVertex; 3], samples: usize) -> PixelRect {
    let [a, b, c] = v;
    PixelRect {
        x: sampled(a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x), samples),
        y: sampled(a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y), samples),
    }
}

/// Finds the spans of a triangle inside a rectangle, from top to bottom, and calls `span(y, columns)` for each span
/// that is not empty.
///
/// `area` is the triangle's [`signed_area`](crate::vertex::signed_area). Vertices are within ±32,767 px. Coverage is
/// exact, as if computed with infinite precision, with the top-left rule and for either winding.
///
/// ```
/// use zstrip::vertex::ScreenVertex;
/// use zstrip::internals::{PixelRect, signed_area, spans};
/// let [a, b, c] = [[0, 0], [0, 2], [2, 0]].map(|[x, y]| ScreenVertex::new(x * 256, y * 256, 0));
/// let mut found = Vec::new();
/// spans(&[a, b, c], signed_area(&a, &b, &c), &PixelRect { x: 0..8, y: 0..8 }, |y, x| found.push((y, x)));
/// assert_eq!(found, [(0, 0..1)]);
/// ```
#[inline]
pub fn spans(v: &[ScreenVertex; 3], area: i64, clip: &PixelRect, mut span: impl FnMut(i32, Range<i32>)) {
    let mut spans = Spans::new(v, area, &clip.y);
    while spans.next_in(&clip.x) {
        span(spans.y, spans.x.clone());
    }
}

/// The spans of a triangle, one by one. The whole state of the iteration is in this struct, and the temporaries of one
/// step are no longer on the stack while a span is drawn.
#[derive(Debug)]
pub struct Spans<'v> {
    outline: Outline<'v>,
    left: Edge,
    right: Edge,
    /// The span's row.
    pub y: i32,
    /// The span's columns.
    pub x: Range<i32>,
}

impl<'v> Spans<'v> {
    /// Starts ahead of the first span in the rows of `clip`. Other parameters are those of [`spans`].
    #[inline]
    pub fn new(v: &'v [ScreenVertex; 3], area: i64, clip: &Range<i32>) -> Self {
        let outline = Outline::new(v, area, clip);
        // Edges are made when their first row is reached.
        Self { y: outline.top.wrapping_sub(1), outline, left: Edge::EMPTY, right: Edge::EMPTY, x: 0..0 }
    }

    /// Goes on to the next span that is not empty in these columns, and returns whether there is one.
    #[inline(never)]
    pub fn next_in(&mut self, columns: &Range<i32>) -> bool {
        loop {
            self.y = self.y.wrapping_add(1);
            if self.y >= self.outline.end {
                return false;
            }
            let (top, bend) = (self.y == self.outline.top, self.y == self.outline.bend);
            if top || bend && !self.outline.bend_right {
                self.left = self.outline.side(false, self.y);
            }
            if top || bend && self.outline.bend_right {
                self.right = self.outline.side(true, self.y);
            }
            self.x = self.left.pixel().max(columns.start)..self.right.pixel().min(columns.end);
            self.left.step();
            self.right.step();
            if self.x.start < self.x.end {
                return true;
            }
        }
    }
}

/// The rows of a triangle, and its edges.
#[derive(Debug)]
pub struct Outline<'v> {
    /// The vertices, sorted by height.
    a: &'v ScreenVertex,
    b: &'v ScreenVertex,
    c: &'v ScreenVertex,
    /// The first row.
    pub top: i32,
    /// The first row below the bend, where a new edge replaces the short side's first edge; `i32::MIN` if no row is
    /// above it.
    pub bend: i32,
    /// The first row after the last.
    pub end: i32,
    /// Set if the bend is to the right of the long edge.
    pub bend_right: bool,
}

impl<'v> Outline<'v> {
    /// Finds the rows of a triangle that are in `clip`. Other parameters are those of [`spans`].
    #[inline(never)]
    pub fn new(v: &'v [ScreenVertex; 3], area: i64, clip: &Range<i32>) -> Self {
        let [mut a, mut b, mut c] = v.each_ref();
        // The sign of the area: each exchange of two vertices inverts it.
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
        let bend = first_centre(b.y);
        Self { a, b, c, top, bend: if bend > top { bend } else { i32::MIN }, end, bend_right }
    }

    /// Returns the edge on the left, or on the right, at a row. The caller has to step it once per row.
    #[inline(never)]
    pub fn side(&self, right: bool, row: i32) -> Edge {
        let (mut from, mut to) = (self.a, self.c);
        if right == self.bend_right {
            if row < self.bend {
                to = self.b;
            } else {
                from = self.b;
            }
        }
        Edge::new(from, to, row)
    }
}
