//! The vertex stage's seam: what a shader sees of a vertex or a face, and what it hands on.

use super::clip_distance::MAX_DISTANCES;
use super::varyings::Varyings;
use crate::math::{Vec3, isqrt, leading_zeros_long, mul_high_signed, reciprocal};
use crate::mesh::{Mesh, Positions};

/// A vertex as the vertex shader sees it. Attributes the mesh does not have read as zero (normals and coordinates) or
/// white (colours).
#[derive(Clone, Copy, Debug)]
pub struct VertexRef<'a> {
    mesh: &'a Mesh<'a>,
    index: usize,
}

impl<'a> VertexRef<'a> {
    pub(crate) const fn new(mesh: &'a Mesh<'a>, index: usize) -> Self {
        Self { mesh, index }
    }

    /// Number of the vertex in its mesh.
    #[must_use]
    pub const fn index(&self) -> usize {
        self.index
    }

    /// Position in object space.
    #[must_use]
    pub fn position(&self) -> Vec3 {
        self.mesh.position(self.index)
    }

    /// Normal in object space, 2.14.
    #[inline]
    #[must_use]
    pub fn normal(&self) -> [i16; 3] {
        self.mesh.data().normals.and_then(|n| n.get(self.index)).copied().unwrap_or_default()
    }

    /// Colour: red, green, blue.
    #[inline]
    #[must_use]
    pub fn color(&self) -> [u8; 3] {
        // Channel by channel: three bytes at once are put together and taken apart.
        match self.mesh.data().colors.and_then(|colors| colors.get(self.index)) {
            Some([r, g, b]) => [*r, *g, *b],
            None => [255; 3],
        }
    }

    /// Texture coordinates.
    #[inline]
    #[must_use]
    pub fn uv(&self) -> [crate::math::Scalar; 2] {
        self.mesh.data().uvs.and_then(|c| c.get(self.index)).copied().unwrap_or_default()
    }
}

/// Which side of a triangle is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Side {
    /// The front: its corners go round as [`State::front`](crate::scene::State::front) says.
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
        // One by one: three halfwords at once are copied by a call, for want of alignment.
        let [a, b, c] = corners;
        Self { mesh, triangle, corners: [a, b, c], side }
    }

    /// Which side is seen: faces that show their back are drawn if [`State::cull`](crate::scene::State::cull) lets them, and may
    /// be lit the other way round.
    #[must_use]
    pub const fn side(&self) -> Side {
        self.side
    }

    /// Number of the triangle in its mesh.
    #[must_use]
    pub const fn index(&self) -> usize {
        self.triangle
    }

    /// The provoking vertex: the first of the triangle, which flat attributes come from.
    #[must_use]
    pub fn provoking(&self) -> VertexRef<'a> {
        VertexRef::new(self.mesh, usize::from(self.corners[0]))
    }

    /// The three vertices, the provoking one first.
    #[must_use]
    pub fn corners(&self) -> [VertexRef<'a>; 3] {
        let [a, b, c] = self.corners;
        let corner = |k: u16| VertexRef::new(self.mesh, usize::from(k));
        [corner(a), corner(b), corner(c)]
    }

    /// Normal of the face in object space, 2.14: the mesh's own where it has face normals, computed otherwise. Zero for
    /// a triangle without area.
    #[inline]
    #[must_use]
    pub fn normal(&self) -> [i16; 3] {
        match self.mesh.data().face_normals {
            Some(normals) => normals.get(self.triangle).copied().unwrap_or_default(),
            None => self.computed_normal(),
        }
    }

    /// The normal of the corners' positions.
    ///
    /// # Format
    /// Edges are scaled to 15 bits, which a normal of 2.14 does not tell; its components, at most 2³¹ - 2¹⁵, to 15 bits again,
    /// so that the sum of their squares fits 32: within 2⁻¹² of the exact normal unless the edges are nearly parallel.
    fn computed_normal(&self) -> [i16; 3] {
        let positions = &self.mesh.data().positions;
        if let Positions::Homogeneous(_) = positions {
            // There is none.
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

/// The direction from a corner to another, scaled to 15 bits.
///
/// # Format
/// Differences of 33 bits are halved, all three: that far they are to be shifted in any case.
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

/// A vector scaled so that its largest component has 15 bits; rounded down, to -2¹⁵ at least.
#[inline(never)]
fn fifteen_bits(v: [i32; 3]) -> [i32; 3] {
    let widest = v.iter().fold(0, |all, c| all | c.unsigned_abs());
    let zeros = leading_zeros_long(widest.into()) as i32 - 49;
    // Zero has 32 leading zeros.
    v.map(|c| if zeros >= 0 { c << zeros } else { c >> -zeros })
}

/// The programmable vertex stage: computes what is interpolated over triangles, and what is constant on them.
///
/// Each vertex is shaded at most once a draw while records are used; without records, as often as it is needed.
pub trait VertexShader {
    /// What is interpolated.
    type Varyings: Varyings;

    /// 32-bit words that a vertex's varyings take in the records.
    const WORDS: usize = <Self::Varyings as Varyings>::LEN;

    /// How many low bits of all varyings are zero at the vertices, up to 16. Knowing it makes set-up cheaper: values of
    /// at most 14 other bits take 32-bit arithmetic. What the clipper makes of them is cut to that too.
    const ZERO_BITS: u32 = 0;

    /// Whether [`displace`](Self::displace) moves vertices. Such draws are not culled by the mesh's bounds.
    const DISPLACES: bool = false;

    /// How many clip distances a vertex has: up to 4, cull distances included. Triangles are cut where one is negative.
    const CLIP_DISTANCES: usize = 0;

    /// How many cull distances it has. A triangle is left out if one of them is negative at all of its corners.
    const CULL_DISTANCES: usize = 0;

    /// The varyings at a vertex.
    fn vertex(&self, vertex: &VertexRef<'_>) -> Self::Varyings;

    /// Where the vertex is to be drawn, in object space; called only if [`DISPLACES`](Self::DISPLACES).
    fn displace(&self, vertex: &VertexRef<'_>) -> Vec3 {
        vertex.position()
    }

    /// Clip distances, then cull distances, on any scale: linear in space, not negative inside. Called only if there are any,
    /// maybe more than once; they concern triangles, not lines and points.
    fn distances(&self, vertex: &VertexRef<'_>) -> [i32; MAX_DISTANCES] {
        let _ = vertex;
        [0; MAX_DISTANCES]
    }

    /// One word that is constant on the triangle, handed to the fragment stage: a packed colour, an index, anything.
    fn face(&self, face: &Face<'_>) -> u32 {
        let _ = face;
        0
    }

    /// Packs varyings into `WORDS` words of a record. Override both together to save memory.
    #[inline]
    fn store(varyings: &Self::Varyings, words: &mut [u32]) {
        for (word, value) in words.iter_mut().zip(varyings.as_ref()) {
            *word = *value as u32;
        }
    }

    /// Unpacks what [`store`](Self::store) packed.
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
