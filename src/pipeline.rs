//! The one place that calls every stage, in order.
//!
//! A frame is drawn by a closure that calls [`Scene::draw`]. The closure runs in one of three phases: it *records* a band
//! of strips (stages 1 to 7), it *replays* the records of one strip (stages 8 to 11), or, where the records are too
//! small even for one strip, it draws that strip *directly* (all stages at once).

use crate::fragment::{AnyDepth, Compare, DepthState, DepthTest, Fragments, LessWrite, NoDepth, Shader, Steps};
use crate::geometry::{
    Bounds, BoundsNode, ClipVertex, Containment, Corner, Correction, DepthRange, Face, Frustum, Mesh, Outcode, Part,
    Placed, Positions, ScreenVertex, Side, Transform, Varyings, VertexShader, Viewport, clip_triangle, inverse_w,
    place, project, signed_area,
};
use crate::math::Projective;
use crate::output::{Framebuffer, Records, Slot, Stats};
use crate::raster::{Edge, Gradients, PixelRect, homogenize, pixel_rect, trapezoids, widen};
use core::ops::Range;

/// Which faces are not drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Cull {
    /// Those that show their back.
    #[default]
    Back,
    /// Those that show their front.
    Front,
    /// Every face is drawn.
    None,
}

/// Which way the corners of a front face go round on the screen, with y up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Winding {
    /// Against the clock.
    #[default]
    CounterClockwise,
    /// With the clock: for meshes made that way, and for mirrored models.
    Clockwise,
}

/// How a draw is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct State {
    /// Which faces are left out.
    pub cull: Cull,
    /// Which faces are front faces.
    pub front: Winding,
    /// The depth test.
    pub depth: DepthState,
    /// What happens before the near and beyond the far plane.
    pub range: DepthRange,
}

impl State {
    /// The side that a triangle of this signed area, which is not 0, shows.
    #[inline]
    fn side(&self, area: i64) -> Side {
        // y points down here: a positive area goes with the clock.
        if (area > 0) == (self.front == Winding::CounterClockwise) { Side::Back } else { Side::Front }
    }

    /// The default, for constants: back faces culled, nearer fragments win, clipped at the near and the far plane.
    pub const DEFAULT: Self =
        Self { cull: Cull::Back, front: Winding::CounterClockwise, depth: DepthState::LESS, range: DepthRange::Clip };
}

/// What the closure's calls do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    Record,
    Replay,
    Direct,
}

/// Where pixels go while a strip is drawn.
#[derive(Debug)]
pub(crate) struct Target<'a, F> {
    pub(crate) framebuffer: &'a mut F,
    /// Depths of the strip's rows, one after the other.
    pub(crate) depth: &'a mut [u16],
    /// Rows of the strip.
    pub(crate) rows: Range<i32>,
}

/// What a frame is drawn through; see [`Renderer::frame`](crate::Renderer::frame).
#[derive(Debug)]
pub struct Scene<'a, F> {
    pub(crate) screen: (u16, u16),
    pub(crate) viewport: Viewport,
    pub(crate) phase: Phase,
    pub(crate) records: Records<'a>,
    pub(crate) strip_rows: u16,
    /// Rows of the band that is recorded, replayed or drawn.
    pub(crate) band: Range<i32>,
    pub(crate) target: Option<Target<'a, F>>,
    pub(crate) stats: &'a mut Stats,
    /// Number of the next draw, and the first that differed from what was recorded.
    pub(crate) draws: u16,
    pub(crate) changed: Option<u16>,
}

impl<F: Framebuffer> Scene<'_, F> {
    /// Draws a mesh: back faces culled, nearer fragments win, clipped at the near and the far plane.
    ///
    /// `mvp` takes object space to clip space: camera · view · model.
    pub fn draw<S: Shader<F::Format>>(&mut self, mesh: &Mesh<'_>, mvp: &Projective, shader: &S) {
        self.draw_with(State::default(), mesh, mvp, shader);
    }

    /// Draws a mesh by other rules.
    pub fn draw_with<S: Shader<F::Format>>(&mut self, state: State, mesh: &Mesh<'_>, mvp: &Projective, shader: &S) {
        const {
            assert!(S::WORDS <= <S::Varyings as Varyings>::LEN, "a vertex needs no more words than varyings");
            assert!(S::WORDS <= 253, "a vertex has at most 253 words of varyings");
            assert!(S::ZERO_BITS == 0 || S::Varyings::PERSPECTIVE == 0, "perspective takes all bits of varyings");
            assert!(S::ZERO_BITS <= 16, "at most 16 bits of varyings are known to be zero");
        };
        let draw = self.draws;
        self.draws = draw.saturating_add(1);
        self.stats.draws = self.stats.draws.wrapping_add(1);
        let stride = S::WORDS + crate::output::VERTEX_WORDS;
        match self.phase {
            Phase::Record => {
                if self.records.overflowed() {
                    return;
                }
                let print = fingerprint(&state, mesh, mvp, &self.viewport, stride);
                let culled = self.is_culled::<S>(&state, mesh, mvp);
                // What is out of view leaves a header without vertices.
                let vertices = if culled { 0 } else { mesh.vertex_count() };
                self.records.begin_draw(print, vertices, stride);
                if !culled {
                    self.assemble(&state, mesh, mvp, shader, true);
                }
                self.records.end_draw();
            }
            Phase::Replay => {
                let print = fingerprint(&state, mesh, mvp, &self.viewport, stride);
                if self.changed.is_some() || !self.records.replay_draw(print, stride) {
                    self.changed = self.changed.or(Some(draw));
                    return;
                }
                self.replay(&state, shader);
            }
            Phase::Direct => {
                if !self.is_culled::<S>(&state, mesh, mvp) {
                    let cached = self.records.begin_direct(mesh.vertex_count(), stride);
                    self.assemble(&state, mesh, mvp, shader, cached);
                }
            }
        }
    }

    /// Whether something with these bounds may be seen in the part of the screen that is being drawn; what is not can be
    /// left out, with everything inside of it: a hierarchy of objects.
    ///
    /// The answer is the same in all calls of the closure that must draw the same. It counts near and far plane as borders,
    /// whatever [`State::range`] says of what lies beyond them.
    #[inline(never)]
    pub fn is_visible(&self, bounds: &Bounds, mvp: &Projective) -> bool {
        self.frustum(&State::default(), mvp).bounds(bounds) != Containment::Outside
    }

    /// Maps clip space to a part of the screen from here on; nothing outside of it is touched. Each call of the closure
    /// starts with the whole screen.
    pub const fn set_viewport(&mut self, viewport: Viewport) {
        self.viewport = viewport;
    }

    /// Width and height of the screen.
    pub const fn screen(&self) -> (u16, u16) {
        self.screen
    }

    /// The pixels that may be drawn, in `rows` of the screen.
    fn clip_rect(&self, rows: &Range<i32>) -> PixelRect {
        let (x, y) = (i32::from(self.viewport.x()), i32::from(self.viewport.y()));
        let viewport =
            PixelRect { x: x..x + i32::from(self.viewport.width()), y: y..y + i32::from(self.viewport.height()) };
        viewport.intersection(&PixelRect { x: 0..i32::from(self.screen.0), y: rows.clone() })
    }

    /// What can be seen of the band.
    fn frustum(&self, state: &State, mvp: &Projective) -> Frustum {
        let rect = self.clip_rect(&self.band);
        Frustum::through(mvp, &self.viewport, (rect.x.start, rect.x.end), (rect.y.start, rect.y.end))
            .without(state.range.clamped())
    }

    /// Stage 1, culling of whole meshes. In a function of its own, as the others here, so that its planes leave the stack.
    #[inline(never)]
    fn is_culled<S: VertexShader>(&mut self, state: &State, mesh: &Mesh<'_>, mvp: &Projective) -> bool {
        let bounded = !S::DISPLACES && !matches!(mesh.data().positions, Positions::Homogeneous(_));
        let culled = bounded && self.frustum(state, mvp).bounds(mesh.bounds()) == Containment::Outside;
        self.stats.culled = self.stats.culled.wrapping_add(u32::from(culled));
        culled
    }

    #[inline(never)]
    fn assemble<S: Shader<F::Format>>(
        &mut self,
        state: &State,
        mesh: &Mesh<'_>,
        mvp: &Projective,
        shader: &S,
        cached: bool,
    ) {
        let transform = Transform::new(mvp, &self.viewport, mesh, S::DISPLACES);
        let clip = self.clip_rect(&self.band);
        let mut assembly = Assembly { scene: self, state, mesh, shader, transform, clip, cached };
        match mesh.data().hierarchy {
            Some(nodes) if !S::DISPLACES => assembly.parts(nodes, mvp),
            _ => assembly.triangles(0..mesh.triangle_count()),
        }
    }

    /// Draws the recorded triangles of this draw in the current strip.
    fn replay<S: Shader<F::Format>>(&mut self, state: &State, shader: &S) {
        let Some(rows) = self.target.as_ref().map(|t| t.rows.clone()) else {
            return;
        };
        let clip = self.clip_rect(&rows);
        while let Some(triangle) = self.records.replay_triangle() {
            let [i, j, k] = triangle.corners;
            let (a, b, c) = (self.records.corner::<S>(i), self.records.corner::<S>(j), self.records.corner::<S>(k));
            let (v, varyings) = ([a.0, b.0, c.0], [a.1, b.1, c.1]);
            if pixel_rect(&v).y.end > rows.end {
                self.records.move_on(&triangle);
            }
            if let Some(target) = &mut self.target {
                rasterize(target, self.screen, &clip, state, shader, &v, &varyings, triangle.face);
            }
        }
    }
}

/// The corners of a clipped polygon on the screen.
type Fan<V> = heapless::Vec<(ScreenVertex, V), 10>;

/// Stages 2 to 7 for one draw: from the mesh's triangles to triangles on the screen.
struct Assembly<'s, 'a, 'm, F, S> {
    scene: &'s mut Scene<'a, F>,
    state: &'m State,
    mesh: &'m Mesh<'m>,
    shader: &'m S,
    transform: Transform,
    /// Pixels that can be drawn in this phase.
    clip: PixelRect,
    /// Whether the records hold a place for each vertex.
    cached: bool,
}

impl<'s, 'a, 'm, F: Framebuffer, S: Shader<F::Format>> Assembly<'s, 'a, 'm, F, S> {
    /// Takes the parts of a mesh that can be seen.
    #[inline(never)]
    fn parts(&mut self, nodes: &[BoundsNode], mvp: &Projective) {
        let frustum = self.scene.frustum(self.state, mvp);
        let mut k = 0;
        while let Some(node) = nodes.get(k) {
            if frustum.bounds(&node.bounds) == Containment::Outside {
                self.scene.stats.culled = self.scene.stats.culled.wrapping_add(1);
                k = usize::from(node.skip);
            } else {
                let first = usize::from(node.first_triangle);
                self.triangles(first..first + usize::from(node.triangles));
                k += 1;
            }
        }
    }

    /// Takes triangles one by one.
    #[inline(never)]
    fn triangles(&mut self, numbers: Range<usize>) {
        for number in numbers {
            if self.scene.records.overflowed() {
                return;
            }
            // 2. Primitive assembly.
            let Some(corners) = self.mesh.triangle(number) else {
                return;
            };
            self.scene.stats.triangles = self.scene.stats.triangles.wrapping_add(1);
            // 3. Vertex stage, once a vertex where there are records to keep the result.
            // Arrays are spelled out here: at `opt-level = "s"`, `map` is a loop through memory.
            let [i, j, k] = corners;
            let (a, b, c) = (self.slot(usize::from(i)), self.slot(usize::from(j)), self.slot(usize::from(k)));
            if a.is_on_screen() & b.is_on_screen() & c.is_on_screen() {
                self.screen_triangle(&[a.screen(), b.screen(), c.screen()], corners, number);
            } else {
                self.clip([a.outcode(), b.outcode(), c.outcode()], corners, number);
            }
        }
    }

    /// The vertex stage's result for a vertex: transformed, projected and snapped, or its outcode.
    #[inline]
    fn slot(&mut self, index: usize) -> Slot {
        if self.cached {
            let slot = Slot::read(self.scene.records.vertex(index));
            if !slot.is_unshaded() {
                return slot;
            }
        }
        self.shade(index)
    }

    #[inline(never)]
    fn shade(&mut self, index: usize) -> Slot {
        self.scene.stats.vertices = self.scene.stats.vertices.wrapping_add(1);
        let placed = if S::DISPLACES {
            place(&self.transformed(index))
        } else {
            self.transform.place(&self.mesh.data().positions, index)
        };
        let slot = Slot::new(&placed);
        if self.cached {
            let varyings = self.vertex(index);
            self.scene.records.keep::<S>(index, slot, &varyings);
        }
        slot
    }

    #[inline]
    fn transformed(&self, index: usize) -> ClipVertex {
        if S::DISPLACES {
            self.transform.point(self.shader.displace(&Corner::new(self.mesh, index)))
        } else {
            self.transform.vertex(&self.mesh.data().positions, index)
        }
    }

    /// The varyings of a vertex, with 1 / w if they take it.
    #[inline]
    fn vertex(&self, index: usize) -> S::Varyings {
        let mut varyings = self.shader.vertex(&Corner::new(self.mesh, index));
        if S::Varyings::PERSPECTIVE > 0 {
            varyings.set_inverse_w(inverse_w(&self.transformed(index)));
        }
        varyings
    }

    /// 4. Clipping, of a triangle with a vertex outside.
    #[inline(never)]
    fn clip(&mut self, codes: [u8; 3], corners: [u16; 3], number: usize) {
        let clamped = self.state.range.clamped().0;
        if codes[0] & codes[1] & codes[2] & !clamped != 0 {
            self.scene.stats.outside = self.scene.stats.outside.wrapping_add(1);
            return;
        }
        self.scene.stats.clipped = self.scene.stats.clipped.wrapping_add(1);
        let all = Outcode(codes[0] | codes[1] | codes[2]);
        for part in self.state.range.parts(all) {
            let mut fan = Fan::<S::Varyings>::new();
            self.cut(corners, all, part, &mut fan);
            self.fan(&fan, corners, number);
        }
    }

    /// What is left of a part of a triangle, on the screen. In a function of its own, so that the polygon in clip space
    /// has left the stack when it is drawn.
    #[inline(never)]
    fn cut(&self, corners: [u16; 3], codes: Outcode, part: Part, fan: &mut Fan<S::Varyings>) {
        let triangle = corners.map(|k| {
            let corner = Corner::new(self.mesh, usize::from(k));
            (self.transformed(usize::from(k)), self.shader.vertex(&corner))
        });
        clip_triangle(&triangle, codes, part, |(vertex, varyings)| {
            if let Some(placed) = project(vertex) {
                let mut varyings = *varyings;
                if S::Varyings::PERSPECTIVE > 0 {
                    varyings.set_inverse_w(inverse_w(vertex));
                }
                // There are no more corners than places.
                let _ = fan.push((placed, varyings));
            }
        });
    }

    /// Draws a clipped polygon as a fan of triangles.
    #[inline(never)]
    fn fan(&mut self, fan: &Fan<S::Varyings>, corners: [u16; 3], number: usize) {
        let mut placed = fan.iter().copied();
        let recording = self.scene.phase == Phase::Record;
        let (Some(first), Some(mut last)) = (placed.next(), placed.next()) else {
            return;
        };
        let mut first_index = 0;
        let mut last_index = 0;
        if recording {
            first_index = self.push(&first);
            last_index = self.push(&last);
        }
        for next in placed {
            let next_index = if recording { self.push(&next) } else { 0 };
            let v = [first.0, last.0, next.0];
            if let Some((visible, side)) = self.visible(&v) {
                let word = self.shader.face(&Face::new(self.mesh, number, corners, side));
                if recording {
                    self.record(&visible, [first_index, last_index, next_index], word);
                } else {
                    // What the records would keep of the varyings, so that the picture is the same without them.
                    let varyings = [&first, &last, &next].map(|corner| rounded::<S>(&corner.1));
                    self.draw(&v, &varyings, word);
                }
            }
            (last, last_index) = (next, next_index);
        }
    }

    fn push(&mut self, vertex: &(ScreenVertex, S::Varyings)) -> u16 {
        let index = self.scene.records.push_vertex();
        self.scene.records.keep::<S>(usize::from(index), Slot::new(&Placed::Screen(vertex.0)), &vertex.1);
        index
    }

    /// A triangle that needs no clipping.
    #[inline]
    fn screen_triangle(&mut self, v: &[ScreenVertex; 3], corners: [u16; 3], number: usize) {
        let Some((visible, side)) = self.visible(v) else { return };
        let word = self.shader.face(&Face::new(self.mesh, number, corners, side));
        if self.scene.phase == Phase::Record {
            self.record(&visible, corners, word);
        } else {
            let varyings = corners.map(|k| self.varyings(usize::from(k)));
            self.draw(v, &varyings, word);
        }
    }

    fn varyings(&self, index: usize) -> S::Varyings {
        if self.cached {
            return self.scene.records.varyings::<S>(index);
        }
        rounded::<S>(&self.vertex(index))
    }

    /// 5. Culling by winding, and of what covers no pixel: where the triangle can have pixels and which side it shows.
    #[inline]
    fn visible(&mut self, v: &[ScreenVertex; 3]) -> Option<(PixelRect, Side)> {
        let stats = &mut *self.scene.stats;
        let area = signed_area(&v[0], &v[1], &v[2]);
        if area == 0 {
            stats.degenerate = stats.degenerate.wrapping_add(1);
            return None;
        }
        let side = self.state.side(area);
        let is_back = side == Side::Back;
        if (self.state.cull == Cull::Back && is_back) || (self.state.cull == Cull::Front && !is_back) {
            stats.back_facing = stats.back_facing.wrapping_add(1);
            return None;
        }
        let rect = pixel_rect(v);
        if rect.is_empty() {
            stats.empty = stats.empty.wrapping_add(1);
            return None;
        }
        let rect = rect.intersection(&self.clip);
        if rect.is_empty() {
            stats.outside = stats.outside.wrapping_add(1);
            return None;
        }
        stats.drawn = stats.drawn.wrapping_add(1);
        Some((rect, side))
    }

    /// 6, 7. Into the records, to the strip it begins in.
    fn record(&mut self, rect: &PixelRect, corners: [u16; 3], face: u32) {
        let row = (rect.y.start - self.scene.band.start) as u32;
        let Some(rows) = core::num::NonZeroU32::new(u32::from(self.scene.strip_rows)) else {
            return;
        };
        self.scene.records.push_triangle(corners, face, (row / rows) as usize);
    }

    fn draw(&mut self, v: &[ScreenVertex; 3], varyings: &[S::Varyings; 3], face: u32) {
        if let Some(target) = &mut self.scene.target {
            rasterize(target, self.scene.screen, &self.clip, self.state, self.shader, v, varyings, face);
        }
    }
}

/// The varyings as the records would give them back.
fn rounded<S: VertexShader>(varyings: &S::Varyings) -> S::Varyings {
    let mut words = S::Varyings::ZERO;
    let words: &mut [u32] = bytemuck::cast_slice_mut(words.as_mut());
    let words = words.get_mut(..S::WORDS).unwrap_or_default();
    S::store(varyings, words);
    S::load(words)
}

/// 8 to 11. A triangle on the screen: set-up, spans, depth test, fragments.
#[expect(clippy::too_many_arguments, reason = "all of them change from call to call, or belong to different owners")]
#[inline(never)]
fn rasterize<F: Framebuffer, S: Shader<F::Format>>(
    target: &mut Target<'_, F>,
    screen: (u16, u16),
    clip: &PixelRect,
    state: &State,
    shader: &S,
    v: &[ScreenVertex; 3],
    varyings: &[S::Varyings; 3],
    face: u32,
) {
    // 8. Plane equations of depth and varyings.
    let area = signed_area(&v[0], &v[1], &v[2]);
    if area == 0 {
        return;
    }
    let gradients = Gradients::new(v, area, screen);
    let depth =
        gradients.plane([i32::from(v[0].z), i32::from(v[1].z), i32::from(v[2].z)], 16).from_corner(gradients.origin());
    let (mut corner, mut dx, mut dy) = (S::Varyings::ZERO, S::Varyings::ZERO, S::Varyings::ZERO);
    let mut correction = <S::Varyings as Varyings>::Correction::NONE;
    let homogeneous;
    let mut varyings = varyings;
    if S::Varyings::PERSPECTIVE > 0 {
        (homogeneous, correction) = homogenize(varyings, v, screen);
        varyings = &homogeneous;
    }
    let values = varyings.each_ref().map(|v| v.as_ref());
    widen(&gradients, &values, &mut correction);
    for (k, ((corner, dx), dy)) in corner.as_mut().iter_mut().zip(dx.as_mut()).zip(dy.as_mut()).enumerate() {
        let values = values.map(|v| v.get(k).copied().unwrap_or(0) >> S::ZERO_BITS);
        let plane = gradients.plane(values, S::ZERO_BITS).from_corner(gradients.origin());
        (*corner, *dx, *dy) = (plane.base as i32, plane.dx, plane.dy);
    }
    let words = shader.prepare(&mut corner, &dx);
    let surface = Surface {
        // With the half that rounds.
        z: depth.base.wrapping_add(1 << 15),
        dz_dy: depth.dy,
        varyings: corner,
        d_dy: dy,
        steps: Steps { dz_dx: depth.dx, d_dx: dx, words, side: state.side(area), correction },
    };

    // 9. Spans; 10, 11: depth test and fragments, in a loop of its own for each kind of test.
    let columns = &clip.x;
    let width = screen.0 as usize;
    trapezoids(v, area, &clip.y, |edges, y| match state.depth {
        DepthState { compare: Compare::Less, write: true } => {
            rows(target, width, columns, &surface, shader, face, LessWrite, edges, y);
        }
        DepthState { compare: Compare::Always, write: false } => {
            rows(target, width, columns, &surface, shader, face, NoDepth, edges, y);
        }
        other => rows(target, width, columns, &surface, shader, face, AnyDepth::new(other), edges, y),
    });
}

/// What is interpolated over a triangle: values at the screen's corner and their changes, all modulo 2³².
struct Surface<V: Varyings> {
    z: u32,
    dz_dy: i32,
    varyings: V,
    d_dy: V,
    steps: Steps<V>,
}

/// 9 to 11 between two edges.
#[expect(clippy::too_many_arguments, reason = "all of them change from call to call, or belong to different owners")]
#[inline(never)]
fn rows<F: Framebuffer, S: Shader<F::Format>, D: DepthTest>(
    target: &mut Target<'_, F>,
    width: usize,
    columns: &Range<i32>,
    surface: &Surface<S::Varyings>,
    shader: &S,
    face: u32,
    test: D,
    edges: &mut [Edge; 2],
    rows: Range<i32>,
) {
    let [mut left, mut right] = *edges;
    let depths = &mut *target.depth;
    let framebuffer = &mut *target.framebuffer;
    let steps = &surface.steps;
    let mut y = rows.start;
    // Column 0 of the row: where its depth is, and what is there.
    let mut row = width.wrapping_mul((y - target.rows.start) as usize);
    let mut z = surface.z.wrapping_add_signed(surface.dz_dy.wrapping_mul(y));
    while y < rows.end {
        let start = left.pixel().max(columns.start);
        let length = right.pixel().min(columns.end) - start;
        if length > 0 {
            let (column, length) = (start as usize, length as usize);
            let color = framebuffer.span(y as u32, column, length);
            // As many depths as pixels, should the framebuffer be narrower than the screen.
            let Some(depth) = depths.get_mut(row + column..) else { return };
            let Some(depth) = depth.get_mut(..color.len()) else { return };
            let mut varyings = surface.varyings;
            let d_dx = steps.d_dx.as_ref().iter();
            for ((value, dx), dy) in varyings.as_mut().iter_mut().zip(d_dx).zip(surface.d_dy.as_ref()) {
                *value = value.wrapping_add(dx.wrapping_mul(start)).wrapping_add(dy.wrapping_mul(y));
            }
            let z = z.wrapping_add_signed(steps.dz_dx.wrapping_mul(start));
            shader.span(face, Fragments { color, depth, z, varyings, steps, position: (start, y) }, test);
        }
        left.step();
        right.step();
        row += width;
        z = z.wrapping_add_signed(surface.dz_dy);
        y += 1;
    }
    *edges = [left, right];
}

/// A word that differs, almost surely, between draws that would not leave the same records.
fn fingerprint(state: &State, mesh: &Mesh<'_>, mvp: &Projective, viewport: &Viewport, stride: usize) -> u32 {
    // FNV-1a over words instead of bytes.
    let mut hash = 0x811C_9DC5_u32;
    let mut add = |word: u32| hash = (hash ^ word).wrapping_mul(0x0100_0193).rotate_left(11);
    for entry in mvp.to_rows().iter().flatten() {
        add(*entry as u32);
        add((*entry >> 32) as u32);
    }
    add(viewport.x() as u32 ^ (viewport.y() as u32) << 16);
    add(u32::from(viewport.width()) | u32::from(viewport.height()) << 16);
    add(mesh.vertex_count() as u32 | (mesh.triangle_count() as u32) << 16);
    let aabb = &mesh.bounds().aabb;
    for coordinate in aabb.center.to_bits().into_iter().chain(aabb.half.to_bits()) {
        add(coordinate as u32);
    }
    add(stride as u32 | (state.cull as u32) << 16 | (state.range as u32) << 20 | (state.front as u32) << 24);
    add(state.depth.compare as u32 | u32::from(state.depth.write) << 8);
    hash
}
