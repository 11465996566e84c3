//! Integers of 320 bits, for the determinants of 4×4 matrices of 64-bit entries.

use core::cmp::Ordering;

/// A signed integer of 320 bits in two's complement, the lowest word first.
#[derive(Clone, Copy)]
pub(super) struct Long([u64; 5]);

impl Long {
    pub(super) const ZERO: Self = Self([0; 5]);

    const fn is_negative(self) -> bool {
        self.0[4] >> 63 != 0
    }

    pub(super) const fn is_zero(self) -> bool {
        let [a, b, c, d, e] = self.0;
        a | b | c | d | e == 0
    }

    /// Returns the sum, modulo 2³²⁰.
    pub(super) const fn plus(self, other: Self) -> Self {
        let mut sum = [0; 5];
        let mut carry = 0;
        let mut k = 0;
        while k < 5 {
            let word = self.0[k] as u128 + other.0[k] as u128 + carry;
            sum[k] = word as u64;
            carry = word >> 64;
            k += 1;
        }
        Self(sum)
    }

    pub(super) const fn negated(self) -> Self {
        let [a, b, c, d, e] = self.0;
        Self([!a, !b, !c, !d, !e]).plus(Self([1, 0, 0, 0, 0]))
    }

    const fn magnitude(self) -> Self {
        if self.is_negative() { self.negated() } else { self }
    }

    /// Returns the product, modulo 2³²⁰.
    pub(super) const fn times(self, factor: i64) -> Self {
        let (mut product, magnitude) = ([0; 5], self.magnitude());
        let mut carry = 0;
        let mut k = 0;
        while k < 5 {
            let word = magnitude.0[k] as u128 * factor.unsigned_abs() as u128 + carry;
            product[k] = word as u64;
            carry = word >> 64;
            k += 1;
        }
        if self.is_negative() != (factor < 0) { Self(product).negated() } else { Self(product) }
    }

    pub(super) const fn of(value: i128) -> Self {
        let sign = (value >> 127) as u64;
        Self([value as u64, (value >> 64) as u64, sign, sign, sign])
    }

    /// Returns 2 · `self`, modulo 2³²⁰.
    const fn doubled(self) -> Self {
        self.plus(self)
    }

    /// Compares two numbers, neither of them negative.
    const fn cmp(self, other: Self) -> Ordering {
        let mut k = 5;
        while k > 0 {
            k -= 1;
            if self.0[k] != other.0[k] {
                return if self.0[k] < other.0[k] { Ordering::Less } else { Ordering::Greater };
            }
        }
        Ordering::Equal
    }

    /// Returns `numerator` · 2⁶⁴ / `denominator`, rounded to nearest, halves away from 0. Returns `None` if the
    /// result does not fit 64 bits, or the denominator is zero.
    ///
    /// # Format
    /// Both magnitudes are below 2³¹⁷.
    pub(super) const fn ratio(numerator: Self, denominator: Self) -> Option<i64> {
        let negative = numerator.is_negative() != denominator.is_negative();
        let (mut rest, divisor) = (numerator.magnitude(), denominator.magnitude());
        // Beyond this the quotient would have more than 63 bits.
        if !matches!(rest.doubled().cmp(divisor), Ordering::Less) {
            return None;
        }
        let mut quotient = 0_u64;
        let mut bit = 0;
        while bit < 64 {
            rest = rest.doubled();
            quotient <<= 1;
            if !matches!(rest.cmp(divisor), Ordering::Less) {
                rest = rest.plus(divisor.negated());
                quotient |= 1;
            }
            bit += 1;
        }
        if !matches!(rest.doubled().cmp(divisor), Ordering::Less) {
            quotient += 1;
        }
        if quotient > i64::MAX as u64 {
            return None;
        }
        Some(if negative { -(quotient as i64) } else { quotient as i64 })
    }
}
