//! A material under any lights, per face, per vertex or per fragment.

use super::vertex_colors::VertexColors;
use crate::color::{PixelFormat, load, round, squeeze, store, unpacked};
use crate::light::LitMaterial;
use crate::math::unit_vector;
use crate::span::{DepthTest, Fragment, Shader, SpanOf, flat_span};
use crate::vertex::{Face, Side, VertexRef, VertexShader};
use core::marker::PhantomData;

/// Frequency of a [`Shaded`] surface: one colour per face, lit at its middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PerFace;

/// Frequency of a [`Shaded`] surface: lit at its vertices; colours are interpolated, linearly on the screen.
///
/// The vertices of two-sided materials turn their normals towards the viewer, as they may belong to faces of both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PerVertex;

/// Frequency of a [`Shaded`] surface: lit at each fragment, by interpolated normals made unit vectors again. For
/// directional lights (a point light does not compile) and a far viewer: a [`Viewer::At`](crate::light::Viewer::At)
/// looks from the direction in which it is from the middle of the mesh's box. The cheaper of the two ways.
///
/// Vertex colours are those of the provoking vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PerFragment;

/// [`PerFragment`] for point lights too, and for a viewer close by: positions are interpolated as well. Linearly on the
/// screen: lights near triangles that are much nearer at one end than at the other want those divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PerFragmentNear;

/// A surface of a [`Material`](crate::light::Material) under a [`Lighting`](crate::light::Lighting), lit as often as
/// `Frequency` says: [`PerFace`], [`PerVertex`], [`PerFragment`] or [`PerFragmentNear`].
///
/// ```
/// use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};
/// use zstrip::shader::{PerFragment, Shaded};
/// use zstrip::light::{DirectionalLight, Lighting, Material};
/// use zstrip::math::{Affine, Vec3};
/// # use zstrip::mesh::{Mesh, MeshData, Positions};
/// # static BALL: Mesh<'static> = Mesh::constant(MeshData::new(Positions::Exact(&[])));
/// let sun = DirectionalLight::new(Vec3::from_ints(4, 7, 6), Rgb888::WHITE);
/// let lighting = Lighting::directional(Rgb888::new(30, 30, 40), [sun]);
/// let gold = Material::glossy(Rgb888::new(230, 160, 40), Rgb888::new(255, 240, 180), 32);
/// let model = Affine::translation(Vec3::from_ints(0, 0, -3));
/// let shader = Shaded::new(PerFragment, lighting.on(&gold, &model, BALL.bounds()));
/// // scene.draw(&BALL, &(camera * model), &shader);
/// # let _ = shader;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shaded<Frequency, const D: usize, const P: usize> {
    material: LitMaterial<D, P>,
    frequency: PhantomData<Frequency>,
}

impl<Frequency: Copy, const D: usize, const P: usize> Shaded<Frequency, D, P> {
    /// Creates a shader that lights as often as `frequency` says.
    #[must_use]
    pub const fn new(frequency: Frequency, material: LitMaterial<D, P>) -> Self {
        let _ = frequency;
        Self { material, frequency: PhantomData }
    }
}

/// A normal of the mesh, 2.14.
#[inline]
fn normal(normal: [i16; 3]) -> [i32; 3] {
    [i32::from(normal[0]), i32::from(normal[1]), i32::from(normal[2])]
}

impl<const D: usize, const P: usize> VertexShader for Shaded<PerFace, D, P> {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    /// The colour, 8 bits a channel, blue lowest.
    fn face(&self, face: &Face<'_>) -> u32 {
        let mut normal = normal(face.normal());
        if self.material.is_two_sided() && face.side() == Side::Back {
            normal = normal.map(|c| -c);
        }
        let [a, b, c] = face.corners().map(|corner| self.material.local(corner.position()));
        // Thirds, near enough: 21,845 / 2¹⁶, of sums below 2¹⁷ / 2³.
        let third = |k: usize| (((a[k] + b[k] + c[k]) >> 3) * 21_845) >> 13;
        let [r, g, b] = self.material.near(&normal, &[third(0), third(1), third(2)], face.provoking().color());
        u32::from_be_bytes([0, round(r), round(g), round(b)])
    }
}

impl<Format: PixelFormat, const D: usize, const P: usize> Shader<Format> for Shaded<PerFace, D, P> {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<Format::Raw> {
        Some(Format::pack_at(unpacked(fragment.flat), fragment.position))
    }

    #[inline]
    fn span<T: DepthTest>(&self, span: SpanOf<'_, Format, Self, T>, test: T) {
        flat_span(span, test);
    }
}

/// Colours are kept and drawn as those of [`Gouraud`](crate::shader::Gouraud).
impl<const D: usize, const P: usize> VertexShader for Shaded<PerVertex, D, P> {
    /// Red, green, blue in 8.16, squeezed to 0.5..=254.5.
    type Varyings = [i32; 3];

    const WORDS: usize = 1;
    const ZERO_BITS: u32 = 13;

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 3] {
        let p = self.material.local(vertex.position());
        let mut normal = normal(vertex.normal());
        if self.material.is_two_sided() {
            normal = self.material.towards_viewer(normal, p);
        }
        self.material.near(&normal, &p, vertex.color()).map(squeeze)
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

impl<const D: usize, const P: usize> VertexColors for Shaded<PerVertex, D, P> {}

/// Normals as they are interpolated: the upper 14 bits and the sign of 63/64 of their length, so that no rounding makes
/// them longer than 1. 2.29.
#[inline]
fn varying([x, y, z]: [i16; 3]) -> [i32; 3] {
    let component = |c: i16| ((i32::from(c) * 63 + 64) >> 7) << 16;
    [component(x), component(y), component(z)]
}

/// Two upper halves in a word.
#[inline]
const fn halves(a: i32, b: i32) -> u32 {
    (a as u32 & 0xFFFF_0000) | (b as u32 >> 16)
}

/// Undoes [`halves`].
#[inline]
const fn unhalved(word: u32) -> (i32, i32) {
    ((word & 0xFFFF_0000) as i32, (word << 16) as i32)
}

/// Colour of the vertices that counts for a face, red lowest.
fn face_color(vertex_colors: bool, face: &Face<'_>) -> u32 {
    if !vertex_colors {
        return u32::MAX;
    }
    let [r, g, b] = face.provoking().color();
    u32::from_le_bytes([r, g, b, 0])
}

/// The unit normal of a fragment; 2.14.
#[inline(always)]
fn fragment_normal(x: i32, y: i32, z: i32, turned: bool) -> [i32; 3] {
    // 15 bits: what `unit_vector` takes without loops, up to 120 degrees between the normals at the vertices.
    let unit = unit_vector([x >> 14, y >> 14, z >> 14]);
    if turned { [-unit[0], -unit[1], -unit[2]] } else { unit }
}

impl<const D: usize> VertexShader for Shaded<PerFragment, D, 0> {
    /// The normal.
    type Varyings = [i32; 3];

    const WORDS: usize = 2;
    const ZERO_BITS: u32 = 16;

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 3] {
        varying(vertex.normal())
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        face_color(self.material.vertex_colors(), face)
    }

    #[inline]
    fn store(normal: &[i32; 3], words: &mut [u32]) {
        if let [xy, z] = words {
            (*xy, *z) = (halves(normal[0], normal[1]), halves(normal[2], 0));
        }
    }

    #[inline]
    fn load(words: &[u32]) -> [i32; 3] {
        let [xy, z] = words else { return [0; 3] };
        let ((x, y), (z, _)) = (unhalved(*xy), unhalved(*z));
        [x, y, z]
    }
}

impl<Format: PixelFormat, const D: usize> Shader<Format> for Shaded<PerFragment, D, 0> {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 3]>) -> Option<Format::Raw> {
        let [x, y, z] = *fragment.varyings;
        let turned = self.material.is_two_sided() && fragment.side == Side::Back;
        let [red, green, blue, _] = fragment.flat.to_le_bytes();
        let [r, g, b] = self.material.far(&fragment_normal(x, y, z, turned), [red, green, blue]);
        Some(Format::pack_at([round(r), round(g), round(b)], fragment.position))
    }
}

impl<const D: usize, const P: usize> VertexShader for Shaded<PerFragmentNear, D, P> {
    /// The normal and the position, the latter in 2¹⁴ local units.
    type Varyings = [i32; 6];

    const WORDS: usize = 3;
    const ZERO_BITS: u32 = 16;

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 6] {
        let [x, y, z] = varying(vertex.normal());
        let [px, py, pz] = self.material.space().fine(vertex.position());
        // Below 2²⁹; rounded to 14 bits.
        let rounded = |c: i32| (c + (1 << 15)) & !0xFFFF;
        [x, y, z, rounded(px), rounded(py), rounded(pz)]
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        face_color(self.material.vertex_colors(), face)
    }

    #[inline]
    fn store(v: &[i32; 6], words: &mut [u32]) {
        if let [a, b, c] = words {
            (*a, *b, *c) = (halves(v[0], v[1]), halves(v[2], v[3]), halves(v[4], v[5]));
        }
    }

    #[inline]
    fn load(words: &[u32]) -> [i32; 6] {
        let [a, b, c] = words else { return [0; 6] };
        let ((x, y), (z, px), (py, pz)) = (unhalved(*a), unhalved(*b), unhalved(*c));
        [x, y, z, px, py, pz]
    }
}

impl<Format: PixelFormat, const D: usize, const P: usize> Shader<Format> for Shaded<PerFragmentNear, D, P> {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 6]>) -> Option<Format::Raw> {
        let [x, y, z, px, py, pz] = *fragment.varyings;
        let turned = self.material.is_two_sided() && fragment.side == Side::Back;
        let [red, green, blue, _] = fragment.flat.to_le_bytes();
        let normal = fragment_normal(x, y, z, turned);
        let [r, g, b] = self.material.near_here(&normal, &[px >> 14, py >> 14, pz >> 14], [red, green, blue]);
        Some(Format::pack_at([round(r), round(g), round(b)], fragment.position))
    }
}
