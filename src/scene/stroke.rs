//! Strokes: a line on the screen → pixels.
//!
//! Lines come in with their ends in 24.8 px, and with the varyings there; only pixels of the painter's clip rectangle
//! are written. Each stroke is a type, so that a program links only the strokes that it uses.

use super::painter::{Painter, RasterHooks};
use crate::color::PixelFormat;
use crate::math::Pixels;
use crate::raster::{Along, Line, LinePixels, PixelRect, homogenize, unit, widen_along};
use crate::span::{
    Corrected, DepthDyn, DepthLess, DepthOff, DepthState, DepthTest, Fragment, Primitive, Sample, Shader, Span, SpanOf,
    TriangleSetup,
};
use crate::target::Framebuffer;
use crate::vertex::{PerspectiveSetup, ScreenVertex, Side, Varyings, VertexShader, Wrapper};

/// Style in which lines are drawn: [`Thin`], [`Dashed`], [`Thick`] or [`Smooth`].
///
/// No other type can implement it: the trait that it extends is private. So the painter, which that trait draws with,
/// need not be public either.
#[expect(private_bounds, reason = "seals the trait")]
pub trait Stroke: DrawStroke {}

/// Draws lines in the style of a stroke.
pub(super) trait DrawStroke: Sized {
    /// Returns how far from the line its pixels may be, in whole pixels.
    fn reach(&self) -> i32;

    /// Returns the stroke for the rest of a line, of which `pixels` pixels along its longer axis were cut off.
    #[must_use]
    fn after(&self, pixels: u32) -> Self;

    /// Draws a line.
    fn draw<F: Framebuffer, S: Shader<F::Format>>(
        &self,
        painter: &mut Painter<'_, '_, F, S>,
        ends: &[(ScreenVertex, S::Varyings); 2],
        flat: u32,
    );
}

/// Draws lines one pixel wide, by the diamond-exit rule: one pixel for each step along the longer axis, exactly those
/// that OpenGL and Vulkan draw. A line does not draw the pixel that it ends in: so lines in a chain draw the pixel of
/// each joint once, and a line that begins and ends in one place draws nothing. [`Scene::canvas`](crate::Scene::canvas)
/// has a `point` for a single pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Thin;

/// Draws lines one pixel wide, with a pattern that begins anew with each line. Bit k says whether the pixels k, k + 32,
/// k + 64 ... of the line are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dashed(pub u32);

impl Dashed {
    /// Draws four pixels, and leaves four out.
    pub const EVEN: Self = Self(0x0F0F_0F0F);
    /// Draws every other pixel.
    pub const DOTTED: Self = Self(0x5555_5555);
}

/// Draws a line as a rectangle along it, with ends cut straight. The corners are rounded to 1/256 px, and the rectangle
/// is drawn as exactly as any two triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Thick(u32);

/// Draws a line as [`Thick`] does, but smoothly, in any width down to parts of a pixel. A pixel is covered as much as
/// the line covers a box of one pixel around its centre, and is blended accordingly with what is there.
///
/// A pixel that is covered by less than 1/256 is left as it is, with its depth. Every other pixel gets the colour that
/// the shader's [`paint`](Shader::paint) gives it, as far as it is covered, and the whole depth.
///
/// Draw it after everything that is farther away. Consider not to write depths: a pixel at the rim hides later draws as
/// much as a pixel inside does. Colours and depths are stretched, so that they reach half a pixel beyond either end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Smooth(u32);

/// Width of the widest line, 2048 px in 24.8.
const WIDEST: u32 = 1 << 19;

/// Returns a width in 24.8 px, clamped to 0..=[`WIDEST`].
const fn width_bits(width: Pixels) -> u32 {
    match width.to_bits() {
        ..0 => 0,
        bits if bits as u32 > WIDEST => WIDEST,
        bits => bits as u32,
    }
}

impl Thick {
    /// Creates a stroke of a width up to 2048 px. Larger widths become 2048 px, negative ones 0.
    #[must_use]
    pub const fn new(width: Pixels) -> Self {
        Self(width_bits(width))
    }

    /// Creates a stroke of a width in whole pixels.
    #[must_use]
    pub const fn px(width: u8) -> Self {
        Self((width as u32) << 8)
    }
}

impl Smooth {
    /// Creates a stroke of a width up to 2048 px. Larger widths become 2048 px, negative ones 0.
    #[must_use]
    pub const fn new(width: Pixels) -> Self {
        Self(width_bits(width))
    }

    /// Creates a stroke of a width in whole pixels.
    #[must_use]
    pub const fn px(width: u8) -> Self {
        Self((width as u32) << 8)
    }
}

impl Stroke for Thin {}
impl Stroke for Dashed {}
impl Stroke for Thick {}
impl Stroke for Smooth {}

impl DrawStroke for Thin {
    fn after(&self, _: u32) -> Self {
        *self
    }

    fn reach(&self) -> i32 {
        1
    }

    #[inline]
    fn draw<F: Framebuffer, S: Shader<F::Format>>(
        &self,
        painter: &mut Painter<'_, '_, F, S>,
        ends: &[(ScreenVertex, S::Varyings); 2],
        flat: u32,
    ) {
        thin::<F, S, false>(painter, ends, flat, 0);
    }
}

impl DrawStroke for Dashed {
    fn after(&self, pixels: u32) -> Self {
        Self(self.0.rotate_right(pixels & 31))
    }

    fn reach(&self) -> i32 {
        1
    }

    #[inline]
    fn draw<F: Framebuffer, S: Shader<F::Format>>(
        &self,
        painter: &mut Painter<'_, '_, F, S>,
        ends: &[(ScreenVertex, S::Varyings); 2],
        flat: u32,
    ) {
        thin::<F, S, true>(painter, ends, flat, self.0);
    }
}

/// Sets up a line one pixel wide, and draws it.
/// Draws the pixels of a line. All samples of a pixel are drawn alike.
fn thin<F: Framebuffer, S: Shader<F::Format>, const DASHED: bool>(
    painter: &mut Painter<'_, '_, F, S>,
    ends: &[(ScreenVertex, S::Varyings); 2],
    flat: u32,
    pattern: u32,
) {
    painter.each_sample(|painter, _| thin_at_sample::<F, S, DASHED>(painter, ends, flat, pattern));
}

#[inline(never)]
fn thin_at_sample<F: Framebuffer, S: Shader<F::Format>, const DASHED: bool>(
    painter: &mut Painter<'_, '_, F, S>,
    ends: &[(ScreenVertex, S::Varyings); 2],
    flat: u32,
    pattern: u32,
) {
    let [(a, from), (b, to)] = ends;
    let line = Line::new((a.x, a.y), (b.x, b.y));
    let (skipped, pixels) = line.pixels(painter.clip);
    if pixels.len() == 0 {
        return;
    }
    let along = Along::new(&line);
    let (z, dz) = along.value(i32::from(a.z), i32::from(b.z), 16);
    let mut perspective = <S::Varyings as Varyings>::PerspectiveSetup::NONE;
    let mut homogeneous;
    let [start, end] = if S::Varyings::PERSPECTIVE > 0 {
        // A line is a triangle that has its second end twice.
        homogeneous = [*from, *to, *to];
        homogenize(&mut homogeneous, &[*a, *b, *b], painter.screen, 1, &mut perspective);
        let [start, end, _] = &homogeneous;
        [start, end]
    } else {
        [from, to]
    };
    let (mut values, mut change) = (*start, S::Varyings::ZERO);
    for ((value, step), to) in values.as_mut().iter_mut().zip(change.as_mut()).zip(end.as_ref()) {
        let (start, change) = along.value(*value, *to, 0);
        (*value, *step) = (start as i32, change);
    }
    let shader = painter.shader;
    // The planes of a line change along its longer axis only. The shader is told the change from pixel to pixel of the
    // line.
    let primitive = |at_origin: S::Varyings, d_dx: S::Varyings, d_dy: S::Varyings| {
        let line = Primitive { d_dx: change, ..Primitive::constant(at_origin, flat, Side::Front, ()) };
        let setup = shader.setup(&TriangleSetup::new(&line, [from, to, to], 0, (a.x >> 8, a.y >> 8)));
        Primitive { dz_dx: dz, d_dx, d_dy, ..Primitive::constant(at_origin, flat, Side::Front, setup) }
    };
    // Both depths below include the bias and the half that rounds.
    let bias = painter.bias([a.z.min(b.z), a.z.max(b.z)], dz);
    let mut pixels = pixels;
    let (mut z, mut pattern) =
        (z.wrapping_add(bias), if DASHED { pattern.rotate_right(skipped & 31) } else { pattern });
    let mut on = skipped.wrapping_sub(along.origin()) as i32;
    if skipped < along.origin() {
        // The first pixel precedes the pixel `origin`, the first one that values are computed for. It gets the values
        // of the line's start.
        let first = primitive(*from, S::Varyings::ZERO, S::Varyings::ZERO);
        let z = (u32::from(a.z) << 16).wrapping_add(bias);
        let pixel = LinePixels { left: 1, ..pixels };
        draw_line::<F, S, DASHED>(painter, &LineRun { pixels: pixel, z, pattern, primitive: &first });
        pattern = pattern.rotate_right(1);
        // That pixel is drawn.
        let _ = pixels.next();
        on = 0;
    }
    z = z.wrapping_add_signed(dz.wrapping_mul(on));
    let (x, y) = pixels.position;
    let (mut d_dx, mut d_dy) = (S::Varyings::ZERO, S::Varyings::ZERO);
    d_dx.advance(&change, pixels.straight.0);
    d_dy.advance(&change, pixels.straight.1);
    widen_along((&line, &along), &[start.as_ref(), end.as_ref()], (&pixels, on), &mut perspective);
    values.advance(&change, on);
    values.advance(&d_dx, x.wrapping_neg());
    values.advance(&d_dy, y.wrapping_neg());
    let primitive = Primitive { perspective, ..primitive(values, d_dx, d_dy) };
    draw_line::<F, S, DASHED>(painter, &LineRun { pixels, z, pattern, primitive: &primitive });
}

impl<F: Framebuffer, S: Shader<F::Format>> Painter<'_, '_, F, S> {
    /// Returns what is added to depths in 16.16: the bias, and the half that rounds. The depths are between `nearest`
    /// and `farthest`, and change by `dz` from pixel to pixel.
    #[inline]
    fn bias(&self, [nearest, farthest]: [u16; 2], dz: i32) -> u32 {
        let bias = self.state.bias;
        let steps = if bias.is_none() { 0 } else { bias.steps(nearest..farthest, dz, 0) };
        (steps as u32) << 16 | 1 << 15
    }
}

/// Pixels of a line, and the values that are interpolated over them.
struct LineRun<'r, V: Varyings, T> {
    pixels: LinePixels,
    /// Depth at the first pixel, 16.16, with the half that rounds.
    z: u32,
    /// Pattern of a dashed line; its lowest bit is for the first pixel.
    pattern: u32,
    primitive: &'r Primitive<V, T>,
}

/// Draws pixels of a line, in a loop for each kind of depth test.
#[inline(never)]
fn draw_line<F: Framebuffer, S: Shader<F::Format>, const DASHED: bool>(
    painter: &mut Painter<'_, '_, F, S>,
    run: &LineRun<'_, S::Varyings, S::Setup>,
) {
    let test = painter.test();
    let sample = painter.target.selected();
    let Painter { target, screen, shader, .. } = painter;
    let (width, first_row) = (usize::from(screen.0), target.rows.start);
    let Some(colors) = target.framebuffer.rows(first_row as u32, width) else {
        return run.draw_spans::<F, S, DASHED>(painter);
    };
    let depths = &mut *target.depth;
    match test {
        DepthState::LESS => {
            run.draw::<F::Format, S, _, DASHED>(colors, depths, (width, first_row), (shader, sample), DepthLess);
        }
        DepthState::OFF => {
            let nothing = &mut [(); usize::MAX];
            run.draw::<F::Format, S, _, DASHED>(colors, nothing, (width, first_row), (shader, sample), DepthOff);
        }
        other => {
            run.draw::<F::Format, S, _, DASHED>(
                colors,
                depths,
                (width, first_row),
                (shader, sample),
                DepthDyn::new(other),
            );
        }
    }
}

impl<V: Varyings, T> LineRun<'_, V, T> {
    /// Draws all pixels, each as a span of its own, into rows that lie one after the other in memory.
    #[inline(always)]
    fn draw<P: PixelFormat, S: Shader<P, Varyings = V, Setup = T>, D: DepthTest, const DASHED: bool>(
        &self,
        colors: &mut [P::Raw],
        depths: &mut [D::Depth],
        (width, first_row): (usize, i32),
        (shader, sample): (&S, Sample),
        test: D,
    ) {
        let index = |(x, y): (i32, i32)| (y.wrapping_mul(width as i32)).wrapping_add(x) as usize;
        let LinePixels { mut position, straight, diagonal, mut error, height, length, left } = self.pixels;
        // Index of the pixel among colours and among depths. It is in range, as all pixels are in the strip.
        let mut at = index((position.0, position.1 - first_row));
        let (straight_at, diagonal_at) = (index(straight), index(diagonal));
        let Self { mut z, mut pattern, primitive, .. } = *self;
        for _ in 0..left {
            if !DASHED || pattern & 1 != 0 {
                if let (Some(color), Some(depth)) = (colors.get_mut(at), depths.get_mut(at)) {
                    let (color, depth) = (core::slice::from_mut(color), core::slice::from_mut(depth));
                    shader.span_at(sample, Span { color, depth, z, position, primitive }, test);
                }
            }
            let (mut step, mut step_at) = (straight, straight_at);
            error = error.wrapping_add(height);
            if error >= 0 {
                error = error.wrapping_sub(length);
                (step, step_at) = (diagonal, diagonal_at);
            }
            at = at.wrapping_add(step_at);
            position = (position.0.wrapping_add(step.0), position.1.wrapping_add(step.1));
            if DASHED {
                pattern = pattern.rotate_right(1);
            }
            z = z.wrapping_add_signed(primitive.dz_dx);
        }
    }

    /// Draws all pixels, each as a span of its own, into any framebuffer.
    fn draw_spans<F: Framebuffer, S: Shader<F::Format, Varyings = V, Setup = T>, const DASHED: bool>(
        &self,
        painter: &mut Painter<'_, '_, F, S>,
    ) {
        let (width, first_row) = (usize::from(painter.screen.0), painter.target.rows.start);
        let Self { pixels, mut z, mut pattern, primitive } = *self;
        let (test, sample) = (DepthDyn::new(painter.test()), painter.target.selected());
        for (x, y) in pixels {
            if !DASHED || pattern & 1 != 0 {
                let color = painter.target.framebuffer.span(y as u32, x as usize, 1);
                let at = width.wrapping_mul((y - first_row) as usize).wrapping_add(x as usize);
                // Without a depth buffer, every depth passes.
                let mut nowhere = 0;
                let depth = painter.target.depth.get_mut(at).unwrap_or(&mut nowhere);
                if let [color] = color {
                    let (color, depth) = (core::slice::from_mut(color), core::slice::from_mut(depth));
                    painter.shader.span_at(sample, Span { color, depth, z, position: (x, y), primitive }, test);
                }
            }
            pattern = pattern.rotate_right(1);
            z = z.wrapping_add_signed(primitive.dz_dx);
        }
    }
}

/// Computes the corners of a rectangle along a line: `half` to either side, and `more` beyond its ends, in 24.8 px.
///
/// # Format
/// For widths up to 2048 px, corners are within 1/256 px of the exact ones, apart from rounding. They are never farther
/// out than the rasterizer can take.
#[inline(never)]
fn rectangle(a: &ScreenVertex, b: &ScreenVertex, (u, v): (i32, i32), half: u32, more: u32) -> [ScreenVertex; 4] {
    // A product of 2.30 and 24.8, rounded.
    let times = |c: i32, length: u32| (crate::math::mul_high_signed(c, length << 3) + 1) >> 1;
    let (along, aside) = ((times(u, more), times(v, more)), (times(-v, half), times(u, half)));
    // An end whose corners would be out of range is moved inward, by four times `half + more`. That is enough at the
    // angles at which a line can come from such an end to the screen, and the line is far longer than that.
    const LIMIT: i32 = (1 << 23) - 1;
    let room = LIMIT - (half + more) as i32;
    let inward = (times(u, 4 * (half + more)), times(v, 4 * (half + more)));
    let moved = |p: &ScreenVertex, sign: i32| {
        let sign = if p.x.abs().max(p.y.abs()) > room { sign } else { 0 };
        (p.x + sign * inward.0, p.y + sign * inward.1)
    };
    let (from, to) = (moved(a, 1), moved(b, -1));
    let corner = |p: (i32, i32), z: u16, x: i32, y: i32| {
        ScreenVertex::new((p.0 + x).clamp(-LIMIT, LIMIT), (p.1 + y).clamp(-LIMIT, LIMIT), z)
    };
    [
        corner(from, a.z, -along.0 + aside.0, -along.1 + aside.1),
        corner(to, b.z, along.0 + aside.0, along.1 + aside.1),
        corner(to, b.z, along.0 - aside.0, along.1 - aside.1),
        corner(from, a.z, -along.0 - aside.0, -along.1 - aside.1),
    ]
}

/// Draws a rectangle as two triangles.
fn fill<F: Framebuffer, S: Shader<F::Format>>(
    painter: &mut Painter<'_, '_, F, S>,
    [a, b, c, d]: &[ScreenVertex; 4],
    [from, to]: [&S::Varyings; 2],
    flat: u32,
) {
    painter.triangle(&mut [*a, *b, *c], &mut [*from, *to, *to], flat);
    painter.triangle(&mut [*a, *c, *d], &mut [*from, *to, *from], flat);
}

impl DrawStroke for Thick {
    fn after(&self, _: u32) -> Self {
        *self
    }

    fn reach(&self) -> i32 {
        (self.0 >> 9) as i32 + 2
    }

    #[inline(never)]
    fn draw<F: Framebuffer, S: Shader<F::Format>>(
        &self,
        painter: &mut Painter<'_, '_, F, S>,
        ends: &[(ScreenVertex, S::Varyings); 2],
        flat: u32,
    ) {
        let [(a, from), (b, to)] = ends;
        let corners = rectangle(a, b, unit(b.x - a.x, b.y - a.y), self.0 / 2, 0);
        fill(painter, &corners, [from, to], flat);
    }
}

impl DrawStroke for Smooth {
    fn after(&self, _: u32) -> Self {
        *self
    }

    fn reach(&self) -> i32 {
        (self.0 >> 9) as i32 + 3
    }

    #[inline(never)]
    fn draw<F: Framebuffer, S: Shader<F::Format>>(
        &self,
        painter: &mut Painter<'_, '_, F, S>,
        ends: &[(ScreenVertex, S::Varyings); 2],
        flat: u32,
    ) {
        let [(a, from), (b, to)] = ends;
        let unit = unit(b.x - a.x, b.y - a.y);
        // Half a pixel more, and two units of 1/256 px for the rounding of the corners.
        let corners = rectangle(a, b, unit, self.0 / 2 + 130, 130);
        let coverage = Coverage::new(a, b, unit, self.0, painter.screen);
        let shader = Covered { shader: painter.shader, coverage };
        let Painter { target, screen, clip, state, .. } = painter;
        fill(
            &mut Painter { target, screen: *screen, clip, state, shader: &shader, hooks: &const { RasterHooks::ANY } },
            &corners,
            [from, to],
            flat,
        );
    }
}

/// Part of a pixel that a line covers: the overlap of the line with a box of 1 px, which is turned to the line.
///
/// As the box moves along the line, its overlap with the line's extent is a trapezoid; likewise across the line. The
/// covered part is the product of both.
struct Coverage {
    /// Distance from the line at the pixel `origin`, positive to the right of the line, in 12.20 px.
    distance: i32,
    /// Distance from the line's start at the pixel `origin`, measured along the line, in 16.16 px.
    way: i32,
    origin: (i32, i32),
    /// Changes of `distance` per pixel in x and in y, and those of `way`.
    step: [(i32, i32); 2],
    /// Distance at which the overlap across the line ends: half of the width and half a pixel, in 12.20 px.
    outer: i32,
    /// Largest overlap across the line, in 12.20 px.
    most: i32,
    /// Place at which the overlap along the line ends: the length and half a pixel, in 16.16 px.
    end: i32,
    /// Largest overlap along the line, in 16.16 px.
    longest: i32,
}

impl Coverage {
    /// Computes the coverage of a line from `a` to `b`, with the unit vector (u, v).
    ///
    /// # Format
    /// The unit vector is 2.30. Steps are off by 2⁻²¹ and 2⁻¹⁷ px. Over 320 pixels in x and in y, distances from the
    /// line are off by 2⁻¹¹ px, and those along the line by 2⁻⁷ px.
    #[inline(never)]
    fn new(a: &ScreenVertex, b: &ScreenVertex, (u, v): (i32, i32), width: u32, (w, h): (u16, u16)) -> Self {
        let origin = ((a.x >> 8).max(0).min(i32::from(w) - 1), (a.y >> 8).max(0).min(i32::from(h) - 1));
        let (x, y) = (i64::from(256 * origin.0 + 128 - a.x), i64::from(256 * origin.1 + 128 - a.y));
        let (u, v) = (i64::from(u), i64::from(v));
        let (dx, dy) = (i64::from(b.x - a.x), i64::from(b.y - a.y));
        // 24.8 times 2.30 has 38 fractional bits. Distances grow to the right of the line, as y points down.
        let (length, way) = ((u * dx + v * dy) >> 22, (u * x + v * y) >> 22);
        // Over the screen, both distances change by less than 6000 px. An end that is farther away than that has no
        // influence, so the distance to it may stop at 16,000 px.
        let stop = |way: i64| way.clamp(-16_000 << 16, 16_000 << 16) as i32;
        let step = |c: i64, down: u32| ((c >> (down - 1)) + 1) as i32 >> 1;
        Self {
            distance: ((u * y - v * x) >> 18) as i32,
            way: stop(way),
            origin,
            step: [(step(-v, 10), step(u, 10)), (step(u, 14), step(v, 14))],
            outer: (width << 11) as i32 + (1 << 19),
            most: (width << 12).min(1 << 20) as i32,
            end: stop(length - way) + stop(way) + (1 << 15),
            longest: length.min(1 << 16) as i32,
        }
    }
}

/// Wraps a shader so that its fragments cover their pixels in part.
struct Covered<'s, S> {
    shader: &'s S,
    coverage: Coverage,
}

impl<S: VertexShader> Wrapper for Covered<'_, S> {
    type Inner = S;

    fn inner(&self) -> &S {
        self.shader
    }
}

impl<P: PixelFormat, S: Shader<P>> Shader<P> for Covered<'_, S> {
    type Setup = S::Setup;

    #[inline(always)]
    fn setup(&self, triangle: &TriangleSetup<'_, S::Varyings>) -> S::Setup {
        self.shader.setup(triangle)
    }

    fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
        self.shader.fragment(fragment)
    }

    #[inline]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        self.span_at(Sample::ONLY, span, test);
    }

    #[inline]
    fn span_at<D: DepthTest>(&self, sample: Sample, span: SpanOf<'_, P, Self, D>, test: D) {
        let mut varyings = span.varyings();
        let Span { color, depth, mut z, mut position, primitive } = span;
        let Coverage { origin, step: [distance_step, way_step], outer, most, end, longest, .. } = self.coverage;
        let (x, y) = (position.0 - origin.0, position.1 - origin.1);
        let at = |base: i32, step: (i32, i32)| {
            base.wrapping_add(step.0.wrapping_mul(x)).wrapping_add(step.1.wrapping_mul(y))
        };
        let (mut distance, mut way) = (at(self.coverage.distance, distance_step), at(self.coverage.way, way_step));
        let Primitive { flat, side, dz_dx, ref setup, .. } = *primitive;
        let mut corrected = (S::Varyings::PERSPECTIVE > 0).then(|| Corrected::new(primitive, position));
        for (color, stored) in color.iter_mut().zip(depth) {
            if let Some(corrected) = &mut corrected {
                varyings = corrected.varyings();
                corrected.advance(1);
            }
            // Overlaps in 1.8.
            let across = outer.wrapping_sub(distance.wrapping_abs()).min(most) >> 12;
            let along = (way.wrapping_add(1 << 15)).min(end.wrapping_sub(way)).min(longest) >> 8;
            let depth = (z >> 16) as u16;
            // A pixel that is covered by less than 1/256 has no fragment, and keeps its depth.
            let part = if across > 0 && along > 0 { (across * along) >> 8 } else { 0 };
            if part > 0 && (!D::ENABLED || test.passes(depth, *stored)) {
                let fragment = Fragment { flat, varyings: &varyings, position, depth, side, setup };
                // A shader that blends does so with the pixel that is there.
                let mut painted = *color;
                if self.shader.paint_at(sample, &fragment, &mut painted) {
                    test.write(depth, stored);
                    *color = mix::<P>(*color, painted, part);
                }
            }
            position.0 = position.0.wrapping_add(1);
            distance = distance.wrapping_add(distance_step.0);
            way = way.wrapping_add(way_step.0);
            z = z.wrapping_add_signed(dz_dx);
            varyings.step(&primitive.d_dx);
        }
    }
}

/// Covers `under` with `over` to `part` / 256; each channel is rounded to nearest.
#[inline]
fn mix<P: PixelFormat>(under: P::Raw, over: P::Raw, part: i32) -> P::Raw {
    let ([r, g, b], [r1, g1, b1]) = (P::unpack(under), P::unpack(over));
    let channel = |c: u8, over: u8| {
        let c = i32::from(c);
        (c + (((i32::from(over) - c) * part + 128) >> 8)) as u8
    };
    P::pack([channel(r, r1), channel(g, g1), channel(b, b1)])
}

/// Draws the pixels of a rectangle, all with the same depth and varyings, and all samples of a pixel alike.
pub(super) fn block<F: Framebuffer, S: Shader<F::Format>>(
    painter: &mut Painter<'_, '_, F, S>,
    rect: &PixelRect,
    z: u16,
    varyings: &S::Varyings,
    flat: u32,
) {
    painter.each_sample(|painter, _| block_at_sample(painter, rect, z, varyings, flat));
}

#[inline(never)]
fn block_at_sample<F: Framebuffer, S: Shader<F::Format>>(
    painter: &mut Painter<'_, '_, F, S>,
    rect: &PixelRect,
    z: u16,
    varyings: &S::Varyings,
    flat: u32,
) {
    let rect = rect.intersection(painter.clip);
    if rect.is_empty() {
        return;
    }
    let point = Primitive::constant(*varyings, flat, Side::Front, ());
    let position = (rect.x.start, rect.y.start);
    let setup = painter.shader.setup(&TriangleSetup::new(&point, [varyings; 3], 0, position));
    let primitive = &Primitive::constant(*varyings, flat, Side::Front, setup);
    let (column, length) = (rect.x.start as usize, (rect.x.end - rect.x.start) as usize);
    let z = (u32::from(z) << 16).wrapping_add(painter.bias([z, z], 0));
    let (test, mut nothing, sample) = (painter.test(), [(); usize::MAX], painter.target.selected());
    for y in rect.y {
        let row = usize::from(painter.screen.0).wrapping_mul((y - painter.target.rows.start) as usize);
        let color = painter.target.framebuffer.span(y as u32, column, length);
        let position = (rect.x.start, y);
        if test == DepthState::OFF {
            let depth = nothing.get_mut(..color.len()).unwrap_or_default();
            painter.shader.span_at(sample, Span { color, depth, z, position, primitive }, DepthOff);
            continue;
        }
        let Some(depth) = painter.target.depth.get_mut(row + column..) else { return };
        let Some(depth) = depth.get_mut(..color.len()) else { return };
        let span = Span { color, depth, z, position, primitive };
        match test {
            DepthState::LESS => painter.shader.span_at(sample, span, DepthLess),
            other => painter.shader.span_at(sample, span, DepthDyn::new(other)),
        }
    }
}
