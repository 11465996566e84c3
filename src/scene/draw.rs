//! The public calls that draw meshes.

use super::assembly::{Assembly, AssemblyHooks};
use super::painter::Painter;
use super::scene::{Phase, Scene, fingerprint};
use super::state::State;
use crate::math::Projective;
use crate::mesh::Mesh;
use crate::span::Shader;
use crate::target::{Framebuffer, TriangleRecord, Triangles, VERTEX_WORDS};
use crate::vertex::{MAX_DISTANCES, Transform, Varyings};

impl<F: Framebuffer> Scene<'_, F> {
    /// Draws a mesh: back faces culled, nearer fragments win, clipped at the near and the far plane.
    ///
    /// `mvp` takes object space to clip space: camera · view · model.
    pub fn draw<S: Shader<F::Format>>(&mut self, mesh: &Mesh<'_>, mvp: &Projective, shader: &S) {
        self.draw_by(&State::DEFAULT, &const { AssemblyHooks::DEFAULT }, mesh, mvp, shader);
    }

    /// Draws a mesh by other rules.
    ///
    /// A program links the loops for the depth tests that may be asked for: where the state is a constant, its own.
    #[inline]
    pub fn draw_with<S: Shader<F::Format>>(&mut self, state: State, mesh: &Mesh<'_>, mvp: &Projective, shader: &S) {
        self.draw_by(&state, &AssemblyHooks::of(&state), mesh, mvp, shader);
    }

    // In its caller: a call less that is on the stack of everything below.
    #[inline(always)]
    fn draw_by<S: Shader<F::Format>>(
        &mut self,
        state: &State,
        hooks: &AssemblyHooks<F, S>,
        mesh: &Mesh<'_>,
        mvp: &Projective,
        shader: &S,
    ) {
        const {
            assert!(S::WORDS <= <S::Varyings as Varyings>::LEN, "a vertex needs no more words than varyings");
            assert!(S::WORDS <= 253, "a vertex has at most 253 words of varyings");
            assert!(S::ZERO_BITS == 0 || S::Varyings::PERSPECTIVE == 0, "perspective takes all bits of varyings");
            assert!(S::CLIP_DISTANCES + S::CULL_DISTANCES <= MAX_DISTANCES, "at most 4 clip and cull distances");
            assert!(S::ZERO_BITS <= 16, "at most 16 bits of varyings are known to be zero");
        };
        let stride = S::WORDS + VERTEX_WORDS;
        if F::RECORDS && self.phase == Phase::Replay {
            let print = fingerprint(state, mesh, mvp, &self.viewport, stride);
            if self.find_draw(print, mesh.vertex_count(), stride) {
                self.replay(state, hooks, shader);
            }
        } else {
            self.assemble(state, hooks, mesh, mvp, shader, stride);
        }
    }

    /// Records a draw, or draws it directly.
    #[inline(never)]
    fn assemble<S: Shader<F::Format>>(
        &mut self,
        state: &State,
        hooks: &AssemblyHooks<F, S>,
        mesh: &Mesh<'_>,
        mvp: &Projective,
        shader: &S,
        stride: usize,
    ) {
        // 1. Culling of whole meshes.
        let mut transform = Transform::default();
        if self.begin_draw(state, mesh, mvp, stride, S::DISPLACES, &mut transform) {
            if let Some(scale) = hooks.depth_scale {
                scale(&mut transform, state.depth_scale);
            }
            let clip = self.clip_rect(&self.band);
            let culling = state.culling();
            let mut assembly =
                Assembly { scene: self, state, hooks, mesh, shader, transform: &transform, culling, clip };
            match mesh.data().hierarchy {
                Some(nodes) if !S::DISPLACES => assembly.parts(nodes, mvp),
                _ => {
                    if F::RECORDS {
                        assembly.shade_all();
                    }
                    assembly.triangles(0..mesh.triangle_count());
                }
            }
            self.end_draw();
        }
    }

    /// Draws the recorded triangles of this draw in the current strip.
    #[inline(never)]
    fn replay<S: Shader<F::Format>>(&mut self, state: &State, hooks: &AssemblyHooks<F, S>, shader: &S) {
        let end = Triangles::end_of(self.target.rows.end);
        let clip = &self.clip_rect(&self.target.rows);
        let last = self.records.last_triangle();
        let mut triangles = self.records.triangles();
        let mut painter =
            Painter { target: &mut self.target, screen: self.screen, clip, state, hooks: &hooks.raster, shader };
        let mut triangle = TriangleRecord::default();
        let mut varyings = [S::Varyings::ZERO; 3];
        while triangles.replay(last, end, &mut triangle) {
            let [i, j, k] = triangle.corners();
            // In place: arrays of them are copied.
            let [a, b, c] = &mut varyings;
            triangles.varyings::<S>(i, a);
            triangles.varyings::<S>(j, b);
            triangles.varyings::<S>(k, c);
            painter.triangle(&triangle.v, &mut varyings, triangle.face);
        }
    }
}
