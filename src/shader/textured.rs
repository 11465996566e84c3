//! Textures as shaders: as they are, and on a surface under light.

use super::surface::Surface;
use crate::color::PixelFormat;
use crate::span::{DepthTest, Fragment, STEP, Shader, SpanOf, TriangleSetup, draw_fragments, texture_span};
use crate::texture::{Filter, Nearest, OPAQUE, Repeat, Texture, TextureError, Wrap};
use crate::vertex::{Perspective, PerspectiveClass, PerspectiveSetup, VertexRef, VertexShader};
use core::marker::PhantomData;
use embedded_graphics_core::geometry::Size;

/// The colours of a texture, perspective-correct: divided every 16 pixels and at both ends of a span.
///
/// The mesh's coordinates go from 0 to 1 over the texture; it repeats, and its nearest texels are shown, unless another
/// [`Wrap`] and [`Filter`] are chosen. Texels whose alpha is below one half are not drawn.
///
/// ```
/// use zstrip::shader::Textured;
/// use zstrip::texture::{Bilinear, Clamp, Tile};
/// static TILE: Tile<'static, 2, 2> = Tile::new(&[[0xFFFF, 0], [0, 0xFFFF]]);
/// let pixelated = Textured::new(&TILE);
/// let smooth = Textured::new(&TILE).wrap(Clamp).filter(Bilinear);
/// # let _ = (pixelated, smooth);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Textured<'a, T, W = Repeat, F = Nearest> {
    /// The texture, and smaller ones of half its size each.
    levels: &'a [T],
    how: PhantomData<(W, F)>,
}

impl<'a, T: Texture> Textured<'a, T> {
    /// Returns the shader of one texture for all sizes on the screen.
    #[must_use]
    pub const fn new(texture: &'a T) -> Self {
        Self { levels: core::slice::from_ref(texture), how: PhantomData }
    }

    /// Returns the shader of a mip chain: each level has half the size of the previous level, rounded down, at least 1.
    /// Each triangle takes the level whose texels are nearest in size to its pixels, and at least half as large.
    ///
    /// # Errors
    /// When a level has another size, or there are no levels.
    pub fn mipmapped(levels: &'a [T]) -> Result<Self, TextureError> {
        let mut sizes = levels.iter().map(Texture::size);
        let mut size = sizes.next().ok_or(TextureError::NoLevels)?;
        for found in sizes {
            let expected = Size::new((size.width / 2).max(1), (size.height / 2).max(1));
            if found != expected {
                return Err(TextureError::Size { found, expected });
            }
            size = found;
        }
        Ok(Self { levels, how: PhantomData })
    }
}

impl<'a, T: Texture, W: Wrap, F: Filter> Textured<'a, T, W, F> {
    /// Returns the shader with another rule for what is outside of the texture.
    #[must_use]
    pub const fn wrap<V: Wrap>(self, _: V) -> Textured<'a, T, V, F> {
        Textured { levels: self.levels, how: PhantomData }
    }

    /// Returns the shader with another filter.
    #[must_use]
    pub const fn filter<G: Filter>(self, _: G) -> Textured<'a, T, W, G> {
        Textured { levels: self.levels, how: PhantomData }
    }

    /// Multiplies the texels by the colours of a [`Surface`] at the vertices: texture × material × vertex colours ×
    /// light.
    ///
    /// Any surface will do: [`Unlit::vertex_colors`](crate::light::Unlit::vertex_colors) shows light that is baked into
    /// the mesh, `sun.on(&Matte::WHITE, &model)` the light of a sun. Highlights are multiplied by the texels too.
    ///
    /// Colours of the surface are interpolated linearly on the screen.
    #[must_use]
    pub const fn lit<S: Surface>(self, surface: S) -> LitTexture<'a, T, S, W, F> {
        LitTexture { texture: self, surface }
    }

    /// Returns a level by its number; there is always one.
    #[inline]
    fn level(&self, level: u32) -> Option<&'a T> {
        self.levels.get(level as usize)
    }

    /// Chooses the level for a triangle; lines and points take the first one.
    #[inline]
    fn level_of<const N: usize>(&self, triangle: &TriangleSetup<'_, Perspective<2, N>>) -> u32 {
        if self.levels.len() < 2 || triangle.area == 0 {
            return 0;
        }
        self.level_for(triangle.corners.map(Perspective::corrected), triangle.area)
    }

    /// The level whose texels have the size of pixels, or are up to half as large: from the areas of a triangle in
    /// texels and in pixels, by their numbers of bits.
    ///
    /// # Format
    /// `area` in 2⁻¹⁶ px², differences of coordinates are cut to 16.8 bits: products below 2⁴⁸, 2⁻¹⁶ of the texture.
    #[inline(never)]
    fn level_for(&self, uv: [[i32; 2]; 3], area: u64) -> u32 {
        let [a, b, c] = uv;
        let difference = |a: i32, b: i32| i64::from(b.wrapping_sub(a) >> 8);
        let texture = difference(a[0], b[0]) * difference(a[1], c[1]) - difference(a[0], c[0]) * difference(a[1], b[1]);
        let Some(Size { width, height }) = self.levels.first().map(Texture::size) else { return 0 };
        let bits = |n: u64| 64 - n.leading_zeros();
        // Half the bits of width and height are those of a square with the same area.
        let texels = (bits(texture.unsigned_abs()) + bits(width.into()) + bits(height.into())).saturating_sub(2);
        (texels.saturating_sub(bits(area)) / 2).min(self.levels.len().saturating_sub(1) as u32)
    }
}

impl<T, W, F> VertexShader for Textured<'_, T, W, F> {
    type Varyings = Perspective<2, 3>;

    #[inline]
    fn vertex(&self, corner: &VertexRef<'_>) -> Perspective<2, 3> {
        Perspective::new(corner.uv().map(|c| c.to_bits()), [])
    }
}

impl<P: PixelFormat, T: Texture, W: Wrap, F: Filter> Shader<P> for Textured<'_, T, W, F> {
    const STEP: usize = STEP;

    /// Number of the level.
    type Setup = u32;

    #[inline]
    fn setup(&self, triangle: &TriangleSetup<'_, Perspective<2, 3>>) -> u32 {
        self.level_of(triangle)
    }

    #[inline(always)]
    fn fragment(&self, fragment: &Fragment<'_, Perspective<2, 3>, u32>) -> Option<P::Raw> {
        let (texture, uv) = (self.level(*fragment.setup)?, fragment.varyings.corrected());
        if P::ALPHA || P::DITHER.is_some() {
            return visible::<P>(F::rgba::<T, W>(texture, uv), fragment.position);
        }
        F::pixel::<P, T, W>(texture, uv)
    }

    #[inline]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        match self.level(span.primitive.setup) {
            _ if P::ALPHA || P::DITHER.is_some() => draw_fragments(self, span, test),
            Some(texture)
                if W::REPEATS && F::NEAREST && span.primitive.perspective.class() != PerspectiveClass::Planes64 =>
            {
                texture_span(texture, span, test);
            }
            _ => draw_fragments(self, span, test),
        }
    }
}

/// A texture on a [`Surface`] under light: see [`Textured::lit`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LitTexture<'a, T, S, W = Repeat, F = Nearest> {
    texture: Textured<'a, T, W, F>,
    surface: S,
}

/// Texture coordinates 16.16; red, green and blue of the surface, 8.16, linear on the screen.
type LitVaryings = Perspective<2, 6>;

impl<T, S: Surface, W, F> VertexShader for LitTexture<'_, T, S, W, F> {
    type Varyings = LitVaryings;

    /// u, v, the colour of the surface in 10 bits per channel, 1 / w.
    const WORDS: usize = 4;

    #[inline]
    fn vertex(&self, corner: &VertexRef<'_>) -> LitVaryings {
        let [r, g, b] = self.surface.vertex(corner).to_bits();
        Perspective::new(corner.uv().map(|c| c.to_bits()), [r << 8, g << 8, b << 8])
    }

    #[inline]
    fn store(varyings: &LitVaryings, words: &mut [u32]) {
        if let ([u, v, r, g, b, w], [a, b_, c, d]) = (varyings.as_ref(), words) {
            let ten = |c: i32| (c >> 14) as u32 & 0x3FF;
            [*a, *b_, *c, *d] = [*u as u32, *v as u32, ten(*r) << 20 | ten(*g) << 10 | ten(*b), *w as u32];
        }
    }

    #[inline]
    fn load(words: &[u32]) -> LitVaryings {
        let [u, v, rgb, w] = words else { return Perspective::new([0; 2], [0; 3]) };
        let eight = |c: u32| ((c & 0x3FF) << 14) as i32;
        let mut varyings = Perspective::new([*u as i32, *v as i32], [eight(rgb >> 20), eight(rgb >> 10), eight(*rgb)]);
        crate::vertex::Varyings::set_inverse_w(&mut varyings, *w);
        varyings
    }
}

/// Returns the pixel of a texel; `None` if the texel is transparent and the format has no alpha.
#[inline(always)]
fn visible<P: PixelFormat>(rgba: [u8; 4], position: (i32, i32)) -> Option<P::Raw> {
    if P::ALPHA || rgba[3] >= OPAQUE { Some(P::pack_rgba(rgba, position)) } else { None }
}

/// Multiplies a channel by one of the surface, 8.16; 255.0 leaves it as it is.
#[inline(always)]
fn under(channel: u8, light: i32) -> u8 {
    // 0..=256; a plane may leave the range of its vertices by 1/8.
    let light = (light.wrapping_add(light >> 8).clamp(0, 0xFF_FFFF) + (1 << 15)) >> 16;
    ((i32::from(channel) * light) >> 8) as u8
}

impl<P: PixelFormat, T: Texture, S: Surface, W: Wrap, F: Filter> Shader<P> for LitTexture<'_, T, S, W, F> {
    const STEP: usize = STEP;

    /// Number of the level.
    type Setup = u32;

    #[inline]
    fn setup(&self, triangle: &TriangleSetup<'_, LitVaryings>) -> u32 {
        self.texture.level_of(triangle)
    }

    #[inline(always)]
    fn fragment(&self, fragment: &Fragment<'_, LitVaryings, u32>) -> Option<P::Raw> {
        let [r, g, b, a] = F::rgba::<T, W>(self.texture.level(*fragment.setup)?, fragment.varyings.corrected());
        let [lr, lg, lb] = fragment.varyings.linear() else { return None };
        visible::<P>([under(r, *lr), under(g, *lg), under(b, *lb), a], fragment.position)
    }
}
