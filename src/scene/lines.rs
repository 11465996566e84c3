//! Lines and points in space.
//!
//! Their vertices are in the records as those of meshes are, but no list says which strip they touch: each strip walks over
//! all of them, which takes some 30 instructions for one that lies elsewhere, and no memory. A vertex is shaded when
//! the first strip meets it.

use super::assembly::{Assembly, AssemblyHooks, rounded};
use super::painter::{Painter, RasterHooks};
use super::scene::{Phase, Scene, fingerprint};
use super::state::State;
use super::stroke::{Stroke, Thin, block};
use crate::math::Projective;
use crate::mesh::{Lines, Mesh, Points, Positions};
use crate::raster::{PixelRect, square};
use crate::span::Shader;
use crate::target::{Framebuffer, PackedVertex, VERTEX_WORDS};
use crate::vertex::{
    DepthSlab, Face, Outcode, ScreenMatrix, ScreenVertex, Side, Transform, Varyings, VertexRef, VertexShader,
    clip_line, weighted,
};

impl<'a, F: Framebuffer> Scene<'a, F> {
    /// Draws lines of one pixel's width: nearer fragments win, clipped at the near and the far plane.
    ///
    /// `mvp` takes object space to clip space: camera · view · model. To the shader, a line is a face without a normal that
    /// shows its front; its first end is the provoking vertex. Varyings are interpolated along the line, linearly on the
    /// screen.
    pub fn draw_lines<S: Shader<F::Format>>(&mut self, lines: &Lines<'_>, mvp: &Projective, shader: &S) {
        self.draw_lines_with(State::default(), lines, mvp, shader, &Thin);
    }

    /// Draws lines by other rules, with a stroke of one's choice.
    ///
    /// **Lines on a surface.** A line has the depth of its own points; the surface it outlines has that of its pixels' centres,
    /// up to half a pixel away in x and in y. So push the surface back, by one step and once its slope, and nothing of its
    /// own hides a line on it, while what lies nearer still does:
    ///
    /// ```
    /// # use zstrip::State;
    /// # use zstrip::span::DepthBias;
    /// # use zstrip::math::Scalar;
    /// const SURFACE: State = State { bias: DepthBias { constant: 1, slope: Scalar::ONE }, ..State::DEFAULT };
    /// ```
    /// Where surfaces must keep their depths, pull lines forward instead, by a bias of `constant: -1` and more the steeper
    /// the surface is. For a wireframe with hidden lines removed, draw the surface with
    /// [`DepthOnly`](crate::shader::DepthOnly) first.
    pub fn draw_lines_with<S: Shader<F::Format>, K: Stroke>(
        &mut self,
        state: State,
        lines: &Lines<'_>,
        mvp: &Projective,
        shader: &S,
        stroke: &K,
    ) {
        if self.begin_walk(&state, lines.vertices(), mvp, stride::<S>(), lines.count(), stroke.reach(), S::DISPLACES) {
            Walk::new(self, &state, lines.vertices(), mvp, shader).lines(lines, stroke);
        }
    }

    /// Draws points as squares with sides of `size` px, in 24.8, about the vertices, each at the depth of its vertex. To
    /// the shader, a point is a face as a line is. A point before the near or beyond the far plane is not drawn.
    pub fn draw_points<S: Shader<F::Format>>(
        &mut self,
        state: State,
        points: &Points<'_>,
        mvp: &Projective,
        shader: &S,
        size: u32,
    ) {
        let reach = (size.min(1 << 24) >> 9) as i32 + 1;
        let count = points.vertices().vertex_count();
        if self.begin_walk(&state, points.vertices(), mvp, stride::<S>(), count, reach, S::DISPLACES) {
            Walk::new(self, &state, points.vertices(), mvp, shader).points(size);
        }
    }

    /// Starts a draw of `count` lines or points whose pixels are up to `reach` px away; whether it has to be walked over
    /// now.
    #[expect(clippy::too_many_arguments, reason = "what the fingerprint is made of")]
    #[inline(never)]
    fn begin_walk(
        &mut self,
        state: &State,
        vertices: &Mesh<'_>,
        mvp: &Projective,
        stride: usize,
        count: usize,
        reach: i32,
        displaced: bool,
    ) -> bool {
        // No mesh has that many triangles and a reach.
        let kind = (count as u32).rotate_left(8) ^ !(reach as u32);
        let print = fingerprint(state, vertices, mvp, &self.viewport, stride) ^ kind;
        if F::RECORDS && self.phase == Phase::Replay {
            return self.find_draw(print, vertices.vertex_count(), stride) && !self.records.is_draw_empty();
        }
        self.count_draw();
        let recording = self.is_recording();
        if self.overflowed() {
            return false;
        }
        let bounded = !displaced && !matches!(vertices.data().positions, Positions::Homogeneous(_));
        let rect = self.clip_rect(&self.band);
        let (x, y) = (rect.x.start - reach..rect.x.end + reach, rect.y.start - reach..rect.y.end + reach);
        let planes = state.range.clamped();
        let mut view = ScreenMatrix::EMPTY;
        view.set_from(mvp, &self.viewport);
        let culled = bounded && !view.sees(vertices.bounds(), &x, &y, planes);
        self.stats.culled = self.stats.culled.wrapping_add(u32::from(culled));
        if recording {
            let count = if culled { 0 } else { vertices.vertex_count() };
            self.records.begin_draw(print, count, stride);
            self.records.end_draw();
            return false;
        }
        if F::RECORDS && !culled {
            self.records.begin_direct(vertices.vertex_count(), stride);
        }
        !culled
    }
}

/// Words of a vertex in the records.
fn stride<S: VertexShader>() -> usize {
    const {
        assert!(S::WORDS <= <S::Varyings as Varyings>::LEN, "a vertex needs no more words than varyings");
        assert!(S::WORDS <= 253, "a vertex has at most 253 words of varyings");
    };
    S::WORDS + VERTEX_WORDS
}

/// A walk over the lines or points of a draw, in a strip.
struct Walk<'s, 'a, F, S> {
    scene: &'s mut Scene<'a, F>,
    state: &'s State,
    vertices: &'s Mesh<'s>,
    mvp: &'s Projective,
    shader: &'s S,
    /// Pixels of the strip that may be drawn.
    clip: PixelRect,
    /// Made when a vertex has to be shaded, or a line to be clipped.
    transform: Option<Transform>,
}

impl<'s, 'a, F: Framebuffer, S: Shader<F::Format>> Walk<'s, 'a, F, S> {
    fn new(
        scene: &'s mut Scene<'a, F>,
        state: &'s State,
        vertices: &'s Mesh<'s>,
        mvp: &'s Projective,
        shader: &'s S,
    ) -> Self {
        let clip = scene.clip_rect(&scene.target.rows);
        Self { scene, state, vertices, mvp, shader, clip, transform: None }
    }

    #[inline(never)]
    fn lines<K: Stroke>(&mut self, lines: &Lines<'_>, stroke: &K) {
        let reach = stroke.reach();
        // What a line has to touch, in 24.8.
        let (left, right) = (256 * (self.clip.x.start - reach), 256 * (self.clip.x.end + reach));
        let (top, bottom) = (256 * (self.clip.y.start - reach), 256 * (self.clip.y.end + reach));
        self.scene.stats.lines = self.scene.stats.lines.wrapping_add(lines.count() as u32);
        let mut number = 0;
        while let Some((candidate, [i, j])) = self.next_near(lines, number, top, bottom) {
            number = candidate + 1;
            let (a, b) = (self.packed_vertex(usize::from(i)), self.packed_vertex(usize::from(j)));
            if !(a.is_on_screen() & b.is_on_screen()) {
                self.clip([a.outcode(), b.outcode()], [i, j], candidate, stroke);
                continue;
            }
            let (a, b) = (a.screen(), b.screen());
            if (a.y < top && b.y < top) || (a.y > bottom && b.y > bottom) {
                continue;
            }
            if (a.x < left && b.x < left) || (a.x > right && b.x > right) {
                continue;
            }
            let ends = [(a, self.varyings(i)), (b, self.varyings(j))];
            self.draw(&ends, [i, j], candidate, stroke);
        }
    }

    /// The next line from `number` on that may have pixels in these rows: all others have both of their ends above, or both
    /// below them. Many lines are passed over in each strip, so this is a loop of its own.
    #[inline(never)]
    fn next_near(&self, lines: &Lines<'_>, mut number: usize, top: i32, bottom: i32) -> Option<(usize, [u16; 2])> {
        let positions = self.scene.records.positions();
        // Coordinates have 24 bits; those of vertices that are not on the screen are the least there are.
        let (top, bottom) = (top.max(-(1 << 23)) << 8, (bottom.min((1 << 23) - 1) << 8) | 0xFF);
        loop {
            let [i, j] = lines.line(number)?;
            let ends = (positions.get(usize::from(i)), positions.get(usize::from(j)));
            let (Some([x, y]), Some([to_x, to_y])) = ends else { return Some((number, [i, j])) };
            let (y, to_y) = (*y as i32, *to_y as i32);
            if !((y < top && to_y < top) || (y > bottom && to_y > bottom)) {
                return Some((number, [i, j]));
            }
            if (*x as i32).min(*to_x as i32) < PackedVertex::LEAST_X {
                return Some((number, [i, j]));
            }
            number += 1;
        }
    }

    #[inline(never)]
    fn points(&mut self, size: u32) {
        for index in 0..self.vertices.vertex_count() {
            self.scene.stats.points = self.scene.stats.points.wrapping_add(1);
            let packed = self.packed_vertex(index);
            let place = if packed.is_on_screen() {
                Some(packed.screen())
            } else if packed.outcode() & !self.state.range.clamped().0 == 0 {
                let assembly = self.assembly();
                assembly.transform.project(&assembly.transformed(index))
            } else {
                None
            };
            let Some(v) = place else { continue };
            let rect = square((v.x, v.y), size).intersection(&self.clip);
            if !rect.is_empty() {
                let number = index as u16;
                let varyings = self.varyings(number);
                let face = self.face([number, number], index);
                block(&mut self.painter(), &rect, v.z, &varyings, face);
            }
        }
    }

    /// The vertex stage's result for a vertex.
    #[inline]
    fn packed_vertex(&mut self, index: usize) -> PackedVertex {
        let packed = self.scene.records.packed_vertex(index);
        if packed.is_unshaded() { self.assembly().shade(index) } else { packed }
    }

    /// The vertex stage.
    #[inline(never)]
    fn assembly(&mut self) -> Assembly<'_, 'a, F, S> {
        let Self { scene, state, vertices, mvp, shader, clip, transform } = self;
        let transform = transform.get_or_insert_with(|| {
            let mut transform = Transform::new(mvp, &scene.viewport, vertices, S::DISPLACES);
            transform.set_depth_scale(state.depth_scale);
            transform
        });
        Assembly {
            scene,
            state,
            hooks: &const { AssemblyHooks::ANY },
            mesh: vertices,
            shader,
            transform,
            culling: state.culling(),
            clip: clip.clone(),
        }
    }

    fn varyings(&self, index: u16) -> S::Varyings {
        if self.scene.has_vertices() {
            return self.scene.records.varyings::<S>(index);
        }
        rounded::<S>(&self.shader.vertex(&VertexRef::new(self.vertices, usize::from(index))))
    }

    fn face(&self, [a, b]: [u16; 2], number: usize) -> u32 {
        self.shader.face(&Face::new(self.vertices, number, [a, b, b], Side::Front))
    }

    fn painter(&mut self) -> Painter<'_, 'a, F, S> {
        self.scene.painter(&self.clip, self.state, &const { RasterHooks::ANY }, self.shader)
    }

    #[inline(never)]
    fn draw<K: Stroke>(
        &mut self,
        ends: &[(ScreenVertex, S::Varyings); 2],
        corners: [u16; 2],
        number: usize,
        stroke: &K,
    ) {
        let face = self.face(corners, number);
        stroke.draw(&mut self.painter(), ends, face);
    }

    /// A line with an end outside: cut anew in each strip, which keeps the records as they are.
    #[inline(never)]
    fn clip<K: Stroke>(&mut self, codes: [u8; 2], corners: [u16; 2], number: usize, stroke: &K) {
        if codes[0] & codes[1] & !self.state.range.clamped().0 != 0 {
            self.scene.stats.outside = self.scene.stats.outside.wrapping_add(1);
            return;
        }
        self.scene.stats.clipped = self.scene.stats.clipped.wrapping_add(1);
        let all = Outcode(codes[0] | codes[1]);
        for part in [DepthSlab::Inside].into_iter().chain(self.state.range.clamped_slabs(all)) {
            if let Some(ends) = self.cut(corners, all, part) {
                self.draw(&ends, corners, number, stroke);
            }
        }
    }

    /// What is left of a part of a line, on the screen. In a function of its own, so that its ends in clip space have left
    /// the stack when it is drawn.
    #[inline(never)]
    fn cut(&mut self, corners: [u16; 2], codes: Outcode, part: DepthSlab) -> Option<[(ScreenVertex, S::Varyings); 2]> {
        let assembly = self.assembly();
        let [i, j] = corners.map(usize::from);
        let [a, b] = clip_line([assembly.transformed(i), assembly.transformed(j)], codes, part)?;
        let (from, to) = (assembly.transform.project(&a.vertex)?, assembly.transform.project(&b.vertex)?);
        let (first, last) = (assembly.vertex(i), assembly.vertex(j));
        // What the records would keep of the varyings, as for ends that are not cut.
        let at = |weights| rounded::<S>(&weighted(weights, &[first, last, last]));
        Some([(from, at(&a.weights)), (to, at(&b.weights))])
    }
}
