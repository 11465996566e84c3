//! Plane equations: how depth and varyings change from pixel to pixel.
//!
//! A quantity that is v0, v1, v2 at the vertices is a plane over the screen. By Cramer's rule
//!
//! ```text
//! dv/dx = ((v1 - v0) (y2 - y0) - (v2 - v0) (y1 - y0)) / area        area = (x1 - x0) (y2 - y0) - (x2 - x0) (y1 - y0)
//! dv/dy = ((v2 - v0) (x1 - x0) - (v1 - v0) (x2 - x0)) / area
//! ```
//!
//! All values are kept modulo 2³². Inside the triangle the true value fits, and sums and integer multiples of the
//! gradients are exact modulo 2³², so it does not matter that a gradient, or the plane outside of the triangle, does not.
//! What is off is only the rounding of the gradients, 2⁻¹⁷ a pixel in 16.16: below 2⁻⁴ over the largest viewport.

use crate::geometry::{ScreenVertex, signed_area};
use crate::math::{mul_high_signed, reciprocal};

/// What all plane equations of a triangle share.
#[derive(Clone, Copy, Debug)]
pub struct Gradients {
    x: [i32; 3],
    y: [i32; 3],
    /// Twice the signed area; never 0.
    area: i64,
    /// 2⁶³ / (|area| << shift), and shift, which puts the top bit of |area| into bit 31; for areas below 2³¹.
    reciprocal: u32,
    shift: i32,
    /// The pixel that plane values refer to: the one that holds vertex 0, for large triangles brought onto the screen.
    origin: (i32, i32),
}

/// A plane: values at pixel centres, modulo 2³².
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlaneEquation {
    /// Change from one pixel to the next on the right.
    pub dx: i32,
    /// Change from one row to the next.
    pub dy: i32,
    /// Value at the centre of the pixel at the origin of its [`Gradients`].
    pub base: u32,
}

impl Gradients {
    /// Of a triangle, for a screen of `width` × `height` px; `None` if it has no area.
    pub fn new(v: &[ScreenVertex; 3], (width, height): (u16, u16)) -> Option<Self> {
        let area = signed_area(&v[0], &v[1], &v[2]);
        let magnitude = area.unsigned_abs();
        if magnitude == 0 {
            return None;
        }
        let origin = (v[0].x >> 8, v[0].y >> 8);
        let (reciprocal, shift, origin) = match u32::try_from(magnitude) {
            Ok(m) if small_triangle(v) => {
                let shift = m.leading_zeros();
                (reciprocal(m << shift), shift as i32, origin)
            }
            _ => (
                0,
                0,
                (
                    origin.0.clamp(0, i32::from(width) - 1),
                    origin.1.clamp(0, i32::from(height) - 1),
                ),
            ),
        };
        Some(Self {
            x: v.map(|v| v.x),
            y: v.map(|v| v.y),
            area,
            reciprocal,
            shift,
            origin,
        })
    }

    /// The pixel that [`PlaneEquation::base`] refers to.
    #[inline]
    pub const fn origin(&self) -> (i32, i32) {
        self.origin
    }

    /// The plane through values at the three vertices, in 16.16 (or any unit of which 2⁻⁶ · 2¹⁶ does not matter).
    ///
    /// # Format
    /// Values as 32-bit patterns; differences are taken as signed 33-bit numbers, times 2²⁵ below 2⁵⁸, in sums below
    /// 2⁵⁹. Evaluated anywhere on the screen inside the triangle, the result is within 2⁻⁴ · 2¹⁶ of the exact plane.
    pub fn plane(&self, values: [i64; 3]) -> PlaneEquation {
        let (v1, v2) = (values[1] - values[0], values[2] - values[0]);
        if v1 == 0 && v2 == 0 {
            return PlaneEquation {
                dx: 0,
                dy: 0,
                base: values[0] as u32,
            };
        }
        let (x1, x2) = (i64::from(self.x[1] - self.x[0]), i64::from(self.x[2] - self.x[0]));
        let (y1, y2) = (i64::from(self.y[1] - self.y[0]), i64::from(self.y[2] - self.y[0]));
        let (a, b) = (v1 * y2 - v2 * y1, v2 * x1 - v1 * x2);
        if self.reciprocal != 0 {
            if let (Some(dx), Some(dy)) = (self.gentle(a), self.gentle(b)) {
                // From vertex 0 to the centre of its pixel, at most half a pixel: 2²⁹⁻⁶ · 2⁷ twice.
                let along = |g: i32, from: i32, to: i32| (g >> 6) * (256 * to + 128 - from);
                let offset = along(dx, self.x[0], self.origin.0) + along(dy, self.y[0], self.origin.1);
                return PlaneEquation {
                    dx,
                    dy,
                    base: (values[0] as u32).wrapping_add((offset >> 2) as u32),
                };
            }
        }
        self.exact(values[0], a, b)
    }

    /// 256 n / area, if it is below 2²⁹ (2¹³ in 16.16), which loses little enough to the reciprocal: relative error below
    /// 2⁻²⁸, less than 2⁻⁷ over the 128 px of a small triangle, and one unit.
    ///
    /// 256 / area = 2^shift reciprocal / 2⁵⁵; n is normalized to n 2^up in 2³⁰..2³¹, or cut to that (by less than
    /// 2⁻³⁰).
    #[inline]
    fn gentle(&self, n: i64) -> Option<i32> {
        let n = if self.area < 0 { -n } else { n };
        // Redundant sign bits above bit 31: how far n can move up (or must move down) to fill an i32.
        let up = (n ^ (n >> 63)).leading_zeros() as i32 - 33;
        let normalized = if up >= 0 { n << up } else { n >> -up } as i32;
        let high = mul_high_signed(normalized, self.reciprocal);
        // high 2³² 2^(shift - up) / 2⁵⁵.
        let down = 23 + up - self.shift;
        if down < 2 { None } else { Some(high >> down.min(31)) }
    }

    /// The same by exact division, for triangles that are large or steep.
    #[inline(never)]
    fn exact(&self, value: i64, a: i64, b: i64) -> PlaneEquation {
        let flip = |n: i128| if self.area < 0 { -n } else { n };
        let area = self.area.unsigned_abs();
        let to_x = 256 * self.origin.0 + 128 - self.x[0];
        let to_y = 256 * self.origin.1 + 128 - self.y[0];
        let offset = i128::from(a) * i128::from(to_x) + i128::from(b) * i128::from(to_y);
        PlaneEquation {
            dx: divide_modulo(flip(i128::from(a) << 8), area) as i32,
            dy: divide_modulo(flip(i128::from(b) << 8), area) as i32,
            base: (value as u32).wrapping_add(divide_modulo(flip(offset), area)),
        }
    }
}

/// Whether all differences of coordinates are below 2¹⁵, so that areas fit 31 bits.
fn small_triangle(v: &[ScreenVertex; 3]) -> bool {
    use crate::geometry::small;
    small(v[1].x - v[0].x) & small(v[1].y - v[0].y) & small(v[2].x - v[0].x) & small(v[2].y - v[0].y)
}

/// ⌊num / den + 1/2⌋ modulo 2³²; |num| < 2⁹⁰, 0 < den < 2⁵¹.
///
/// Long division, bit by bit: no 128-bit division routine to link, and rare.
fn divide_modulo(num: i128, den: u64) -> u32 {
    let num = num + i128::from(den >> 1);
    let magnitude = if num < 0 { !num } else { num } as u128;
    let mut rest = 0_u64;
    let mut quotient = 0_u32;
    let mut bit = 128 - magnitude.leading_zeros();
    while bit > 0 {
        bit -= 1;
        rest = rest << 1 | ((magnitude >> bit) as u64 & 1);
        quotient <<= 1;
        if rest >= den {
            rest -= den;
            quotient |= 1;
        }
    }
    // ⌊-n / d⌋ = !⌊(n - 1) / d⌋.
    if num < 0 { !quotient } else { quotient }
}

impl PlaneEquation {
    /// Value at the centre of pixel (x, y), modulo 2³².
    #[inline]
    pub const fn at(&self, origin: (i32, i32), x: i32, y: i32) -> u32 {
        self.base
            .wrapping_add((self.dx.wrapping_mul(x - origin.0)) as u32)
            .wrapping_add((self.dy.wrapping_mul(y - origin.1)) as u32)
    }
}
