//! Stages 2 and 5: a mesh's triangles one after the other, without those that cannot be seen. The same code for all shaders.

use super::{Cull, State, Winding};
use crate::geometry::{Mesh, Outcode, ScreenVertex, Side, Topology, signed_area, small};
use crate::output::{Records, Slot, Stats, StripRows};
use crate::raster::{PixelRect, pixel_rect};
use core::ops::Range;

/// Where a walk over triangles is, and the last one it found.
pub(super) struct Scan<'m> {
    mesh: &'m Mesh<'m>,
    /// Those to come, if the mesh is an indexed list.
    list: &'m [u16],
    /// Whether it is a list without indices.
    consecutive: bool,
    next: usize,
    end: usize,
    pub(super) seen: Seen,
}

/// How triangles are recorded.
#[derive(Clone, Copy)]
pub(super) struct Recorder<'r> {
    pub(super) faces: &'r dyn Faces,
    pub(super) strips: &'r StripRows,
    /// The first row of the band.
    pub(super) row: i32,
}

/// What a shader hands on for faces, so that for all shaders the same code records.
pub(super) trait Faces {
    /// The word of triangle `number`: by its first two corners, the second in the upper half, and the third below the sign of
    /// the area.
    fn word(&self, number: usize, corners: u32, last: u32) -> u32;
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

/// Which faces are left out.
#[derive(Clone, Copy)]
pub(super) struct Culling {
    /// What the sign of an area is changed by, so that faces that are left out have none.
    flip: i32,
    /// Negative if none are left out.
    keep: i32,
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
        let counter_clockwise = self.front == Winding::CounterClockwise;
        Culling {
            flip: if (self.cull == Cull::Front) == counter_clockwise { -1 } else { 0 },
            keep: if self.cull == Cull::None { -1 } else { 0 },
        }
    }
}

impl Culling {
    /// Whether a face of this area, or of the upper half of it, is left out; the area is not 0.
    #[inline]
    fn leaves_out(self, area: i32) -> bool {
        (area ^ self.flip) | self.keep >= 0
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
        let rect = pixel_rect(&self.v);
        let within = rect.intersection(clip);
        self.row = within.y.start;
        let found = !within.is_empty();
        let count = if self.area == 0 {
            &mut stats.degenerate
        } else if culling.leaves_out((self.area >> 32) as i32) {
            &mut stats.back_facing
        } else if rect.is_empty() {
            &mut stats.empty
        } else if !found {
            &mut stats.outside
        } else {
            stats.drawn = stats.drawn.wrapping_add(1);
            return true;
        };
        *count = count.wrapping_add(1);
        false
    }
}

/// A place in the records, as a pair of signed words: see [`Slot`].
type Words = [i32; 2];

/// Differences of places, the second and the third less the first, in x and y: if both are small, and none of the vertices is off
/// the screen or more than 16,511 px away from its corner.
///
/// # Format
/// A vertex off the screen has x = -2²³, and no y: that is no small difference from any other below 2²².
#[inline(always)]
fn near(a: Words, b: Words, c: Words) -> Option<[i32; 4]> {
    let (ax, ay) = (a[0] >> 8, a[1] >> 8);
    let [bx, by, cx, cy] = [(b[0] >> 8) - ax, (b[1] >> 8) - ay, (c[0] >> 8) - ax, (c[1] >> 8) - ay];
    let far = a[0].wrapping_add(1 << 30) | a[1].wrapping_add(1 << 30);
    if far >= 0 && small(bx) & small(by) & small(cx) & small(cy) { Some([bx, by, cx, cy]) } else { None }
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
            consecutive: mesh.data().topology == Topology::Triangles && mesh.data().indices.is_none(),
            next: numbers.start,
            end: numbers.end.min(mesh.triangle_count()),
            seen: Seen::NONE,
        }
    }

    /// Records triangles, up to one that has to be looked at; without a recorder, goes on to the next one that may be seen, or
    /// that has to be looked at.
    #[inline(never)]
    pub(super) fn next(
        &mut self,
        records: &mut Records<'_>,
        recorder: Option<&Recorder<'_>>,
        culling: Culling,
        clip: &PixelRect,
        stats: &mut Stats,
    ) -> Stop {
        let mut records = records.triangles();
        // In an empty rectangle is nothing: one that is far away serves as well, and takes no test of its own.
        let clip = if clip.is_empty() { &PixelRect { x: i32::MAX..i32::MAX, y: 0..0 } } else { clip };
        let mut list = self.list;
        let mut number = self.next;
        let stop = loop {
            // 2. Primitive assembly. The usual meshes by the shortest way.
            let (i, j, k) = match list.split_first_chunk() {
                Some(([i, j, k], rest)) => {
                    list = rest;
                    (*i, *j, *k)
                }
                _ if number >= self.end => break Stop::End,
                _ if self.consecutive => (3 * number as u16, 3 * number as u16 + 1, 3 * number as u16 + 2),
                _ => match self.mesh.any_triangle(number) {
                    Some([i, j, k]) => (i, j, k),
                    None => break Stop::End,
                },
            };
            number += 1;
            let place = |index: u16| records.place(index).map(|word| word as i32);
            let (a, b, c) = (place(i), place(j), place(k));
            // 5. Culling by winding, as early as can be, and of what covers no pixel.
            let (area, row) = match near(a, b, c) {
                Some([bx, by, cx, cy]) => {
                    let area = bx * cy - cx * by;
                    if area == 0 || culling.leaves_out(area) {
                        let count = if area == 0 { &mut stats.degenerate } else { &mut stats.back_facing };
                        *count = count.wrapping_add(1);
                        continue;
                    }
                    // The pixels whose centres are in the bounding box, as `pixel_rect` has them: of words, which lie in the same order as
                    // coordinates.
                    let centre = |word: i32| (word + (127 << 8)) >> 16;
                    let y = centre(a[1].min(b[1]).min(c[1]))..centre(a[1].max(b[1]).max(c[1]));
                    let x = centre(a[0].min(b[0]).min(c[0]))..centre(a[0].max(b[0]).max(c[0]));
                    if x.start >= x.end || y.start >= y.end {
                        stats.empty = stats.empty.wrapping_add(1);
                        continue;
                    }
                    if x.start >= clip.x.end || clip.x.start >= x.end || y.start >= clip.y.end || clip.y.start >= y.end {
                        stats.outside = stats.outside.wrapping_add(1);
                        continue;
                    }
                    stats.drawn = stats.drawn.wrapping_add(1);
                    (area, y.start.max(clip.y.start))
                }
                None => {
                    let slots = [a, b, c].map(|words| Slot::from_words(words.map(|word| word as u32)));
                    if !slots.iter().all(|slot| slot.is_on_screen()) {
                        self.seen.corners = [i, j, k];
                        break Stop::Unplaced;
                    }
                    self.seen.v = slots.map(Slot::screen);
                    if !self.seen.find(culling, clip, stats) {
                        continue;
                    }
                    ((self.seen.area >> 32) as i32, self.seen.row)
                }
            };
            let Some(recorder) = recorder else {
                self.seen.corners = [i, j, k];
                self.seen.v = [a, b, c].map(|words| Slot::from_words(words.map(|word| word as u32)).screen());
                let [a, b, c] = &self.seen.v;
                self.seen.area = signed_area(a, b, c);
                self.seen.row = row;
                break Stop::Seen;
            };
            // 6, 7. Into the records, to the strip it begins in.
            let corners = u32::from(i) | u32::from(j) << 16;
            let last = u32::from(k) | area as u32 & 1 << 31;
            let face = recorder.faces.word(number - 1, corners, last);
            if !records.push(corners, k, face, recorder.strips.of((row - recorder.row) as u32)) {
                break Stop::End;
            }
        };
        self.list = list;
        stats.triangles = stats.triangles.wrapping_add((number - self.next) as u32);
        self.next = number;
        self.seen.number = number.wrapping_sub(1);
        stop
    }
}
