//! Depth: bias, and how well distances are told apart.

use crate::reference::rng::Rng;
use crate::support::{strips, whole};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::internals::{Projected, Transform};
use zstrip::math::{Affine, Angle16, DepthPrecision, PrecisionError, ProjectionError, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::shader::Flat;
use zstrip::span::{DepthBias, DepthState};
use zstrip::vertex::{DepthScale, Viewport};
use zstrip::{Cull, Framebuffer, Scene, State};

const SCREEN: (u16, u16) = (160, 120);
const BOTH_SIDES: State = State { cull: Cull::None, ..State::DEFAULT };

/// A tilted floor, and triangles that lie on it, all with corners of their own.
struct Decals {
    floor: Vec<Vec3>,
    decals: Vec<Vec3>,
}

impl Decals {
    fn new(seed: u64) -> Self {
        let mut rng = Rng::new(seed);
        let directions = [Vec3::from_milli(3000, 250, 500), Vec3::from_milli(500, 750, -4000)];
        // Multiples of 1/1024 of the directions, which are themselves rounded to 1/65,536: on the plane but for a unit.
        let point = |i: i32, j: i32| {
            let [a, b] = directions.map(Vec3::to_bits);
            let along = |k: usize| (i64::from(a[k]) * i64::from(i) + i64::from(b[k]) * i64::from(j)) >> 10;
            Vec3::new(
                Scalar::from_bits(along(0) as i32),
                Scalar::from_bits(along(1) as i32),
                Scalar::from_bits(along(2) as i32),
            )
        };
        let floor = [(-1024, -1024), (1024, -1024), (1024, 1024), (-1024, -1024), (1024, 1024), (-1024, 1024)];
        let floor = floor.map(|(i, j)| point(i, j)).to_vec();
        let decals = (0..3 * 12).map(|_| point(rng.between(-900, 900), rng.between(-900, 900))).collect();
        Self { floor, decals }
    }

    fn draw<F: Framebuffer<Format = Rgb565>>(&self, scene: &mut Scene<'_, F>, state: State) {
        let camera = Projective::perspective(
            Angle16::from_degrees(60),
            Size::new(SCREEN.0.into(), SCREEN.1.into()),
            Scalar::ONE,
            Scalar::from_num(50),
        );
        let mvp = camera.expect("a camera") * Affine::translation(Vec3::from_milli(0, -1500, -7000));
        let mesh = |points| Mesh::new(MeshData::new(Positions::Exact(points))).expect("a mesh");
        scene.draw_with(BOTH_SIDES, &mesh(&self.floor), &mvp, &Flat::unlit(Rgb888::BLUE));
        scene.draw_with(state, &mesh(&self.decals), &mvp, &Flat::unlit(Rgb888::WHITE));
    }

    /// Pixels of the decals that are seen.
    fn seen(&self, state: State) -> usize {
        let (picture, _, _) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| self.draw(scene, state));
        picture.iter().filter(|pixel| **pixel == 0xFFFF).count()
    }
}

#[test]
fn biased_decals_are_seen_whole() {
    let bias = DepthBias { constant: -1, slope: -Scalar::ONE };
    let mut fought = 0;
    for seed in 0..40 {
        let decals = Decals::new(seed);
        let all = decals.seen(State { depth: DepthState::OFF, ..BOTH_SIDES });
        assert!(all > 1000, "seed {seed}: {all} pixels");
        assert_eq!(decals.seen(State { bias, ..BOTH_SIDES }), all, "seed {seed}");
        fought += all - decals.seen(BOTH_SIDES);
        // Farther, none is seen.
        let bias = DepthBias { constant: 1, slope: Scalar::ONE };
        assert_eq!(decals.seen(State { bias, ..BOTH_SIDES }), 0, "seed {seed}");
    }
    assert!(fought > 10_000, "without bias only {fought} pixels are lost");
}

#[test]
fn biased_pictures_are_the_same_in_any_strips() {
    let decals = Decals::new(99);
    let state = State { bias: DepthBias { constant: 0, slope: -Scalar::from_num(0.5) }, ..BOTH_SIDES };
    let (expected, _) = strips::<Rgb565>(SCREEN, 120, 5000, Rgb565::BLACK, |scene| decals.draw(scene, state));
    for (rows, records) in [(1, 5000), (7, 200), (16, 0)] {
        let (picture, _) = strips::<Rgb565>(SCREEN, rows, records, Rgb565::BLACK, |scene| decals.draw(scene, state));
        assert!(picture == expected, "strips of {rows} rows, {records} records");
    }
}

/// At both ends of depth a bias has no room: nothing wraps to the other end.
#[test]
fn biased_depth_never_wraps() {
    for z in [0, 1, 5, 40_000, 65_530, 65_534, 65_535] {
        for constant in [-32_768, -6, -1, 1, 6, 32_767] {
            // A rectangle whose depths are z to the left and half of it to the right, in 1/65,535.
            let corner = |x: i32, y: i32, z: i32| [x << 16, y << 16, z, 0x1_0000].map(Scalar::from_bits);
            let corners = [corner(-1, 1, z), corner(-1, -1, z), corner(1, -1, z / 2), corner(1, 1, z / 2)];
            let data =
                MeshData { indices: Some(&[0, 1, 2, 0, 2, 3]), ..MeshData::new(Positions::Homogeneous(&corners)) };
            let mesh = Mesh::new(data).expect("a mesh");
            let depths = |bias| {
                let state = State { bias, ..BOTH_SIDES };
                let (_, depths, _) = whole::<Rgb565>((20, 10), Rgb565::BLACK, |scene| {
                    scene.draw_with(state, &mesh, &Projective::IDENTITY, &Flat::unlit(Rgb888::RED));
                });
                depths
            };
            let plain = depths(DepthBias::NONE);
            // Depths of the corners.
            let [high, low] = [z, z / 2].map(|z| (f64::from(z) * 65_535.0 / 65_536.0).round() as i32);
            for (place, (plain, biased)) in
                plain.iter().zip(depths(DepthBias { constant, ..DepthBias::NONE })).enumerate()
            {
                let moved = i32::from(biased) - i32::from(*plain);
                assert!(moved.signum() * i32::from(constant).signum() >= 0 && moved.abs() <= i32::from(constant).abs());
                // As far as it goes.
                let free = if constant < 0 { low } else { 65_535 - high };
                assert_eq!(moved.abs(), free.min(i32::from(constant).abs()), "pixel {place} of z {z}, {constant}");
            }
        }
    }
}

/// Distances at which depth is k + 1/2 steps, in floating point.
fn boundary(n: f64, f: f64, k: f64) -> f64 {
    n * f / (f - (k + 0.5).clamp(0.0, 65_535.0) / 65_535.0 * (f - n))
}

#[test]
fn size_of_a_bin_is_that_of_all_distances_with_its_depth() {
    let mut rng = Rng::new(7);
    for case in 0..20_000 {
        let near = Scalar::from_bits(rng.between(1, i32::MAX - 1) >> rng.between(0, 30));
        let far = Scalar::from_bits(rng.between(near.to_bits().min(i32::MAX - 1), i32::MAX - 1) + 1);
        let Ok(precision) = DepthPrecision::new(near.max(Scalar::DELTA), far) else { continue };
        let (n, f) = (near.max(Scalar::DELTA).to_num::<f64>(), far.to_num::<f64>());
        let distance = Scalar::from_bits(rng.between(near.to_bits(), far.to_bits()));
        let d = distance.to_num::<f64>();
        let exact = 65_535.0 * f * (d - n) / ((f - n) * d);
        let depth = f64::from(precision.depth(distance));
        assert!((depth - exact).abs() < 0.500_01, "case {case}: depth {depth} at {d}, exactly {exact}");
        let size = boundary(n, f, depth) - boundary(n, f, depth - 1.0);
        let bin = precision.bin(distance).to_num::<f64>();
        assert!((bin - size).abs() <= 1e-9 * f + 2f64.powi(-31), "case {case}: bin {bin}, exactly {size}");
        let back = precision.distance(precision.depth(distance)).to_num::<f64>();
        assert!((back - d).abs() <= size + 1e-4, "case {case}: {d} becomes {back}");
    }
}

/// Brute force: the camera itself, and vertices a bin apart.
#[test]
fn depths_of_a_frame_are_those_of_the_helper() {
    let (near, far) = (Scalar::from_num(0.5), Scalar::from_num(800));
    let precision = DepthPrecision::new(near, far).expect("a camera");
    let camera = Projective::perspective(Angle16::from_degrees(60), Size::new(8, 8), near, far).expect("a camera");
    let depth_at = |distance: Scalar, state: State| {
        // A wall over the whole view.
        let (z, side) = (-distance, distance + distance);
        let [a, b, c, d] =
            [(-side, -side), (side, -side), (side, side), (-side, side)].map(|(x, y)| Vec3::new(x, y, z));
        let corners = [a, b, c, a, c, d];
        let mesh = Mesh::new(MeshData::new(Positions::Exact(&corners))).expect("a mesh");
        let (_, depths, _) = whole::<Rgb565>((8, 8), Rgb565::BLACK, |scene| {
            scene.draw_with(state, &mesh, &camera, &Flat::unlit(Rgb888::RED));
        });
        assert!(depths.iter().all(|depth| depth == &depths[0]), "a wall at {distance} is not flat");
        depths[0]
    };
    let uniform = State { depth_scale: DepthScale::Uniform { far }, ..State::DEFAULT };
    for distance in [0.501, 0.6, 1.0, 2.0, 7.7, 31.0, 99.9, 250.0, 511.0, 799.0] {
        let distance = Scalar::from_num(distance);
        let found = depth_at(distance, State::DEFAULT);
        assert!(found.abs_diff(precision.depth(distance)) <= 1, "{distance}: {found}");
        // Two bins farther is farther, in the frame as well.
        let bins = Scalar::from_num(2 * precision.bin(distance)) + Scalar::DELTA;
        if distance + bins < far {
            assert!(depth_at(distance + bins, State::DEFAULT) > found, "{distance} and two bins more");
        }
        let exact = 65_535.0 * (distance.to_num::<f64>() - 0.5) / 799.5;
        let found = depth_at(distance, uniform);
        assert!((f64::from(found) - exact).abs() <= 0.51, "{distance}: uniform depth {found}, exactly {exact}");
        let bin = Scalar::from_num(precision.uniform_bin()) + Scalar::DELTA;
        if distance + bin + bin < far {
            assert!(depth_at(distance + bin + bin, uniform) > found, "{distance} and two uniform bins more");
        }
    }
    assert!((precision.uniform_bin().to_num::<f64>() - 799.5 / 65_535.0).abs() < 1e-9);
    // Points are where vertices are.
    let mut point = None;
    whole::<Rgb565>((8, 8), Rgb565::BLACK, |scene| {
        point = scene.project_with(uniform, Vec3::from_ints(0, 0, -250), &camera);
    });
    let point = point.expect("it is in view");
    assert_eq!((point.x, point.y, point.z), (4 << 8, 4 << 8, depth_at(Scalar::from_num(250), uniform)));
}

#[test]
fn near_plane_for_a_bin_is_the_smallest() {
    let mut rng = Rng::new(8);
    let mut found = 0;
    for case in 0..20_000 {
        let far = Scalar::from_bits(rng.between(1 << 16, i32::MAX));
        let distance = Scalar::from_bits(rng.between(1 << 12, far.to_bits()));
        let bin = Scalar::from_bits((distance.to_bits() >> rng.between(6, 20)).max(1));
        let Ok(near) = DepthPrecision::near_for(far, distance, bin) else { continue };
        let Ok(precision) = DepthPrecision::new(near, far) else { continue };
        assert!(precision.bin(distance) <= bin, "case {case}: near {near} does not make {bin} at {distance}");
        // A twentieth nearer is not enough, where 16.16 can tell.
        if near > Scalar::from_num(0.01) && bin > Scalar::from_num(0.01) {
            let (n, f, d) = ((near - near / 20).to_num::<f64>(), far.to_num::<f64>(), distance.to_num::<f64>());
            assert!(
                d * d * (f - n) / (65_535.0 * n * f) > bin.to_num::<f64>(),
                "case {case}: near {near}, {bin} at {distance}"
            );
            found += 1;
        }
    }
    assert!(found > 1000, "{found} cases");
}

#[test]
fn precision_that_cannot_be_is_refused() {
    let (one, ten) = (Scalar::ONE, Scalar::from_num(10));
    assert_eq!(DepthPrecision::new(-one, ten), Err(ProjectionError::NearNotPositive { near: -one }));
    assert_eq!(DepthPrecision::new(ten, one), Err(ProjectionError::NearNotBeforeFar { near: ten, far: one }));
    assert_eq!(DepthPrecision::near_for(one, ten, one), Err(PrecisionError::Distance { distance: ten, far: one }));
    assert_eq!(DepthPrecision::near_for(ten, one, Scalar::ZERO), Err(PrecisionError::Bin { bin: Scalar::ZERO }));
    let fine = DepthPrecision::near_for(Scalar::from_num(30_000), ten, Scalar::DELTA);
    assert!(matches!(fine, Err(PrecisionError::TooFine { near, .. }) if near > ten), "{fine:?}");
    assert_eq!(PrecisionError::Bin { bin: Scalar::ZERO }.to_string(), "a step of depth of 0, must be above 0");
}

/// Vertices of random meshes through random cameras, against 65,535 z / far in floating point.
#[test]
fn uniform_depth_of_vertices_is_within_half_a_step() {
    let mut rng = Rng::new(21);
    let (mut worst, mut placed, mut short) = (0_f64, 0, 0);
    for case in 0..2000 {
        let near = Scalar::from_bits(rng.between(1 << 10, 1 << 18));
        let far =
            Scalar::from_bits(rng.between(near.to_bits() + (1 << 12), i32::MAX) >> rng.between(0, 8)).max(near + near);
        let camera =
            Projective::perspective(Angle16::from_degrees(60), Size::new(320, 240), near, far).expect("a camera");
        let scale = Scalar::from_bits(rng.between(1 << 10, 1 << 20));
        let distance = Scalar::from_bits(rng.between(near.to_bits(), far.to_bits().min(1 << 29)));
        let turn = Affine::rotation_x(Angle16(rng.between(0, 65_535) as u16));
        let model = Affine::translation(Vec3::new(Scalar::ZERO, Scalar::ZERO, -distance)) * turn * Affine::scale(scale);
        let mvp = camera * model;
        let points: Vec<_> = (0..30).map(|_| [(); 3].map(|()| rng.between(-32_768, 32_767) as i16)).collect();
        let positions = Positions::Quantized { points: &points, scale: Scalar::ONE, offset: Vec3::ZERO };
        let mesh = Mesh::new(MeshData::new(positions)).expect("a mesh");
        let viewport = Viewport::full(Size::new(320, 240)).expect("a viewport");
        let mut transform = Transform::new(&mvp, &viewport, &mesh, false);
        transform.set_depth_scale(DepthScale::Uniform { far });
        short += u32::from(transform.is_short());
        for (index, point) in points.iter().enumerate() {
            let Projected::OnScreen(vertex) = transform.project_vertex(&mesh.data().positions, index) else { continue };
            let row = mvp.to_rows()[2].map(|entry| entry as f64 / 2f64.powi(32));
            let z = row[3] + (0..3).map(|k| row[k] * f64::from(point[k]) / 32_768.0).sum::<f64>();
            let exact = (65_535.0 * z / far.to_num::<f64>()).clamp(0.0, 65_535.0);
            worst = worst.max((f64::from(vertex.z) - exact).abs());
            placed += 1;
            // As the corner of a clipped triangle.
            let clip = transform.vertex(&mesh.data().positions, index);
            assert_eq!(transform.project(&clip), Some(vertex), "case {case}: {point:?}, clipped");
            assert!(worst <= 0.51, "case {case}: depth {} of {point:?}, exactly {exact}", vertex.z);
        }
    }
    assert!(placed > 10_000 && short > 200, "{placed} vertices, {short} meshes in the short path");
}

/// Halfway on the screen between distances a and b, uniform depth is that of (a + b) / 2.
#[test]
fn uniform_depth_bends_within_a_face() {
    let far = Scalar::from_num(100);
    let camera =
        Projective::perspective(Angle16::from_degrees(90), Size::new(9, 9), Scalar::ONE, far).expect("a camera");
    // A wall from distance 2, on the left, to 8, on the right.
    let corner = |side: i16, up: i16, distance: i16| Vec3::from_ints(side * distance, up * distance, -distance);
    let (a, b) = ([corner(-1, -1, 2), corner(-1, 1, 2)], [corner(1, -1, 8), corner(1, 1, 8)]);
    let corners = [a[0], b[0], b[1], a[0], b[1], a[1]];
    let mesh = Mesh::new(MeshData::new(Positions::Exact(&corners))).expect("a mesh");
    let state = State { depth_scale: DepthScale::Uniform { far }, ..BOTH_SIDES };
    let (_, depths, _) = whole::<Rgb565>((9, 9), Rgb565::BLACK, |scene| {
        scene.draw_with(state, &mesh, &camera, &Flat::unlit(Rgb888::RED));
    });
    let expected = 65_535.0 * (5.0 - 1.0) / 99.0;
    assert!((f64::from(depths[4 * 9 + 4]) - expected).abs() <= 2.0, "{}, {expected}", depths[4 * 9 + 4]);
}
