//! Stages 3, 5 and 6 of [the pipeline](crate#the-pipeline): assembles a mesh's triangles one after the other, culls the
//! ones that cannot be visible, and records the others. This code is compiled once, for all shaders.

use super::state::Culling;
use crate::mesh::{Mesh, Topology};
use crate::raster::{PixelRect, pixel_rect};
use crate::target::{PackedVertex, Records, Stats, StripRows};
use crate::vertex::{ClipVertex, Outcode, ScreenVertex, signed_area, small};
use core::ops::Range;

/// A pass over the triangles of a mesh: its position, and the triangle that it stopped at.
pub(super) struct Scan<'m> {
    mesh: &'m Mesh<'m>,
    /// Indices of the triangles to come, if the mesh is an indexed list.
    list: &'m [u16],
    next: usize,
    end: usize,
    culling: Culling,
    recording: bool,
    pub(super) triangle: ScreenTriangle,
}

/// Placeholder for a recorded triangle's face word, until `shade_faces` fills it. The upper bits hold the number of the
/// mesh's next triangle, and the lowest bit the sign of this triangle's area.
#[derive(Clone, Copy)]
pub(super) struct PendingFace(pub(super) u32);

impl PendingFace {
    #[inline]
    const fn new(next: usize, area: i32) -> Self {
        Self((next as u32) << 1 | area as u32 >> 31)
    }

    /// Returns the triangle's number, and an area with the sign of the triangle's area.
    #[inline]
    pub(super) const fn parts(self) -> (usize, i64) {
        ((self.0 as usize >> 1).wrapping_sub(1), if self.0 & 1 == 0 { 1 } else { -1 })
    }
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
    pub(super) fn assess(
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
            return if self.passes_culling(culling, clip, stats) { ScanEvent::Visible } else { ScanEvent::Done };
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
    pub(super) fn passes_culling(&mut self, culling: Culling, clip: &PixelRect, stats: &mut Stats) -> bool {
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

/// Returns the edge vectors b − a and c − a, x and y of each in 24.8, from words of
/// [`PackedVertex`](crate::target::PackedVertex)s. `None` unless all components fit 16 bits and all vertices lie within
/// 16,511 px of the screen's corner.
///
/// # Format
/// A vertex off the screen has x = -2²³, and no y. Its difference from any x below 2²² is not small.
#[inline(always)]
fn small_sides(a: [i32; 2], b: [i32; 2], c: [i32; 2]) -> Option<[i32; 4]> {
    let (ax, ay) = (a[0] >> 8, a[1] >> 8);
    let [bx, by, cx, cy] = [(b[0] >> 8) - ax, (b[1] >> 8) - ay, (c[0] >> 8) - ax, (c[1] >> 8) - ay];
    let far = a[0].wrapping_add(1 << 30) | a[1].wrapping_add(1 << 30);
    if far >= 0 && small(bx) & small(by) & small(cx) & small(cy) { Some([bx, by, cx, cy]) } else { None }
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

/// A rectangle to the right of all triangles.
const NOWHERE: PixelRect = PixelRect { x: i32::MAX..i32::MAX, y: 0..0 };

impl<'m> Scan<'m> {
    /// Begins a scan of the triangles with these numbers.
    pub(super) fn new(mesh: &'m Mesh<'m>, numbers: Range<usize>, culling: Culling, recording: bool) -> Self {
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
            recording,
            triangle: ScreenTriangle::NONE,
        }
    }

    /// Goes on to the next triangle that the caller has to handle. Visible triangles that precede it are recorded, with
    /// [`PendingFace`]s as their face words. While triangles are recorded, the scan stops only at triangles that need
    /// their vertices. Otherwise it stops at visible triangles, too.
    pub(super) fn next(
        &mut self,
        records: &mut Records<'_>,
        strips: &StripRows,
        band: i32,
        clip: &PixelRect,
        stats: &mut Stats,
    ) -> ScanEvent {
        loop {
            if !self.scan_small(records, strips, band, clip, stats) {
                return ScanEvent::Done;
            }
            if self.triangle.v.iter().any(|v| v.x == PackedVertex::OFF_SCREEN_X) {
                return ScanEvent::NeedsVertices;
            }
            if self.triangle.passes_culling(self.culling, clip, stats) {
                if !self.recording {
                    return ScanEvent::Visible;
                }
                let pending = PendingFace::new(self.next, (self.triangle.area >> 32) as i32);
                records.push_triangle(self.triangle.corners, pending.0, strips.of((self.triangle.row - band) as u32));
            }
        }
    }

    /// Records triangles until one needs the exact test of [`ScreenTriangle::passes_culling`]. Nearly all triangles
    /// pass here: they are small, and on the screen or not far off it. If nothing is recorded, stops at the first
    /// triangle that may be visible, too. Returns whether it stopped at a triangle.
    #[inline(never)]
    fn scan_small(
        &mut self,
        records: &mut Records<'_>,
        strips: &StripRows,
        band: i32,
        clip: &PixelRect,
        stats: &mut Stats,
    ) -> bool {
        let mut triangles = records.triangles();
        let first = triangles.count();
        // If nothing is recorded, a list without room ends the loop at the first visible triangle, at no cost per
        // triangle. A test of `recording` there would take 4 % of the scan.
        if !self.recording {
            triangles.leave_no_room();
        }
        // No triangle is inside an empty rectangle. A rectangle far away has this effect without a test per triangle.
        let clip = if clip.is_empty() { &NOWHERE } else { clip };
        let strips = *strips;
        let culling = self.culling;
        let in_a_row = self.mesh.data().topology == Topology::Triangles && self.mesh.data().indices.is_none();
        let mut list = self.list;
        let mut number = self.next;
        let found = loop {
            // Stage 3, primitive assembly: the most common meshes take the shortest way.
            let (corners, positions) = match list.split_first_chunk() {
                Some((corners, rest)) => {
                    list = rest;
                    (*corners, triangles.positions_of(*corners))
                }
                _ if number >= self.end => break None,
                _ if in_a_row => triangles.in_a_row(number),
                _ => match self.mesh.any_triangle(number) {
                    Some(corners) => (corners, triangles.positions_of(corners)),
                    None => break None,
                },
            };
            number += 1;
            // Stage 5, culling: first by winding, as early as possible, and then of triangles that cover no pixel.
            let [i, j, k] = corners;
            let [a, b, c] = positions;
            let Some([bx, by, cx, cy]) = small_sides(a, b, c) else {
                break Some((corners, positions));
            };
            let area = bx * cy - cx * by;
            if area == 0 || culling.leaves_out(area) {
                let count = if area == 0 { &mut stats.degenerate } else { &mut stats.back_facing };
                *count = count.wrapping_add(1);
                continue;
            }
            // As in `pixel_rect`, but from packed words, which compare as their coordinates do.
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
            // Stage 6, recording: into the list of the strip that the triangle begins in.
            let strip = strips.of((y.start.max(clip.y.start) - band) as u32);
            if !triangles.push(u32::from(i) | u32::from(j) << 16, k, PendingFace::new(number, area).0, strip) {
                if !self.recording {
                    break Some((corners, positions));
                }
                triangles.overflow();
                break None;
            }
        };
        stats.drawn = stats.drawn.wrapping_add((triangles.count() - first).into());
        triangles.finish();
        stats.triangles = stats.triangles.wrapping_add((number - self.next) as u32);
        self.list = list;
        self.next = number;
        self.triangle.number = number.wrapping_sub(1) as u16;
        let Some((corners, [a, b, c])) = found else { return false };
        self.triangle.corners = corners;
        self.triangle.v =
            [PackedVertex::signed(a).screen(), PackedVertex::signed(b).screen(), PackedVertex::signed(c).screen()];
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::state::{Cull, State, Winding};
    use super::*;
    use crate::math::random::Rng;
    use crate::math::{Scalar, Vec3};
    use crate::mesh::{MeshData, Positions};
    use crate::target::{Layout, TriangleRecord};
    use crate::vertex::Projected;
    use std::vec;
    use std::vec::Vec;

    const STRIPS: usize = 15;
    const COUNT: usize = 600;

    struct Random(Rng);

    impl Random {
        fn below(&mut self, end: i32) -> i32 {
            self.0.below(end as u64) as i32
        }

        /// Returns three vertices of a tiny, small, large or huge triangle. Some of them are not shaded, or off the
        /// screen.
        fn positions(&mut self) -> [[u32; 2]; 3] {
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
            records.vertices_mut().0.copy_from_slice(&positions);
            let strips = StripRows::new(16, true);
            let mut scan = Scan::new(&mesh, 0..COUNT, state.culling(), true);
            let (mut stats, mut unplaced) = (Stats::default(), Vec::new());
            while scan.next(&mut records, &strips, rows.start, &clip, &mut stats) == ScanEvent::NeedsVertices {
                unplaced.push((scan.triangle.number, scan.triangle.corners));
            }
            records.end_draw();

            let mut expected = Stats { triangles: COUNT as u32, ..Stats::default() };
            let mut triangle = ScreenTriangle::NONE;
            let (mut left, mut drawn) = (Vec::new(), vec![Vec::new(); STRIPS]);
            for number in 0..COUNT {
                let corners = mesh.triangle(number).expect("a triangle");
                let packed = corners.map(|k| PackedVertex::from_words(positions[usize::from(k)]));
                triangle.v = packed.map(PackedVertex::screen);
                if !packed.iter().all(|packed| packed.is_on_screen()) {
                    left.push((number as u16, corners));
                } else if triangle.passes_culling(state.culling(), &clip, &mut expected) {
                    drawn[strips.of((triangle.row - rows.start) as u32)].push((corners, number, triangle.area > 0));
                }
            }
            assert_eq!(unplaced, left, "case {case}");
            assert_eq!(stats, expected, "case {case}");
            for (strip, drawn) in drawn.iter().enumerate() {
                records.begin_replay(strip);
                assert!(records.replay_draw(7, positions.len(), 2));
                let last = records.last_triangle();
                let mut triangle = TriangleRecord::default();
                for expected in drawn {
                    assert!(
                        records.triangles().replay(last, i32::MAX >> 2, &mut triangle),
                        "case {case}, strip {strip}"
                    );
                    let (number, area) = PendingFace(triangle.face).parts();
                    assert_eq!((triangle.corners(), number, area > 0), *expected, "case {case}, strip {strip}");
                    found += 1;
                }
                assert!(!records.triangles().replay(last, i32::MAX >> 2, &mut triangle), "case {case}, strip {strip}");
            }
        }
        assert!(found > 3000, "{found} triangles");
    }
}
