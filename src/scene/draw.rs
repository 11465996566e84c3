//! The calls that draw meshes: a mesh, a matrix and a shader come in, and go through [the pipeline](crate#the-pipeline)
//! from top to bottom. Stages 1 to 7 are in `assemble`; stages 8 to 11 of recorded triangles follow in the replay.

use super::assembly::{Assembly, ClampedSlabs, Program};
use super::program::{AssemblyHooks, MeshProgram};
use super::scene::{Draw, Phase, Primitives, Scene};
use super::state::State;
use super::vertex_stage::VertexStage;
use crate::math::Projective;
use crate::mesh::Mesh;
use crate::span::Shader;
use crate::target::Framebuffer;
use crate::vertex::Transform;

/// Stages 2 to 7 of a draw that may be visible.
type Way<F, S> = fn(&mut Scene<'_, F>, &Draw<'_>, &MeshProgram<'_, F, S>, &Transform, Option<ClampedSlabs<F>>);

impl<F: Framebuffer> Scene<'_, F> {
    /// Draws a mesh with the default state: back faces are culled, nearer fragments win, and triangles are clipped at
    /// the near and the far plane.
    ///
    /// `mvp` takes object space to clip space: camera · view · model.
    pub fn draw<S: Shader<F::Format>>(&mut self, mesh: &Mesh<'_>, mvp: &Projective, shader: &S) {
        self.draw_by(
            &State::DEFAULT,
            &const { AssemblyHooks::DEFAULT },
            mesh,
            mvp,
            shader,
            |scene, draw, program, transform, slabs| {
                scene.assemble_by(draw, program, transform, slabs);
            },
        );
    }

    /// Draws a mesh by the rules of `state`.
    ///
    /// A program links the loops for all depth tests that `state` may ask for. If `state` is a constant, the program
    /// links only the loop for its depth test.
    #[inline]
    pub fn draw_with<S: Shader<F::Format>>(&mut self, state: State, mesh: &Mesh<'_>, mvp: &Projective, shader: &S) {
        self.draw_by(
            &state,
            &AssemblyHooks::of(&state),
            mesh,
            mvp,
            shader,
            |scene, draw, program, transform, slabs| {
                scene.assemble_by(draw, program, transform, slabs);
            },
        );
    }

    /// Draws a mesh whose hierarchy is a list of clusters. Only programs that call it link what clusters take.
    #[inline]
    pub(crate) fn draw_clusters<S: Shader<F::Format>>(
        &mut self,
        state: State,
        mesh: &Mesh<'_>,
        mvp: &Projective,
        shader: &S,
    ) {
        self.draw_by(
            &state,
            &AssemblyHooks::of(&state),
            mesh,
            mvp,
            shader,
            |scene, draw, program, transform, slabs| {
                scene.assemble_clusters(draw, program, transform, slabs);
            },
        );
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
        way: Way<F, S>,
    ) {
        let draw = Draw::new::<S, ()>(state, hooks.depth_scale, mesh, mvp, Primitives::Triangles);
        if F::RECORDS && self.phase == Phase::Replay {
            if self.find_draw(&draw) {
                (hooks.raster.replay)(self, state, &hooks.raster, shader, false);
            }
        } else {
            self.assemble(&draw, hooks, shader, way);
        }
    }

    /// Records the triangles of a draw, or draws them directly: stages 1 to 7.
    #[inline(never)]
    fn assemble<S: Shader<F::Format>>(
        &mut self,
        draw: &Draw<'_>,
        hooks: &AssemblyHooks<F, S>,
        shader: &S,
        way: Way<F, S>,
    ) {
        // Stage 1, bounds.
        let mut transform = Transform::default();
        if self.begin_draw(draw, Some(&mut transform)) {
            let stage = VertexStage { mesh: draw.mesh, shader, transform: &transform };
            let program = MeshProgram { stage, state: draw.state, hooks: &hooks.raster };
            way(self, draw, &program, &transform, hooks.clamped_slabs);
        }
    }

    /// Stages 2 to 7 of a draw that may be visible, cluster by cluster if it has any.
    #[inline(never)]
    fn assemble_clusters<S: Shader<F::Format>>(
        &mut self,
        draw: &Draw<'_>,
        program: &MeshProgram<'_, F, S>,
        transform: &Transform,
        clamped_slabs: Option<ClampedSlabs<F>>,
    ) {
        let Some(nodes) = draw.hierarchy() else { return self.assemble_by(draw, program, transform, clamped_slabs) };
        let clip = self.clip_rect(&self.band);
        let culling = draw.state.culling();
        let mut assembly = Assembly { scene: self, draw, program, transform, clamped_slabs, culling, clip };
        assembly.clusters(nodes, &|scene, vertices| program.project(scene, vertices));
        self.end_draw();
    }

    /// Stages 2 to 7 of a draw that may be visible.
    #[inline(never)]
    fn assemble_by(
        &mut self,
        draw: &Draw<'_>,
        program: &dyn Program<F>,
        transform: &Transform,
        clamped_slabs: Option<ClampedSlabs<F>>,
    ) {
        let clip = self.clip_rect(&self.band);
        let culling = draw.state.culling();
        let mut assembly = Assembly { scene: self, draw, program, transform, clamped_slabs, culling, clip };
        match draw.hierarchy() {
            // Stages 2 to 7, per part of the mesh that may be visible. Vertices are shaded when triangles ask for them.
            Some(nodes) => assembly.hierarchy(nodes, draw.mvp),
            _ => {
                // Stage 2, vertices: the positions of all at once, if the results are kept. Varyings are computed when
                // a visible triangle asks for them.
                program.project_all(assembly.scene);
                // Stages 3 to 7, triangle by triangle: assembly, clipping, culling, recording, faces.
                assembly.triangles(0..draw.mesh.triangle_count());
            }
        }
        self.end_draw();
    }
}
