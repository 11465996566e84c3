//! Shapes with smooth edges: the covered part of each pixel against exact areas, strips, memory, and all that is
//! degenerate.

use crate::reference::rng::Rng;
use crate::support::area::{Contour, areas, compare};
use crate::support::outlines::{BOUND, Errors, SCREEN, arc, center, curved, drawn, px, thick, turned};
use crate::support::{accuracy, difference, strips, whole};
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888, RgbColor};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::math::{Angle16, Pixels, Scalar};
use zstrip::scene::ShapeBuffer;
use zstrip::shape::{
    Cap, Circle, CurvePath, Ellipse, FillRule, Join, Path, PathStep, Polyline, Ring, RoundedRectangle,
};
use zstrip::span::DepthState;
use zstrip::target::Framebuffer;
use zstrip::{Canvas, Scene, ScreenPoint};

type Bits = [i32; 2];

fn points(contours: &[Vec<Bits>]) -> Vec<Vec<ScreenPoint>> {
    let point = |p: &Bits| ScreenPoint::new(Pixels::from_bits(p[0]), Pixels::from_bits(p[1]));
    contours.iter().map(|contour| contour.iter().map(point).collect()).collect()
}

fn in_pixels(contours: &[Vec<Bits>]) -> Vec<Contour> {
    contours.iter().map(|contour| contour.iter().map(|p| p.map(|c| f64::from(c) / 256.0)).collect()).collect()
}

/// Random contours of one of many kinds.
fn contours(rng: &mut Rng) -> Vec<Vec<Bits>> {
    let any = |rng: &mut Rng| [rng.between(-2000, 18_000), rng.between(-2000, 14_000)];
    let kind = rng.below(9);
    let count = 1 + rng.below(3) as usize;
    (0..count)
        .map(|_| {
            let corners = match kind {
                0 => 3,
                1 => 4,
                2 => 3 + rng.below(20) as usize,
                _ => 3 + rng.below(6) as usize,
            };
            let middle = any(rng);
            let mut corner = || match kind {
                // On a grid, so that edges and corners coincide.
                3 => any(rng).map(|c| c / 128 * 128),
                4 => any(rng).map(|c| c / 1024 * 1024),
                // In few pixels.
                5 => middle.map(|c| c + rng.between(-300, 300)),
                // Flat.
                6 => [rng.between(-2000, 18_000), middle[1] + rng.between(-90, 90)],
                // Steep.
                7 => [middle[0] + rng.between(-90, 90), rng.between(-2000, 14_000)],
                // Far off.
                8 => [rng.between(-9_000_000, 9_000_000), rng.between(-9_000_000, 9_000_000)],
                _ => any(rng),
            };
            (0..corners).map(|_| corner()).collect()
        })
        .collect()
}

/// Returns the number of cases of a test: a quarter of them without optimization, where they take minutes.
const fn cases(all: usize) -> usize {
    if cfg!(debug_assertions) { all / 4 } else { all }
}

#[test]
fn covered_parts_are_exact_areas() {
    let mut rng = Rng::new(1);
    let (mut worst, mut sum, mut count) = ([0_f64; 2], 0.0, 0);
    for case in 0..cases(200) {
        let bits = contours(&mut rng);
        let points = points(&bits);
        let slices: Vec<_> = points.iter().map(Vec::as_slice).collect();
        let exact = [false, true].map(|even_odd| areas(&in_pixels(&bits), even_odd, (64, 48)));
        // With room for all edges, and for very few of them.
        for (k, edges) in [200, 4 + rng.below(6) as usize].into_iter().enumerate() {
            for (rule, exact) in [FillRule::NonZero, FillRule::EvenOdd].into_iter().zip(&exact) {
                let found = drawn(&Path::new(&slices).with_rule(rule), edges, 64);
                let (error, mean, at) = compare(&found, exact);
                assert!(
                    error <= BOUND,
                    "case {case}, {rule:?}, {edges} edges: pixel ({}, {}) is {}, exactly {}: {bits:?}",
                    at % 64,
                    at / 64,
                    f64::from(found[at]) / 255.0,
                    exact[at]
                );
                worst[k] = worst[k].max(error);
                (sum, count) = (sum + mean, count + 1);
            }
        }
    }
    println!("polygons: mean error 1/{:.0}", f64::from(count) / sum);
    accuracy::check("coverage of a pixel by a polygon", worst[0] * 255.0);
    accuracy::check("coverage of a pixel by a polygon, with memory for 4 to 9 edges", worst[1] * 255.0);
}

/// A length or a place of any size, most of them near the screen.
fn any_bits(rng: &mut Rng) -> i32 {
    match rng.below(12) {
        0 => rng.next_u64() as i32,
        1 => rng.pick(&[i32::MIN, i32::MAX, 0, -1, 1 << 23, -(1 << 23)]),
        2 => rng.between(-9_000_000, 9_000_000),
        _ => rng.between(-1000, 17_000),
    }
}

fn any_point(rng: &mut Rng) -> ScreenPoint {
    ScreenPoint::new(px(any_bits(rng)), px(any_bits(rng)))
}

/// Fills a shape of any kind: small, huge, degenerate.
fn fill_any<F: Framebuffer>(canvas: &mut Canvas<'_, '_, F>, rng: &mut Rng, buffer: &mut ShapeBuffer<'_>) {
    let [r, g, b] = [(); 3].map(|()| rng.below(256) as u8);
    let color = Rgb888::new(r, g, b);
    let at = any_point(rng);
    let [a, b] = [(); 2].map(|()| px(any_bits(rng)));
    let round = rng.pick(&[false, true]);
    match rng.below(8) {
        0 => canvas.fill(&Circle::new(at, a), color, buffer),
        1 => {
            let angle = if round { Angle16(rng.next_u64() as u16) } else { Angle16::ZERO };
            canvas.fill(&Ellipse::new(at, a, b).turned(angle), color, buffer);
        }
        6 => {
            let steps: Vec<_> = (0..rng.below(6))
                .map(|_| match rng.below(5) {
                    0 => PathStep::Move(any_point(rng)),
                    1 => PathStep::Line(any_point(rng)),
                    2 => PathStep::Quad(any_point(rng), any_point(rng)),
                    _ => PathStep::Cubic(any_point(rng), any_point(rng), any_point(rng)),
                })
                .collect();
            let path = CurvePath::new(&steps).at(at).turned(Angle16(rng.next_u64() as u16));
            let scale = rng.pick(&[1 << 16, 40_000, -65_536, 0, i32::MAX, i32::MIN]);
            canvas.fill(&path.scaled(Scalar::from_bits(scale)), color, buffer);
        }
        2 | 3 => {
            let ring = Ring::new(at, a, b).part(Angle16(rng.next_u64() as u16), any_bits(rng));
            canvas.fill(&if round { ring.with_round_ends() } else { ring }, color, buffer);
        }
        4 => canvas.fill(&RoundedRectangle::new(at, any_point(rng)).with_radii(a, b), color, buffer),
        5 => {
            let points: Vec<_> = (0..rng.below(6)).map(|_| any_point(rng)).collect();
            let pattern: Vec<_> = (0..rng.below(4)).map(|_| px(any_bits(rng))).collect();
            let line = Polyline::new(&points, px(any_bits(rng) / 8))
                .with_join(rng.pick(&[Join::Miter, Join::Round, Join::Bevel]))
                .with_cap(rng.pick(&[Cap::Butt, Cap::Round, Cap::Square]))
                .with_miter_limit(rng.next_u64() as u8)
                .with_dashes(&pattern, b);
            canvas.fill(&if round { line.closed() } else { line }, color, buffer);
        }
        _ => {
            let points = points(&contours(rng));
            let slices: Vec<_> = points.iter().map(Vec::as_slice).collect();
            let rule = rng.pick(&[FillRule::NonZero, FillRule::EvenOdd]);
            canvas.fill(&Path::new(&slices).with_rule(rule), color, buffer);
        }
    }
}

/// Some of all kinds of shapes.
fn draw_any<F: Framebuffer>(scene: &mut Scene<'_, F>, seed: u64, words: &mut [u32]) {
    let rng = &mut Rng::new(seed);
    let mut buffer = ShapeBuffer::new(words, 64).expect("enough words");
    let mut canvas = scene.canvas();
    for _ in 0..cases(30) {
        fill_any(&mut canvas, rng, &mut buffer);
        if rng.one_in(4) {
            let corner = Point::new(rng.between(-20, 60), rng.between(-20, 60));
            let area = Rectangle::new(corner, Size::new(rng.below(40) as u32, rng.below(40) as u32));
            canvas.set_scissor((!rng.one_in(3)).then_some(&area));
        }
        canvas.set_depth(rng.next_u64() as u16, rng.pick(&[DepthState::LESS, DepthState::OFF, DepthState::LESS_EQUAL]));
    }
}

#[test]
fn strips_do_not_matter() {
    for seed in 0..cases(10) as u64 {
        for edges in [5, 100] {
            let mut words = vec![0; ShapeBuffer::words(64, edges)];
            let (expected, ..) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| draw_any(scene, seed, &mut words));
            assert!(expected.iter().any(|pixel| *pixel != 0));
            for (rows, records) in [(1, 0), (7, 100), (16, 0), (48, 100)] {
                let (picture, _) =
                    strips::<Rgb565>(SCREEN, rows, records, Rgb565::BLACK, |scene| draw_any(scene, seed, &mut words));
                assert_eq!(difference(&picture, &expected, SCREEN.0), None, "seed {seed}, {rows} rows");
            }
        }
    }
}

#[test]
fn round_shapes_are_round() {
    let mut rng = Rng::new(5);
    let mut errors = Errors::new("circles and ellipses");
    for case in 0..cases(60) {
        let (at, place) = center(&mut rng);
        let radius = rng.between(0, [300, 2000, 8000][case % 3]);
        let r = f64::from(radius) / 256.0;
        errors.add(&Circle::new(at, px(radius)), &[arc(place, [r; 2], 0.0, 1.0)]);
        let other = rng.between(0, 8000);
        errors.add(&Ellipse::new(at, px(radius), px(other)), &[arc(place, [r, f64::from(other) / 256.0], 0.0, 1.0)]);
    }
    // So large that only a part is on the screen.
    for _ in 0..cases(20) {
        let radius = rng.between(10_000, 4096 * 256);
        let r = f64::from(radius) / 256.0;
        let turn = rng.unit();
        let [x, y] = turned([32.0, 24.0], [r; 2], turn).map(|c| (c * 256.0) as i32);
        let place = [x, y].map(|c| f64::from(c) / 256.0);
        let part = 50.0 / r;
        let mut contour = arc(place, [r; 2], turn + 0.5 - part, turn + 0.5 + part);
        contour.extend([
            turned(place, [r; 2], turn + 0.25),
            turned(place, [r; 2], turn),
            turned(place, [r; 2], turn - 0.25),
        ]);
        errors.add(&Circle::new(ScreenPoint::new(px(x), px(y)), px(radius)), &[contour]);
    }
    errors.print();
    accuracy::check("coverage of a pixel by a circle or an ellipse", errors.worst * 255.0);
    let mut errors = Errors::new("rings and pies");
    for case in 0..cases(80) {
        let (at, place) = center(&mut rng);
        let [a, b] = [(); 2].map(|()| rng.between(0, 8000));
        let (outer, inner) = (a.max(b), if case % 4 == 0 { 0 } else { a.min(b) });
        let (ro, ri) = (f64::from(outer) / 256.0, f64::from(inner) / 256.0);
        let ring = Ring::new(at, px(outer), px(inner));
        let mut back = arc(place, [ri; 2], 0.0, 1.0);
        back.reverse();
        errors.add(&ring, &[arc(place, [ro; 2], 0.0, 1.0), back]);
        let from = Angle16(rng.next_u64() as u16);
        let sweep = rng.between(-66_000, 66_000);
        if sweep.abs() >= 65_536 {
            continue;
        }
        let start = f64::from(from.0) / 65_536.0;
        let (start, end) =
            (start.min(start + f64::from(sweep) / 65_536.0), start.max(start + f64::from(sweep) / 65_536.0));
        let mut back = arc(place, [ri; 2], start, end);
        back.reverse();
        let forth = arc(place, [ro; 2], start, end);
        errors.add(&ring.part(from, sweep), &[[forth, back].concat()]);
        let mut contours = vec![arc(place, [ro; 2], start, end)];
        let mut back = arc(place, [ri; 2], start, end);
        back.reverse();
        contours[0].extend(back);
        if sweep != 0 {
            for turn in [start, end] {
                let middle = turned(place, [(ro + ri) / 2.0; 2], turn);
                contours.push(arc(middle, [(ro - ri) / 2.0; 2], 0.0, 1.0));
            }
        }
        if sweep.abs() < 40_000 {
            errors.add(&ring.part(from, sweep).with_round_ends(), &contours);
        }
    }
    errors.print();
    accuracy::check("coverage of a pixel by a part of a ring", errors.worst * 255.0);
    let mut errors = Errors::new("rectangles");
    for _ in 0..cases(60) {
        let ((a, p), (b, q)) = (center(&mut rng), center(&mut rng));
        let radius = rng.between(0, 3000);
        let (from, to) = ([p[0].min(q[0]), p[1].min(q[1])], [p[0].max(q[0]), p[1].max(q[1])]);
        let r = f64::from(radius) / 256.0;
        let radii = [r.min((to[0] - from[0]) / 2.0), r.min((to[1] - from[1]) / 2.0)];
        let corner = |x: f64, y: f64, turn: f64| arc([x, y], radii, turn, turn + 0.25);
        let contour = [
            corner(to[0] - radii[0], from[1] + radii[1], 0.75),
            corner(to[0] - radii[0], to[1] - radii[1], 0.0),
            corner(from[0] + radii[0], to[1] - radii[1], 0.25),
            corner(from[0] + radii[0], from[1] + radii[1], 0.5),
        ];
        errors.add(&RoundedRectangle::new(a, b).with_radius(px(radius)), &[contour.concat()]);
        let sharp = vec![from, [to[0], from[1]], to, [from[0], to[1]]];
        errors.add(&RoundedRectangle::new(a, b), &[sharp]);
    }
    errors.print();
    accuracy::check("coverage of a pixel by a rectangle with round corners", errors.worst * 255.0);
}

#[test]
fn thick_lines_are_their_segments_joins_and_caps() {
    let mut rng = Rng::new(8);
    let mut errors = Errors::new("thick lines");
    for case in 0..cases(150) {
        let count = rng.between(2, 6);
        // On the screen, or on both sides of it. Exact areas of hundreds of round caps would take minutes.
        let wide_apart = case % 4 >= 2;
        let point = |rng: &mut Rng| {
            let (at, place) = center(rng);
            if !wide_apart {
                return (at, place);
            }
            let wide = |bits: i32| 4 * bits - 96 * 256;
            (ScreenPoint::new(px(wide(at.x().to_bits())), at.y()), [4.0 * place[0] - 96.0, place[1]])
        };
        let points: Vec<_> = (0..count).map(|_| point(&mut rng)).collect();
        let (line, exact): (Vec<_>, Vec<_>) = points.into_iter().unzip();
        let width = rng.between(20, [600, 3000][case % 2]);
        let join =
            rng.pick(if wide_apart { &[Join::Miter, Join::Bevel] } else { &[Join::Miter, Join::Round, Join::Bevel] });
        let cap = rng.pick(if wide_apart { &[Cap::Butt, Cap::Square] } else { &[Cap::Butt, Cap::Round, Cap::Square] });
        let closed = rng.one_in(3) && count > 2;
        let pattern: Vec<_> = (0..2 * rng.below(3)).map(|_| rng.between(100, 4000)).collect();
        let offset = rng.between(-3000, 3000);
        let fixed: Vec<_> = pattern.iter().map(|bits| px(*bits)).collect();
        let dashes: Vec<_> = pattern.iter().map(|bits| f64::from(*bits) / 256.0).collect();
        let total: f64 = dashes.iter().sum();
        let start = if dashes.is_empty() { 0.0 } else { (f64::from(offset) / 256.0).rem_euclid(total) };
        let shape = Polyline::new(&line, px(width)).with_join(join).with_cap(cap).with_dashes(&fixed, px(offset));
        let shape = if closed { shape.closed() } else { shape };
        let half = f64::from(width) / 512.0;
        let exact = thick(&exact, closed, half, join, cap, 4.0, &dashes, start);
        errors.add(&shape, &exact);
    }
    errors.print();
    accuracy::check("coverage of a pixel by a thick line", errors.worst * 255.0);
}

/// A line to a point and back is the line.
#[test]
fn lines_that_turn_back_cover_nothing_else() {
    let mut rng = Rng::new(11);
    for case in 0..cases(300) {
        let [(a, _), (b, _)] = [center(&mut rng), center(&mut rng)];
        let width = px(rng.between(20, 1000));
        let (there, back) = ([a, b], [a, b, a]);
        let line = Polyline::new(&there, width);
        let found = [drawn(&line, 64, 64), drawn(&line.closed(), 64, 64), drawn(&Polyline::new(&back, width), 64, 64)];
        for other in &found[1..] {
            let most = found[0].iter().zip(other).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(most <= Some(2), "case {case}: {a:?}, {b:?}, {width}: {most:?}");
        }
    }
}

#[test]
fn curves_are_near_their_polynomials() {
    let mut rng = Rng::new(21);
    let mut errors = Errors::of_curves("curves");
    for case in 0..cases(80) {
        let middle = center(&mut rng);
        let reach = [2000, 8000][case % 2];
        let mut near = |rng: &mut Rng| {
            let [x, y] = [(); 2].map(|()| rng.between(-reach, reach));
            let c = f64::from;
            let (point, [a, b]) = middle;
            (ScreenPoint::new(point.x() + px(x), point.y() + px(y)), [a + c(x) / 256.0, b + c(y) / 256.0])
        };
        let (steps, contour) = curved(&mut rng, &mut near);
        errors.add(&CurvePath::new(&steps), &[contour]);
    }
    errors.print();
    accuracy::check("coverage of a pixel by a path of curves", errors.worst * 255.0);
}

#[test]
fn ellipses_and_paths_turn() {
    let mut rng = Rng::new(22);
    let mut errors = Errors::of_curves("turned ellipses");
    for case in 0..cases(60) {
        let (at, place) = center(&mut rng);
        let [a, b] = [(); 2].map(|()| rng.between(0, [2000, 8000][case % 2]));
        let angle = Angle16(rng.next_u64() as u16);
        let (sine, cosine) = (f64::from(angle.0) / 65_536.0 * core::f64::consts::TAU).sin_cos();
        let mut exact = arc([0.0; 2], [a, b].map(|bits| f64::from(bits) / 256.0), 0.0, 1.0);
        for point in &mut exact {
            let [x, y] = *point;
            *point = [place[0] + x * cosine - y * sine, place[1] + x * sine + y * cosine];
        }
        errors.add(&Ellipse::new(at, px(a), px(b)).turned(angle), &[exact]);
    }
    errors.print();
    accuracy::check("coverage of a pixel by a turned ellipse", errors.worst * 255.0);
    let mut errors = Errors::of_curves("turned paths");
    for _ in 0..cases(30) {
        let (at, place) = center(&mut rng);
        let angle = Angle16(rng.next_u64() as u16);
        let (sine, cosine) = (f64::from(angle.0) / 65_536.0 * core::f64::consts::TAU).sin_cos();
        let scale = rng.between(-100_000, 100_000);
        let mut around = |rng: &mut Rng| {
            let [x, y] = [(); 2].map(|()| rng.between(-3000, 3000));
            (ScreenPoint::new(px(x), px(y)), [x, y].map(|c| f64::from(c) / 256.0))
        };
        let (steps, mut exact) = curved(&mut rng, &mut around);
        for point in &mut exact {
            let [x, y] = point.map(|c| c * f64::from(scale) / 65_536.0);
            *point = [place[0] + x * cosine - y * sine, place[1] + x * sine + y * cosine];
        }
        let path = CurvePath::new(&steps).at(at).turned(angle).scaled(Scalar::from_bits(scale));
        errors.add(&path, &[exact]);
    }
    errors.print();
    accuracy::check("coverage of a pixel by a turned path", errors.worst * 255.0);
}

/// A line to the left that ends beyond the screen, in the middle of a dash or not, covers nothing on its right.
#[test]
fn dashed_lines_that_end_left_of_the_screen_cover_nothing_else() {
    let pattern = [px(5 * 256), px(3 * 256)];
    for case in 0..64 {
        let line = [ScreenPoint::corner(10, 10), ScreenPoint::new(px(-40 * 256 - 64 * case), px(30 * 256))];
        let line = Polyline::new(&line, px(512)).with_dashes(&pattern, px(0));
        let found = drawn(&line, 40, 64);
        let right = found.chunks(64).flat_map(|row| &row[13..]).max();
        assert_eq!((found[64 * 10 + 9] > 0, right), (true, Some(&0)), "case {case}: {line:?}");
    }
}

/// Dashes of wide lines reach far beyond their ends, by caps and by miters.
#[test]
fn dashes_of_wide_lines_are_the_same_in_strips() {
    let mut rng = Rng::new(24);
    let mut words = vec![0; ShapeBuffer::words(64, 40)];
    for case in 0..cases(400) {
        let points: Vec<_> = (0..rng.between(2, 5)).map(|_| center(&mut rng).0).collect();
        let pattern: Vec<_> = (0..rng.between(1, 4)).map(|_| px(rng.between(500, 10_000))).collect();
        let line = Polyline::new(&points, px(rng.between(1000, 8000)))
            .with_join(rng.pick(&[Join::Miter, Join::Round, Join::Bevel]))
            .with_cap(rng.pick(&[Cap::Butt, Cap::Round, Cap::Square]))
            .with_miter_limit(16)
            .with_dashes(&pattern, px(rng.between(-10_000, 10_000)));
        let line = if rng.one_in(2) { line.closed() } else { line };
        let expected = drawn(&line, 40, 64);
        let (picture, _) = strips::<Gray8>(SCREEN, 3, 0, Gray8::new(0), |scene| {
            let mut buffer = ShapeBuffer::new(&mut words, 64).expect("enough words");
            scene.canvas().fill(&line, Rgb888::WHITE, &mut buffer);
        });
        assert_eq!(difference(&picture, &expected, SCREEN.0), None, "case {case}: {line:?}");
    }
}

/// A wide line in tiny dashes has far more edges per row than there is memory for.
#[test]
fn tiny_dashes_of_wide_lines_are_the_same_with_little_memory() {
    let mut rng = Rng::new(23);
    for case in 0..cases(12) {
        let [(a, _), (b, _)] = [center(&mut rng), center(&mut rng)];
        // Level, upright, or at any angle.
        let b = [ScreenPoint::new(b.x(), a.y()), ScreenPoint::new(a.x(), b.y()), b][case % 3];
        let pattern = [(); 2].map(|()| px(rng.between(60, 300)));
        let line = [a, b];
        let line = Polyline::new(&line, px(rng.between(2000, 40_000))).with_dashes(&pattern, px(rng.between(0, 300)));
        let most = drawn(&line, 2000, 64).iter().zip(drawn(&line, 32, 64)).map(|(a, b)| a.abs_diff(b)).max();
        assert!(most <= Some(4), "case {case}: {line:?}: {most:?}");
    }
}
