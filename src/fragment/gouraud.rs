//! Colours a vertex, interpolated over the triangle.

use super::flat::channels;
use super::shader::fragments;
use super::{DepthTest, Fragments, PixelFormat, Shader};
use crate::geometry::{Corner, Light, Lit, VertexShader};
use embedded_graphics_core::pixelcolor::Rgb888;

/// Gouraud shading: lit at the vertices, by the mesh's normals, and interpolated linearly on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Gouraud {
    light: Option<Light>,
    /// One colour for the whole mesh, lit; otherwise the mesh's colours count.
    lit: Option<Lit>,
}

impl Gouraud {
    /// One colour under a light (given in object space, see [`Light::to_object`]).
    pub fn new(light: Light, color: impl Into<Rgb888>) -> Self {
        Self {
            light: Some(light),
            lit: Some(light.on(channels(color.into()))),
        }
    }

    /// The colours of the mesh's vertices under a light.
    pub const fn colors(light: Light) -> Self {
        Self {
            light: Some(light),
            lit: None,
        }
    }

    /// The colours of the mesh's vertices as they are.
    pub const fn unlit() -> Self {
        Self { light: None, lit: None }
    }
}

/// Channels are interpolated as (c + 1/2) 255 / 256: so they stay half a step away from both ends of their 8 bits, which
/// leaves [`packed_span`] room for its errors.
const fn squeeze(c: i32) -> i32 {
    let c = (c << 8) + (1 << 15);
    c - (c >> 8)
}

/// The integer nearest to the channel that was squeezed.
const fn unsqueeze(c: i32) -> u8 {
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
        let [r, g, b] = *rgb;
        let packed = ((r + (1 << 13)) >> 14) << 22 | ((g + (1 << 12)) >> 13) << 11 | (b + (1 << 12)) >> 13;
        if let [word] = words {
            *word = packed as u32;
        }
    }

    #[inline]
    fn load(words: &[u32]) -> [i32; 3] {
        let word = words.first().copied().unwrap_or(0);
        let channel = |bits: u32| (bits << 13) as i32;
        [
            channel(word >> 22 << 1),
            channel((word >> 11) & 0x7FF),
            channel(word & 0x7FF),
        ]
    }
}

impl<P: PixelFormat> Shader<P> for Gouraud {
    #[inline]
    fn fragment(&self, _: u32, rgb: &[i32; 3]) -> P::Raw {
        P::pack(rgb.map(unsqueeze))
    }

    #[inline]
    fn span<D: DepthTest>(&self, face: u32, span: Fragments<'_, P, [i32; 3]>, test: D) {
        if P::PACKED {
            packed_span(span, test);
        } else {
            fragments(self, face, span, test);
        }
    }
}

/// Pixels that one packed word is stepped over before it is made anew.
const RUN: usize = 5;

/// A word of three channels: red 8.3 in the upper 11 bits, blue 8.3 in the next 11, green 8.2 in the lower 10.
///
/// It stands for red 2²¹ + blue 2¹⁰ + green, so steps of either sign may be added as words, as long as each channel stays
/// in range.
#[inline(always)]
const fn pack(r: i32, g: i32, b: i32) -> u32 {
    ((r as u32) << 21).wrapping_add((b as u32) << 10).wrapping_add(g as u32)
}

/// Draws a span with one addition a pixel for all three channels, for formats of 5 or 6 bits a channel.
///
/// # Format
/// Steps are rounded to 8.3 and 8.2, by at most 1/16 and 1/8. Each run of 5 pixels starts from the exact values, moved
/// so that the rounding cancels in its middle: 2 steps away it is 1/4 for green, 1/8 for the others; with the rounding of
/// the word below 0.375. Squeezed channels are off by at most 1/2, and by 1/16 from the records (1/8 for red): in all,
/// within 1 of 255 before the lower bits are cut. And 0.5..=254.5 is far enough from the ends that no channel runs into
/// its neighbour.
#[inline(always)]
fn packed_span<P: PixelFormat, D: DepthTest>(span: Fragments<'_, P, [i32; 3]>, test: D) {
    let Fragments {
        color,
        depth,
        mut z,
        dz_dx,
        varyings,
        d_dx,
        ..
    } = span;
    // 8.16 → 8.3 or 8.2, rounded.
    let [dr, dg, db] = [
        (d_dx[0] + (1 << 12)) >> 13,
        (d_dx[1] + (1 << 13)) >> 14,
        (d_dx[2] + (1 << 12)) >> 13,
    ];
    let step = pack(dr, dg, db);
    let [mut r, mut g, mut b] = varyings;
    if color.len() > 2 {
        // What the steps miss on the way to the middle.
        r += 2 * (d_dx[0] - (dr << 13));
        g += 2 * (d_dx[1] - (dg << 14));
        b += 2 * (d_dx[2] - (db << 13));
    }
    let start = |r: i32, g: i32, b: i32| pack((r + (1 << 12)) >> 13, (g + (1 << 13)) >> 14, (b + (1 << 12)) >> 13);
    let mut pixel = |word: u32, color: &mut P::Raw, depth: &mut u16| {
        if !D::ENABLED || test.passes((z >> 16) as u16, depth) {
            *color = P::from_packed(word);
        }
        z = z.wrapping_add_signed(dz_dx);
    };
    let mut colors = color.chunks_exact_mut(RUN);
    let mut depths = depth.chunks_exact_mut(RUN);
    for (colors, depths) in (&mut colors).zip(&mut depths) {
        let mut word = start(r, g, b);
        for (color, depth) in colors.iter_mut().zip(depths) {
            pixel(word, color, depth);
            word = word.wrapping_add(step);
        }
        r = r.wrapping_add(RUN as i32 * d_dx[0]);
        g = g.wrapping_add(RUN as i32 * d_dx[1]);
        b = b.wrapping_add(RUN as i32 * d_dx[2]);
    }
    let mut word = start(r, g, b);
    for (color, depth) in colors.into_remainder().iter_mut().zip(depths.into_remainder()) {
        pixel(word, color, depth);
        word = word.wrapping_add(step);
    }
}
