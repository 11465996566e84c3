//! Vectors and matrices in 64-bit floats, as far as imports need them.

use crate::model::Transform;

pub(crate) type Vector = [f64; 3];

/// Four columns.
pub(crate) type Matrix = [[f64; 4]; 4];

pub(crate) fn sub(a: [f32; 3], b: [f32; 3]) -> Vector {
    std::array::from_fn(|k| f64::from(a[k]) - f64::from(b[k]))
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The vector of length 1 in this direction, or none for 0.
pub(crate) fn unit(v: Vector) -> Option<Vector> {
    let largest = v.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if largest.is_nan() || largest <= 0.0 || largest.is_infinite() {
        return None;
    }
    let v = v.map(|x| x / largest);
    let length = dot(v, v).sqrt();
    Some(v.map(|x| x / length))
}

/// The unit normal of a triangle, or none if it has no area.
///
/// A triangle counts as without area where its height is below 1e-10 of its longest side: positions are 24 bits.
pub(crate) fn face_normal(corners: [[f32; 3]; 3]) -> Option<Vector> {
    let [a, b, c] = corners;
    let (ab, ac, bc) = (sub(b, a), sub(c, a), sub(c, b));
    let normal = cross(ab, ac);
    let longest = dot(ab, ab).max(dot(ac, ac)).max(dot(bc, bc));
    if dot(normal, normal).sqrt() <= 1e-10 * longest { None } else { unit(normal) }
}

/// The angle of a triangle at its corner `k`.
pub(crate) fn corner_angle(corners: [[f32; 3]; 3], k: usize) -> f64 {
    let [a, b] = [1, 2].map(|step| sub(corners[(k + step) % 3], corners[k]));
    let normal = cross(a, b);
    dot(normal, normal).sqrt().atan2(dot(a, b))
}

pub(crate) const IDENTITY: Matrix =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// The matrix that does `b` first and then `a`.
pub(crate) fn times(a: &Matrix, b: &Matrix) -> Matrix {
    b.map(|column| std::array::from_fn(|row| (0..4).map(|k| a[k][row] * column[k]).sum()))
}

pub(crate) fn point(m: &Matrix, p: Vector) -> Vector {
    std::array::from_fn(|row| m[0][row] * p[0] + m[1][row] * p[1] + m[2][row] * p[2] + m[3][row])
}

/// The determinant of the upper three rows and columns: below 0 where the matrix mirrors.
pub(crate) fn determinant(m: &Matrix) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|k| [m[k][0], m[k][1], m[k][2]]);
    dot(cross(x, y), z)
}

pub(crate) fn matrix(transform: &Transform) -> Matrix {
    match transform {
        Transform::Matrix(columns) => columns.map(|column| column.map(f64::from)),
        Transform::Parts { translation, rotation, scale } => {
            trs(translation.map(f64::from), rotation.map(f64::from), scale.map(f64::from))
        }
    }
}

/// The matrix that scales, then turns by a quaternion of any length but 0, then moves.
pub(crate) fn trs(translation: Vector, rotation: [f64; 4], scale: Vector) -> Matrix {
    let length = rotation.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [x, y, z, w] = rotation.map(|c| if length > 0.0 { c / length } else { c });
    let columns = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)],
        [2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)],
        [2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let axis = |k: usize| {
        let [a, b, c] = columns[k].map(|v| v * scale[k]);
        [a, b, c, 0.0]
    };
    let [a, b, c] = translation;
    [axis(0), axis(1), axis(2), [a, b, c, 1.0]]
}

/// The quaternion brought to length 1, and whether it was further from it than rounding explains.
pub(crate) fn unit_quaternion(q: [f32; 4]) -> ([f32; 4], bool) {
    let wide = q.map(f64::from);
    let length = wide.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 || !length.is_finite() {
        return ([0.0, 0.0, 0.0, 1.0], true);
    }
    (wide.map(|x| (x / length) as f32), (length - 1.0).abs() > 0.01)
}
