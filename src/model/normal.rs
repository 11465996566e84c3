//! Unit vectors in two bytes.

use crate::math::unit_vector;

/// Returns the unit normal, 2.14, of two bytes: an octahedron, whose lower half is folded over the upper one.
///
/// ```text
/// -127     127            (x, y) / 127 is on the square. Inside of |x| + |y| = 127 is the upper half,
///   +-------+              with z = 127 - |x| - |y|. Each corner of the square is the lowest point, -z:
///   | \ | / |              there, (x, y) stands for ((127 - |y|) sign x, (127 - |x|) sign y).
///   |---+---|
///   | / | \ |
///   +-------+
/// ```
///
/// # Format
/// Numbers are in -127..=127; -128 counts as -127. Components are within 1.5 of the exact ones. The bytes nearest to a
/// direction are within 0.95 degrees of it.
#[inline]
#[must_use]
pub fn decode_normal(bytes: [i8; 2]) -> [i16; 3] {
    let [x, y, z] = octahedral(bytes);
    // The length is 73 to 127: 2¹⁴ to 2¹⁵ now.
    let [x, y, z] = unit_vector([x << 8, y << 8, z << 8]);
    [x as i16, y as i16, z as i16]
}

/// Returns the point of the octahedron |x| + |y| + |z| = 127 that two bytes stand for.
#[inline(always)]
pub(super) fn octahedral([x, y]: [i8; 2]) -> [i32; 3] {
    let (x, y) = (i32::from(x).max(-127), i32::from(y).max(-127));
    let z = 127 - x.abs() - y.abs();
    // What z is below 0 is taken off both others; they change sides then. 0 counts as positive.
    let fold = (-z).max(0);
    let folded = |c: i32| if c < 0 { c + fold } else { c - fold };
    [folded(x), folded(y), z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::println;

    /// The definition in double precision.
    fn exact([x, y]: [i8; 2]) -> [f64; 3] {
        let (x, y) = (f64::from(x).max(-127.0) / 127.0, f64::from(y).max(-127.0) / 127.0);
        let z = 1.0 - x.abs() - y.abs();
        let sign = |c: f64| if c < 0.0 { -1.0 } else { 1.0 };
        let (x, y) = if z < 0.0 { ((1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)) } else { (x, y) };
        let length = (x * x + y * y + z * z).sqrt();
        [x / length, y / length, z / length]
    }

    #[test]
    fn bytes_decode_to_the_directions_of_the_definition() {
        let mut worst = 0.0_f64;
        for bytes in (i8::MIN..=i8::MAX).flat_map(|x| (i8::MIN..=i8::MAX).map(move |y| [x, y])) {
            let found = decode_normal(bytes).map(f64::from);
            for (found, exact) in found.into_iter().zip(exact(bytes)) {
                worst = worst.max((found - 16_384.0 * exact).abs());
            }
        }
        println!("worst component off by {worst:.3} / 2^14");
        assert!(worst < 1.5, "{worst}");
    }

    #[test]
    fn some_bytes_are_within_a_degree_of_any_direction() {
        let mut worst = 0.0_f64;
        for k in 0..20_000 {
            // Directions spread evenly over the sphere.
            let z = 1.0 - (2.0 * f64::from(k) + 1.0) / 20_000.0;
            let (turn, ring) = (2.399_963_229_728_653 * f64::from(k), (1.0 - z * z).sqrt());
            let n = [ring * turn.cos(), ring * turn.sin(), z];
            let sum = n.iter().map(|c| c.abs()).sum::<f64>();
            let (x, y) = (n[0] / sum, n[1] / sum);
            let sign = |c: f64| if c < 0.0 { -1.0 } else { 1.0 };
            let (x, y) = if z < 0.0 { ((1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)) } else { (x, y) };
            let around = |c: f64| [(c * 127.0).floor() as i8, ((c * 127.0).floor() as i8).saturating_add(1)];
            let best = around(x).into_iter().flat_map(|x| around(y).map(|y| [x, y])).map(|bytes| {
                let found = exact(bytes);
                let dot: f64 = (0..3).map(|k| found[k] * n[k]).sum();
                dot.clamp(-1.0, 1.0).acos().to_degrees()
            });
            worst = worst.max(best.fold(f64::MAX, f64::min));
        }
        println!("worst direction off by {worst:.3} degrees");
        assert!(worst < 0.95, "{worst}");
    }
}
