//! Perspective-correct varyings, along a span: one reciprocal for each pixel, or for each few of them.
//!
//! ```text
//! span    ├───────────────┼───────────────┼───────────────┼─────┤
//! divided ●               ●               ●               ●     ●      linear in between
//!         first pixel     + STEP          + 2 STEP        ..    last pixel
//! ```
//! Both ends of a span are pixels of the triangle, so nothing is ever divided by what q = 1 / w is outside of it. At the ends
//! varyings are exact, and so they are on both sides of an edge that two triangles share: no seam, whatever the step.

use super::{DepthTest, Fragment, Fragments, PixelFormat, Shader, Steps};
use crate::geometry::{Correction, Lane, PerspectiveClass, Varyings};
use crate::math::{Divisor, mul_high_signed};

/// Perspective-correct varyings at a pixel, and a way to the next ones.
#[derive(Clone, Copy, Debug)]
pub struct Corrected<'a, V: Varyings> {
    steps: &'a Steps<V>,
    /// d q, linear ones, q.
    at: V,
    /// The pixel: where the planes are taken for triangles that take 64 bits.
    position: (i32, i32),
}

impl<'a, V: Varyings> Corrected<'a, V> {
    /// At the first pixel of a span.
    #[inline]
    pub fn new(varyings: V, steps: &'a Steps<V>, position: (i32, i32)) -> Self {
        Self { steps, at: varyings, position }
    }

    /// Goes on by as many pixels.
    #[inline]
    pub fn advance(&mut self, pixels: i32) {
        self.at.advance(&self.steps.d_dx, pixels);
        self.position.0 = self.position.0.wrapping_add(pixels);
    }

    /// The varyings here.
    #[inline]
    pub fn varyings(&self) -> V {
        let mut varyings = self.at;
        correct_at(self.steps, self.position, &mut varyings);
        varyings
    }
}

/// Puts the varyings at a pixel in the place of what is linear.
#[inline(never)]
fn correct_at<V: Varyings>(steps: &Steps<V>, position: (i32, i32), varyings: &mut V) {
    let (lanes, values) = (steps.correction.varyings(), varyings.as_mut());
    match steps.correction.class() {
        PerspectiveClass::Affine => correct(values, lanes, |h, _| h),
        PerspectiveClass::Narrow => {
            let [.., q] = *values else { return };
            let q = Divisor::new(q as u32);
            correct(values, lanes, |dq, _| q.divide(dq));
        }
        PerspectiveClass::Wide => {
            let q = steps.correction.wide_w().at(position) as u64;
            let shift = q.leading_zeros() & 63;
            let q = Divisor::new(((q << shift) >> 32) as u32);
            correct(values, lanes, |_, lane| q.divide_shifted(((lane.plane.at(position) << shift) >> 32) as i32));
        }
    }
}

/// Replaces each value by what it says of the varying: h, from `quotient`, scaled back.
#[inline]
fn correct(values: &mut [i32], lanes: &[Lane], quotient: impl Fn(i32, &Lane) -> i32) {
    for (value, lane) in values.iter_mut().zip(lanes) {
        let h = quotient(*value, lane);
        // To nearest; the shift is at most 30.
        *value = lane.base.wrapping_add(h.wrapping_add((1 << lane.shift) >> 1) >> lane.shift);
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

/// Draws a span fragment by fragment. Out of line, for its stack is not needed where a shader has a faster loop.
#[inline(never)]
pub(super) fn corrected_fragments<P: PixelFormat, S: Shader<P> + ?Sized, D: DepthTest>(
    shader: &S,
    face: u32,
    mut span: Fragments<'_, P, S::Varyings, D::Stored>,
    test: D,
) {
    const { assert!(S::STEP.is_power_of_two() && S::STEP <= 32, "steps are 1, 4, 8, 16 or 32 pixels") };
    let mut varyings = span.varyings;
    correct_at(span.steps, span.position, &mut varyings);
    let mut run = Run { span: &mut span, face, varyings, change: varyings, next: varyings, test };
    while !run.span.color.is_empty() {
        let pixels = run.aim(S::STEP);
        run.draw(shader, pixels);
    }
}

/// Pixels between two that are divided.
struct Run<'a, 's, P: PixelFormat, V: Varyings, D: DepthTest> {
    /// What is left of the span. Varyings are what is linear, at the end of the run.
    span: &'a mut Fragments<'s, P, V, D::Stored>,
    face: u32,
    varyings: V,
    change: V,
    /// The varyings at the end of the run.
    next: V,
    test: D,
}

impl<P: PixelFormat, V: Varyings, D: DepthTest> Run<'_, '_, P, V, D> {
    /// Aims at where the next run ends: at the next pixel that is divided, or the last one. Yields how many pixels it has.
    #[inline(never)]
    fn aim(&mut self, step: usize) -> usize {
        let Self { span, varyings, change, next, .. } = self;
        let pixels = span.color.len().min(step);
        let way = if span.color.len() > step { step } else { pixels.wrapping_sub(1) };
        *varyings = *next;
        span.varyings.advance(&span.steps.d_dx, way as i32);
        *next = span.varyings;
        correct_at(span.steps, (span.position.0.wrapping_add(way as i32), span.position.1), next);
        let ends = varyings.as_ref().iter().zip(next.as_ref());
        for (change, (from, to)) in change.as_mut().iter_mut().zip(ends) {
            *change = if way == 0 { 0 } else { nth(to.wrapping_sub(*from), way) };
        }
        pixels
    }

    /// Draws that many pixels. Out of line, for what divides needs no stack meanwhile.
    #[inline(never)]
    fn draw<S: Shader<P, Varyings = V> + ?Sized>(&mut self, shader: &S, pixels: usize) {
        let Self { span, face, varyings, change, test, .. } = self;
        let Some((colors, rest)) = core::mem::take(&mut span.color).split_at_mut_checked(pixels) else { return };
        let Some((depths, depth_rest)) = core::mem::take(&mut span.depth).split_at_mut_checked(pixels) else { return };
        (span.color, span.depth) = (rest, depth_rest);
        for (color, stored) in colors.iter_mut().zip(depths) {
            let depth = (span.z >> 16) as u16;
            if !D::ENABLED || test.passes(depth, *stored) {
                let (position, side, level) = (span.position, span.steps.side, span.steps.level);
                let fragment = Fragment { face: *face, varyings: &*varyings, position, depth, side, level };
                if shader.paint(&fragment, color) {
                    test.write(depth, stored);
                }
            }
            span.position.0 = span.position.0.wrapping_add(1);
            span.z = span.z.wrapping_add_signed(span.steps.dz_dx);
            varyings.step(change);
        }
    }
}
