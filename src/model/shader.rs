//! The shaders that parts of a model are drawn by: the ready-made ones, on attributes that are packed.

use super::normal::decode_normal;
use crate::color::PixelFormat;
use crate::light::{Lighting, LitColor, LitMaterial, Material, Sun, Sunlit};
use crate::math::{Affine, Vec3};
use crate::mesh::Bounds;
use crate::shader::Surface;
use crate::span::{DepthTest, Fragment, Sample, Shader, SmallResult, SmallTriangle, SpanOf, TriangleSetup};
use crate::vertex::{Face, MAX_DISTANCES, PackedCorners, VertexRef, VertexShader};
use embedded_graphics_core::pixelcolor::Rgb888;

/// A light that a model can be placed under.
///
/// [`Sun`] and [`Lighting`] are such lights. They stand in the world, as the camera does.
pub trait Light {
    /// A material under the light.
    type Surface: Surface + Copy;

    /// Puts the light on a material of a mesh that `model` brings into the world.
    fn on_material(&self, material: &Material, model: &Affine, bounds: &Bounds) -> Self::Surface;
}

/// A sun has no highlights, and lights both sides of a face alike.
impl Light for Sun {
    type Surface = Sunlit;

    fn on_material(&self, material: &Material, model: &Affine, _: &Bounds) -> Sunlit {
        self.on(&material.body(), model)
    }
}

impl<const D: usize, const P: usize> Light for Lighting<D, P> {
    type Surface = LitMaterial<D, P>;

    fn on_material(&self, material: &Material, model: &Affine, bounds: &Bounds) -> LitMaterial<D, P> {
        self.on(material, model, bounds)
    }
}

/// The surface of a part: under light, or as bright as it is by itself.
#[derive(Clone, Copy, Debug)]
pub enum PartSurface<S> {
    /// Under light.
    Lit(S),
    /// A colour that those of the vertices are multiplied by.
    Unlit([u8; 3]),
}

/// The surface of a part on a mesh without normals, beside its packed ones.
#[derive(Clone, Copy, Debug)]
pub struct PackedSurface<'a, S> {
    pub(super) surface: PartSurface<S>,
    /// Octahedral normals; `None` if the mesh has normals, or none are needed.
    pub(super) normals: Option<&'a [[i8; 2]]>,
}

/// Multiplies two channels; 255 is 1.
fn product(a: u8, b: u8) -> i32 {
    // 255 · 255 · 257 / 2⁸ is 255 in 8.8, less 1/256.
    (i32::from(a) * i32::from(b) * 257) >> 8
}

impl<S: Surface> Surface for PackedSurface<'_, S> {
    #[inline]
    fn vertex(&self, vertex: &VertexRef<'_>) -> LitColor {
        match &self.surface {
            PartSurface::Lit(surface) => match self.normals {
                Some(normals) => {
                    let normal = normals.get(vertex.index()).map_or([0; 3], |bytes| decode_normal(*bytes));
                    surface.vertex_with(vertex, normal)
                }
                None => surface.vertex(vertex),
            },
            PartSurface::Unlit([r, g, b]) => {
                let color = vertex.color();
                LitColor::new([product(*r, color[0]), product(*g, color[1]), product(*b, color[2])])
            }
        }
    }

    fn face(&self, face: &Face<'_>) -> Rgb888 {
        match &self.surface {
            PartSurface::Lit(surface) => surface.face(face),
            PartSurface::Unlit(_) => self.vertex(&face.provoking()).into(),
        }
    }
}

/// Packed texture coordinates: an offset, 16.16, and numbers of 8 or 16 bits, which are shifted.
#[derive(Clone, Copy, Debug)]
pub struct PackedUvs<'a> {
    pub(super) uvs: Uvs<'a>,
    pub(super) offset: [i32; 2],
    pub(super) shift: u8,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Uvs<'a> {
    None,
    Short(&'a [[u16; 2]]),
    Bytes(&'a [[u8; 2]]),
}

impl PackedUvs<'_> {
    /// Returns the texture coordinates of a vertex, 16.16: numbers of at most 16 bits, shifted by at most 15.
    #[inline(always)]
    fn of(&self, vertex: usize) -> [i32; 2] {
        let stored = match self.uvs {
            Uvs::None => None,
            Uvs::Short(all) => all.get(vertex).map(|[u, v]| [i32::from(*u), i32::from(*v)]),
            Uvs::Bytes(all) => all.get(vertex).map(|[u, v]| [i32::from(*u), i32::from(*v)]),
        };
        let ([u, v], [from_u, from_v], shift) = (stored.unwrap_or_default(), self.offset, u32::from(self.shift) & 15);
        [from_u.wrapping_add(u << shift), from_v.wrapping_add(v << shift)]
    }
}

/// A textured shader on packed texture coordinates: its first two varyings are u and v.
#[derive(Clone, Copy, Debug)]
pub struct Unpacked<'a, S> {
    pub(super) shader: S,
    pub(super) uvs: PackedUvs<'a>,
}

impl<S: VertexShader> VertexShader for Unpacked<'_, S> {
    type Varyings = S::Varyings;
    const WORDS: usize = S::WORDS;
    const ZERO_BITS: u32 = S::ZERO_BITS;
    const DISPLACES: bool = S::DISPLACES;
    const CLIP_DISTANCES: usize = S::CLIP_DISTANCES;
    const CULL_DISTANCES: usize = S::CULL_DISTANCES;
    const IS_TOLERANT: bool = S::IS_TOLERANT;

    #[inline]
    fn tolerance(&self) -> u32 {
        self.shader.tolerance()
    }

    #[inline]
    fn vertex(&self, vertex: &VertexRef<'_>) -> S::Varyings {
        let mut varyings = self.shader.vertex(vertex);
        if let ([to_u, to_v, ..], [u, v]) = (varyings.as_mut(), self.uvs.of(vertex.index())) {
            (*to_u, *to_v) = (u, v);
        }
        varyings
    }

    #[inline]
    fn displace(&self, vertex: &VertexRef<'_>) -> Vec3 {
        self.shader.displace(vertex)
    }

    #[inline]
    fn distances(&self, vertex: &VertexRef<'_>) -> [i32; MAX_DISTANCES] {
        self.shader.distances(vertex)
    }

    #[inline]
    fn face(&self, face: &Face<'_>) -> u32 {
        self.shader.face(face)
    }

    #[inline]
    fn store(varyings: &S::Varyings, words: &mut [u32]) {
        S::store(varyings, words);
    }

    #[inline]
    fn load(words: &[u32]) -> S::Varyings {
        S::load(words)
    }
}

impl<P: PixelFormat, S: Shader<P>> Shader<P> for Unpacked<'_, S> {
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
        self.shader.paint(fragment, pixel)
    }

    #[inline(always)]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        self.shader.span(span, test);
    }

    #[inline(always)]
    fn paint_at(&self, sample: Sample, fragment: &Fragment<'_, S::Varyings, S::Setup>, pixel: &mut P::Raw) -> bool {
        self.shader.paint_at(sample, fragment, pixel)
    }

    #[inline(always)]
    fn span_at<D: DepthTest>(&self, sample: Sample, span: SpanOf<'_, P, Self, D>, test: D) {
        self.shader.span_at(sample, span, test);
    }

    #[inline(always)]
    fn small<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &[S::Varyings; 3],
        flat: u32,
    ) -> SmallResult {
        self.shader.small(triangle, corners, flat)
    }

    const PACKS_SMALL: bool = S::PACKS_SMALL;

    #[inline(always)]
    fn small_packed<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &PackedCorners<'_>,
    ) -> SmallResult {
        self.shader.small_packed(triangle, corners)
    }
}
