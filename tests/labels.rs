//! 2-D drawing at a depth, among meshes: against a model that tests each pixel by itself, and where points of the world
//! are.

use crate::reference::rng::Rng;
use crate::support::{Soup, angle, apply, difference, matrix, on_screen, rigid, scalar, strips, vector, whole};
use core::cell::Cell;
use core::convert::Infallible;
use embedded_graphics::mono_font::{MonoTextStyle, ascii};
use embedded_graphics::pixelcolor::{Rgb565, Rgb888, WebColors};
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{Circle, PrimitiveStyle, Rectangle};
use embedded_graphics::text::{Baseline, Text};
use zstrip::color::PixelFormat;
use zstrip::frame::{FramebufferRenderer, Renderer};
use zstrip::internals::{Projected, Transform};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::{Flat, Gouraud};
use zstrip::span::{Compare, DepthState};
use zstrip::vertex::{DepthScale, ScreenVertex, Viewport};
use zstrip::{Cull, Framebuffer, Scene, ScreenPoint, State};

const SCREEN: (u16, u16) = (64, 48);
const PIXELS: usize = 64 * 48;
const BOTH_SIDES: State = State { cull: Cull::None, ..State::DEFAULT };

/// A whole screen, pixel by pixel.
struct Model {
    colors: Vec<u16>,
    depths: Vec<u16>,
    z: u16,
    state: DepthState,
}

impl OriginDimensions for Model {
    fn size(&self) -> Size {
        Size::new(SCREEN.0.into(), SCREEN.1.into())
    }
}

impl DrawTarget for Model {
    type Color = Rgb565;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(at, color) in pixels {
            if (0..64).contains(&at.x) && (0..48).contains(&at.y) {
                let k = (at.y * 64 + at.x) as usize;
                let (new, old) = (self.z, self.depths[k]);
                let passes = match self.state.compare {
                    Compare::Never => false,
                    Compare::Less => new < old,
                    Compare::Equal => new == old,
                    Compare::LessEqual => new <= old,
                    Compare::Greater => new > old,
                    Compare::NotEqual => new != old,
                    Compare::GreaterEqual => new >= old,
                    Compare::Always => true,
                };
                if passes {
                    self.colors[k] = color.into_storage();
                    if self.state.write {
                        self.depths[k] = new;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Draws areas of all kinds, some of them with too few colours, some with endless ones.
fn areas<D: DrawTarget<Color = Rgb565, Error = Infallible>>(target: &mut D, rng: &mut Rng) {
    let color = |k: u32| Rgb565::new((k * 7) as u8 & 31, (k * 5) as u8 & 63, k as u8 & 31);
    for _ in 0..4 {
        let corner = Point::new(rng.between(-40, 70), rng.between(-40, 50));
        let size = Size::new(rng.below(90) as u32, rng.below(70) as u32);
        let area = Rectangle::new(corner, size);
        let seed = rng.below(1000) as u32;
        let Ok(()) = match rng.below(5) {
            0 => target.fill_solid(&area, color(seed)),
            1 => target.fill_contiguous(&area, (seed..).map(color)),
            2 => {
                let some = rng.below(u64::from(size.width * size.height) + 1) as u32;
                target.fill_contiguous(&area, (seed..seed + some).map(color))
            }
            3 => target.draw_iter(area.points().zip(seed..).map(|(at, k)| Pixel(at, color(k)))),
            _ if rng.one_in(8) => target.clear(color(seed)),
            _ => target.fill_solid(&area, color(seed)),
        };
    }
}

fn random_state(rng: &mut Rng) -> DepthState {
    use Compare::*;
    let compare = rng.pick(&[Never, Less, Equal, LessEqual, Greater, NotEqual, GreaterEqual, Always]);
    DepthState { compare, write: !rng.one_in(3) }
}

#[test]
fn drawing_at_a_depth_tests_each_pixel_against_the_meshes() {
    let mut seen = 0;
    for seed in 0..150 {
        let mut rng = Rng::new(seed);
        let soup = Soup::new(&mut rng, 8);
        let mesh = soup.mesh();
        let (colors, depths, _) = whole::<Rgb565>(SCREEN, Rgb565::BLUE, |s| {
            s.draw_with(BOTH_SIDES, &mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
        });
        // Depths that are there, so that equality matters.
        let z = if rng.one_in(2) { depths[rng.below(PIXELS as u64) as usize] } else { rng.next_u64() as u16 };
        let (state, kind, colors_seed) = (random_state(&mut rng), rng.below(3), rng.next_u64());
        let model_state = [DepthState::OFF, DepthState::LESS_EQUAL, state][kind as usize];
        let before = colors.clone();
        let mut model = Model { colors, depths, z, state: model_state };
        areas(&mut model, &mut Rng::new(colors_seed));
        seen += usize::from(model.colors != before);
        for (rows, records) in [(48, 20_000), (48, 0), (7, 20_000), (7, 200), (1, 0)] {
            let (picture, _) = strips::<Rgb565>(SCREEN, rows, records, Rgb565::BLUE, |s| {
                s.draw_with(BOTH_SIDES, &mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
                let mut rng = Rng::new(colors_seed);
                match kind {
                    0 => areas(&mut s.overlay(), &mut rng),
                    1 => areas(&mut s.at_depth(z), &mut rng),
                    _ => areas(&mut s.at_depth_with(z, state), &mut rng),
                }
            });
            let found = difference(&picture, &model.colors, SCREEN.0);
            assert_eq!(found, None, "seed {seed}, {rows} rows, {records} records, depth {z}, {model_state:?}");
        }
    }
    assert!(seen > 75, "only {seen} drawings can be seen");
}

/// Labels before, between and after meshes.
fn mixed<F: Framebuffer<Format = Rgb565>>(scene: &mut Scene<'_, F>, mesh: &Mesh<'_>, seed: u64) {
    let mut rng = Rng::new(seed);
    for _ in 0..3 {
        let z = rng.next_u64() as u16;
        areas(&mut scene.at_depth(z), &mut rng);
        let turn = Affine::rotation_z(angle(&mut rng));
        scene.draw_with(BOTH_SIDES, mesh, &Projective::from(turn), &Flat::unlit(Rgb888::new(seed as u8, 99, 7)));
        areas(&mut scene.overlay(), &mut rng);
    }
}

#[test]
fn labels_among_meshes_are_the_same_in_any_strips() {
    for seed in 0..60 {
        let soup = Soup::new(&mut Rng::new(seed), 10);
        let mesh = soup.mesh();
        let (expected, _, _) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |s| mixed(s, &mesh, seed));
        let (_, without) = strips::<Rgb565>(SCREEN, 7, 20_000, Rgb565::BLACK, |s| {
            let mut rng = Rng::new(seed);
            for _ in 0..3 {
                rng.next_u64();
                // The same random numbers, on an overlay of another scene's size: nothing.
                areas(
                    &mut Model { colors: vec![0; PIXELS], depths: vec![0; PIXELS], z: 0, state: DepthState::OFF },
                    &mut rng,
                );
                let turn = Affine::rotation_z(angle(&mut rng));
                s.draw_with(BOTH_SIDES, &mesh, &Projective::from(turn), &Flat::unlit(Rgb888::new(seed as u8, 99, 7)));
                areas(
                    &mut Model { colors: vec![0; PIXELS], depths: vec![0; PIXELS], z: 0, state: DepthState::OFF },
                    &mut rng,
                );
            }
        });
        for (rows, records) in [(48, 0), (16, 20_000), (7, 20_000), (5, 400), (1, 20_000), (1, 0)] {
            let (picture, stats) = strips::<Rgb565>(SCREEN, rows, records, Rgb565::BLACK, |s| mixed(s, &mesh, seed));
            let found = difference(&picture, &expected, SCREEN.0);
            assert_eq!(found, None, "seed {seed}, {rows} rows, {records} records");
            if (rows, records) == (7, 20_000) {
                assert_eq!(stats, without, "seed {seed}: overlays change no counter");
            }
        }
    }
}

const SQUARE: [Vec3; 4] = [
    Vec3::from_milli(-500, -500, 0),
    Vec3::from_milli(0, -500, 0),
    Vec3::from_milli(0, 500, 0),
    Vec3::from_milli(-500, 500, 0),
];

#[test]
fn mesh_in_front_of_a_label_hides_its_part() {
    let square =
        Mesh::new(MeshData { topology: Topology::Quads, ..MeshData::new(Positions::Exact(&SQUARE)) }).expect("a mesh");
    // Clip space as it is: depth 1/4, columns 16 to 31, rows 12 to 35.
    let near = Projective::from(Affine::translation(Vec3::from_milli(0, 0, 250)));
    let far = Projective::from(Affine::translation(Vec3::from_milli(0, 0, 750)));
    let style = MonoTextStyle::new(&ascii::FONT_6X10, Rgb565::YELLOW);
    // Columns 2 to 61, rows 19 to 28: in front of, behind and beside the square.
    let text = Text::with_baseline("MMMMMMMMMM", Point::new(2, 19), style, Baseline::Top);
    let mut drawn = vec![false; PIXELS];
    let (plain, _) = strips::<Rgb565>(SCREEN, 48, 0, Rgb565::BLACK, |s| s.overlay().draw(&text));
    for (drawn, pixel) in drawn.iter_mut().zip(&plain) {
        *drawn = *pixel == Rgb565::YELLOW.into_storage();
    }
    let red = Flat::unlit(Rgb888::RED);
    for (rows, records) in [(48, 0), (48, 500), (5, 500), (5, 30), (1, 0)] {
        for (mvp, hidden) in [(&near, true), (&far, false)] {
            for label_first in [true, false] {
                let (picture, _) = strips::<Rgb565>(SCREEN, rows, records, Rgb565::BLACK, |s| {
                    if !label_first {
                        s.draw(&square, mvp, &red);
                    }
                    s.at_depth(1 << 15).draw(&text);
                    if label_first {
                        s.draw(&square, mvp, &red);
                    }
                });
                for (k, pixel) in picture.iter().enumerate() {
                    let (x, y) = (k % 64, k / 64);
                    let square = (16..32).contains(&x) && (12..36).contains(&y);
                    let expected = match (square, drawn[k]) {
                        (true, true) if hidden => Rgb565::RED,
                        (_, true) => Rgb565::YELLOW,
                        (true, false) => Rgb565::RED,
                        (false, false) => Rgb565::BLACK,
                    };
                    assert_eq!(
                        Rgb565::to_color(*pixel),
                        expected,
                        "pixel ({x}, {y}), {rows} rows, {records} records, hidden: {hidden}, label first: {label_first}"
                    );
                }
                let count = |color: Rgb565| picture.iter().filter(|p| **p == color.into_storage()).count();
                assert!(count(Rgb565::YELLOW) > 50 && count(Rgb565::RED) > 200, "both can be seen");
            }
        }
    }
}

/// Counts how often rows are asked for.
struct Counting {
    pixels: Vec<u16>,
    spans: usize,
}

impl Framebuffer for Counting {
    type Format = Rgb565;

    fn row(&mut self, y: u32) -> &mut [u16] {
        self.spans += 1;
        self.pixels.get_mut(y as usize * 64..y as usize * 64 + 64).unwrap_or_default()
    }
}

#[test]
fn nothing_is_drawn_while_recording() {
    let frame = |records: usize| {
        let (walks, colors) = (Cell::new(0), Cell::new(0));
        let mut framebuffer = Counting { pixels: vec![0; PIXELS], spans: 0 };
        // Two strips: one would be drawn directly.
        let (mut depth, mut records) = (vec![0; PIXELS / 2], vec![0; records]);
        let mut renderer = FramebufferRenderer::new(Size::new(SCREEN.0.into(), SCREEN.1.into()))
            .expect("a renderer")
            .with_depth(&mut depth)
            .expect("a renderer")
            .with_records(&mut records);
        let stats = renderer.frame_over(&mut framebuffer, |scene| {
            walks.set(walks.get() + 1);
            let mut overlay = scene.at_depth(7);
            let area = Rectangle::new(Point::new(3, 4), Size::new(20, 10));
            let Ok(()) = overlay.fill_solid(&area, Rgb565::RED);
            let counted = area.points().map(|at| {
                colors.set(colors.get() + 1);
                Pixel(at, Rgb565::RED)
            });
            let Ok(()) = overlay.draw_iter(counted);
        });
        assert_eq!(stats.expect("a frame").walks, walks.get());
        (walks.get(), framebuffer.spans, colors.get())
    };
    let (walks, spans, colors) = frame(0);
    assert_eq!((walks, spans, colors), (2, 20, 400), "directly: ten rows for the area, and for the pixels ten more");
    assert_eq!(frame(100), (3, spans, colors), "recorded and replayed: only the walks after the first one draw");
}

#[test]
fn overlay_covers_the_screen_in_every_strip_and_says_what_is_visible() {
    let strip = Cell::new(0);
    let (mut color, mut depth) = (vec![0; 64 * 10], vec![0; 64 * 10]);
    let renderer = Renderer::<Rgb565>::new(Size::new(SCREEN.0.into(), SCREEN.1.into()))
        .expect("a renderer")
        .with_depth(&mut depth)
        .expect("a renderer");
    let mut renderer = renderer.with_records(&mut []);
    let mut frame = renderer.begin(Rgb565::BLACK);
    while frame
        .next_strip(&mut color, |scene| {
            let top = 10 * strip.get();
            let overlay = scene.overlay();
            assert_eq!(overlay.bounding_box(), Rectangle::new(Point::zero(), Size::new(64, 48)));
            for y in -5..60 {
                for (x, inside) in [(-3, false), (-2, true), (63, true), (64, false)] {
                    let visible = overlay.is_visible(&Rectangle::new(Point::new(x, y), Size::new(3, 2)));
                    assert_eq!(visible, inside && y + 2 > top && y < (top + 10).min(48), "({x}, {y}) at {top}");
                }
            }
            assert!(!overlay.is_visible(&Rectangle::new(Point::new(5, top), Size::new(0, 5))));
            let all = Rectangle::new(Point::new(i32::MIN, i32::MIN), Size::new(u32::MAX, u32::MAX));
            assert!(overlay.is_visible(&all));
        })
        .expect("a strip")
        .is_some()
    {
        strip.set(strip.get() + 1);
    }
    assert_eq!(strip.get(), 5);
}

#[test]
fn what_is_drawn_by_its_bounding_box_stays_in_it() {
    /// Draws a circle that it does not admit to.
    struct Sly(Circle);
    impl Dimensions for Sly {
        fn bounding_box(&self) -> Rectangle {
            Rectangle::new(self.0.top_left, Size::new(10, 12))
        }
    }
    impl Drawable for Sly {
        type Color = Rgb565;
        type Output = ();
        fn draw<D: DrawTarget<Color = Rgb565>>(&self, target: &mut D) -> Result<(), D::Error> {
            self.0.into_styled(PrimitiveStyle::with_fill(Rgb565::WHITE)).draw(target)
        }
    }
    let sly = Sly(Circle::new(Point::new(20, 13), 30));
    for rows in [48, 16, 3] {
        let (picture, _) = strips::<Rgb565>(SCREEN, rows, 0, Rgb565::BLACK, |s| s.overlay().draw(&sly));
        let mut inside = 0;
        for (k, pixel) in picture.iter().enumerate() {
            let (x, y) = (k % 64, k / 64);
            let white = *pixel == Rgb565::WHITE.into_storage();
            assert!(!white || ((20..30).contains(&x) && (13..25).contains(&y)), "({x}, {y}), {rows} rows");
            inside += usize::from(white);
        }
        assert!(inside > 40, "{inside} pixels, {rows} rows");
    }
}

/// What `Scene::project` says in each call of a frame, which must be one and the same.
fn projected(point: Vec3, mvp: &Projective, viewport: Viewport) -> Option<ScreenVertex> {
    let mut answers = Vec::new();
    strips::<Rgb565>(SCREEN, 20, 100, Rgb565::BLACK, |scene| {
        scene.set_viewport(viewport);
        answers.push(scene.project(point, mvp));
    });
    assert_eq!(answers.len(), 4, "recorded once, replayed three times");
    assert!(answers.iter().all(|a| *a == answers[0]), "{answers:?}");
    answers[0]
}

#[test]
fn points_are_projected_to_where_vertices_would_be() {
    let (mut seen, mut unseen) = (0, 0);
    for seed in 0..600 {
        let mut rng = Rng::new(seed);
        let camera = Projective::perspective(
            Angle16::from_degrees(rng.between(20, 120)),
            Size::new(rng.between(10, 300) as u32, rng.between(10, 300) as u32),
            Scalar::ONE,
            Scalar::ONE * 50,
        )
        .expect("a camera");
        let mvp = camera * (Affine::translation(Vec3::from_ints(0, 0, -10)) * rigid(&mut rng, 4.0));
        let viewport = Viewport::new(Point::new(rng.between(-50, 50), 9), Size::new(rng.between(1, 300) as u32, 200))
            .expect("a viewport");
        let point = vector(&mut rng, 15.0);
        let found = projected(point, &mvp, viewport);

        // As a vertex of a mesh, bit for bit.
        let corners = [point, vector(&mut rng, 100.0), Vec3::new(scalar(&mut rng, 900.0), Scalar::ZERO, Scalar::ONE)];
        let positions = Positions::Exact(&corners);
        let mesh = Mesh::new(MeshData::new(positions)).expect("a mesh");
        let as_vertex = match Transform::new(&mvp, &viewport, &mesh, false).project_vertex(&positions, 0) {
            Projected::OnScreen(vertex) => Some(vertex),
            Projected::NeedsClip(_) => None,
        };
        assert_eq!(found, as_vertex, "seed {seed}");
        assert_eq!(
            found.is_some(),
            matches!(
                zstrip::internals::projected(&Transform::new(&mvp, &viewport, &mesh, false).point(point)),
                Projected::OnScreen(_)
            )
        );

        // And by the textbook.
        let p = point.to_bits().map(|v| f64::from(v) / 65_536.0);
        let clip = apply(&matrix(&mvp), [p[0], p[1], p[2], 1.0]);
        let [x, y, z] = on_screen(&viewport, clip);
        match found {
            None => {
                unseen += 1;
                assert!(clip[3] <= 1e-4 || !(1e-6..=1.0 - 1e-6).contains(&z), "seed {seed}: {clip:?} was refused");
            }
            Some(v) => {
                seen += 1;
                let off = (f64::from(v.x) - 256.0 * x).abs().max((f64::from(v.y) - 256.0 * y).abs());
                assert!(off <= 1.0, "seed {seed}: {off}/256 px off");
                assert!((f64::from(v.z) - 65_535.0 * z).abs() <= 1.0, "seed {seed}: depth {} for {z}", v.z);
                assert_eq!(v.pixel(), Point::new(v.x.div_euclid(256), v.y.div_euclid(256)));
            }
        }
    }
    assert!(seen > 150 && unseen > 50, "{seen} seen, {unseen} not");
}

/// A point of the scene, its place on the screen, and what lies there at its depth.
#[test]
fn what_is_under_a_point_of_the_screen_is_the_point_that_was_projected() {
    let lens = Projective::perspective(
        Angle16::from_degrees(60),
        Size::new(SCREEN.0.into(), SCREEN.1.into()),
        Scalar::ONE,
        Scalar::ONE * 9,
    )
    .expect("a camera");
    let mvp = lens * Affine::translation(Vec3::from_ints(0, 0, -4)) * Affine::rotation_y(Angle16::from_degrees(25));
    let mut seen = 0;
    strips::<Rgb565>(SCREEN, SCREEN.1.into(), 0, Rgb565::BLACK, |scene| {
        seen = 0;
        let mut rng = Rng::new(3);
        for case in 0..200 {
            let point = Vec3::from_bits([(); 3].map(|()| rng.between(-100_000, 100_000)));
            let Some(v) = scene.project(point, &mvp) else { continue };
            let found = scene.unproject(ScreenPoint::from(v), v.z, &mvp).expect("the camera has an inverse");
            seen += 1;
            // Half a step of depth is 1/1800 of the way at the far end; half of 1/256 px far less.
            for (found, point) in found.to_bits().iter().zip(point.to_bits()) {
                assert!((found - point).abs() < 120, "case {case}: {found} instead of {point}");
            }
        }
        let flat = Projective::from_rows([[0; 4]; 4]);
        assert_eq!(scene.unproject(ScreenPoint::center(3, 3), 100, &flat), None);
    });
    assert!(seen > 100, "{seen}");
}

#[test]
fn points_have_the_depth_of_vertices_on_either_scale() {
    let camera = Projective::perspective(
        Angle16::from_degrees(60),
        Size::new(SCREEN.0.into(), SCREEN.1.into()),
        Scalar::ONE,
        Scalar::ONE * 9,
    )
    .expect("a camera");
    let mvp = camera * Affine::translation(Vec3::from_ints(0, 0, -4));
    let viewport = Viewport::full(Size::new(SCREEN.0.into(), SCREEN.1.into())).expect("a viewport");
    for depth_scale in [DepthScale::Perspective, DepthScale::Uniform { far: Scalar::ONE * 9 }] {
        let state = State { depth_scale, ..State::DEFAULT };
        let mut depths = Vec::new();
        for z in [-2000, -900, 0, 1100, 2500] {
            let corners = [Vec3::from_milli(300, -200, z); 3];
            let positions = Positions::Exact(&corners);
            let mesh = Mesh::new(MeshData::new(positions)).expect("a mesh");
            let mut transform = Transform::new(&mvp, &viewport, &mesh, false);
            transform.set_depth_scale(depth_scale);
            let Projected::OnScreen(expected) = transform.project_vertex(&positions, 0) else {
                panic!("{z} is out of view")
            };
            strips::<Rgb565>(SCREEN, 48, 0, Rgb565::BLACK, |scene| {
                assert_eq!(scene.project_with(state, corners[0], &mvp), Some(expected), "{depth_scale:?}, z {z}");
            });
            depths.push(expected.z);
        }
        assert!(depths.is_sorted_by(|a, b| a > b), "nearer is less: {depths:?}, {depth_scale:?}");
    }
}

#[test]
fn label_at_a_projected_point_is_hidden_by_what_is_in_front_of_the_point() {
    let square =
        Mesh::new(MeshData { topology: Topology::Quads, ..MeshData::new(Positions::Exact(&SQUARE)) }).expect("a mesh");
    let camera = Projective::perspective(
        Angle16::from_degrees(60),
        Size::new(SCREEN.0.into(), SCREEN.1.into()),
        Scalar::ONE,
        Scalar::ONE * 9,
    )
    .expect("a camera");
    let mvp = camera * Affine::translation(Vec3::from_ints(0, 0, -2));
    for (z, visible) in [(300, true), (-300, false)] {
        let point = Vec3::from_milli(-250, 0, z);
        let (picture, _) = strips::<Rgb565>(SCREEN, 7, 300, Rgb565::BLACK, |scene| {
            scene.draw(&square, &mvp, &Flat::unlit(Rgb888::CSS_TEAL));
            let label = scene.project(point, &mvp).expect("a point in view");
            let Ok(()) = scene.at_depth(label.z).draw_iter([Pixel(label.pixel(), Rgb565::WHITE)]);
        });
        let white = picture.iter().filter(|p| **p == Rgb565::WHITE.into_storage()).count();
        assert_eq!(white, usize::from(visible), "{z} mm in front of the square");
    }
}
