//! Depth: bias, and how well distances are told apart.

mod reference;
mod support;

use reference::rng::Rng;
use support::{strips, whole};
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::fragment::{DepthBias, DepthState, Flat};
use zstrip::geometry::{Mesh, MeshData, Positions};
use zstrip::math::{Affine, Angle, Projective, Scalar, Vec3};
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
        let camera = Projective::perspective(Angle::from_degrees(60), SCREEN, Scalar::ONE, Scalar::from_num(50));
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
