//! Sides of a thick line: segments, corners and ends come in, and edges go out.
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
use crate::math::{leading_zeros, mul_high, mul_wide, reciprocal};
use crate::raster::unit;
use crate::scene::{Pen, Place};

/// Form of the corners of a thick line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Join {
    /// Sides go on to where they meet, up to the line's [miter limit](crate::shape::Polyline::with_miter_limit);
    /// beyond it, corners are beveled.
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

/// Returns the direction and the length, 16.16 px, of a segment; `None` if it has no length.
pub(super) fn way(from: Place, to: Place) -> Option<(Direction, i64)> {
    let (x, y) = (to[0] - from[0], to[1] - from[1]);
    let (mut dx, mut dy) = (x, y);
    // Components of up to 2⁴¹ become such of up to 2²⁵. Short ones keep all bits.
    while dx.unsigned_abs().max(dy.unsigned_abs()) >= 1 << 25 {
        (dx, dy) = (dx >> 1, dy >> 1);
    }
    let (u, v) = unit(dx as i32, dy as i32);
    if (u, v) == (0, 0) { None } else { Some(([u, v], times(x, u) + times(y, v))) }
}

/// Returns how far from its points a line may reach: to the corners of caps or miters, and 1 px.
pub(super) fn reach(half: i64, join: Join, limit: u32) -> i64 {
    let times = if join == Join::Miter { i64::from(limit.max(2)) } else { 2 };
    times * half + (1 << 16)
}

/// Draws the sides of a thick line, from segment to segment.
pub(super) struct Stroker<'s, 'p, 'm> {
    pub(super) pen: &'s mut Pen<'p, 'm>,
    half: i64,
    /// Circle of round caps and joins, around any point.
    round: Curve,
    join: Join,
    cap: Cap,
    limit: u32,
    /// Distance from the line's points to the corners of caps or miters at most, and 1 px.
    reach: i64,
    /// Places where the left and the right side of the current segment begin.
    pub(super) sides: [Place; 2],
}

fn plus(place: Place, change: Place) -> Place {
    [place[0] + change[0], place[1] + change[1]]
}

fn minus(place: Place, change: Place) -> Place {
    [place[0] - change[0], place[1] - change[1]]
}

impl<'s, 'p, 'm> Stroker<'s, 'p, 'm> {
    /// Makes a stroker for half of a width in 16.16 px, and a miter limit from 0 to 16.
    pub(super) fn new(pen: &'s mut Pen<'p, 'm>, half: i64, join: Join, cap: Cap, limit: u32) -> Self {
        let is_round = join == Join::Round || cap == Cap::Round;
        let round = Curve::new([0; 2], [if is_round { half } else { 0 }; 2]);
        Self { pen, half, round, join, cap, limit, reach: reach(half, join, limit), sides: [[0; 2]; 2] }
    }
}

impl Stroker<'_, '_, '_> {
    /// Returns the change from a point of a line to its left side.
    fn left(&self, [u, v]: Direction) -> Place {
        [times(self.half, v), -times(self.half, u)]
    }

    /// Returns how far from the line between its ends a dash may reach, and how far beyond them, with 1 px more for
    /// both.
    pub(super) fn reach_of_dash(&self) -> (i64, i64) {
        let beyond = if self.cap == Cap::Butt { 0 } else { self.half };
        (self.half + (1 << 16), beyond + (1 << 16))
    }

    /// Returns whether nothing of a segment, or of its ends, is in the rows that are drawn now.
    pub(super) fn misses(&self, from: Place, to: Place) -> bool {
        self.pen.misses(from[1].min(to[1]) - self.reach, from[1].max(to[1]) + self.reach)
    }

    /// Begins at a point, with a cap or where another part has ended.
    pub(super) fn begin(&mut self, at: Place, way: Direction) {
        let back = way.map(|c| -c);
        self.sides = self.cap(at, back);
        self.sides.reverse();
    }

    /// Ends at a point.
    pub(super) fn end(&mut self, at: Place, way: Direction) {
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
            self.round.around(at).arc(self.pen, normal, normal.map(|c| -c));
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
    pub(super) fn corner(&self, at: Place, before: Direction, after: Direction, room: i64) -> Corner {
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
        let has_miter = self.join == Join::Miter && u64::from(sum) * u64::from(self.limit * self.limit) >= 2 << 30;
        let miter = has_miter.then(|| plus(at, over(both, sum)));
        let is_straight = turn == 0 && ahead >= 0;
        Corner { ends, starts, turns_right, meets, is_straight, miter }
    }

    /// Draws a join between two segments, and the sides of the first one.
    pub(super) fn join(&mut self, at: Place, before: Direction, after: Direction, room: i64) {
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
                    self.round.around(at).arc(self.pen, from, to);
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
pub(super) struct Corner {
    ends: [Place; 2],
    pub(super) starts: [Place; 2],
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
