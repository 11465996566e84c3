//! A frame's cost is bounded by what it draws: counted in walks, vertices, triangles and cuts, and not in time.

use crate::reference::rng::Rng;
use crate::support::{difference, strips, unrecorded_strips};
use std::cell::Cell;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::math::{Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{LineTopology, Lines, Mesh, MeshData, Positions, Topology, Vertices};
use zstrip::shader::Gouraud;
use zstrip::span::{Fragment, Shader, TriangleSetup};
use zstrip::target::Stats;
use zstrip::vertex::{VertexRef, VertexShader};
use zstrip::{Cull, State, Thick};

const SCREEN: (u16, u16) = (320, 240);
const BOTH: State = State { cull: Cull::None, ..State::DEFAULT };

/// 600 small triangles at the bottom of the screen, each with one corner in front of the near plane.
fn cut_by_the_near_plane() -> (Vec<Vec3>, Projective) {
    let camera =
        Projective::perspective(Angle16::from_degrees(60), Size::new(320, 240), Scalar::ONE, Scalar::from_num(60));
    let at = |x: f64, y: f64, z: f64| Vec3::new(Scalar::from_num(x), Scalar::from_num(y), Scalar::from_num(z));
    // At a distance of 1, the screen ends 0.577 below its middle, and a pixel is 1/208.
    let triangles = (0..600).flat_map(|k| {
        let (x, y) = (f64::from(k % 60) / 50.0 - 0.6, -0.56 + f64::from(k / 60) / 1000.0);
        [at(x, y, -1.01), at(x + 0.015, y, -1.01), at(x, y + 0.01, -0.99)]
    });
    // One triangle at the top, so that the bounds of the mesh reach all strips.
    let top = [at(0.0, 0.58, -1.01), at(0.1, 0.58, -1.01), at(0.0, 0.56, -1.01)];
    (triangles.chain(top).collect(), camera.expect("a camera"))
}

fn frame(rows: usize, records: Option<usize>) -> (Vec<u16>, Stats) {
    let (points, camera) = cut_by_the_near_plane();
    let mesh = Mesh::new(MeshData::new(Positions::Exact(&points))).expect("triangles");
    let shader = Gouraud::vertex_colors();
    match records {
        Some(records) => {
            strips::<Rgb565>(SCREEN, rows, records, Rgb565::BLACK, |s| s.draw_with(BOTH, &mesh, &camera, &shader))
        }
        None => {
            unrecorded_strips::<Rgb565>(SCREEN, rows, Rgb565::BLACK, |s| s.draw_with(BOTH, &mesh, &camera, &shader))
        }
    }
}

/// The work of the stages before pixels, in about equal parts.
fn work(stats: &Stats) -> u32 {
    stats.vertices + stats.triangles + 10 * stats.clipped
}

#[test]
fn triangle_is_cut_only_in_strips_that_its_bounds_reach() {
    let (whole, one) = frame(240, None);
    assert_eq!((one.clipped, one.strips), (600, 1));
    let (picture, many) = frame(1, None);
    assert_eq!(difference(&picture, &whole, 320), None);
    println!("one strip: {one:?}\n240 strips: {many:?}");
    // Triangles are less than 4 rows high; a row above and one below count as reached.
    assert_eq!(many.strips, 240);
    assert!(many.clipped <= 600 * 7, "{} cuts in 240 strips", many.clipped);
}

#[test]
fn line_is_cut_only_in_strips_that_its_bounds_reach() {
    let (points, camera) = cut_by_the_near_plane();
    let lines = Lines::new(Vertices::new(Positions::Exact(&points)), LineTopology::Strip, None).expect("lines");
    let draw = |rows| {
        unrecorded_strips::<Rgb565>(SCREEN, rows, Rgb565::BLACK, |scene| {
            scene.draw_lines(&lines, &camera, &Gouraud::vertex_colors(), &Thick::px(5));
        })
    };
    let ((whole, one), (picture, many)) = (draw(240), draw(1));
    assert_eq!(difference(&picture, &whole, 320), None);
    println!("one strip: {} cuts, 240 strips: {} cuts", one.clipped, many.clipped);
    assert!(one.clipped > 1000 && many.clipped <= one.clipped * 16, "{} cuts, then {}", one.clipped, many.clipped);
}

#[test]
fn records_that_are_too_small_are_no_slower_than_none() {
    for rows in [1, 4, 16] {
        let (expected, none) = frame(rows, Some(0));
        let mut worst = (0.0, 0);
        for records in [100, 3900, 5500, 6000, 8000, 100_000] {
            let (picture, stats) = frame(rows, Some(records));
            assert_eq!(difference(&picture, &expected, 320), None, "{rows} rows, {records} words");
            let slower = f64::from(work(&stats)) / f64::from(work(&none));
            println!(
                "{rows} rows, {records} words: {:.3} of the work without records; {} walks for {} strips, {} in vain",
                slower, stats.walks, stats.strips, stats.overflows
            );
            worst = if slower > worst.0 { (slower, records) } else { worst };
        }
        assert!(worst.0 < 1.1, "{rows} rows, {} words: {:.3} of the work without records", worst.1, worst.0);
    }
}

/// Tall stripes side by side, one per draw: each of them reaches all strips.
#[test]
fn bands_are_recorded_in_vain_only_a_few_times() {
    let at = |x: i32, y: i32| [x, y, 0, 400].map(|c| Scalar::from_bits(c << 16));
    let stripes: Vec<Vec<_>> = (0..30)
        .map(|k| {
            let quads = (0..60).flat_map(move |row| {
                let (x, y) = (26 * k - 390, 13 * row - 390);
                [(x, y), (x + 20, y), (x + 20, y + 13), (x, y + 13)]
            });
            quads.map(|(x, y)| at(x, y)).collect()
        })
        .collect();
    let mesh =
        |points| Mesh::new(MeshData { topology: Topology::Quads, ..MeshData::new(Positions::Homogeneous(points)) });
    let meshes: Vec<_> = stripes.iter().map(|points| mesh(points).expect("quads")).collect();
    let frame = |rows, records| {
        strips::<Rgb565>(SCREEN, rows, records, Rgb565::BLACK, |scene| {
            for mesh in &meshes {
                scene.draw_with(BOTH, mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
            }
        })
    };
    for (rows, most) in [(4, 7), (16, 2)] {
        let (expected, none) = frame(rows, 0);
        for records in [3000, 12_000, 21_900, 22_200, 26_000, 40_000] {
            let (picture, stats) = frame(rows, records);
            assert_eq!(difference(&picture, &expected, 320), None, "{rows} rows, {records} words");
            let slower = f64::from(work(&stats)) / f64::from(work(&none));
            let case = format!(
                "{rows} rows, {records} words: {slower:.3} of the work without records; {} walks for {} strips, {} in vain",
                stats.walks, stats.strips, stats.overflows
            );
            println!("{case}");
            assert!(slower < 1.1 && stats.overflows <= most, "{case}");
        }
    }
}

/// A shader that counts how often it is called for each vertex.
struct CountsVertices(Vec<Cell<u32>>);

impl VertexShader for CountsVertices {
    type Varyings = [i32; 1];

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 1] {
        let calls = &self.0[vertex.index()];
        calls.set(calls.get() + 1);
        [0]
    }
}

impl Shader<Rgb565> for CountsVertices {
    type Setup = ();

    fn setup(&self, _: &TriangleSetup<'_, [i32; 1]>) {}

    fn fragment(&self, _: &Fragment<'_, [i32; 1]>) -> Option<u16> {
        Some(0xFFFF)
    }
}

#[test]
fn recorded_vertices_are_shaded_once_if_a_triangle_of_theirs_is_seen() {
    let seed = 71;
    let mut rng = Rng::new(seed);
    let (mut shaded, mut hidden) = (0, 0);
    for case in 0..60 {
        // Squares of 20 px from 80 px left of the screen and above it to 80 px right of it and below, or of 40 px.
        let (side, columns, rows) = [(20, 25, 21), (40, 13, 11)][case % 2];
        let at = |k: u16| [i32::from(k % columns) * side - 80, i32::from(k / columns) * side - 80];
        let points: Vec<_> = (0..columns * rows)
            .map(|k| {
                let [x, y] = at(k);
                // The screen is 320 px by 240 px, and w is 480.
                [3 * x - 480, 480 - 4 * y, 0, 480].map(|c| Scalar::from_bits(c << 16))
            })
            .collect();
        let height = [240, 120, 16, 5][case / 2 % 4];
        // Each triangle shows its front, its back or is left out.
        let mut indices = Vec::new();
        let mut expected = vec![0; points.len()];
        for k in (0..columns * (rows - 1)).filter(|k| k % columns != columns - 1) {
            for [a, b, c] in [[k, k + columns, k + 1], [k + 1, k + columns, k + columns + 1]] {
                let corners = [a, b, c].map(at);
                let is_in = |axis: usize, screen: i32| {
                    corners.iter().any(|at| at[axis] > 0) && corners.iter().any(|at| at[axis] < screen)
                };
                match rng.between(0, 2) {
                    0 => indices.push([a, c, b]),
                    1 => {
                        indices.push([a, b, c]);
                        // In a single strip, triangles beside the screen are shaded too.
                        if height == 240 || is_in(0, 320) && is_in(1, 240) {
                            for k in [a, b, c] {
                                expected[usize::from(k)] = 1;
                            }
                        }
                    }
                    _ => {}
                }
            }
        }
        let indices = indices.concat();
        let mesh = Mesh::new(MeshData { indices: Some(&indices), ..MeshData::new(Positions::Homogeneous(&points)) });
        let (mesh, shader) = (mesh.expect("triangles"), CountsVertices(vec![Cell::new(0); points.len()]));

        let (_, stats) = strips::<Rgb565>(SCREEN, height, 100_000, Rgb565::BLACK, |scene| {
            scene.draw(&mesh, &Projective::IDENTITY, &shader);
        });
        let calls: Vec<_> = shader.0.iter().map(Cell::get).collect();
        assert_eq!(stats.clipped, 0, "seed {seed}, case {case}");
        assert_eq!(calls, expected, "seed {seed}, case {case}: strips of {height} rows");
        shaded += calls.iter().filter(|calls| **calls == 1).count();
        hidden += calls.iter().filter(|calls| **calls == 0).count();
    }
    println!("seed {seed}: {shaded} vertices are shaded, {hidden} are not");
    assert!(shaded > 1000 && hidden > 1000);
}
