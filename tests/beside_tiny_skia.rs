//! Smooth shapes beside those of tiny-skia, and both beside exact areas: docs/accuracy.md has the differences.

use crate::reference::rng::Rng;
use crate::support::accuracy;
use crate::support::area::{Contour, areas, compare};
use crate::support::outlines::{SCREEN, arc, center, curved, drawn, px, thick};
use tiny_skia::{FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};
use zstrip::ScreenPoint;
use zstrip::scene::Outline;
use zstrip::shape::{Cap, Circle, CurvePath, Join, Path, PathStep, Polyline, RoundedRectangle};

/// The covered parts of a shape that tiny-skia draws, of 255.
fn drawn_by_skia(path: &tiny_skia::Path, rule: FillRule, stroke: Option<&Stroke>) -> Vec<u8> {
    let mut pixmap = Pixmap::new(SCREEN.0.into(), SCREEN.1.into()).expect("a picture");
    let mut paint = Paint::default();
    paint.set_color_rgba8(255, 255, 255, 255);
    match stroke {
        None => pixmap.fill_path(path, &paint, rule, Transform::identity(), None),
        Some(stroke) => pixmap.stroke_path(path, &paint, stroke, Transform::identity(), None),
    }
    pixmap.pixels().iter().map(|pixel| pixel.alpha()).collect()
}

/// Mean and worst differences of one kind of shape, of 255: zstrip and exact, tiny-skia and exact, both.
struct Differences {
    name: &'static str,
    means: [f64; 3],
    worst: [f64; 3],
    count: f64,
}

impl Differences {
    fn new(name: &'static str) -> Self {
        Self { name, means: [0.0; 3], worst: [0.0; 3], count: 0.0 }
    }

    fn add(&mut self, shape: &impl Outline, by_skia: &[u8], exact: &[f64]) {
        let found = drawn(shape, 64, SCREEN.0);
        let both: Vec<_> = by_skia.iter().map(|part| f64::from(*part) / 255.0).collect();
        // The mean of both is over the pixels of the others, too.
        let partial = exact.iter().filter(|part| **part > 1e-6 && **part < 1.0 - 1e-6).count().max(1);
        let sum: f64 = found.iter().zip(&both).map(|(a, b)| (f64::from(*a) / 255.0 - b).abs()).sum();
        let of_exact = [compare(&found, exact), compare(by_skia, exact)];
        for (k, (worst, mean, _)) in of_exact.into_iter().enumerate() {
            self.worst[k] = self.worst[k].max(255.0 * worst);
            self.means[k] += 255.0 * mean;
        }
        self.worst[2] = self.worst[2].max(255.0 * compare(&found, &both).0);
        self.means[2] += 255.0 * sum / partial as f64;
        self.count += 1.0;
    }

    /// Prints the row of the page, and holds the differences to it.
    fn check(self) {
        let found: Vec<_> = (0..6)
            .map(|k| if k % 2 == 0 { self.means[k / 2] / self.count } else { self.worst[k / 2] })
            .map(|value| (100.0 * value).round() / 100.0)
            .collect();
        let cells: Vec<_> = found.iter().map(|value| format!("{value:.2}")).collect();
        println!("accuracy: | {} | {} |", self.name, cells.join(" | "));
        let row = accuracy::PAGE.lines().find_map(|line| line.strip_prefix(&format!("| {} | ", self.name)));
        let row = row.unwrap_or_else(|| panic!("docs/accuracy.md has no row `{}`", self.name));
        let stated: Vec<f64> = row.split('|').filter_map(|cell| cell.trim().parse().ok()).collect();
        assert_eq!(stated.len(), found.len(), "{row}");
        // tiny-skia's sines and roots are those of the machine: the last digit may differ.
        for (found, stated) in found.iter().zip(stated) {
            assert!((found - stated).abs() <= 0.02, "{}: {found} instead of {stated}", self.name);
        }
        assert!(self.means[0] <= self.means[1] && self.worst[0] <= self.worst[1], "{}", self.name);
    }
}

const CASES: usize = 24;

fn f32s([x, y]: [f64; 2]) -> (f32, f32) {
    (x as f32, y as f32)
}

fn closed(contours: &[Contour]) -> tiny_skia::Path {
    let mut path = PathBuilder::new();
    for contour in contours {
        for (k, point) in contour.iter().enumerate() {
            let (x, y) = f32s(*point);
            if k == 0 {
                path.move_to(x, y);
            } else {
                path.line_to(x, y);
            }
        }
        path.close();
    }
    path.finish().expect("a path")
}

fn polygons(name: &'static str, seed: u64, rule: (zstrip::shape::FillRule, FillRule)) {
    let mut rng = Rng::new(seed);
    let mut differences = Differences::new(name);
    for _ in 0..CASES {
        let corners = rng.between(3, 9);
        let (points, exact): (Vec<_>, Vec<_>) = (0..corners).map(|_| center(&mut rng)).unzip();
        let exact = [exact];
        let by_skia = drawn_by_skia(&closed(&exact), rule.1, None);
        let exact = areas(&exact, rule.1 == FillRule::EvenOdd, (64, 48));
        differences.add(&Path::new(&[&points]).with_rule(rule.0), &by_skia, &exact);
    }
    differences.check();
}

#[test]
fn polygons_are_nearer_to_their_areas() {
    polygons("polygons, winding number not 0", 31, (zstrip::shape::FillRule::NonZero, FillRule::Winding));
    polygons("polygons, winding number odd", 32, (zstrip::shape::FillRule::EvenOdd, FillRule::EvenOdd));
}

#[test]
fn circles_are_nearer_to_their_areas() {
    let mut rng = Rng::new(33);
    let mut differences = Differences::new("circles");
    for _ in 0..CASES {
        let (at, place) = center(&mut rng);
        let radius = rng.between(200, 8000);
        let r = f64::from(radius) / 256.0;
        let (x, y) = f32s(place);
        let by_skia =
            drawn_by_skia(&PathBuilder::from_circle(x, y, r as f32).expect("a circle"), FillRule::Winding, None);
        let exact = areas(&[arc(place, [r; 2], 0.0, 1.0)], false, (64, 48));
        differences.add(&Circle::new(at, px(radius)), &by_skia, &exact);
    }
    differences.check();
}

#[test]
fn rectangles_are_nearer_to_their_areas() {
    let mut rng = Rng::new(37);
    let mut differences = Differences::new("rectangles with round corners");
    for _ in 0..CASES {
        let ((a, p), (b, q)) = (center(&mut rng), center(&mut rng));
        let (from, to) = ([p[0].min(q[0]), p[1].min(q[1])], [p[0].max(q[0]), p[1].max(q[1])]);
        let least = (to[0] - from[0]).min(to[1] - from[1]) / 2.0;
        if least < 1.0 {
            continue;
        }
        let r = (f64::from(rng.between(128, 3000)) / 256.0).min(least);
        let r = (r * 256.0).floor() / 256.0;
        let corner = |x: f64, y: f64, turn: f64| arc([x, y], [r; 2], turn, turn + 0.25);
        let contour = [
            corner(to[0] - r, from[1] + r, 0.75),
            corner(to[0] - r, to[1] - r, 0.0),
            corner(from[0] + r, to[1] - r, 0.25),
            corner(from[0] + r, from[1] + r, 0.5),
        ]
        .concat();
        let mut path = PathBuilder::new();
        // Quarters of circles as cubic curves, which are within r / 3,600 of them.
        let c = r * (1.0 - 0.552_284_75);
        let quarter = |path: &mut PathBuilder, corner: [f64; 2], start: [f64; 2], end: [f64; 2]| {
            let toward = |p: [f64; 2]| [0, 1].map(|k| corner[k] + (p[k] - corner[k]) / r * c);
            let [(x0, y0), (x1, y1), (x2, y2), (x3, y3)] = [start, toward(start), toward(end), end].map(f32s);
            if path.is_empty() {
                path.move_to(x0, y0);
            } else {
                path.line_to(x0, y0);
            }
            path.cubic_to(x1, y1, x2, y2, x3, y3);
        };
        quarter(&mut path, [to[0], from[1]], [to[0] - r, from[1]], [to[0], from[1] + r]);
        quarter(&mut path, to, [to[0], to[1] - r], [to[0] - r, to[1]]);
        quarter(&mut path, [from[0], to[1]], [from[0] + r, to[1]], [from[0], to[1] - r]);
        quarter(&mut path, from, [from[0], from[1] + r], [from[0] + r, from[1]]);
        path.close();
        let by_skia = drawn_by_skia(&path.finish().expect("a path"), FillRule::Winding, None);
        let exact = areas(&[contour], false, (64, 48));
        differences.add(&RoundedRectangle::new(a, b).with_radius(px((r * 256.0) as i32)), &by_skia, &exact);
    }
    differences.check();
}

#[test]
fn lines_are_nearer_to_their_areas() {
    lines("thick lines with joins and caps", 34, false);
    lines("thick lines with dashes", 35, true);
}

#[test]
fn curves_are_nearer_to_their_areas() {
    let mut rng = Rng::new(36);
    let mut differences = Differences::new("curves of the second and third degree");
    for _ in 0..CASES {
        let (steps, contour) = curved(&mut rng, &mut center);
        let mut path = PathBuilder::new();
        for step in &steps {
            let place = |p: &ScreenPoint| (p.x().to_num::<f32>(), p.y().to_num::<f32>());
            match step {
                PathStep::Move(to) => path.move_to(place(to).0, place(to).1),
                PathStep::Line(to) => path.line_to(place(to).0, place(to).1),
                PathStep::Quad(a, to) => path.quad_to(place(a).0, place(a).1, place(to).0, place(to).1),
                PathStep::Cubic(a, b, to) => {
                    let [(ax, ay), (bx, by), (x, y)] = [a, b, to].map(place);
                    path.cubic_to(ax, ay, bx, by, x, y);
                }
            }
        }
        path.close();
        let by_skia = drawn_by_skia(&path.finish().expect("a path"), FillRule::Winding, None);
        differences.add(&CurvePath::new(&steps), &by_skia, &areas(&[contour], false, (64, 48)));
    }
    differences.check();
}

fn lines(name: &'static str, seed: u64, dashed: bool) {
    let mut rng = Rng::new(seed);
    let mut differences = Differences::new(name);
    for case in 0..CASES {
        let count = rng.between(2, 6);
        let (points, exact): (Vec<_>, Vec<_>) = (0..count).map(|_| center(&mut rng)).unzip();
        // Narrower lines of tiny-skia are hairlines of a coverage that is not their area.
        let width = rng.between(300, 2000);
        let join = [Join::Miter, Join::Round, Join::Bevel][case % 3];
        let cap = [Cap::Butt, Cap::Round, Cap::Square][case / 3 % 3];
        let pattern: Vec<_> = if dashed { (0..2).map(|_| rng.between(500, 4000)).collect() } else { Vec::new() };
        let offset = rng.between(0, 3000);
        let (fixed, pixels): (Vec<_>, Vec<_>) =
            pattern.iter().map(|bits| (px(*bits), f64::from(*bits) / 256.0)).unzip();
        let total: f64 = pixels.iter().sum();
        let start = if dashed { (f64::from(offset) / 256.0).rem_euclid(total) } else { 0.0 };
        let line = Polyline::new(&points, px(width)).with_join(join).with_cap(cap).with_dashes(&fixed, px(offset));
        let mut path = PathBuilder::new();
        for (k, point) in exact.iter().enumerate() {
            let (x, y) = f32s(*point);
            if k == 0 {
                path.move_to(x, y);
            } else {
                path.line_to(x, y);
            }
        }
        let stroke = Stroke {
            width: width as f32 / 256.0,
            miter_limit: 4.0,
            line_cap: [LineCap::Butt, LineCap::Round, LineCap::Square][case / 3 % 3],
            line_join: [LineJoin::Miter, LineJoin::Round, LineJoin::Bevel][case % 3],
            dash: StrokeDash::new(pixels.iter().map(|length| *length as f32).collect(), offset as f32 / 256.0),
        };
        let by_skia = drawn_by_skia(&path.finish().expect("a path"), FillRule::Winding, Some(&stroke));
        let half = f64::from(width) / 512.0;
        let exact = areas(&thick(&exact, false, half, join, cap, 4.0, &pixels, start), false, (64, 48));
        differences.add(&line, &by_skia, &exact);
    }
    differences.check();
}
