//! Why a camera could not be built.

use super::angle::Angle16;
use super::format::Scalar;
use core::fmt;

/// Why a camera could not be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ProjectionError {
    /// The near plane is at or behind the eye: its distance, raw 16.16.
    NearNotPositive(i32),
    /// The near plane is not in front of the far plane: both distances, raw 16.16.
    NearNotBeforeFar(i32, i32),
    /// The field of view is not between 0 and 180 degrees.
    FieldOfView(Angle16),
    /// One side of the aspect ratio is zero.
    Aspect(u16, u16),
    /// Two opposite planes of an orthographic box coincide: both, raw 16.16.
    EmptyBox(i32, i32),
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
        let scalar = Scalar::from_bits;
        match *self {
            Self::NearNotPositive(n) => write!(f, "near plane at {}, must be positive", scalar(n)),
            Self::NearNotBeforeFar(n, m) => {
                write!(f, "near plane at {} is not before the far plane at {}", scalar(n), scalar(m))
            }
            Self::FieldOfView(a) => write!(f, "field of view of {}/65536 turns is not within 0..32768", a.0),
            Self::Aspect(w, h) => write!(f, "aspect ratio {w}:{h} has an empty side"),
            Self::EmptyBox(a, b) => {
                write!(f, "orthographic box is empty between {} and {}", scalar(a), scalar(b))
            }
            Self::DegenerateView => f.write_str("eye and target coincide, or up is parallel to the view"),
        }
    }
}

impl core::error::Error for ProjectionError {}
