//! One colour per face.

use crate::color::{PixelFormat, channels, packed, unpacked};
use crate::light::Light;
use crate::span::{DepthTest, Fragment, Shader, SpanOf, flat_span};
use crate::vertex::{Face, VertexRef, VertexShader};

/// Flat shading: each triangle in one colour, lit by its face normal.
///
/// The colour is the shader's, or that of the provoking vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flat {
    /// Red, green and blue in a word, blue lowest; otherwise the provoking vertices'.
    color: Option<u32>,
    light: Option<Light>,
}

impl Flat {
    /// Creates a shader of one colour under a light (given in object space, see [`Light::to_object`]).
    #[must_use]
    pub fn new(light: Light, color: impl Into<embedded_graphics_core::pixelcolor::Rgb888>) -> Self {
        Self { color: Some(packed(channels(color.into()))), light: Some(light) }
    }

    /// Creates a shader of one colour without light.
    #[must_use]
    pub fn unlit(color: impl Into<embedded_graphics_core::pixelcolor::Rgb888>) -> Self {
        Self { color: Some(packed(channels(color.into()))), light: None }
    }

    /// Creates a shader of the vertices' colours as they are: each triangle takes that of its provoking vertex.
    #[must_use]
    pub const fn vertex_colors() -> Self {
        Self { color: None, light: None }
    }

    /// Creates a shader of the vertices' colours under a light: each triangle takes that of its provoking vertex.
    #[must_use]
    pub const fn colors(light: Light) -> Self {
        Self { color: None, light: Some(light) }
    }
}

impl VertexShader for Flat {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    /// Returns the colour, 8 bits per channel, blue lowest.
    #[inline]
    fn face(&self, face: &Face<'_>) -> u32 {
        let color = match self.color {
            Some(color) => color,
            None => packed(face.provoking().color()),
        };
        match &self.light {
            Some(light) => light.shade(color, face.normal()),
            None => color,
        }
    }
}

impl<P: PixelFormat> Shader<P> for Flat {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        Some(P::pack_at(unpacked(fragment.flat), fragment.position))
    }

    #[inline]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        flat_span(span, test);
    }
}
