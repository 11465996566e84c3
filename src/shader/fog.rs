//! Fog: colours fade with distance into one colour.
//!
//! Fog is computed from a fragment's depth, and not from a varying of its own. So it wraps any shader, adds nothing to
//! records and set-up, and is right at each pixel of a large triangle. Depth is a hyperbola of distance: a small table
//! converts it to the amount of fog. The table has finer steps beyond 15/16 of the depth range, and again beyond
//! 255/256, because depth is coarse there.

use crate::color::{PixelFormat, channels};
use crate::math::{ProjectionError, Scalar, exp_negative};
use crate::span::{Fragment, Shader, TriangleSetup};
use crate::vertex::{VertexShader, Wrapper};
use core::fmt;
use embedded_graphics_core::pixelcolor::Rgb888;

/// Law by which fog thickens with the distance in front of the camera's plane. Behind that plane, where an orthographic
/// camera may see something, fog is as at the plane itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FogCurve {
    /// No fog up to `start`, nothing but fog from `end` on, evenly in between.
    Linear {
        /// Distance at which fog begins.
        start: Scalar,
        /// Distance from which on nothing else is seen; not below `start`.
        end: Scalar,
    },
    /// Even fog, which leaves e^-(density · distance) of a colour.
    Exponential {
        /// Density per unit of distance, 0 or more.
        density: Scalar,
    },
    /// Fog that is clearer close by and denser far away, which leaves e^-(density · distance)² of a colour.
    ExponentialSquared {
        /// Density per unit of distance, 0 or more.
        density: Scalar,
    },
}

/// An error in the numbers that a table of fog is computed from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FogError {
    /// The planes are not those of a camera.
    Planes(ProjectionError),
    /// The density is negative: fog would make colours brighter than they are.
    Density {
        /// The density.
        density: Scalar,
    },
    /// Fog ends before it starts.
    Ends {
        /// Distance at which fog begins.
        start: Scalar,
        /// Distance at which nothing else is seen.
        end: Scalar,
    },
}

#[cfg(feature = "defmt")]
impl defmt::Format for FogError {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}", defmt::Debug2Format(self));
    }
}

impl fmt::Display for FogError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Planes(error) => write!(f, "fog: {error}"),
            Self::Density { density } => write!(f, "fog of the density {density}, must be 0 or more"),
            Self::Ends { start, end } => write!(f, "fog ends at {end}, before it starts at {start}"),
        }
    }
}

impl core::error::Error for FogError {}

/// Number of entries: one for each of the last 256 steps of depth, 256 of 16 steps each, 256 of 256 steps each, and the
/// end.
///
/// An entry stands at the near end of its steps: counted from the far plane, `k`, 16 `k` and 256 `k`. The first 16
/// entries of the second and of the third kind are not used, except for the very first of the third kind, which ends
/// the second.
const ENTRIES: usize = 769;

/// Part of a colour that fog leaves at each depth. Make the table a constant, or make it once per camera.
///
/// ```
/// use zstrip::shader::{FogCurve, FogTable};
/// use zstrip::math::Scalar;
/// static MIST: FogTable = match FogTable::perspective(
///     Scalar::ONE,
///     Scalar::from_bits(100 << 16),
///     FogCurve::Linear { start: Scalar::from_bits(20 << 16), end: Scalar::from_bits(90 << 16) },
/// ) {
///     Ok(table) => table,
///     Err(_) => panic!("near and far"),
/// };
/// assert_eq!(MIST.transmittance(0), 255);
/// assert_eq!(MIST.transmittance(65_535), 0);
/// ```
///
/// # Format
/// 255 = the whole colour. Within 1.5 of the exact part at any depth, as tested for fog that thickens over a quarter of
/// the distance or more, and up to far = 4,000 near.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FogTable {
    entries: [u8; ENTRIES],
}

impl FogCurve {
    /// Returns the mistake in the curve's numbers.
    const fn mistake(&self) -> Option<FogError> {
        match *self {
            Self::Linear { start, end } if start.to_bits() > end.to_bits() => Some(FogError::Ends { start, end }),
            Self::Exponential { density } | Self::ExponentialSquared { density } if density.to_bits() < 0 => {
                Some(FogError::Density { density })
            }
            _ => None,
        }
    }

    /// Computes the part of a colour that fog leaves at a distance in 16.16, 255 = all.
    const fn transmittance(&self, distance: i64) -> u8 {
        let distance = if distance < 0 { 0 } else { distance };
        match *self {
            Self::Linear { start, end } => {
                let (start, end) = (start.to_bits() as i64, end.to_bits() as i64);
                if distance <= start {
                    255
                } else if distance >= end {
                    0
                } else {
                    // start < end here.
                    (((end - distance) * 510 + (end - start)) / (2 * (end - start))) as u8
                }
            }
            Self::Exponential { density } => fading(density, distance, false),
            Self::ExponentialSquared { density } => fading(density, distance, true),
        }
    }
}

/// Computes 255 e^-x, or 255 e^-x², for x = density · distance, neither of them negative.
const fn fading(density: Scalar, distance: i64, squared: bool) -> u8 {
    // From x = 32 on, the result rounds to 0.
    let limit = 32 << 16;
    let product = (density.to_bits() as i64 * distance) >> 16;
    let x = if product > limit { limit } else { product };
    let exponent = if squared { (x * x) >> 16 } else { x };
    let exponent = if exponent > limit { limit } else { exponent };
    ((exp_negative(exponent as i32) * 255 + (1 << 15)) >> 16) as u8
}

impl FogTable {
    /// Computes the table of a [perspective camera](crate::math::Projective::perspective) with these planes.
    ///
    /// # Errors
    /// When `near ≤ 0` or `near ≥ far`; when the curve's density is negative, or its end before its start.
    pub const fn perspective(near: Scalar, far: Scalar, curve: FogCurve) -> Result<Self, FogError> {
        if near.to_bits() <= 0 {
            return Err(FogError::Planes(ProjectionError::NearNotPositive { near }));
        }
        Self::new(near, far, curve, true)
    }

    /// Computes the table of an [orthographic camera](crate::math::Projective::orthographic) with these planes.
    ///
    /// # Errors
    /// When `near ≥ far`; when the curve's density is negative, or its end before its start.
    pub const fn orthographic(near: Scalar, far: Scalar, curve: FogCurve) -> Result<Self, FogError> {
        Self::new(near, far, curve, false)
    }

    const fn new(near: Scalar, far: Scalar, curve: FogCurve, perspective: bool) -> Result<Self, FogError> {
        let (n, f) = (near.to_bits() as i64, far.to_bits() as i64);
        if n >= f {
            return Err(FogError::Planes(ProjectionError::NearNotBeforeFar { near, far }));
        }
        if let Some(mistake) = curve.mistake() {
            return Err(mistake);
        }
        let mut entries = [0; ENTRIES];
        let mut k = 0;
        while k < ENTRIES {
            // Steps in front of the far plane; the near plane is 65,535 steps in front of it.
            let steps = match k {
                0..256 => k,
                256..512 => (k - 256) << 4,
                512 => 4096,
                _ => (k - 512) << 8,
            };
            let steps = if steps > 65_535 { 65_535 } else { steps as i64 };
            let distance = if perspective { hyperbola(n, f, steps) } else { f - steps * (f - n) / 65_535 };
            entries[k] = curve.transmittance(distance);
            k += 1;
        }
        Ok(Self { entries })
    }

    /// Returns the part of a colour that fog leaves at a depth, 255 = all.
    #[must_use]
    #[inline]
    pub fn transmittance(&self, depth: u16) -> u8 {
        let steps = !depth;
        let (entry, fraction) = match steps {
            4096.. => (512 + (steps >> 8), steps & 0xFF),
            256.. => (256 + (steps >> 4), (steps & 0xF) << 4),
            _ => (steps, 0),
        };
        // At most 512 + 255 + 1.
        let at = |entry: usize| i32::from(self.entries.get(entry).copied().unwrap_or(0));
        let (here, next) = (at(usize::from(entry)), at(usize::from(entry) + 1));
        (here + (((next - here) * i32::from(fraction) + 128) >> 8)) as u8
    }
}

/// Computes the distance at a depth of a perspective camera: n f / (n + (f - n) steps / 65,535). All 16.16; 0 < n < f.
const fn hyperbola(n: i64, f: i64, steps: i64) -> i64 {
    // Below 2⁶²; as many bits more as fit, up to 16.
    let product = n * f;
    let zeros = product.leading_zeros() - 1;
    let more = if zeros > 16 { 16 } else { zeros };
    let divisor = (n << more) + ((steps * (f - n)) << more) / 65_535;
    match (product << more).checked_div(divisor) {
        Some(distance) => distance,
        None => f,
    }
}

/// A shader in fog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fogged<'t, S> {
    shader: S,
    table: &'t FogTable,
    color: [u8; 3],
}

impl<'t, S> Fogged<'t, S> {
    /// Wraps a shader, whose colours fade into `color`: usually the background's, and black for draws that are
    /// [added](crate::shader::Add).
    #[must_use]
    pub fn new(shader: S, table: &'t FogTable, color: impl Into<Rgb888>) -> Self {
        Self { shader, table, color: channels(color.into()) }
    }
}

impl<S: VertexShader> Wrapper for Fogged<'_, S> {
    type Inner = S;

    #[inline(always)]
    fn inner(&self) -> &S {
        &self.shader
    }
}

impl<P: PixelFormat, S: Shader<P>> Shader<P> for Fogged<'_, S> {
    const STEP: usize = S::STEP;
    type Setup = S::Setup;

    #[inline(always)]
    fn setup(&self, triangle: &TriangleSetup<'_, S::Varyings>) -> S::Setup {
        self.shader.setup(triangle)
    }

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
        let left = u32::from(self.table.transmittance(fragment.depth));
        Some(P::mix(self.shader.fragment(fragment)?, P::pack(self.color), left + (left >> 7)))
    }
}
