//! Perspective-correct varyings along a span, with one reciprocal per pixel or per several pixels.
//!
//! ```text
//! span    ├───────────────┼───────────────┼───────────────┼─────┤
//! divided ●               ●               ●               ●     ●      linear in between
//!         first pixel     + STEP          + 2 STEP        ..    last pixel
//! ```
//! Both ends of a span are pixels of the triangle, so no value is ever divided by a q = 1 / w from outside of the
//! triangle. At the ends varyings are exact, and so they are on both sides of an edge that two triangles share. So no
//! choice of `STEP` makes a seam.

use super::span::Primitive;
use crate::math::{Divisor, mul_high_signed};
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

/// Table of 2³² / n, for steps of n pixels.
static INVERSES: [u32; 33] = {
    let mut inverses = [u32::MAX; 33];
    let mut n = 2;
    while n < 33 {
        inverses[n] = ((1_u64 << 32) / n as u64) as u32;
        n += 1;
    }
    inverses
};

/// Computes `difference` / `pixels`, within one unit, for 1 to 32 pixels.
#[inline]
pub(super) fn per_pixel(difference: i32, pixels: usize) -> i32 {
    let inverse = INVERSES.get(pixels).copied().unwrap_or(0);
    if pixels == 1 { difference } else { mul_high_signed(difference, inverse) }
}
