//! Depth without colour.

use crate::color::PixelFormat;
use crate::span::{DepthTest, Fragment, Shader, Span, SpanOf};
use crate::vertex::{VertexRef, VertexShader};

/// Writes depths and no colours: a mesh drawn with it keeps the pixels that are there, and hides everything behind it
/// that is drawn later. So a mesh hides its own lines, for instance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DepthOnly;

impl VertexShader for DepthOnly {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }
}

impl<P: PixelFormat> Shader<P> for DepthOnly {
    type Setup = ();

    /// Returns no colour: there is none.
    fn fragment(&self, _: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        None
    }

    /// Keeps the pixel as it is, and counts as drawn, so that its depth is written. Smooth strokes ask per pixel.
    #[inline(always)]
    fn paint(&self, _: &Fragment<'_, [i32; 0]>, _: &mut P::Raw) -> bool {
        true
    }

    #[inline]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        if !D::ENABLED {
            return;
        }
        let Span { depth, mut z, primitive, .. } = span;
        for stored in depth {
            let depth = (z >> 16) as u16;
            if test.passes(depth, *stored) {
                test.write(depth, stored);
            }
            z = z.wrapping_add_signed(primitive.dz_dx);
        }
    }
}
