//! Shaders that count their calls: what there is to do in a frame, by small and large triangles.
#![allow(dead_code)] // each program uses its part

use std::cell::Cell;
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565};
use zstrip::light::Unlit;
use zstrip::shader::{LitTexture, Textured};
use zstrip::span::{DepthTest, Fragment, Shader, SmallResult, SmallTriangle, SpanOf, TriangleSetup};
use zstrip::texture::Texture;
use zstrip::vertex::{Perspective, Varyings, VertexRef, VertexShader, Wrapper};

/// Draws nothing, and counts triangles, rows and pixels.
#[derive(Default)]
pub struct Calls {
    /// Of small and of large triangles.
    pub counts: [[Cell<u32>; 3]; 2],
    /// Vertices whose varyings were asked for.
    pub vertices: Cell<u32>,
    is_small: Cell<bool>,
}

impl Calls {
    fn add(&self, what: usize, count: usize) {
        let cell = &self.counts[usize::from(!self.is_small.get())][what];
        cell.set(cell.get() + count as u32);
    }
}

impl VertexShader for Calls {
    type Varyings = [i32; 3];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 3] {
        self.vertices.set(self.vertices.get() + 1);
        [0; 3]
    }
}

impl<P: PixelFormat> Shader<P> for Calls {
    type Setup = ();

    fn setup(&self, _: &TriangleSetup<'_, [i32; 3]>) {
        self.add(0, 1);
    }

    fn fragment(&self, _: &Fragment<'_, [i32; 3]>) -> Option<P::Raw> {
        None
    }

    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, _: D) {
        self.add(1, 1);
        self.add(2, span.color.len());
    }
}

/// A texture of which only the sides count.
pub struct Sides(Size);

impl Texture for Sides {
    fn size(&self) -> Size {
        self.0
    }

    fn rgba(&self, _: u32, _: u32) -> [u8; 4] {
        [255; 4]
    }

    fn pixel<P: PixelFormat>(&self, x: u32, y: u32) -> Option<P::Raw> {
        Some(P::pack_rgba(self.rgba(x, y), (0, 0)))
    }
}

/// Counts as [`Calls`] does, with texture coordinates: perspective decides, too, which triangles are small, and so does
/// the number of varyings.
pub struct TexturedCalls<'u, const VARYINGS: usize> {
    pub calls: Calls,
    /// That of a texture's shader.
    tolerance: u32,
    row: Cell<i32>,
    /// Texture coordinates that take the place of the mesh's.
    uvs: Option<&'u [[i32; 2]]>,
}

/// Counts for a texture.
pub type TextureCalls<'u> =
    TexturedCalls<'u, { <<Textured<'static, Sides> as VertexShader>::Varyings as Varyings>::LEN }>;

/// Counts for a texture under light.
pub type LitTextureCalls<'u> =
    TexturedCalls<'u, { <<LitTexture<'static, Sides, Unlit> as VertexShader>::Varyings as Varyings>::LEN }>;

impl<'u, const VARYINGS: usize> TexturedCalls<'u, VARYINGS> {
    /// Counts for a texture of sides up to `side` texels.
    pub fn new(side: u32) -> Self {
        let tolerance = Textured::new(&Sides(Size::new_equal(side.max(1)))).tolerance();
        Self { calls: Calls::default(), tolerance, row: Cell::new(0), uvs: None }
    }

    pub fn with_uvs(self, uvs: &'u [[i32; 2]]) -> Self {
        Self { uvs: Some(uvs), ..self }
    }
}

impl<const VARYINGS: usize> VertexShader for TexturedCalls<'_, VARYINGS> {
    type Varyings = Perspective<2, VARYINGS>;

    const IS_TOLERANT: bool = true;

    fn tolerance(&self) -> u32 {
        self.tolerance
    }

    fn vertex(&self, vertex: &VertexRef<'_>) -> Perspective<2, VARYINGS> {
        self.calls.vertices.set(self.calls.vertices.get() + 1);
        let uv = match self.uvs {
            Some(uvs) => uvs.get(vertex.index()).copied().unwrap_or_default(),
            None => vertex.uv().map(|c| c.to_bits()),
        };
        let mut varyings = Perspective::ZERO;
        for (varying, coordinate) in varyings.as_mut().iter_mut().zip(uv) {
            *varying = coordinate;
        }
        varyings
    }
}

impl<P: PixelFormat, const VARYINGS: usize> Shader<P> for TexturedCalls<'_, VARYINGS> {
    type Setup = ();

    /// Small triangles are not set up.
    fn setup(&self, _: &TriangleSetup<'_, Perspective<2, VARYINGS>>) {
        self.calls.add(0, 1);
    }

    /// Fragments of small triangles.
    fn fragment(&self, fragment: &Fragment<'_, Perspective<2, VARYINGS>>) -> Option<P::Raw> {
        let (_, y) = fragment.position;
        self.calls.add(1, usize::from(self.row.replace(y) != y));
        self.calls.add(2, 1);
        None
    }

    /// Spans of large triangles.
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, _: D) {
        self.calls.add(1, 1);
        self.calls.add(2, span.color.len());
    }
}

/// A shader that counts.
pub trait Counter: Shader<Gray8, Setup = ()> + Shader<Rgb565, Setup = ()> {
    fn calls(&self) -> &Calls;

    /// A small triangle begins.
    fn begin(&self) {
        self.calls().is_small.set(true);
    }

    /// A small triangle has ended.
    fn end(&self, result: SmallResult) {
        let _ = result;
        self.calls().is_small.set(false);
    }
}

impl Counter for Calls {
    fn calls(&self) -> &Calls {
        self
    }
}

impl<const VARYINGS: usize> Counter for TexturedCalls<'_, VARYINGS> {
    fn calls(&self) -> &Calls {
        &self.calls
    }

    fn begin(&self) {
        self.row.set(i32::MIN);
        self.calls.is_small.set(true);
    }

    fn end(&self, result: SmallResult) {
        self.calls.add(0, usize::from(result == SmallResult::Drawn));
        self.calls.is_small.set(false);
    }
}

/// Tells the shader inside which triangles are small.
pub struct BySize<'c, C>(pub &'c C);

impl<C: Counter> Wrapper for BySize<'_, C> {
    type Inner = C;

    fn inner(&self) -> &C {
        self.0
    }
}

impl<P: PixelFormat, C: Counter + Shader<P, Setup = ()>> Shader<P> for BySize<'_, C> {
    type Setup = ();

    fn setup(&self, triangle: &TriangleSetup<'_, C::Varyings>) {
        Shader::<P>::setup(self.0, triangle);
    }

    fn fragment(&self, fragment: &Fragment<'_, C::Varyings>) -> Option<P::Raw> {
        Shader::<P>::fragment(self.0, fragment)
    }

    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        Shader::<P>::span(self.0, span, test);
    }

    fn small<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &[C::Varyings; 3],
        flat: u32,
    ) -> SmallResult {
        self.0.begin();
        let result = Shader::<P>::small(self.0, triangle, corners, flat);
        self.0.end(result);
        result
    }
}
