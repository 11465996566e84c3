//! Materials lit per fragment.

use crate::color::PixelFormat;
use crate::light::LitMaterial;
use crate::math::unit_vector;
use crate::span::{Fragment, Shader};
use crate::vertex::{Face, Side, VertexRef, VertexShader};

/// Phong shading under directional lights: a [`LitMaterial`] is lit at each fragment, by the interpolated normal made a
/// unit vector again.
///
/// It is the cheaper of the two shaders per fragment, because it interpolates no positions. So it takes no point lights
/// (they do not compile), and the viewer is far away: a [`Viewer::At`](crate::light::Viewer::At) looks from the
/// direction in which it is from the middle of the mesh's box. [`PhongNear`] has neither limit.
///
/// Colours of vertices are those of the provoking vertex.
///
/// ```
/// use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};
/// use zstrip::light::{DirectionalLight, Lighting, Material};
/// use zstrip::math::{Affine, Vec3};
/// # use zstrip::mesh::{Mesh, MeshData, Positions};
/// use zstrip::shader::Phong;
/// # static BALL: Mesh<'static> = Mesh::constant(MeshData::new(Positions::Exact(&[])));
/// let sun = DirectionalLight::new(Vec3::from_ints(4, 7, 6), Rgb888::WHITE);
/// let lighting = Lighting::directional(Rgb888::new(30, 30, 40), [sun]);
/// let gold = Material::glossy(Rgb888::new(230, 160, 40), Rgb888::new(255, 240, 180), 32);
/// let model = Affine::translation(Vec3::from_ints(0, 0, -3));
/// let shader = Phong::new(lighting.on(&gold, &model, BALL.bounds()));
/// // scene.draw(&BALL, &(camera * model), &shader);
/// # let _ = shader;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Phong<const D: usize> {
    material: LitMaterial<D, 0>,
}

impl<const D: usize> Phong<D> {
    /// Returns the shader of a material under directional lights.
    #[must_use]
    pub const fn new(material: LitMaterial<D, 0>) -> Self {
        Self { material }
    }
}

/// Phong shading under any lights: as [`Phong`], with point lights and a viewer close by, because positions are
/// interpolated as well.
///
/// Positions are interpolated linearly on the screen. Where a triangle is much nearer to the viewer at one end than at
/// the other, a light close to it is displaced: divide such triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PhongNear<const D: usize, const P: usize> {
    material: LitMaterial<D, P>,
}

impl<const D: usize, const P: usize> PhongNear<D, P> {
    /// Returns the shader of a material under lights.
    #[must_use]
    pub const fn new(material: LitMaterial<D, P>) -> Self {
        Self { material }
    }
}

/// Makes varyings of a normal, 2.29: 14 bits and the sign of 63/64 of it, so that no rounding makes it longer than 1.
#[inline]
fn varying([x, y, z]: [i16; 3]) -> [i32; 3] {
    let component = |c: i16| ((i32::from(c) * 63 + 64) >> 7) << 16;
    [component(x), component(y), component(z)]
}

/// Packs the upper halves of two words into one.
#[inline]
const fn halves(a: i32, b: i32) -> u32 {
    (a as u32 & 0xFFFF_0000) | (b as u32 >> 16)
}

/// Unpacks the word that [`halves`] packed.
#[inline]
const fn unhalved(word: u32) -> (i32, i32) {
    ((word & 0xFFFF_0000) as i32, (word << 16) as i32)
}

/// Returns the colour of a face's provoking vertex, red lowest; white if colours of vertices do not count.
fn face_color(vertex_colors: bool, face: &Face<'_>) -> u32 {
    if !vertex_colors {
        return u32::MAX;
    }
    let [r, g, b] = face.provoking().color();
    u32::from_le_bytes([r, g, b, 0])
}

/// Makes an interpolated normal a unit vector again, 2.14, and turns it round if `turned`.
#[inline(always)]
fn fragment_normal(x: i32, y: i32, z: i32, turned: bool) -> [i32; 3] {
    // 15 bits: `unit_vector` takes them without loops if the normals at the vertices are up to 120 degrees apart.
    let unit = unit_vector([x >> 14, y >> 14, z >> 14]);
    if turned { [-unit[0], -unit[1], -unit[2]] } else { unit }
}

impl<const D: usize> VertexShader for Phong<D> {
    /// The normal.
    type Varyings = [i32; 3];

    const WORDS: usize = 2;
    const ZERO_BITS: u32 = 16;

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 3] {
        varying(self.material.turned(vertex.normal()))
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        face_color(self.material.has_vertex_colors(), face)
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

impl<Format: PixelFormat, const D: usize> Shader<Format> for Phong<D> {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 3]>) -> Option<Format::Raw> {
        let [x, y, z] = *fragment.varyings;
        let turned = self.material.is_two_sided() && fragment.side == Side::Back;
        let [red, green, blue, _] = fragment.flat.to_le_bytes();
        let color = self.material.shade_distant(&fragment_normal(x, y, z, turned), [red, green, blue]);
        Some(Format::pack_at(color.rounded(), fragment.position))
    }
}

impl<const D: usize, const P: usize> VertexShader for PhongNear<D, P> {
    /// The normal and the position, the latter in 2¹⁴ local units.
    type Varyings = [i32; 6];

    const WORDS: usize = 3;
    const ZERO_BITS: u32 = 16;

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 6] {
        let [x, y, z] = varying(self.material.turned(vertex.normal()));
        let [px, py, pz] = self.material.fine_position(vertex.position());
        // Below 2²⁹; rounded to 14 bits.
        let rounded = |c: i32| (c + (1 << 15)) & !0xFFFF;
        [x, y, z, rounded(px), rounded(py), rounded(pz)]
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        face_color(self.material.has_vertex_colors(), face)
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

impl<Format: PixelFormat, const D: usize, const P: usize> Shader<Format> for PhongNear<D, P> {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 6]>) -> Option<Format::Raw> {
        let [x, y, z, px, py, pz] = *fragment.varyings;
        let turned = self.material.is_two_sided() && fragment.side == Side::Back;
        let [red, green, blue, _] = fragment.flat.to_le_bytes();
        let normal = fragment_normal(x, y, z, turned);
        let p = [px >> 14, py >> 14, pz >> 14];
        let color = self.material.shade_at_inlined(&normal, &p, [red, green, blue]);
        Some(Format::pack_at(color.rounded(), fragment.position))
    }
}
