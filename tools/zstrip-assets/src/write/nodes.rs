//! Nodes: translation, rotation and scale of each, also of those that have a matrix.

use bytemuck::Zeroable;
use zstrip::model::container::{NONE, Node, SectionKind};

use super::quantize::fixed;
use super::report::{WriteError, WriteNote, WriteReport};
use super::sections::Sections;
use crate::geometry::{Matrix, Vector, cross, determinant, dot, matrix, unit};
use crate::model::{Import, Transform};

/// Nodes of the container, and the number of each node of the import in it.
pub(super) struct Nodes {
    pub items: Vec<Node>,
    pub numbers: Vec<u16>,
}

/// Writes the transforms of all nodes. A matrix that shears is a rotation after a scale after a rotation, so its node
/// becomes two: the first has the first two of them.
pub(super) fn nodes(import: &Import, to: &mut Sections, report: &mut WriteReport) -> Result<Nodes, WriteError> {
    let (mut items, mut numbers) = (Vec::new(), Vec::new());
    let mut sheared = 0;
    for (k, node) in import.nodes.iter().enumerate() {
        let place = |what: &str| format!("nodes[{k}], {what}");
        let mut parent = node.parent.map_or(NONE, |parent| numbers[parent]);
        let mut end = node.name.len().min(0xFFFF);
        while !node.name.is_char_boundary(end) {
            end -= 1;
        }
        let name = &node.name.as_bytes()[..end];
        let (first, name_length) = (to.add(SectionKind::Bytes, name), name.len() as u16);
        let mut push = |translation: Vector, rotation, scale: Vector, is_named: bool| {
            let [translation, scale] = [(translation, "translation"), (scale, "scale")].map(|(v, what)| {
                let [x, y, z] = v.map(|x| fixed(x, || place(what)));
                Ok::<_, WriteError>([x?, y?, z?])
            });
            let rotation = longest(rotation).ok_or_else(|| WriteError::NotFinite { place: place("rotation") })?;
            items.push(Node {
                parent,
                name: if is_named { first } else { 0 },
                name_length: if is_named { name_length } else { 0 },
                translation: translation?,
                rotation,
                scale: scale?,
                ..Node::zeroed()
            });
            parent = (items.len() - 1).min(usize::from(NONE)) as u16;
            Ok::<_, WriteError>(())
        };
        match &node.transform {
            Transform::Parts { translation, rotation, scale } => {
                push(translation.map(f64::from), rotation.map(f64::from), scale.map(f64::from), true)?;
            }
            Transform::Matrix(columns) => {
                if !columns.as_flattened().iter().all(|x| x.is_finite()) {
                    return Err(WriteError::NotFinite { place: place("matrix") });
                }
                let m = matrix(&node.transform);
                let translation = [m[3][0], m[3][1], m[3][2]];
                if let Some((rotation, scale)) = turned_and_scaled(&m) {
                    push(translation, rotation, scale, true)?;
                } else {
                    let (after, scale, before) = singular_values(&m);
                    push(translation, after, scale, false)?;
                    push([0.0; 3], before, [1.0; 3], true)?;
                    sheared += 1;
                }
            }
        }
        numbers.push(parent);
    }
    let (found, most) = (items.len(), usize::from(NONE));
    if found > most {
        return Err(WriteError::TooMany { what: "nodes", found, most });
    }
    report.note(sheared, |nodes| WriteNote::Sheared { nodes });
    Ok(Nodes { items, numbers })
}

/// Returns the longest quaternion of 16-bit numbers in the direction of this one.
fn longest(rotation: [f64; 4]) -> Option<[i16; 4]> {
    let largest = rotation.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    if rotation.iter().any(|c| !c.is_finite()) {
        return None;
    }
    if largest == 0.0 {
        return Some([0, 0, 0, 0x7FFF]);
    }
    Some(rotation.map(|c| (c / largest * 32_767.0).round() as i16))
}

/// Returns rotation and scale of a matrix whose columns are at right angles.
fn turned_and_scaled(m: &Matrix) -> Option<([f64; 4], Vector)> {
    let columns = [0, 1, 2].map(|k| [m[k][0], m[k][1], m[k][2]]);
    let mut scale = columns.map(|c| dot(c, c).sqrt());
    let mut axes = [unit(columns[0])?, unit(columns[1])?, unit(columns[2])?];
    if [(0, 1), (1, 2), (2, 0)].iter().any(|(a, b)| dot(axes[*a], axes[*b]).abs() > 1e-5) {
        return None;
    }
    if determinant(m) < 0.0 {
        scale[0] = -scale[0];
        axes[0] = axes[0].map(|x| -x);
    }
    Some((quaternion(&axes), scale))
}

/// Returns a rotation, a scale and a rotation whose product, from the last to the first, is the matrix: the singular
/// value decomposition, by Jacobi's rotations of the columns.
fn singular_values(m: &Matrix) -> ([f64; 4], Vector, [f64; 4]) {
    let mut u = [0, 1, 2].map(|k| [m[k][0], m[k][1], m[k][2]]);
    let mut v: [Vector; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..24 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            // The angle that brings columns p and q to a right angle.
            let (a, b, c) = (dot(u[p], u[p]), dot(u[q], u[q]), dot(u[p], u[q]));
            let (sin, cos) = (0.5 * (2.0 * c).atan2(a - b)).sin_cos();
            for columns in [&mut u, &mut v] {
                let (x, y) = (columns[p], columns[q]);
                columns[p] = std::array::from_fn(|k| cos * x[k] + sin * y[k]);
                columns[q] = std::array::from_fn(|k| cos * y[k] - sin * x[k]);
            }
        }
    }
    // Columns go from large to small, so the last ones may be missing.
    let mut scale = u.map(|c| dot(c, c).sqrt());
    let x = unit(u[0]).unwrap_or([1.0, 0.0, 0.0]);
    let small = 1e-9 * scale[0];
    let y = if scale[1] > small {
        u[1]
    } else {
        cross(x, if x[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] })
    };
    let y = unit(y).unwrap_or([0.0, 1.0, 0.0]);
    let z = cross(x, y);
    if dot(z, u[2]) < 0.0 {
        scale[2] = -scale[2];
    }
    // The columns of v are the rows of the first rotation.
    let rows: [Vector; 3] = std::array::from_fn(|k| std::array::from_fn(|j| v[j][k]));
    (quaternion(&[x, y, z]), scale, quaternion(&rows))
}

/// Returns the quaternion of a rotation of these columns.
fn quaternion(axes: &[Vector; 3]) -> [f64; 4] {
    let m = |row: usize, column: usize| axes[column][row];
    let trace = m(0, 0) + m(1, 1) + m(2, 2);
    // The largest of the four, times two, is safe to divide by.
    let squares = [m(0, 0) * 2.0 - trace, m(1, 1) * 2.0 - trace, m(2, 2) * 2.0 - trace, trace];
    let largest = (0..4).max_by(|a, b| squares[*a].total_cmp(&squares[*b])).unwrap_or(3);
    let twice = (squares[largest] + 1.0).max(0.0).sqrt();
    let off = |i: usize, j: usize, sign: f64| (m(i, j) + sign * m(j, i)) / (2.0 * twice);
    let half = twice / 2.0;
    match largest {
        0 => [half, off(1, 0, 1.0), off(2, 0, 1.0), off(2, 1, -1.0)],
        1 => [off(1, 0, 1.0), half, off(2, 1, 1.0), off(0, 2, -1.0)],
        2 => [off(2, 0, 1.0), off(2, 1, 1.0), half, off(1, 0, -1.0)],
        _ => [off(2, 1, -1.0), off(0, 2, -1.0), off(1, 0, -1.0), half],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{times, trs};

    #[test]
    fn a_matrix_is_a_rotation_after_a_scale_after_a_rotation() {
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 40) as f64 / f64::from(1 << 23) - 1.0
        };
        for round in 0..2000 {
            let mut m: Matrix =
                std::array::from_fn(
                    |k| if k == 3 { [0.0, 0.0, 0.0, 1.0] } else { [random(), random(), random(), 0.0] },
                );
            if round % 3 == 1 {
                // A plane.
                m[2] = std::array::from_fn(|k| m[0][k] + m[1][k]);
            }
            let (after, scale, before) = singular_values(&m);
            let found = times(&trs([0.0; 3], after, scale), &trs([0.0; 3], before, [1.0; 3]));
            let worst = found.as_flattened().iter().zip(m.as_flattened()).map(|(a, b)| (a - b).abs());
            let worst = worst.fold(0.0, f64::max);
            assert!(worst < 1e-9, "round {round}: {m:?} is off by {worst}");
        }
    }

    #[test]
    fn right_angles_need_one_node() {
        let rotation = [0.1, -0.7, 0.3, 0.2];
        for scale in [[1.0, 2.0, 3.0], [-1.0, 2.0, 3.0], [0.5, -0.5, -0.5]] {
            let m = trs([1.0, 2.0, 3.0], rotation, scale);
            let (turn, factors) = turned_and_scaled(&m).expect("right angles");
            let found = trs([1.0, 2.0, 3.0], turn, factors);
            let worst = found.as_flattened().iter().zip(m.as_flattened()).map(|(a, b)| (a - b).abs());
            assert!(worst.fold(0.0, f64::max) < 1e-12, "{scale:?}");
        }
    }
}
