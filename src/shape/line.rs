//! Thick lines through given points, with joins, caps and dashes.
//!
//! Each segment is a contour of its own, with its caps, and so is the outer side of each join. All of them go round
//! clockwise, and overlap; the fill rule unites them.
//!
//! ```text
//!       L ─────────────── L       a segment, and the join after it: a wedge around the point
//!       │                 │ `-.
//!    ───┼─────────────────P    L  on the side that the line turns away from
//!       │                 │ \ /
//!       R ─────────────── R
//! ```

use super::arc::{Curve, Direction, times};
use super::round::{length, place};
use crate::math::{Pixels, divide, mul_wide};
use crate::raster::unit;
use crate::scene::{Outline, Pen, Place, ScreenPoint};
use core::num::NonZeroU32;
use core::ops::Range;

/// Form of the corners of a thick line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Join {
    /// Sides go on to where they meet, up to the line's [miter limit](Polyline::with_miter_limit); beyond it, corners
    /// are beveled.
    #[default]
    Miter,
    /// Corners are round.
    Round,
    /// Corners are cut off straight.
    Bevel,
}

/// Form of the ends of a thick line, and of its dashes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cap {
    /// A line ends at its end.
    #[default]
    Butt,
    /// A half disc is added.
    Round,
    /// Half a square is added.
    Square,
}

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
    /// Square of the miter limit, in 24.8.
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
            limit: 16 << 8,
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
    /// width. It is 4 unless set.
    #[must_use]
    pub const fn with_miter_limit(self, limit: u8) -> Self {
        let limit = if limit > 16 { 16 } else { limit as u32 };
        Self { limit: (limit * limit) << 8, ..self }
    }

    /// Returns the line in dashes: lengths that are drawn and left out by turns, over and over along the whole line.
    /// The pattern begins `offset` px before the line's first point. A pattern whose sum is below 1/64 px draws the
    /// whole line; negative lengths are 0.
    #[must_use]
    pub const fn with_dashes(self, pattern: &'a [Pixels], offset: Pixels) -> Self {
        Self { pattern, offset, ..self }
    }

    fn half(&self) -> i64 {
        length(self.width).min(WIDEST) >> 1
    }
}

/// Returns the direction and the length, 16.16 px, of a segment; `None` if it has no length.
fn way(from: Place, to: Place) -> Option<(Direction, i64)> {
    let (x, y) = (to[0] - from[0], to[1] - from[1]);
    let (mut dx, mut dy) = (x, y);
    // Components of up to 2⁴¹ become such of up to 2²⁵. Short ones keep all bits.
    while dx.unsigned_abs().max(dy.unsigned_abs()) >= 1 << 25 {
        (dx, dy) = (dx >> 1, dy >> 1);
    }
    let (u, v) = unit(dx as i32, dy as i32);
    if (u, v) == (0, 0) { None } else { Some(([u, v], times(x, u) + times(y, v))) }
}

/// Draws the parts of a thick line.
struct Stroker<'s, 'p, 'm> {
    pen: &'s mut Pen<'p, 'm>,
    half: i64,
    join: Join,
    cap: Cap,
    limit: u32,
}

impl Stroker<'_, '_, '_> {
    /// Returns the change from a point of a line to its left side.
    fn left(&self, [u, v]: Direction) -> Place {
        [times(self.half, v), -times(self.half, u)]
    }

    /// Returns how far from its points the line may reach.
    fn reach(&self) -> i64 {
        // Twice the half width, for the corners of square caps, and 1 px.
        2 * self.half + (1 << 16)
    }

    /// Draws a part of a segment, with caps at its ends or without.
    fn segment(&mut self, from: Place, to: Place, way: Direction, caps: [bool; 2]) {
        let (low, high) = (from[1].min(to[1]), from[1].max(to[1]));
        if self.pen.misses(low - self.reach(), high + self.reach()) {
            return;
        }
        let left = self.left(way);
        let side = |p: Place, sign: i64| [p[0] + sign * left[0], p[1] + sign * left[1]];
        let square = |p: Place, sign: i64| {
            let longer = [times(self.half, way[0]), times(self.half, way[1])];
            [p[0] + sign * longer[0], p[1] + sign * longer[1]]
        };
        let [capped, end_capped] = caps.map(|capped| capped && self.cap != Cap::Butt);
        let (from, start) = match self.cap {
            Cap::Square if capped => (square(from, -1), from),
            _ => (from, from),
        };
        let (to, end) = match self.cap {
            Cap::Square if end_capped => (square(to, 1), to),
            _ => (to, to),
        };
        let normal = [-way[1], way[0]];
        self.pen.move_to_place(side(from, -1));
        if capped && self.cap == Cap::Round {
            Curve::new(start, [self.half; 2]).arc(self.pen, normal, normal.map(|c| -c));
        }
        self.pen.line_to_place(side(from, 1));
        self.pen.line_to_place(side(to, 1));
        if end_capped && self.cap == Cap::Round {
            Curve::new(end, [self.half; 2]).arc(self.pen, normal.map(|c| -c), normal);
        }
        self.pen.line_to_place(side(to, -1));
    }

    /// Draws the outer side of a join between two segments.
    fn join(&mut self, at: Place, before: Direction, after: Direction) {
        // A miter reaches 16 half widths at most.
        let reach = 16 * self.half + (1 << 16);
        if self.pen.misses(at[1] - reach, at[1] + reach) {
            return;
        }
        let [[a, b], [c, d]] = [before, after];
        let turn = mul_wide(a, d) - mul_wide(b, c);
        let ahead = (mul_wide(a, c) + mul_wide(b, d)) >> 30;
        if turn == 0 && ahead >= 0 {
            return;
        }
        let (before, after) = (self.left(before), self.left(after));
        // Clockwise, so the wedge of a line that turns left begins at the segment after it.
        let (first, second) = if turn >= 0 { (before, after) } else { (after.map(|c| -c), before.map(|c| -c)) };
        let plus = |change: Place| [at[0] + change[0], at[1] + change[1]];
        self.pen.move_to_place(at);
        self.pen.line_to_place(plus(first));
        match self.join {
            Join::Round => {
                let directions = if turn >= 0 { [[b, -a], [d, -c]] } else { [[-d, c], [-b, a]] };
                Curve::new(at, [self.half; 2]).arc(self.pen, directions[0], directions[1]);
            }
            Join::Miter => {
                // (Miter length / width)² = 2 / (1 + cosine); the sum below is the cosine and 1, in 2.30.
                let sum = (ahead + (1 << 30)).max(0) as u32;
                let limit = u64::from(sum) * u64::from(self.limit);
                if let (true, Some(divisor)) = (limit >= 2 << 38, NonZeroU32::new(sum >> 1)) {
                    // The sides meet at (first + second) / (1 + cosine); the quotient is at most 2³⁰.
                    let ratio = |change: i64| {
                        let (quotient, _) = divide(change.unsigned_abs() << 29, divisor);
                        if change < 0 { -i64::from(quotient) } else { i64::from(quotient) }
                    };
                    self.pen.line_to_place(plus([ratio(first[0] + second[0]), ratio(first[1] + second[1])]));
                }
            }
            Join::Bevel => {}
        }
        self.pen.line_to_place(plus(second));
    }
}

/// Place in a pattern of dashes.
#[derive(Clone, Copy)]
struct Dashes<'a> {
    pattern: &'a [Pixels],
    /// Sum of the pattern's lengths, twice if they are odd in number, 16.16 px.
    all: i64,
    at: usize,
    /// Set if the current length is drawn; and what is left of it, 16.16 px.
    drawn: bool,
    left: i64,
}

impl<'a> Dashes<'a> {
    /// Begins a pattern; without one, a dash without end.
    fn new(pattern: &'a [Pixels], offset: Pixels) -> Self {
        let sum: i64 = pattern.iter().fold(0, |sum, part| sum.saturating_add(length(*part)));
        if sum < 1 << 10 {
            return Self { pattern: &[], all: i64::MAX, at: 0, drawn: true, left: i64::MAX };
        }
        let all = if pattern.len().is_multiple_of(2) { sum } else { 2 * sum };
        let mut dashes = Self { pattern, all, at: 0, drawn: true, left: 0 };
        dashes.left = dashes.length();
        dashes.skip((i64::from(offset.to_bits()) << 8).checked_rem_euclid(all).unwrap_or(0));
        dashes
    }

    /// Returns whether there are any gaps.
    fn are_dashes(&self) -> bool {
        !self.pattern.is_empty()
    }

    /// Returns whether a dash that has begun goes on here.
    fn goes_on(&self) -> bool {
        !self.are_dashes() || self.drawn && self.left < self.length()
    }

    fn length(&self) -> i64 {
        self.pattern.get(self.at).map_or(i64::MAX, |part| length(*part))
    }

    /// Moves on to the next length.
    fn next(&mut self) {
        self.at += 1;
        if self.at >= self.pattern.len() {
            self.at = 0;
        }
        self.drawn = !self.drawn;
        self.left = self.length();
    }

    /// Moves on by a distance.
    fn skip(&mut self, distance: i64) {
        let mut rest = if distance < self.all { distance } else { distance.checked_rem(self.all).unwrap_or(0) };
        while rest >= self.left {
            rest -= self.left;
            self.next();
        }
        self.left -= rest;
    }
}

/// A segment of a line: its start, its direction and its length, 16.16 px.
#[derive(Clone, Copy)]
struct Segment {
    from: Place,
    way: Direction,
    length: i64,
}

impl Segment {
    fn at(&self, distance: i64) -> Place {
        [self.from[0] + times(distance, self.way[0]), self.from[1] + times(distance, self.way[1])]
    }

    /// Returns a part of the segment that holds all of it that is up to `reach` away from an area. The segments of a
    /// plot may be far longer than the screen, and have any number of dashes.
    fn near(&self, area: [Range<i64>; 2], reach: i64) -> Range<i64> {
        let mut near = 0..self.length;
        for (k, range) in area.into_iter().enumerate() {
            let (start, change) = if k == 0 { (self.from[0], self.way[0]) } else { (self.from[1], self.way[1]) };
            let (first, last) = (range.start - reach - start, range.end + reach - start);
            let (first, last) = if change >= 0 { (first, last) } else { (-last, -first) };
            // In 2.22, below 2⁻¹² off. Along a coordinate that hardly changes, nothing is left out.
            let divisor = i64::from(change.unsigned_abs() >> 8);
            if divisor >= 1 << 12 {
                // Distances in 16.16 px are below 2⁴⁰.
                let distance = |way: i64| (way << 22).checked_div(divisor).unwrap_or(0);
                let (first, last) = (distance(first), distance(last));
                near.start = near.start.max(first - (first.abs() >> 10) - (1 << 16));
                near.end = near.end.min(last + (last.abs() >> 10) + (1 << 16));
            }
        }
        near
    }
}

impl Stroker<'_, '_, '_> {
    /// Draws a segment dash by dash. The first dash goes on from the segment before, if `goes_on` says so; the last one
    /// is capped if the line `ends`.
    fn dash(&mut self, dashes: &mut Dashes<'_>, segment: &Segment, mut goes_on: bool, ends: bool) {
        let all = segment.length;
        if !dashes.are_dashes() {
            return self.segment(segment.from, segment.at(all), segment.way, [!goes_on, ends]);
        }
        let near = segment.near(self.pen.area(), self.reach());
        let mut done = 0;
        if near.start > 0 && near.start < all {
            let begun = dashes.length() - dashes.left;
            dashes.skip(near.start);
            // Back to the beginning of the dash or gap, so that a dash is the same in every strip.
            let back = dashes.length() - dashes.left;
            if back <= near.start {
                (done, goes_on) = (near.start - back, false);
                dashes.left += back;
            } else {
                dashes.left = dashes.length() - begun;
            }
        }
        while done < all {
            if done > near.end {
                dashes.skip(all - done);
                return;
            }
            let ended = dashes.left <= all - done;
            let end = if ended { done + dashes.left } else { all };
            if dashes.drawn {
                let caps = [!goes_on, ended || ends];
                self.segment(segment.at(done), segment.at(end), segment.way, caps);
            }
            goes_on = false;
            if ended {
                dashes.next();
            } else {
                dashes.left -= end - done;
            }
            done = end;
        }
    }
}

impl Outline for Polyline<'_> {
    fn trace(&self, pen: &mut Pen<'_, '_>) {
        let mut dashes = Dashes::new(self.pattern, self.offset);
        let mut stroker = Stroker { pen, half: self.half(), join: self.join, cap: self.cap, limit: self.limit };
        let Some(first) = self.points.first().copied().map(place) else { return };
        let meets = self.closed && !dashes.are_dashes();
        let mut goes_on = meets;
        // A segment waits until it is known whether it is the last one.
        let (mut waiting, mut first_way, mut at) = (None::<Segment>, None, first);
        let last = self.closed.then_some(first);
        let rest = self.points.get(1..).unwrap_or_default().iter().copied().map(place);
        for to in rest.chain(last) {
            let Some((way, length)) = way(at, to) else { continue };
            if let Some(segment) = waiting {
                stroker.dash(&mut dashes, &segment, goes_on, false);
                goes_on = dashes.goes_on();
                if goes_on {
                    stroker.join(at, segment.way, way);
                }
            }
            first_way = first_way.or(Some(way));
            waiting = Some(Segment { from: at, way, length });
            at = to;
        }
        match (waiting, first_way) {
            (Some(segment), Some(way)) => {
                stroker.dash(&mut dashes, &segment, goes_on, !meets);
                if meets {
                    stroker.join(at, segment.way, way);
                }
            }
            // All points are one.
            _ if self.cap != Cap::Butt => stroker.segment(at, at, [1 << 30, 0], [true; 2]),
            _ => {}
        }
    }
}
