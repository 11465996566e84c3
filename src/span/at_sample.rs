//! Any shader → a shader that paints one sample of each pixel.

use super::sample::Sample;
use super::shader::Shader;
use super::span::{Fragment, TriangleSetup};
use crate::color::PixelFormat;
use crate::vertex::{VertexShader, Wrapper};

/// A shader whose fragments are painted at a sample.
pub(crate) struct AtSample<'s, S> {
    pub(crate) shader: &'s S,
    pub(crate) sample: Sample,
}

impl<S: VertexShader> Wrapper for AtSample<'_, S> {
    type Inner = S;

    #[inline(always)]
    fn inner(&self) -> &S {
        self.shader
    }
}

impl<P: PixelFormat, S: Shader<P>> Shader<P> for AtSample<'_, S> {
    const STEP: usize = S::STEP;
    type Setup = S::Setup;

    #[inline(always)]
    fn setup(&self, triangle: &TriangleSetup<'_, S::Varyings>) -> S::Setup {
        self.shader.setup(triangle)
    }

    #[inline(always)]
    fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
        self.shader.fragment(fragment)
    }

    #[inline(always)]
    fn paint(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>, pixel: &mut P::Raw) -> bool {
        self.shader.paint_at(self.sample, fragment, pixel)
    }
}
