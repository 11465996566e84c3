//! Culling of whole objects: never what can be seen, mostly what cannot, and the picture stays the same.

use crate::reference::rng::Rng;
use crate::scenes;
use crate::support;
use crate::support::{difference, rigid, scalar, strips, vector};
use std::ops::Range;
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::internals::{Outcode, Planes, ScreenMatrix};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Bounds, BoundsNode, Mesh, MeshData, Positions, Topology};
use zstrip::shader::Gouraud;
use zstrip::span::{Fragment, Shader};
use zstrip::vertex::{VertexRef, VertexShader, Viewport};
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
        Projective::perspective(
            Angle16::from_degrees(rng.between(3, 170)),
            Size::new(size.0.into(), size.1.into()),
            near,
            end,
        )
    };
    (lens.expect("a camera") * rigid(rng, far), far)
}

fn to_f64(v: Vec3) -> [f64; 3] {
    v.to_bits().map(|c| f64::from(c) / 65_536.0)
}

/// The planes that a point has to be inside of to be seen in a rectangle of the screen, from the definition of the
/// matrix and the viewport: a · x + b · y + c · z + d ≥ 0 for each. Exact.
///
/// With X = x0 + (1 + x / w) · width / 2, X ≥ left is width · x + (2 x0 + width - 2 left) · w ≥ 0, as w > 0.
fn planes(camera: &Projective, viewport: &Viewport, columns: &Range<i32>, lines: &Range<i32>) -> [[i128; 4]; 6] {
    let [x, y, z, w] = camera.to_rows().map(|row| row.map(i128::from));
    let sum = |a: i128, row: [i128; 4], b: i128| [0, 1, 2, 3].map(|k: usize| a * row[k] + b * w[k]);
    let (corner, size) = (viewport.top_left(), viewport.size());
    let (width, height) = (i128::from(size.width), i128::from(size.height));
    let (middle_x, middle_y) = (2 * i128::from(corner.x) + width, 2 * i128::from(corner.y) + height);
    [
        sum(width, x, middle_x - 2 * i128::from(columns.start)),
        sum(-width, x, 2 * i128::from(columns.end) - middle_x),
        // y of clip space points up.
        sum(-height, y, middle_y - 2 * i128::from(lines.start)),
        sum(height, y, 2 * i128::from(lines.end) - middle_y),
        sum(1, z, 0),
        sum(-1, z, 1),
    ]
}

/// The value of a plane at the corner of a box that is farthest inside of it.
fn innermost(plane: &[i128; 4], bounds: &Bounds) -> i128 {
    let (center, half) = (bounds.center.to_bits(), bounds.half.to_bits());
    let corner = |k: u32| {
        let at = |axis: usize| {
            let half = i128::from(half[axis]);
            i128::from(center[axis]) + if k >> axis & 1 == 0 { half } else { -half }
        };
        plane[0] * at(0) + plane[1] * at(1) + plane[2] * at(2) + plane[3] * 65_536
    };
    (0..8).map(corner).max().expect("eight corners")
}

/// Asks random cameras for random boxes, and compares with the exact values of the planes at the corners of the boxes.
#[test]
fn boxes_are_culled_if_all_corners_are_outside_of_a_plane_and_only_then() {
    let (mut outside, mut missed, mut kept) = ([0; 6], 0, 0);
    for seed in 0..6000 {
        let mut rng = Rng::new(seed);
        let (camera, far) = random_camera(&mut rng);
        let corner = Point::new(rng.between(-100, 100), rng.between(-100, 100));
        let size = Size::new(rng.between(1, 640) as u32, rng.between(1, 640) as u32);
        let viewport = Viewport::new(corner, size).expect("a viewport");
        let mut range = |start: i32, size: u32| {
            let low = start + rng.below(size.into()) as i32;
            low..low + rng.between(1, 400)
        };
        let (columns, lines) = (range(corner.x, size.width), range(corner.y, size.height));
        let extent = far * (rng.unit() * -8.0).exp2();
        let mut side = || Scalar::from_num(extent * rng.unit());
        let half = Vec3::new(side(), side(), side());
        let center = vector(&mut rng, far.min(32_000.0));
        let bounds = Bounds { center, half };
        let clamped = rng.pick(&[0, 0, Outcode::FAR, Outcode::FAR | Outcode::NEAR]);

        let mut screen = ScreenMatrix::EMPTY;
        screen.set_from(&camera, &viewport);
        let sees = screen.sees(&bounds, &columns, &lines, Outcode(clamped));

        // The way of nodes, whose sides are made once for many boxes.
        let mut planes_of_nodes = Planes::EMPTY;
        screen.set_planes(&mut planes_of_nodes, &columns, &lines, Outcode(clamped));
        assert_eq!(planes_of_nodes.sees(&bounds), sees, "seed {seed}");

        let counts = |k: usize| match k {
            4 => clamped & Outcode::NEAR == 0,
            5 => clamped & Outcode::FAR == 0,
            _ => true,
        };
        // Entries are cut to 15 bits and coordinates to 14, which together is less than 1/100 of their largest product.
        let reach =
            center.to_bits().iter().chain(&half.to_bits()).fold(1 << 16, |reach, c| reach.max(c.unsigned_abs()));
        let (mut is_outside, mut is_well_outside) = (false, false);
        for (k, plane) in planes(&camera, &viewport, &columns, &lines).iter().enumerate().filter(|(k, _)| counts(*k)) {
            let value = innermost(plane, &bounds);
            let largest = plane.iter().fold(0, |largest, entry| largest.max(entry.abs()));
            is_outside |= value < 0;
            is_well_outside |= value * 100 < -largest * i128::from(reach);
            outside[k] += usize::from(value < 0);
        }
        let case = format!("seed {seed}: {bounds:?} in {columns:?} {lines:?} of {viewport:?}, clamped {clamped}");
        assert!(sees || is_outside, "culled, but outside of no plane: {case}");
        assert!(!sees || !is_well_outside, "kept, but outside of a plane: {case}");
        missed += usize::from(sees && is_outside);
        kept += usize::from(sees);
    }
    println!("{outside:?} boxes are outside of each plane, {missed} of them missed; {kept} of all are kept");
    assert!(outside.iter().all(|count| *count > 200) && kept > 400, "{outside:?}, {kept} kept");
    assert!(missed < 100, "{missed} boxes that are barely outside are kept");
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
            let bounds = mesh.bounds();
            let (center, half) = (to_f64(bounds.center), to_f64(bounds.half));
            for k in 0..12 {
                let p = support::position(&positions, k);
                let case = format!("seed {seed}: vertex {k} at {p:?}, {bounds:?}");
                assert!((0..3).all(|i| (p[i] - center[i]).abs() <= half[i]), "{case}");
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
        let camera =
            Projective::perspective(Angle16::from_degrees(50), Size::new(64, 48), Scalar::ONE, Scalar::from_num(60))
                .expect("a camera");
        let eye = Vec3::new(scalar(&mut rng, 20.0), scalar(&mut rng, 3.0), Scalar::ZERO);
        let mvp = camera * Affine::rotation_y(Angle16(rng.between(-6000, 6000) as u16)) * Affine::translation(-eye);
        let draw = |mesh| {
            strips::<Rgb565>((64, 48), 8, records, Rgb565::BLACK, |scene| {
                scene.draw_with(state, mesh, &mvp, &Gouraud::vertex_colors())
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
    let camera =
        Projective::perspective(Angle16::from_degrees(60), Size::new(64, 64), Scalar::ONE, Scalar::from_num(60))
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
                    scene.draw(mesh, &camera, &Gouraud::vertex_colors())
                })
            };
            let ((expected, _), (picture, stats)) = (draw(&Mesh::new(plain).expect("squares")), draw(&tree));
            assert_eq!(difference(&picture, &expected, 64), None, "{records} records, {seen} seen: {stats:?}");
            assert_eq!((stats.drawn, stats.culled), (2 * seen, 100 - seen), "{records} records: {stats:?}");
        }
    }
}

/// Bounds ignore the w of homogeneous positions, so they do not tell where these are.
#[test]
fn hierarchy_leaves_homogeneous_meshes_whole() {
    let corners = [(2, -1), (4, -1), (4, 1), (2, 1)].map(|(x, y)| [x, y, 0, 4].map(|c| Scalar::from_bits(c << 16)));
    let plain = MeshData { topology: Topology::Quads, ..MeshData::new(Positions::Homogeneous(&corners)) };
    let plain = Mesh::new(plain).expect("a quad");
    let nodes = [BoundsNode { bounds: *plain.bounds(), skip: 1, first_triangle: 0, triangles: 2 }];
    let tree = Mesh::new(MeshData { hierarchy: Some(&nodes), ..*plain.data() }).expect("a quad");
    for (rows, records) in [8, 4, 2, 1].into_iter().flat_map(|rows| [(rows, 0), (rows, 9), (rows, 500)]) {
        for mesh in [&plain, &tree] {
            let (picture, _) = strips::<Rgb565>((8, 8), rows, records, Rgb565::BLACK, |scene| {
                scene.draw(mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
            });
            // x from 0.5 to 1 of the half width, y from -1/4 to 1/4 of the half height.
            let lit: Vec<_> = (0..64).filter(|k| picture[*k] != 0).map(|k| (k % 8, k / 8)).collect();
            assert_eq!(lit, [(6, 3), (7, 3), (6, 4), (7, 4)], "{rows} rows, {records} records");
        }
    }
}

/// Moves all vertices to the right.
struct Aside(i16);

impl VertexShader for Aside {
    type Varyings = [i32; 0];
    const DISPLACES: bool = true;

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    fn displace(&self, vertex: &VertexRef<'_>) -> Vec3 {
        vertex.position() + Vec3::from_ints(self.0, 0, 0)
    }
}

impl Shader<Rgb565> for Aside {
    type Setup = ();

    fn fragment(&self, _: &Fragment<'_, [i32; 0], ()>) -> Option<u16> {
        Some(7)
    }
}

/// A hierarchy tells where vertices are before a shader moves them. So such shaders do without it.
#[test]
fn hierarchy_does_not_cull_what_a_shader_moves_into_view() {
    let (points, nodes) = row_of_squares();
    let plain = MeshData { topology: Topology::Quads, ..MeshData::new(Positions::Exact(&points)) };
    let tree = Mesh::new(MeshData { hierarchy: Some(&nodes), ..plain }).expect("squares");
    let plain = Mesh::new(plain).expect("squares");
    let camera =
        Projective::perspective(Angle16::from_degrees(50), Size::new(64, 48), Scalar::ONE, Scalar::from_num(60));
    let mvp = camera.expect("a camera") * Affine::translation(Vec3::from_ints(-200, 0, 0));
    for (aside, records) in [(0, 0), (200, 0), (200, 5000), (190, 300)] {
        let draw = |mesh| {
            strips::<Rgb565>((64, 48), 8, records, Rgb565::BLACK, |scene| scene.draw(mesh, &mvp, &Aside(aside))).0
        };
        let (expected, picture) = (draw(&plain), draw(&tree));
        assert_eq!(difference(&picture, &expected, 64), None, "{aside} aside, {records} records");
        assert_eq!(picture.contains(&7), aside > 0, "{aside} aside, {records} records");
    }
}

#[test]
fn scenes_may_leave_out_what_is_not_visible() {
    let torus = &scenes::torus::MESH;
    let at = |x: i16, z: i16| Affine::translation(Vec3::from_ints(x, 0, z));
    let places = [at(0, -4), at(-40, -5), at(1, 4), at(3, -6), at(0, -80)];
    let camera =
        Projective::perspective(Angle16::from_degrees(60), Size::new(64, 48), Scalar::ONE, Scalar::from_num(50))
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
                scene.draw(torus, &mvp, &Gouraud::new(scenes::LIT_COLORS));
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

/// Boxes as far out as coordinates go, of objects in front of the eye and behind it. Each mesh has its triangle twice:
/// bounds of up to four vertices are not looked at.
#[test]
fn far_corners_of_a_large_world_are_seen_from_the_front_and_culled_behind() {
    let lens =
        Projective::perspective(Angle16::from_degrees(60), Size::new(512, 512), Scalar::ONE, Scalar::from_num(1000));
    let lens = lens.expect("a camera");
    let (mut rng, mut culled) = (Rng::new(8), 0);
    for case in 0..150 {
        let [x, y, z] = [(); 3].map(|()| (rng.between(-31_000, 31_000) >> rng.below(12)) as i16);
        let corners = [(-60, -50), (60, -50), (0, 50)].map(|(i, j)| Vec3::from_ints(x + i, y + j, z));
        let corners = [corners, corners].concat();
        let mesh = Mesh::new(MeshData::new(Positions::Exact(&corners))).expect("a mesh");
        // Somewhere on the screen, if not in its middle.
        let (aside, up) = (rng.between(-120, 120) as i16, rng.between(-120, 120) as i16);
        let eye = Vec3::from_ints(x + aside, y + up, z + 290);
        let [ex, ey, ez] = eye.to_bits().map(Scalar::from_bits);
        let there = Affine::translation(Vec3::new(-ex, -ey, -ez));
        for (turn, seen) in [(Angle16(0), true), (Angle16(1 << 15), false)] {
            let mvp = lens * Affine::rotation_y(turn) * there;
            let (picture, stats) = strips::<Rgb565>((512, 512), 512, 100, Rgb565::BLACK, |scene| {
                scene.draw_with(State { cull: Cull::None, ..State::default() }, &mesh, &mvp, &Gouraud::vertex_colors());
            });
            let lit = picture.iter().filter(|pixel| **pixel != 0).count();
            let case = format!("case {case}: ({x}, {y}, {z}) from {eye:?}, {turn:?}: {lit} pixels, {stats:?}");
            assert!(if seen { lit > 5000 && stats.culled == 0 } else { lit == 0 }, "{case}");
            culled += stats.culled;
        }
    }
    // The others are behind the eye by less than a hundredth of their coordinates.
    assert!(culled > 80, "{culled} of 150 triangles behind the eye are culled");
}
