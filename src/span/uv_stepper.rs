//! The coordinates of a texture along a span, divided by 1 / w every few columns and straight in between: what
//! [`texture_span`](super::textured::texture_span) steps by.

use super::depth::RUN;
use super::perspective::{MOST_STRAIGHT, is_straight, longest_log_step};
use super::span::{Primitive, Span};
use crate::color::PixelFormat;
use crate::math::{CoarseDivisor, SMALL_CORE};
use crate::vertex::{PerspectiveClass, PerspectivePlane, PerspectiveSetup, Varyings};

/// Both coordinates of a texture along a span, from run to run.
///
/// q, d q of u and d q of v are shifted up, so that the larger q of both ends has its top bit set. Without perspective,
/// q is 0.
///
/// The order of the fields decides which of them the compiler loads too early, and then keeps on the stack.
#[derive(Debug)]
#[repr(C)]
pub(crate) struct UvStepper {
    u: Scale,
    /// u and v at the stepper's position.
    uv: (i32, i32),
    v: Scale,
    /// q, d q of u and d q of v at the stepper's position, and their changes over the next run.
    at: [i32; 3],
    step: [i32; 3],
    /// Number of pixels to the left of the first pixel, up to the column that is divided.
    pub(super) back: u32,
    /// Binary logarithm of the number of pixels between two columns that are divided.
    pub(super) log_step: u32,
    /// Number of pixels of the span to the left of the first one, and number of those that are drawn.
    before: usize,
    length: usize,
    /// Depth at the next pixel, and its change per pixel. The stepper keeps them in memory for the loops, and does not
    /// use them itself.
    pub(super) z: u32,
    pub(super) dz_dx: i32,
}

impl UvStepper {
    /// A stepper that is nowhere.
    pub(crate) const EMPTY: Self = Self {
        at: [0; 3],
        step: [0; 3],
        uv: (0, 0),
        u: Scale::EMPTY,
        v: Scale::EMPTY,
        back: 0,
        log_step: 0,
        before: 0,
        length: 0,
        z: 0,
        dz_dx: 0,
    };

    /// Returns the binary logarithm of the step to begin the spans of a primitive with, where a shader asks for `step`;
    /// 0 if a stepper can draw none of them: it has no planes of 64 bits, and divides at columns that are apart.
    #[inline(always)]
    pub(crate) fn log_step<V: Varyings, U>(primitive: &Primitive<V, U>, step: usize) -> u32 {
        match primitive.perspective.class() {
            PerspectiveClass::Planes64 => 0,
            _ => longest_log_step::<V>(&primitive.perspective, step),
        }
    }

    /// Returns a stepper for the pixels of a span that a [texture span](super::textured::texture_span) can draw, one
    /// step before their first column. The stepper knows [how many](Self::length) they are, and how many pixels the
    /// span has [before](Self::before) them. Those that can be drawn lie between columns over which coordinates are
    /// straight enough ([`straight_log_step`](super::perspective::straight_log_step)). As q is linear, they lie side by
    /// side.
    ///
    /// Columns are 1 << `log_step` pixels apart. This is 1 << `halvings` times less than [`log_step`](Self::log_step)
    /// says, which must not be 0.
    #[inline(never)]
    pub(crate) fn begin<V: Varyings, U>(
        primitive: &Primitive<V, U>,
        position: (i32, i32),
        length: usize,
        log_step: u32,
        halvings: u32,
    ) -> Self {
        Self::begin_on::<SMALL_CORE, V, U>(primitive, position, length, log_step, halvings)
    }

    /// Does as [`begin`](Self::begin), for a small core or another one.
    #[inline(always)]
    fn begin_on<const SMALL: bool, V: Varyings, U>(
        primitive: &Primitive<V, U>,
        (x, y): (i32, i32),
        mut length: usize,
        log_step: u32,
        halvings: u32,
    ) -> Self {
        let perspective = &primitive.perspective;
        let least = perspective.least_straight() >> halvings;
        let value = |values: &[i32], k: usize| values.get(k).copied().unwrap_or(0);
        let last = |values: &[i32]| values.last().copied().unwrap_or(0);
        let change = primitive.d_dx.as_ref();
        let (mut dq, du, dv) = (last(change), value(change, 0), value(change, 1));
        // Columns that are divided, on both sides of the span. q is in 0..2³¹ within the span, and changes by less than
        // 2²⁸ up to them.
        let mut back = x & ((1 << log_step) - 1);
        let first = x.wrapping_sub(back);
        let steps = ((back.wrapping_add(length as i32) - 1) >> log_step) + 1;
        let mut at = primitive.at((first, y));
        let mut ends = [last(at.as_ref()), last(at.as_ref()).wrapping_add(dq.wrapping_mul(steps << log_step))];
        let mut before = 0;
        // `is_straight` at both ends, in one comparison: `least` is below 2³¹.
        let above = |q: i32| (q as u32).wrapping_sub(least);
        if above(ends[0]).max(above(ends[1])) >= MOST_STRAIGHT.wrapping_sub(least) {
            // Leaves out steps at the ends, as far as they are bent.
            let (skipped, left) = straight_steps(ends, steps, dq << log_step, least);
            if left <= 0 {
                return Self::EMPTY;
            }
            let (skipped, end) = (skipped << log_step, (skipped + left) << log_step);
            let past = end.min(back.wrapping_add(length as i32));
            let begin = back.max(skipped);
            (before, length) = (begin.wrapping_sub(back) as usize, past.wrapping_sub(begin) as usize);
            back = begin.wrapping_sub(skipped);
            at.advance(&primitive.d_dx, skipped);
            ends = [last(at.as_ref()), last(at.as_ref()).wrapping_add(dq.wrapping_mul(left << log_step))];
        }
        let planes = perspective.planes();
        let at = at.as_ref();
        let [mut q, to] = ends;
        let mut most = (q as u32).max(to as u32) | 1;
        let mut shift = 0;
        if SMALL {
            // Takes a few rounds, and fewer instructions than `leading_zeros` does with its table.
            while most >> 31 == 0 {
                (most, shift) = (most << 1, shift + 1);
            }
        } else {
            shift = most.leading_zeros();
        }
        if perspective.class() == PerspectiveClass::Affine {
            (q, dq, shift) = (0, 0, 0);
        }
        let up = |value: i32| value << (shift & 31);
        let over = |change: i32| change << ((shift + log_step) & 31);
        let step = [over(dq), over(du), over(dv)];
        let [du, dv] = [up(value(at, 0)), up(value(at, 1))];
        Self {
            at: [up(q).wrapping_sub(step[0]), du.wrapping_sub(step[1]), dv.wrapping_sub(step[2])],
            step,
            uv: (0, 0),
            u: Scale::new::<SMALL>(planes.first()),
            v: Scale::new::<SMALL>(planes.get(1)),
            back: back as u32,
            log_step,
            before,
            length,
            z: 0,
            dz_dx: primitive.dz_dx,
        }
    }

    /// Hands the parts of a span whose coordinates are straight enough to `draw`, with their steppers, in a shader that
    /// divides every `step` pixels. Returns what is left, if anything is: pixels that have to be divided one by one.
    #[inline(always)]
    pub(crate) fn each_straight_part<'s, P: PixelFormat, V: Varyings, U, Z>(
        mut span: Span<'s, P, V, U, Z>,
        step: usize,
        mut draw: impl FnMut(Span<'s, P, V, U, Z>, &mut Self),
    ) -> Option<Span<'s, P, V, U, Z>> {
        // Half the step may do at one end of the span, if coordinates are not straight enough there.
        let mut log_step = Self::log_step(span.primitive, step);
        let longest = log_step;
        while log_step > 0 {
            let length = span.color.len().min(span.depth.len());
            let halvings = longest - log_step;
            let mut stepper = Self::begin(span.primitive, span.position, length, log_step, halvings);
            let straight = stepper.length();
            if straight == length {
                draw(span, &mut stepper);
                return None;
            }
            if straight > 0 {
                let (first, rest) = span.split_at(stepper.before())?;
                let (straight, last) = rest.split_at(straight)?;
                draw(straight, &mut stepper);
                span = if first.color.is_empty() { last } else { first };
            }
            log_step -= 1;
        }
        Some(span)
    }

    /// Returns the number of pixels of the span before those that the stepper is for.
    #[inline(always)]
    pub(crate) fn before(&self) -> usize {
        self.before
    }

    /// Returns the number of pixels of the span that the stepper is for.
    #[inline(always)]
    pub(crate) fn length(&self) -> usize {
        self.length
    }

    /// Computes u and v at the stepper's position.
    #[inline(always)]
    fn divided<const SMALL: bool>(&self) -> (i32, i32) {
        let [q, mut u, mut v] = self.at;
        let (u, v) = 'quotients: {
            let mut q = q as u32;
            if q >> 31 == 0 {
                if q == 0 {
                    break 'quotients (u, v);
                }
                while q >> 31 == 0 {
                    (q, u, v) = (q << 1, u << 1, v << 1);
                }
            }
            let q = CoarseDivisor::of_normalized::<SMALL>(q);
            (q.divide_normalized::<SMALL>(u), q.divide_normalized::<SMALL>(v))
        };
        (self.u.scaled::<SMALL>(u), self.v.scaled::<SMALL>(v))
    }

    /// Moves on by one run, and returns the word and the step with which that run is drawn, from its first column on.
    /// Out of line: it has more values than the loop around it has registers for.
    #[inline(never)]
    pub(super) fn next_run(&mut self) -> (u32, u32) {
        self.next_run_on::<SMALL_CORE, false>()
    }

    /// Does as [`next_run`](Self::next_run), for a small core or another one. `WHOLE` says that runs have 16 pixels.
    #[inline(always)]
    pub(super) fn next_run_on<const SMALL: bool, const WHOLE: bool>(&mut self) -> (u32, u32) {
        let [q, u, v] = self.at;
        let [dq, du, dv] = self.step;
        self.at = [q.wrapping_add(dq), u.wrapping_add(du), v.wrapping_add(dv)];
        let (from, to) = (self.uv, self.divided::<SMALL>());
        self.uv = to;
        let log_step = if WHOLE { RUN.trailing_zeros() } else { self.log_step & 31 };
        let half = 1 << log_step >> 1;
        let per_pixel = |from: i32, to: i32| to.wrapping_sub(from).wrapping_add(half) >> log_step;
        (packed(from), step([per_pixel(from.0, to.0), per_pixel(from.1, to.1)]))
    }
}

/// Returns the number of steps to leave out before the straight ones of a span, and the number of the straight ones.
/// q is given at both `ends` of `steps` steps, and changes by `change` over one.
#[cold]
#[inline(never)]
fn straight_steps([mut from, mut to]: [i32; 2], steps: i32, change: i32, least: u32) -> (i32, i32) {
    let (mut skipped, mut left) = (0, steps);
    while left > 0 && !is_straight(from as u32, least) {
        (skipped, left, from) = (skipped + 1, left - 1, from.wrapping_add(change));
    }
    while left > 0 && !is_straight(to as u32, least) {
        (left, to) = (left - 1, to.wrapping_sub(change));
    }
    (skipped, left)
}

/// Scale that takes a coordinate from its interpolated form h back to 16.16.
#[derive(Debug)]
struct Scale {
    /// Half of the last bit that stays after the shift, which rounds. On cores with long products it is multiplied by
    /// 4.
    half: i32,
    /// Number of bits to shift by. On cores with long products, 2³⁰ shifted right by that number.
    by: i32,
    /// Coordinate for h = 0.
    base: i32,
}

impl Scale {
    const EMPTY: Self = Self { half: 0, by: 0, base: 0 };

    #[inline(always)]
    fn new<const SMALL: bool>(plane: Option<&PerspectivePlane>) -> Self {
        let (base, shift) = plane.map_or((0, 0), |plane| (plane.base, plane.shift & 31));
        if SMALL {
            Self { half: (1 << shift) >> 1, by: shift as i32, base }
        } else {
            Self { half: 2 << shift & !3, by: 1 << 30 >> shift, base }
        }
    }

    /// Scales `h` back and adds the base, rounded to nearest.
    ///
    /// # Format
    /// |`h`| is below 2²⁹, because d q is below 3/16 q, and without perspective below 2²⁶ + 2²⁸; shifts are at most 26.
    #[inline(always)]
    fn scaled<const SMALL: bool>(&self, h: i32) -> i32 {
        if SMALL {
            self.base.wrapping_add(h.wrapping_add(self.half) >> (self.by & 31))
        } else {
            // A long product shifts, in two instructions with the sum.
            let h = (h << 2).wrapping_add(self.half);
            self.base.wrapping_add(((i64::from(h) * i64::from(self.by)) >> 32) as i32)
        }
    }
}

/// Packs u and v into one word. v is as if nothing had been carried from u.
#[inline(always)]
const fn packed((u, v): (i32, i32)) -> u32 {
    ((v as u32) << 16).wrapping_add(u as u32 & 0xFFFF)
}

/// Packs the steps of u and v into one word, which steps both. Carries from u go into v, up or down.
#[inline(always)]
const fn step([du, dv]: [i32; 2]) -> u32 {
    ((dv as u32) << 16).wrapping_add(du as u32)
}

#[cfg(test)]
impl UvStepper {
    /// Makes a stepper without perspective. It is at `u` and `v`, and moves on by `du` and `dv`.
    pub(super) fn straight([u, v]: [i32; 2], [du, dv]: [i32; 2]) -> Self {
        let scale = || Scale::new::<SMALL_CORE>(None);
        let (at, step) = ([0, u, v], [0, du, dv]);
        Self { at, step, uv: (u, v), u: scale(), v: scale(), log_step: 4, ..Self::EMPTY }
    }
}

#[cfg(test)]
mod tests {
    use super::super::perspective::Corrected;
    use super::*;
    use crate::math::random::Rng;
    use crate::vertex::{Perspective, Side};

    /// Makes a primitive of two coordinates, as extreme as a stepper takes them: the greatest differences, the greatest
    /// change of q over a run, and bases from all over the numbers. Returns the pixels of a span, too.
    fn extreme(rng: &mut Rng, log_step: u32) -> (Primitive<Perspective<2, 3>>, i32, usize) {
        let mut random = || rng.next_u32();
        let (x, length) = ((random() % 300) as i32, 1 + (random() % 200) as usize);
        let affine = random() % 8 == 0;
        let mut primitive = Primitive::constant(Perspective::<2, 3>::ZERO, 0, Side::Front, ());
        let ends = [x, x + length as i32 - 1];
        // q within a factor of 2⁹ over the span, or nearly constant.
        let spread = if affine { 0 } else { random() % 10 };
        let q = [0, 1].map(|_| (1 << 30 | random() >> 2) >> random().checked_rem(spread + 1).unwrap_or(0));
        let q = if affine { [q[0] | 1 << 30; 2] } else { q };
        let way = (ends[1] - ends[0]).max(1);
        let dq = ((i64::from(q[1]) - i64::from(q[0])) / i64::from(way)) as i32;
        // d q is at most a thirty-second of q at both ends of the span, and changes as much as that allows.
        let least = ((q[0].min(q[1]) / 2) >> (log_step + 3)) as i32;
        let mut along = || {
            let mut end = |q: u32| ((i64::from(random() as i32) * i64::from(q)) >> 36) as i32;
            let [from, to] = q.map(&mut end);
            if length == 1 {
                (from, end(least as u32 * 32))
            } else {
                (from, ((i64::from(to) - i64::from(from)) / i64::from(way)) as i32)
            }
        };
        let (u, v) = (along(), along());
        primitive.d_dx.as_mut().copy_from_slice(&[u.1, v.1, dq]);
        let origin = |at: i32, change: i32| at.wrapping_sub(change.wrapping_mul(x));
        let (u, v) = (origin(u.0, u.1), origin(v.0, v.1));
        primitive.at_origin.as_mut().copy_from_slice(&[u, v, origin(q[0] as i32, dq)]);
        if let Some((class, _, planes)) = primitive.perspective.parts_mut() {
            *class = if affine { PerspectiveClass::Affine } else { PerspectiveClass::Planes32 };
            for plane in planes {
                (plane.base, plane.shift) = (random() as i32, 1 + random() % 26);
            }
        }
        let most = primitive.d_dx.as_ref().iter().map(|change| change.unsigned_abs()).max().unwrap_or(0);
        let fits = most >> (28 - log_step) == 0;
        primitive.perspective.set_least_straight(if fits { most << (log_step + 3) } else { u32::MAX });
        (primitive, x, length)
    }

    /// Returns the number of divided steps that a span is a part of.
    fn runs(x: i32, length: usize, log_step: u32) -> i32 {
        ((x + length as i32 - 1) >> log_step) - (x >> log_step) + 1
    }

    /// Both kinds of core step and divide alike, bit by bit, at any value that a stepper takes.
    #[test]
    fn small_cores_and_others_have_the_same_words() {
        let mut rng = Rng::new(14);
        let mut begun = 0;
        for case in 0..200_000 {
            let log_step = 1 + case % 5;
            let (primitive, x, length) = extreme(&mut rng, log_step);
            if UvStepper::log_step(&primitive, 1 << log_step) == 0 {
                continue;
            }
            let mut small = UvStepper::begin_on::<true, _, _>(&primitive, (x, 0), length, log_step, 0);
            let mut other = UvStepper::begin_on::<false, _, _>(&primitive, (x, 0), length, log_step, 0);
            assert_eq!((small.length, small.before), (other.length, other.before), "{case}");
            if other.length > 0 {
                begun += 1;
                let mut whole = UvStepper::begin_on::<false, _, _>(&primitive, (x, 0), length, log_step, 0);
                // One more: steppers begin a step before the first column.
                for _ in 0..=runs(x + small.before as i32, other.length, log_step) {
                    let word = other.next_run_on::<false, false>();
                    assert_eq!(small.next_run_on::<true, false>(), word, "{case}: {primitive:?}");
                    if 1 << log_step == RUN {
                        assert_eq!(whole.next_run_on::<false, true>(), word, "{case}: {primitive:?}");
                    }
                }
            }
        }
        assert!(begun > 50_000, "{begun}");
    }

    #[test]
    fn steppers_are_where_divisors_are() {
        let mut rng = Rng::new(1);
        let mut begun = 0;
        for case in 0..20_000 {
            let log_step = 1 + case % 5;
            let (primitive, x, length) = extreme(&mut rng, log_step);
            if UvStepper::log_step(&primitive, 1 << log_step) == 0 {
                continue;
            }
            let mut stepper = UvStepper::begin(&primitive, (x, 0), length, log_step, 0);
            let (x, length) = (x + stepper.before as i32, stepper.length);
            if length == 0 {
                continue;
            }
            stepper.next_run();
            begun += 1;
            let first = x >> log_step << log_step;
            let mut exact = Corrected::new(&primitive, (first, 0));
            for _ in 0..runs(x, length, log_step) {
                let (found, expected) = ([stepper.uv.0, stepper.uv.1], exact.varyings().corrected());
                for ((found, expected), plane) in found.iter().zip(expected).zip(primitive.perspective.planes()) {
                    let quotient = i64::from(expected.wrapping_sub(plane.base)).abs();
                    let bound = (quotient >> 18) + (200 >> plane.shift) + 1;
                    let off = i64::from(found.wrapping_sub(expected)).abs();
                    assert!(off <= bound, "{case}: {off} units, not {bound}");
                }
                stepper.next_run();
                exact.advance(1 << log_step);
            }
        }
        assert!(begun > 5_000, "{begun}");
    }
}
