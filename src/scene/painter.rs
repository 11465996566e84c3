//! Stages 8 to 11 of [the pipeline](crate#the-pipeline): a triangle on the screen → pixels.
//!
//! Triangles come in with snapped vertices, their varyings and their face's word. Only pixels of the painter's clip
//! rectangle are written.

use super::scene::{Scene, Target, check};
use super::small_rows::SmallRows;
use super::state::State;
use crate::raster::{Gradients, Outline, PixelRect, PlaneEquation, Spans, moves};
use crate::span::{
    BiasSteps, DepthBias, DepthState, DepthTest, Primitive, Shader, SmallResult, SmallTriangle, Span, SpanOf, biased,
    interpolate, set_up_shader, subslice,
};
use crate::target::{Framebuffer, turns as turns_of};
use crate::vertex::{MAX_IN_REGISTERS, PackedCorners, ScreenVertex, Side, Varyings, VertexShader, pack, signed_area};
use core::ops::Range;

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
    pub(super) spans:
        fn(&mut Painter<'_, '_, F, S>, &SetUp<'_, S::Varyings, S::Setup>, Option<&SetUp<'_, S::Varyings, S::Setup>>),
    /// Draws a triangle in the way of small ones, stages 8 and 9, and returns whether it is small.
    pub(super) small: Small<F, S>,
    /// Draws triangles in the records.
    pub(super) replay: ReplayBy<F, S>,
    /// Computes the depth bias of a triangle, a part of stage 8, if the state may have one.
    pub(super) bias: Option<BiasSteps>,
}

/// The draw whose triangles are replayed: its state, the functions for it, and its shader.
type ReplayBy<F, S> = fn(&mut Scene<'_, F>, &State, &RasterHooks<F, S>, &S, waiting: bool);
type Small<F, S> =
    fn(&mut Painter<'_, '_, F, S>, &[ScreenVertex; 3], &[<S as VertexShader>::Varyings; 3], u32) -> SmallResult;

impl<F: Framebuffer, S: Shader<F::Format>> Painter<'_, '_, F, S> {
    /// Returns the depth test. Without a depth buffer, every fragment passes.
    pub(super) fn test(&self) -> DepthState {
        if F::DEPTH { self.state.depth } else { DepthState::OFF }
    }

    /// Draws a triangle, unless its area is 0.
    #[inline]
    pub(super) fn triangle(&mut self, v: &mut [ScreenVertex; 3], varyings: &mut [S::Varyings; 3], flat: u32) {
        turn(varyings, turn_vertices(v));
        self.turned(v, varyings, flat, false);
    }

    /// Draws a triangle, unless its area is 0. Its highest corner is the first. `large` says that it is known not to be
    /// small.
    #[inline(never)]
    pub(super) fn turned(&mut self, v: &[ScreenVertex; 3], varyings: &[S::Varyings; 3], flat: u32, large: bool) {
        if large || (self.hooks.small)(self, v, varyings, flat) == SmallResult::Large {
            self.large(v, varyings, flat);
        }
    }

    /// Draws a triangle in the way of large ones, unless its area is 0. Its highest corner is the first.
    #[inline(never)]
    fn large(&mut self, v: &[ScreenVertex; 3], varyings: &[S::Varyings; 3], flat: u32) {
        let area = signed_area(&v[0], &v[1], &v[2]);
        if area == 0 {
            return;
        }
        let side = self.state.side(area);
        let mut set_up = SetUp::new(v, area, flat, side);
        self.set_up(&mut set_up, varyings);
        // Stage 9, in a loop for each kind of depth test.
        if F::SAMPLES == 1 {
            return (self.hooks.spans)(self, &set_up, None);
        }
        // Each sample is a picture of its own, in which the triangle is moved.
        self.each_sample(|painter, (x, y)| {
            let moved = &v.each_ref().map(|v| ScreenVertex { x: v.x + x, y: v.y + y, z: v.z });
            let mut at_sample = SetUp::new(moved, area, flat, side);
            painter.set_up(&mut at_sample, varyings);
            (painter.hooks.spans)(painter, &at_sample, Some(&set_up));
        });
    }

    /// Calls a function for the pixels of each sample, with the move that brings the sample to the pixel's centre. With
    /// one sample per pixel, it calls the function once.
    #[inline(always)]
    pub(super) fn each_sample(&mut self, mut draw: impl FnMut(&mut Painter<'_, '_, F, S>, (i32, i32))) {
        let Self { screen, clip, state, shader, hooks, .. } = *self;
        if F::SAMPLES == 1 {
            return draw(self, (0, 0));
        }
        for (sample, to_centre) in moves(F::SAMPLES).iter().enumerate() {
            let target = &mut self.target.sample(sample, screen.0);
            draw(&mut Painter { target, screen, clip, state, shader, hooks }, *to_centre);
        }
        self.target.framebuffer.select_sample(0);
    }

    /// Draws a triangle, if it is small.
    #[inline(never)]
    pub(super) fn small<D: DepthTest>(
        &mut self,
        v: &[ScreenVertex; 3],
        varyings: &[S::Varyings; 3],
        flat: u32,
        test: D,
    ) -> SmallResult {
        let mut words = [[0; 2]; 3];
        pack(v, &mut words);
        let [a, b, c] = words.each_ref();
        const { assert!(!S::PACKS_SMALL || S::WORDS <= MOST_PACKED, "small triangles take at most 4 words a corner") };
        let mut packed = [0; 3 * MOST_PACKED];
        if S::PACKS_SMALL {
            pack_varyings::<S>(varyings, &mut packed);
        }
        let packed = PackedCorners { varyings: &packed, vertices: &[], corners: [0, 1, 2] };
        let (shader, bias) = (self.shader, self.bias_steps());
        let rows = SmallRows::new(self.screen, self.clip, self.state, bias);
        let Range { start: mut y, end } = rows.of::<F>(v);
        while y < end {
            // Not moved out: that would link `memcpy`.
            let mut place = rows.place(self.target, Some(y), None);
            let Some(target) = &mut place else { return SmallResult::Large };
            y = target.rows.end;
            let triangle = SmallTriangle { target, v: [a, b, c], state: None, test };
            let result = if S::PACKS_SMALL {
                shader.small_packed(triangle, &packed)
            } else {
                shader.small(triangle, varyings, flat)
            };
            if result == SmallResult::Large {
                return SmallResult::Large;
            }
        }
        SmallResult::Drawn
    }

    /// Returns the depth bias, and how it is computed, if the state may have one.
    fn bias_steps(&self) -> Option<(BiasSteps, DepthBias)> {
        self.hooks.bias.map(|bias| (bias, self.state.bias))
    }

    /// Computes the plane equations of depth and varyings, and lets the shader set up: stage 8 of [the
    /// pipeline](crate#the-pipeline). The base of each plane is its value at the screen's top left corner.
    ///
    /// Out of line, with its result in place, so that its frame is not on the stack while spans are drawn.
    #[inline(never)]
    fn set_up(&self, set_up: &mut SetUp<'_, S::Varyings, S::Setup>, varyings: &[S::Varyings; 3]) {
        let SetUp { v, area, depth, primitive } = set_up;
        if S::Varyings::LEN == 0 && v[0].z == v[1].z && v[0].z == v[2].z {
            // Depth is constant, and there are no varyings: no gradient to compute.
            depth.base = u32::from(v[0].z) << 16;
        } else {
            let gradients = Gradients::new(v, *area, self.screen);
            *depth = gradients.plane([i32::from(v[0].z), i32::from(v[1].z), i32::from(v[2].z)], 16);
            interpolate(self.shader, &gradients, v, self.screen, varyings, primitive);
        }
        primitive.dz_dx = depth.dx;
        if let Some(bias) = self.bias_steps() {
            let depths = v.each_ref().map(|v| i32::from(v.z));
            depth.base = depth.base.wrapping_add(biased(&bias, depths, depth.dx, depth.dy));
        }
        set_up_shader(self.shader, [v[0].x, v[0].y], varyings, area.unsigned_abs(), primitive);
    }

    /// Draws the spans between the edges of a triangle, row by row: stage 9 of [the pipeline](crate#the-pipeline).
    #[inline(never)]
    ///
    /// With several samples per pixel, `set_up` is the triangle moved for a sample, and `centre` as it is: pixels are
    /// shaded at their centre or, if that is not covered, at the sample.
    pub(super) fn spans<D: DepthTest>(
        &mut self,
        set_up: &SetUp<'_, S::Varyings, S::Setup>,
        centre: Option<&SetUp<'_, S::Varyings, S::Setup>>,
        test: D,
    ) {
        if F::SAMPLES > 1
            && let Some(centre) = centre
        {
            return self.spans_at_sample(set_up, centre, test);
        }
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

    /// Draws the spans of a triangle at a sample.
    #[inline(never)]
    fn spans_at_sample<D: DepthTest>(
        &mut self,
        set_up: &SetUp<'_, S::Varyings, S::Setup>,
        centre: &SetUp<'_, S::Varyings, S::Setup>,
        test: D,
    ) {
        let mut nothing = [(); usize::MAX];
        let (rows, columns) = (&self.clip.y, &self.clip.x);
        let mut spans = Spans::new(set_up.v, set_up.area, rows);
        let mut centres = Spans::new(centre.v, centre.area, rows);
        let (shader, sample) = (self.shader, self.target.selected());
        let mut has_centres = centres.next_in(columns);
        while spans.next_in(columns) {
            let (y, Range { start, end }) = (spans.y, spans.x.clone());
            while has_centres && centres.y < y {
                has_centres = centres.next_in(columns);
            }
            let (mut inner, mut outer) = (end, end);
            if has_centres && centres.y == y && centres.x.start < end && start < centres.x.end {
                (inner, outer) = (start.max(centres.x.start), end.min(centres.x.end));
            }
            let parts =
                [(&set_up.primitive, start..inner), (&centre.primitive, inner..outer), (&set_up.primitive, outer..end)];
            for (primitive, part) in parts {
                if !part.is_empty() {
                    let span = self.part_at::<D>(&set_up.depth, primitive, (y, part), &mut nothing);
                    shader.span_at(sample, span, test);
                }
            }
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
        self.part_at::<D>(&set_up.depth, &set_up.primitive, (spans.y, spans.x.clone()), nothing)
    }

    /// Finds the colours, the depths and the first depth of columns in a row.
    #[inline(always)]
    fn part_at<'a, D: DepthTest>(
        &'a mut self,
        plane: &PlaneEquation,
        primitive: &'a Primitive<S::Varyings, S::Setup>,
        (y, x): (i32, Range<i32>),
        nothing: &'a mut [()],
    ) -> SpanOf<'a, F::Format, S, D> {
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

/// Returns the number of corners before the highest one. Corners of equal height are told apart by depth.
#[inline(always)]
fn turns([a, b, c]: &[ScreenVertex; 3]) -> u32 {
    // As the words of a `PackedVertex` compare.
    let word = |v: &ScreenVertex| v.y << 8 | i32::from(v.z & 0xFF);
    turns_of([word(a), word(b), word(c)])
}

/// Turns the corners of a triangle with these vertices, so that the highest one comes first.
#[inline(never)]
pub(super) fn turn_corners(v: &[ScreenVertex; 3], corners: &mut [u16; 3]) {
    turn(corners, turns(v));
}

/// Turns the vertices of a triangle, so that the highest one comes first. Returns the number of those before it.
#[inline(never)]
pub(super) fn turn_vertices(v: &mut [ScreenVertex; 3]) -> u32 {
    let turns = turns(v);
    turn(v, turns);
    turns
}

/// Most words of a vertex that small triangles are drawn from.
const MOST_PACKED: usize = 4;

/// Packs varyings, as the records do.
#[inline(never)]
fn pack_varyings<S: VertexShader>(varyings: &[S::Varyings; 3], packed: &mut [u32; 3 * MOST_PACKED]) {
    for (k, varyings) in varyings.iter().enumerate() {
        S::store(
            varyings,
            packed.get_mut(S::WORDS * k..).and_then(|rest| rest.get_mut(..S::WORDS)).unwrap_or_default(),
        );
    }
}

/// Turns three things, so that number `turns` comes first.
#[inline(always)]
pub(super) fn turn<T>([a, b, c]: &mut [T; 3], turns: u32) {
    for _ in 0..turns {
        core::mem::swap(a, b);
        core::mem::swap(b, c);
    }
}

/// A triangle with its plane equations and the data of the shader: the result of stage 8.
pub(super) struct SetUp<'a, V: Varyings, T> {
    v: &'a [ScreenVertex; 3],
    area: i64,
    depth: PlaneEquation,
    primitive: Primitive<V, T>,
}

impl<'a, V: Varyings, T: Default> SetUp<'a, V, T> {
    /// Makes the set-up of a triangle whose planes are not computed yet.
    #[inline(always)]
    fn new(v: &'a [ScreenVertex; 3], area: i64, flat: u32, side: Side) -> Self {
        let primitive = Primitive::constant(V::ZERO, flat, side, T::default());
        Self { v, area, depth: PlaneEquation::default(), primitive }
    }
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
        if F::OCCLUDES {
            self.note_test(state.depth);
        }
        Painter { target: &mut self.target, screen: self.screen, clip, state, hooks, shader }
    }
}
