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
//! 1. **Coordinates are divided every 16 pixels**, or at another [step](crate::span::Shader::STEP), at columns of the
//!    screen that are multiples of it. In between u and v are linear, both in one word:
//!
//!    ```text
//!    bits   31 .. 16   15 .. 0
//!              v          u        fractions of the texture; a carry from u adds 2⁻¹⁶ to v
//!    ```
//!    Steps are rounded to 2⁻¹⁶, so a pixel of a run is off by at most 2⁻¹³.
//! 2. **Runs of 16 pixels are drawn in two passes** on small cores, first depths and then texels. Each pass has its
//!    values in registers: 33.5 → 31.3.
//! 3. **q, u q and v q are normalized once per span**, and the word and the step of a run are computed out of line:
//!    30.6 → 29.0 and 20.7 → 20.2.
//! 4. **Texels of a run are fetched out of line**, and the last pixels of a span are drawn in two passes too: 29.0 →
//!    27.3.
//! 5. **Dividing takes two instructions, and scaling too**, where the core has long products: 19.7 → 18.9 on a
//!    Cortex-M4.
//! 6. **One comparison tells that a span is straight**, its stepper is written once, runs of 16 pixels come one after
//!    another, and the colours of shorter ones are unrolled: 31.1 → 28.9 and 22.3 → 21.4.

use super::depth::{DepthTest, RUN, count_passing_prefix, untested_short_tail};
use super::perspective::{MOST_STRAIGHT, is_straight, longest_log_step};
use super::span::{Primitive, Span};
use crate::color::PixelFormat;
use crate::math::{CoarseDivisor, SMALL_CORE};
use crate::texture::Texture;
use crate::vertex::{PerspectiveClass, PerspectivePlane, PerspectiveSetup, Varyings};

/// Number of pixels from one division to the next, unless another one is chosen.
pub(crate) const STEP: usize = RUN;

/// Draws a span of a repeating texture. The first two varyings are u and v in 16.16. The stepper is that of the span.
#[inline(never)]
pub(crate) fn texture_span<P: PixelFormat, T: Texture, D: DepthTest, V: Varyings, U>(
    texture: &T,
    span: Span<'_, P, V, U, D::Depth>,
    test: D,
    stepper: &mut UvStepper,
) {
    let Span { color, depth, z, .. } = span;
    let length = color.len().min(depth.len());
    let Some(mut color) = color.get_mut(..length) else { return };
    let Some(mut depth) = depth.get_mut(..length) else { return };
    stepper.z = z;
    // Moves on to the first column. The first run may begin between two of them.
    stepper.next_run();
    let step = 1 << (stepper.log_step & 31);
    let mut short = (step - stepper.back as usize) & (step - 1);
    loop {
        if short > 0 {
            let pixels = short.min(color.len());
            let Some((colors, rest)) = core::mem::take(&mut color).split_at_mut_checked(pixels) else { return };
            color = rest;
            let Some((depths, rest)) = core::mem::take(&mut depth).split_at_mut_checked(pixels) else { return };
            depth = rest;
            short_run::<P, T, D>(texture, test, stepper, colors, depths);
        }
        // The last run may end between two columns. Runs of another length than 16 are all drawn above.
        short = step;
        if step == RUN {
            let whole = color.len() / RUN * RUN;
            let Some((colors, rest)) = core::mem::take(&mut color).split_at_mut_checked(whole) else { return };
            color = rest;
            let Some((depths, rest)) = core::mem::take(&mut depth).split_at_mut_checked(whole) else { return };
            depth = rest;
            for (colors, depths) in colors.chunks_exact_mut(RUN).zip(depths.chunks_exact_mut(RUN)) {
                let (Ok(colors), Ok(depths)) = (colors.try_into(), depths.try_into()) else { return };
                if SMALL_CORE && T::IS_OPAQUE {
                    whole_run_in_two_passes::<P, T, D>(texture, test, stepper, colors, depths);
                } else {
                    whole_run_in_one_pass::<P, T, D>(texture, test, stepper, colors, depths);
                }
            }
        }
        if color.is_empty() {
            return;
        }
    }
}

/// Draws a run of 16 pixels of an opaque texture, first depths and then colours. Each loop has all of its values in
/// registers.
#[inline(always)]
fn whole_run_in_two_passes<P: PixelFormat, T: Texture, D: DepthTest>(
    texture: &T,
    test: D,
    stepper: &mut UvStepper,
    colors: &mut [P::Raw; RUN],
    depths: &mut [D::Depth; RUN],
) {
    let passed = count_passing_prefix(test, depths, stepper.z, stepper.dz_dx);
    let (vu, step) = stepper.next_run();
    if passed == RUN {
        color_run16::<P, T>(texture, colors, vu, step);
        stepper.z = stepper.z.wrapping_add_signed(stepper.dz_dx.wrapping_mul(RUN as i32));
    } else {
        partial::<P, T, D>(texture, test, stepper, (vu, step), passed, colors, depths);
    }
}

/// Draws a run of 16 pixels, pixel by pixel. Out of line: the word and the step of the run take all registers.
#[inline(never)]
fn whole_run_in_one_pass<P: PixelFormat, T: Texture, D: DepthTest>(
    texture: &T,
    test: D,
    stepper: &mut UvStepper,
    colors: &mut [P::Raw; RUN],
    depths: &mut [D::Depth; RUN],
) {
    let (vu, step) = stepper.next_run_on::<SMALL_CORE, true>();
    let mut cursor = TexelCursor { z: stepper.z, dz_dx: stepper.dz_dx, vu, step };
    cursor.run16::<P, T, D>(texture, test, colors, depths);
    stepper.z = cursor.z;
}

/// Draws a run of fewer than 16 pixels, or of another length. Out of line, because a span has two of them.
#[inline(never)]
fn short_run<P: PixelFormat, T: Texture, D: DepthTest>(
    texture: &T,
    test: D,
    stepper: &mut UvStepper,
    colors: &mut [P::Raw],
    depths: &mut [D::Depth],
) {
    let pixels = colors.len();
    let Some(depths) = depths.get_mut(..pixels) else { return };
    let (mut vu, step) = stepper.next_run();
    // Only the first run may begin between two columns.
    vu = vu.wrapping_add(step.wrapping_mul(core::mem::take(&mut stepper.back)));
    if SMALL_CORE && T::IS_OPAQUE {
        short_run_in_two_passes::<P, T, D>(texture, test, stepper, (vu, step), colors, depths);
    } else if SMALL_CORE {
        partial::<P, T, D>(texture, test, stepper, (vu, step), 0, colors, depths);
    } else {
        let mut cursor = TexelCursor { z: stepper.z, dz_dx: stepper.dz_dx, vu, step };
        cursor.tail::<P, T, D>(texture, test, colors, depths);
        stepper.z = cursor.z;
    }
}

/// Draws a run of an opaque texture, first depths and then colours, if it is shorter than 16 pixels.
#[inline(always)]
fn short_run_in_two_passes<P: PixelFormat, T: Texture, D: DepthTest>(
    texture: &T,
    test: D,
    stepper: &mut UvStepper,
    (vu, step): (u32, u32),
    colors: &mut [P::Raw],
    depths: &mut [D::Depth],
) {
    let (pixels, mut passed) = (colors.len(), 0);
    if pixels < RUN {
        passed = pixels.saturating_sub(untested_short_tail(test, depths, stepper.z, stepper.dz_dx));
        if passed == pixels {
            color_short::<P, T>(texture, colors, vu, step);
            stepper.z = stepper.z.wrapping_add_signed(stepper.dz_dx.wrapping_mul(pixels as i32));
            return;
        }
    }
    partial::<P, T, D>(texture, test, stepper, (vu, step), passed, colors, depths);
}

/// Draws a run; its first `passed` depths have passed already, and are stored.
#[inline(never)]
fn partial<P: PixelFormat, T: Texture, D: DepthTest>(
    texture: &T,
    test: D,
    stepper: &mut UvStepper,
    (vu, step): (u32, u32),
    passed: usize,
    colors: &mut [P::Raw],
    depths: &mut [D::Depth],
) {
    let Some((first, colors)) = colors.split_at_mut_checked(passed) else { return };
    let Some(depths) = depths.get_mut(passed..) else { return };
    color_short::<P, T>(texture, first, vu, step);
    let vu = vu.wrapping_add(step.wrapping_mul(passed as u32));
    let z = stepper.z.wrapping_add_signed(stepper.dz_dx.wrapping_mul(passed as i32));
    let mut cursor = TexelCursor { z, dz_dx: stepper.dz_dx, vu, step };
    cursor.tail::<P, T, D>(texture, test, colors, depths);
    stepper.z = cursor.z;
}

/// Colours pixels, and steps the word to the pixel after them. Unrolled by hand: at `opt-level = "s"` a loop would stay
/// a loop.
macro_rules! color {
    ($texture:ident, $vu:ident, $step:ident, $($color:ident)*) => {
        $(
            // Steps first: the fetch may then overwrite the old word, which need not be copied.
            let here = $vu;
            $vu = $vu.wrapping_add($step);
            if let Some(pixel) = $texture.fetch::<P>(here) {
                *$color = pixel;
            }
        )*
    };
}

/// Colours a run of 16 pixels.
#[inline(never)]
fn color_run16<P: PixelFormat, T: Texture>(texture: &T, colors: &mut [P::Raw; RUN], mut vu: u32, step: u32) {
    let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = colors;
    color!(texture, vu, step, a b c d e f g h i j k l m n o p);
    let _ = vu;
}

/// Colours fewer pixels than a run has.
#[inline(never)]
fn color_short<P: PixelFormat, T: Texture>(texture: &T, mut colors: &mut [P::Raw], mut vu: u32, step: u32) {
    macro_rules! color_first {
        ($($color:ident)*) => {
            let Some(([$($color),*], rest)) = core::mem::take(&mut colors).split_first_chunk_mut() else { return };
            colors = rest;
            color!(texture, vu, step, $($color)*);
        };
    }
    if colors.len() >= 8 {
        color_first!(a b c d e f g h);
    }
    if colors.len() >= 4 {
        color_first!(a b c d);
    }
    if colors.len() >= 2 {
        color_first!(a b);
    }
    if !colors.is_empty() {
        color_first!(a);
    }
    let _ = (colors, vu);
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
#[derive(Clone, Copy)]
struct TexelCursor {
    z: u32,
    dz_dx: i32,
    vu: u32,
    step: u32,
}

impl TexelCursor {
    /// Draws a run pixel by pixel.
    #[inline(always)]
    fn run16<P: PixelFormat, T: Texture, D: DepthTest>(
        &mut self,
        texture: &T,
        test: D,
        colors: &mut [P::Raw; RUN],
        depths: &mut [D::Depth; RUN],
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
        &mut self,
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
///
/// The order of the fields decides which of them the compiler loads too early, and then keeps on the stack.
#[derive(Debug)]
#[repr(C)]
pub(crate) struct UvStepper {
    u: Scale,
    /// u and v at the stepper's position.
    uv: (i32, i32),
    v: Scale,
    /// q, d q of u and d q of v at the stepper's position, and their changes over the next run.
    at: [i32; 3],
    step: [i32; 3],
    /// Number of pixels to the left of the first pixel, up to the column that is divided.
    back: u32,
    /// Binary logarithm of the number of pixels between two columns that are divided.
    log_step: u32,
    /// Number of pixels of the span to the left of the first one, and number of those that are drawn.
    before: usize,
    length: usize,
    /// Depth at the next pixel, and its change per pixel. The stepper keeps them in memory for the loops, and does not
    /// use them itself.
    z: u32,
    dz_dx: i32,
}

impl UvStepper {
    /// A stepper that is nowhere.
    pub(crate) const EMPTY: Self = Self {
        at: [0; 3],
        step: [0; 3],
        uv: (0, 0),
        u: Scale::EMPTY,
        v: Scale::EMPTY,
        back: 0,
        log_step: 0,
        before: 0,
        length: 0,
        z: 0,
        dz_dx: 0,
    };

    /// Returns the binary logarithm of the step to begin the spans of a primitive with, where a shader asks for `step`;
    /// 0 if a stepper can draw none of them: it has no planes of 64 bits, and divides at columns that are apart.
    #[inline(always)]
    pub(crate) fn log_step<V: Varyings, U>(primitive: &Primitive<V, U>, step: usize) -> u32 {
        match primitive.perspective.class() {
            PerspectiveClass::Planes64 => 0,
            _ => longest_log_step::<V>(&primitive.perspective, step),
        }
    }

    /// Returns a stepper for the pixels of a span that [`texture_span`] can draw, one step before their first column.
    /// The stepper knows [how many](Self::length) they are, and how many pixels the span has [before](Self::before)
    /// them.
    /// Those that can be drawn lie between columns over which coordinates are straight enough
    /// ([`straight_log_step`](super::perspective::straight_log_step)). As q is linear, they lie side by side.
    ///
    /// Columns are 1 << `log_step` pixels apart. This is 1 << `halvings` times less than [`log_step`](Self::log_step)
    /// says, which must not be 0.
    #[inline(never)]
    pub(crate) fn begin<V: Varyings, U>(
        primitive: &Primitive<V, U>,
        position: (i32, i32),
        length: usize,
        log_step: u32,
        halvings: u32,
    ) -> Self {
        Self::begin_on::<SMALL_CORE, V, U>(primitive, position, length, log_step, halvings)
    }

    /// Does as [`begin`](Self::begin), for a small core or another one.
    #[inline(always)]
    fn begin_on<const SMALL: bool, V: Varyings, U>(
        primitive: &Primitive<V, U>,
        (x, y): (i32, i32),
        mut length: usize,
        log_step: u32,
        halvings: u32,
    ) -> Self {
        let perspective = &primitive.perspective;
        let least = perspective.least_straight() >> halvings;
        let value = |values: &[i32], k: usize| values.get(k).copied().unwrap_or(0);
        let last = |values: &[i32]| values.last().copied().unwrap_or(0);
        let change = primitive.d_dx.as_ref();
        let (mut dq, du, dv) = (last(change), value(change, 0), value(change, 1));
        // Columns that are divided, on both sides of the span. q is in 0..2³¹ within the span, and changes by less than
        // 2²⁸ up to them.
        let mut back = x & ((1 << log_step) - 1);
        let first = x.wrapping_sub(back);
        let steps = ((back.wrapping_add(length as i32) - 1) >> log_step) + 1;
        let mut at = primitive.at((first, y));
        let mut ends = [last(at.as_ref()), last(at.as_ref()).wrapping_add(dq.wrapping_mul(steps << log_step))];
        let mut before = 0;
        // `is_straight` at both ends, in one comparison: `least` is below 2³¹.
        let above = |q: i32| (q as u32).wrapping_sub(least);
        if above(ends[0]).max(above(ends[1])) >= MOST_STRAIGHT.wrapping_sub(least) {
            // Leaves out steps at the ends, as far as they are bent.
            let (skipped, left) = straight_steps(ends, steps, dq << log_step, least);
            if left <= 0 {
                return Self::EMPTY;
            }
            let (skipped, end) = (skipped << log_step, (skipped + left) << log_step);
            let past = end.min(back.wrapping_add(length as i32));
            let begin = back.max(skipped);
            (before, length) = (begin.wrapping_sub(back) as usize, past.wrapping_sub(begin) as usize);
            back = begin.wrapping_sub(skipped);
            at.advance(&primitive.d_dx, skipped);
            ends = [last(at.as_ref()), last(at.as_ref()).wrapping_add(dq.wrapping_mul(left << log_step))];
        }
        let planes = perspective.planes();
        let at = at.as_ref();
        let [mut q, to] = ends;
        let mut most = (q as u32).max(to as u32) | 1;
        let mut shift = 0;
        if SMALL {
            // Takes a few rounds, and fewer instructions than `leading_zeros` does with its table.
            while most >> 31 == 0 {
                (most, shift) = (most << 1, shift + 1);
            }
        } else {
            shift = most.leading_zeros();
        }
        if perspective.class() == PerspectiveClass::Affine {
            (q, dq, shift) = (0, 0, 0);
        }
        let up = |value: i32| value << (shift & 31);
        let over = |change: i32| change << ((shift + log_step) & 31);
        let step = [over(dq), over(du), over(dv)];
        let [du, dv] = [up(value(at, 0)), up(value(at, 1))];
        Self {
            at: [up(q).wrapping_sub(step[0]), du.wrapping_sub(step[1]), dv.wrapping_sub(step[2])],
            step,
            uv: (0, 0),
            u: Scale::new::<SMALL>(planes.first()),
            v: Scale::new::<SMALL>(planes.get(1)),
            back: back as u32,
            log_step,
            before,
            length,
            z: 0,
            dz_dx: primitive.dz_dx,
        }
    }

    /// Returns the number of pixels of the span before those that the stepper is for.
    #[inline(always)]
    pub(crate) fn before(&self) -> usize {
        self.before
    }

    /// Returns the number of pixels of the span that the stepper is for.
    #[inline(always)]
    pub(crate) fn length(&self) -> usize {
        self.length
    }

    /// Computes u and v at the stepper's position.
    #[inline(always)]
    fn divided<const SMALL: bool>(&self) -> (i32, i32) {
        let [q, mut u, mut v] = self.at;
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
            let q = CoarseDivisor::of_normalized::<SMALL>(q);
            (q.divide_normalized::<SMALL>(u), q.divide_normalized::<SMALL>(v))
        };
        (self.u.scaled::<SMALL>(u), self.v.scaled::<SMALL>(v))
    }

    /// Moves on by one run, and returns the word and the step with which that run is drawn, from its first column on.
    /// Out of line: it has more values than the loop around it has registers for.
    #[inline(never)]
    fn next_run(&mut self) -> (u32, u32) {
        self.next_run_on::<SMALL_CORE, false>()
    }

    /// Does as [`next_run`](Self::next_run), for a small core or another one. `WHOLE` says that runs have 16 pixels.
    #[inline(always)]
    fn next_run_on<const SMALL: bool, const WHOLE: bool>(&mut self) -> (u32, u32) {
        let [q, u, v] = self.at;
        let [dq, du, dv] = self.step;
        self.at = [q.wrapping_add(dq), u.wrapping_add(du), v.wrapping_add(dv)];
        let (from, to) = (self.uv, self.divided::<SMALL>());
        self.uv = to;
        let log_step = if WHOLE { RUN.trailing_zeros() } else { self.log_step & 31 };
        let half = 1 << log_step >> 1;
        let per_pixel = |from: i32, to: i32| to.wrapping_sub(from).wrapping_add(half) >> log_step;
        (packed(from), step([per_pixel(from.0, to.0), per_pixel(from.1, to.1)]))
    }
}

/// Returns the number of steps to leave out before the straight ones of a span, and the number of the straight ones.
/// q is given at both `ends` of `steps` steps, and changes by `change` over one.
#[cold]
#[inline(never)]
fn straight_steps([mut from, mut to]: [i32; 2], steps: i32, change: i32, least: u32) -> (i32, i32) {
    let (mut skipped, mut left) = (0, steps);
    while left > 0 && !is_straight(from as u32, least) {
        (skipped, left, from) = (skipped + 1, left - 1, from.wrapping_add(change));
    }
    while left > 0 && !is_straight(to as u32, least) {
        (left, to) = (left - 1, to.wrapping_sub(change));
    }
    (skipped, left)
}

/// Scale that takes a coordinate from its interpolated form h back to 16.16.
#[derive(Debug)]
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
    const EMPTY: Self = Self { half: 0, by: 0, base: 0 };

    #[inline(always)]
    fn new<const SMALL: bool>(plane: Option<&PerspectivePlane>) -> Self {
        let (base, shift) = plane.map_or((0, 0), |plane| (plane.base, plane.shift & 31));
        if SMALL {
            Self { half: (1 << shift) >> 1, by: shift as i32, base }
        } else {
            Self { half: 2 << shift & !3, by: 1 << 30 >> shift, base }
        }
    }

    /// Scales `h` back and adds the base, rounded to nearest.
    ///
    /// # Format
    /// |`h`| is below 2²⁹, because d q is below 3/16 q, and without perspective below 2²⁶ + 2²⁸; shifts are at most 26.
    #[inline(always)]
    fn scaled<const SMALL: bool>(&self, h: i32) -> i32 {
        if SMALL {
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
        let scale = || Scale::new::<SMALL_CORE>(None);
        let (at, step) = ([0, u, v], [0, du, dv]);
        UvStepper { at, step, uv: (u, v), u: scale(), v: scale(), log_step: 4, ..UvStepper::EMPTY }
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
            let begun = || UvStepper { z, dz_dx, ..stepper(uv, duv) };
            let mut cursor = TexelCursor { z, dz_dx, vu, step };
            let pixel = |k: usize| tile.fetch::<Rgb565>(vu.wrapping_add(step.wrapping_mul(k as u32)));
            let case = naive::Case { length: RUN, z, dz_dx, background: 0x1234_u16 };
            naive::compare(
                test,
                case,
                &mut rng,
                &stored,
                pixel,
                &mut [
                    ("a run in one pass", &mut |color, depth| {
                        let (Ok(color), Ok(depth)) = (color.try_into(), depth.try_into()) else { return };
                        whole_run_in_one_pass::<Rgb565, _, D>(tile, test, &mut begun(), color, depth);
                    }),
                    ("a run in two passes", &mut |color, depth| {
                        let (Ok(color), Ok(depth)) = (color.try_into(), depth.try_into()) else { return };
                        whole_run_in_two_passes::<Rgb565, _, D>(tile, test, &mut begun(), color, depth);
                    }),
                ],
            );
            let case = naive::Case { length: rng.below(RUN as u64 + 1) as usize, ..case };
            naive::compare(
                test,
                case,
                &mut rng,
                &stored,
                pixel,
                &mut [
                    ("a tail", &mut |color, depth| cursor.tail::<Rgb565, _, D>(tile, test, color, depth)),
                    ("a short run", &mut |color, depth| {
                        short_run::<Rgb565, _, D>(tile, test, &mut begun(), color, depth);
                    }),
                    ("a short run in two passes", &mut |color, depth| {
                        let word = (vu, step);
                        short_run_in_two_passes::<Rgb565, _, D>(tile, test, &mut begun(), word, color, depth);
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

    /// Makes a primitive of two coordinates, as extreme as a stepper takes them: the greatest differences, the greatest
    /// change of q over a run, and bases from all over the numbers. Returns the pixels of a span, too.
    fn extreme(rng: &mut Rng, log_step: u32) -> (Primitive<Perspective<2, 3>>, i32, usize) {
        let mut random = || rng.next_u32();
        let (x, length) = ((random() % 300) as i32, 1 + (random() % 200) as usize);
        let affine = random() % 8 == 0;
        let mut primitive = Primitive::constant(Perspective::<2, 3>::ZERO, 0, Side::Front, ());
        let ends = [x, x + length as i32 - 1];
        // q within a factor of 2⁹ over the span, or nearly constant.
        let spread = if affine { 0 } else { random() % 10 };
        let q = [0, 1].map(|_| (1 << 30 | random() >> 2) >> random().checked_rem(spread + 1).unwrap_or(0));
        let q = if affine { [q[0] | 1 << 30; 2] } else { q };
        let way = (ends[1] - ends[0]).max(1);
        let dq = ((i64::from(q[1]) - i64::from(q[0])) / i64::from(way)) as i32;
        // d q is at most a thirty-second of q at both ends of the span, and changes as much as that allows.
        let least = ((q[0].min(q[1]) / 2) >> (log_step + 3)) as i32;
        let mut along = || {
            let mut end = |q: u32| ((i64::from(random() as i32) * i64::from(q)) >> 36) as i32;
            let [from, to] = q.map(&mut end);
            if length == 1 {
                (from, end(least as u32 * 32))
            } else {
                (from, ((i64::from(to) - i64::from(from)) / i64::from(way)) as i32)
            }
        };
        let (u, v) = (along(), along());
        primitive.d_dx.as_mut().copy_from_slice(&[u.1, v.1, dq]);
        let origin = |at: i32, change: i32| at.wrapping_sub(change.wrapping_mul(x));
        let (u, v) = (origin(u.0, u.1), origin(v.0, v.1));
        primitive.at_origin.as_mut().copy_from_slice(&[u, v, origin(q[0] as i32, dq)]);
        if let Some((class, _, planes)) = primitive.perspective.parts_mut() {
            *class = if affine { PerspectiveClass::Affine } else { PerspectiveClass::Planes32 };
            for plane in planes {
                (plane.base, plane.shift) = (random() as i32, 1 + random() % 26);
            }
        }
        let most = primitive.d_dx.as_ref().iter().map(|change| change.unsigned_abs()).max().unwrap_or(0);
        let fits = most >> (28 - log_step) == 0;
        primitive.perspective.set_least_straight(if fits { most << (log_step + 3) } else { u32::MAX });
        (primitive, x, length)
    }

    /// Returns the number of divided steps that a span is a part of.
    fn runs(x: i32, length: usize, log_step: u32) -> i32 {
        ((x + length as i32 - 1) >> log_step) - (x >> log_step) + 1
    }

    /// Both kinds of core step and divide alike, bit by bit, at any value that a stepper takes.
    #[test]
    fn small_cores_and_others_have_the_same_words() {
        let mut rng = Rng::new(14);
        let mut begun = 0;
        for case in 0..200_000 {
            let log_step = 1 + case % 5;
            let (primitive, x, length) = extreme(&mut rng, log_step);
            if UvStepper::log_step(&primitive, 1 << log_step) == 0 {
                continue;
            }
            let mut small = UvStepper::begin_on::<true, _, _>(&primitive, (x, 0), length, log_step, 0);
            let mut other = UvStepper::begin_on::<false, _, _>(&primitive, (x, 0), length, log_step, 0);
            assert_eq!((small.length, small.before), (other.length, other.before), "{case}");
            if other.length > 0 {
                begun += 1;
                let mut whole = UvStepper::begin_on::<false, _, _>(&primitive, (x, 0), length, log_step, 0);
                // One more: steppers begin a step before the first column.
                for _ in 0..=runs(x + small.before as i32, other.length, log_step) {
                    let word = other.next_run_on::<false, false>();
                    assert_eq!(small.next_run_on::<true, false>(), word, "{case}: {primitive:?}");
                    if 1 << log_step == RUN {
                        assert_eq!(whole.next_run_on::<false, true>(), word, "{case}: {primitive:?}");
                    }
                }
            }
        }
        assert!(begun > 50_000, "{begun}");
    }

    #[test]
    fn steppers_are_where_divisors_are() {
        let mut rng = Rng::new(1);
        let mut begun = 0;
        for case in 0..20_000 {
            let log_step = 1 + case % 5;
            let (primitive, x, length) = extreme(&mut rng, log_step);
            if UvStepper::log_step(&primitive, 1 << log_step) == 0 {
                continue;
            }
            let mut stepper = UvStepper::begin(&primitive, (x, 0), length, log_step, 0);
            let (x, length) = (x + stepper.before as i32, stepper.length);
            if length == 0 {
                continue;
            }
            stepper.next_run();
            begun += 1;
            let first = x >> log_step << log_step;
            let mut exact = Corrected::new(&primitive, (first, 0));
            for _ in 0..runs(x, length, log_step) {
                let (found, expected) = ([stepper.uv.0, stepper.uv.1], exact.varyings().corrected());
                for ((found, expected), plane) in found.iter().zip(expected).zip(primitive.perspective.planes()) {
                    let quotient = i64::from(expected.wrapping_sub(plane.base)).abs();
                    let bound = (quotient >> 18) + (200 >> plane.shift) + 1;
                    let off = i64::from(found.wrapping_sub(expected)).abs();
                    assert!(off <= bound, "{case}: {off} units, not {bound}");
                }
                stepper.next_run();
                exact.advance(1 << log_step);
            }
        }
        assert!(begun > 5_000, "{begun}");
    }
}
