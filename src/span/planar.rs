//! Small triangles with perspective-correct varyings, of any shader that says how exact these have to be: textures with
//! a shader around them, above all.
//!
//! The plain loop, over planes of v / w of each varying v, and of 1 / w:
//!
//! ```text
//! for each pixel:
//!     if z >> 16 passes against the stored depth:
//!         color = fragment(vq / q of each varying)
//!         store z >> 16, if a fragment is drawn
//! ```
//! Where perspective moves no varying by more than is allowed, the varyings themselves are planes, as they are for
//! [textures](super::texels). Planes are those of differences to the first corner, with 8 more bits; of differences of
//! more than 16 bits, the lower ones are cut.

use super::brush::{Brush, BrushRows};
use super::carried::{load_varyings, save_varyings, words_of};
use super::depth::DepthTest;
use super::sample::Sample;
use super::shader::Shader;
use super::span::{Fragment, shift};
use crate::color::PixelFormat;
use crate::raster::{ShortPlanes, gradients, least_and_most};
use crate::vertex::{MAX_IN_REGISTERS, Side, Varyings};
use core::marker::PhantomData;

/// Draws small triangles fragment by fragment.
pub(crate) struct PlanarBrush<'s, P, S: Shader<P> + ?Sized>
where
    P: PixelFormat,
{
    pub(crate) shader: &'s S,
    pub(crate) corners: &'s [S::Varyings; 3],
    pub(crate) flat: u32,
    pub(crate) clockwise_fronts: bool,
    pub(crate) format: PhantomData<P>,
}

/// The spans of a [`PlanarBrush`].
pub(crate) struct PlanarRows<'s, P: PixelFormat, S: Shader<P> + ?Sized> {
    shader: &'s S,
    flat: u32,
    side: Side,
    planes: Planes<S::Varyings>,
    /// The first column, and the row; its number below the first row.
    place: (i32, i32),
    row: i32,
    format: PhantomData<P>,
}

/// The planes of varyings.
struct Planes<V> {
    /// Varyings at the first corner.
    base: V,
    /// Differences from them at the first pixel, and their changes.
    at: V,
    dx: V,
    dy: V,
    /// Bits that differences have more than varyings, 0 to 8.
    finer: V,
}

impl<V: Varyings> Planes<V> {
    const ZERO: Self = Self { base: V::ZERO, at: V::ZERO, dx: V::ZERO, dy: V::ZERO, finer: V::ZERO };

    /// Computes the planes through three corners. Returns `false` if perspective moves a varying by more than
    /// `tolerance` units, or if one differs by 2²⁴ or more.
    ///
    /// # Format
    /// As `coordinate` of `texels.rs`: differences that are cut to 16 bits, and 8 bits after the point.
    #[inline(never)]
    fn set(&mut self, short: &ShortPlanes, [a, b, c]: [&V; 3], tolerance: u32) -> bool {
        let [a, b, c] = [a.as_ref(), b.as_ref(), c.as_ref()];
        let ([.., wa], [.., wb], [.., wc]) = (a, b, c) else { return false };
        self.base.as_mut().copy_from_slice(a);
        let planes = self.at.as_mut().iter_mut().zip(self.dx.as_mut()).zip(self.dy.as_mut()).zip(self.finer.as_mut());
        let (values, mut most) = (a.iter().zip(b).zip(c).take(V::LEN - 1), 0);
        for (k, ((((at, dx), dy), finer), ((a, b), c))) in planes.zip(values).enumerate() {
            let (b, c) = (b.wrapping_sub(*a), c.wrapping_sub(*a));
            let bits = ((b ^ b >> 31) | (c ^ c >> 31)) as u32;
            let cut = 16_u32.saturating_sub(bits.leading_zeros());
            if cut > 8 {
                return false;
            }
            if k < V::PERSPECTIVE {
                most = most.max((b.max(c).max(0) - b.min(c).min(0)) as u32);
            }
            let (n, m) = short.numerators(b >> cut, c >> cut);
            let Some((x, y)) = gradients(n, m, short.reciprocal, short.shift as i32 - 15) else { return false };
            // Half a unit is added, so that pixels on an edge do not show what is beyond it.
            let start = short.offset(x, y).wrapping_add(1 << (8 - cut) >> 1);
            (*at, *dx, *dy, *finer) = (start, x, y, 8 - cut as i32);
        }
        is_straight([*wa as u32, *wb as u32, *wc as u32], most, tolerance)
    }

    /// Returns the varyings at a pixel, from the differences there.
    #[inline(always)]
    fn varyings(&self, at: &V) -> V {
        let mut varyings = self.base;
        for ((value, at), finer) in varyings.as_mut().iter_mut().zip(at.as_ref()).zip(self.finer.as_ref()) {
            *value = value.wrapping_add(at >> (finer & 31));
        }
        varyings
    }
}

/// Returns whether perspective moves no value by more than `tolerance`, where values differ by `most`.
///
/// # Format
/// Δ (q - q₀) / 4 q₀ is at most the tolerance, see `texels.rs`. The rounding of q, of 26 bits, is a unit more.
#[inline(never)]
fn is_straight(words: [u32; 3], most: u32, tolerance: u32) -> bool {
    let (least, largest) = least_and_most(words);
    let more = largest - least + 2;
    u64::from(more) * u64::from(most) <= 4 * u64::from(least) * u64::from(tolerance)
}

impl<'s, P: PixelFormat, D: DepthTest, S: Shader<P> + ?Sized> Brush<P, D> for PlanarBrush<'s, P, S> {
    const PLANES: bool = true;
    const TALL: bool = S::Varyings::LEN > MAX_IN_REGISTERS;

    type Rows = PlanarRows<'s, P, S>;

    #[inline(always)]
    fn set_up(&self, short: &ShortPlanes, swapped: bool, place: (i32, i32), _: i32) -> Option<PlanarRows<'s, P, S>> {
        let [a, mut b, mut c] = self.corners.each_ref();
        if swapped {
            (b, c) = (c, b);
        }
        let side = if swapped == self.clockwise_fronts { Side::Front } else { Side::Back };
        let (shader, flat, format) = (self.shader, self.flat, PhantomData);
        let mut rows = PlanarRows { shader, flat, side, planes: Planes::ZERO, place, row: 0, format };
        if rows.planes.set(short, [a, b, c], shader.tolerance()) { Some(rows) } else { None }
    }

    fn resume(&self, words: &[u32], place: (i32, i32)) -> PlanarRows<'s, P, S> {
        let (shader, flat, format) = (self.shader, self.flat, PhantomData);
        let mut rows = PlanarRows { shader, flat, side: Side::Front, planes: Planes::ZERO, place, row: 0, format };
        let Planes { base, at, dx, dy, finer } = &mut rows.planes;
        if let Some((side, words)) = words.split_first() {
            if *side != 0 {
                rows.side = Side::Back;
            }
            load_varyings([base, at, dx, dy, finer], words);
        }
        rows
    }
}

impl<P: PixelFormat, D: DepthTest, S: Shader<P> + ?Sized> BrushRows<P, D> for PlanarRows<'_, P, S> {
    const WORDS: Option<usize> = words_of::<S::Varyings>(5);

    #[inline(never)]
    fn save(&self, down: u32, words: &mut [u32]) {
        let Planes { base, at, dx, dy, finer } = &self.planes;
        let mut below = *at;
        below.advance(dy, self.row.wrapping_add(down as i32));
        if let Some((side, words)) = words.split_first_mut() {
            *side = (self.side == Side::Back).into();
            save_varyings([base, &below, dx, dy, finer], words);
        }
    }

    #[inline(always)]
    fn beside(&self, (right, down): (i32, i32)) -> Self {
        let Planes { base, mut at, dx, dy, finer } = self.planes;
        shift(&mut at, (&dx, right), (&dy, down));
        Self { planes: Planes { base, at, dx, dy, finer }, ..*self }
    }

    #[inline(always)]
    fn next_row(&mut self) {
        self.row += 1;
    }

    #[inline(always)]
    fn span(&self, color: &mut [P::Raw], depth: &mut [D::Depth], z: u32, dz_dx: i32, column: i32, test: D) {
        self.span_at(Sample::ONLY, color, depth, (z, dz_dx), column, test);
    }

    #[inline(always)]
    fn span_at(
        &self,
        sample: Sample,
        color: &mut [P::Raw],
        depth: &mut [D::Depth],
        (mut z, dz_dx): (u32, i32),
        column: i32,
        test: D,
    ) {
        let mut at = self.planes.at;
        at.advance(&self.planes.dx, column);
        at.advance(&self.planes.dy, self.row);
        let Self { flat, side, .. } = *self;
        let mut position = (self.place.0 + column, self.place.1 + self.row);
        for (color, stored) in color.iter_mut().zip(depth) {
            let depth = (z >> 16) as u16;
            if !D::ENABLED || test.passes(depth, *stored) {
                let (varyings, setup) = (&self.planes.varyings(&at), &S::Setup::default());
                let fragment = Fragment { flat, varyings, position, depth, side, setup };
                if self.shader.paint_at(sample, &fragment, color) {
                    test.write(depth, stored);
                }
            }
            z = z.wrapping_add_signed(dz_dx);
            at.step(&self.planes.dx);
            position.0 = position.0.wrapping_add(1);
        }
    }
}
