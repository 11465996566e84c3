//! Whole frames against three independent renderers: exact from snapped vertices, homogeneous without a clipper, and
//! rays.

use crate::reference::camera::{Camera, Lens};
use crate::reference::exact;
use crate::reference::frame::{Cull as ReferenceCull, Frame};
use crate::reference::homogeneous::{self, Vertex};
use crate::reference::ray;
use crate::reference::rng::Rng;
use crate::reference::snapped::{self, Shading, SnappedVertex};
use crate::scenes;
use crate::scenes::{Draw, polygons, soup, torus};
use crate::support;
use crate::support::{apply, matrix, position, whole};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};
use zstrip::light::{Matte, NORMAL_ONE, Sun};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::Gouraud;
use zstrip::span::{DepthState, Fragment, Shader};
use zstrip::vertex::{DepthRange, Face, VertexRef, VertexShader, Viewport};
use zstrip::{Cull, State};

/// A draw of a scene.
struct Part {
    mesh: &'static Mesh<'static>,
    mvp: Projective,
    cull: Cull,
    /// Ids of its triangles begin behind this one.
    first: u32,
}

fn parts(meshes: &[(&'static Mesh<'static>, Projective)], cull: Cull) -> Vec<Part> {
    let mut first = 0;
    let mut part = |&(mesh, mvp): &(&'static Mesh<'static>, Projective)| {
        let part = Part { mesh, mvp, cull, first };
        first += mesh.triangle_count() as u32;
        part
    };
    meshes.iter().map(&mut part).collect()
}

/// The draws of the scenes of the examples, under their names.
fn scene_parts(name: &str, size: (u16, u16), turn: Angle16) -> Vec<Part> {
    let screen = Size::new(size.0.into(), size.1.into());
    let camera = scenes::camera(screen, Scalar::ONE, Scalar::from_num(12));
    let at = |z: i16| Affine::translation(Vec3::from_ints(0, 0, z));
    let (spin, tilt) = (Affine::rotation_z(turn), Affine::rotation_x(Angle16::from_degrees(-20)));
    match name {
        "torus" => parts(&[(&torus::MESH, camera * scenes::torus_model(turn))], Cull::Back),
        "room" => {
            let room = scenes::room_camera(screen, turn);
            let pillar = Affine::translation(Vec3::from_milli(800, 0, -600));
            let ring = Affine::translation(Vec3::from_milli(-600, -250, -700)) * Affine::rotation_x(turn + turn + turn);
            let half = Affine::scale(Scalar::from_bits(1 << 15));
            let meshes = [
                (&polygons::ROOM, room),
                (&polygons::FLOOR, room),
                (&polygons::PILLAR, room * pillar),
                (&torus::MESH, room * (ring * half)),
            ];
            parts(&meshes, Cull::Back)
        }
        "intersections" => {
            let turned = Affine::rotation_y(turn + Angle16::from_degrees(25));
            let mvp = camera * at(-3) * Affine::rotation_x(Angle16::from_degrees(40)) * turned;
            parts(&[(&polygons::CROSSING, mvp)], Cull::None)
        }
        "cycle" => parts(&[(&polygons::CYCLE, camera * at(-3) * spin)], Cull::Back),
        "slivers" => parts(&[(&soup::SLIVERS, camera * at(-3) * spin)], Cull::None),
        "far" => parts(&[(&soup::FAR, camera * at(-4) * spin)], Cull::None),
        "soup" => parts(&[(&soup::SOUP, camera * Affine::rotation_y(turn))], Cull::None),
        "near" => parts(&[(&soup::NEAR, Projective::from(spin))], Cull::None),
        "field" => {
            let mvp = camera * at(-3) * tilt * spin;
            let meshes = [&polygons::GRID, &polygons::STRIP, &polygons::FAN, &polygons::QUADS].map(|mesh| (mesh, mvp));
            parts(&meshes, Cull::None)
        }
        _ => panic!("no scene {name}"),
    }
}

/// The scenes must be those of the examples.
#[test]
fn parts_are_what_the_examples_draw() {
    let size = (80, 60);
    let turn = Angle16(4321);
    let screen = Size::new(size.0.into(), size.1.into());
    let frame = |drawing: &dyn for<'p> Draw<zstrip::target::FrameSlice<'p, Rgb888>>| {
        whole::<Rgb888>(size, Rgb888::BLACK, |scene| drawing.draw(scene)).1
    };
    for (name, depths) in [
        ("torus", frame(&scenes::Torus::flat(screen, turn))),
        ("room", frame(&scenes::Room::new(screen, turn))),
        ("intersections", frame(&scenes::Intersections::new(screen, turn))),
        ("cycle", frame(&scenes::Cycle::new(screen, turn))),
        ("slivers", frame(&scenes::Slivers::new(screen, turn))),
        ("far", frame(&scenes::Far::new(screen, turn))),
        ("soup", frame(&scenes::Soup::new(screen, turn))),
        ("near", frame(&scenes::Near::new(turn))),
        ("field", frame(&scenes::Field::new(screen, turn))),
    ] {
        let (_, same) = draw_ids(size, &scene_parts(name, size, turn), DepthState::LESS);
        assert_eq!(support::difference(&same, &depths, size.0), None, "{name}");
    }
}

/// Colours pixels with 24-bit ids: `first` + number of the triangle + 1.
struct Ids(u32);

impl VertexShader for Ids {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        self.0 + face.index() as u32 + 1
    }
}

impl Shader<Rgb888> for Ids {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<[u8; 3]> {
        let [_, r, g, b] = fragment.flat.to_be_bytes();
        Some([r, g, b])
    }
}

fn state(part: &Part, depth: DepthState) -> State {
    State { cull: part.cull, depth, ..State::DEFAULT }
}

/// Ids and depths of a frame by the crate.
fn draw_ids(size: (u16, u16), parts: &[Part], depth: DepthState) -> (Vec<u32>, Vec<u16>) {
    let (color, depths, _) = whole::<Rgb888>(size, Rgb888::BLACK, |scene| {
        for part in parts {
            scene.draw_with(state(part, depth), part.mesh, &part.mvp, &Ids(part.first));
        }
    });
    (color.into_iter().map(|[r, g, b]| u32::from_be_bytes([0, r, g, b])).collect(), depths)
}

fn reference_cull(cull: Cull) -> ReferenceCull {
    match cull {
        Cull::Back => ReferenceCull::Back,
        Cull::Front => ReferenceCull::Front,
        Cull::None => ReferenceCull::None,
    }
}

/// Half a step of 8-bit channels in 8.16, which the Gouraud shader adds for rounding.
const HALF: i32 = 1 << 15;

/// The mesh's colours as the Gouraud shader interpolates them.
fn colors(mesh: &Mesh<'_>, index: usize) -> [i32; 3] {
    let color = mesh.data().colors.map_or([255; 3], |c| c[index]);
    color.map(|c| (i32::from(c) << 16) + HALF)
}

/// Triangles on the screen as the crate snaps them, with their ids and sides to drop.
fn snapped_parts(size: (u16, u16), parts: &[Part]) -> Vec<([SnappedVertex; 3], u32, ReferenceCull)> {
    let viewport = Viewport::full(Size::new(size.0.into(), size.1.into())).expect("a viewport");
    let mut triangles = Vec::new();
    for part in parts {
        let all = support::snapped(part.mesh, &part.mvp, &viewport, DepthRange::Clip, |k| colors(part.mesh, k));
        for (corners, number) in all {
            let tri = corners.map(|(v, color)| SnappedVertex {
                position: [v.x, v.y],
                depth: v.z,
                color: color.map(|c| f64::from(c - HALF) / 65_536.0 / 255.0),
            });
            triangles.push((tri, part.first + number as u32 + 1, reference_cull(part.cull)));
        }
    }
    triangles
}

const SNAPPED: [&str; 9] = ["torus", "room", "intersections", "cycle", "slivers", "far", "soup", "near", "field"];

#[test]
fn coverage_is_exact_given_the_snapped_vertices() {
    let size = (120, 90);
    for (name, turn) in SNAPPED.into_iter().flat_map(|name| [(name, Angle16(0)), (name, Angle16(11_111))]) {
        let parts = scene_parts(name, size, turn);
        // Without depth, the last triangle of those that cover a pixel shows.
        let (ids, _) = draw_ids(size, &parts, DepthState::OFF);
        let mut expected = vec![0; ids.len()];
        for (tri, id, cull) in snapped_parts(size, &parts) {
            let position = exact::widen(tri.map(|v| v.position));
            if !cull.drops(exact::area2(position) < 0) {
                exact::for_each_pixel(position, size.0.into(), size.1.into(), |x, y| {
                    expected[y as usize * usize::from(size.0) + x as usize] = id;
                });
            }
        }
        assert_eq!(support::difference(&ids, &expected, size.0), None, "{name} at {turn:?}");
        let drawn = ids.iter().filter(|id| **id != 0).count();
        assert!(drawn * 100 > ids.len(), "{name}: {drawn} pixels");
    }
}

#[test]
fn depth_and_colours_agree_with_the_snapped_reference() {
    let size = (48, 36);
    let (mut worst_depth, mut worst_color) = (0, 0_f64);
    for (name, turn) in SNAPPED.into_iter().map(|name| (name, Angle16(3000))) {
        let parts = scene_parts(name, size, turn);
        let mut frame = Frame::new(size.0.into(), size.1.into(), [0.0; 3]);
        for (tri, id, cull) in snapped_parts(size, &parts) {
            snapped::draw(&mut frame, cull, &tri, Shading::Gouraud, id);
        }
        let (ids, depths) = draw_ids(size, &parts, DepthState::LESS);
        let (picture, ..) = whole::<Rgb888>(size, Rgb888::BLACK, |scene| {
            for part in &parts {
                scene.draw_with(state(part, DepthState::LESS), part.mesh, &part.mvp, &Gouraud::vertex_colors());
            }
        });
        let mut excluded = 0;
        for (i, code) in frame.depth_codes().into_iter().enumerate() {
            // Depths may be off by one step on either side.
            if frame.gap[i] * 65_535.0 < 2.5 {
                excluded += 1;
                continue;
            }
            let case = format!("{name} at {turn:?}, pixel {i} of {size:?}");
            assert_eq!(ids[i], frame.id[i], "{case}");
            let error = depths[i].abs_diff(code);
            assert!(error <= 1, "{case}: depth {} instead of {code}", depths[i]);
            worst_depth = worst_depth.max(error);
            for (found, exact) in picture[i].iter().zip(frame.color[i]) {
                let error = (f64::from(*found) - 255.0 * exact).abs();
                assert!(error <= 1.0, "{case}: colour {:?} instead of {:?}", picture[i], frame.color[i]);
                worst_color = worst_color.max(error);
            }
        }
        println!("{name}: {excluded} of {} pixels left out for a near tie", ids.len());
        assert!(excluded * 50 <= ids.len(), "{name}: {excluded} of {} left out", ids.len());
    }
    println!("worst: depth {worst_depth} step, colours {worst_color:.3} of 255");
}

/// The frame of the crate in the reference's form; the margins are the reference's.
fn as_frame(size: (u16, u16), (ids, depths): (Vec<u32>, Vec<u16>)) -> Frame {
    let mut frame = Frame::new(size.0.into(), size.1.into(), [0.0; 3]);
    frame.depth = depths.into_iter().map(|d| f64::from(d) / 65_535.0).collect();
    frame.id = ids;
    frame
}

/// By 2-D homogeneous rasterization in f64, which needs no clipper.
fn homogeneous_frame(size: (u16, u16), parts: &[Part]) -> Frame {
    let mut frame = Frame::new(size.0.into(), size.1.into(), [0.0; 3]);
    let viewport = homogeneous::Viewport::new(size.0.into(), size.1.into());
    for part in parts {
        let m = matrix(&part.mvp);
        for number in 0..part.mesh.triangle_count() {
            let corners = part.mesh.triangle(number).expect("a triangle").map(usize::from);
            let tri = corners.map(|k| Vertex {
                position: apply(&m, position(&part.mesh.data().positions, k)),
                attributes: colors(part.mesh, k).map(|c| f64::from(c - HALF) / 65_536.0 / 255.0),
            });
            let id = part.first + number as u32 + 1;
            homogeneous::draw(&mut frame, &viewport, reference_cull(part.cull), &tri, id, |s| s.linear);
        }
    }
    frame
}

/// Snapping moves vertices by up to 3/512 px, and with them depth on steep faces; beyond these margins pictures agree.
const MARGIN: f64 = 1.0 / 100.0;
const GAP: f64 = 12.0 / 65_535.0;

#[test]
fn frames_agree_with_homogeneous_rasterization() {
    let size = (64, 48);
    // The share of pixels that lie within the margins, in percent: at most this.
    for (name, share) in [
        ("torus", 2.0),
        ("room", 2.0),
        ("intersections", 1.0),
        ("cycle", 1.0),
        ("slivers", 6.0),
        ("field", 2.0),
        ("near", 2.0),
        ("far", 5.0),
        ("soup", 2.0),
    ] {
        for turn in [Angle16(0), Angle16(5000)] {
            let parts = scene_parts(name, size, turn);
            let frame = as_frame(size, draw_ids(size, &parts, DepthState::LESS));
            let reference = homogeneous_frame(size, &parts);
            let result = reference.compare(&frame, MARGIN, GAP);
            let excluded = 100.0 * result.excluded as f64 / frame.id.len() as f64;
            println!(
                "{name} at {turn:?}: {excluded:.2} % left out, depth within {:.2} steps",
                result.depth_error * 65_535.0
            );
            assert_eq!(result.other_id, 0, "{name} at {turn:?}: {result:?}");
            assert!(excluded <= share, "{name} at {turn:?}: {excluded} % of the pixels are left out");
        }
    }
}

/// Colours where nothing is clipped, so that both interpolate the same plane.
#[test]
fn colours_agree_with_homogeneous_rasterization() {
    let size = (96, 72);
    let mut worst = 0_f64;
    for name in ["cycle", "field", "intersections"] {
        let parts = scene_parts(name, size, Angle16(777));
        let reference = homogeneous_frame(size, &parts);
        let (picture, ..) = whole::<Rgb888>(size, Rgb888::BLACK, |scene| {
            for part in &parts {
                scene.draw_with(state(part, DepthState::LESS), part.mesh, &part.mvp, &Gouraud::vertex_colors());
            }
        });
        for (i, found) in picture.iter().enumerate().filter(|(i, _)| reference.is_clear_cut(*i, MARGIN, GAP)) {
            for (found, exact) in found.iter().zip(reference.color[i]) {
                let error = (f64::from(*found) - 255.0 * exact).abs();
                assert!(error <= 1.0, "{name}, pixel {i}: {found} instead of {}", 255.0 * exact);
                worst = worst.max(error);
            }
        }
    }
    println!("worst colour is off by {worst:.3} of 255");
}

/// The torus lit in f64: what light, normals and interpolation do together.
#[test]
fn lit_torus_agrees_with_light_in_f64() {
    let size = (96, 72);
    let turn = Angle16(9000);
    let model = scenes::torus_model(turn);
    let mvp = scenes::camera(Size::new(size.0.into(), size.1.into()), Scalar::ONE, Scalar::from_num(12)) * model;
    let rows = model.to_rows().map(|row| row.map(|v| f64::from(v) / 65_536.0));
    let to_light = ray::normalize([0.4, 0.7, 0.6]);
    // Into object space: by the transposed rotation.
    let to_light: [f64; 3] = core::array::from_fn(|j| (0..3).map(|i| rows[i][j] * to_light[i]).sum());
    let normals = torus::MESH.data().normals.expect("normals");
    let color = [255.0, 160.0, 64.0];
    let lit = |k: usize| {
        let normal = normals[k].map(|c| f64::from(c) / f64::from(NORMAL_ONE));
        let level = 38.0 / 256.0 + 218.0 / 256.0 * ray::dot(normal, to_light).max(0.0);
        color.map(|c| (c * level).min(255.0))
    };
    let m = matrix(&mvp);
    let viewport = homogeneous::Viewport::new(size.0.into(), size.1.into());
    let mut reference = Frame::new(size.0.into(), size.1.into(), [0.0; 3]);
    for number in 0..torus::MESH.triangle_count() {
        let corners = torus::MESH.triangle(number).expect("a triangle").map(usize::from);
        let tri = corners
            .map(|k| Vertex { position: apply(&m, position(&torus::MESH.data().positions, k)), attributes: lit(k) });
        homogeneous::draw(&mut reference, &viewport, ReferenceCull::Back, &tri, number as u32 + 1, |s| s.linear);
    }
    let gouraud = scenes::Torus::gouraud(Size::new(size.0.into(), size.1.into()), turn);
    let (picture, ..) = whole::<Rgb888>(size, Rgb888::BLACK, |scene| gouraud.draw(scene));
    let (mut worst, mut pixels) = (0_f64, 0);
    for (i, found) in picture.iter().enumerate().filter(|(i, _)| reference.is_clear_cut(*i, MARGIN, GAP)) {
        pixels += usize::from(reference.id[i] != 0);
        for (found, exact) in found.iter().zip(reference.color[i]) {
            worst = worst.max((f64::from(*found) - exact).abs());
        }
    }
    println!("{pixels} pixels, worst colour is off by {worst:.3} of 255");
    assert!(pixels > 1000);
    // One for the interpolation, as promised, and a third for light and its direction in 2.14.
    assert!(worst <= 4.0 / 3.0, "{worst} of 255");
}

/// Clip coordinates of the ray caster's camera in 16.16.
fn clip_of(camera: &Camera, point: [f64; 3]) -> [Scalar; 4] {
    camera.clip_position(point).map(Scalar::from_num)
}

#[test]
fn frames_agree_with_rays() {
    let (width, height) = (64_u16, 48_u16);
    for seed in 0..12 {
        let mut rng = Rng::new(seed);
        let lens = rng.pick(&[Lens::Perspective { tan_half_fov: 0.5 }, Lens::Orthographic { half_height: 2.5 }]);
        let cull = rng.pick(&[Cull::None, Cull::Back, Cull::Front]);
        let mut camera = Camera::look_at([1.0, 2.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0], lens, 64.0 / 48.0);
        (camera.near, camera.far) = (2.0, 9.0);
        let mut coordinate = || rng.unit() * 14.0 - 7.0;
        let triangles: Vec<_> = (1..=9)
            .map(|id| ray::Triangle {
                corners: [(); 3].map(|()| [coordinate(), coordinate(), coordinate()]),
                color: [1.0; 3],
                id,
            })
            .collect();
        let vertices: Vec<_> = triangles.iter().flat_map(|t| t.corners).map(|p| clip_of(&camera, p)).collect();
        let mesh = Mesh::new(MeshData::new(Positions::Homogeneous(&vertices))).expect("a mesh");
        let state = State { cull, ..State::default() };
        let (color, depths, _) = whole::<Rgb888>((width, height), Rgb888::BLACK, |scene| {
            scene.draw_with(state, &mesh, &Projective::IDENTITY, &Ids(0))
        });
        let ids = color.into_iter().map(|[_, _, id]| u32::from(id)).collect();
        let frame = as_frame((width, height), (ids, depths));
        let scene = ray::Scene {
            triangles,
            quadrics: Vec::new(),
            light: ray::Light { ambient: 1.0, diffuse: 0.0, direction: [0.0, 0.0, 1.0] },
            background: [0.0; 3],
            cull: reference_cull(cull),
        };
        let reference = scene.render(&camera, width.into(), height.into());
        let result = reference.compare(&frame, 1.0 / 50.0, 20.0 / 65_535.0);
        println!("seed {seed} {lens:?} {cull:?}: {result:?}");
        assert_eq!(result.other_id, 0, "seed {seed} {lens:?} {cull:?}: {result:?}");
        assert!(result.excluded * 12 < result.compared, "seed {seed} {lens:?} {cull:?}: {result:?}");
    }
}

/// A unit sphere of `around` × `across` quads: its vertices, with their normals, and indices.
fn sphere(around: u16, across: u16) -> (Vec<[f64; 3]>, Vec<u16>) {
    let mut points = Vec::new();
    for (j, i) in (0..=across).flat_map(|j| (0..around).map(move |i| (j, i))) {
        let lat = (f64::from(j) / f64::from(across) - 0.5) * std::f64::consts::PI;
        let lon = f64::from(i) / f64::from(around) * std::f64::consts::TAU;
        points.push([lat.cos() * lon.sin(), lat.sin(), lat.cos() * lon.cos()]);
    }
    let mut indices = Vec::new();
    for (j, i) in (0..across).flat_map(|j| (0..around).map(move |i| (j, i))) {
        let at = |i: u16, j: u16| j * around + i % around;
        indices.extend([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    (points, indices)
}

/// How a mesh of a sphere differs from the sphere: pixels of the silhouette, and mean brightness in 1/255 where both
/// are.
fn sphere_error(around: u16, across: u16) -> (usize, f64) {
    let lens = Lens::Perspective { tan_half_fov: 0.4 };
    let mut camera = Camera::look_at([0.6, 1.2, 3.0], [0.0; 3], [0.0, 1.0, 0.0], lens, 1.0);
    (camera.near, camera.far) = (1.0, 6.0);
    let light =
        ray::Light { ambient: 51.0 / 256.0, diffuse: 205.0 / 256.0, direction: ray::normalize([1.0, 2.0, 2.0]) };
    let scene = ray::Scene {
        triangles: Vec::new(),
        quadrics: vec![ray::Quadric::sphere([0.0; 3], 1.0, [1.0; 3], 1)],
        light,
        background: [0.0; 3],
        cull: ReferenceCull::Back,
    };
    let reference = scene.render(&camera, 128, 128);

    let (points, indices) = sphere(around, across);
    let vertices: Vec<_> = points.iter().map(|p| clip_of(&camera, *p)).collect();
    let normals: Vec<_> = points.iter().map(|p| p.map(|c| (c * f64::from(NORMAL_ONE)).round() as i16)).collect();
    let mesh = Mesh::new(MeshData {
        topology: Topology::Quads,
        indices: Some(&indices),
        normals: Some(&normals),
        ..MeshData::new(Positions::Homogeneous(&vertices))
    })
    .expect("a mesh");
    let grey = |level: u8| Rgb888::new(level, level, level);
    let shader =
        Gouraud::new(Sun::new(Vec3::from_ints(1, 2, 2), grey(204), grey(51)).on(&Matte::WHITE, &Affine::IDENTITY));
    let (picture, depths, _) =
        whole::<Rgb888>((128, 128), Rgb888::BLACK, |scene| scene.draw(&mesh, &Projective::IDENTITY, &shader));
    let (mut silhouette, mut sum, mut both) = (0, 0.0, 0);
    for i in 0..picture.len() {
        let (mesh, sphere) = (depths[i] != u16::MAX, reference.id[i] != 0);
        silhouette += usize::from(mesh != sphere);
        if mesh && sphere {
            both += 1;
            sum += (f64::from(picture[i][0]) - 255.0 * reference.color[i][0]).abs();
        }
    }
    assert!(both > 5000, "{both} pixels");
    (silhouette, sum / f64::from(both))
}

#[test]
fn sphere_meshes_converge_to_the_quadric() {
    let errors = [(8, 6), (16, 12), (32, 24), (64, 48)].map(|(around, across)| sphere_error(around, across));
    println!("silhouette px and mean brightness error in 1/255 by refinement: {errors:?}");
    for pair in errors.windows(2) {
        assert!(pair[1].0 < pair[0].0 && pair[1].1 < pair[0].1, "{errors:?}");
    }
    let (silhouette, shade) = errors[3];
    assert!(silhouette <= 30, "{silhouette} px of the silhouette differ");
    assert!(shade <= 0.6, "mean brightness is off by {shade} of 255, half a step of which is rounding");
}
