//! Spans of repeating textures, with nearest texels: the fastest loop for textures.
//!
//! The plain loop, over u q, v q and q = 1 / w, which are linear on the screen:
//!
//! ```text
//! for each pixel:
//!     if z >> 16 passes against the stored depth:
//!         color = texel(uq / q, vq / q)
//!         store z >> 16, unless the texel is transparent
//!     z += dz_dx;  uq += duq;  vq += dvq;  q += dq
//! ```
//! The departures from it, with what each gained on a Cortex-M0+ and a Cortex-M4 when it was made. Gains are
//! instructions per pixel of W3, a tilted quad:
//!
//! 1. **Coordinates are divided every 16 pixels**, and at the last pixel. In between u and v are linear, both in one
//!    word:
//!
//!    ```text
//!    bits   31 .. 16   15 .. 0
//!              v          u        fractions of the texture; a carry from u adds 2⁻¹⁶ to v
//!    ```
//!    Steps are rounded to 2⁻¹⁶, so a pixel of a run is off by at most 2⁻¹³. The last run of a span is stepped
//!    backwards from its end, so that both ends are exact.
//! 2. **Runs of 16 pixels are drawn in two passes** on small cores, first depths and then texels. Each pass has its
//!    values in registers: 33.5 → 31.3.
//! 3. **q, u q and v q are normalized once per span**, and the word and the step of a run are computed out of line:
//!    30.6 → 29.0 and 20.7 → 20.2.
//! 4. **Texels of a run are fetched out of line**, and the last pixels of a span are drawn in two passes too: 29.0 →
//!    27.3.
//! 5. **Dividing takes two instructions, and scaling too**, where the core has long products: 19.7 → 18.9 on a
//!    Cortex-M4.

use super::depth::{DepthTest, RUN, count_passing_prefix, untested_tail};
use super::perspective::per_pixel;
use super::span::{Primitive, Span};
use crate::color::PixelFormat;
use crate::math::{CoarseDivisor, SMALL_CORE};
use crate::texture::Texture;
use crate::vertex::{PerspectiveClass, PerspectivePlane, PerspectiveSetup, Varyings};

/// Number of pixels from one division to the next.
pub(crate) const STEP: usize = RUN;

/// Draws a span of a repeating texture. The first two varyings are u and v in 16.16. The perspective of the triangle
/// must not be [`Planes64`](PerspectiveClass::Planes64).
#[inline(never)]
pub(crate) fn texture_span<P: PixelFormat, T: Texture, D: DepthTest, V: Varyings, U>(
    texture: &T,
    span: Span<'_, P, V, U, D::Depth>,
    test: D,
) {
    let Span { color, depth, z, position, primitive } = span;
    let length = color.len().min(depth.len());
    let Some(mut color) = color.get_mut(..length) else { return };
    let Some(mut depth) = depth.get_mut(..length) else { return };
    let mut stepper = UvStepper::new(primitive, position, length as i32 - 1);
    let mut cursor = TexelCursor { z, dz_dx: primitive.dz_dx, vu: 0, step: 0 };
    stepper.next_run();
    while color.len() > STEP {
        let Some((colors, rest)) = core::mem::take(&mut color).split_first_chunk_mut::<STEP>() else { return };
        color = rest;
        let Some((depths, rest)) = core::mem::take(&mut depth).split_first_chunk_mut::<STEP>() else { return };
        depth = rest;
        if SMALL_CORE && T::IS_OPAQUE {
            cursor.run16_two_pass::<P, T, D>(texture, test, &mut stepper, colors, depths);
        } else {
            (cursor.vu, cursor.step) = stepper.next_run();
            // Reads the step from memory. The compiler would otherwise compute its multiple before the loop, and keep
            // it on the stack.
            cursor.dz_dx = stepper.dz_dx;
            cursor.run16::<P, T, D>(texture, test, colors, depths);
        }
    }
    let way = color.len().saturating_sub(1);
    (cursor.vu, cursor.step) = stepper.last(way);
    if SMALL_CORE && T::IS_OPAQUE {
        cursor.short_two_pass::<P, T, D>(texture, test, color, depth);
    } else if SMALL_CORE {
        cursor.partial::<P, T, D>(texture, test, 0, color, depth);
    } else {
        cursor.tail::<P, T, D>(texture, test, color, depth);
    }
}

/// Colours a run.
#[inline(never)]
fn color_run16<P: PixelFormat, T: Texture>(texture: &T, colors: &mut [P::Raw; STEP], mut vu: u32, step: u32) {
    // Unrolled by hand: at `opt-level = "s"` a loop would stay a loop.
    macro_rules! color {
        ($($color:ident)*) => {
            let [$($color),*] = colors;
            $(
                // Steps first: the fetch may then overwrite the old word, which need not be copied.
                let here = vu;
                vu = vu.wrapping_add(step);
                if let Some(pixel) = texture.fetch::<P>(here) {
                    *$color = pixel;
                }
            )*
        };
    }
    color!(a b c d e f g h i j k l m n o p);
    let _ = vu;
}

/// Colours fewer pixels than a run has, and returns the word of the pixel after them.
#[inline(never)]
fn color_short<P: PixelFormat, T: Texture>(texture: &T, colors: &mut [P::Raw], mut vu: u32, step: u32) -> u32 {
    for color in colors {
        let here = vu;
        vu = vu.wrapping_add(step);
        if let Some(pixel) = texture.fetch::<P>(here) {
            *color = pixel;
        }
    }
    vu
}

/// Packs u and v into one word. v is as if nothing had been carried from u.
#[inline(always)]
const fn packed((u, v): (i32, i32)) -> u32 {
    ((v as u32) << 16).wrapping_add(u as u32 & 0xFFFF)
}

/// Packs the steps of u and v into one word, which steps both. Carries from u go into v, up or down.
#[inline(always)]
const fn step([du, dv]: [i32; 2]) -> u32 {
    ((dv as u32) << 16).wrapping_add(du as u32)
}

/// State of the loops over a textured span: all that changes from pixel to pixel.
struct TexelCursor {
    z: u32,
    dz_dx: i32,
    vu: u32,
    step: u32,
}

impl TexelCursor {
    /// Draws the next run of an opaque texture, first depths and then colours. Each loop has all of its values in
    /// registers.
    #[inline(always)]
    fn run16_two_pass<P: PixelFormat, T: Texture, D: DepthTest>(
        &mut self,
        texture: &T,
        test: D,
        stepper: &mut UvStepper,
        colors: &mut [P::Raw; STEP],
        depths: &mut [D::Depth; STEP],
    ) {
        let passed = count_passing_prefix(test, depths, self.z, self.dz_dx);
        let (vu, step) = stepper.next_run();
        if passed == STEP {
            color_run16::<P, T>(texture, colors, vu, step);
        } else {
            // A copy, so that the cursor itself stays in registers.
            Self { vu, step, ..*self }.partial::<P, T, D>(texture, test, passed, colors, depths);
        }
        self.z = self.z.wrapping_add_signed(self.dz_dx.wrapping_mul(STEP as i32));
    }

    /// Draws a run pixel by pixel.
    #[inline(always)]
    fn run16<P: PixelFormat, T: Texture, D: DepthTest>(
        &mut self,
        texture: &T,
        test: D,
        colors: &mut [P::Raw; STEP],
        depths: &mut [D::Depth; STEP],
    ) {
        // Unrolled by hand: at `opt-level = "s"` a loop would stay a loop.
        macro_rules! draw {
            ($($color:ident $depth:ident)*) => {
                let [$($color),*] = colors;
                let [$($depth),*] = depths;
                $( self.draw::<P, T, D>(texture, test, $color, $depth); )*
            };
        }
        draw!(a az b bz c cz d dz e ez f fz g gz h hz i iz j jz k kz l lz m mz n nz o oz p pz);
    }

    /// Draws pixels one by one, in pairs on larger cores.
    #[inline(always)]
    fn tail<P: PixelFormat, T: Texture, D: DepthTest>(
        mut self,
        texture: &T,
        test: D,
        mut colors: &mut [P::Raw],
        mut depths: &mut [D::Depth],
    ) {
        while !SMALL_CORE && colors.len() >= 2 {
            let Some(([a, b], rest)) = core::mem::take(&mut colors).split_first_chunk_mut::<2>() else { return };
            colors = rest;
            let Some(([az, bz], rest)) = core::mem::take(&mut depths).split_first_chunk_mut::<2>() else { return };
            depths = rest;
            self.draw::<P, T, D>(texture, test, a, az);
            self.draw::<P, T, D>(texture, test, b, bz);
        }
        for (color, stored) in colors.iter_mut().zip(depths) {
            self.draw::<P, T, D>(texture, test, color, stored);
        }
    }

    /// Draws at most a run of pixels in two passes.
    #[inline(always)]
    fn short_two_pass<P: PixelFormat, T: Texture, D: DepthTest>(
        self,
        texture: &T,
        test: D,
        colors: &mut [P::Raw],
        depths: &mut [D::Depth],
    ) {
        let left = untested_tail(test, depths, self.z, self.dz_dx);
        if left == 0 {
            color_short::<P, T>(texture, colors, self.vu, self.step);
        } else {
            let passed = colors.len().saturating_sub(left);
            self.partial::<P, T, D>(texture, test, passed, colors, depths);
        }
    }

    /// Draws pixels; the first `passed` depths have passed already, and are stored.
    #[inline(never)]
    fn partial<P: PixelFormat, T: Texture, D: DepthTest>(
        mut self,
        texture: &T,
        test: D,
        passed: usize,
        colors: &mut [P::Raw],
        depths: &mut [D::Depth],
    ) {
        let Some((first, colors)) = colors.split_at_mut_checked(passed) else { return };
        let Some(depths) = depths.get_mut(passed..) else { return };
        self.vu = color_short::<P, T>(texture, first, self.vu, self.step);
        self.z = self.z.wrapping_add_signed(self.dz_dx.wrapping_mul(passed as i32));
        self.tail::<P, T, D>(texture, test, colors, depths);
    }

    /// Draws a pixel and steps to the next one.
    #[inline(always)]
    fn draw<P: PixelFormat, T: Texture, D: DepthTest>(
        &mut self,
        texture: &T,
        test: D,
        color: &mut P::Raw,
        stored: &mut D::Depth,
    ) {
        let (depth, vu) = ((self.z >> 16) as u16, self.vu);
        self.z = self.z.wrapping_add_signed(self.dz_dx);
        self.vu = vu.wrapping_add(self.step);
        if !D::ENABLED || test.passes(depth, *stored) {
            if T::IS_OPAQUE {
                test.write(depth, stored);
            }
            if let Some(pixel) = texture.fetch::<P>(vu) {
                if !T::IS_OPAQUE {
                    test.write(depth, stored);
                }
                *color = pixel;
            }
        }
    }
}

/// Both coordinates of a texture along a span, from run to run.
///
/// q, d q of u and d q of v are shifted up, so that the larger q of both ends has its top bit set. Without perspective,
/// q is 0.
struct UvStepper {
    /// q, d q of u and d q of v at the stepper's position, and their changes over the next run.
    at: [i32; 3],
    step: [i32; 3],
    /// u and v at the stepper's position.
    uv: (i32, i32),
    u: Scale,
    v: Scale,
    /// q, d q of u and d q of v at the last pixel.
    end: [i32; 3],
    /// Change of depth per pixel. The stepper keeps it in memory for the loop, and does not use it itself.
    dz_dx: i32,
}

impl UvStepper {
    /// Creates a stepper that is one run to the left of the first pixel. The last pixel is `way` pixels to the right of
    /// the first one.
    #[inline(never)]
    fn new<V: Varyings, U>(primitive: &Primitive<V, U>, position: (i32, i32), way: i32) -> Self {
        let varyings = primitive.at(position);
        let (at, step) = (varyings.as_ref(), primitive.d_dx.as_ref());
        let value = |values: &[i32], k: usize| values.get(k).copied().unwrap_or(0);
        let last = |values: &[i32]| values.last().copied().unwrap_or(0);
        let (mut q, mut dq) = (last(at), last(step));
        let end = q.wrapping_add(dq.wrapping_mul(way));
        let mut most = (q as u32).max(end as u32) | 1;
        let mut shift = 0;
        if SMALL_CORE {
            // Takes a few rounds, and fewer instructions than `leading_zeros` does with its table.
            while most >> 31 == 0 {
                (most, shift) = (most << 1, shift + 1);
            }
        } else {
            shift = most.leading_zeros();
        }
        if primitive.perspective.class() == PerspectiveClass::Affine {
            (q, dq, shift) = (0, 0, 0);
        }
        let shift = shift & 31;
        let at = [q, value(at, 0), value(at, 1)];
        let step = [dq, value(step, 0), value(step, 1)];
        let planes = primitive.perspective.planes();
        let along = |k: usize| {
            let (at, step) = (value(&at, k) << shift, value(&step, k) << shift);
            (at.wrapping_sub(step << 4), step << 4, at.wrapping_add(step.wrapping_mul(way)))
        };
        let (q, u, v) = (along(0), along(1), along(2));
        Self {
            at: [q.0, u.0, v.0],
            step: [q.1, u.1, v.1],
            uv: (0, 0),
            u: Scale::new(planes.first()),
            v: Scale::new(planes.get(1)),
            end: [q.2, u.2, v.2],
            dz_dx: primitive.dz_dx,
        }
    }

    /// Moves on by one run, and returns the word and the step with which that run is drawn. Out of line: it has more
    /// values than the loop around it has registers for.
    #[inline(never)]
    fn next_run(&mut self) -> (u32, u32) {
        let [q, u, v] = self.at;
        let [dq, du, dv] = self.step;
        let (q, mut u, mut v) = (q.wrapping_add(dq), u.wrapping_add(du), v.wrapping_add(dv));
        self.at = [q, u, v];
        let (u, v) = 'quotients: {
            let mut q = q as u32;
            if q >> 31 == 0 {
                if q == 0 {
                    break 'quotients (u, v);
                }
                while q >> 31 == 0 {
                    (q, u, v) = (q << 1, u << 1, v << 1);
                }
            }
            let q = CoarseDivisor::of_normalized(q);
            (q.divide_normalized(u), q.divide_normalized(v))
        };
        let (from, to) = (self.uv, (self.u.scaled(u), self.v.scaled(v)));
        self.uv = to;
        let (du, dv) = (to.0.wrapping_sub(from.0), to.1.wrapping_sub(from.1));
        (packed(from), step([du.wrapping_add(8) >> 4, dv.wrapping_add(8) >> 4]))
    }

    /// Moves on to the last pixel, `way` pixels ahead, and returns the word and the step with which the pixels up to it
    /// are drawn.
    #[inline(never)]
    fn last(&mut self, way: usize) -> (u32, u32) {
        let from = self.uv;
        let ([q, u, v], [end_q, end_u, end_v]) = (self.at, self.end);
        self.step = [end_q.wrapping_sub(q), end_u.wrapping_sub(u), end_v.wrapping_sub(v)];
        self.next_run();
        let (du, dv) = (self.uv.0.wrapping_sub(from.0), self.uv.1.wrapping_sub(from.1));
        let step = step([per_pixel(du, way), per_pixel(dv, way)]);
        (packed(self.uv).wrapping_sub(step.wrapping_mul(way as u32)), step)
    }
}

/// Scale that takes a coordinate from its interpolated form h back to 16.16.
struct Scale {
    /// Half of the last bit that stays after the shift, which rounds. On cores with long products it is multiplied by
    /// 4.
    half: i32,
    /// Number of bits to shift by. On cores with long products, 2³⁰ shifted right by that number.
    by: i32,
    /// Coordinate for h = 0.
    base: i32,
}

impl Scale {
    #[inline(always)]
    fn new(plane: Option<&PerspectivePlane>) -> Self {
        let (base, shift) = plane.map_or((0, 0), |plane| (plane.base, plane.shift & 31));
        if SMALL_CORE {
            Self { half: (1 << shift) >> 1, by: shift as i32, base }
        } else {
            Self { half: 2 << shift & !3, by: 1 << 30 >> shift, base }
        }
    }

    /// Scales `h` back and adds the base, rounded to nearest.
    ///
    /// # Format
    /// |`h`| is at most a little more than 2²⁸; shifts are at most 28.
    #[inline(always)]
    fn scaled(&self, h: i32) -> i32 {
        if SMALL_CORE {
            self.base.wrapping_add(h.wrapping_add(self.half) >> (self.by & 31))
        } else {
            // A long product shifts, in two instructions with the sum.
            let h = (h << 2).wrapping_add(self.half);
            self.base.wrapping_add(((i64::from(h) * i64::from(self.by)) >> 32) as i32)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::depth::{Compare, DepthDyn, DepthLess, DepthOff, DepthState};
    use super::super::naive;
    use super::super::perspective::Corrected;
    use super::*;
    use crate::math::random::Rng;
    use crate::texture::Tile;
    use crate::vertex::{Perspective, Side};
    use embedded_graphics_core::pixelcolor::Rgb565;

    /// Creates a stepper without perspective. It is at `u` and `v`, and moves on by `du` and `dv`.
    fn stepper([u, v]: [i32; 2], [du, dv]: [i32; 2]) -> UvStepper {
        let scale = || Scale::new(None);
        let at = [0, u, v];
        UvStepper { at, step: [0, du, dv], uv: (u, v), u: scale(), v: scale(), end: [0; 3], dz_dx: 0 }
    }

    /// Compares all loops with the plain one, over an opaque tile.
    fn compare<D: DepthTest<Depth: PartialEq + core::fmt::Debug>>(test: D, stored: impl Fn(u16) -> D::Depth) {
        let texels: [[u16; 8]; 4] =
            core::array::from_fn(|y| core::array::from_fn(|x| ((8 * y + x) as u16).wrapping_mul(0x0843)));
        let tile = &Tile::new(&texels);
        let mut rng = Rng::new(1);
        for _ in 0..1000 {
            let (z, dz_dx) = (20_000 << 16, rng.next_u32() as i32 >> 20);
            let mut uv = || rng.next_u32() as i32 >> 8;
            let (uv, duv) = ([uv(), uv()], [uv(), uv()]);
            let (vu, step) = stepper(uv, duv).next_run();
            let cursor = || TexelCursor { z, dz_dx, vu, step };
            let pixel = |k: usize| tile.fetch::<Rgb565>(vu.wrapping_add(step.wrapping_mul(k as u32)));
            let case = naive::Case { length: STEP, z, dz_dx, background: 0x1234_u16 };
            naive::compare(
                test,
                case,
                &mut rng,
                &stored,
                pixel,
                &mut [
                    ("a run in one pass", &mut |color, depth| {
                        let (Ok(color), Ok(depth)) = (color.try_into(), depth.try_into()) else { return };
                        cursor().run16::<Rgb565, _, D>(tile, test, color, depth);
                    }),
                    ("a run in two passes", &mut |color, depth| {
                        let (Ok(color), Ok(depth)) = (color.try_into(), depth.try_into()) else { return };
                        cursor().run16_two_pass::<Rgb565, _, D>(tile, test, &mut stepper(uv, duv), color, depth);
                    }),
                ],
            );
            let case = naive::Case { length: rng.below(STEP as u64 + 1) as usize, ..case };
            naive::compare(
                test,
                case,
                &mut rng,
                &stored,
                pixel,
                &mut [
                    ("a tail", &mut |color, depth| cursor().tail::<Rgb565, _, D>(tile, test, color, depth)),
                    ("a tail in two passes", &mut |color, depth| {
                        cursor().short_two_pass::<Rgb565, _, D>(tile, test, color, depth);
                    }),
                ],
            );
        }
    }

    #[test]
    fn spans_are_those_pixel_by_pixel() {
        compare(DepthLess, |depth| depth);
        compare(DepthDyn::new(DepthState { compare: Compare::Greater, write: false }), |depth| depth);
        compare(DepthOff, |_| ());
    }

    #[test]
    fn steppers_are_where_divisors_are() {
        let mut rng = Rng::new(1);
        let mut random = || rng.next_u32();
        for case in 0..5000 {
            let way = (random() % 200) as i32;
            let q = [random(), random()].map(|q| ((q >> 1 >> (random() % 9)) | 1 << 22) as i32);
            // |d q| goes up to q / 8 at both ends.
            let corner = Perspective::<2, 3>::ZERO;
            let mut primitive = Primitive::constant(corner, 0, Side::Front, ());
            let ends = [0, 1].map(|_| q.map(|q| ((i64::from(random() as i32) * i64::from(q)) >> 34) as i32));
            let per_pixel = |a: i32, b: i32| (b - a) / way.max(1);
            primitive.at_origin.as_mut().copy_from_slice(&[ends[0][0], ends[1][0], q[0]]);
            let changes = [per_pixel(ends[0][0], ends[0][1]), per_pixel(ends[1][0], ends[1][1]), per_pixel(q[0], q[1])];
            primitive.d_dx.as_mut().copy_from_slice(&changes);
            let affine = case % 8 == 0;
            if let Some((class, _, planes)) = primitive.perspective.parts_mut() {
                *class = if affine { PerspectiveClass::Affine } else { PerspectiveClass::Planes32 };
                for plane in planes {
                    (plane.base, plane.shift) = (random() as i32 >> 4, random() % 29);
                }
            }
            let mut exact = Corrected::new(&primitive, (0, 0));
            let mut stepper = UvStepper::new(&primitive, (0, 0), way);
            stepper.next_run();
            let check = |stepper: &UvStepper, exact: &Corrected<'_, Perspective<2, 3>>| {
                let (found, expected) = ([stepper.uv.0, stepper.uv.1], exact.varyings().corrected());
                for ((found, expected), plane) in found.iter().zip(expected).zip(primitive.perspective.planes()) {
                    let quotient = i64::from(expected - plane.base).abs();
                    let bound = if affine { 0 } else { (quotient >> 18) + (200 >> plane.shift) + 1 };
                    let off = (i64::from(*found) - i64::from(expected)).abs();
                    assert!(off <= bound, "{case}: {off} units, not {bound}");
                }
            };
            check(&stepper, &exact);
            for _ in 0..way / STEP as i32 {
                stepper.next_run();
                exact.advance(STEP as i32);
                check(&stepper, &exact);
            }
            stepper.last((way % STEP as i32) as usize);
            exact.advance(way % STEP as i32);
            check(&stepper, &exact);
        }
    }
}
