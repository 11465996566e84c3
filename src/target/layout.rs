//! The layout of [`Records`](super::records::Records): which things lie where in the words.

use super::state_pool::StatePool;

/// Number that stands for no triangle.
pub(super) const NONE: u16 = u16::MAX;
/// Words of a triangle: two vertices; the third and the link; the word of its face.
pub(super) const TRIANGLE: usize = 3;

/// Positions of things in the words; kept by the frame from one walk over the scene to the next.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Layout {
    /// First free word.
    pub(super) front: usize,
    /// Number of recorded triangles.
    pub(super) triangles: u16,
    /// The current draw: position of its header, and of its vertices; number of vertices of the mesh, and of those
    /// that the clipper added; words per vertex.
    pub(super) header: usize,
    /// First word of the marks of the current draw's vertices: a bit is set if the vertex has its varyings.
    pub(super) marks: usize,
    pub(super) vertices: usize,
    pub(super) count: usize,
    pub(super) added: u16,
    pub(super) stride: usize,
    pub(super) overflow: bool,
    /// Replay: number of the strip; one more than the last triangle of the draw;
    /// the next triangle; the last triangle that was moved on; and the triangle after
    /// that one in the next strip's list.
    pub(super) strip: usize,
    pub(super) last: u32,
    pub(super) next: u16,
    pub(super) moved: u16,
    pub(super) after: u16,
    /// First word after the lists of the strips.
    pub(super) lists: usize,
    /// Places for the states of triangles that go on in the next strip.
    pub(super) pool: StatePool,
}
