//! The fragment stage's seam, and the loop over the pixels of a span.

use super::{DepthTest, PixelFormat};
use crate::geometry::VertexShader;

/// The pixels of a span and everything that is interpolated along it.
#[derive(Debug)]
pub struct Fragments<'a, P: PixelFormat, V, Z> {
    /// Colours, to be written where the depth test passes.
    pub color: &'a mut [P::Raw],
    /// Stored depths, as many ([`DepthTest::Stored`]).
    pub depth: &'a mut [Z],
    /// Depth at the first pixel, 16.16, with the half that rounds it already added.
    pub z: u32,
    /// Varyings at the first pixel.
    pub varyings: V,
    /// How depth and varyings change.
    pub steps: &'a Steps<V>,
    /// Position of the first pixel on the screen.
    pub position: (i32, i32),
}

/// What all spans of a triangle share.
#[derive(Clone, Copy, Debug)]
pub struct Steps<V> {
    /// Change of depth a pixel, modulo 2³².
    pub dz_dx: i32,
    /// Change of the varyings a pixel, modulo 2³².
    pub d_dx: V,
    /// What [`Shader::prepare`] made of them.
    pub words: [u32; 2],
}

/// The programmable fragment stage: colours pixels of format `P`.
///
/// A shader is compiled into the pixel loop; nothing is called indirectly.
pub trait Shader<P: PixelFormat>: VertexShader {
    /// The colour of a fragment, from the triangle's word and the varyings at the pixel's centre.
    fn fragment(&self, face: u32, varyings: &Self::Varyings) -> P::Raw;

    /// Whatever of the span loop's work can be done once a triangle: called before its spans with the varyings at one of
    /// its pixels, which may be moved (all of its spans will be), and with their changes a pixel. Yields words for the
    /// spans.
    #[inline]
    fn prepare(&self, varyings: &mut Self::Varyings, d_dx: &Self::Varyings) -> [u32; 2] {
        let _ = (varyings, d_dx);
        [0; 2]
    }

    /// Draws a span, by default fragment by fragment. Override it where a whole span can be drawn faster.
    #[inline]
    fn span<D: DepthTest>(&self, face: u32, span: Fragments<'_, P, Self::Varyings, D::Stored>, test: D) {
        fragments(self, face, span, test);
    }
}

/// Draws a span fragment by fragment.
#[inline(always)]
pub(super) fn fragments<P: PixelFormat, S: Shader<P> + ?Sized, D: DepthTest>(
    shader: &S,
    face: u32,
    span: Fragments<'_, P, S::Varyings, D::Stored>,
    test: D,
) {
    let Fragments { color, depth, mut z, mut varyings, steps, .. } = span;
    for (color, depth) in color.iter_mut().zip(depth) {
        if !D::ENABLED || test.passes((z >> 16) as u16, depth) {
            *color = shader.fragment(face, &varyings);
        }
        z = z.wrapping_add_signed(steps.dz_dx);
        for (value, step) in varyings.as_mut().iter_mut().zip(steps.d_dx.as_ref()) {
            *value = value.wrapping_add(*step);
        }
    }
}
