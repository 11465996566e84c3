//! Exact division, where the core may have no divider, or numbers are longer than it takes.

use super::reciprocal::SMALL_CORE;
use core::num::NonZeroU32;

/// `num / den`, rounded down, and the remainder.
#[inline]
pub(crate) fn divided(num: u32, den: NonZeroU32) -> (u32, u32) {
    if SMALL_CORE { divided_bit_by_bit(num, den) } else { (num / den, num % den) }
}

/// As many rounds as the quotient has bits: what lines and strips divide gives few, and a small program need not link the
/// compiler's longer routine.
#[inline(never)]
fn divided_bit_by_bit(num: u32, den: NonZeroU32) -> (u32, u32) {
    let (mut rest, mut quotient) = (num, 0);
    let (mut den, mut bit) = (den.get(), 1_u32);
    while den <= rest >> 1 {
        den <<= 1;
        bit <<= 1;
    }
    while bit != 0 {
        if rest >= den {
            rest -= den;
            quotient |= bit;
        }
        den >>= 1;
        bit >>= 1;
    }
    (quotient, rest)
}

/// `num / den` and the remainder, for quotients below 2³².
#[inline]
pub(crate) fn divide(num: u64, den: NonZeroU32) -> (u32, u32) {
    match u32::try_from(num) {
        Ok(num) => divided(num, den),
        Err(_) => long_divide((num >> 32) as u32, num as u32, den),
    }
}

/// The same bit by bit, `high` being below `den`: rare, and no 64-bit division to link.
#[cold]
#[inline(never)]
fn long_divide(high: u32, low: u32, den: NonZeroU32) -> (u32, u32) {
    let (mut rest, mut low) = (high, low);
    for _ in 0..32 {
        // The bit that leaves `rest` at the top makes it larger than any divisor.
        let carry = rest >> 31;
        rest = rest << 1 | low >> 31;
        low <<= 1;
        if carry != 0 || rest >= den.get() {
            rest = rest.wrapping_sub(den.get());
            low |= 1;
        }
    }
    (low, rest)
}

/// ⌊n 2³² / den⌋ modulo 2⁶⁴ for n = `high` 2³² + `low`, 0 < den < 2⁵¹.
///
/// Long division, bit by bit: it is rare, and wider divisions are code that small programs need not link.
#[inline(never)]
pub(crate) fn divide_modulo(high: i64, low: u32, den: u64) -> i64 {
    // ⌊-n / d⌋ = !⌊(n - 1) / d⌋, and !n = -n - 1 in all bits, those still to come included.
    let flip = (high >> 63) as u32;
    let mut rest = 0_u64;
    let mut quotient = 0_u64;
    for word in [(high >> 32) as u32, high as u32, low, 0] {
        let mut word = word ^ flip;
        if rest == 0 && u64::from(word) < den {
            // Nothing but zeros.
            rest = word.into();
            quotient <<= 32;
            continue;
        }
        if let Some(den) = u32::try_from(den).ok().and_then(NonZeroU32::new) {
            // Most have few bits; the rest is below it.
            let (digit, remainder) = long_divide(rest as u32, word, den);
            rest = remainder.into();
            quotient = quotient << 32 | u64::from(digit);
            continue;
        }
        for _ in 0..32 {
            rest = rest << 1 | u64::from(word >> 31);
            word <<= 1;
            quotient <<= 1;
            if rest >= den {
                rest -= den;
                quotient |= 1;
            }
        }
    }
    quotient as i64 ^ high >> 63
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bit_by_bit_is_division() {
        let mut state = 3_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state ^ state >> 15
        };
        let ends = [0, 1, 2, 3, 0x7FFF_FFFF, 0x8000_0000, 0x8000_0001, u32::MAX - 1, u32::MAX];
        let all = ends.into_iter().flat_map(|num| ends.map(|den| (num, den)));
        let random = core::iter::repeat_with(|| (next() >> (next() & 31), next() >> (next() & 31))).take(100_000);
        for (num, den) in all.chain(random) {
            let Some(den) = NonZeroU32::new(den) else { continue };
            assert_eq!(divided_bit_by_bit(num, den), (num / den, num % den), "{num} / {den}");
        }
    }

    #[test]
    fn long_division_is_exact_modulo_2_to_64() {
        let mut state = 5_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state ^ state >> 29
        };
        for case in 0..20_000 {
            let (high, low) = (next() as i64 >> (next() % 64), next() as u32);
            let den = (next() >> (13 + next() % 50)).max(1);
            let exact = i128::from(high) << 32 | i128::from(low);
            let expected = (exact << 32).div_euclid(i128::from(den)) as i64;
            assert_eq!(divide_modulo(high, low, den), expected, "case {case}: {exact} << 32 / {den}");
        }
    }

    #[test]
    fn long_division_is_division() {
        let mut state = 9_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state ^ state >> 31
        };
        for _ in 0..20_000 {
            let den = NonZeroU32::new((next() >> (32 + next() % 31)) as u32 | 1).expect("odd");
            let num = (u64::from(den.get()) * (next() >> (32 + next() % 32))) + next() % u64::from(den.get());
            let expected = ((num / u64::from(den.get())) as u32, (num % u64::from(den.get())) as u32);
            assert_eq!(long_divide((num >> 32) as u32, num as u32, den), expected, "{num} / {den}");
        }
    }
}
