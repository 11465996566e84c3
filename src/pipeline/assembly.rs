//! Stages 2 to 7: from a mesh's triangles to triangles on the screen, drawn or recorded.

use super::scan::{Culling, Scan, Seen, Stop};
use super::triangle::Chosen;
use super::{Scene, State};
use crate::fragment::Shader;
use crate::geometry::{
    BoundsNode, CLIPPED_CORNERS, ClipVertex, Corner, DISTANCE_CORNERS, Face, MAX_DISTANCES, Mesh, Outcode, Part,
    Placed, Polygon, PolygonCorner, Transform, Varyings, VertexShader, View, inverse_w, weighted,
};
use crate::math::Projective;
use crate::output::{Framebuffer, Slot};
use crate::raster::PixelRect;
use core::ops::Range;

/// The corners of a clipped polygon on the screen, with their varyings.
type Fan<S, const N: usize> = heapless::Vec<FanCorner<S>, N>;
type FanCorner<S> = (Slot, <S as VertexShader>::Varyings);

/// One draw.
pub(super) struct Assembly<'s, 'a, F: Framebuffer, S: Shader<F::Format>> {
    pub(super) scene: &'s mut Scene<'a, F>,
    pub(super) state: &'s State,
    pub(super) chosen: &'s Chosen<F, S>,
    pub(super) mesh: &'s Mesh<'s>,
    pub(super) shader: &'s S,
    pub(super) transform: &'s Transform,
    /// Pixels that can be drawn in this phase.
    pub(super) clip: PixelRect,
}

impl<F: Framebuffer, S: Shader<F::Format>> Assembly<'_, '_, F, S> {
    /// Takes the parts of a mesh that can be seen.
    #[inline(never)]
    pub(super) fn parts(&mut self, nodes: &[BoundsNode], mvp: &Projective) {
        let mut view = View::EMPTY;
        view.fold(mvp, &self.scene.viewport);
        let mut k = 0;
        while let Some(node) = nodes.get(k) {
            if self.scene.sees(&view, &node.bounds, self.state.range) {
                let first = usize::from(node.first_triangle);
                self.triangles(first..first + usize::from(node.triangles));
                k += 1;
            } else {
                self.scene.stats.culled = self.scene.stats.culled.wrapping_add(1);
                k = usize::from(node.skip);
            }
        }
    }

    /// Takes triangles one by one.
    #[inline(never)]
    pub(super) fn triangles(&mut self, numbers: Range<usize>) {
        let first = numbers.start;
        let culling = self.state.culling();
        if S::CULL_DISTANCES > 0 || !self.scene.has_vertices() {
            return self.each_triangle(numbers, culling);
        }
        let mut scan = Scan::new(self.mesh, numbers);
        while !self.scene.overflowed() {
            match scan.next(&self.scene.records, culling, &self.clip, self.scene.stats) {
                Stop::Seen => self.shade_face(&scan.seen, scan.corners, scan.number),
                Stop::Unplaced => self.unplaced(&mut scan.seen, culling, scan.corners, scan.number),
                Stop::End => break,
            }
        }
        self.scene.stats.triangles = self.scene.stats.triangles.wrapping_add((scan.next_number() - first) as u32);
    }

    /// [`triangles`](Self::triangles) where there is nothing to scan: places are not kept, or cull distances come before them.
    #[inline(never)]
    fn each_triangle(&mut self, numbers: Range<usize>, culling: Culling) {
        let mut seen = Seen::NONE;
        for number in numbers {
            let Some(corners) = self.mesh.any_triangle(number) else { return };
            if self.scene.overflowed() {
                return;
            }
            self.scene.stats.triangles = self.scene.stats.triangles.wrapping_add(1);
            if S::CULL_DISTANCES > 0 && self.is_culled_by_distance(corners) {
                self.scene.stats.outside = self.scene.stats.outside.wrapping_add(1);
            } else {
                self.unplaced(&mut seen, culling, corners, number);
            }
        }
    }

    /// A triangle that has a vertex which is not shaded yet, or not on the screen.
    #[inline(never)]
    fn unplaced(&mut self, seen: &mut Seen, culling: Culling, corners: [u16; 3], number: usize) {
        // 3. Vertex stage, once a vertex where there are records to keep the result.
        let mut slots = [Slot::NONE; 3];
        let mut visible = true;
        for (slot, index) in slots.iter_mut().zip(&corners) {
            *slot = self.slot(*index);
            visible &= slot.is_on_screen();
        }
        if !visible {
            return self.clip(seen, &slots, corners, number);
        }
        if seen.set(&slots, culling, &self.clip, self.scene.stats) {
            self.shade_face(seen, corners, number);
        }
    }

    /// A triangle on the screen.
    #[inline(never)]
    fn shade_face(&mut self, seen: &Seen, corners: [u16; 3], number: usize) {
        let word = self.face(seen, corners, number);
        if self.scene.is_recording() {
            self.record(seen.row, corners, word);
        } else {
            let [i, j, k] = corners;
            self.draw(seen, &mut [self.varyings(i), self.varyings(j), self.varyings(k)], word);
        }
    }

    #[inline(never)]
    fn face(&self, seen: &Seen, corners: [u16; 3], number: usize) -> u32 {
        self.shader.face(&Face::new(self.mesh, number, corners, self.state.side(seen.area)))
    }

    /// The vertex stage's result for a vertex, from the records if it is there.
    #[inline]
    fn slot(&mut self, index: u16) -> Slot {
        if !self.scene.has_vertices() {
            return self.shade(index.into());
        }
        let slot = self.scene.records.slot(index.into());
        if slot.is_unshaded() { self.shade(index.into()) } else { slot }
    }

    /// 3. Vertex stage, of all vertices, where there are records to keep the result.
    #[inline(never)]
    pub(super) fn shade_all(&mut self) {
        let Self { scene, mesh, shader, transform, .. } = self;
        let stage = VertexStage { mesh, shader: *shader, transform };
        let (places, varyings) = scene.records.vertices_mut();
        scene.stats.vertices = scene.stats.vertices.wrapping_add(places.len() as u32);
        for (index, place) in places.iter_mut().enumerate() {
            *place = stage.place(index).words();
            if S::WORDS > 0 {
                let words = varyings.get_mut(index * S::WORDS..).and_then(|rest| rest.get_mut(..S::WORDS));
                S::store(&stage.varyings(index), words.unwrap_or_default());
            }
        }
    }

    /// The vertex stage's result for a vertex: transformed, projected and snapped, or its outcode.
    #[inline(never)]
    pub(super) fn shade(&mut self, index: usize) -> Slot {
        self.scene.stats.vertices = self.scene.stats.vertices.wrapping_add(1);
        let slot = self.stage().place(index);
        if self.scene.has_vertices() {
            let varyings = self.vertex(index);
            self.scene.records.keep::<S>(index, slot, &varyings);
        }
        slot
    }

    #[inline]
    fn stage(&self) -> VertexStage<'_, S> {
        VertexStage { mesh: self.mesh, shader: self.shader, transform: self.transform }
    }

    #[inline]
    pub(super) fn transformed(&self, index: usize) -> ClipVertex {
        self.stage().transformed(index)
    }

    /// 4. Clipping, of a triangle with a vertex outside.
    #[inline(never)]
    fn clip(&mut self, seen: &mut Seen, slots: &[Slot; 3], corners: [u16; 3], number: usize) {
        let (mut common, mut all) = (!self.state.range.clamped().0, 0);
        for slot in slots {
            common &= slot.outcode();
            all |= slot.outcode();
        }
        let all = Outcode(all);
        if common != 0 {
            self.scene.stats.outside = self.scene.stats.outside.wrapping_add(1);
            return;
        }
        self.scene.stats.clipped = self.scene.stats.clipped.wrapping_add(1);
        self.part(seen, all, corners, number, Part::Between);
        if let Some(beyond) = self.chosen.beyond {
            beyond(self, seen, all, corners, number);
        }
    }

    /// The parts of a triangle that have their depth clamped.
    pub(super) fn beyond(&mut self, seen: &mut Seen, codes: Outcode, corners: [u16; 3], number: usize) {
        for part in self.state.range.parts_beyond(codes) {
            self.part(seen, codes, corners, number, part);
        }
    }

    #[inline]
    fn part(&mut self, seen: &mut Seen, codes: Outcode, corners: [u16; 3], number: usize, part: Part) {
        if S::CLIP_DISTANCES > 0 {
            self.cut_part::<DISTANCE_CORNERS>(seen, codes, corners, number, part);
        } else {
            self.cut_part::<CLIPPED_CORNERS>(seen, codes, corners, number, part);
        }
    }

    /// A part of a triangle, which has up to `N` corners when it has been clipped.
    #[inline(never)]
    fn cut_part<const N: usize>(
        &mut self,
        seen: &mut Seen,
        codes: Outcode,
        corners: [u16; 3],
        number: usize,
        part: Part,
    ) {
        let mut fan = Fan::<S, N>::new();
        self.cut(corners, codes, part, &mut fan);
        self.fan(seen, &fan, corners, number);
    }

    /// Whether one of the cull distances is negative at all corners.
    #[inline]
    fn is_culled_by_distance(&self, corners: [u16; 3]) -> bool {
        let [a, b, c] = corners.map(|k| self.shader.distances(&Corner::new(self.mesh, usize::from(k))));
        let all = a.iter().zip(b).zip(c).map(|((a, b), c)| a & b & c);
        all.skip(S::CLIP_DISTANCES).take(S::CULL_DISTANCES).any(|sign| sign < 0)
    }

    /// What is left of a part of a triangle, on the screen. In a function of its own, so that the polygon in clip space
    /// has left the stack when it is drawn.
    #[inline(never)]
    fn cut<const N: usize>(&self, corners: [u16; 3], codes: Outcode, part: Part, fan: &mut Fan<S, N>) {
        let mut triangle = [ClipVertex::default(); 3];
        for (vertex, index) in triangle.iter_mut().zip(&corners) {
            *vertex = self.transformed(usize::from(*index));
        }
        let polygon: &mut Polygon = &mut Polygon::<[PolygonCorner; N]>::new();
        polygon.clip(&triangle, codes, part);
        let [i, j, k] = corners;
        let (i, j, k) = (usize::from(i), usize::from(j), usize::from(k));
        if S::CLIP_DISTANCES > 0 {
            let [i, j, k] = [self.stage().distances(i), self.stage().distances(j), self.stage().distances(k)];
            for ((i, j), k) in i.into_iter().zip(j).zip(k).take(S::CLIP_DISTANCES) {
                polygon.cut_by_distance([i, j, k]);
            }
        }
        let vertex = |index| self.shader.vertex(&Corner::new(self.mesh, index));
        let varyings = [vertex(i), vertex(j), vertex(k)];
        for corner in polygon.corners() {
            let vertex = corner.vertex();
            let Some(placed) = self.transform.project(&vertex) else { continue };
            let mut varyings: S::Varyings = weighted(&corner.weights(), &varyings);
            if S::Varyings::PERSPECTIVE > 0 {
                varyings.set_inverse_w(inverse_w(&vertex));
            }
            if !self.scene.is_recording() {
                // What the records would keep of them, so that the picture is the same without.
                varyings = rounded::<S>(&varyings);
            }
            // There are no more corners than places.
            let _ = fan.push((Slot::new(&Placed::Screen(placed)), varyings));
        }
    }

    /// Draws a clipped polygon as a fan of triangles.
    #[inline(never)]
    fn fan(&mut self, seen: &mut Seen, fan: &[FanCorner<S>], corners: [u16; 3], number: usize) {
        let recording = self.scene.is_recording();
        let (mut v, mut indices) = ([Slot::NONE; 3], [0; 3]);
        for (place, (slot, varyings)) in fan.iter().enumerate() {
            if recording {
                indices[2] = self.scene.records.push_vertex();
                self.scene.records.keep::<S>(usize::from(indices[2]), *slot, varyings);
            }
            v[2] = *slot;
            if let (2.., Some(first), Some(last)) = (place, fan.first(), fan.get(place.wrapping_sub(1))) {
                if seen.set(&v, self.state.culling(), &self.clip, self.scene.stats) {
                    let word = self.face(seen, corners, number);
                    if recording {
                        self.record(seen.row, indices, word);
                    } else {
                        self.draw(seen, &mut [first.1, last.1, *varyings], word);
                    }
                }
            }
            let place = usize::from(place > 0);
            (v[place], indices[place]) = (v[2], indices[2]);
        }
    }

    /// The varyings of a vertex, with 1 / w if they take it.
    #[inline]
    pub(super) fn vertex(&self, index: usize) -> S::Varyings {
        self.stage().varyings(index)
    }

    fn varyings(&self, index: u16) -> S::Varyings {
        if self.scene.has_vertices() {
            return self.scene.records.varyings::<S>(index);
        }
        rounded::<S>(&self.vertex(usize::from(index)))
    }

    /// 6, 7. Into the records, to the strip it begins in.
    fn record(&mut self, row: i32, corners: [u16; 3], face: u32) {
        let row = row - self.scene.band.start;
        let strip = self.scene.strips.of(row as u32);
        self.scene.records.push_triangle(corners, face, strip);
    }

    #[inline]
    fn draw(&mut self, seen: &Seen, varyings: &mut [S::Varyings; 3], face: u32) {
        self.scene
            .painter(&self.clip, self.state, self.chosen, self.shader)
            .triangle_of_area(&seen.v, seen.area, varyings, face);
    }
}

/// The varyings as the records would give them back.
#[inline(never)]
pub(super) fn rounded<S: VertexShader>(varyings: &S::Varyings) -> S::Varyings {
    let mut words = S::Varyings::ZERO;
    let words: &mut [u32] = bytemuck::cast_slice_mut(words.as_mut());
    let words = words.get_mut(..S::WORDS).unwrap_or_default();
    S::store(varyings, words);
    S::load(words)
}

/// What the vertex stage works with.
struct VertexStage<'s, S> {
    mesh: &'s Mesh<'s>,
    shader: &'s S,
    transform: &'s Transform,
}

impl<S: VertexShader> VertexStage<'_, S> {
    /// Where a vertex is: transformed, projected and snapped, or its outcode.
    #[inline(always)]
    fn place(&self, index: usize) -> Slot {
        let placed = if S::DISPLACES {
            self.transform.place_clip(&self.transformed(index))
        } else {
            self.transform.place(&self.mesh.data().positions, index)
        };
        let slot = Slot::new(&placed);
        if S::CLIP_DISTANCES > 0 && self.distances(index).iter().any(|distance| *distance < 0) {
            // Off the screen, but not by the planes that outcodes know.
            return Slot::new(&Placed::Outside(Outcode(slot.outcode())));
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

    /// The clip distances of a vertex; those that the shader does not have are 0.
    #[inline]
    fn distances(&self, index: usize) -> [i32; MAX_DISTANCES] {
        let mut distances = self.shader.distances(&Corner::new(self.mesh, index));
        distances.iter_mut().skip(S::CLIP_DISTANCES).for_each(|distance| *distance = 0);
        distances
    }

    /// The varyings of a vertex, with 1 / w if they take it.
    #[inline]
    fn varyings(&self, index: usize) -> S::Varyings {
        let mut varyings = self.shader.vertex(&Corner::new(self.mesh, index));
        if S::Varyings::PERSPECTIVE > 0 {
            varyings.set_inverse_w(inverse_w(&self.transformed(index)));
        }
        varyings
    }
}
