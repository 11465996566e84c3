//! Textures as shaders: as they are, and on a surface under light.

use super::mipmap::{BLOCK, Levels, Mipmapped, OneLevel};
use super::surface::Surface;
use crate::color::PixelFormat;
use crate::math::leading_zeros;
use crate::span::{
    DepthTest, Fragment, Light, Primitive, STEP, Shader, SmallResult, SmallTriangle, Span, SpanOf, TexelSource,
    TriangleSetup, UvStepper, draw_fragments, is_light_in_range, lit_texture_span, texture_span,
};
use crate::texture::{Filter, Nearest, OPAQUE, Repeat, Texture, TextureError, Wrap};
use crate::vertex::{PackedCorners, Perspective, Varyings, VertexRef, VertexShader};
use core::marker::PhantomData;
use embedded_graphics_core::geometry::Size;

/// The colours of a texture, perspective-correct: divided at every 16th column of the screen, or at another
/// [`step`](Self::step).
///
/// The mesh's coordinates go from 0 to 1 over the texture; it repeats, and its nearest texels are shown, unless another
/// [`Wrap`] and [`Filter`] are chosen. Texels whose alpha is below one half are not drawn.
///
/// # Small triangles
/// Triangles of up to 60 × 25 px, as most of a model's are, take a shorter way if perspective moves none of their
/// texels by more than half a texel; by 1/8 texel at a step of 2 or 4, and by 1/32 at a step of 1. There, coordinates
/// are planes on the screen, and nothing is divided. Under light, triangles of up to 60 px in height whose width and
/// height are at most 85 px together take it, too. A triangle that the left or the right edge of the viewport cuts
/// takes the other way, so scrolling may move its texels by as much. Mip chains have no shorter way.
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
pub struct Textured<'a, T, W = Repeat, F = Nearest, L = OneLevel, const N: usize = STEP> {
    /// The texture, and smaller ones of half its size each.
    levels: &'a [T],
    how: PhantomData<(W, F, L)>,
}

impl<'a, T: Texture> Textured<'a, T> {
    /// Returns the shader of one texture for all sizes on the screen.
    #[must_use]
    pub const fn new(texture: &'a T) -> Self {
        Self { levels: core::slice::from_ref(texture), how: PhantomData }
    }

    /// Returns the shader of a mip chain: each level has half the size of the previous level, rounded down, at least 1.
    /// Each pixel takes the level whose texels are nearest in size to the pixels around it, along the direction in
    /// which they are smallest on the screen. Levels change at columns that are multiples of 16, and at any row. They
    /// depend on the triangle's plane alone, so neither clipping nor the shape of triangles makes them jump.
    ///
    /// # Errors
    /// When a level has another size, or there are no levels.
    pub fn mipmapped(levels: &'a [T]) -> Result<Textured<'a, T, Repeat, Nearest, Mipmapped>, TextureError> {
        let mut sizes = levels.iter().map(Texture::size);
        let mut size = sizes.next().ok_or(TextureError::NoLevels)?;
        for found in sizes {
            let expected = Size::new((size.width / 2).max(1), (size.height / 2).max(1));
            if found != expected {
                return Err(TextureError::Size { found, expected });
            }
            size = found;
        }
        Ok(Textured { levels, how: PhantomData })
    }
}

impl<'a, T: Texture, W: Wrap, F: Filter, L: Levels, const N: usize> Textured<'a, T, W, F, L, N> {
    /// Returns the shader with another rule for what is outside of the texture.
    #[must_use]
    pub const fn wrap<V: Wrap>(self, _: V) -> Textured<'a, T, V, F, L, N> {
        Textured { levels: self.levels, how: PhantomData }
    }

    /// Returns the shader with another filter.
    #[must_use]
    pub const fn filter<G: Filter>(self, _: G) -> Textured<'a, T, W, G, L, N> {
        Textured { levels: self.levels, how: PhantomData }
    }

    /// Returns the shader with coordinates that are divided at every `M`-th column of the screen instead of every
    /// 16th: 1, 2, 4, 8, 16 or 32. At 1, every texel is exact. [`Perspective`](Perspective#sub-spans) tells how far off
    /// texels are otherwise.
    ///
    /// ```
    /// use zstrip::shader::Textured;
    /// # use zstrip::texture::Tile;
    /// # static TILE: Tile<'static, 2, 2> = Tile::new(&[[0xFFFF, 0], [0, 0xFFFF]]);
    /// let exact = Textured::new(&TILE).step::<1>();
    /// # let _ = exact;
    /// ```
    #[must_use]
    pub const fn step<const M: usize>(self) -> Textured<'a, T, W, F, L, M> {
        const { assert!(M.is_power_of_two() && M <= 32, "steps are 1, 2, 4, 8, 16 or 32 pixels") };
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
    pub const fn lit<S: Surface>(self, surface: S) -> LitTexture<'a, T, S, W, F, L, N> {
        LitTexture { texture: self, surface }
    }

    /// Returns a level by its number; there is always one.
    #[inline]
    fn level(&self, level: usize) -> Option<&'a T> {
        self.levels.get(level)
    }

    /// Returns the texture for a fragment.
    #[inline(always)]
    fn texture<const K: usize>(&self, fragment: &Fragment<'_, Perspective<2, K>, L::Scale>) -> Option<&'a T> {
        let values: &[i32] = fragment.varyings.as_ref();
        let q = values.last().copied().unwrap_or(0);
        self.level(L::level(fragment.setup, fragment.position, q))
    }
}

impl<T: Texture, W: Wrap, F: Filter, L: Levels, const N: usize> VertexShader for Textured<'_, T, W, F, L, N> {
    type Varyings = Perspective<2, 3>;
    const IS_TOLERANT: bool = true;

    /// Returns half a texel; 1/8 at a step of 2 or 4, and 1/32 if each pixel is divided; or less, because sides are
    /// rounded up to powers of two.
    #[inline]
    fn tolerance(&self) -> u32 {
        let sides = self.level(0).map_or(Size::zero(), Texture::size);
        let log = 32 - leading_zeros(sides.width.max(sides.height).saturating_sub(1));
        1_u32 << 16 >> texel_bits(N) >> log.min(16)
    }

    #[inline]
    fn vertex(&self, corner: &VertexRef<'_>) -> Perspective<2, 3> {
        Perspective::new(corner.uv().map(|c| c.to_bits()), [])
    }
}

impl<P: PixelFormat, T: Texture, W: Wrap, F: Filter, L: Levels, const N: usize> Shader<P>
    for Textured<'_, T, W, F, L, N>
{
    const STEP: usize = N;

    /// Sizes of texels on the triangle.
    type Setup = L::Scale;

    #[inline]
    fn setup(&self, triangle: &TriangleSetup<'_, Perspective<2, 3>>) -> L::Scale {
        L::scale(self.levels, triangle)
    }

    #[inline(always)]
    fn fragment(&self, fragment: &Fragment<'_, Perspective<2, 3>, L::Scale>) -> Option<P::Raw> {
        let (texture, uv) = (self.texture(fragment)?, fragment.varyings.corrected());
        if P::ALPHA || P::DITHER.is_some() {
            return visible::<P>(F::rgba::<T, W>(texture, uv), fragment.position);
        }
        F::pixel::<P, T, W>(texture, uv)
    }

    #[inline]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        if P::ALPHA || P::DITHER.is_some() || !W::REPEATS || !F::NEAREST || N == 1 {
            return draw_fragments(self, span, test);
        }
        self.each_level(span, |texture, part| {
            let draw = |part: SpanOf<'_, P, Self, D>, stepper: &mut UvStepper| {
                texture_span(texture, part, test, stepper);
            };
            if let Some(bent) = UvStepper::each_straight_part(part, N, draw) {
                draw_fragments(self, bent, test);
            }
        });
    }

    const PACKS_SMALL: bool = !L::MANY;

    #[inline(always)]
    fn small_packed<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &PackedCorners<'_>,
    ) -> SmallResult {
        triangle.draw_texels::<_, 3>(self, corners)
    }
}

impl<P: PixelFormat, T: Texture, W: Wrap, F: Filter, L: Levels, const N: usize> TexelSource<P>
    for Textured<'_, T, W, F, L, N>
{
    type Texture = T;
    const LIT: bool = false;
    const RGB565: bool = false;
    const REPEATS: bool = W::REPEATS;
    const BITS: u32 = texel_bits(N);

    #[inline(always)]
    fn texture(&self) -> Option<&T> {
        if L::MANY { None } else { self.level(0) }
    }

    #[inline(always)]
    fn pixel(texture: &T, uv: [i32; 2], _: Light, position: (i32, i32)) -> Option<P::Raw> {
        if P::ALPHA || P::DITHER.is_some() {
            return visible::<P>(F::rgba::<T, W>(texture, uv), position);
        }
        F::pixel::<P, T, W>(texture, uv)
    }
}

impl<'a, T: Texture, W: Wrap, F: Filter, L: Levels, const N: usize> Textured<'a, T, W, F, L, N> {
    /// Hands a span to `draw` with its texture, in parts that have one texture each.
    #[inline(always)]
    fn each_level<'s, P: PixelFormat, V: Varyings, Z>(
        &self,
        mut span: Span<'s, P, V, L::Scale, Z>,
        mut draw: impl FnMut(&'a T, Span<'s, P, V, L::Scale, Z>),
    ) {
        if !L::MANY {
            if let Some(texture) = self.level(0) {
                draw(texture, span);
            }
            return;
        }
        while !span.color.is_empty() {
            let (texture, pixels) = self.level_run(span.primitive, span.position, span.color.len());
            let (Some(texture), Some((part, rest))) = (texture, span.split_at(pixels)) else { return };
            draw(texture, part);
            span = rest;
        }
    }

    /// Returns the texture of the pixels from `position` on, and the number of pixels, up to `length`, that share it.
    #[inline(never)]
    fn level_run<V: Varyings>(
        &self,
        primitive: &Primitive<V, L::Scale>,
        (x, y): (i32, i32),
        length: usize,
    ) -> (Option<&'a T>, usize) {
        let level = |x: i32| {
            let values = primitive.at((x, y));
            let q: &[i32] = values.as_ref();
            L::level(&primitive.setup, (x, y), q.last().copied().unwrap_or(0))
        };
        let (first, end) = (level(x), x.wrapping_add(length as i32));
        let mut next = (x | (BLOCK - 1)) + 1;
        while next < end && level(next) == first {
            next += BLOCK;
        }
        (self.level(first), next.min(end).wrapping_sub(x) as usize)
    }
}

/// A texture on a [`Surface`] under light: see [`Textured::lit`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LitTexture<'a, T, S, W = Repeat, F = Nearest, L = OneLevel, const N: usize = STEP> {
    texture: Textured<'a, T, W, F, L, N>,
    surface: S,
}

/// Texture coordinates 16.16; red, green and blue of the surface, 8.16, linear on the screen.
type LitVaryings = Perspective<2, 6>;

impl<T: Texture, S: Surface, W: Wrap, F: Filter, L: Levels, const N: usize> VertexShader
    for LitTexture<'_, T, S, W, F, L, N>
{
    type Varyings = LitVaryings;
    const IS_TOLERANT: bool = true;

    #[inline]
    fn tolerance(&self) -> u32 {
        self.texture.tolerance()
    }

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
            // Surfaces stay within 255.0; the varyings of a canvas are its caller's.
            let ten = |c: i32| (c.clamp(0, 255 << 16) >> 14) as u32;
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

/// Returns b, if perspective may move texels of small triangles by 2⁻ᵇ of one where a `step` is chosen: by less than it
/// does between the columns that are divided on large ones.
const fn texel_bits(step: usize) -> u32 {
    match step {
        1 => 5,
        2 | 4 => 3,
        _ => 1,
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

impl<P: PixelFormat, T: Texture, S: Surface, W: Wrap, F: Filter, L: Levels, const N: usize> Shader<P>
    for LitTexture<'_, T, S, W, F, L, N>
{
    const STEP: usize = N;

    /// Sizes of texels on the triangle.
    type Setup = L::Scale;

    #[inline]
    fn setup(&self, triangle: &TriangleSetup<'_, LitVaryings>) -> L::Scale {
        L::scale(self.texture.levels, triangle)
    }

    #[inline(always)]
    fn fragment(&self, fragment: &Fragment<'_, LitVaryings, L::Scale>) -> Option<P::Raw> {
        let texture = self.texture.texture(fragment)?;
        let [r, g, b, a] = F::rgba::<T, W>(texture, fragment.varyings.corrected());
        let [lr, lg, lb] = fragment.varyings.linear() else { return None };
        visible::<P>([under(r, *lr), under(g, *lg), under(b, *lb), a], fragment.position)
    }

    #[inline]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        // The light of a canvas may be anything.
        if P::ALPHA || P::DITHER.is_some() || !W::REPEATS || !F::NEAREST || N == 1 || !is_light_in_range(&span) {
            return draw_fragments(self, span, test);
        }
        self.texture.each_level(span, |texture, part| {
            let draw = |part: SpanOf<'_, P, Self, D>, stepper: &mut UvStepper| {
                lit_texture_span::<P, Self, D, _, _>(texture, part, test, stepper);
            };
            if let Some(bent) = UvStepper::each_straight_part(part, N, draw) {
                draw_fragments(self, bent, test);
            }
        });
    }

    const PACKS_SMALL: bool = !L::MANY;

    #[inline(always)]
    fn small_packed<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &PackedCorners<'_>,
    ) -> SmallResult {
        triangle.draw_texels::<_, 4>(self, corners)
    }
}

impl<P: PixelFormat, T: Texture, S: Surface, W: Wrap, F: Filter, L: Levels, const N: usize> TexelSource<P>
    for LitTexture<'_, T, S, W, F, L, N>
{
    type Texture = T;
    const LIT: bool = true;
    /// Texels and pixels of 16 bits are multiplied in those bits.
    const RGB565: bool = P::PACKED && P::DITHER.is_none() && !P::ALPHA && F::NEAREST && T::IS_RGB565;
    const REPEATS: bool = W::REPEATS;
    const BITS: u32 = texel_bits(N);

    #[inline(always)]
    fn texture(&self) -> Option<&T> {
        if L::MANY { None } else { self.texture.level(0) }
    }

    #[inline(always)]
    fn pixel(texture: &T, uv: [i32; 2], light: Light, position: (i32, i32)) -> Option<P::Raw> {
        if <Self as TexelSource<P>>::RGB565 {
            return Some(P::from_rgb565(light.on_rgb565(F::rgb565::<T, W>(texture, uv))));
        }
        let [r, g, b, a] = F::rgba::<T, W>(texture, uv);
        let [lr, lg, lb] = light.channels();
        visible::<P>([under(r, lr), under(g, lg), under(b, lb), a], position)
    }
}
