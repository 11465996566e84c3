//! Small triangles in pixels of several samples, as they are set up, and their edges at samples.
//!
//! The edges at a sample are parallel to those at the centre, so directions are divided once for all samples.

use crate::raster::{ShortEdge, ShortSlope, first_centre};
use core::ops::Range;

/// A small triangle that is set up.
pub(super) struct SampledTriangle {
    /// x and y of the corners on the left and on the right, relative to the highest one, 24.8.
    pub(super) sides: [i32; 4],
    /// The highest corner, 24.8.
    pub(super) a: (i32, i32),
    /// The first column and row that any sample may be in, and the column and row after the last ones.
    pub(super) place: (i32, i32),
    pub(super) past: (i32, i32),
    /// Depth at the highest corner, and its changes to the right and down.
    pub(super) depth: u32,
    pub(super) dz: (i32, i32),
}

/// The edges of a triangle, for all samples.
pub(super) struct Edges {
    /// Directions from the highest corner to those on the left and on the right, and between these.
    left: ShortSlope,
    right: ShortSlope,
    second: ShortSlope,
    /// The corner at the bend, relative to the highest one, 24.8, and whether it is on the right.
    bend: (i32, i32),
    bends_right: bool,
    /// The height of the triangle.
    height: i32,
    /// The highest corner, with x relative to the first column.
    a: (i32, i32),
}

/// The edges of a triangle that is moved for a sample, in some rows.
pub(super) struct Moved {
    pub(super) left: ShortEdge,
    pub(super) right: ShortEdge,
    /// The first row.
    pub(super) row: i32,
    /// Numbers of rows before the bend, which may be negative, and from there on.
    pub(super) count: i32,
    rest: i32,
    /// The edge from the bend on begins at this place, and this far above the first row at the bend.
    second: (i32, i32),
}

impl Edges {
    pub(super) fn new(triangle: &SampledTriangle) -> Self {
        let [bx, by, cx, cy] = triangle.sides;
        let bends_right = cy < by;
        let (bend, (dx, dy)) =
            if bends_right { ((cx, cy), (bx - cx, by - cy)) } else { ((bx, by), (cx - bx, cy - by)) };
        Self {
            left: ShortSlope::new(bx, by),
            right: ShortSlope::new(cx, cy),
            second: ShortSlope::new(dx, dy),
            bend,
            bends_right,
            height: by.max(cy),
            a: (triangle.a.0 - (triangle.place.0 << 8), triangle.a.1),
        }
    }

    /// Returns the edges in some rows, moved by `by` in 24.8; `None` if the triangle is in none of these rows.
    ///
    /// # Format
    /// A move is below 128: relative to the first column, x is in 0..62 · 2⁸.
    #[inline(always)]
    pub(super) fn moved(&self, by: (i32, i32), rows: &Range<i32>) -> Option<Moved> {
        let (x, y) = (self.a.0 + by.0, self.a.1 + by.1);
        let row = first_centre(y).max(rows.start);
        let end = first_centre(y + self.height).min(rows.end);
        if row >= end {
            return None;
        }
        let p = 256 * row + 128 - y;
        let count = first_centre(y + self.bend.1).min(end) - row;
        let second = (x + self.bend.0, p + 256 * count.max(0) - self.bend.1);
        let (left, right) = (self.left.edge(x, p), self.right.edge(x, p));
        Some(Moved { left, right, row, count, rest: end - row - count, second })
    }
}

impl Moved {
    /// Goes on to the rows from the bend on. Returns `None` if there are none.
    #[inline(always)]
    pub(super) fn bend(&mut self, edges: &Edges) -> Option<()> {
        if self.rest <= 0 {
            return None;
        }
        (self.count, self.rest) = (self.count + self.rest, 0);
        let (x, p) = self.second;
        let second = edges.second.edge(x, p);
        if edges.bends_right {
            self.right = second;
        } else {
            self.left = second;
        }
        Some(())
    }

    /// Goes one row down.
    #[inline(always)]
    pub(super) const fn step(&mut self) {
        self.left.step();
        self.right.step();
        self.count -= 1;
    }
}

impl SampledTriangle {
    /// Returns the depth of a sample at the first column and at a row.
    ///
    /// # Format
    /// As that of the moved triangle, bit for bit: from the vertex to the centre of its pixel, and from there on.
    #[inline(always)]
    pub(super) fn depth_at(&self, (x, y): (i32, i32), row: i32) -> u32 {
        let ((dx, dy), (ax, ay)) = (self.dz, (self.a.0 + x, self.a.1 + y));
        let to = (128 - (ax & 0xFF), 128 - (ay & 0xFF));
        let offset = ((dx >> 6) * to.0 + (dy >> 6) * to.1) >> 2;
        self.depth
            .wrapping_add(offset as u32)
            .wrapping_add_signed(dx.wrapping_mul(self.place.0 - (ax >> 8)))
            .wrapping_add_signed(dy.wrapping_mul(row - (ay >> 8)))
    }
}
