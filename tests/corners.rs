//! VertexRef cases that once went wrong, or easily could.

use crate::reference::conformance::Rasterizer;
use crate::reference::model::Model;
use crate::reference::rng::Rng;
use crate::reference::scenes::depth_soup;
use crate::reference::subject::Subject;
use std::cell::Cell;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::frame::{FrameError, FramebufferRenderer, Renderer};
use zstrip::internals::{Projected, Transform};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Bounds, Mesh, MeshData, MeshError, Positions, Topology};
use zstrip::shader::{Flat, Gouraud};
use zstrip::span::{Compare, DepthState, Fragment, Shader};
use zstrip::target::{FrameSlice, Stats, Strip, StripPixels};
use zstrip::target::{WithDepth, WithRecords};
use zstrip::vertex::{DepthRange, Face, VertexRef, VertexShader, Viewport};
use zstrip::{Cull, Scene, State};

const SQUARE: [Vec3; 4] =
    [Vec3::from_ints(-1, -1, 0), Vec3::from_ints(1, -1, 0), Vec3::from_ints(1, 1, 0), Vec3::from_ints(-1, 1, 0)];

fn quad(corners: &[Vec3]) -> MeshData<'_> {
    MeshData { topology: Topology::Quads, ..MeshData::new(Positions::Exact(corners)) }
}

fn square() -> Mesh<'static> {
    Mesh::new(quad(&SQUARE)).expect("a mesh")
}

fn white() -> Flat {
    Flat::unlit(Rgb888::WHITE)
}

/// A frame of 64×64 px in one strip: how many pixels are not black.
fn lit(draw: impl FnMut(&mut Scene<'_, Strip<'_, Rgb565, WithDepth, WithRecords>>)) -> (usize, Stats) {
    let (mut color, mut depth, mut records) = ([0; 4096], [0; 4096], [0; 1000]);
    let renderer =
        Renderer::<Rgb565>::new(Size::new(64, 64)).expect("a renderer").with_depth(&mut depth).expect("a renderer");
    let mut renderer = renderer.with_records(&mut records);
    let mut lit = 0;
    let count = |strip: &StripPixels<'_, Rgb565>| {
        lit += strip.pixels().iter().filter(|p| **p != 0).count();
        Ok::<(), ()>(())
    };
    let stats = renderer.frame_to(count, &mut color, Rgb565::BLACK, draw).expect("a frame");
    (lit, stats)
}

/// 1,000 soups of random triangles, against exact coverage and depth.
#[test]
fn random_soups_have_exactly_the_right_pixels_and_depths() {
    let (mut pixels, mut worst) = (0, 0);
    for seed in 0..1000 {
        let soup = depth_soup(&mut Rng::new(seed), 6, 32, 32);
        let (_, exact) = Model.depth_scene(32, 32, &soup);
        let (winners, depths) = Subject::default().depth_scene(32, 32, &soup);
        for (k, (exact, found)) in exact.into_iter().zip(depths).enumerate() {
            pixels += usize::from(winners[k] > 0);
            worst = worst.max(exact.abs_diff(found));
            assert!(exact.abs_diff(found) <= 1, "seed {seed}, pixel {k}: depth {found}, exact {exact}");
            assert!(winners[k] > 0 || exact >= u16::MAX - 1, "seed {seed}: pixel {k} is missing");
        }
    }
    println!("{pixels} pixels, worst depth off by {worst} step");
    assert!(pixels > 100_000, "{pixels}");
}

#[test]
fn clamped_meshes_are_not_culled_beyond_the_far_plane() {
    let camera =
        Projective::perspective(Angle16::from_degrees(60), Size::new(1, 1), Scalar::ONE, Scalar::from_num(100));
    let camera = camera.expect("a camera");
    // Twice: the bounds of a single square are not looked at.
    let squares = [SQUARE, SQUARE].concat();
    let squares = Mesh::new(quad(&squares)).expect("a mesh");
    let depth = DepthState { compare: Compare::LessEqual, write: true };
    for (z, range, expected) in [
        (-99, DepthRange::Clip, true),
        (-101, DepthRange::Clip, false),
        (-101, DepthRange::ClampFar, true),
        (-200, DepthRange::Clamp, true),
    ] {
        let mvp = camera * Affine::translation(Vec3::from_ints(0, 0, z)) * Affine::scale(Scalar::from_num(50));
        let state = State { range, depth, ..State::default() };
        let (pixels, stats) = lit(|scene| scene.draw_with(state, &squares, &mvp, &white()));
        assert_eq!((pixels > 0, stats.culled == 0), (expected, expected), "{range:?} at {z}");
        let (single, stats) = lit(|scene| scene.draw_with(state, &square(), &mvp, &white()));
        assert_eq!((single, stats.culled), (pixels, 0), "a single square, {range:?} at {z}");
    }
}

#[test]
fn ground_as_large_as_the_world_is_not_culled() {
    let ground = [[-1, 1], [1, 1], [1, -1], [-1, -1]].map(|[x, z]| Vec3::from_ints(x * 30_000, 0, z * 30_000));
    let ground = [ground, ground].concat();
    let mesh = Mesh::new(quad(&ground)).expect("a mesh");
    let camera =
        Projective::perspective(Angle16::from_degrees(90), Size::new(1, 1), Scalar::ONE, Scalar::from_num(5000));
    let (eye, target) = (Vec3::from_ints(28_000, 20, 28_000), Vec3::from_ints(29_000, 20, 28_000));
    let mvp = camera.expect("a camera") * Affine::look_at(eye, target, Vec3::Y).expect("a view");
    let (pixels, stats) = lit(|scene| scene.draw(&mesh, &mvp, &white()));
    assert!(pixels > 1000 && stats.culled == 0, "{pixels} {stats:?}");
}

/// Keeps the normal of the face it is asked about.
struct Normal(Cell<[i16; 3]>);

impl VertexShader for Normal {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        self.0.set(face.normal());
        0
    }
}

impl Shader<Rgb565> for Normal {
    type Setup = ();

    fn fragment(&self, _: &Fragment<'_, [i32; 0]>) -> Option<u16> {
        Some(1)
    }
}

#[test]
fn computed_normals_are_those_of_f64() {
    let mut worst = 0.0_f64;
    for seed in 0..3000 {
        let mut rng = Rng::new(seed);
        let size = rng.pick(&[300, 5000, 65_536, 98_304, 131_000, 1_000_000]);
        let mut point = || Vec3::from_bits([0; 3].map(|_: i32| rng.between(-size, size)));
        let corners = [point(), point(), point()];
        let [a, b, c] = corners.map(|p| p.to_bits().map(f64::from));
        let (u, v) = ([0, 1, 2].map(|k: usize| b[k] - a[k]), [0, 1, 2].map(|k: usize| c[k] - a[k]));
        let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
        // Nearly parallel edges have no well-known normal.
        if length(n) < 0.2 * length(u) * length(v) {
            continue;
        }
        let mesh = Mesh::new(MeshData::new(Positions::Exact(&corners))).expect("a mesh");
        let shader = Normal(Cell::default());
        // Seen from somewhere where it is on the screen.
        let scale = Affine::scale(Scalar::from_bits((65_536.0 * 32_768.0 / f64::from(size)).min(2e9) as i32));
        let state = State { cull: Cull::None, range: DepthRange::Clamp, ..State::default() };
        let (_, stats) = lit(|scene| scene.draw_with(state, &mesh, &Projective::from(scale), &shader));
        if stats.drawn == 0 {
            continue;
        }
        for (found, exact) in shader.0.get().into_iter().zip(n) {
            let error = (f64::from(found) / 16_384.0 - exact / length(n)).abs();
            worst = worst.max(error);
            assert!(error < 1.0 / 256.0, "seed {seed}: {found} for {} of {corners:?}", exact / length(n) * 16_384.0);
        }
    }
    println!("worst component off by 2^{:.1}", worst.log2());
    assert!(worst > 0.0);
}

/// The gradient of blue is 2³¹ less a little, modulo 2³²: a span of one pixel.
#[test]
fn steep_channels_on_slivers_do_not_overflow() {
    let corners = [[8322, 8307], [8319, 8800], [8321, 8269]]
        .map(|[x, y]: [i32; 2]| [x * 8 - 65_536, 65_536 - y * 8, 0, 65_536].map(Scalar::from_bits));
    let colors = [[0, 0, 0], [0, 0, 16], [0, 0, 157]];
    let mesh = Mesh::new(MeshData { colors: Some(&colors), ..MeshData::new(Positions::Homogeneous(&corners)) });
    let state = State { cull: Cull::None, ..State::default() };
    let mesh = mesh.expect("a mesh");
    let (_, stats) = lit(|scene| scene.draw_with(state, &mesh, &Projective::IDENTITY, &Gouraud::vertex_colors()));
    assert_eq!(stats.drawn, 1);
}

#[test]
fn frame_is_over_after_its_scene_changed() {
    let (mut color, mut depth, mut records) = ([0; 512], [0; 512], [0; 1000]);
    let renderer =
        Renderer::<Rgb565>::new(Size::new(64, 64)).expect("a renderer").with_depth(&mut depth).expect("a renderer");
    let mut renderer = renderer.with_records(&mut records);
    let mut frame = renderer.begin(Rgb565::BLACK);
    let mut call = 0;
    let mut next = || {
        frame
            .next_strip(&mut color, |scene| {
                call += 1;
                scene.draw(&square(), &Projective::IDENTITY, &white());
                let turn = Angle16(if call == 2 { 100 } else { 0 });
                scene.draw(&square(), &Projective::from(Affine::rotation_z(turn)), &white());
            })
            .map(|strip| strip.is_some())
    };
    assert_eq!(next(), Err(FrameError::SceneChanged { draw: 1 }));
    assert_eq!(next(), Ok(false));
}

#[test]
fn another_mesh_of_the_same_size_is_noticed() {
    let half = SQUARE.map(|p| p * Scalar::from_num(0.5));
    let (whole, half) = (square(), Mesh::new(quad(&half)).expect("a mesh"));
    let (mut color, mut depth, mut records) = ([0; 512], [0; 512], [0; 1000]);
    let renderer =
        Renderer::<Rgb565>::new(Size::new(64, 64)).expect("a renderer").with_depth(&mut depth).expect("a renderer");
    let mut renderer = renderer.with_records(&mut records);
    let mut call = 0;
    let result = renderer.frame_to(
        |_: &StripPixels<'_, Rgb565>| Ok::<(), ()>(()),
        &mut color,
        Rgb565::BLACK,
        |scene| {
            call += 1;
            scene.draw(if call == 1 { &whole } else { &half }, &Projective::IDENTITY, &white());
        },
    );
    assert_eq!(result, Err(FrameError::SceneChanged { draw: 0 }));
}

#[test]
fn given_bounds_must_hold_the_vertices() {
    let good = *square().bounds();
    let with = |bounds| Mesh::new(MeshData { bounds: Some(bounds), ..quad(&SQUARE) }).map(|_| ());
    assert_eq!(with(good), Ok(()));
    assert_eq!(with(Bounds { half: Vec3::from_milli(1, 1, 1), ..good }), Err(MeshError::Bounds { vertex: 0 }));
    let half = -good.half;
    assert_eq!(with(Bounds { half, ..good }), Err(MeshError::HalfSize { half }));
}

#[test]
fn framebuffers_smaller_than_the_screen_get_what_they_hold() {
    let draw = |scene: &mut Scene<'_, FrameSlice<'_, Rgb565>>| {
        scene.draw(&square(), &Projective::IDENTITY, &white());
    };
    let mut depth = [0; 4096];
    for (width, height, stride) in [(32, 64, 32), (64, 20, 64), (1, 64, 3), (64, 1, usize::MAX)] {
        let mut pixels = vec![0; 4096];
        let mut renderer = FramebufferRenderer::new(Size::new(64, 64))
            .expect("a renderer")
            .with_depth(&mut depth)
            .expect("a renderer");
        let mut slice =
            FrameSlice::<Rgb565>::with_stride(&mut pixels, Size::new(width, height), stride).expect("a framebuffer");
        renderer.frame(&mut slice, Rgb565::BLACK, draw).expect("a frame");
        let lit = pixels.iter().filter(|p| **p != 0).count();
        assert_eq!(lit, (width * height) as usize, "{width}x{height}");
    }
}

/// w on the border of the range that the short path is made for: its own rounding must not lead out of it.
#[test]
fn short_path_is_not_taken_where_rounding_leaves_its_range() {
    let points = [[-32_768; 3], [32_766; 3], [-32_768, 32_766, -32_768]];
    let positions = Positions::Quantized { points: &points, scale: Scalar::ONE, offset: Vec3::ZERO };
    let mesh = Mesh::new(MeshData::new(positions)).expect("a mesh");
    let viewport = Viewport::full(Size::new(4096, 4096)).expect("a viewport");
    let mut short = 0;
    for nudge in -3000..3000_i64 {
        let w = [1_431_655_800, 858_993_514, 613_566_821, 7_199_183_431 + 40 * nudge];
        let mvp = Projective::from_rows([[0, 0, 0, 1 << 30], [0, 1 << 32, 0, 0], [0, 0, 0, 1 << 31], w]);
        let transform = Transform::new(&mvp, &viewport, &mesh, false);
        short += usize::from(transform.is_short());
        for index in 0..points.len() {
            if let Projected::OnScreen(vertex) = transform.project_vertex(&positions, index) {
                let clip = transform.vertex(&positions, index);
                assert_eq!(transform.project(&clip), Some(vertex), "nudge {nudge}, vertex {index}");
            }
        }
    }
    assert!(short > 1000 && short < 6000, "{short} short transforms of 6000");
}
