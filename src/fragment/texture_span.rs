//! The fastest loop for textures: nearest texels of what repeats, both coordinates in one word.
//!
//! ```text
//! bits   31 .. 16   15 .. 0
//!           v          u        fractions of the texture; what is carried from u into v is 2⁻¹⁶ of it
//! ```
//! Every [`STEP`] pixels, and at the last pixel of a span, both are made anew. In between, steps rounded to 2⁻¹⁶ are off
//! by at most 2⁻¹³; in the last run of a span they are taken backwards from its end, so that ends are exact.

use super::perspective::nth;
use super::{DepthTest, Fragments, PixelFormat, Steps, Texture};
use crate::geometry::{Correction, PerspectiveClass, Varyings};
use crate::math::CoarseDivisor;

/// Pixels from one division to the next.
pub(super) const STEP: usize = 16;

/// Draws a span of a texture that repeats; the first two varyings are u and v, 16.16. Not for triangles whose perspective
/// is [`Wide`](PerspectiveClass::Wide).
#[inline(never)]
pub(super) fn texture_span<P: PixelFormat, T: Texture, D: DepthTest, V: Varyings>(
    texture: &T,
    span: Fragments<'_, P, V, D::Stored>,
    test: D,
) {
    let Fragments { mut color, mut depth, z, varyings, steps, .. } = span;
    let is_affine = steps.correction.class() == PerspectiveClass::Affine;
    let (mut u, mut v) = (Coordinate::new(0, &varyings, steps), Coordinate::new(1, &varyings, steps));
    let last = |values: &[i32]| values.last().copied().unwrap_or(0);
    let (mut q, dq_dx) = (last(varyings.as_ref()), last(steps.d_dx.as_ref()));
    let mut shift = 1;
    let mut uv = coordinates(&u, &v, q, is_affine, &mut shift);
    let mut pen = Pen { z, dz_dx: steps.dz_dx, vu: 0, step: 0 };
    while color.len() > STEP {
        let Some((colors, rest)) = core::mem::take(&mut color).split_first_chunk_mut::<STEP>() else { return };
        color = rest;
        let Some((depths, rest)) = core::mem::take(&mut depth).split_first_chunk_mut::<STEP>() else { return };
        depth = rest;
        u.advance(STEP as i32);
        v.advance(STEP as i32);
        q = q.wrapping_add(dq_dx.wrapping_mul(STEP as i32));
        let next = coordinates(&u, &v, q, is_affine, &mut shift);
        pen.vu = packed(uv);
        let [du, dv] = [next[0].wrapping_sub(uv[0]), next[1].wrapping_sub(uv[1])];
        pen.step = step([du.wrapping_add(8) >> 4, dv.wrapping_add(8) >> 4]);
        uv = next;
        // As if it changed: what it is multiplied by would be computed before the loop, and live on the stack.
        pen.dz_dx = core::hint::black_box(pen.dz_dx);
        // Spelled out: at `opt-level = "s"` a loop would stay a loop.
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = colors;
        let [az, bz, cz, dz, ez, fz, gz, hz, iz, jz, kz, lz, mz, nz, oz, pz] = depths;
        pen.draw::<P, T, D>(texture, test, a, az);
        pen.draw::<P, T, D>(texture, test, b, bz);
        pen.draw::<P, T, D>(texture, test, c, cz);
        pen.draw::<P, T, D>(texture, test, d, dz);
        pen.draw::<P, T, D>(texture, test, e, ez);
        pen.draw::<P, T, D>(texture, test, f, fz);
        pen.draw::<P, T, D>(texture, test, g, gz);
        pen.draw::<P, T, D>(texture, test, h, hz);
        pen.draw::<P, T, D>(texture, test, i, iz);
        pen.draw::<P, T, D>(texture, test, j, jz);
        pen.draw::<P, T, D>(texture, test, k, kz);
        pen.draw::<P, T, D>(texture, test, l, lz);
        pen.draw::<P, T, D>(texture, test, m, mz);
        pen.draw::<P, T, D>(texture, test, n, nz);
        pen.draw::<P, T, D>(texture, test, o, oz);
        pen.draw::<P, T, D>(texture, test, p, pz);
    }
    let way = color.len().saturating_sub(1);
    let mut end = uv;
    if way > 0 {
        u.advance(way as i32);
        v.advance(way as i32);
        q = q.wrapping_add(dq_dx.wrapping_mul(way as i32));
        end = coordinates(&u, &v, q, is_affine, &mut shift);
    }
    let [du, dv] = [end[0].wrapping_sub(uv[0]), end[1].wrapping_sub(uv[1])];
    pen.step = step([nth(du, way), nth(dv, way)]);
    pen.vu = packed(end).wrapping_sub(pen.step.wrapping_mul(way as u32));
    let mut colors = color.chunks_exact_mut(4);
    let mut depths = depth.chunks_exact_mut(4);
    for run in (&mut colors).zip(&mut depths) {
        let ([a, b, c, d], [az, bz, cz, dz]) = run else { return };
        pen.draw::<P, T, D>(texture, test, a, az);
        pen.draw::<P, T, D>(texture, test, b, bz);
        pen.draw::<P, T, D>(texture, test, c, cz);
        pen.draw::<P, T, D>(texture, test, d, dz);
    }
    for (color, depth) in colors.into_remainder().iter_mut().zip(depths.into_remainder()) {
        pen.draw::<P, T, D>(texture, test, color, depth);
    }
}

/// u and v in one word; v as if nothing had been carried from u.
#[inline(always)]
const fn packed([u, v]: [i32; 2]) -> u32 {
    ((v as u32) << 16).wrapping_add(u as u32 & 0xFFFF)
}

/// The word that steps both: what is carried from u is carried, up or down.
#[inline(always)]
const fn step([du, dv]: [i32; 2]) -> u32 {
    ((dv as u32) << 16).wrapping_add(du as u32)
}

/// What changes from pixel to pixel.
struct Pen {
    z: u32,
    dz_dx: i32,
    vu: u32,
    step: u32,
}

impl Pen {
    /// Draws a pixel and steps to the next one.
    #[inline(always)]
    fn draw<P: PixelFormat, T: Texture, D: DepthTest>(
        &mut self,
        texture: &T,
        test: D,
        color: &mut P::Raw,
        stored: &mut D::Stored,
    ) {
        let depth = (self.z >> 16) as u16;
        if !D::ENABLED || test.passes(depth, *stored) {
            if T::IS_OPAQUE {
                test.write(depth, stored);
            }
            if let Some(pixel) = texture.fetch::<P>(self.vu) {
                if !T::IS_OPAQUE {
                    test.write(depth, stored);
                }
                *color = pixel;
            }
        }
        self.z = self.z.wrapping_add_signed(self.dz_dx);
        self.vu = self.vu.wrapping_add(self.step);
    }
}

/// What is interpolated of a coordinate, and how to scale it back.
struct Coordinate {
    h: i32,
    dh_dx: i32,
    base: i32,
    shift: u32,
    /// Half of what is shifted out.
    half: i32,
}

impl Coordinate {
    #[inline(always)]
    fn new<V: Varyings>(k: usize, varyings: &V, steps: &Steps<V>) -> Self {
        let (base, shift) = steps.correction.varyings().get(k).map_or((0, 0), |lane| (lane.base, lane.shift & 31));
        let at = |values: &[i32]| values.get(k).copied().unwrap_or(0);
        Self { h: at(varyings.as_ref()), dh_dx: at(steps.d_dx.as_ref()), base, shift, half: (1 << shift) >> 1 }
    }

    #[inline(always)]
    fn advance(&mut self, pixels: i32) {
        self.h = self.h.wrapping_add(self.dh_dx.wrapping_mul(pixels));
    }

    /// To nearest.
    #[inline(always)]
    fn scaled(&self, h: i32) -> i32 {
        self.base.wrapping_add(h.wrapping_add(self.half) >> self.shift)
    }
}

/// Both coordinates at a pixel. `shift` is how far 1 / w was shifted last.
#[inline(always)]
fn coordinates(u: &Coordinate, v: &Coordinate, q: i32, is_affine: bool, shift: &mut u32) -> [i32; 2] {
    if is_affine {
        return [u.scaled(u.h), v.scaled(v.h)];
    }
    let q = CoarseDivisor::near(q as u32, shift);
    [u.scaled(q.divide(u.h)), v.scaled(q.divide(v.h))]
}
