//! Stages 3, 5 and 6 of [the pipeline](crate#the-pipeline): assembles a mesh's triangles one after the other, culls the
//! ones that cannot be visible, and records the others. This code is compiled once, for all shaders.

use super::cull::{CullPass, PendingFace, Stop};
use super::state::Culling;
use crate::mesh::{Mesh, Topology};
use crate::raster::{PixelRect, sampled};
use crate::target::{Framebuffer, Records, Stats, StripRows, Triangles};
use crate::vertex::{ClipVertex, Outcode, PackedVertex, ScreenVertex, pack, signed_area};
use core::ops::Range;

/// A pass over the triangles of a mesh: its position, and the triangle that it stopped at.
pub(super) struct Scan<'m> {
    mesh: &'m Mesh<'m>,
    /// Indices of the triangles to come, if the mesh is an indexed list.
    list: &'m [u16],
    next: usize,
    end: usize,
    culling: Culling,
    /// Destination of the triangles that are not culled.
    pub(super) to: ScanTo,
    pub(super) triangle: ScreenTriangle,
}

/// Destinations of the triangles that may be visible.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum ScanTo {
    /// Record them, for the strips of the band.
    Records,
    /// Leave as many as there is room for in the records, to be drawn at once.
    Drawing,
}

/// A triangle of the mesh on the screen: the one that a scan stopped at, or a triangle of a fan.
pub(super) struct ScreenTriangle {
    /// The triangle's number in the mesh, and its vertices.
    pub(super) number: u16,
    pub(super) corners: [u16; 3],
    /// Vertices on the screen; those of one triangle of the fan, if the triangle is clipped.
    pub(super) v: [ScreenVertex; 3],
    /// Twice the signed area; never 0 once the triangle has passed culling.
    pub(super) area: i64,
    /// The first row that the triangle can have a pixel in.
    pub(super) row: i32,
}

/// Reasons why a scan stops.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum ScanEvent {
    /// The scan stopped at a triangle on the screen that may be visible, to be drawn.
    Visible,
    /// The scan stopped at a triangle with vertices that are off the screen or not shaded yet.
    NeedsVertices,
    /// A triangle has to be clipped, by these planes and by clip distances.
    NeedsClip(Outcode),
    /// There is no more room: what was put into the records has to be drawn, or placed into the strips' lists.
    Full,
    /// There are no more triangles, or the current triangle cannot be visible.
    Done,
}

impl ScreenTriangle {
    /// A placeholder, until a scan stops at a triangle.
    pub(super) const NONE: Self =
        Self { number: 0, corners: [0; 3], v: [ScreenVertex::new(0, 0, 0); 3], area: 0, row: 0 };

    /// Returns what has to be done with the triangle, from the results of the vertex stage: [`ScanEvent::Done`] if it
    /// cannot be visible. A triangle that lies outside of one of `planes` is not.
    #[inline(never)]
    pub(super) fn assess<F: Framebuffer>(
        &mut self,
        packed: &[PackedVertex; 3],
        planes: Outcode,
        culling: Culling,
        clip: &PixelRect,
        stats: &mut Stats,
    ) -> ScanEvent {
        let (mut visible, mut common, mut all) = (true, planes.0, 0);
        for (v, packed) in self.v.iter_mut().zip(packed) {
            *v = packed.screen();
            visible &= packed.is_on_screen();
            common &= packed.outcode();
            all |= packed.outcode();
        }
        if visible {
            return if self.passes_culling::<F>(culling, clip, stats) { ScanEvent::Visible } else { ScanEvent::Done };
        }
        if common != 0 {
            stats.outside = stats.outside.wrapping_add(1);
            return ScanEvent::Done;
        }
        stats.clipped = stats.clipped.wrapping_add(1);
        ScanEvent::NeedsClip(Outcode(all))
    }

    /// Stage 5, culling: returns whether the triangle at `v` shows the right side and may cover a pixel of `clip`.
    /// Computes its area and its first row.
    #[inline(never)]
    pub(super) fn passes_culling<F: Framebuffer>(
        &mut self,
        culling: Culling,
        clip: &PixelRect,
        stats: &mut Stats,
    ) -> bool {
        let [a, b, c] = &self.v;
        self.area = signed_area(a, b, c);
        let count = if self.area == 0 {
            &mut stats.degenerate
        } else if culling.leaves_out((self.area >> 32) as i32) {
            &mut stats.back_facing
        } else {
            let mut words = [[0; 2]; 3];
            pack(&self.v, &mut words);
            let mut test = BoxTest::new(clip);
            let row = test.first_row::<F>(words.each_ref());
            test.finish(stats, 1);
            self.row = row.unwrap_or_default();
            return row.is_some();
        };
        *count = count.wrapping_add(1);
        false
    }
}

/// A rectangle without pixels.
const NOWHERE: PixelRect = PixelRect { x: 0..0, y: 0..0 };

/// Tests the bounding box of triangles: stage 5, the second part of culling.
pub(super) struct BoxTest<'t> {
    clip: &'t PixelRect,
    /// Triangles that were left out: without a centre of a pixel, and outside of the rectangle.
    pub(super) left_out: [u32; 2],
}

impl<'t> BoxTest<'t> {
    pub(super) fn new(clip: &'t PixelRect) -> Self {
        // No triangle is in an empty rectangle. A rectangle without rows has this effect without a test per triangle.
        Self { clip: if clip.is_empty() { &NOWHERE } else { clip }, left_out: [0; 2] }
    }

    /// Returns the first row that a triangle with these vertices can have a pixel in; `None` if it can have none in the
    /// rectangle.
    #[inline(never)]
    pub(super) fn first_row<F: Framebuffer>(&mut self, v: [&[u32; 2]; 3]) -> Option<i32> {
        self.first_row_inlined::<F>(v)
    }

    /// Returns the first row as [`first_row`](Self::first_row) does; inlined, for the loop over recorded triangles.
    #[inline(always)]
    fn first_row_inlined<F: Framebuffer>(&mut self, [a, b, c]: [&[u32; 2]; 3]) -> Option<i32> {
        // Packed words compare as their coordinates do. Results are those of `pixel_rect`.
        let word = |axis: usize| [a[axis] as i32, b[axis] as i32, c[axis] as i32];
        let range = |[a, b, c]: [i32; 3]| sampled(a.min(b).min(c) >> 8, a.max(b).max(c) >> 8, F::SAMPLES);
        let (y, x) = (range(word(1)), range(word(0)));
        if x.start >= x.end || y.start >= y.end {
            self.left_out[0] += 1;
            return None;
        }
        let clip = self.clip;
        let (top, end) = (y.start.max(clip.y.start), y.end.min(clip.y.end));
        if x.start >= clip.x.end || clip.x.start >= x.end || top >= end {
            self.left_out[1] += 1;
            return None;
        }
        Some(top)
    }

    /// Adds the counts of the triangles that were left out, of `count` that were tested.
    pub(super) fn finish(&self, stats: &mut Stats, count: u32) {
        let [empty, outside] = self.left_out;
        stats.empty = stats.empty.wrapping_add(empty);
        stats.outside = stats.outside.wrapping_add(outside);
        stats.drawn = stats.drawn.wrapping_add(count).wrapping_sub(empty).wrapping_sub(outside);
    }
}

/// Returns whether a triangle in clip space may cover pixels of a rectangle, or up to `reach` px away from it. Looks at
/// its corners only, and errs on the side of `true`: so that triangles and lines are cut only in strips that they
/// reach.
///
/// # Format
/// If 512 x < left w holds at all corners, it holds all over the triangle, whatever the signs of w are, and also for
/// the part in front of the eye: this part is left of a column. Both sides are divided by 2⁷, so that they are below
/// 2⁵⁷ and 2⁶². The bits that w loses move a border by at most border · 2⁷ / w: 1/2 px on the screen. One pixel more is
/// left for that, and for what clipping and snapping round.
#[inline(never)]
pub(super) fn may_reach(clip: &PixelRect, reach: i32, corners: &[ClipVertex]) -> bool {
    let mut sides = [false; 4];
    let reach = reach + 1;
    let borders = [clip.x.start - reach, clip.x.end + reach, clip.y.start - reach, clip.y.end + reach];
    if borders.iter().any(|border| border.abs() > 1 << 14) {
        return true;
    }
    for vertex in corners {
        let w = vertex.w >> 7;
        let along = [vertex.x, vertex.x, vertex.y, vertex.y];
        for (k, ((inside, border), value)) in sides.iter_mut().zip(&borders).zip(along).enumerate() {
            let beyond = (value << 2) - i64::from(*border) * w;
            *inside |= if k & 1 == 0 { beyond >= 0 } else { beyond <= 0 };
        }
    }
    sides == [true; 4] && !clip.is_empty()
}

impl<'m> Scan<'m> {
    /// Begins a scan of the triangles with these numbers.
    pub(super) fn new(mesh: &'m Mesh<'m>, numbers: Range<usize>, culling: Culling, to: ScanTo) -> Self {
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
            culling,
            to,
            triangle: ScreenTriangle::NONE,
        }
    }

    /// Goes on to the next triangle that the caller has to handle. Triangles that precede it and may be visible are put
    /// into the records, with [`PendingFace`]s as their face words, and into no strip's list yet.
    #[inline(never)]
    pub(super) fn next(&mut self, records: &mut Records<'_>, stats: &mut Stats) -> ScanEvent {
        let mut triangles = records.triangles();
        let first = triangles.count();
        let event = loop {
            let Some(stop) = self.cull(&mut triangles, stats) else { break ScanEvent::Done };
            let [i, j, k] = self.triangle.corners;
            let corners = [i, j, k];
            let [a, b, c] = triangles.positions_of(corners).map(|words| PackedVertex::of(*words));
            let mut event = None;
            if stop == Stop::Large && !(a.is_on_screen() & b.is_on_screen() & c.is_on_screen()) {
                event = Some(ScanEvent::NeedsVertices);
            } else {
                let area = signed_area(&a.screen(), &b.screen(), &c.screen());
                let side = (area >> 32) as i32;
                if area == 0 {
                    stats.degenerate = stats.degenerate.wrapping_add(1);
                } else if self.culling.leaves_out(side) {
                    stats.back_facing = stats.back_facing.wrapping_add(1);
                } else if !triangles.push(corners, PendingFace::new(self.next + 1, side).0) {
                    // Those that wait here leave room, all of them or those without a pixel.
                    if triangles.count() != first {
                        break ScanEvent::Full;
                    }
                    if self.to == ScanTo::Records {
                        triangles.overflow();
                        break ScanEvent::Done;
                    }
                    // There is room for none: triangles are handled one by one.
                    event = Some(ScanEvent::NeedsVertices);
                }
            }
            // The scan goes on after this triangle.
            self.triangle.number = self.next as u16;
            self.next += 1;
            self.list = self.list.get(3..).unwrap_or_default();
            stats.triangles = stats.triangles.wrapping_add(1);
            if let Some(event) = event {
                break event;
            }
        };
        triangles.finish();
        event
    }

    /// Stage 5, the first part of culling: leaves out triangles that show the wrong side, and puts the others into the
    /// records. Stores the corners of the triangle that it stops at. Returns `None` if there are no more triangles.
    #[inline(never)]
    fn cull(&mut self, triangles: &mut Triangles<'_>, stats: &mut Stats) -> Option<Stop> {
        let (room, positions) = triangles.room();
        let mut pass = CullPass { culling: self.culling, room, positions, degenerate: 0, corners: [0; 3] };
        let before = self.next;
        // Stage 3, primitive assembly: the most common meshes take the shortest way.
        let data = self.mesh.data();
        let stop = if data.topology != Topology::Triangles {
            pass.any(self.mesh, &mut self.next, self.end)
        } else if data.indices.is_some() {
            pass.list(&mut self.list, &mut self.next)
        } else {
            pass.row(&mut self.next, self.end)
        };
        let CullPass { room, degenerate, corners: [i, j, k], .. } = pass;
        self.triangle.corners = [i, j, k];
        let left = room.left();
        let recorded = triangles.fill(left);
        let count = (self.next - before) as u32;
        stats.triangles = stats.triangles.wrapping_add(count);
        stats.degenerate = stats.degenerate.wrapping_add(degenerate);
        stats.back_facing = stats.back_facing.wrapping_add(count.wrapping_sub(degenerate).wrapping_sub(recorded));
        stop
    }
}

/// Stage 5, the second part of culling, and stage 6, recording: leaves out those of the triangles recorded from `first`
/// on that cover no pixel, and puts the others into the lists of the strips that they begin in.
#[inline(never)]
pub(super) fn place<F: Framebuffer>(
    records: &mut Records<'_>,
    first: u16,
    strips: &StripRows,
    band: i32,
    clip: &PixelRect,
    stats: &mut Stats,
) {
    let mut triangles = records.triangles();
    let count = triangles.count() - first;
    let mut test = BoxTest::new(clip);
    let strips = *strips;
    triangles.keep_each(first, |v| test.first_row_inlined::<F>(v).map(|row| strips.of((row - band) as u32)));
    test.finish(stats, count.into());
    triangles.finish();
}

#[cfg(test)]
mod tests {
    use super::super::state::{Cull, State, Winding};
    use super::*;
    use crate::math::random::Rng;
    use crate::math::{Scalar, Vec3};
    use crate::mesh::{MeshData, Positions};
    use crate::span::SmallResult;
    use crate::target::{DrawTriangles, Layout, Strip, TriangleRecord};
    use crate::vertex::Projected;
    use embedded_graphics_core::pixelcolor::Gray8;
    use std::vec;
    use std::vec::Vec;

    /// One sample per pixel.
    type Pixels = Strip<'static, Gray8>;

    const STRIPS: usize = 15;
    const COUNT: usize = 600;

    struct Random(Rng);

    impl Random {
        fn below(&mut self, end: i32) -> i32 {
            self.0.below(end as u64) as i32
        }

        /// Returns three vertices of a tiny, small, large or huge triangle. Some of them are not shaded, or off the
        /// screen. The area of some triangles is 2³², whose lower word is 0.
        fn positions(&mut self) -> [[u32; 2]; 3] {
            if self.below(20) == 0 {
                let (x, y, bits) = (self.below(1 << 16), self.below(1 << 14), 10 + self.below(6));
                let places = [(x, y), (x + (1 << bits), y), (x, y + (1 << (32 - bits)))];
                let first = self.below(3) as usize;
                let order = if self.below(2) == 0 { [0, 1, 2] } else { [0, 2, 1] };
                return order.map(|k| {
                    let (x, y) = places[(first + k) % 3];
                    PackedVertex::new(&Projected::OnScreen(ScreenVertex::new(x, y, 7))).words()
                });
            }
            let size = [300, 3000, 1 << 15, 1 << 17, 1 << 22][self.below(5) as usize];
            let at = [[self.below(1 << 17), self.below(1 << 16)], [(1 << 23) - 1 - size, -(1 << 23) + 1]];
            let [x, y] = at[usize::from(self.below(20) == 0)];
            [(); 3].map(|()| {
                let v = ScreenVertex::new(x + self.below(size), y + self.below(size), self.below(1 << 16) as u16);
                match self.below(100) {
                    0 => PackedVertex::NONE,
                    1 => PackedVertex::new(&Projected::NeedsClip(Outcode(Outcode::NEAR))),
                    _ => PackedVertex::new(&Projected::OnScreen(v)),
                }
                .words()
            })
        }
    }

    /// Looks at each triangle.
    struct Each<T>(T);

    impl<T: FnMut(&TriangleRecord, [&[u32; 2]; 3])> DrawTriangles for Each<T> {
        const CARRIES: bool = false;

        fn draw(&mut self, _: &Triangles<'_>, record: &TriangleRecord, v: [&[u32; 2]; 3]) -> SmallResult {
            (self.0)(record, v);
            SmallResult::Drawn
        }

        fn take_state(&mut self) -> &[u32] {
            &[]
        }

        fn go_on(&mut self, _: &mut [u32]) -> Option<bool> {
            None
        }
    }

    /// A scan records and counts the results of [`ScreenTriangle::passes_culling`] for each triangle.
    #[test]
    fn scans_find_what_is_found_one_by_one() {
        let mut random = Random(Rng::new(1));
        let points = [[0; 3]; 3 * COUNT];
        let positions = Positions::Quantized { points: &points, scale: Scalar::ONE, offset: Vec3::ZERO };
        let indices: Vec<u16> = (0..3 * COUNT as u16).map(|k| k ^ 1).collect();
        let (mut words, mut found) = (vec![0; 20_000], 0);
        for case in 0..60 {
            let cull = [Cull::Back, Cull::Front, Cull::None][case % 3];
            let front = [Winding::CounterClockwise, Winding::Clockwise][case / 3 % 2];
            let state = State { cull, front, ..State::DEFAULT };
            let data = MeshData { indices: (case % 4 > 1).then_some(&indices[..]), ..MeshData::new(positions) };
            let mesh = Mesh::new(data).expect("a mesh");
            let rows = 32..32 + 16 * STRIPS as i32;
            let clip = [PixelRect { x: 0..320, y: rows.clone() }, PixelRect { x: 50..60, y: 600..rows.start }]
                [usize::from(case % 7 == 6)]
            .clone();
            let positions: Vec<_> = (0..COUNT).flat_map(|_| random.positions()).collect();

            let mut layout = Layout::default();
            let mut records = Records::new(&mut words, &mut layout);
            records.begin_band(STRIPS);
            records.begin_draw(7, positions.len(), 2);
            records.positions_mut().copy_from_slice(&positions);
            let strips = StripRows::new(16, true);
            let mut scan = Scan::new(&mesh, 0..COUNT, state.culling(), ScanTo::Records);
            let (mut stats, mut unplaced) = (Stats::default(), Vec::new());
            loop {
                let first = records.triangle_count();
                let event = scan.next(&mut records, &mut stats);
                place::<Pixels>(&mut records, first, &strips, rows.start, &clip, &mut stats);
                if event == ScanEvent::Done {
                    break;
                }
                assert!(event == ScanEvent::NeedsVertices);
                unplaced.push((scan.triangle.number, scan.triangle.corners));
            }
            records.end_draw();

            let mut expected = Stats { triangles: COUNT as u32, ..Stats::default() };
            let mut triangle = ScreenTriangle::NONE;
            let (mut left, mut drawn) = (Vec::new(), vec![Vec::new(); STRIPS]);
            for number in 0..COUNT {
                let corners = mesh.triangle(number).expect("a triangle");
                let packed = corners.map(|k| PackedVertex::of(positions[usize::from(k)]));
                triangle.v = packed.map(PackedVertex::screen);
                if !packed.iter().all(|packed| packed.is_on_screen()) {
                    left.push((number as u16, corners));
                } else if triangle.passes_culling::<Pixels>(state.culling(), &clip, &mut expected) {
                    drawn[strips.of((triangle.row - rows.start) as u32)].push((corners, number, triangle.area > 0));
                }
            }
            assert_eq!(unplaced, left, "case {case}");
            assert_eq!(stats, expected, "case {case}");
            for (strip, drawn) in drawn.iter().enumerate() {
                records.begin_replay(strip);
                assert!(records.replay_draw(7, positions.len(), 2));
                let mut listed = drawn.iter();
                let draw = |triangle: &TriangleRecord, v: [&[u32; 2]; 3]| {
                    let (corners, number, front) = listed.next().expect("no more triangles");
                    let (next, area) = PendingFace(triangle.face).parts();
                    assert_eq!((next, area > 0), (*number, *front), "case {case}, strip {strip}");
                    let [a, b, c] = *corners;
                    let turned = [[a, b, c], [b, c, a], [c, a, b]];
                    assert!(turned.contains(&triangle.corners), "case {case}, strip {strip}");
                    let [a, b, c] = triangle.corners.map(|k| positions[usize::from(k)]);
                    assert_eq!(v, [&a, &b, &c], "case {case}, strip {strip}");
                    let [a, b, c] = [a, b, c].map(|words| words[1] as i32);
                    assert!(a <= b && a <= c, "case {case}, strip {strip}: the highest corner is not the first");
                    found += 1;
                };
                records.triangles().replay_each(i32::MAX >> 2, &mut TriangleRecord::default(), &mut Each(draw));
                assert_eq!(listed.next(), None, "case {case}, strip {strip}");
            }
        }
        assert!(found > 3000, "{found} triangles");
    }
}
