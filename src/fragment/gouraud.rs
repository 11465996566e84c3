//! Colours a vertex, interpolated over the triangle.

use super::dither::{spread, spread_step};
use super::flat::channels;
use super::luma::{luma_span, weighted};
use super::shader::fragments;
use super::{DepthTest, Fragment, Fragments, PixelFormat, Shader};
use crate::geometry::{Corner, Light, Lit, VertexShader};
use embedded_graphics_core::pixelcolor::Rgb888;

/// Gouraud shading: lit at the vertices, by the mesh's normals, and interpolated linearly on the screen. A mesh without
/// normals shows the ambient light only.
#[derive(Clone, Copy, Debug)]
pub struct Gouraud {
    light: Option<Light>,
    /// One colour for the whole mesh, lit; otherwise the mesh's colours count.
    lit: Option<Lit>,
}

impl Gouraud {
    /// One colour under a light (given in object space, see [`Light::to_object`]).
    pub fn new(light: Light, color: impl Into<Rgb888>) -> Self {
        Self { light: Some(light), lit: Some(light.on(channels(color.into()))) }
    }

    /// The colours of the mesh's vertices under a light.
    pub const fn colors(light: Light) -> Self {
        Self { light: Some(light), lit: None }
    }

    /// The varyings of a vertex that has this colour.
    #[inline]
    pub fn varyings(color: Rgb888) -> [i32; 3] {
        let [r, g, b] = channels(color);
        [squeeze(i32::from(r) << 8), squeeze(i32::from(g) << 8), squeeze(i32::from(b) << 8)]
    }

    /// The colours of the mesh's vertices as they are.
    pub const fn colors_unlit() -> Self {
        Self { light: None, lit: None }
    }
}

/// Channels are interpolated as (c + 1/2) 255 / 256: so they stay half a step away from both ends of their 8 bits, which
/// leaves [`packed_span`] room for its errors.
pub(super) const fn squeeze(c: i32) -> i32 {
    let c = (c << 8) + (1 << 15);
    c - (c >> 8)
}

/// The integer nearest to the channel that was squeezed.
pub(super) const fn unsqueeze(c: i32) -> u8 {
    ((c + (c >> 8)) >> 16) as u8
}

impl VertexShader for Gouraud {
    /// Red, green, blue in 8.16, squeezed to 0.5..=254.5.
    type Varyings = [i32; 3];

    /// All three in one word: red 8.2, green and blue 8.3; off by at most 1/8 of 255.
    const WORDS: usize = 1;

    const ZERO_BITS: u32 = 13;

    #[inline]
    fn vertex(&self, vertex: &Corner<'_>) -> [i32; 3] {
        let rgb = match (self.lit, self.light) {
            (Some(lit), _) => lit.shade(vertex.normal()),
            (None, Some(light)) => light.on(vertex.color()).shade(vertex.normal()),
            (None, None) => vertex.color().map(|c| i32::from(c) << 8),
        };
        rgb.map(squeeze)
    }

    #[inline]
    fn store(rgb: &[i32; 3], words: &mut [u32]) {
        store(rgb, words);
    }

    #[inline]
    fn load(words: &[u32]) -> [i32; 3] {
        load(words)
    }
}

impl<P: PixelFormat> Shader<P> for Gouraud {
    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 3]>) -> Option<P::Raw> {
        // Spelled out: at `opt-level = "s"`, `map` is a loop through memory.
        let [r, g, b] = *fragment.varyings;
        Some(P::pack_at([unsqueeze(r), unsqueeze(g), unsqueeze(b)], fragment.position))
    }

    #[inline]
    fn prepare(&self, rgb: &mut [i32; 3], d_dx: &[i32; 3]) -> [u32; 2] {
        if P::PACKED {
            prepare::<P>(rgb, d_dx)
        } else if P::IS_LUMA {
            [weighted(*d_dx), 0]
        } else {
            [0; 2]
        }
    }

    #[inline]
    fn span<D: DepthTest>(&self, face: u32, span: Fragments<'_, P, [i32; 3], D::Stored>, test: D) {
        match span {
            // A line's pixel, or a tip of a triangle.
            Fragments { color: [color], depth: [depth], z, varyings, position, .. } if P::PACKED => {
                let mut pen = Pen { z, dz_dx: 0, word: word(spread::<P>(varyings)), step: 0, mask: P::packed_mask() };
                pen.draw::<P, D>(test, P::dither(position)[0], color, depth);
            }
            span if P::PACKED => packed_span(span, test),
            span if P::IS_LUMA => {
                let [step, _] = span.steps.words;
                luma_span(span, step, test);
            }
            span => fragments(self, face, span, test),
        }
    }
}

/// Channels in one word of the records.
#[inline]
pub(super) fn store(rgb: &[i32; 3], words: &mut [u32]) {
    let [r, g, b] = *rgb;
    let packed = ((r + (1 << 13)) >> 14) << 22 | ((g + (1 << 12)) >> 13) << 11 | (b + (1 << 12)) >> 13;
    if let [word] = words {
        *word = packed as u32;
    }
}

/// What [`store`] packed.
#[inline]
pub(super) fn load(words: &[u32]) -> [i32; 3] {
    let word = words.first().copied().unwrap_or(0);
    let channel = |bits: u32| (bits << 13) as i32;
    [channel(word >> 22 << 1), channel((word >> 11) & 0x7FF), channel(word & 0x7FF)]
}

/// A word of three channels: red 8.3 in the upper 11 bits, blue 8.3 in the next 11, green 8.2 in the lower 10.
///
/// It stands for red 2²¹ + blue 2¹⁰ + green, so steps of either sign may be added as words, as long as each channel stays
/// in range.
#[inline(always)]
pub(super) const fn pack(r: i32, g: i32, b: i32) -> u32 {
    ((r as u32) << 21).wrapping_add((b as u32) << 10).wrapping_add(g as u32)
}

/// Pixels that a word is stepped over until its rounding is made up for, and until it is made anew.
const GROUP: usize = 4;
const RUN: usize = 2 * GROUP;

/// The word of channels in 8.16, cut.
#[inline(always)]
pub(super) const fn word([r, g, b]: [i32; 3]) -> u32 {
    pack(r >> 13, g >> 14, b >> 13)
}

/// Once a triangle: moves the channels so that cutting them rounds, and so that the errors of stepping cancel in the middle
/// of a run. Yields the step of a word, and what leads from the end of a group to the first pixel of the next.
#[inline(never)]
pub(super) fn prepare<P: PixelFormat>(rgb: &mut [i32; 3], d_dx: &[i32; 3]) -> [u32; 2] {
    let mut one = [0; 3];
    let mut group = [0; 3];
    for (k, (value, &step)) in rgb.iter_mut().zip(d_dx).enumerate() {
        let step = spread_step::<P>(k, step);
        let half = if k == 1 { 1 << 13 } else { 1 << 12 };
        let rounded = |v: i32| v.wrapping_add(half) & -(2 * half);
        let four = step.wrapping_mul(GROUP as i32);
        (one[k], group[k]) = (rounded(step), rounded(four));
        let lost = 3 * step.wrapping_sub(one[k]) + four.wrapping_sub(group[k]);
        *value = value.wrapping_add(half + (lost >> 1));
    }
    let step = word(one);
    [step, word(group).wrapping_sub(step.wrapping_mul(GROUP as u32))]
}

/// Draws a span with one addition a pixel for all three channels, for formats of 5 or 6 bits a channel.
///
/// # Format
/// Steps of one pixel and of four are rounded to 8.3 and 8.2, by at most e = 1/16 and 1/8. Each run of 8 pixels starts
/// from the exact values, moved so that the rounding cancels in its middle: at most 1.5 steps of a pixel and half a step
/// of a group away it is 2 e, 1/4 for green, 1/8 for the others; with the rounding of the word below 0.375. Squeezed
/// channels are off by at most 1/2, and by 1/16 from the records (1/8 for red): in all, within 1 of 255 before the lower
/// bits are cut. And 0.5..=254.5 is far enough from the ends that no channel runs into its neighbour.
#[inline(never)]
pub(super) fn packed_span<P: PixelFormat, D: DepthTest>(span: Fragments<'_, P, [i32; 3], D::Stored>, test: D) {
    let Fragments { color, depth, z, varyings, steps, position } = span;
    let [step, correction] = steps.words;
    let mut pen = Pen { z, dz_dx: steps.dz_dx, word: word(spread::<P>(varyings)), step, mask: P::packed_mask() };
    let [mut r, mut g, mut b] = varyings;
    let addends = P::dither(position);
    let mut colors = color.chunks_exact_mut(RUN);
    let mut depths = depth.chunks_exact_mut(RUN);
    for run in (&mut colors).zip(&mut depths) {
        // Hidden from the compiler: it would prepare all multiples of the step, and spill them.
        pen.dz_dx = core::hint::black_box(pen.dz_dx);
        // Spelled out: at `opt-level = "s"` a loop would stay a loop.
        let ([a, b0, c, d, e, f, g0, h], [az, bz, cz, dz, ez, fz, gz, hz]) = run else { return };
        pen.draw::<P, D>(test, addends[0], a, az);
        pen.draw::<P, D>(test, addends[1], b0, bz);
        pen.draw::<P, D>(test, addends[2], c, cz);
        pen.draw::<P, D>(test, addends[3], d, dz);
        pen.word = pen.word.wrapping_add(correction);
        pen.draw::<P, D>(test, addends[4], e, ez);
        pen.draw::<P, D>(test, addends[5], f, fz);
        pen.draw::<P, D>(test, addends[6], g0, gz);
        pen.draw::<P, D>(test, addends[7], h, hz);
        r = r.wrapping_add(RUN as i32 * steps.d_dx[0]);
        g = g.wrapping_add(RUN as i32 * steps.d_dx[1]);
        b = b.wrapping_add(RUN as i32 * steps.d_dx[2]);
        pen.word = word(spread::<P>([r, g, b]));
    }
    let (mut color, mut depth) = (colors.into_remainder(), depths.into_remainder());
    let [_, _, _, _, last @ ..] = addends;
    let mut rest: &[u32] = addends;
    if color.len() >= GROUP {
        let ([a, b, c, d, color_rest @ ..], [az, bz, cz, dz, depth_rest @ ..]) = (color, depth) else { return };
        pen.draw::<P, D>(test, addends[0], a, az);
        pen.draw::<P, D>(test, addends[1], b, bz);
        pen.draw::<P, D>(test, addends[2], c, cz);
        pen.draw::<P, D>(test, addends[3], d, dz);
        pen.word = pen.word.wrapping_add(correction);
        (color, depth, rest) = (color_rest, depth_rest, last);
    }
    for (k, (color, depth)) in color.iter_mut().zip(depth).enumerate() {
        pen.draw::<P, D>(test, rest.get(k).copied().unwrap_or(0), color, depth);
    }
}

/// What changes from pixel to pixel in [`packed_span`].
struct Pen {
    z: u32,
    dz_dx: i32,
    word: u32,
    step: u32,
    mask: u32,
}

impl Pen {
    /// Draws a pixel and steps to the next one.
    #[inline(always)]
    fn draw<P: PixelFormat, D: DepthTest>(&mut self, test: D, addend: u32, color: &mut P::Raw, depth: &mut D::Stored) {
        let z = (self.z >> 16) as u16;
        if !D::ENABLED || test.passes(z, *depth) {
            test.write(z, depth);
            let word = if P::DITHER.is_some() { self.word.wrapping_add(addend) } else { self.word };
            *color = P::from_packed(word, self.mask);
        }
        self.z = self.z.wrapping_add_signed(self.dz_dx);
        self.word = self.word.wrapping_add(self.step);
    }
}
