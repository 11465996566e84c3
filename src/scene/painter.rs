//! Stages 8 to 11 of [the pipeline](crate#the-pipeline): a triangle on the screen → pixels.
//!
//! Triangles come in with snapped vertices, their varyings and their face's word. Only pixels of the painter's clip
//! rectangle are written.

use super::scene::{Scene, Target, check};
use super::state::State;
use crate::raster::{Gradients, Outline, PixelRect, PlaneEquation, Spans, homogenize, straighten, widen};
use crate::span::{
    DepthBias, DepthDyn, DepthLess, DepthOff, DepthState, DepthTest, Primitive, Shader, Span, SpanOf, TriangleSetup,
};
use crate::target::Framebuffer;
use crate::vertex::{MAX_IN_REGISTERS, ScreenVertex, Varyings, signed_area};

/// Draws the triangles of a draw call, with its state and its shader.
pub(super) struct Painter<'p, 't, F: Framebuffer, S: Shader<F::Format>> {
    pub(super) target: &'p mut Target<'t, F>,
    pub(super) screen: (u16, u16),
    /// Pixels that may be drawn: in the strip, inside of the viewport and of a canvas's scissor.
    pub(super) clip: &'p PixelRect,
    pub(super) state: &'p State,
    pub(super) shader: &'p S,
    pub(super) hooks: &'p RasterHooks<F, S>,
}

/// Parts of the rasterization that only some states need, as functions. They are chosen where the state is known, so
/// that a program links only what its states ask for.
pub(super) struct RasterHooks<F: Framebuffer, S: Shader<F::Format>> {
    /// Draws the spans of a triangle under a depth test: stage 9 of [the pipeline](crate#the-pipeline).
    #[expect(clippy::type_complexity, reason = "an alias would have to repeat the bounds of both types")]
    spans: fn(&mut Painter<'_, '_, F, S>, &SetUp<'_, S::Varyings, S::Setup>),
    /// Computes the depth bias of a triangle, a part of stage 8, if the state may have one.
    bias: Option<Bias>,
}

impl<F: Framebuffer, S: Shader<F::Format>> RasterHooks<F, S> {
    /// Functions for [`State::DEFAULT`].
    pub(super) const DEFAULT: Self = Self { spans: if F::DEPTH { spans_nearer } else { spans_over }, bias: None };

    /// Functions for any state.
    pub(super) const ANY: Self = Self { spans: if F::DEPTH { spans_by_state } else { spans_over }, bias: Some(biased) };

    /// Chooses the functions for a state.
    #[inline(always)]
    pub(super) fn of(state: &State) -> Self {
        Self {
            spans: match state.depth {
                DepthState::LESS => Self::DEFAULT.spans,
                DepthState::OFF => spans_over,
                _ => Self::ANY.spans,
            },
            bias: if state.bias.is_none() { None } else { Self::ANY.bias },
        }
    }
}

type Bias = fn(&DepthBias, &[ScreenVertex; 3], &PlaneEquation) -> i32;

/// Computes the steps that a depth bias adds to the depths of a triangle.
fn biased(bias: &DepthBias, [a, b, c]: &[ScreenVertex; 3], depth: &PlaneEquation) -> i32 {
    bias.steps(a.z.min(b.z).min(c.z)..a.z.max(b.z).max(c.z), depth.dx, depth.dy)
}

fn spans_nearer<F: Framebuffer, S: Shader<F::Format>>(
    painter: &mut Painter<'_, '_, F, S>,
    set_up: &SetUp<'_, S::Varyings, S::Setup>,
) {
    painter.spans(set_up, DepthLess);
}

fn spans_over<F: Framebuffer, S: Shader<F::Format>>(
    painter: &mut Painter<'_, '_, F, S>,
    set_up: &SetUp<'_, S::Varyings, S::Setup>,
) {
    painter.spans(set_up, DepthOff);
}

fn spans_by_state<F: Framebuffer, S: Shader<F::Format>>(
    painter: &mut Painter<'_, '_, F, S>,
    set_up: &SetUp<'_, S::Varyings, S::Setup>,
) {
    match painter.test() {
        DepthState::LESS => painter.spans(set_up, DepthLess),
        DepthState::OFF => painter.spans(set_up, DepthOff),
        other => painter.spans(set_up, DepthDyn::new(other)),
    }
}

impl<F: Framebuffer, S: Shader<F::Format>> Painter<'_, '_, F, S> {
    /// Returns the depth test. Without a depth buffer, every fragment passes.
    pub(super) fn test(&self) -> DepthState {
        if F::DEPTH { self.state.depth } else { DepthState::OFF }
    }

    /// Draws a triangle, unless its area is 0.
    #[inline]
    pub(super) fn triangle(&mut self, v: &[ScreenVertex; 3], varyings: &[S::Varyings; 3], flat: u32) {
        let area = signed_area(&v[0], &v[1], &v[2]);
        if area != 0 {
            self.triangle_of_area(v, area, varyings, flat);
        }
    }

    /// Draws a triangle whose signed area is given, and is not 0.
    #[inline(never)]
    pub(super) fn triangle_of_area(
        &mut self,
        v: &[ScreenVertex; 3],
        area: i64,
        varyings: &[S::Varyings; 3],
        flat: u32,
    ) {
        let primitive = Primitive::constant(S::Varyings::ZERO, flat, self.state.side(area), S::Setup::default());
        let mut set_up = SetUp { v, area, depth: PlaneEquation::default(), primitive };
        self.set_up(&mut set_up, varyings);
        // Stage 9, in a loop for each kind of depth test.
        (self.hooks.spans)(self, &set_up);
    }

    /// Computes the plane equations of depth and varyings, and lets the shader set up: stage 8 of [the
    /// pipeline](crate#the-pipeline). The base of each plane is its value at the screen's top left corner.
    ///
    /// Out of line, with its result in place, so that its frame is not on the stack while spans are drawn.
    #[inline(never)]
    fn set_up(&self, set_up: &mut SetUp<'_, S::Varyings, S::Setup>, varyings: &[S::Varyings; 3]) {
        let SetUp { v, area, depth, primitive } = set_up;
        let corners = varyings.each_ref();
        if S::Varyings::LEN == 0 && v[0].z == v[1].z && v[0].z == v[2].z {
            // Depth is constant, and there are no varyings: no gradient to compute.
            depth.base = u32::from(v[0].z) << 16;
        } else {
            let gradients = Gradients::new(v, *area, self.screen);
            *depth = gradients.plane([i32::from(v[0].z), i32::from(v[1].z), i32::from(v[2].z)], 16);
            let mut homogeneous;
            let [a, b, c] = if S::Varyings::PERSPECTIVE > 0 {
                homogeneous = *varyings;
                homogenize(&mut homogeneous, v, self.screen, S::STEP, &mut primitive.perspective);
                homogeneous.each_ref()
            } else {
                corners
            };
            let values = [a.as_ref(), b.as_ref(), c.as_ref()];
            widen(&gradients, &values, &mut primitive.perspective);
            let Primitive { at_origin, d_dx, d_dy, perspective, .. } = &mut *primitive;
            let planes = at_origin.as_mut().iter_mut().zip(d_dx.as_mut()).zip(d_dy.as_mut());
            for (k, ((at_origin, dx), dy)) in planes.enumerate() {
                let value = |vertex: &[i32]| vertex.get(k).copied().unwrap_or(0) >> S::ZERO_BITS;
                let plane = gradients.plane([value(values[0]), value(values[1]), value(values[2])], S::ZERO_BITS);
                (*at_origin, *dx, *dy) = (plane.base as i32, plane.dx, plane.dy);
            }
            if S::Varyings::PERSPECTIVE > 0 && S::STEP > 1 {
                straighten(d_dx.as_ref(), S::STEP.trailing_zeros(), perspective);
            }
        }
        primitive.dz_dx = depth.dx;
        if let Some(bias) = self.hooks.bias {
            let steps = bias(&self.state.bias, v, depth);
            depth.base = depth.base.wrapping_add((steps as u32) << 16);
        }
        let position = (v[0].x >> 8, v[0].y >> 8);
        let triangle = TriangleSetup::new(primitive, corners, area.unsigned_abs(), position);
        primitive.setup = self.shader.setup(&triangle);
    }

    /// Draws the spans between the edges of a triangle, row by row: stage 9 of [the pipeline](crate#the-pipeline).
    #[inline(never)]
    fn spans<D: DepthTest>(&mut self, set_up: &SetUp<'_, S::Varyings, S::Setup>, test: D) {
        if S::Varyings::LEN > MAX_IN_REGISTERS {
            return self.spans_outlined(set_up, test);
        }
        let SetUp { v, area, depth, primitive } = set_up;
        let columns = self.clip.x.clone();
        let width = usize::from(self.screen.0);
        let first = self.target.rows.start;
        let framebuffer = &mut *self.target.framebuffer;
        let mut nothing = [(); usize::MAX];
        let outline = Outline::new(v, *area, &self.clip.y);
        if outline.top >= outline.end {
            return;
        }
        let (mut left, mut right) = (outline.side(false, outline.top), outline.side(true, outline.top));
        // Depth at column 0 of the row, with the half that rounds.
        let mut y = outline.top;
        let mut z = depth.base.wrapping_add(1 << 15).wrapping_add_signed(depth.dy.wrapping_mul(y));
        let (bend, last, bend_right) = (outline.bend, outline.end, outline.bend_right);
        while y < last {
            if y == bend {
                let edge = outline.side(bend_right, y);
                if bend_right {
                    right = edge;
                } else {
                    left = edge;
                }
            }
            // If colours lie row after row in memory, as depths do, all rows up to the bend or to the end; otherwise
            // one row.
            let mut row = width.wrapping_mul((y - first) as usize);
            let mut end = if y < bend { bend.min(last) } else { last };
            let mut depths = D::slots(self.target.depth, &mut nothing);
            let mut colors = framebuffer.rows(first as u32, width).unwrap_or_default();
            let mut right_end = columns.end;
            if width.wrapping_mul((end - first) as usize) > colors.len() {
                // Colours do not lie row after row, or the framebuffer has fewer or shorter rows than the screen: one
                // row.
                depths = depths.get_mut(row..).unwrap_or_default();
                colors = framebuffer.row(y as u32);
                (row, end) = (0, y + 1);
                right_end = right_end.min(colors.len() as i32);
            }
            // Both get one length, so that the compiler knows a span inside of one to be inside of the other.
            let length = colors.len().min(depths.len());
            let (Some(colors), Some(depths)) = (colors.get_mut(..length), depths.get_mut(..length)) else { return };
            // The order of these statements decides which values stay in registers: any other order takes a few percent
            // more, see docs/speed.md.
            while y < end {
                let start = left.pixel().max(columns.start);
                let past = right.pixel().min(right_end);
                left.step();
                if start < past {
                    let (at, length) = (row.wrapping_add(start as usize), (past - start) as usize);
                    let Some(depth) = subslice(depths, at, length) else { return };
                    let Some(color) = subslice(colors, at, length) else { return };
                    let z = z.wrapping_add_signed(primitive.dz_dx.wrapping_mul(start));
                    // Stages 10 and 11: depth test and fragments.
                    self.shader.span(Span { color, depth, z, position: (start, y), primitive }, test);
                }
                y += 1;
                row = row.wrapping_add(width);
                z = z.wrapping_add_signed(depth.dy);
                right.step();
            }
        }
    }

    /// Draws the spans of a triangle with many varyings. Their fragments take far longer than finding the span does, so
    /// only the edges are kept from span to span. That keeps the frame of this function small under the fragment stage.
    #[inline(always)]
    fn spans_outlined<D: DepthTest>(&mut self, set_up: &SetUp<'_, S::Varyings, S::Setup>, test: D) {
        let mut nothing = [(); usize::MAX];
        let mut spans = Spans::new(set_up.v, set_up.area, &self.clip.y);
        let shader = self.shader;
        while spans.next_in(&self.clip.x) {
            // Stages 10 and 11: depth test and fragments.
            shader.span(self.span_at::<D>(set_up, &spans, &mut nothing), test);
        }
    }

    /// Finds the colours, the depths and the first depth of a span.
    #[inline(never)]
    fn span_at<'a, D: DepthTest>(
        &'a mut self,
        set_up: &'a SetUp<'_, S::Varyings, S::Setup>,
        spans: &Spans<'_>,
        nothing: &'a mut [()],
    ) -> SpanOf<'a, F::Format, S, D> {
        let (y, x) = (spans.y, &spans.x);
        let SetUp { depth: plane, primitive, .. } = set_up;
        let row = usize::from(self.screen.0).wrapping_mul((y - self.target.rows.start) as usize);
        let color = self.target.framebuffer.span(y as u32, x.start as usize, x.len());
        let depths = D::slots(self.target.depth, nothing);
        let depth = subslice(depths, row.wrapping_add(x.start as usize), color.len()).unwrap_or_default();
        // The half rounds.
        let z = plane.base.wrapping_add(1 << 15).wrapping_add_signed(plane.dy.wrapping_mul(y));
        let z = z.wrapping_add_signed(plane.dx.wrapping_mul(x.start));
        Span { color, depth, z, position: (x.start, y), primitive }
    }
}

/// A triangle with its plane equations and the data of the shader: the result of stage 8.
pub(super) struct SetUp<'a, V: Varyings, T> {
    v: &'a [ScreenVertex; 3],
    area: i64,
    depth: PlaneEquation,
    primitive: Primitive<V, T>,
}

/// Returns `length` elements from `start` on, if there are as many. Two steps check this with one comparison each; a
/// range is checked at both ends at once, which costs twice as much.
#[inline(always)]
fn subslice<T>(slice: &mut [T], start: usize, length: usize) -> Option<&mut [T]> {
    slice.get_mut(start..)?.get_mut(..length)
}

impl<'a, F: Framebuffer> Scene<'a, F> {
    /// Returns a painter for the strip that is drawn now. Phases that only record have no use for it.
    pub(super) fn painter<'p, S: Shader<F::Format>>(
        &'p mut self,
        clip: &'p PixelRect,
        state: &'p State,
        hooks: &'p RasterHooks<F, S>,
        shader: &'p S,
    ) -> Painter<'p, 'a, F, S> {
        check::<S>();
        Painter { target: &mut self.target, screen: self.screen, clip, state, hooks, shader }
    }
}
