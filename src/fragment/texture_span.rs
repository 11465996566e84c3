//! The fastest loop for textures: nearest texels of what repeats, both coordinates in one word.
//!
//! ```text
//! bits   31 .. 16   15 .. 0
//!           v          u        fractions of the texture; what is carried from u into v is 2⁻¹⁶ of it
//! ```
//! Every [`STEP`] pixels, and at the last pixel of a span, both are made anew. In between, steps rounded to 2⁻¹⁶ are off
//! by at most 2⁻¹³; in the last run of a span they are taken backwards from its end, so that ends are exact.

use super::depth::{RUN, passing};
use super::perspective::nth;
use super::{DepthTest, Fragments, PixelFormat, Steps, Texture};
use crate::geometry::{Correction, Lane, PerspectiveClass, Varyings};
use crate::math::{CoarseDivisor, SMALL_CORE, leading_zeros};
use core::hint::black_box;

/// Pixels from one division to the next.
pub(super) const STEP: usize = RUN;

/// Draws a span of a texture that repeats; the first two varyings are u and v, 16.16. Not for triangles whose perspective
/// is [`Wide`](PerspectiveClass::Wide).
#[inline(never)]
pub(super) fn texture_span<P: PixelFormat, T: Texture, D: DepthTest, V: Varyings>(
    texture: &T,
    span: Fragments<'_, P, V, D::Stored>,
    test: D,
) {
    let Fragments { color, depth, z, varyings, steps, .. } = span;
    let length = color.len().min(depth.len());
    let Some(mut color) = color.get_mut(..length) else { return };
    let Some(mut depth) = depth.get_mut(..length) else { return };
    let mut walk = Walk::new(&varyings, steps, length as i32 - 1);
    let mut pen = Pen { z, dz_dx: steps.dz_dx, vu: 0, step: 0 };
    walk.run();
    while color.len() > STEP {
        let Some((colors, rest)) = core::mem::take(&mut color).split_first_chunk_mut::<STEP>() else { return };
        color = rest;
        let Some((depths, rest)) = core::mem::take(&mut depth).split_first_chunk_mut::<STEP>() else { return };
        depth = rest;
        (pen.vu, pen.step) = walk.run();
        if SMALL_CORE && T::IS_OPAQUE {
            pen.run_in_two::<P, T, D>(texture, test, colors, depths);
        } else {
            // As if it changed: what it is multiplied by would be computed before the loop, and live on the stack.
            pen.dz_dx = black_box(pen.dz_dx);
            pen.run::<P, T, D>(texture, test, colors, depths);
        }
    }
    let way = color.len().saturating_sub(1);
    (pen.vu, pen.step) = walk.rest(way);
    if SMALL_CORE {
        pen.some::<P, T, D>(texture, test, 0, color, depth);
    } else {
        pen.rest::<P, T, D>(texture, test, 0, color, depth);
    }
}

/// u and v in one word; v as if nothing had been carried from u.
#[inline(always)]
const fn packed((u, v): (i32, i32)) -> u32 {
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
    /// Draws a run of a texture that is opaque, depths first and colours then: each loop has all of its values in registers.
    #[inline(always)]
    fn run_in_two<P: PixelFormat, T: Texture, D: DepthTest>(
        &mut self,
        texture: &T,
        test: D,
        colors: &mut [P::Raw; STEP],
        depths: &mut [D::Stored; STEP],
    ) {
        let passed = passing(test, depths, self.z, self.dz_dx);
        if passed == STEP {
            self.colors::<P, T>(texture, colors);
        } else {
            // A copy, so that the pen itself need not be in memory.
            Self { ..*self }.some::<P, T, D>(texture, test, passed, colors, depths);
        }
        self.z = self.z.wrapping_add_signed(self.dz_dx.wrapping_mul(STEP as i32));
    }

    /// Colours a run.
    #[inline(always)]
    fn colors<P: PixelFormat, T: Texture>(&self, texture: &T, colors: &mut [P::Raw; STEP]) {
        let mut vu = self.vu;
        // Spelled out: at `opt-level = "s"` a loop would stay a loop.
        macro_rules! color {
            ($($color:ident)*) => {
                let [$($color),*] = colors;
                $(
                    if let Some(pixel) = texture.fetch::<P>(vu) {
                        *$color = pixel;
                    }
                    vu = vu.wrapping_add(self.step);
                )*
            };
        }
        color!(a b c d e f g h i j k l m n o p);
        let _ = vu;
    }

    /// Draws a run pixel by pixel.
    #[inline(always)]
    fn run<P: PixelFormat, T: Texture, D: DepthTest>(
        &mut self,
        texture: &T,
        test: D,
        colors: &mut [P::Raw; STEP],
        depths: &mut [D::Stored; STEP],
    ) {
        // Spelled out: at `opt-level = "s"` a loop would stay a loop.
        macro_rules! draw {
            ($($color:ident $depth:ident)*) => {
                let [$($color),*] = colors;
                let [$($depth),*] = depths;
                $( self.draw::<P, T, D>(texture, test, false, $color, $depth); )*
            };
        }
        draw!(a az b bz c cz d dz e ez f fz g gz h hz i iz j jz k kz l lz m mz n nz o oz p pz);
    }

    /// Draws pixels, of which the first depths have been tested.
    #[inline(always)]
    fn rest<P: PixelFormat, T: Texture, D: DepthTest>(
        mut self,
        texture: &T,
        test: D,
        passed: usize,
        colors: &mut [P::Raw],
        depths: &mut [D::Stored],
    ) {
        for (k, (color, stored)) in colors.iter_mut().zip(depths).enumerate() {
            self.draw::<P, T, D>(texture, test, k < passed, color, stored);
        }
    }

    /// The same, once for all.
    #[inline(never)]
    fn some<P: PixelFormat, T: Texture, D: DepthTest>(
        self,
        texture: &T,
        test: D,
        passed: usize,
        colors: &mut [P::Raw],
        depths: &mut [D::Stored],
    ) {
        self.rest::<P, T, D>(texture, test, passed, colors, depths);
    }

    /// Draws a pixel and steps to the next one.
    #[inline(always)]
    fn draw<P: PixelFormat, T: Texture, D: DepthTest>(
        &mut self,
        texture: &T,
        test: D,
        passed: bool,
        color: &mut P::Raw,
        stored: &mut D::Stored,
    ) {
        let depth = (self.z >> 16) as u16;
        if !D::ENABLED || passed || test.passes(depth, *stored) {
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

/// Both coordinates along a span, from run to run.
///
/// q, d q of u and that of v are shifted up, so that the larger q of both ends has its top bit set. Where there is no
/// perspective, q is 0.
struct Walk {
    /// q and the others where the walk is, and what the next run adds.
    at: [i32; 3],
    step: [i32; 3],
    /// u and v there.
    uv: (i32, i32),
    u: Scale,
    v: Scale,
    /// q and the others at the last pixel.
    end: [i32; 3],
}

impl Walk {
    /// A run before a span, whose last pixel is `way` pixels from the first.
    #[inline(always)]
    fn new<V: Varyings>(varyings: &V, steps: &Steps<V>, way: i32) -> Self {
        let (at, step) = (varyings.as_ref(), steps.d_dx.as_ref());
        let value = |values: &[i32], k: usize| values.get(k).copied().unwrap_or(0);
        let last = |values: &[i32]| values.last().copied().unwrap_or(0);
        let (mut q, mut dq) = (last(at), last(step));
        if steps.correction.class() == PerspectiveClass::Affine {
            (q, dq) = (0, 0);
        }
        let end = q.wrapping_add(dq.wrapping_mul(way));
        let shift = leading_zeros((q as u32).max(end as u32)) & 31;
        let at = [q, value(at, 0), value(at, 1)];
        let step = [dq, value(step, 0), value(step, 1)];
        let lanes = steps.correction.varyings();
        let along = |k: usize| {
            let (at, step) = (value(&at, k) << shift, value(&step, k) << shift);
            (at.wrapping_sub(step << 4), step << 4, at.wrapping_add(step.wrapping_mul(way)))
        };
        let (q, u, v) = (along(0), along(1), along(2));
        Self {
            at: [q.0, u.0, v.0],
            step: [q.1, u.1, v.1],
            uv: (0, 0),
            u: Scale::new(lanes.first()),
            v: Scale::new(lanes.get(1)),
            end: [q.2, u.2, v.2],
        }
    }

    /// Goes a run on: what to draw it with. Out of line: its values are more than the loop around it has registers for.
    #[inline(never)]
    fn run(&mut self) -> (u32, u32) {
        let [q, u, v] = self.at;
        let [dq, du, dv] = self.step;
        let (q, mut u, mut v) = (q.wrapping_add(dq), u.wrapping_add(du), v.wrapping_add(dv));
        self.at = [q, u, v];
        if q != 0 {
            let mut q = q as u32;
            while q >> 31 == 0 {
                (q, u, v) = (q << 1, u << 1, v << 1);
            }
            let q = CoarseDivisor::of_normalized(q);
            (u, v) = (q.divide_normalized(u), q.divide_normalized(v));
        }
        let (from, to) = (self.uv, (self.u.scaled(u), self.v.scaled(v)));
        self.uv = to;
        let (du, dv) = (to.0.wrapping_sub(from.0), to.1.wrapping_sub(from.1));
        (packed(from), step([du.wrapping_add(8) >> 4, dv.wrapping_add(8) >> 4]))
    }

    /// Goes on to the end: what to draw the last pixels with, the last of them `way` pixels ahead.
    #[inline(always)]
    fn rest(&mut self, way: usize) -> (u32, u32) {
        let from = self.uv;
        let ([q, u, v], [end_q, end_u, end_v]) = (self.at, self.end);
        self.step = [end_q.wrapping_sub(q), end_u.wrapping_sub(u), end_v.wrapping_sub(v)];
        self.run();
        let (du, dv) = (self.uv.0.wrapping_sub(from.0), self.uv.1.wrapping_sub(from.1));
        let step = step([nth(du, way), nth(dv, way)]);
        (packed(self.uv).wrapping_sub(step.wrapping_mul(way as u32)), step)
    }
}

/// How to scale what is interpolated of a coordinate back.
struct Scale {
    /// Half of what is shifted out.
    half: i32,
    shift: u32,
    base: i32,
}

impl Scale {
    #[inline(always)]
    fn new(lane: Option<&Lane>) -> Self {
        let (base, shift) = lane.map_or((0, 0), |lane| (lane.base, lane.shift & 31));
        Self { half: (1 << shift) >> 1, shift, base }
    }

    /// To nearest.
    #[inline(always)]
    fn scaled(&self, h: i32) -> i32 {
        self.base.wrapping_add(h.wrapping_add(self.half) >> (self.shift & 31))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fragment::{AnyDepth, Compare, DepthState, LessWrite, Tile};
    use embedded_graphics_core::pixelcolor::Rgb565;

    #[test]
    fn runs_in_two_are_those_pixel_by_pixel() {
        let texels: [[u16; 8]; 4] =
            core::array::from_fn(|y| core::array::from_fn(|x| ((8 * y + x) as u16).wrapping_mul(0x0843)));
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state ^ state >> 15
        };
        for case in 0..2000 {
            let (z, dz_dx, vu, step) = (random() >> 1, random() as i32 >> 12, random(), random());
            // All pass, all but a few, few.
            let far = [0, 1, 5, 13][case % 4];
            let depths: [u16; STEP] = core::array::from_fn(|_| if random() % 16 < far { 0 } else { u16::MAX });
            let draw = |in_two: bool, greater: bool| {
                let mut pen = Pen { z, dz_dx, vu, step };
                let (mut colors, mut depths) = ([0; STEP], depths);
                let (tile, colors_mut, depths_mut) = (&Tile::new(&texels), &mut colors, &mut depths);
                let any = AnyDepth::new(DepthState { compare: Compare::Greater, write: false });
                match (in_two, greater) {
                    (false, false) => pen.run::<Rgb565, _, _>(tile, LessWrite, colors_mut, depths_mut),
                    (true, false) => pen.run_in_two::<Rgb565, _, _>(tile, LessWrite, colors_mut, depths_mut),
                    (false, true) => pen.run::<Rgb565, _, _>(tile, any, colors_mut, depths_mut),
                    (true, true) => pen.run_in_two::<Rgb565, _, _>(tile, any, colors_mut, depths_mut),
                }
                (colors, depths, pen.z)
            };
            assert_eq!(draw(true, false), draw(false, false), "{case}");
            assert_eq!(draw(true, true), draw(false, true), "{case}");
        }
    }
}
