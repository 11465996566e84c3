//! Computes numbers of geometry: `const` code has arithmetic, but neither roots nor sines.

use zstrip::math::{Scalar, Vec3};
use zstrip::mesh::Positions;

/// Returns the square root, by Newton's method.
pub const fn root(x: f64) -> f64 {
    let mut r = if x < 1.0 { 1.0 } else { x };
    let mut k = 0;
    while k < 64 {
        r = (r + x / r) / 2.0;
        k += 1;
    }
    r
}

/// Returns sine and cosine for |x| ≤ 2π, by their series: errors are below 1e-13.
pub const fn sin_cos(x: f64) -> (f64, f64) {
    let (mut sin, mut cos) = (0.0, 0.0);
    let mut term = 1.0;
    let mut k = 0;
    while k < 40 {
        match k % 4 {
            0 => cos += term,
            1 => sin += term,
            2 => cos -= term,
            _ => sin -= term,
        }
        k += 1;
        term = term * x / k as f64;
    }
    (sin, cos)
}

pub const fn nearest(x: f64) -> i64 {
    (if x < 0.0 { x - 0.5 } else { x + 0.5 }) as i64
}

pub const fn vector(v: [f64; 3]) -> Vec3 {
    Vec3::from_bits([nearest(v[0] * 65_536.0) as i32, nearest(v[1] * 65_536.0) as i32, nearest(v[2] * 65_536.0) as i32])
}

/// Returns a point as fractions of a cube. `half` is half of the cube's side.
pub const fn quantized(v: [f64; 3], middle: [f64; 3], half: f64) -> [i16; 3] {
    [
        nearest((v[0] - middle[0]) / half * 32_768.0) as i16,
        nearest((v[1] - middle[1]) / half * 32_768.0) as i16,
        nearest((v[2] - middle[2]) / half * 32_768.0) as i16,
    ]
}

pub const fn quantities<'a>(points: &'a [[i16; 3]], middle: [f64; 3], half: f64) -> Positions<'a> {
    Positions::Quantized { points, scale: Scalar::from_bits(nearest(half * 65_536.0) as i32), offset: vector(middle) }
}

pub const fn normal(n: [f64; 3]) -> [i16; 3] {
    [nearest(n[0] * 16_384.0) as i16, nearest(n[1] * 16_384.0) as i16, nearest(n[2] * 16_384.0) as i16]
}

pub const fn normalized(v: [f64; 3]) -> [f64; 3] {
    let length = root(dot(v, v));
    [v[0] / length, v[1] / length, v[2] / length]
}

pub const fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub const fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub const fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
