//! Areas → runs of pixels: outlines come in, for as many rows at a time as there is memory for, and runs of pixels that
//! are covered alike, or each to a part of its own, go out, row by row from the top.
//!
//! An outline is traced once per band of rows. Where its edges in the band do not fit the memory, the band loses its
//! last rows while the outline is traced, down to a single row. A row with too many edges is cut into parts of a half,
//! a quarter ... of its height, whose covered parts add up. Where so many edges cross one height that even 1/256 of a
//! row has too many, the places where they cross it are found, as many at a time as fit. So any memory will do for any
//! outline.

use super::area_cells::{Cells, start_and_end};
use super::area_edge::{AreaEdge, AreaEdges, EDGE_WORDS, Wanted};
use super::area_row::{FillRule, Row};
use super::triangle::PixelRect;

/// Height of the smallest part of a row, 1/256 px: that of a unit of [`Pixels`](crate::math::Pixels).
const LEAST_PART: i32 = 256;

/// Number of edges up to which insertion is the faster way to sort them.
const FEW_EDGES: usize = 8;

/// Most edges of a band: their numbers have 16 bits in the order of edges.
const MOST_EDGES: usize = 0xFFFF;

/// Fewest edges that areas take.
pub(crate) const LEAST_EDGES: usize = 4;

/// Memory in which areas are made: edges, their order, and the cells of a row.
#[derive(Debug)]
pub(crate) struct AreaMemory<'m> {
    edges: &'m mut [AreaEdge],
    order: &'m mut [u32],
    cover: &'m mut [i32],
    ranges: &'m mut [u32],
}

/// Returns the words for rows of `width` pixels and a number of edges.
pub(crate) const fn area_words(width: usize, edges: usize) -> usize {
    let cells = width.saturating_add(1);
    cells.saturating_add(cells.div_ceil(16)).saturating_add(edges.saturating_mul(EDGE_WORDS + 1))
}

impl<'m> AreaMemory<'m> {
    /// Shares words out: cells for rows of `width` pixels, and edges with the rest. `None` if they are too few.
    pub(crate) fn new(words: &'m mut [u32], width: usize) -> Option<Self> {
        let cells = width.checked_add(1)?;
        let (cover, words) = words.split_at_mut_checked(cells)?;
        let (ranges, words) = words.split_at_mut_checked(cells.div_ceil(16))?;
        let edges = (words.len() / (EDGE_WORDS + 1)).min(MOST_EDGES);
        if edges < LEAST_EDGES {
            return None;
        }
        let (order, words) = words.split_at_mut_checked(edges)?;
        let edges = bytemuck::try_cast_slice_mut(words.get_mut(..edges * EDGE_WORDS)?).ok()?;
        let cover = bytemuck::try_cast_slice_mut(cover).ok()?;
        cover.fill(0);
        Some(Self { edges, order, cover, ranges })
    }

    /// Begins an area that is drawn in a rectangle.
    pub(crate) fn area(&mut self, rect: &PixelRect, rule: FillRule, kind: Contours) -> Area<'_> {
        let Self { edges, order, cover, ranges } = self;
        let order_len = order.len().min(1 << 14) as i32;
        let width = (cover.len() as i32 - 1).min(rect.x.end.wrapping_sub(rect.x.start)).max(0);
        Area {
            edges: AreaEdges {
                edges,
                count: 0,
                overflowed: false,
                upright: true,
                top: 0,
                bottom: 0,
                left: rect.x.start << 16,
                right: (rect.x.start + width) << 16,
                wanted: Wanted::Rows,
            },
            order,
            cells: Cells { cover, ranges, count: 0, left: rect.x.start, width },
            rule,
            kind,
            row: rect.y.start,
            end: rect.y.end,
            // Most outlines have fewer than 4 edges per row.
            rows: (order_len >> 2).max(1).min(rect.y.end - rect.y.start),
            part: 0..0,
            winding: 0,
            active: 0,
            waiting: 0,
            band_end: rect.y.start,
            scanning: false,
            scanned: 0,
            range: 0,
            sum: 0,
            varied: 0..0,
        }
    }
}

/// Kinds of outlines, by how their contours lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Contours {
    /// One convex contour.
    Convex,
    /// Contours that neither cross nor touch, with winding numbers of 0 and 1, or 0 and -1.
    Apart,
    Any,
}

/// An area that is being drawn. Its owner calls [`begin_band`](Self::begin_band), traces the outline into
/// [`edges`](Self::edges), calls [`end_band`](Self::end_band), and takes all runs, until there is no band any more.
pub(crate) struct Area<'a> {
    pub(crate) edges: AreaEdges<'a>,
    /// Numbers of the edges in the current row, and from `waiting` on, of those below it, with the rows they begin in.
    order: &'a mut [u32],
    cells: Cells<'a>,
    rule: FillRule,
    kind: Contours,
    /// The current row, the end of all rows, and the number of rows of a band.
    row: i32,
    end: i32,
    rows: i32,
    /// Heights in the row that the current part is between; empty if edges of whole rows are wanted.
    part: core::ops::Range<i32>,
    /// Winding number after the crossings so far.
    winding: i32,
    active: usize,
    waiting: usize,
    band_end: i32,
    /// Set while the current row has runs left.
    scanning: bool,
    /// Column up to which the row is scanned, from the first one on, the next range of cells, and the covered part
    /// there.
    scanned: i32,
    range: usize,
    sum: i32,
    /// Columns of the last run of varied parts, whose cells are not cleared yet.
    varied: core::ops::Range<i32>,
}

/// Pixels side by side in a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    pub(crate) y: i32,
    pub(crate) x: core::ops::Range<i32>,
    /// Covered part of each pixel, 256 for all of it; `None` if each has its own, see [`Area::parts`].
    pub(crate) part: Option<u32>,
}

/// Rounds a covered part from 2⁻¹⁶ to 256ths.
#[inline(always)]
const fn part(sum: i32) -> u32 {
    let part = sum.unsigned_abs();
    let part = if part > 1 << 16 { 1 << 16 } else { part };
    (part + 128) >> 8
}

impl<'a> Area<'a> {
    /// Returns the first column after those that this area draws.
    pub(crate) const fn right(&self) -> i32 {
        self.cells.left + self.cells.width
    }

    /// Begins the next band, and returns whether there is one.
    #[inline(never)]
    pub(crate) fn begin_band(&mut self) -> bool {
        if self.row >= self.end || self.cells.width <= 0 {
            return false;
        }
        let edges = &mut self.edges;
        (edges.count, edges.overflowed, edges.upright) = (0, false, true);
        if edges.wanted == Wanted::Rows {
            self.rows = self.rows.min(self.end - self.row).max(1);
            (edges.top, edges.bottom) = (self.row << 16, (self.row + self.rows) << 16);
        } else {
            (edges.top, edges.bottom) = ((self.row << 16) + self.part.start, (self.row << 16) + self.part.end);
        }
        true
    }

    /// Ends the tracing of a band. Without enough memory for one row, the next band is a part of it, and has no runs.
    #[inline(never)]
    pub(crate) fn end_band(&mut self) {
        self.scanning = false;
        (self.active, self.waiting) = (0, 0);
        match self.edges.wanted {
            Wanted::Rows if self.edges.overflowed => {
                self.edges.wanted = Wanted::Part;
                self.part = 0..1 << 15;
            }
            Wanted::Rows => {
                self.band_end = self.edges.bottom >> 16;
                self.rows = self.band_end - self.row;
                // Twice as many rows may well have twice as many edges.
                if self.edges.count < self.edges.edges.len() / 2 {
                    self.rows = self.rows.saturating_mul(2);
                }
                self.sort();
            }
            Wanted::Part if self.edges.overflowed => {
                let height = self.part.end - self.part.start;
                if height > LEAST_PART && !self.edges.upright {
                    self.part.end = self.part.start + (height >> 1);
                } else {
                    self.edges.wanted = Wanted::Crossings { after: i32::MIN };
                    self.winding = 0;
                }
            }
            Wanted::Part => {
                self.active = self.edges.count;
                for (k, number) in self.order.iter_mut().enumerate() {
                    *number = k as u32;
                }
                let (from, to) = (self.part.start, self.part.end);
                self.in_row().fill(from, to);
                self.cells.add_all();
                self.next_part();
            }
            Wanted::Crossings { .. } => {
                let (height, mut winding) = (self.part.end - self.part.start, self.winding);
                let last = self.edges.count.checked_sub(1).and_then(|last| self.edges.edges.get(last));
                let after = last.map_or(i32::MAX, |edge| edge.x);
                self.in_row().crossings(height, &mut winding);
                self.cells.add_all();
                self.winding = winding;
                if self.edges.overflowed {
                    self.edges.wanted = Wanted::Crossings { after };
                } else {
                    self.edges.wanted = Wanted::Part;
                    self.next_part();
                }
            }
        }
    }

    /// Moves on to the next part of the row; after the last one, the row is done.
    fn next_part(&mut self) {
        let height = self.part.end - self.part.start;
        self.part = self.part.end..self.part.end + height;
        if self.part.start >= 1 << 16 {
            self.edges.wanted = Wanted::Rows;
            self.begin_scan();
            (self.active, self.edges.count) = (0, 0);
            self.band_end = self.row + 1;
            self.rows = 1;
        }
    }

    /// Returns the edges of the current row.
    fn in_row(&mut self) -> Row<'_, 'a> {
        let Self { edges: AreaEdges { edges, count, .. }, order, cells, rule, row, active, .. } = self;
        Row {
            edges: edges.get_mut(..*count).unwrap_or_default(),
            order: order.get_mut(..*active).unwrap_or_default(),
            cells,
            top: *row << 16,
            rule: *rule,
        }
    }

    /// Sorts edges by the rows that they begin in, and by their numbers: a few by insertion, many by Shell's method,
    /// with gaps of 2ⁿ - 1. Outlines go up and down, so that half of their edges are in order. A row of the band is in
    /// the upper half of a word, and a number in the lower one.
    fn sort(&mut self) {
        let AreaEdges { edges, count, top, .. } = &self.edges;
        let count = *count;
        let Some(order) = self.order.get_mut(..count) else { return };
        for (k, (place, edge)) in order.iter_mut().zip(edges.iter()).enumerate() {
            *place = (edge.top.wrapping_sub(*top).max(0) as u32 >> 16) << 16 | k as u32;
        }
        let mut gap = 1;
        while count > FEW_EDGES && 2 * gap + 1 < count {
            gap = 2 * gap + 1;
        }
        while gap > 0 {
            for k in gap..count {
                let Some(own) = order.get(k).copied() else { return };
                let mut at = k;
                while let Some(previous) = at.checked_sub(gap).and_then(|at| order.get(at)).copied() {
                    if previous <= own {
                        break;
                    }
                    if let Some(place) = order.get_mut(at) {
                        *place = previous;
                    }
                    at -= gap;
                }
                if let Some(place) = order.get_mut(at) {
                    *place = own;
                }
            }
            gap >>= 1;
        }
    }

    /// Returns the next run of pixels that are covered at all; `None` after the last one of the band.
    #[inline(never)]
    pub(crate) fn next_run(&mut self) -> Option<Run> {
        loop {
            if self.scanning {
                if let Some(run) = self.scan() {
                    return Some(run);
                }
                self.scanning = false;
                self.row += 1;
            }
            // Without a band of rows, edges have no order.
            if self.row < self.band_end && self.active == 0 {
                self.row = self.next_row().max(self.row);
            }
            if self.row >= self.band_end {
                return None;
            }
            self.fill_row();
            self.begin_scan();
        }
    }

    /// Returns the row that the next edge begins in, or the end of the band.
    fn next_row(&self) -> i32 {
        let next = self.order.get(self.waiting).filter(|_| self.waiting < self.edges.count);
        next.map_or(self.band_end, |word| (self.edges.top >> 16) + (word >> 16) as i32)
    }

    fn begin_scan(&mut self) {
        (self.scanning, self.scanned, self.sum, self.varied) = (true, 0, 0, 0..0);
        self.range = 0;
    }

    /// Fills the cells of the current row, and moves its edges on.
    #[inline(never)]
    fn fill_row(&mut self) {
        let bottom = (self.row + 1) << 16;
        // The first word of the rows below.
        let below = ((self.row + 1 - (self.edges.top >> 16)) as u32) << 16;
        while let Some(next) = self.order.get(self.waiting).copied().filter(|_| self.waiting < self.edges.count) {
            if next >= below && below > 0 {
                break;
            }
            if let Some(place) = self.order.get_mut(self.active) {
                *place = next & 0xFFFF;
            }
            self.active += 1;
            self.waiting += 1;
        }
        match self.kind {
            Contours::Convex => self.in_row().fill_convex(),
            Contours::Apart => self.in_row().fill_apart(),
            Contours::Any => self.in_row().fill(0, 1 << 16),
        }
        let mut kept = 0;
        for k in 0..self.active {
            let Some(number) = self.order.get(k).copied() else { break };
            let Some(edge) = self.edges.edges.get_mut(number as usize) else { break };
            if edge.bottom > bottom {
                edge.step();
                if let Some(place) = self.order.get_mut(kept) {
                    *place = number;
                }
                kept += 1;
            }
        }
        self.active = kept;
    }

    /// Returns the next run of the current row; `None` after the last one. Cells are cleared on the way.
    #[inline(always)]
    fn scan(&mut self) -> Option<Run> {
        let Cells { cover, ranges, count, left, width } = &mut self.cells;
        if let Some(cells) = cover.get_mut(self.varied.start as usize..self.varied.end as usize) {
            for cell in cells {
                *cell = 0;
            }
        }
        let range = ranges.get(self.range).copied().filter(|_| self.range < *count);
        let (start, end) = range.map_or((*width, *width), start_and_end);
        let first = self.scanned;
        if first < start {
            (self.scanned, self.varied) = (start, 0..0);
            let part = part(self.sum);
            if part > 0 {
                return Some(Run { y: self.row, x: *left + first..*left + start, part: Some(part) });
            }
        }
        if start < end {
            let mut sum = self.sum;
            for cell in cover.get_mut(start as usize..end as usize).unwrap_or_default() {
                sum = sum.wrapping_add(*cell);
                *cell = part(sum) as i32;
            }
            (self.scanned, self.sum, self.varied) = (end, sum, start..end);
            self.range += 1;
            return Some(Run { y: self.row, x: *left + start..*left + end, part: None });
        }
        *count = 0;
        if let Some(cell) = cover.get_mut(*width as usize) {
            *cell = 0;
        }
        None
    }

    /// Returns the covered parts of the pixels of a run in which they vary, 0 to 256 each.
    #[inline]
    pub(crate) fn parts(&self, run: &Run) -> &[i32] {
        let at = |x: i32| (x - self.cells.left) as usize;
        self.cells.cover.get(at(run.x.start)..at(run.x.end)).unwrap_or_default()
    }
}
