//! Perspective-correct varyings, along a span: one reciprocal for each pixel, or for each few of them.
//!
//! ```text
//! span    ├───────────────┼───────────────┼───────────────┼─────┤
//! divided ●               ●               ●               ●     ●      linear in between
//!         first pixel     + STEP          + 2 STEP        ..    last pixel
//! ```
//! Both ends of a span are pixels of the triangle, so nothing is ever divided by what q = 1 / w is outside of it. At the ends
//! varyings are exact, and so they are on both sides of an edge that two triangles share: no seam, whatever the step.

use super::span::Primitive;
use crate::math::{Divisor, mul_high_signed};
use crate::vertex::{PerspectiveClass, PerspectivePlane, PerspectiveSetup, Varyings};

/// Perspective-correct varyings at a pixel, and a way to the next ones.
#[derive(Clone, Copy, Debug)]
pub struct Corrected<'a, V: Varyings> {
    perspective: &'a V::PerspectiveSetup,
    d_dx: &'a V,
    /// d q, linear ones, q.
    at: V,
    /// The pixel: where the planes are taken for triangles that take 64 bits.
    position: (i32, i32),
}

impl<'a, V: Varyings> Corrected<'a, V> {
    /// Starts at a pixel of a primitive.
    #[inline]
    pub fn new<T>(primitive: &'a Primitive<V, T>, position: (i32, i32)) -> Self {
        Self { perspective: &primitive.perspective, d_dx: &primitive.d_dx, at: primitive.at(position), position }
    }

    /// Goes on by `pixels`.
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

/// Puts the varyings at a pixel in the place of what is linear.
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

/// Replaces each value by what it says of the varying: h, from `quotient`, scaled back.
#[inline]
fn correct(values: &mut [i32], planes: &[PerspectivePlane], quotient: impl Fn(i32, &PerspectivePlane) -> i32) {
    for (value, plane) in values.iter_mut().zip(planes) {
        let h = quotient(*value, plane);
        // To nearest; the shift is at most 30.
        *value = plane.base.wrapping_add(h.wrapping_add((1 << plane.shift) >> 1) >> plane.shift);
    }
}

/// 2³² / n, for steps of n pixels.
static PARTS: [u32; 33] = {
    let mut parts = [u32::MAX; 33];
    let mut n = 2;
    while n < 33 {
        parts[n] = ((1_u64 << 32) / n as u64) as u32;
        n += 1;
    }
    parts
};

/// `difference` / `n`, within a unit, for n in 1..=32.
#[inline]
pub(super) fn nth(difference: i32, n: usize) -> i32 {
    let part = PARTS.get(n).copied().unwrap_or(0);
    if n == 1 { difference } else { mul_high_signed(difference, part) }
}
