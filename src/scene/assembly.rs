//! Stages 2 to 7 of [the pipeline](crate#the-pipeline), as far as they depend on shaders: a mesh's triangles come in,
//! and go out as triangles on the screen, drawn or recorded. The part that is the same for all shaders is in `scan`.

use super::painter::RasterHooks;
use super::scan::{PendingFace, Scan, ScanEvent, ScreenTriangle, may_reach};
use super::scene::Scene;
use super::state::{Culling, State};
use crate::math::Projective;
use crate::mesh::{BoundsNode, Mesh};
use crate::raster::PixelRect;
use crate::span::Shader;
use crate::target::{Framebuffer, PackedVertex};
use crate::vertex::{
    CLIPPED_CORNERS, ClipCorner, ClipVertex, Clipping, DISTANCE_CORNERS, DepthRange, DepthScale, DepthSlab, Face,
    MAX_DISTANCES, Outcode, Projected, Transform, Varyings, VertexRef, VertexShader, inverse_w, weighted,
};
use core::ops::Range;
use heapless::deque::Deque;
use heapless::vec::{Vec, VecView};

/// A corner of a clipped polygon on the screen. Its varyings are computed when it is drawn or recorded.
struct FanCorner {
    vertex: PackedVertex,
    /// Weights of the triangle's three corners, see [`ClipCorner`].
    weights: [i32; 3],
    /// See [`inverse_w`]; 0 if no varying is perspective-correct.
    inverse_w: u32,
}

/// Number of a corner that is not in the records. Vertices have lower numbers.
const UNSTORED: u16 = u16::MAX;

type ClampedSlabs<F, S> = fn(&mut Assembly<'_, '_, F, S>, &mut ScreenTriangle, Outcode);

/// Work that a draw does only in some states, as function pointers that are set where the state is known. So a program
/// links only the functions that its states need.
pub struct AssemblyHooks<F: Framebuffer, S: Shader<F::Format>> {
    /// Hooks of stages 8 and 9, set-up and spans.
    pub(super) raster: RasterHooks<F, S>,
    pub(super) depth_scale: Option<fn(&mut Transform, DepthScale)>,
    /// Stage 4, clipping: draws the parts of a triangle in front of the near plane and beyond the far plane.
    clamped_slabs: Option<ClampedSlabs<F, S>>,
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

/// The assembly of one draw.
pub(super) struct Assembly<'s, 'a, F: Framebuffer, S: Shader<F::Format>> {
    pub(super) scene: &'s mut Scene<'a, F>,
    pub(super) state: &'s State,
    pub(super) hooks: &'s AssemblyHooks<F, S>,
    pub(super) mesh: &'s Mesh<'s>,
    pub(super) shader: &'s S,
    pub(super) transform: &'s Transform,
    /// The faces that are left out.
    pub(super) culling: Culling,
    /// The pixels that can be drawn in this phase.
    pub(super) clip: PixelRect,
}

impl<F: Framebuffer, S: Shader<F::Format>> Assembly<'_, '_, F, S> {
    /// Handles the triangles of those nodes of a mesh's hierarchy that may be visible.
    pub(super) fn hierarchy(&mut self, nodes: &[BoundsNode], mvp: &Projective) {
        let mut next = 0;
        while next < nodes.len() {
            let mut at = next;
            let mut visible = self.scene.visible_nodes(self.state, nodes, mvp, &mut next);
            while visible != 0 {
                if let (Some(node), 1) = (nodes.get(at), visible & 1) {
                    let first = usize::from(node.first_triangle);
                    self.triangles(first..first + usize::from(node.triangles));
                }
                (at, visible) = (at + 1, visible >> 1);
            }
        }
    }

    /// Handles the triangles with these numbers.
    #[inline(never)]
    pub(super) fn triangles(&mut self, numbers: Range<usize>) {
        if S::CULL_DISTANCES > 0 || !self.scene.keeps_vertices() {
            self.each_triangle(numbers);
        } else {
            self.scan(numbers);
        }
    }

    /// Scans the triangles of a draw that keeps its vertices, and handles each triangle that the scan stops at.
    #[inline(never)]
    fn scan(&mut self, numbers: Range<usize>) {
        let mut scan = Scan::new(self.mesh, numbers, self.culling, self.scene.is_recording());
        while !self.scene.overflowed() {
            let first = self.scene.records.triangle_count();
            let Scene { records, strips, band, stats, .. } = &mut *self.scene;
            let event = scan.next(records, strips, band.start, &self.clip, stats);
            if self.scene.records.triangle_count() != first {
                self.shade_faces(first);
            }
            if event == ScanEvent::Done {
                break;
            }
            self.handle(event, &mut scan.triangle);
        }
    }

    /// Stage 7, faces: replaces the [`PendingFace`]s of the triangles recorded from `first` on by the shader's words.
    #[inline(never)]
    fn shade_faces(&mut self, first: u16) {
        let Self { scene, state, mesh, shader, .. } = self;
        let mut records = scene.records.triangles_from(first);
        while let Some(([corners, last, word], rest)) = records.split_first_chunk_mut() {
            let (number, area) = PendingFace(*word).parts();
            let [k, _] = bytemuck::cast(*last);
            let corners = [*corners as u16, (*corners >> 16) as u16, k];
            *word = shader.face(&Face::new(mesh, number, corners, state.side(area)));
            records = rest;
        }
    }

    /// Handles every triangle, without a scan: for draws that do not keep their vertices or have cull distances.
    #[inline(never)]
    fn each_triangle(&mut self, numbers: Range<usize>) {
        let mut triangle = ScreenTriangle::NONE;
        for number in numbers {
            let Some([i, j, k]) = self.mesh.any_triangle(number) else { return };
            if self.scene.overflowed() {
                return;
            }
            self.scene.stats.triangles = self.scene.stats.triangles.wrapping_add(1);
            if S::CULL_DISTANCES > 0 && self.is_culled_by_distance([i, j, k]) {
                self.scene.stats.outside = self.scene.stats.outside.wrapping_add(1);
            } else {
                (triangle.number, triangle.corners) = (number as u16, [i, j, k]);
                self.handle(ScanEvent::NeedsVertices, &mut triangle);
            }
        }
    }

    /// Handles a triangle that the scan stopped at.
    #[inline(always)]
    fn handle(&mut self, event: ScanEvent, triangle: &mut ScreenTriangle) {
        match if event == ScanEvent::NeedsVertices { self.shade_corners(triangle) } else { event } {
            ScanEvent::Visible => self.shade_face(triangle),
            // Stage 4, clipping.
            ScanEvent::NeedsClip(codes) => {
                self.clip(triangle, codes, DepthSlab::Inside);
                if let Some(clip) = self.hooks.clamped_slabs {
                    clip(self, triangle, codes);
                }
            }
            ScanEvent::NeedsVertices | ScanEvent::Done => {}
        }
    }

    /// Shades the vertices of a triangle that needs them, and returns what has to be done with the triangle:
    /// [`ScanEvent::Done`] if it cannot be visible.
    #[inline(never)]
    fn shade_corners(&mut self, triangle: &mut ScreenTriangle) -> ScanEvent {
        // Stage 2, vertices: once per vertex if the results are kept.
        let mut packed = [PackedVertex::NONE; 3];
        for (packed, index) in packed.iter_mut().zip(&triangle.corners) {
            *packed = self.packed_vertex(*index);
        }
        let planes = Outcode(!self.state.range.clamped().0);
        let event = triangle.assess(&packed, planes, self.culling, &self.clip, self.scene.stats);
        if event == ScanEvent::Done || event == ScanEvent::Visible || self.may_reach(&triangle.corners) {
            return event;
        }
        self.scene.stats.clipped = self.scene.stats.clipped.wrapping_sub(1);
        self.scene.stats.outside = self.scene.stats.outside.wrapping_add(1);
        ScanEvent::Done
    }

    /// Returns whether a triangle that has to be clipped may cover pixels of this strip or band.
    #[inline(never)]
    fn may_reach(&self, [i, j, k]: &[u16; 3]) -> bool {
        let corner = |index: &u16| self.transformed(usize::from(*index));
        may_reach(&self.clip, 0, &[corner(i), corner(j), corner(k)])
    }

    /// Shades the face of a single triangle on the screen, stage 7, and records or draws the triangle.
    #[inline(never)]
    fn shade_face(&mut self, triangle: &ScreenTriangle) {
        let word = self.face(triangle);
        if self.scene.is_recording() {
            self.scene.record(triangle.row, triangle.corners, word);
        } else {
            let [i, j, k] = triangle.corners;
            self.draw(triangle, &mut [self.varyings(i), self.varyings(j), self.varyings(k)], word);
        }
    }

    #[inline(never)]
    fn face(&self, triangle: &ScreenTriangle) -> u32 {
        self.shader.face(&Face::new(
            self.mesh,
            triangle.number.into(),
            triangle.corners,
            self.state.side(triangle.area),
        ))
    }

    /// Returns the vertex stage's result for a vertex: from the records, if it is there.
    #[inline]
    fn packed_vertex(&mut self, index: u16) -> PackedVertex {
        if !self.scene.keeps_vertices() {
            return self.shade(index.into());
        }
        let packed = self.scene.records.packed_vertex(index.into());
        if packed.is_unshaded() { self.shade(index.into()) } else { packed }
    }

    /// Stage 2, vertices: shades all vertices of a draw that keeps them.
    #[inline(never)]
    pub(super) fn shade_all(&mut self) {
        let Self { scene, mesh, shader, transform, .. } = self;
        let stage = VertexStage { mesh, shader: *shader, transform };
        let (places, varyings) = scene.records.vertices_mut();
        scene.stats.vertices = scene.stats.vertices.wrapping_add(places.len() as u32);
        match transform.short_points(&mesh.data().positions) {
            Some(points) if !S::DISPLACES && S::CLIP_DISTANCES == 0 => project_all(transform, points, places),
            _ => stage.project_each(places),
        }
        if S::WORDS > 0 {
            stage.store_each(varyings);
        }
    }

    /// Returns the vertex stage's result for a vertex: transformed, projected and snapped, or its outcode.
    #[inline(never)]
    pub(super) fn shade(&mut self, index: usize) -> PackedVertex {
        self.scene.stats.vertices = self.scene.stats.vertices.wrapping_add(1);
        let packed = self.stage().project(index);
        if self.scene.keeps_vertices() {
            let varyings = self.vertex(index);
            self.scene.records.store_vertex::<S>(index, packed, &varyings);
        }
        packed
    }

    #[inline]
    fn stage(&self) -> VertexStage<'_, S> {
        VertexStage { mesh: self.mesh, shader: self.shader, transform: self.transform }
    }

    #[inline]
    pub(super) fn transformed(&self, index: usize) -> ClipVertex {
        self.stage().transformed(index)
    }

    /// Draws or records the parts of a triangle whose depth is clamped.
    pub(super) fn clip_clamped_slabs(&mut self, triangle: &mut ScreenTriangle, codes: Outcode) {
        for slab in self.state.range.clamped_slabs(codes) {
            self.clip(triangle, codes, slab);
        }
    }

    /// Clips a triangle, and draws or records the part that lies in one slab of depth.
    #[inline]
    fn clip(&mut self, triangle: &mut ScreenTriangle, codes: Outcode, slab: DepthSlab) {
        if S::CLIP_DISTANCES > 0 {
            self.clip_to_fan::<DISTANCE_CORNERS>(triangle, codes, slab);
        } else {
            self.clip_to_fan::<CLIPPED_CORNERS>(triangle, codes, slab);
        }
    }

    /// Clips a triangle to a polygon of up to `N` corners, and draws or records it as a fan of triangles about its
    /// first corner.
    #[inline(never)]
    fn clip_to_fan<const N: usize>(&mut self, triangle: &mut ScreenTriangle, codes: Outcode, slab: DepthSlab) {
        let mut corners = Vec::<FanCorner, N>::new();
        self.clipped::<N>(triangle.corners, codes, slab, &mut corners);
        let recording = self.scene.is_recording();
        // Numbers of the first, the previous and the current corner in the records. A corner is stored when the first
        // triangle with it is recorded, so that those in other strips take no words.
        let mut indices = [UNSTORED; 3];
        for (k, corner) in corners.iter().enumerate() {
            triangle.v[2] = corner.vertex.screen();
            if k >= 2 && triangle.passes_culling(self.culling, &self.clip, self.scene.stats) {
                let (Some(first), Some(previous)) = (corners.first(), corners.get(k - 1)) else { return };
                let fan = [first, previous, corner];
                if recording {
                    for (index, corner) in indices.iter_mut().zip(fan) {
                        if *index == UNSTORED {
                            *index = self.store_corner(triangle.corners, corner);
                        }
                    }
                    self.scene.record(triangle.row, indices, self.face(triangle));
                } else {
                    self.draw_corners(triangle, fan);
                }
            }
            // The first corner stays. The last corner becomes the second one of the next triangle.
            let place = usize::from(k > 0);
            (triangle.v[place], indices[place]) = (triangle.v[2], indices[2]);
            indices[2] = UNSTORED;
        }
    }

    /// Stores a corner of a clipped triangle in the records, and returns its index.
    #[inline(never)]
    fn store_corner(&mut self, corners: [u16; 3], corner: &FanCorner) -> u16 {
        let index = self.scene.records.push_vertex();
        let varyings = self.corner_varyings(corners, corner);
        self.scene.records.store_vertex::<S>(usize::from(index), corner.vertex, &varyings);
        index
    }

    /// Draws one triangle of a fan.
    #[inline(never)]
    fn draw_corners(&mut self, triangle: &ScreenTriangle, [a, b, c]: [&FanCorner; 3]) {
        let varyings = |corner| self.corner_varyings(triangle.corners, corner);
        let mut varyings = [varyings(a), varyings(b), varyings(c)];
        self.draw(triangle, &mut varyings, self.face(triangle));
    }

    /// Returns the varyings at a corner of a clipped triangle.
    fn corner_varyings(&self, corners: [u16; 3], corner: &FanCorner) -> S::Varyings {
        let varyings = self.weighted_varyings(corners, &corner.weights, corner.inverse_w);
        // Without records, varyings are rounded as records would round them, so that the picture is equal.
        if self.scene.is_recording() { varyings } else { rounded::<S>(&varyings) }
    }

    /// Returns the varyings at a corner that the clipper made, before they are packed.
    #[inline(never)]
    fn weighted_varyings(&self, corners: [u16; 3], weights: &[i32; 3], inverse_w: u32) -> S::Varyings {
        let vertex = |index: u16| self.shader.vertex(&VertexRef::new(self.mesh, usize::from(index)));
        let [i, j, k] = corners;
        let mut varyings: S::Varyings = weighted(weights, &[vertex(i), vertex(j), vertex(k)]);
        if S::Varyings::PERSPECTIVE > 0 {
            varyings.set_inverse_w(inverse_w);
        }
        varyings
    }

    /// Returns the varyings at the end of a line that was cut.
    pub(super) fn end_varyings(&self, [i, j]: [u16; 2], end: &ClipCorner) -> S::Varyings {
        rounded::<S>(&self.weighted_varyings([i, j, j], &end.weights, inverse_w(&end.vertex)))
    }

    /// Returns whether one of the cull distances is negative at all three corners.
    #[inline]
    fn is_culled_by_distance(&self, corners: [u16; 3]) -> bool {
        let [a, b, c] = corners.map(|k| self.shader.distances(&VertexRef::new(self.mesh, usize::from(k))));
        let all = a.iter().zip(b).zip(c).map(|((a, b), c)| a & b & c);
        all.skip(S::CLIP_DISTANCES).take(S::CULL_DISTANCES).any(|sign| sign < 0)
    }

    /// Clips a triangle and projects the corners of the remaining polygon. Not inlined, so that the polygon in clip
    /// space is no longer on the stack when the fan is drawn.
    #[inline(never)]
    fn clipped<const N: usize>(
        &self,
        corners: [u16; 3],
        codes: Outcode,
        slab: DepthSlab,
        fan: &mut VecView<FanCorner>,
    ) {
        let mut polygon = Deque::<ClipCorner, N>::new();
        for (k, index) in corners.iter().enumerate() {
            let _ = polygon.push_back(ClipCorner::new(self.transformed(usize::from(*index)), k));
        }
        let mut clipping = Clipping::new(&mut polygon);
        clipping.clip(codes, slab);
        if S::CLIP_DISTANCES > 0 {
            let [i, j, k] = corners;
            let distances = |index: u16| self.stage().distances(usize::from(index));
            for ((i, j), k) in distances(i).into_iter().zip(distances(j)).zip(distances(k)).take(S::CLIP_DISTANCES) {
                clipping.cut_by_distance([i, j, k]);
            }
        }
        project_corners(&clipping, self.transform, S::Varyings::PERSPECTIVE > 0, fan);
    }

    /// Returns the varyings of a vertex, with 1 / w if any of them is perspective-correct.
    #[inline]
    fn vertex(&self, index: usize) -> S::Varyings {
        self.stage().varyings(index)
    }

    /// Returns the varyings of a vertex, rounded as the records round them.
    pub(super) fn varyings(&self, index: u16) -> S::Varyings {
        if self.scene.keeps_vertices() {
            return self.scene.records.varyings::<S>(index);
        }
        rounded::<S>(&self.vertex(usize::from(index)))
    }

    #[inline]
    fn draw(&mut self, triangle: &ScreenTriangle, varyings: &mut [S::Varyings; 3], face: u32) {
        self.scene.painter(&self.clip, self.state, &self.hooks.raster, self.shader).triangle_of_area(
            &triangle.v,
            triangle.area,
            varyings,
            face,
        );
    }
}

/// Projects the corners of a clipped polygon.
#[inline(never)]
fn project_corners(clipping: &Clipping<'_>, transform: &Transform, perspective: bool, fan: &mut VecView<FanCorner>) {
    for ClipCorner { vertex, weights } in clipping.corners() {
        // All corners can be projected, because clipping has left no corner behind the eye.
        let projected = transform.project(vertex).unwrap_or_default();
        let inverse_w = if perspective { inverse_w(vertex) } else { 0 };
        let vertex = PackedVertex::new(&Projected::OnScreen(projected));
        let _ = fan.push(FanCorner { vertex, weights: *weights, inverse_w });
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

/// Stage 2, vertices, of a whole mesh by the short path: projects all positions.
#[inline(never)]
fn project_all(transform: &Transform, points: &[[i16; 3]], places: &mut [[u32; 2]]) {
    for (place, point) in places.iter_mut().zip(points) {
        // `black_box` makes the compiler read the transform again per vertex: there are too few registers to hold all
        // of it.
        *place = PackedVertex::new(&core::hint::black_box(transform).project_quantized(*point).0).words();
    }
}

/// The inputs of the vertex stage.
struct VertexStage<'s, S> {
    mesh: &'s Mesh<'s>,
    shader: &'s S,
    transform: &'s Transform,
}

impl<S: VertexShader> VertexStage<'_, S> {
    /// Transforms, projects and snaps a vertex, or finds its outcode.
    #[inline(always)]
    fn project(&self, index: usize) -> PackedVertex {
        let projected = if S::DISPLACES {
            self.transform.project_clip_vertex(&self.transformed(index))
        } else {
            self.transform.project_vertex(&self.mesh.data().positions, index)
        };
        let packed = PackedVertex::new(&projected);
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

    /// Packs the varyings of all vertices.
    #[inline(never)]
    fn store_each(&self, mut words: &mut [u32]) {
        let mut index = 0;
        while let Some((some, rest)) = words.split_at_mut_checked(S::WORDS) {
            S::store(&self.varyings(index), some);
            (index, words) = (index + 1, rest);
        }
    }

    #[inline]
    fn transformed(&self, index: usize) -> ClipVertex {
        if S::DISPLACES {
            self.transform.point(self.shader.displace(&VertexRef::new(self.mesh, index)))
        } else {
            self.transform.vertex(&self.mesh.data().positions, index)
        }
    }

    /// Returns the clip distances of a vertex. Distances that the shader does not have are 0.
    #[inline]
    fn distances(&self, index: usize) -> [i32; MAX_DISTANCES] {
        let mut distances = self.shader.distances(&VertexRef::new(self.mesh, index));
        distances.iter_mut().skip(S::CLIP_DISTANCES).for_each(|distance| *distance = 0);
        distances
    }

    /// Returns the varyings of a vertex, with 1 / w if any of them is perspective-correct.
    #[inline]
    fn varyings(&self, index: usize) -> S::Varyings {
        let mut varyings = self.shader.vertex(&VertexRef::new(self.mesh, index));
        if S::Varyings::PERSPECTIVE > 0 {
            let w = if S::DISPLACES {
                self.transformed(index).w
            } else {
                self.transform.w(&self.mesh.data().positions, index)
            };
            varyings.set_inverse_w(inverse_w(&ClipVertex { w, ..ClipVertex::default() }));
        }
        varyings
    }
}
