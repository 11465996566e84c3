//! The order of draws: transparent things are drawn after all others, from back to front.

use super::bounds::Bounds;
use crate::math::Projective;

/// How far away the middle of `bounds` is, as `mvp` sees it: w of its centre, 32.32, saturated.
pub fn view_depth(mvp: &Projective, bounds: &Bounds) -> i64 {
    let [x, y, z] = bounds.center.to_bits();
    let row = mvp.to_rows()[3];
    // Entries of 32.32 by coordinates of 16.16, the upper half of the entry and the lower one.
    let times = |entry: i64, c: i32| {
        (entry >> 16).saturating_mul(i64::from(c)).saturating_add(((entry & 0xFFFF) * i64::from(c)) >> 16)
    };
    times(row[0], x).saturating_add(times(row[1], y)).saturating_add(times(row[2], z)).saturating_add(row[3])
}

/// Sorts the numbers of draws by their depth, the farthest first; equal depths by number.
///
/// Blending needs this order, since a colour is mixed with what is already there; adding and multiplying alone do not. Do it
/// once a frame, before the frame's closure, which has to draw the same each time it is called:
///
/// 1. everything opaque, in any order, best from front to back;
/// 2. what is transparent, from back to front, with [`DepthState::TEST`](crate::span::DepthState::TEST): it is hidden by
///    what is before it, and hides nothing;
/// 3. what is added, such as sparks.
///
/// Closed meshes that are transparent are best drawn twice, back faces first. The order from the frame before is a good one
/// to start from: a sorted list takes one comparison a draw. (Insertion sort: with no memory of its own, and for tens of
/// draws, not for thousands.)
///
/// ```
/// use zstrip::mesh::sort_back_to_front;
/// let depths = [3, 9, 1];
/// let mut order = [0, 1, 2];
/// sort_back_to_front(&mut order, |draw| depths[usize::from(draw)]);
/// assert_eq!(order, [1, 0, 2]);
/// ```
/// With [`view_depth`] for depths, that is `sort_back_to_front(&mut order, |k| view_depth(&mvps[k], mesh.bounds()))`.
pub fn sort_back_to_front(order: &mut [u16], depth: impl Fn(u16) -> i64) {
    for end in 2..=order.len() {
        let Some(mut sorted) = order.get_mut(..end) else { return };
        let Some(&draw) = sorted.last() else { return };
        let new = depth(draw);
        while let Some((place, before)) = sorted.split_last_mut() {
            let Some(previous) = before.last_mut() else { break };
            let old = depth(*previous);
            if old > new || (old == new && *previous < draw) {
                break;
            }
            core::mem::swap(place, previous);
            sorted = before;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use crate::math::{Affine, Angle16, Scalar, Vec3};
    use std::vec::Vec;

    #[test]
    fn draws_are_sorted_like_by_the_standard_library() {
        let mut rng = Rng::new(7);
        for length in 0..40_u16 {
            for spread in [1, 4, 1000] {
                let depths: Vec<i64> = (0..length).map(|_| rng.below(spread) as i64).collect();
                let mut order: Vec<u16> = (0..length).rev().collect();
                sort_back_to_front(&mut order, |k| depths[usize::from(k)]);
                let mut expected: Vec<u16> = (0..length).collect();
                expected.sort_by_key(|&k| (-depths[usize::from(k)], k));
                assert_eq!(order, expected, "{depths:?}");
            }
        }
    }

    #[test]
    fn depth_is_the_distance_before_the_camera() {
        let camera =
            Projective::perspective(Angle16::from_degrees(60), (4, 3), Scalar::ONE, Scalar::from_num(100)).unwrap();
        let center = Vec3::from_milli(300, -200, 500);
        let bounds = Bounds { center, half: Vec3::ZERO };
        for distance in [-20, 0, 3, 90] {
            let mvp = camera * Affine::translation(Vec3::from_ints(1, 2, -distance));
            let exact = i64::from(distance) * (1 << 32) - (i64::from(center.z.to_bits()) << 16);
            assert!(view_depth(&mvp, &bounds).abs_diff(exact) < 1 << 17, "{distance}");
        }
        let far = Projective::from_rows([[i64::MIN; 4]; 4]);
        assert!(view_depth(&far, &bounds) < 0);
    }
}
