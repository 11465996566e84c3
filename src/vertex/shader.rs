//! The vertex stage's seam: what a shader reads of a vertex or a face, and what it hands on to the fragment stage.

use super::clip_distance::MAX_DISTANCES;
use super::varyings::Varyings;
use crate::math::{Vec3, isqrt, leading_zeros_long, mul_high_signed, reciprocal};
use crate::mesh::{Mesh, Positions};

/// A vertex as the vertex shader sees it. Attributes that the mesh does not have read as zero (normals and texture
/// coordinates) or white (colours).
#[derive(Clone, Copy, Debug)]
pub struct VertexRef<'a> {
    mesh: &'a Mesh<'a>,
    index: usize,
}

impl<'a> VertexRef<'a> {
    pub(crate) const fn new(mesh: &'a Mesh<'a>, index: usize) -> Self {
        Self { mesh, index }
    }

    /// Returns the number of the vertex in its mesh.
    #[must_use]
    pub const fn index(&self) -> usize {
        self.index
    }

    /// Returns the position in object space.
    #[must_use]
    pub fn position(&self) -> Vec3 {
        self.mesh.position(self.index)
    }

    /// Returns the normal in object space, 2.14.
    #[inline]
    #[must_use]
    pub fn normal(&self) -> [i16; 3] {
        match self.mesh.data().normals.and_then(|normals| normals.get(self.index)) {
            Some([x, y, z]) => [*x, *y, *z],
            None => [0; 3],
        }
    }

    /// Returns the colour: red, green, blue.
    #[inline]
    #[must_use]
    pub fn color(&self) -> [u8; 3] {
        // Channel by channel: copied at once, three bytes would be packed into a word and unpacked again.
        match self.mesh.data().colors.and_then(|colors| colors.get(self.index)) {
            Some([r, g, b]) => [*r, *g, *b],
            None => [255; 3],
        }
    }

    /// Returns the texture coordinates.
    #[inline]
    #[must_use]
    pub fn uv(&self) -> [crate::math::Scalar; 2] {
        self.mesh.data().uvs.and_then(|c| c.get(self.index)).copied().unwrap_or_default()
    }
}

/// A side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Side {
    /// The front: on the screen, its corners go round as [`State::front`](crate::scene::State::front) says.
    Front,
    /// The back.
    Back,
}

/// A triangle as the vertex shader sees it.
#[derive(Clone, Copy, Debug)]
pub struct Face<'a> {
    mesh: &'a Mesh<'a>,
    triangle: usize,
    corners: [u16; 3],
    side: Side,
}

impl<'a> Face<'a> {
    #[inline]
    pub(crate) const fn new(mesh: &'a Mesh<'a>, triangle: usize, corners: [u16; 3], side: Side) -> Self {
        // One by one: three halfwords at once would be copied by a call, because they are not aligned to words.
        let [a, b, c] = corners;
        Self { mesh, triangle, corners: [a, b, c], side }
    }

    /// Returns the side that is seen. Triangles that show their back are drawn if
    /// [`State::cull`](crate::scene::State::cull) lets them, and a shader may light them the other way round.
    #[must_use]
    pub const fn side(&self) -> Side {
        self.side
    }

    /// Returns the number of the triangle in its mesh.
    #[must_use]
    pub const fn index(&self) -> usize {
        self.triangle
    }

    /// Returns the provoking vertex: the first one of the triangle, which flat attributes come from.
    #[must_use]
    pub fn provoking(&self) -> VertexRef<'a> {
        VertexRef::new(self.mesh, usize::from(self.corners[0]))
    }

    /// Returns the three vertices, the provoking one first.
    #[must_use]
    pub fn corners(&self) -> [VertexRef<'a>; 3] {
        let [a, b, c] = self.corners;
        let corner = |k: u16| VertexRef::new(self.mesh, usize::from(k));
        [corner(a), corner(b), corner(c)]
    }

    /// Returns the face's normal in object space, 2.14. It is the mesh's own if the mesh has face normals, and computed
    /// otherwise. It is zero for a triangle without area.
    #[inline]
    #[must_use]
    pub fn normal(&self) -> [i16; 3] {
        match self.mesh.data().face_normals {
            Some(normals) => normals.get(self.triangle).copied().unwrap_or_default(),
            None => self.computed_normal(),
        }
    }

    /// Computes the normal from the corners' positions.
    ///
    /// # Format
    /// Edges are scaled to 15 bits, which makes no difference in a normal of 2.14. The components of their cross
    /// product, at most 2³¹ - 2¹⁵, are scaled to 15 bits again, so that the sum of their squares fits 32 bits. The
    /// result is within 2⁻¹² of the exact normal unless the edges are nearly parallel.
    fn computed_normal(&self) -> [i16; 3] {
        let positions = &self.mesh.data().positions;
        if let Positions::Homogeneous(_) = positions {
            // Homogeneous positions do not give a normal.
            return [0; 3];
        }
        let [a, b, c] = self.corners;
        let numbers = |corner: u16| positions.numbers(corner.into());
        let (a, b, c) = (numbers(a), numbers(b), numbers(c));
        let ([ax, ay, az], [bx, by, bz]) = (edge(&a, &b), edge(&a, &c));
        let mut n = fifteen_bits([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]);
        let length = isqrt(n.iter().fold(0, |sum, v| sum.wrapping_add((v * v) as u32)));
        // v 2¹⁴ / length = v 2¹⁶ (2⁶³ / (length 2^shift)) / 2³² / 2^(33 - shift), with 15 or 16 bits of length.
        let shift = leading_zeros_long(length.into()) - 32;
        if shift > 17 {
            return [0; 3];
        }
        let inverse = reciprocal(length << shift);
        for v in &mut n {
            *v = (mul_high_signed(*v << 16, inverse) + (1 << (32 - shift))) >> (33 - shift);
        }
        let [x, y, z] = n;
        [x as i16, y as i16, z as i16]
    }
}

/// Returns the direction from a corner to another one, scaled to 15 bits.
///
/// # Format
/// If a difference takes 33 bits, all three are halved: they would be shifted down at least that far anyway.
#[inline(never)]
fn edge(from: &[i32; 4], to: &[i32; 4]) -> [i32; 3] {
    let mut difference = [0; 3];
    let mut overflow = false;
    for ((difference, a), b) in difference.iter_mut().zip(from).zip(to) {
        let overflows;
        (*difference, overflows) = b.overflowing_sub(*a);
        overflow |= overflows;
    }
    if overflow {
        for ((difference, a), b) in difference.iter_mut().zip(from).zip(to) {
            *difference = ((i64::from(*b) - i64::from(*a)) >> 1) as i32;
        }
    }
    fifteen_bits(difference)
}

/// Scales a vector so that its largest component has 15 bits. Components are rounded down, to -2¹⁵ at least.
#[inline(never)]
fn fifteen_bits(v: [i32; 3]) -> [i32; 3] {
    let widest = v.iter().fold(0, |all, c| all | c.unsigned_abs());
    let zeros = leading_zeros_long(widest.into()) as i32 - 49;
    // Zero has 32 leading zeros.
    v.map(|c| if zeros >= 0 { c << zeros } else { c >> -zeros })
}

/// The programmable vertex stage: computes the values that are interpolated over triangles, and the word that is
/// constant on each.
///
/// While records are used, each vertex of a triangle that is not culled is shaded once per draw. Vertices that only
/// culled triangles have are not shaded; nor are, in a frame of several strips, those that only triangles beside the
/// screen have. A triangle that has to be clipped asks for its vertices again. Without records, a vertex is shaded as
/// often as it is needed.
pub trait VertexShader {
    /// Type of the values that are interpolated.
    type Varyings: Varyings;

    /// Number of 32-bit words that a vertex's varyings take in the records.
    const WORDS: usize = <Self::Varyings as Varyings>::LEN;

    /// Number of low bits, up to 16, that are zero in all varyings at the vertices. Knowing it makes set-up cheaper:
    /// values of at most 14 other bits take 32-bit arithmetic. The values that the clipper computes are cut to these
    /// bits, too.
    const ZERO_BITS: u32 = 0;

    /// Set if [`displace`](Self::displace) moves vertices. Such draws are not culled by the mesh's bounds, nor by its
    /// hierarchy.
    const DISPLACES: bool = false;

    /// Number of clip distances per vertex: up to 4, cull distances included. Triangles are cut where one is negative.
    const CLIP_DISTANCES: usize = 0;

    /// Number of cull distances per vertex. A triangle is left out if one of them is negative at all of its corners.
    const CULL_DISTANCES: usize = 0;

    /// Set if perspective-correct varyings may be planes on the screen, on small triangles where perspective moves none
    /// of them by more than [`tolerance`](Self::tolerance). That saves all divisions there. Shaders whose
    /// [`Setup`](crate::span::Shader::Setup) is not empty take no part.
    ///
    /// ```
    /// use zstrip::embedded_graphics_core::pixelcolor::Gray8;
    /// use zstrip::span::{Fragment, Shader, TriangleSetup};
    /// use zstrip::vertex::{Perspective, VertexRef, VertexShader};
    ///
    /// /// Shows a chessboard of 8 × 8 fields.
    /// struct Board;
    ///
    /// impl VertexShader for Board {
    ///     type Varyings = Perspective<2, 3>;
    ///
    ///     const IS_TOLERANT: bool = true;
    ///
    ///     // A field is 2¹³ units of the coordinates, 16.16: its border may move by 1/64 of it.
    ///     fn tolerance(&self) -> u32 {
    ///         1 << 7
    ///     }
    ///
    ///     fn vertex(&self, vertex: &VertexRef<'_>) -> Perspective<2, 3> {
    ///         Perspective::new(vertex.uv().map(|c| c.to_bits()), [])
    ///     }
    /// }
    ///
    /// impl Shader<Gray8> for Board {
    ///     type Setup = ();
    ///
    ///     fn setup(&self, _: &TriangleSetup<'_, Perspective<2, 3>>) {}
    ///
    ///     fn fragment(&self, fragment: &Fragment<'_, Perspective<2, 3>>) -> Option<u8> {
    ///         let [u, v] = fragment.varyings.corrected();
    ///         Some(if (u ^ v) >> 13 & 1 == 0 { 0 } else { 255 })
    ///     }
    /// }
    /// ```
    const IS_TOLERANT: bool = false;

    /// Returns by how much perspective may move perspective-correct varyings on small triangles, in units of the
    /// varyings: for texture coordinates, a fraction of a texel.
    #[inline]
    fn tolerance(&self) -> u32 {
        0
    }

    /// Returns the varyings at a vertex.
    fn vertex(&self, vertex: &VertexRef<'_>) -> Self::Varyings;

    /// Returns the position in object space at which the vertex is drawn. This function is called only if
    /// [`DISPLACES`](Self::DISPLACES) is set.
    fn displace(&self, vertex: &VertexRef<'_>) -> Vec3 {
        vertex.position()
    }

    /// Returns the clip distances, and then the cull distances, on any scale: linear in space, and not negative inside.
    /// This function is called only if the shader has distances, and possibly more than once per vertex. Distances
    /// concern triangles, not lines and points.
    fn distances(&self, vertex: &VertexRef<'_>) -> [i32; MAX_DISTANCES] {
        let _ = vertex;
        [0; MAX_DISTANCES]
    }

    /// Returns one word that is constant on the triangle and handed to the fragment stage: a packed colour, an index,
    /// anything.
    fn face(&self, face: &Face<'_>) -> u32 {
        let _ = face;
        0
    }

    /// Returns the word that is handed to the fragment stage for a shape of a [`Canvas`](crate::scene::Canvas), which
    /// is no face of a mesh. `word` is the one that the caller of [`polygon_with`](crate::scene::Canvas::polygon_with)
    /// gave. A shader whose word does not depend on the mesh returns its own word instead.
    fn shape(&self, word: u32) -> u32 {
        word
    }

    /// Packs varyings into `WORDS` words of a record. To save memory, override it together with [`load`](Self::load).
    #[inline]
    fn store(varyings: &Self::Varyings, words: &mut [u32]) {
        for (word, value) in words.iter_mut().zip(varyings.as_ref()) {
            *word = *value as u32;
        }
    }

    /// Unpacks the words that [`store`](Self::store) packed.
    #[inline]
    #[must_use]
    fn load(words: &[u32]) -> Self::Varyings {
        let mut varyings = Self::Varyings::ZERO;
        for (value, word) in varyings.as_mut().iter_mut().zip(words) {
            *value = *word as i32;
        }
        varyings
    }
}
