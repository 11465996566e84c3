//! Stage 2 of [the pipeline](crate#the-pipeline), vertices: a mesh, a matrix and a shader come in; places on the screen
//! and varyings go out, for one vertex or for all.

use super::scene::Scene;
use crate::math::SMALL_CORE;
use crate::mesh::Mesh;
use crate::target::{Framebuffer, Unshaded};
use crate::vertex::{
    ClipCorner, ClipVertex, MAX_DISTANCES, Outcode, PackedVertex, Projected, Transform, Varyings, VertexRef,
    VertexShader, inverse_w, weighted,
};
use core::ops::Range;

/// The inputs of the vertex stage.
pub(super) struct VertexStage<'s, S> {
    pub(super) mesh: &'s Mesh<'s>,
    pub(super) shader: &'s S,
    pub(super) transform: &'s Transform,
}

impl<S: VertexShader> VertexStage<'_, S> {
    /// Projects all vertices of a draw.
    #[inline(never)]
    pub(super) fn project_all(&self, places: &mut [[u32; 2]]) {
        match self.transform.short_points(&self.mesh.data().positions) {
            Some(points) if !S::DISPLACES && S::CLIP_DISTANCES == 0 => self.transform.project_all(points, places),
            _ => self.project_each(places),
        }
    }

    /// Projects a range of the vertices of a draw, as [`project_all`](Self::project_all) does all of them.
    #[inline(never)]
    pub(super) fn project_range(&self, vertices: Range<usize>, places: &mut [[u32; 2]]) {
        match self.transform.short_points(&self.mesh.data().positions) {
            Some(points) if !S::DISPLACES && S::CLIP_DISTANCES == 0 => {
                self.transform.project_all(points.get(vertices).unwrap_or_default(), places);
            }
            _ => {
                for (index, place) in vertices.zip(places) {
                    *place = self.project(index).words();
                }
            }
        }
    }

    /// Shades a vertex: it is transformed, projected and snapped, or its outcode is found. Keeps the result if the draw
    /// keeps its vertices.
    #[inline(never)]
    pub(super) fn shade<F: Framebuffer>(&self, scene: &mut Scene<'_, F>, index: usize) -> PackedVertex {
        scene.stats.vertices = scene.stats.vertices.wrapping_add(1);
        let packed = self.project(index);
        if scene.keeps_vertices() {
            scene.records.store_vertex::<S>(index, packed, &self.vertex(index));
        }
        packed
    }

    /// Transforms, projects and snaps a vertex, or finds its outcode.
    #[inline(always)]
    fn project(&self, index: usize) -> PackedVertex {
        let packed = if S::DISPLACES {
            PackedVertex::new(&self.transform.project_clip_vertex(&self.transformed(index)))
        } else {
            self.transform.project_packed(&self.mesh.data().positions, index)
        };
        if S::CLIP_DISTANCES > 0 && self.distances(index).iter().any(|distance| *distance < 0) {
            // The vertex counts as off the screen, because of a distance and not of a plane that outcodes know.
            return PackedVertex::new(&Projected::NeedsClip(Outcode(packed.outcode())));
        }
        packed
    }

    #[inline(never)]
    fn project_each(&self, places: &mut [[u32; 2]]) {
        for (index, place) in places.iter_mut().enumerate() {
            *place = self.project(index).words();
        }
    }

    /// Packs the varyings of vertices that have none yet.
    #[inline(never)]
    pub(super) fn store_each(&self, vertices: Unshaded<'_>) {
        vertices.each(|index, words| self.store(index, words));
    }

    /// Packs the varyings of a vertex into its words among those of all vertices.
    #[inline(never)]
    fn store(&self, index: usize, words: &mut [u32]) {
        let Some(words) = words.get_mut(S::WORDS * index..).and_then(|rest| rest.get_mut(..S::WORDS)) else { return };
        // On a small core, the compiler decides whether to inline them.
        let varyings = if SMALL_CORE { self.varyings(index) } else { self.varyings_inlined(index) };
        S::store(&varyings, words);
    }

    /// Returns a vertex in clip space.
    #[inline]
    pub(super) fn transformed(&self, index: usize) -> ClipVertex {
        if S::DISPLACES {
            self.transform.point(self.shader.displace(&VertexRef::new(self.mesh, index)))
        } else {
            self.transform.vertex(&self.mesh.data().positions, index)
        }
    }

    /// Returns the clip distances of a vertex. Distances that the shader does not have are 0.
    #[inline]
    pub(super) fn distances(&self, index: usize) -> [i32; MAX_DISTANCES] {
        let mut distances = self.shader.distances(&VertexRef::new(self.mesh, index));
        distances.iter_mut().skip(S::CLIP_DISTANCES).for_each(|distance| *distance = 0);
        distances
    }

    /// Returns whether one of the cull distances is negative at all three corners.
    #[inline]
    pub(super) fn is_culled_by_distance(&self, corners: [u16; 3]) -> bool {
        let [a, b, c] = corners.map(|k| self.shader.distances(&VertexRef::new(self.mesh, usize::from(k))));
        let all = a.iter().zip(b).zip(c).map(|((a, b), c)| a & b & c);
        all.skip(S::CLIP_DISTANCES).take(S::CULL_DISTANCES).any(|sign| sign < 0)
    }

    /// Returns the varyings of a single vertex.
    #[inline(never)]
    fn vertex(&self, index: usize) -> S::Varyings {
        self.varyings(index)
    }

    /// Returns the varyings of a vertex, with 1 / w if any of them is perspective-correct.
    #[inline]
    fn varyings(&self, index: usize) -> S::Varyings {
        self.varyings_inlined(index)
    }

    /// Returns the varyings of a vertex as [`varyings`](Self::varyings) does, inlined.
    #[inline(always)]
    fn varyings_inlined(&self, index: usize) -> S::Varyings {
        let mut varyings = self.shader.vertex(&VertexRef::new(self.mesh, index));
        if S::Varyings::PERSPECTIVE > 0 {
            varyings.set_inverse_w(if S::DISPLACES {
                inverse_w(&self.transformed(index))
            } else {
                self.transform.inverse_w(&self.mesh.data().positions, index)
            });
        }
        varyings
    }

    /// Returns the varyings of a vertex, rounded as the records round them.
    pub(super) fn kept<F: Framebuffer>(&self, scene: &Scene<'_, F>, index: u16) -> S::Varyings {
        if scene.keeps_vertices() && scene.records.has_varyings(index) {
            return scene.records.varyings::<S>(index);
        }
        rounded::<S>(&self.vertex(usize::from(index)))
    }

    /// Returns the varyings at a corner that the clipper made, before they are packed.
    #[inline(never)]
    pub(super) fn weighted(&self, corners: [u16; 3], weights: &[i32; 3], inverse_w: u32) -> S::Varyings {
        let mut vertices = [S::Varyings::ZERO; 3];
        for (vertex, index) in vertices.iter_mut().zip(&corners) {
            *vertex = self.shader.vertex(&VertexRef::new(self.mesh, usize::from(*index)));
        }
        let mut varyings: S::Varyings = weighted(weights, &vertices);
        if S::Varyings::PERSPECTIVE > 0 {
            varyings.set_inverse_w(inverse_w);
        }
        varyings
    }

    /// Returns the varyings at a corner that the clipper made, rounded as the records would round them, so that the
    /// picture is equal without records.
    pub(super) fn rounded(&self, corners: [u16; 3], weights: &[i32; 3], inverse_w: u32) -> S::Varyings {
        rounded::<S>(&self.weighted(corners, weights, inverse_w))
    }

    /// Returns the varyings at the end of a line that was cut.
    pub(super) fn rounded_end(&self, [i, j]: [u16; 2], end: &ClipCorner) -> S::Varyings {
        rounded::<S>(&self.weighted([i, j, j], &end.weights, inverse_w(&end.vertex)))
    }
}

/// Rounds varyings as the records would round them, by packing and unpacking.
#[inline(never)]
fn rounded<S: VertexShader>(varyings: &S::Varyings) -> S::Varyings {
    let mut words = S::Varyings::ZERO;
    let words: &mut [u32] = bytemuck::cast_slice_mut(words.as_mut());
    let words = words.get_mut(..S::WORDS).unwrap_or_default();
    S::store(varyings, words);
    S::load(words)
}
