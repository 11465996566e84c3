//! The order of draws: transparent things are drawn after all others, from back to front.

use super::bounds::Bounds;
use crate::math::Projective;

/// Returns the distance of the middle of `bounds` along the axis of the camera of `mvp`: the w of its centre, 32.32,
/// saturated.
#[must_use]
pub fn view_depth(mvp: &Projective, bounds: &Bounds) -> i64 {
    let [x, y, z] = bounds.center.to_bits();
    let row = mvp.to_rows()[3];
    // Entries are 32.32, coordinates are 16.16. The upper and the lower half of an entry are multiplied apart.
    let times = |entry: i64, c: i32| {
        (entry >> 16).saturating_mul(i64::from(c)).saturating_add(((entry & 0xFFFF) * i64::from(c)) >> 16)
    };
    times(row[0], x).saturating_add(times(row[1], y)).saturating_add(times(row[2], z)).saturating_add(row[3])
}

/// Sorts draws, or numbers of draws, by their depth, the farthest first. Draws of equal depth keep their order.
///
/// Blending needs this order, since a colour is mixed with the one that is already there. Blending that only adds or
/// only multiplies does not. A scene without a depth buffer needs the order for all of its draws. Sort once per
/// frame, outside of the frame's closure, since each call of the closure must draw in one order:
///
/// 1. everything opaque, in any order, best from front to back;
/// 2. everything transparent, from back to front, with [`DepthState::TEST`](crate::span::DepthState::TEST): opaque
///    things in front hide it, and it hides nothing;
/// 3. light that is added, such as sparks.
///
/// A closed transparent mesh is best drawn twice, its back faces first.
///
/// This is an insertion sort. It needs no memory, and calls `depth` once per comparison. If the list starts in the
/// order of the previous frame and is still sorted, it takes one comparison per draw. It suits tens or hundreds of
/// draws, not thousands.
///
/// ```
/// use zstrip::mesh::sort_back_to_front;
/// let mut order = [(20, "house"), (300, "hill"), (7, "tree")];
/// sort_back_to_front(&mut order, |(distance, _)| *distance);
/// assert_eq!(order.map(|(_, name)| name), ["hill", "house", "tree"]);
/// ```
/// With [`view_depth`] for depths and an order of numbers, that is
/// `sort_back_to_front(&mut order, |k| view_depth(&mvps[*k], mesh.bounds()))`.
pub fn sort_back_to_front<T>(order: &mut [T], depth: impl Fn(&T) -> i64) {
    for end in 2..=order.len() {
        let Some(mut sorted) = order.get_mut(..end) else { return };
        let Some(new) = sorted.last().map(&depth) else { return };
        while let Some((place, before)) = sorted.split_last_mut() {
            let Some(previous) = before.last_mut() else { break };
            if depth(previous) >= new {
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
    use embedded_graphics_core::geometry::Size;
    use std::vec::Vec;

    #[test]
    fn draws_are_sorted_like_by_the_standard_library() {
        let mut rng = Rng::new(7);
        for length in 0..40_u16 {
            for spread in [1, 4, 1000] {
                let depths: Vec<i64> = (0..length).map(|_| rng.below(spread) as i64).collect();
                let mut order: Vec<u16> = (0..length).rev().collect();
                let mut expected = order.clone();
                sort_back_to_front(&mut order, |k| depths[usize::from(*k)]);
                expected.sort_by_key(|&k| -depths[usize::from(k)]);
                assert_eq!(order, expected, "{depths:?}");
            }
        }
    }

    #[test]
    fn depth_is_the_distance_before_the_camera() {
        let camera =
            Projective::perspective(Angle16::from_degrees(60), Size::new(4, 3), Scalar::ONE, Scalar::from_num(100))
                .unwrap();
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
