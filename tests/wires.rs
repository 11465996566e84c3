//! Lines and points in space: which pixels, which depths, which colours; and that strips do not matter.

use crate::reference::rng::Rng;
use crate::support;
use crate::support::{difference, strips, whole};
use std::cell::RefCell;
use std::collections::BTreeMap;
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::internals::{Line, PixelRect, Projected, Transform, square};
use zstrip::math::{Affine, Angle16, Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{LineTopology, Lines, MeshData, Points, Positions, Vertices};
use zstrip::shader::{Flat, Gouraud};
use zstrip::span::{Compare, DepthState, Fragment, Shader};
use zstrip::target::Framebuffer;
use zstrip::vertex::{DepthRange, Face, Perspective, ScreenVertex, VertexRef, VertexShader, Viewport};
use zstrip::{Dashed, Scene, ScreenPoint, Smooth, State, Thick, Thin};

const SCREEN: (u16, u16) = (160, 120);
const EVERYTHING: State = State { depth: DepthState::OFF, ..State::DEFAULT };

/// Vertices in clip space of every kind: on the screen, far out, behind the eye, exactly there.
struct Ends {
    positions: Vec<[Scalar; 4]>,
    colors: Vec<[u8; 3]>,
}

impl Ends {
    fn new(rng: &mut Rng, count: usize) -> Self {
        let mut one = || {
            let wide = rng.pick(&[1.5, 1.5, 20.0, 1000.0]);
            let w = rng.pick(&[1.0, 1.0, 1.0, 0.01, 0.0, -1.0]) * rng.unit();
            let [x, y] = [(); 2].map(|()| (2.0 * rng.unit() - 1.0) * wide);
            let z = rng.unit() * rng.pick(&[1.0, 1.0, 1.5, -0.5]) * w.abs();
            [x, y, z, w].map(|v| Scalar::from_num(v))
        };
        let positions = (0..count).map(|_| one()).collect();
        let colors = (0..count).map(|_| [(); 3].map(|()| rng.below(256) as u8)).collect();
        Self { positions, colors }
    }

    fn data(&self) -> Vertices<'_> {
        Vertices { colors: Some(&self.colors), ..Vertices::new(Positions::Homogeneous(&self.positions)) }
    }
}

/// One draw of each kind.
fn draw_all<F: Framebuffer>(scene: &mut Scene<'_, F>, ends: &Ends, turn: Angle16, range: DepthRange) {
    let mvp = Projective::from(Affine::rotation_z(turn));
    let lines = |joined| Lines::new(ends.data(), joined, None).expect("lines");
    let shader = Gouraud::vertex_colors();
    let state = State { range, ..State::DEFAULT };
    scene.draw_lines_with(state, &lines(LineTopology::Strip), &mvp, &shader, &Thin);
    scene.draw_lines_with(state, &lines(LineTopology::Loop), &mvp, &shader, &Dashed::EVEN);
    scene.draw_lines_with(state, &lines(LineTopology::Pairs), &mvp, &shader, &Thick::new(Pixels::from_bits(700)));
    let blended = State { depth: DepthState { compare: Compare::LessEqual, write: false }, ..state };
    scene.draw_lines_with(
        blended,
        &lines(LineTopology::Pairs),
        &mvp,
        &Flat::unlit(Rgb888::GREEN),
        &Smooth::new(Pixels::from_bits(300)),
    );
    scene.draw_points_with(
        state,
        &Points::new(ends.data()).expect("points"),
        &mvp,
        &shader,
        Pixels::from_bits(5 * 256 + 77),
    );
}

#[test]
fn strips_and_records_do_not_matter() {
    let mut rng = Rng::new(21);
    for case in 0..12 {
        let count = 2 + 2 * rng.below(40) as usize;
        let ends = Ends::new(&mut rng, count);
        let turn = support::angle(&mut rng);
        let range = [DepthRange::Clip, DepthRange::ClampFar, DepthRange::Clamp][case % 3];
        let (expected, _, stats) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |s| draw_all(s, &ends, turn, range));
        assert!(stats.lines > 0 && stats.points > 0);
        for (rows, records) in [(1, 10_000), (7, 10_000), (16, 0), (16, 100), (16, 300), (120, 0), (120, 10_000)] {
            let (picture, _) =
                strips::<Rgb565>(SCREEN, rows, records, Rgb565::BLACK, |s| draw_all(s, &ends, turn, range));
            let found = difference(&picture, &expected, SCREEN.0);
            assert_eq!(found, None, "seed {}, case {case}: {rows} rows, {records} records", rng.seed());
        }
    }
}

/// Shows one perspective-correct value, on lines that have a width.
struct Correct;

impl VertexShader for Correct {
    type Varyings = Perspective<1, 2>;

    fn vertex(&self, vertex: &VertexRef<'_>) -> Perspective<1, 2> {
        Perspective::new([i32::from(vertex.color()[0]) << 8], [])
    }
}

impl<P: PixelFormat<Raw = u16>> Shader<P> for Correct {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, Perspective<1, 2>>) -> Option<u16> {
        Some(fragment.varyings.as_ref()[0] as u16)
    }
}

#[test]
fn perspective_correct_lines_are_drawn_alike_with_and_without_records() {
    let mut rng = Rng::new(29);
    let (mut lit, mut clipped) = (0, 0);
    for case in 0..20 {
        let ends = Ends::new(&mut rng, 40);
        let lines = Lines::new(ends.data(), LineTopology::Pairs, None).expect("lines");
        let mvp = Projective::from(Affine::rotation_z(support::angle(&mut rng)));
        let draw = |records| {
            strips::<Rgb565>(SCREEN, 24, records, Rgb565::BLACK, |scene| {
                scene.draw_lines_with(State::DEFAULT, &lines, &mvp, &Correct, &Thick::new(Pixels::from_bits(900)));
            })
        };
        let ((expected, stats), (picture, _)) = (draw(10_000), draw(0));
        assert_eq!(difference(&picture, &expected, SCREEN.0), None, "seed {}, case {case}", rng.seed());
        lit += expected.iter().filter(|pixel| **pixel != 0).count();
        clipped += stats.clipped;
    }
    assert!(lit > 5000 && clipped > 100, "{lit} pixels, {clipped} lines cut");
}

/// A line that goes away from the eye, as a whole and cut at the near plane.
#[test]
fn perspective_correct_values_of_a_line_that_is_cut_are_those_of_the_whole_line() {
    // From w = 1/2 to w = 8 in one line; and with its start drawn out to w = 0, where the value goes on evenly in
    // space.
    let along = |w: f64| [(w - 0.5) / 8.0, (w - 0.5) / 8.0, (w - 0.25) * 0.5, w].map(Scalar::from_num);
    let value = |w: f64| ((w + 1.0) * 20.0) as u8;
    let picture = |from: f64| {
        let positions = [along(from), along(8.0)];
        let colors = [[value(from); 3], [value(8.0); 3]];
        let data = Vertices { colors: Some(&colors), ..Vertices::new(Positions::Homogeneous(&positions)) };
        let line = Lines::new(data, LineTopology::Pairs, None).expect("a line");
        let (picture, ..) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| {
            scene.draw_lines_with(EVERYTHING, &line, &Projective::IDENTITY, &Correct, &Thick::px(4));
        });
        picture
    };
    let (near, cut) = (picture(0.25), picture(-0.5));
    let mut seen = 0;
    for (k, (near, cut)) in near.iter().zip(&cut).enumerate() {
        if *near != 0 && *cut != 0 {
            seen += 1;
            assert!(near.abs_diff(*cut) <= 24, "pixel {k}: {near} and {cut}");
        }
    }
    assert!(seen > 60, "{seen}");
}

/// A fragment: where, its depth, its only varying.
type Hit = ((i32, i32), u16, i32);

/// Reports each fragment.
struct Seen<'a>(RefCell<&'a mut Vec<Hit>>);

impl VertexShader for Seen<'_> {
    type Varyings = [i32; 1];

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 1] {
        [value(vertex.index())]
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        face.index() as u32
    }
}

/// The varying of a vertex: any number.
fn value(index: usize) -> i32 {
    (index as i32).wrapping_mul(0x1234_5677) >> 3
}

impl Shader<Rgb565> for Seen<'_> {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 1]>) -> Option<u16> {
        self.0.borrow_mut().push((fragment.position, fragment.depth, fragment.varyings[0]));
        Some(1)
    }
}

/// Fragments of a draw in a whole frame.
fn fragments(draw: impl Fn(&mut Scene<'_, zstrip::target::FrameSlice<'_, Rgb565>>, &Seen<'_>)) -> Vec<Hit> {
    let mut seen = Vec::new();
    let shader = Seen(RefCell::new(&mut seen));
    whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| draw(scene, &shader));
    seen
}

/// Vertices in view, with depth.
fn in_view(rng: &mut Rng, count: usize) -> Vec<Vec3> {
    (0..count).map(|_| support::vector(rng, 1.0)).collect()
}

fn camera() -> Projective {
    let camera = Projective::perspective(
        Angle16::from_degrees(60),
        Size::new(SCREEN.0.into(), SCREEN.1.into()),
        Scalar::ONE,
        Scalar::from_num(10),
    );
    camera.expect("a camera") * Affine::translation(Vec3::from_ints(0, 0, -3))
}

fn placed(lines: &Lines<'_>, mvp: &Projective) -> Vec<ScreenVertex> {
    let viewport = Viewport::full(Size::new(SCREEN.0.into(), SCREEN.1.into())).expect("a viewport");
    let transform = Transform::new(mvp, &viewport, lines.vertices(), false);
    let place = |k| match transform.project_vertex(&lines.vertices().data().positions, k) {
        Projected::OnScreen(v) => v,
        Projected::NeedsClip(code) => panic!("{code:?}"),
    };
    (0..lines.vertices().vertex_count()).map(place).collect()
}

#[test]
fn thin_lines_are_those_of_the_rule_with_exact_depth_and_values() {
    let mut rng = Rng::new(22);
    let screen = PixelRect { x: 0..i32::from(SCREEN.0), y: 0..i32::from(SCREEN.1) };
    let mut worst = [0_f64; 2];
    for _ in 0..200 {
        let ends = in_view(&mut rng, 8);
        let lines = Lines::new(Vertices::new(Positions::Exact(&ends)), LineTopology::Pairs, None).expect("lines");
        let seen = fragments(|scene, shader| scene.draw_lines_with(EVERYTHING, &lines, &camera(), shader, &Thin));
        let v = placed(&lines, &camera());
        let mut seen = seen.into_iter();
        for k in (0..8).step_by(2) {
            let (a, b) = (v[k], v[k + 1]);
            let line = Line::new((a.x, a.y), (b.x, b.y));
            let (skipped, pixels) = line.pixels(&screen);
            for (n, pixel) in (skipped..).zip(pixels) {
                let case = format!("seed {}: {a:?} {b:?} pixel {n}", rng.seed());
                let (position, depth, varying) = seen.next().expect("a fragment");
                assert_eq!(position, pixel, "{case}");
                let way = f64::from(line.lead()) + 256.0 * f64::from(n);
                let t = (way / f64::from(line.length())).max(0.0);
                let between = |a: f64, b: f64| a + t * (b - a);
                let z = (f64::from(depth) - between(a.z.into(), b.z.into())).abs();
                let value = (f64::from(varying) - between(value(k).into(), value(k + 1).into())).abs();
                worst = [worst[0].max(z), worst[1].max(value)];
                assert!(z <= 0.502, "{case}: depth is off by {z}");
                assert!(value <= 200.0, "{case}: value is off by {value}");
            }
        }
        assert_eq!(seen.next(), None);
    }
    println!("worst errors: depth {} steps, value {} units of 2^31", worst[0], worst[1]);
}

#[test]
fn strips_and_loops_draw_each_pixel_of_a_joint_once() {
    // A circle, with corners everywhere in their pixels: no pixel twice, each touches the next.
    for corners in [12, 13, 60, 200] {
        let ends: Vec<_> = (0..corners)
            .map(|k| {
                let angle = Angle16((k * 65_536 / corners) as u16);
                Vec3::new(angle.cos(), angle.sin(), Scalar::ZERO)
            })
            .collect();
        let data = Vertices::new(Positions::Exact(&ends));
        let circle = Lines::new(data, LineTopology::Loop, None).expect("a loop");
        let seen = fragments(|scene, shader| scene.draw_lines_with(EVERYTHING, &circle, &camera(), shader, &Thin));
        let mut hits = BTreeMap::new();
        seen.iter().for_each(|(position, ..)| *hits.entry(*position).or_insert(0) += 1);
        assert!(hits.values().all(|n| *n == 1), "{corners} corners: {hits:?}");
        let apart = |(a, b): (&Hit, &Hit)| (a.0.0 - b.0.0).abs().max((a.0.1 - b.0.1).abs());
        let farthest = seen.iter().zip(seen.iter().cycle().skip(1)).map(apart).max();
        assert_eq!(farthest, Some(1), "{corners} corners");
        // The strip is the loop without the last line.
        let open = Lines::new(data, LineTopology::Strip, None).expect("a strip");
        let strip = fragments(|scene, shader| scene.draw_lines_with(EVERYTHING, &open, &camera(), shader, &Thin));
        assert_eq!(seen[..strip.len()], strip);
        assert!(strip.len() < seen.len());
    }
}

#[test]
fn dashes_are_the_pixels_of_the_pattern() {
    let mut rng = Rng::new(23);
    for _ in 0..50 {
        let ends = in_view(&mut rng, 2);
        let pattern = rng.next_u64() as u32;
        let lines = Lines::new(Vertices::new(Positions::Exact(&ends)), LineTopology::Pairs, None).expect("a line");
        let draw =
            |stroke: &dyn Fn(&mut Scene<'_, zstrip::target::FrameSlice<'_, Rgb565>>, &Seen<'_>)| fragments(stroke);
        let all = draw(&|scene, shader| scene.draw_lines_with(EVERYTHING, &lines, &camera(), shader, &Thin));
        let dashed =
            draw(&|scene, shader| scene.draw_lines_with(EVERYTHING, &lines, &camera(), shader, &Dashed(pattern)));
        let [a, b] = placed(&lines, &camera())[..] else { panic!("two ends") };
        let line = Line::new((a.x, a.y), (b.x, b.y));
        let (skipped, _) = line.pixels(&PixelRect { x: 0..i32::from(SCREEN.0), y: 0..i32::from(SCREEN.1) });
        let expected: Vec<_> =
            (skipped..).zip(all).filter(|(k, _)| pattern >> (k % 32) & 1 != 0).map(|(_, fragment)| fragment).collect();
        assert_eq!(dashed, expected, "seed {}", rng.seed());
    }
}

#[test]
fn points_are_squares_at_their_depth() {
    let mut rng = Rng::new(24);
    for _ in 0..50 {
        let ends = in_view(&mut rng, 5);
        let data = Vertices::new(Positions::Exact(&ends));
        let points = Points::new(data).expect("points");
        let size = rng.below(4000) as u32;
        let seen = fragments(|scene, shader| {
            scene.draw_points_with(EVERYTHING, &points, &camera(), shader, Pixels::from_bits(size as i32))
        });
        let v = placed(&Lines::new(data, LineTopology::Strip, None).expect("lines"), &camera());
        let screen = PixelRect { x: 0..i32::from(SCREEN.0), y: 0..i32::from(SCREEN.1) };
        let mut expected = Vec::new();
        for (k, v) in v.iter().enumerate() {
            let rect = square((v.x, v.y), size).intersection(&screen);
            for y in rect.y {
                expected.extend(rect.x.clone().map(|x| ((x, y), v.z, value(k))));
            }
        }
        assert_eq!(seen, expected, "seed {}", rng.seed());
    }
}

/// The share of a pixel-sized box, turned to the line, that a line covers.
fn coverage(a: [f64; 2], b: [f64; 2], width: f64, pixel: (i32, i32)) -> f64 {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    let (u, v) = ((b[0] - a[0]) / length, (b[1] - a[1]) / length);
    let (x, y) = (f64::from(pixel.0) + 0.5 - a[0], f64::from(pixel.1) + 0.5 - a[1]);
    let overlap = |at: f64, low: f64, high: f64| ((at + 0.5).min(high) - (at - 0.5).max(low)).max(0.0);
    overlap(u * y - v * x, -width / 2.0, width / 2.0) * overlap(u * x + v * y, 0.0, length)
}

#[test]
fn smooth_lines_cover_pixels_in_proportion() {
    let mut rng = Rng::new(25);
    let mut worst = 0_f64;
    for _ in 0..100 {
        let ends = in_view(&mut rng, 2);
        let lines = Lines::new(Vertices::new(Positions::Exact(&ends)), LineTopology::Pairs, None).expect("a line");
        let [a, b] = placed(&lines, &camera())[..] else { panic!("two ends") };
        let width = rng.pick(&[64, 128, 256, 400, 1280, 5000]);
        let (picture, ..) = whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| {
            scene.draw_lines_with(
                EVERYTHING,
                &lines,
                &camera(),
                &Flat::unlit(Rgb888::WHITE),
                &Smooth::new(Pixels::from_bits(width)),
            );
        });
        let [a, b] = [a, b].map(|v| [f64::from(v.x) / 256.0, f64::from(v.y) / 256.0]);
        for (k, [red, ..]) in picture.iter().enumerate() {
            let pixel = (k as i32 % i32::from(SCREEN.0), k as i32 / i32::from(SCREEN.0));
            let exact = coverage(a, b, f64::from(width) / 256.0, pixel);
            let error = (f64::from(*red) - 255.0 * exact).abs();
            worst = worst.max(error);
            assert!(error <= 4.0, "seed {}: {a:?} {b:?} {width} {pixel:?}: {red}, {exact}", rng.seed());
        }
    }
    println!("worst error of coverage: {worst} of 255");
    support::accuracy::check("coverage of a pixel by a smooth line", worst);
}

/// Ends anywhere within ±32,767 px, so that the line crosses the screen.
#[test]
fn wide_lines_from_far_away_are_where_they_should_be() {
    let mut rng = Rng::new(27);
    let (mut worst, mut drawn) = (0_f64, 0);
    for case in 0..300 {
        const LIMIT: i32 = 32_767;
        let (x, y) = (rng.between(0, 160), rng.between(0, 120));
        // From a place on the border through a place on the screen, and as far on as there is room.
        let border = rng.between(-LIMIT, LIMIT);
        let edge = rng.pick(&[-LIMIT, LIMIT]);
        let a = if rng.one_in(2) { [edge, border] } else { [border, edge] };
        let way = [x - a[0], y - a[1]].map(f64::from);
        let most = [0, 1].map(|k| (f64::from(LIMIT) - f64::from([x, y][k]) * way[k].signum()) / way[k].abs());
        let on = rng.pick(&[0.0, 0.001, most[0].min(most[1])]).min(most[0].min(most[1]));
        let b = [0, 1].map(|k| f64::from([x, y][k]) + on * way[k]);
        let [a, b] = [a.map(f64::from), b].map(|p| p.map(|c| (256.0 * c).round() as i32));
        let width = rng.pick(&[256, 1280, 20_000, 200_000]);
        let [from, to] = [a, b].map(|p| ScreenPoint::new(Pixels::from_bits(p[0]), Pixels::from_bits(p[1])));
        let smooth = case % 2 == 0;
        let (picture, ..) = whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| match smooth {
            true => scene.canvas().line_with(from, to, Rgb888::WHITE, &Smooth::new(Pixels::from_bits(width))),
            false => scene.canvas().line_with(from, to, Rgb888::WHITE, &Thick::new(Pixels::from_bits(width))),
        });
        let [a, b] = [from, to].map(|p| [p.x().to_num::<f64>(), p.y().to_num()]);
        for (k, [red, ..]) in picture.iter().enumerate() {
            let pixel = (k as i32 % i32::from(SCREEN.0), k as i32 / i32::from(SCREEN.0));
            let exact = coverage(a, b, f64::from(width) / 256.0, pixel);
            drawn += u32::from(*red > 0);
            let case = format!("seed {}: {a:?} {b:?} {width} {pixel:?}: {red}, {exact}", rng.seed());
            if smooth {
                worst = worst.max((f64::from(*red) - 255.0 * exact).abs());
                assert!((f64::from(*red) - 255.0 * exact).abs() <= 8.0, "{case}");
            } else {
                // Covered by half, the centre is on a side; by a quarter, it may be in a corner.
                assert!(*red == 255 || exact < 0.52, "{case}");
                assert!(*red == 0 || exact > 0.23, "{case}");
            }
        }
    }
    assert!(drawn > 100_000, "{drawn}");
    println!("worst error of coverage: {worst} of 255");
}

#[test]
fn thick_lines_are_rectangles() {
    let mut rng = Rng::new(26);
    for _ in 0..100 {
        let ends = in_view(&mut rng, 2);
        let lines = Lines::new(Vertices::new(Positions::Exact(&ends)), LineTopology::Pairs, None).expect("a line");
        let [a, b] = placed(&lines, &camera())[..] else { panic!("two ends") };
        let width = rng.pick(&[64, 256, 700, 2560, 10_000]);
        let seen = fragments(|scene, shader| {
            scene.draw_lines_with(EVERYTHING, &lines, &camera(), shader, &Thick::new(Pixels::from_bits(width)))
        });
        let mut hits = BTreeMap::new();
        seen.iter().for_each(|(position, ..)| *hits.entry(*position).or_insert(0) += 1);
        let [a, b] = [a, b].map(|v| [f64::from(v.x) / 256.0, f64::from(v.y) / 256.0]);
        let (length, half) = ((b[0] - a[0]).hypot(b[1] - a[1]), f64::from(width) / 512.0);
        let (u, v) = ((b[0] - a[0]) / length, (b[1] - a[1]) / length);
        for pixel in (0..i32::from(SCREEN.1)).flat_map(|y| (0..i32::from(SCREEN.0)).map(move |x| (x, y))) {
            let (x, y) = (f64::from(pixel.0) + 0.5 - a[0], f64::from(pixel.1) + 0.5 - a[1]);
            let (across, along) = (half - (u * y - v * x).abs(), (u * x + v * y).min(length - u * x - v * y));
            let inside = across.min(along);
            let count = hits.get(&pixel).copied().unwrap_or(0);
            let case = format!("seed {}: {a:?} {b:?} {width} {pixel:?}: {count}, {inside}", rng.seed());
            // Corners are rounded to 1/256 px.
            match inside {
                d if d > 0.01 => assert_eq!(count, 1, "{case}"),
                d if d < -0.01 => assert_eq!(count, 0, "{case}"),
                _ => assert!(count <= 1, "{case}"),
            }
        }
    }
}

#[test]
fn a_stroke_that_changes_between_strips_is_an_error() {
    let ends = [Vec3::ZERO, Vec3::from_milli(500, 500, 0)];
    let lines = Lines::new(Vertices::new(Positions::Exact(&ends)), LineTopology::Pairs, None).expect("a line");
    let other = Lines::new(Vertices::new(Positions::Exact(&ends)), LineTopology::Loop, None).expect("a line");
    let (mut color, mut depth, mut records) = ([0; 160 * 10], [0; 160 * 10], [0; 200]);
    let renderer = zstrip::Renderer::<Rgb565>::new(Size::new(SCREEN.0.into(), SCREEN.1.into()))
        .expect("a renderer")
        .with_depth(&mut depth)
        .expect("a renderer");
    let mut renderer = renderer.with_records(&mut records);
    let mut calls = 0;
    let sink = |_: &zstrip::target::StripPixels<'_, Rgb565>| Ok::<(), core::convert::Infallible>(());
    let result = renderer.frame_to(sink, &mut color, Rgb565::BLACK, |scene| {
        calls += 1;
        scene.draw_lines(if calls < 4 { &lines } else { &other }, &camera(), &Flat::unlit(Rgb888::RED), &Thin);
    });
    assert_eq!(result, Err(zstrip::frame::FrameError::SceneChanged { draw: 0 }));
    assert_eq!(calls, 4);
}

#[test]
fn depth_decides_between_lines_and_faces() {
    // A line through a square in the middle: half of it is in front.
    let corners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]].map(|[x, y, z]| Vec3::from_ints(x, y, z));
    let data = MeshData::new(Positions::Exact(&corners));
    let mesh = MeshData { topology: zstrip::mesh::Topology::Quads, ..data };
    let mesh = zstrip::mesh::Mesh::new(mesh).expect("a mesh");
    let ends = [Vec3::from_milli(-900, 0, 500), Vec3::from_milli(900, 0, -500)];
    let line = Lines::new(Vertices::new(Positions::Exact(&ends)), LineTopology::Pairs, None).expect("a line");
    let draw = |first: bool| {
        let (picture, ..) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| {
            if first {
                scene.draw_lines(&line, &camera(), &Flat::unlit(Rgb888::RED), &Thin);
            }
            scene.draw(&mesh, &camera(), &Flat::unlit(Rgb888::BLUE));
            if !first {
                scene.draw_lines(&line, &camera(), &Flat::unlit(Rgb888::RED), &Thin);
            }
        });
        picture
    };
    let (red, picture) = (Rgb565::from_color(Rgb565::RED), draw(false));
    assert_eq!(draw(true), picture);
    let columns: Vec<_> = (0..picture.len()).filter(|k| picture[*k] == red).map(|k| k % 160).collect();
    assert!(columns.iter().all(|x| *x < 81), "{columns:?}");
    assert!(columns.len() > 30);
}
