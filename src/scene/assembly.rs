//! Stages 3 to 7 of [the pipeline](crate#the-pipeline): a mesh's triangles come in, and go out as triangles on the
//! screen, drawn or recorded. This code is compiled once, for all shaders: a [`Program`] is what it knows of them.

use super::cull::PendingFace;
use super::painter::{turn, turn_corners, turn_vertices};
use super::scan::{Scan, ScanEvent, ScanTo, ScreenTriangle, may_reach, place};
use super::scene::{Draw, Scene};
use super::state::Culling;
use crate::math::Projective;
use crate::mesh::BoundsNode;
use crate::raster::PixelRect;
use crate::target::{Framebuffer, Records, triangle_words};
use crate::vertex::{
    ClipCorner, ClipVertex, Clipping, DepthSlab, Outcode, PackedVertex, Projected, Transform, inverse_w,
};
use core::ops::Range;
use heapless::deque::Deque;
use heapless::vec::{Vec, VecView};

/// A corner of a clipped polygon on the screen. Its varyings are computed when it is drawn or recorded.
pub(super) struct FanCorner {
    pub(super) vertex: PackedVertex,
    /// Weights of the triangle's three corners, see [`ClipCorner`].
    pub(super) weights: [i32; 3],
    /// See [`inverse_w`]; 0 if no varying is perspective-correct.
    pub(super) inverse_w: u32,
}

/// Number of a corner that is not in the records. Vertices have lower numbers.
const UNSTORED: u16 = u16::MAX;

/// The parts of a draw that its shader takes part in.
pub(super) trait Program<F: Framebuffer> {
    /// Stage 2, vertices: projects all vertices of a draw that keeps them.
    fn project_all(&self, scene: &mut Scene<'_, F>);

    /// Stage 2, vertices: computes the varyings at the corners of triangles recorded from `first` on, where they are
    /// not in the records yet.
    fn shade_corners(&self, records: &mut Records<'_>, first: u16);

    /// Stage 2, vertices: shades one vertex, and keeps the result if the draw keeps its vertices.
    fn shade(&self, scene: &mut Scene<'_, F>, index: usize) -> PackedVertex;

    /// Computes a vertex in clip space.
    fn transformed(&self, index: usize, to: &mut ClipVertex);

    /// Returns whether one of the shader's cull distances is negative at all three corners.
    fn is_culled_by_distance(&self, corners: [u16; 3]) -> bool;

    /// Stage 4, clipping, by one slab of depth and by the shader's clip distances.
    fn clip(&self, assembly: &mut Assembly<'_, '_, F>, triangle: &mut ScreenTriangle, codes: Outcode, slab: DepthSlab);

    /// Cuts a triangle by the shader's clip distances.
    fn cut_by_distances(&self, clipping: &mut Clipping<'_>, corners: [u16; 3]);

    /// Stores a corner of a clipped triangle in the records, at a number that has room.
    fn store_corner(&self, scene: &mut Scene<'_, F>, index: u16, corners: [u16; 3], corner: &FanCorner);

    /// Stage 7, faces: replaces the [`PendingFace`]s in these words of records by the shader's words.
    fn shade_faces(&self, records: &mut [u32]);

    /// Draws a triangle of the mesh, or a triangle of the fan that it was clipped to: stages 8 to 11. Its highest
    /// corner is the first.
    fn draw(
        &self,
        scene: &mut Scene<'_, F>,
        clip: &PixelRect,
        triangle: &ScreenTriangle,
        face: u32,
        fan: Option<[&FanCorner; 3]>,
    );

    /// Draws the triangles that wait in the records, and takes them out of there: stages 8 to 11.
    fn draw_waiting(&self, scene: &mut Scene<'_, F>);
}

/// Draws or records the parts of a triangle whose depth is clamped.
pub(super) type ClampedSlabs<F> = fn(&mut Assembly<'_, '_, F>, &mut ScreenTriangle, Outcode);

/// The assembly of one draw.
pub(super) struct Assembly<'s, 'a, F: Framebuffer> {
    pub(super) scene: &'s mut Scene<'a, F>,
    pub(super) draw: &'s Draw<'s>,
    pub(super) program: &'s dyn Program<F>,
    pub(super) transform: &'s Transform,
    /// Stage 4, clipping, of the parts in front of the near plane and beyond the far plane. `None` if the state does
    /// not draw them.
    pub(super) clamped_slabs: Option<ClampedSlabs<F>>,
    /// The faces that are left out.
    pub(super) culling: Culling,
    /// The pixels that can be drawn in this phase.
    pub(super) clip: PixelRect,
}

impl<F: Framebuffer> Assembly<'_, '_, F> {
    /// Handles the triangles of those nodes of a mesh's hierarchy that may be visible.
    pub(super) fn hierarchy(&mut self, nodes: &[BoundsNode], mvp: &Projective) {
        let mut next = 0;
        while next < nodes.len() {
            let mut at = next;
            let mut visible = self.scene.visible_nodes(self.draw.state, nodes, mvp, &mut next);
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
        if self.draw.has_cull_distances || !self.scene.keeps_vertices() {
            self.each_triangle(numbers);
        } else {
            self.scan(numbers);
        }
    }

    /// Scans the triangles of a draw that keeps its vertices, and handles each triangle that the scan stops at.
    #[inline(never)]
    fn scan(&mut self, numbers: Range<usize>) {
        let to = if self.scene.is_recording() { ScanTo::Records } else { ScanTo::Drawing };
        let mut scan = Scan::new(self.draw.mesh, numbers, self.culling, to);
        while !self.scene.overflowed() {
            let first = self.scene.records.triangle_count();
            let Scene { records, strips, band, stats, .. } = &mut *self.scene;
            let event = scan.next(records, stats);
            if records.triangle_count() != first {
                // Stage 7, faces.
                self.program.shade_faces(records.triangles_from(first));
                if scan.to == ScanTo::Records {
                    place::<F>(records, first, strips, band.start, &self.clip, stats);
                }
                self.program.shade_corners(records, first);
                if scan.to == ScanTo::Drawing {
                    self.program.draw_waiting(self.scene);
                }
            }
            if event == ScanEvent::Done {
                break;
            }
            self.handle(event, &mut scan.triangle);
        }
    }

    /// Handles every triangle, without a scan: for draws that do not keep their vertices or have cull distances.
    #[inline(never)]
    fn each_triangle(&mut self, numbers: Range<usize>) {
        let mut triangle = ScreenTriangle::NONE;
        for number in numbers {
            let Some([i, j, k]) = self.draw.mesh.any_triangle(number) else { return };
            if self.scene.overflowed() {
                return;
            }
            self.scene.stats.triangles = self.scene.stats.triangles.wrapping_add(1);
            if self.program.is_culled_by_distance([i, j, k]) {
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
            ScanEvent::Visible => self.emit(triangle),
            // Stage 4, clipping.
            ScanEvent::NeedsClip(codes) => {
                self.program.clip(self, triangle, codes, DepthSlab::Inside);
                if let Some(clip) = self.clamped_slabs {
                    clip(self, triangle, codes);
                }
            }
            ScanEvent::NeedsVertices | ScanEvent::Full | ScanEvent::Done => {}
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
        let planes = Outcode(!self.draw.state.range.clamped().0);
        let event = triangle.assess::<F>(&packed, planes, self.culling, &self.clip, self.scene.stats);
        if event == ScanEvent::Done || event == ScanEvent::Visible || self.may_reach(&triangle.corners) {
            return event;
        }
        self.scene.stats.clipped = self.scene.stats.clipped.wrapping_sub(1);
        self.scene.stats.outside = self.scene.stats.outside.wrapping_add(1);
        ScanEvent::Done
    }

    /// Returns whether a triangle that has to be clipped may cover pixels of this strip or band.
    #[inline(never)]
    fn may_reach(&self, corners: &[u16; 3]) -> bool {
        let mut vertices = [ClipVertex::default(); 3];
        for (vertex, index) in vertices.iter_mut().zip(corners) {
            self.program.transformed(usize::from(*index), vertex);
        }
        may_reach(&self.clip, 0, &vertices)
    }

    /// Shades the face of a single triangle on the screen, stage 7, and records or draws the triangle.
    #[inline(never)]
    fn emit(&mut self, triangle: &mut ScreenTriangle) {
        if self.scene.is_recording() {
            self.record(triangle, triangle.corners);
        } else {
            self.draw_triangle(triangle, None);
        }
    }

    /// Stage 7, faces: returns the shader's word for a triangle, which is put into a record for that.
    fn face(&self, triangle: &ScreenTriangle) -> u32 {
        let ScreenTriangle { number, corners, area, .. } = triangle;
        let pending = PendingFace::new(usize::from(*number) + 1, (*area >> 32) as i32);
        let mut record = triangle_words(*corners, pending.0);
        self.program.shade_faces(&mut record);
        record[2]
    }

    /// Shades the face of a triangle, stage 7, and draws the triangle with its highest corner first. Turns its
    /// vertices, and its corners or those of the fan.
    #[inline(never)]
    fn draw_triangle(&mut self, triangle: &mut ScreenTriangle, mut fan: Option<[&FanCorner; 3]>) {
        let face = self.face(triangle);
        let turns = turn_vertices(&mut triangle.v);
        match &mut fan {
            Some(fan) => turn(fan, turns),
            None => turn(&mut triangle.corners, turns),
        }
        self.program.draw(self.scene, &self.clip, triangle, face, fan);
    }

    /// Stage 6, recording: puts a triangle into the list of the strip that it begins in, with its face's word.
    fn record(&mut self, triangle: &ScreenTriangle, mut corners: [u16; 3]) {
        turn_corners(&triangle.v, &mut corners);
        let face = self.face(triangle);
        let strip = self.scene.strips.of((triangle.row - self.scene.band.start) as u32);
        let number = self.scene.records.triangle_count();
        self.scene.records.push_triangle(corners, face, strip);
        self.program.shade_corners(&mut self.scene.records, number);
    }

    /// Returns the vertex stage's result for a vertex: from the records, if it is there.
    #[inline]
    fn packed_vertex(&mut self, index: u16) -> PackedVertex {
        if self.scene.keeps_vertices() {
            let packed = self.scene.records.packed_vertex(index.into());
            if !packed.is_unshaded() {
                return packed;
            }
        }
        self.program.shade(self.scene, index.into())
    }

    /// Draws or records the parts of a triangle whose depth is clamped.
    pub(super) fn clip_clamped_slabs(&mut self, triangle: &mut ScreenTriangle, codes: Outcode) {
        for slab in self.draw.state.range.clamped_slabs(codes) {
            self.program.clip(self, triangle, codes, slab);
        }
    }

    /// Clips a triangle to a polygon of up to `N` corners, and draws or records it as a fan of triangles about its
    /// first corner.
    #[inline(never)]
    pub(super) fn clip_to_fan<const N: usize>(
        &mut self,
        triangle: &mut ScreenTriangle,
        codes: Outcode,
        slab: DepthSlab,
    ) {
        let mut corners = Vec::<FanCorner, N>::new();
        self.clipped::<N>(triangle.corners, codes, slab, &mut corners);
        let recording = self.scene.is_recording();
        // Numbers of the first, the previous and the current corner in the records. A corner is stored when the first
        // triangle with it is recorded, so that those in other strips take no words.
        let mut indices = [UNSTORED; 3];
        for (k, corner) in corners.iter().enumerate().skip(2) {
            let (Some(first), Some(previous)) = (corners.first(), corners.get(k - 1)) else { return };
            let fan = [first, previous, corner];
            for (v, corner) in triangle.v.iter_mut().zip(fan) {
                *v = corner.vertex.screen();
            }
            if triangle.passes_culling::<F>(self.culling, &self.clip, self.scene.stats) {
                if recording {
                    for (index, corner) in indices.iter_mut().zip(fan) {
                        if *index == UNSTORED {
                            *index = self.scene.records.push_vertex();
                            self.program.store_corner(self.scene, *index, triangle.corners, corner);
                        }
                    }
                    self.record(triangle, indices);
                } else {
                    self.draw_triangle(triangle, Some(fan));
                }
            }
            // The first corner stays. The last corner becomes the second one of the next triangle.
            indices[1] = indices[2];
            indices[2] = UNSTORED;
        }
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
            let _ = polygon.push_back(ClipCorner::new(ClipVertex::default(), k));
            // In place, so that the vertex is not on the stack twice.
            if let Some(corner) = polygon.back_mut() {
                self.program.transformed(usize::from(*index), &mut corner.vertex);
            }
        }
        let mut clipping = Clipping::new(&mut polygon);
        clipping.clip(codes, slab);
        self.program.cut_by_distances(&mut clipping, corners);
        project_corners(&clipping, self.transform, self.draw.is_perspective, fan);
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
