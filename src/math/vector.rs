//! Three-dimensional vectors in 16.16.

use super::format::Scalar;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A point or direction of three [`Scalar`]s. Its arithmetic saturates, so nothing here can panic or wrap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Vec3 {
    /// Right.
    pub x: Scalar,
    /// Up.
    pub y: Scalar,
    /// Towards the viewer.
    pub z: Scalar,
}

/// Saturates `value`, a 16.16 in 64 bits, to 32.
pub(super) const fn saturate(value: i64) -> Scalar {
    if value > i32::MAX as i64 {
        Scalar::MAX
    } else if value < i32::MIN as i64 {
        Scalar::MIN
    } else {
        Scalar::from_bits(value as i32)
    }
}

impl Vec3 {
    /// The origin.
    pub const ZERO: Self = Self::new(Scalar::ZERO, Scalar::ZERO, Scalar::ZERO);
    /// Unit vector to the right.
    pub const X: Self = Self::new(Scalar::ONE, Scalar::ZERO, Scalar::ZERO);
    /// Unit vector up.
    pub const Y: Self = Self::new(Scalar::ZERO, Scalar::ONE, Scalar::ZERO);
    /// Unit vector towards the viewer.
    pub const Z: Self = Self::new(Scalar::ZERO, Scalar::ZERO, Scalar::ONE);

    /// Makes a vector of its components.
    #[must_use]
    pub const fn new(x: Scalar, y: Scalar, z: Scalar) -> Self {
        Self { x, y, z }
    }

    /// Makes a vector of whole numbers.
    #[must_use]
    pub const fn from_ints(x: i16, y: i16, z: i16) -> Self {
        Self::from_bits([(x as i32) << 16, (y as i32) << 16, (z as i32) << 16])
    }

    /// Makes a vector of thousandths, rounded down to 2⁻¹⁶: a readable way to write constants.
    #[must_use]
    pub const fn from_milli(x: i32, y: i32, z: i32) -> Self {
        Self::new(
            saturate(((x as i64) << 16).div_euclid(1000)),
            saturate(((y as i64) << 16).div_euclid(1000)),
            saturate(((z as i64) << 16).div_euclid(1000)),
        )
    }

    /// Makes a vector of raw 16.16 bits.
    #[must_use]
    pub const fn from_bits(bits: [i32; 3]) -> Self {
        Self::new(Scalar::from_bits(bits[0]), Scalar::from_bits(bits[1]), Scalar::from_bits(bits[2]))
    }

    /// Returns raw 16.16 bits.
    #[must_use]
    pub const fn to_bits(self) -> [i32; 3] {
        [self.x.to_bits(), self.y.to_bits(), self.z.to_bits()]
    }

    /// Returns the dot product, rounded down to 2⁻¹⁶.
    #[must_use]
    pub const fn dot(self, other: Self) -> Scalar {
        let (a, b) = (self.to_bits(), other.to_bits());
        // Each product is quartered before the sum of three can leave 64 bits.
        let sum = ((a[0] as i64 * b[0] as i64) >> 2)
            + ((a[1] as i64 * b[1] as i64) >> 2)
            + ((a[2] as i64 * b[2] as i64) >> 2);
        saturate(sum >> 14)
    }

    /// Returns the cross product, right-handed, rounded down to 2⁻¹⁶.
    #[must_use]
    pub const fn cross(self, other: Self) -> Self {
        let (a, b) = (self.to_bits(), other.to_bits());
        Self::new(minor(a[1], b[2], a[2], b[1]), minor(a[2], b[0], a[0], b[2]), minor(a[0], b[1], a[1], b[0]))
    }

    /// Returns the length, rounded down to 2⁻¹⁶; saturates.
    #[must_use]
    pub const fn length(self) -> Scalar {
        let root = self.length_bits();
        if root > i32::MAX as u64 { Scalar::MAX } else { Scalar::from_bits(root as i32) }
    }

    /// Returns the vector of length 1 in the direction of this one, each component within 2⁻¹⁵; `None` for the zero
    /// vector.
    #[must_use]
    pub const fn normalized(self) -> Option<Self> {
        let bits = self.to_bits();
        // Short vectors are scaled up first, so that the length keeps 30 significant bits.
        let widest = bits[0].unsigned_abs() | bits[1].unsigned_abs() | bits[2].unsigned_abs();
        if widest == 0 {
            return None;
        }
        let shift = widest.leading_zeros();
        let a = [(bits[0] as i64) << shift, (bits[1] as i64) << shift, (bits[2] as i64) << shift];
        // |a| ≤ 2³², so the squares are those of a / 4.
        Self::of_length_1([a[0] >> 2, a[1] >> 2, a[2] >> 2])
    }

    /// Returns the vector of length 1 at right angles to two others, right-handed, each component within 2⁻¹⁵; `None`
    /// if they are exactly parallel, or one of them is zero.
    ///
    /// # Format
    /// Products are at most 2⁶², and not rounded; their differences are at most 2⁶³ - 2³¹. So it does not matter how
    /// short the vectors are, nor how close to each other.
    #[must_use]
    pub(super) const fn across(self, other: Self) -> Option<Self> {
        let (a, b) = (self.to_bits(), other.to_bits());
        let n = [
            exact_minor(a[1], b[2], a[2], b[1]),
            exact_minor(a[2], b[0], a[0], b[2]),
            exact_minor(a[0], b[1], a[1], b[0]),
        ];
        let widest = n[0].unsigned_abs() | n[1].unsigned_abs() | n[2].unsigned_abs();
        if widest == 0 {
            return None;
        }
        // The widest component takes 30 bits.
        let zeros = widest.leading_zeros();
        let (left, right) = (zeros.saturating_sub(34), 34_u32.saturating_sub(zeros));
        Self::of_length_1([n[0] << left >> right, n[1] << left >> right, n[2] << left >> right])
    }

    /// Returns the vector of length 1 in the direction of components of at most 31 bits, one of which has 30.
    const fn of_length_1(b: [i64; 3]) -> Option<Self> {
        let length = ((b[0] * b[0] + b[1] * b[1] + b[2] * b[2]) as u64).isqrt() as i64;
        if length == 0 {
            return None;
        }
        Some(Self::new(
            saturate((b[0] << 16) / length),
            saturate((b[1] << 16) / length),
            saturate((b[2] << 16) / length),
        ))
    }

    const fn length_bits(self) -> u64 {
        let a = self.to_bits();
        ((a[0] as i64 * a[0] as i64) as u64 + (a[1] as i64 * a[1] as i64) as u64 + (a[2] as i64 * a[2] as i64) as u64)
            .isqrt()
    }
}

/// Returns `a b - c d` of 16.16 numbers. The products are halved, so that the difference fits 64 bits.
const fn minor(a: i32, b: i32, c: i32, d: i32) -> Scalar {
    saturate((((a as i64 * b as i64) >> 1) - ((c as i64 * d as i64) >> 1)) >> 15)
}

/// Returns `a b - c d` exactly.
const fn exact_minor(a: i32, b: i32, c: i32, d: i32) -> i64 {
    a as i64 * b as i64 - c as i64 * d as i64
}

impl Add for Vec3 {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.x.saturating_add(other.x), self.y.saturating_add(other.y), self.z.saturating_add(other.z))
    }
}

impl Sub for Vec3 {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.x.saturating_sub(other.x), self.y.saturating_sub(other.y), self.z.saturating_sub(other.z))
    }
}

impl Neg for Vec3 {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(self.x.saturating_neg(), self.y.saturating_neg(), self.z.saturating_neg())
    }
}

impl Mul<Scalar> for Vec3 {
    type Output = Self;
    fn mul(self, factor: Scalar) -> Self {
        Self::new(self.x.saturating_mul(factor), self.y.saturating_mul(factor), self.z.saturating_mul(factor))
    }
}

impl AddAssign for Vec3 {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Vec3 {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign<Scalar> for Vec3 {
    fn mul_assign(&mut self, factor: Scalar) {
        *self = *self * factor;
    }
}

impl Div<Scalar> for Vec3 {
    type Output = Self;
    /// Divides each component, rounded towards 0. Division by 0 gives the largest or the smallest number, and 0 for
    /// 0.
    fn div(self, divisor: Scalar) -> Self {
        let quotient = |component: Scalar| match (i64::from(component.to_bits()) << 16)
            .checked_div(i64::from(divisor.to_bits()))
        {
            Some(quotient) => saturate(quotient),
            None => saturate(i64::from(component.to_bits()) << 32),
        };
        Self::new(quotient(self.x), quotient(self.y), quotient(self.z))
    }
}

impl DivAssign<Scalar> for Vec3 {
    fn div_assign(&mut self, divisor: Scalar) {
        *self = *self / divisor;
    }
}
