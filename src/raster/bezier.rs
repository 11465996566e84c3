//! Bézier curves → chords: control points come in, and the ends of chords go out, piece by piece.
//!
//! A curve of the third degree at most is cut into 2ⁿ chords of equal steps of t, which begin and end on it but for a
//! small shift. With M, the largest second derivative, a chord between two points of the curve is at most M / 8 · 4⁻ⁿ
//! away from it. So n is the least number for which that distance is 1/64 px or less.
//!
//! ```text
//!        .-"""-.            a chord's ends are moved towards the outside by half of that distance:
//!      /_________\          so half of it is missing in the middle of a chord, and as much is too much at its ends
//! ```
//!
//! The points of a piece of 16 chords are found by three differences, in additions alone. Pieces above and below the
//! rows that are drawn are one line each.

/// Largest n. All curves whose control points are within ±32,767 px take 12 or less: there, M is at most 6 · 4 · 2¹⁵
/// px.
const MOST: u32 = 12;

/// Chords of a piece, as a power of two.
const PIECE: u32 = 4;

type Place = [i64; 2];

/// One coordinate of a curve: at + c t + b t² + a t³, in 16.16 px.
#[derive(Clone, Copy, Debug)]
struct Axis {
    at: i64,
    c: i64,
    b: i64,
    a: i64,
}

/// A curve of the second or third degree.
///
/// # Format
/// Control points are 16.16 px, below 2⁴⁰·⁵. So c is below 2⁴³·¹, 2 b below 2⁴⁵·¹, and 6 a below 2⁴⁶·¹.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bezier {
    axes: [Axis; 2],
    end: Place,
    /// Chords of the curve, and of one of its pieces, as powers of two.
    chords: u32,
    piece: u32,
    /// Greatest distance of a piece's points from the line between its ends.
    reach: i64,
}

impl Bezier {
    /// Makes a curve from its first point, its control point and its last point.
    pub(crate) fn quadratic(from: Place, control: Place, to: Place) -> Self {
        let bend = second(from, control, to);
        let axis = |at: i64, control: i64, b: i64| Axis { at, c: 2 * (control - at), b, a: 0 };
        let axes = [axis(from[0], control[0], bend[0]), axis(from[1], control[1], bend[1])];
        Self::new(axes, to, 2 * length(bend))
    }

    /// Makes a curve from its first point, two control points and its last point.
    pub(crate) fn cubic(from: Place, first: Place, other: Place, to: Place) -> Self {
        let (bend, last) = (second(from, first, other), second(first, other, to));
        let axis =
            |at: i64, first: i64, bend: i64, last: i64| Axis { at, c: 3 * (first - at), b: 3 * bend, a: last - bend };
        let axes = [axis(from[0], first[0], bend[0], last[0]), axis(from[1], first[1], bend[1], last[1])];
        // The second derivative changes linearly, so it is greatest at one of the ends.
        Self::new(axes, to, 6 * length(bend).max(length(last)))
    }

    /// Makes a curve whose second derivative is at most `most`, in 16.16 px.
    fn new(axes: [Axis; 2], end: Place, most: u64) -> Self {
        let mut chords = 0;
        // 8 M <= 4ⁿ px.
        while chords < MOST && most > 1 << (13 + 2 * chords) {
            chords += 1;
        }
        let piece = chords.min(PIECE);
        // Of the curve from its chord, and of both from where they are moved to.
        let reach = (most >> (3 + 2 * (chords - piece))) + (most >> (3 + 2 * chords)) + 8;
        Self { axes, end, chords, piece, reach: reach as i64 }
    }

    /// Returns the pieces from the first one on.
    #[inline]
    pub(crate) fn pieces(&self) -> impl Iterator<Item = Piece<'_>> {
        let mut start = [self.axes[0].at, self.axes[1].at];
        let count = 1 << (self.chords - self.piece);
        (0..count).map(move |number| {
            let end = if number + 1 == count { self.end } else { self.border(number + 1) };
            let piece = Piece { curve: self, number, start, end };
            start = end;
            piece
        })
    }

    /// Returns the point at which a piece begins, and its second derivative there. Each rounding loses less than a
    /// unit.
    fn start_of(&self, number: i64) -> [(i64, i64); 2] {
        // t is a number up to 2⁸ over a power of two, so products are below 2⁵⁵.
        let times = |factor: i64| (factor * number) >> (self.chords - self.piece);
        self.axes.map(|Axis { at, c, b, a }| (at + times(c + times(b + times(a))), 2 * b + times(6 * a)))
    }

    /// Returns where two pieces meet: their common point, moved as the ends of chords are.
    fn border(&self, number: i64) -> Place {
        self.start_of(number).map(|(point, second)| point - (second >> (4 + 2 * self.chords)))
    }
}

/// A part of a curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece<'c> {
    curve: &'c Bezier,
    number: i64,
    start: Place,
    end: Place,
}

impl Piece<'_> {
    /// Returns the place where the piece ends.
    pub(crate) const fn end(&self) -> Place {
        self.end
    }

    /// Returns two heights that the piece is between.
    pub(crate) fn heights(&self) -> [i64; 2] {
        let ([from, to], reach) = ([self.start[1], self.end[1]], self.curve.reach);
        [from.min(to) - reach, from.max(to) + reach]
    }

    /// Returns the ends of all chords but the last one.
    ///
    /// # Format
    /// 16.32 px. The first differences lose less than 3 units, the second ones 2 and the third ones 1, which add up to
    /// less than 1,000 units after 16 chords: 2⁻²² px.
    #[inline]
    pub(crate) fn chords(&self) -> impl Iterator<Item = Place> {
        let Bezier { axes, chords, piece, .. } = *self.curve;
        let number = self.number;
        let times = |factor: i64| (factor * number) >> (chords - piece);
        let starts = if number == 0 { axes.map(|axis| (axis.at, 2 * axis.b)) } else { self.curve.start_of(number) };
        let steps = |Axis { c, b, a, .. }: Axis, second: i64| {
            // The derivative at the piece's beginning.
            let first = if number == 0 { c } else { c + times(2 * b + times(3 * a)) };
            let third = ((6 * a) << 16) >> (3 * chords);
            let second = (second << 16) >> (2 * chords);
            Steps {
                at: 0,
                first: (first << 16 >> chords) + (second >> 1) + (a << 16 >> (3 * chords)),
                second: second + third,
                third,
            }
        };
        let mut steps = [steps(axes[0], starts[0].1), steps(axes[1], starts[1].1)];
        (1..1 << piece).map(move |_| [starts[0].0 + steps[0].next(), starts[1].0 + steps[1].next()])
    }
}

/// A coordinate that is found by differences.
#[derive(Clone, Copy, Debug)]
struct Steps {
    at: i64,
    first: i64,
    second: i64,
    third: i64,
}

impl Steps {
    /// Moves on to the next point, and returns it, moved by half of what its chord is away: 1/16 of the second
    /// difference around it.
    #[inline(always)]
    const fn next(&mut self) -> i64 {
        self.at += self.first;
        let moved = self.at - (self.second >> 4);
        self.first += self.second;
        self.second += self.third;
        moved >> 16
    }
}

/// Returns the second difference of three points.
fn second(a: Place, b: Place, c: Place) -> Place {
    [a[0] - 2 * b[0] + c[0], a[1] - 2 * b[1] + c[1]]
}

/// Returns the length of a difference, or up to an eighth more: the greater coordinate and half of the smaller one.
fn length([x, y]: Place) -> u64 {
    let (x, y) = (x.unsigned_abs(), y.unsigned_abs());
    x.max(y) + (x.min(y) >> 1) + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use std::vec::Vec;

    /// All chords of a curve, as a pen would draw them.
    fn chords(curve: &Bezier) -> Vec<Place> {
        let mut places = std::vec![[curve.axes[0].at, curve.axes[1].at]];
        for piece in curve.pieces() {
            places.extend(piece.chords());
            places.push(piece.end());
        }
        places
    }

    fn px(c: i64) -> f64 {
        c as f64 / 65_536.0
    }

    /// The point of a curve at t, by its control points.
    fn point(points: &[Place], t: f64) -> [f64; 2] {
        let mut points: Vec<_> = points.iter().map(|p| p.map(px)).collect();
        while points.len() > 1 {
            let mixed = |p: &[[f64; 2]]| [0, 1].map(|k| p[0][k] + (p[1][k] - p[0][k]) * t);
            points = points.windows(2).map(mixed).collect();
        }
        points[0]
    }

    /// Chords are within 1/64 px of the curve at equal t, from its first point to its last one, and pieces within their
    /// heights.
    #[test]
    fn chords_are_near_their_curve() {
        let mut rng = Rng::new(77);
        let mut worst = 0_f64;
        for case in 0..6000 {
            let reach = [4, 300, 20_000, 8_388_000][case % 4] << 8;
            let mut place = || [(); 2].map(|()| i64::from(rng.between(-reach, reach)) << 8);
            let mut points = [place(), place(), place(), place()];
            match case % 11 {
                0 => points[1] = points[0],
                1 => points[2] = points[3],
                2 => points = [points[0]; 4],
                3 => points[3] = points[0],
                // A cusp, and a line to and fro.
                4 => (points[1], points[2]) = (points[3], points[0]),
                5 => points = points.map(|p| [p[0], p[0]]),
                _ => {}
            }
            let points = if case & 16 == 0 { &points[..] } else { &points[..3] };
            let curve = match *points {
                [from, control, to] => Bezier::quadratic(from, control, to),
                [from, first, second, to] => Bezier::cubic(from, first, second, to),
                _ => unreachable!(),
            };
            let found = chords(&curve);
            assert_eq!((found[0], found[found.len() - 1]), (points[0], points[points.len() - 1]));
            let count = found.len() - 1;
            for (k, chord) in found.windows(2).enumerate().step_by(1 + count / 64) {
                for part in [0.0, 0.25, 0.45, 0.5, 0.55, 1.0] {
                    let exact = point(points, (k as f64 + part) / count as f64);
                    let [x, y] = [0, 1].map(|axis: usize| {
                        let (from, to) = (px(chord[0][axis]), px(chord[1][axis]));
                        from + (to - from) * part - exact[axis]
                    });
                    let off = x.hypot(y);
                    if reach <= 32_767 << 8 {
                        assert!(off <= 1.0 / 64.0, "case {case}: {points:?}, chord {k} of {count} is {off} px off");
                        worst = worst.max(off);
                    } else {
                        assert!(off <= 2.0, "case {case}: {points:?}, chord {k} of {count} is {off} px off");
                    }
                }
            }
            for piece in curve.pieces() {
                let [top, bottom] = piece.heights();
                assert!(piece.chords().all(|place| (top..=bottom).contains(&place[1])), "case {case}: {points:?}");
            }
        }
        std::println!("worst 1/{:.1} px", 1.0 / worst);
    }
}
