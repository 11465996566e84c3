//! Errors of cameras and other projections.

use super::angle::Angle16;
use super::format::Scalar;
use core::fmt;

/// An error in the numbers that a camera is built from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ProjectionError {
    /// The near plane is at the eye or behind it.
    NearNotPositive {
        /// Distance of the near plane.
        near: Scalar,
    },
    /// The near plane is not in front of the far plane.
    NearNotBeforeFar {
        /// Distance of the near plane.
        near: Scalar,
        /// Distance of the far plane.
        far: Scalar,
    },
    /// The field of view is not between 0 and 180 degrees.
    FieldOfView {
        /// The opening angle.
        angle: Angle16,
    },
    /// One side of the aspect ratio is zero.
    Aspect {
        /// First number of the ratio.
        width: u32,
        /// Second number of the ratio.
        height: u32,
    },
    /// Two opposite planes of an orthographic box coincide.
    EmptyBox {
        /// Left or bottom plane.
        low: Scalar,
        /// Right or top plane.
        high: Scalar,
    },
    /// A box is too large, or too far from the origin, for a camera that shows all of it.
    BoxOutOfRange {
        /// The largest coordinate or distance that the camera would need, in whole units, rounded down.
        reach: i64,
    },
    /// Eye and target coincide, or up is zero or parallel to the view direction.
    DegenerateView,
}

#[cfg(feature = "defmt")]
impl defmt::Format for ProjectionError {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}", defmt::Debug2Format(self));
    }
}

impl fmt::Display for ProjectionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NearNotPositive { near } => write!(f, "near plane at {near}, must be above 0"),
            Self::NearNotBeforeFar { near, far } => {
                write!(f, "near plane at {near} is not in front of the far plane at {far}")
            }
            Self::FieldOfView { angle } => write!(f, "field of view of {angle} is not between 0° and 180°"),
            Self::Aspect { width, height } => write!(f, "aspect ratio {width}:{height} has an empty side"),
            Self::EmptyBox { low, high } => write!(f, "orthographic box is empty between {low} and {high}"),
            Self::BoxOutOfRange { reach } => {
                write!(f, "the camera that shows the box needs numbers up to {reach}, must be below 32768")
            }
            Self::DegenerateView => f.write_str("eye and target coincide, or up is zero or parallel to the view"),
        }
    }
}

impl core::error::Error for ProjectionError {}
