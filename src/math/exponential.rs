//! The exponential function of negative numbers, for fog.

/// Factors for the bits 20 to 1 of a 16.16 exponent: entry `k` is 2³¹ e^(-2^(4 - k)), rounded.
static FACTORS: [u32; 20] = [
    242,
    720_401,
    39_332_535,
    290_630_308,
    790_015_084,
    1_302_514_674,
    1_672_461_947,
    1_895_147_668,
    2_017_374_191,
    2_081_412_522,
    2_114_190_000,
    2_130_771_798,
    2_139_111_403,
    2_143_293_437,
    2_145_387_520,
    2_146_435_328,
    2_146_959_424,
    2_147_221_520,
    2_147_352_580,
    2_147_418_113,
];

/// Returns e^-`x`.
///
/// # Format
/// `x` is 16.16; negative ones count as 0. The result is 0.16, with 65,536 for 1, and off by less than 0.6. From x =
/// 32 on it is 0. It takes up to 20 products, so it is meant for filling tables.
///
/// # Source
/// e^-(a + b) = e^-a e^-b, multiplied over the bits of `x`.
pub const fn exp_negative(x: i32) -> u32 {
    if x <= 0 {
        return 1 << 16;
    }
    if x >= 32 << 16 {
        return 0;
    }
    // The product is in 1.31.
    let mut product = 1_u64 << 31;
    let mut k = 0;
    while k < FACTORS.len() {
        if x as u32 & (1 << (20 - k)) != 0 {
            product = (product * FACTORS[k] as u64 + (1 << 30)) >> 31;
        }
        k += 1;
    }
    // The lowest bit: e^-2⁻¹⁶ is 1 - 2⁻¹⁶, within 2⁻³³.
    if x & 1 != 0 {
        product -= product >> 16;
    }
    ((product + (1 << 14)) >> 15) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_the_rounded_exponentials() {
        for (k, factor) in FACTORS.iter().enumerate() {
            let exact = (2f64.powi(31) * (-(2f64.powi(4 - k as i32))).exp()).round();
            assert_eq!(f64::from(*factor), exact, "entry {k}");
        }
    }

    #[test]
    fn exponentials_are_within_0_6_of_65_536ths() {
        let mut worst = 0.0_f64;
        for x in (0..33 << 16).step_by(3) {
            let exact = 65_536.0 * (-f64::from(x) / 65_536.0).exp();
            worst = worst.max((f64::from(exp_negative(x)) - exact).abs());
        }
        std::println!("worst error of exp_negative: {worst:.4} / 65,536");
        assert!(worst < 0.6, "{worst}");
        assert_eq!(exp_negative(i32::MIN), 1 << 16);
        assert_eq!(exp_negative(i32::MAX), 0);
    }
}
