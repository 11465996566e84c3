//! The packed varyings of a triangle's corners, in the words where the vertex stage left them.

use super::packed::VERTEX_WORDS;

/// The packed varyings of a triangle's corners. A shader receives them in
/// [`small_packed`](crate::span::Shader::small_packed) and hands them on to the shader inside.
#[derive(Clone, Copy, Debug)]
pub struct PackedCorners<'r> {
    /// Words of varyings, those of one vertex after the other.
    pub(crate) varyings: &'r [u32],
    /// Words of all vertices, among them those that the clipper added.
    pub(crate) vertices: &'r [u32],
    /// Numbers of the corners.
    pub(crate) corners: [u16; 3],
}

impl<'r> PackedCorners<'r> {
    /// No corners.
    pub(crate) const NONE: PackedCorners<'static> = PackedCorners { varyings: &[], vertices: &[], corners: [0; 3] };

    /// Returns the words of each corner, `N` each.
    #[inline(always)]
    pub(crate) fn words<const N: usize>(&self) -> Option<[&'r [u32; N]; 3]> {
        let [i, j, k] = self.corners;
        Some([self.corner(i)?, self.corner(j)?, self.corner(k)?])
    }

    #[inline(always)]
    fn corner<const N: usize>(&self, index: u16) -> Option<&'r [u32; N]> {
        match self.varyings.get(N * usize::from(index)..).and_then(<[u32]>::first_chunk) {
            Some(words) => Some(words),
            None => self.added(index),
        }
    }

    /// Returns the words of a corner that the clipper added.
    #[inline(never)]
    fn added<const N: usize>(&self, index: u16) -> Option<&'r [u32; N]> {
        self.vertices.get((N + VERTEX_WORDS) * usize::from(index) + VERTEX_WORDS..)?.first_chunk()
    }
}
