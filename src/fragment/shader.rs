//! The fragment stage's seam, and the loop over the pixels of a span.

use super::perspective::corrected_fragments;
use super::{AnyDepth, DepthState, DepthTest, PixelFormat};
use crate::geometry::{Correction, FEW, Side, Varyings, VertexShader};

/// A fragment that passed the depth test: what the fragment stage sees of it.
#[derive(Clone, Copy, Debug)]
pub struct Fragment<'a, V> {
    /// The triangle's word, from [`VertexShader::face`].
    pub face: u32,
    /// Varyings at the pixel's centre.
    pub varyings: &'a V,
    /// The pixel, from the screen's top left corner.
    pub position: (i32, i32),
    /// Depth, 0 near, 65,535 far.
    pub depth: u16,
    /// Which side of the triangle is seen.
    pub side: Side,
    /// What [`Shader::level`] made of the triangle.
    pub level: u32,
}

/// The pixels of a span and everything that is interpolated along it.
#[derive(Debug)]
pub struct Fragments<'a, P: PixelFormat, V: Varyings, Z> {
    /// Colours, to be written where the depth test passes.
    pub color: &'a mut [P::Raw],
    /// Stored depths, as many ([`DepthTest::Stored`]).
    pub depth: &'a mut [Z],
    /// Depth at the first pixel, 16.16, with the half that rounds it already added.
    pub z: u32,
    /// Varyings at the first pixel; perspective-correct ones as what is linear on the screen, for [`Corrected`](super::Corrected).
    pub varyings: V,
    /// How depth and varyings change.
    pub steps: &'a Steps<V>,
    /// Position of the first pixel on the screen.
    pub position: (i32, i32),
}

/// What all spans of a triangle share.
#[derive(Clone, Copy, Debug)]
pub struct Steps<V: Varyings> {
    /// Change of depth a pixel, modulo 2³².
    pub dz_dx: i32,
    /// Of a triangle: varyings at the screen's corner, modulo 2³².
    pub corner: V,
    /// Of a triangle: change of the varyings a row, modulo 2³².
    pub d_dy: V,
    /// Change of the varyings a pixel, modulo 2³².
    pub d_dx: V,
    /// What to make of perspective-correct ones.
    pub correction: V::Correction,
    /// What [`Shader::prepare`] made of them.
    pub words: [u32; 3],
    /// Which side of the triangle is seen.
    pub side: Side,
    /// What [`Shader::level`] made of it.
    pub level: u32,
}

impl<V: Varyings> Steps<V> {
    /// Of something that is linear on the screen, and no triangle: from row to row, nothing changes.
    #[inline]
    pub const fn linear(dz_dx: i32, d_dx: V, words: [u32; 3], side: Side) -> Self {
        let (corner, d_dy) = (V::ZERO, V::ZERO);
        Self { dz_dx, corner, d_dy, d_dx, correction: V::Correction::NONE, words, side, level: 0 }
    }

    /// Varyings of a triangle at a pixel. Other spans come with theirs.
    #[inline(always)]
    pub fn at(&self, (x, y): (i32, i32)) -> V {
        let mut values = self.corner;
        values.advance(&self.d_dy, y);
        values.advance(&self.d_dx, x);
        values
    }
}

/// [`Fragments`] of a triangle, whose varyings have not been worked out: a loop over short spans has no registers for it.
#[derive(Debug)]
pub struct TriangleSpan<'a, P: PixelFormat, V: Varyings, Z> {
    /// Colours, to be written where the depth test passes.
    pub color: &'a mut [P::Raw],
    /// Stored depths, as many ([`DepthTest::Stored`]).
    pub depth: &'a mut [Z],
    /// Depth at the first pixel, 16.16, with the half that rounds it already added.
    pub z: u32,
    /// How depth and varyings change.
    pub steps: &'a Steps<V>,
    /// Position of the first pixel on the screen.
    pub position: (i32, i32),
}

impl<'a, P: PixelFormat, V: Varyings, Z> TriangleSpan<'a, P, V, Z> {
    /// With its varyings.
    #[inline(always)]
    pub fn fragments(self) -> Fragments<'a, P, V, Z> {
        let Self { color, depth, z, steps, position } = self;
        Fragments { color, depth, z, varyings: steps.at(position), steps, position }
    }
}

/// The programmable fragment stage: colours pixels of format `P`.
///
/// A shader is compiled into the pixel loop; nothing is called indirectly.
pub trait Shader<P: PixelFormat>: VertexShader {
    /// For how many pixels perspective-correct varyings are taken as linear: 1 divides at each pixel; 4, 8, 16 or 32 at
    /// every so many of them and at both ends of a span, which is faster, and off by little: see
    /// [`Perspective`](crate::geometry::Perspective).
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
    fn triangle_span<D: DepthTest>(&self, face: u32, span: TriangleSpan<'_, P, Self::Varyings, D::Stored>, test: D) {
        self.span(face, span.fragments(), test);
    }

    /// Draws a span, by default fragment by fragment. Override it where a whole span can be drawn faster.
    #[inline]
    fn span<D: DepthTest>(&self, face: u32, span: Fragments<'_, P, Self::Varyings, D::Stored>, test: D) {
        fragments(self, face, span, test);
    }
}

/// Pixels of a span that are drawn at a time where there are no depths.
const CHUNK: usize = 16;

/// Draws a span fragment by fragment.
#[inline]
pub(super) fn fragments<P: PixelFormat, S: Shader<P> + ?Sized, D: DepthTest>(
    shader: &S,
    face: u32,
    span: Fragments<'_, P, S::Varyings, D::Stored>,
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
    mut span: Fragments<'_, P, S::Varyings, D::Stored>,
    test: D,
) {
    // Varyings stay where they are.
    let Fragments { ref mut color, ref mut depth, z, ref mut varyings, steps, position } = span;
    let mut pixels = Pixels { face, z, varyings, steps, position, test: AnyDepth::new(DepthState::OFF) };
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
    test: AnyDepth,
}

/// Draws a span fragment by fragment, in the one loop that a shader is compiled into.
#[inline(never)]
fn linear_fragments<P: PixelFormat, S: Shader<P> + ?Sized>(
    shader: &S,
    color: &mut [P::Raw],
    depth: &mut [u16],
    pixels: &mut Pixels<'_, S::Varyings>,
) {
    if <S::Varyings as Varyings>::LEN > FEW {
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
            let fragment = Fragment { face: *face, varyings: &**varyings, position: *position, depth, side, level };
            if shader.paint(&fragment, color) {
                test.write(depth, stored);
            }
        }
        position.0 = position.0.wrapping_add(1);
        *z = z.wrapping_add_signed(steps.dz_dx);
        varyings.step(&steps.d_dx);
    }
}
