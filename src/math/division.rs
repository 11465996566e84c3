//! Exact division for cores that have no divider, and for numbers that are longer than a divider takes.

use super::reciprocal::SMALL_CORE;
use core::num::NonZeroU32;

/// Returns `num / den`, rounded down, and the remainder.
#[inline]
pub(crate) fn divided(num: u32, den: NonZeroU32) -> (u32, u32) {
    if SMALL_CORE { divided_bit_by_bit(num, den) } else { (num / den, num % den) }
}

/// Divides in as many rounds as the quotient has bits. The quotients of lines and strips have few bits, and a small
/// program need not link the compiler's longer routine.
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

/// Returns `num / den` and the remainder, for quotients below 2³² and divisors below 2³¹.
#[inline]
pub(crate) fn divide(num: u64, den: NonZeroU32) -> (u32, u32) {
    match u32::try_from(num) {
        Ok(num) => divided(num, den),
        Err(_) => split(long_divide(num, den.get())),
    }
}

/// Divides 64 bits by 32, bit by bit, and returns the remainder above the quotient. The bits of the quotient come in
/// from below as those of `num` leave at the top. It is rarely called, and a small program need not link a 64-bit
/// division.
#[cold]
#[inline(never)]
fn long_divide(mut num: u64, den: u32) -> u64 {
    for _ in 0..32 {
        num <<= 1;
        if let Some(rest) = ((num >> 32) as u32).checked_sub(den) {
            num = u64::from(rest) << 32 | u64::from(num as u32 | 1);
        }
    }
    num
}

/// Returns the lower and the upper word.
#[inline]
fn split(num: u64) -> (u32, u32) {
    (num as u32, (num >> 32) as u32)
}

/// Returns ⌊n 2³² / den⌋ modulo 2⁶⁴ for n = `high` 2³² + `low`, 0 < den < 2⁵¹.
///
/// This is long division, bit by bit. It is rarely called, and small programs need not link the code of wider
/// divisions.
#[inline(never)]
pub(crate) fn divide_modulo(high: i64, low: u32, den: u64) -> i64 {
    // ⌊-n / d⌋ = !⌊(n - 1) / d⌋. !n = -n - 1 holds for all bits, those of the words still to come included.
    let flip = (high >> 63) as u32;
    let mut rest = 0_u64;
    let mut quotient = 0_u64;
    for word in [(high >> 32) as u32, high as u32, low, 0] {
        let mut word = word ^ flip;
        if rest == 0 && u64::from(word) < den {
            // All 32 bits of the quotient are 0: the word becomes the rest.
            rest = word.into();
            word = 0;
        } else if den >> 31 == 0 {
            // Most divisors have few bits, and the rest is below the divisor.
            let remainder;
            (word, remainder) = split(long_divide(rest << 32 | u64::from(word), den as u32));
            rest = remainder.into();
        } else {
            for _ in 0..32 {
                rest = rest << 1 | u64::from(word >> 31);
                word <<= 1;
                if let Some(less) = rest.checked_sub(den) {
                    rest = less;
                    word |= 1;
                }
            }
        }
        quotient = quotient << 32 | u64::from(word);
    }
    quotient as i64 ^ high >> 63
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    #[test]
    fn bit_by_bit_is_division() {
        let mut rng = Rng::new(3);
        let mut next = || rng.next_u32();
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
        let mut rng = Rng::new(5);
        let mut next = || rng.next_u64();
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
        let mut rng = Rng::new(9);
        let mut next = || rng.next_u64();
        for _ in 0..20_000 {
            let den = NonZeroU32::new((next() >> (33 + next() % 30)) as u32 | 1).expect("odd");
            let num = (u64::from(den.get()) * (next() >> (32 + next() % 32))) + next() % u64::from(den.get());
            let expected = ((num / u64::from(den.get())) as u32, (num % u64::from(den.get())) as u32);
            assert_eq!(split(long_divide(num, den.get())), expected, "{num} / {den}");
        }
    }
}
