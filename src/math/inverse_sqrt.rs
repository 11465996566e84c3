//! Inverse square roots without a divider, for making vectors of length 1: a table, and chords between its entries.

use super::reciprocal::leading_zeros;

/// Roots: entry `n & 255` is 2¹⁹ / √n for n in 64..=256, lowered by half of the largest height of the chord to the
/// next entry above the curve. (65,536 is kept as 65,535.)
static ROOTS: [u16; 256] = roots();

const fn roots() -> [u16; 256] {
    let mut table = [u16::MAX; 256];
    let mut n = 64_u64;
    while n <= 256 {
        // `root` is eight times the root. A chord of f = n^(-1/2) over a unit of n is at most f'' / 8 = f · 3 / (32
        // n²) too high.
        let root = ((1_u64 << 44) / n).isqrt();
        let value = (root - root * 3 / (64 * n * n) + 4) >> 3;
        table[(n & 255) as usize] = if value > u16::MAX as u64 { u16::MAX } else { value as u16 };
        n += 1;
    }
    table
}

/// Returns 2²³ / √`x`.
///
/// # Format
/// `x` in 2¹⁴..=2¹⁶; the result is in 2¹⁵..2¹⁶. It is off by less than 1.4, so by a relative 2⁻¹⁵ (tested for all
/// `x`). Any other `x` gives some number below 2¹⁶.
#[inline]
pub const fn inverse_sqrt(x: u32) -> u32 {
    let n = x as usize >> 8;
    let (here, next) = (ROOTS[n & 0xFF] as u32, ROOTS[(n + 1) & 0xFF] as u32);
    here.wrapping_sub((here.wrapping_sub(next).wrapping_mul(x & 0xFF).wrapping_add(128)) >> 8) & 0xFFFF
}

/// Returns the vector of length 1 in the direction of `v`, in 2.14; zero for zero.
///
/// # Format
/// Components are below 2¹⁵ in magnitude, in any unit. Each component of the result is within 1.5 of the exact one if
/// the length is at least 2¹¹; for shorter vectors it is as exact as their components are. It takes some 35
/// instructions if the length is in 2¹⁴..=2¹⁵, and about twice as many otherwise. For larger components, whose squares
/// wrap, the result is some vector with components from -2¹⁵ to 2¹⁵.
#[inline]
pub fn unit_vector(v: [i32; 3]) -> [i32; 3] {
    let [x, y, z] = v;
    // Below 3 · 2³⁰.
    let q = x.wrapping_mul(x).wrapping_add(y.wrapping_mul(y)).wrapping_add(z.wrapping_mul(z)) as u32;
    if q.wrapping_sub(1 << 28) <= (1 << 30) - (1 << 28) { divide_by_root(v, q) } else { unit_vector_of_any_length(v) }
}

/// Returns `v` / √`q` in 2.14, where `q`, in 2²⁸..=2³⁰, is the sum of the squares of `v`.
#[inline(always)]
fn divide_by_root([x, y, z]: [i32; 3], q: u32) -> [i32; 3] {
    // The factor is 2³⁰ / √q. Its product with a component is at most 2³⁰ and a little.
    let factor = inverse_sqrt((q + (1 << 13)) >> 14) as i32;
    let component = |c: i32| c.wrapping_mul(factor).wrapping_add(1 << 15) >> 16;
    [component(x), component(y), component(z)]
}

/// Returns [`unit_vector`] for components of any size: shifts the vector until its length is in 2¹⁴..=2¹⁵. It has no
/// loop, so that there is none to run for ever where a square wraps.
#[inline(never)]
pub fn unit_vector_of_any_length(v: [i32; 3]) -> [i32; 3] {
    let moved = |[x, y, z]: [i32; 3], down: u32| [x >> down, y >> down, z >> down];
    let square =
        |[x, y, z]: [i32; 3]| x.wrapping_mul(x).wrapping_add(y.wrapping_mul(y)).wrapping_add(z.wrapping_mul(z)) as u32;
    let [x, y, z] = v;
    let widest = x.unsigned_abs() | y.unsigned_abs() | z.unsigned_abs();
    // To 15 bits and a sign, so that the sum of the squares fits: it is at most 3 · 2³⁰.
    let mut v = moved(v, 17_u32.saturating_sub(leading_zeros(widest)));
    let mut q = square(v);
    if q > 1 << 30 {
        v = moved(v, 1);
        q = square(v);
    }
    // At most 2³⁰ now, and 0 only for the vector 0. Two bits more of the square are one bit more of the length.
    let up = leading_zeros(q).saturating_sub(2) >> 1;
    if up > 14 {
        return [0; 3];
    }
    let [x, y, z] = v;
    divide_by_root([x << up, y << up, z << up], q << (2 * up))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use std::println;

    #[test]
    fn inverse_roots_are_within_their_bound_for_all_inputs() {
        let worst = ((1_u32 << 14)..=1 << 16).fold(0.0, |worst: f64, x| {
            let exact = 2f64.powi(23) / f64::from(x).sqrt();
            let off = (f64::from(inverse_sqrt(x)) - exact).abs();
            assert!(off / exact < 2f64.powi(-15), "x = {x}: {} instead of {exact}", inverse_sqrt(x));
            worst.max(off)
        });
        println!("worst error of inverse_sqrt: {worst:.3}");
        assert!(worst < 1.4, "{worst}");
    }

    #[test]
    fn vectors_become_unit_vectors() {
        let mut rng = Rng::new(1);
        let mut next = || rng.signed_bits(16) as i32;
        let (mut worst, mut worst_length) = (0.0_f64, 0.0_f64);
        for round in 0..200_000 {
            let shift = round % 4;
            let v = [next().max(-32_767) >> shift, next().max(-32_767) >> shift, next().max(-32_767) >> shift];
            let length = v.iter().map(|&c| f64::from(c).powi(2)).sum::<f64>().sqrt();
            if length < 2048.0 {
                continue;
            }
            let unit = unit_vector(v);
            for (u, c) in unit.into_iter().zip(v) {
                let off = (f64::from(u) - 16_384.0 * f64::from(c) / length).abs();
                worst = worst.max(off);
                assert!(off < 1.5, "{v:?}: {unit:?}, off by {off}");
            }
            let exact = unit.iter().map(|&c| f64::from(c).powi(2)).sum::<f64>().sqrt();
            worst_length = worst_length.max((exact - 16_384.0).abs());
        }
        println!("worst component off by {worst:.3} / 2^14, worst length by {worst_length:.3} / 2^14");
        // The largest components that are allowed, which the function halves first; and zero.
        assert_eq!(unit_vector([32_767; 3]), [9459; 3]);
        assert_eq!(unit_vector([0; 3]), [0; 3]);
        assert_eq!(unit_vector([0, -1, 0]), [0, -16_384, 0]);
    }

    #[test]
    fn components_of_any_size_give_components_of_16_bits() {
        // The squares of these wrap to small numbers, to 0, and to 1.
        let wrapping = [-131_071, 131_072, 65_535, 65_536, -65_536, 1 << 30, i32::MIN, i32::MAX];
        let ends = [i32::MIN, i32::MIN + 1, -131_072, -32_769, -32_768, -1, 0, 1, 32_767, 32_768, 131_071, i32::MAX];
        let mut rng = Rng::new(2);
        let random = core::iter::repeat_with(|| [(); 3].map(|()| rng.any_magnitude(31))).take(100_000);
        let some = ends.into_iter().flat_map(|x| ends.into_iter().flat_map(move |y| ends.map(|z| [x, y, z])));
        for v in wrapping.map(|c| [c, 0, 0]).into_iter().chain(some).chain(random) {
            let unit = unit_vector(v);
            assert!(unit.iter().all(|c| c.unsigned_abs() <= 1 << 15), "{v:?}: {unit:?}");
            // Out of line it is right for all.
            let unit = unit_vector_of_any_length(v);
            let length = v.iter().map(|&c| f64::from(c).powi(2)).sum::<f64>().sqrt();
            for (u, c) in unit.into_iter().zip(v) {
                let exact = if length == 0.0 { 0.0 } else { 16_384.0 * f64::from(c) / length };
                assert!((f64::from(u) - exact).abs() < 4.0, "{v:?}: {unit:?} instead of {exact}");
            }
        }
    }
}
