//! Thick lines through given points, with joins, caps and dashes: segments are handed to a stroker, which draws the
//! sides.

use super::arc::Direction;
use super::dashes::{Dashes, Segment};
use super::round::{around_all, length, place};
use super::stroker::{Cap, Join, Stroker, reach, way};
use crate::math::Pixels;
use crate::scene::{Outline, Pen, Place, ScreenPoint};
use embedded_graphics_core::primitives::Rectangle;

/// A thick line through points, open or closed.
///
/// ```
/// use zstrip::ScreenPoint;
/// use zstrip::math::Pixels;
/// use zstrip::shape::{Cap, Join, Polyline};
/// let points = [(10, 50), (30, 20), (50, 40), (70, 10)].map(|(x, y)| ScreenPoint::center(x, y));
/// let plot = Polyline::new(&points, Pixels::from_num(2.5)).with_join(Join::Round).with_cap(Cap::Round);
/// // Dashes of 6 px and gaps of 4 px run on around corners.
/// let pattern = [6, 4].map(Pixels::from_num::<i32>);
/// let dashed = Polyline::new(&points, Pixels::from_num(2)).with_dashes(&pattern, Pixels::ZERO);
/// # let _ = (plot, dashed);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polyline<'a> {
    points: &'a [ScreenPoint],
    width: Pixels,
    join: Join,
    cap: Cap,
    closed: bool,
    /// Miter limit, from 0 to 16.
    limit: u32,
    pattern: &'a [Pixels],
    offset: Pixels,
}

/// Width of the widest line, 2048 px in 16.16.
const WIDEST: i64 = 2048 << 16;

impl<'a> Polyline<'a> {
    /// Makes an open line of a width up to 2048 px. Larger widths become 2048 px.
    #[must_use]
    pub const fn new(points: &'a [ScreenPoint], width: Pixels) -> Self {
        Self {
            points,
            width,
            join: Join::Miter,
            cap: Cap::Butt,
            closed: false,
            limit: 4,
            pattern: &[],
            offset: Pixels::ZERO,
        }
    }

    /// Returns the line with one more segment, from the last point to the first, and no ends.
    #[must_use]
    pub const fn closed(self) -> Self {
        Self { closed: true, ..self }
    }

    /// Returns the line with other joins.
    #[must_use]
    pub const fn with_join(self, join: Join) -> Self {
        Self { join, ..self }
    }

    /// Returns the line with other caps.
    #[must_use]
    pub const fn with_cap(self, cap: Cap) -> Self {
        Self { cap, ..self }
    }

    /// Returns the line with another miter limit, from 1 to 16: the greatest ratio of a miter's length to the line's
    /// width. It is 4 unless set. Larger limits become 16, and at 0 no corner has a miter.
    #[must_use]
    pub const fn with_miter_limit(self, limit: u8) -> Self {
        let limit = if limit > 16 { 16 } else { limit as u32 };
        Self { limit, ..self }
    }

    /// Returns the line in dashes: lengths that are drawn and left out by turns, over and over along the whole line.
    /// The pattern begins `offset` px before the line's first point. A pattern without gaps, or whose sum is below
    /// 1/64 px, draws the whole line; negative lengths are 0.
    ///
    /// Only dashes that may be seen are drawn. Rows with more edges of them than the buffer holds take many times as
    /// long: those of dashes of less than a pixel on a slanted line that is much wider.
    #[must_use]
    pub const fn with_dashes(self, pattern: &'a [Pixels], offset: Pixels) -> Self {
        Self { pattern, offset, ..self }
    }

    fn half(&self) -> i64 {
        length(self.width).min(WIDEST) >> 1
    }
}

impl Polyline<'_> {
    /// Draws a line with dashes.
    fn trace_dashes(&self, stroker: &mut Stroker<'_, '_, '_>, mut dashes: Dashes<'_>) {
        let mut waiting = None::<Segment>;
        let mut goes_on = false;
        self.each_segment(|from, to| {
            let Some((way, length)) = way(from, to) else { return };
            if let Some(segment) = waiting {
                stroker.dash(&mut dashes, &segment, goes_on, false);
                goes_on = dashes.goes_on();
                if goes_on {
                    let room = segment.length.min(length).min(dashes.left).min(dashes.length() - dashes.left) >> 1;
                    stroker.join(from, segment.way, way, room);
                }
            }
            waiting = Some(Segment { from, way, length });
        });
        if let Some(segment) = waiting {
            stroker.dash(&mut dashes, &segment, goes_on, true);
        }
    }

    /// Draws a line without dashes. Directions are computed for the segments in the rows that are drawn now, and for
    /// their neighbours.
    fn trace_sides(&self, stroker: &mut Stroker<'_, '_, '_>) {
        // The previous segment, its direction and length if they are known, and whether it is out of the rows.
        let mut previous = None::<(Place, Place, Option<(Direction, i64)>, bool)>;
        let mut first = None;
        if self.closed {
            // The last segment comes before the first one.
            self.each_segment(|from, to| previous = Some((from, to, None, true)));
            if let Some((from, to, known, _)) = &mut previous {
                *known = way(*from, *to);
            }
        }
        self.each_segment(|from, to| {
            let missed = stroker.misses(from, to);
            let mut known = None;
            match previous {
                None => {
                    known = way(from, to);
                    if let Some((way, _)) = known {
                        stroker.begin(from, way);
                    }
                }
                Some((_, _, _, true)) if missed && first.is_some() => {}
                Some((a, b, before, _)) => {
                    known = way(from, to);
                    if let (Some((way, length)), Some((before, other))) = (known, before.or_else(|| self::way(a, b))) {
                        let room = length.min(other) >> 1;
                        if first.is_some() {
                            stroker.join(from, before, way, room);
                        } else {
                            // The join of a closed line's ends is drawn with its last segment.
                            stroker.sides = stroker.corner(from, before, way, room).starts;
                        }
                    }
                }
            }
            first = first.or(known);
            previous = Some((from, to, known, missed));
        });
        let Some((from, to, known, _)) = previous else { return };
        let Some((last, length)) = known.or_else(|| way(from, to)) else { return };
        match first {
            Some((first, other)) if self.closed => stroker.join(to, last, first, length.min(other) >> 1),
            _ => stroker.end(to, last),
        }
    }

    /// Hands over each segment that has a length.
    fn each_segment(&self, mut segment: impl FnMut(Place, Place)) {
        let Some(first) = self.points.first().copied().map(place) else { return };
        let mut at = first;
        let rest = self.points.get(1..).unwrap_or_default().iter().copied().map(place);
        for to in rest.chain(self.closed.then_some(first)) {
            if to != at {
                segment(at, to);
                at = to;
            }
        }
    }
}

impl Outline for Polyline<'_> {
    fn trace(&self, pen: &mut Pen<'_, '_>) {
        let Some(first) = self.points.first().copied().map(place) else { return };
        let mut stroker = Stroker::new(pen, self.half(), self.join, self.cap, self.limit);
        let dashes = Dashes::new(self.pattern, self.offset);
        if dashes.are_dashes() {
            self.trace_dashes(&mut stroker, dashes);
        } else if self.points.iter().any(|point| place(*point) != first) {
            self.trace_sides(&mut stroker);
        } else if self.cap != Cap::Butt {
            stroker.begin(first, [1 << 30, 0]);
            stroker.end(first, [1 << 30, 0]);
        }
        // The sides are edges by themselves, and no contour is open.
        stroker.pen.jump(first);
    }

    fn bounds(&self) -> Option<Rectangle> {
        let reach = reach(self.half(), self.join, self.limit);
        around_all(self.points.iter().copied().map(place), reach)
    }
}
