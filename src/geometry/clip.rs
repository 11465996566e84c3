//! Clipping in homogeneous space: outcodes, and polygons cut by one plane after the other.
//!
//! Four rules hold: visible vertices pass unchanged, bit by bit; edge AB is cut like BA, since a cut always goes from
//! the vertex inside to the one outside; planes come in one order; there is one set of planes. Sides of the view are
//! no planes here: the rasterizer is exact to ±32,767 px, and only at that guard band anything is cut.

use super::Varyings;
use heapless::Deque;

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
    /// Against a cleared depth buffer that takes [`Compare::LessEqual`](crate::fragment::Compare::LessEqual), as 65,535 is
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
        let mut code = 0;
        for plane in 0..PLANES {
            code |= u8::from(distance(plane, vertex) < 0) << plane;
        }
        Self(code)
    }
}

/// w, near, far, then the guard band: left, right, top, bottom.
pub(super) const PLANES: usize = 7;
pub(super) const NEAR: usize = 1;
pub(super) const FAR: usize = 2;

/// Signed distance from a plane, not negative inside, in a scale of its own.
///
/// # Format
/// Below 2⁵⁶ · 65 < 2⁶³. The guard band is (64 - 2⁻¹⁶) · 512 px, or 2²³ - 2 in 24.8.
#[inline]
pub(super) fn distance(plane: usize, v: &ClipVertex) -> i64 {
    let band = 64 * v.w - (v.w >> 16);
    match plane {
        0 => v.w - ClipVertex::MIN_W,
        NEAR => v.z,
        FAR => v.w - v.z,
        3 => band + v.x,
        4 => band - v.x,
        5 => band + v.y,
        _ => band - v.y,
    }
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

    /// Corner `k` of a triangle.
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

/// A triangle cut by seven planes has at most ten corners, and one more is in its place twice while a plane cuts.
const CORNERS: usize = 11;
type Polygon = Deque<ClipCorner, CORNERS>;

/// A part of a triangle, by depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Before the near plane.
    Before,
    /// Between near and far plane.
    Between,
    /// Beyond the far plane.
    Beyond,
}

impl DepthRange {
    /// The depth planes that are not clipped at: what lies outside of them is drawn with its depth clamped.
    pub const fn clamped(self) -> Outcode {
        match self {
            Self::Clip => Outcode(0),
            Self::ClampFar => Outcode(Outcode::FAR),
            Self::Clamp => Outcode(Outcode::FAR | Outcode::NEAR),
        }
    }

    /// The parts to draw of a triangle whose vertices' outcodes are `codes`, united.
    pub fn parts(self, codes: Outcode) -> impl Iterator<Item = Part> {
        let outside = codes.0 & self.clamped().0;
        let before = (outside & Outcode::NEAR != 0).then_some(Part::Before);
        let beyond = (outside & Outcode::FAR != 0).then_some(Part::Beyond);
        [before, Some(Part::Between), beyond].into_iter().flatten()
    }
}

/// Cuts a triangle by the planes in `codes` (the outcodes of its vertices, united) and hands on the corners of what is
/// left in one part of it: a convex polygon, or nothing.
#[inline]
pub fn clip_triangle(triangle: [ClipVertex; 3], codes: Outcode, part: Part, emit: impl FnMut(&ClipCorner)) {
    let mut polygon = Polygon::new();
    clip(&mut polygon, &triangle, codes, part);
    polygon.iter().for_each(emit);
}

/// [`clip_triangle`] into an empty polygon.
#[inline(never)]
fn clip(polygon: &mut Polygon, triangle: &[ClipVertex; 3], codes: Outcode, part: Part) {
    for (k, vertex) in triangle.iter().enumerate() {
        // A vertex at the eye itself leaves nothing to see: the triangle is edge-on, and has no direction to be cut in.
        if *vertex == ClipVertex::default() {
            polygon.clear();
            return;
        }
        // Three fit eleven; the same holds for every push below.
        let _ = polygon.push_back(ClipCorner::new(*vertex, k));
    }
    for plane in 0..PLANES {
        if codes.0 & (1 << plane) != 0 {
            let outside = (plane == NEAR && part == Part::Before) || (plane == FAR && part == Part::Beyond);
            cut(polygon, plane, !outside);
        }
    }
    if polygon.len() < 3 {
        polygon.clear();
    }
    polygon.iter_mut().for_each(|corner| part.clamp(&mut corner.vertex));
}

impl Part {
    /// Brings what is before or beyond to its plane.
    pub(super) fn clamp(self, vertex: &mut ClipVertex) {
        match self {
            Self::Before => vertex.z = 0,
            Self::Between => {}
            Self::Beyond => vertex.z = vertex.w,
        }
    }
}

/// Leaves the part of a convex polygon that is on one side of a plane: inside, or outside.
///
/// Corners are taken from the front and put back behind, in place.
///
/// # Source
/// Sutherland and Hodgman 1974, "Reentrant polygon clipping".
#[inline(never)]
fn cut(polygon: &mut Polygon, plane: usize, inside: bool) {
    let Some(mut from) = polygon.back().copied() else { return };
    for _ in 0..polygon.len() {
        let Some(to) = polygon.pop_front() else { return };
        if let Some(crossing) = intersection(&from, &to, plane) {
            let _ = polygon.push_back(crossing);
        }
        if (distance(plane, &to.vertex) >= 0) == inside {
            let _ = polygon.push_back(to);
        }
        from = to;
    }
}

/// Where an edge meets the plane, if its ends are on different sides of it.
///
/// # Format
/// t = da / (da - db) as 0.64, rounded down, with a inside and b outside, so that AB is cut like BA; coordinates are off by
/// less than 1 + 2⁻⁷ of their unit.
#[inline(never)]
pub(super) fn intersection(from: &ClipCorner, to: &ClipCorner, plane: usize) -> Option<ClipCorner> {
    let (mut a, mut b) = (from, to);
    let (mut da, mut db) = (distance(plane, &a.vertex), distance(plane, &b.vertex));
    if (da >= 0) == (db >= 0) {
        return None;
    }
    if da < 0 {
        (a, b, da, db) = (b, a, db, da);
    }
    let mut crossing = crossing(a, da, b, db);
    match plane {
        NEAR => crossing.vertex.z = 0,
        FAR => crossing.vertex.z = crossing.vertex.w,
        _ => {}
    }
    Some(crossing)
}

/// Where the edge from `a`, at the distance `da` inside of a plane, to `b`, outside, meets it.
#[inline]
pub(super) fn crossing(a: &ClipCorner, da: i64, b: &ClipCorner, db: i64) -> ClipCorner {
    let t = fraction(da as u64, da.abs_diff(db));
    let mut crossing = *a;
    let ClipVertex { x, y, z, w } = &mut crossing.vertex;
    let end = b.vertex;
    for (value, end) in [x, y, z, w].into_iter().zip([end.x, end.y, end.z, end.w]) {
        *value = along(*value, end, t);
    }
    for (value, end) in crossing.weights.iter_mut().zip(b.weights) {
        *value = along(i64::from(*value), i64::from(end), t) as i32;
    }
    crossing
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
        clip_triangle(triangle, Outcode(codes), Part::Between, |_| corners += 1);
        corners
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
        clip_triangle(triangle, Outcode(codes), Part::Between, |corner| {
            let v = project(&corner.vertex);
            near += u32::from((v[0] - x).hypot(v[1] - y) < 0.5);
        });
        // Both ends of what is left of the edge.
        assert!(near >= 2);
    }
}
