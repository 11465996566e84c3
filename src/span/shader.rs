//! The seam of the fragment stage, and the loops that call a shader for the pixels of a span.

use super::brush::{SmallResult, SmallTriangle};
use super::depth::{DepthDyn, DepthState, DepthTest};
use super::perspective::{correct_at, longest_log_step, straight_log_step};
use super::sample::Sample;
use super::span::{Fragment, Primitive, Span, TriangleSetup};
use crate::color::PixelFormat;
use crate::vertex::{MAX_IN_REGISTERS, PackedCorners, Varyings, VertexShader};

/// The programmable fragment stage: colours pixels of format `P`.
///
/// A shader is compiled into the pixel loop; nothing is called indirectly.
///
/// # A shader from scratch
///
/// A toon shader: a texture in three tones of light, whose transparent texels are left out. The pipeline calls its
/// functions in this order:
///
/// 1. [`VertexShader::vertex`], once per vertex of visible triangles while records are used, otherwise at most once per
///    corner of a triangle. It returns the varyings: here, texture coordinates that are
///    [perspective-correct](crate::vertex::Perspective), and one varying that is linear on the screen.
/// 2. [`VertexShader::face`], once per visible triangle, for a word that is constant on it. It is not used here.
/// 3. [`setup`](Self::setup), once per triangle and strip, for data that all fragments of the triangle share. Here,
///    that is the brightness of the triangle.
/// 4. [`span`](Self::span), once per row of a triangle. It is not overridden here, so it draws fragment by fragment.
/// 5. [`fragment`](Self::fragment), once per pixel that passes the depth test. `None` leaves the pixel and its depth as
///    they were.
///
/// ```
/// use zstrip::color::PixelFormat;
/// use zstrip::prelude::*;
/// use zstrip::span::{Fragment, Shader, TriangleSetup};
/// use zstrip::vertex::{Perspective, VertexRef, VertexShader};
///
/// struct Toon {
///     /// Red, green, blue and opacity of 4 × 4 texels.
///     texels: [[[u8; 4]; 4]; 4],
/// }
///
/// impl VertexShader for Toon {
///     /// u and v in 16.16, perspective-correct; brightness, linear. The third number counts one more, for 1 / w.
///     type Varyings = Perspective<2, 4>;
///
///     fn vertex(&self, vertex: &VertexRef<'_>) -> Perspective<2, 4> {
///         let [u, v] = vertex.uv();
///         // The light comes from the viewer: the brightness is z of the normal, 2.14.
///         let [_, _, z] = vertex.normal();
///         Perspective::new([u.to_bits(), v.to_bits()], [i32::from(z).max(0) << 8])
///     }
/// }
///
/// /// How bright a triangle is, in 256ths.
/// #[derive(Clone, Copy, Default)]
/// struct Tone(u32);
///
/// impl<P: PixelFormat> Shader<P> for Toon {
///     /// Coordinates are divided at every eighth pixel.
///     const STEP: usize = 8;
///     type Setup = Tone;
///
///     fn setup(&self, triangle: &TriangleSetup<'_, Perspective<2, 4>>) -> Tone {
///         let brightness: i32 = triangle.corners.iter().map(|corner| corner.linear()[0] / 3).sum();
///         Tone(match brightness >> 8 {
///             ..5_000 => 64,
///             ..12_000 => 160,
///             _ => 256,
///         })
///     }
///
///     fn fragment(&self, fragment: &Fragment<'_, Perspective<2, 4>, Tone>) -> Option<P::Raw> {
///         // 16.16 to texels: two bits after the point, repeated.
///         let [column, row] = fragment.varyings.corrected().map(|c| (c >> 14) as usize & 3);
///         let [r, g, b, opacity] = self.texels[row][column];
///         if opacity < 128 {
///             return None;
///         }
///         let Tone(tone) = *fragment.setup;
///         let [r, g, b] = [r, g, b].map(|channel| (u32::from(channel) * tone >> 8) as u8);
///         Some(P::pack_at([r, g, b], fragment.position))
///     }
/// }
///
/// // A square that fills the screen and faces the viewer; its texture is white, but for a hole in the first texel.
/// let at = |x, y| [x, y, 0, 1].map(|c| Scalar::from_bits(c << 16));
/// let corners = [at(-1, 1), at(-1, -1), at(1, -1), at(1, 1)];
/// let uvs = [[0, 0], [0, 1], [1, 1], [1, 0]].map(|uv| uv.map(|c| Scalar::from_bits(c << 16)));
/// let normals = [[0, 0, 10_000]; 4];
/// let data = MeshData { uvs: Some(&uvs), normals: Some(&normals), ..MeshData::new(Positions::Homogeneous(&corners)) };
/// let square = Mesh::new(MeshData { topology: Topology::Fan, ..data })?;
/// let mut toon = Toon { texels: [[[255; 4]; 4]; 4] };
/// toon.texels[0][0][3] = 0;
///
/// let mut pixels = [0; 16 * 16];
/// let mut depth = [u16::MAX; 16 * 16];
/// let mut renderer = Renderer::<Rgb565>::new(Size::new(16, 16))?.with_depth(&mut depth)?;
/// let mut frame = renderer.begin(Rgb888::BLUE);
/// while frame.next_strip(&mut pixels, |scene| scene.draw(&square, &Projective::IDENTITY, &toon))?.is_some() {}
///
/// // The background through the hole; 160/256 of white elsewhere.
/// assert_eq!(pixels[0], Rgb565::pack([0, 0, 255]));
/// assert_eq!(pixels[3 * 16 + 3], Rgb565::pack([0, 0, 255]));
/// assert_eq!(pixels[4], Rgb565::pack([159; 3]));
/// assert_eq!(pixels[15 * 16 + 15], Rgb565::pack([159; 3]));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub trait Shader<P: PixelFormat>: VertexShader {
    /// Number of pixels over which perspective-correct varyings are taken as linear. 1 divides at each pixel. 2, 4, 8,
    /// 16 or 32 divide at the columns of the screen that are multiples of it; that is faster, and off by little, see
    /// [`Perspective`](crate::vertex::Perspective#sub-spans).
    const STEP: usize = 1;

    /// Data that [`setup`](Self::setup) computes once per triangle for its fragments and spans; `()` for most shaders.
    type Setup: Copy + Default;

    /// Computes the shader's data of a triangle, before its spans are drawn. Lines and points are set up once as well.
    #[inline(always)]
    fn setup(&self, triangle: &TriangleSetup<'_, Self::Varyings>) -> Self::Setup {
        let _ = triangle;
        Self::Setup::default()
    }

    /// Computes the colour of a fragment that passed the depth test. `None` discards the fragment, and leaves the pixel
    /// and its depth as they were.
    fn fragment(&self, fragment: &Fragment<'_, Self::Varyings, Self::Setup>) -> Option<P::Raw>;

    /// Colours a pixel and returns `true`, or discards the fragment and returns `false`. Only shaders that blend with
    /// the pixel that is there, or leave it as it is and write its depth, have to override it.
    #[inline(always)]
    fn paint(&self, fragment: &Fragment<'_, Self::Varyings, Self::Setup>, pixel: &mut P::Raw) -> bool {
        match self.fragment(fragment) {
            Some(value) => {
                *pixel = value;
                true
            }
            None => false,
        }
    }

    /// Colours a sample of a pixel, or discards the fragment there. By default, this function does as
    /// [`paint`](Self::paint). Only shaders that tell samples apart, as
    /// [alpha to coverage](crate::shader::AlphaToCoverage) does, have to override it, together with
    /// [`span_at`](Self::span_at). At [`Sample::ONLY`], both have to do as `paint` and [`span`](Self::span).
    #[inline(always)]
    fn paint_at(
        &self,
        sample: Sample,
        fragment: &Fragment<'_, Self::Varyings, Self::Setup>,
        pixel: &mut P::Raw,
    ) -> bool {
        let _ = sample;
        self.paint(fragment, pixel)
    }

    /// Draws a span, by default fragment by fragment. Override it where a whole span can be drawn faster. It has to
    /// leave the pixels and depths that [`paint`](Self::paint) leaves: [`Smooth`](crate::scene::Smooth) strokes call
    /// `paint_at` for each pixel, and never this function.
    #[inline]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        draw_fragments(self, span, test);
    }

    /// Draws a span of one sample of each pixel: by [`span`](Self::span), unless the shader tells samples apart. It has
    /// to leave the pixels and depths that [`paint_at`](Self::paint_at) leaves. With one sample per pixel, triangles
    /// are drawn by `span`, and most other things by this function.
    #[inline(always)]
    fn span_at<D: DepthTest>(&self, sample: Sample, span: SpanOf<'_, P, Self, D>, test: D) {
        let _ = sample;
        self.span(span, test);
    }

    /// Draws a triangle, if it is small: by [`span`](Self::span), unless the shader knows a shorter way. A shader whose
    /// spans are another shader's may pass the call on to that shader.
    ///
    /// A triangle that goes on from the strip above brings its state along: its corners' varyings say nothing then.
    #[inline(always)]
    fn small<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &[Self::Varyings; 3],
        flat: u32,
    ) -> SmallResult {
        triangle.draw_spans(self, corners, flat)
    }

    /// Set if small triangles are drawn from packed varyings, by [`small_packed`](Self::small_packed). Such a shader
    /// has at most 4 [`WORDS`](VertexShader::WORDS).
    const PACKS_SMALL: bool = false;

    /// Draws a triangle, if it is small, from the words that [`store`](VertexShader::store) packed at its corners. A
    /// shader whose spans are another shader's may pass the call on to that shader.
    ///
    /// A triangle that goes on from the strip above brings its state along: its corners' words say nothing then.
    #[inline(always)]
    fn small_packed<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &PackedCorners<'_>,
    ) -> SmallResult {
        let _ = (triangle, corners);
        SmallResult::Large
    }
}

/// The [`Span`] that a shader `S` draws under a depth test `D`.
pub type SpanOf<'a, P, S, D> =
    Span<'a, P, <S as VertexShader>::Varyings, <S as Shader<P>>::Setup, <D as DepthTest>::Depth>;

/// Number of pixels that are drawn at a time where there is no depth buffer.
const CHUNK: usize = 16;

/// Draws a span fragment by fragment.
#[inline]
pub(crate) fn draw_fragments<P: PixelFormat, S: Shader<P> + ?Sized, D: DepthTest>(
    shader: &S,
    span: SpanOf<'_, P, S, D>,
    test: D,
) {
    if S::Varyings::PERSPECTIVE > 0 {
        corrected_fragments(shader, span, test);
    } else {
        uncorrected_fragments(shader, span, test);
    }
}

#[inline(always)]
fn uncorrected_fragments<P: PixelFormat, S: Shader<P> + ?Sized, D: DepthTest>(
    shader: &S,
    span: SpanOf<'_, P, S, D>,
    test: D,
) {
    let mut varyings = span.varyings();
    let Span { color, depth, z, position, primitive } = span;
    let mut pixels = Pixels { z, varyings: &mut varyings, primitive, position, test: DepthDyn::new(DepthState::OFF) };
    if !D::ENABLED {
        return fragments_without_depth(shader, color, &mut pixels);
    }
    if let Some((test, depth)) = test.as_dyn(depth) {
        pixels.test = test;
        linear_fragments(shader, color, depth, &mut pixels);
    }
}

/// Draws a span in the loop of [`linear_fragments`]. That loop needs stored depths, so it gets an array
/// of its own, under a test that always passes.
#[inline(never)]
fn fragments_without_depth<P: PixelFormat, S: Shader<P> + ?Sized>(
    shader: &S,
    color: &mut [P::Raw],
    pixels: &mut Pixels<'_, S::Varyings, S::Setup>,
) {
    let mut nothing = [0; CHUNK];
    for chunk in color.chunks_mut(CHUNK) {
        linear_fragments(shader, chunk, &mut nothing, pixels);
    }
}

/// State of [`linear_fragments`]: its place in a span, and all that changes from pixel to pixel.
struct Pixels<'a, V: Varyings, T> {
    z: u32,
    varyings: &'a mut V,
    primitive: &'a Primitive<V, T>,
    position: (i32, i32),
    test: DepthDyn,
}

/// Draws a span fragment by fragment, in the one loop that a shader is compiled into.
#[inline(never)]
fn linear_fragments<P: PixelFormat, S: Shader<P> + ?Sized>(
    shader: &S,
    color: &mut [P::Raw],
    depth: &mut [u16],
    pixels: &mut Pixels<'_, S::Varyings, S::Setup>,
) {
    if <S::Varyings as Varyings>::LEN > MAX_IN_REGISTERS {
        return paint_pixels(shader, color, depth, pixels);
    }
    // Up to three varyings are stepped in a copy, which the compiler keeps in registers. More are stepped where they
    // are.
    let mut varyings = *pixels.varyings;
    let Pixels { z, primitive, position, test, .. } = *pixels;
    let mut own = Pixels { z, varyings: &mut varyings, primitive, position, test };
    paint_pixels(shader, color, depth, &mut own);
    (pixels.z, pixels.position) = (own.z, own.position);
    *pixels.varyings = varyings;
}

#[inline(always)]
fn paint_pixels<P: PixelFormat, S: Shader<P> + ?Sized>(
    shader: &S,
    color: &mut [P::Raw],
    depth: &mut [u16],
    pixels: &mut Pixels<'_, S::Varyings, S::Setup>,
) {
    let Pixels { z, varyings, primitive, position, test } = pixels;
    let Primitive { flat, side, ref setup, .. } = **primitive;
    for (color, stored) in color.iter_mut().zip(depth) {
        let depth = (*z >> 16) as u16;
        if test.passes(depth, *stored) {
            let fragment = Fragment { flat, varyings: &**varyings, position: *position, depth, side, setup };
            if shader.paint(&fragment, color) {
                test.write(depth, stored);
            }
        }
        position.0 = position.0.wrapping_add(1);
        *z = z.wrapping_add_signed(primitive.dz_dx);
        varyings.step(&primitive.d_dx);
    }
}

/// Draws a span of perspective-correct varyings fragment by fragment. Out of line, so that its frame is not on the
/// stack of shaders that have a faster loop.
#[inline(never)]
fn corrected_fragments<P: PixelFormat, S: Shader<P> + ?Sized, D: DepthTest>(
    shader: &S,
    mut span: SpanOf<'_, P, S, D>,
    test: D,
) {
    const { assert!(S::STEP.is_power_of_two() && S::STEP <= 32, "steps are 1, 2, 4, 8, 16 or 32 pixels") };
    let mut stretch = Stretch {
        change: span.primitive.d_dx,
        span: &mut span,
        varyings: S::Varyings::ZERO,
        divided: S::Varyings::ZERO,
        column: None,
        test,
    };
    let log_step = longest_log_step::<S::Varyings>(&stretch.span.primitive.perspective, S::STEP);
    while !stretch.span.color.is_empty() {
        let pixels = stretch.aim(log_step);
        stretch.draw(shader, pixels);
    }
}

/// Computes the values at a pixel that are linear on the screen. In place, because an array would be copied when it is
/// returned.
#[inline(never)]
fn linear_at<V: Varyings, T>(primitive: &Primitive<V, T>, (x, y): (i32, i32), to: &mut V) {
    *to = primitive.at_origin;
    to.advance(&primitive.d_dy, y);
    to.advance(&primitive.d_dx, x);
}

/// A part of a span: one pixel whose varyings are divided, or the pixels between two columns at which they are divided.
struct Stretch<'a, 's, P: PixelFormat, V: Varyings, T, D: DepthTest> {
    /// Pixels of the span that are not drawn yet.
    span: &'a mut Span<'s, P, V, T, D::Depth>,
    /// Varyings at the first of the pixels that are drawn next, and their change per pixel.
    varyings: V,
    change: V,
    /// Varyings at the column that was divided last.
    divided: V,
    /// That column, if there is one.
    column: Option<i32>,
    test: D,
}

impl<P: PixelFormat, V: Varyings, T, D: DepthTest> Stretch<'_, '_, P, V, T, D> {
    /// Moves on to the next part, and returns the number of its pixels. Values that are linear on the screen are exact
    /// at each pixel. Perspective-correct ones are so at columns that are multiples of 1 << `log_step`, or of half of
    /// it, and so on, where they are not straight enough.
    #[inline(never)]
    fn aim(&mut self, log_step: u32) -> usize {
        let Self { span, varyings, change, divided, column, .. } = self;
        let Primitive { perspective, d_dx, .. } = span.primitive;
        let (x, y) = span.position;
        // Linear on the screen until they are corrected.
        linear_at(span.primitive, span.position, varyings);
        let log_step = match log_step {
            0 => 0,
            _ => straight_log_step(span.primitive, varyings, span.position, log_step),
        };
        if log_step == 0 {
            correct_at::<V>(perspective, span.position, varyings);
            return 1;
        }
        let step = 1 << log_step;
        let back = x & (step - 1);
        let (first, next) = (x.wrapping_sub(back), x.wrapping_sub(back).wrapping_add(step));
        if *column != Some(first) {
            *divided = *varyings;
            divided.advance(d_dx, back.wrapping_neg());
            correct_at::<V>(perspective, (first, y), divided);
        }
        for (value, from) in varyings.as_mut().iter_mut().zip(divided.as_ref()).take(V::PERSPECTIVE) {
            *value = *from;
        }
        linear_at(span.primitive, span.position, divided);
        divided.advance(d_dx, step.wrapping_sub(back));
        correct_at::<V>(perspective, (next, y), divided);
        *column = Some(next);
        let ends = varyings.as_mut().iter_mut().zip(divided.as_ref()).take(V::PERSPECTIVE);
        for ((value, to), change) in ends.zip(change.as_mut()) {
            *change = to.wrapping_sub(*value).wrapping_add(step >> 1) >> log_step;
            *value = value.wrapping_add(change.wrapping_mul(back));
        }
        span.color.len().min(step.wrapping_sub(back) as usize)
    }

    /// Draws that many pixels. Out of line, so that the frame of the division is not on the stack meanwhile.
    #[inline(never)]
    fn draw<S: Shader<P, Varyings = V, Setup = T> + ?Sized>(&mut self, shader: &S, pixels: usize) {
        let Self { span, varyings, change, test, .. } = self;
        let Some((colors, rest)) = core::mem::take(&mut span.color).split_at_mut_checked(pixels) else { return };
        let Some((depths, depth_rest)) = core::mem::take(&mut span.depth).split_at_mut_checked(pixels) else { return };
        (span.color, span.depth) = (rest, depth_rest);
        let Primitive { flat, side, dz_dx, ref setup, .. } = *span.primitive;
        for (color, stored) in colors.iter_mut().zip(depths) {
            let depth = (span.z >> 16) as u16;
            if !D::ENABLED || test.passes(depth, *stored) {
                let fragment = Fragment { flat, varyings: &*varyings, position: span.position, depth, side, setup };
                if shader.paint(&fragment, color) {
                    test.write(depth, stored);
                }
            }
            span.position.0 = span.position.0.wrapping_add(1);
            span.z = span.z.wrapping_add_signed(dz_dx);
            varyings.step(change);
        }
    }
}
