//! The clipper's rules, depth ranges, culling by winding, depth functions, and input that is legal but unpleasant.

use crate::reference::conformance::Rasterizer;
use crate::reference::homogeneous::{self, Vertex, for_each_sample};
use crate::reference::rng::Rng;
use crate::reference::scenes::{ClipKind, clip_triangle as random_triangle};
use crate::reference::subject::Subject;
use crate::support::{Soup, angle, strips, vector, whole};
use std::collections::BTreeSet;
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888, RgbColor, WebColors};
use zstrip::internals::{ClipVertex, Outcode, clip_triangle};
use zstrip::light::{Material, Matte, Sun};
use zstrip::math::{Affine, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::{Flat, Gouraud};
use zstrip::span::{Compare, DepthState};
use zstrip::vertex::{DepthRange, Viewport};
use zstrip::{Cull, State, Winding};

const RANGES: [DepthRange; 3] = [DepthRange::Clip, DepthRange::ClampFar, DepthRange::Clamp];
const COMPARES: [Compare; 8] = [
    Compare::Never,
    Compare::Less,
    Compare::Equal,
    Compare::LessEqual,
    Compare::Greater,
    Compare::NotEqual,
    Compare::GreaterEqual,
    Compare::Always,
];
const NO_CULLING: State = State { cull: Cull::None, ..State::DEFAULT };

/// In the scale of the vertex transform.
fn scaled([x, y, z, w]: [i32; 4]) -> ClipVertex {
    let [x, y, z, w] = [x, y, z, w].map(|c| i64::from(c) << 24);
    ClipVertex { x, y, z, w }
}

/// Varyings that tell how much of each corner a vertex has.
const CORNERS: [[i32; 3]; 3] = [[1 << 30, 0, 0], [0, 1 << 30, 0], [0, 0, 1 << 30]];

type Polygon = Vec<(ClipVertex, [i32; 3])>;

fn clipped(triangle: &[(ClipVertex, [i32; 3]); 3], range: DepthRange) -> Vec<Polygon> {
    let codes = triangle.iter().fold(0, |codes, (v, _)| codes | Outcode::of(v).0);
    let mut polygons = Vec::new();
    for part in [zstrip::internals::DepthSlab::Inside].into_iter().chain(range.clamped_slabs(Outcode(codes))) {
        let mut polygon = Vec::new();
        clip_triangle(triangle.map(|v| v.0), Outcode(codes), part, |corner| {
            polygon.push((corner.vertex, corner.weights))
        });
        if !polygon.is_empty() {
            polygons.push(polygon);
        }
    }
    polygons
}

fn labelled(triangle: [[i32; 4]; 3]) -> [(ClipVertex, [i32; 3]); 3] {
    [0, 1, 2].map(|k| (scaled(triangle[k]), CORNERS[k]))
}

#[test]
fn visible_vertices_pass_bit_exact() {
    let mut visible = 0;
    for seed in 0..400 {
        let mut rng = Rng::new(seed);
        for (kind, range) in ClipKind::ALL.into_iter().flat_map(|kind| RANGES.map(|range| (kind, range))) {
            let triangle = labelled(random_triangle(&mut rng, kind));
            if triangle.iter().any(|(v, _)| *v == ClipVertex::default()) {
                continue;
            }
            let polygons = clipped(&triangle, range);
            for vertex in triangle.iter().filter(|(v, _)| Outcode::of(v).0 == 0) {
                visible += 1;
                let found = polygons.iter().flatten().any(|v| v == vertex);
                assert!(found, "seed {seed} {kind:?} {range:?}: {vertex:?} is missing from {polygons:?}");
            }
        }
    }
    assert!(visible > 5000);
}

#[test]
fn clipped_vertices_lie_inside_of_all_planes() {
    for seed in 0..400 {
        let mut rng = Rng::new(seed);
        for (kind, range) in ClipKind::ALL.into_iter().flat_map(|kind| RANGES.map(|range| (kind, range))) {
            let triangle = labelled(random_triangle(&mut rng, kind));
            for (v, varyings) in clipped(&triangle, range).iter().flatten() {
                let case = format!("seed {seed} {kind:?} {range:?}: {v:?}");
                assert!(v.w > 0 && v.z >= 0 && v.z <= v.w, "{case}");
                // Each later cut rounds w by a unit, and so the guard band by 64.
                let band = 64 * i128::from(v.w) + 256;
                assert!(i128::from(v.x).abs() <= band && i128::from(v.y).abs() <= band, "{case}");
                assert!(varyings.iter().all(|k| (0..=1 << 30).contains(k)), "{case}: {varyings:?}");
            }
        }
    }
}

/// The vertices on the edge from corner 0 to corner 1, with their parts of the two.
fn on_edge(polygons: &[Polygon], corners: [usize; 2]) -> BTreeSet<[i64; 6]> {
    let on = polygons.iter().flatten().filter(|(_, part)| {
        let other = 3 - corners[0] - corners[1];
        part[other] == 0
    });
    on.map(|(v, part)| [v.x, v.y, v.z, v.w, part[corners[0]].into(), part[corners[1]].into()]).collect()
}

#[test]
fn edge_is_cut_alike_in_both_directions_and_in_both_triangles() {
    let mut cuts = 0;
    for seed in 0..600 {
        let mut rng = Rng::new(seed);
        for kind in [ClipKind::CrossingNear, ClipKind::CrossingFar, ClipKind::Huge, ClipKind::ZeroW] {
            let [a, b, c] = random_triangle(&mut rng, kind);
            let [d, ..] = random_triangle(&mut rng, ClipKind::Visible);
            let range = rng.pick(&RANGES);
            let there = on_edge(&clipped(&labelled([a, b, c]), range), [0, 1]);
            // The same triangle with its corners in another order, and a neighbour.
            for (other, edge) in [([b, a, c], [1, 0]), ([c, b, a], [2, 1]), ([b, c, a], [2, 0])] {
                let back = on_edge(&clipped(&labelled(other), range), edge);
                assert_eq!(there, back, "seed {seed} {kind:?} {range:?}: {a:?} {b:?} {c:?} as {other:?}");
            }
            if range == DepthRange::Clip {
                let neighbour = on_edge(&clipped(&labelled([b, a, d]), range), [1, 0]);
                assert_eq!(there, neighbour, "seed {seed} {kind:?}: {a:?} {b:?}, beside {c:?} and {d:?}");
            }
            cuts += there.len();
        }
    }
    println!("{cuts} vertices on shared edges");
    assert!(cuts > 2000);
}

/// The near plane cuts at x = -66.7 w and -66 w, which the guard band at -64 w then takes away; so no vertex at z = 0
/// is left. With less to the left, the near plane alone cuts.
#[test]
fn planes_come_in_one_order() {
    let one = 1 << 16;
    for (left, at_near, at_band) in [(-200, 0, 2), (-100, 2, 0)] {
        let triangle = labelled([[0, 0, one / 2, one], [one, one, one / 2, one], [left * one, one, -one, one]]);
        let polygons = clipped(&triangle, DepthRange::Clip);
        let [polygon] = &polygons[..] else { panic!("{polygons:?}") };
        let near = polygon.iter().filter(|(v, _)| v.z == 0).count();
        let band = polygon.iter().filter(|(v, _)| v.x < -63 * v.w).count();
        assert_eq!((near, band, polygon.len()), (at_near, at_band, 4), "{polygon:?}");
    }
}

/// Two triangles of a parallelogram in space, which any plane may cut: no pixel twice, none left out.
#[test]
fn shared_edge_of_clipped_triangles_has_no_crack_and_no_overlap() {
    let viewport = homogeneous::Viewport { clip_y_down: true, ..homogeneous::Viewport::new(64, 64) };
    let (mut pixels, mut clipped) = (0, 0);
    for seed in 0..250 {
        let mut rng = Rng::new(seed);
        let kind = rng.pick(&[
            ClipKind::CrossingNear,
            ClipKind::CrossingFar,
            ClipKind::ZeroW,
            ClipKind::Visible,
            ClipKind::Huge,
        ]);
        let [a, b, c] = random_triangle(&mut rng, kind).map(|v| v.map(|c| c / 4));
        let d: [i32; 4] = core::array::from_fn(|k| a[k] + b[k] - c[k]);
        let mut hits = vec![0; 64 * 64];
        let mut subject = Subject { strip_rows: 16, records: 300 };
        subject.clip_triangles(64, 64, &[[a, b, c], [b, a, d]], &mut |_, x, y| hits[(64 * y + x) as usize] += 1);
        let twice = hits.iter().filter(|n| **n > 1).count();
        assert_eq!(twice, 0, "seed {seed} {kind:?}: {a:?} {b:?} {c:?} {d:?} overlap");
        // Inside by a margin, of the parallelogram cut along one diagonal or the other.
        for tri in [[a, b, c], [b, a, d], [c, d, a], [d, c, b]] {
            let tri = tri.map(|v| Vertex { position: v.map(f64::from), attributes: [] });
            for_each_sample(&viewport, (64, 64), &tri, |s| {
                if s.covered && s.margin > 1.0 / 64.0 {
                    pixels += 1;
                    let count = hits[(64 * s.y + s.x) as usize];
                    assert_eq!(count, 1, "seed {seed} {kind:?}: {a:?} {b:?} {c:?} {d:?}, pixel ({}, {})", s.x, s.y);
                }
            });
        }
        clipped += usize::from(kind != ClipKind::Visible);
    }
    println!("{pixels} samples, {clipped} pairs clipped");
    assert!(pixels > 50_000);
}

/// Coverage and depth, clamped pixel by pixel, of a triangle by homogeneous rasterization.
fn clamped_reference(
    triangle: &[[Scalar; 4]; 3],
    size: (u16, u16),
    range: DepthRange,
    mut visit: impl FnMut(usize, bool, f64, f64),
) {
    let position = triangle.map(|v| v.map(|c| c.to_num::<f64>()));
    let tri = position.map(|[x, y, z, w]| Vertex {
        // A z that no plane cuts where none should: far is a long way off, or near and far are both.
        position: match range {
            DepthRange::Clip => [x, y, z, w],
            DepthRange::ClampFar => [x, y, z * 1e-7, w],
            DepthRange::Clamp => [x, y, w / 2.0, w],
        },
        attributes: [z],
    });
    let viewport = homogeneous::Viewport::new(size.0.into(), size.1.into());
    for_each_sample(&viewport, (size.0.into(), size.1.into()), &tri, |s| {
        let depth = s.perspective[0] * s.inv_w;
        visit(s.y as usize * usize::from(size.0) + s.x as usize, s.covered, s.margin, depth);
    });
}

#[test]
fn depth_is_cut_or_clamped_pixel_by_pixel() {
    let size = (48, 32);
    let state = |range| State { depth: DepthState { compare: Compare::Always, write: true }, range, ..NO_CULLING };
    let mut counts = [[0_usize; 3]; 3];
    for seed in 0..300 {
        let mut rng = Rng::new(seed);
        let kind = rng.pick(&[ClipKind::CrossingNear, ClipKind::CrossingFar, ClipKind::Huge, ClipKind::Visible]);
        let triangle = random_triangle(&mut rng, kind).map(|v| v.map(Scalar::from_bits));
        let mesh = Mesh::new(MeshData::new(Positions::Homogeneous(&triangle))).expect("a triangle");
        for (k, range) in RANGES.into_iter().enumerate() {
            let (picture, depths, _) = whole::<Rgb888>(size, Rgb888::BLACK, |scene| {
                scene.draw_with(state(range), &mesh, &Projective::IDENTITY, &Flat::unlit(Rgb888::WHITE))
            });
            let mut samples = vec![None; depths.len()];
            clamped_reference(&triangle, size, range, |i, covered, margin, depth| {
                samples[i] = Some((covered, margin, depth))
            });
            for (i, sample) in samples.iter().enumerate() {
                let case = format!("seed {seed} {kind:?} {range:?}: {triangle:?}, pixel {i}: {sample:?}");
                let drawn = picture[i] != [0; 3];
                let Some((covered, margin, depth)) = *sample else {
                    assert!(!drawn, "{case}");
                    continue;
                };
                if margin < 1.0 / 50.0 {
                    continue;
                }
                assert_eq!(drawn, covered, "{case}");
                if !covered {
                    continue;
                }
                // Snapping moves a steep plane by its change over 1/64 px; clamped parts are flat.
                let beside = [i.wrapping_sub(1), i + 1, i.wrapping_sub(48), i + 48];
                let step =
                    beside.iter().filter_map(|&n| samples.get(n).copied().flatten()).map(|s| (s.2 - depth).abs());
                let slack = 2.0 / 65_535.0 + step.fold(0.0, f64::max) / 32.0;
                let error = (f64::from(depths[i]) / 65_535.0 - depth.clamp(0.0, 1.0)).abs();
                assert!(error <= slack, "{case}: {} is off by {error}, more than {slack}", depths[i]);
                counts[k][usize::from(depth >= 0.0) + usize::from(depth > 1.0)] += 1;
                if depth > 1.0 + slack {
                    assert_eq!(depths[i], 65_535, "{case}");
                }
                if depth < -slack {
                    assert_eq!(depths[i], 0, "{case}");
                }
            }
        }
    }
    println!("pixels before near, between, beyond far, for {RANGES:?}: {counts:?}");
    assert!(counts[2].iter().all(|n| *n > 2000) && counts[1][2] > 2000 && counts[0][1] > 2000);
}

/// Everything that a draw can be told, on triangles of every kind.
#[test]
fn no_input_panics_in_any_state() {
    let sun = Sun::new(Vec3::from_ints(1, 2, 3), Rgb888::WHITE, Rgb888::CSS_GRAY);
    let light = sun.on(&Matte::WHITE.vertex_colors(), &Affine::IDENTITY);
    let mut drawn = 0;
    for seed in 0..300_u64 {
        let mut rng = Rng::new(seed);
        let soup = Soup::new(&mut rng, 12);
        let mesh = soup.mesh();
        let state = State {
            cull: rng.pick(&[Cull::Back, Cull::Front, Cull::None]),
            depth: DepthState { compare: COMPARES[seed as usize % 8], write: seed / 8 % 2 == 0 },
            range: RANGES[seed as usize % 3],
            front: rng.pick(&[Winding::CounterClockwise, Winding::Clockwise]),
            ..State::DEFAULT
        };
        let stats = strips::<Rgb565>(
            (20, 15),
            rng.between(1, 15) as usize,
            rng.pick(&[0, 200, 2000]),
            Rgb565::BLACK,
            |scene| {
                scene.draw_with(state, &mesh, &Projective::IDENTITY, &Flat::new(light));
                scene.draw_with(state, &mesh, &Projective::IDENTITY, &Gouraud::new(light));
                scene.draw_with(state, &mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
            },
        )
        .1;
        drawn += stats.drawn;
    }
    assert!(drawn > 1000);
}

/// A 16.16 number of any magnitude, often the largest or smallest.
fn extreme(rng: &mut Rng) -> Scalar {
    Scalar::from_bits(match rng.below(3) {
        0 => rng.pick(&[i32::MIN, i32::MIN + 1, i32::MAX, 0, 1, -1]),
        _ => rng.any_magnitude(31),
    })
}

fn extreme_matrix(rng: &mut Rng) -> Projective {
    Projective::from_rows([(); 4].map(|()| {
        [(); 4].map(|()| match rng.below(3) {
            0 => rng.pick(&[i64::MIN, i64::MAX, 0, 1, -1, 1 << 32, -(1 << 32)]),
            1 => i64::from(rng.any_magnitude(31)) << rng.below(33),
            _ => rng.next_u64() as i64 >> rng.below(64),
        })
    }))
}

/// Positions of every format at the ends of their range, through matrices of any magnitude, lit by any normal.
#[test]
fn extreme_positions_and_matrices_never_panic() {
    for seed in 0..500 {
        let mut rng = Rng::new(seed);
        let exact: Vec<_> =
            (0..9).map(|_| Vec3::new(extreme(&mut rng), extreme(&mut rng), extreme(&mut rng))).collect();
        let fractions: Vec<_> =
            (0..9).map(|_| [(); 3].map(|()| rng.pick(&[i16::MIN, i16::MAX, 0, 1, -1, 12_345]))).collect();
        let homogeneous: Vec<_> = (0..9).map(|_| [(); 4].map(|()| extreme(&mut rng))).collect();
        let normals: Vec<_> =
            (0..9).map(|_| [(); 3].map(|()| rng.pick(&[i16::MIN, i16::MAX, 0, 16_384, -16_384]))).collect();
        let scale = Scalar::from_bits(rng.pick(&[1, 1 << 16, i32::MAX]));
        let offset = Vec3::new(extreme(&mut rng), extreme(&mut rng), extreme(&mut rng));
        let mvp = if rng.one_in(3) { Projective::IDENTITY } else { extreme_matrix(&mut rng) };
        let light = Sun::new(vector(&mut rng, 9.0), Rgb888::WHITE, Rgb888::WHITE)
            .on(&Material::matte(Rgb888::CSS_CORAL), &Affine::rotation_x(angle(&mut rng)));
        let corner = [(); 2].map(|()| rng.pick(&[-8192_i16, 8192, 0, 3]));
        let size = [(); 2].map(|()| rng.pick(&[1_u16, 4096, 20]));
        let viewport =
            Viewport::new(Point::new(corner[0].into(), corner[1].into()), Size::new(size[0].into(), size[1].into()))
                .expect("a viewport");
        for positions in [
            Positions::Exact(&exact),
            Positions::Homogeneous(&homogeneous),
            Positions::Quantized { points: &fractions, scale, offset },
        ] {
            for topology in [Topology::Triangles, Topology::Strip, Topology::Fan] {
                let mesh = Mesh::new(MeshData { topology, normals: Some(&normals), ..MeshData::new(positions) });
                let mesh = mesh.unwrap_or_else(|error| panic!("seed {seed}: {error}"));
                strips::<Gray8>((20, 15), 6, rng.pick(&[0, 500]), Gray8::new(0), |scene| {
                    scene.set_viewport(viewport);
                    scene.draw_with(NO_CULLING, &mesh, &mvp, &Flat::new(light));
                    scene.draw_with(NO_CULLING, &mesh, &mvp, &Gouraud::new(light));
                    let _ = scene.is_visible(mesh.bounds(), &mvp);
                });
            }
        }
    }
}

/// A mesh of triangles whose corners are at w = 1 and depth code `z`, in pixels of a 16 × 16 screen.
fn flat_triangles(corners: &[[i32; 2]], z: u16) -> Vec<[Scalar; 4]> {
    let clip = |c: i32| Scalar::from_bits((c - 8) * 8192);
    let z = Scalar::from_bits(((i64::from(z) * 65_536 + 32_767) / 65_535) as i32);
    corners.iter().map(|&[x, y]| [clip(x), -clip(y), z, Scalar::ONE]).collect()
}

#[test]
fn degenerate_and_tiny_triangles_are_counted() {
    let point = [5, 5];
    let vertices = flat_triangles(
        &[point, point, point, [1, 1], [4, 4], [9, 9], [2, 2], [2, 2], [7, 3], [0, 0], [0, 8], [8, 0]],
        100,
    );
    // And one that lies between pixel centres.
    let mut vertices = vertices;
    vertices.extend(
        [[0, 0], [512, 0], [0, 512]]
            .map(|[x, y]| [Scalar::from_bits(x), Scalar::from_bits(y), Scalar::ZERO, Scalar::ONE]),
    );
    let mesh = Mesh::new(MeshData::new(Positions::Homogeneous(&vertices))).expect("a mesh");
    let (picture, _, stats) = whole::<Gray8>((16, 16), Gray8::new(0), |scene| {
        scene.draw_with(NO_CULLING, &mesh, &Projective::IDENTITY, &Flat::unlit(Rgb888::WHITE))
    });
    assert_eq!((stats.triangles, stats.degenerate, stats.empty, stats.drawn), (5, 3, 1, 1), "{stats:?}");
    // Half of 8 × 8 pixels; the centres on the hypotenuse are on a right edge.
    assert_eq!(picture.iter().filter(|p| **p == 255).count(), 28);
}

/// Layers that cover the screen, drawn in order: the model is one pixel.
#[test]
fn depth_functions_and_write_mask_work_as_the_model_does() {
    let passes = |compare: Compare, new: u16, old: u16| match compare {
        Compare::Never => false,
        Compare::Less => new < old,
        Compare::Equal => new == old,
        Compare::LessEqual => new <= old,
        Compare::Greater => new > old,
        Compare::NotEqual => new != old,
        Compare::GreaterEqual => new >= old,
        Compare::Always => true,
    };
    for seed in 0..400 {
        let mut rng = Rng::new(seed);
        let layers: Vec<_> = (1..=8_u8)
            .map(|grey| {
                let z = rng.pick(&[0_u16, 1, 2, 30_000, 30_001, 65_534, 65_535]);
                let depth = DepthState { compare: rng.pick(&COMPARES), write: rng.one_in(2) };
                (grey, z, depth, flat_triangles(&[[-40, -40], [160, -40], [-40, 160]], z))
            })
            .collect();
        let (mut color, mut stored) = (0, u16::MAX);
        for &(grey, z, depth, _) in &layers {
            if passes(depth.compare, z, stored) {
                color = grey;
                stored = if depth.write { z } else { stored };
            }
        }
        let (picture, depths, _) = whole::<Rgb888>((16, 16), Rgb888::BLACK, |scene| {
            for (grey, _, depth, vertices) in &layers {
                let mesh = Mesh::new(MeshData::new(Positions::Homogeneous(vertices))).expect("a triangle");
                let state = State { depth: *depth, ..NO_CULLING };
                scene.draw_with(state, &mesh, &Projective::IDENTITY, &Flat::unlit(Rgb888::new(*grey, 0, 0)));
            }
        });
        let layers: Vec<_> = layers.iter().map(|l| (l.0, l.1, l.2)).collect();
        assert!(picture.iter().all(|p| p[0] == color), "seed {seed}: {layers:?} give {:?}, not {color}", picture[0]);
        assert!(depths.iter().all(|d| *d == stored), "seed {seed}: {layers:?} leave {}, not {stored}", depths[0]);
    }
}

#[test]
fn culling_goes_by_winding_on_the_screen() {
    // Counter-clockwise with y up: a front face.
    let front = flat_triangles(&[[2, 14], [14, 14], [8, 2]], 5);
    let back = [front[0], front[2], front[1]];
    for (cull, vertices, shows) in [
        (Cull::Back, &front[..], true),
        (Cull::Front, &front, false),
        (Cull::None, &front, true),
        (Cull::Back, &back, false),
        (Cull::Front, &back, true),
        (Cull::None, &back, true),
    ] {
        let mesh = Mesh::new(MeshData::new(Positions::Homogeneous(vertices))).expect("a triangle");
        for winding in [Winding::CounterClockwise, Winding::Clockwise] {
            // The other winding turns faces round, which matters unless both sides show.
            let shows = shows != (winding == Winding::Clockwise && cull != Cull::None);
            let state = State { cull, front: winding, ..NO_CULLING };
            let (picture, _, stats) = whole::<Gray8>((16, 16), Gray8::new(0), |scene| {
                scene.draw_with(state, &mesh, &Projective::IDENTITY, &Flat::unlit(Rgb888::WHITE))
            });
            assert_eq!(picture[8 * 16 + 8] == 255, shows, "{cull:?} {winding:?}");
            let counts = (u32::from(!shows), u32::from(shows));
            assert_eq!((stats.back_facing, stats.drawn), counts, "{cull:?} {winding:?}");
        }
    }
}

/// A strip turns every other triangle round; all of them face the same way.
#[test]
fn strips_fans_and_quads_keep_their_facing() {
    let corners = flat_triangles(&[[2, 14], [14, 14], [2, 2], [14, 2]], 5);
    let around = [corners[0], corners[1], corners[3], corners[2]];
    for (topology, vertices) in [(Topology::Strip, &corners[..]), (Topology::Fan, &around), (Topology::Quads, &around)]
    {
        let mesh =
            Mesh::new(MeshData { topology, ..MeshData::new(Positions::Homogeneous(vertices)) }).expect("a square");
        let (picture, _, stats) = whole::<Gray8>((16, 16), Gray8::new(0), |scene| {
            scene.draw(&mesh, &Projective::IDENTITY, &Flat::unlit(Rgb888::WHITE))
        });
        assert_eq!((stats.triangles, stats.drawn, stats.back_facing), (2, 2, 0), "{topology:?}");
        assert_eq!(picture.iter().filter(|p| **p == 255).count(), 144, "{topology:?}");
    }
}
