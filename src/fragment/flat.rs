//! One colour a face.

use super::depth::{RUN, passing};
use super::dither::dithered_span;
use super::fill::fill;
use super::{DepthTest, Fragment, Fragments, PixelFormat, Shader};
use crate::geometry::{Corner, Face, Light, VertexShader};
use crate::math::SMALL_CORE;
use core::hint::black_box;

/// Flat shading: each triangle in one colour, lit by its face normal.
///
/// The colour is the shader's, or that of the provoking vertex.
#[derive(Clone, Copy, Debug)]
pub struct Flat {
    /// Red, green and blue in a word, blue lowest; otherwise the provoking vertices'.
    color: Option<u32>,
    light: Option<Light>,
}

impl Flat {
    /// A colour under a light (given in object space, see [`Light::to_object`]).
    pub fn new(light: Light, color: impl Into<embedded_graphics_core::pixelcolor::Rgb888>) -> Self {
        Self { color: Some(packed(channels(color.into()))), light: Some(light) }
    }

    /// A colour without light.
    pub fn unlit(color: impl Into<embedded_graphics_core::pixelcolor::Rgb888>) -> Self {
        Self { color: Some(packed(channels(color.into()))), light: None }
    }

    /// The colours of the mesh's vertices as they are, the provoking one's a triangle.
    pub const fn colors_unlit() -> Self {
        Self { color: None, light: None }
    }

    /// The colours of the mesh's vertices (the provoking one's a triangle) under a light.
    pub const fn colors(light: Light) -> Self {
        Self { color: None, light: Some(light) }
    }
}

/// Red, green, blue.
pub(super) fn channels(color: embedded_graphics_core::pixelcolor::Rgb888) -> [u8; 3] {
    use embedded_graphics_core::pixelcolor::RgbColor;
    [color.r(), color.g(), color.b()]
}

impl VertexShader for Flat {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &Corner<'_>) -> [i32; 0] {
        []
    }

    /// The colour, 8 bits a channel, blue lowest.
    #[inline]
    fn face(&self, face: &Face<'_>) -> u32 {
        let color = match self.color {
            Some(color) => color,
            None => packed(face.provoking().color()),
        };
        match &self.light {
            Some(light) => light.shade(color, face.normal()),
            None => color,
        }
    }
}

/// 8.8 to 8 bits, to nearest; 255.0 is the largest value there is.
pub(super) const fn round(channel: i32) -> u8 {
    ((channel + 128) >> 8) as u8
}

/// The word of a face of this colour.
const fn packed([r, g, b]: [u8; 3]) -> u32 {
    u32::from_be_bytes([0, r, g, b])
}

/// The colour of a face, from its word.
#[inline(always)]
pub(super) const fn unpacked(face: u32) -> [u8; 3] {
    let [_, r, g, b] = face.to_be_bytes();
    [r, g, b]
}

impl<P: PixelFormat> Shader<P> for Flat {
    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        Some(P::pack_at(unpacked(fragment.face), fragment.position))
    }

    #[inline]
    fn span<D: DepthTest>(&self, face: u32, span: Fragments<'_, P, [i32; 0], D::Stored>, test: D) {
        flat_span(face, span, test);
    }
}

/// Pixels from which on a call is worth it.
const LONG: usize = 9;

/// Draws a span in the colour of a face's word.
#[inline]
pub(super) fn flat_span<P: PixelFormat, D: DepthTest>(face: u32, span: Fragments<'_, P, [i32; 0], D::Stored>, test: D) {
    if P::DITHER.is_some() {
        return dithered_span(unpacked(face), span, test);
    }
    let Fragments { color, depth, z, steps, .. } = span;
    let value = P::pack(unpacked(face));
    if !D::ENABLED {
        return fill(color, value);
    }
    if color.len() >= LONG {
        return tested_span(color, depth, z, steps.dz_dx, value, test);
    }
    let (mut z, dz_dx) = (z, steps.dz_dx);
    for (color, depth) in color.iter_mut().zip(depth) {
        let near = (z >> 16) as u16;
        if test.passes(near, *depth) {
            test.write(near, depth);
            *color = value;
        }
        z = z.wrapping_add_signed(dz_dx);
    }
}

/// One value where the depth test passes, in a long span. Out of line: amid others, the loops would not get the registers that
/// they need.
#[inline(never)]
fn tested_span<R: Copy, D: DepthTest>(
    mut color: &mut [R],
    depth: &mut [D::Stored],
    mut z: u32,
    mut dz_dx: i32,
    value: R,
    test: D,
) {
    let Some(mut depth) = depth.get_mut(..color.len()) else { return };
    while SMALL_CORE && color.len() >= RUN {
        let Some((colors, rest)) = core::mem::take(&mut color).split_first_chunk_mut::<RUN>() else { return };
        color = rest;
        let Some((depths, rest)) = core::mem::take(&mut depth).split_first_chunk_mut::<RUN>() else { return };
        depth = rest;
        run(test, &mut z, dz_dx, value, colors, depths);
    }
    while !SMALL_CORE && color.len() >= 4 {
        // Spelled out: at `opt-level = "s"` a loop would stay a loop.
        let Some(([a, b, c, d], rest)) = core::mem::take(&mut color).split_first_chunk_mut::<4>() else { return };
        color = rest;
        let Some(([az, bz, cz, dz], rest)) = core::mem::take(&mut depth).split_first_chunk_mut::<4>() else { return };
        depth = rest;
        if !draw(test, &mut z, dz_dx, value, a, az) {
            // As if it changed: the compiler would otherwise prepare all multiples of the step, and spill them.
            dz_dx = black_box(dz_dx);
        }
        draw(test, &mut z, dz_dx, value, b, bz);
        draw(test, &mut z, dz_dx, value, c, cz);
        draw(test, &mut z, dz_dx, value, d, dz);
    }
    for (color, depth) in color.iter_mut().zip(depth) {
        draw(test, &mut z, dz_dx, value, color, depth);
    }
}

/// Draws a run, depths first and colours then.
#[inline(always)]
fn run<R: Copy, D: DepthTest>(
    test: D,
    z: &mut u32,
    dz_dx: i32,
    value: R,
    colors: &mut [R; RUN],
    depths: &mut [D::Stored; RUN],
) {
    let passed = passing(test, depths, *z, dz_dx);
    if passed == RUN {
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = colors;
        (*a, *b, *c, *d, *e, *f, *g, *h) = (value, value, value, value, value, value, value, value);
        (*i, *j, *k, *l, *m, *n, *o, *p) = (value, value, value, value, value, value, value, value);
        *z = z.wrapping_add_signed(dz_dx.wrapping_mul(RUN as i32));
        return;
    }
    for (k, (color, depth)) in colors.iter_mut().zip(depths).enumerate() {
        if k < passed {
            *color = value;
            *z = z.wrapping_add_signed(dz_dx);
        } else {
            draw(test, z, dz_dx, value, color, depth);
        }
    }
}

/// Draws a pixel, if it passes, and steps to the next one.
#[inline(always)]
fn draw<R: Copy, D: DepthTest>(
    test: D,
    z: &mut u32,
    dz_dx: i32,
    value: R,
    color: &mut R,
    depth: &mut D::Stored,
) -> bool {
    let near = (*z >> 16) as u16;
    let passes = test.passes(near, *depth);
    if passes {
        test.write(near, depth);
        *color = value;
    }
    *z = z.wrapping_add_signed(dz_dx);
    passes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fragment::LessWrite;

    #[test]
    fn runs_in_two_are_those_pixel_by_pixel() {
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state ^ state >> 15
        };
        for case in 0..2000 {
            let (z, dz_dx) = (random() >> 1, random() as i32 >> 12);
            // All pass, all but a few, few.
            let far = [0, 1, 5, 13][case % 4];
            let depths: [u16; RUN] = core::array::from_fn(|_| if random() % 16 < far { 0 } else { u16::MAX });
            let (mut expected, mut found) = (([0_u16; RUN], depths, z), ([0_u16; RUN], depths, z));
            for (color, depth) in expected.0.iter_mut().zip(&mut expected.1) {
                draw(LessWrite, &mut expected.2, dz_dx, 7, color, depth);
            }
            run(LessWrite, &mut found.2, dz_dx, 7, &mut found.0, &mut found.1);
            assert_eq!(found, expected, "{case}");
        }
    }
}
