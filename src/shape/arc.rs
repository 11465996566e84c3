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
    [angle.cos_q30() as i32, angle.sin_q30() as i32]
}

/// An ellipse around a centre, that arcs are a part of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve {
    center: Place,
    /// Both radii, 16.16 px, with what makes up for chords.
    radii: [i64; 2],
    /// Part of a sector that a chord takes, 0.16.
    step: u32,
}

/// A greater radius is drawn with chords for this one, 16.16 px.
const GREATEST: i64 = 32_767 << 16;

impl Curve {
    /// Makes a curve of radii in 16.16 px; those below 0 are 0.
    pub(super) fn new(center: Place, radii: [i64; 2]) -> Self {
        let radii = radii.map(|radius| radius.max(0));
        // A chord of an angle t is up to r t² / 8 away. That is 1/128 px where a sector has r · 0.154 chords, squared.
        let greatest = (radii[0].max(radii[1])).min(GREATEST) as u32;
        let chords = NonZeroU32::MIN.saturating_add(isqrt(((greatest >> 8) * 40) >> 16));
        let (step, _) = divided(1 << 16, chords);
        // r t² / 16, where t is the step times a sector, 1/64 turn: r / 1659 for a whole one.
        let square = (i64::from(step) * i64::from(step)) >> 16;
        let radii = radii.map(|radius| radius + ((((radius.min(GREATEST) * 158) >> 18) * square) >> 16));
        Self { center, radii, step }
    }

    /// Returns the point in a direction.
    pub(super) fn point(&self, [x, y]: Direction) -> Place {
        [self.center[0] + times(self.radii[0], x), self.center[1] + times(self.radii[1], y)]
    }

    /// Draws to the point in a direction, along the curve; the direction is less than a sector away, clockwise or not.
    fn chords(&self, pen: &mut Pen<'_, '_>, from: Direction, to: Direction) {
        let (start, end) = (self.center[1] + times(self.radii[1], from[1]), self.point(to));
        if self.step < 1 << 16 && !pen.misses(start.min(end[1]), start.max(end[1])) {
            let change = [to[0] - from[0], to[1] - from[1]];
            // Square of the chord of the sector, below 0.01, in 0.32.
            let square = (mul_wide(change[0], change[0]) + mul_wide(change[1], change[1])) >> 28;
            let mut part = self.step;
            // Roundings of the step leave out no chord, and add none.
            while part + (self.step >> 1) < 1 << 16 {
                // A point of the chord is (1 - s)^(1/2) away from the centre.
                let s = (square * i64::from((part * ((1 << 16) - part)) >> 16)) >> 16;
                let longer = (1 << 30) + ((s >> 3) + ((3 * ((s * s) >> 32)) >> 5)) as i32;
                let on = [0, 1].map(|k: usize| {
                    let (from, change) = if k == 0 { (from[0], change[0]) } else { (from[1], change[1]) };
                    let on_chord = from + (mul_wide(change, part as i32) >> 16) as i32;
                    (mul_wide(on_chord, longer) >> 30) as i32
                });
                pen.line_to_place(self.point(on));
                part += self.step;
            }
        }
        pen.line_to_place(end);
    }

    /// Draws clockwise to the point in a direction, from that in another one, where the pen is. Equal directions are no
    /// arc at all.
    pub(super) fn arc(&self, pen: &mut Pen<'_, '_>, from: Direction, to: Direction) {
        let first = sector(from);
        let count = sector(to).wrapping_sub(first) % SECTORS;
        self.sectors(pen, from, first, count, to);
    }

    fn sectors(&self, pen: &mut Pen<'_, '_>, from: Direction, first: u32, count: u32, to: Direction) {
        let mut at = from;
        for number in first + 1..=first + count {
            let next = border(number);
            self.chords(pen, at, next);
            at = next;
        }
        self.chords(pen, at, to);
    }

    /// Draws clockwise by an angle of up to a turn, in 65,536ths, from the angle where the pen is.
    pub(super) fn sweep(&self, pen: &mut Pen<'_, '_>, from: Angle16, sweep: u32) {
        let start = u32::from(from.0);
        let end = start + sweep;
        let (first, last) = (start >> 10, end >> 10);
        self.sectors(pen, direction(from), first, last - first, direction(Angle16(end as u16)));
    }

    /// Draws back, counter-clockwise, to the angle `from`, from the angle `sweep` after it, where the pen is.
    pub(super) fn sweep_back(&self, pen: &mut Pen<'_, '_>, from: Angle16, sweep: u32) {
        let start = u32::from(from.0);
        let end = start + sweep;
        let mut at = direction(Angle16(end as u16));
        for number in ((start >> 10) + 1..=end >> 10).rev() {
            let next = border(number);
            self.chords(pen, at, next);
            at = next;
        }
        self.chords(pen, at, direction(from));
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
