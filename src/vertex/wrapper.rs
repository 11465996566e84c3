//! Shaders around other shaders: a [`Wrapper`] names the shader inside, and gets its vertex stage from it.

use super::clip_distance::MAX_DISTANCES;
use super::shader::{Face, VertexRef, VertexShader};
use crate::math::Vec3;

/// A shader around another one, whose vertex stage it leaves as it is: fog, blending, an alpha test.
///
/// A wrapper is a [`VertexShader`] already. It implements [`Shader`](crate::span::Shader) itself, and forwards
/// [`Shader::setup`](crate::span::Shader::setup).
///
/// ```
/// use zstrip::color::PixelFormat;
/// use zstrip::span::{Fragment, Shader, TriangleSetup};
/// use zstrip::vertex::Wrapper;
///
/// /// Draws every other row of a shader's pixels.
/// struct Interlaced<S>(S);
///
/// impl<S: zstrip::vertex::VertexShader> Wrapper for Interlaced<S> {
///     type Inner = S;
///
///     fn inner(&self) -> &S {
///         &self.0
///     }
/// }
///
/// impl<P: PixelFormat, S: Shader<P>> Shader<P> for Interlaced<S> {
///     const STEP: usize = S::STEP;
///     type Setup = S::Setup;
///
///     fn setup(&self, triangle: &TriangleSetup<'_, S::Varyings>) -> S::Setup {
///         self.0.setup(triangle)
///     }
///
///     fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
///         if fragment.position.1 & 1 == 0 { self.0.fragment(fragment) } else { None }
///     }
/// }
/// ```
pub trait Wrapper {
    /// Type of the shader inside.
    type Inner: VertexShader;

    /// Returns the shader inside.
    fn inner(&self) -> &Self::Inner;
}

impl<W: Wrapper> VertexShader for W {
    type Varyings = <W::Inner as VertexShader>::Varyings;
    const WORDS: usize = W::Inner::WORDS;
    const ZERO_BITS: u32 = W::Inner::ZERO_BITS;
    const DISPLACES: bool = W::Inner::DISPLACES;
    const CLIP_DISTANCES: usize = W::Inner::CLIP_DISTANCES;
    const CULL_DISTANCES: usize = W::Inner::CULL_DISTANCES;
    const IS_TOLERANT: bool = W::Inner::IS_TOLERANT;

    #[inline]
    fn tolerance(&self) -> u32 {
        self.inner().tolerance()
    }

    #[inline]
    fn vertex(&self, vertex: &VertexRef<'_>) -> Self::Varyings {
        self.inner().vertex(vertex)
    }

    #[inline]
    fn displace(&self, vertex: &VertexRef<'_>) -> Vec3 {
        self.inner().displace(vertex)
    }

    #[inline]
    fn distances(&self, vertex: &VertexRef<'_>) -> [i32; MAX_DISTANCES] {
        self.inner().distances(vertex)
    }

    #[inline]
    fn face(&self, face: &Face<'_>) -> u32 {
        self.inner().face(face)
    }

    #[inline]
    fn shape(&self, word: u32) -> u32 {
        self.inner().shape(word)
    }

    #[inline]
    fn store(varyings: &Self::Varyings, words: &mut [u32]) {
        W::Inner::store(varyings, words);
    }

    #[inline]
    fn load(words: &[u32]) -> Self::Varyings {
        W::Inner::load(words)
    }
}
