//! Spans of pixels, primitives that spans are a part of, and the fragments that a shader is asked about.

use crate::color::PixelFormat;
use crate::vertex::{PerspectiveSetup, Side, Varyings};

/// A fragment that passed the depth test, as [`Shader::fragment`](crate::span::Shader::fragment) sees it.
#[derive(Clone, Copy, Debug)]
pub struct Fragment<'a, V, T = ()> {
    /// Word of the triangle, from [`VertexShader::face`](crate::vertex::VertexShader::face).
    pub flat: u32,
    /// Varyings at the centre of the pixel.
    pub varyings: &'a V,
    /// Position of the pixel, from the screen's top left corner.
    pub position: (i32, i32),
    /// Depth: 0 is near, 65,535 far.
    pub depth: u16,
    /// Side of the triangle that the viewer sees.
    pub side: Side,
    /// Data of the triangle, from [`Shader::setup`](crate::span::Shader::setup).
    pub setup: &'a T,
}

/// A triangle as [`Shader::setup`](crate::span::Shader::setup) sees it. Lines and points are handed over in this form
/// too.
#[derive(Clone, Copy, Debug)]
pub struct TriangleSetup<'a, V: Varyings> {
    /// Varyings at the vertices, as the vertex stage returned them. A line has its second end twice; a point has its
    /// only vertex three times.
    pub corners: [&'a V; 3],
    /// Twice the area on the screen, in 2⁻¹⁶ px²; 0 for lines and points.
    pub area: u64,
    /// Word of the triangle, from [`VertexShader::face`](crate::vertex::VertexShader::face).
    pub flat: u32,
    /// Side of the triangle that the viewer sees.
    pub side: Side,
    /// Varyings at the pixel in the screen's top left corner, modulo 2³². Perspective-correct varyings are in an
    /// internal form here.
    pub at_origin: &'a V,
    /// Change of the varyings from a pixel to its right neighbour, modulo 2³². For a line, it is the change from a
    /// pixel of the line to the next one.
    pub d_dx: &'a V,
    /// Change of the varyings from a pixel to its lower neighbour, modulo 2³²; 0 for lines and points.
    pub d_dy: &'a V,
    /// The pixel of the first vertex. It may lie outside of the screen.
    pub position: (i32, i32),
    /// Data that turns values that are linear on the screen into perspective-correct varyings.
    pub(crate) perspective: &'a V::PerspectiveSetup,
}

impl<'a, V: Varyings> TriangleSetup<'a, V> {
    /// Describes a primitive to a shader, which makes the primitive's setup of it.
    #[inline(always)]
    pub(crate) const fn new<T>(
        primitive: &'a Primitive<V, T>,
        corners: [&'a V; 3],
        area: u64,
        position: (i32, i32),
    ) -> Self {
        let Primitive { flat, side, at_origin, d_dx, d_dy, perspective, .. } = primitive;
        Self { corners, area, flat: *flat, side: *side, at_origin, d_dx, d_dy, position, perspective }
    }
}

/// Data that all spans of a triangle, a line or a point share: plane equations, and data of the shader.
#[derive(Clone, Copy, Debug)]
pub struct Primitive<V: Varyings, T = ()> {
    /// Change of depth from a pixel to its right neighbour, 16.16, modulo 2³².
    pub dz_dx: i32,
    /// Data of the shader, from [`Shader::setup`](crate::span::Shader::setup).
    pub setup: T,
    /// Change of the varyings from a pixel to its lower neighbour, modulo 2³².
    pub d_dy: V,
    /// Change of the varyings from a pixel to its right neighbour, modulo 2³².
    pub d_dx: V,
    /// Varyings at the pixel in the screen's top left corner, modulo 2³².
    pub at_origin: V,
    /// Data that turns values that are linear on the screen into perspective-correct varyings.
    pub(crate) perspective: V::PerspectiveSetup,
    /// Side of the triangle that the viewer sees.
    pub side: Side,
    /// Word of the triangle, from [`VertexShader::face`](crate::vertex::VertexShader::face).
    pub flat: u32,
}

/// Moves values to the right and down by parts of a pixel, 24.8, modulo 2³².
#[inline(never)]
pub(super) fn shift<V: Varyings>(values: &mut V, (d_dx, right): (&V, i32), (d_dy, down): (&V, i32)) {
    // Both parts of a change by themselves, because their sum times a part of a pixel may not fit.
    let part = |change: i32, by: i32| (change >> 8).wrapping_mul(by).wrapping_add(((change & 0xFF) * by) >> 8);
    for ((value, dx), dy) in values.as_mut().iter_mut().zip(d_dx.as_ref()).zip(d_dy.as_ref()) {
        *value = value.wrapping_add(part(*dx, right)).wrapping_add(part(*dy, down));
    }
}

impl<V: Varyings, T> Primitive<V, T> {
    /// Returns a primitive whose depth and varyings are the same at all of its pixels.
    #[inline]
    pub(crate) const fn constant(varyings: V, flat: u32, side: Side, setup: T) -> Self {
        let perspective = V::PerspectiveSetup::NONE;
        Self { dz_dx: 0, at_origin: varyings, d_dy: V::ZERO, d_dx: V::ZERO, perspective, setup, side, flat }
    }

    /// Computes the varyings at a pixel. Perspective-correct varyings are returned in an internal form that is linear
    /// on the screen; [`Corrected`](crate::span::Corrected) computes the varyings themselves.
    #[inline(always)]
    pub fn at(&self, (x, y): (i32, i32)) -> V {
        let mut values = self.at_origin;
        values.advance(&self.d_dy, y);
        values.advance(&self.d_dx, x);
        values
    }
}

/// Pixels of one primitive that are side by side in a row.
///
/// Varyings are no field: a loop over many short spans has no registers for them, so [`varyings`](Self::varyings)
/// computes them on demand.
#[derive(Debug)]
pub struct Span<'a, P: PixelFormat, V: Varyings, T, Z> {
    /// Colours. They are written where the depth test passes.
    pub color: &'a mut [P::Raw],
    /// Stored depths, one per colour ([`DepthTest::Depth`](crate::span::DepthTest::Depth)).
    pub depth: &'a mut [Z],
    /// Depth at the first pixel, 16.16. The half that rounds it is already added.
    pub z: u32,
    /// Position of the first pixel on the screen.
    pub position: (i32, i32),
    /// The triangle, line or point that the span is a part of.
    pub primitive: &'a Primitive<V, T>,
}

impl<'a, P: PixelFormat, V: Varyings, T, Z> Span<'a, P, V, T, Z> {
    /// Splits the span after `pixels` pixels; `None` if it has fewer of them.
    #[inline(always)]
    pub(crate) fn split_at(self, pixels: usize) -> Option<(Self, Self)> {
        let Self { color, depth, z, position: (x, y), primitive } = self;
        let (color, colors) = color.split_at_mut_checked(pixels)?;
        let (depth, depths) = depth.split_at_mut_checked(pixels)?;
        let next = z.wrapping_add_signed(primitive.dz_dx.wrapping_mul(pixels as i32));
        let position = (x.wrapping_add(pixels as i32), y);
        Some((
            Span { color, depth, z, position: (x, y), primitive },
            Span { color: colors, depth: depths, z: next, position, primitive },
        ))
    }

    /// Computes the varyings at the first pixel. Perspective-correct varyings are returned in an internal form that is
    /// linear on the screen; [`Corrected`](crate::span::Corrected) computes the varyings themselves.
    #[inline(always)]
    #[must_use]
    pub fn varyings(&self) -> V {
        self.primitive.at(self.position)
    }
}
