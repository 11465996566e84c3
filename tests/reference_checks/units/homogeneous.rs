use crate::reference::exact;
use crate::reference::homogeneous::*;
use crate::reference::rng::Rng;

fn bare(position: [f64; 4]) -> Vertex<0> {
    let attributes = [];
    Vertex { position, attributes }
}

#[test]
fn equals_exact_coverage_on_flat_triangles() {
    let seed = 11;
    let mut rng = Rng::new(seed);
    for case in 0..300 {
        // Halves of a pixel, so that ties are common; w = 1, so that nothing is rounded.
        let points = [(); 3].map(|()| [128 * rng.between(-10, 50), 128 * rng.between(-10, 50)]);
        let tri = points.map(|[x, y]| bare([f64::from(x) / 2048.0 - 1.0, 1.0 - f64::from(y) / 2048.0, 0.5, 1.0]));
        let wide = exact::widen(points);
        let front = exact::area2(wide) < 0;
        let mut covered = Vec::new();
        for_each_sample(&Viewport::new(16, 16), (16, 16), &tri, |s| {
            assert_eq!(s.front, front, "seed {seed} case {case}");
            if s.covered {
                covered.push((s.x, s.y));
            }
        });
        let mut expected = Vec::new();
        exact::for_each_pixel(wide, 16, 16, |x, y| expected.push((x, y)));
        assert_eq!(covered, expected, "seed {seed} case {case}: {points:?}");
    }
}

#[test]
fn interpolation_matches_the_exact_fraction() {
    let points = [[100, 300], [3900, 500], [900, 3700]];
    let (w, u) = ([1i64, 4, 9], [7i64, -30, 250]);
    let tri: [Vertex<1>; 3] = std::array::from_fn(|i| {
        let ([x, y], w) = (points[i].map(f64::from), w[i] as f64);
        let position = [(x / 2048.0 - 1.0) * w, (1.0 - y / 2048.0) * w, w * 0.25, w];
        let attributes = [u[i] as f64];
        Vertex { position, attributes }
    });
    let mut count = 0;
    for_each_sample(&Viewport::new(16, 16), (16, 16), &tri, |s| {
        if s.covered {
            let at = exact::center(s.x.into(), s.y.into());
            let wide = exact::widen(points);
            let perspective = exact::to_f64(exact::perspective_at(wide, w, u, at));
            let linear = exact::to_f64(exact::affine_at(wide, u, at));
            assert!((s.perspective[0] - perspective).abs() < 1e-9);
            assert!((s.linear[0] - linear).abs() < 1e-9);
            assert!((s.depth - 0.25).abs() < 1e-12);
            count += 1;
        }
    });
    assert!(count > 50);
}

#[test]
fn vertex_behind_the_eye_leaves_the_part_in_front() {
    // A floor one unit below the eye, from behind it to the horizon; z = w - 1/8 and so near is at w = 1/8.
    let floor = [[-64.0, -1.0, -2.0], [64.0, -1.0, -2.0], [0.0, -1.0, 64.0]];
    let tri = floor.map(|[x, y, w]| bare([x, y, w - 0.125, w]));
    let mut rows = [0; 16];
    for_each_sample(&Viewport::new(16, 16), (16, 16), &tri, |s| {
        rows[s.y as usize] += u32::from(s.covered);
    });
    assert_eq!(rows[..8], [0; 8], "nothing above the horizon");
    assert_eq!(rows[8..], [16; 8]);
}

#[test]
fn near_and_far_cut_per_pixel() {
    // z runs from -1 at the left edge of the screen to 2 at the right one.
    let z_at = |x: f64| 0.5 + 1.5 * x;
    let corners = [[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]];
    let tri = corners.map(|[x, y]| bare([x, y, z_at(x), 1.0]));
    for_each_sample(&Viewport::new(15, 1), (15, 1), &tri, |s| {
        assert_eq!(s.covered, (5..10).contains(&s.x), "{s:?}");
        let to_cut = [5.0, 10.0].map(|cut: f64| (f64::from(s.x) + 0.5 - cut).abs());
        assert!(s.margin <= to_cut[0].min(to_cut[1]) + 1e-9);
    });
}
