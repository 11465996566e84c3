//! Colours per vertex, interpolated over the triangle: the fragment stage of all shaders that make them.

use crate::color::{PixelFormat, unsqueeze};
use crate::span::{
    ChannelBrush, ColorSetup, DepthTest, Fragment, Shader, SmallResult, SmallTriangle, SpanOf, TriangleSetup,
    draw_fragments, luma_span, packed_span,
};
use crate::vertex::VertexShader;

/// A vertex stage whose varyings are colours: red, green and blue as
/// [`Gouraud::varyings`](crate::shader::Gouraud::varyings) makes them.
///
/// A type that implements it is a [`Shader`] for every pixel format, with the fastest loop that each format has.
pub trait VertexColors: VertexShader<Varyings = [i32; 3]> {}

impl<P: PixelFormat, S: VertexColors> Shader<P> for S {
    type Setup = ColorSetup;

    #[inline(always)]
    fn setup(&self, triangle: &TriangleSetup<'_, [i32; 3]>) -> ColorSetup {
        ColorSetup::new::<P>(triangle)
    }

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 3], ColorSetup>) -> Option<P::Raw> {
        // Spelled out: at `opt-level = "s"`, `map` is a loop through memory.
        let [r, g, b] = *fragment.varyings;
        Some(P::pack_at([unsqueeze(r), unsqueeze(g), unsqueeze(b)], fragment.position))
    }

    #[inline(always)]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        if P::PACKED {
            packed_span(span, test);
        } else if P::IS_LUMA {
            luma_span(span, test);
        } else {
            draw_fragments(self, span, test);
        }
    }

    #[inline(always)]
    fn small<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &[[i32; 3]; 3],
        flat: u32,
    ) -> SmallResult {
        if ChannelBrush::<P>::FITS {
            triangle.draw(&ChannelBrush::new(corners))
        } else {
            triangle.draw_spans(self, corners, flat)
        }
    }
}
