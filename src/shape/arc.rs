//! Arcs as chains of chords: a centre, radii and directions come in, and points for a pen go out.
//!
//! A turn has 64 sectors, whose borders are in a table. Each sector is cut into as many chords as the radius takes.
//! Chords lie inside of the circle, so the radius is made larger by half of their greatest distance from it, at most
//! 1/256 px: then half of that is missing in the middle of a chord, and as much is too much at its ends.
//!
//! A sector that is above or below the rows that are drawn is one chord.

use crate::math::{Angle16, divided, isqrt, mul_long, mul_wide};
use crate::scene::{Pen, Place};
use core::num::NonZeroU32;

/// A direction, of length 1 in 2.30: x to the right, y down.
pub(super) type Direction = [i32; 2];

/// Sectors of a turn.
const SECTORS: u32 = 64;

/// Sines of the sectors' borders in the first quarter of a turn, 2.30.
static SINES: [i32; 17] = {
    let mut table = [0; 17];
    let mut k = 0;
    while k < 17 {
        table[k] = Angle16((k << 10) as u16).sin_q30() as i32;
        k += 1;
    }
    table
};

/// Returns the direction of a sector's first border, modulo a turn.
fn border(number: u32) -> Direction {
    let at = |k: u32| SINES.get(k as usize & 31).copied().unwrap_or(0);
    let part = number & 15;
    let (sine, cosine) = (at(part), at(16 - part));
    match number >> 4 & 3 {
        0 => [cosine, sine],
        1 => [-sine, cosine],
        2 => [-cosine, -sine],
        _ => [sine, -cosine],
    }
}

/// Returns the number of the sector that a direction is in.
fn sector([x, y]: Direction) -> u32 {
    // Turned back into the first quarter.
    let (quarter, x, y) = match (x > 0, y >= 0) {
        (true, true) => (0, x, y),
        (false, _) if y > 0 => (1, y, -x),
        (_, false) if x >= 0 => (3, -y, x),
        _ => (2, -x, -y),
    };
    // The greatest border that is not past the direction.
    let mut found = 0;
    for step in [8, 4, 2, 1] {
        let [cosine, sine] = border(found + step);
        if mul_wide(cosine, y) >= mul_wide(sine, x) {
            found += step;
        }
    }
    quarter << 4 | found
}

/// Returns a length in 16.16 px times a number in 2.30, rounded down.
pub(super) fn times(length: i64, factor: i32) -> i64 {
    match i32::try_from(length) {
        Ok(length) => mul_wide(length, factor) >> 30,
        Err(_) => (mul_long(length, factor) >> 30) as i64,
    }
}

/// Returns the direction of an angle, clockwise from the right.
pub(super) fn direction(angle: Angle16) -> Direction {
    if angle.0 & 0x3FF == 0 {
        return border(u32::from(angle.0) >> 10);
    }
    [angle.cos_q30() as i32, angle.sin_q30() as i32]
}

/// Returns how far the middle of an arc is from that of its chord, times 4, for a chord whose middle is 1 away from the
/// centre, in 2.30. `square` is that of the chord, below 0.01, in 0.32.
///
/// With s for the square: 4 (1 / (1 - s / 4)^(1/2) - 1) = s / 2 + 3 s² / 32, and less than 2⁻²³ more.
const fn bulge_of(square: i64) -> i32 {
    ((square >> 3) + ((3 * ((square * square) >> 32)) >> 7)) as i32
}

/// Returns the bulge between two directions less than a sector apart.
fn bulge(a: Direction, b: Direction) -> i32 {
    let [x, y] = [b[0] - a[0], b[1] - a[1]];
    bulge_of((mul_wide(x, x) + mul_wide(y, y)) >> 28)
}

/// The bulge of a sector; the square of its chord is (2 sin(π / 64))².
const BULGE: i32 = bulge_of(41_362_883);

/// An ellipse around a centre, that arcs are a part of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve {
    center: Place,
    /// Both radii, 16.16 px, with what makes up for chords.
    radii: [i64; 2],
    /// Part of a sector that a chord takes, 0.16; and the number of sectors that a chord of a small radius takes.
    step: u32,
    stride: u32,
}

/// A greater radius is drawn with chords for this one, 16.16 px.
const GREATEST: i64 = 32_767 << 16;

impl Curve {
    /// Makes a curve of radii in 16.16 px; those below 0 are 0.
    pub(super) fn new(center: Place, radii: [i64; 2]) -> Self {
        let radii = radii.map(|radius| radius.max(0));
        // A chord of an angle t is up to r t² / 8 away. That is 1/128 px where a sector has r · 0.154 chords, squared.
        let greatest = radii[0].max(radii[1]).min(GREATEST) as u32;
        let stride = match greatest {
            // 16 and 32 chords per turn, up to 0.4 px and 1.6 px.
            0..26_500 => 4,
            26_500..106_000 => 2,
            _ => 1,
        };
        let chords = NonZeroU32::MIN.saturating_add(isqrt(((greatest >> 8) * 40) >> 16));
        let step = if chords.get() == 1 { 1 << 16 } else { divided(1 << 16, chords).0 };
        // r t² / 16, where t is the step times a sector, 1/64 turn: r / 1659 for a whole one.
        let square = (i64::from(step) * i64::from(step) * i64::from(stride * stride)) >> 16;
        let radii = radii.map(|radius| radius + ((((radius.min(GREATEST) * 158) >> 18) * square) >> 16));
        Self { center, radii, step, stride }
    }

    /// Returns the curve around another centre.
    pub(super) const fn around(self, center: Place) -> Self {
        Self { center, ..self }
    }

    /// Returns the point in a direction.
    pub(super) fn point(&self, [x, y]: Direction) -> Place {
        [self.center[0] + times(self.radii[0], x), self.center[1] + times(self.radii[1], y)]
    }

    /// Draws to a point in a direction, along the curve; the direction is less than a sector away, clockwise or not.
    /// `bulge` is that between the directions.
    ///
    /// A sector is nearly a parabola: with t from 0 to 1, the point at t of the chord from a to b, moved by 4 t (1 - t)
    /// times the distance of the chord's middle from the curve. It is off by r / 4,000,000. Its points are found by two
    /// differences, in additions alone.
    ///
    /// # Format
    /// Points are relative to the first one, in 16.22 px: a sector is at most 402 px wide in a direction. So roundings
    /// of both differences add up to less than 1/2,000 px.
    fn chords(&self, pen: &mut Pen<'_, '_>, from: Place, to: Place, bulge: i32) {
        if self.step < 1 << 16 && !pen.misses(from[1].min(to[1]), from[1].max(to[1])) {
            let ([dx, ddx], [dy, ddy]) = (self.differences(0, from, to, bulge), self.differences(1, from, to, bulge));
            pen.chords(from, self.step, [dx, dy], [ddx, ddy]);
        }
        pen.line_to_place(to);
    }

    /// Returns the first and the second difference of a coordinate from chord to chord, in 16.22.
    #[inline(always)]
    fn differences(&self, axis: usize, from: Place, to: Place, bulge: i32) -> [i32; 2] {
        let of = |place: Place| if axis == 0 { place[0] } else { place[1] };
        let (a, b) = (of(from), of(to));
        let bulge = times(((a + b) >> 1) - of(self.center), bulge);
        // For a radius beyond the greatest one, some differences.
        let by = |length: i64| (mul_wide(length as i32, (self.step << 14) as i32) >> 30) as i32;
        let second = by(i64::from(by(bulge << 6)));
        [by((b - a + bulge) << 6).wrapping_sub(second), second.wrapping_mul(-2)]
    }

    /// Draws clockwise to the point in a direction, from that in another one, where the pen is. Equal directions are no
    /// arc at all.
    pub(super) fn arc(&self, pen: &mut Pen<'_, '_>, from: Direction, to: Direction) {
        let first = sector(from);
        let count = sector(to).wrapping_sub(first) % SECTORS;
        self.sectors(pen, from, first, count, to);
    }

    /// Draws through `count` borders, from number `first` + 1 on, to the point in a direction.
    fn sectors(&self, pen: &mut Pen<'_, '_>, from: Direction, first: u32, count: u32, to: Direction) {
        let (stride, end) = (self.stride, (first + count) & !(self.stride - 1));
        // The first border that chords end at.
        let mut number = (first + stride) & !(stride - 1);
        let (mut at, mut last) = (self.point(from), from);
        if number <= first + count {
            let direction = border(number);
            let next = self.point(direction);
            self.chords(pen, at, next, bulge(from, direction));
            at = next;
            while number < end {
                let size = self.size(pen, at, number, end);
                let next = self.point(border(number + size));
                if size == 1 {
                    self.chords(pen, at, next, BULGE);
                } else {
                    pen.line_to_place(next);
                }
                number += size;
                at = next;
            }
            last = border(end);
        }
        self.chords(pen, at, self.point(to), bulge(last, to));
    }

    /// Returns how many sectors the next line takes: a quarter of a turn, or a quarter of that, if it is out of the
    /// rows that are drawn.
    #[inline]
    fn size(&self, pen: &Pen<'_, '_>, at: Place, number: u32, end: u32) -> u32 {
        let misses = |size: u32| {
            let next = self.center[1] + times(self.radii[1], border(number + size)[1]);
            pen.misses(at[1].min(next), at[1].max(next))
        };
        if number & 15 == 0 && number + 16 <= end && misses(16) {
            16
        } else if number & 3 == 0 && number + 4 <= end && misses(4) {
            4
        } else {
            self.stride
        }
    }

    /// Draws clockwise by an angle of up to a turn, in 65,536ths, from the angle where the pen is.
    pub(super) fn sweep(&self, pen: &mut Pen<'_, '_>, from: Angle16, sweep: u32) {
        let start = u32::from(from.0);
        let end = start + sweep;
        let (first, last) = (start >> 10, end >> 10);
        self.sectors(pen, direction(from), first, last - first, direction(Angle16(end as u16)));
    }

    /// Draws back, counter-clockwise, to the angle `from`, from the angle `sweep` after it, where the pen is.
    ///
    /// An arc upside down is drawn clockwise where the arc is drawn counter-clockwise.
    pub(super) fn sweep_back(&self, pen: &mut Pen<'_, '_>, from: Angle16, sweep: u32) {
        let end = Angle16(from.0.wrapping_add(sweep as u16));
        let mirrored = Self { radii: [self.radii[0], -self.radii[1]], ..*self };
        mirrored.sweep(pen, -end, sweep);
    }

    /// Draws the whole curve, as a contour of its own, clockwise or counter-clockwise.
    pub(super) fn whole(&self, pen: &mut Pen<'_, '_>, clockwise: bool) {
        pen.move_to_place(self.point(border(0)));
        if clockwise {
            self.sweep(pen, Angle16::ZERO, 1 << 16);
        } else {
            self.sweep_back(pen, Angle16::ZERO, 1 << 16);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    #[test]
    fn directions_are_in_their_sectors() {
        let mut rng = Rng::new(2);
        for case in 0..200_000 {
            let angle = Angle16(if case < 65_536 { case as u16 } else { rng.next_u32() as u16 });
            let expected = u32::from(angle.0) >> 10;
            assert_eq!(sector(direction(angle)), expected, "{angle:?}");
        }
    }
}
