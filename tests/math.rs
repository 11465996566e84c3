//! Angles, vectors and matrices against f64.

use crate::reference::rng::Rng;
use crate::support::{accuracy, angle, apply, matrix, rigid, scalar, vector};
use std::f64::consts::TAU;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3, Wide};

const STEP: f64 = 1.0 / 65_536.0;

fn radians(angle: Angle16) -> f64 {
    f64::from(angle.0) / 65_536.0 * TAU
}

fn to_f64(v: Vec3) -> [f64; 3] {
    v.to_bits().map(|c| f64::from(c) * STEP)
}

fn rows(a: &Affine) -> [[f64; 4]; 3] {
    a.to_rows().map(|row| row.map(|c| f64::from(c) * STEP))
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// Bound: 2⁻¹⁵, and 2⁻¹⁶ as documented.
#[test]
fn sine_and_cosine_are_right_at_all_angles() {
    let mut worst = 0_f64;
    for k in 0..=u16::MAX {
        let a = Angle16(k);
        let (sin, cos) = (a.sin().to_num::<f64>(), a.cos().to_num::<f64>());
        worst = worst.max((sin - radians(a).sin()).abs()).max((cos - radians(a).cos()).abs());
        assert!(sin.abs() <= 1.0 && cos.abs() <= 1.0, "{a:?}");
        // Odd and even, but for the rounding of halves.
        let off = |p: Scalar, q: Scalar| (p - q).abs().to_bits();
        assert!(off((-a).sin(), -a.sin()) <= 1 && off((-a).cos(), a.cos()) <= 1, "{a:?}");
    }
    println!("worst sine or cosine is off by {:.3} · 2⁻¹⁶", worst / STEP);
    accuracy::check("sine, cosine", worst / STEP);
    for (degrees, sin, cos) in [(0, 0, 1), (90, 1, 0), (180, 0, -1), (270, -1, 0), (-90, -1, 0), (450, 1, 0)] {
        let a = Angle16::from_degrees(degrees);
        assert_eq!((a.sin(), a.cos()), (Scalar::from_num(sin), Scalar::from_num(cos)), "{degrees}°");
    }
}

#[test]
fn angles_wrap_as_angles_do() {
    for degrees in -1000..1000 {
        let expected = (f64::from(degrees) / 360.0).rem_euclid(1.0) * 65_536.0;
        let found = f64::from(Angle16::from_degrees(degrees).0);
        let off = (found - expected).abs();
        assert!(off <= 0.5 || off >= 65_535.5, "{degrees}°: {found} for {expected}");
    }
    assert_eq!(Angle16(60_000) + Angle16(10_000), Angle16(4464));
    assert_eq!(Angle16(100) - Angle16(200), Angle16(65_436));
    assert_eq!(-Angle16(1), Angle16(65_535));
    let _ = Angle16::from_degrees(i32::MIN);
    let _ = Angle16::from_degrees(i32::MAX);
}

#[test]
fn rotations_are_orthonormal_and_go_the_right_way() {
    let mut worst = [0_f64; 2];
    for seed in 0..3000 {
        let mut rng = Rng::new(seed);
        let (axis, turn) = (vector(&mut rng, 3.0), angle(&mut rng));
        let (s, c) = radians(turn).sin_cos();
        let n = to_f64(axis);
        let n = n.map(|c| c / length(n));
        // Rodrigues in f64.
        let cross = [[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]];
        let m = rows(&Affine::rotation(axis, turn));
        for i in 0..3 {
            for j in 0..3 {
                let unit = f64::from(u8::from(i == j));
                let expected = unit * c + n[i] * n[j] * (1.0 - c) + cross[i][j] * s;
                worst[0] = worst[0].max((m[i][j] - expected).abs());
                let dot: f64 = (0..3).map(|k| m[i][k] * m[j][k]).sum();
                worst[1] = worst[1].max((dot - unit).abs());
            }
        }
    }
    println!(
        "worst entry of a rotation {:.2} · 2⁻¹⁶, worst product of two rows {:.2} · 2⁻¹⁶ off",
        worst[0] / STEP,
        worst[1] / STEP
    );
    accuracy::check("entry of a rotation", worst[0] / STEP);
    assert!(worst[1] <= 12.0 * STEP, "{}", worst[1]);

    let quarter = Angle16::from_degrees(90);
    for (axis, from, to, named) in [
        (Vec3::X, Vec3::Y, Vec3::Z, Affine::rotation_x(quarter)),
        (Vec3::Y, Vec3::Z, Vec3::X, Affine::rotation_y(quarter)),
        (Vec3::Z, Vec3::X, Vec3::Y, Affine::rotation_z(quarter)),
    ] {
        assert_eq!(named.transform_vector(from), to);
        assert_eq!(Affine::rotation(axis, quarter).transform_vector(from), to);
    }
    assert_eq!(Affine::rotation(Vec3::ZERO, Angle16(77)), Affine::IDENTITY);
    for k in (0..=u16::MAX).step_by(97) {
        for (axis, named) in [
            (Vec3::X, Affine::rotation_x(Angle16(k))),
            (Vec3::Y, Affine::rotation_y(Angle16(k))),
            (Vec3::Z, Affine::rotation_z(Angle16(k))),
        ] {
            let (a, b) = (named.to_rows(), Affine::rotation(axis, Angle16(k)).to_rows());
            let off = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).max();
            assert!(off <= Some(4), "angle {k} about {axis:?}: {a:?} {b:?}");
        }
    }
}

#[test]
fn vectors_agree_with_f64() {
    let mut worst = [0_f64; 4];
    for seed in 0..3000 {
        let mut rng = Rng::new(seed);
        let reach = (rng.unit() * 7.0).exp2();
        let (a, b) = (vector(&mut rng, reach), vector(&mut rng, reach));
        let (p, q) = (to_f64(a), to_f64(b));
        let dot: f64 = (0..3).map(|i| p[i] * q[i]).sum();
        worst[0] = worst[0].max((a.dot(b).to_num::<f64>() - dot).abs());
        let cross = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        for (found, exact) in to_f64(a.cross(b)).into_iter().zip(cross) {
            worst[1] = worst[1].max((found - exact).abs());
        }
        worst[2] = worst[2].max((a.length().to_num::<f64>() - length(p)).abs());
        let tiny = Vec3::from_bits(a.to_bits().map(|c| c >> rng.below(16)));
        if let Some(unit) = tiny.normalized() {
            let p = to_f64(tiny);
            for (found, exact) in to_f64(unit).into_iter().zip(p.map(|c| c / length(p))) {
                worst[3] = worst[3].max((found - exact).abs());
            }
        }
    }
    println!("worst dot, cross, length, normalized, in 2⁻¹⁶: {:?}", worst.map(|w| w / STEP));
    assert!(worst[..3].iter().all(|w| *w <= 1.01 * STEP), "rounded down to 2⁻¹⁶");
    accuracy::check("component of a unit vector", worst[3] / STEP);
    assert_eq!(Vec3::ZERO.normalized(), None);
    let huge = Vec3::from_bits([i32::MIN; 3]);
    assert_eq!(
        (huge.dot(huge), huge.length(), huge + huge, -huge),
        (Scalar::MAX, Scalar::MAX, huge, Vec3::from_bits([i32::MAX; 3]))
    );
    assert_eq!(huge.cross(Vec3::from_bits([i32::MAX, i32::MIN, 0])).x, Scalar::MIN);
    huge.normalized().expect("a direction");
}

#[test]
fn look_at_puts_the_eye_at_the_origin_and_the_target_ahead() {
    let mut worst = 0_f64;
    for seed in 0..2000 {
        let mut rng = Rng::new(seed);
        let (eye, target) = (vector(&mut rng, 50.0), vector(&mut rng, 50.0));
        let Ok(view) = Affine::look_at(eye, target, Vec3::Y) else {
            continue;
        };
        let distance = length(to_f64(target - eye));
        if distance < 1.0 {
            continue;
        }
        let [x, y, z] = to_f64(view.transform_point(target));
        let [ex, ey, ez] = to_f64(view.transform_point(eye));
        // Units of 2⁻¹⁶ a unit of distance from the origin.
        let scale = STEP * (distance + 2.0 * length(to_f64(eye)) + 1.0);
        let error = [x, y, z + distance, ex, ey, ez].map(|v| v.abs() / scale);
        worst = error.into_iter().fold(worst, f64::max);
        // What is above the target is above it on the screen.
        assert!(to_f64(view.transform_point(target + Vec3::Y))[1] >= y - 4.0 * scale, "seed {seed}");
    }
    println!("worst look_at is off by {worst:.2} · 2⁻¹⁶ a unit of distance");
    assert!(worst <= 4.0);
}

/// The rows of a view in f64, for the numbers as they are.
fn exact_view(eye: Vec3, target: Vec3, up: Vec3) -> [[f64; 3]; 3] {
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let unit = |v: [f64; 3]| v.map(|c| c / length(v));
    let (e, t) = (to_f64(eye), to_f64(target));
    let z = unit([0, 1, 2].map(|k| e[k] - t[k]));
    let x = unit(cross(unit(to_f64(up)), z));
    [x, cross(z, x), z]
}

/// `up` comes as close to the view direction as numbers of 16.16 can tell, and closer than a unit vector can.
#[test]
fn look_at_is_a_rotation_whatever_is_up() {
    let (mut skewed, mut short, mut off) = (0.0_f64, 0.0_f64, 0.0_f64);
    for seed in 0..20_000 {
        let mut rng = Rng::new(seed);
        let reach = (rng.unit() * 12.0).exp2();
        let (eye, target) = (vector(&mut rng, reach), vector(&mut rng, reach));
        let view = to_f64(eye - target);
        // Long enough for its 16.16 to tell a thousandth of a degree.
        if length(view) < 0.1 {
            continue;
        }
        let degrees = if seed % 4 == 0 { rng.unit() * 180.0 } else { (rng.unit() * 1000_f64.ln()).exp() / 1000.0 };
        let across = degrees.to_radians().tan().clamp(-10.0, 10.0) * length(view);
        let side = exact_view(eye, target, vector(&mut rng, 1.0))[0].map(|c| c * across);
        // Along the view or against it, and of any length.
        let sign = rng.pick(&[-1.0, 1.0]) * 8000.0 / length(view) * (-10.0 * rng.unit()).exp2();
        let up = Vec3::from_bits([0, 1, 2].map(|k| ((view[k] + side[k]) * sign / STEP).clamp(-2e9, 2e9) as i32));
        let exact = exact_view(eye, target, up);
        let Ok(found) = Affine::look_at(eye, target, up) else { panic!("seed {seed}: {eye:?} {target:?} {up:?}") };
        let [x, y, z] = rows(&found).map(|[x, y, z, _]| [x, y, z]);
        for (a, b) in [(x, y), (y, z), (z, x)] {
            skewed = skewed.max((a[0] * b[0] + a[1] * b[1] + a[2] * b[2]).abs());
            short = short.max((length(a) - 1.0).abs());
        }
        for (found, exact) in [x, y, z].as_flattened().iter().zip(exact.as_flattened()) {
            off = off.max((found - exact).abs());
        }
    }
    accuracy::check("view, product of two rows", skewed / STEP);
    accuracy::check("view, length of a row", short / STEP);
    accuracy::check("entry of a view", off / STEP);
}

/// Directions that are parallel by the numbers that were given, whatever their lengths are.
#[test]
fn look_at_tells_an_up_that_is_parallel_from_one_that_is_nearly_so() {
    for seed in 0..2000 {
        let mut rng = Rng::new(seed);
        let [x, y, z] = [(); 3].map(|()| rng.between(-5000, 5000));
        let (a, b) = (rng.between(1, 5000), rng.between(1, 5000) * rng.pick(&[-1, 1]));
        let eye = vector(&mut rng, 50.0);
        let view = Vec3::from_bits([x, y, z].map(|c| c * a));
        let up = Vec3::from_bits([x, y, z].map(|c| c * b));
        let parallel = Affine::look_at(eye + view, eye, up);
        assert!(parallel.is_err(), "seed {seed}: {view:?} {up:?} {parallel:?}");
        let beside = Affine::look_at(eye + view, eye, up + Vec3::from_bits([i32::from(y != 0 || z != 0), 0, 0]));
        assert!([y, z] == [0; 2] || beside.is_ok_and(|view| skew(&view) < 11.0 * STEP), "seed {seed}: {beside:?}");
    }
}

#[test]
fn perspective_maps_near_to_0_and_far_to_1() {
    let mut worst = 0_f64;
    for seed in 0..2000 {
        let mut rng = Rng::new(seed);
        let near = 0.01 + rng.unit() * 10.0;
        let far = near * (1.5 + rng.unit() * 2000.0);
        let (near, far) = (Scalar::from_num(near), Scalar::from_num(far.min(32_000.0)));
        let fov = Angle16(rng.between(400, 32_000) as u16);
        let (width, height) = (rng.between(1, 2000) as u16, rng.between(1, 2000) as u16);
        let m =
            matrix(&Projective::perspective(fov, Size::new(width.into(), height.into()), near, far).expect("a camera"));
        let (n, f) = (near.to_num::<f64>(), far.to_num::<f64>());
        for (distance, depth) in [(n, 0.0), (f, 1.0), ((n + f) / 2.0, f * (f - n) / 2.0 / ((f - n) * (n + f) / 2.0))] {
            let [_, _, z, w] = apply(&m, [0.0, 0.0, -distance, 1.0]);
            assert!((w - distance).abs() < 1e-9);
            worst = worst.max((z / w - depth).abs() * n.min(1.0));
        }
        // The edge of the view at half the angle.
        let tan = (radians(Angle16(fov.0 / 2))).tan();
        let aspect = f64::from(width) / f64::from(height);
        let [x, y, _, w] = apply(&m, [tan * aspect, tan, -1.0, 1.0]);
        assert!((x / w - 1.0).abs() < 1e-4 && (y / w - 1.0).abs() < 1e-4, "seed {seed}: ({x}, {y}) / {w}");
    }
    println!("worst depth is off by 2^{:.1} / near", worst.log2());
    assert!(worst < 2f64.powi(-30), "{worst}");
}

#[test]
fn orthographic_maps_its_box_to_clip_space() {
    for seed in 0..2000 {
        let mut rng = Rng::new(seed);
        let mut range = || {
            let low = scalar(&mut rng, 100.0);
            (low, low + Scalar::from_num(0.5 + rng.unit() * 200.0))
        };
        let (x, y, z) = (range(), range(), range());
        let m = matrix(&Projective::orthographic(x, y, z).expect("a box"));
        let num = |v: Scalar| v.to_num::<f64>();
        let low = apply(&m, [num(x.0), num(y.0), -num(z.0), 1.0]);
        let high = apply(&m, [num(x.1), num(y.1), -num(z.1), 1.0]);
        for (found, expected) in low.into_iter().chain(high).zip([-1.0, -1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0]) {
            assert!((found - expected).abs() < 1e-6, "seed {seed}: {low:?} {high:?}");
        }
    }
}

#[test]
fn composition_is_application_one_after_the_other() {
    let mut worst = [0_f64; 3];
    for seed in 0..2000 {
        let mut rng = Rng::new(seed);
        let [a, b, c] = [(); 3].map(|()| rigid(&mut rng, 20.0));
        let point = vector(&mut rng, 20.0);
        let off = |p: Vec3, q: Vec3| length(to_f64(p - q)) / STEP;
        worst[0] = worst[0].max(off((a * b).transform_point(point), a.transform_point(b.transform_point(point))));
        worst[1] = worst[1].max(off(((a * b) * c).transform_point(point), (a * (b * c)).transform_point(point)));
        let there_and_back = a.inverse_rigid() * a;
        worst[2] = worst[2].max(off(there_and_back.transform_point(point), point));
        // The 4 × 4 matrix says the same, and composes to 2⁻³².
        let four = Projective::from(a);
        let [x, y, z] = to_f64(point);
        let p = apply(&matrix(&four), [x, y, z, 1.0]);
        let q = to_f64(a.transform_point(point));
        assert!((0..3).all(|i| (p[i] - q[i]).abs() <= 2.0 * STEP) && p[3] == 1.0, "seed {seed}");
        let left = matrix(&((four * b) * c));
        let right = matrix(&(four * (Projective::from(b) * c)));
        for (l, r) in left.iter().flatten().zip(right.iter().flatten()) {
            assert!((l - r).abs() < 100.0 / 2f64.powi(32), "seed {seed}: {l} {r}");
        }
    }
    println!("worst in 2⁻¹⁶: (a b) p against a (b p), (a b) c against a (b c), inverse: {worst:.1?}");
    // Entries of a product are off by 1 · 2⁻¹⁶, those of a rotation by 4, times coordinates up to 35 · √3.
    assert!(worst[..2].iter().all(|w| *w <= 250.0) && worst[2] <= 500.0, "{worst:?}");
    assert_eq!(Affine::IDENTITY * Affine::translation(Vec3::X), Affine::translation(Vec3::X));
    assert_eq!(Projective::IDENTITY * Projective::IDENTITY, Projective::IDENTITY);
}

#[test]
fn products_are_the_exact_ones_rounded_to_nearest() {
    let mut rng = Rng::new(91);
    let nearest = |sum: i128| ((sum + (1 << 15)) >> 16).clamp(i32::MIN.into(), i32::MAX.into()) as i32;
    for _ in 0..20_000 {
        let bits = rng.between(4, 31) as u32;
        let mut vector = || Vec3::from_bits([(); 3].map(|()| rng.any_magnitude(bits)));
        let [a, b] = [(); 2].map(|()| Affine::from_rows(vector(), vector(), vector(), vector()));
        let p = vector();
        let (ra, rb) = (a.to_rows(), b.to_rows());
        let sum = |row: &[i32; 4], v: [i32; 3]| (0..3).map(|k| i128::from(row[k]) * i128::from(v[k])).sum::<i128>();
        let columns: [[i32; 3]; 4] = core::array::from_fn(|j| rb.map(|row| row[j]));
        let (product, point, direction) = ((a * b).to_rows(), a.transform_point(p), a.transform_vector(p));
        for (i, row) in ra.iter().enumerate() {
            let moved = i128::from(row[3]) << 16;
            for (j, column) in columns.into_iter().enumerate() {
                let exact = nearest(sum(row, column) + if j == 3 { moved } else { 0 });
                assert_eq!(product[i][j], exact, "seed {}: {a:?} {b:?}", rng.seed());
            }
            assert_eq!(point.to_bits()[i], nearest(sum(row, p.to_bits()) + moved), "{a:?} {p:?}");
            assert_eq!(direction.to_bits()[i], nearest(sum(row, p.to_bits())), "{a:?} {p:?}");
        }
    }
}

/// How far products of two rows are from 0 and 1, at most.
fn skew(a: &Affine) -> f64 {
    let m = rows(a);
    let product = |i: usize, j: usize| (0..3).map(|k| m[i][k] * m[j][k]).sum::<f64>() - f64::from(u8::from(i == j));
    (0..9).map(|k| product(k / 3, k % 3).abs()).fold(0.0, f64::max)
}

#[test]
fn a_thousand_small_turns_leave_a_rotation_and_it_can_be_made_exact_again() {
    let (mut worst, mut kept) = (0.0_f64, 0.0_f64);
    for seed in 0..60 {
        let mut rng = Rng::new(seed);
        let (mut drifting, mut straight) = (Affine::IDENTITY, Affine::IDENTITY);
        let (axis, small) = (vector(&mut rng, 1.0), rng.between(1, 400) as u16);
        for _ in 0..1000 {
            let axis = if seed % 2 == 0 { axis } else { vector(&mut rng, 1.0) };
            let step = Affine::rotation(axis, Angle16(small));
            drifting = step * drifting;
            straight = (step * straight).orthonormalized().expect("a rotation");
            kept = kept.max(skew(&straight));
        }
        worst = worst.max(skew(&drifting));
    }
    accuracy::check("rotation turned 1,000 times", worst);
    accuracy::check("rotation made orthonormal", kept / STEP);
}

#[test]
fn orthonormalizing_keeps_the_first_row_the_plane_of_two_the_mirror_and_the_translation() {
    let mut worst = 0.0_f64;
    for seed in 0..3000 {
        let mut rng = Rng::new(seed);
        let size = (rng.unit() * 14.0 - 6.0).exp2();
        let [x, y, z] = [(); 3].map(|()| vector(&mut rng, size));
        let model = Affine::from_rows(x, y, z, vector(&mut rng, 9.0));
        let (f, m) = (|v: Vec3| to_f64(v), rows(&model));
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let normal = cross(f(x), f(y));
        let sine = length(normal) / (length(f(x)) * length(f(y)));
        let volume = (0..3).map(|k| normal[k] * f(z)[k]).sum::<f64>() / (length(normal) * length(f(z)));
        // Rows that are nearly in one plane leave their order to rounding.
        if sine < 0.1 || volume.abs() < 0.01 {
            continue;
        }
        let straight = model.orthonormalized().expect("rows in different directions");
        worst = worst.max(skew(&straight));
        let s = rows(&straight);
        let unit = |v: [f64; 3]| v.map(|c| c / length(v));
        let (first, third) = (unit(f(x)), unit(normal).map(|c| c * volume.signum()));
        for k in 0..3 {
            assert!((s[0][k] - first[k]).abs() <= 2.0 * STEP, "seed {seed}: {model:?} {straight:?}");
            assert!((s[2][k] - third[k]).abs() <= 4.0 * STEP / sine, "seed {seed}: {model:?} {straight:?}");
            assert_eq!(s[k][3], m[k][3]);
        }
    }
    accuracy::check("any matrix made orthonormal", worst / STEP);
    assert_eq!(Affine::scale(Scalar::ZERO).orthonormalized(), None);
    assert_eq!(Affine::from_rows(Vec3::X, Vec3::X, Vec3::Y, Vec3::ZERO).orthonormalized(), None);
    assert_eq!(Affine::scale(-Scalar::ONE).orthonormalized(), Some(Affine::scale(-Scalar::ONE)));
}

#[test]
fn scales_and_saturation() {
    let scale = Affine::scale_axes(Vec3::from_ints(2, -3, 0));
    assert_eq!(scale.transform_point(Vec3::from_ints(1, 1, 1)), Vec3::from_ints(2, -3, 0));
    let huge = Affine::scale(Scalar::MAX);
    assert_eq!((huge * huge).transform_point(Vec3::X).x, Scalar::MAX);
    let big = Projective::from_rows([[i64::MAX; 4]; 4]);
    assert_eq!((big * big).to_rows(), [[i64::MAX; 4]; 4]);
    assert_eq!(Projective::IDENTITY.entry(1, 1), Some(Wide::ONE));
    assert_eq!(Projective::IDENTITY.entry(4, 0), None);
}

/// Whole cameras and models can be constants.
#[test]
fn transforms_are_constants() {
    const NEAR: Scalar = Scalar::ONE;
    const FAR: Scalar = Scalar::from_bits(100 << 16);
    const CAMERA: Projective = match Projective::perspective(Angle16::from_degrees(60), Size::new(320, 240), NEAR, FAR)
    {
        Ok(camera) => camera,
        Err(_) => panic!("not a camera"),
    };
    const VIEW: Affine = match Affine::look_at(Vec3::from_ints(0, 2, 5), Vec3::ZERO, Vec3::Y) {
        Ok(view) => view,
        Err(_) => panic!("not a view"),
    };
    const MODEL: Affine =
        Affine::rotation(Vec3::from_ints(1, 1, 0), Angle16(1000)).compose(&Affine::scale(Scalar::ONE));
    const MVP: Projective = CAMERA.compose_affine(&VIEW).compose_affine(&MODEL.inverse_rigid());
    const LENGTH: Scalar = Vec3::from_ints(3, 4, 0).length();
    assert_eq!(MVP, CAMERA * VIEW * MODEL.inverse_rigid());
    assert_eq!(LENGTH, Scalar::from_num(5));
}

#[test]
fn points_are_transformed_as_by_f64() {
    let near = Scalar::from_num(0.5);
    let camera = Projective::perspective(Angle16::from_degrees(70), Size::new(4, 3), near, Scalar::from_num(40))
        .expect("a camera");
    let model = Affine::translation(Vec3::from_ints(1, -2, -9)) * Affine::rotation_x(Angle16::from_degrees(33));
    let point = Vec3::from_milli(1250, -3700, 812);
    assert_eq!(model * point, model.transform_point(point));
    let rows = (camera * model).to_rows().map(|row| row.map(|v| v as f64 / 4_294_967_296.0));
    let p = point.to_bits().map(|v| f64::from(v) / 65_536.0);
    for (row, found) in rows.iter().zip((camera * model).transform_point(point)) {
        let exact = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
        assert!((found.to_num::<f64>() - exact).abs() < 1e-9, "{found} for {exact}");
    }
}

#[test]
fn angles_have_the_operators_of_numbers_and_print_as_degrees() {
    let mut angle = Angle16(65_000);
    angle += Angle16(1000);
    assert_eq!(angle, Angle16(464));
    angle -= Angle16(1000);
    assert_eq!(angle, Angle16(65_000));
    assert_eq!((Angle16(0x3000) * 3, Angle16(0x3000) * -1), (Angle16(0x9000), Angle16(0xD000)));
    assert_eq!((Angle16(0xFFFF) / 2, Angle16(0x8000) / -2), (Angle16(0x7FFF), Angle16(0xC000)));
    assert_eq!(Angle16(0xFFFF) / i32::MIN, Angle16(0));
    let quarter = Angle16(0x4000);
    assert_eq!((format!("{quarter}"), format!("{quarter:?}")), ("90°".into(), "Angle16(16384 = 90°)".into()));
    assert_eq!(format!("{:.2}", Angle16(1)), "0.01°");
    for units in 0..=u16::MAX {
        let angle = Angle16(units);
        assert_eq!(angle.to_degrees().to_num::<f64>(), f64::from(units) * 360.0 / 65_536.0);
        assert_eq!(Angle16::from_degrees_fixed(angle.to_degrees()), angle);
    }
    let mut rng = Rng::new(11);
    for case in 0..10_000 {
        let degrees = Scalar::from_bits(rng.between(i32::MIN, i32::MAX));
        let exact = (degrees.to_num::<f64>() / 360.0).rem_euclid(1.0) * 65_536.0;
        let off = (f64::from(Angle16::from_degrees_fixed(degrees).0) - exact).abs();
        assert!(off <= 0.5 || off >= 65_535.5, "case {case}: {degrees}");
    }
}

#[test]
fn vectors_are_scaled_and_divided_and_saturate() {
    let mut v = Vec3::from_ints(3, -6, 0);
    v += Vec3::X;
    v -= Vec3::Y;
    v *= Scalar::from_num(2);
    assert_eq!(v, Vec3::from_ints(8, -14, 0));
    v /= Scalar::from_num(-4);
    assert_eq!(v, Vec3::from_milli(-2000, 3500, 0));
    assert_eq!(Vec3::from_ints(8, -14, 0) / Scalar::ZERO, Vec3::new(Scalar::MAX, Scalar::MIN, Scalar::ZERO));
    assert_eq!(Vec3::from_ints(8, -14, 0) / Scalar::DELTA, Vec3::new(Scalar::MAX, Scalar::MIN, Scalar::ZERO));
    let seed = 5;
    let mut rng = Rng::new(seed);
    for case in 0..10_000 {
        let mut number = || Scalar::from_bits(rng.between(i32::MIN, i32::MAX) >> rng.between(0, 30));
        let (v, divisor) = (Vec3::new(number(), number(), number()), number());
        if divisor == 0 {
            continue;
        }
        for (quotient, part) in (v / divisor).to_bits().into_iter().zip(v.to_bits()) {
            let exact = f64::from(part) / f64::from(divisor.to_bits()) * 65_536.0;
            let exact = exact.trunc().clamp(f64::from(i32::MIN), f64::from(i32::MAX));
            assert_eq!(f64::from(quotient), exact, "seed {seed}, case {case}: {v:?} / {divisor}");
        }
    }
}

/// The determinant of the matrix without row `i` and column `j`, with its sign.
fn cofactor<const N: usize>(m: &[[i128; N]; N], i: usize, j: usize) -> i128 {
    let rest = |skipped: usize| (0..N).filter(move |k| *k != skipped);
    let minor: Vec<Vec<i128>> = rest(i).map(|row| rest(j).map(|column| m[row][column]).collect()).collect();
    let det2 = |a: &[i128], b: &[i128], p: usize, q: usize| a[p] * b[q] - a[q] * b[p];
    let value = match &minor[..] {
        [a, b] => det2(a, b, 0, 1),
        [a, b, c] => a[0] * det2(b, c, 1, 2) - a[1] * det2(b, c, 0, 2) + a[2] * det2(b, c, 0, 1),
        _ => unreachable!("3×3 or 4×4"),
    };
    if (i + j).is_multiple_of(2) { value } else { -value }
}

/// `num / den`, and whether a number is within half a unit of it.
fn is_nearest(found: i128, num: i128, den: i128) -> bool {
    2 * (found * den - num).abs() <= den.abs()
}

#[test]
fn inverses_of_affine_transforms_are_the_exact_ones_rounded() {
    let seed = 21;
    let mut rng = Rng::new(seed);
    let (mut some, mut none) = (0, 0);
    for case in 0..20_000 {
        let shift = rng.between(0, 30);
        let mut number = || rng.between(i32::MIN, i32::MAX) >> shift;
        let m: [[i32; 4]; 3] = core::array::from_fn(|_| core::array::from_fn(|_| number()));
        let row = |k: usize| Vec3::from_bits([m[k][0], m[k][1], m[k][2]]);
        let transform = Affine::from_rows(row(0), row(1), row(2), Vec3::from_bits([m[0][3], m[1][3], m[2][3]]));
        let matrix: [[i128; 3]; 3] = core::array::from_fn(|i| core::array::from_fn(|j| m[i][j].into()));
        let det: i128 = (0..3).map(|j| matrix[0][j] * cofactor(&matrix, 0, j)).sum();
        let exact = |i: usize, j: usize| match j {
            3 => -(0..3).map(|k| cofactor(&matrix, k, i) * i128::from(m[k][3])).sum::<i128>() << 16,
            _ => cofactor(&matrix, j, i) << 32,
        };
        match transform.inverse() {
            Some(inverse) => {
                some += 1;
                for (i, row) in inverse.to_rows().iter().enumerate() {
                    for (j, entry) in row.iter().enumerate() {
                        let nearest = is_nearest(i128::from(*entry), exact(i, j), det);
                        assert!(nearest, "seed {seed}, case {case}: {m:?}, entry ({i}, {j}) is {entry}");
                    }
                }
            }
            None => {
                none += 1;
                let fits = |i: usize, j: usize| (exact(i, j) / det).abs() < 1 << 31;
                let all = det != 0 && (0..3).all(|i| (0..4).all(|j| fits(i, j)));
                assert!(!all, "seed {seed}, case {case}: {m:?} has an inverse");
            }
        }
    }
    println!("{some} inverses, {none} transforms without one");
    assert!(some > 5000 && none > 500, "{some}, {none}");
}

#[test]
fn inverses_of_small_projective_transforms_are_the_exact_ones_rounded() {
    let seed = 22;
    let mut rng = Rng::new(seed);
    let mut some = 0;
    for case in 0..5000 {
        let bits = rng.between(2, 15);
        let rows: [[i64; 4]; 4] =
            core::array::from_fn(|_| core::array::from_fn(|_| rng.between(-(1 << bits), 1 << bits).into()));
        let m = rows.map(|row| row.map(i128::from));
        let det: i128 = (0..4).map(|j| m[0][j] * cofactor(&m, 0, j)).sum();
        let exact = |i: usize, j: usize| cofactor(&m, j, i) << 64;
        match Projective::from_rows(rows).inverse() {
            Some(inverse) => {
                some += 1;
                for (i, row) in inverse.to_rows().iter().enumerate() {
                    for (j, entry) in row.iter().enumerate() {
                        let (found, off) = (i128::from(*entry), exact(i, j) % det);
                        // In two steps: the product of quotient and determinant would not fit.
                        let floor = (exact(i, j) - off) / det;
                        assert!(is_nearest(found - floor, off, det), "seed {seed}, case {case}: {rows:?} ({i}, {j})");
                    }
                }
            }
            None => assert!(
                det == 0 || (0..4).any(|i| (0..4).any(|j| (exact(i, j) / det).abs() >= i128::from(i64::MAX))),
                "seed {seed}, case {case}: {rows:?}"
            ),
        }
    }
    assert!(some > 4000, "{some}");
}

/// Off by half a unit each, the entries of the inverse may leave half of a row's sum in each entry of the product.
#[test]
fn cameras_and_large_matrices_are_undone() {
    let seed = 23;
    let mut rng = Rng::new(seed);
    for case in 0..2000 {
        let camera = if case % 2 == 0 {
            let angle = Angle16::from_degrees(rng.between(5, 170));
            let lens = Projective::perspective(angle, Size::new(320, 240), Scalar::ONE, Scalar::from_num(100));
            lens.expect("a camera") * (Affine::translation(Vec3::from_ints(3, -2, -9)) * rigid(&mut rng, 4.0))
        } else {
            let mut entry = || i64::from(rng.between(i32::MIN, i32::MAX)) << 8;
            Projective::from_rows(core::array::from_fn(|_| core::array::from_fn(|_| entry())))
        };
        let inverse = camera.inverse().unwrap_or_else(|| panic!("seed {seed}, case {case}: {camera:?}"));
        let (a, b) = (camera.to_rows(), inverse.to_rows());
        for (i, row) in a.iter().enumerate() {
            let bound = row.iter().map(|entry| i128::from(entry.unsigned_abs())).sum::<i128>() / 2 + 1;
            for j in 0..4 {
                let column = b.iter().map(|row| row[j]);
                let product: i128 = row.iter().zip(column).map(|(a, b)| i128::from(*a) * i128::from(b)).sum();
                let one = i128::from(i == j) << 64;
                assert!((product - one).abs() <= bound, "seed {seed}, case {case}: {camera:?} ({i}, {j})");
            }
        }
    }
    assert_eq!(Projective::from_rows([[i64::MIN; 4]; 4]).inverse(), None);
    assert_eq!(Projective::IDENTITY.inverse(), Some(Projective::default()));
    // The largest determinants that there are.
    let (p, m) = (i64::MAX, i64::MIN);
    let hadamard = Projective::from_rows([[p, p, p, p], [p, m, p, m], [p, p, m, m], [p, m, m, p]]);
    let inverse = hadamard.inverse().expect("an inverse").to_rows();
    // A quarter of 2⁶⁴ / 2⁶³, which is half a unit.
    assert!(inverse.as_flattened().iter().all(|entry| entry.abs() <= 1), "{inverse:?}");
}
