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
use crate::geometry::{Correction, PerspectiveClass, Varyings};
use crate::math::{CoarseDivisor, SMALL_CORE};
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
    let Fragments { mut color, mut depth, z, varyings, steps, .. } = span;
    let mut walk = Walk::new(&varyings, steps);
    let mut pen = Pen { z, dz_dx: steps.dz_dx, vu: 0, step: 0 };
    let mut uv = walk.ahead(0);
    while color.len() > STEP {
        let Some((colors, rest)) = core::mem::take(&mut color).split_first_chunk_mut::<STEP>() else { return };
        color = rest;
        let Some((depths, rest)) = core::mem::take(&mut depth).split_first_chunk_mut::<STEP>() else { return };
        depth = rest;
        let next = walk.ahead(STEP as i32);
        pen.vu = packed(uv);
        let (du, dv) = (next.0.wrapping_sub(uv.0), next.1.wrapping_sub(uv.1));
        pen.step = step([du.wrapping_add(8) >> 4, dv.wrapping_add(8) >> 4]);
        uv = next;
        if SMALL_CORE && T::IS_OPAQUE {
            pen.run_in_two::<P, T, D>(texture, test, colors, depths);
        } else {
            // As if it changed: what it is multiplied by would be computed before the loop, and live on the stack.
            pen.dz_dx = black_box(pen.dz_dx);
            pen.run::<P, T, D>(texture, test, colors, depths);
        }
    }
    let way = color.len().saturating_sub(1);
    let end = if way > 0 { walk.ahead(way as i32) } else { uv };
    let (du, dv) = (end.0.wrapping_sub(uv.0), end.1.wrapping_sub(uv.1));
    pen.step = step([nth(du, way), nth(dv, way)]);
    pen.vu = packed(end).wrapping_sub(pen.step.wrapping_mul(way as u32));
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

/// Both coordinates, and 1 / w, along a span.
struct Walk {
    u: Coordinate,
    v: Coordinate,
    q: i32,
    dq_dx: i32,
    /// How far q was shifted last.
    shift: u32,
    is_affine: bool,
}

impl Walk {
    #[inline(always)]
    fn new<V: Varyings>(varyings: &V, steps: &Steps<V>) -> Self {
        let last = |values: &[i32]| values.last().copied().unwrap_or(0);
        Self {
            u: Coordinate::new(0, varyings, steps),
            v: Coordinate::new(1, varyings, steps),
            q: last(varyings.as_ref()),
            dq_dx: last(steps.d_dx.as_ref()),
            shift: 1,
            is_affine: steps.correction.class() == PerspectiveClass::Affine,
        }
    }

    /// Both coordinates so many pixels on.
    #[inline(always)]
    fn ahead(&mut self, pixels: i32) -> (i32, i32) {
        if SMALL_CORE { self.ahead_apart(pixels) } else { self.ahead_here(pixels) }
    }

    /// Out of line: its values are more than the loop around it has registers for.
    #[inline(never)]
    fn ahead_apart(&mut self, pixels: i32) -> (i32, i32) {
        self.ahead_here(pixels)
    }

    #[inline(always)]
    fn ahead_here(&mut self, pixels: i32) -> (i32, i32) {
        let Self { u, v, .. } = self;
        u.advance(pixels);
        v.advance(pixels);
        self.q = self.q.wrapping_add(self.dq_dx.wrapping_mul(pixels));
        if self.is_affine {
            return (u.scaled(u.h), v.scaled(v.h));
        }
        let q = CoarseDivisor::near(self.q as u32, &mut self.shift);
        (u.scaled(q.divide(u.h)), v.scaled(q.divide(v.h)))
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
