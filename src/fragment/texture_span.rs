//! The fastest loop for textures: nearest texels of what repeats, both coordinates in one word.
//!
//! ```text
//! bits   31 .. 16   15 .. 0
//!           v          u        fractions of the texture; what is carried from u into v is 2⁻¹⁶ of it
//! ```
//! Every [`STEP`] pixels, and at the last pixel of a span, both are made anew. In between, steps rounded to 2⁻¹⁶ are off
//! by at most 2⁻¹³; in the last run of a span they are taken backwards from its end, so that ends are exact.

use super::perspective::{Corrected, nth};
use super::{DepthTest, Fragments, PixelFormat, Steps, Texture};
use crate::geometry::{Correction, Lane, PerspectiveClass, Varyings};
use crate::math::Divisor;

/// Pixels from one division to the next.
pub(super) const STEP: usize = 16;

/// Draws a span of a texture that repeats; the first two varyings are u and v, 16.16.
#[inline(always)]
pub(super) fn texture_span<P: PixelFormat, T: Texture, D: DepthTest, V: Varyings>(
    texture: &T,
    span: Fragments<'_, P, V>,
    test: D,
) {
    let Fragments { mut color, mut depth, z, varyings, steps, position } = span;
    let mut ahead = Ahead::new(varyings, steps, position);
    let mut uv = ahead.uv();
    let mut pen = Pen { z, dz_dx: steps.dz_dx, vu: 0, step: 0 };
    while color.len() > STEP {
        let Some((colors, rest)) = core::mem::take(&mut color).split_first_chunk_mut::<STEP>() else { return };
        color = rest;
        let Some((depths, rest)) = core::mem::take(&mut depth).split_first_chunk_mut::<STEP>() else { return };
        depth = rest;
        ahead.advance(STEP as i32);
        let next = ahead.uv();
        pen.vu = packed(uv);
        let [du, dv] = [next[0].wrapping_sub(uv[0]), next[1].wrapping_sub(uv[1])];
        pen.step = packed([(du + STEP as i32 / 2) >> 4, (dv + STEP as i32 / 2) >> 4]);
        uv = next;
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
    ahead.advance(way as i32);
    let end = if way > 0 { ahead.uv() } else { uv };
    let [du, dv] = [end[0].wrapping_sub(uv[0]), end[1].wrapping_sub(uv[1])];
    pen.step = packed([nth(du, way), nth(dv, way)]);
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
        stored: &mut u16,
    ) {
        let depth = (self.z >> 16) as u16;
        if !D::ENABLED || test.passes(depth, *stored) {
            if let Some(pixel) = texture.fetch::<P>(self.vu) {
                test.write(depth, stored);
                *color = pixel;
            }
        }
        self.z = self.z.wrapping_add_signed(self.dz_dx);
        self.vu = self.vu.wrapping_add(self.step);
    }
}

/// Texture coordinates at a pixel, and the way to the next ones: [`Corrected`], for two varyings and no others.
struct Ahead<'a, V: Varyings> {
    class: PerspectiveClass,
    lanes: [Lane2; 2],
    q: i32,
    dq_dx: i32,
    wide: Option<Corrected<'a, V>>,
}

/// What is interpolated of a coordinate, and how to scale it back.
struct Lane2 {
    h: i32,
    dh_dx: i32,
    base: i32,
    shift: u32,
}

impl<'a, V: Varyings> Ahead<'a, V> {
    #[inline(always)]
    fn new(varyings: V, steps: &'a Steps<V>, position: (i32, i32)) -> Self {
        let class = steps.correction.class();
        let (values, changes, lanes) = (varyings.as_ref(), steps.d_dx.as_ref(), steps.correction.varyings());
        let lane = |k: usize| {
            let (base, shift) = lanes.get(k).map_or((0, 0), |lane: &Lane| (lane.base, lane.shift));
            let at = |values: &[i32]| values.get(k).copied().unwrap_or(0);
            Lane2 { h: at(values), dh_dx: at(changes), base: base.wrapping_add(0), shift }
        };
        let last = |values: &[i32]| values.last().copied().unwrap_or(0);
        let wide = match class {
            PerspectiveClass::Wide => Some(Corrected::new(varyings, steps, position)),
            _ => None,
        };
        Self { class, lanes: [lane(0), lane(1)], q: last(values), dq_dx: last(changes), wide }
    }

    #[inline(always)]
    fn advance(&mut self, pixels: i32) {
        let [u, v] = &mut self.lanes;
        u.h = u.h.wrapping_add(u.dh_dx.wrapping_mul(pixels));
        v.h = v.h.wrapping_add(v.dh_dx.wrapping_mul(pixels));
        self.q = self.q.wrapping_add(self.dq_dx.wrapping_mul(pixels));
        if let Some(wide) = &mut self.wide {
            wide.advance(pixels);
        }
    }

    #[inline(always)]
    fn uv(&self) -> [i32; 2] {
        let [u, v] = &self.lanes;
        match self.class {
            PerspectiveClass::Affine => [u.scaled(u.h), v.scaled(v.h)],
            PerspectiveClass::Narrow => {
                let q = Divisor::new(self.q as u32);
                [u.scaled(q.divide(u.h)), v.scaled(q.divide(v.h))]
            }
            PerspectiveClass::Wide => self.wide.as_ref().map_or([0; 2], wide),
        }
    }
}

#[inline(never)]
fn wide<V: Varyings>(corrected: &Corrected<'_, V>) -> [i32; 2] {
    match corrected.varyings().as_ref() {
        [u, v, ..] => [*u, *v],
        _ => [0; 2],
    }
}

impl Lane2 {
    /// To nearest.
    #[inline(always)]
    fn scaled(&self, h: i32) -> i32 {
        self.base.wrapping_add(h.wrapping_add((1 << self.shift) >> 1) >> self.shift)
    }
}
