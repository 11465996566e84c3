//! One colour a face.

use super::dither::dithered_span;
use super::fill::fill;
use super::{DepthTest, Fragment, Fragments, PixelFormat, Shader};
use crate::geometry::{Corner, Face, Light, Lit, VertexShader};

/// Flat shading: each triangle in one colour, lit by its face normal.
///
/// The colour is the shader's, or that of the provoking vertex.
#[derive(Clone, Copy, Debug)]
pub struct Flat {
    paint: Paint,
}

/// Where a face's colour comes from.
#[derive(Clone, Copy, Debug)]
enum Paint {
    /// One colour.
    Color([u8; 3]),
    /// One colour under a light.
    Lit(Lit),
    /// The provoking vertices' colours.
    Colors,
    /// The same under a light.
    LitColors(Light),
}

impl Flat {
    /// A colour under a light (given in object space, see [`Light::to_object`]).
    pub fn new(light: Light, color: impl Into<embedded_graphics_core::pixelcolor::Rgb888>) -> Self {
        Self { paint: Paint::Lit(light.on(channels(color.into()))) }
    }

    /// A colour without light.
    pub fn unlit(color: impl Into<embedded_graphics_core::pixelcolor::Rgb888>) -> Self {
        Self { paint: Paint::Color(channels(color.into())) }
    }

    /// The colours of the mesh's vertices as they are, the provoking one's a triangle.
    pub const fn colors_unlit() -> Self {
        Self { paint: Paint::Colors }
    }

    /// The colours of the mesh's vertices (the provoking one's a triangle) under a light.
    pub const fn colors(light: Light) -> Self {
        Self { paint: Paint::LitColors(light) }
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
        let [r, g, b] = match &self.paint {
            Paint::Color([r, g, b]) => return u32::from_be_bytes([0, *r, *g, *b]),
            Paint::Lit(lit) => lit.shade(face.normal()),
            Paint::Colors => {
                let [r, g, b] = face.provoking().color();
                return u32::from_be_bytes([0, r, g, b]);
            }
            Paint::LitColors(light) => light.shade(face.provoking().color(), face.normal()),
        };
        u32::from_be_bytes([0, round(r), round(g), round(b)])
    }
}

/// 8.8 to 8 bits, to nearest; 255.0 is the largest value there is.
pub(super) const fn round(channel: i32) -> u8 {
    ((channel + 128) >> 8) as u8
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

/// Draws a span in the colour of a face's word.
#[inline]
pub(super) fn flat_span<P: PixelFormat, D: DepthTest>(face: u32, span: Fragments<'_, P, [i32; 0], D::Stored>, test: D) {
    if P::DITHER.is_some() {
        return dithered_span(unpacked(face), span, test);
    }
    let Fragments { color, depth, mut z, steps, .. } = span;
    let dz_dx = steps.dz_dx;
    let value = P::pack(unpacked(face));
    if !D::ENABLED {
        return fill(color, value);
    }
    for (color, depth) in color.iter_mut().zip(depth) {
        let near = (z >> 16) as u16;
        if test.passes(near, *depth) {
            test.write(near, depth);
            *color = value;
        }
        z = z.wrapping_add_signed(dz_dx);
    }
}
