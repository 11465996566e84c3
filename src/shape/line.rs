//! Thick lines through given points, with joins, caps and dashes.
//!
//! Both sides of a segment, its caps, and the joins between segments are edges that make one contour, though they come
//! in another order. On the inner side of a join, sides end where they meet, so that the line covers nothing twice
//! there. If segments are too short for that, sides overlap, and go through the point; the fill rule unites them.
//!
//! ```text
//!       L ──────────────► L       the left side goes on, and the right side back: clockwise
//!                           `-.
//!    ─────────────────────P    L  a join, on the side that the line turns away from
//!                       /   \ /
//!       R ◄────────── R
//! ```

use super::arc::{Curve, Direction, times};
use super::round::{length, place};
use crate::math::{Pixels, leading_zeros, mul_high, mul_wide, reciprocal};
use crate::raster::unit;
use crate::scene::{Outline, Pen, Place, ScreenPoint};
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

/// Draws the sides of a thick line, from segment to segment.
struct Stroker<'s, 'p, 'm> {
    pen: &'s mut Pen<'p, 'm>,
    half: i64,
    join: Join,
    cap: Cap,
    limit: u32,
    /// Places where the left and the right side of the current segment begin.
    sides: [Place; 2],
}

fn plus(place: Place, change: Place) -> Place {
    [place[0] + change[0], place[1] + change[1]]
}

fn minus(place: Place, change: Place) -> Place {
    [place[0] - change[0], place[1] - change[1]]
}

impl Stroker<'_, '_, '_> {
    /// Returns the change from a point of a line to its left side.
    fn left(&self, [u, v]: Direction) -> Place {
        [times(self.half, v), -times(self.half, u)]
    }

    /// Returns how far from its points the line may reach: the corners of caps, or of miters, and 1 px.
    fn reach(&self) -> i64 {
        let times = if self.join == Join::Miter { 16 } else { 2 };
        times * self.half + (1 << 16)
    }

    /// Returns whether nothing of a segment, or of its ends, is in the rows that are drawn now.
    fn misses(&self, from: Place, to: Place) -> bool {
        let reach = self.reach();
        self.pen.misses(from[1].min(to[1]) - reach, from[1].max(to[1]) + reach)
    }

    /// Begins at a point, with a cap or where another part has ended.
    fn begin(&mut self, at: Place, way: Direction) {
        let back = way.map(|c| -c);
        self.sides = self.cap(at, back);
        self.sides.reverse();
    }

    /// Ends at a point.
    fn end(&mut self, at: Place, way: Direction) {
        let ends = self.cap(at, way);
        self.draw_sides(ends);
    }

    /// Draws the cap of a line that ends in a direction, and returns where its left and its right side end.
    fn cap(&mut self, at: Place, way: Direction) -> [Place; 2] {
        let left = self.left(way);
        let mut end = at;
        if self.cap == Cap::Square {
            end = plus(at, [times(self.half, way[0]), times(self.half, way[1])]);
        }
        let ends = [plus(end, left), minus(end, left)];
        let normal = [way[1], -way[0]];
        if self.cap == Cap::Round && !self.misses(at, at) {
            self.pen.jump(ends[0]);
            Curve::new(at, [self.half; 2]).arc(self.pen, normal, normal.map(|c| -c));
            self.pen.line_to_place(ends[1]);
        } else {
            self.pen.edge(ends[0], ends[1]);
        }
        ends
    }

    /// Draws the sides of a segment, which end where the next ones begin.
    fn draw_sides(&mut self, [left, right]: [Place; 2]) {
        self.pen.edge(self.sides[0], left);
        self.pen.edge(right, self.sides[1]);
    }

    /// Finds where the sides of two segments end and begin at their common point. On the inner side, that is where they
    /// meet, if it is at most `room` from the point along both.
    fn corner(&self, at: Place, before: Direction, after: Direction, room: i64) -> Corner {
        let [mut ends, mut starts] = [before, after].map(|way| {
            let left = self.left(way);
            [plus(at, left), minus(at, left)]
        });
        let [[a, b], [c, d]] = [before, after];
        let turn = mul_wide(a, d) - mul_wide(b, c);
        let ahead = (mul_wide(a, c) + mul_wide(b, d)) >> 30;
        // The cosine and 1, in 2.30.
        let sum = (ahead + (1 << 30)).max(0) as u32;
        let turns_right = turn >= 0;
        // Sides meet at the sum of both changes to them over 1 + cosine: on the outer side, away from the point.
        let both = if turns_right {
            minus(plus(ends[0], starts[0]), plus(at, at))
        } else {
            minus(plus(ends[1], starts[1]), plus(at, at))
        };
        let sine = (turn >> 30).unsigned_abs().min(1 << 30) as i32;
        // Along the segments, they meet at half the width times sine / (1 + cosine), 0 or more. Where a line nearly
        // turns back, at 1 + cosine below 1/64, directions of 2.30 are not exact enough for that.
        let [along, _] = over([times(self.half, sine), 0], sum);
        let meets = sum >= 1 << 24 && along <= room;
        if meets {
            let meeting = minus(at, over(both, sum));
            if turns_right {
                (ends[1], starts[1]) = (meeting, meeting);
            } else {
                (ends[0], starts[0]) = (meeting, meeting);
            }
        }
        // (Miter length / width)² = 2 / (1 + cosine).
        let has_miter = self.join == Join::Miter && u64::from(sum) * u64::from(self.limit) >= 2 << 38;
        let miter = has_miter.then(|| plus(at, over(both, sum)));
        let is_straight = turn == 0 && ahead >= 0;
        Corner { ends, starts, turns_right, meets, is_straight, miter }
    }

    /// Draws a join between two segments, and the sides of the first one.
    fn join(&mut self, at: Place, before: Direction, after: Direction, room: i64) {
        let Corner { ends, starts, turns_right, meets, is_straight, miter } = self.corner(at, before, after, room);
        if !meets && turns_right {
            self.pen.edge(starts[1], at);
            self.pen.edge(at, ends[1]);
        } else if !meets {
            self.pen.edge(ends[0], at);
            self.pen.edge(at, starts[0]);
        }
        // Clockwise: on the left, from the first segment to the second one, and back on the right.
        let (first, second) = if turns_right { (ends[0], starts[0]) } else { (starts[1], ends[1]) };
        self.pen.jump(first);
        if !is_straight && !self.misses(at, at) {
            let [[a, b], [c, d]] = [before, after];
            match (self.join, miter) {
                (Join::Round, _) => {
                    let [from, to] = if turns_right { [[b, -a], [d, -c]] } else { [[-d, c], [-b, a]] };
                    Curve::new(at, [self.half; 2]).arc(self.pen, from, to);
                }
                (Join::Miter, Some(miter)) => self.pen.line_to_place(miter),
                _ => {}
            }
        }
        self.pen.line_to_place(second);
        self.draw_sides(ends);
        self.sides = starts;
    }
}

/// A point of a line where two segments meet: where their left and right sides end and begin there.
struct Corner {
    ends: [Place; 2],
    starts: [Place; 2],
    /// Set if the left side is the outer one.
    turns_right: bool,
    /// Set if the inner sides end where they meet.
    meets: bool,
    is_straight: bool,
    /// Place where the outer sides meet, if that is within the miter limit.
    miter: Option<Place>,
}

/// Divides a change of place, below 2²⁷, by 1 + cosine, 2.30; at most 2³² for quotients that are larger.
fn over(change: Place, sum: u32) -> Place {
    let shift = leading_zeros(sum | 1) & 31;
    let inverse = reciprocal((sum | 1) << shift);
    change.map(|c| {
        let quotient = u64::from(mul_high((c.unsigned_abs() as u32) << 5, inverse)) << shift >> 6;
        let quotient = quotient.min(1 << 32) as i64;
        if c < 0 { -quotient } else { quotient }
    })
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
    /// Draws a segment dash by dash. The first dash goes on from the segment before, if `goes_on` says so; and the last
    /// one goes on, unless the line `ends`.
    fn dash(&mut self, dashes: &mut Dashes<'_>, segment: &Segment, mut goes_on: bool, ends: bool) {
        let all = segment.length;
        let mut near = segment.near(self.pen.area(), self.reach());
        let mut done = 0;
        while done < all {
            // A dash that has begun is drawn to its end, wherever that is.
            if !goes_on && done > near.end {
                dashes.skip(all - done);
                if dashes.goes_on() {
                    // It begins out of sight.
                    self.begin(segment.at(all), segment.way);
                }
                return;
            }
            if !goes_on && done < near.start && near.start < all {
                let begun = dashes.length() - dashes.left;
                dashes.skip(near.start - done);
                // Back to the beginning of the dash or gap, so that a dash is the same in every strip.
                let back = dashes.length() - dashes.left;
                if back <= near.start - done {
                    done = near.start - back;
                    dashes.left += back;
                } else {
                    dashes.left = dashes.length() - begun;
                }
                near.start = 0;
            }
            let ended = dashes.left <= all - done;
            let end = if ended { done + dashes.left } else { all };
            if dashes.drawn {
                if !goes_on {
                    self.begin(segment.at(done), segment.way);
                }
                if ended || ends {
                    self.end(segment.at(end), segment.way);
                }
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
        let (half, join, cap, limit) = (self.half(), self.join, self.cap, self.limit);
        let mut stroker = Stroker { pen, half, join, cap, limit, sides: [first; 2] };
        let dashes = Dashes::new(self.pattern, self.offset);
        if dashes.are_dashes() {
            self.trace_dashes(&mut stroker, dashes);
        } else if self.points.iter().any(|point| place(*point) != first) {
            self.trace_sides(&mut stroker);
        } else if cap != Cap::Butt {
            stroker.begin(first, [1 << 30, 0]);
            stroker.end(first, [1 << 30, 0]);
        }
        // The sides are edges by themselves, and no contour is open.
        stroker.pen.jump(first);
    }
}
