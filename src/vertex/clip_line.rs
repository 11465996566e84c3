//! Clipping of lines: by the planes of [`clip_triangle`](crate::vertex::clip_triangle), in the order of its planes and
//! with its cuts.

use super::clip::{ClipCorner, ClipVertex, DepthSlab, Outcode, PLANES, crossing, distance};

/// Cuts a line by the planes in `codes`, the union of its ends' outcodes. Returns the ends of the part that lies in
/// `slab`, or `None` if no part does. The third weight of both ends is 0.
///
/// A visible end passes unchanged, bit by bit; AB is cut like BA.
pub fn clip_line(ends: [ClipVertex; 2], codes: Outcode, slab: DepthSlab) -> Option<[ClipCorner; 2]> {
    let [a, b] = ends;
    let (mut a, mut b) = (ClipCorner::new(a, 0), ClipCorner::new(b, 1));
    for plane in 0..PLANES {
        if codes.0 & (1 << plane) == 0 {
            continue;
        }
        let (da, db) = (distance(plane, &a.vertex), distance(plane, &b.vertex));
        let [keeps_a, keeps_b] = [da, db].map(|d| (d >= 0) == slab.is_inside(plane));
        match (keeps_a, keeps_b) {
            (true, true) => {}
            (true, false) => b = crossing(plane, &a, &b, da, db),
            (false, true) => a = crossing(plane, &a, &b, da, db),
            (false, false) => return None,
        }
    }
    slab.clamp(&mut a.vertex);
    slab.clamp(&mut b.vertex);
    Some([a, b])
}

#[cfg(test)]
mod tests {
    use super::super::clip::clip_triangle;
    use super::*;
    use crate::math::random::Rng;
    use std::vec::Vec;

    const ONE: i64 = 1 << 50;

    fn codes(vertices: &[ClipVertex]) -> Outcode {
        Outcode(vertices.iter().fold(0, |all, v| all | Outcode::of(v).0))
    }

    /// Makes lines with random ends in all directions, with w of either sign.
    fn ends(count: usize) -> Vec<[ClipVertex; 2]> {
        let mut rng = Rng::new(17);
        let mut next = |limit: i64| rng.below(2 * limit as u64) as i64 - limit;
        let mut end = || {
            let w = next(ONE);
            ClipVertex { x: next(20 * ONE), y: next(20 * ONE), z: next(ONE), w }
        };
        (0..count).map(|_| [end(), end()]).collect()
    }

    #[test]
    fn what_is_left_is_inside_of_all_planes() {
        let mut left = 0;
        for line in ends(20_000) {
            let Some(cut) = clip_line(line, codes(&line), DepthSlab::Inside) else { continue };
            left += 1;
            for (end, original) in cut.iter().zip(&line) {
                // Rounding of the cuts: a few units of 2⁵⁰, and 65 times as much at the guard band.
                for plane in 0..PLANES {
                    assert!(distance(plane, &end.vertex) >= -400, "plane {plane}: {end:?}");
                }
                if Outcode::of(original) == Outcode(0) {
                    assert_eq!(end.vertex, *original);
                }
            }
        }
        assert!(left > 1000, "{left}");
    }

    #[test]
    fn line_is_cut_the_same_from_both_ends_and_as_the_edge_of_a_triangle() {
        let mut cut_lines = 0;
        for line in ends(20_000) {
            let [a, b] = line;
            let all = codes(&line);
            let cut = clip_line(line, all, DepthSlab::Inside);
            let back = clip_line([b, a], all, DepthSlab::Inside);
            let turned = |corner: ClipCorner| {
                let [a, b, c] = corner.weights;
                ClipCorner { weights: [b, a, c], ..corner }
            };
            assert_eq!(cut, back.map(|[a, b]| [turned(b), turned(a)]), "{line:?}");
            // The line is also cut as an edge of a triangle whose third vertex is inside.
            let third = ClipVertex { x: 0, y: 0, z: ONE / 4, w: ONE / 2 };
            let mut corners = Vec::new();
            clip_triangle([a, b, third], all, DepthSlab::Inside, |corner| corners.push(*corner));
            if let Some([a, b]) = cut {
                cut_lines += 1;
                assert!(corners.contains(&a) && corners.contains(&b), "{line:?}");
            }
        }
        assert!(cut_lines > 1000, "{cut_lines}");
    }

    #[test]
    fn parts_before_and_beyond_meet_the_part_between() {
        let v = |z, w| ClipVertex { x: 0, y: 0, z, w };
        let line = [v(-ONE / 4, ONE / 2), v(ONE, ONE / 2)];
        let all = codes(&line);
        let parts =
            [DepthSlab::InFrontOfNear, DepthSlab::Inside, DepthSlab::BeyondFar].map(|slab| clip_line(line, all, slab));
        let [Some(before), Some(between), Some(beyond)] = parts else { panic!("{parts:?}") };
        assert_eq!((before[0].vertex.z, before[1], between[0]), (0, between[0], before[1]));
        assert_eq!((between[1], beyond[1].vertex.z), (beyond[0], beyond[1].vertex.w));
    }
}
