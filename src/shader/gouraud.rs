//! Colours per vertex, interpolated over the triangle.

use super::surface::Surface;
use super::vertex_colors::VertexColors;
use crate::color::{load, squeeze, store};
use crate::light::{LitColor, Unlit};
use crate::vertex::{VertexRef, VertexShader};
use embedded_graphics_core::pixelcolor::Rgb888;

/// Gouraud shading: colours of the [`Surface`] at the vertices, interpolated linearly on the screen.
///
/// It takes the normals of the mesh. Without normals, a mesh shows the ambient light only.
///
/// ```
/// use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, WebColors};
/// use zstrip::light::{Material, Sun};
/// use zstrip::math::{Affine, Vec3};
/// use zstrip::shader::Gouraud;
/// let sun = Sun::new(Vec3::from_ints(4, 7, 6), Rgb888::CSS_LIGHT_GRAY, Rgb888::CSS_DIM_GRAY);
/// let lit = Gouraud::new(sun.on(&Material::matte(Rgb888::CSS_CORAL), &Affine::IDENTITY));
/// let plain = Gouraud::vertex_colors();
/// # let _ = (lit, plain);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gouraud<S = Unlit> {
    surface: S,
}

impl<S: Surface> Gouraud<S> {
    /// Returns the shader of a surface.
    #[must_use]
    pub const fn new(surface: S) -> Self {
        Self { surface }
    }
}

impl Gouraud {
    /// Returns the shader of the mesh's colours without light.
    #[must_use]
    pub const fn vertex_colors() -> Self {
        Self { surface: Unlit::vertex_colors() }
    }

    /// Returns the varyings of a vertex of a colour.
    #[inline]
    pub fn varyings(color: Rgb888) -> [i32; 3] {
        squeezed(LitColor::from(color))
    }
}

/// Makes varyings of a colour.
#[inline(always)]
fn squeezed(color: LitColor) -> [i32; 3] {
    // Spelled out: at `opt-level = "s"`, `map` is a loop through memory.
    let [r, g, b] = color.to_bits();
    [squeeze(r), squeeze(g), squeeze(b)]
}

impl<S: Surface> VertexShader for Gouraud<S> {
    /// Red, green, blue in 8.16, squeezed to 0.5..=254.5.
    type Varyings = [i32; 3];

    /// All three in one word: red 8.2, green and blue 8.3; off by at most 1/8 of 255.
    const WORDS: usize = 1;

    const ZERO_BITS: u32 = 13;

    #[inline]
    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 3] {
        squeezed(self.surface.vertex(vertex))
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

impl<S: Surface> VertexColors for Gouraud<S> {}
