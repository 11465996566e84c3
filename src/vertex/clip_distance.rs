//! Clip distances: planes of a shader's own, which cut what [`Clipping::clip`] has left.

use super::clip::{CLIPPED_CORNERS, Clipping, PLANES};

/// Most distances that a shader may have.
pub const MAX_DISTANCES: usize = 4;

/// Most corners of a triangle that is cut by seven planes and by four distances.
pub const DISTANCE_CORNERS: usize = CLIPPED_CORNERS + MAX_DISTANCES;

impl Clipping<'_> {
    /// Leaves the part of it where a distance, given at the corners of its triangle, is not negative.
    ///
    /// The rules are those of the other planes: what is inside passes unchanged, and an edge is cut from its end inside to the
    /// one outside, whichever triangle it belongs to.
    ///
    /// # Format
    /// A corner's distance is the sum of its weights, 2.30, times those of the triangle's corners: below 2⁶².
    #[inline(never)]
    pub fn cut_by_distance(&mut self, distances: [i32; 3]) {
        self.cut(PLANES, true, |corner| {
            let ([a, b, c], [wa, wb, wc]) = (distances.map(i64::from), corner.weights.map(i64::from));
            a * wa + b * wb + c * wc
        });
    }
}
