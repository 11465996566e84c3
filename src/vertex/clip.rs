//! Clipping in homogeneous space: outcodes, and polygons cut by one plane after the other.
//!
//! Four rules hold: visible vertices pass unchanged, bit by bit; edge AB is cut like BA, since a cut always goes from
//! the vertex inside to the one outside; planes come in one order; there is one set of planes. Sides of the view are
//! no planes here: the rasterizer is exact to ±32,767 px, and only at that guard band anything is cut.

use super::varyings::Varyings;
use heapless::deque::{Deque, DequeView};

/// A vertex in clip space, in any common scale: x / w, y / w in units of 512 px from the screen's corner, z / w depth.
///
/// Magnitudes stay below 2⁵⁵ + 2, so that plane distances fit 63 bits. The scale must be so large that w below
/// [`ClipVertex::MIN_W`] does not matter; it counts as behind the eye.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClipVertex {
    /// To the right.
    pub x: i64,
    /// Down.
    pub y: i64,
    /// Depth: 0 on the near plane, w on the far plane.
    pub z: i64,
    /// The divisor.
    pub w: i64,
}

impl ClipVertex {
    /// Smallest w in front of the eye. A cut there is off by one unit, 1/8 of 1/256 px in x and y; the short path of the vertex transform
    /// has no smaller w, and the long one only nearer to the eye than positions resolve.
    pub const MIN_W: i64 = 1 << 20;
}

/// What becomes of what lies before the near plane or beyond the far plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthRange {
    /// Both are cut away.
    #[default]
    Clip,
    /// What is beyond the far plane is drawn at depth 65,535: a sky, a distant landscape.
    ///
    /// Against a cleared depth buffer that takes [`Compare::LessEqual`](crate::span::Compare::LessEqual), as 65,535 is
    /// what it is cleared to.
    ClampFar,
    /// Both are drawn, at depth 0 and 65,535.
    Clamp,
}

/// Which planes a vertex lies outside of, a bit each, after Cohen and Sutherland.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcode(pub u8);

impl Outcode {
    /// Bit of w ≥ [`ClipVertex::MIN_W`].
    pub const W: u8 = 1;
    /// Bit of the near plane, z ≥ 0.
    pub const NEAR: u8 = 2;
    /// Bit of the far plane, z ≤ w.
    pub const FAR: u8 = 4;
    /// Bits of the guard band: left, right, top, bottom.
    pub const SIDES: u8 = 0x78;

    /// The planes `vertex` lies outside of.
    #[inline]
    pub fn of(vertex: &ClipVertex) -> Self {
        Self((0..PLANES).fold(0, |code, plane| code | u8::from(distance(plane, vertex) < 0) << plane))
    }
}

/// w, near, far, then the guard band: left, right, top, bottom.
pub(super) const PLANES: usize = 7;
pub(super) const NEAR: usize = 1;
pub(super) const FAR: usize = 2;

/// The guard band: (64 - 2⁻¹⁶) · 512 px, or 2²³ - 2 in 24.8.
#[inline]
const fn band(w: i64) -> i64 {
    64 * w - (w >> 16)
}

/// Signed distance of x, y, z, w from a plane, not negative inside, in a scale of its own.
///
/// # Format
/// Below 2⁵⁶ · 65 < 2⁶³.
#[inline(never)]
pub(super) fn distance(plane: usize, vertex: &ClipVertex) -> i64 {
    let ClipVertex { x, y, z, w } = *vertex;
    let (border, value) = match plane {
        0 => return w - ClipVertex::MIN_W,
        NEAR => (0, z),
        FAR => (w, z),
        3 | 4 => (band(w), x),
        _ => (band(w), y),
    };
    if plane & 1 == 0 { border - value } else { border + value }
}

/// A corner of what is clipped: where it is, and how much of the triangle's corners is in it.
///
/// Whatever a shader interpolates is made of the weights when clipping is done, so that clipping does not depend on shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClipCorner {
    /// In clip space.
    pub vertex: ClipVertex,
    /// Parts of the three corners, 2.30. A corner itself has [`WHOLE`](Self::WHOLE) of itself and nothing of the others; a
    /// point on an edge has nothing of the third.
    pub weights: [i32; 3],
}

impl ClipCorner {
    /// The weight 1.
    pub const WHOLE: i32 = 1 << 30;

    /// VertexRef `k` of a triangle.
    pub const fn new(vertex: ClipVertex, k: usize) -> Self {
        Self {
            vertex,
            weights: [
                if k == 0 { Self::WHOLE } else { 0 },
                if k == 1 { Self::WHOLE } else { 0 },
                if k == 2 { Self::WHOLE } else { 0 },
            ],
        }
    }
}

/// The varyings at a corner with these weights, from those of the triangle's corners: unchanged at a corner itself.
///
/// # Format
/// Products below 2⁶¹, rounded to nearest: values below 2²⁸ that are the same at all corners stay the same.
#[inline(never)]
pub fn weighted<V: Varyings>(weights: &[i32; 3], corners: &[V; 3]) -> V {
    let mut mixed = V::ZERO;
    for (k, mixed) in mixed.as_mut().iter_mut().enumerate() {
        let mut sum = 1 << 29;
        for (weight, corner) in weights.iter().zip(corners) {
            sum += i64::from(*weight) * i64::from(corner.as_ref().get(k).copied().unwrap_or(0));
        }
        *mixed = (sum >> 30) as i32;
    }
    mixed
}

/// Most corners of a triangle that is cut by seven planes.
pub const CLIPPED_CORNERS: usize = 3 + PLANES;

/// A triangle that is being clipped: the corners of its polygon, in order. There is room for as many as may come to be.
#[derive(Debug)]
pub(crate) struct Clipping<'p> {
    polygon: &'p mut DequeView<ClipCorner>,
}

/// A part of a triangle, by depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthSlab {
    /// Before the near plane.
    InFrontOfNear,
    /// Between near and far plane.
    Inside,
    /// Beyond the far plane.
    BeyondFar,
}

impl DepthRange {
    /// The depth planes that are not clipped at: what lies outside of them is drawn with its depth clamped.
    pub(crate) const fn clamped(self) -> Outcode {
        match self {
            Self::Clip => Outcode(0),
            Self::ClampFar => Outcode(Outcode::FAR),
            Self::Clamp => Outcode(Outcode::FAR | Outcode::NEAR),
        }
    }

    /// The parts to draw beside that between the planes, of a triangle whose vertices' outcodes are `codes`, united.
    #[doc(hidden)]
    pub fn clamped_slabs(self, codes: Outcode) -> impl Iterator<Item = DepthSlab> {
        let outside = codes.0 & self.clamped().0;
        let parts = [(DepthSlab::InFrontOfNear, Outcode::NEAR), (DepthSlab::BeyondFar, Outcode::FAR)];
        parts.into_iter().filter(move |(_, plane)| outside & plane != 0).map(|(part, _)| part)
    }
}

/// Cuts a triangle by the planes in `codes` (the outcodes of its vertices, united) and hands on the corners of what is
/// left in one part of it: a convex polygon, or nothing.
pub fn clip_triangle(triangle: [ClipVertex; 3], codes: Outcode, part: DepthSlab, emit: impl FnMut(&ClipCorner)) {
    let mut polygon = Deque::<_, CLIPPED_CORNERS>::new();
    for (k, vertex) in triangle.into_iter().enumerate() {
        let _ = polygon.push_back(ClipCorner::new(vertex, k));
    }
    let mut clipping = Clipping::new(&mut polygon);
    clipping.clip(codes, part);
    clipping.corners().for_each(emit);
}

impl<'p> Clipping<'p> {
    /// Begins with a triangle, in a queue with room for one corner more per plane.
    pub(crate) fn new(polygon: &'p mut DequeView<ClipCorner>) -> Self {
        Self { polygon }
    }

    /// Clips the triangle by the planes in `codes` (the outcodes of its vertices, united): leaves what is inside of them, in one
    /// slab of depth, or nothing.
    #[inline(never)]
    pub(crate) fn clip(&mut self, codes: Outcode, slab: DepthSlab) {
        // A vertex at the eye itself leaves nothing to see: the triangle is edge-on, and has no direction to be cut in.
        if self.polygon.iter().any(|corner| corner.vertex == ClipVertex::default()) {
            self.polygon.clear();
        }
        for plane in 0..PLANES {
            if codes.0 & (1 << plane) != 0 {
                self.cut(plane, slab.is_inside(plane), |corner| distance(plane, &corner.vertex));
            }
        }
        for corner in self.polygon.iter_mut() {
            slab.clamp(&mut corner.vertex);
        }
    }

    /// Leaves the part of the polygon that is on one side of a plane: inside, where distances are not negative, or outside.
    ///
    /// Takes each corner from the front of the queue and puts what is left of it, and of the edge to it, at the back. Entering the
    /// side that is kept adds one corner, and leaving it takes one: so one corner more than before is all that is ever there.
    ///
    /// # Source
    /// Sutherland and Hodgman 1974, "Reentrant polygon clipping".
    #[inline]
    pub(super) fn cut(&mut self, plane: usize, inside: bool, distance: impl Fn(&ClipCorner) -> i64) {
        let Some(mut from) = self.polygon.back().copied() else { return };
        let mut df = distance(&from);
        for _ in 0..self.polygon.storage_len() {
            let Some(to) = self.polygon.pop_front() else { return };
            let dt = distance(&to);
            if (df >= 0) != (dt >= 0) {
                let _ = self.polygon.push_back(crossing(plane, &from, &to, df, dt));
            }
            if (dt >= 0) == inside {
                let _ = self.polygon.push_back(to);
            }
            (from, df) = (to, dt);
        }
        if self.polygon.storage_len() < 3 {
            self.polygon.clear();
        }
    }

    /// Returns the corners of what is left, in order.
    pub(crate) fn corners(&self) -> impl Iterator<Item = &ClipCorner> {
        self.polygon.iter()
    }
}

impl DepthSlab {
    /// Whether it is inside of a plane.
    pub(super) fn is_inside(self, plane: usize) -> bool {
        !((plane == NEAR && self == Self::InFrontOfNear) || (plane == FAR && self == Self::BeyondFar))
    }

    /// Brings what is before or beyond to its plane.
    pub(super) fn clamp(self, vertex: &mut ClipVertex) {
        match self {
            Self::InFrontOfNear => vertex.z = 0,
            Self::Inside => {}
            Self::BeyondFar => vertex.z = vertex.w,
        }
    }
}

/// Returns the point where the edge between two corners on different sides of a plane meets the plane, from their distances
/// `df` and `dt`. On the near and the far plane, its depth is exact.
///
/// # Format
/// t = da / (da - db) as 0.64, rounded down, with a inside and b outside, so that AB is cut like BA; coordinates are off by
/// less than 1 + 2⁻⁷ of their unit.
#[inline(never)]
pub(super) fn crossing(plane: usize, from: &ClipCorner, to: &ClipCorner, df: i64, dt: i64) -> ClipCorner {
    let (a, b, da) = if df >= 0 { (from, to, df) } else { (to, from, dt) };
    let t = fraction(da as u64, df.abs_diff(dt));
    let (p, q) = (&a.vertex, &b.vertex);
    let mut vertex =
        ClipVertex { x: along(p.x, q.x, t), y: along(p.y, q.y, t), z: along(p.z, q.z, t), w: along(p.w, q.w, t) };
    match plane {
        NEAR => vertex.z = 0,
        FAR => vertex.z = vertex.w,
        _ => {}
    }
    let mut weights = a.weights;
    for (weight, b) in weights.iter_mut().zip(&b.weights) {
        *weight = along((*weight).into(), (*b).into(), t) as i32;
    }
    ClipCorner { vertex, weights }
}

/// `a + (b - a) t` with t as 0.64, rounded towards `a`.
///
/// # Format
/// |b - a| < 2⁵⁷. Four products of halves, each below 2⁶⁴, their carries kept.
#[inline(never)]
fn along(a: i64, b: i64, t: u64) -> i64 {
    let d = b.abs_diff(a);
    let (d1, d0) = (d >> 32, d & 0xFFFF_FFFF);
    let (t1, t0) = (t >> 32, t & 0xFFFF_FFFF);
    let middle = d1 * t0 + ((d0 * t0) >> 32);
    let other = d0 * t1 + (middle & 0xFFFF_FFFF);
    let part = (d1 * t1 + (middle >> 32) + (other >> 32)) as i64;
    if b < a { a - part } else { a + part }
}

/// `num / den` as 0.64, rounded down; `num < den < 2⁶³`.
fn fraction(num: u64, den: u64) -> u64 {
    let mut rest = num;
    let mut quotient = 0;
    for _ in 0..64 {
        rest <<= 1;
        quotient <<= 1;
        if rest >= den {
            rest -= den;
            quotient |= 1;
        }
    }
    quotient
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(triangle: [[i64; 4]; 3]) -> usize {
        let triangle = triangle.map(|[x, y, z, w]| ClipVertex { x, y, z, w });
        let codes = triangle.iter().fold(0, |codes, v| codes | Outcode::of(v).0);
        let mut corners = 0;
        clip_triangle(triangle, Outcode(codes), DepthSlab::Inside, |_| corners += 1);
        corners
    }

    #[test]
    fn outcodes_are_the_signs_of_distances() {
        let values = [-(1 << 54), -64 << 20, -1, 0, 1, 1 << 20, (64 << 20) - 16, (64 << 20) - 15, 64 << 20, 1 << 54];
        for (x, y) in values.into_iter().flat_map(|x| values.map(|y| (x, y))) {
            for (z, w) in values.into_iter().flat_map(|z| values.map(|w| (z, w))) {
                let vertex = ClipVertex { x, y, z, w };
                let code = (0..PLANES).fold(0, |code, k| code | u8::from(distance(k, &vertex) < 0) << k);
                assert_eq!(Outcode::of(&vertex), Outcode(code), "{vertex:?}");
            }
        }
    }

    #[test]
    fn triangle_with_a_vertex_at_the_eye_has_nothing_to_see() {
        let (a, b) = ([1 << 50, 0, 1 << 49, 1 << 50], [0, 1 << 50, 1 << 49, 1 << 50]);
        assert_eq!(corners([a, b, [0, 0, 1 << 49, 1 << 50]]), 3);
        assert_eq!(corners([a, b, [0; 4]]), 0);
    }

    /// The edge from a to -a meets w = 0 in the eye: what is left in front of it projects to a, and not to anywhere.
    #[test]
    fn edge_through_the_eye_is_cut_where_it_can_be_projected() {
        let a = [(1 << 50) + 12_345, -(1 << 49), 1 << 48, 1 << 51];
        let triangle = [a, a.map(|c| -c), [1 << 50, 1 << 50, 1 << 50, 1 << 51]];
        let triangle = triangle.map(|[x, y, z, w]| ClipVertex { x, y, z, w });
        let codes = triangle.iter().fold(0, |codes, v| codes | Outcode::of(v).0);
        let project = |v: &ClipVertex| [v.x, v.y].map(|c| c as f64 / v.w as f64 * 131_072.0);
        let [x, y] = project(&triangle[0]);
        let mut near = 0;
        clip_triangle(triangle, Outcode(codes), DepthSlab::Inside, |corner| {
            let v = project(&corner.vertex);
            near += u32::from((v[0] - x).hypot(v[1] - y) < 0.5);
        });
        // Both ends of what is left of the edge.
        assert!(near >= 2);
    }
}
