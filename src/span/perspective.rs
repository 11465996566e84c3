//! Perspective-correct varyings along a span, with one reciprocal per pixel or per several pixels.
//!
//! ```text
//! columns 0       STEP    2 STEP  3 STEP  4 STEP          of the screen
//!         ├───────┼───────┼───────┼───────┼──
//! span            │  ├────┼───────┼──┤    │               the pixels that are drawn
//! divided         ●       ●       ●       ●               linear in between
//! ```
//! Columns at which varyings are divided are multiples of `STEP`, whichever of them the span holds. So a varying at a
//! pixel depends on the triangle's plane and on the pixel alone: a wall that leaves the screen and a viewport that cuts
//! it move no texel, and a clip plane moves texels by what the rounding of its corners to 1/256 px does. The first and
//! the last of these columns may lie outside of the triangle. That goes well where q = 1 / w and d q change little over
//! `STEP` columns ([`straight_log_step`]). Where they change more, half of `STEP` is tried, then a quarter, down to
//! each pixel. The change of q is also what makes the straight line differ from the curve, so nothing is off by more
//! than 1/34 of its change over `STEP` columns.

use super::span::Primitive;
use crate::math::Divisor;
use crate::vertex::{PerspectiveClass, PerspectivePlane, PerspectiveSetup, Varyings};

/// Perspective-correct varyings at a pixel, with what is needed to go on to other pixels of the row.
#[derive(Clone, Copy, Debug)]
pub struct Corrected<'a, V: Varyings> {
    perspective: &'a V::PerspectiveSetup,
    d_dx: &'a V,
    /// Values at the pixel: d q of each perspective-correct varying, then the linear varyings, then q.
    at: V,
    /// The pixel. Triangles that take 64 bits evaluate their planes there.
    position: (i32, i32),
}

impl<'a, V: Varyings> Corrected<'a, V> {
    /// Creates the varyings at a pixel of a primitive.
    #[inline]
    pub fn new<T>(primitive: &'a Primitive<V, T>, position: (i32, i32)) -> Self {
        Self { perspective: &primitive.perspective, d_dx: &primitive.d_dx, at: primitive.at(position), position }
    }

    /// Moves on by `pixels` to the right.
    #[inline]
    pub fn advance(&mut self, pixels: i32) {
        self.at.advance(self.d_dx, pixels);
        self.position.0 = self.position.0.wrapping_add(pixels);
    }

    /// Computes the varyings at the pixel.
    #[inline]
    pub fn varyings(&self) -> V {
        let mut varyings = self.at;
        correct_at::<V>(self.perspective, self.position, &mut varyings);
        varyings
    }
}

/// Replaces the values that are linear on the screen by the varyings at a pixel.
#[inline(never)]
pub(super) fn correct_at<V: Varyings>(perspective: &V::PerspectiveSetup, position: (i32, i32), varyings: &mut V) {
    let (planes, values) = (perspective.planes(), varyings.as_mut());
    match perspective.class() {
        PerspectiveClass::Affine => correct(values, planes, |h, _| h),
        PerspectiveClass::Planes32 => {
            let [.., q] = *values else { return };
            let q = Divisor::new(q as u32);
            correct(values, planes, |dq, _| q.divide(dq));
        }
        PerspectiveClass::Planes64 => {
            let q = perspective.inverse_w64().at(position) as u64;
            let shift = q.leading_zeros() & 63;
            let q = Divisor::new(((q << shift) >> 32) as u32);
            correct(values, planes, |_, plane| q.divide_shifted(((plane.wide.at(position) << shift) >> 32) as i32));
        }
    }
}

/// Replaces the linear value of each perspective-correct varying by the varying itself. `quotient` computes h, which is
/// scaled back and added to the plane's base.
#[inline]
fn correct(values: &mut [i32], planes: &[PerspectivePlane], quotient: impl Fn(i32, &PerspectivePlane) -> i32) {
    for (value, plane) in values.iter_mut().zip(planes) {
        let h = quotient(*value, plane);
        // The shift rounds to nearest; it is at most 30.
        *value = plane.base.wrapping_add(h.wrapping_add((1 << plane.shift) >> 1) >> plane.shift);
    }
}

/// Returns whether the column at which q is given may be one end of a straight part, in whose triangle `least` is the
/// least q of straight parts. q is in -2²⁸..2³¹ + 2²⁸, modulo 2³².
#[inline(always)]
pub(super) const fn is_straight(q: u32, least: u32) -> bool {
    least <= q && q < MOST_STRAIGHT
}

/// The end of the range of q at which a part may be straight. Numbers from there on are below 0.
pub(super) const MOST_STRAIGHT: u32 = 3 << 30;

/// Returns the binary logarithm of the distance of the columns at which varyings of a triangle are divided, where a
/// shader asks for `step`; 0 if the triangle's varyings are divided at each pixel. Its spans then need not look for
/// straight parts.
#[inline(always)]
pub(super) fn longest_log_step<V: Varyings>(perspective: &V::PerspectiveSetup, step: usize) -> u32 {
    if perspective.least_straight() == u32::MAX { 0 } else { step.trailing_zeros() }
}

/// Returns the binary logarithm of the greatest step, up to 1 << `log_step`, for which varyings may be taken as linear
/// between the two multiples of it around a pixel; 0 if the pixel has to be divided by itself. `linear` are the values
/// at the pixel that are linear on the screen.
#[inline(never)]
pub(super) fn straight_log_step<V: Varyings, T>(
    primitive: &Primitive<V, T>,
    linear: &V,
    (x, y): (i32, i32),
    log_step: u32,
) -> u32 {
    let (perspective, least) = (&primitive.perspective, primitive.perspective.least_straight());
    let (q, dq) = if perspective.class() == PerspectiveClass::Planes64 {
        let plane = perspective.inverse_w64();
        ((plane.at((x, y)) >> 32) as u32, (plane.dx >> 32) as i32)
    } else {
        let (Some(q), Some(dq)) = (linear.as_ref().last(), primitive.d_dx.as_ref().last()) else { return 0 };
        (*q as u32, *dq)
    };
    (1..=log_step).rev().find(|log| is_between(q, dq, x, *log, least, log_step)).unwrap_or(0)
}

/// Returns whether both columns around a pixel that are multiples of 1 << `log` are ends of a straight part.
#[inline(always)]
fn is_between(q: u32, dq: i32, x: i32, log: u32, least: u32, log_step: u32) -> bool {
    let least = least >> (log_step - log);
    let first = q.wrapping_sub(dq.wrapping_mul(x & ((1 << log) - 1)) as u32);
    is_straight(first, least) && is_straight(first.wrapping_add_signed(dq << log), least)
}
