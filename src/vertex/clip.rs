//! Clipping in homogeneous space: triangles and outcodes come in, polygons cut by one plane after the other go out.
//!
//! Four rules hold:
//! - A visible vertex passes unchanged, bit by bit.
//! - Edge AB is cut exactly like edge BA, because a cut always goes from the vertex inside to the vertex outside.
//! - The planes are taken in one fixed order.
//! - There is only one set of planes.
//!
//! The sides of the view are not among the planes: the rasterizer is exact up to ±32,767 px, and sides are cut only at
//! that guard band.

use super::varyings::Varyings;
use heapless::deque::{Deque, DequeView};

/// A vertex in clip space, in any common scale. x / w and y / w count units of 512 px from the screen's corner, and
/// z / w is depth.
///
/// Magnitudes stay below 2⁵⁵ + 2, so that plane distances fit 63 bits. The scale must be so large that a w below
/// [`ClipVertex::MIN_W`] does not matter: such a vertex counts as behind the eye.
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
    /// Smallest w in front of the eye. A cut at this w is off by one unit, which is 1/8 of 1/256 px in x and y. The
    /// short path of the vertex transform never gives a smaller w. The long path gives one only nearer to the eye than
    /// positions resolve.
    pub const MIN_W: i64 = 1 << 20;
}

/// Treatment of geometry in front of the near plane and beyond the far plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthRange {
    /// Cuts away the parts in front of the near plane and beyond the far plane.
    #[default]
    Clip,
    /// Draws the part beyond the far plane at depth 65,535: a sky, a distant landscape.
    ///
    /// To be visible against a cleared depth buffer, such a draw needs
    /// [`Compare::LessEqual`](crate::span::Compare::LessEqual), because the buffer is cleared to 65,535.
    ClampFar,
    /// Draws the part in front of the near plane at depth 0, and the part beyond the far plane at depth 65,535.
    Clamp,
}

/// Set of planes that a vertex lies outside of, one bit per plane, after Cohen and Sutherland.
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

    /// Returns the planes that `vertex` lies outside of.
    #[inline]
    pub fn of(vertex: &ClipVertex) -> Self {
        Self((0..PLANES).fold(0, |code, plane| code | u8::from(distance(plane, vertex) < 0) << plane))
    }
}

/// Number of planes: w, near, far, and the four of the guard band (left, right, top, bottom).
pub(super) const PLANES: usize = 7;
pub(super) const NEAR: usize = 1;
pub(super) const FAR: usize = 2;

/// Returns the guard band's half width at `w`: (64 - 2⁻¹⁶) · 512 px, or 2²³ - 2 in 24.8.
#[inline]
const fn band(w: i64) -> i64 {
    64 * w - (w >> 16)
}

/// Returns the signed distance of a vertex from a plane: not negative inside, in a scale that differs from plane to
/// plane.
///
/// # Format
/// The result is below 2⁵⁶ · 65 < 2⁶³.
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

/// A corner of a polygon that is being clipped: its position, and its weights with respect to the triangle's three
/// corners.
///
/// The values that a shader interpolates are computed from the weights after clipping, so that clipping does not depend
/// on shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClipCorner {
    /// Position in clip space.
    pub vertex: ClipVertex,
    /// Weights of the triangle's three corners, 2.30. A corner of the triangle has the weight [`WHOLE`](Self::WHOLE)
    /// for itself and 0 for the others; a point on an edge has the weight 0 for the third corner.
    pub weights: [i32; 3],
}

impl ClipCorner {
    /// The weight 1.
    pub const WHOLE: i32 = 1 << 30;

    /// Makes corner `k` of a triangle.
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

/// Mixes the varyings of a triangle's corners by weights. At a corner of the triangle itself, the varyings come out
/// unchanged.
///
/// # Format
/// Products are below 2⁶¹, and sums are rounded to nearest. A value below 2²⁸ that is equal at all corners comes out
/// unchanged.
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

/// Largest number of corners after a triangle has been cut by all seven planes.
pub const CLIPPED_CORNERS: usize = 3 + PLANES;

/// A triangle that is being clipped: the corners of its polygon, in order, in a queue that holds the largest polygon
/// possible.
#[derive(Debug)]
pub(crate) struct Clipping<'p> {
    polygon: &'p mut DequeView<ClipCorner>,
}

/// A part of a triangle, by depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthSlab {
    /// The part in front of the near plane.
    InFrontOfNear,
    /// The part between the near and the far plane.
    Inside,
    /// The part beyond the far plane.
    BeyondFar,
}

impl DepthRange {
    /// Returns the depth planes that do not cut. The parts outside of them are drawn with their depth clamped.
    pub(crate) const fn clamped(self) -> Outcode {
        match self {
            Self::Clip => Outcode(0),
            Self::ClampFar => Outcode(Outcode::FAR),
            Self::Clamp => Outcode(Outcode::FAR | Outcode::NEAR),
        }
    }

    /// Returns the slabs to draw beside the one between the planes, for a triangle with `codes`, the union of its
    /// vertices' outcodes.
    #[doc(hidden)]
    pub fn clamped_slabs(self, codes: Outcode) -> impl Iterator<Item = DepthSlab> {
        let outside = codes.0 & self.clamped().0;
        let slabs = [(DepthSlab::InFrontOfNear, Outcode::NEAR), (DepthSlab::BeyondFar, Outcode::FAR)];
        slabs.into_iter().filter(move |(_, plane)| outside & plane != 0).map(|(slab, _)| slab)
    }
}

/// Cuts a triangle by the planes in `codes`, the union of its vertices' outcodes, and hands on the corners of the part
/// that lies in `slab`: a convex polygon, or nothing.
pub fn clip_triangle(triangle: [ClipVertex; 3], codes: Outcode, slab: DepthSlab, emit: impl FnMut(&ClipCorner)) {
    let mut polygon = Deque::<_, CLIPPED_CORNERS>::new();
    for (k, vertex) in triangle.into_iter().enumerate() {
        let _ = polygon.push_back(ClipCorner::new(vertex, k));
    }
    let mut clipping = Clipping::new(&mut polygon);
    clipping.clip(codes, slab);
    clipping.corners().for_each(emit);
}

impl<'p> Clipping<'p> {
    /// Begins with a triangle, in a queue that has room for one more corner per plane.
    pub(crate) fn new(polygon: &'p mut DequeView<ClipCorner>) -> Self {
        Self { polygon }
    }

    /// Clips the triangle by the planes in `codes`, the union of its vertices' outcodes. Leaves the part inside of
    /// these planes and in one slab of depth, or nothing.
    #[inline(never)]
    pub(crate) fn clip(&mut self, codes: Outcode, slab: DepthSlab) {
        // A triangle with a vertex at the eye itself is invisible: it is edge-on, and has no direction to be cut in.
        if self.corners().any(|corner| corner.vertex == ClipVertex::default()) {
            self.polygon.clear();
        }
        for plane in 0..PLANES {
            if codes.0 & (1 << plane) != 0 {
                self.cut(plane, slab.is_inside(plane), |corner| distance(plane, &corner.vertex));
            }
        }
        for k in 0..self.len() {
            if let Some(corner) = self.polygon.get_mut(k) {
                slab.clamp(&mut corner.vertex);
            }
        }
    }

    /// Leaves the part of the polygon on one side of a plane: inside, where distances are not negative, or outside.
    ///
    /// Takes each corner from the front of the queue. Puts the crossing of the edge to this corner at the back, if
    /// there is one, and then the corner, if it is kept. An edge that enters the kept side adds one corner; an edge
    /// that leaves it replaces the corner by the crossing. So the queue never holds more than one additional corner.
    ///
    /// # Source
    /// Sutherland and Hodgman 1974, "Reentrant polygon clipping".
    #[inline]
    pub(super) fn cut(&mut self, plane: usize, inside: bool, distance: impl Fn(&ClipCorner) -> i64) {
        let Some(mut from) = self.polygon.back().copied() else { return };
        let mut df = distance(&from);
        for _ in 0..self.len() {
            let Some(to) = self.polygon.pop_front() else { return };
            let dt = distance(&to);
            if (df >= 0) != (dt >= 0) {
                self.push(&crossing(plane, &from, &to, df, dt));
            }
            if (dt >= 0) == inside {
                self.push(&to);
            }
            (from, df) = (to, dt);
        }
        if self.len() < 3 {
            self.polygon.clear();
        }
    }

    /// Adds a corner, field by field: a copy of the whole would link `memmove`, of 1.5 KB.
    #[inline(never)]
    fn push(&mut self, corner: &ClipCorner) {
        let ClipVertex { x, y, z, w } = corner.vertex;
        let [a, b, c] = corner.weights;
        let _ = self.polygon.push_back(ClipCorner { vertex: ClipVertex { x, y, z, w }, weights: [a, b, c] });
    }

    /// Returns the corners of the clipped polygon, in order.
    pub(crate) fn corners(&self) -> impl Iterator<Item = &ClipCorner> {
        // The queue's own iterator goes over two slices, with a loop for each.
        (0..self.len()).map_while(|k| self.corner(k))
    }

    /// Returns the number of corners.
    #[inline(never)]
    fn len(&self) -> usize {
        self.polygon.storage_len()
    }

    #[inline(never)]
    fn corner(&self, k: usize) -> Option<&ClipCorner> {
        self.polygon.get(k)
    }
}

impl DepthSlab {
    /// Returns whether the slab lies inside of a plane.
    pub(super) fn is_inside(self, plane: usize) -> bool {
        !((plane == NEAR && self == Self::InFrontOfNear) || (plane == FAR && self == Self::BeyondFar))
    }

    /// Sets the depth of a vertex in a slab outside of the depth planes to the depth of the slab's plane.
    pub(super) fn clamp(self, vertex: &mut ClipVertex) {
        match self {
            Self::InFrontOfNear => vertex.z = 0,
            Self::Inside => {}
            Self::BeyondFar => vertex.z = vertex.w,
        }
    }
}

/// Returns the point where the edge between two corners on different sides of a plane meets the plane, from the
/// corners' distances `df` and `dt`. On the near and the far plane, its depth is exact.
///
/// # Format
/// t = da / (da - db) as 0.64, rounded down. a is the corner inside and b the one outside, so that AB is cut like BA.
/// Coordinates are off by less than 1 + 2⁻⁷ of their unit.
#[inline(never)]
pub(super) fn crossing(plane: usize, from: &ClipCorner, to: &ClipCorner, df: i64, dt: i64) -> ClipCorner {
    let (a, b, da) = if df >= 0 { (from, to, df) } else { (to, from, dt) };
    let t = fraction(da as u64, df.abs_diff(dt));
    let (p, q) = (&a.vertex, &b.vertex);
    let mut vertex = ClipVertex {
        x: interpolate(p.x, q.x, t),
        y: interpolate(p.y, q.y, t),
        z: interpolate(p.z, q.z, t),
        w: interpolate(p.w, q.w, t),
    };
    match plane {
        NEAR => vertex.z = 0,
        FAR => vertex.z = vertex.w,
        _ => {}
    }
    let mut weights = a.weights;
    for (weight, b) in weights.iter_mut().zip(&b.weights) {
        *weight = interpolate((*weight).into(), (*b).into(), t) as i32;
    }
    ClipCorner { vertex, weights }
}

/// Returns `a + (b - a) t` with t as 0.64, rounded towards `a`.
///
/// # Format
/// |b - a| < 2⁵⁷. The product is made of four products of halves, each below 2⁶⁴, with their carries.
#[inline(never)]
fn interpolate(a: i64, b: i64, t: u64) -> i64 {
    let d = b.abs_diff(a);
    let (d1, d0) = (d >> 32, d & 0xFFFF_FFFF);
    let (t1, t0) = (t >> 32, t & 0xFFFF_FFFF);
    let middle = d1 * t0 + ((d0 * t0) >> 32);
    let other = d0 * t1 + (middle & 0xFFFF_FFFF);
    let part = (d1 * t1 + (middle >> 32) + (other >> 32)) as i64;
    if b < a { a - part } else { a + part }
}

/// Returns `num / den` as 0.64, rounded down; `num < den < 2⁶³`.
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

    /// The edge from a to -a meets w = 0 in the eye: its part in front of the eye projects to a, and to no other point.
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
        // Both ends of the remaining part of the edge.
        assert!(near >= 2);
    }
}
