//! The first part of stage 5 of [the pipeline](crate#the-pipeline), culling: triangles of a mesh come in as numbers of
//! vertices on the screen; those that are small and do not show the wrong side are put into the records.

use super::state::Culling;
use crate::math::SMALL_CORE;
use crate::mesh::Mesh;
use crate::target::{Room, third};
use crate::vertex::{PackedVertex, small};

/// Placeholder for a recorded triangle's face word, until `shade_faces` fills it. The upper bits hold the number of the
/// mesh's next triangle, and the lowest bit the sign of this triangle's area.
#[derive(Clone, Copy)]
pub(super) struct PendingFace(pub(super) u32);

impl PendingFace {
    #[inline]
    pub(super) const fn new(next: usize, area: i32) -> Self {
        Self((next as u32) << 1 | area as u32 >> 31)
    }

    /// Returns the triangle's number, and an area with the sign of the triangle's area.
    #[inline]
    pub(super) const fn parts(self) -> (usize, i64) {
        ((self.0 as usize >> 1).wrapping_sub(1), if self.0 & 1 == 0 { 1 } else { -1 })
    }
}

/// Reasons why a pass over triangles stops at one.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Stop {
    /// The triangle is large, or not all of its vertices are on the screen.
    Large,
    /// There is no room for it.
    Full,
}

/// Triangles are on their way through the first part of culling. Each loop is a function of its own, with few values,
/// so that all of them are in registers.
pub(super) struct CullPass<'p, 'r> {
    pub(super) culling: Culling,
    pub(super) room: Room<'p>,
    pub(super) positions: &'r [[u32; 2]],
    pub(super) degenerate: u32,
    /// The triangle that the pass stops at.
    pub(super) corners: [u16; 3],
}

impl CullPass<'_, '_> {
    /// Passes over an indexed list.
    #[inline(never)]
    pub(super) fn list(&mut self, list: &mut &[u16], number: &mut usize) -> Option<Stop> {
        let Self { culling, positions, .. } = *self;
        let mut room = self.room.take();
        let end = *number + third(list.len());
        let mut rest = *list;
        let stop = loop {
            let Some((corners, after)) = rest.split_first_chunk() else { break None };
            let [i, j, k] = *corners;
            let at = |index: u16| positions.get(usize::from(index));
            let stop = match (at(i), at(j), at(k)) {
                (Some(a), Some(b), Some(c)) => {
                    let next = || end - third(after.len());
                    cull_one(culling, &mut room, &mut self.degenerate, next, *corners, [a, b, c])
                }
                _ => Some(Stop::Large),
            };
            if let Some(stop) = stop {
                self.corners = [i, j, k];
                break Some(stop);
            }
            rest = after;
        };
        (*list, *number, self.room) = (rest, end - third(rest.len()), room);
        stop
    }

    /// Passes over a list without indices.
    #[inline(never)]
    pub(super) fn row(&mut self, number: &mut usize, end: usize) -> Option<Stop> {
        let Self { culling, positions, .. } = *self;
        let mut room = self.room.take();
        let mut next = *number;
        let mut rest = positions.get(3 * next..3 * end).unwrap_or_default();
        let stop = loop {
            let Some(([a, b, c], after)) = rest.split_first_chunk() else { break None };
            let first = (3 * next) as u16;
            let corners = [first, first.wrapping_add(1), first.wrapping_add(2)];
            if let Some(stop) = cull_one(culling, &mut room, &mut self.degenerate, || next + 1, corners, [a, b, c]) {
                self.corners = corners;
                break Some(stop);
            }
            (rest, next) = (after, next + 1);
        };
        (*number, self.room) = (next, room);
        stop
    }

    /// Passes over triangles of any topology.
    #[inline(never)]
    pub(super) fn any(&mut self, mesh: &Mesh<'_>, number: &mut usize, end: usize) -> Option<Stop> {
        while *number < end {
            // A list of one triangle.
            let corners = mesh.any_triangle(*number)?;
            let stop = self.list(&mut corners.as_slice(), number);
            if stop.is_some() {
                return stop;
            }
        }
        None
    }
}

/// Culls one triangle by its winding, or puts it into the records. `next` returns the number of the triangle after it.
///
/// # Format
/// Positions are 24.8. A vertex off the screen has x = -2²³, and its difference from any other x does not fit 16 bits.
/// On small cores, products have 32 bits, so differences in y have to fit 16 bits, too. Other cores make a product of
/// 64 bits by one instruction, and any y will do: 2 · 2¹⁵ · 2²⁵ < 2⁶³. The upper word of the area has the area's sign.
#[inline(always)]
fn cull_one(
    culling: Culling,
    room: &mut Room<'_>,
    degenerate: &mut u32,
    next: impl FnOnce() -> usize,
    corners: [u16; 3],
    [a, b, c]: [&[u32; 2]; 3],
) -> Option<Stop> {
    let (ax, ay) = (a[0] as i32 >> 8, a[1] as i32 >> 8);
    let side = |p: u32, from: i32| (p as i32 >> 8) - from;
    let [bx, by, cx, cy] = [side(b[0], ax), side(b[1], ay), side(c[0], ax), side(c[1], ay)];
    let is_small = small(bx) & small(cx) & (!SMALL_CORE || small(by) & small(cy));
    if !is_small {
        return Some(Stop::Large);
    }
    let (low, sign) = if SMALL_CORE {
        let area = bx * cy - cx * by;
        (area, area)
    } else {
        let area = i64::from(bx) * i64::from(cy) - i64::from(cx) * i64::from(by);
        (area as i32, (area >> 32) as i32)
    };
    if low == 0 && (SMALL_CORE || is_zero(sign)) {
        // Or none of the vertices is on the screen.
        if (a[0] as i32) < PackedVertex::LEAST_X {
            return Some(Stop::Large);
        }
        *degenerate += 1;
    } else if !culling.leaves_out(sign) && !room.push(corners, PendingFace::new(next(), sign).0) {
        return Some(Stop::Full);
    }
    None
}

/// Returns whether a word is 0. Out of line, because the compiler would otherwise compare both halves of each area.
#[inline(never)]
const fn is_zero(word: i32) -> bool {
    word == 0
}
