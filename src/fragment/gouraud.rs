//! Colours a vertex, interpolated over the triangle.

use super::flat::channels;
use super::{PixelFormat, Shader};
use crate::geometry::{Corner, Light, Lit, VertexShader};
use embedded_graphics_core::pixelcolor::Rgb888;

/// Gouraud shading: lit at the vertices, by the mesh's normals, and interpolated linearly on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Gouraud {
    light: Option<Light>,
    /// One colour for the whole mesh, lit; otherwise the mesh's colours count.
    lit: Option<Lit>,
}

impl Gouraud {
    /// One colour under a light (given in object space, see [`Light::to_object`]).
    pub fn new(light: Light, color: impl Into<Rgb888>) -> Self {
        Self {
            light: Some(light),
            lit: Some(light.on(channels(color.into()))),
        }
    }

    /// The colours of the mesh's vertices under a light.
    pub const fn colors(light: Light) -> Self {
        Self {
            light: Some(light),
            lit: None,
        }
    }

    /// The colours of the mesh's vertices as they are.
    pub const fn unlit() -> Self {
        Self { light: None, lit: None }
    }
}

/// Half a step of the 8-bit channels in 8.16, so that cutting the fraction rounds.
const HALF: i32 = 1 << 15;

impl VertexShader for Gouraud {
    /// Red, green, blue in 8.16, [`HALF`] added; so always in 0.5..=255.5.
    type Varyings = [i32; 3];

    /// All three in one word: red 8.2, green and blue 8.3; off by at most 1/8 of 255.
    const WORDS: usize = 1;

    const ZERO_BITS: u32 = 13;

    #[inline]
    fn vertex(&self, vertex: &Corner<'_>) -> [i32; 3] {
        let rgb = match (self.lit, self.light) {
            (Some(lit), _) => lit.shade(vertex.normal()),
            (None, Some(light)) => light.on(vertex.color()).shade(vertex.normal()),
            (None, None) => vertex.color().map(|c| i32::from(c) << 8),
        };
        rgb.map(|c| (c << 8) + HALF)
    }

    #[inline]
    fn store(rgb: &[i32; 3], words: &mut [u32]) {
        let [r, g, b] = rgb.map(|c| c - HALF);
        // Rounded: 255.0, the largest value, stays in range.
        let packed = ((r + (1 << 13)) >> 14) << 22 | ((g + (1 << 12)) >> 13) << 11 | (b + (1 << 12)) >> 13;
        if let [word] = words {
            *word = packed as u32;
        }
    }

    #[inline]
    fn load(words: &[u32]) -> [i32; 3] {
        let word = words.first().copied().unwrap_or(0);
        let channel = |bits: u32| (bits << 13) as i32 + HALF;
        [
            channel(word >> 22 << 1),
            channel((word >> 11) & 0x7FF),
            channel(word & 0x7FF),
        ]
    }
}

impl<P: PixelFormat> Shader<P> for Gouraud {
    #[inline]
    fn fragment(&self, _: u32, rgb: &[i32; 3]) -> P::Raw {
        P::pack(rgb.map(|c| (c >> 16) as u8))
    }
}
