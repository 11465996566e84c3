//! Spans of repeating textures under light, with nearest texels.
//!
//! The plain loop, over u q, v q, q = 1 / w and light, which are linear on the screen:
//!
//! ```text
//! for each pixel:
//!     if z >> 16 passes against the stored depth:
//!         color = texel(uq / q, vq / q) · light
//!         store z >> 16, unless the texel is transparent
//!     z += dz_dx;  uq += duq;  vq += dvq;  q += dq;  light += dlight
//! ```
//! u and v are divided at columns of the screen that are apart, as [`texture_span`](super::textured::texture_span) has
//! it. Light is computed anew at each of these columns, and stepped in two words in between, as small triangles have it
//! ([`texels`](super::texels)): 16 steps are off by at most 9 units, 0.07 of 255.

use super::depth::DepthTest;
use super::span::{Primitive, Span};
use super::texels::{Light, TexelSource};
use super::uv_stepper::UvStepper;
use crate::color::PixelFormat;
use crate::vertex::Varyings;

/// Draws a span of a repeating texture under light. The first two varyings are u and v in 16.16, the next three are
/// red, green and blue of the light, 8.16. The stepper is that of the span.
#[inline(never)]
pub(crate) fn lit_texture_span<P: PixelFormat, S: TexelSource<P>, D: DepthTest, V: Varyings, U>(
    texture: &S::Texture,
    span: Span<'_, P, V, U, D::Depth>,
    test: D,
    stepper: &mut UvStepper,
) {
    let Span { mut color, mut depth, z, position: (x, y), primitive } = span;
    stepper.z = z;
    // Moves on to the first column. The first run may begin between two of them.
    stepper.next_run();
    let step = 1 << (stepper.log_step & 31);
    let mut back = stepper.back;
    let mut column = x.wrapping_sub(back as i32);
    let change = change::<P, S, V, U>(primitive);
    while !color.is_empty() {
        let pixels = (step - back as usize).min(color.len());
        let Some((colors, rest)) = core::mem::take(&mut color).split_at_mut_checked(pixels) else { return };
        color = rest;
        let Some((depths, rest)) = core::mem::take(&mut depth).split_at_mut_checked(pixels) else { return };
        depth = rest;
        let (vu, vu_step) = stepper.next_run();
        let light = light::<P, S, V, U>(primitive, (column, y));
        let from = |at: u32, step: u32| at.wrapping_add(step.wrapping_mul(back));
        let run = Run {
            vu: from(vu, vu_step),
            vu_step,
            light: [from(light[0], change[0]), from(light[1], change[1])],
            change,
            position: (column.wrapping_add(back as i32), y),
        };
        run.draw::<P, S, D>(texture, test, stepper, colors, depths);
        column = column.wrapping_add(step as i32);
        back = 0;
    }
}

/// Returns whether light is in 0..=255 all along a span, but for rounding. Light is linear: its ends tell.
///
/// # Format
/// A plane leaves the range of its corners by less than 1/8, 2¹³ in 8.16. [`Light`] has room for three times as much.
#[inline(never)]
pub(crate) fn is_light_in_range<P: PixelFormat, V: Varyings, U, Z>(span: &Span<'_, P, V, U, Z>) -> bool {
    let (x, y) = span.position;
    let last = x.wrapping_add(span.color.len() as i32).wrapping_sub(1);
    let is_light = |c: i32| (-(1 << 13)..(255 << 16) + (1 << 13)).contains(&c);
    [x, last].into_iter().all(|x| channels(&span.primitive.at((x, y))).into_iter().all(is_light))
}

/// The pixels between two columns at which coordinates are divided.
struct Run {
    vu: u32,
    vu_step: u32,
    light: [u32; 2],
    change: [u32; 2],
    position: (i32, i32),
}

impl Run {
    /// Draws the run. Out of line: its values take all registers.
    #[inline(never)]
    fn draw<P: PixelFormat, S: TexelSource<P>, D: DepthTest>(
        self,
        texture: &S::Texture,
        test: D,
        stepper: &mut UvStepper,
        colors: &mut [P::Raw],
        depths: &mut [D::Depth],
    ) {
        let Self { mut vu, vu_step, mut light, change, mut position } = self;
        let (mut z, dz_dx) = (stepper.z, stepper.dz_dx);
        for (color, stored) in colors.iter_mut().zip(depths) {
            let depth = (z >> 16) as u16;
            if !D::ENABLED || test.passes(depth, *stored) {
                let uv = [(vu & 0xFFFF) as i32, (vu >> 16) as i32];
                if let Some(pixel) = S::pixel(texture, uv, Light(light), position) {
                    test.write(depth, stored);
                    *color = pixel;
                }
            }
            z = z.wrapping_add_signed(dz_dx);
            vu = vu.wrapping_add(vu_step);
            light = [light[0].wrapping_add(change[0]), light[1].wrapping_add(change[1])];
            position.0 = position.0.wrapping_add(1);
        }
        stepper.z = z;
    }
}

/// Returns red, green and blue of varyings.
#[inline(always)]
fn channels<V: Varyings>(varyings: &V) -> [i32; 3] {
    match varyings.as_ref() {
        [_, _, r, g, b, ..] => [*r, *g, *b],
        _ => [0; 3],
    }
}

/// Returns the light at a pixel.
#[inline(never)]
fn light<P: PixelFormat, S: TexelSource<P>, V: Varyings, U>(primitive: &Primitive<V, U>, at: (i32, i32)) -> [u32; 2] {
    Light::of_channels(channels(&primitive.at(at)), S::RGB565).0
}

/// Returns the change of light from a pixel to its right neighbour.
#[inline(never)]
fn change<P: PixelFormat, S: TexelSource<P>, V: Varyings, U>(primitive: &Primitive<V, U>) -> [u32; 2] {
    Light::of_changes(channels(&primitive.d_dx), S::RGB565)
}
