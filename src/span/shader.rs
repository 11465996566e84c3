//! The fragment stage's seam, and the loops over the pixels of a span.

use super::depth::{DepthDyn, DepthState, DepthTest};
use super::perspective::{correct_at, nth};
use super::span::{Fragment, Fragments, Steps, TriangleSpan};
use crate::color::PixelFormat;
use crate::vertex::{MAX_IN_REGISTERS, Varyings, VertexShader};

/// The programmable fragment stage: colours pixels of format `P`.
///
/// A shader is compiled into the pixel loop; nothing is called indirectly.
pub trait Shader<P: PixelFormat>: VertexShader {
    /// For how many pixels perspective-correct varyings are taken as linear: 1 divides at each pixel; 4, 8, 16 or 32 at
    /// every so many of them and at both ends of a span, which is faster, and off by little: see
    /// [`Perspective`](crate::vertex::Perspective).
    const STEP: usize = 1;

    /// The colour of a fragment that passed the depth test; `None` discards it, and leaves colour and depth as they were.
    fn fragment(&self, fragment: &Fragment<'_, Self::Varyings>) -> Option<P::Raw>;

    /// A word for the fragments of a triangle, from the varyings at its vertices and twice its area in 2⁻¹⁶ px²: a level of
    /// detail.
    #[inline(always)]
    fn level(&self, corners: &[Self::Varyings; 3], area: u64) -> u32 {
        let _ = (corners, area);
        0
    }

    /// Whatever of the span loop's work can be done once a triangle: called before its spans with the varyings at the
    /// screen's corner, modulo 2³² (or at a pixel, of what is no triangle), which may be moved (all of its spans will be), and with their
    /// changes a pixel. Yields words for the spans.
    #[inline]
    fn prepare(&self, varyings: &mut Self::Varyings, d_dx: &Self::Varyings) -> [u32; 3] {
        let _ = (varyings, d_dx);
        [0; 3]
    }

    /// Colours a pixel, or discards the fragment and says `false`. Only what blends with the pixel that is there has to
    /// override it.
    #[inline(always)]
    fn paint(&self, fragment: &Fragment<'_, Self::Varyings>, pixel: &mut P::Raw) -> bool {
        match self.fragment(fragment) {
            Some(value) => {
                *pixel = value;
                true
            }
            None => false,
        }
    }

    /// Draws a span of a triangle, by default as any other [`span`](Self::span). Override it, too, where most of what is drawn
    /// is a few pixels long and varyings are better worked out later, or not at all.
    ///
    /// Called for shaders of up to three varyings; spans of others come to [`span`](Self::span). One shader's goes with its
    /// [`prepare`](Self::prepare) and [`level`](Self::level): who hands one on hands on all.
    #[inline(always)]
    fn triangle_span<D: DepthTest>(&self, face: u32, span: TriangleSpan<'_, P, Self::Varyings, D::Depth>, test: D) {
        self.span(face, span.fragments(), test);
    }

    /// Draws a span, by default fragment by fragment. Override it where a whole span can be drawn faster.
    #[inline]
    fn span<D: DepthTest>(&self, face: u32, span: Fragments<'_, P, Self::Varyings, D::Depth>, test: D) {
        fragments(self, face, span, test);
    }
}

/// Pixels of a span that are drawn at a time where there are no depths.
const CHUNK: usize = 16;

/// Draws a span fragment by fragment.
#[inline]
pub(crate) fn fragments<P: PixelFormat, S: Shader<P> + ?Sized, D: DepthTest>(
    shader: &S,
    face: u32,
    span: Fragments<'_, P, S::Varyings, D::Depth>,
    test: D,
) {
    if S::Varyings::PERSPECTIVE > 0 {
        corrected_fragments(shader, face, span, test);
    } else {
        uncorrected_fragments(shader, face, span, test);
    }
}

#[inline(always)]
fn uncorrected_fragments<P: PixelFormat, S: Shader<P> + ?Sized, D: DepthTest>(
    shader: &S,
    face: u32,
    mut span: Fragments<'_, P, S::Varyings, D::Depth>,
    test: D,
) {
    // Varyings stay where they are.
    let Fragments { ref mut color, ref mut depth, z, ref mut varyings, steps, position } = span;
    let mut pixels = Pixels { face, z, varyings, steps, position, test: DepthDyn::new(DepthState::OFF) };
    if !D::ENABLED {
        return fragments_without_depth(shader, color, &mut pixels);
    }
    if let Some((test, depth)) = test.any(depth) {
        pixels.test = test;
        linear_fragments(shader, color, depth, &mut pixels);
    }
}

/// The same loop, with depths that are nobody's.
#[inline(never)]
fn fragments_without_depth<P: PixelFormat, S: Shader<P> + ?Sized>(
    shader: &S,
    color: &mut [P::Raw],
    pixels: &mut Pixels<'_, S::Varyings>,
) {
    let mut nothing = [0; CHUNK];
    for chunk in color.chunks_mut(CHUNK) {
        linear_fragments(shader, chunk, &mut nothing, pixels);
    }
}

/// Where [`linear_fragments`] is, and how it goes on.
struct Pixels<'a, V: Varyings> {
    face: u32,
    z: u32,
    varyings: &'a mut V,
    steps: &'a Steps<V>,
    position: (i32, i32),
    test: DepthDyn,
}

/// Draws a span fragment by fragment, in the one loop that a shader is compiled into.
#[inline(never)]
fn linear_fragments<P: PixelFormat, S: Shader<P> + ?Sized>(
    shader: &S,
    color: &mut [P::Raw],
    depth: &mut [u16],
    pixels: &mut Pixels<'_, S::Varyings>,
) {
    if <S::Varyings as Varyings>::LEN > MAX_IN_REGISTERS {
        return paint_pixels(shader, color, depth, pixels);
    }
    // Few varyings are walked where the compiler likes, many where they are.
    let mut varyings = *pixels.varyings;
    let Pixels { face, z, steps, position, test, .. } = *pixels;
    let mut own = Pixels { face, z, varyings: &mut varyings, steps, position, test };
    paint_pixels(shader, color, depth, &mut own);
    (pixels.z, pixels.position) = (own.z, own.position);
    *pixels.varyings = varyings;
}

#[inline(always)]
fn paint_pixels<P: PixelFormat, S: Shader<P> + ?Sized>(
    shader: &S,
    color: &mut [P::Raw],
    depth: &mut [u16],
    pixels: &mut Pixels<'_, S::Varyings>,
) {
    let Pixels { face, z, varyings, steps, position, test } = pixels;
    for (color, stored) in color.iter_mut().zip(depth) {
        let depth = (*z >> 16) as u16;
        if test.passes(depth, *stored) {
            let (side, level) = (steps.side, steps.level);
            let fragment = Fragment { flat: *face, varyings: &**varyings, position: *position, depth, side, level };
            if shader.paint(&fragment, color) {
                test.write(depth, stored);
            }
        }
        position.0 = position.0.wrapping_add(1);
        *z = z.wrapping_add_signed(steps.dz_dx);
        varyings.step(&steps.d_dx);
    }
}

/// Draws a span fragment by fragment. Out of line, for its stack is not needed where a shader has a faster loop.
#[inline(never)]
fn corrected_fragments<P: PixelFormat, S: Shader<P> + ?Sized, D: DepthTest>(
    shader: &S,
    face: u32,
    mut span: Fragments<'_, P, S::Varyings, D::Depth>,
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
    span: &'a mut Fragments<'s, P, V, D::Depth>,
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
                let fragment = Fragment { flat: *face, varyings: &*varyings, position, depth, side, level };
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
