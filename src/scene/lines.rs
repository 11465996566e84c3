//! Lines and points in space: lines or points, a matrix and a shader come in, and pixels of the current strip go out.
//!
//! Draws of lines and points begin as those of meshes do, with stage 1 of [the pipeline](crate#the-pipeline), bounds.
//! Their vertices are in the records like those of meshes. But no list says which strip a line or point touches: each
//! strip looks at all of them. This takes some 80 instructions per line that lies elsewhere, and no memory. A vertex is
//! shaded, stage 2, in the first strip that needs it.

use super::painter::{Painter, RasterHooks};
use super::scan::may_reach;
use super::scene::{Draw, Phase, Primitives, Scene};
use super::state::State;
use super::stroke::{Stroke, block};
use super::vertex_stage::VertexStage;
use crate::math::{Pixels, Projective};
use crate::mesh::{Lines, Points};
use crate::raster::{PixelRect, square};
use crate::span::Shader;
use crate::target::Framebuffer;
use crate::vertex::{DepthSlab, Face, Outcode, PackedVertex, ScreenMatrix, ScreenVertex, Side, Transform, clip_line};

impl<'a, F: Framebuffer> Scene<'a, F> {
    /// Draws lines with a stroke: nearer fragments win, and lines are clipped at the near and the far plane.
    ///
    /// `mvp` takes object space to clip space: camera · view · model. A shader sees a line as a face without a normal
    /// that shows its front. The line's first end is the provoking vertex. Varyings are interpolated along the line:
    /// linearly on the screen, or in space if they are [`Perspective`](crate::vertex::Perspective).
    ///
    /// ```
    /// # use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};
    /// # use zstrip::{Framebuffer, Scene, math::Projective, mesh::Lines, shader::Flat};
    /// use zstrip::Thin;
    /// # fn f(scene: &mut Scene<'_, impl Framebuffer>, axes: &Lines<'_>, mvp: &Projective) {
    /// scene.draw_lines(axes, mvp, &Flat::unlit(Rgb888::WHITE), &Thin);
    /// # }
    /// ```
    pub fn draw_lines<S: Shader<F::Format>, K: Stroke>(
        &mut self,
        lines: &Lines<'_>,
        mvp: &Projective,
        shader: &S,
        stroke: &K,
    ) {
        self.draw_lines_with(State::DEFAULT, lines, mvp, shader, stroke);
    }

    /// Draws lines with a stroke, by the rules of `state`.
    ///
    /// **Lines on a surface.** A line has the depth of its own points. The surface that it outlines has the depth of
    /// the centres of its pixels, up to half a pixel away in x and in y. So push the surface back, by one step plus
    /// once its slope. Then the surface never hides a line that lies on it, and nearer surfaces still hide the line:
    ///
    /// ```
    /// # use zstrip::State;
    /// # use zstrip::span::DepthBias;
    /// # use zstrip::math::Scalar;
    /// const SURFACE: State = State { bias: DepthBias { constant: 1, slope: Scalar::ONE }, ..State::DEFAULT };
    /// ```
    /// If surfaces must keep their depths, pull lines forward instead, by a bias of `constant: -1`, or by more for
    /// steeper surfaces. For a wireframe with hidden lines removed, draw the surface with
    /// [`DepthOnly`](crate::shader::DepthOnly) first.
    pub fn draw_lines_with<S: Shader<F::Format>, K: Stroke>(
        &mut self,
        state: State,
        lines: &Lines<'_>,
        mvp: &Projective,
        shader: &S,
        stroke: &K,
    ) {
        let vertices = lines.vertices();
        let samples = self.samples(vertices, lines.count(), |n| lines.line(n).map(|[i, j]| [i, j, j]));
        let primitives = Primitives::Lines { reach: stroke.reach(), samples };
        let draw = Draw::new::<S, K>(&state, Some(Transform::set_depth_scale), vertices, mvp, primitives);
        if self.begin_lines(&draw) {
            LineDraw::new(self, &draw, shader).lines(lines, stroke);
        }
    }

    /// Draws points as squares with sides of `size`: nearer fragments win.
    ///
    /// The centre of a square is its vertex, and its depth is the vertex's depth. A shader sees a point as a face, as
    /// it sees a line. A point in front of the near plane or beyond the far plane is not drawn.
    ///
    /// ```
    /// # use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};
    /// # use zstrip::{Framebuffer, Scene, math::Projective, mesh::Points, shader::Flat};
    /// use zstrip::math::Pixels;
    /// # fn f(scene: &mut Scene<'_, impl Framebuffer>, stars: &Points<'_>, mvp: &Projective) {
    /// scene.draw_points(stars, mvp, &Flat::unlit(Rgb888::WHITE), Pixels::from_num(3));
    /// # }
    /// ```
    pub fn draw_points<S: Shader<F::Format>>(
        &mut self,
        points: &Points<'_>,
        mvp: &Projective,
        shader: &S,
        size: Pixels,
    ) {
        self.draw_points_with(State::DEFAULT, points, mvp, shader, size);
    }

    /// Draws points as squares with sides of `size`, by the rules of `state`.
    pub fn draw_points_with<S: Shader<F::Format>>(
        &mut self,
        state: State,
        points: &Points<'_>,
        mvp: &Projective,
        shader: &S,
        size: Pixels,
    ) {
        let size = size.to_bits().max(0) as u32;
        let vertices = points.vertices();
        let samples = self.samples(vertices, vertices.vertex_count(), |n| Some([n as u16; 3]));
        let primitives = Primitives::Points { reach: (size.min(1 << 24) >> 9) as i32 + 1, samples };
        let draw = Draw::new::<S, ()>(&state, Some(Transform::set_depth_scale), vertices, mvp, primitives);
        if self.begin_lines(&draw) {
            LineDraw::new(self, &draw, shader).points(size);
        }
    }

    /// Begins a draw of lines or points, and returns whether any of them may be drawn in this strip. While a band is
    /// recorded, it only reserves room for their vertices.
    #[inline(never)]
    fn begin_lines(&mut self, draw: &Draw<'_>) -> bool {
        if F::RECORDS && self.phase == Phase::Replay {
            return self.find_draw(draw) && !self.records.is_draw_empty();
        }
        let visible = self.begin_draw(draw, None);
        if self.is_recording() {
            if visible {
                self.end_draw();
            }
            return false;
        }
        visible
    }
}

/// The lines or points of a draw, in one strip.
struct LineDraw<'s, 'a, F, S> {
    scene: &'s mut Scene<'a, F>,
    draw: &'s Draw<'s>,
    shader: &'s S,
    /// Pixels of the strip that may be drawn.
    clip: PixelRect,
    /// Transform of the vertex stage, made when the first vertex has to be shaded or the first line has to be clipped.
    transform: Option<Transform>,
}

impl<'s, 'a, F: Framebuffer, S: Shader<F::Format>> LineDraw<'s, 'a, F, S> {
    fn new(scene: &'s mut Scene<'a, F>, draw: &'s Draw<'s>, shader: &'s S) -> Self {
        let clip = scene.clip_rect(&scene.target.rows);
        Self { scene, draw, shader, clip, transform: None }
    }

    #[inline(never)]
    fn lines<K: Stroke>(&mut self, lines: &Lines<'_>, stroke: &K) {
        let reach = stroke.reach();
        // Borders of the region that a line has to touch, in 24.8.
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

    /// Returns the next line, from `number` on, that may have pixels in the rows from `top` to `bottom`. The lines that
    /// it passes over have both ends above or both ends below these rows. Each strip passes over many lines, so this is
    /// a loop of its own.
    #[inline(never)]
    fn next_near(&self, lines: &Lines<'_>, mut number: usize, top: i32, bottom: i32) -> Option<(usize, [u16; 2])> {
        let positions = self.scene.records.positions();
        // Coordinates have 24 bits. Vertices that are not on the screen have the least possible coordinates.
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
        for index in 0..self.draw.mesh.vertex_count() {
            self.scene.stats.points = self.scene.stats.points.wrapping_add(1);
            let packed = self.packed_vertex(index);
            let place = if packed.is_on_screen() {
                Some(packed.screen())
            } else if packed.outcode() & !self.draw.state.range.clamped().0 == 0 {
                let (_, stage) = self.stage();
                stage.transform.project(&stage.transformed(index))
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

    /// Returns the vertex stage's result for a vertex.
    #[inline]
    fn packed_vertex(&mut self, index: usize) -> PackedVertex {
        let packed = self.scene.records.packed_vertex(index);
        if !packed.is_unshaded() {
            return packed;
        }
        let (scene, stage) = self.stage();
        stage.shade(scene, index)
    }

    /// Returns the vertex stage beside the scene, and makes the transform if there is none yet.
    #[inline(never)]
    fn stage(&mut self) -> (&mut Scene<'a, F>, VertexStage<'_, S>) {
        let Self { scene, draw, shader, transform, .. } = self;
        let transform = transform.get_or_insert_with(|| {
            let (mut screen, mut transform) = (ScreenMatrix::EMPTY, Transform::default());
            screen.set_from(draw.mvp, &scene.viewport);
            draw.set_transform(&screen, &mut transform);
            transform
        });
        (scene, VertexStage { mesh: draw.mesh, shader, transform })
    }

    /// Returns the varyings of a vertex.
    fn varyings(&mut self, index: u16) -> S::Varyings {
        if self.scene.keeps_vertices() {
            // The transform is not needed, and may not have been made.
            return self.scene.records.varyings::<S>(index);
        }
        let (scene, stage) = self.stage();
        stage.kept(scene, index)
    }

    fn face(&self, [a, b]: [u16; 2], number: usize) -> u32 {
        self.shader.face(&Face::new(self.draw.mesh, number, [a, b, b], Side::Front))
    }

    fn painter(&mut self) -> Painter<'_, 'a, F, S> {
        self.scene.painter(&self.clip, self.draw.state, &const { RasterHooks::ANY }, self.shader)
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

    /// Draws a line with an end outside of the planes. It is cut anew in each strip, so that the records stay as they
    /// are.
    #[inline(never)]
    fn clip<K: Stroke>(&mut self, codes: [u8; 2], corners: [u16; 2], number: usize, stroke: &K) {
        if codes[0] & codes[1] & !self.draw.state.range.clamped().0 != 0 {
            self.scene.stats.outside = self.scene.stats.outside.wrapping_add(1);
            return;
        }
        if !self.may_reach(corners, stroke.reach()) {
            self.scene.stats.outside = self.scene.stats.outside.wrapping_add(1);
            return;
        }
        self.scene.stats.clipped = self.scene.stats.clipped.wrapping_add(1);
        let all = Outcode(codes[0] | codes[1]);
        for slab in [DepthSlab::Inside].into_iter().chain(self.draw.state.range.clamped_slabs(all)) {
            if let Some(ends) = self.cut(corners, all, slab) {
                self.draw(&ends, corners, number, stroke);
            }
        }
    }

    /// Returns whether a line that has to be cut may cover pixels of this strip.
    #[inline(never)]
    fn may_reach(&mut self, corners: [u16; 2], reach: i32) -> bool {
        let (_, stage) = self.stage();
        let ends = corners.map(|index| stage.transformed(usize::from(index)));
        may_reach(&self.clip, reach, &ends)
    }

    /// Cuts a line to one slab of depth, and returns the ends of the remaining part on the screen. Not inlined, so that
    /// the ends in clip space are no longer on the stack when the line is drawn.
    #[inline(never)]
    fn cut(&mut self, corners: [u16; 2], codes: Outcode, slab: DepthSlab) -> Option<[(ScreenVertex, S::Varyings); 2]> {
        let (_, stage) = self.stage();
        let [i, j] = corners.map(usize::from);
        let [a, b] = clip_line([stage.transformed(i), stage.transformed(j)], codes, slab)?;
        let (from, to) = (stage.transform.project(&a.vertex)?, stage.transform.project(&b.vertex)?);
        Some([(from, stage.rounded_end(corners, &a)), (to, stage.rounded_end(corners, &b))])
    }
}
