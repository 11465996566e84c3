//! Bad input gets an error that says what is wrong; sinks that fail, scenes that change, memory, displays and formats.

use crate::scenes;
use crate::scenes::{Draw, Room, Torus};
use crate::support::{difference, strips};
use core::convert::Infallible;
use std::error::Error;
use zstrip::color::{PixelFormat, Rgb565Be};
use zstrip::embedded_graphics_core::Pixel;
use zstrip::embedded_graphics_core::draw_target::DrawTarget;
use zstrip::embedded_graphics_core::geometry::Point;
use zstrip::embedded_graphics_core::geometry::{OriginDimensions, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, GrayColor, PixelColor, Rgb565, Rgb888, RgbColor};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::frame::{FrameError, FramebufferRenderer, RamBudget, Renderer, RendererError};
use zstrip::math::{Affine, Angle16, ProjectionError, Projective, Scalar, Vec3};
use zstrip::mesh::{Bounds, BoundsNode, Mesh, MeshData, MeshError, Positions, Topology};
use zstrip::shader::{Flat, Gouraud};
use zstrip::span::Shader;
use zstrip::target::{FrameSlice, FramebufferError, StripPixels, StripSink, records_len};
use zstrip::target::{WithDepth, WithRecords};
use zstrip::vertex::{VertexShader, Viewport, ViewportError};

/// The error, and that it says more than nothing.
fn told<T, E: Error>(result: Result<T, E>) -> E {
    let Err(error) = result else { panic!("there is no error") };
    let text = error.to_string();
    assert!(text.len() > 10, "{error:?} is shown as `{text}`");
    println!("{text}");
    error
}

const TRIANGLE: [Vec3; 3] = [Vec3::from_ints(-1, -1, 0), Vec3::from_ints(1, -1, 0), Vec3::from_ints(0, 1, 0)];

fn data(points: &[Vec3]) -> MeshData<'_> {
    MeshData::new(Positions::Exact(points))
}

#[test]
fn wrong_meshes_are_refused_with_the_offending_number() {
    use MeshError::*;
    let four = [Vec3::ZERO; 4];
    let with =
        |indices: &[u16], topology| told(Mesh::new(MeshData { indices: Some(indices), topology, ..data(&four) }));
    let past = with(&[0, 1, 2, 3, 4, 0], Topology::Triangles);
    assert_eq!(past, Index { at: 4, index: 4, vertices: 4 });
    assert!(past.to_string().contains("index 4 at position 4"), "{past}");
    assert_eq!(with(&[65_535, 0, 0], Topology::Fan), Index { at: 0, index: 65_535, vertices: 4 });
    assert_eq!(with(&[0, 1], Topology::Triangles), Incomplete { indices: 2, unit: 3 });
    assert_eq!(with(&[0, 1], Topology::Strip), Incomplete { indices: 2, unit: 3 });
    assert_eq!(with(&[0], Topology::Fan), Incomplete { indices: 1, unit: 3 });
    assert_eq!(with(&[0, 1, 2, 3, 0], Topology::Quads), Incomplete { indices: 5, unit: 4 });
    assert_eq!(told(Mesh::new(data(&four))), Incomplete { indices: 4, unit: 3 });

    let many = vec![Vec3::ZERO; 65_536];
    assert_eq!(told(Mesh::new(data(&many))), TooManyVertices { vertices: 65_536 });
    let long = vec![0; 65_538];
    let strip = MeshData { indices: Some(&long), topology: Topology::Strip, ..data(&four) };
    assert_eq!(told(Mesh::new(strip)), TooManyTriangles { triangles: 65_536 });

    let three = data(&TRIANGLE);
    assert_eq!(told(Mesh::new(MeshData { normals: Some(&[[0; 3]; 2]), ..three })), Normals { normals: 2, vertices: 3 });
    assert_eq!(
        told(Mesh::new(MeshData { face_normals: Some(&[[0; 3]; 2]), ..three })),
        FaceNormals { face_normals: 2, triangles: 1 }
    );
    assert_eq!(told(Mesh::new(MeshData { colors: Some(&[[0; 3]; 4]), ..three })), Colors { colors: 4, vertices: 3 });
    assert_eq!(told(Mesh::new(MeshData { uvs: Some(&[]), ..three })), Uvs { uvs: 0, vertices: 3 });
    for bits in [0, -1, i32::MIN] {
        let points = [[0; 3]; 3];
        let quantized = Positions::Quantized { points: &points, scale: Scalar::from_bits(bits), offset: Vec3::ZERO };
        assert_eq!(told(Mesh::new(MeshData::new(quantized))), Scale { scale: Scalar::from_bits(bits) });
    }
}

#[test]
fn wrong_hierarchies_are_refused_with_the_offending_node() {
    let bounds: Bounds = *Mesh::new(data(&TRIANGLE)).expect("a triangle").bounds();
    let node = |skip, first_triangle, triangles| BoundsNode { bounds, skip, first_triangle, triangles };
    for (nodes, wrong) in [
        ([node(2, 0, 0), node(1, 0, 1)], 1),
        ([node(0, 0, 0), node(2, 0, 1)], 0),
        ([node(2, 0, 0), node(3, 0, 1)], 1),
        ([node(2, 0, 0), node(2, 0, 2)], 1),
        ([node(2, 2, 0), node(2, 0, 1)], 0),
        ([node(2, 65_535, 65_535), node(2, 0, 1)], 0),
    ] {
        let mesh = Mesh::new(MeshData { hierarchy: Some(&nodes), ..data(&TRIANGLE) });
        assert_eq!(told(mesh), MeshError::Hierarchy { node: wrong, nodes: 2 }, "{nodes:?}");
    }
    let nodes = [node(2, 0, 0), node(2, 0, 1)];
    let good = MeshData { hierarchy: Some(&nodes), ..data(&TRIANGLE) };
    assert!(Mesh::new(good).is_ok());
}

/// A row of squares, one per leaf, in a tree of a root and its leaves.
fn tree_of_squares(leaves: i16) -> (Vec<Vec3>, Vec<BoundsNode>) {
    let points: Vec<_> = (0..leaves)
        .flat_map(|k| [(k, 0), (k + 1, 0), (k + 1, 1), (k, 1)].map(|(x, y)| Vec3::from_ints(x, y, 0)))
        .collect();
    let bounds =
        |points: &[Vec3]| *Mesh::new(MeshData { topology: Topology::Quads, ..data(points) }).expect("squares").bounds();
    let root = BoundsNode { bounds: bounds(&points), skip: leaves as u16 + 1, first_triangle: 0, triangles: 0 };
    let leaf = |k: usize| BoundsNode {
        bounds: bounds(&points[4 * k..4 * k + 4]),
        skip: k as u16 + 2,
        first_triangle: 2 * k as u16,
        triangles: 2,
    };
    let nodes = [root].into_iter().chain((0..leaves as usize).map(leaf)).collect();
    (points, nodes)
}

#[test]
fn hierarchy_has_each_triangle_in_one_leaf() {
    use MeshError::{Hierarchy, Leaf, LeftOut, TooManyNodes};
    let (points, nodes) = tree_of_squares(3);
    let squares = MeshData { topology: Topology::Quads, ..data(&points) };
    let with = |change: fn(&mut Vec<BoundsNode>)| {
        let mut nodes = nodes.clone();
        change(&mut nodes);
        Mesh::new(MeshData { hierarchy: Some(&nodes), ..squares }).map(|_| ())
    };
    assert_eq!(with(|_| ()), Ok(()));
    // The same triangles in two leaves, at the end and at the beginning.
    assert_eq!(told(with(|nodes| nodes[3].first_triangle = 2)), Leaf { node: 3, first_triangle: 2, expected: 4 });
    assert_eq!(told(with(|nodes| nodes[2].first_triangle = 0)), Leaf { node: 2, first_triangle: 0, expected: 2 });
    // Triangles in no leaf: first, in the middle, last, all.
    assert_eq!(
        told(with(|nodes| (nodes[1].first_triangle, nodes[1].triangles) = (1, 1))),
        Leaf { node: 1, first_triangle: 1, expected: 0 }
    );
    assert_eq!(told(with(|nodes| nodes[2].triangles = 1)), Leaf { node: 3, first_triangle: 4, expected: 3 });
    assert_eq!(told(with(|nodes| nodes[3].triangles = 1)), LeftOut { triangle: 5, triangles: 6 });
    assert_eq!(
        told(with(|nodes| nodes.iter_mut().for_each(|node| node.triangles = 0))),
        LeftOut { triangle: 0, triangles: 6 }
    );
    assert_eq!(told(with(Vec::clear)), LeftOut { triangle: 0, triangles: 6 });
    // The last leaf is not below the root, but the first leaf skips it.
    assert_eq!(told(with(|nodes| (nodes[0].skip, nodes[1].skip) = (2, 3))), Hierarchy { node: 1, nodes: 4 });

    // 1,000 leaves over the same 2,000 triangles.
    let (points, _) = tree_of_squares(1000);
    let all = BoundsNode { bounds: nodes[0].bounds, skip: 0, first_triangle: 0, triangles: 2000 };
    let bounds = Bounds { center: Vec3::ZERO, half: Vec3::from_ints(2000, 2000, 2000) };
    let many: Vec<_> = (0..1000).map(|k| BoundsNode { bounds, skip: k + 1, ..all }).collect();
    let squares = MeshData { topology: Topology::Quads, hierarchy: Some(&many), ..data(&points) };
    assert_eq!(told(Mesh::new(squares)), Leaf { node: 1, first_triangle: 0, expected: 2000 });
    // Empty nodes without end.
    let empty: Vec<_> = (0..5000).map(|k| BoundsNode { bounds, skip: k + 1, triangles: 0, ..all }).collect();
    let empty = many[..1].iter().chain(&empty).enumerate();
    let empty: Vec<_> = empty.map(|(k, node)| BoundsNode { skip: k as u16 + 1, ..*node }).collect();
    let with = |nodes: &[BoundsNode]| Mesh::new(MeshData { hierarchy: Some(nodes), ..squares }).map(|_| ());
    assert_eq!(told(with(&empty)), TooManyNodes { nodes: 5001, triangles: 2000 });
    assert_eq!(with(&empty[..4001]), Ok(()));
}

#[test]
fn bounds_of_a_hierarchy_hold_what_they_claim() {
    use MeshError::{HalfSize, NodeBounds};
    let (points, nodes) = tree_of_squares(3);
    let squares = MeshData { topology: Topology::Quads, ..data(&points) };
    let with = |number: usize, center: [i32; 3], half: [i32; 3]| {
        let mut nodes = nodes.clone();
        let bounds = &mut nodes[number].bounds;
        let add = |v: Vec3, more: [i32; 3]| {
            let [x, y, z] = v.to_bits();
            Vec3::from_bits([x + more[0], y + more[1], z + more[2]])
        };
        *bounds = Bounds { center: add(bounds.center, center), half: add(bounds.half, half) };
        Mesh::new(MeshData { hierarchy: Some(&nodes), ..squares }).map(|_| ())
    };
    // Positions may be rounded by one unit of 2⁻¹⁶. Boxes may be larger than they have to be, the root's excepted.
    assert_eq!(with(2, [1, 0, 0], [0; 3]), Ok(()));
    assert_eq!(with(2, [0; 3], [1 << 20; 3]), Ok(()));
    assert_eq!(told(with(2, [2, 0, 0], [0; 3])), NodeBounds { node: 2, vertex: 4 });
    assert_eq!(told(with(3, [0; 3], [0, -2, 0])), NodeBounds { node: 3, vertex: 8 });
    assert_eq!(told(with(0, [2, 0, 0], [0; 3])), NodeBounds { node: 0, vertex: 0 });
    assert_eq!(told(with(0, [0; 3], [-2, 0, 0])), NodeBounds { node: 0, vertex: 0 });
    // The box of a leaf that is too large is no excuse for the root's.
    let mut wrong = nodes.clone();
    wrong[1].bounds.half = Vec3::from_ints(9, 9, 9);
    wrong[0].bounds = wrong[2].bounds;
    assert_eq!(told(Mesh::new(MeshData { hierarchy: Some(&wrong), ..squares })), NodeBounds { node: 0, vertex: 0 });
    let Err(HalfSize { half }) = with(1, [0; 3], [0, 0, -1]) else { panic!("a negative half size") };
    assert_eq!(half.to_bits(), [1 << 15, 1 << 15, -1]);

    // A mesh's own bounds.
    let bounds = |half: [i32; 3]| Some(Bounds { center: Vec3::ZERO, half: Vec3::from_bits(half) });
    let one = [Vec3::ZERO; 3];
    assert!(Mesh::new(MeshData { bounds: bounds([0; 3]), ..data(&one) }).is_ok());
    let half = Vec3::from_bits([0, -1, 0]);
    assert_eq!(told(Mesh::new(MeshData { bounds: bounds([0, -1, 0]), ..data(&one) })), HalfSize { half });
    assert_eq!(told(Mesh::new(MeshData { bounds: bounds([0, -1, 0]), ..data(&[]) })), HalfSize { half });
}

#[test]
fn wrong_viewports_and_screens_are_refused_with_their_size() {
    let large = |w, h| ViewportError::TooLarge { size: Size::new(w, h) };
    let at = |x, y, w, h| Viewport::new(Point::new(x, y), Size::new(w, h));
    assert_eq!(told(at(0, 0, 0, 9)), ViewportError::Empty { size: Size::new(0, 9) });
    assert_eq!(told(Viewport::full(Size::new(9, 0))), ViewportError::Empty { size: Size::new(9, 0) });
    assert_eq!(told(Viewport::full(Size::new(4097, 1))), large(4097, 1));
    assert_eq!(told(Viewport::full(Size::new(1, u32::MAX))), large(1, u32::MAX));
    assert_eq!(told(at(8193, 0, 1, 1)), ViewportError::TooFar { top_left: Point::new(8193, 0) });
    assert_eq!(told(at(0, i32::MIN, 1, 1)), ViewportError::TooFar { top_left: Point::new(0, i32::MIN) });
    assert!(at(-8192, 8192, 4096, 4096).is_ok());

    let build = |(width, height), color: usize, depth: usize| {
        let mut depth = vec![0; depth];
        let renderer = Renderer::<Rgb565>::new(Size::new(width, height))?.with_depth(&mut depth)?;
        Ok::<_, RendererError>(renderer.strip_rows(color))
    };
    for depth in [319, 0] {
        let short = RendererError::DepthTooShort { pixels: depth, needed: 320 };
        assert_eq!(told(build((320, 240), 320, depth)), short);
        let mut depth = vec![0; depth];
        let framebuffer = FramebufferRenderer::new(Size::new(320, 240)).expect("a renderer");
        assert_eq!(told(framebuffer.with_depth(&mut depth)), short);
    }
    for (width, height) in [(0, 240), (320, 0), (4097, 1), (1, 4097), (65_536 + 320, 240), (320, u32::MAX)] {
        let screen = Size::new(width, height);
        let refused = RendererError::Screen(told(Viewport::full(screen)));
        assert_eq!(told(build((width, height), 5000, 5000)), refused);
        assert_eq!(told(FramebufferRenderer::new(screen)), refused);
    }
    // The smaller buffer decides, and no strip is higher than the screen.
    assert_eq!(build((320, 240), 320 * 16, 320 * 9 + 319), Ok(9));
    assert_eq!(build((320, 240), 320 * 7, 320 * 9), Ok(7));
    assert_eq!(build((320, 240), 320 * 8 - 1, 320 * 9), Ok(7));
    assert_eq!(build((320, 240), 319, 320 * 9), Ok(0));
    assert_eq!(build((10, 4), 1000, 1000), Ok(4));
    let bare = Renderer::<Rgb565>::new(Size::new(320, 240)).expect("a renderer");
    assert_eq!(bare.strip_rows(320 * 5), 5);
    assert_eq!(bare.strip_rows(usize::MAX), 240);

    let mut pixels = [0_u16; 100];
    assert_eq!(
        told(FrameSlice::<Rgb565>::new(&mut pixels, Size::new(10, 11))),
        FramebufferError::TooShort { pixels: 100, needed: 110 }
    );
    let strided = FrameSlice::<Rgb565>::with_stride(&mut pixels, Size::new(10, 4), 9);
    assert_eq!(told(strided), FramebufferError::Stride { stride: 9, width: 10 });
    let strided = FrameSlice::<Rgb565>::with_stride(&mut pixels, Size::new(10, 4), 31);
    assert_eq!(told(strided), FramebufferError::TooShort { pixels: 100, needed: 103 });
    // The gap behind the last row need not be there.
    assert!(FrameSlice::<Rgb565>::with_stride(&mut pixels, Size::new(10, 4), 30).is_ok());
    assert!(FrameSlice::<Rgb565>::with_stride(&mut pixels, Size::new(10, 4), usize::MAX).is_err());
}

#[test]
fn wrong_cameras_are_refused_with_the_offending_numbers() {
    let (one, two) = (Scalar::ONE, Scalar::from_num(2));
    let right = Angle16::from_degrees(90);
    let perspective =
        |angle, (width, height), near, far| told(Projective::perspective(angle, Size::new(width, height), near, far));
    use ProjectionError::*;
    assert_eq!(perspective(right, (4, 3), Scalar::ZERO, one), NearNotPositive { near: Scalar::ZERO });
    assert_eq!(perspective(right, (4, 3), -one, one), NearNotPositive { near: -one });
    assert_eq!(perspective(right, (4, 3), two, one), NearNotBeforeFar { near: two, far: one });
    assert_eq!(perspective(right, (4, 3), one, one), NearNotBeforeFar { near: one, far: one });
    assert_eq!(perspective(Angle16(0), (4, 3), one, two), FieldOfView { angle: Angle16(0) });
    assert_eq!(perspective(Angle16(0x8000), (4, 3), one, two), FieldOfView { angle: Angle16(0x8000) });
    assert_eq!(perspective(right, (0, 3), one, two), Aspect { width: 0, height: 3 });
    assert_eq!(perspective(right, (4, 0), one, two), Aspect { width: 4, height: 0 });
    let box_of = |x, y, z| told(Projective::orthographic(x, y, z));
    assert_eq!(box_of((one, one), (one, two), (one, two)), EmptyBox { low: one, high: one });
    assert_eq!(box_of((one, two), (two, two), (one, two)), EmptyBox { low: two, high: two });
    assert_eq!(box_of((one, two), (one, two), (two, one)), NearNotBeforeFar { near: two, far: one });
    for (eye, target, up) in
        [(Vec3::X, Vec3::X, Vec3::Y), (Vec3::X, Vec3::Y, Vec3::ZERO), (Vec3::Y, Vec3::ZERO, Vec3::Y)]
    {
        assert_eq!(told(Affine::look_at(eye, target, up)), DegenerateView);
    }
}

#[test]
fn empty_mesh_draws_nothing() {
    for topology in [Topology::Triangles, Topology::Strip, Topology::Fan, Topology::Quads] {
        for indices in [None, Some(&[][..])] {
            let mesh = Mesh::new(MeshData { topology, indices, ..data(&[]) });
            let mesh = mesh.expect("an empty mesh is a mesh");
            for records in [0, 100] {
                let (picture, stats) = strips::<Gray8>((8, 8), 3, records, Gray8::new(9), |scene| {
                    scene.draw(&mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
                });
                assert_eq!((stats.triangles, stats.vertices, stats.drawn), (0, 0, 0), "{topology:?}");
                assert!(picture.iter().all(|p| *p == 9));
            }
        }
    }
}

const SIZE: (u16, u16) = (64, 48);

/// Calls `test` with a renderer of strips of 8 rows.
fn with_renderer<T>(
    records: usize,
    test: impl FnOnce(&mut Renderer<'_, Rgb565, WithDepth, WithRecords>, &mut [u16]) -> T,
) -> T {
    let (mut color, mut depth, mut records) = (vec![0; 64 * 8], vec![0; 64 * 8], vec![0; records]);
    let renderer = Renderer::<Rgb565>::new(Size::new(64, 48)).expect("a renderer");
    test(&mut renderer.with_depth(&mut depth).expect("a renderer").with_records(&mut records), &mut color)
}

/// The whole frame, from a renderer that has been used before.
fn next_frame(
    renderer: &mut Renderer<'_, Rgb565, WithDepth, WithRecords>,
    color: &mut [u16],
    turn: Angle16,
) -> Vec<u16> {
    let mut picture = Vec::new();
    let sink = |strip: &StripPixels<'_, Rgb565>| {
        picture.extend_from_slice(strip.pixels());
        Ok::<(), Infallible>(())
    };
    let room = Room::new(Size::new(64, 48), turn);
    let drawn = renderer.frame_to(sink, color, Rgb565::BLACK, |scene| room.draw(scene));
    drawn.expect("a frame like any other");
    picture
}

fn first_frame(turn: Angle16) -> Vec<u16> {
    let room = Room::new(Size::new(64, 48), turn);
    strips::<Rgb565>(SIZE, 48, 40_000, Rgb565::BLACK, |scene| room.draw(scene)).0
}

/// A sink that fails at a strip.
struct Failing {
    strips_left: usize,
}

impl StripSink<Rgb565> for Failing {
    type Error = &'static str;

    fn strip(&mut self, _: &StripPixels<'_, Rgb565>) -> Result<(), &'static str> {
        self.strips_left = self.strips_left.checked_sub(1).ok_or("the cable came off")?;
        Ok(())
    }
}

#[test]
fn failing_sink_ends_the_frame_and_the_next_one_is_right() {
    for (records, strips_left) in [0, 900, 30_000].into_iter().flat_map(|r| [0, 1, 3, 5].map(|s| (r, s))) {
        with_renderer(records, |renderer, color| {
            let sink = Failing { strips_left };
            let room = Room::new(Size::new(64, 48), Angle16(1000));
            let failed = renderer.frame_to(sink, color, Rgb565::RED, |scene| room.draw(scene));
            let error = failed.expect_err("the sink fails");
            assert_eq!(error, FrameError::Sink("the cable came off"));
            assert!(error.to_string().contains("the cable came off"));
            let found = difference(&next_frame(renderer, color, Angle16(9)), &first_frame(Angle16(9)), 64);
            assert_eq!(found, None, "{records} records, after {strips_left} strips");
        });
    }
}

#[test]
fn scene_that_changes_between_calls_is_an_error_and_the_next_frame_is_right() {
    let mesh = Mesh::new(data(&TRIANGLE)).expect("a triangle");
    let shader = Flat::unlit(Rgb888::WHITE);
    // Draws in the first call, and in the later ones; which draw differs.
    for (first, later, differs) in [(2, 1, 1), (1, 2, 1), (0, 1, 0), (3, 0, 0)] {
        with_renderer(30_000, |renderer, color| {
            let mut calls = 0;
            let changed = renderer.frame_to(
                |_: &StripPixels<'_, Rgb565>| Ok::<(), Infallible>(()),
                color,
                Rgb565::RED,
                |scene| {
                    calls += 1;
                    for _ in 0..if calls == 1 { first } else { later } {
                        scene.draw(&mesh, &Projective::IDENTITY, &shader);
                    }
                },
            );
            assert_eq!(changed, Err(FrameError::SceneChanged { draw: differs }), "{first} draws, then {later}");
            assert!(told(changed).to_string().contains(&differs.to_string()));
            assert_eq!(difference(&next_frame(renderer, color, Angle16(9)), &first_frame(Angle16(9)), 64), None);
        });
    }
    // Another matrix, another state, another mesh.
    let other = Mesh::new(data(&[Vec3::ZERO; 6])).expect("two triangles");
    for change in 0..3 {
        with_renderer(30_000, |renderer, color| {
            let mut calls = 0;
            let changed = renderer.frame_to(
                |_: &StripPixels<'_, Rgb565>| Ok::<(), Infallible>(()),
                color,
                Rgb565::RED,
                |scene| {
                    calls += 1;
                    let which = if calls < 3 { 3 } else { change };
                    scene.draw(&mesh, &Projective::IDENTITY, &shader);
                    let turned = Projective::from(Affine::rotation_z(Angle16(calls)));
                    let state = zstrip::State {
                        cull: if which == 1 { zstrip::Cull::None } else { zstrip::Cull::Back },
                        ..zstrip::State::default()
                    };
                    let mvp = if which == 0 { turned } else { Projective::IDENTITY };
                    scene.draw_with(state, if which == 2 { &other } else { &mesh }, &mvp, &shader);
                },
            );
            assert_eq!(changed, Err(FrameError::SceneChanged { draw: 1 }), "change {change}");
            assert_eq!(difference(&next_frame(renderer, color, Angle16(9)), &first_frame(Angle16(9)), 64), None);
        });
    }
}

/// The buffers of a 320 × 240 frame in 16-row strips, with records for the torus: added up, and as the constants say.
#[test]
fn ram_of_a_frame_is_what_the_constants_say() {
    const WIDTH: u32 = 320;
    const ROWS: u32 = 16;
    const WORDS: usize = <Gouraud as VertexShader>::WORDS;
    const VERTICES: usize = scenes::torus::MESH.vertex_count();
    const TRIANGLES: usize = scenes::torus::MESH.triangle_count();
    const RECORDS: usize = records_len(15, 1, VERTICES, WORDS, TRIANGLES / 2);
    const BARE: RamBudget = RamBudget::new::<Rgb565>(WIDTH, ROWS);
    const RAM: RamBudget = BARE.with_records(1, 240, VERTICES, WORDS, TRIANGLES / 2);
    const _: () = assert!(RAM.total() < 40 * 1024, "a constant that can be asserted");

    let pixels = (WIDTH * ROWS) as usize;
    let (mut color, mut depth, mut records) = (vec![0_u16; pixels], vec![0_u16; pixels], vec![0_u32; RECORDS]);
    let bytes = [size_of_val(&color[..]), size_of_val(&depth[..]), size_of_val(&records[..])];
    assert_eq!(bytes, [RAM.color, RAM.depth, RAM.records]);
    assert_eq!(bytes.iter().sum::<usize>(), RAM.total());
    assert_eq!(BARE.total(), RAM.color + RAM.depth);

    let renderer =
        Renderer::<Rgb565>::new(Size::new(WIDTH, 240)).expect("a renderer").with_depth(&mut depth).expect("a renderer");
    let mut renderer = renderer.with_records(&mut records);
    assert_eq!(renderer.strip_rows(color.len()), ROWS);
    let handle = size_of_val(&renderer);
    let sink = |_: &StripPixels<'_, Rgb565>| Ok::<(), Infallible>(());
    let torus = Torus::gouraud(Size::new(WIDTH, 240), Angle16(0));
    let stats = renderer.frame_to(sink, &mut color, Rgb565::BLACK, |scene| torus.draw(scene)).expect("a frame");
    assert_eq!((stats.overflows, stats.direct_strips), (0, 0), "the records suffice: {stats:?}");
    println!(
        "320x240 in 16-row strips: colour {} + depth {} + records {} = {} bytes; renderer {handle} bytes; without records {}",
        RAM.color,
        RAM.depth,
        RAM.records,
        RAM.total(),
        BARE.total()
    );
    println!("a whole frame with depth would take {} bytes", RamBudget::new::<Rgb565>(WIDTH, 240).total());
    assert!(handle < 160);

    assert_eq!(RamBudget::new::<Rgb888>(10, 3).color, 90);
    assert_eq!(RamBudget::new::<Gray8>(10, 3).color, 30);
}

/// A display of 20 × 16 pixels that counts how often each is drawn, and fails if asked to.
struct Display<C> {
    pixels: Vec<Option<C>>,
    fills: usize,
    fails_at: usize,
}

impl<C: PixelColor> Display<C> {
    fn new() -> Self {
        Self { pixels: vec![None; 20 * 16], fills: 0, fails_at: usize::MAX }
    }
}

impl<C> OriginDimensions for Display<C> {
    fn size(&self) -> Size {
        Size::new(20, 16)
    }
}

impl<C: PixelColor> DrawTarget for Display<C> {
    type Color = C;
    type Error = &'static str;

    fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        for Pixel(at, color) in pixels {
            let index = usize::try_from(20 * at.y + at.x).map_err(|_| "a pixel outside of the display")?;
            let old = self.pixels.get_mut(index).ok_or("a pixel outside of the display")?.replace(color);
            assert!(old.is_none(), "pixel {at:?} is drawn twice");
        }
        Ok(())
    }

    fn fill_contiguous<I: IntoIterator<Item = C>>(&mut self, area: &Rectangle, colors: I) -> Result<(), Self::Error> {
        if self.fills == self.fails_at {
            return Err("no answer on the bus");
        }
        self.fills += 1;
        let colors: Vec<C> = colors.into_iter().collect();
        assert_eq!(colors.len() as u32, area.size.width * area.size.height, "as many colours as pixels");
        let points = (area.top_left.y..).take(area.size.height as usize).flat_map(|y| {
            (area.top_left.x..)
                .take(area.size.width as usize)
                .map(move |x| zstrip::embedded_graphics_core::geometry::Point::new(x, y))
        });
        self.draw_iter(points.zip(colors).map(|(at, color)| Pixel(at, color)))
    }
}

/// The upper left half of the screen, in a colour with distinct channels.
const CORNER: [Vec3; 3] = [Vec3::from_ints(-1, 1, 0), Vec3::from_ints(-1, -1, 0), Vec3::from_ints(1, 1, 0)];
const COLOR: Rgb888 = Rgb888::new(0x12, 0x9A, 0xF0);

fn on_display<P: PixelFormat>(background: P::Color) -> Vec<P::Color>
where
    Flat: Shader<P>,
{
    let mesh = Mesh::new(data(&CORNER)).expect("a triangle");
    let (mut color, mut depth) = (vec![P::pack([0; 3]); 20 * 5], vec![0; 20 * 5]);
    let renderer =
        Renderer::<P>::new(Size::new(20, 16)).expect("a renderer").with_depth(&mut depth).expect("a renderer");
    let mut renderer = renderer.with_records(&mut []);
    let mut display = Display::new();
    let draw = |scene: &mut zstrip::Scene<'_, zstrip::target::Strip<'_, P, WithDepth, WithRecords>>| {
        scene.draw(&mesh, &Projective::IDENTITY, &Flat::unlit(COLOR));
    };
    renderer.frame(&mut display, &mut color, background, draw).expect("a display that works");
    assert_eq!(display.fills, 4, "a strip is one call");

    let mut broken = Display { fails_at: 2, ..Display::new() };
    let error = renderer.frame(&mut broken, &mut color, background, draw).expect_err("a display that fails");
    assert_eq!(error, FrameError::Sink("no answer on the bus"));
    display.pixels.into_iter().map(|p| p.expect("every pixel is drawn")).collect()
}

#[test]
fn pixels_arrive_on_a_display_in_the_right_places() {
    let in_corner = |i: usize| {
        let (x, y) = (i % 20, i / 20);
        (2 * x + 1) * 16 + (2 * y + 1) * 20 < 2 * 20 * 16
    };
    let check = |name: &str, found: &[bool]| {
        for (i, found) in found.iter().enumerate() {
            assert_eq!(*found, in_corner(i), "{name}: pixel ({}, {})", i % 20, i / 20);
        }
    };
    let color565 = Rgb565::new(0x12 >> 3, 0x9A >> 2, 0xF0 >> 3);
    let seen = on_display::<Rgb565>(Rgb565::RED);
    assert!(seen.iter().all(|c| [color565, Rgb565::RED].contains(c)));
    check("Rgb565", &seen.iter().map(|c| *c == color565).collect::<Vec<_>>());
    let seen = on_display::<Rgb565Be>(Rgb565::RED);
    assert!(seen.iter().all(|c| [color565, Rgb565::RED].contains(c)));
    check("Rgb565Be", &seen.iter().map(|c| *c == color565).collect::<Vec<_>>());
    let seen = on_display::<Rgb888>(Rgb888::RED);
    assert!(seen.iter().all(|c| [COLOR, Rgb888::RED].contains(c)));
    check("Rgb888", &seen.iter().map(|c| *c == COLOR).collect::<Vec<_>>());
    let seen = on_display::<Gray8>(Gray8::new(1));
    let luma = (0x12 * 77 + 0x9A * 150 + 0xF0 * 29) / 256;
    check("Gray8", &seen.iter().map(|c| c.luma() == luma as u8).collect::<Vec<_>>());
}

/// The bytes of a strip in one colour, from left to right.
fn bytes_of<P: PixelFormat>(background: P::Color) -> Vec<u8> {
    let (mut color, mut depth) = (vec![P::pack([0; 3]); 2], vec![0; 2]);
    let renderer = Renderer::<P>::new(Size::new(2, 1)).expect("a renderer").with_depth(&mut depth).expect("a renderer");
    let mut renderer = renderer.with_records(&mut []);
    let mut frame = renderer.begin(background);
    let strip = frame.next_strip(&mut color, |_| ()).expect("an empty scene").expect("one strip");
    assert!(strip.colors().eq([background; 2]));
    strip.bytes().to_vec()
}

#[test]
fn formats_have_their_bytes_in_order() {
    let color = Rgb565::new(0b10010, 0b001101, 0b11001);
    // 10010001 10111001.
    assert_eq!(bytes_of::<Rgb565Be>(color), [0x91, 0xB9, 0x91, 0xB9]);
    let native: Vec<u8> = [0x91B9_u16.to_ne_bytes(); 2].concat();
    assert_eq!(bytes_of::<Rgb565>(color), native);
    assert_eq!(bytes_of::<Rgb888>(Rgb888::new(1, 2, 3)), [1, 2, 3, 1, 2, 3]);
    assert_eq!(bytes_of::<Gray8>(Gray8::new(200)), [200, 200]);
}

#[test]
fn formats_pack_and_unpack_alike() {
    for rgb in [[0; 3], [255; 3], [255, 0, 0], [0, 255, 0], [0, 0, 255], [0x12, 0x9A, 0xF0], [7, 3, 7], [8, 4, 8]] {
        let [r, g, b] = rgb;
        let to565 = Rgb565::new(r >> 3, g >> 2, b >> 3);
        assert_eq!(Rgb565::to_color(Rgb565::pack(rgb)), to565, "{rgb:?}");
        assert_eq!(Rgb565Be::to_color(Rgb565Be::pack(rgb)), to565, "{rgb:?}");
        assert_eq!(Rgb565Be::from_color(to565), Rgb565Be::pack(rgb), "{rgb:?}");
        assert_eq!(Rgb565Be::pack(rgb).to_ne_bytes(), Rgb565::pack(rgb).to_be_bytes(), "{rgb:?}");
        assert_eq!(Rgb888::to_color(Rgb888::pack(rgb)), Rgb888::new(r, g, b), "{rgb:?}");
        let luma = (f64::from(r) * 77.0 + f64::from(g) * 150.0 + f64::from(b) * 29.0) / 256.0;
        assert_eq!(Gray8::pack(rgb), luma as u8, "{rgb:?}");
    }
    assert_eq!(Gray8::pack([255; 3]), 255, "white stays white");
}
