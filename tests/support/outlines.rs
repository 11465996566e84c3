//! Shapes with smooth edges and their exact outlines: pictures of covered parts, contours of arcs and of thick lines in
//! f64, and the worst and mean errors of pictures.

use super::area::{Contour, areas, compare};
use super::whole;
use crate::reference::rng::Rng;
use zstrip::ScreenPoint;
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb888, RgbColor};
use zstrip::math::Pixels;
use zstrip::scene::{Outline, ShapeBuffer};
use zstrip::shape::{Cap, Join, PathStep};

/// The screen of the pictures.
pub const SCREEN: (u16, u16) = (64, 48);

/// Bound of the error of a covered part.
pub const BOUND: f64 = 1.0 / 128.0;

/// A picture of the covered parts, white on black.
pub fn drawn(shape: &impl Outline, edges: usize, width: u16) -> Vec<u8> {
    let mut words = vec![0xDEAD_BEEF; ShapeBuffer::words(width, edges)];
    let mut buffer = ShapeBuffer::new(&mut words, width).expect("enough words");
    whole::<Gray8>(SCREEN, Gray8::new(0), |scene| scene.canvas().fill(shape, Rgb888::WHITE, &mut buffer)).0
}

/// A coordinate of bits, 24.8.
pub fn px(bits: i32) -> Pixels {
    Pixels::from_bits(bits)
}

/// A place on the screen, and the same in f64.
pub fn center(rng: &mut Rng) -> (ScreenPoint, [f64; 2]) {
    let [x, y] = [rng.between(0, 64 * 256), rng.between(0, 48 * 256)];
    (ScreenPoint::new(px(x), px(y)), [f64::from(x) / 256.0, f64::from(y) / 256.0])
}

/// A point of an ellipse, by a part of a turn.
pub fn turned(center: [f64; 2], radii: [f64; 2], turn: f64) -> [f64; 2] {
    let (sine, cosine) = (turn * core::f64::consts::TAU).sin_cos();
    [center[0] + radii[0] * cosine, center[1] + radii[1] * sine]
}

/// An arc in so many chords that they do not matter, from one turn to another.
pub fn arc(center: [f64; 2], radii: [f64; 2], from: f64, to: f64) -> Contour {
    let chords = ((to - from).abs() * 4000.0).ceil().max(8.0) as usize;
    (0..=chords).map(|k| turned(center, radii, from + (to - from) * k as f64 / chords as f64)).collect()
}

/// Worst and mean errors of one kind of shape.
pub struct Errors {
    pub name: &'static str,
    pub worst: f64,
    bound: f64,
    sum: f64,
    count: u32,
}

impl Errors {
    pub fn new(name: &'static str) -> Self {
        Self { name, worst: 0.0, bound: BOUND, sum: 0.0, count: 0 }
    }

    /// Those of shapes whose curves are within 1/64 px.
    pub fn of_curves(name: &'static str) -> Self {
        Self { bound: 1.0 / 64.0, ..Self::new(name) }
    }

    pub fn add(&mut self, shape: &(impl Outline + core::fmt::Debug), exact: &[Contour]) {
        let found = drawn(shape, 64, 64);
        let exact = areas(exact, false, (64, 48));
        let (error, mean, at) = compare(&found, &exact);
        let (x, y) = (at % 64, at / 64);
        let (is, exact) = (f64::from(found[at]) / 255.0, exact[at]);
        assert!(error <= self.bound, "{}: pixel ({x}, {y}) is {is}, exactly {exact}: {shape:?}", self.name);
        self.worst = self.worst.max(error);
        (self.sum, self.count) = (self.sum + mean, self.count + 1);
    }

    pub fn print(&self) {
        let mean = f64::from(self.count) / self.sum;
        println!("{}: worst error 1/{:.0}, mean 1/{mean:.0}", self.name, 1.0 / self.worst);
    }
}

/// The contours of a thick line, in f64: segments, joins and caps, all clockwise.
#[allow(clippy::too_many_arguments)] // the parts of a stroke
pub fn thick(
    points: &[[f64; 2]],
    closed: bool,
    half: f64,
    join: Join,
    cap: Cap,
    limit: f64,
    dashes: &[f64],
    offset: f64,
) -> Vec<Contour> {
    let mut points = points.to_vec();
    points.dedup();
    if closed {
        points.push(points[0]);
        points.dedup();
    }
    let mut contours = Vec::new();
    // The parts of the line that are drawn, as distances along it.
    let lengths: Vec<f64> = points.windows(2).map(|s| (s[1][0] - s[0][0]).hypot(s[1][1] - s[0][1])).collect();
    let total: f64 = lengths.iter().sum();
    let mut drawn = vec![];
    if dashes.is_empty() {
        drawn.push((0.0, total));
    } else {
        let (mut at, mut k) = (-offset, 0);
        while at < total {
            let end = at + dashes[k % dashes.len()];
            if k % 2 == 0 && end > 0.0 {
                drawn.push((at, end));
            }
            (at, k) = (end, k + 1);
        }
    }
    let meets = closed && dashes.is_empty();
    for (start, end) in drawn {
        let mut from = 0.0;
        let mut previous: Option<[f64; 2]> = None;
        for (segment, length) in points.windows(2).zip(&lengths) {
            let to = from + length;
            let u = [(segment[1][0] - segment[0][0]) / length, (segment[1][1] - segment[0][1]) / length];
            let (a, b) = (start.max(from), end.min(to));
            if a < b || (start == end && a == b) {
                let n = [-u[1] * half, u[0] * half];
                let at = |d: f64| [segment[0][0] + u[0] * (d - from), segment[0][1] + u[1] * (d - from)];
                let (mut p, mut q) = (at(a), at(b));
                let capped = [
                    !meets && a == start.max(0.0) && from <= a && (start > from || from == 0.0 || start == from),
                    !meets && b == end.min(total),
                ];
                let turn = u[1].atan2(u[0]) / core::f64::consts::TAU;
                if cap == Cap::Round {
                    if capped[0] {
                        contours.push(arc(p, [half; 2], turn + 0.25, turn + 0.75));
                    }
                    if capped[1] {
                        contours.push(arc(q, [half; 2], turn - 0.25, turn + 0.25));
                    }
                }
                if cap == Cap::Square {
                    if capped[0] {
                        p = [p[0] - u[0] * half, p[1] - u[1] * half];
                    }
                    if capped[1] {
                        q = [q[0] + u[0] * half, q[1] + u[1] * half];
                    }
                }
                contours.push(vec![
                    [p[0] + n[0], p[1] + n[1]],
                    [p[0] - n[0], p[1] - n[1]],
                    [q[0] - n[0], q[1] - n[1]],
                    [q[0] + n[0], q[1] + n[1]],
                ]);
                if let Some(v) = previous.filter(|_| a == from) {
                    contours.extend(joined(segment[0], v, u, half, join, limit));
                }
            }
            previous = Some(u);
            from = to;
        }
    }
    if meets {
        let direction = |k: usize| {
            let s = &points[k..k + 2];
            [(s[1][0] - s[0][0]) / lengths[k], (s[1][1] - s[0][1]) / lengths[k]]
        };
        contours.extend(joined(points[0], direction(lengths.len() - 1), direction(0), half, join, limit));
    }
    contours
}

/// The contour of a join: between the ends of two segments' outer sides.
fn joined(at: [f64; 2], before: [f64; 2], after: [f64; 2], half: f64, join: Join, limit: f64) -> Option<Contour> {
    let turn = before[0] * after[1] - before[1] * after[0];
    let cosine = before[0] * after[0] + before[1] * after[1];
    let side = if turn >= 0.0 { -1.0 } else { 1.0 };
    let place = |u: [f64; 2]| [at[0] - side * u[1] * half, at[1] + side * u[0] * half];
    let (mut first, mut second) = (place(before), place(after));
    if turn < 0.0 {
        core::mem::swap(&mut first, &mut second);
    }
    let mut contour = vec![at];
    match join {
        Join::Round => {
            let angle = |p: [f64; 2]| (p[1] - at[1]).atan2(p[0] - at[0]) / core::f64::consts::TAU;
            let (from, mut to) = (angle(first), angle(second));
            if to < from {
                to += 1.0;
            }
            contour.extend(arc(at, [half; 2], from, to));
        }
        Join::Miter if 2.0 / (1.0 + cosine) <= limit * limit => {
            let sum = [first[0] + second[0] - 2.0 * at[0], first[1] + second[1] - 2.0 * at[1]];
            contour.extend([first, [at[0] + sum[0] / (1.0 + cosine), at[1] + sum[1] / (1.0 + cosine)], second]);
        }
        _ => contour.extend([first, second]),
    }
    (half > 0.0).then_some(contour)
}

/// A contour of curves through random points, as steps and in so many chords that they do not matter.
pub fn curved(rng: &mut Rng, place: &mut impl FnMut(&mut Rng) -> (ScreenPoint, [f64; 2])) -> (Vec<PathStep>, Contour) {
    let (first, mut at) = place(rng);
    let (mut steps, mut contour) = (vec![PathStep::Move(first)], vec![at]);
    for _ in 0..1 + rng.below(4) {
        let points = [(); 3].map(|()| place(rng));
        let [a, b, c] = points.map(|point| point.1);
        let [p, q, r] = points.map(|point| point.0);
        let mixed = |a: [f64; 2], b: [f64; 2], t: f64| [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];
        let kind = rng.below(5);
        let from = at;
        let mut add = |end: [f64; 2], curve: &dyn Fn(f64) -> [f64; 2]| {
            contour.extend((1..=200).map(|k| curve(f64::from(k) / 200.0)));
            end
        };
        match kind {
            0 => {
                steps.push(PathStep::Line(p));
                at = add(a, &|t| mixed(from, a, t));
            }
            1 | 2 => {
                steps.push(PathStep::Quad(p, q));
                at = add(b, &|t| mixed(mixed(from, a, t), mixed(a, b, t), t));
            }
            _ => {
                steps.push(PathStep::Cubic(p, q, r));
                at = add(c, &|t| {
                    let (u, v, w) = (mixed(from, a, t), mixed(a, b, t), mixed(b, c, t));
                    mixed(mixed(u, v, t), mixed(v, w, t), t)
                });
            }
        }
    }
    (steps, contour)
}
