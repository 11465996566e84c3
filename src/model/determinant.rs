//! Determinants of transforms, exactly: a transform that mirrors, and the point that one brings to the origin.

use crate::math::{Affine, mul_long, mul_wide};

/// Returns the minor a b - c d of a matrix: below 2⁶³.
fn minor(a: i32, b: i32, c: i32, d: i32) -> i64 {
    mul_wide(a, b) - mul_wide(c, d)
}

/// Returns the cofactors of a row of a matrix, of the two other rows in cyclic order.
fn cofactors([a, b, c]: [i32; 3], [d, e, f]: [i32; 3]) -> [i64; 3] {
    [minor(b, f, c, e), minor(c, d, a, f), minor(a, e, b, d)]
}

/// Returns the sum of three products, exactly: below 3 · 2⁹⁴.
fn dot([a, b, c]: [i64; 3], [x, y, z]: [i32; 3]) -> i128 {
    mul_long(a, x) + mul_long(b, y) + mul_long(c, z)
}

/// Returns whether a transform is a mirror: its determinant is negative.
pub(super) fn is_mirrored(transform: &Affine) -> bool {
    let [x, y, z] = transform.to_rows().map(|[x, y, z, _]| [x, y, z]);
    dot(cofactors(y, z), x) < 0
}

/// Returns the point, raw 16.16, that a transform brings to the origin. `None` if there is no such point, or if it is
/// beyond the range of numbers.
///
/// # Format
/// By Cramer's rule, a coordinate is a quotient of a sum of three products and the determinant, both of at most 96
/// bits. They are cut until the determinant has 32 bits. Coordinates are within 2⁻¹⁵ of the exact ones.
pub(super) fn origin_of(transform: &Affine) -> Option<[i32; 3]> {
    let rows = transform.to_rows();
    let ([x, y, z], t) = (rows.map(|[x, y, z, _]| [x, y, z]), rows.map(|[.., t]| t));
    let [a, b, c] = [cofactors(y, z), cofactors(z, x), cofactors(x, y)];
    let determinant = dot(a, x);
    let cut = 96_u32.saturating_sub(determinant.unsigned_abs().leading_zeros());
    let divisor = (determinant.unsigned_abs() >> cut) as u64;
    let coordinate = |k: usize| {
        let numerator = dot([a[k], b[k], c[k]], t);
        let quotient = u64::try_from((numerator.unsigned_abs() << 16) >> cut).ok()?.checked_div(divisor)?;
        let quotient = i32::try_from(quotient).ok()?;
        Some(if (numerator < 0) == (determinant < 0) { -quotient } else { quotient })
    };
    Some([coordinate(0)?, coordinate(1)?, coordinate(2)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use crate::math::{Scalar, Vec3};

    fn random(rng: &mut Rng, bits: u32, moved: u32) -> Affine {
        let mut vector = |bits| Vec3::from_bits(core::array::from_fn(|_| rng.signed_bits(bits) as i32));
        Affine::from_rows(vector(bits), vector(bits), vector(bits), vector(moved))
    }

    #[test]
    fn the_origin_of_a_transform_is_that_of_its_inverse() {
        let mut rng = Rng::new(4);
        let mut found = 0;
        for case in 0..20_000 {
            let transform = random(&mut rng, 4 + case % 28, 1 + case / 7 % 31);
            let Some(origin) = origin_of(&transform) else { continue };
            let Some(inverse) = transform.inverse() else { continue };
            found += 1;
            let exact = inverse.transform_point(Vec3::ZERO).to_bits();
            let is_near = origin.iter().zip(exact).all(|(a, b)| a.abs_diff(b) <= 2);
            assert!(is_near, "{origin:?}, not {exact:?}: {transform:?}");
        }
        assert!(found > 5000, "{found}");
        assert_eq!(origin_of(&Affine::scale(Scalar::ZERO)), None);
        let far = Affine::translation(Vec3::from_ints(20_000, 0, 0)) * Affine::scale(Scalar::from_num(0.5));
        assert_eq!(origin_of(&far), None);
        let ends = Affine::from_rows(Vec3::X, Vec3::Y, Vec3::Z, Vec3::from_bits([i32::MIN, i32::MAX, 1]));
        assert_eq!(origin_of(&ends), None);
    }

    #[test]
    fn mirrors_have_a_negative_determinant() {
        let mut rng = Rng::new(5);
        for case in 0..20_000 {
            let transform = random(&mut rng, 2 + case % 31, 5);
            let [[a, b, c, _], [d, e, f, _], [g, h, i, _]] = transform.to_rows().map(|row| row.map(i128::from));
            let determinant = a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g);
            assert_eq!(is_mirrored(&transform), determinant < 0, "{transform:?}");
        }
        let least = Vec3::from_bits([i32::MIN; 3]);
        assert!(!is_mirrored(&Affine::from_rows(least, least, least, least)));
        assert!(is_mirrored(&Affine::scale(Scalar::MIN)));
    }
}
