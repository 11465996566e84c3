//! The posed vertices of a part, as they lie in the memory of a pose: scale, offset, box, positions, normals.

use super::container::Part;
use super::read::{POSED_HEAD, bounds_of, vector_words};
use crate::math::Scalar;
use crate::mesh::{Bounds, Positions};

/// The posed vertices of a part in the memory of a pose.
pub(super) struct PosedPart<'p> {
    head: &'p [u32; POSED_HEAD],
    points: &'p [[i16; 3]],
    normals: Option<&'p [[i16; 3]]>,
}

impl<'p> PosedPart<'p> {
    /// Returns the posed vertices of a part; `None` for a part that no pose moves, and without a pose.
    pub(super) fn of(pose: &'p [u32], part: &Part) -> Option<Self> {
        let words = pose.get(part.pose as usize..)?;
        let (head, rest) = words.split_first_chunk()?;
        let vertices = part.vertices as usize;
        let (points, rest) = rest.split_at_checked(vector_words(vertices))?;
        let normals = rest.get(..vector_words(vertices)).filter(|_| part.has_normals());
        Some(Self { head, points: vectors(points, vertices), normals: normals.map(|words| vectors(words, vertices)) })
    }

    /// Returns the box around the vertices.
    pub(super) fn bounds(&self) -> Bounds {
        let [_, _, _, _, center @ .., a, b, c] = *self.head;
        bounds_of(center.map(|c| c as i32), [a, b, c].map(|c| c as i32))
    }

    pub(super) fn positions(&self) -> Positions<'p> {
        let [scale, x, y, z, ..] = *self.head;
        let offset = bounds_of([x, y, z].map(|c| c as i32), [0; 3]).center;
        Positions::Quantized { points: self.points, scale: Scalar::from_bits(scale as i32), offset }
    }

    pub(super) const fn normals(&self) -> Option<&'p [[i16; 3]]> {
        self.normals
    }
}

/// Returns words as vectors of three numbers of 16 bits.
fn vectors(words: &[u32], count: usize) -> &[[i16; 3]] {
    let halves: &[i16] = bytemuck::try_cast_slice(words).unwrap_or_default();
    let halves = halves.get(..3 * count).unwrap_or_default();
    bytemuck::try_cast_slice(halves).unwrap_or_default()
}
