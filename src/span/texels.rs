//! Small triangles with a texture, under light or not.
//!
//! The plain loop, over planes of u / w, v / w, 1 / w and light:
//!
//! ```text
//! for each pixel:
//!     if z >> 16 passes against the stored depth:
//!         color = texel(uq / q, vq / q) · light
//!         store z >> 16, unless the texel is transparent
//! ```
//! Where perspective moves no texel by more than half of one (1/32 where each pixel is to be exact), u and v are planes
//! themselves: neither a triangle nor a pixel takes a division. Other triangles take the way of large ones.
//!
//! ```text
//! bits   31 .. 24   23 .. 0              u, and v: 8.24
//!        whole      fraction
//!
//! bits   31 .. 16   15 .. 0              light, 9.7 each: one word for red and green, one for blue
//!        red        green
//!        blue
//! ```
//!
//! # Perspective
//! A pixel is the mean of three corners, with weights bᵢ for planes and bᵢ qᵢ / Σ bⱼ qⱼ in space. The values of the
//! corners differ by at most Δ, and qᵢ = 1 / wᵢ by at most a factor r. Then the two means differ by at most Δ times the
//! share of the weight that moves from some corners to others. That share is largest where q takes its two extremes:
//! (√r - 1) / (√r + 1), which is at most (r - 1) / 4.

use super::brush::{Brush, BrushRows, SmallResult, SmallTriangle};
use super::depth::DepthTest;
use crate::color::PixelFormat;
use crate::math::SMALL_CORE;
use crate::raster::{ShortPlanes, gradients_inlined, least_and_most};
use crate::texture::Texture;
use crate::vertex::PackedCorners;
use core::hint::black_box;
use core::marker::PhantomData;
use embedded_graphics_core::geometry::Size;

/// A shader whose small triangles show texels.
pub(crate) trait TexelSource<P: PixelFormat> {
    type Texture: Texture;
    /// Set if texels are multiplied by light.
    const LIT: bool;
    /// Set if light is scaled for [`Light::on_rgb565`].
    const RGB565: bool;
    /// Set if coordinates count modulo 1.
    const REPEATS: bool;
    /// Perspective may move texels by 2⁻`BITS` of one.
    const BITS: u32;

    /// Returns the texture; `None` if not all pixels of a triangle have the same one.
    fn texture(&self) -> Option<&Self::Texture>;

    /// Returns the pixel at coordinates in 16.16; `None` if it is transparent.
    fn pixel(texture: &Self::Texture, uv: [i32; 2], light: Light, position: (i32, i32)) -> Option<P::Raw>;
}

impl<P: PixelFormat, D: DepthTest> SmallTriangle<'_, '_, P, D> {
    /// Draws the triangle with the texels of a shader, if it is small. The shader packs corners into `N` words: u and
    /// v, light if there is any, and 1 / w.
    #[inline(always)]
    pub(crate) fn draw_texels<S: TexelSource<P>, const N: usize>(
        self,
        shader: &S,
        corners: &PackedCorners<'_>,
    ) -> SmallResult {
        let words = if self.state.is_some() { Some([&[0; N]; 3]) } else { corners.words::<N>() };
        match (shader.texture(), words) {
            (Some(texture), Some(words)) => self.draw(&TexelBrush::<S, P, N> { texture, words, format: PhantomData }),
            _ => SmallResult::Large,
        }
    }
}

/// Light on a pixel: red and green, and blue.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Light(pub(crate) [u32; 2]);

/// Light that is added, so that rounding leaves no channel below 0.
const MARGIN: i32 = 48;

impl Light {
    /// Makes light of channels in 8.16. `for_rgb565` says that it is for [`on_rgb565`](Self::on_rgb565).
    ///
    /// Channels in -64..2⁸ - 1/2, and a little beyond them at pixels that are not drawn: words are modulo 2³², so that
    /// steps lead from there to the right values.
    #[inline(always)]
    pub(crate) fn of_channels(channels: [i32; 3], for_rgb565: bool) -> Self {
        let [r, g, b] = channels.map(|c| ((scaled(c, for_rgb565) >> 9) + MARGIN) as u32);
        Self([(r << 16).wrapping_add(g), b << 16])
    }

    /// Returns what light changes by where channels change by these numbers, 8.16, rounded to nearest.
    #[inline(always)]
    pub(crate) fn of_changes(changes: [i32; 3], for_rgb565: bool) -> [u32; 2] {
        let [r, g, b] = changes.map(|c| (scaled(c, for_rgb565).wrapping_add(1 << 8) >> 9) as u32);
        [(r << 16).wrapping_add(g), b << 16]
    }

    /// Returns the channels in 8.16.
    #[inline(always)]
    pub(crate) const fn channels(self) -> [i32; 3] {
        let [red_green, blue] = self.0;
        let (r, g, b) = ((red_green >> 16) as i32, (red_green & 0xFFFF) as i32, (blue >> 16) as i32);
        [(r - MARGIN) << 9, (g - MARGIN) << 9, (b - MARGIN) << 9]
    }

    /// Multiplies a texel in RGB565 by the light. Full light is 1,020 · 32.5, which is 2¹⁵ · 1.0117: a channel of 6
    /// bits counts 4 · 1.0119 in one of 8 bits. A channel of 5 bits counts 8 · 1.0282, so its light is 1/64 more.
    ///
    /// # Format
    /// With what is added, light is below 33,270. Times 63 it is below 2²¹; with 1/64 more, times 31, below 2²⁰.
    #[inline(always)]
    pub(crate) fn on_rgb565(self, texel: u16) -> u16 {
        let [red_green, blue] = self.0;
        let texel = texel as u32;
        let five = |channel: u32, light: u32| channel.wrapping_mul(light + (light >> 6)) >> 15;
        let (r, b) = (five(texel >> 11, red_green >> 16), five(texel & 31, blue >> 16));
        let g = (texel >> 5 & 63).wrapping_mul(red_green & 0xFFFF) >> 15;
        (r << 11 | g << 5 | b) as u16
    }
}

/// Returns a channel, 1/64 more for RGB565.
#[inline(always)]
const fn scaled(channel: i32, for_rgb565: bool) -> i32 {
    if for_rgb565 { channel.wrapping_add(channel >> 6) } else { channel }
}

/// Draws small triangles with the texels of a source.
struct TexelBrush<'s, S: TexelSource<P>, P: PixelFormat, const N: usize> {
    texture: &'s S::Texture,
    words: [&'s [u32; N]; 3],
    format: PhantomData<P>,
}

/// The spans of a [`TexelBrush`].
struct TexelRows<'s, S: TexelSource<P>, P: PixelFormat> {
    texture: &'s S::Texture,
    /// The first column, and the row; its number below the first row.
    place: (i32, i32),
    row: u32,
    /// u, v and light at the first pixel, and their changes.
    at: [u32; 4],
    dx: [u32; 4],
    dy: [u32; 4],
    format: PhantomData<P>,
}

/// Half a unit of 16.16, in 8.24.
const HALF: u32 = 128;

/// A plane: its value at the first pixel, and its changes to the right and down.
type Plane = [u32; 3];

/// Computes the plane of a coordinate in 8.24, from one in 16.16 at the first corner and the differences to the others.
///
/// # Format
/// Differences are at most 2¹⁶, so numerators are at most 2¹⁶ · 60 · 2⁸ · 2 < 2³¹. Changes are 2¹⁶ n / area, below 2²⁸:
/// they are too small by at most two units, and the start by 128, to which [`HALF`] is added. Over 60 columns and 25
/// rows, that is below 2⁻¹⁶ of the texture, 1/256 texel of 256. Where pixels lie on an edge along which a coordinate is
/// a whole number, hardly any shows a texel of the other side.
#[inline(always)]
fn coordinate(planes: &ShortPlanes, a: i32, b: i32, c: i32) -> Option<Plane> {
    let (n, m) = planes.numerators(b, c);
    let (dx, dy) = gradients_inlined(n, m, planes.reciprocal, planes.shift as i32 - 15)?;
    let start = ((a as u32) << 8).wrapping_add(HALF);
    let start = start.wrapping_add_signed(planes.offset(dx, dy));
    // Without the black box, the compiler would leave part of the sum to each span.
    Some([if SMALL_CORE { start } else { black_box(start) }, dx as u32, dy as u32])
}

/// Computes the plane of a channel of light, from 9.7 at the corners.
///
/// # Format
/// Values are below 2¹⁵·¹, so numerators are below 2¹⁵·¹ · 60 · 2⁸ · 2 < 2³¹. Changes are 2⁸ n / area, rounded to
/// nearest from 2²⁰ n / area: at most 2¹⁶. A steeper triangle, narrower than half a pixel, is drawn as large ones are.
/// So the start is below 2³¹ before it is cut, and right although green has red above it. Over 60 columns and 25 rows,
/// and with the cut of the start, errors are below 47 units, a third of a 255th: less than [`MARGIN`].
#[inline(always)]
fn channel(planes: &ShortPlanes, a: i32, b: i32, c: i32) -> Option<Plane> {
    let (n, m) = planes.numerators(b.wrapping_sub(a), c.wrapping_sub(a));
    let (dx, dy) = gradients_inlined(n, m, planes.reciprocal, planes.shift as i32 - 11)?;
    let (dx, dy) = ((dx + (1 << 11)) >> 12, (dy + (1 << 11)) >> 12);
    let offset = (dx * planes.to.0 + dy * planes.to.1) >> 8;
    Some([a.wrapping_add(offset) as u32, dx as u32, dy as u32])
}

/// Computes the plane of a channel as [`channel`] does, out of line.
#[inline(never)]
fn channel_outlined(planes: &ShortPlanes, a: i32, b: i32, c: i32) -> Option<Plane> {
    channel(planes, a, b, c)
}

/// Returns whether perspective surely moves no texel by more than 2⁻`bits` texels, by a short test. Differences of
/// coordinates are at most `difference` + 1 units of 16.16, and [`inverse_w`](crate::vertex::inverse_w) made the words.
///
/// # Format
/// Values differ by at most 2 (`difference` + 1) units, so Δ is at most `texels` + 1 in 24.8. Numbers q have 26 bits:
/// Δ (r - 1) / 4 ≤ 2⁻ᵇ becomes (q - q₀) / 2¹⁰ · 2⁸ Δ ≤ q₀ / 2ᵇ, with q₀ the least. With one exponent, q - q₀ is below
/// 2²⁵, and the product at most 2³¹.
#[inline(always)]
fn is_clearly_straight(difference: u32, sides: Size, [a, b, c]: [u32; 3], bits: u32) -> bool {
    // Usually 1 / w has one exponent at all corners.
    if ((a ^ b) | (a ^ c)) & 63 != 0 || difference >> 14 != 0 {
        return false;
    }
    let (least, most) = (a.min(b).min(c) >> 6, a.max(b).max(c) >> 6);
    let texels = (2 * difference + 2).wrapping_mul(sides.width.max(sides.height)) >> 8;
    texels >> 16 == 0 && bends_little(least, most, texels, bits)
}

/// Returns whether (q - q₀) / 2¹⁰ · 2⁸ Δ ≤ q₀ / 2^`bits`.
#[inline(always)]
const fn bends_little(least: u32, most: u32, texels: u32, bits: u32) -> bool {
    (((most - least) >> 10) + 1).wrapping_mul(texels + 1) <= least >> bits
}

/// Returns whether perspective moves no texel by more than 2⁻`bits` texels, where two corners differ from the third by
/// `du` and `dv` units of 16.16.
///
/// # Format
/// Differences are at most 2¹⁶, and sides of the texture below 2¹⁶: Δ is below 2³¹ · 2⁻⁶. Where q differs by more than
/// a factor of 2, too much is moved in any case.
#[inline(never)]
fn is_straight(sides: Size, [du, dv]: [(i32, i32); 2], words: [u32; 3], bits: u32) -> bool {
    // Rounded up: in a wide texture, one unit is a texel.
    let range = |(b, c): (i32, i32)| (b.max(c).max(0) - b.min(c).min(0) + 3) as u32 >> 2;
    let texels = (range(du).wrapping_mul(sides.width) >> 6).max(range(dv).wrapping_mul(sides.height) >> 6);
    let (least, most) = least_and_most(words);
    texels >> 16 == 0 && most - least <= least && bends_little(least, most, texels, bits)
}

/// Returns the bits that a number or its complement has: 0..=|n|.
#[inline(always)]
const fn bits_of(n: i32) -> u32 {
    (n ^ n >> 31) as u32
}

impl<'s, P: PixelFormat, D: DepthTest, S: TexelSource<P>, const N: usize> Brush<P, D> for TexelBrush<'s, S, P, N> {
    const PLANES: bool = true;
    const TALL: bool = S::LIT;

    type Rows = TexelRows<'s, S, P>;

    #[inline(always)]
    fn set_up(&self, planes: &ShortPlanes, swapped: bool, place: (i32, i32), _: i32) -> Option<TexelRows<'s, S, P>> {
        let [a, mut b, mut c] = self.words;
        if swapped {
            (b, c) = (c, b);
        }
        let ((ua, va, wa), (ub, vb, wb), (uc, vc, wc)) = (coordinates(a), coordinates(b), coordinates(c));
        let (ub, vb, uc, vc) = (ub.wrapping_sub(ua), vb.wrapping_sub(va), uc.wrapping_sub(ua), vc.wrapping_sub(va));
        let difference = bits_of(ub) | bits_of(vb) | bits_of(uc) | bits_of(vc);
        let (sides, words, bits) = (self.texture.size(), [wa, wb, wc], S::BITS);
        if difference >> 16 != 0
            || !is_clearly_straight(difference, sides, words, bits)
                && !is_straight(sides, [(ub, uc), (vb, vc)], words, bits)
        {
            return None;
        }
        // Whole parts have 8 bits.
        let fits =
            |a: i32, b: i32, c: i32| [a, a.wrapping_add(b), a.wrapping_add(c)].iter().all(|c| *c >> 22 == *c >> 31);
        if !(S::REPEATS || fits(ua, ub, uc) && fits(va, vb, vc)) {
            return None;
        }
        let (u, v) = (coordinate(planes, ua, ub, uc)?, coordinate(planes, va, vb, vc)?);
        let mut rows = TexelRows {
            texture: self.texture,
            place,
            row: 0,
            at: [u[0], v[0], 0, 0],
            dx: [u[1], v[1], 0, 0],
            dy: [u[2], v[2], 0, 0],
            format: PhantomData,
        };
        if S::LIT {
            // Channels in 8.2: red, green and blue.
            let (a, b, c) = (a[2], b[2], c[2]);
            let level = |word: u32, at: u32| {
                let ten = (word >> at & 0x3FF) as i32;
                (ten << 5) + if S::RGB565 { ten >> 1 } else { 0 } + MARGIN
            };
            let plane = |at: u32| channel_outlined(planes, level(a, at), level(b, at), level(c, at));
            let r = channel(planes, level(a, 20), level(b, 20), level(c, 20))?;
            // White light on a white surface is one channel.
            let grey = |word: u32| (word & 0x3FF).wrapping_mul(0x0010_0401) == word;
            let (g, b) = if grey(a) & grey(b) & grey(c) { (r, r) } else { (plane(10)?, plane(0)?) };
            // Rows beside the centres split words into changes of 16 bits.
            let is_steep = |plane: &Plane| (bits_of(plane[1] as i32) | bits_of(plane[2] as i32)) >> 15 != 0;
            if D::SAMPLED && (is_steep(&r) || is_steep(&g) || is_steep(&b)) {
                return None;
            }
            let pair = |k: usize| (r[k] << 16).wrapping_add(g[k]);
            (rows.at[2], rows.dx[2], rows.dy[2]) = (pair(0), pair(1), pair(2));
            (rows.at[3], rows.dx[3], rows.dy[3]) = (b[0] << 16, b[1] << 16, b[2] << 16);
        }
        Some(rows)
    }

    #[inline(always)]
    fn resume(&self, words: &[u32], place: (i32, i32)) -> TexelRows<'s, S, P> {
        let mut rows =
            TexelRows { texture: self.texture, place, row: 0, at: [0; 4], dx: [0; 4], dy: [0; 4], format: PhantomData };
        let planes = rows.at.iter_mut().zip(&mut rows.dx).zip(&mut rows.dy);
        for (((at, dx), dy), words) in planes.zip(words.chunks_exact(3)) {
            if let [a, b, c] = words {
                (*at, *dx, *dy) = (*a, *b, *c);
            }
        }
        rows
    }
}

impl<P: PixelFormat, D: DepthTest, S: TexelSource<P>> BrushRows<P, D> for TexelRows<'_, S, P> {
    const WORDS: Option<usize> = Some(if S::LIT { 12 } else { 6 });
    const SHADES: bool = S::Texture::IS_OPAQUE;

    #[inline(always)]
    fn shade(&self, color: &mut [P::Raw], column: i32) {
        let first = |k: usize| {
            self.at[k]
                .wrapping_add(self.dx[k].wrapping_mul(column as u32))
                .wrapping_add(self.dy[k].wrapping_mul(self.row))
        };
        let (mut u, mut v) = (first(0), first(1));
        let mut light = if S::LIT { [first(2), first(3)] } else { [0; 2] };
        let mut x = self.place.0 + column;
        for color in color {
            let uv = [u as i32 >> 8, v as i32 >> 8];
            if let Some(pixel) = S::pixel(self.texture, uv, Light(light), (x, self.place.1 + self.row as i32)) {
                *color = pixel;
            }
            u = u.wrapping_add(self.dx[0]);
            v = v.wrapping_add(self.dx[1]);
            if S::LIT {
                light = [light[0].wrapping_add(self.dx[2]), light[1].wrapping_add(self.dx[3])];
            }
            x = x.wrapping_add(1);
        }
    }

    #[inline(always)]
    fn save(&self, down: u32, words: &mut [u32]) {
        let at = |k: usize| self.at[k].wrapping_add(self.dy[k].wrapping_mul(self.row.wrapping_add(down)));
        if let Some((words, light)) = words.split_first_chunk_mut() {
            *words = [at(0), self.dx[0], self.dy[0], at(1), self.dx[1], self.dy[1]];
            if let (true, Some(words)) = (S::LIT, light.first_chunk_mut()) {
                *words = [at(2), self.dx[2], self.dy[2], at(3), self.dx[3], self.dy[3]];
            }
        }
    }

    /// # Format
    /// Changes are below 2²⁸, so 2⁻⁸ of them times 127 fit. Light has changes below 2¹⁵ in 9.7. Sums are cut.
    #[inline(always)]
    fn beside(&self, (right, down): (i32, i32)) -> Self {
        let of_long = |k: usize| (self.dx[k] as i32 >> 8) * right + (self.dy[k] as i32 >> 8) * down;
        let of_short = |dx: i32, dy: i32| ((dx * right + dy * down) >> 8) as u32;
        let low = |word: u32| i32::from(word as i16);
        let high = |word: u32| (word as i32).wrapping_sub(low(word)) >> 16;
        let mut at = [self.at[0].wrapping_add_signed(of_long(0)), self.at[1].wrapping_add_signed(of_long(1)), 0, 0];
        if S::LIT {
            let ([_, _, dx, blue_dx], [_, _, dy, blue_dy]) = (self.dx, self.dy);
            let red_green = (of_short(high(dx), high(dy)) << 16).wrapping_add(of_short(low(dx), low(dy)));
            at[2] = self.at[2].wrapping_add(red_green);
            at[3] = self.at[3].wrapping_add(of_short(high(blue_dx), high(blue_dy)) << 16);
        }
        Self { at, ..*self }
    }

    #[inline(always)]
    fn next_row(&mut self) {
        self.row += 1;
    }

    #[inline(always)]
    fn span(&self, color: &mut [P::Raw], depth: &mut [D::Depth], mut z: u32, dz_dx: i32, column: i32, test: D) {
        let first = |k: usize| {
            self.at[k]
                .wrapping_add(self.dx[k].wrapping_mul(column as u32))
                .wrapping_add(self.dy[k].wrapping_mul(self.row))
        };
        let (mut u, mut v) = (first(0), first(1));
        let mut light = if S::LIT { [first(2), first(3)] } else { [0; 2] };
        let mut x = self.place.0 + column;
        for (color, depth) in color.iter_mut().zip(depth) {
            let near = (z >> 16) as u16;
            if !D::ENABLED || test.passes(near, *depth) {
                let uv = [u as i32 >> 8, v as i32 >> 8];
                if let Some(pixel) = S::pixel(self.texture, uv, Light(light), (x, self.place.1 + self.row as i32)) {
                    test.write(near, depth);
                    *color = pixel;
                }
            }
            z = z.wrapping_add_signed(dz_dx);
            u = u.wrapping_add(self.dx[0]);
            v = v.wrapping_add(self.dx[1]);
            if S::LIT {
                light = [light[0].wrapping_add(self.dx[2]), light[1].wrapping_add(self.dx[3])];
            }
            x = x.wrapping_add(1);
        }
    }
}

/// Returns u, v and 1 / w from the words of a corner.
#[inline(always)]
const fn coordinates<const N: usize>(words: &[u32; N]) -> (i32, i32, u32) {
    (words[0] as i32, words[1] as i32, words[N - 1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use crate::vertex::{ClipVertex, inverse_w};

    /// Neither test lets a triangle pass whose texels are moved further than it says.
    #[test]
    fn straight_triangles_move_no_texel_further_than_stated() {
        let mut rng = Rng::new(21);
        let (mut clear, mut straight, mut refused) = (0, 0, 0);
        for case in 0..20_000 {
            let spread = 1.0 + f64::from(rng.next_u32()) / 2f64.powi(32) * [0.001, 0.02, 0.3, 5.0][case % 4];
            let w = i64::from(rng.between(1 << 20, 1 << 30)) << rng.below(12);
            let mut w_of = || (w as f64 * spread.powf(f64::from(rng.next_u32()) / 2f64.powi(32))) as i64;
            let w = [w_of(), w_of(), w_of()];
            let words = w.map(|w| inverse_w(&ClipVertex { w, ..ClipVertex::default() }));
            let most = 1 << (2 + case / 4 % 15);
            let mut difference = || (rng.between(-most, most), rng.between(-most, most));
            let (du, dv) = (difference(), difference());
            let sides = Size::new(1 << rng.below(11), 1 + rng.below(2000) as u32);
            let bits = 4 + (case % 2) as u32;
            // The most that perspective moves: between two corners, where planes and space differ most.
            let mut moved = 0_f64;
            for ((b, c), side) in [(du, sides.width), (dv, sides.height)] {
                let values = [0.0, f64::from(b), f64::from(c)].map(|value| value / 65_536.0 * f64::from(side));
                for step in 0..=20 {
                    for other in 0..=20 - step {
                        let weights = [step, other, 20 - step - other].map(|n| f64::from(n) / 20.0);
                        let q = w.map(|w| 1.0 / w as f64);
                        let sum: f64 = (0..3).map(|k| weights[k] * q[k]).sum();
                        let mean = |of: &dyn Fn(usize) -> f64| (0..3).map(|k| of(k) * values[k]).sum::<f64>();
                        moved = moved.max((mean(&|k| weights[k]) - mean(&|k| weights[k] * q[k] / sum)).abs());
                    }
                }
                if case % 50 > 0 {
                    break;
                }
            }
            let bound = 0.5_f64.powi(bits as i32);
            let all = bits_of(du.0) | bits_of(du.1) | bits_of(dv.0) | bits_of(dv.1);
            let (is_clear, is) =
                (is_clearly_straight(all, sides, words, bits), is_straight(sides, [du, dv], words, bits));
            assert!(!(is_clear | is) || moved <= bound, "{case}: {moved} texels, {du:?} {dv:?} {sides:?} {w:?}");
            (clear, straight, refused) =
                (clear + u32::from(is_clear), straight + u32::from(is), refused + u32::from(!is));
        }
        assert!(clear > 2000 && straight > clear && refused > 2000, "{clear}, {straight}, {refused}");
    }

    /// One unit of 16.16 is a texel of the widest textures.
    #[test]
    fn few_units_of_wide_textures_are_many_texels() {
        let words = [1_i64 << 40, 1 << 40, 1 << 39].map(|w| inverse_w(&ClipVertex { w, ..ClipVertex::default() }));
        for units in 1..40 {
            for side in [4096, 65_535] {
                let moved = f64::from(units) / 65_536.0 * f64::from(side) * (2f64.sqrt() - 1.0) / (2f64.sqrt() + 1.0);
                for (bits, bound) in [(4, 1.0 / 16.0), (5, 1.0 / 32.0)] {
                    let found = is_straight(Size::new(side, 1), [(0, units), (0, 0)], words, bits);
                    assert!(!found || moved <= bound, "{units} units of {side} texels: {moved} texels");
                }
            }
        }
    }

    /// A texel of 16 bits under light is the one that channels of 8 bits make, cut to 16 bits, or next to it.
    #[test]
    fn texels_under_light_are_those_of_8_bits() {
        let mut worst = 0_f64;
        for ten in 0..=1020_u32 {
            let level = (ten << 5) + (ten >> 1);
            let light = Light([level << 16 | level, level << 16]);
            for k in 0..64_u16 {
                let lit = light.on_rgb565((k >> 1) << 11 | k << 5 | k >> 1);
                let found = [lit >> 11, lit >> 5 & 63, lit & 31].map(f64::from);
                let by = f64::from(ten) / 1020.0;
                let five = f64::from(k >> 1) / 31.0 * 255.0 / 8.0 * by;
                let six = f64::from(k) / 63.0 * 255.0 / 4.0 * by;
                for (found, exact) in found.into_iter().zip([five, six, five]) {
                    worst = worst.max(found - exact).max(exact - found - 1.0);
                }
            }
        }
        assert!(worst < 0.05, "{worst} levels");
    }
}
