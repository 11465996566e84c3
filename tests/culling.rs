//! Culling of whole objects: never what can be seen, mostly what cannot, and the picture stays the same.

mod reference;
#[path = "../examples/scenes/mod.rs"]
mod scenes;
mod support;

use reference::rng::Rng;
use support::{apply, difference, matrix, on_screen, rigid, scalar, strips, vector};
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::internals::{Containment, Frustum};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{BoundingBox, BoundingSphere, Bounds, BoundsNode, Mesh, MeshData, Positions, Topology};
use zstrip::shader::Gouraud;
use zstrip::vertex::Viewport;
use zstrip::{Cull, State};

/// A camera of any kind, wherever it stands, and how far it sees.
fn random_camera(rng: &mut Rng) -> (Projective, f64) {
    let far = (rng.unit() * 9.0).exp2() * 4.0;
    let near = far * (rng.unit() * -9.0 - 1.0).exp2();
    let (near, end) = (Scalar::from_num(near.max(1e-4)), Scalar::from_num(far));
    let lens = if rng.one_in(3) {
        let half = Scalar::from_num(far * (0.1 + rng.unit()));
        Projective::orthographic((-half, half), (-half, half), (near, end))
    } else {
        let size = (rng.between(1, 1024) as u16, rng.between(1, 1024) as u16);
        Projective::perspective(Angle16::from_degrees(rng.between(3, 170)), size, near, end)
    };
    (lens.expect("a camera") * rigid(rng, far), far)
}

fn to_f64(v: Vec3) -> [f64; 3] {
    v.to_bits().map(|c| f64::from(c) / 65_536.0)
}

/// Whether clip coordinates are seen, with a margin that is positive inside.
fn depth_inside([x, y, z, w]: [f64; 4]) -> f64 {
    [w + x, w - x, w + y, w - y, z, w - z].into_iter().fold(f64::INFINITY, f64::min)
}

/// Points of a box, among them its corners.
fn points_in_box(rng: &mut Rng, aabb: &BoundingBox) -> Vec<[f64; 4]> {
    let (center, half) = (to_f64(aabb.center), to_f64(aabb.half));
    let at = |part: [f64; 3]| {
        let [x, y, z] = [0, 1, 2].map(|k| center[k] + part[k] * half[k]);
        [x, y, z, 1.0]
    };
    let corner = |k: u32| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { -1.0 } else { 1.0 });
    let mut points: Vec<_> = (0..8).map(|k| at(corner(k))).collect();
    points.extend((0..24).map(|_| at([(); 3].map(|()| 2.0 * rng.unit() - 1.0))));
    points
}

fn points_in_sphere(rng: &mut Rng, sphere: &BoundingSphere) -> Vec<[f64; 4]> {
    let (center, radius) = (to_f64(sphere.center), sphere.radius.to_num::<f64>());
    let mut points = vec![[center[0], center[1], center[2], 1.0]];
    while points.len() < 32 {
        let p = [(); 3].map(|()| 2.0 * rng.unit() - 1.0);
        let length = p.iter().map(|c| c * c).sum::<f64>().sqrt();
        // On the surface, half of them; the rest inside.
        if length > 0.01 && length < 1.0 {
            let s = radius / if rng.one_in(2) { length } else { 1.0 };
            points.push([center[0] + s * p[0], center[1] + s * p[1], center[2] + s * p[2], 1.0]);
        }
    }
    points
}

#[test]
fn nothing_visible_is_culled_and_what_is_inside_is_visible() {
    let (mut outside, mut inside, mut crossing) = (0, 0, 0);
    for seed in 0..1500 {
        let mut rng = Rng::new(seed);
        let (camera, far) = random_camera(&mut rng);
        let (frustum, m) = (Frustum::new(&camera), matrix(&camera));
        for _ in 0..4 {
            let center = vector(&mut rng, (2.0 * far).min(32_000.0));
            let size = far * (rng.unit() * -8.0).exp2();
            let half = [(); 3].map(|()| Scalar::from_num(size * rng.unit()));
            let aabb = BoundingBox { center, half: Vec3::new(half[0], half[1], half[2]) };
            let sphere = BoundingSphere { center, radius: Scalar::from_num(size) };
            for (name, result, points) in [
                ("box", frustum.aabb(&aabb), points_in_box(&mut rng, &aabb)),
                ("sphere", frustum.sphere(&sphere), points_in_sphere(&mut rng, &sphere)),
            ] {
                for point in points {
                    let depth = depth_inside(apply(&m, point));
                    let case = format!("seed {seed}: {name} {result:?} {aabb:?}, point {point:?} has {depth}");
                    match result {
                        Containment::Outside => assert!(depth < 0.0, "{case}"),
                        Containment::Inside => assert!(depth >= 0.0, "{case}"),
                        Containment::Crossing => {}
                    }
                }
                match result {
                    Containment::Outside => outside += 1,
                    Containment::Inside => inside += 1,
                    Containment::Crossing => crossing += 1,
                }
            }
        }
    }
    println!("{outside} outside, {inside} inside, {crossing} crossing");
    assert!(outside > 3000 && inside > 150 && crossing > 500);
}

/// A matrix and a point at the ends of the range, where rounding of the planes weighs most: a point-sized object.
#[test]
fn rounding_of_the_planes_never_culls_a_visible_point() {
    for seed in 0..3000 {
        let mut rng = Rng::new(seed);
        let (camera, _) = random_camera(&mut rng);
        let shift = rng.below(20) as i64;
        let camera = camera * Affine::scale(Scalar::from_bits((1 << 16) >> shift));
        let point = [(); 3].map(|()| rng.pick(&[i32::MAX, i32::MIN, 1 << 30]).saturating_add(rng.any_magnitude(30)));
        let sphere = BoundingSphere { center: Vec3::from_bits(point), radius: Scalar::ZERO };
        let aabb = BoundingBox { center: sphere.center, half: Vec3::ZERO };
        // In exact integers: 32.32 entries times 16.16 coordinates.
        let rows = camera.to_rows().map(|row| {
            let sum = |k: usize| i128::from(row[k]) * i128::from(point[k]);
            sum(0) + sum(1) + sum(2) + (i128::from(row[3]) << 16)
        });
        let [x, y, z, w] = rows;
        let depth = [w + x, w - x, w + y, w - y, z, w - z].into_iter().min().expect("six");
        let frustum = Frustum::new(&camera);
        for result in [frustum.sphere(&sphere), frustum.aabb(&aabb)] {
            match result {
                Containment::Outside => assert!(depth < 0, "seed {seed}: {point:?} is seen by {depth}, {camera:?}"),
                Containment::Inside => assert!(depth >= 0, "seed {seed}: {point:?} is not seen by {depth}, {camera:?}"),
                Containment::Crossing => {}
            }
        }
    }
}

/// Points at the ends of the range that lie in front of the eye by next to nothing.
#[test]
fn points_just_inside_of_a_plane_are_not_culled() {
    for seed in 0..3000 {
        let mut rng = Rng::new(seed);
        let point = [(); 3].map(|()| if rng.one_in(2) { i32::MAX } else { i32::MIN });
        let normal = [(); 3].map(|()| i64::from(rng.between(i32::MIN, i32::MAX)) << rng.below(14));
        let sum: i128 = (0..3).map(|k| i128::from(normal[k]) * i128::from(point[k])).sum();
        // 16.16 times 32.32: w = (sum + offset 2¹⁶) / 2⁴⁸, rounded up.
        let offset = (-sum).div_euclid(1 << 16) as i64 + 1;
        let [a, b, c] = normal;
        let camera = Projective::from_rows([[0; 4], [0; 4], [0; 4], [a, b, c, offset]]);
        let sphere = BoundingSphere { center: Vec3::from_bits(point), radius: Scalar::ZERO };
        let result = Frustum::new(&camera).sphere(&sphere);
        assert_ne!(result, Containment::Outside, "seed {seed}: {point:?} {normal:?}");
    }
}

/// Objects far outside of one plane are nearly all found to be so.
#[test]
fn culling_is_useful() {
    let (mut candidates, mut culled, mut small, mut seen_inside) = (0, 0, 0, 0);
    for seed in 0..2000 {
        let mut rng = Rng::new(seed);
        let (camera, far) = random_camera(&mut rng);
        let (frustum, m) = (Frustum::new(&camera), matrix(&camera));
        let size = far / 50.0;
        let center = vector(&mut rng, (2.0 * far).min(32_000.0));
        let sphere = BoundingSphere { center, radius: Scalar::from_num(size) };
        let [x, y, z] = to_f64(center);
        let clip = apply(&m, [x, y, z, 1.0]);
        // Distances from the planes in multiples of the radius: the length of a plane's normal is that of its row.
        let row = |i: usize, sign: f64| -> f64 {
            let n = [0, 1, 2].map(|j| if i == 4 { m[2][j] } else { m[3][j] + sign * m[i][j] });
            n.iter().map(|c| c * c).sum::<f64>().sqrt() * size
        };
        let [cx, cy, cz, cw] = clip;
        let distances = [
            (cw + cx) / row(0, 1.0),
            (cw - cx) / row(0, -1.0),
            (cw + cy) / row(1, 1.0),
            (cw - cy) / row(1, -1.0),
            cz / row(4, 0.0),
            (cw - cz) / row(2, -1.0),
        ];
        let least = distances.into_iter().fold(f64::INFINITY, f64::min);
        if least < -1.01 {
            candidates += 1;
            culled += usize::from(frustum.sphere(&sphere) == Containment::Outside);
        }
        if least > 1.01 {
            small += 1;
            seen_inside += usize::from(frustum.sphere(&sphere) == Containment::Inside);
        }
    }
    println!("{culled} of {candidates} spheres outside are culled, {seen_inside} of {small} inside need no clipping");
    assert!(candidates > 1000 && culled * 100 >= candidates * 99, "{culled} of {candidates}");
    assert!(small > 30 && seen_inside * 100 >= small * 95, "{seen_inside} of {small}");
}

#[test]
fn frustum_through_a_rectangle_sees_what_is_in_it() {
    let (mut outside, mut inside) = (0, 0);
    for seed in 0..4000 {
        let mut rng = Rng::new(seed);
        let (camera, far) = random_camera(&mut rng);
        let m = matrix(&camera);
        let size = [(); 2].map(|()| rng.between(1, 640));
        let corner = [(); 2].map(|()| rng.between(-100, 100));
        let viewport =
            Viewport::new(corner[0] as i16, corner[1] as i16, size[0] as u16, size[1] as u16).expect("a viewport");
        let range = |rng: &mut Rng, start: i32, size: i32| {
            let low = start + rng.between(0, size - 1);
            (low, low + rng.between(1, 400))
        };
        let (x, y) = (range(&mut rng, corner[0], size[0]), range(&mut rng, corner[1], size[1]));
        let frustum = Frustum::through(&camera, &viewport, x, y);
        let center = vector(&mut rng, far.min(32_000.0));
        let point = BoundingSphere { center, radius: Scalar::ZERO };
        let [px, py, pz] = to_f64(center);
        let clip = apply(&m, [px, py, pz, 1.0]);
        let [sx, sy, depth] = on_screen(&viewport, clip);
        let within =
            |v: f64, (low, high): (i32, i32), slack: f64| v >= f64::from(low) - slack && v <= f64::from(high) + slack;
        let seen = |slack: f64| {
            let range = within(sx, x, slack) && within(sy, y, slack);
            range && clip[3] > 0.0 && (-slack..=1.0 + slack).contains(&depth)
        };
        match frustum.sphere(&point) {
            Containment::Outside => {
                outside += 1;
                assert!(!seen(0.0), "seed {seed}: {center:?} is at ({sx}, {sy}) in {x:?} {y:?}");
            }
            Containment::Inside => {
                inside += 1;
                assert!(seen(1e-6), "seed {seed}: {center:?} is at ({sx}, {sy}) in {x:?} {y:?}");
            }
            Containment::Crossing => {}
        }
    }
    println!("{outside} points outside, {inside} inside");
    assert!(outside > 3000 && inside > 20);
}

#[test]
fn bounds_of_a_mesh_hold_all_of_it() {
    for seed in 0..500 {
        let mut rng = Rng::new(seed);
        let reach = (rng.unit() * 15.0).exp2();
        let fractions: Vec<_> = (0..12).map(|_| [(); 3].map(|()| rng.between(-32_768, 32_767) as i16)).collect();
        let points: Vec<_> = (0..12).map(|_| vector(&mut rng, reach)).collect();
        let quantized = Positions::Quantized {
            points: &fractions,
            scale: Scalar::from_num(reach),
            offset: vector(&mut rng, 32_767.0 - reach.min(32_000.0)),
        };
        for positions in [quantized, Positions::Exact(&points)] {
            let mesh = Mesh::new(MeshData::new(positions)).expect("a mesh");
            let Bounds { aabb, sphere } = *mesh.bounds();
            let (center, half) = (to_f64(aabb.center), to_f64(aabb.half));
            let (middle, radius) = (to_f64(sphere.center), sphere.radius.to_num::<f64>());
            for k in 0..12 {
                let p = support::position(&positions, k);
                let case = format!("seed {seed}: vertex {k} at {p:?}, {aabb:?} {sphere:?}");
                assert!((0..3).all(|i| (p[i] - center[i]).abs() <= half[i]), "{case}");
                let distance = (0..3).map(|i| (p[i] - middle[i]).powi(2)).sum::<f64>().sqrt();
                // A sphere at the edge of the number range may have the largest radius there is.
                assert!(distance <= radius || sphere.radius == Scalar::MAX, "{case}");
            }
        }
    }
}

/// A row of squares along x, in a hierarchy: the whole, two halves of it, four quarters with their triangles.
fn row_of_squares() -> (Vec<Vec3>, Vec<BoundsNode>) {
    let mut points = Vec::new();
    for k in 0..16 {
        let x = 3 * k - 24;
        points.extend([(x, -1), (x + 2, -1), (x + 2, 1), (x, 1)].map(|(x, y)| Vec3::from_ints(x, y, -10 - (k & 3))));
    }
    let bounds = |squares: std::ops::Range<usize>| {
        let part = &points[4 * squares.start..4 * squares.end];
        *Mesh::new(MeshData { topology: Topology::Quads, ..MeshData::new(Positions::Exact(part)) })
            .expect("squares")
            .bounds()
    };
    let node = |squares: std::ops::Range<usize>, skip, leaf: bool| BoundsNode {
        bounds: bounds(squares.clone()),
        skip,
        first_triangle: 2 * squares.start as u16,
        triangles: if leaf { 2 * squares.len() as u16 } else { 0 },
    };
    let nodes = vec![
        node(0..16, 7, false),
        node(0..8, 4, false),
        node(0..4, 3, true),
        node(4..8, 4, true),
        node(8..16, 7, false),
        node(8..12, 6, true),
        node(12..16, 7, true),
    ];
    (points, nodes)
}

#[test]
fn hierarchy_draws_the_same_picture_and_culls_something() {
    let (points, nodes) = row_of_squares();
    let colors: Vec<_> = (0..64).map(|k| [60 + 3 * k, 250 - 2 * k, 100]).collect();
    let plain =
        MeshData { topology: Topology::Quads, colors: Some(&colors), ..MeshData::new(Positions::Exact(&points)) };
    let tree = MeshData { hierarchy: Some(&nodes), ..plain };
    let (plain, tree) = (Mesh::new(plain).expect("squares"), Mesh::new(tree).expect("squares"));
    let state = State { cull: Cull::None, ..State::default() };
    let (mut culled, mut saved) = (0, 0);
    for (seed, records) in (0..24).flat_map(|seed| [(seed, 0), (seed, 5000)]) {
        let mut rng = Rng::new(seed);
        let camera = Projective::perspective(Angle16::from_degrees(50), (64, 48), Scalar::ONE, Scalar::from_num(60))
            .expect("a camera");
        let eye = Vec3::new(scalar(&mut rng, 20.0), scalar(&mut rng, 3.0), Scalar::ZERO);
        let mvp = camera * Affine::rotation_y(Angle16(rng.between(-6000, 6000) as u16)) * Affine::translation(-eye);
        let draw = |mesh| {
            strips::<Rgb565>((64, 48), 8, records, Rgb565::BLACK, |scene| {
                scene.draw_with(state, mesh, &mvp, &Gouraud::colors_unlit())
            })
        };
        let ((expected, all), (picture, some)) = (draw(&plain), draw(&tree));
        assert_eq!(difference(&picture, &expected, 64), None, "seed {seed}, {records} records");
        assert!(some.triangles <= all.triangles);
        culled += some.culled;
        saved += all.triangles - some.triangles;
    }
    println!("{culled} nodes culled, {saved} triangles saved");
    assert!(culled > 50 && saved > 500);
}

/// More leaves than are tested at a time, all of them seen, or every third.
#[test]
fn hierarchy_of_many_leaves_draws_all_that_are_seen() {
    const LEAVES: i16 = 100;
    let squares = |far: bool| {
        let corners = move |k: i16| {
            let (x, y) = (3 * (k % 10) - 15, 3 * (k / 10) - 15 + if far && k % 3 > 0 { 5000 } else { 0 });
            [(x, y), (x + 2, y), (x + 2, y + 2), (x, y + 2)].map(|(x, y)| Vec3::from_ints(x, y, -30))
        };
        (0..LEAVES).flat_map(corners).collect::<Vec<_>>()
    };
    let camera = Projective::perspective(Angle16::from_degrees(60), (64, 64), Scalar::ONE, Scalar::from_num(60))
        .expect("a camera");
    for (far, seen) in [(false, 100), (true, 34)] {
        let points = squares(far);
        let plain = MeshData { topology: Topology::Quads, ..MeshData::new(Positions::Exact(&points)) };
        let leaf = |k: i16| {
            let part = &points[4 * k as usize..4 * k as usize + 4];
            let square = MeshData { positions: Positions::Exact(part), ..plain };
            let bounds = *Mesh::new(square).expect("a square").bounds();
            BoundsNode { bounds, skip: k as u16 + 1, first_triangle: 2 * k as u16, triangles: 2 }
        };
        let nodes: Vec<_> = (0..LEAVES).map(leaf).collect();
        let tree = Mesh::new(MeshData { hierarchy: Some(&nodes), ..plain }).expect("squares");
        for records in [0, 5000] {
            let draw = |mesh| {
                strips::<Rgb565>((64, 64), 64, records, Rgb565::BLACK, |scene| {
                    scene.draw(mesh, &camera, &Gouraud::colors_unlit())
                })
            };
            let ((expected, _), (picture, stats)) = (draw(&Mesh::new(plain).expect("squares")), draw(&tree));
            assert_eq!(difference(&picture, &expected, 64), None, "{records} records, {seen} seen: {stats:?}");
            assert_eq!((stats.drawn, stats.culled), (2 * seen, 100 - seen), "{records} records: {stats:?}");
        }
    }
}

#[test]
fn scenes_may_leave_out_what_is_not_visible() {
    let torus = &scenes::torus::MESH;
    let at = |x: i16, z: i16| Affine::translation(Vec3::from_ints(x, 0, z));
    let places = [at(0, -4), at(-40, -5), at(1, 4), at(3, -6), at(0, -80)];
    let camera = Projective::perspective(Angle16::from_degrees(60), (64, 48), Scalar::ONE, Scalar::from_num(50))
        .expect("a camera");
    let frame = |records, ask: bool| {
        let mut left_out = 0;
        let (picture, _) = strips::<Rgb565>((64, 48), 8, records, Rgb565::BLACK, |scene| {
            for place in places {
                let mvp = camera * place;
                if ask && !scene.is_visible(torus.bounds(), &mvp) {
                    left_out += 1;
                    continue;
                }
                scene.draw(torus, &mvp, &Gouraud::new(scenes::LIGHT, Rgb888::WHITE));
            }
        });
        (picture, left_out)
    };
    let (expected, _) = frame(20_000, false);
    for records in [0, 2000, 20_000] {
        let (picture, left_out) = frame(records, true);
        assert_eq!(difference(&picture, &expected, 64), None, "{records} records");
        // At least the three that no strip shows: beside, behind, too far.
        assert!(left_out >= 3 * 6, "{records} records: {left_out}");
    }
}

/// Boxes as far out as coordinates go, of objects that are seen.
#[test]
fn far_corners_of_a_large_world_are_seen() {
    let lens = Projective::perspective(Angle16::from_degrees(60), (512, 512), Scalar::ONE, Scalar::from_num(1000));
    let lens = lens.expect("a camera");
    let mut rng = Rng::new(8);
    for case in 0..300 {
        let [x, y, z] = [(); 3].map(|()| (rng.between(-31_000, 31_000) >> rng.below(12)) as i16);
        let corners = [(-60, -50), (60, -50), (0, 50)].map(|(i, j)| Vec3::from_ints(x + i, y + j, z));
        let mesh = Mesh::new(MeshData::new(Positions::Exact(&corners))).expect("a mesh");
        // Somewhere on the screen, if not in its middle.
        let (aside, up) = (rng.between(-120, 120) as i16, rng.between(-120, 120) as i16);
        let eye = Vec3::from_ints(x + aside, y + up, z + 290);
        let [ex, ey, ez] = eye.to_bits().map(Scalar::from_bits);
        let mvp = lens * Affine::translation(Vec3::new(-ex, -ey, -ez));
        let (picture, stats) = strips::<Rgb565>((512, 512), 512, 100, Rgb565::BLACK, |scene| {
            scene.draw_with(State { cull: Cull::None, ..State::default() }, &mesh, &mvp, &Gouraud::colors_unlit());
        });
        let lit = picture.iter().filter(|pixel| **pixel != 0).count();
        assert!(lit > 5000 && stats.culled == 0, "case {case}: ({x}, {y}, {z}) from {eye:?}: {lit} pixels, {stats:?}");
    }
}
