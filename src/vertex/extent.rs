//! Extents: a box in object space comes in, and the pixels and the depths that anything in it may have come out. They
//! say whether it can be hidden.

use super::clip::ClipVertex;
use super::project::{ScreenVertex, project};
use super::transform::{ScreenMatrix, times};
use crate::mesh::Bounds;
use core::ops::Range;

/// The pixels that something may cover, and a depth that none of it is nearer than.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Extent {
    pub(crate) columns: Range<i32>,
    pub(crate) rows: Range<i32>,
    pub(crate) nearest: u16,
}

impl Extent {
    /// An extent without pixels, to be [`widened`](Self::widen).
    pub(crate) const EMPTY: Self = {
        // The first position is both ends of a range.
        let none = Range { start: i32::MAX, end: i32::MIN };
        Self { columns: Range { ..none }, rows: none, nearest: u16::MAX }
    };

    /// Widens the extent, whose ranges are in 24.8 px for now, by a position.
    #[inline(always)]
    pub(crate) fn widen(&mut self, x: i32, y: i32, z: u16) {
        for (range, c) in [(&mut self.columns, x), (&mut self.rows, y)] {
            *range = range.start.min(c)..range.end.max(c);
        }
        self.nearest = self.nearest.min(z);
    }

    /// Turns ranges of 24.8 px into those of pixels, which have the pixels of both ends in them.
    pub(crate) fn to_pixels(&self) -> Self {
        let pixels = |range: &Range<i32>| range.start >> 8..(range.end >> 8).saturating_add(1);
        Self { columns: pixels(&self.columns), rows: pixels(&self.rows), nearest: self.nearest }
    }
}

/// Largest distance of a corner from the screen's corner, in 24.8 px: well inside of the guard band, so that no
/// triangle in the box is cut there.
const FARTHEST: u32 = 32_000 << 8;

/// Steps of depth that a vertex may be nearer than its box: one each for the roundings of both, and one for
/// what the vertex stage is off by.
pub(crate) const STEPS: u16 = 3;

impl ScreenMatrix {
    /// Returns the extent of all vertices in a box, in perspective depth. `None` if the box is too near to the eye, if
    /// it reaches too far off the screen, or if `may_hide` says that its centre is not hidden. The test of the centre
    /// takes a fraction of the time, and most boxes that are seen are seen there.
    ///
    /// # Format
    /// Entries are below 2⁴⁵ and coordinates below 2¹⁶: sums of six products and an entry are below 2⁶³.
    ///
    /// The vertex stage is off by less than 2⁻³⁷ of the largest value that a vertex of its format can reach, which is
    /// at most 2¹⁶ times the entries of a row and the translation. No corner's w is below 1/8 of these entries. So a
    /// clip coordinate is off by less than 2⁻¹⁸ of w: a quarter of a step of depth, and on the screen, where
    /// coordinates are up to 64 times w in units of 512 px, 1/8 px. The extent is wider by 3 steps and by 1 px.
    #[inline(never)]
    pub(crate) fn extent(&self, bounds: &Bounds, may_hide: impl FnOnce(ScreenVertex) -> bool) -> Option<Extent> {
        let (center, half) = (bounds.center.to_bits(), bounds.half.to_bits());
        let mut middle = [0; 4];
        for (row, middle) in self.rows.iter().zip(&mut middle) {
            let [.., translation] = *row;
            let products = row.iter().zip(&center).filter(|(entry, _)| **entry != 0);
            *middle = products.fold(translation, |sum, (entry, center)| sum + times(*entry, *center));
        }
        let [x, y, z, w] = middle;
        if w <= 0 || !may_hide(project(&ClipVertex { x, y, z, w })?) {
            return None;
        }
        let (mut sides, mut reach) = ([[0; 4]; 3], 0);
        for (k, row) in self.rows.iter().enumerate() {
            let [.., translation] = *row;
            let mut entries = translation.abs() >> 16;
            for ((entry, side), half) in row.iter().zip(&mut sides).zip(&half) {
                entries += entry.abs();
                if *entry != 0
                    && let Some(side) = side.get_mut(k)
                {
                    *side = times(*entry, *half);
                }
            }
            reach = entries.max(reach);
        }
        let mut extent = Extent::EMPTY;
        for corner in 0..8 {
            let mut at = middle;
            for (k, side) in sides.iter().enumerate() {
                for (c, side) in at.iter_mut().zip(side) {
                    *c += if corner >> k & 1 == 0 { -side } else { *side };
                }
            }
            let [x, y, z, w] = at;
            if w < reach >> 3 || z < 0 {
                return None;
            }
            let corner = project(&ClipVertex { x, y, z, w })?;
            if corner.x.unsigned_abs() | corner.y.unsigned_abs() > FARTHEST {
                return None;
            }
            extent.widen(corner.x, corner.y, corner.z);
        }
        let Extent { columns, rows, nearest } = extent.to_pixels();
        let wider = |range: Range<i32>| range.start - 1..range.end + 1;
        Some(Extent { columns: wider(columns), rows: wider(rows), nearest: nearest.saturating_sub(STEPS) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use crate::math::{Affine, Angle16, Projective, Scalar, Vec3};
    use crate::mesh::{Mesh, MeshData, Positions};
    use crate::vertex::{Projected, Transform, Viewport};
    use embedded_graphics_core::geometry::{Point, Size};
    use std::vec::Vec;

    /// Vertices of random meshes, in both formats and at the corners of their boxes, too: all that are in front of the
    /// near plane are within the extent.
    #[test]
    fn extents_hold_all_vertices() {
        let (mut rng, mut found, mut none) = (Rng::new(1), 0, 0);
        for case in 0..4000 {
            let size = Size::new(1 + rng.below(1024) as u32, 1 + rng.below(1024) as u32);
            let viewport = Viewport::new(Point::new(rng.below(200) as i32 - 100, 0), size).expect("a viewport");
            let near = Scalar::from_bits(1 << rng.below(18));
            let far = near.saturating_mul(Scalar::from_bits(70_000 << rng.below(12)));
            let camera = Projective::perspective(Angle16::from_degrees(60), size, near, far);
            let mut random = |bits: u32| Scalar::from_bits(rng.signed_bits(bits) as i32);
            let bits = 8 + case % 20;
            let place = Vec3::new(random(bits + 2), random(bits + 2), -random(bits + 2).abs());
            let turn = Affine::rotation_y(Angle16(random(16).to_bits() as u16));
            let points: Vec<Vec3> = (0..21).map(|_| Vec3::new(random(bits), random(bits), random(bits))).collect();
            let short: Vec<[i16; 3]> =
                points.iter().map(|_| [random(16), random(16), random(16)].map(|c| c.to_bits() as i16)).collect();
            let positions = if case % 2 == 0 {
                Positions::Exact(&points)
            } else {
                Positions::Quantized {
                    points: &short,
                    scale: random(bits).abs(),
                    offset: Vec3::new(random(bits), place.x, place.y),
                }
            };
            let (Ok(mesh), Ok(camera)) = (Mesh::new(MeshData::new(positions)), camera) else { continue };
            let mvp = camera * Affine::translation(place) * turn;
            let mut screen = ScreenMatrix::EMPTY;
            screen.set_from(&mvp, &viewport);
            let Some(extent) = screen.extent(mesh.bounds(), |_| true) else {
                none += 1;
                continue;
            };
            let transform = Transform::new(&mvp, &viewport, &mesh, false);
            for index in 0..21 {
                let Projected::OnScreen(v) = transform.project_vertex(&positions, index) else { continue };
                let inside = extent.columns.contains(&(v.x >> 8)) && extent.rows.contains(&(v.y >> 8));
                assert!(inside && v.z >= extent.nearest, "case {case}: {v:?} is not in {extent:?}");
                found += 1;
            }
        }
        assert!(found > 5000 && none > 100, "{found} vertices, {none} boxes too near");
    }
}
