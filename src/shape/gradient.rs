//! Gradients to fill shapes with: shaders whose colour depends on the place on the screen alone.

use super::round::length;
use crate::color::{PixelFormat, channels};
use crate::math::{Pixels, divide, divide_modulo};
use crate::scene::ScreenPoint;
use crate::span::{DepthTest, Fragment, Shader, Span, SpanOf, draw_fragments};
use crate::vertex::{VertexRef, VertexShader};
use core::num::NonZeroU32;
use embedded_graphics_core::pixelcolor::Rgb888;

/// The colours of a gradient, as a table of `N` of them: a power of two, up to 256.
///
/// ```
/// use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};
/// use zstrip::shape::Ramp;
/// let heat = Ramp::<64>::new(&[(0, Rgb888::BLACK), (128, Rgb888::RED), (255, Rgb888::YELLOW)]);
/// # let _ = heat;
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ramp<const N: usize>([[u8; 3]; N]);

impl<const N: usize> Ramp<N> {
    /// Makes a table from colours at places from 0 to 255, in ascending order. Before the first place and after the
    /// last one, colours stay; without any colour, all is black.
    #[must_use]
    pub fn new(stops: &[(u8, Rgb888)]) -> Self {
        const { assert!(N.is_power_of_two() && N >= 2 && N <= 256, "a ramp has 2, 4, 8 ... 256 colours") };
        let mut colors = [[0; 3]; N];
        for (k, color) in colors.iter_mut().enumerate() {
            // From 0 for the first colour to 255 for the last one, in 8.8.
            let at = ((k as u32 * 255) << 8).checked_div(N as u32 - 1).unwrap_or(0);
            let after = stops.iter().find(|stop| u32::from(stop.0) << 8 >= at);
            let before = stops.iter().rev().find(|stop| u32::from(stop.0) << 8 <= at);
            *color = match (before, after) {
                (Some(before), Some(after)) => {
                    let from = u32::from(before.0) << 8;
                    let way = u32::from(after.0.saturating_sub(before.0)) << 8;
                    let ([r, g, b], [r1, g1, b1]) = (channels(before.1), channels(after.1));
                    // At most 255 times 255, 16.16, and rounded to nearest.
                    let mixed = |before: u8, after: u8| {
                        let sum = u32::from(before) * (way - (at - from)) + u32::from(after) * (at - from);
                        (sum + way / 2).checked_div(way).map_or(before, |channel| channel as u8)
                    };
                    [mixed(r, r1), mixed(g, g1), mixed(b, b1)]
                }
                (Some(only), None) | (None, Some(only)) => channels(only.1),
                (None, None) => [0; 3],
            };
        }
        Self(colors)
    }

    /// Number of bits of a colour's number.
    const BITS: u32 = N.trailing_zeros();

    #[inline(always)]
    fn color(&self, number: u32) -> [u8; 3] {
        self.0.get(number as usize & (N - 1)).copied().unwrap_or_default()
    }
}

/// A gradient along a line: the colours change from one point to another, and stay before and after them.
///
/// ```
/// use zstrip::ScreenPoint;
/// use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};
/// use zstrip::shape::{LinearGradient, Ramp};
/// let ramp = Ramp::<32>::new(&[(0, Rgb888::BLUE), (255, Rgb888::CYAN)]);
/// let sky = LinearGradient::new(&ramp, ScreenPoint::corner(0, 0), ScreenPoint::corner(0, 120));
/// // canvas.fill_with(&shape, &sky, 0, &mut buffer);
/// # let _ = sky;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinearGradient<'r, const N: usize> {
    ramp: &'r Ramp<N>,
    /// Place at the centre of the screen's first pixel, and its changes per pixel, 32.32: 0 at the first point, 1 at
    /// the second one.
    base: i64,
    steps: [i64; 2],
}

impl<'r, const N: usize> LinearGradient<'r, N> {
    /// Makes a gradient between two points, within ±32,767 px. Points less than 1 px apart are moved apart, to 1 px or
    /// more; two equal ones have a border between the first and the last colour, at their right.
    #[must_use]
    pub fn new(ramp: &'r Ramp<N>, from: ScreenPoint, to: ScreenPoint) -> Self {
        let bits = |c: Pixels| i64::from(c.to_bits()).clamp(-(1 << 23), 1 << 23);
        let (x, y) = (bits(from.x()), bits(from.y()));
        let (mut dx, mut dy) = (bits(to.x()) - x, bits(to.y()) - y);
        if (dx, dy) == (0, 0) {
            dx = 256;
        }
        while dx * dx + dy * dy < 1 << 16 {
            (dx, dy) = (2 * dx, 2 * dy);
        }
        // At most 2⁴⁹; the sums below are at most 2⁵⁰.
        let square = (dx * dx + dy * dy) as u64;
        let quotient = |n: i64| divide_modulo(n >> 32, n as u32, square);
        let base = quotient((128 - x) * dx + (128 - y) * dy);
        Self { ramp, base, steps: [quotient(dx << 8), quotient(dy << 8)] }
    }

    /// Returns the place of a pixel, 32.32. Places are below 2¹⁷, so nothing overflows.
    #[inline]
    fn place(&self, (x, y): (i32, i32)) -> i64 {
        let along = |step: i64, n: i32| step.wrapping_mul(n.into());
        self.base.wrapping_add(along(self.steps[0], x)).wrapping_add(along(self.steps[1], y))
    }

    #[inline(always)]
    fn color(&self, place: u32) -> [u8; 3] {
        self.ramp.color(place >> (32 - Ramp::<N>::BITS))
    }
}

/// Returns a place in 0.32, clamped.
#[inline(always)]
fn clamped(place: i64) -> u32 {
    u32::try_from(place).unwrap_or(if place < 0 { 0 } else { u32::MAX })
}

impl<const N: usize> VertexShader for LinearGradient<'_, N> {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }
}

impl<P: PixelFormat, const N: usize> Shader<P> for LinearGradient<'_, N> {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        let rgb = self.color(clamped(self.place(fragment.position)));
        Some(P::pack_at(rgb, fragment.position))
    }

    #[inline]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        if P::DITHER.is_some() {
            return draw_fragments(self, span, test);
        }
        let (x, y) = span.position;
        let first = self.place((x, y));
        let last = self.place((x.wrapping_add(span.color.len() as i32).wrapping_sub(1), y));
        if u32::try_from(first).is_err() || u32::try_from(last).is_err() {
            let (mut place, Span { color, depth, z, .. }) = (first, span);
            let near = (z >> 16) as u16;
            for (color, stored) in color.iter_mut().zip(depth) {
                if !D::ENABLED || test.passes(near, *stored) {
                    test.write(near, stored);
                    *color = P::pack(self.color(clamped(place)));
                }
                place = place.wrapping_add(self.steps[0]);
            }
            return;
        }
        let (mut place, step) = (first as u32, self.steps[0] as u32);
        let Span { color, depth, z, .. } = span;
        let near = (z >> 16) as u16;
        for (color, stored) in color.iter_mut().zip(depth) {
            if !D::ENABLED || test.passes(near, *stored) {
                test.write(near, stored);
                *color = P::pack(self.color(place));
            }
            place = place.wrapping_add(step);
        }
    }
}

/// A gradient from a point outward: the colours change from the centre to a radius, and stay beyond it.
///
/// ```
/// use zstrip::ScreenPoint;
/// use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};
/// use zstrip::math::Pixels;
/// use zstrip::shape::{RadialGradient, Ramp};
/// let ramp = Ramp::<32>::new(&[(0, Rgb888::WHITE), (255, Rgb888::BLUE)]);
/// let ball = RadialGradient::new(&ramp, ScreenPoint::corner(50, 40), Pixels::from_num(30));
/// # let _ = ball;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RadialGradient<'r, const N: usize> {
    ramp: &'r Ramp<N>,
    /// Position of the centre, 24.8 px.
    center: [i64; 2],
    /// 1 px in radii, 3.29.
    step: u32,
}

impl<'r, const N: usize> RadialGradient<'r, N> {
    /// Makes a gradient around a point. A radius below 1 px becomes 1 px.
    #[must_use]
    pub fn new(ramp: &'r Ramp<N>, center: ScreenPoint, radius: Pixels) -> Self {
        let radius = NonZeroU32::MIN.saturating_add(((length(radius) >> 8) as u32).max(256) - 1);
        let (step, _) = divide(1 << 37, radius);
        Self { ramp, center: [center.x(), center.y()].map(|c| c.to_bits().into()), step }
    }

    /// Returns how far the centre of a pixel is from that of the gradient, along x or y, in radii, 3.29.
    #[inline]
    fn away(&self, pixel: i32, axis: usize) -> i64 {
        let center = if axis == 0 { self.center[0] } else { self.center[1] };
        // Below 2³³ times 2²⁹.
        ((256 * i64::from(pixel) + 128 - center) * i64::from(self.step)) >> 8
    }

    /// Returns the square of a distance below 2 radii, 4.28.
    #[inline(always)]
    fn square(away: i32) -> u32 {
        let away = away >> 15;
        away.wrapping_mul(away) as u32
    }

    /// Returns the number of the colour at a distance's square; `last` is that of a pixel nearby.
    #[inline(always)]
    fn number(square: u32, last: u32) -> u32 {
        let square = square >> (28 - 2 * Ramp::<N>::BITS);
        let mut number = last;
        while number + 1 < N as u32 && (number + 1) * (number + 1) <= square {
            number += 1;
        }
        while number * number > square {
            number -= 1;
        }
        number
    }
}

/// Returns a distance in 3.29, at most 2 radii.
#[inline]
fn within(away: i64) -> i32 {
    const LIMIT: i64 = (1 << 30) - 1;
    away.clamp(-LIMIT, LIMIT) as i32
}

impl<const N: usize> VertexShader for RadialGradient<'_, N> {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }
}

impl<P: PixelFormat, const N: usize> Shader<P> for RadialGradient<'_, N> {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        let (x, y) = fragment.position;
        let square = Self::square(within(self.away(x, 0))) + Self::square(within(self.away(y, 1)));
        Some(P::pack_at(self.ramp.color(Self::number(square, 0)), fragment.position))
    }

    #[inline]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        let (x, y) = span.position;
        let (first, last) = (self.away(x, 0), self.away(x.wrapping_add(span.color.len() as i32), 0));
        if P::DITHER.is_some() || i64::from(within(first)) != first || i64::from(within(last)) != last {
            return draw_fragments(self, span, test);
        }
        // A pixel to the right adds 256 steps before the shift by 8, so that stepping is exact.
        let (mut number, row) = (0, Self::square(within(self.away(y, 1))));
        let Span { color, depth, z, .. } = span;
        let near = (z >> 16) as u16;
        let mut away = first as i32;
        for (color, stored) in color.iter_mut().zip(depth) {
            if !D::ENABLED || test.passes(near, *stored) {
                test.write(near, stored);
                number = Self::number(Self::square(away) + row, number);
                *color = P::pack(self.ramp.color(number));
            }
            away = away.wrapping_add(self.step as i32);
        }
    }
}
