//! Numbers against f64 and exact fractions: projected positions, depth, interpolated colours. The worst cases are
//! printed.

use crate::reference::conformance::Rasterizer;
use crate::reference::exact;
use crate::reference::rng::Rng;
use crate::reference::scenes::{screen_triangle, sliver};
use crate::reference::subject::Subject;
use crate::support;
use crate::support::{accuracy, apply, matrix, on_screen, position, rigid, scalar, vector, whole};
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::internals::{Transform, project};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::shader::Gouraud;
use zstrip::span::DepthState;
use zstrip::vertex::Viewport;
use zstrip::{Cull, State};

/// Largest errors seen, in 1/256 px and in steps of depth, and of how many vertices.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    position: f64,
    depth: f64,
    vertices: usize,
}

/// Vertices of any format about the origin, up to `extent` away from it.
enum Cloud {
    Quantized(Vec<[i16; 3]>, Scalar, Vec3),
    Exact(Vec<Vec3>),
}

const VERTICES: usize = 60;

impl Cloud {
    fn new(rng: &mut Rng, quantized: bool, extent: f64) -> Self {
        if quantized {
            let corner = |rng: &mut Rng| [(); 3].map(|()| rng.between(-32_768, 32_767) as i16);
            let points = (0..VERTICES).map(|_| corner(rng)).collect();
            Cloud::Quantized(points, Scalar::from_num(extent), vector(rng, extent / 2.0))
        } else {
            Cloud::Exact((0..VERTICES).map(|_| vector(rng, extent)).collect())
        }
    }

    fn positions(&self) -> Positions<'_> {
        match self {
            Cloud::Quantized(points, scale, offset) => Positions::Quantized { points, scale: *scale, offset: *offset },
            Cloud::Exact(points) => Positions::Exact(points),
        }
    }
}

fn random_viewport(rng: &mut Rng) -> Viewport {
    let [width, height] = [(); 2].map(|()| rng.between(1, 1024) as u16);
    let [x, y] = [(); 2].map(|()| if rng.one_in(2) { 0 } else { rng.between(-600, 600) as i16 });
    Viewport::new(Point::new(x.into(), y.into()), Size::new(width.into(), height.into())).expect("a viewport")
}

/// A mesh of just vertices.
fn points<'a>(positions: &Positions<'a>) -> Mesh<'a> {
    Mesh::new(MeshData { indices: Some(&[]), ..MeshData::new(*positions) }).expect("a mesh")
}

/// Measures the vertices of which the promise speaks: in front of the near plane, w at least 1/1024 of `extent`,
/// within 32,767 px.
fn measure(
    worst: &mut Worst,
    mvp: &Projective,
    viewport: &Viewport,
    positions: &Positions<'_>,
    extent: f64,
    case: &str,
) {
    let transform = Transform::new(mvp, viewport, &points(positions), false);
    let m = matrix(mvp);
    let count = match positions {
        Positions::Quantized { points, .. } => points.len(),
        Positions::Exact(points) => points.len(),
        Positions::Homogeneous(points) => points.len(),
    };
    for index in 0..count {
        let clip = apply(&m, position(positions, index));
        let [_, _, z, w] = clip;
        let [x, y, depth] = on_screen(viewport, clip);
        if !(z >= 0.0 && z <= w && w >= extent / 1024.0 && x.abs() <= 32_767.0 && y.abs() <= 32_767.0) {
            continue;
        }
        let vertex = transform.vertex(positions, index);
        let snapped = project(&vertex).unwrap_or_else(|| panic!("{case}: vertex {index} has w = {w}"));
        let error = (f64::from(snapped.x) - 256.0 * x).abs().max((f64::from(snapped.y) - 256.0 * y).abs());
        let depth_error = (f64::from(snapped.z) - 65_535.0 * depth).abs();
        worst.vertices += 1;
        worst.position = worst.position.max(error);
        worst.depth = worst.depth.max(depth_error);
        assert!(
            error <= 1.5 && depth_error <= 1.0,
            "{case}: vertex {index} at ({x}, {y}) px, depth {depth}, w {w}, is off by {error}/256 px, {depth_error} steps; short path: {}",
            transform.is_short()
        );
    }
}

/// Objects of some size (relative to their distance) and format; the worst for the short path and for the long one.
fn objects(
    name: &str,
    seeds: std::ops::Range<u64>,
    quantized: bool,
    distances: [f64; 2],
    orthographic: bool,
) -> [Worst; 2] {
    let mut worst = [Worst::default(); 2];
    for seed in seeds {
        let mut rng = Rng::new(seed);
        let case = format!("{name}, seed {seed}");
        let viewport = random_viewport(&mut rng);
        let size = (viewport.size().width as u16, viewport.size().height as u16);
        // Sizes over several powers of two, in the object and through the model matrix.
        let extent = (rng.unit() * 10.0 - 4.0).exp2();
        let factor = if rng.one_in(2) { 1.0 } else { (rng.unit() * 6.0 - 3.0).exp2() };
        let scale = Affine::scale(Scalar::from_num(factor));
        let reach = extent * factor;
        let distance = reach * (distances[0] + rng.unit() * (distances[1] - distances[0]));
        let far = (distance + 4.0 * reach + 1.0).min(32_000.0);
        let near = (reach / 2000.0).max(1.0 / 4096.0).min(far / 2.0);
        let camera = if orthographic {
            let half = Scalar::from_num(reach * (0.3 + rng.unit()));
            let sides = (-half, half);
            Projective::orthographic(sides, sides, (Scalar::ZERO, Scalar::from_num(far)))
        } else {
            let angle = Angle16::from_degrees(rng.between(10, 120));
            Projective::perspective(
                angle,
                Size::new(size.0.into(), size.1.into()),
                Scalar::from_num(near),
                Scalar::from_num(far),
            )
        };
        let camera = camera.unwrap_or_else(|error| panic!("{case}: {error}"));
        let aside = vector(&mut rng, distance / 4.0);
        let away = Vec3::new(aside.x, aside.y, Scalar::from_num(-distance));
        let model = Affine::translation(away) * rigid(&mut rng, reach / 8.0) * scale;
        let cloud = Cloud::new(&mut rng, quantized, extent);
        let positions = cloud.positions();
        let mvp = camera * model;
        let short = Transform::new(&mvp, &viewport, &points(&positions), false).is_short();
        measure(&mut worst[usize::from(!short)], &mvp, &viewport, &positions, reach, &case);
    }
    for (worst, path) in worst.iter().zip(["short", "long"]) {
        println!(
            "{name}, {path} path: {} vertices, worst {:.3}/256 px, {:.3} steps of depth",
            worst.vertices, worst.position, worst.depth
        );
    }
    worst
}

/// Bound: 1/256 px beside the rounding of 1/512 px.
#[test]
fn positions_are_within_a_256th_of_a_pixel_of_f64() {
    let near = objects("quantized, close by", 0..400, true, [0.0, 1.5], false);
    assert!(near[1].vertices > 2000, "the long path is taken");
    let far = objects("quantized, far away", 1000..1400, true, [2.0, 30.0], false);
    assert!(far[0].vertices > 4000, "the short path is taken");
    let exact_near = objects("exact, close by", 2000..2400, false, [0.0, 1.5], false);
    let exact_far = objects("exact, far away", 3000..3400, false, [2.0, 30.0], false);
    let flat = objects("quantized, orthographic", 4000..4400, true, [1.2, 30.0], true);
    assert!(flat[0].vertices > 4000, "the short path is taken");
    let exact_flat = objects("exact, orthographic", 5000..5400, false, [1.2, 30.0], true);
    let all = [near, far, exact_near, exact_far, flat, exact_flat];
    let worst = |of: fn(&Worst) -> f64| all.iter().flatten().map(of).fold(0.0, f64::max);
    accuracy::check("position of a vertex", worst(|w| w.position));
    accuracy::check("depth of a vertex", worst(|w| w.depth));
}

#[test]
fn homogeneous_positions_are_within_a_256th_of_a_pixel_of_f64() {
    let mut worst = Worst::default();
    for seed in 0..600 {
        let mut rng = Rng::new(seed);
        let viewport = random_viewport(&mut rng);
        let extent = (rng.unit() * 14.0).exp2();
        let points: Vec<[Scalar; 4]> = (0..VERTICES)
            .map(|_| {
                let w = rng.unit() * extent;
                let side = extent.min(8.0 * w);
                [scalar(&mut rng, side), scalar(&mut rng, side), Scalar::from_num(w * rng.unit()), Scalar::from_num(w)]
            })
            .collect();
        let turn = Projective::from(Affine::rotation_z(support::angle(&mut rng)));
        let mvp = if rng.one_in(2) { Projective::IDENTITY } else { turn };
        measure(&mut worst, &mvp, &viewport, &Positions::Homogeneous(&points), extent, &format!("seed {seed}"));
    }
    println!("homogeneous: {worst:?}");
    accuracy::check("position of a homogeneous vertex", worst.position);
    assert!(worst.vertices > 10_000);
}

/// A triangle that may be anything: small, huge, thin, partly or wholly outside; on the grid that [`clip`] can express.
fn any_triangle(rng: &mut Rng, width: u32, height: u32) -> [[i32; 2]; 3] {
    let tri = match rng.below(3) {
        0 => sliver(rng, width, height),
        1 => screen_triangle(rng, width, height),
        _ => [(); 3].map(|()| [rng.between(-64, 256 * width as i32), rng.between(-64, 256 * height as i32)]),
    };
    // 16.16 clip coordinates divide a large screen more coarsely than into 1/256 px.
    let on_grid = |c: i32, size: u32| c - c % (size as i32 / 512).max(1);
    tri.map(|[x, y]| [on_grid(x, width), on_grid(y, height)])
}

/// The clip coordinate, with w = 1, of a 24.8 screen coordinate; exact on screens that are powers of two.
fn clip(c: i32, size: u32) -> Scalar {
    Scalar::from_bits((i64::from(c) * 512 / i64::from(size)) as i32 - 65_536)
}

/// Depth ranges that are flat, steep or full.
fn any_depths(rng: &mut Rng) -> [u16; 3] {
    match rng.below(4) {
        0 => [rng.between(0, 65_534) as u16; 3],
        1 => {
            let z = rng.between(0, 65_000);
            [(); 3].map(|()| (z + rng.between(0, 500)) as u16)
        }
        2 => [(); 3].map(|()| rng.pick(&[0, 1, 32_768, 65_534, 65_535])),
        _ => [(); 3].map(|()| rng.between(0, 65_535) as u16),
    }
}

#[test]
fn depth_is_within_one_step_of_the_exact_plane() {
    let mut worst = (0.0, String::new());
    let mut pixels = 0;
    for (seed, count, (width, height)) in
        [(1, 2500, (64, 64)), (2, 300, (1024, 8)), (3, 120, (8, 1024)), (4, 150, (4096, 4))]
    {
        let mut rng = Rng::new(seed);
        for case in 0..count {
            let (v, z) = (any_triangle(&mut rng, width, height), any_depths(&mut rng));
            let (winners, depths) = Subject::default().depth_scene(width, height, &[(v, z)]);
            let tri = exact::widen(v);
            let (low, high) = (*z.iter().min().expect("three"), *z.iter().max().expect("three"));
            let mut covered = 0;
            exact::for_each_pixel(tri, width, height, |x, y| {
                let i = (y * width + x) as usize;
                covered += 1;
                let exact = exact::to_f64(exact::depth_at(tri, z.map(i64::from), x.into(), y.into()));
                let case =
                    format!("seed {seed} case {case}: {v:?} depths {z:?}, pixel ({x}, {y}): {} for {exact}", depths[i]);
                // What rounds to the clear value does not pass the test.
                let error = (f64::from(depths[i]) - exact).abs();
                assert!(error <= 1.0, "{case}");
                assert!(winners[i] == 1 || exact > 65_534.0, "{case}");
                assert!((low..=high).contains(&depths[i]) || winners[i] == 0, "{case}: outside of the vertices' range");
                if error > worst.0 {
                    worst = (error, case);
                }
            });
            pixels += covered;
            let drawn = winners.iter().filter(|w| **w == 1).count();
            assert!(drawn <= covered, "seed {seed} case {case}: {v:?} {z:?}");
        }
    }
    println!("{pixels} pixels; worst depth is off by {:.4} steps: {}", worst.0, worst.1);
    accuracy::check("depth of a pixel", worst.0);
    assert!(pixels > 100_000);
}

/// Draws random Gouraud triangles in a pixel format, and gives `check` each covered pixel and the exact channels there.
fn gouraud_pixels<P: PixelFormat>(black: P::Color, mut check: impl FnMut(P::Raw, [f64; 3], String)) {
    let state = State { cull: Cull::None, depth: DepthState::OFF, ..State::default() };
    for (seed, count, (width, height)) in [(11, 1500, (64_u32, 64_u32)), (12, 150, (1024, 8)), (13, 60, (4096, 4))] {
        let mut rng = Rng::new(seed);
        for case in 0..count {
            let snaps = any_triangle(&mut rng, width, height);
            let colors = [(); 3].map(|()| [(); 3].map(|()| rng.pick(&[0, 255, 77, 128]) as u8));
            let vertices = snaps.map(|[x, y]| [clip(x, width), -clip(y, height), Scalar::ZERO, Scalar::ONE]);
            let mesh =
                Mesh::new(MeshData { colors: Some(&colors), ..MeshData::new(Positions::Homogeneous(&vertices)) })
                    .expect("a triangle");
            let (picture, ..) = whole::<P>((width as u16, height as u16), black, |scene| {
                scene.draw_with(state, &mesh, &Projective::IDENTITY, &Gouraud::vertex_colors())
            });
            let tri = exact::widen(snaps);
            exact::for_each_pixel(tri, width, height, |x, y| {
                let at = exact::center(x.into(), y.into());
                let exact = [0, 1, 2].map(|channel| {
                    let values = colors.map(|c| i64::from(c[channel]));
                    exact::to_f64(exact::affine_at(tri, values, at))
                });
                let case = format!("seed {seed} case {case}: {snaps:?} {colors:?} at ({x}, {y}), exact {exact:?}");
                check(picture[(y * width + x) as usize], exact, case);
            });
        }
    }
}

#[test]
fn gouraud_channels_are_within_1_of_255_of_the_exact_plane() {
    let (mut worst, mut pixels) = ((0.0, String::new()), 0);
    gouraud_pixels::<Rgb888>(Rgb888::BLACK, |found, exact, case| {
        pixels += 1;
        for (found, exact) in found.into_iter().zip(exact) {
            let error = (f64::from(found) - exact).abs();
            assert!(error <= 1.0, "{case}: {found}");
            if error > worst.0 {
                worst = (error, case.clone());
            }
        }
    });
    println!("{pixels} pixels; worst channel is off by {:.4} of 255: {}", worst.0, worst.1);
    accuracy::check("colour of a pixel, 24 bits", worst.0);
    assert!(pixels > 50_000);
}

/// Formats of 16 bits have a loop of their own, all channels in one word; what it packs must have been within 1 as
/// well.
#[test]
fn packed_channels_were_within_1_of_255_before_they_lost_bits() {
    let (mut worst, mut pixels) = ((0.0, String::new()), 0);
    gouraud_pixels::<Rgb565>(Rgb565::BLACK, |found, exact, case| {
        pixels += 1;
        let steps = [(found >> 11, 8.0), (found >> 5 & 63, 4.0), (found & 31, 8.0)];
        for ((found, step), exact) in steps.into_iter().zip(exact) {
            // The nearest value that is cut to this one.
            let low = f64::from(found) * step;
            let error = (low - exact).max(exact - (low + step)).max(0.0);
            assert!(error <= 1.0, "{case}: {found} steps of {step}");
            if error > worst.0 {
                worst = (error, case.clone());
            }
        }
    });
    println!("{pixels} pixels; worst channel is off by {:.4} of 255: {}", worst.0, worst.1);
    accuracy::check("colour of a pixel, 16 bits, before bits are cut", worst.0);
    assert!(pixels > 50_000);
}
