//! Clip distances: planes that a shader adds itself. They cut the polygon that [`Clipping::clip`] has left.

use super::clip::{CLIPPED_CORNERS, Clipping, PLANES};

/// Largest number of distances that a shader may have.
pub const MAX_DISTANCES: usize = 4;

/// Largest number of corners after a triangle has been cut by seven planes and by four distances.
pub const DISTANCE_CORNERS: usize = CLIPPED_CORNERS + MAX_DISTANCES;

impl Clipping<'_> {
    /// Leaves the part of the polygon where a distance is not negative. The distance is given at the triangle's three
    /// corners.
    ///
    /// The rules are those of the other planes: a corner inside passes unchanged, and an edge is cut from its end
    /// inside to its end outside, whichever triangle it belongs to.
    ///
    /// # Format
    /// The distance at a corner is the sum of its weights, 2.30, times the distances at the triangle's corners: below
    /// 2⁶².
    #[inline(never)]
    pub fn cut_by_distance(&mut self, distances: [i32; 3]) {
        self.cut(PLANES, true, |corner| {
            let ([a, b, c], [wa, wb, wc]) = (distances.map(i64::from), corner.weights.map(i64::from));
            a * wa + b * wb + c * wc
        });
    }
}
