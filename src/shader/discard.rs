//! Shaders that discard fragments: the alpha test and the screen door.

use crate::color::{PixelFormat, Rgba8888};
use crate::span::{Fragment, Shader, TriangleSetup};
use crate::vertex::{VertexShader, Wrapper};

/// Draws the fragments whose alpha is at least a threshold, opaque: leaves, fences, letters. The order of draws is
/// free.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AlphaTest<S> {
    shader: S,
    threshold: u8,
}

impl<S> AlphaTest<S> {
    /// Wraps a shader; `threshold` is the least alpha that is drawn.
    #[must_use]
    pub const fn new(shader: S, threshold: u8) -> Self {
        Self { shader, threshold }
    }
}

impl<S: VertexShader> Wrapper for AlphaTest<S> {
    type Inner = S;

    #[inline(always)]
    fn inner(&self) -> &S {
        &self.shader
    }
}

impl<P: PixelFormat, S: Shader<Rgba8888>> Shader<P> for AlphaTest<S> {
    const STEP: usize = S::STEP;
    type Setup = S::Setup;

    #[inline(always)]
    fn setup(&self, triangle: &TriangleSetup<'_, S::Varyings>) -> S::Setup {
        self.shader.setup(triangle)
    }

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
        let [r, g, b, alpha] = self.shader.fragment(fragment)?;
        if alpha >= self.threshold { Some(P::pack_at([r, g, b], fragment.position)) } else { None }
    }
}

/// Bayer's matrix of order 4: one word per row, column x in its bits 4x to 4x + 3.
const PATTERN: [u16; 4] = [0xA280, 0x6E4C, 0x91B3, 0x5D7F];

/// Draws some of the fragments, in a regular pattern of 4 by 4 pixels that is fixed to the screen. This transparency
/// reads no pixel, writes depth, and needs no order of draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScreenDoor<S> {
    shader: S,
    opacity: u8,
}

impl<S> ScreenDoor<S> {
    /// Wraps a shader and draws `opacity` of each 16 pixels.
    #[must_use]
    pub const fn new(shader: S, opacity: u8) -> Self {
        Self { shader, opacity }
    }
}

impl<S: VertexShader> Wrapper for ScreenDoor<S> {
    type Inner = S;

    #[inline(always)]
    fn inner(&self) -> &S {
        &self.shader
    }
}

impl<P: PixelFormat, S: Shader<P>> Shader<P> for ScreenDoor<S> {
    const STEP: usize = S::STEP;
    type Setup = S::Setup;

    #[inline(always)]
    fn setup(&self, triangle: &TriangleSetup<'_, S::Varyings>) -> S::Setup {
        self.shader.setup(triangle)
    }

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
        let (x, y) = fragment.position;
        let row = PATTERN[(y & 3) as usize];
        let place = row >> (4 * (x & 3)) & 15;
        if place < u16::from(self.opacity) { self.shader.fragment(fragment) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::PATTERN;

    #[test]
    fn the_pattern_has_each_place_once_and_spreads_them() {
        let at = |x: usize, y: usize| PATTERN[y % 4] >> (4 * (x % 4)) & 15;
        for opacity in 0..=16_u16 {
            let drawn = (0..16).filter(|k| at(k % 4, k / 4) < opacity).count();
            assert_eq!(drawn, usize::from(opacity));
        }
        for k in 0..16 {
            // Half of them are a chequerboard; a quarter has no neighbours, not even across corners.
            let (x, y) = (k % 4, k / 4);
            assert_eq!(at(x, y) < 8, (x + y) % 2 == 0, "{x}, {y}");
            if at(x, y) < 4 {
                let around = [(1, 0), (0, 1), (1, 1), (3, 1)];
                assert!(around.iter().all(|(dx, dy)| at(x + dx, y + dy) >= 4), "{x}, {y}");
            }
        }
    }
}
