//! Reciprocals and divisions on cores without a divider: a table of seeds, up to two Newton steps, and a proven bound
//! of the error for each function. The file also has wide products and leading zeros for cores that lack the
//! instructions.

/// True for cores that multiply 32 × 32 bits to the lower 32 only: Armv6-M, recognized by its lack of
/// compare-and-swap. On these, a wide product is put together by hand, since `__aeabi_lmul` takes three times as
/// long.
pub(crate) const SMALL_CORE: bool = cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));

/// Returns the high word of a 32 × 32 bit product, rounded down.
#[inline(always)]
pub const fn mul_high(a: u32, b: u32) -> u32 {
    if SMALL_CORE { mul_high_by_halves(a, b) } else { ((a as u64 * b as u64) >> 32) as u32 }
}

/// Returns the high word of a signed by unsigned 32 × 32 bit product, rounded down.
#[inline(always)]
pub const fn mul_high_signed(a: i32, b: u32) -> i32 {
    if SMALL_CORE { mul_high_signed_by_halves(a, b) } else { ((a as i64 * b as i64) >> 32) as i32 }
}

/// Multiplies two numbers to 64 bits, in a third of the time that the compiler's own routine takes on small cores.
#[inline]
pub(crate) const fn mul_wide(a: i32, b: i32) -> i64 {
    if SMALL_CORE { product_by_halves(a, b) } else { a as i64 * b as i64 }
}

#[inline(never)]
const fn product_by_halves(a: i32, b: i32) -> i64 {
    // The routine takes a negative `b` for b + 2³².
    let high = mul_high_signed_by_halves(a, b as u32).wrapping_sub(a & b >> 31);
    (high as i64) << 32 | a.wrapping_mul(b) as u32 as i64
}

/// Multiplies numbers of 64 and 32 bits, by two products of 32 bits: one of 128 bits takes several times as long on
/// cores of 32 bits.
#[inline]
pub(crate) const fn mul_long(a: i64, b: i32) -> i128 {
    let (high, low) = ((a >> 32) as i32, a as u32);
    // A lower half that is taken for a negative number is 2³² too small.
    let taken = mul_wide(low as i32, b);
    let low = taken as i128 + (((low as i32 >> 31 & b) as i128) << 32);
    ((mul_wide(high, b) as i128) << 32) + low
}

/// Returns [`mul_high_signed`], out of line: for places where size counts and speed does not.
#[inline(never)]
pub fn mul_high_outlined(a: i32, b: u32) -> i32 {
    mul_high_signed(a, b)
}

/// Returns [`mul_high`] by means of [`mul_high_signed_by_halves`]. That takes `a` for a - 2³² when its top bit is
/// set, so b is added then.
///
/// The compiler would recognize four unsigned products in a row, and replace them by a call to `__aeabi_lmul`.
#[inline(always)]
const fn mul_high_by_halves(a: u32, b: u32) -> u32 {
    (mul_high_signed_by_halves(a as i32, b) as u32).wrapping_add(b & (a as i32 >> 31) as u32)
}

/// Returns [`mul_high_signed`], from four products of 16 bits. The upper half of `a` keeps its sign.
#[inline(always)]
const fn mul_high_signed_by_halves(a: i32, b: u32) -> i32 {
    let (a1, a0, b1, b0) = (a >> 16, a as u32 & 0xFFFF, b >> 16, b & 0xFFFF);
    let middle = a1 * b0 as i32 + ((a0 * b0) >> 16) as i32;
    let other = a0 * b1 + (middle as u32 & 0xFFFF);
    a1 * b1 as i32 + (middle >> 16) + (other >> 16) as i32
}

/// Number of leading zeros of each byte.
static BYTE_ZEROS: [u8; 256] = {
    let mut table = [0; 256];
    let mut i = 0;
    while i < 256 {
        table[i] = (i as u8).leading_zeros() as u8;
        i += 1;
    }
    table
};

/// Counts the leading zeros of a byte by a table, for cores that have no instruction for it.
#[inline(always)]
pub(crate) const fn byte_zeros(x: u8) -> u32 {
    BYTE_ZEROS[x as usize] as u32
}

/// Counts leading zeros. Where cores have no instruction for it, this takes two comparisons and a table: a third of
/// the time of the compiler's own routine.
#[inline(always)]
pub(crate) const fn leading_zeros(x: u32) -> u32 {
    if !SMALL_CORE {
        return x.leading_zeros();
    }
    leading_zeros_by_table(x)
}

/// Counts the leading zeros of 64 bits, out of line: for places where size counts and speed does not.
#[inline(never)]
pub(crate) const fn leading_zeros_long(x: u64) -> u32 {
    if !SMALL_CORE {
        return x.leading_zeros();
    }
    let (word, zeros) = if x >> 32 == 0 { (x as u32, 32) } else { ((x >> 32) as u32, 0) };
    zeros + leading_zeros_by_table(word)
}

#[inline(always)]
const fn leading_zeros_by_table(x: u32) -> u32 {
    let (x, zeros) = if x >> 16 != 0 { (x >> 16, 0) } else { (x, 16) };
    let (x, zeros) = if x >> 8 != 0 { (x >> 8, zeros) } else { (x, zeros + 8) };
    zeros + byte_zeros(x as u8)
}

/// Seeds of [`reciprocal`]: entry `i` is 2³¹ / m rounded, where m is the middle of the i-th of 256 equal parts of
/// 2¹⁵..2¹⁶.
static SEED: [u16; 256] = seed();

const fn seed() -> [u16; 256] {
    let mut table = [0; 256];
    let mut i = 0;
    while i < 256 {
        // 2³¹ / (2¹⁵ + (i + 1/2) 2⁷), at most 65,408.
        let middle = (1 << 16) + ((2 * i as u64 + 1) << 7);
        table[i] = ((1_u64 << 33) / middle).div_ceil(2) as u16;
        i += 1;
    }
    table
}

/// Returns 2⁶³ / `x` for a normalized `x`.
///
/// # Format
/// `x` in 2³¹..2³² (top bit set); the result is in 2³¹..2³², saturated at `u32::MAX`. The relative error is below
/// 2⁻²⁹:
/// - The seed is within 2⁻⁹ (half a table step) + 2⁻¹⁶ (its rounding) of the reciprocal.
/// - The first Newton step squares that to below 2⁻¹⁷·⁹. The 16-bit view of `x` adds 2⁻¹⁶, and cut bits add 2⁻²².
/// - The second step squares this sum, which is below 2⁻¹⁵·⁶, to 2⁻³¹·². Cut bits of the correction add at most 2⁻¹⁵
///   · 2⁻¹⁵·⁶ + 2⁻³¹.
///
/// # Source
/// Newton's iteration r' = r (2 - x r).
#[inline(never)]
pub const fn reciprocal(x: u32) -> u32 {
    // Only an error of the caller could leave the top bit clear. It would cost precision, nothing else.
    let x = x | 1 << 31;
    let r0 = SEED[(x >> 23) as usize & 0xFF] as u32;
    // First step, in 16 bits: x16 = x / 2¹⁶ rounded, in 2¹⁵..=2¹⁶. x16 r0 is near 2³¹, and its defect is below 2²²·¹.
    let x16 = (x >> 16) + ((x >> 15) & 1);
    let defect = (1_i32 << 31).wrapping_sub((x16 * r0) as i32);
    let r1 = (r0 << 16).wrapping_add((((r0 as i32) * (defect >> 8)) >> 7) as u32);
    let r1 = saturated(r1);
    // Second step: the defect, which is the distance of x r1 / 2³² from 2³¹, is below 2¹⁵·⁵. The top of r1 has 15
    // bits.
    let defect = (1_i32 << 31).wrapping_sub(mul_high(x, r1) as i32);
    let correction = ((r1 >> 17) as i32 * defect) >> 14;
    saturated(r1.wrapping_add(correction as u32))
}

/// Saturates a number near 2³¹..2³² at 2³² - 1. Only the reciprocal of 2³¹ can pass 2³², by its error.
#[inline(always)]
const fn saturated(r: u32) -> u32 {
    r | (((r >> 30) as i32 - 1) >> 31) as u32
}

/// A divisor, kept as a reciprocal of 16 bits and the defect of that reciprocal.
///
/// It is cheaper than [`reciprocal`] on cores that have no product of 32 × 32 bits.
#[derive(Clone, Copy, Debug)]
pub struct Divisor {
    /// Shift that brings the divisor to 2³¹..2³².
    shift: u32,
    /// 2⁴⁷ / x within 2⁻¹⁴·⁹, where x is the shifted divisor: in 2¹⁵..=2¹⁶.
    reciprocal: i32,
    /// Defect of the reciprocal, 2³¹ - x `reciprocal` / 2¹⁶: below 2¹⁶·¹.
    defect: i32,
}

impl Divisor {
    /// Makes a divisor of a number that is not 0; for 0, quotients are some numbers.
    #[inline(always)]
    pub fn new(q: u32) -> Self {
        let shift = leading_zeros(q) & 31;
        Self { shift, ..Self::of_normalized(q << shift) }
    }

    /// Makes a divisor of a number whose top bit is set. For any other number, quotients are some numbers.
    #[inline(always)]
    pub fn of_normalized(x: u32) -> Self {
        let r0 = SEED[(x >> 23) as usize & 0xFF] as i32;
        // As the first step of `reciprocal`, rounded to 16 bits.
        let x16 = (x >> 16) + ((x >> 15) & 1);
        let defect = (1_i32 << 31).wrapping_sub((x16 as i32).wrapping_mul(r0));
        let r = r0 + (r0.wrapping_mul(defect >> 8).wrapping_add(1 << 22) >> 23);
        let product = if SMALL_CORE {
            (x >> 16).wrapping_mul(r as u32).wrapping_add((x & 0xFFFF).wrapping_mul(r as u32) >> 16)
        } else {
            ((u64::from(x) * u64::from(r as u32)) >> 16) as u32
        };
        Self { shift: 0, reciprocal: r, defect: (1_i32 << 31).wrapping_sub(product as i32) }
    }

    /// Returns `n` / x in 1.31, for an `x` with its top bit set.
    ///
    /// # Format
    /// |n| ≤ x / 2. The error is in -5..=3 units: less than 1 for each of two cuts, 1.1 for the rounding of the
    /// correction's factor, 1/2 for the rounding of the defect, and twice 2⁻²⁹·⁸, which is the error after the second
    /// of two Newton steps.
    #[inline(always)]
    pub const fn divide_normalized(&self, n: i32) -> i32 {
        if SMALL_CORE { self.divide_by_halves(n) } else { self.divide_by_words(n) }
    }

    #[inline(always)]
    const fn divide_by_halves(&self, n: i32) -> i32 {
        let low = (n as u32 & 0xFFFF).wrapping_mul(self.reciprocal as u32) >> 16;
        let h = (n >> 16).wrapping_mul(self.reciprocal).wrapping_add(low as i32);
        h.wrapping_add((h.wrapping_add(1 << 15) >> 16).wrapping_mul(self.defect) >> 15)
    }

    /// Divides as [`divide_by_halves`](Self::divide_by_halves) does, bit for bit, by two instructions that multiply
    /// 32 by 16 bits. The reciprocal less 2¹⁶ fits 16 bits and a sign.
    #[inline(always)]
    const fn divide_by_words(&self, n: i32) -> i32 {
        let h = n.wrapping_add(((n as i64 * (self.reciprocal as i16) as i64) >> 16) as i32);
        let top = (h.wrapping_add(1 << 15) >> 16) as i16;
        h.wrapping_add((((self.defect << 1) as i64 * top as i64) >> 16) as i32)
    }

    /// Returns `n` / x in 1.31, for an `x` with its top bit set and `n` ≤ x. It is exact for an `x` of one bit.
    ///
    /// # Format
    /// The error is in -7..=3 units: less than 1 for each of two cuts, 2.2 for the rounding of the correction's
    /// factor, 1 for the rounding of the defect, and 2⁻²⁹·⁸, which is the error after the second of two Newton steps.
    #[inline(always)]
    pub const fn fraction_normalized(&self, n: u32) -> u32 {
        let r = self.reciprocal as u32;
        let h = if SMALL_CORE {
            (n >> 16).wrapping_mul(r).wrapping_add((n & 0xFFFF).wrapping_mul(r) >> 16)
        } else {
            ((n as u64 * r as u64) >> 16) as u32
        };
        h.wrapping_add_signed(((h.wrapping_add(1 << 16) >> 17) as i32).wrapping_mul(self.defect) >> 14)
    }

    /// Returns `n` / q in 1.31.
    ///
    /// # Format
    /// |n| ≤ q / 2. The error is less than 6 units: twice 2⁻²⁹·⁸, which is the error after the second of two Newton
    /// steps, and the bits that are cut.
    #[inline(always)]
    pub fn divide(&self, n: i32) -> i32 {
        self.divide_shifted(n << self.shift)
    }

    /// Returns `n` / q in 1.31 as [`divide`](Self::divide) does, for an `n` that is already shifted by the divisor's
    /// own shift.
    #[inline(always)]
    pub fn divide_shifted(&self, n: i32) -> i32 {
        let low = (n as u32 & 0xFFFF).wrapping_mul(self.reciprocal as u32) >> 16;
        let h = (n >> 16).wrapping_mul(self.reciprocal).wrapping_add(low as i32);
        h.wrapping_add((h >> 16).wrapping_mul(self.defect) >> 15)
    }
}

/// A divisor below 2¹⁶: shorter than a [`Divisor`].
#[derive(Clone, Copy, Debug)]
pub struct ShortDivisor {
    shift: u32,
    /// 2⁴⁷ / x, in 2¹⁵..=2¹⁶, where x is the divisor shifted to 2³¹..2³²; and the defect of this reciprocal, 2³¹ - x
    /// `reciprocal` / 2¹⁶, below 2¹⁵·¹.
    reciprocal: i32,
    defect: i32,
}

impl ShortDivisor {
    /// Makes a divisor of a number that is not 0; for 0, quotients are some numbers.
    ///
    /// # Format
    /// The table is within 2⁻⁹ where the reciprocal is near 2¹⁶, within 2⁻¹⁰ where it is near 2¹⁵. One Newton step
    /// squares that to 1/4 or 1/32 of a unit, and rounds by 1/2. The defect is this sum times x16, below 2¹⁵·¹.
    #[inline(always)]
    pub const fn new(q: u32) -> Self {
        let shift = leading_zeros(q) & 31;
        Self::of_shifted(q << shift, shift)
    }

    #[inline(always)]
    const fn of_shifted(x: u32, shift: u32) -> Self {
        let x16 = (x >> 16) as i32;
        let r = SEED[(x16 >> 7) as usize & 0xFF] as i32;
        let defect = (1_i32 << 31).wrapping_sub(x16.wrapping_mul(r));
        let r = r + (r.wrapping_mul(defect >> 8).wrapping_add(1 << 22) >> 23);
        Self { shift, reciprocal: r, defect: (1_i32 << 31).wrapping_sub(x16.wrapping_mul(r)) }
    }

    /// Makes a divisor as [`new`](Self::new) does, of a number below 2¹³.
    #[inline(always)]
    pub fn of_13_bits(q: u32) -> Self {
        // Usually 5 bits more than a byte holds: one comparison finds the leading zeros.
        let shift = if !SMALL_CORE {
            q.leading_zeros() & 31
        } else if q >> 5 != 0 {
            19 + byte_zeros((q >> 5) as u8)
        } else {
            24 + byte_zeros(q as u8)
        };
        Self::of_shifted(q << (shift & 31), shift)
    }

    /// Returns the number of bits that the divisor is shifted by to reach 2³¹..2³².
    #[inline(always)]
    pub const fn shift(&self) -> u32 {
        self.shift
    }

    /// Returns `n` / q · 2^(47 - shift): the quotient with 47 - shift fractional bits.
    ///
    /// # Format
    /// |n| ≤ 2¹⁴: the result is below 2³⁰ and a little. Before it is rounded down, it is off by less than 0.55 for
    /// rounding and by 2⁻³¹·⁸ of its value.
    #[inline(always)]
    pub const fn divide(&self, n: i32) -> i32 {
        let h = n.wrapping_mul(self.reciprocal);
        h.wrapping_add((h.wrapping_add(1 << 15) >> 16).wrapping_mul(self.defect) >> 15)
    }
}

/// A divisor whose reciprocal comes straight from the table: shorter and less exact than a [`Divisor`].
#[derive(Clone, Copy, Debug)]
pub struct CoarseDivisor {
    /// 2⁴⁷ / x within 2⁻⁹, in 16 bits.
    reciprocal: i32,
    /// Defect of the reciprocal, 2²⁵ - x `reciprocal` / 2²²: below 2¹⁶·¹.
    defect: i32,
}

impl CoarseDivisor {
    /// Makes a divisor of a number whose top bit is set, for a small core or another one: bit by bit alike.
    #[inline(always)]
    pub fn of_normalized<const SMALL: bool>(x: u32) -> Self {
        let r = SEED[(x >> 23) as usize & 0xFF] as u32;
        let defect = if SMALL {
            let product = (x >> 16).wrapping_mul(r).wrapping_add((x & 0xFFFF).wrapping_mul(r) >> 16);
            // The subtraction from 2³¹ is a negation without that bit: the difference fits 31 bits.
            (product.wrapping_neg() << 1) as i32 >> 7
        } else {
            (1_i32 << 31).wrapping_sub(mul_high(x, r << 16) as i32) >> 6
        };
        Self { reciprocal: r as i32, defect }
    }

    /// Returns `n` / x in 1.31.
    ///
    /// # Format
    /// |n| < x / 4. The error is less than 2⁻¹⁸ of the quotient, which is the square of the table's error, and 192
    /// units for the bits that are cut.
    #[inline(always)]
    pub fn divide_normalized<const SMALL: bool>(&self, n: i32) -> i32 {
        if SMALL {
            let low = (n as u32 & 0xFFFF).wrapping_mul(self.reciprocal as u32) >> 16;
            let h = (n >> 16).wrapping_mul(self.reciprocal).wrapping_add(low as i32);
            h.wrapping_add((h >> 16).wrapping_mul(self.defect) >> 9)
        } else {
            // Bit for bit as above, by two instructions that multiply 32 by 16 bits: the reciprocal less 2¹⁶ fits 16
            // bits and a sign.
            let times = |a: i32, b: i16| ((i64::from(a) * i64::from(b)) >> 16) as i32;
            let h = n.wrapping_add(times(n, self.reciprocal as i16));
            h.wrapping_add(times(self.defect << 7, (h >> 16) as i16))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    #[test]
    fn both_cores_divide_alike() {
        let mut rng = Rng::new(1);
        let mut next = || rng.next_u32();
        for case in 0..300_000 {
            let x = if case % 3 == 0 { 1 << 31 | next() >> (8 + next() % 24) } else { 1 << 31 | next() };
            let divisor = Divisor::of_normalized(x);
            let half = (x / 2) as i32;
            for n in [next() as i32 % half, (next() >> (next() % 32)) as i32 % half, half, -half, 0, -1] {
                assert_eq!(divisor.divide_by_halves(n), divisor.divide_by_words(n), "{n} / {x}");
            }
        }
    }

    #[test]
    fn long_products_are_products() {
        let mut rng = Rng::new(8);
        let ends = [i64::MIN, i64::MIN + 1, -1 << 32, -1 << 31, -1, 0, 1, 1 << 31, 1 << 32, i64::MAX];
        let random: std::vec::Vec<_> = (0..2000).map(|_| (rng.next_u64() as i64) >> rng.below(64)).collect();
        for a in ends.into_iter().chain(random) {
            let short = rng.next_u32() as i32 >> rng.below(32);
            for b in [i32::MIN, -1, 0, 1, i32::MAX, short] {
                assert_eq!(mul_long(a, b), i128::from(a) * i128::from(b), "{a} {b}");
            }
        }
    }

    #[test]
    fn products_by_halves_are_products() {
        let ends = [i32::MIN, i32::MIN + 1, -0x1_0000, -0xFFFF, -1, 0, 1, 0xFFFF, 0x1_0000, 0x7FFF_0000, i32::MAX];
        let mut rng = Rng::new(1);
        let mut next = || rng.next_u32() as i32;
        let random: std::vec::Vec<_> = (0..2000).map(|_| next() >> (next() & 31)).collect();
        for (a, b) in ends.iter().chain(&random).flat_map(|a| ends.iter().chain(&random).map(move |b| (*a, *b))) {
            assert_eq!(product_by_halves(a, b), i64::from(a) * i64::from(b), "{a} {b}");
        }
    }

    #[test]
    fn divisors_are_within_their_bounds() {
        let mut rng = Rng::new(1);
        let mut random = || rng.next_u32();
        let (mut worst, mut worst_coarse) = (0_f64, 0_f64);
        let boundaries = (0..1 << 17).map(|k| (1 << 31) + (k << 14)).chain((0..1 << 16).map(|k| u32::MAX - (k << 15)));
        for x in boundaries.flat_map(|x: u32| [x, x.wrapping_sub(1) | 1 << 31, x >> 7, x >> 20]) {
            for n in [x / 2, random() % (x / 2 + 1)] {
                for n in [n as i32, -(n as i32)] {
                    let exact = f64::from(n) / f64::from(x) * 2f64.powi(31);
                    worst = worst.max((f64::from(Divisor::new(x).divide(n)) - exact).abs());
                    if x >> 31 != 0 {
                        let off = f64::from(Divisor::of_normalized(x).divide_normalized(n)) - exact;
                        assert!(off > -5.0 && off < 3.0, "{n} / {x}: {off} units");
                        let exact = f64::from(n.unsigned_abs()) / f64::from(x) * 2f64.powi(32);
                        let divisor = Divisor::of_normalized(x);
                        let off = f64::from(divisor.fraction_normalized(2 * n.unsigned_abs())) - exact;
                        assert!(off > -7.0 && off < 3.0, "2 {n} / {x}: {off} units");
                        let n = n.unsigned_abs();
                        assert_eq!(Divisor::of_normalized(1 << 31).fraction_normalized(n), n);
                        let n = n as i32 / 2 * if off < 0.0 { -1 } else { 1 };
                        let coarse = CoarseDivisor::of_normalized::<false>(x).divide_normalized::<false>(n);
                        let small = CoarseDivisor::of_normalized::<true>(x).divide_normalized::<true>(n);
                        assert_eq!(coarse, small, "{n} / {x}");
                        let exact = f64::from(n) / f64::from(x) * 2f64.powi(31);
                        worst_coarse = worst_coarse.max((f64::from(coarse) - exact).abs() - exact.abs() / 262_144.0);
                    }
                }
            }
        }
        std::println!("worst {worst:.2} units; coarse: {worst_coarse:.2} beside 2^-18");
        assert!(worst < 6.0, "worst {worst} units");
        assert!(worst_coarse < 192.0, "worst {worst_coarse} units beside 2^-18 of the quotient");
    }

    #[test]
    fn short_divisors_are_within_their_bound() {
        let mut worst = (0_f64, 0_f64);
        for q in 1..1 << 16 {
            let divisor = ShortDivisor::new(q);
            assert!(divisor.defect.abs() < 35_100, "{q}: {}", divisor.defect);
            for n in [1, 255, 256, 5000, 16_383, 16_384, (q % 16_384) as i32].into_iter().flat_map(|n| [n, -n]) {
                let exact = f64::from(n) / f64::from(q) * 2f64.powi(47 - divisor.shift() as i32);
                let off = f64::from(divisor.divide(n)) - exact;
                let part = exact.abs() * 2f64.powf(-31.8);
                worst = (worst.0.min(off + part), worst.1.max(off - part));
            }
        }
        assert!(worst.0 > -1.55 && worst.1 < 0.55, "{worst:?}");
    }

    #[test]
    fn divisors_take_all_numbers() {
        let ends = [0, 1, 2, 5, 255, 0x7FFF, 0x8000, 0xFFFF, 1 << 16, 1 << 30, 0x7FFF_FFFF, 1 << 31, u32::MAX];
        let mut rng = Rng::new(4);
        let random = core::iter::repeat_with(|| rng.next_u32() >> rng.below(32)).take(2000);
        for q in ends.into_iter().chain(random) {
            let (any, normalized, short) = (Divisor::new(q), Divisor::of_normalized(q), ShortDivisor::new(q));
            let coarse = CoarseDivisor::of_normalized::<false>(q);
            for n in ends {
                let signed = n as i32;
                let _ = (any.divide(signed), any.divide_shifted(signed), normalized.fraction_normalized(n));
                let _ = (short.divide(signed), coarse.divide_normalized::<false>(signed), reciprocal(n));
                for divisor in [any, normalized] {
                    let _ = (divisor.divide_by_halves(signed), divisor.divide_by_words(signed));
                }
            }
        }
    }

    /// Returns the worst relative error over `inputs`, against exact division.
    fn worst(inputs: impl Iterator<Item = u32>) -> f64 {
        inputs
            .map(|x| {
                let exact = 2f64.powi(63) / f64::from(x);
                ((f64::from(reciprocal(x)) - exact) / exact).abs()
            })
            .fold(0.0, f64::max)
    }

    #[test]
    fn relative_error_is_below_2_to_minus_29() {
        // Every 4,093rd input, and the ends of each seed interval with all 16-bit rounding boundaries around them.
        let strided = (0..(1_u32 << 31) / 4093).map(|i| (1 << 31) + i * 4093);
        let ends = (0..256_u32).flat_map(|i| {
            let start = (1_u32 << 31) + (i << 23);
            (0..256).flat_map(move |k| [start.wrapping_add(k * 32_768), start.wrapping_add((1 << 23) - 1 - k * 32_768)])
        });
        let found = worst(strided.chain(ends).filter(|x| *x >= 1 << 31));
        assert!(found < 2f64.powi(-29), "worst relative error 2^{}", found.log2());
    }

    #[test]
    fn leading_zeros_are_those_of_the_standard_library() {
        for x in (0..32).flat_map(|k| [1 << k, (1 << k) - 1, (1 << k) | 1, u32::MAX >> k]).chain(0..1 << 17) {
            assert_eq!(leading_zeros_by_table(x), x.leading_zeros(), "{x}");
        }
    }

    #[test]
    fn products_by_halves_are_the_same() {
        let corners = [0, 1, 0x7FFF, 0x8000, 0xFFFF, 0x1_0000, 0x7FFF_FFFF, 0x8000_0000, 0x8000_FFFF, u32::MAX];
        let mut rng = Rng::new(1);
        let random = core::iter::repeat_with(|| rng.next_u32());
        for a in corners.into_iter().chain(random.take(1000)) {
            for b in corners.into_iter().chain([a.rotate_left(7), !a]) {
                assert_eq!(u64::from(mul_high_by_halves(a, b)), (u64::from(a) * u64::from(b)) >> 32, "{a} {b}");
                let signed = i64::from(a as i32) * i64::from(b);
                assert_eq!(i64::from(mul_high_signed_by_halves(a as i32, b)), signed >> 32, "{a} {b}");
            }
        }
    }

    #[test]
    fn ends_of_the_range() {
        assert_eq!(reciprocal(1 << 31), u32::MAX);
        assert!(reciprocal(u32::MAX) - (1 << 31) <= 4);
    }
}
