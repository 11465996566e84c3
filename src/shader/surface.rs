//! Surfaces under light: the colours that shaders ask for, per face or per vertex.

use crate::light::{LitColor, LitMaterial, Sunlit, Unlit, long};
use crate::vertex::{Face, Side, VertexRef};
use embedded_graphics_core::pixelcolor::{Rgb888, raw::RawU24};

/// A surface that has a colour at each face and at each vertex of a mesh: a material under light, in object space.
///
/// A surface says which colours there are. A shader says how often they are computed, and for which pixels:
/// [`Flat`](crate::shader::Flat) asks once per face, [`Gouraud`](crate::shader::Gouraud) once per vertex, and
/// [`Textured::lit`](crate::shader::Textured::lit) multiplies its texels by the colours of the vertices.
///
/// [`Unlit`], [`Sunlit`] and [`LitMaterial`] are surfaces. A surface of one's own takes one function. This one is
/// brighter where it looks up, as under an overcast sky:
///
/// ```
/// use zstrip::light::LitColor;
/// use zstrip::shader::{Gouraud, Surface};
/// use zstrip::vertex::VertexRef;
///
/// struct Overcast;
///
/// impl Surface for Overcast {
///     fn vertex(&self, vertex: &VertexRef<'_>) -> LitColor {
///         let [_, y, _] = vertex.normal(); // 2.14
///         let level = (i32::from(y) + 16_384) >> 7; // 0..=256
///         LitColor::new(vertex.color().map(|channel| i32::from(channel) * level))
///     }
/// }
///
/// let shader = Gouraud::new(Overcast);
/// # let _ = shader;
/// ```
///
/// A shader is compiled for each type of surface that it is used with. Where a program has several, and size matters
/// more than speed, `&dyn Surface` makes them one type.
pub trait Surface {
    /// Returns the colour at a vertex.
    fn vertex(&self, vertex: &VertexRef<'_>) -> LitColor;

    /// Returns the colour at a vertex with a unit normal, 2.14, that is not the mesh's: one that is packed, or
    /// computed. Surfaces that know no normals, as by default, return [`vertex`](Self::vertex).
    #[inline]
    fn vertex_with(&self, vertex: &VertexRef<'_>, normal: [i16; 3]) -> LitColor {
        let _ = normal;
        self.vertex(vertex)
    }

    /// Returns the colour of a face; by default that of its provoking vertex, lit by the normal of that vertex.
    #[inline]
    fn face(&self, face: &Face<'_>) -> Rgb888 {
        self.vertex(&face.provoking()).into()
    }

    /// Returns the colour of a shape that is no part of a mesh; `None` if the colour depends on the mesh.
    #[inline]
    fn shape(&self) -> Option<Rgb888> {
        None
    }
}

impl<S: Surface + ?Sized> Surface for &S {
    #[inline]
    fn vertex(&self, vertex: &VertexRef<'_>) -> LitColor {
        S::vertex(self, vertex)
    }

    #[inline]
    fn vertex_with(&self, vertex: &VertexRef<'_>, normal: [i16; 3]) -> LitColor {
        S::vertex_with(self, vertex, normal)
    }

    #[inline]
    fn face(&self, face: &Face<'_>) -> Rgb888 {
        S::face(self, face)
    }

    #[inline]
    fn shape(&self) -> Option<Rgb888> {
        S::shape(self)
    }
}

/// Converts red, green and blue to a colour.
#[inline(always)]
const fn rgb([r, g, b]: [u8; 3]) -> Rgb888 {
    Rgb888::new(r, g, b)
}

impl Surface for Unlit {
    #[inline]
    fn vertex(&self, vertex: &VertexRef<'_>) -> LitColor {
        let color = match self.color() {
            Some(color) => color,
            None => vertex.color(),
        };
        LitColor::from_channels(color)
    }

    #[inline]
    fn face(&self, face: &Face<'_>) -> Rgb888 {
        match self.color() {
            Some(color) => rgb(color),
            None => rgb(face.provoking().color()),
        }
    }

    #[inline]
    fn shape(&self) -> Option<Rgb888> {
        self.color().map(rgb)
    }
}

/// Lit by the normals of vertices or of faces. A mesh without normals shows only the ambient light at its vertices.
impl Surface for Sunlit {
    #[inline]
    fn vertex(&self, vertex: &VertexRef<'_>) -> LitColor {
        // The normal is looked up last. Shared with `vertex_with`, this code would be slower or larger.
        if self.has_vertex_colors() {
            self.colored(vertex.color()).shade(self.turned(vertex.normal()))
        } else {
            self.shade(self.turned(vertex.normal()))
        }
    }

    #[inline]
    fn vertex_with(&self, vertex: &VertexRef<'_>, normal: [i16; 3]) -> LitColor {
        if self.has_vertex_colors() {
            self.colored(vertex.color()).shade(self.turned(normal))
        } else {
            self.shade(self.turned(normal))
        }
    }

    #[inline]
    fn face(&self, face: &Face<'_>) -> Rgb888 {
        let word = if self.has_vertex_colors() {
            self.colored(face.provoking().color()).shade_word(self.turned(face.normal()))
        } else {
            self.shade_word(self.turned(face.normal()))
        };
        Rgb888::from(RawU24::new(word))
    }
}

/// Lit by the normals of vertices, or by the normal of a face at its middle. A mesh without normals shows only the
/// ambient light at its vertices.
///
/// Two-sided materials turn the normal of a face that shows its back, and turn the normal of a vertex towards the
/// viewer, because the vertex may belong to faces of both sides.
impl<const D: usize, const P: usize> Surface for LitMaterial<D, P> {
    fn vertex(&self, vertex: &VertexRef<'_>) -> LitColor {
        self.vertex_with(vertex, vertex.normal())
    }

    fn vertex_with(&self, vertex: &VertexRef<'_>, normal: [i16; 3]) -> LitColor {
        let mut normal = long(self.turned(normal));
        let turns_by_place = self.is_two_sided() && self.is_seen_from_close_by();
        let p = if self.depends_on_place() || turns_by_place { self.local(vertex.position()) } else { [0; 3] };
        if self.is_two_sided() {
            normal = self.towards_viewer(normal, p);
        }
        self.shade_at(&normal, &p, vertex.color())
    }

    fn face(&self, face: &Face<'_>) -> Rgb888 {
        // Without lights, no normal is computed; where no light needs it, no middle of the face.
        let mut normal = if Self::HAS_LIGHTS { long(self.turned(face.normal())) } else { [0; 3] };
        if self.is_two_sided() && face.side() == Side::Back {
            normal = normal.map(|c| -c);
        }
        let middle = if self.depends_on_place() { self.middle(face) } else { [0; 3] };
        self.shade_at(&normal, &middle, face.provoking().color()).into()
    }
}

impl<const D: usize, const P: usize> LitMaterial<D, P> {
    /// Returns the middle of a face in local units. Out of line, so that the corners are not on the stack while light
    /// is added up.
    #[inline(never)]
    fn middle(&self, face: &Face<'_>) -> [i32; 3] {
        let [a, b, c] = face.corners().map(|corner| self.local(corner.position()));
        // Thirds, near enough: 21,845 / 2¹⁶, of sums below 2¹⁷ / 2³.
        let third = |k: usize| (((a[k] + b[k] + c[k]) >> 3) * 21_845) >> 13;
        [third(0), third(1), third(2)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::{DirectionalLight, Lighting, Material, PointLight, Viewer};
    use crate::math::{Affine, Scalar, Vec3};
    use crate::mesh::{LOOKED_UP, Mesh, MeshData, Positions};

    const CORNERS: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];
    const SUN: DirectionalLight = DirectionalLight { direction: Vec3::Z, color: Rgb888::new(200, 200, 200) };
    const LAMP: PointLight =
        PointLight { position: Vec3::Z, color: Rgb888::new(200, 200, 200), range: Scalar::from_bits(9 << 16) };
    const AFAR: Viewer = Viewer::Toward(Vec3::Z);
    const NEAR: Viewer = Viewer::At(Vec3::from_ints(0, 0, 3));

    /// Returns how many positions the colour of a vertex takes, and that of a face: three of its own for the normal,
    /// and three for its middle.
    fn looked_up<const D: usize, const P: usize>(
        directional: [DirectionalLight; D],
        points: [PointLight; P],
        viewer: Viewer,
        material: Material,
    ) -> [u32; 2] {
        let mesh = Mesh::new(MeshData::new(Positions::Exact(&CORNERS))).expect("a mesh");
        let lighting = Lighting { ambient: Rgb888::new(9, 9, 9), directional, points, viewer };
        let lit = lighting.on(material, &Affine::IDENTITY, mesh.bounds());
        let count = |ask: &dyn Fn()| {
            LOOKED_UP.set(0);
            ask();
            LOOKED_UP.get()
        };
        let face = Face::new(&mesh, 0, [0, 1, 2], Side::Front);
        [
            count(&|| {
                lit.vertex(&VertexRef::new(&mesh, 1));
            }),
            count(&|| {
                lit.face(&face);
            }),
        ]
    }

    #[test]
    fn no_position_is_looked_up_that_no_light_needs() {
        let white = Rgb888::new(255, 255, 255);
        let (matte, glossy) = (Material::from(Material::matte(white)), Material::glossy(white, white, 20));
        // Ambient light alone: not even a normal.
        for viewer in [AFAR, NEAR] {
            for material in [matte, glossy] {
                assert_eq!(looked_up([], [], viewer, material), [0, 0], "{viewer:?} {material:?}");
            }
        }
        // Far lights: the normal of the face.
        assert_eq!(looked_up([SUN], [], AFAR, matte), [0, 3]);
        assert_eq!(looked_up([SUN], [], AFAR, glossy), [0, 3]);
        assert_eq!(looked_up([SUN], [], AFAR, glossy.two_sided()), [0, 3]);
        assert_eq!(looked_up([SUN], [], NEAR, matte), [0, 3]);
        // The place, too: for highlights that are seen from close by, for lamps, and to see which side a vertex shows.
        assert_eq!(looked_up([SUN], [], NEAR, glossy), [1, 6]);
        assert_eq!(looked_up([], [LAMP], AFAR, matte), [1, 6]);
        assert_eq!(looked_up([SUN], [LAMP], NEAR, glossy), [1, 6]);
        assert_eq!(looked_up([SUN], [], NEAR, matte.two_sided()), [1, 3]);
    }
}
