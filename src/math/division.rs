//! Division with a remainder, where the core may have no divider.

use super::reciprocal::SMALL_CORE;
use core::num::NonZeroU32;

/// `num / den`, rounded down, and the remainder.
#[inline]
pub(crate) fn divided(num: u32, den: NonZeroU32) -> (u32, u32) {
    if SMALL_CORE { divided_bit_by_bit(num, den) } else { (num / den, num % den) }
}

/// As many rounds as the quotient has bits: what edges and strips divide gives few, and a small program need not link the
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
}
