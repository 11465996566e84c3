//! Colours per vertex, interpolated over the triangle.

use super::vertex_colors::VertexColors;
use crate::color::{channels, load, squeeze, store};
use crate::light::{Light, Lit};
use crate::vertex::{VertexRef, VertexShader};
use embedded_graphics_core::pixelcolor::Rgb888;

/// Gouraud shading: lit at the vertices, by the mesh's normals, and interpolated linearly on the screen. A mesh without
/// normals shows the ambient light only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gouraud {
    colors: Colors,
}

/// Source of the colours of vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Colors {
    /// One for the whole mesh, lit.
    One(Lit),
    /// The mesh's, lit.
    Lit(Light),
    /// The mesh's, as they are.
    Unlit,
}

impl Gouraud {
    /// Creates a shader of one colour under a light (given in object space, see [`Light::to_object`]).
    #[must_use]
    pub fn new(light: Light, color: impl Into<Rgb888>) -> Self {
        Self { colors: Colors::One(light.on(channels(color.into()))) }
    }

    /// Creates a shader of the vertices' colours under a light.
    #[must_use]
    pub const fn colors(light: Light) -> Self {
        Self { colors: Colors::Lit(light) }
    }

    /// Returns the varyings of a vertex that has this colour.
    #[must_use]
    #[inline]
    pub fn varyings(color: Rgb888) -> [i32; 3] {
        let [r, g, b] = channels(color);
        [squeeze(i32::from(r) << 8), squeeze(i32::from(g) << 8), squeeze(i32::from(b) << 8)]
    }

    /// Creates a shader of the vertices' colours as they are.
    #[must_use]
    pub const fn vertex_colors() -> Self {
        Self { colors: Colors::Unlit }
    }
}

impl VertexShader for Gouraud {
    /// Red, green, blue in 8.16, squeezed to 0.5..=254.5.
    type Varyings = [i32; 3];

    /// All three in one word: red 8.2, green and blue 8.3; off by at most 1/8 of 255.
    const WORDS: usize = 1;

    const ZERO_BITS: u32 = 13;

    #[inline]
    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 3] {
        // Spelled out: at `opt-level = "s"`, `map` is a loop through memory.
        let [r, g, b] = match &self.colors {
            Colors::One(lit) => lit.shade(vertex.normal()),
            Colors::Lit(light) => light.on(vertex.color()).shade(vertex.normal()),
            Colors::Unlit => {
                let [r, g, b] = vertex.color();
                [i32::from(r) << 8, i32::from(g) << 8, i32::from(b) << 8]
            }
        };
        [squeeze(r), squeeze(g), squeeze(b)]
    }

    #[inline]
    fn store(rgb: &[i32; 3], words: &mut [u32]) {
        store(rgb, words);
    }

    #[inline]
    fn load(words: &[u32]) -> [i32; 3] {
        load(words)
    }
}

impl VertexColors for Gouraud {}
