//! Small triangles whose three channels are interpolated linearly, in formats of at most 6 bits per channel.
//!
//! Two words hold the channels, and their changes per pixel and per row:
//!
//! ```text
//! bits   31 .. 24   23 .. 16   15 .. 8   7 .. 0
//!        red        fraction   green     fraction
//!        blue       fraction
//! ```
//! So a triangle takes three planes of 32 bits and nothing per row, and a pixel takes two additions.

use super::brush::{Brush, BrushRows};
use super::depth::DepthTest;
use crate::color::PixelFormat;
use crate::raster::{ShortPlanes, high};
use core::marker::PhantomData;

/// Low bits of channels in 8.16 that are left out: those of 8.3 count.
const LEFT_OUT: u32 = 13;

/// Draws a small triangle whose varyings are channels in 8.16, squeezed to 0.5..=254.5.
pub(crate) struct ChannelBrush<'c, P> {
    corners: &'c [[i32; 3]; 3],
    format: PhantomData<P>,
}

/// The spans of a [`ChannelBrush`].
pub(crate) struct ChannelRows {
    /// The words at the first column of the row, and their changes.
    at: [u32; 2],
    dx: [u32; 2],
    dy: [u32; 2],
}

impl<'c, P: PixelFormat> ChannelBrush<'c, P> {
    /// Set if pixels of this format are packed from whole channels.
    pub(crate) const FITS: bool = P::PACKED && P::DITHER.is_none();

    #[inline(always)]
    pub(crate) fn new(corners: &'c [[i32; 3]; 3]) -> Self {
        Self { corners, format: PhantomData }
    }
}

/// Computes a channel's value at the first pixel and its changes to the right and down, 8.8, from 8.3 at the corners.
///
/// # Format
/// Differences are below 2¹¹, so numerators are below 2¹¹ · 60 · 2⁸ · 2 < 2²⁶, of which 2⁵ times fit. Changes are 2¹³ n
/// / area, rounded: off by at most 1/2 unit and, since a unit of the high word is at most one of 8.8 before it is
/// shifted, by 2⁻⁸ of one more. Over 60 columns and 25 rows, and with the cut of the start, that makes 44 units, 0.17
/// of 255. A pixel of the triangle has channels in 0.5..=254.5 but for that: they do not run into each other. Changes
/// have to be below 2¹⁶: then the start is below 2³¹ before it is cut, and right although green has red above it.
#[inline(always)]
fn channel([a, b, c]: [i32; 3], planes: &ShortPlanes, down: u32, half: i32) -> [u32; 3] {
    let (n, m) = planes.numerators(b.wrapping_sub(a), c.wrapping_sub(a));
    let dx = high(n << 5, planes.reciprocal).wrapping_add(half) >> (down & 31);
    let dy = high(m << 5, planes.reciprocal).wrapping_add(half) >> (down & 31);
    let offset = dx.wrapping_mul(planes.to.0).wrapping_add(dy.wrapping_mul(planes.to.1)) >> 8;
    [(a << 5).wrapping_add(offset) as u32, dx as u32, dy as u32]
}

impl<P: PixelFormat, D: DepthTest> Brush<P, D> for ChannelBrush<'_, P> {
    const PLANES: bool = true;

    type Rows = ChannelRows;

    #[inline(always)]
    fn set_up(&self, planes: &ShortPlanes, swapped: bool, _: (i32, i32), _: i32) -> Option<ChannelRows> {
        // Of areas below 2⁻⁷ px², changes would lose bits.
        let Some(down @ 1..) = 23_u32.checked_sub(planes.shift) else { return None };
        let half = 1 << ((down - 1) & 31);
        let [a, mut b, mut c] = self.corners.each_ref();
        if swapped {
            (b, c) = (c, b);
        }
        let rounded = |value: i32| value.wrapping_add(1 << (LEFT_OUT - 1)) >> LEFT_OUT;
        let values = |k: usize| [rounded(a[k]), rounded(b[k]), rounded(c[k])];
        let pair = |red: u32, green: u32| (red << 16).wrapping_add(green);
        let [r, r_dx, r_dy] = channel(values(0), planes, down, half);
        let [g, g_dx, g_dy] = channel(values(1), planes, down, half);
        let (at, dx, dy) = (pair(r, g), pair(r_dx, g_dx), pair(r_dy, g_dy));
        let [b, b_dx, b_dy] = channel(values(2), planes, down, half);
        let bits = |change: u32| change ^ (change as i32 >> 31) as u32;
        // Rows beside the centres split words into changes of 16 bits.
        let most = if D::SAMPLED { 15 } else { 16 };
        if (bits(r_dx) | bits(r_dy) | bits(g_dx) | bits(g_dy)) >> most != 0 {
            return None;
        }
        if D::SAMPLED && (bits(b_dx) | bits(b_dy)) >> most != 0 {
            return None;
        }
        Some(ChannelRows { at: [at, b << 16], dx: [dx, b_dx << 16], dy: [dy, b_dy << 16] })
    }

    #[inline(always)]
    fn resume(&self, words: &[u32], _: (i32, i32)) -> ChannelRows {
        let [a, b, c, d, e, f] = *words.first_chunk().unwrap_or(&[0; 6]);
        ChannelRows { at: [a, b], dx: [c, d], dy: [e, f] }
    }
}

impl<P: PixelFormat, D: DepthTest> BrushRows<P, D> for ChannelRows {
    const WORDS: Option<usize> = Some(6);
    const SHADES: bool = true;

    #[inline(always)]
    fn shade(&self, color: &mut [P::Raw], column: i32) {
        let [dx, blue_dx] = self.dx;
        let mut red_green = self.at[0].wrapping_add(dx.wrapping_mul(column as u32));
        let mut blue = self.at[1].wrapping_add(blue_dx.wrapping_mul(column as u32));
        for color in color {
            *color = P::pack([(red_green >> 24) as u8, (red_green >> 8) as u8, (blue >> 24) as u8]);
            red_green = red_green.wrapping_add(dx);
            blue = blue.wrapping_add(blue_dx);
        }
    }

    #[inline(always)]
    fn save(&self, down: u32, words: &mut [u32]) {
        if let Some(words) = words.first_chunk_mut() {
            let ([a, b], [c, d], [e, f]) = (self.at, self.dx, self.dy);
            *words = [a.wrapping_add(e.wrapping_mul(down)), b.wrapping_add(f.wrapping_mul(down)), c, d, e, f];
        }
    }

    /// # Format
    /// Changes of 8.8 are below 2¹⁵, and so is half of the sum of two. It is cut, so channels are off by one unit more.
    #[inline(always)]
    fn beside(&self, (right, down): (i32, i32)) -> Self {
        let beside = |dx: i32, dy: i32| ((dx * right + dy * down) >> 8) as u32;
        let low = |word: u32| i32::from(word as i16);
        let high = |word: u32| (word as i32).wrapping_sub(low(word)) >> 16;
        let ([dx, blue_dx], [dy, blue_dy]) = (self.dx, self.dy);
        let red_green = (beside(high(dx), high(dy)) << 16).wrapping_add(beside(low(dx), low(dy)));
        let blue = beside(high(blue_dx), high(blue_dy)) << 16;
        Self { at: [self.at[0].wrapping_add(red_green), self.at[1].wrapping_add(blue)], ..*self }
    }

    #[inline(always)]
    fn next_row(&mut self) {
        self.at[0] = self.at[0].wrapping_add(self.dy[0]);
        self.at[1] = self.at[1].wrapping_add(self.dy[1]);
    }

    #[inline(always)]
    fn span(&self, color: &mut [P::Raw], depth: &mut [D::Depth], mut z: u32, dz_dx: i32, column: i32, test: D) {
        let [dx, blue_dx] = self.dx;
        let mut red_green = self.at[0].wrapping_add(dx.wrapping_mul(column as u32));
        let mut blue = self.at[1].wrapping_add(blue_dx.wrapping_mul(column as u32));
        for (color, depth) in color.iter_mut().zip(depth) {
            let near = (z >> 16) as u16;
            if !D::ENABLED || test.passes(near, *depth) {
                test.write(near, depth);
                *color = P::pack([(red_green >> 24) as u8, (red_green >> 8) as u8, (blue >> 24) as u8]);
            }
            z = z.wrapping_add_signed(dz_dx);
            red_green = red_green.wrapping_add(dx);
            blue = blue.wrapping_add(blue_dx);
        }
    }
}
