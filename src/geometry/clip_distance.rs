//! Clip distances: planes of a shader's own, which cut what [`clip_triangle`](super::clip_triangle) has left.

use super::ClipCorner;
use super::clip::crossing;
use heapless::Deque;

/// Most distances that a shader may have.
pub const MAX_DISTANCES: usize = 4;

/// Most corners of a triangle that is cut by seven planes and by four distances.
pub const DISTANCE_CORNERS: usize = 10 + MAX_DISTANCES;

/// What is left of a convex polygon, with room for one corner that is in its place twice while it is cut.
pub type DistancePolygon = Deque<ClipCorner, { DISTANCE_CORNERS + 1 }>;

/// Leaves the part of a convex polygon where a distance, given at the corners of its triangle, is not negative.
///
/// The rules are those of the other planes: what is inside passes unchanged, and an edge is cut from its end inside to the one
/// outside, whichever triangle it belongs to.
///
/// # Format
/// A corner's distance is the sum of its weights, 2.30, times those of the triangle's corners: below 2⁶².
#[inline(never)]
pub fn cut_by_distance(polygon: &mut DistancePolygon, distances: [i32; 3]) {
    let distance = |corner: &ClipCorner| {
        let ([a, b, c], [wa, wb, wc]) = (distances.map(i64::from), corner.weights.map(i64::from));
        a * wa + b * wb + c * wc
    };
    let Some(mut from) = polygon.back().copied() else { return };
    for _ in 0..polygon.len() {
        let Some(to) = polygon.pop_front() else { return };
        let (df, dt) = (distance(&from), distance(&to));
        if (df >= 0) != (dt >= 0) {
            let cut = if df >= 0 { crossing(&from, df, &to, dt) } else { crossing(&to, dt, &from, df) };
            let _ = polygon.push_back(cut);
        }
        if dt >= 0 {
            let _ = polygon.push_back(to);
        }
        from = to;
    }
    if polygon.len() < 3 {
        polygon.clear();
    }
}
