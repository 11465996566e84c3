//! The calls that draw meshes: a mesh, a matrix and a shader come in, and go through [the pipeline](crate#the-pipeline)
//! from top to bottom. Stages 1 to 7 are in `assemble`, stages 8 to 11 in `replay`.

use super::assembly::{Assembly, AssemblyHooks};
use super::painter::Painter;
use super::scene::{Draw, Phase, Primitives, Scene};
use super::state::State;
use crate::math::Projective;
use crate::mesh::Mesh;
use crate::span::Shader;
use crate::target::{Framebuffer, TriangleRecord, Triangles};
use crate::vertex::{Transform, Varyings};

impl<F: Framebuffer> Scene<'_, F> {
    /// Draws a mesh with the default state: back faces are culled, nearer fragments win, and triangles are clipped at
    /// the near and the far plane.
    ///
    /// `mvp` takes object space to clip space: camera · view · model.
    pub fn draw<S: Shader<F::Format>>(&mut self, mesh: &Mesh<'_>, mvp: &Projective, shader: &S) {
        self.draw_by(&State::DEFAULT, &const { AssemblyHooks::DEFAULT }, mesh, mvp, shader);
    }

    /// Draws a mesh by the rules of `state`.
    ///
    /// A program links the loops for all depth tests that `state` may ask for. If `state` is a constant, the program
    /// links only the loop for its depth test.
    #[inline]
    pub fn draw_with<S: Shader<F::Format>>(&mut self, state: State, mesh: &Mesh<'_>, mvp: &Projective, shader: &S) {
        self.draw_by(&state, &AssemblyHooks::of(&state), mesh, mvp, shader);
    }

    // Inlined, so that its frame is not on the stack under the whole draw.
    #[inline(always)]
    fn draw_by<S: Shader<F::Format>>(
        &mut self,
        state: &State,
        hooks: &AssemblyHooks<F, S>,
        mesh: &Mesh<'_>,
        mvp: &Projective,
        shader: &S,
    ) {
        let draw = Draw::new::<S, ()>(state, hooks.depth_scale, mesh, mvp, Primitives::Triangles);
        if F::RECORDS && self.phase == Phase::Replay {
            if self.find_draw(&draw) {
                self.replay(state, hooks, shader);
            }
        } else {
            self.assemble(&draw, hooks, shader);
        }
    }

    /// Records the triangles of a draw, or draws them directly: stages 1 to 7.
    #[inline(never)]
    fn assemble<S: Shader<F::Format>>(&mut self, draw: &Draw<'_>, hooks: &AssemblyHooks<F, S>, shader: &S) {
        let (state, mesh) = (draw.state, draw.mesh);
        // Stage 1, bounds.
        let mut transform = Transform::default();
        if !self.begin_draw(draw, Some(&mut transform)) {
            return;
        }
        let clip = self.clip_rect(&self.band);
        let culling = state.culling();
        let mut assembly = Assembly { scene: self, state, hooks, mesh, shader, transform: &transform, culling, clip };
        match draw.hierarchy() {
            // Stages 2 to 7, per part of the mesh that may be visible. Vertices are shaded when triangles ask for them.
            Some(nodes) => assembly.hierarchy(nodes, draw.mvp),
            _ => {
                // Stage 2, vertices: all at once, if their results are kept.
                if F::RECORDS {
                    assembly.shade_all();
                }
                // Stages 3 to 7, triangle by triangle: assembly, clipping, culling, recording, faces.
                assembly.triangles(0..mesh.triangle_count());
            }
        }
        self.end_draw();
    }

    /// Draws the recorded triangles of this draw in the current strip: stages 8 to 11, for each triangle in
    /// [`Painter::triangle_of_area`].
    #[inline(never)]
    fn replay<S: Shader<F::Format>>(&mut self, state: &State, hooks: &AssemblyHooks<F, S>, shader: &S) {
        let end = Triangles::end_of(self.target.rows.end);
        let clip = &self.clip_rect(&self.target.rows);
        let last = self.records.last_triangle();
        let mut triangles = self.records.triangles();
        // Stage 8, set-up; stage 9, spans; stage 10, depth test; stage 11, fragments.
        let mut painter =
            Painter { target: &mut self.target, screen: self.screen, clip, state, hooks: &hooks.raster, shader };
        let mut triangle = TriangleRecord::default();
        let mut varyings = [S::Varyings::ZERO; 3];
        while triangles.replay(last, end, &mut triangle) {
            let [i, j, k] = triangle.corners();
            // Loaded in place, because arrays of varyings would be copied when they are returned.
            let [a, b, c] = &mut varyings;
            triangles.varyings::<S>(i, a);
            triangles.varyings::<S>(j, b);
            triangles.varyings::<S>(k, c);
            painter.triangle(&triangle.v, &varyings, triangle.face);
        }
    }
}
