//! Dashes of thick lines: a pattern of lengths that goes on from segment to segment, and only the dashes that may be
//! seen are drawn.

use super::arc::{Direction, times};
use super::round::length;
use super::stroker::Stroker;
use crate::math::{Pixels, leading_zeros, mul_high, reciprocal};
use crate::scene::Place;
use core::ops::Range;

/// Place in a pattern of dashes.
#[derive(Clone, Copy)]
pub(super) struct Dashes<'a> {
    pattern: &'a [Pixels],
    /// Sum of the pattern's lengths, twice if they are odd in number, 16.16 px.
    all: i64,
    at: usize,
    /// Set if the current length is drawn; and what is left of it, 16.16 px.
    drawn: bool,
    pub(super) left: i64,
}

impl<'a> Dashes<'a> {
    /// Begins a pattern; without one, a dash without end.
    pub(super) fn new(pattern: &'a [Pixels], offset: Pixels) -> Self {
        let sum: i64 = pattern.iter().fold(0, |sum, part| sum.saturating_add(length(*part)));
        // Each length of an odd number of them is a gap in every other turn.
        let every = if pattern.len().is_multiple_of(2) { 2 } else { 1 };
        let mut gaps = pattern.iter().skip(every - 1).step_by(every);
        if sum < 1 << 10 || gaps.all(|gap| length(*gap) == 0) {
            return Self { pattern: &[], all: i64::MAX, at: 0, drawn: true, left: i64::MAX };
        }
        let all = if pattern.len().is_multiple_of(2) { sum } else { 2 * sum };
        let mut dashes = Self { pattern, all, at: 0, drawn: true, left: 0 };
        dashes.left = dashes.length();
        dashes.skip((i64::from(offset.to_bits()) << 8).checked_rem_euclid(all).unwrap_or(0));
        dashes
    }

    /// Returns whether there are any gaps.
    pub(super) fn are_dashes(&self) -> bool {
        !self.pattern.is_empty()
    }

    /// Returns whether a dash that has begun goes on here.
    pub(super) fn goes_on(&self) -> bool {
        !self.are_dashes() || self.drawn && self.left < self.length()
    }

    pub(super) fn length(&self) -> i64 {
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
pub(super) struct Segment {
    pub(super) from: Place,
    pub(super) way: Direction,
    pub(super) length: i64,
}

impl Segment {
    fn at(&self, distance: i64) -> Place {
        [self.from[0] + times(distance, self.way[0]), self.from[1] + times(distance, self.way[1])]
    }

    /// Returns a part of the segment that holds all dashes that reach into an area: those that are up to `reach` away,
    /// or up to `beyond` along the segment. The segments of a plot may be far longer than the screen, and have any
    /// number of dashes.
    fn near(&self, area: [Range<i64>; 2], (reach, beyond): (i64, i64)) -> Range<i64> {
        let mut near = 0..self.length;
        // Distances along the segment to the nearest and to the farthest corner of the area.
        let (mut first, mut last) = (-beyond, beyond);
        for (k, range) in area.iter().enumerate() {
            let (start, change) = if k == 0 { (self.from[0], self.way[0]) } else { (self.from[1], self.way[1]) };
            let (a, b) = (times(range.start - start, change), times(range.end - start, change));
            (first, last) = (first + a.min(b), last + a.max(b));
        }
        (near.start, near.end) = (near.start.max(first), near.end.min(last));
        for (k, range) in area.into_iter().enumerate() {
            let (start, change) = if k == 0 { (self.from[0], self.way[0]) } else { (self.from[1], self.way[1]) };
            // Along a coordinate that hardly changes, nothing is left out.
            if change.unsigned_abs() >= 1 << 20 {
                let ways = [range.start - reach - start, range.end + reach - start];
                let [first, last] = if change >= 0 { ways } else { [-ways[1], -ways[0]] };
                let inverse = Inverse::of(change.unsigned_abs());
                let (first, last) = (inverse.times(first), inverse.times(last));
                near.start = near.start.max(first - (first.abs() >> 10) - (1 << 16) - beyond);
                near.end = near.end.min(last + (last.abs() >> 10) + (1 << 16) + beyond);
            }
        }
        near
    }
}

/// 1 over a number of 2.30.
struct Inverse {
    shift: u32,
    inverse: u32,
}

impl Inverse {
    fn of(number: u32) -> Self {
        let shift = leading_zeros(number | 1) & 31;
        Self { shift, inverse: reciprocal((number | 1) << shift) }
    }

    /// Returns a length times the inverse, in the unit of the length: off by less than 1/1,000 of it and 1 px together.
    ///
    /// # Format
    /// Lengths are 16.16 px, below 2⁴²; the number is 2²⁰ or more, so the result is below 2⁵². 31 bits of the length
    /// count, and the product loses less than 2¹⁰ units of 32-bit lengths.
    fn times(&self, length: i64) -> i64 {
        let all = length.unsigned_abs();
        let excess = 33_u32.saturating_sub(all.leading_zeros());
        let product = i64::from(mul_high((all >> excess) as u32, self.inverse)) << (excess + self.shift) >> 1;
        if length < 0 { -product } else { product }
    }
}

impl Stroker<'_, '_, '_> {
    /// Passes over the rest of a segment, out of sight. A dash that goes on after it begins at its end.
    fn pass(&mut self, dashes: &mut Dashes<'_>, segment: &Segment, done: i64, ends: bool) {
        dashes.skip(segment.length - done);
        if dashes.goes_on() && !ends {
            self.begin(segment.at(segment.length), segment.way);
        }
    }

    /// Draws a segment dash by dash. The first dash goes on from the segment before, if `goes_on` says so; and the last
    /// one goes on, unless the line `ends`.
    pub(super) fn dash(&mut self, dashes: &mut Dashes<'_>, segment: &Segment, mut goes_on: bool, ends: bool) {
        let all = segment.length;
        if !goes_on && self.misses(segment.from, segment.at(all)) {
            return self.pass(dashes, segment, 0, ends);
        }
        let mut near = segment.near(self.pen.area(), self.reach_of_dash());
        let mut done = 0;
        while done < all {
            // A dash that has begun is drawn to its end, wherever that is.
            if !goes_on && done > near.end {
                return self.pass(dashes, segment, done, ends);
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
