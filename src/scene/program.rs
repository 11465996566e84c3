//! A mesh and its shader as the assembly of triangles sees them: one table of functions per shader. So the assembly is
//! compiled once for all shaders, and what a shader adds to a program are its own stages.

use super::assembly::{Assembly, ClampedSlabs, FanCorner, Program};
use super::cull::PendingFace;
use super::painter::RasterHooks;
use super::scan::ScreenTriangle;
use super::scene::Scene;
use super::state::State;
use super::vertex_stage::VertexStage;
use crate::raster::PixelRect;
use crate::span::Shader;
use crate::target::{Framebuffer, Records, corners_of};
use crate::vertex::{
    CLIPPED_CORNERS, ClipVertex, Clipping, DISTANCE_CORNERS, DepthRange, DepthScale, DepthSlab, Face, Outcode,
    PackedVertex, Transform, Varyings,
};
use core::ops::Range;

/// Work that a draw does only in some states, as function pointers that are set where the state is known. So a program
/// links only the functions that its states need.
pub struct AssemblyHooks<F: Framebuffer, S: Shader<F::Format>> {
    /// Hooks of stages 8 and 9, set-up and spans.
    pub(super) raster: RasterHooks<F, S>,
    pub(super) depth_scale: Option<fn(&mut Transform, DepthScale)>,
    /// Stage 4, clipping: draws the parts of a triangle in front of the near plane and beyond the far plane.
    pub(super) clamped_slabs: Option<ClampedSlabs<F>>,
}

impl<F: Framebuffer, S: Shader<F::Format>> AssemblyHooks<F, S> {
    /// Hooks for [`State::DEFAULT`].
    pub(super) const DEFAULT: Self = Self { raster: RasterHooks::DEFAULT, depth_scale: None, clamped_slabs: None };

    /// Hooks for any state.
    pub(super) const ANY: Self = Self {
        raster: RasterHooks::ANY,
        depth_scale: Some(Transform::set_depth_scale),
        clamped_slabs: Some(|assembly, triangle, codes| assembly.clip_clamped_slabs(triangle, codes)),
    };

    /// Returns the hooks that a state needs.
    #[inline(always)]
    pub(super) fn of(state: &State) -> Self {
        Self {
            raster: RasterHooks::of(state),
            depth_scale: match state.depth_scale {
                DepthScale::Perspective => None,
                DepthScale::Uniform { .. } => Self::ANY.depth_scale,
            },
            clamped_slabs: match state.range {
                DepthRange::Clip => None,
                DepthRange::ClampFar | DepthRange::Clamp => Self::ANY.clamped_slabs,
            },
        }
    }
}

/// The [`Program`] of a mesh and a shader.
pub(super) struct MeshProgram<'s, F: Framebuffer, S: Shader<F::Format>> {
    pub(super) stage: VertexStage<'s, S>,
    pub(super) state: &'s State,
    pub(super) hooks: &'s RasterHooks<F, S>,
}

impl<F: Framebuffer, S: Shader<F::Format>> MeshProgram<'_, F, S> {
    /// Stage 2, vertices: projects a range of the vertices of a draw that keeps them.
    #[inline(never)]
    pub(super) fn project(&self, scene: &mut Scene<'_, F>, vertices: Range<usize>) {
        if F::RECORDS {
            let places = scene.records.positions_mut().get_mut(vertices.clone()).unwrap_or_default();
            scene.stats.vertices = scene.stats.vertices.wrapping_add(places.len() as u32);
            self.stage.project_range(vertices, places);
        }
    }

    /// Computes the varyings at the corners of a triangle, rounded as the records round them.
    #[inline(never)]
    fn varyings(
        &self,
        scene: &Scene<'_, F>,
        corners: [u16; 3],
        fan: Option<[&FanCorner; 3]>,
        to: &mut [S::Varyings; 3],
    ) {
        for (k, to) in to.iter_mut().enumerate() {
            *to = match fan.and_then(|fan| fan.get(k).copied()) {
                Some(corner) => self.stage.rounded(corners, &corner.weights, corner.inverse_w),
                None => self.stage.kept(scene, corners.get(k).copied().unwrap_or_default()),
            };
        }
    }
}

impl<F: Framebuffer, S: Shader<F::Format>> Program<F> for MeshProgram<'_, F, S> {
    fn project_all(&self, scene: &mut Scene<'_, F>) {
        if F::RECORDS {
            let places = scene.records.positions_mut();
            scene.stats.vertices = scene.stats.vertices.wrapping_add(places.len() as u32);
            self.stage.project_all(places);
        }
    }

    fn shade_corners(&self, records: &mut Records<'_>, first: u16) {
        if F::RECORDS
            && S::WORDS > 0
            && let Some(vertices) = records.unshaded(first)
        {
            self.stage.store_each(vertices);
        }
    }

    fn shade(&self, scene: &mut Scene<'_, F>, index: usize) -> PackedVertex {
        self.stage.shade(scene, index)
    }

    fn transformed(&self, index: usize, to: &mut ClipVertex) {
        *to = self.stage.transformed(index);
    }

    fn is_culled_by_distance(&self, corners: [u16; 3]) -> bool {
        S::CULL_DISTANCES > 0 && self.stage.is_culled_by_distance(corners)
    }

    fn clip(&self, assembly: &mut Assembly<'_, '_, F>, triangle: &mut ScreenTriangle, codes: Outcode, slab: DepthSlab) {
        if S::CLIP_DISTANCES > 0 {
            assembly.clip_to_fan::<DISTANCE_CORNERS>(triangle, codes, slab);
        } else {
            assembly.clip_to_fan::<CLIPPED_CORNERS>(triangle, codes, slab);
        }
    }

    fn cut_by_distances(&self, clipping: &mut Clipping<'_>, [i, j, k]: [u16; 3]) {
        if S::CLIP_DISTANCES > 0 {
            let distances = |index: u16| self.stage.distances(usize::from(index));
            for ((i, j), k) in distances(i).into_iter().zip(distances(j)).zip(distances(k)).take(S::CLIP_DISTANCES) {
                clipping.cut_by_distance([i, j, k]);
            }
        }
    }

    fn store_corner(&self, scene: &mut Scene<'_, F>, index: u16, corners: [u16; 3], corner: &FanCorner) {
        if F::RECORDS {
            let varyings = self.stage.weighted(corners, &corner.weights, corner.inverse_w);
            scene.records.store_vertex::<S>(usize::from(index), corner.vertex, &varyings);
        }
    }

    fn shade_faces(&self, mut records: &mut [u32]) {
        while let Some(([corners, last, word], rest)) = records.split_first_chunk_mut() {
            let (number, area) = PendingFace(*word).parts();
            let corners = corners_of(*corners, *last);
            *word = self.stage.shader.face(&Face::new(self.stage.mesh, number, corners, self.state.side(area)));
            records = rest;
        }
    }

    fn draw(
        &self,
        scene: &mut Scene<'_, F>,
        clip: &PixelRect,
        triangle: &ScreenTriangle,
        face: u32,
        fan: Option<[&FanCorner; 3]>,
    ) {
        let mut varyings = [S::Varyings::ZERO; 3];
        self.varyings(scene, triangle.corners, fan, &mut varyings);
        let mut painter = scene.painter(clip, self.state, self.hooks, self.stage.shader);
        painter.turned(&triangle.v, &varyings, face, false);
    }

    fn draw_waiting(&self, scene: &mut Scene<'_, F>) {
        if F::RECORDS {
            (self.hooks.replay)(scene, self.state, self.hooks, self.stage.shader, true);
        }
    }
}
