//! Lines and points on the screen, against their definitions.

use crate::reference::diamonds;
use crate::reference::rng::Rng;
use zstrip::internals::{Line, PixelRect, square};

const EVERYWHERE: PixelRect = PixelRect { x: -40_000..40_000, y: -40_000..40_000 };

fn pixels(a: [i32; 2], b: [i32; 2], clip: &PixelRect) -> Vec<(i32, i32)> {
    Line::new(a.into(), b.into()).pixels(clip).1.collect()
}

#[test]
fn every_line_of_a_small_grid_is_that_of_the_definition() {
    // All ties there are: end points on quarters of a pixel, within 2 px in all directions.
    let grid = || (-8..=8).flat_map(|y| (-8..=8).map(move |x| [64 * x, 64 * y]));
    for start in [[0, 0], [64, 0], [0, 64], [64, 64], [128, 0], [0, 128], [128, 128], [64, 128], [192, 64]] {
        for end in grid() {
            let end = [start[0] + end[0], start[1] + end[1]];
            assert_eq!(pixels(start, end, &EVERYWHERE), diamonds::pixels(start, end), "{start:?} to {end:?}");
        }
    }
}

#[test]
fn random_lines_are_those_of_the_definition() {
    let mut rng = Rng::new(11);
    for _ in 0..4000 {
        let grid = rng.pick(&[1, 16, 64, 128, 256]);
        let reach = rng.pick(&[300, 2000, 8000]) / grid;
        let [a, b] = [(); 2].map(|()| [(); 2].map(|()| rng.between(-reach, reach) * grid));
        assert_eq!(pixels(a, b, &EVERYWHERE), diamonds::pixels(a, b), "seed {}: {a:?} to {b:?}", rng.seed());
    }
}

#[test]
fn a_window_shows_the_same_pixels() {
    let mut rng = Rng::new(12);
    for _ in 0..20_000 {
        let reach = rng.pick(&[2000, 20_000]);
        let [a, b] = [(); 2].map(|()| [(); 2].map(|()| rng.between(-reach, reach)));
        let [x, y] = [(); 2].map(|()| {
            let start = rng.between(-100, 100);
            start..start + rng.pick(&[0, 1, 3, 16, 100])
        });
        let clip = PixelRect { x, y };
        let line = Line::new(a.into(), b.into());
        let all: Vec<_> = line.pixels(&EVERYWHERE).1.collect();
        let inside = |&&(x, y): &&(i32, i32)| clip.x.contains(&x) && clip.y.contains(&y);
        let expected: Vec<_> = all.iter().filter(inside).copied().collect();
        let (skipped, seen) = line.pixels(&clip);
        let case = format!("seed {}: {a:?} to {b:?} in {clip:?}", rng.seed());
        assert_eq!(seen.collect::<Vec<_>>(), expected, "{case}");
        assert_eq!(line.count() as usize, all.len(), "{case}");
        if let Some(first) = expected.first() {
            assert_eq!(all[skipped as usize], *first, "{case}");
        }
    }
}

/// Far end points, a window around a place on the line.
#[test]
fn lines_with_far_end_points_are_exact_too() {
    let mut rng = Rng::new(13);
    const LIMIT: i32 = 32_767 * 256;
    let mut drawn = 0;
    for _ in 0..3000 {
        let mut far = || {
            let any = rng.between(-LIMIT, LIMIT);
            rng.pick(&[any, LIMIT, -LIMIT, any / 1000])
        };
        let (a, b) = ([far(), far()], [far(), far()]);
        let part = rng.unit();
        let on_line = |k: usize| (f64::from(a[k]) + part * (f64::from(b[k]) - f64::from(a[k]))) as i32 >> 8;
        let (x, y) = (on_line(0), on_line(1));
        let clip = PixelRect { x: x - 3..x + 4, y: y - 3..y + 4 };
        let mut expected = Vec::new();
        for y in clip.y.clone() {
            expected.extend(clip.x.clone().map(|x| (x, y)).filter(|&(x, y)| diamonds::draws(a, b, x, y)));
        }
        let mut seen = pixels(a, b, &clip);
        seen.sort_by_key(|p| (p.1, p.0));
        assert_eq!(seen, expected, "seed {}: {a:?} to {b:?}", rng.seed());
        drawn += seen.len();
    }
    assert!(drawn > 9000, "{drawn}");
}

#[test]
fn chains_draw_each_pixel_of_a_joint_once() {
    let mut rng = Rng::new(14);
    for _ in 0..2000 {
        let grid = rng.pick(&[1, 64, 128]);
        // A chain that goes on in about the same direction, so that only joints could be drawn twice.
        let mut at = [0, 0];
        let mut hits = std::collections::BTreeMap::new();
        let (sx, sy) = (rng.pick(&[-1, 1]), rng.pick(&[-1, 1]));
        for _ in 0..20 {
            let (along, aside) = (rng.between(0, 1000 / grid), rng.between(0, 1000 / grid));
            let next = [at[0] + sx * grid * along.max(aside), at[1] + sy * grid * along.min(aside)];
            for pixel in pixels(at, next, &EVERYWHERE) {
                *hits.entry(pixel).or_insert(0) += 1;
            }
            at = next;
        }
        let (first, last) = ([0, 0], at);
        assert!(hits.values().all(|n| *n == 1), "seed {}: {first:?} to {last:?}", rng.seed());
        // And no gap: one pixel a column.
        let columns: Vec<_> = hits.keys().map(|p| p.0).collect();
        let (low, high) = (columns.iter().min(), columns.iter().max());
        if let (Some(low), Some(high)) = (low, high) {
            assert_eq!(columns.len() as i32, high - low + 1, "seed {}", rng.seed());
        }
    }
}

#[test]
fn squares_hold_the_centres_between_their_sides() {
    let mut rng = Rng::new(15);
    for _ in 0..20_000 {
        let center = (rng.between(-2000, 2000), rng.between(-2000, 2000));
        let side = rng.between(0, 2000);
        let rect = square(center, side as u32);
        for (range, c) in [(&rect.x, center.0), (&rect.y, center.1)] {
            for p in -20..20 {
                let twice = 2 * (256 * p + 128);
                let inside = (2 * c - side..2 * c + side).contains(&twice);
                assert_eq!(range.contains(&p), inside, "seed {}: {center:?} {side} {p}", rng.seed());
            }
        }
    }
}
