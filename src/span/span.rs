//! A span of pixels, and what is interpolated along it.

use crate::color::PixelFormat;
use crate::vertex::{PerspectiveSetup, Side, Varyings};

/// A fragment that passed the depth test: what the fragment stage sees of it.
#[derive(Clone, Copy, Debug)]
pub struct Fragment<'a, V> {
    /// The triangle's word, from [`VertexShader::face`](crate::vertex::VertexShader::face).
    pub flat: u32,
    /// Varyings at the pixel's centre.
    pub varyings: &'a V,
    /// The pixel, from the screen's top left corner.
    pub position: (i32, i32),
    /// Depth, 0 near, 65,535 far.
    pub depth: u16,
    /// Which side of the triangle is seen.
    pub side: Side,
    /// What [`Shader::level`](crate::span::Shader::level) made of the triangle.
    pub level: u32,
}

/// The pixels of a span and everything that is interpolated along it.
#[derive(Debug)]
pub struct Fragments<'a, P: PixelFormat, V: Varyings, Z> {
    /// Colours, to be written where the depth test passes.
    pub color: &'a mut [P::Raw],
    /// Stored depths, as many ([`DepthTest::Depth`](crate::span::DepthTest::Depth)).
    pub depth: &'a mut [Z],
    /// Depth at the first pixel, 16.16, with the half that rounds it already added.
    pub z: u32,
    /// Varyings at the first pixel; perspective-correct ones as what is linear on the screen, for [`Corrected`](crate::span::Corrected).
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
    pub perspective: V::PerspectiveSetup,
    /// What [`Shader::prepare`](crate::span::Shader::prepare) made of them.
    pub words: [u32; 3],
    /// Which side of the triangle is seen.
    pub side: Side,
    /// What [`Shader::level`](crate::span::Shader::level) made of it.
    pub level: u32,
}

impl<V: Varyings> Steps<V> {
    /// Of something that is linear on the screen, and no triangle: from row to row, nothing changes.
    #[inline]
    pub const fn linear(dz_dx: i32, d_dx: V, words: [u32; 3], side: Side) -> Self {
        let (corner, d_dy) = (V::ZERO, V::ZERO);
        Self { dz_dx, corner, d_dy, d_dx, perspective: V::PerspectiveSetup::NONE, words, side, level: 0 }
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
    /// Stored depths, as many ([`DepthTest::Depth`](crate::span::DepthTest::Depth)).
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
