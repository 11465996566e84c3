//! Shapes of a canvas whose corners are far off the screen, beyond what the rasterizer itself can take, against exact
//! lines and half planes.

use crate::reference::rng::Rng;
use crate::support::{accuracy, difference, strips, whole};
use zstrip::embedded_graphics_core::geometry::Point;
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb888, RgbColor};
use zstrip::math::Pixels;
use zstrip::{Dashed, Framebuffer, Scene, ScreenPoint, Smooth, Thick, Thin};

const SIZE: i32 = 64;
const SCREEN: (u16, u16) = (SIZE as u16, SIZE as u16);

/// Distance from an edge, in px, within which a pixel's centre may fall on either side: ends that are cut are rounded
/// to 1/256 px.
const TOLERANCE: f64 = 1.0 / 256.0;

fn point(bits: [i32; 2]) -> ScreenPoint {
    ScreenPoint::new(Pixels::from_bits(bits[0]), Pixels::from_bits(bits[1]))
}

/// A point at any distance, up to the largest coordinates.
fn any(rng: &mut Rng) -> [i32; 2] {
    let bits = rng.between(12, 31) as u32;
    [(); 2].map(|()| rng.any_magnitude(bits))
}

/// The end of a ray from `from` through a point of the screen, as far away as it can be.
fn beyond(rng: &mut Rng, from: [i32; 2]) -> [i32; 2] {
    let through = [(); 2].map(|()| rng.between(0, 256 * SIZE));
    let way = [0, 1].map(|k| f64::from(through[k]) - f64::from(from[k]));
    let longest = way[0].abs().max(way[1].abs()).max(1.0);
    let factor = 1.0 + rng.unit() * 2f64.powi(rng.between(0, 31)) / longest;
    [0, 1].map(|k| (f64::from(from[k]) + way[k] * factor) as i32)
}

/// Exact twice signed area of three points in 24.8.
fn area(a: [i32; 2], b: [i32; 2], p: [i32; 2]) -> i128 {
    let d = |k: usize, q: [i32; 2]| i128::from(q[k]) - i128::from(a[k]);
    d(0, b) * d(1, p) - d(1, b) * d(0, p)
}

/// Distance in px of a point from the line through a and b, positive to the right of it.
fn distance(a: [i32; 2], b: [i32; 2], p: [i32; 2]) -> f64 {
    let length = (f64::from(b[0]) - f64::from(a[0])).hypot(f64::from(b[1]) - f64::from(a[1]));
    area(a, b, p) as f64 / length / 256.0
}

fn center(x: i32, y: i32) -> [i32; 2] {
    [256 * x + 128, 256 * y + 128]
}

#[test]
fn a_line_to_a_far_point_keeps_its_direction() {
    let lit = |to: Point| {
        let (picture, ..) = whole::<Gray8>((101, 101), Gray8::new(0), |scene| {
            scene.canvas().line(ScreenPoint::center(0, 0), to.into(), Rgb888::WHITE);
        });
        move |x: usize, y: usize| picture[101 * y + x] > 0
    };
    assert!(lit(Point::new(200_000, 100_000))(100, 50));
    assert!(lit(Point::new(100_000, 200_000))(50, 100));
    assert!(lit(Point::new(8_000_000, 4_000_000))(100, 50));
}

/// Columns (or rows, along the longer axis) in which a thin line has to draw, with the exact place there in px.
fn along(a: [i32; 2], b: [i32; 2]) -> impl Fn(i32) -> Option<f64> {
    let d = [0, 1].map(|k| f64::from(b[k]) - f64::from(a[k]));
    let major = usize::from(d[1].abs() > d[0].abs());
    move |column| {
        let at = 256.0 * f64::from(column) + 128.0;
        let t = (at - f64::from(a[major])) / d[major];
        (0.0..1.0).contains(&t).then(|| (f64::from(a[1 - major]) + t * d[1 - major]) / 256.0)
    }
}

#[test]
fn thin_and_dashed_lines_are_within_a_256th_of_a_pixel_of_the_exact_line() {
    let mut rng = Rng::new(81);
    let (mut columns, mut worst) = (0, 0_f64);
    for _ in 0..1000 {
        let a = any(&mut rng);
        let b = beyond(&mut rng, a);
        let steep = b[1].abs_diff(a[1]) > b[0].abs_diff(a[0]);
        let pattern = rng.next_u32();
        let draw = |dashed: bool| {
            let (picture, ..) = whole::<Gray8>(SCREEN, Gray8::new(0), |scene| match dashed {
                true => scene.canvas().line_with(point(a), point(b), Rgb888::WHITE, &Dashed(pattern)),
                false => scene.canvas().line(point(a), point(b), Rgb888::WHITE),
            });
            move |column: i32, row: i32| {
                let (x, y) = if steep { (row, column) } else { (column, row) };
                picture[(y * SIZE + x) as usize] > 0
            }
        };
        let (solid, dashed) = (draw(false), draw(true));
        let exact = along(a, b);
        let case = format!("seed {}: {a:?} to {b:?}", rng.seed());
        let mut shifts = [true; 3];
        for column in 0..SIZE {
            // The diamonds of the ends themselves may add or take a pixel.
            let near_end = [a, b].iter().any(|end| (end[usize::from(steep)] / 256 - column).abs() <= 1);
            let found: Vec<_> = (0..SIZE).filter(|row| solid(column, *row)).collect();
            let Some(place) = exact(column).filter(|_| !near_end) else {
                assert!(near_end || found.is_empty(), "{case}, column {column}: {found:?}");
                continue;
            };
            let expected = place.floor() as i32;
            let slack = (place - place.round()).abs();
            let either = if place.round() > place { expected + 1 } else { expected - 1 };
            columns += usize::from(!found.is_empty());
            if found != [expected] && (0..SIZE).contains(&expected) {
                worst = worst.max(slack);
            }
            for row in &found {
                assert!(*row == expected || slack <= TOLERANCE && *row == either, "{case}, column {column}: {found:?}");
            }
            assert!(
                found.len() == 1 || !(0..SIZE).contains(&expected) || slack <= TOLERANCE,
                "{case}, column {column}"
            );
            // Bit n of the pattern is for the n-th pixel of the whole line; the first one may be one off.
            let [from, _] = [a, b].map(|end| end[usize::from(steep)] >> 8);
            for row in found {
                for (shift, fits) in (-1..=1).zip(&mut shifts) {
                    let number = (i64::from(column) - i64::from(from)).abs() + shift;
                    *fits &= dashed(column, row) == (pattern >> (number & 31) & 1 != 0);
                }
            }
        }
        assert!(shifts.contains(&true), "{case}: the pattern {pattern:#x} is displaced");
    }
    println!("{columns} columns; the worst line passes {worst:.5} px on the wrong side of a centre");
    assert!(columns > 15_000);
}

#[test]
fn polygons_are_within_a_256th_of_a_pixel_of_the_exact_ones() {
    let mut rng = Rng::new(82);
    let (mut pixels, mut worst, mut cut) = (0, 0_f64, 0);
    for _ in 0..700 {
        let a = any(&mut rng);
        let corners = [a, beyond(&mut rng, a), any(&mut rng)];
        let [a, b, c] = corners;
        let sign = area(a, b, c).signum();
        if sign == 0 {
            continue;
        }
        cut += usize::from(corners.iter().flatten().any(|c| c.unsigned_abs() >= 1 << 23));
        let (picture, ..) = whole::<Gray8>(SCREEN, Gray8::new(0), |scene| {
            scene.canvas().polygon(&corners.map(point), Rgb888::WHITE);
        });
        for (x, y) in (0..SIZE * SIZE).map(|k| (k % SIZE, k / SIZE)) {
            let inside = [(a, b), (b, c), (c, a)].map(|(a, b)| distance(a, b, center(x, y)) * sign as f64);
            let depth = inside.into_iter().fold(f64::INFINITY, f64::min);
            let found = picture[(y * SIZE + x) as usize] > 0;
            pixels += usize::from(found);
            if found != (depth > 0.0) {
                worst = worst.max(depth.abs());
                assert!(depth.abs() <= TOLERANCE, "seed {}: {corners:?} at ({x}, {y})", rng.seed());
            }
        }
    }
    println!("{pixels} pixels of polygons, {cut} of them cut; the worst edge is off by {worst:.5} px");
    accuracy::check("edge of a polygon that was cut at ±32,767 px", worst);
    assert!(pixels > 100_000 && cut > 200);
}

#[test]
fn neighbours_with_far_corners_share_their_edges() {
    let mut rng = Rng::new(83);
    let mut covered = 0;
    for _ in 0..500 {
        let (a, c) = (any(&mut rng), any(&mut rng));
        let b = beyond(&mut rng, a);
        // Two triangles on either side of ab.
        let d = any(&mut rng);
        if area(a, b, c).signum() * area(a, b, d).signum() >= 0 {
            continue;
        }
        let count = |corners: [[i32; 2]; 3]| {
            let (picture, ..) = whole::<Gray8>(SCREEN, Gray8::new(0), |scene| {
                scene.canvas().polygon(&corners.map(point), Rgb888::new(1, 1, 1));
            });
            picture
        };
        let (one, other) = (count([a, b, c]), count([b, a, d]));
        for k in 0..one.len() {
            assert!(one[k] + other[k] < 2, "seed {}: pixel {k} twice: {a:?} {b:?} {c:?} {d:?}", rng.seed());
            covered += usize::from(one[k] + other[k]);
            // A centre clearly inside of the quad belongs to one of them.
            let at = center(k as i32 % SIZE, k as i32 / SIZE);
            let inside = |p: [[i32; 2]; 3], outer: [usize; 2]| {
                let sign = area(p[0], p[1], p[2]).signum() as f64;
                outer.into_iter().all(|k| distance(p[k], p[(k + 1) % 3], at) * sign > TOLERANCE)
                    && distance(p[0], p[1], at) * sign > -TOLERANCE
            };
            if inside([a, b, c], [1, 2]) && inside([b, a, d], [1, 2]) {
                assert_eq!(one[k] + other[k], 1, "seed {}: a gap at {at:?}", rng.seed());
            }
        }
    }
    assert!(covered > 50_000, "{covered}");
}

#[test]
fn gradients_of_far_shapes_are_within_1_of_255() {
    let mut rng = Rng::new(84);
    let (mut pixels, mut worst) = (0, 0_f64);
    for _ in 0..1000 {
        let a = any(&mut rng);
        let corners = [a, beyond(&mut rng, a), any(&mut rng)];
        let [a, b, c] = corners;
        let whole_area = area(a, b, c) as f64;
        // A sliver's plane is not determined by corners that are rounded to 1/256 px.
        let longest = [(a, b), (b, c), (c, a)]
            .map(|(p, q)| (f64::from(q[0]) - f64::from(p[0])).hypot(f64::from(q[1]) - f64::from(p[1])));
        let longest = longest.into_iter().fold(0.0, f64::max);
        if whole_area.abs() / longest < 256.0 * 600.0 {
            continue;
        }
        let colors = [(); 3].map(|()| [(); 3].map(|()| rng.below(256) as u8));
        let (picture, ..) = whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| {
            let corners: [_; 3] =
                core::array::from_fn(|k| (point(corners[k]), Rgb888::new(colors[k][0], colors[k][1], colors[k][2])));
            scene.canvas().gradient(&corners);
        });
        for (x, y) in (0..SIZE * SIZE).step_by(7).map(|k| (k % SIZE, k / SIZE)) {
            let at = center(x, y);
            let weights = [area(b, c, at), area(c, a, at), area(a, b, at)].map(|part| part as f64 / whole_area);
            if weights.iter().any(|w| *w < 0.001) {
                continue;
            }
            let found = picture[(y * SIZE + x) as usize];
            for channel in 0..3 {
                let exact: f64 = (0..3).map(|k| weights[k] * f64::from(colors[k][channel])).sum();
                let error = (f64::from(found[channel]) - exact).abs();
                worst = worst.max(error);
                pixels += 1;
                assert!(error <= 1.0, "seed {}: {corners:?} {colors:?} at ({x}, {y}), off by {error}", rng.seed());
            }
        }
    }
    println!("{pixels} channels, the worst is off by {worst:.4} of 255");
    assert!(pixels > 25_000);

    let (mut pixels, mut worst) = (0, 0_f64);
    for _ in 0..1000 {
        let a = any(&mut rng);
        let b = beyond(&mut rng, a);
        let steep = usize::from(b[1].abs_diff(a[1]) > b[0].abs_diff(a[0]));
        if b[steep].abs_diff(a[steep]) < 256 * 16 {
            continue;
        }
        let (picture, ..) = whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| {
            let ends = [(point(a), Rgb888::new(255, 255, 0)), (point(b), Rgb888::new(0, 255, 255))];
            scene.canvas().gradient_line(ends[0], ends[1], &Thin);
        });
        for (k, [r, g, b_]) in picture.into_iter().enumerate().filter(|(_, pixel)| pixel[1] > 0) {
            let at = center(k as i32 % SIZE, k as i32 / SIZE)[steep];
            let t = (f64::from(at) - f64::from(a[steep])) / (f64::from(b[steep]) - f64::from(a[steep]));
            let error = (f64::from(r) - 255.0 * (1.0 - t)).abs().max((f64::from(b_) - 255.0 * t).abs());
            // The pixels at the ends lie up to one pixel before or after them.
            let slack = 255.0 * 256.0 / f64::from(b[steep].abs_diff(a[steep]));
            worst = worst.max(error - slack);
            pixels += 1;
            assert!(g == 255 && error <= 1.0 + slack, "seed {}: {a:?} to {b:?}, pixel {k}: {r} {b_}, {t}", rng.seed());
        }
    }
    println!("{pixels} pixels of lines, the worst is off by {worst:.4} of 255");
    assert!(pixels > 20_000);
}

#[test]
fn thick_lines_are_within_2_256ths_of_a_pixel_of_the_exact_rectangle() {
    let mut rng = Rng::new(85);
    let (mut pixels, mut worst) = (0, 0_f64);
    for _ in 0..500 {
        let a = any(&mut rng);
        let b = beyond(&mut rng, a);
        let width = rng.between(200, 5000);
        let length = (f64::from(b[0]) - f64::from(a[0])).hypot(f64::from(b[1]) - f64::from(a[1])) / 256.0;
        if length < 40.0 {
            continue;
        }
        let draw = |smooth: bool| {
            whole::<Gray8>(SCREEN, Gray8::new(0), |scene| match smooth {
                true => {
                    scene.canvas().line_with(point(a), point(b), Rgb888::WHITE, &Smooth::new(Pixels::from_bits(width)))
                }
                false => {
                    scene.canvas().line_with(point(a), point(b), Rgb888::WHITE, &Thick::new(Pixels::from_bits(width)))
                }
            })
            .0
        };
        let (thick, smooth) = (draw(false), draw(true));
        for k in 0..SIZE * SIZE {
            let at = center(k % SIZE, k / SIZE);
            let aside = f64::from(width) / 512.0 - distance(a, b, at).abs();
            let way = [0, 1].map(|k| (f64::from(b[k]) - f64::from(a[k])) / 256.0 / length);
            let t = [0, 1].map(|k| (f64::from(at[k]) - f64::from(a[k])) / 256.0 * way[k]).iter().sum::<f64>();
            let depth = aside.min(t).min(length - t);
            let found = thick[k as usize] > 0;
            pixels += usize::from(found);
            if found != (depth > 0.0) {
                worst = worst.max(depth.abs());
            }
            assert!(found == (depth > 0.0) || depth.abs() <= 2.0 * TOLERANCE, "seed {}: {a:?} {b:?} {k}", rng.seed());
            // A box of a pixel reaches up to 0.71 px from its centre.
            let smooth = smooth[k as usize];
            assert!(depth.abs() < 0.75 || (smooth > 0) == (depth > 0.0), "seed {}: {a:?} {b:?} {k}", rng.seed());
        }
    }
    println!("{pixels} pixels of thick lines, the worst edge is off by {worst:.5} px");
    assert!(pixels > 15_000);
}

#[test]
fn squares_are_exact_wherever_they_are() {
    let mut rng = Rng::new(86);
    let mut pixels = 0;
    for _ in 0..1000 {
        let at = any(&mut rng);
        // Often one that reaches the screen.
        let reach = 2 * i64::from(at[0].unsigned_abs().max(at[1].unsigned_abs()));
        let side = (reach + i64::from(rng.between(-20_000, 20_000))).clamp(-5, i64::from(i32::MAX)) as i32;
        let (picture, ..) = whole::<Gray8>(SCREEN, Gray8::new(0), |scene| {
            scene.canvas().point(point(at), Pixels::from_bits(side), Rgb888::WHITE);
        });
        for k in 0..SIZE * SIZE {
            let centre = center(k % SIZE, k / SIZE);
            let inside = (0..2).all(|axis| {
                let from = 2 * (i64::from(centre[axis]) - i64::from(at[axis]));
                -i64::from(side) <= from && from < i64::from(side)
            });
            pixels += usize::from(inside);
            assert_eq!(picture[k as usize] > 0, inside, "seed {}: {at:?} {side} pixel {k}", rng.seed());
        }
    }
    assert!(pixels > 100_000, "{pixels}");
}

/// Draws shapes of all kinds with corners anywhere.
fn shapes<F: Framebuffer>(scene: &mut Scene<'_, F>, seed: u64) {
    let rng = &mut Rng::new(seed);
    let mut canvas = scene.canvas();
    for _ in 0..20 {
        let a = any(rng);
        let points = [a, beyond(rng, a), any(rng), any(rng)].map(point);
        let color = Rgb888::new(rng.next_u32() as u8, rng.next_u32() as u8, 200);
        match rng.below(5) {
            0 => canvas.polygon(&points[..3], color),
            1 => canvas.outline(&points, color, &Dashed(rng.next_u32())),
            2 => canvas.polyline(&points, color, &Thick::px(rng.below(9) as u8)),
            3 => canvas.gradient_line((points[0], color), (points[1], Rgb888::RED), &Smooth::px(2)),
            _ => canvas.gradient(&points.map(|p| (p, Rgb888::new(rng.next_u32() as u8, 9, 90)))),
        }
    }
}

#[test]
fn strips_do_not_matter() {
    for seed in 0..80 {
        let (expected, ..) = whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| shapes(scene, seed));
        for (rows, records) in [(1, 0), (7, 100)] {
            let (picture, _) = strips::<Rgb888>(SCREEN, rows, records, Rgb888::BLACK, |scene| shapes(scene, seed));
            assert_eq!(difference(&picture, &expected, SCREEN.0), None, "seed {seed}, {rows} rows");
        }
    }
}
