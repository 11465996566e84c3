//! Stages 2 to 7 of [the pipeline](crate#the-pipeline) for the clusters of a model's part: nodes of one level, most of
//! which are seen. A mesh's own hierarchy is for parts of which most are not; it goes through the assembly itself.
//!
//! Vertices are projected in loops before triangles are scanned, as those of a mesh without a hierarchy are. A scan
//! that shades vertices as triangles ask for them stops at every triangle with a new vertex.

use super::assembly::Assembly;
use super::scene::Scene;
use super::state::State;
use crate::math::Projective;
use crate::mesh::{BoundsNode, Topology};
use crate::target::Framebuffer;
use crate::vertex::{PackedVertex, Planes, ScreenMatrix};
use core::ops::Range;

/// The first word of a vertex that is not projected yet.
const UNSHADED: u32 = PackedVertex::NONE_WORDS[0];

/// Projects a range of the vertices of a draw that keeps them.
pub(super) type ProjectRange<'p, F> = dyn Fn(&mut Scene<'_, F>, Range<usize>) + 'p;

impl<F: Framebuffer> Assembly<'_, '_, F> {
    /// Handles the triangles of those clusters that may be visible.
    #[inline(never)]
    pub(super) fn clusters(&mut self, nodes: &[BoundsNode], project: &ProjectRange<'_, F>) {
        let (mesh, mvp) = (self.draw.mesh, self.draw.mvp);
        let keeps_vertices = self.scene.keeps_vertices();
        // It takes 45 instructions on a Cortex-M0+ to look for the vertices of a triangle, and 240 to project a vertex.
        // So where three quarters of the triangles may be visible, all vertices are projected in one loop.
        let mut looks = keeps_vertices;
        let culled = self.scene.stats.culled;
        let (mut leaves, mut seen) = (Leaves::new(nodes), 0);
        while keeps_vertices && leaves.next(self.scene, self.draw.state, mvp) {
            seen += leaves.run.len();
        }
        if keeps_vertices && 4 * seen >= 3 * mesh.triangle_count() {
            project(self.scene, 0..mesh.vertex_count());
            looks = false;
        }
        self.scene.stats.culled = culled;
        leaves = Leaves::new(nodes);
        while leaves.next(self.scene, self.draw.state, mvp) {
            if looks {
                self.project(leaves.run.clone(), project);
            }
            self.triangles(leaves.run.clone());
        }
    }

    /// Stage 2, vertices: projects those vertices of triangles with these numbers that are not projected yet. They
    /// mostly follow one another in a mesh, and a range of them is projected in one loop.
    #[inline(never)]
    fn project(&mut self, numbers: Range<usize>, project: &ProjectRange<'_, F>) {
        let data = self.draw.mesh.data();
        let (Topology::Triangles, Some(indices)) = (data.topology, data.indices) else { return };
        let mut indices = indices.get(3 * numbers.start..3 * numbers.end).unwrap_or_default();
        while !indices.is_empty() {
            let run = next_run(self.scene.records.positions(), &mut indices);
            project(self.scene, run);
        }
    }
}

/// A walk through the leaves of a hierarchy that may be visible.
struct Leaves<'n> {
    nodes: &'n [BoundsNode],
    /// The first node that is not tested yet.
    next: usize,
    /// The first of the nodes that are tested and not handled, and one bit for each of them.
    at: usize,
    visible: u32,
    /// Numbers of the triangles of the leaves that were found: of all that follow one another, because each scan takes
    /// some time by itself.
    run: Range<usize>,
}

impl<'n> Leaves<'n> {
    fn new(nodes: &'n [BoundsNode]) -> Self {
        Self { nodes, next: 0, at: 0, visible: 0, run: 0..0 }
    }

    /// Finds the next run of triangles. Returns `false` if there is none.
    #[inline(never)]
    fn next<F: Framebuffer>(&mut self, scene: &mut Scene<'_, F>, state: &State, mvp: &Projective) -> bool {
        self.run = 0..0;
        loop {
            if self.visible == 0 {
                if self.next >= self.nodes.len() {
                    return !self.run.is_empty();
                }
                self.at = self.next;
                self.visible = visible_nodes(scene, state, self.nodes, mvp, &mut self.next);
                continue;
            }
            if let (Some(node), 1) = (self.nodes.get(self.at), self.visible & 1) {
                let (first, count) = (usize::from(node.first_triangle), usize::from(node.triangles));
                if self.run.is_empty() {
                    self.run = first..first;
                } else if count > 0 && first != self.run.end {
                    return true;
                }
                self.run.end += count;
            }
            (self.at, self.visible) = (self.at + 1, self.visible >> 1);
        }
    }
}

/// Tests up to 32 nodes as [`Scene::visible_nodes`] does, by sides of the view volume that are made once for all.
#[inline(never)]
fn visible_nodes<F: Framebuffer>(
    scene: &mut Scene<'_, F>,
    state: &State,
    nodes: &[BoundsNode],
    mvp: &Projective,
    next: &mut usize,
) -> u32 {
    let mut planes = Planes::EMPTY;
    scene.set_planes(&mut planes, mvp, state.range);
    let mut screen = ScreenMatrix::EMPTY;
    if F::OCCLUDES {
        screen.set_from(mvp, &scene.viewport);
    }
    let (first, mut visible) = (*next, 0);
    while let (Some(node), Some(bit)) = (nodes.get(*next), 1_u32.checked_shl((*next - first) as u32)) {
        let seen = planes.sees(&node.bounds);
        if F::OCCLUDES && seen && scene.hides_bounds(state, &screen, &node.bounds) {
            scene.stats.culled = scene.stats.culled.wrapping_add(1);
            *next = usize::from(node.skip);
        } else if seen {
            visible |= bit;
            *next += 1;
        } else {
            scene.stats.culled = scene.stats.culled.wrapping_add(1);
            *next = usize::from(node.skip);
        }
    }
    visible
}

/// Returns the next vertices of a list that follow one another and are not projected yet, and takes them, with those
/// that are projected, from the front of the list.
#[inline(never)]
fn next_run(places: &[[u32; 2]], indices: &mut &[u16]) -> Range<usize> {
    let is_unshaded = |index: u16| places.get(usize::from(index)).is_some_and(|[word, _]| *word == UNSHADED);
    let all = *indices;
    let mut list = all.iter();
    let Some(first) = list.by_ref().copied().find(|index| is_unshaded(*index)) else {
        *indices = &[];
        return 0..0;
    };
    let mut length = 1;
    // Most are in the run, or projected.
    let end = list.position(|index| {
        let place = index.wrapping_sub(first);
        if place < length || !is_unshaded(*index) {
            return false;
        }
        let is_next = place == length;
        length += u16::from(is_next);
        !is_next
    });
    // With the vertex that the next run begins with.
    *indices = end.and_then(|_| all.get(all.len() - list.len() - 1..)).unwrap_or_default();
    usize::from(first)..usize::from(first) + usize::from(length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use std::vec;
    use std::vec::Vec;

    /// Vertices of a model's cluster, of a shuffled mesh, and of anything in between.
    fn random_indices(rng: &mut Rng, vertices: u64) -> Vec<u16> {
        let mut fresh = rng.below(vertices);
        (0..rng.below(200))
            .map(|_| {
                if rng.below(4) == 0 {
                    fresh = (fresh + 1) % vertices;
                    return fresh as u16;
                }
                // Also numbers of no vertex.
                if rng.below(3) == 0 {
                    rng.below(vertices + 2) as u16
                } else {
                    fresh.saturating_sub(rng.below(6)) as u16
                }
            })
            .collect()
    }

    #[test]
    fn runs_are_the_vertices_that_are_not_projected_once_and_in_order() {
        let mut longest = 0;
        for seed in 0..4000 {
            let mut rng = Rng::new(seed);
            let count = 1 + rng.below(60);
            let mut places = vec![PackedVertex::NONE_WORDS; count as usize];
            for place in &mut places {
                if rng.below(4) == 0 {
                    *place = [1, 2];
                }
            }
            let indices = random_indices(&mut rng, count);
            let mut expected = vec![];
            for index in indices.iter().copied().map(usize::from) {
                if places.get(index) == Some(&PackedVertex::NONE_WORDS) && !expected.contains(&index) {
                    expected.push(index);
                }
            }
            let (mut found, mut rest) = (vec![], &indices[..]);
            while !rest.is_empty() {
                let run = next_run(&places, &mut rest);
                longest = longest.max(run.len());
                // As projecting does.
                run.clone().for_each(|k| places[k] = [3, 4]);
                found.extend(run);
            }
            assert_eq!(found, expected, "seed {seed}: {indices:?}");
        }
        assert!(longest > 10, "{longest}");
    }
}
