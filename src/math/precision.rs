//! Precision of 16-bit depth: the distance that two things must be apart to differ in depth, and the near plane that
//! makes a given distance enough.

use super::error::ProjectionError;
use super::format::{Scalar, Wide};
use core::fmt;

/// Steps of 16-bit depth.
const STEPS: i128 = 65_535;

/// Precision of 16-bit depth at any distance, for a perspective camera's near and far distance.
///
/// Depth is far (d - near) / ((far - near) d), so half of all steps lie between near and twice near. At distance d a
/// step is about d² (far - near) / (65,535 near far). So the near plane decides; the far plane hardly matters once it
/// is far.
///
/// The classic example is a flight simulator with its near plane at 1 m and its far plane at 50 km:
///
/// | distance | near 1 m | near 10 m | near 100 m | uniform |
/// |---|---|---|---|---|
/// | 100 m | 15 cm | 1.5 cm | - | 76 cm |
/// | 1 km | 15 m | 1.5 m | 15 cm | 76 cm |
/// | 10 km | 1.7 km | 155 m | 15 m | 76 cm |
/// | 50 km, and nearer | 14 km | 1.8 km | 190 m | 76 cm |
///
/// With the near plane at the pilot's nose, a hangar 1 km away and a wall 15 m behind it share one depth, and so do
/// all clouds around 10 km away.
/// - A near plane at 10 m mends the hangar. The cockpit then gets a camera of its own, and is drawn in front of
///   everything.
/// - [`DepthScale::Uniform`](crate::vertex::DepthScale::Uniform) mends the clouds.
/// - The marks on the runway need a [bias](crate::span::DepthBias) in any case.
///
/// ```
/// use zstrip::math::{DepthPrecision, Scalar};
/// // In units of 10 m: near 1 m, far 50 km.
/// let precision = DepthPrecision::new(Scalar::from_num(0.1), Scalar::from_num(5000)).unwrap();
/// let metres = |distance: f32| 10.0 * precision.bin(Scalar::from_num(distance)).to_num::<f32>();
/// assert!((metres(100.0) - 15.3).abs() < 0.2); // at 1 km
/// // To tell 1 m from 1 m at 10 km, near must be beyond 1.5 km.
/// let near = DepthPrecision::near_for(Scalar::from_num(5000), Scalar::from_num(1000), Scalar::from_num(0.1)).unwrap();
/// assert!((10.0 * near.to_num::<f32>() - 1480.0).abs() < 20.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthPrecision {
    near: Scalar,
    far: Scalar,
}

/// An error in a precision that a camera is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PrecisionError {
    /// The distance is not above 0, or is beyond the far plane.
    Distance {
        /// The distance asked for.
        distance: Scalar,
        /// Distance of the far plane.
        far: Scalar,
    },
    /// The size of a bin is not above 0.
    Bin {
        /// The size asked for.
        bin: Scalar,
    },
    /// The near plane would have to be beyond the distance itself.
    TooFine {
        /// Distance of that near plane.
        near: Scalar,
        /// The distance asked for.
        distance: Scalar,
    },
}

#[cfg(feature = "defmt")]
impl defmt::Format for PrecisionError {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}", defmt::Debug2Format(self));
    }
}

impl fmt::Display for PrecisionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Distance { distance, far } => {
                write!(f, "distance {distance} is not between 0 and the far plane at {far}")
            }
            Self::Bin { bin } => write!(f, "a step of depth of {bin}, must be above 0"),
            Self::TooFine { near, distance } => {
                write!(f, "the near plane would have to be at {near}, beyond the distance {distance}")
            }
        }
    }
}

impl core::error::Error for PrecisionError {}

/// Returns `num / den`, rounded to nearest, for two positive numbers; 0 for a `den` of 0.
const fn rounded(num: i128, den: i128) -> i128 {
    match (2 * num + den).checked_div_euclid(2 * den) {
        Some(quotient) => quotient,
        None => 0,
    }
}

impl DepthPrecision {
    /// Takes the distances of a camera's near and far plane.
    ///
    /// # Errors
    /// When `near ≤ 0` or `near ≥ far`, as for the camera itself.
    pub const fn new(near: Scalar, far: Scalar) -> Result<Self, ProjectionError> {
        if near.to_bits() <= 0 {
            return Err(ProjectionError::NearNotPositive { near });
        }
        if near.to_bits() >= far.to_bits() {
            return Err(ProjectionError::NearNotBeforeFar { near, far });
        }
        Ok(Self { near, far })
    }

    const fn planes(&self) -> (i128, i128) {
        (self.near.to_bits() as i128, self.far.to_bits() as i128)
    }

    /// Returns the depth of things at `distance` along the camera's axis, rounded to nearest. It is 0 in front of the
    /// near plane, 65,535 beyond the far plane.
    #[must_use]
    pub const fn depth(&self, distance: Scalar) -> u16 {
        let (n, f) = self.planes();
        let d = distance.to_bits() as i128;
        if d <= n {
            0
        } else if d >= f {
            65_535
        } else {
            rounded(STEPS * f * (d - n), (f - n) * d) as u16
        }
    }

    /// Returns the distance at which depth is `halves` / 2 steps, in 32.32, rounded to nearest, within near and far.
    ///
    /// # Format
    /// 2 · 65,535 n f 2¹⁶ has 95 bits. The divisor is not below 2 · 65,535 n.
    const fn boundary(&self, halves: i128) -> i128 {
        let (n, f) = self.planes();
        let halves = if halves < 0 { 0 } else { halves };
        if halves >= 2 * STEPS {
            return f << 16;
        }
        rounded((2 * STEPS * n * f) << 16, 2 * STEPS * f - halves * (f - n))
    }

    /// Returns the distance at which depth is exactly `depth` steps, rounded to nearest.
    #[must_use]
    pub const fn distance(&self, depth: u16) -> Scalar {
        Scalar::from_bits(((self.boundary(2 * depth as i128) + (1 << 15)) >> 16) as i32)
    }

    /// Returns the size of the range of distances that share one depth with `distance`. Two things this far apart may
    /// share a depth; two things twice as far apart do not.
    #[must_use]
    pub const fn bin(&self, distance: Scalar) -> Wide {
        let depth = self.depth(distance) as i128;
        Wide::from_bits((self.boundary(2 * depth + 1) - self.boundary(2 * depth - 1)) as i64)
    }

    /// Returns the size of a step of depth for [`DepthScale::Uniform`](crate::vertex::DepthScale::Uniform), at any
    /// distance, rounded up.
    #[must_use]
    pub const fn uniform_bin(&self) -> Wide {
        let (n, f) = self.planes();
        Wide::from_bits(((((f - n) << 16) + STEPS - 1) / STEPS) as i64)
    }

    /// Returns the smallest near distance, or a trifle above it, for which the [`bin`](Self::bin) at `distance` is at
    /// most `bin`.
    ///
    /// # Errors
    /// When `distance` is not in 0..=far, `bin` is not above 0, or the near plane would be beyond `distance`.
    pub const fn near_for(far: Scalar, distance: Scalar, bin: Scalar) -> Result<Scalar, PrecisionError> {
        let (f, d, b) = (far.to_bits() as i128, distance.to_bits() as i128, bin.to_bits() as i128);
        if d <= 0 || d > f {
            return Err(PrecisionError::Distance { distance, far });
        }
        if b <= 0 {
            return Err(PrecisionError::Bin { bin });
        }
        // A bin from d- to d+ has the size (f - n) d- d+ / (65,535 n f), with d- ≤ d and d+ ≤ d + b. Near is rounded
        // up.
        let product = d * (d + b);
        let den = b * f * STEPS + product;
        let near = match (f * product + den - 1).checked_div(den) {
            Some(near) => near,
            None => f,
        };
        if near > d {
            // `near` is below far, which is below 2³¹.
            return Err(PrecisionError::TooFine { near: Scalar::from_bits(near as i32), distance });
        }
        Ok(Scalar::from_bits(near as i32))
    }
}
