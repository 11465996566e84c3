//! Clipping in homogeneous space: outcodes, and polygons cut by one plane after the other.
//!
//! Four rules hold: visible vertices pass unchanged, bit by bit; edge AB is cut like BA, since a cut always goes from
//! the vertex inside to the one outside; planes come in one order; there is one set of planes. Sides of the view are
//! no planes here: the rasterizer is exact to ±32,767 px, and only at that guard band anything is cut.

use super::varyings::Varyings;
use core::cell::Cell;

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
        let place = [Cell::new(vertex.x), Cell::new(vertex.y), Cell::new(vertex.z), Cell::new(vertex.w)];
        Self((0..PLANES).fold(0, |code, plane| code | u8::from(distance(plane, &place) < 0) << plane))
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
pub(super) fn distance(plane: usize, [x, y, z, w]: &[Cell<i64>; 4]) -> i64 {
    let w = w.get();
    let band = band(w);
    let (border, value) = match plane {
        0 => return w - ClipVertex::MIN_W,
        NEAR => (0, z),
        FAR => (w, z),
        3 | 4 => (band, x),
        _ => (band, y),
    };
    if plane & 1 == 0 { border - value.get() } else { border + value.get() }
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

/// A corner of a [`Polygon`].
#[derive(Clone, Debug, Default)]
pub struct PolygonCorner {
    /// x, y, z, w in clip space.
    pub(super) place: [Cell<i64>; 4],
    /// See [`ClipCorner::weights`].
    weights: [Cell<i32>; 3],
    /// The place of the next corner.
    next: Cell<u8>,
}

impl PolygonCorner {
    const fn new() -> Self {
        Self { place: [const { Cell::new(0) }; 4], weights: [const { Cell::new(0) }; 3], next: Cell::new(0) }
    }

    /// VertexRef `k` of a triangle.
    pub(super) fn set(&self, vertex: &ClipVertex, k: usize) {
        for (place, c) in self.place.iter().zip([vertex.x, vertex.y, vertex.z, vertex.w]) {
            place.set(c);
        }
        for (own, weight) in self.weights.iter().enumerate() {
            weight.set(if own == k { ClipCorner::WHOLE } else { 0 });
        }
    }

    /// Where it is.
    #[inline]
    pub fn vertex(&self) -> ClipVertex {
        let [x, y, z, w] = &self.place;
        ClipVertex { x: x.get(), y: y.get(), z: z.get(), w: w.get() }
    }

    /// How much of the triangle's corners is in it.
    #[inline]
    pub fn weights(&self) -> [i32; 3] {
        let [a, b, c] = &self.weights;
        [a.get(), b.get(), c.get()]
    }
}

/// A convex polygon that is being cut: a ring of corners, in places of which there are at least as many as corners.
///
/// ```text
/// ring.last ─→ corner ─→ corner ─→ ... ─→ back to the last        ring.free ─→ place ─→ place ─→ ... ─→ none
/// ```
/// Corners stay where they are; a cut moves links.
#[derive(Clone, Debug)]
pub struct Polygon<C: ?Sized = [PolygonCorner]> {
    ring: Ring,
    corners: C,
}

#[derive(Clone, Debug)]
struct Ring {
    len: usize,
    /// The place of the last corner; the first one is the next of it.
    last: usize,
    /// The first place without a corner.
    free: usize,
}

impl Ring {
    /// A place for a new corner.
    #[inline]
    fn take<'c>(&mut self, corners: &'c [PolygonCorner]) -> Option<(usize, &'c PolygonCorner)> {
        let place = self.free;
        let corner = corners.get(place)?;
        self.free = usize::from(corner.next.get());
        Some((place, corner))
    }

    /// Puts a corner behind the last one.
    #[inline(never)]
    fn append(&mut self, corners: &[PolygonCorner], place: usize, corner: &PolygonCorner) {
        let mut first = place as u8;
        if let (1.., Some(last)) = (self.len, corners.get(self.last)) {
            first = last.next.replace(first);
        }
        corner.next.set(first);
        self.last = place;
        self.len += 1;
    }
}

impl<const N: usize> Polygon<[PolygonCorner; N]> {
    /// Without corners, with room for `N`.
    #[inline]
    pub fn new() -> Self {
        Self { ring: Ring { len: 0, last: 0, free: 0 }, corners: [const { PolygonCorner::new() }; N] }
    }
}

impl<const N: usize> Default for Polygon<[PolygonCorner; N]> {
    fn default() -> Self {
        Self::new()
    }
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
pub fn clip_triangle(triangle: [ClipVertex; 3], codes: Outcode, part: DepthSlab, mut emit: impl FnMut(&ClipCorner)) {
    let polygon: &mut Polygon = &mut Polygon::<[PolygonCorner; CLIPPED_CORNERS]>::new();
    for (k, vertex) in triangle.iter().enumerate() {
        polygon.set(k, vertex);
    }
    polygon.clip(codes, part);
    for corner in polygon.corners() {
        emit(&ClipCorner { vertex: corner.vertex(), weights: corner.weights() });
    }
}

impl Polygon {
    /// Sets corner `k` of the triangle that a new polygon is to be cut from.
    pub fn set(&mut self, k: usize, vertex: &ClipVertex) {
        if let Some(corner) = self.corners.get(k) {
            corner.set(vertex, k);
        }
    }

    /// Becomes the part of its triangle that is inside of the planes in `codes` (the outcodes of its vertices, united), or nothing.
    #[inline(never)]
    pub fn clip(&mut self, codes: Outcode, part: DepthSlab) {
        self.ring = Ring { len: 3, last: 2, free: 3 };
        for (k, corner) in self.corners.iter().enumerate() {
            corner.next.set(if k == 2 { 0 } else { k as u8 + 1 });
            // A vertex at the eye itself leaves nothing to see: the triangle is edge-on, and has no direction to be cut in.
            if k < 3 && corner.place.iter().fold(0, |all, c| all | c.get()) == 0 {
                self.ring.len = 0;
                return;
            }
        }
        for plane in 0..PLANES {
            if codes.0 & (1 << plane) != 0 {
                self.cut(plane, part.is_inside(plane), |corner| distance(plane, &corner.place));
            }
        }
        for corner in self.corners() {
            part.clamp(&corner.place);
        }
    }

    /// Leaves the part of it that is on one side of a plane: inside, where distances are not negative, or outside.
    ///
    /// A corner that is cut away leaves its place to the next that is found, even if that is on the edge from it: a crossing may
    /// be written over either end. So there are never more places in use than one more than corners before.
    ///
    /// # Source
    /// Sutherland and Hodgman 1974, "Reentrant polygon clipping".
    #[inline]
    pub(super) fn cut(&mut self, plane: usize, inside: bool, distance: impl Fn(&PolygonCorner) -> i64) {
        let Self { ring, corners } = self;
        let Some(mut from) = corners.get(ring.last) else { return };
        let mut df = distance(from);
        let mut next = usize::from(from.next.get());
        for _ in 0..core::mem::take(&mut ring.len) {
            let place = next;
            let Some(to) = corners.get(place) else { return };
            next = usize::from(to.next.get());
            let dt = distance(to);
            if (df >= 0) != (dt >= 0) {
                // There are as many places as corners.
                if let Some((place, new)) = ring.take(corners) {
                    crossing(plane, [from, to, new], df, dt);
                    ring.append(corners, place, new);
                }
            }
            if (dt >= 0) == inside {
                ring.append(corners, place, to);
            } else {
                to.next.set(ring.free as u8);
                ring.free = place;
            }
            (from, df) = (to, dt);
        }
        if ring.len < 3 {
            ring.len = 0;
        }
    }

    /// Its corners, in order.
    #[inline]
    pub fn corners(&self) -> Corners<'_> {
        Corners { corners: &self.corners, last: self.ring.last, left: self.ring.len }
    }
}

/// The corners of a polygon, in order.
#[derive(Clone, Debug)]
pub struct Corners<'p> {
    corners: &'p [PolygonCorner],
    /// The place of the last one that was given, and how many are left.
    last: usize,
    left: usize,
}

impl<'p> Iterator for Corners<'p> {
    type Item = &'p PolygonCorner;

    #[inline]
    fn next(&mut self) -> Option<&'p PolygonCorner> {
        self.left = self.left.checked_sub(1)?;
        self.last = usize::from(self.corners.get(self.last)?.next.get());
        self.corners.get(self.last)
    }
}

impl DepthSlab {
    /// Whether it is inside of a plane.
    pub(super) fn is_inside(self, plane: usize) -> bool {
        !((plane == NEAR && self == Self::InFrontOfNear) || (plane == FAR && self == Self::BeyondFar))
    }

    /// Brings what is before or beyond to its plane.
    pub(super) fn clamp(self, [_, _, z, w]: &[Cell<i64>; 4]) {
        match self {
            Self::InFrontOfNear => z.set(0),
            Self::Inside => {}
            Self::BeyondFar => z.set(w.get()),
        }
    }
}

/// Where the edge between two corners on different sides of a plane meets it; that is written to the third, which may be either
/// of them. Distances from the plane are given; on the near and the far plane, depth is exact.
///
/// # Format
/// t = da / (da - db) as 0.64, rounded down, with a inside and b outside, so that AB is cut like BA; coordinates are off by
/// less than 1 + 2⁻⁷ of their unit.
#[inline(never)]
pub(super) fn crossing(plane: usize, [from, to, new]: [&PolygonCorner; 3], df: i64, dt: i64) {
    let (a, b, da) = if df >= 0 { (from, to, df) } else { (to, from, dt) };
    let t = fraction(da as u64, df.abs_diff(dt));
    for ((new, a), b) in new.place.iter().zip(&a.place).zip(&b.place) {
        new.set(along(a.get(), b.get(), t));
    }
    for ((new, a), b) in new.weights.iter().zip(&a.weights).zip(&b.weights) {
        new.set(along(a.get().into(), b.get().into(), t) as i32);
    }
    let [_, _, z, w] = &new.place;
    match plane {
        NEAR => z.set(0),
        FAR => z.set(w.get()),
        _ => {}
    }
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
    use crate::math::random::Rng;
    use std::vec::Vec;

    fn corners(triangle: [[i64; 4]; 3]) -> usize {
        let triangle = triangle.map(|[x, y, z, w]| ClipVertex { x, y, z, w });
        let codes = triangle.iter().fold(0, |codes, v| codes | Outcode::of(v).0);
        let mut corners = 0;
        clip_triangle(triangle, Outcode(codes), DepthSlab::Inside, |_| corners += 1);
        corners
    }

    /// Corners copied from polygon to polygon, plane by plane.
    fn plainly_clipped(triangle: [ClipVertex; 3], codes: Outcode, part: DepthSlab) -> Vec<(ClipVertex, [i32; 3])> {
        let corner = |vertex: &ClipVertex, weights: [i32; 3]| {
            let corner = PolygonCorner::default();
            corner.set(vertex, 0);
            corner.weights.iter().zip(weights).for_each(|(own, weight)| own.set(weight));
            corner
        };
        let mut polygon: Vec<_> = (0..3).map(|k| (triangle[k], ClipCorner::new(triangle[k], k).weights)).collect();
        for plane in (0..PLANES).filter(|plane| codes.0 & 1 << plane != 0) {
            let mut left = Vec::new();
            for (k, to) in polygon.iter().enumerate() {
                let from = &polygon[(k + polygon.len() - 1) % polygon.len()];
                let (from, to) = (corner(&from.0, from.1), corner(&to.0, to.1));
                let (df, dt) = (distance(plane, &from.place), distance(plane, &to.place));
                if (df >= 0) != (dt >= 0) {
                    let new = PolygonCorner::default();
                    crossing(plane, [&from, &to, &new], df, dt);
                    left.push((new.vertex(), new.weights()));
                }
                if (dt >= 0) == part.is_inside(plane) {
                    left.push((to.vertex(), to.weights()));
                }
            }
            polygon = left;
        }
        if polygon.len() < 3 {
            polygon.clear();
        }
        for (vertex, _) in &mut polygon {
            match part {
                DepthSlab::InFrontOfNear => vertex.z = 0,
                DepthSlab::Inside => {}
                DepthSlab::BeyondFar => vertex.z = vertex.w,
            }
        }
        polygon
    }

    #[test]
    fn corners_in_a_ring_are_those_of_polygon_after_polygon() {
        let mut rng = Rng::new(11);
        let mut next = |bits: u32| rng.signed_bits(bits);
        let mut most = 0;
        for case in 0..20_000 {
            // Some with small w, which cross most of the guard band's planes.
            let w = [40, 47, 50][case % 3];
            let mut vertex = || ClipVertex { x: next(54), y: next(54), z: next(w), w: next(w) + (1 << (w - 2)) };
            let triangle = [vertex(), vertex(), vertex()];
            let codes = Outcode(triangle.iter().fold(0, |codes, v| codes | Outcode::of(v).0));
            for part in [DepthSlab::InFrontOfNear, DepthSlab::Inside, DepthSlab::BeyondFar] {
                let mut found = Vec::new();
                clip_triangle(triangle, codes, part, |corner| found.push((corner.vertex, corner.weights)));
                assert_eq!(found, plainly_clipped(triangle, codes, part), "case {case}: {triangle:?}");
                most = most.max(found.len());
            }
        }
        assert!(most >= 8, "{most}");
    }

    #[test]
    fn outcodes_are_the_signs_of_distances() {
        let values = [-(1 << 54), -64 << 20, -1, 0, 1, 1 << 20, (64 << 20) - 16, (64 << 20) - 15, 64 << 20, 1 << 54];
        for (x, y) in values.into_iter().flat_map(|x| values.map(|y| (x, y))) {
            for (z, w) in values.into_iter().flat_map(|z| values.map(|w| (z, w))) {
                let (vertex, corner) = (ClipVertex { x, y, z, w }, PolygonCorner::default());
                corner.set(&vertex, 0);
                let code = (0..PLANES).fold(0, |code, k| code | u8::from(distance(k, &corner.place) < 0) << k);
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
