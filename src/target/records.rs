//! Records: the vertices and triangles that the recording walk over a scene leaves for the strips. They lie in a
//! slice of words that the caller lends. Positions on the screen, varyings and visible triangles come in; each strip
//! gets its triangles back, in drawing order.
//!
//! ```text
//!  strips   draw 0              draw 1                 free              triangles, newest first
//! ┌───────┬────────┬──────────┬────────┬─────────────┬───────────── ─ ─ ┬──────┬──────┬──────┐
//! │ lists │ header │ vertices │ header │ vertices    │ →             ←  │  2   │  1   │  0   │
//! └───────┴────────┴──────────┴────────┴─────────────┴───────────── ─ ─ ┴──────┴──────┴──────┘
//! ```
//! A draw's vertices are marks, a bit each, then the positions of all of them, two words each, and then the varyings of
//! all of them. A mark says that the vertex has its varyings: they are computed when a visible triangle asks for them.
//! Vertices that the clipper adds come after these, each with its position and its varyings together.
//!
//! The word of a strip in `lists` holds the first and the last of its triangles, which are linked through their
//! records in drawing order. A triangle is in one list at a time. It is recorded into the list of the topmost strip
//! it touches; when that strip is done with it, it moves on to the list of the next strip. So a triangle is one
//! record, however tall it is. What is left free may keep the state of such triangles: see `carried.rs`.

use super::layout::{Layout, NONE, TRIANGLE};
use super::state_pool::StatePool;
use super::triangles::{Triangles, Unshaded};
use crate::color::clear_words;
use crate::vertex::{Extent, PackedVertex, VERTEX_WORDS, Varyings, VertexShader};

/// Words of a draw's header: fingerprint, first word of its vertices, number of its last triangle + 1, next header.
const HEADER: usize = 4;
/// Words of a draw's extent, which end its words if hidden draws are left out: columns, nearest depth.
const EXTENT: usize = 2;

/// Returns the words of records that a scene needs at most when nothing is clipped. `draws` is the number of draw
/// calls, `vertices` and `triangles` are those of all draws together, of triangles only the visible ones.
/// `varying_words` is the number of words of varyings per vertex
/// ([`VertexShader::WORDS`](crate::vertex::VertexShader::WORDS)).
/// [`Renderer::with_occlusion`](crate::frame::Renderer::with_occlusion) takes 2 words more for each draw.
///
/// A number that does not fit is `usize::MAX`.
///
/// With fewer words, a frame takes more walks over the scene; without any, it takes one walk per strip.
#[must_use]
pub const fn records_len(
    strips: usize,
    draws: usize,
    vertices: usize,
    varying_words: usize,
    triangles: usize,
) -> usize {
    // A bit per vertex, in whole words for each draw: Σ ⌈v / 32⌉.
    let marks = if varying_words > 0 { vertices.saturating_add(draws.saturating_mul(31)) / 32 } else { 0 };
    let vertices = VERTEX_WORDS.saturating_add(varying_words).saturating_mul(vertices);
    strips
        .saturating_add(HEADER.saturating_mul(draws))
        .saturating_add(marks)
        .saturating_add(vertices)
        .saturating_add(TRIANGLE.saturating_mul(triangles))
}

/// The words of the records, and the layout that says which things lie where in them.
#[derive(Debug)]
pub(crate) struct Records<'a> {
    words: &'a mut [u32],
    layout: &'a mut Layout,
}

impl<'a> Records<'a> {
    /// Takes up the words in the state in which a walk left them.
    pub(crate) fn new(words: &'a mut [u32], layout: &'a mut Layout) -> Self {
        Self { words, layout }
    }

    /// Empties the records, for a strip that is drawn directly.
    pub(crate) fn clear(&mut self) {
        self.begin_band(0);
    }

    fn get(&self, at: usize) -> u32 {
        self.words.get(at).copied().unwrap_or(0)
    }

    fn set(&mut self, at: usize, value: u32) {
        if let Some(word) = self.words.get_mut(at) {
            *word = value;
        }
    }

    /// Empties the records and starts empty lists for a number of strips.
    #[inline(never)]
    pub(crate) fn begin_band(&mut self, strips: usize) {
        *self.layout = Layout { front: strips, lists: strips, ..Layout::default() };
        match self.words.get_mut(..strips) {
            Some(lists) => clear_words(lists, NONE),
            None => self.layout.overflow = true,
        }
    }

    /// Returns true if something did not fit, so that the walk is in vain.
    pub(crate) fn overflowed(&self) -> bool {
        self.layout.overflow
    }

    /// Returns the number of free words.
    fn free(&self) -> usize {
        self.words.len().saturating_sub(self.layout.front + TRIANGLE * usize::from(self.layout.triangles))
    }

    /// Reserves words for the vertices of a draw, all unshaded. Returns `false` if there are too few.
    fn reserve(&mut self, vertices: usize, stride: usize) -> bool {
        let start = self.layout.front;
        let marks = if stride > VERTEX_WORDS { vertices.div_ceil(32) } else { 0 };
        // At most 2¹⁶ · 255, which `usize` may not hold.
        let needs = vertices.saturating_mul(stride).saturating_add(marks);
        if self.free() < needs {
            return false;
        }
        self.layout.marks = start;
        if let Some(marks) = self.words.get_mut(start..start + marks) {
            clear_words(marks, 0);
        }
        self.layout.vertices = start + marks;
        self.layout.count = vertices;
        self.layout.added = 0;
        self.layout.stride = stride;
        self.layout.front = start + needs;
        self.positions_mut().fill(PackedVertex::NONE.0);
        true
    }

    /// Starts recording a draw.
    pub(crate) fn begin_draw(&mut self, fingerprint: u32, vertices: usize, stride: usize) {
        let header = self.layout.front;
        if self.free() < HEADER {
            self.layout.overflow = true;
            return;
        }
        self.layout.header = header;
        self.layout.front = header + HEADER;
        if !self.reserve(vertices, stride) {
            self.layout.overflow = true;
            return;
        }
        self.set(header, fingerprint);
        self.set(header + 1, self.layout.vertices as u32);
    }

    /// Keeps the extent of the current draw at the end of its words.
    #[inline(never)]
    pub(crate) fn keep_extent(&mut self) {
        // Without vertices, there is nothing that asks for it.
        if self.layout.count == 0 {
            return;
        }
        if self.free() < EXTENT {
            self.layout.overflow = true;
            return;
        }
        // x is compared with the byte of z below it, which changes nothing above it.
        let (mut left, mut right, mut nearest) = (i32::MAX, i32::MIN, u32::from(u16::MAX));
        let mut widen = |[a, b]: [u32; 2]| {
            let x = a as i32;
            if x >= PackedVertex::LEAST_X {
                (left, right) = (left.min(x), right.max(x));
                nearest = nearest.min((a & 0xFF) << 8 | b & 0xFF);
            }
        };
        self.positions().iter().for_each(|words| widen(*words));
        let Layout { count, added, front, .. } = *self.layout;
        for index in count..count + usize::from(added) {
            let (position, _) = self.words_of(index);
            widen([self.get(position), self.get(position + 1)]);
        }
        // Whole pixels, the last one too. Columns that the screen does not have are of no use.
        let [left, right] = [left >> 16, (right >> 16) + 1].map(|c| c.clamp(0, 0xFFFF) as u32);
        self.set(front, left | right << 16);
        self.set(front + 1, nearest);
        self.layout.front = front + EXTENT;
    }

    /// Returns the extent of the draw that was found.
    pub(crate) fn extent(&self) -> Extent {
        let at = self.layout.front.wrapping_sub(EXTENT);
        let (columns, nearest) = (self.get(at), self.get(at.wrapping_add(1)));
        // Rows are not kept: the draw has triangles in the strip, which is a few blocks high at most.
        Extent {
            columns: (columns & 0xFFFF) as i32..(columns >> 16) as i32,
            rows: 0..i32::MAX,
            nearest: nearest as u16,
        }
    }

    /// Returns whether the draw that was found has triangles in this strip.
    pub(crate) fn has_triangles(&self) -> bool {
        u32::from(self.layout.next) < self.layout.last
    }

    /// Ends recording a draw.
    #[inline(never)]
    pub(crate) fn end_draw(&mut self) {
        self.set(self.layout.header + 2, u32::from(self.layout.triangles));
        self.set(self.layout.header + 3, self.layout.front as u32);
    }

    /// Lends all the words to the vertices of one draw that is drawn directly, if they fit.
    pub(crate) fn keep_vertices(&mut self, vertices: usize, stride: usize) {
        // Vertices begin at the end of the words: if `reserve` fails, all of them read as unshaded.
        *self.layout = Layout { vertices: self.words.len(), ..Layout::default() };
        self.reserve(vertices, stride);
    }

    /// Returns whether there is room for each vertex of the current draw.
    #[inline]
    pub(crate) fn keeps_vertices(&self) -> bool {
        self.layout.stride > 0
    }

    /// Returns the positions of all vertices of the current draw: words of [`PackedVertex`]s.
    #[inline]
    pub(crate) fn positions(&self) -> &[[u32; 2]] {
        let start = self.layout.vertices;
        let words = self.words.get(start..start + 2 * self.layout.count).unwrap_or_default();
        bytemuck::try_cast_slice(words).unwrap_or_default()
    }

    /// Returns the position of a vertex of the current draw.
    #[inline]
    pub(crate) fn packed_vertex(&self, index: usize) -> PackedVertex {
        self.positions().get(index).map_or(PackedVertex::NONE, |words| PackedVertex(*words))
    }

    /// Returns the positions of all vertices of the current draw, to be changed.
    pub(crate) fn positions_mut(&mut self) -> &mut [[u32; 2]] {
        let start = self.layout.vertices;
        let words = self.words.get_mut(start..start + VERTEX_WORDS * self.layout.count).unwrap_or_default();
        bytemuck::try_cast_slice_mut(words).unwrap_or_default()
    }

    /// Returns the first word of a vertex's position and the first word of its varyings.
    #[inline(never)]
    fn words_of(&self, index: usize) -> (usize, usize) {
        let Layout { vertices, count, stride, .. } = *self.layout;
        if index < count {
            (vertices + VERTEX_WORDS * index, vertices + VERTEX_WORDS * count + (stride - VERTEX_WORDS) * index)
        } else {
            let start = vertices + stride * index;
            (start, start + VERTEX_WORDS)
        }
    }

    /// Takes apart what the varyings of recorded triangles are computed from, for the triangles from a number on.
    pub(crate) fn unshaded(&mut self, first: u16) -> Option<Unshaded<'_>> {
        let (start, end) = (self.triangle_at(self.layout.triangles), self.triangle_at(first));
        let Layout { marks, vertices, count, stride, front, .. } = *self.layout;
        let (used, rest) = self.words.split_at_mut_checked(front)?;
        let range = start.wrapping_add(TRIANGLE).wrapping_sub(front)..end.wrapping_add(TRIANGLE).wrapping_sub(front);
        let triangles = rest.get(range)?;
        let words = used.get_mut(marks..vertices + count * stride)?;
        let (marks, words) = words.split_at_mut_checked(vertices - marks)?;
        Some(Unshaded { triangles, marks, varyings: words.get_mut(VERTEX_WORDS * count..)? })
    }

    /// Returns whether a vertex of the mesh has its varyings.
    pub(crate) fn has_varyings(&self, index: u16) -> bool {
        let word = self.layout.marks + usize::from(index >> 5);
        word < self.layout.vertices && self.get(word) >> (index & 31) & 1 != 0
    }

    /// Stores a vertex of the current draw, for whose vertices there is room.
    #[inline(never)]
    pub(crate) fn store_vertex<S: VertexShader>(&mut self, index: usize, packed: PackedVertex, varyings: &S::Varyings) {
        // A constant length: otherwise, copying would link `memcpy`.
        S::store(varyings, self.store_position(index, packed, S::WORDS).get_mut(..S::WORDS).unwrap_or_default());
    }

    /// Stores the position of a vertex, and returns the words from its varyings on, which the caller fills in.
    #[inline(never)]
    fn store_position(&mut self, index: usize, packed: PackedVertex, varyings: usize) -> &mut [u32] {
        let (position, rest) = self.words_of(index);
        let [a, b] = packed.0;
        self.set(position, a);
        self.set(position + 1, b);
        // Those that the clipper added are not asked for by their marks.
        let Layout { marks, vertices, .. } = *self.layout;
        if varyings > 0
            && let Some(mark) = self.words.get_mut(marks..vertices).and_then(|marks| marks.get_mut(index / 32))
        {
            *mark |= 1 << (index & 31);
        }
        self.words.get_mut(rest..).unwrap_or_default()
    }

    /// Returns the varyings of a vertex of the current draw.
    #[inline]
    pub(crate) fn varyings<S: VertexShader>(&self, index: u16) -> S::Varyings {
        if S::WORDS == 0 {
            return S::Varyings::ZERO;
        }
        let (_, rest) = self.words_of(index.into());
        S::load(self.words.get(rest..).and_then(|rest| rest.get(..S::WORDS)).unwrap_or_default())
    }

    /// Adds a vertex to the current draw, for a polygon that the clipper made. Returns its number.
    pub(crate) fn push_vertex(&mut self) -> u16 {
        let index = self.layout.count + usize::from(self.layout.added);
        if self.free() < self.layout.stride || index >= usize::from(u16::MAX) {
            self.layout.overflow = true;
            return 0;
        }
        self.layout.front += self.layout.stride;
        self.layout.added += 1;
        index as u16
    }

    /// Records a triangle whose topmost strip, in this band, is `strip`.
    pub(crate) fn push_triangle(&mut self, corners: [u16; 3], face: u32, strip: usize) {
        let mut triangles = self.triangles();
        let number = triangles.count;
        if triangles.push(corners, face) {
            triangles.append(strip, number);
        } else {
            triangles.overflow();
        }
        triangles.finish();
    }

    /// Takes the words apart into slices, for a pass over many triangles that adds no vertices.
    #[inline(never)]
    pub(crate) fn triangles(&mut self) -> Triangles<'_> {
        let Self { words, layout } = self;
        let (lists, vertices, positions, triangles) = split(words, layout).unwrap_or_default();
        Triangles { lists, vertices, positions, triangles, count: layout.triangles, layout }
    }

    /// Makes the words that recording has left a pool for the states of triangles.
    pub(crate) fn begin_carrying(&mut self) {
        self.layout.pool = StatePool::new(self.words.len().saturating_sub(self.layout.front));
    }

    /// Starts replaying a strip of the band.
    pub(crate) fn begin_replay(&mut self, strip: usize) {
        self.layout.strip = strip;
        let first = |strip| {
            let [first, _]: [u16; 2] = bytemuck::cast(self.get(strip));
            first
        };
        (self.layout.next, self.layout.after) = (first(strip), first(strip + 1));
        self.layout.moved = NONE;
        self.layout.front = self.layout.lists;
    }

    /// Finds the next recorded draw. Returns `false` if it is not the draw that was recorded.
    pub(crate) fn replay_draw(&mut self, fingerprint: u32, vertices: usize, stride: usize) -> bool {
        let header = self.layout.front;
        self.layout.header = header;
        self.layout.vertices = self.get(header + 1) as usize;
        self.layout.count = vertices;
        self.layout.stride = stride;
        self.layout.last = self.get(header + 2);
        self.layout.front = self.get(header + 3) as usize;
        self.get(header) == fingerprint
    }

    /// Returns true if the draw that was found has no vertices.
    pub(crate) fn is_draw_empty(&self) -> bool {
        self.layout.front == self.layout.vertices
    }

    /// Returns the number of recorded triangles.
    pub(crate) const fn triangle_count(&self) -> u16 {
        self.layout.triangles
    }

    /// Returns the words of the triangles from a number on, the newest first.
    #[inline]
    pub(crate) fn triangles_from(&mut self, first: u16) -> &mut [u32] {
        let end = self.triangle_at(first).wrapping_add(TRIANGLE);
        let start = self.triangle_at(self.layout.triangles).wrapping_add(TRIANGLE);
        self.words.get_mut(start..end).unwrap_or_default()
    }

    fn triangle_at(&self, number: u16) -> usize {
        self.words.len().wrapping_sub(TRIANGLE * usize::from(number) + TRIANGLE)
    }
}

/// The words of lists, of vertices, of vertices' positions and of triangles.
type Parts<'w> = (&'w mut [u32], &'w [u32], &'w [[u32; 2]], &'w mut [u32]);

/// Takes the words of records apart.
#[inline(always)]
fn split<'w>(words: &'w mut [u32], layout: &Layout) -> Option<Parts<'w>> {
    let (lists, rest) = words.split_at_mut_checked(layout.lists)?;
    let (used, rest) = rest.split_at_mut_checked(layout.front.wrapping_sub(layout.lists))?;
    let vertices: &[u32] = used.get(layout.vertices.wrapping_sub(layout.lists)..)?;
    let positions = bytemuck::try_cast_slice(vertices.get(..VERTEX_WORDS * layout.count)?).ok()?;
    // Numbers of triangles must stay below `NONE`, so room for more triangles is left out.
    let beyond = rest.len().saturating_sub(TRIANGLE.saturating_mul(usize::from(NONE)));
    Some((lists, vertices, positions, rest.get_mut(beyond..)?))
}
