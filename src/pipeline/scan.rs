//! Stages 2 and 5: a mesh's triangles one after the other, without those that cannot be seen. The same code for all shaders.

use super::{Cull, State, Winding};
use crate::geometry::{Mesh, Outcode, ScreenVertex, Side, Topology, area_of, signed_area};
use crate::output::{Records, Slot, Stats};
use crate::raster::{PixelRect, pixel_rect};
use core::ops::Range;

/// Where a walk over triangles is, and the last one it found.
pub(super) struct Scan<'m> {
    mesh: &'m Mesh<'m>,
    /// Those to come, if the mesh is an indexed list.
    list: &'m [u16],
    next: usize,
    end: usize,
    pub(super) seen: Seen,
}

/// A triangle that was found: one on the screen that may have pixels, or one that has to be looked at.
pub(super) struct Seen {
    /// Its number in the mesh, and its vertices.
    pub(super) number: usize,
    pub(super) corners: [u16; 3],
    /// Where it is; a part of it, if it has to be clipped.
    pub(super) v: [ScreenVertex; 3],
    /// Twice the signed area; not 0.
    pub(super) area: i64,
    /// The first row it can have a pixel in.
    pub(super) row: i32,
}

/// What a walk stopped at.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Stop {
    /// A triangle that may be seen.
    Seen,
    /// One with a vertex that is not shaded yet, or not on the screen.
    Unplaced,
    /// One to be clipped, by these planes and by clip distances.
    Clipped(Outcode),
    /// There are no more.
    End,
}

/// Which areas are those of faces that are left out.
#[derive(Clone, Copy)]
pub(super) struct Culling {
    positive: bool,
    negative: bool,
}

impl State {
    /// The side that a triangle of this signed area, which is not 0, shows.
    #[inline]
    pub(super) fn side(&self, area: i64) -> Side {
        // y points down here: a positive area goes with the clock.
        if (area > 0) == (self.front == Winding::CounterClockwise) { Side::Back } else { Side::Front }
    }

    /// Which faces are left out.
    pub(super) fn culling(&self) -> Culling {
        let culled = |area| match self.cull {
            Cull::Back => self.side(area) == Side::Back,
            Cull::Front => self.side(area) == Side::Front,
            Cull::None => false,
        };
        Culling { positive: culled(1), negative: culled(-1) }
    }
}

impl Culling {
    #[inline]
    fn leaves_out(self, area: i64) -> bool {
        (self.positive & (area > 0)) | (self.negative & (area < 0))
    }
}

impl Seen {
    /// Nothing yet.
    pub(super) const NONE: Self =
        Self { number: 0, corners: [0; 3], v: [ScreenVertex::new(0, 0, 0); 3], area: 0, row: 0 };

    /// Whether what is at `v` may be seen: stage 5, culling by winding, and of what covers no pixel of `clip`.
    #[inline(never)]
    pub(super) fn find(&mut self, culling: Culling, clip: &PixelRect, stats: &mut Stats) -> bool {
        let [a, b, c] = &self.v;
        self.area = signed_area(a, b, c);
        if culling.leaves_out(self.area) {
            stats.back_facing = stats.back_facing.wrapping_add(1);
            return false;
        }
        self.has_pixels(clip, stats)
    }

    /// Whether it may have pixels in `clip`, and in which row the first.
    #[inline(never)]
    fn has_pixels(&mut self, clip: &PixelRect, stats: &mut Stats) -> bool {
        if self.area == 0 {
            stats.degenerate = stats.degenerate.wrapping_add(1);
            return false;
        }
        let rect = pixel_rect(&self.v);
        if rect.is_empty() {
            stats.empty = stats.empty.wrapping_add(1);
            return false;
        }
        let rect = rect.intersection(clip);
        if rect.is_empty() {
            stats.outside = stats.outside.wrapping_add(1);
            return false;
        }
        stats.drawn = stats.drawn.wrapping_add(1);
        self.row = rect.y.start;
        true
    }
}

impl<'m> Scan<'m> {
    /// Of some triangles of a mesh.
    pub(super) fn new(mesh: &'m Mesh<'m>, numbers: Range<usize>) -> Self {
        let indices = match mesh.data() {
            data if data.topology == Topology::Triangles => data.indices,
            _ => None,
        };
        let list = indices.and_then(|indices| indices.get(3 * numbers.start..3 * numbers.end));
        Self {
            mesh,
            list: list.unwrap_or_default(),
            next: numbers.start,
            end: numbers.end.min(mesh.triangle_count()),
            seen: Seen::NONE,
        }
    }

    /// Goes on to the next triangle that may be seen, or that has to be looked at.
    #[inline(never)]
    pub(super) fn next(
        &mut self,
        records: &Records<'_>,
        culling: Culling,
        clip: &PixelRect,
        stats: &mut Stats,
    ) -> Stop {
        let vertices = records.positions();
        let slot = |index: u16| vertices.get(usize::from(index)).map_or(Slot::NONE, |words| Slot::from_words(*words));
        let mut list = self.list;
        let mut number = self.next;
        let stop = loop {
            // 2. Primitive assembly. The usual mesh by the shortest way.
            let (i, j, k) = match list.split_first_chunk() {
                Some(([i, j, k], rest)) => {
                    list = rest;
                    (*i, *j, *k)
                }
                _ => match self.other(number) {
                    Some([i, j, k]) => (i, j, k),
                    None => break Stop::End,
                },
            };
            number += 1;
            let (a, b, c) = (slot(i), slot(j), slot(k));
            if !(a.is_on_screen() && b.is_on_screen() && c.is_on_screen()) {
                self.seen.corners = [i, j, k];
                break Stop::Unplaced;
            }
            // 5. Culling by winding, as early as can be.
            let area = area_of(a.xy(), b.xy(), c.xy());
            if culling.leaves_out(area) {
                stats.back_facing = stats.back_facing.wrapping_add(1);
                continue;
            }
            self.seen.corners = [i, j, k];
            self.seen.v = [a.screen(), b.screen(), c.screen()];
            self.seen.area = area;
            if self.seen.has_pixels(clip, stats) {
                break Stop::Seen;
            }
        };
        self.list = list;
        stats.triangles = stats.triangles.wrapping_add((number - self.next) as u32);
        self.next = number;
        self.seen.number = number.wrapping_sub(1);
        stop
    }

    /// The vertices of a triangle of any topology; none past the last.
    fn other(&self, number: usize) -> Option<[u16; 3]> {
        if number < self.end { self.mesh.any_triangle(number) } else { None }
    }
}
