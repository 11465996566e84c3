//! Filled shapes with smooth edges, on the screen's plane: an outline and a shader come in; pixels that are covered as
//! a whole go through the shader's span loop, and those at the edges are mixed with what is there.

use super::canvas::{Canvas, ScreenPoint, level};
use super::outline::{Outline, Pen};
use super::scene::{Target, check};
use crate::color::{PixelFormat, channels, packed};
use crate::raster::{AreaEdges, AreaMemory, Contours, Gradients, LEAST_EDGES, PixelRect, Run, area_words};
use crate::shader::Flat;
use crate::span::{
    Corrected, DepthDyn, DepthLess, DepthOff, DepthState, DepthTest, Fragment, Primitive, Sample, Shader, Span, SpanOf,
    TriangleSetup, interpolate, set_up_shader,
};
use crate::target::Framebuffer;
use crate::vertex::{Side, Varyings, signed_area};
use core::fmt;
use embedded_graphics_core::pixelcolor::Rgb888;

/// Error of a buffer for shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ShapeError {
    /// The buffer is too short.
    TooShort {
        /// Words that it has.
        words: usize,
        /// Fewest words for this width.
        needed: usize,
    },
}

impl fmt::Display for ShapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TooShort { words, needed } => write!(f, "buffer of {words} words for shapes, {needed} are needed"),
        }
    }
}

impl core::error::Error for ShapeError {}

/// Memory in which shapes are made into pixels: one row's cells, and the edges of some rows. All shapes share it, one
/// after the other.
///
/// Any number of edges from 4 on will do, for any shape. A shape is traced once for as many rows as its edges fit, so
/// that more of them are faster. Where not even the edges of one row fit, the row is put together from lower parts, and
/// its pixels may differ by 1/256 of coverage.
///
/// ```
/// use zstrip::scene::{ShapeBuffer, ShapeError};
/// const WORDS: usize = ShapeBuffer::words(320, 64);
/// let mut words = [0; WORDS]; // 4 KB
/// let buffer = ShapeBuffer::new(&mut words, 320)?;
/// # let _ = buffer;
/// let error = ShapeBuffer::new(&mut [0; 300], 320).unwrap_err();
/// assert_eq!(error, ShapeError::TooShort { words: 300, needed: 386 });
/// # Ok::<(), ShapeError>(())
/// ```
#[derive(Debug)]
pub struct ShapeBuffer<'m>(AreaMemory<'m>);

impl<'m> ShapeBuffer<'m> {
    /// Returns the number of words for rows of `width` pixels, and for `edges` edges.
    #[must_use]
    pub const fn words(width: u16, edges: usize) -> usize {
        area_words(width as usize, edges)
    }

    /// Makes a buffer of words for a screen of `width` pixels. A screen may also be wider: then each shape is drawn in
    /// columns of this width, one after the other.
    ///
    /// # Errors
    /// If there are fewer words than [`words`](Self::words) says for 4 edges.
    pub fn new(words: &'m mut [u32], width: u16) -> Result<Self, ShapeError> {
        let width = width.max(1);
        let error = ShapeError::TooShort { words: words.len(), needed: Self::words(width, LEAST_EDGES) };
        AreaMemory::new(words, width.into()).map(Self).ok_or(error)
    }
}

impl<F: Framebuffer> Canvas<'_, '_, F> {
    /// Fills a shape with smooth edges. A pixel is mixed with what is there by the part of it that the shape covers,
    /// which is exact to 1/256 and some roundings. A pixel that is covered by less than 1/512 is left as it is.
    ///
    /// At a depth, pixels at the edges store the whole depth, as those of [`Smooth`](crate::Smooth) lines do.
    ///
    /// ```
    /// # use embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
    /// # use zstrip::embedded_graphics_core::geometry::Size;
    /// # use zstrip::frame::Renderer;
    /// # use zstrip::target::StripPixels;
    /// use zstrip::ScreenPoint;
    /// use zstrip::math::Pixels;
    /// use zstrip::scene::ShapeBuffer;
    /// use zstrip::shape::Circle;
    /// # let mut color = [0; 64 * 8];
    /// # let mut renderer = Renderer::<Rgb565>::new(Size::new(64, 64))?;
    /// # let sink = |_: &StripPixels<Rgb565>| Ok::<(), core::convert::Infallible>(());
    /// let mut words = [0; ShapeBuffer::words(64, 32)];
    /// let mut buffer = ShapeBuffer::new(&mut words, 64)?;
    /// let circle = Circle::new(ScreenPoint::corner(32, 32), Pixels::from_num(20.5));
    /// renderer.frame_to(sink, &mut color, Rgb888::BLACK, |scene| {
    ///     scene.canvas().fill(&circle, Rgb888::RED, &mut buffer);
    /// }).unwrap();
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn fill(&mut self, shape: &impl Outline, color: impl Into<Rgb888>, buffer: &mut ShapeBuffer<'_>) {
        let color = color.into();
        self.fill_with(shape, &Flat::unlit(color), packed(channels(color)), buffer);
    }

    /// Fills a shape with a shader that needs no varyings, such as a gradient or a [`Blend`](crate::shader::Blend) of a
    /// colour. `face` is the shader's face word, as in [`polygon_with`](Self::polygon_with). Varyings are 0.
    pub fn fill_with<S: Shader<F::Format>>(
        &mut self,
        shape: &impl Outline,
        shader: &S,
        face: u32,
        buffer: &mut ShapeBuffer<'_>,
    ) {
        let Some(rect) = self.rect_of(shape) else { return };
        let varyings = level(S::Varyings::ZERO);
        let flat = shader.shape(face);
        let point = Primitive::constant(varyings, flat, Side::Front, ());
        let position = (rect.x.start, rect.y.start);
        let setup = shader.setup(&TriangleSetup::new(&point, [&varyings; 3], 0, position));
        let primitive = Primitive::constant(varyings, flat, Side::Front, setup);
        self.fill_primitive(shape, rect, shader, &primitive, buffer);
    }

    /// Fills a shape with a shader whose varyings are planes over the screen, through their values at three points.
    /// The points may lie anywhere within ±32,767 px, but not on one line; the shape may be larger than their triangle.
    /// A shape with other points is not drawn.
    pub fn fill_shaded<S: Shader<F::Format>>(
        &mut self,
        shape: &impl Outline,
        points: &[(ScreenPoint, S::Varyings); 3],
        shader: &S,
        face: u32,
        buffer: &mut ShapeBuffer<'_>,
    ) {
        let Some(rect) = self.rect_of(shape) else { return };
        if points.iter().any(|point| point.0.outcode().0 != 0) {
            return;
        }
        let vertices = points.each_ref().map(|point| point.0.vertex(self.z));
        let area = signed_area(&vertices[0], &vertices[1], &vertices[2]);
        if area == 0 {
            return;
        }
        let varyings = points.each_ref().map(|point| level(point.1));
        let screen = self.scene.screen;
        let flat = shader.shape(face);
        let mut primitive = Primitive::constant(S::Varyings::ZERO, flat, Side::Front, S::Setup::default());
        let gradients = Gradients::new(&vertices, area, screen);
        interpolate(shader, &gradients, &vertices, screen, &varyings, &mut primitive);
        let first = [vertices[0].x, vertices[0].y];
        set_up_shader(shader, first, &varyings, area.unsigned_abs(), &mut primitive);
        self.fill_primitive(shape, rect, shader, &primitive, buffer);
    }

    /// Returns the pixels that a shape may cover; `None` if there are none.
    fn rect_of(&self, shape: &impl Outline) -> Option<PixelRect> {
        let rect = match shape.bounds() {
            Some(bounds) => self.clip.intersection(&PixelRect::of_area(&bounds)),
            None => self.clip.clone(),
        };
        (!rect.is_empty()).then_some(rect)
    }

    #[inline(never)]
    fn fill_primitive<S: Shader<F::Format>>(
        &mut self,
        shape: &impl Outline,
        mut rect: PixelRect,
        shader: &S,
        primitive: &Primitive<S::Varyings, S::Setup>,
        buffer: &mut ShapeBuffer<'_>,
    ) {
        check::<S>();
        let Self { scene, state, z, .. } = self;
        let mut spans = Spans {
            screen: scene.screen,
            target: &mut scene.target,
            test: if F::DEPTH { state.depth } else { DepthState::OFF },
            z: u32::from(*z) << 16 | 1 << 15,
            shader,
            primitive,
        };
        let kind = match (shape.is_convex(), shape.is_apart()) {
            (true, _) => Contours::Convex,
            (_, true) => Contours::Apart,
            _ => Contours::Any,
        };
        while rect.x.start < rect.x.end {
            let mut area = buffer.0.area(&rect, shape.rule(), kind);
            while area.begin_band() {
                trace(shape, &mut area.edges);
                area.end_band();
                while let Some(run) = area.next_run() {
                    spans.draw(&run, if run.part.is_none() { area.parts(&run) } else { &[] });
                }
            }
            rect.x.start = area.right();
        }
    }
}

/// Traces a shape. Out of line, so that its frame is not on the stack while pixels are drawn.
#[inline(never)]
fn trace(shape: &impl Outline, edges: &mut AreaEdges<'_>) {
    let mut pen = Pen::new(edges);
    shape.trace(&mut pen);
    pen.close();
}

/// Draws the runs of a shape.
struct Spans<'s, 't, F: Framebuffer, S: Shader<F::Format>> {
    screen: (u16, u16),
    target: &'s mut Target<'t, F>,
    test: DepthState,
    z: u32,
    shader: &'s S,
    primitive: &'s Primitive<S::Varyings, S::Setup>,
}

impl<F: Framebuffer, S: Shader<F::Format>> Spans<'_, '_, F, S> {
    /// Draws a run: all samples of a pixel alike.
    #[inline]
    fn draw(&mut self, run: &Run, parts: &[i32]) {
        if F::SAMPLES == 1 {
            return self.draw_at_sample(run, parts);
        }
        let Self { screen, test, z, shader, primitive, .. } = *self;
        for sample in 0..F::SAMPLES {
            let target = &mut self.target.sample(sample, screen.0);
            Spans { screen, target, test, z, shader, primitive }.draw_at_sample(run, parts);
        }
        self.target.framebuffer.select_sample(0);
    }

    #[inline(always)]
    fn draw_at_sample(&mut self, run: &Run, parts: &[i32]) {
        let Self { screen, target, test, z, shader, primitive } = self;
        let sample = target.selected();
        let (column, length) = (run.x.start as usize, (run.x.end - run.x.start) as usize);
        let row = usize::from(screen.0).wrapping_mul((run.y - target.rows.start) as usize);
        let color = target.framebuffer.span(run.y as u32, column, length);
        let position = (run.x.start, run.y);
        let part = run.part.unwrap_or(0);
        let mut nothing = [(); usize::MAX];
        if *test == DepthState::OFF {
            let depth = nothing.get_mut(..color.len()).unwrap_or_default();
            let run = Span { color, depth, z: *z, position, primitive };
            return span(*shader, (sample, run), DepthOff, part, parts);
        }
        let Some(depth) = target.depth.get_mut(row.wrapping_add(column)..) else { return };
        let Some(depth) = depth.get_mut(..color.len()) else { return };
        let run = Span { color, depth, z: *z, position, primitive };
        match *test {
            DepthState::LESS => span(*shader, (sample, run), DepthLess, part, parts),
            other => span(*shader, (sample, run), DepthDyn::new(other), part, parts),
        }
    }
}

/// Draws a run: as a span, if it is covered as a whole.
#[inline(always)]
fn span<P: PixelFormat, S: Shader<P>, D: DepthTest>(
    shader: &S,
    (sample, run): (Sample, SpanOf<'_, P, S, D>),
    test: D,
    part: u32,
    parts: &[i32],
) {
    if part == 256 { shader.span_at(sample, run, test) } else { covered(shader, (sample, run), test, part, parts) }
}

/// Draws pixels that are covered in part: all of them alike, or each as `parts` says.
#[inline(never)]
fn covered<P: PixelFormat, S: Shader<P>, D: DepthTest>(
    shader: &S,
    (sample, span): (Sample, SpanOf<'_, P, S, D>),
    test: D,
    part: u32,
    parts: &[i32],
) {
    let mut varyings = span.varyings();
    let Span { color, depth, z, mut position, primitive } = span;
    let Primitive { flat, side, ref setup, .. } = *primitive;
    let near = (z >> 16) as u16;
    let mut corrected = (S::Varyings::PERSPECTIVE > 0).then(|| Corrected::new(primitive, position));
    let mut parts = parts.iter();
    for (color, stored) in color.iter_mut().zip(depth) {
        if let Some(corrected) = &mut corrected {
            varyings = corrected.varyings();
            corrected.advance(1);
        }
        let part = parts.next().map_or(part, |part| *part as u32);
        if part > 0 && (!D::ENABLED || test.passes(near, *stored)) {
            let fragment = Fragment { flat, varyings: &varyings, position, depth: near, side, setup };
            // A shader that blends does so with the pixel that is there.
            let mut painted = *color;
            if shader.paint_at(sample, &fragment, &mut painted) {
                test.write(near, stored);
                *color = if part < 256 { mixed::<P>(painted, *color, part) } else { painted };
            }
        }
        position.0 = position.0.wrapping_add(1);
        varyings.step(&primitive.d_dx);
    }
}

/// Covers `under` with `over` to `part` / 256.
#[inline(always)]
fn mixed<P: PixelFormat>(over: P::Raw, under: P::Raw, part: u32) -> P::Raw {
    if P::IS_LUMA {
        let sum = u32::from(P::luma(over)) * part + u32::from(P::luma(under)) * (256_u32.wrapping_sub(part)) + 128;
        return P::from_luma((sum >> 8) as u8);
    }
    P::mix(over, under, part)
}
