//! Hidden draws are left out: the picture is the same as without, whatever is drawn by which state, in any strips, with
//! records of any number; and a scene that is hidden takes hardly any work.

use crate::reference::rng::Rng;
use crate::scenes;
use crate::scenes::street::Street;
use crate::scenes::{Draw, Room, Torus, dashboard, labels, light, overlay, polygons, textured, torus, water, wires};
use crate::support::{difference, scalar, vector};
use std::cell::Cell;
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::frame::{Renderer, RendererError};
use zstrip::math::{Affine, Angle16, Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{Bounds, BoundsNode, LineTopology, Lines, Mesh, MeshData, Points, Positions, Vertices};
use zstrip::shader::{Flat, Gouraud};
use zstrip::span::{Compare, DepthBias, DepthState};
use zstrip::target::{
    DepthChoice, RecordsChoice, Stats, Strip, WithCarriedState, WithDepth, WithOcclusion, WithRecords, WithoutRecords,
    occlusion_len,
};
use zstrip::texture::Bilinear;
use zstrip::vertex::{DepthRange, DepthScale, Viewport};
use zstrip::{Cull, Framebuffer, Scene, ScreenPoint, State, Thin};

const SIZE: Size = Size::new(200, 150);
const PIXELS: usize = 200 * 150;
const AMPLE: usize = 60_000;

/// Draws a scene into strips of a renderer with any depth and any records.
trait Draws:
    for<'p> Draw<Strip<'p, Rgb565, WithDepth, WithoutRecords>>
    + for<'p> Draw<Strip<'p, Rgb565, WithDepth, WithRecords>>
    + for<'p> Draw<Strip<'p, Rgb565, WithOcclusion, WithRecords>>
    + for<'p> Draw<Strip<'p, Rgb565, WithOcclusion, WithoutRecords>>
    + for<'p> Draw<Strip<'p, Rgb565, WithOcclusion, WithCarriedState>>
{
}

impl<T> Draws for T where
    T: for<'p> Draw<Strip<'p, Rgb565, WithDepth, WithoutRecords>>
        + for<'p> Draw<Strip<'p, Rgb565, WithDepth, WithRecords>>
        + for<'p> Draw<Strip<'p, Rgb565, WithOcclusion, WithRecords>>
        + for<'p> Draw<Strip<'p, Rgb565, WithOcclusion, WithoutRecords>>
        + for<'p> Draw<Strip<'p, Rgb565, WithOcclusion, WithCarriedState>>
{
}

/// Draws a frame in strips as high as `color`.
fn frame<D: DepthChoice, R: RecordsChoice>(
    mut renderer: Renderer<'_, Rgb565, D, R>,
    color: &mut [u16],
    drawing: &(impl for<'p> Draw<Strip<'p, Rgb565, D, R>> + ?Sized),
) -> (Vec<u16>, Stats) {
    let (mut frame, mut picture) = (renderer.begin(scenes::BACKGROUND), vec![]);
    while let Some(strip) = frame.next_strip(color, |scene| drawing.draw(scene)).expect("the same scene each time") {
        picture.extend_from_slice(strip.pixels());
    }
    (picture, frame.stats())
}

fn renderer(depth: &mut [u16]) -> Renderer<'_, Rgb565, WithDepth> {
    Renderer::new(SIZE).and_then(|renderer| renderer.with_depth(depth)).expect("a renderer")
}

fn occluding(depth: &mut [u16]) -> Renderer<'_, Rgb565, WithOcclusion> {
    renderer(depth).with_occlusion().expect("a renderer")
}

/// Draws a scene without occlusion, and with it in strips of these heights with records of these sizes. Returns the
/// number of draws that were left out with records, and without.
fn same(name: &str, drawing: &dyn Draws, heights: &[usize], capacities: &[usize]) -> [u32; 2] {
    let mut color = vec![0; PIXELS];
    let mut depth = vec![0x1234; PIXELS + occlusion_len(200, 150)];
    let (expected, plain) = frame::<_, WithoutRecords>(renderer(&mut depth), &mut color, drawing);
    assert_eq!(plain.strips, 1, "{name}: {plain:?}");
    // Draws that are out of view in the same strips, with the same records.
    let out_of_view = |rows: usize, records: Option<usize>| {
        let (mut color, mut depth) = (vec![0; 200 * rows], vec![0x1234; 200 * rows]);
        match records {
            None => frame(renderer(&mut depth), &mut color, drawing).1.culled,
            Some(words) => frame(renderer(&mut depth).with_records(&mut vec![0; words]), &mut color, drawing).1.culled,
        }
    };
    let mut left_out = [0; 2];
    for rows in heights {
        let (color, depth) = (&mut color[..200 * rows], &mut depth[..200 * rows + occlusion_len(200, *rows)]);
        let (picture, stats) = frame(occluding(depth), color, drawing);
        let found = difference(&picture, &expected, 200);
        assert_eq!(found, None, "{name}: strips of {rows} rows");
        assert_eq!(stats.strips as usize, 150_usize.div_ceil(*rows), "{name}");
        left_out[1] += stats.culled - out_of_view(*rows, None);
        for capacity in capacities {
            let mut records = vec![0xDEAD_BEEF; *capacity];
            let (picture, stats) = frame(occluding(depth).with_records(&mut records), color, drawing);
            let found = difference(&picture, &expected, 200);
            assert_eq!(found, None, "{name}: strips of {rows} rows, {capacity} records");
            left_out[usize::from(stats.direct_strips > 0)] += stats.culled - out_of_view(*rows, Some(*capacity));
            let carrying = occluding(depth).with_records(&mut records).with_carried_state();
            let (picture, _) = frame(carrying, color, drawing);
            let found = difference(&picture, &expected, 200);
            assert_eq!(found, None, "{name}: strips of {rows} rows, {capacity} records, carried state");
        }
    }
    left_out
}

#[test]
fn every_scene_is_the_same() {
    let turn = Angle16(7777);
    let drawings: [(&str, Box<dyn Draws>); 16] = [
        ("torus", Box::new(Torus::gouraud(SIZE, turn))),
        ("room", Box::new(Room::new(SIZE, turn))),
        ("soup", Box::new(scenes::Soup::new(SIZE, turn))),
        ("far", Box::new(scenes::Far::new(SIZE, turn))),
        ("near", Box::new(scenes::Near::new(turn))),
        ("field", Box::new(scenes::Field::new(SIZE, turn))),
        ("wires", Box::new(wires::Wires::new(SIZE, turn))),
        ("crates", Box::new(textured::Crates::new(SIZE, turn, Bilinear, textured::Levels::All))),
        ("close", Box::new(textured::Close::new(SIZE, turn))),
        ("water", Box::new(water::Sea::new(SIZE, turn, 1))),
        ("overlay", Box::new(overlay::Markers::new(SIZE, turn))),
        ("dashboard", Box::new(dashboard::Dashboard::new(turn))),
        ("labels", Box::new(labels::Labels::new(SIZE, turn))),
        ("fog", Box::new(light::Fog::new(SIZE, turn, light::Mist::Squared))),
        ("glass", Box::new(light::Glass::new(SIZE, turn))),
        ("street", Box::new(Street::open(SIZE, turn))),
    ];
    for (name, drawing) in drawings {
        same(name, &*drawing, &[7, 16, 50], &[300, AMPLE]);
    }
}

/// A draw of a random scene.
struct Item {
    kind: u64,
    mesh: usize,
    mvp: Projective,
    state: State,
    color: Rgb888,
    place: [i32; 4],
}

/// A random scene: a wall or two, things around it, and whatever writes depths.
struct Heap<'m> {
    meshes: &'m [Mesh<'m>],
    points: &'m [Vec3],
    viewport: Viewport,
    items: Vec<Item>,
    /// Objects that were found to be hidden.
    hidden: &'m Cell<u32>,
}

impl<F: Framebuffer<Format = Rgb565>> Draw<F> for Heap<'_> {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        scene.set_viewport(self.viewport);
        for Item { kind, mesh, mvp, state, color, place: [x, y, z, size] } in &self.items {
            let (mesh, shader, rows) = (&self.meshes[*mesh], &Flat::unlit(*color), *y..*y + *size);
            match kind {
                0 => {
                    let lines = Lines::new(Vertices::new(Positions::Exact(self.points)), LineTopology::Strip, None);
                    scene.draw_lines_with(*state, &lines.expect("lines"), mvp, shader, &Thin);
                }
                1 => {
                    let points = Points::new(Vertices::new(Positions::Exact(self.points))).expect("points");
                    scene.draw_points_with(*state, &points, mvp, shader, Pixels::from_num(5));
                }
                2 => {
                    let corner = |x, y| (ScreenPoint::corner(x as i16, y as i16), []);
                    let corners = [corner(*x, *y), corner(x + size, *y), corner(x + size, y + size)];
                    scene.canvas_with(*z as u16, state.depth).polygon_with(&corners, shader, 0);
                }
                3 => {
                    let area = Rectangle::new(Point::new(*x, rows.start), Size::new_equal(*size as u32));
                    let mut overlay = scene.at_depth_with(*z as u16, state.depth);
                    use zstrip::embedded_graphics_core::draw_target::DrawTarget;
                    overlay.fill_solid(&area, Rgb565::new(*x as u8 & 31, 9, 9)).expect("no error");
                }
                4 | 5 => {
                    if scene.is_visible_with(*state, mesh.bounds(), mvp) {
                        scene.draw_with(*state, mesh, mvp, shader);
                    } else {
                        self.hidden.set(self.hidden.get() + 1);
                    }
                }
                6 => scene.draw_with(*state, mesh, mvp, &Gouraud::vertex_colors()),
                _ => scene.draw_with(*state, mesh, mvp, shader),
            }
        }
    }
}

fn compare(rng: &mut Rng) -> Compare {
    use Compare::{Always, Equal, Greater, GreaterEqual, Less, LessEqual, Never, NotEqual};
    if rng.one_in(12) {
        rng.pick(&[Never, Equal, Greater, NotEqual, GreaterEqual, Always])
    } else {
        rng.pick(&[Less, LessEqual])
    }
}

fn state(rng: &mut Rng) -> State {
    let bias = |rng: &mut Rng| DepthBias { constant: rng.between(-300, 300) as i16, slope: scalar(rng, 3.0) };
    State {
        cull: if rng.one_in(3) { Cull::None } else { Cull::Back },
        depth: DepthState { compare: compare(rng), write: !rng.one_in(4) },
        range: rng.pick(&[DepthRange::Clip, DepthRange::Clip, DepthRange::Clamp, DepthRange::ClampFar]),
        bias: if rng.one_in(4) { bias(rng) } else { DepthBias::NONE },
        depth_scale: match rng.below(10) {
            0 => DepthScale::Uniform { far: Scalar::from_num(20) },
            _ => DepthScale::Perspective,
        },
        ..State::DEFAULT
    }
}

/// A body of triangles with random corners, in one of both formats, and leaves of a hierarchy for it.
fn body(rng: &mut Rng) -> (Vec<Vec3>, Vec<[i16; 3]>, Vec<[u8; 3]>) {
    let count = 3 * (2 + rng.below(20) as usize);
    let points = (0..count).map(|_| vector(rng, 1.0)).collect();
    let short = (0..count).map(|_| [0; 3].map(|_: i16| rng.next_u64() as i16)).collect();
    let colors = (0..count).map(|_| [0; 3].map(|_: u8| rng.next_u64() as u8)).collect();
    (points, short, colors)
}

#[test]
fn random_scenes_are_the_same() {
    let mut rng = Rng::new(1);
    println!("seed {}", rng.seed());
    let (hidden, mut left_out) = (Cell::new(0), [0; 2]);
    for case in 0..60 {
        let bodies: Vec<_> = (0..6).map(|_| body(&mut rng)).collect();
        let half = Vec3::from_ints(1, 1, 1);
        let bounds = Bounds { center: Vec3::ZERO, half };
        let nodes: Vec<_> = bodies
            .iter()
            .map(|(points, ..)| {
                let first = (points.len() / 6) as u16;
                let node = BoundsNode { bounds, skip: 1, first_triangle: 0, triangles: first };
                let rest = points.len() as u16 / 3 - first;
                [node, BoundsNode { skip: 2, first_triangle: first, triangles: rest, ..node }]
            })
            .collect();
        let meshes: Vec<_> = bodies
            .iter()
            .zip(&nodes)
            .enumerate()
            .map(|(k, ((points, short, colors), nodes))| {
                let positions = if k % 2 == 0 {
                    Positions::Exact(points)
                } else {
                    Positions::Quantized { points: short, scale: Scalar::ONE, offset: Vec3::ZERO }
                };
                let hierarchy = (k % 3 == 0).then_some(&nodes[..]);
                Mesh::new(MeshData { colors: Some(colors), hierarchy, ..MeshData::new(positions) }).expect("a mesh")
            })
            .chain([polygons::PILLAR, torus::MESH, textured_wall()])
            .collect();
        let near = rng.pick(&[1 << 12, 1 << 15, 1 << 16]);
        let camera = scenes::camera(SIZE, Scalar::from_bits(near), Scalar::from_num(24));
        let items = (0..30)
            .map(|k| {
                // Walls first, later ones nearer or farther.
                let (wall, far) = (k % 10 == 0, f64::from(k) * 0.4);
                let distance = if wall { 3.0 + 2.0 * rng.unit() } else { 1.0 + far + 8.0 * rng.unit() };
                let aside = vector(&mut rng, if wall { 1.0 } else { 0.4 * distance });
                let place = Vec3::new(aside.x, aside.y, Scalar::from_num(-distance));
                let turn = if wall { Angle16(0) } else { Angle16(rng.next_u64() as u16) };
                let model = Affine::translation(place) * Affine::rotation_y(turn) * Affine::rotation_x(turn);
                let size = if wall { 1.0 } else { 0.2 + 0.6 * rng.unit() };
                let kind = if wall { 9 } else { rng.below(16) };
                Item {
                    kind,
                    mesh: if wall { 8 } else { rng.below(8) as usize },
                    mvp: camera * model * Affine::scale(Scalar::from_num(size)),
                    state: if wall || rng.one_in(2) { State::DEFAULT } else { state(&mut rng) },
                    color: Rgb888::new(rng.next_u64() as u8, k as u8, rng.next_u64() as u8),
                    place: [rng.between(-20, 200), rng.between(-20, 150), rng.between(0, 65_535), rng.between(1, 90)],
                }
            })
            .collect();
        let viewport = match case % 3 {
            0 => Viewport::new(Point::new(-20, 13), Size::new(190, 120)),
            _ => Viewport::full(SIZE),
        };
        let (viewport, points) = (viewport.expect("a viewport"), &bodies[0].0[..]);
        let heap = Heap { meshes: &meshes, points, viewport, items, hidden: &hidden };
        let found = same(&format!("case {case}"), &heap, &[[3, 40], [16, 150], [1, 31]][case % 3], &[0, 900, AMPLE]);
        left_out = [left_out[0] + found[0], left_out[1] + found[1]];
    }
    assert!(left_out.iter().all(|count| *count > 1000) && hidden.get() > 1000, "{left_out:?}, {hidden:?}");
}

/// A wall of 4 × 4, divided.
fn textured_wall() -> Mesh<'static> {
    static POINTS: [Vec3; 6] = [
        Vec3::from_ints(-2, -2, 0),
        Vec3::from_ints(2, -2, 0),
        Vec3::from_ints(2, 2, 0),
        Vec3::from_ints(-2, -2, 0),
        Vec3::from_ints(2, 2, 0),
        Vec3::from_ints(-2, 2, 0),
    ];
    static COLORS: [[u8; 3]; 6] = [[200; 3]; 6];
    Mesh::constant(MeshData { colors: Some(&COLORS), ..MeshData::new(Positions::Exact(&POINTS)) })
}

/// Of a street behind a wall, nearly all draws are left out in every strip. Without records, so are their vertices.
#[test]
fn a_hidden_street_is_left_out() {
    for turn in [0, 10_000, 40_000].map(Angle16) {
        let street = Street::behind_a_wall(SIZE, turn);
        let [recorded, direct] = same("street", &street, &[16], &[0, AMPLE]);
        assert!(recorded > 50 && direct > 100, "{recorded} {direct}");
        let mut color = vec![0; 200 * 16];
        let mut depth = vec![0; 200 * 16 + occlusion_len(200, 16)];
        let (_, all) = frame::<_, WithoutRecords>(renderer(&mut depth), &mut color, &street);
        let (_, few) = frame::<_, WithoutRecords>(occluding(&mut depth), &mut color, &street);
        assert!(3 * few.vertices < all.vertices, "{few:?}, {all:?}");
        assert!(few.triangles < all.triangles && few.drawn < all.drawn, "{few:?}, {all:?}");
    }
}

/// What nothing hides is never left out: a heap of things from far to near.
#[test]
fn nothing_is_left_out_from_far_to_near() {
    struct Rings;
    impl<F: Framebuffer> Draw<F> for Rings {
        fn draw(&self, scene: &mut Scene<'_, F>) {
            for k in 0..12 {
                let place = Affine::translation(Vec3::from_milli(0, 0, -12_000 + 800 * k));
                let mvp = scenes::camera(SIZE, Scalar::ONE, Scalar::from_num(16)) * place;
                assert!(scene.is_visible_with(State::DEFAULT, torus::MESH.bounds(), &mvp));
                scene.draw(&torus::MESH, &mvp, &Flat::unlit(Rgb888::new(20 * k as u8, 90, 90)));
            }
        }
    }
    assert_eq!(same("rings", &Rings, &[150], &[0]), [0; 2]);
    same("street", &Street::far_first(SIZE, Angle16(3000)), &[7, 150], &[0, AMPLE]);
}

/// Coarse depths take rows if the buffer has no more room, and a buffer for less than a row is an error.
#[test]
fn coarse_depths_take_room() {
    let rows = |length: usize| {
        let mut depth = vec![0; length];
        let renderer = Renderer::<Rgb565>::new(SIZE).and_then(|renderer| renderer.with_depth(&mut depth));
        renderer.and_then(Renderer::with_occlusion).map(|renderer| renderer.strip_rows(PIXELS))
    };
    assert_eq!(rows(16 * 200 + occlusion_len(200, 16)), Ok(16));
    assert_eq!(rows(16 * 200), Ok(15));
    assert_eq!(rows(PIXELS + occlusion_len(200, 150)), Ok(150));
    assert_eq!(rows(PIXELS), Ok(148));
    assert_eq!(rows(225), Err(RendererError::DepthTooShort { pixels: 225, needed: 226 }));
}

/// Things a few steps in front of a wall, at its depth, and behind it: each is drawn where its test lets it pass.
#[test]
fn steps_around_a_wall_are_the_same() {
    struct Steps(Compare, i32);
    impl<F: Framebuffer> Draw<F> for Steps {
        fn draw(&self, scene: &mut Scene<'_, F>) {
            let wall = Affine::translation(Vec3::new(Scalar::ZERO, Scalar::ZERO, Scalar::from_bits(1 << 15)));
            let thing = Affine::translation(Vec3::new(Scalar::ZERO, Scalar::ZERO, Scalar::from_bits(self.1)));
            let depth = DepthState { compare: self.0, write: true };
            let [wall, thing] = [wall, thing].map(|place| Projective::from_affine(&place));
            scene.draw(&textured_wall(), &wall, &Flat::unlit(Rgb888::new(90, 90, 90)));
            let shader = Flat::unlit(Rgb888::new(250, 40, 40));
            scene.draw_with(State { depth, ..State::DEFAULT }, &textured_wall(), &thing, &shader);
        }
    }
    for step in -6..=6 {
        for compare in [Compare::Less, Compare::LessEqual, Compare::Equal, Compare::Greater] {
            let left_out = same(&format!("{compare:?} {step}"), &Steps(compare, (1 << 15) + step), &[16], &[0, AMPLE]);
            let hidden = compare != Compare::Greater && step > 1;
            assert!(!hidden || left_out[0] == 10, "{compare:?} {step}: {left_out:?}");
        }
    }
}
