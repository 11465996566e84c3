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
//! record, however tall it is.

use crate::color::clear_words;
use crate::span::SmallResult;
use crate::vertex::{
    MAX_IN_REGISTERS, PackedCorners, PackedVertex, ScreenVertex, VERTEX_WORDS, Varyings, VertexShader,
};

/// Number that stands for no triangle.
const NONE: u16 = u16::MAX;
/// Words of a draw's header: fingerprint, first word of its vertices, number of its last triangle + 1, next header.
const HEADER: usize = 4;
/// Words of a triangle: two vertices; the third and the link; the word of its face.
const TRIANGLE: usize = 3;
/// Returns the words of records that a scene needs at most when nothing is clipped. `draws` is the number of draw
/// calls, `vertices` and `triangles` are those of all draws together, of triangles only the visible ones.
/// `varying_words` is the number of words of varyings per vertex
/// ([`VertexShader::WORDS`](crate::vertex::VertexShader::WORDS)).
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

/// A triangle from the records: the numbers of its vertices, and the word of its face. The highest vertex is the first.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TriangleRecord {
    pub(crate) corners: [u16; 3],
    pub(crate) face: u32,
}

/// The words of the records, and the layout that says which things lie where in them.
#[derive(Debug)]
pub(crate) struct Records<'a> {
    words: &'a mut [u32],
    layout: &'a mut Layout,
}

/// Joins two halves to a word. Which of them is the upper one does not matter, as long as [`halves`] agrees.
#[inline]
fn pair(halves: [u16; 2]) -> u32 {
    bytemuck::cast(halves)
}

/// Returns the numbers of a triangle's vertices, from the first two words of its record.
#[inline(always)]
fn corners_of(a: u32, b: u32) -> [u16; 3] {
    let [k, _]: [u16; 2] = bytemuck::cast(b);
    [a as u16, (a >> 16) as u16, k]
}

/// Returns the words of three vertices' [`PackedVertex`]s.
#[inline(always)]
pub(crate) fn positions_at(positions: &[[u32; 2]], [i, j, k]: [u16; 3]) -> [&[u32; 2]; 3] {
    let at = |index: u16| positions.get(usize::from(index)).unwrap_or(&PackedVertex::NONE_WORDS);
    [at(i), at(j), at(k)]
}

/// Returns the number of corners before the highest one, by the second words of their [`PackedVertex`]s.
#[inline(always)]
pub(crate) const fn turns([a, b, c]: [i32; 3]) -> u32 {
    if b < a {
        if c < b { 2 } else { 1 }
    } else if c < a {
        2
    } else {
        0
    }
}

/// The words of triangles whose vertices may have no varyings yet, their marks, and the words of all varyings.
pub(crate) struct Unshaded<'r> {
    triangles: &'r [u32],
    marks: &'r mut [u32],
    varyings: &'r mut [u32],
}

impl Unshaded<'_> {
    /// Hands each vertex that has no varyings yet to `store`, with their `words` words.
    #[inline(always)]
    pub(crate) fn each(self, words: usize, mut store: impl FnMut(usize, &mut [u32])) {
        let Self { mut triangles, marks, varyings } = self;
        while let Some(([a, b, _], rest)) = triangles.split_first_chunk() {
            triangles = rest;
            for index in corners_of(*a, *b) {
                let (index, bit) = (usize::from(index), 1 << (index & 31));
                let Some(mark) = marks.get_mut(index >> 5) else { continue };
                if *mark & bit == 0 {
                    *mark |= bit;
                    if let Some(words) = varyings.get_mut(words * index..).and_then(|rest| rest.get_mut(..words)) {
                        store(index, words);
                    }
                }
            }
        }
    }
}

/// Words that triangles are put into, from the end. They are in no strip's list yet.
#[derive(Debug)]
pub(crate) struct Room<'r> {
    words: &'r mut [u32],
}

impl Room<'_> {
    /// Puts in a triangle. Returns `false` if there is no room for it.
    #[inline(always)]
    pub(crate) fn push(&mut self, [i, j, k]: [u16; 3], face: u32) -> bool {
        // Fewer words than a triangle takes stay where they are.
        if self.words.len() < TRIANGLE {
            return false;
        }
        let Some((rest, triangle)) = core::mem::take(&mut self.words).split_last_chunk_mut() else { return false };
        *triangle = [u32::from(i) | u32::from(j) << 16, pair([k, NONE]), face];
        self.words = rest;
        true
    }

    /// Takes the words, and leaves none.
    #[inline(always)]
    pub(crate) fn take(&mut self) -> Self {
        Self { words: core::mem::take(&mut self.words) }
    }

    /// Returns the words that are left.
    #[inline(always)]
    pub(crate) const fn left(&self) -> usize {
        self.words.len()
    }
}

/// Returns the two halves of a word.
#[inline]
fn halves(word: &mut u32) -> &mut [u16; 2] {
    bytemuck::cast_mut(word)
}

/// The words of a draw, taken apart into slices for a pass over its triangles.
#[derive(Debug)]
pub(crate) struct Triangles<'r> {
    lists: &'r mut [u32],
    /// Words of all vertices of the draw. `positions` are the packed positions at its beginning, one for each vertex
    /// of the mesh.
    vertices: &'r [u32],
    positions: &'r [[u32; 2]],
    /// Words after the vertices, at most as many as triangles can take. Triangles fill them from the end.
    triangles: &'r mut [u32],
    /// Number of recorded triangles.
    count: u16,
    layout: &'r mut Layout,
}

impl<'r> Triangles<'r> {
    /// Takes the room for triangles that are not recorded yet, as [`Room`], and the positions of all vertices.
    #[inline(always)]
    pub(crate) fn room(&mut self) -> (Room<'_>, &'r [[u32; 2]]) {
        let taken = TRIANGLE * usize::from(self.count);
        let free = self.triangles.len().saturating_sub(taken);
        (Room { words: self.triangles.get_mut(..free).unwrap_or_default() }, self.positions)
    }

    /// Counts the triangles that were put into the [`room`](Self::room), of which so much is left. Returns how many
    /// these are.
    #[inline(always)]
    pub(crate) fn fill(&mut self, left: usize) -> u32 {
        let before = self.count;
        // A division by three that leaves nothing is a product modulo 2³²: 3 · 0xAAAA_AAAB = 2³³ + 1.
        self.count = (self.triangles.len().wrapping_sub(left) as u32).wrapping_mul(0xAAAA_AAAB) as u16;
        u32::from(self.count.wrapping_sub(before))
    }

    /// Puts in a triangle that is in no strip's list yet. Returns `false` if there is no room for it.
    #[inline(never)]
    pub(crate) fn push(&mut self, corners: [u16; 3], face: u32) -> bool {
        let (mut room, _) = self.room();
        let fits = room.push(corners, face);
        self.count += u16::from(fits);
        fits
    }

    /// Returns the number of recorded triangles.
    pub(crate) const fn count(&self) -> u16 {
        self.count
    }

    /// Notes that there was no room for a triangle.
    pub(crate) const fn overflow(&mut self) {
        self.layout.overflow = true;
    }

    /// Ends a pass that recorded triangles: stores their number.
    pub(crate) const fn finish(self) {
        self.layout.triangles = self.count;
    }

    /// Keeps those of the triangles recorded from `first` on for which `strip` returns a strip, and puts each into the
    /// list of this strip, the topmost one of the band that it touches, with its highest vertex first. `strip` is given
    /// the words of its vertices' [`PackedVertex`]s in this order.
    #[inline(always)]
    pub(crate) fn keep_each(&mut self, first: u16, mut strip: impl FnMut([&'r [u32; 2]; 3]) -> Option<usize>) {
        let mut kept = first;
        for number in first..self.count {
            let Some(&[a, b, face]) = self.triangles.get(self.triangle_at(number)..).and_then(<[u32]>::first_chunk)
            else {
                break;
            };
            let ([i, j, k], v) = self.highest_first(corners_of(a, b));
            let Some(strip) = strip(v) else { continue };
            if let Some(words) = self.triangles.get_mut(self.triangle_at(kept)..).and_then(<[u32]>::first_chunk_mut) {
                *words = [u32::from(i) | u32::from(j) << 16, pair([k, NONE]), face];
            }
            self.append(strip, kept);
            kept += 1;
        }
        self.count = kept;
    }

    /// Puts a triangle at the end of a strip's list.
    #[inline(always)]
    fn append(&mut self, strip: usize, number: u16) {
        let Some([first, end]) = self.lists.get_mut(strip).map(halves) else { return };
        let before = core::mem::replace(end, number);
        if before == NONE {
            *first = number;
        } else {
            self.link(before, number);
        }
    }

    /// Hands the triangles of the draw in this strip to `draw`, one after the other, with their vertices, until `draw`
    /// finds one that is large. Returns whether it did. The triangle is in `to` then.
    ///
    /// A triangle that reaches beyond `end`, see [`end_of`](Self::end_of), moves on to the next strip.
    #[inline(always)]
    pub(crate) fn replay_each(
        &mut self,
        end: i32,
        to: &mut TriangleRecord,
        mut draw: impl FnMut(&Self, &TriangleRecord, [&[u32; 2]; 3]) -> SmallResult,
    ) -> bool {
        loop {
            let number = self.layout.next;
            if u32::from(number) >= self.layout.last {
                return false;
            }
            let Some([a, b, face, ..]) = self.triangles.get(self.triangle_at(number)..) else { return false };
            let [_, next]: [u16; 2] = bytemuck::cast(*b);
            *to = TriangleRecord { corners: corners_of(*a, *b), face: *face };
            self.layout.next = next;
            let v = self.positions_of(to.corners);
            // The first vertex is not below the others.
            if (end - (v[1][1] as i32 >> 8)) | (end - (v[2][1] as i32 >> 8)) < 0 {
                self.move_on(number);
            }
            if draw(self, to, v) == SmallResult::Large {
                return true;
            }
        }
    }

    /// Starts with the first triangle that waits to be drawn at once.
    pub(crate) const fn begin_waiting(&mut self) {
        self.layout.next = 0;
    }

    /// Takes all triangles out of the records.
    pub(crate) const fn clear(self) {
        self.layout.triangles = 0;
    }

    /// Hands the triangles that wait to be drawn at once to `draw`, as [`replay_each`](Self::replay_each) does, with
    /// their highest vertices first. Counts those that are not drawn because they are empty, or outside.
    #[inline(always)]
    pub(crate) fn waiting_each(
        &mut self,
        to: &mut TriangleRecord,
        [empty, outside]: &mut [u32; 2],
        mut draw: impl FnMut(&Self, &TriangleRecord, [&[u32; 2]; 3]) -> SmallResult,
    ) -> bool {
        loop {
            let number = self.layout.next;
            if number >= self.count {
                return false;
            }
            let Some([a, b, face, ..]) = self.triangles.get(self.triangle_at(number)..) else { return false };
            let (corners, face) = (corners_of(*a, *b), *face);
            self.layout.next = number + 1;
            let (corners, v) = self.highest_first(corners);
            *to = TriangleRecord { corners, face };
            match draw(self, to, v) {
                SmallResult::Drawn => {}
                SmallResult::Empty => *empty += 1,
                SmallResult::Outside => *outside += 1,
                SmallResult::Large => return true,
            }
        }
    }

    /// Finds the vertices of a triangle of the mesh, and turns them so that the highest one is the first.
    #[inline(always)]
    fn highest_first(&self, [i, j, k]: [u16; 3]) -> ([u16; 3], [&'r [u32; 2]; 3]) {
        let [a, b, c] = positions_at(self.positions, [i, j, k]);
        match turns([a[1] as i32, b[1] as i32, c[1] as i32]) {
            0 => ([i, j, k], [a, b, c]),
            1 => ([j, k, i], [b, c, a]),
            _ => ([k, i, j], [c, a, b]),
        }
    }

    /// Reads the vertices of a triangle.
    #[inline(never)]
    pub(crate) fn vertices_of(&self, triangle: &TriangleRecord, to: &mut [ScreenVertex; 3]) {
        for (to, index) in to.iter_mut().zip(triangle.corners) {
            *to = PackedVertex(*self.position(index)).screen();
        }
    }

    /// Returns the words of three vertices' [`PackedVertex`]s.
    pub(crate) fn positions_of(&self, corners: [u16; 3]) -> [&'r [u32; 2]; 3] {
        let [i, j, k] = corners;
        [self.position(i), self.position(j), self.position(k)]
    }

    /// Returns the words of a vertex's [`PackedVertex`].
    #[inline(always)]
    fn position(&self, index: u16) -> &'r [u32; 2] {
        match self.positions.get(usize::from(index)) {
            Some(words) => words,
            None => self.added(index),
        }
    }

    /// Returns the largest y that vertices of a triangle can have if the triangle ends above `row`.
    pub(crate) const fn end_of(row: i32) -> i32 {
        // The first pixel whose centre is at or after a coordinate is (coordinate + 127) / 256.
        row * 256 + 128
    }

    /// Returns the position of a vertex that the clipper added.
    #[inline(never)]
    fn added(&self, index: u16) -> &'r [u32; 2] {
        let words = self.vertices.get(self.layout.stride * usize::from(index)..);
        words.and_then(|words| words.first_chunk()).unwrap_or(&PackedVertex::NONE.0)
    }

    /// Reads the varyings of a vertex of the draw.
    #[inline(always)]
    pub(crate) fn varyings<S: VertexShader>(&self, index: u16, to: &mut S::Varyings) {
        if S::Varyings::LEN > MAX_IN_REGISTERS {
            self.varyings_outlined::<S>(index, to);
        } else if S::WORDS > 0 {
            *to = self.load::<S>(index);
        }
    }

    /// Reads many varyings out of line: they lie on the stack until they are put together, and this function's frame
    /// is gone when the triangle is drawn.
    #[inline(never)]
    fn varyings_outlined<S: VertexShader>(&self, index: u16, to: &mut S::Varyings) {
        *to = self.load::<S>(index);
    }

    #[inline(always)]
    fn load<S: VertexShader>(&self, index: u16) -> S::Varyings {
        let (index, count) = (usize::from(index), self.positions.len());
        let at = if index < count {
            VERTEX_WORDS * count + S::WORDS * index
        } else {
            (S::WORDS + VERTEX_WORDS) * index + VERTEX_WORDS
        };
        S::load(self.vertices.get(at..).and_then(|rest| rest.get(..S::WORDS)).unwrap_or_default())
    }

    /// Returns the packed varyings of a triangle's corners.
    #[inline(always)]
    pub(crate) fn packed_corners<S: VertexShader>(&self, corners: [u16; 3]) -> PackedCorners<'r> {
        let ([i, j, k], count) = (corners, self.positions.len());
        let varyings = self.vertices.get(VERTEX_WORDS * count..(VERTEX_WORDS + S::WORDS) * count).unwrap_or_default();
        PackedCorners { varyings, vertices: self.vertices, corners: [i, j, k] }
    }

    #[inline(always)]
    fn triangle_at(&self, number: u16) -> usize {
        self.triangles.len().wrapping_sub(TRIANGLE * usize::from(number) + TRIANGLE)
    }

    #[inline(always)]
    fn link(&mut self, from: u16, to: u16) {
        let at = self.triangles.len().wrapping_sub(TRIANGLE * usize::from(from) + TRIANGLE - 1);
        if let Some([_, link]) = self.triangles.get_mut(at).map(halves) {
            *link = to;
        }
    }

    fn linked(&self, from: u16) -> u16 {
        let [_, link] =
            self.triangles.get(self.triangle_at(from).wrapping_add(1)).map_or([NONE; 2], |word| bytemuck::cast(*word));
        link
    }

    /// Moves a triangle of this strip on to the next strip's list, and keeps that list in drawing order.
    ///
    /// Triangles are moved in ascending order, so the search goes on from the place where the last one was put: a
    /// merge of two lists.
    #[inline(never)]
    fn move_on(&mut self, number: u16) {
        let strip = self.layout.strip + 1;
        if strip >= self.lists.len() {
            return;
        }
        let (mut before, mut after) = (self.layout.moved, self.layout.after);
        while after < number {
            before = after;
            after = self.linked(after);
        }
        self.layout.after = after;
        self.link(number, after);
        if before != NONE {
            self.link(before, number);
        } else if let Some([first, _]) = self.lists.get_mut(strip).map(halves) {
            *first = number;
        }
        self.layout.moved = number;
    }
}

/// Positions of things in the words; kept by the frame from one walk over the scene to the next.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Layout {
    /// First free word.
    front: usize,
    /// Number of recorded triangles.
    triangles: u16,
    /// The current draw: position of its header, and of its vertices; number of vertices of the mesh, and of those
    /// that the clipper added; words per vertex.
    header: usize,
    /// First word of the marks of the current draw's vertices: a bit is set if the vertex has its varyings.
    marks: usize,
    vertices: usize,
    count: usize,
    added: u16,
    stride: usize,
    overflow: bool,
    /// Replay: number of the strip; one more than the last triangle of the draw;
    /// the next triangle; the last triangle that was moved on; and the triangle after
    /// that one in the next strip's list.
    strip: usize,
    last: u32,
    next: u16,
    moved: u16,
    after: u16,
    /// First word after the lists of the strips.
    lists: usize,
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
    pub(crate) fn unshaded(&mut self, first: u16) -> Unshaded<'_> {
        let (start, end) = (self.triangle_at(self.layout.triangles), self.triangle_at(first));
        let Layout { marks, vertices, count, stride, front, .. } = *self.layout;
        let (used, rest) = self.words.split_at_mut_checked(front).unwrap_or_default();
        let range = start.wrapping_add(TRIANGLE).wrapping_sub(front)..end.wrapping_add(TRIANGLE).wrapping_sub(front);
        let triangles = rest.get(range).unwrap_or_default();
        let words = used.get_mut(marks..vertices + count * stride).unwrap_or_default();
        let (marks, words) = words.split_at_mut_checked(vertices - marks).unwrap_or_default();
        Unshaded { triangles, marks, varyings: words.get_mut(VERTEX_WORDS * count..).unwrap_or_default() }
    }

    /// Returns whether a vertex of the mesh has its varyings.
    pub(crate) fn has_varyings(&self, index: u16) -> bool {
        let word = self.layout.marks + usize::from(index >> 5);
        word < self.layout.vertices && self.get(word) >> (index & 31) & 1 != 0
    }

    /// Stores a vertex of the current draw, for whose vertices there is room.
    #[inline(never)]
    pub(crate) fn store_vertex<S: VertexShader>(&mut self, index: usize, packed: PackedVertex, varyings: &S::Varyings) {
        let (position, rest) = self.words_of(index);
        let [a, b] = packed.0;
        self.set(position, a);
        self.set(position + 1, b);
        S::store(varyings, self.words.get_mut(rest..).and_then(|rest| rest.get_mut(..S::WORDS)).unwrap_or_default());
        // Those that the clipper added are not asked for by their marks.
        let Layout { marks, vertices, .. } = *self.layout;
        if S::WORDS > 0
            && let Some(mark) = self.words.get_mut(marks..vertices).and_then(|marks| marks.get_mut(index / 32))
        {
            *mark |= 1 << (index & 31);
        }
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
        let (lists, rest) = words.split_at_mut_checked(layout.lists).unwrap_or_default();
        let (used, rest) = rest.split_at_mut_checked(layout.front.wrapping_sub(layout.lists)).unwrap_or_default();
        let vertices: &[u32] = used.get(layout.vertices.wrapping_sub(layout.lists)..).unwrap_or_default();
        let positions = vertices.get(..VERTEX_WORDS * layout.count).unwrap_or_default();
        // Numbers of triangles must stay below `NONE`, so room for more triangles is left out.
        let beyond = rest.len().saturating_sub(TRIANGLE.saturating_mul(usize::from(NONE)));
        Triangles {
            lists,
            vertices,
            positions: bytemuck::try_cast_slice(positions).unwrap_or_default(),
            triangles: rest.get_mut(beyond..).unwrap_or_default(),
            count: layout.triangles,
            layout,
        }
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
