//! Levels of a mip chain: how many texels a pixel covers, at any pixel of a triangle.
//!
//! With u = h / q, which are both linear on the screen, the change of u from a pixel to its right neighbour is
//!
//! ```text
//! ∂u/∂x = (q ∂h/∂x - h ∂q/∂x) / q²         the numerator is constant along a row, and linear down a column
//! ```
//! and likewise for ∂u/∂y and for v. So three numbers for each coordinate tell the size of a texel at every pixel of
//! the triangle's plane, and a level depends on neither the triangle's corners nor how it was clipped.

use crate::math::leading_zeros;
use crate::span::TriangleSetup;
use crate::texture::Texture;
use crate::vertex::{Perspective, PerspectiveClass, PerspectiveSetup};
use core::fmt::Debug;
use embedded_graphics_core::geometry::Size;

/// Columns of the screen that share a level.
pub(super) const BLOCK: i32 = 16;

/// Choice among the levels of a texture: [`OneLevel`] or [`Mipmapped`]. Nothing else can implement it.
pub trait Levels: Copy + sealed::Choose {}

impl Levels for OneLevel {}
impl Levels for Mipmapped {}

/// One texture for all sizes on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OneLevel;

/// A mip chain, whose levels are chosen at every 16th column of the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mipmapped;

pub(super) mod sealed {
    use super::*;

    /// Chooses a level.
    pub trait Choose {
        /// Set if there may be more than one level.
        const MANY: bool;
        /// Data of a triangle.
        type Scale: Copy + Default + Debug;

        /// Prepares the choice on a triangle.
        fn scale<T: Texture, const N: usize>(
            levels: &[T],
            triangle: &TriangleSetup<'_, Perspective<2, N>>,
        ) -> Self::Scale;

        /// Returns the number of the level at a pixel where q is given.
        fn level(scale: &Self::Scale, position: (i32, i32), q: i32) -> usize;
    }

    impl Choose for OneLevel {
        const MANY: bool = false;
        type Scale = ();

        #[inline(always)]
        fn scale<T: Texture, const N: usize>(_: &[T], _: &TriangleSetup<'_, Perspective<2, N>>) {}

        #[inline(always)]
        fn level((): &(), _: (i32, i32), _: i32) -> usize {
            0
        }
    }

    impl Choose for Mipmapped {
        const MANY: bool = true;
        type Scale = TexelScale;

        #[inline]
        fn scale<T: Texture, const N: usize>(
            levels: &[T],
            triangle: &TriangleSetup<'_, Perspective<2, N>>,
        ) -> TexelScale {
            let Some(Size { width, height }) = levels.first().map(Texture::size) else { return TexelScale::default() };
            if levels.len() < 2 || triangle.area == 0 {
                return TexelScale::default();
            }
            let value = |of: &Perspective<2, N>| {
                let all: &[i32] = of.as_ref();
                let [u, v] = of.corrected();
                [u, v, all.last().copied().unwrap_or(0)]
            };
            let at = triangle.at_origin;
            let planes = [value(at), value(triangle.d_dx), value(triangle.d_dy)];
            let perspective = triangle.perspective;
            let shifts = [0, 1].map(|k| perspective.planes().get(k).map_or(0, |plane| plane.shift));
            let is_flat = perspective.class() == PerspectiveClass::Affine;
            TexelScale::new(&planes, triangle.position, shifts, [width, height], is_flat, levels.len())
        }

        #[inline(always)]
        fn level(scale: &TexelScale, position: (i32, i32), q: i32) -> usize {
            if scale.last == 0 { 0 } else { scale.level(position, q) }
        }
    }
}

/// Size of texels on a triangle, see the module's documentation.
#[derive(Clone, Copy, Debug, Default)]
pub struct TexelScale {
    /// Numerators of ∂/∂x and ∂/∂y at the pixel `from`, which is on the screen, and the change of the former per row;
    /// u first, then v.
    numerators: [[i32; 3]; 2],
    from: (i32, i32),
    dq_dx: i32,
    /// Binary logarithm of the unit of numerators, for q = 1: 24.8.
    unit: i32,
    /// Set if q plays no part.
    is_flat: bool,
    /// Number of the last level.
    last: u8,
}

impl TexelScale {
    /// Computes the scale from the planes of h of u, h of v and q: values at the screen's corner, changes per column
    /// and per row. `from` is the pixel of a vertex, where the planes are true.
    ///
    /// # Format
    /// Values are below 2³¹ and their gradients below 2³⁰: numerators are below 2⁶². They are moved onto the screen in
    /// 62 bits, over less than 2¹⁶ pixels, and kept in 30 bits, over 4,096 pixels.
    #[inline(never)]
    fn new(
        [at, dx, dy]: &[[i32; 3]; 3],
        from: (i32, i32),
        shifts: [u32; 2],
        sizes: [u32; 2],
        is_flat: bool,
        levels: usize,
    ) -> Self {
        let ([u, v, q], [u_x, v_x, q_x], [u_y, v_y, q_y]) = (*at, *dx, *dy);
        let here = |at: i32, x: i32, y: i32| {
            i64::from(at.wrapping_add(x.wrapping_mul(from.0)).wrapping_add(y.wrapping_mul(from.1)))
        };
        let q = here(q, q_x, q_y);
        let (wide_x, wide_y) = (i64::from(q_x), i64::from(q_y));
        let least = shifts[0].min(shifts[1]);
        // A vertex may be far away from the screen.
        let near = (from.0.clamp(0, 2047), from.1.clamp(0, 2047));
        let numerators = |h: i64, x: i32, y: i32| {
            let (x, y) = (i64::from(x), i64::from(y));
            if is_flat {
                return [x << 30, y << 30, 0];
            }
            let change = (x * wide_y).wrapping_sub(y * wide_x);
            [(x * q).wrapping_sub(h * wide_x), (y * q).wrapping_sub(h * wide_y), change]
        };
        let mut numerators = [numerators(here(u, u_x, u_y), u_x, u_y), numerators(here(v, v_x, v_y), v_x, v_y)];
        let mut exponent = if is_flat { -30 } else { 31 } - least as i32 - 16;
        // Shifts all numerators so that each fits that many bits, and the change over 2^`way` pixels.
        let mut fit = |numerators: &mut [[i64; 3]; 2], most: u32, way: u32| {
            let bits = |n: i64| 64 - n.unsigned_abs().leading_zeros();
            let of = |[a, b, c]: [i64; 3]| bits(a).max(bits(b)).max(bits(c) + way);
            let down = of(numerators[0]).max(of(numerators[1])).saturating_sub(most).min(63);
            numerators.iter_mut().flatten().for_each(|n| *n >>= down);
            exponent += down as i32;
        };
        fit(&mut numerators, 61, 16);
        let (right, down) = (i64::from(near.0 - from.0), i64::from(near.1 - from.1));
        for [n_x, n_y, change] in &mut numerators {
            (*n_x, *n_y) = (*n_x + *change * down, *n_y - *change * right);
        }
        fit(&mut numerators, 46, 12);
        for ((numerators, size), shift) in numerators.iter_mut().zip(sizes).zip(shifts) {
            numerators.iter_mut().for_each(|n| *n = n.wrapping_mul(i64::from(size)) >> (shift - least));
        }
        fit(&mut numerators, 30, 12);
        Self {
            numerators: numerators.map(|n| n.map(|n| n as i32)),
            from: near,
            dq_dx: q_x,
            unit: exponent * 256,
            is_flat,
            last: levels.saturating_sub(1).min(255) as u8,
        }
    }

    /// Returns the level at a pixel: that of the middle of its block of columns, where that is not too far from the
    /// triangle. Its texels are nearest in size to the longest way that a texel's side takes to the next pixel.
    #[inline(never)]
    fn level(&self, (x, y): (i32, i32), q: i32) -> usize {
        let to_middle = (x & !(BLOCK - 1)) + BLOCK / 2 - x;
        let (mut x, mut q) = (x, q);
        if self.dq_dx.unsigned_abs() <= q as u32 >> 4 {
            (x, q) = (x + to_middle, q.wrapping_add(self.dq_dx.wrapping_mul(to_middle)));
        }
        let way = |to: i32, from: i32| to.wrapping_sub(from).clamp(-4095, 4095);
        let (right, down) = (way(x, self.from.0), way(y, self.from.1));
        let mut most = 1;
        for [n_x, n_y, change] in self.numerators {
            let n_x = n_x.wrapping_add(change.wrapping_mul(down));
            let n_y = n_y.wrapping_sub(change.wrapping_mul(right));
            most = n_x.unsigned_abs().max(n_y.unsigned_abs()).max(most);
        }
        let q = if self.is_flat { 0 } else { 2 * logarithm(q as u32) };
        ((logarithm(most) + self.unit - q + 128) >> 8).clamp(0, self.last.into()) as usize
    }
}

/// Returns the binary logarithm in 24.8, within 0.015: log₂(1 + m) is m + 0.344 m (1 - m), within 0.01.
#[inline(always)]
fn logarithm(n: u32) -> i32 {
    let zeros = leading_zeros(n | 1) & 31;
    let m = ((n << zeros) >> 23 & 0xFF) as i32;
    ((31 - zeros as i32) << 8) + m + ((m * (256 - m) * 88) >> 16)
}
