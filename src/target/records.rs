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
//! A draw's vertices are the positions of all of them, two words each, and then the varyings of all of them. Vertices
//! that the clipper adds come after these, each with its position and its varyings together.
//!
//! The word of a strip in `lists` holds the first and the last of its triangles, which are linked through their
//! records in drawing order. A triangle is in one list at a time. It is recorded into the list of the topmost strip
//! it touches; when that strip is done with it, it moves on to the list of the next strip. So a triangle is one
//! record, however tall it is.

use crate::color::clear_words;
use crate::vertex::{MAX_IN_REGISTERS, Projected, ScreenVertex, Varyings, VertexShader};

/// Number that stands for no triangle.
const NONE: u16 = u16::MAX;
/// Words of a draw's header: fingerprint, first word of its vertices, number of its last triangle + 1, next header.
const HEADER: usize = 4;
/// Words of a triangle: two vertices; the third and the link; the word of its face.
const TRIANGLE: usize = 3;
/// Words of a vertex beside its varyings.
pub(crate) const VERTEX_WORDS: usize = 2;

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
    let vertices = VERTEX_WORDS.saturating_add(varying_words).saturating_mul(vertices);
    strips
        .saturating_add(HEADER.saturating_mul(draws))
        .saturating_add(vertices)
        .saturating_add(TRIANGLE.saturating_mul(triangles))
}

/// A recorded position of a vertex, in two words: x in the upper 24 bits of the first, y in those of the second;
/// below x the high byte of z, below y the low byte.
///
/// A vertex that is not on the screen has an x that no vertex on the screen has. The low byte of that word is its
/// outcode, or a mark that it is not shaded yet: [`UNSHADED`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PackedVertex([u32; 2]);

const OFF_SCREEN: u32 = 0x8000_0000;
const UNSHADED: u32 = OFF_SCREEN | 0x80;

impl PackedVertex {
    /// Packs a vertex on the screen, or one that has to be clipped and so cannot be projected.
    #[inline]
    pub(crate) const fn new(placed: &Projected) -> Self {
        match placed {
            Projected::OnScreen(v) => {
                Self([(v.x as u32) << 8 | (v.z >> 8) as u32, (v.y as u32) << 8 | (v.z & 0xFF) as u32])
            }
            Projected::NeedsClip(code) => Self([OFF_SCREEN | code.0 as u32, 0]),
        }
    }

    /// A vertex that is not shaded yet.
    pub(crate) const NONE: Self = Self([UNSHADED, 0]);

    /// x that [`screen`](Self::screen) returns for a vertex that is not on the screen.
    pub(crate) const OFF_SCREEN_X: i32 = OFF_SCREEN as i32 >> 8;

    /// Makes a packed vertex of its words, which are taken as signed.
    #[inline]
    pub(crate) const fn signed([a, b]: [i32; 2]) -> Self {
        Self([a as u32, b as u32])
    }

    /// Makes a packed vertex of its words.
    #[cfg(test)]
    pub(crate) const fn from_words(words: [u32; 2]) -> Self {
        Self(words)
    }

    #[inline]
    pub(crate) const fn is_unshaded(self) -> bool {
        self.0[0] == UNSHADED
    }

    #[inline]
    pub(crate) const fn is_on_screen(self) -> bool {
        self.0[0] >> 8 != OFF_SCREEN >> 8
    }

    /// Returns the outcode of a vertex that is not on the screen, 0 for one that is.
    pub(crate) const fn outcode(self) -> u8 {
        if self.is_on_screen() { 0 } else { self.0[0] as u8 }
    }

    /// Returns the two words.
    #[inline]
    pub(crate) const fn words(self) -> [u32; 2] {
        self.0
    }

    /// Limit of first words, taken as signed: a first word below it belongs to a vertex that is not on the screen.
    /// The second word of a vertex on the screen begins with its y.
    pub(crate) const LEAST_X: i32 = (OFF_SCREEN as i32) + 0x100;

    /// Returns the position of a vertex on the screen.
    #[inline]
    pub(crate) const fn screen(self) -> ScreenVertex {
        let [a, b] = self.0;
        ScreenVertex::new(a as i32 >> 8, b as i32 >> 8, ((a & 0xFF) << 8 | (b & 0xFF)) as u16)
    }
}

/// A triangle from the records.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TriangleRecord {
    pub(crate) v: [ScreenVertex; 3],
    /// Numbers of the first two corners, the second in the upper half; `last` is the third.
    corners: u32,
    last: u16,
    pub(crate) face: u32,
}

impl TriangleRecord {
    /// Returns the numbers of its vertices.
    #[inline]
    pub(crate) const fn corners(&self) -> [u16; 3] {
        [self.corners as u16, (self.corners >> 16) as u16, self.last]
    }
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

/// Returns the two halves of a word.
#[inline]
fn halves(word: &mut u32) -> &mut [u16; 2] {
    bytemuck::cast_mut(word)
}

#[inline]
fn signed([a, b]: &[u32; 2]) -> [i32; 2] {
    [*a as i32, *b as i32]
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

impl Triangles<'_> {
    /// Returns the words of three vertices' [`PackedVertex`]s, as signed numbers.
    #[inline(always)]
    pub(crate) fn positions_of(&self, [i, j, k]: [u16; 3]) -> [[i32; 2]; 3] {
        let place = |index: u16| signed(self.positions.get(usize::from(index)).unwrap_or(&PackedVertex::NONE.0));
        [place(i), place(j), place(k)]
    }

    /// Returns the vertex numbers of a triangle in a list without indices, and the words of their [`PackedVertex`]s.
    #[inline(always)]
    pub(crate) fn in_a_row(&self, number: usize) -> ([u16; 3], [[i32; 2]; 3]) {
        let first = 3 * number;
        let positions = match self.positions.get(first..) {
            Some([a, b, c, ..]) => [signed(a), signed(b), signed(c)],
            _ => [signed(&PackedVertex::NONE.0); 3],
        };
        ([first as u16, (first + 1) as u16, (first + 2) as u16], positions)
    }

    /// Returns the number of recorded triangles.
    pub(crate) const fn count(&self) -> u16 {
        self.count
    }

    /// Makes [`push`](Self::push) return `false` from here on.
    pub(crate) fn leave_no_room(&mut self) {
        self.triangles = &mut [];
    }

    /// Notes that there was no room for a triangle.
    pub(crate) const fn overflow(&mut self) {
        self.layout.overflow = true;
    }

    /// Ends a pass that recorded triangles: stores their number.
    pub(crate) const fn finish(self) {
        self.layout.triangles = self.count;
    }

    /// Records a triangle whose topmost strip, in this band, is `strip`. `corners` has the numbers of its first two
    /// corners. Returns `false` if there was no room.
    #[inline(always)]
    pub(crate) fn push(&mut self, corners: u32, last: u16, face: u32, strip: usize) -> bool {
        let behind = TRIANGLE * usize::from(self.count) + TRIANGLE;
        let Some(at) = self.triangles.len().checked_sub(behind) else { return false };
        let Some([a, b, c, ..]) = self.triangles.get_mut(at..) else { return false };
        let number = self.count;
        (*a, *b, *c) = (corners, pair([last, NONE]), face);
        self.count += 1;
        let Some([first, end]) = self.lists.get_mut(strip).map(halves) else { return true };
        let before = core::mem::replace(end, number);
        if before == NONE {
            *first = number;
        } else {
            self.link(before, number);
        }
        true
    }

    /// Reads the next triangle of the draw in this strip; returns `false` if there is none with a number below
    /// `last`. A triangle that reaches beyond `end`, see [`end_of`](Self::end_of), moves on to the next strip.
    #[inline(always)]
    pub(crate) fn replay(&mut self, last: u32, end: i32, to: &mut TriangleRecord) -> bool {
        let number = self.layout.next;
        if u32::from(number) >= last {
            return false;
        }
        let Some([a, b, face, ..]) = self.triangles.get(self.triangle_at(number)..) else { return false };
        let [last, next]: [u16; 2] = bytemuck::cast(*b);
        (to.corners, to.last, to.face) = (*a, last, *face);
        self.layout.next = next;
        let [i, j, k] = to.corners();
        let screen = |index: u16| match self.positions.get(usize::from(index)) {
            Some(words) => PackedVertex(*words).screen(),
            None => self.added(index).screen(),
        };
        // Vertices are read one by one, so that few values are in registers at once.
        let [a, b, c] = &mut to.v;
        *a = screen(i);
        let mut above = end - a.y;
        *b = screen(j);
        above |= end - b.y;
        *c = screen(k);
        above |= end - c.y;
        if above < 0 {
            self.move_on(number);
        }
        true
    }

    /// Returns the largest y that vertices of a triangle can have if the triangle ends above `row`.
    pub(crate) const fn end_of(row: i32) -> i32 {
        // The first pixel whose centre is at or after a coordinate is (coordinate + 127) / 256.
        row * 256 + 128
    }

    /// Returns the position of a vertex that the clipper added.
    #[inline(never)]
    fn added(&self, index: u16) -> PackedVertex {
        match self.vertices.get(self.layout.stride * usize::from(index)..) {
            Some([a, b, ..]) => PackedVertex([*a, *b]),
            _ => PackedVertex::NONE,
        }
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
    vertices: usize,
    count: usize,
    added: u16,
    stride: usize,
    overflow: bool,
    /// Replay: number of the strip; its next triangle; the last triangle that was moved on; and the triangle after
    /// that one in the next strip's list.
    strip: usize,
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
        *self.layout = Layout::default();
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
        // At most 2¹⁶ · 255, which `usize` may not hold.
        let needs = vertices.saturating_mul(stride);
        if self.free() < needs {
            return false;
        }
        self.layout.vertices = start;
        self.layout.count = vertices;
        self.layout.added = 0;
        self.layout.stride = stride;
        self.layout.front = start + needs;
        let (positions, _) = self.vertices_mut();
        positions.fill(PackedVertex::NONE.0);
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

    /// Returns the positions of all vertices, and the words of their varyings.
    pub(crate) fn vertices_mut(&mut self) -> (&mut [[u32; 2]], &mut [u32]) {
        let start = self.layout.vertices;
        let words = self.words.get_mut(start..start + self.layout.count * self.layout.stride).unwrap_or_default();
        let Some((positions, varyings)) = words.split_at_mut_checked(2 * self.layout.count) else {
            return Default::default();
        };
        (bytemuck::try_cast_slice_mut(positions).unwrap_or_default(), varyings)
    }

    /// Returns the first word of a vertex's position and the first word of its varyings.
    #[inline]
    fn words_of(&self, index: usize) -> (usize, usize) {
        let Layout { vertices, count, stride, .. } = *self.layout;
        if index < count {
            (vertices + VERTEX_WORDS * index, vertices + VERTEX_WORDS * count + (stride - VERTEX_WORDS) * index)
        } else {
            let start = vertices + stride * index;
            (start, start + VERTEX_WORDS)
        }
    }

    /// Stores a vertex of the current draw, for whose vertices there is room.
    #[inline]
    pub(crate) fn store_vertex<S: VertexShader>(&mut self, index: usize, packed: PackedVertex, varyings: &S::Varyings) {
        let (position, rest) = self.words_of(index);
        let [a, b] = packed.0;
        self.set(position, a);
        self.set(position + 1, b);
        S::store(varyings, self.words.get_mut(rest..).and_then(|rest| rest.get_mut(..S::WORDS)).unwrap_or_default());
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
    pub(crate) fn push_triangle(&mut self, [i, j, k]: [u16; 3], face: u32, strip: usize) {
        let mut triangles = self.parts();
        if !triangles.push(u32::from(i) | u32::from(j) << 16, k, face, strip) {
            triangles.overflow();
        }
        triangles.finish();
    }

    /// Takes the words apart into slices, for a pass over many triangles that adds no vertices.
    #[inline(never)]
    pub(crate) fn triangles(&mut self) -> Triangles<'_> {
        self.parts()
    }

    #[inline(always)]
    fn parts(&mut self) -> Triangles<'_> {
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

    /// Returns one more than the number of the last triangle of the draw that was found.
    #[inline(never)]
    pub(crate) fn last_triangle(&self) -> u32 {
        self.get(self.layout.header + 2)
    }
}
