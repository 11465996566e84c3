//! One colour per face.

use super::surface::Surface;
use crate::color::{PixelFormat, unpacked};
use crate::light::Unlit;
use crate::span::{DepthTest, Fragment, Shader, SmallResult, SmallTriangle, SpanOf, ValueBrush, flat_span};
use crate::vertex::{Face, VertexRef, VertexShader};
use embedded_graphics_core::pixelcolor::{IntoStorage, Rgb888};

/// Flat shading: each triangle has one colour, that of the [`Surface`] at the face.
///
/// ```
/// use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, WebColors};
/// use zstrip::light::{Material, Sun};
/// use zstrip::math::{Affine, Vec3};
/// use zstrip::shader::Flat;
/// let sun = Sun::new(Vec3::from_ints(4, 7, 6), Rgb888::CSS_LIGHT_GRAY, Rgb888::CSS_DIM_GRAY);
/// let lit = Flat::new(sun.on(&Material::matte(Rgb888::CSS_CORAL), &Affine::IDENTITY));
/// let plain = Flat::unlit(Rgb888::CSS_CORAL);
/// # let _ = (lit, plain);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flat<S = Unlit> {
    surface: S,
}

impl<S: Surface> Flat<S> {
    /// Returns the shader of a surface.
    #[must_use]
    pub const fn new(surface: S) -> Self {
        Self { surface }
    }
}

impl Flat {
    /// Returns the shader of a colour without light.
    #[must_use]
    pub fn unlit(color: impl Into<Rgb888>) -> Self {
        Self { surface: Unlit::new(color) }
    }

    /// Returns the shader of the mesh's colours without light: a triangle has the colour of its provoking vertex.
    #[must_use]
    pub const fn vertex_colors() -> Self {
        Self { surface: Unlit::vertex_colors() }
    }
}

impl<S: Surface> VertexShader for Flat<S> {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    /// Returns the colour, 8 bits per channel, blue lowest.
    #[inline]
    fn face(&self, face: &Face<'_>) -> u32 {
        self.surface.face(face).into_storage()
    }

    /// Returns the surface's own colour if it has one; otherwise `word`, as a colour.
    #[inline]
    fn shape(&self, word: u32) -> u32 {
        match self.surface.shape() {
            Some(color) => color.into_storage(),
            None => word,
        }
    }
}

impl<P: PixelFormat, S: Surface> Shader<P> for Flat<S> {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        Some(P::pack_at(unpacked(fragment.flat), fragment.position))
    }

    #[inline]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        flat_span(span, test);
    }

    #[inline(always)]
    fn small<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &[[i32; 0]; 3],
        flat: u32,
    ) -> SmallResult {
        if P::DITHER.is_some() {
            triangle.draw_spans(self, corners, flat)
        } else {
            triangle.draw(&ValueBrush(P::pack(unpacked(flat))))
        }
    }
}
