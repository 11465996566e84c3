use crate::reference::rng::Rng;
use crate::reference::scenes::*;

#[test]
fn clip_kinds_are_what_they_say() {
    for seed in 0..400 {
        let mut rng = Rng::new(seed);
        for kind in ClipKind::ALL {
            let tri = clip_triangle(&mut rng, kind);
            let any = |test: fn(&ClipVertex) -> bool| tri.iter().any(test);
            let visible = |v: &ClipVertex| v[3] > 0 && (0..=v[3]).contains(&v[2]);
            let seen = tri.iter().filter(|v| visible(v)).count();
            let ok = match kind {
                ClipKind::Tiny | ClipKind::Visible | ClipKind::Huge => seen == 3,
                ClipKind::CrossingNear => (1..=2).contains(&seen) && any(|v| v[2] < 0),
                ClipKind::CrossingFar => (1..=2).contains(&seen) && any(|v| v[2] > v[3]),
                ClipKind::BehindEye => tri.iter().all(|v| v[3] < 0),
                ClipKind::ZeroW => any(|v| v[3] == 0),
                ClipKind::Origin => any(|v| *v == [0; 4]),
                ClipKind::Extreme | ClipKind::Degenerate => true,
            };
            assert!(ok, "seed {seed} {kind:?}: {tri:?}");
        }
    }
    let mut rng = Rng::new(1);
    assert_eq!(clip_soup(&mut rng, 30).len(), 30);
    assert_eq!(depth_soup(&mut rng, 30, 64, 64).len(), 30);
}

#[test]
fn slivers_are_thin_and_screen_triangles_stay_in_range() {
    let mut rng = Rng::new(2);
    let mut on_grid = 0;
    for _ in 0..500 {
        let tri = screen_triangle(&mut rng, 64, 64);
        assert!(tri.iter().flatten().all(|c| c.abs() <= 32_767 * 256));
        on_grid += u32::from(tri.iter().flatten().all(|c| c % 128 == 0));
        let [_, b, c] = sliver(&mut rng, 64, 64);
        assert!((b[0] - c[0]).abs() <= 128 && (b[1] - c[1]).abs() <= 128);
    }
    assert!(on_grid > 200);
}
