//! Interpolation along a line: a line and the values at its ends come in, and values at its pixels go out, linear on
//! the screen.
//!
//! ```text
//!   a ──┼────────┼────────┼── b      The value at a pixel is that of the point of the line which is level with the
//!       0        1        2          pixel's centre along the major axis. The centre of the first pixel may lie before
//!                                    a: this pixel has the value at a itself, so no value leaves the ends' range.
//! ```
//! This takes one reciprocal per line, and no division. Values are kept modulo 2³², as planes over triangles are.

use super::line::Line;
use crate::math::{divide_modulo, mul_high, reciprocal};

/// The part of the interpolation that is common to all values on a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Along {
    /// 2⁶³ / (length << shift), where shift puts the top bit of the length into bit 31.
    reciprocal: u32,
    shift: u32,
    /// Position of the centre of the pixel `origin` between the two ends, 0.32.
    fraction: u32,
    /// 1 if the centre of the first pixel lies before the line's start, otherwise 0.
    origin: u32,
}

impl Along {
    /// Prepares interpolation along a line that has pixels.
    #[inline]
    pub fn new(line: &Line) -> Self {
        let shift = line.length().leading_zeros() & 31;
        let reciprocal = reciprocal(line.length() << shift);
        let origin = u32::from(line.lead() < 0);
        let way = (line.lead() + 256 * origin as i32).max(0) as u32;
        // As 1.31 first: the way may be the whole line, or longer if there is no pixel after the first.
        let way = way.min(line.length()) << shift;
        let fraction = mul_high(way, reciprocal).min(0x7FFF_FFFF) << 1;
        Self { reciprocal, shift, fraction, origin }
    }

    /// Returns the number of the pixel that values are given for: 0 or 1. If it is 1, pixel 0 has the value at the
    /// line's start.
    #[inline]
    pub const fn origin(&self) -> u32 {
        self.origin
    }

    /// Returns the value at the pixel `origin` and its change per pixel, both times 2^`scale`, modulo 2³².
    ///
    /// # Format
    /// The difference of the values, times 2^`scale`, is below 2³². The first value is within 8 units of the exact one,
    /// and never outside of the two ends' range. The change is within 1/2 unit and 2⁻²⁸ of the exact change (within 1
    /// unit if the line is shorter than 2 px). Over 8192 px, a value is within 2¹³. Over all of 32,767 px, a depth in
    /// 16.16 is within 1/4 of a step.
    #[inline]
    pub fn value(&self, from: i32, to: i32, scale: u32) -> (u32, i32) {
        let difference = to.wrapping_sub(from);
        let magnitude = difference.unsigned_abs() << scale;
        // length ≥ 2⁸ if there is a pixel to step to, so shift ≤ 23. The step is rounded where the shift is smaller.
        let step = mul_high(magnitude, self.reciprocal);
        let step = match 23_u32.saturating_sub(self.shift) {
            0 => step,
            down => ((step >> (down - 1)) + 1) >> 1,
        };
        let way = mul_high(magnitude, self.fraction);
        let start = (from as u32) << scale;
        if difference < 0 {
            (start.wrapping_sub(way), (step as i32).wrapping_neg())
        } else {
            (start.wrapping_add(way), step as i32)
        }
    }

    /// Returns the value at the pixel `origin` and its change per pixel as [`value`](Self::value) does, with 32
    /// fractional bits, by long division.
    ///
    /// # Format
    /// Differences of 33 bits times 2²⁴ are below 2⁵⁸. Both results are rounded down. The line's length is not 0.
    #[inline(never)]
    pub fn wide(&self, line: &Line, from: i32, to: i32) -> (i64, i64) {
        let difference = i64::from(to) - i64::from(from);
        // As in `new`: not before the line's start, and not beyond its end.
        let way = (line.lead() + 256 * self.origin as i32).max(0).min(line.length() as i32);
        let divided = |n: i64| divide_modulo(n >> 32, n as u32, line.length().into());
        ((i64::from(from) << 32).wrapping_add(divided(difference * i64::from(way))), divided(difference << 8))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use std::println;

    fn lines(count: usize) -> impl Iterator<Item = ([i32; 2], [i32; 2], i32, i32)> {
        let mut rng = Rng::new(23);
        let mut next = move |limit: i32| rng.between(-limit, limit);
        (0..count).map(move |k| {
            let reach = [300, 5000, 80_000, 1 << 20][k % 4];
            let mut point = || [next(reach), next(reach)];
            let (a, b) = (point(), point());
            (a, b, next(i32::MAX >> 1), next(i32::MAX >> 1))
        })
    }

    /// Returns the exact value at a pixel, in f64, and the value at the line's start for centres before it.
    fn exact(line: &Line, k: u32, from: i32, to: i32) -> f64 {
        let way = f64::from(line.lead()) + 256.0 * f64::from(k);
        f64::from(from) + (way / f64::from(line.length())).max(0.0) * (f64::from(to) - f64::from(from))
    }

    #[test]
    fn values_are_those_of_the_line_at_the_centres() {
        let mut worst = 0_f64;
        let mut seen = 0;
        for (a, b, from, to) in lines(20_000) {
            let line = Line::new(a.into(), b.into());
            if line.count() == 0 {
                continue;
            }
            seen += 1;
            let along = Along::new(&line);
            let (start, step) = along.value(from, to, 0);
            for k in [0, 1, 2, line.count() / 2, line.count() - 1] {
                let Some(after) = k.checked_sub(along.origin()).filter(|_| k < line.count()) else { continue };
                let value = start.wrapping_add(after.wrapping_mul(step as u32)) as i32;
                let error = (f64::from(value) - exact(&line, k, from, to)).abs();
                worst = worst.max(error - f64::from(after) / 2.0);
                assert!(error <= 16.0 + f64::from(after) / 2.0, "{a:?} {b:?} {from} {to}, pixel {k}: {error}");
            }
        }
        assert!(seen > 15_000);
        println!("worst error beside half a unit a pixel: {worst}");
    }

    #[test]
    fn wide_values_are_exact() {
        for (a, b, from, to) in lines(20_000) {
            let line = Line::new(a.into(), b.into());
            if line.count() == 0 {
                continue;
            }
            let along = Along::new(&line);
            let (start, step) = along.wide(&line, from, to);
            for k in [0, 1, line.count() / 2, line.count() - 1] {
                let Some(after) = k.checked_sub(along.origin()).filter(|_| k < line.count()) else { continue };
                let value = (start + i64::from(after) * step) as f64 / 4_294_967_296.0;
                // f64 itself rounds to 2⁻²².
                let error = (value - exact(&line, k, from, to)).abs();
                assert!(error < 1e-5, "{a:?} {b:?} {from} {to}, pixel {k}: {error}");
            }
        }
    }

    #[test]
    fn depth_stays_between_the_ends() {
        for (a, b, from, to) in lines(20_000) {
            let line = Line::new(a.into(), b.into());
            let (from, to) = (from as u16, to as u16);
            let along = Along::new(&line);
            let (start, step) = along.value(from.into(), to.into(), 16);
            for k in [along.origin(), line.count().saturating_sub(1)] {
                let Some(after) = k.checked_sub(along.origin()).filter(|_| k < line.count()) else { continue };
                let z = start.wrapping_add(1 << 15).wrapping_add(after.wrapping_mul(step as u32)) >> 16;
                let exact = exact(&line, k, from.into(), to.into());
                let bound = 0.5 + f64::from(after) / 131_072.0 + 1e-3;
                assert!((f64::from(z) - exact).abs() <= bound, "{a:?} {b:?} {from} {to}, pixel {k}: {z}");
                assert!((from.min(to)..=from.max(to)).contains(&(z as u16)));
            }
        }
    }
}
