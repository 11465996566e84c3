//! Clusters of a part, with the cones that tell from where only their backs are seen.

use zstrip::model::container::Cluster;

use super::parts::Piece;
use super::quantize::fraction_box;
use crate::geometry::{Vector, cross, dot, unit};

/// Returns the clusters of a part, with boxes and cones around its quantized triangles.
pub(super) fn clusters(piece: &Piece, points: &[[i16; 3]]) -> Vec<Cluster> {
    let mut first = 0;
    let cluster = |count: &usize| {
        let triangles = &piece.triangles[first..first + count];
        let (center, half) = fraction_box(triangles.as_flattened().iter().map(|v| points[usize::from(*v)]));
        let normals: Vec<_> = triangles.iter().filter_map(|t| face(t.map(|v| points[usize::from(v)]))).collect();
        let (axis, cutoff) = cone(&normals);
        let item = Cluster { center, half, first_triangle: first as u16, triangles: *count as u16, axis, cutoff };
        first += count;
        item
    };
    piece.clusters.iter().map(cluster).collect()
}

/// Returns the unit normal of a triangle, if it has an area.
fn face(corners: [[i16; 3]; 3]) -> Option<Vector> {
    let [a, b, c] = corners.map(|p| p.map(f64::from));
    let side = |p: Vector| std::array::from_fn(|k| p[k] - a[k]);
    unit(cross(side(b), side(c)))
}

/// Returns axis and cutoff of a cone around normals: no triangle of the cluster is seen where the cone says so.
///
/// With the axis a of length l ≤ 1, and all normals within an angle α of it, an eye e sees only backs if
/// (c - e) · a / l ≥ sin α |c - e| + r. The container's rule has l sin α for the cutoff and r for l r, which is more.
fn cone(normals: &[Vector]) -> ([i8; 3], i8) {
    const NEVER: ([i8; 3], i8) = ([0, 0, 0], 127);
    let mut sum = [0.0; 3];
    normals.iter().for_each(|n| (0..3).for_each(|k| sum[k] += n[k]));
    let Some(middle) = unit(sum) else { return NEVER };
    let axis = middle.map(|c| (c * 127.0).trunc() as i8);
    let exact = axis.map(|c| f64::from(c) / 127.0);
    let (length, Some(direction)) = (dot(exact, exact).sqrt(), unit(exact)) else { return NEVER };
    let cosine = normals.iter().map(|n| dot(*n, direction)).fold(1.0, f64::min);
    if cosine <= 0.05 {
        return NEVER;
    }
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    (axis, (sine * length * 127.0 + 1e-6).ceil().min(127.0) as i8)
}
