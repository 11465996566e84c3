//! Unit vectors along lines that have a width.

use crate::math::{isqrt, mul_high, mul_high_signed, reciprocal};

/// Returns the vector of length 1 in the direction of (x, y); zero for the zero vector.
///
/// # Format
/// Components are within ±2²⁵. The result is 2.30, within 2⁻²³ of the exact one. A root of 15 bits and its reciprocal
/// give a first vector within 2⁻¹². Its squared length falls short of 1 by e; multiplying it by 1 + e / 2 leaves an
/// error of 3/8 e².
pub(crate) fn unit(x: i32, y: i32) -> (i32, i32) {
    let larger = x.unsigned_abs().max(y.unsigned_abs());
    if larger == 0 {
        return (0, 0);
    }
    // Scales the larger component to 2²⁹..2³⁰.
    let up = larger.leading_zeros().saturating_sub(2);
    let (x, y) = (x << up, y << up);
    let (a, b) = (x >> 15, y >> 15);
    // The sum is in 2²⁸..=2³¹, so the root is in 2¹⁴..2¹⁶.
    let root = isqrt((a * a).wrapping_add(b * b) as u32).max(1);
    let zeros = root.leading_zeros();
    // 2⁴⁶ / root.
    let scale = reciprocal(root << zeros) >> 17_u32.saturating_sub(zeros);
    // 3.29.
    let (u, v) = (mul_high_signed(x, scale), mul_high_signed(y, scale));
    let square = |c: i32| mul_high((2 * c).unsigned_abs(), (2 * c).unsigned_abs()) as i32;
    // 4.28, below 2⁻¹¹.
    let lack = (1 << 28) - square(u) - square(v);
    let mended = |c: i32| 2 * (c + (((c >> 15) * lack) >> 14));
    (mended(u), mended(v))
}

#[cfg(test)]
mod tests {
    use super::unit;
    use crate::math::random::Rng;

    #[test]
    fn unit_vectors_have_length_1_and_the_direction() {
        let mut rng = Rng::new(5);
        let mut next = |limit: i32| rng.between(-limit, limit);
        let mut worst = 0_f64;
        for case in 0..100_000 {
            let limit = 1 << (1 + case % 25);
            let (x, y) = match case % 7 {
                0 => (next(limit), 0),
                1 => (limit, limit),
                2 => (-limit, next(3)),
                _ => (next(limit), next(limit)),
            };
            if (x, y) == (0, 0) {
                assert_eq!(unit(x, y), (0, 0));
                continue;
            }
            let length = f64::from(x).hypot(f64::from(y));
            let (u, v) = unit(x, y);
            for (found, exact) in [(u, f64::from(x) / length), (v, f64::from(y) / length)] {
                worst = worst.max((f64::from(found) / 2f64.powi(30) - exact).abs());
            }
        }
        assert!(worst < 2f64.powi(-23), "worst error 2^{}", worst.log2());
        std::println!("worst error 2^{}", worst.log2());
    }
}
