//! Binary angles and the integer sine.

use super::format::Scalar;
use core::fmt;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// An angle in binary units: 65,536 make one turn, and arithmetic wraps as angles do.
///
/// It is named by its 16 bits, since embedded-graphics' prelude has an `Angle` of its own, an `f32`. So both preludes
/// may be imported side by side.
///
/// ```
/// use zstrip::math::{Angle16, Scalar};
/// assert_eq!(Angle16::from_degrees(90), Angle16(0x4000));
/// assert_eq!(Angle16::from_degrees(90).sin(), Scalar::ONE);
/// assert_eq!(Angle16(0xC000) + Angle16(0x8000), Angle16(0x4000));
/// assert_eq!(Angle16(0x4000).to_string(), "90°");
/// ```
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Angle16(pub u16);

/// Taylor coefficients of sin(πx/2), from π/2 on, without their alternating signs, in 2.30.
///
/// The first term left out is (π/2)¹³/13! < 2⁻²⁴, at x = 1.
const SINE: [i64; 6] = [1_686_629_713, 693_598_668, 85_569_306, 5_026_995, 172_272, 3_864];

impl Angle16 {
    /// No rotation.
    pub const ZERO: Self = Self(0);

    /// Returns the angle of a whole number of degrees, over any number of turns, rounded to the nearest unit.
    #[must_use]
    pub const fn from_degrees(degrees: i32) -> Self {
        let reduced = degrees.rem_euclid(360) as u32;
        Self(((reduced * 65_536 + 180) / 360) as u16)
    }

    /// Returns the angle of degrees with a fraction, over any number of turns, rounded to the nearest unit, halves
    /// up.
    ///
    /// ```
    /// use zstrip::math::{Angle16, Scalar};
    /// assert_eq!(Angle16::from_degrees_fixed(Scalar::from_num(22.5)), Angle16(0x1000));
    /// ```
    #[must_use]
    pub const fn from_degrees_fixed(degrees: Scalar) -> Self {
        // In 2⁻¹⁶ degrees, 360 make a unit.
        let reduced = degrees.to_bits().rem_euclid(360 << 16) as u32;
        Self(((reduced + 180) / 360) as u16)
    }

    /// Returns the degrees, exactly: 0 or more, below 360.
    #[must_use]
    pub const fn to_degrees(self) -> Scalar {
        Scalar::from_bits(self.0 as i32 * 360)
    }

    /// Returns the sine, exact at quarter turns.
    ///
    /// # Format
    /// 16.16. The error is at most 2⁻¹⁶, half of which is rounding.
    #[must_use]
    pub const fn sin(self) -> Scalar {
        Scalar::from_bits(((self.sin_q30() + (1 << 13)) >> 14) as i32)
    }

    /// Returns the cosine; see [`sin`](Self::sin) for its error.
    #[must_use]
    pub const fn cos(self) -> Scalar {
        Self(self.0.wrapping_add(0x4000)).sin()
    }

    /// Returns the sine in 2.30, with an error below 2⁻²³.
    pub(crate) const fn sin_q30(self) -> i64 {
        let quarter = self.0 >> 14;
        let offset = (self.0 & 0x3FFF) as i64;
        // x in 0..=1, with 30 fractional bits, is the distance from the zero crossing in quarter turns.
        let x = if quarter & 1 == 0 { offset } else { 0x4000 - offset } << 16;
        let x2 = (x * x) >> 30;
        let mut sum = 0;
        let mut k = SINE.len();
        while k > 0 {
            k -= 1;
            sum = SINE[k] - ((sum * x2) >> 30);
        }
        let mut sine = (sum * x) >> 30;
        if sine > 1 << 30 || x == 1 << 30 {
            sine = 1 << 30;
        }
        if quarter >= 2 { -sine } else { sine }
    }

    /// Returns the cosine in 2.30, with an error below 2⁻²³.
    pub(crate) const fn cos_q30(self) -> i64 {
        Self(self.0.wrapping_add(0x4000)).sin_q30()
    }
}

impl Add for Angle16 {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }
}

impl AddAssign for Angle16 {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Angle16 {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0.wrapping_sub(other.0))
    }
}

impl SubAssign for Angle16 {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Neg for Angle16 {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.wrapping_neg())
    }
}

impl Mul<i32> for Angle16 {
    type Output = Self;
    /// Turns `times` as far; whole turns are lost.
    fn mul(self, times: i32) -> Self {
        Self(self.0.wrapping_mul(times as u16))
    }
}

impl Div<i32> for Angle16 {
    type Output = Self;
    /// Divides the angle, counted from 0 to 360 degrees, and rounds towards 0; a negative divisor turns back. Division
    /// by 0 gives the largest angle, and 0 for 0.
    fn div(self, divisor: i32) -> Self {
        match u32::from(self.0).checked_div(divisor.unsigned_abs()) {
            Some(part) if divisor < 0 => -Self(part as u16),
            Some(part) => Self(part as u16),
            None if self.0 == 0 => Self::ZERO,
            None => Self(u16::MAX),
        }
    }
}

/// Degrees, such as `90°` or `0.0055°`; a precision is that of a [`Scalar`].
impl fmt::Display for Angle16 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.to_degrees(), f)?;
        f.write_str("°")
    }
}

/// Units and degrees: `Angle16(16384 = 90°)`.
impl fmt::Debug for Angle16 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Angle16({} = {self})", self.0)
    }
}
