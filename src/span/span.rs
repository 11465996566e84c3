//! Spans of pixels, and what the fragment stage is handed.

use crate::color::PixelFormat;
use crate::vertex::{PerspectiveSetup, Side, Varyings};

/// A fragment that passed the depth test, as [`Shader::fragment`](crate::span::Shader::fragment) sees it.
#[derive(Clone, Copy, Debug)]
pub struct Fragment<'a, V, T = ()> {
    /// The triangle's word, from [`VertexShader::face`](crate::vertex::VertexShader::face).
    pub flat: u32,
    /// Varyings at the pixel's centre.
    pub varyings: &'a V,
    /// The pixel, from the screen's top left corner.
    pub position: (i32, i32),
    /// Depth, 0 near, 65,535 far.
    pub depth: u16,
    /// Side of the triangle that is seen.
    pub side: Side,
    /// Data of the triangle, from [`Shader::setup`](crate::span::Shader::setup).
    pub setup: &'a T,
}

/// A triangle as [`Shader::setup`](crate::span::Shader::setup) sees it. Lines and points are set up as well.
#[derive(Clone, Copy, Debug)]
pub struct TriangleSetup<'a, V> {
    /// Varyings at the vertices, as the vertex stage made them. A line hands over its two ends, the second one twice; a point
    /// its only vertex three times.
    pub corners: [&'a V; 3],
    /// Twice the area on the screen, in 2⁻¹⁶ px²; 0 for lines and points.
    pub area: u64,
    /// The triangle's word, from [`VertexShader::face`](crate::vertex::VertexShader::face).
    pub flat: u32,
    /// Side of the triangle that is seen.
    pub side: Side,
    /// Varyings at the pixel in the screen's top left corner, modulo 2³². Perspective-correct ones are kept in a form of the
    /// pipeline's own.
    pub at_origin: &'a V,
    /// Change of the varyings from a pixel to the next one on the right, modulo 2³²; of a line, to its next pixel.
    pub d_dx: &'a V,
}

/// All that the spans of a triangle, a line or a point have in common: plane equations, and data of the shader.
#[derive(Clone, Copy, Debug)]
pub struct Primitive<V: Varyings, T = ()> {
    /// Change of depth from a pixel to the next one on the right, 16.16, modulo 2³².
    pub dz_dx: i32,
    /// Data of the shader, from [`Shader::setup`](crate::span::Shader::setup).
    pub setup: T,
    /// Change of the varyings from a row to the next one, modulo 2³².
    pub d_dy: V,
    /// Change of the varyings from a pixel to the next one on the right, modulo 2³².
    pub d_dx: V,
    /// Varyings at the pixel in the screen's top left corner, modulo 2³².
    pub at_origin: V,
    /// Turns what is linear on the screen into perspective-correct varyings.
    pub(crate) perspective: V::PerspectiveSetup,
    /// Side of the triangle that is seen.
    pub side: Side,
    /// The triangle's word, from [`VertexShader::face`](crate::vertex::VertexShader::face).
    pub flat: u32,
}

impl<V: Varyings, T> Primitive<V, T> {
    /// Returns a primitive whose depth and varyings are the same at all of its pixels.
    #[inline]
    pub(crate) const fn constant(varyings: V, flat: u32, side: Side, setup: T) -> Self {
        let perspective = V::PerspectiveSetup::NONE;
        Self { dz_dx: 0, at_origin: varyings, d_dy: V::ZERO, d_dx: V::ZERO, perspective, setup, side, flat }
    }

    /// Computes the varyings at a pixel. Perspective-correct ones come as what is linear on the screen, for
    /// [`Corrected`](crate::span::Corrected).
    #[inline(always)]
    pub fn at(&self, (x, y): (i32, i32)) -> V {
        let mut values = self.at_origin;
        values.advance(&self.d_dy, y);
        values.advance(&self.d_dx, x);
        values
    }
}

/// Pixels side by side in a row, all of one primitive.
///
/// Varyings are not among its fields: a loop over many short spans has no registers for them, so
/// [`varyings`](Self::varyings) computes them where they are wanted.
#[derive(Debug)]
pub struct Span<'a, P: PixelFormat, V: Varyings, T, Z> {
    /// Colours, to be written where the depth test passes.
    pub color: &'a mut [P::Raw],
    /// Stored depths, one per colour ([`DepthTest::Depth`](crate::span::DepthTest::Depth)).
    pub depth: &'a mut [Z],
    /// Depth at the first pixel, 16.16, with the half that rounds it already added.
    pub z: u32,
    /// Position of the first pixel on the screen.
    pub position: (i32, i32),
    /// The triangle, line or point that the span is a part of.
    pub primitive: &'a Primitive<V, T>,
}

impl<P: PixelFormat, V: Varyings, T, Z> Span<'_, P, V, T, Z> {
    /// Computes the varyings at the first pixel. Perspective-correct ones come as what is linear on the screen, for
    /// [`Corrected`](crate::span::Corrected).
    #[inline(always)]
    #[must_use]
    pub fn varyings(&self) -> V {
        self.primitive.at(self.position)
    }
}
