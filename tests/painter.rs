//! The painter's algorithm, against a depth buffer.

use crate::reference::rng::Rng;
use crate::scenes;
use crate::support::whole;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::Rgb888;
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology, sort_back_to_front};
use zstrip::shader::Gouraud;
use zstrip::span::DepthState;
use zstrip::vertex::{SortError, SortReport, SortScratch, Viewport, painters_order};
use zstrip::{Cull, State};

const SCREEN: (u16, u16) = (160, 120);
const BOTH_SIDES: State = State { cull: Cull::None, ..State::DEFAULT };

#[test]
fn items_are_sorted_from_sort_back_to_front() {
    let mut rng = Rng::new(3);
    for case in 0..500 {
        let items: Vec<i32> = (0..rng.between(0, 60)).map(|_| rng.between(-20, 20) << rng.between(0, 20)).collect();
        let (mut sorted, mut expected) = (items.clone(), items);
        sort_back_to_front(&mut sorted, |item| i64::from(*item));
        expected.sort_unstable_by_key(|item| std::cmp::Reverse(*item));
        assert_eq!(sorted, expected, "case {case}");
    }
}

/// Draws a mesh with a depth buffer, and sorted without one: pixels that differ, pixels drawn, and the order.
fn compare(mesh: &Mesh<'_>, mvp: &Projective) -> (usize, usize, SortReport) {
    let viewport = Viewport::full(Size::new(SCREEN.0.into(), SCREEN.1.into())).expect("a viewport");
    let mut memory = vec![SortScratch::default(); mesh.triangle_count()];
    let mut indices = vec![0; 3 * mesh.triangle_count()];
    let order = painters_order(mesh, mvp, &viewport, &mut memory, &mut indices).expect("room for all");
    let draw = |mesh: &Mesh<'_>, state: State| {
        let (picture, ..) = whole::<Rgb888>(SCREEN, Rgb888::new(1, 2, 3), |scene| {
            scene.draw_with(state, mesh, mvp, &Gouraud::vertex_colors());
        });
        picture
    };
    let expected = draw(mesh, BOTH_SIDES);
    let data = MeshData { topology: Topology::Triangles, indices: Some(&indices), ..*mesh.data() };
    let sorted = Mesh::new(data).expect("the same mesh");
    let painted = draw(&sorted, State { depth: DepthState::OFF, ..BOTH_SIDES });
    // A vertex' depth is a step off at most, and so is where surfaces meet.
    let far = |(a, b): (&[u8; 3], &[u8; 3])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 40);
    let differ = painted.iter().zip(&expected).filter(|(a, b)| far((a, b))).count();
    (differ, expected.iter().filter(|pixel| **pixel != [1, 2, 3]).count(), order)
}

/// A torus of triangles in random colours.
#[test]
fn torus_is_painted_as_a_depth_buffer_would_show_it() {
    let mut rng = Rng::new(17);
    let source = scenes::torus::MESH.data();
    let colors: Vec<[u8; 3]> =
        (0..scenes::torus::MESH.vertex_count()).map(|_| [(); 3].map(|()| rng.between(0, 255) as u8)).collect();
    let data = MeshData { face_normals: None, normals: None, colors: Some(&colors), hierarchy: None, ..*source };
    let mesh = Mesh::new(data).expect("a mesh");
    for turn in [0, 9000, 31_000] {
        let camera = scenes::camera(Size::new(SCREEN.0.into(), SCREEN.1.into()), Scalar::ONE, Scalar::from_num(12));
        let (differ, drawn, order) = compare(&mesh, &(camera * scenes::torus_model(Angle16(turn))));
        assert!(drawn > 2000 && differ <= drawn / 200, "turn {turn}: {differ} of {drawn} pixels differ, {order:?}");
    }
}

/// Triangles in layers, which an order by their farthest vertex alone gets wrong.
#[test]
fn slanted_triangles_are_painted_in_the_right_order() {
    let (mut wrong, mut naive_wrong, mut clean) = (0, 0, 0);
    for seed in 0..60 {
        let mut rng = Rng::new(seed);
        let (mut points, mut colors) = (Vec::new(), Vec::new());
        // Parallel planes, slanted, a tenth apart: no two triangles meet.
        for layer in 0..14 {
            let color = [(); 3].map(|()| rng.between(0, 255) as u8);
            for _ in 0..3 {
                let (x, y) = (rng.between(-1500, 1500) as i16, rng.between(-1200, 1200) as i16);
                points.push(Vec3::from_milli(x.into(), y.into(), -5000 + layer * 100 + i32::from(x) * 3 / 4));
                colors.push(color);
            }
        }
        // In no order to begin with.
        let mut order: Vec<u16> = (0..14).collect();
        sort_back_to_front(&mut order, |k| (i64::from(*k) * 7919 + seed as i64) % 31);
        let indices: Vec<u16> = order.iter().flat_map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let data =
            MeshData { colors: Some(&colors), indices: Some(&indices), ..MeshData::new(Positions::Exact(&points)) };
        let mesh = Mesh::new(data).expect("a mesh");
        let camera = scenes::camera(Size::new(SCREEN.0.into(), SCREEN.1.into()), Scalar::ONE, Scalar::from_num(12));
        let (differ, _, order) = compare(&mesh, &camera);
        assert_eq!(order.indices, 42);
        wrong += differ;
        clean += usize::from(order.unresolved == 0);
        // By their farthest vertices alone.
        let mut naive: Vec<u16> = (0..14).collect();
        let distance = |k: &u16| (0..3).map(|c| -points[usize::from(3 * k + c)].to_bits()[2]).max().unwrap_or(0);
        sort_back_to_front(&mut naive, |k| i64::from(distance(k)));
        let back_to_front = (0..14).collect::<Vec<u16>>();
        naive_wrong += usize::from(naive != back_to_front);
    }
    assert!(wrong <= 60, "{wrong} pixels differ in 60 pictures");
    assert_eq!(clean, 60, "pictures without pairs that cannot be ordered");
    assert!(naive_wrong > 30, "{naive_wrong} pictures need more than distances");
}

#[test]
fn rings_and_intersections_are_counted() {
    let camera = scenes::camera(Size::new(SCREEN.0.into(), SCREEN.1.into()), Scalar::ONE, Scalar::from_num(12));
    let mvp = camera * Affine::translation(Vec3::from_ints(0, 0, -3));
    let (.., order) = compare(&scenes::polygons::CYCLE, &mvp);
    assert!(order.unresolved > 0, "{order:?}");
}

#[test]
fn what_cannot_be_sorted_is_refused() {
    let mesh = &scenes::polygons::CYCLE;
    let count = mesh.triangle_count();
    let viewport = Viewport::full(Size::new(SCREEN.0.into(), SCREEN.1.into())).expect("a viewport");
    let sort = |mesh: &Mesh<'_>, places: usize, indices: usize| {
        let (mut memory, mut indices) = (vec![SortScratch::default(); places], vec![0; indices]);
        painters_order(mesh, &Projective::IDENTITY, &viewport, &mut memory, &mut indices)
    };
    assert_eq!(sort(mesh, count - 1, 3 * count), Err(SortError::TooShort { found: count - 1, expected: count }));
    assert_eq!(
        sort(mesh, count, 3 * count - 1),
        Err(SortError::IndicesTooShort { found: 3 * count - 1, expected: 3 * count })
    );
    let normals = vec![[0, 0, 1]; count];
    let with_normals = Mesh::new(MeshData { face_normals: Some(&normals), ..*mesh.data() }).expect("a mesh");
    assert_eq!(sort(&with_normals, count, 3 * count), Err(SortError::FaceNormals));
    // Nothing of it is on the screen: any order is right.
    let behind = Projective::IDENTITY * Affine::translation(Vec3::from_ints(0, 0, 900));
    let mut memory = vec![SortScratch::default(); count];
    let order = painters_order(mesh, &behind, &viewport, &mut memory, &mut vec![0; 3 * count]);
    assert_eq!(order.map(|order| order.indices), Ok(3 * count));
}
