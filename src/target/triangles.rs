//! A draw's triangles in the [`Records`](super::records::Records), taken apart for passes over many of them: they are
//! put in, placed into the lists of strips, and handed out to be drawn.

use super::layout::{Layout, NONE, TRIANGLE};
use crate::math::SMALL_CORE;
use crate::span::SmallResult;
use crate::vertex::{
    MAX_IN_REGISTERS, PackedCorners, PackedVertex, ScreenVertex, VERTEX_WORDS, Varyings, VertexShader,
};

/// A triangle from the records: the numbers of its vertices, and the word of its face. The highest vertex is the first.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TriangleRecord {
    pub(crate) corners: [u16; 3],
    pub(crate) face: u32,
}

/// Joins two halves to a word. Which of them is the upper one does not matter, as long as [`halves`] agrees.
#[inline]
fn pair(halves: [u16; 2]) -> u32 {
    bytemuck::cast(halves)
}

/// Returns the words of a triangle that is in no strip's list.
#[inline(always)]
pub(crate) fn triangle_words([i, j, k]: [u16; 3], face: u32) -> [u32; TRIANGLE] {
    [u32::from(i) | u32::from(j) << 16, pair([k, NONE]), face]
}

/// Returns the numbers of a triangle's vertices, from the first two words of its record.
#[inline(always)]
pub(crate) fn corners_of(a: u32, b: u32) -> [u16; 3] {
    let [k, _]: [u16; 2] = bytemuck::cast(b);
    [a as u16, (a >> 16) as u16, k]
}

/// Returns a third of a multiple of three: a product modulo 2³², as 3 · 0xAAAA_AAAB = 2³³ + 1.
#[inline(always)]
pub(crate) const fn third(length: usize) -> usize {
    (length as u32).wrapping_mul(0xAAAA_AAAB) as usize
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
    pub(super) triangles: &'r [u32],
    pub(super) marks: &'r mut [u32],
    pub(super) varyings: &'r mut [u32],
}

impl Unshaded<'_> {
    /// Hands each vertex that has no varyings yet to `store`, with the words of all varyings.
    #[inline(always)]
    pub(crate) fn each(self, mut store: impl FnMut(usize, &mut [u32])) {
        let Self { mut triangles, marks, varyings } = self;
        while let Some(([a, b, _], rest)) = triangles.split_first_chunk() {
            triangles = rest;
            let mut visit = |index: u16| {
                let (index, bit) = (usize::from(index), 1 << (index & 31));
                let Some(mark) = marks.get_mut(index >> 5) else { return };
                if *mark & bit == 0 {
                    *mark |= bit;
                    store(index, varyings);
                }
            };
            let [i, j, k] = corners_of(*a, *b);
            if SMALL_CORE {
                [i, j, k].into_iter().for_each(visit);
            } else {
                visit(i);
                visit(j);
                visit(k);
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
    pub(crate) fn push(&mut self, corners: [u16; 3], face: u32) -> bool {
        // Fewer words than a triangle takes stay where they are.
        if self.words.len() < TRIANGLE {
            return false;
        }
        let Some((rest, triangle)) = core::mem::take(&mut self.words).split_last_chunk_mut() else { return false };
        *triangle = triangle_words(corners, face);
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
pub(super) fn halves(word: &mut u32) -> &mut [u16; 2] {
    bytemuck::cast_mut(word)
}

/// Draws the triangles that it is handed.
pub(crate) trait DrawTriangles {
    /// Set if the state of triangles may be carried on from strip to strip.
    const CARRIES: bool;

    /// Draws a triangle with these vertices, if it is small.
    fn draw(&mut self, triangles: &Triangles<'_>, record: &TriangleRecord, v: [&[u32; 2]; 3]) -> SmallResult;

    /// Returns the state that the last triangle has left for the next strip, once.
    fn take_state(&mut self) -> &[u32];

    /// Goes on with a triangle from the strip above. Returns whether it goes on in the next one; `None` if that is not
    /// possible here.
    fn go_on(&mut self, state: &mut [u32]) -> Option<bool>;
}

/// The words of a draw, taken apart into slices for a pass over its triangles.
#[derive(Debug)]
pub(crate) struct Triangles<'r> {
    pub(super) lists: &'r mut [u32],
    /// Words of all vertices of the draw. `positions` are the packed positions at its beginning, one for each vertex
    /// of the mesh.
    pub(super) vertices: &'r [u32],
    pub(super) positions: &'r [[u32; 2]],
    /// Words after the vertices, at most as many as triangles can take. Triangles fill them from the end.
    pub(super) triangles: &'r mut [u32],
    /// Number of recorded triangles.
    pub(super) count: u16,
    pub(super) layout: &'r mut Layout,
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
        self.count = third(self.triangles.len().wrapping_sub(left)) as u16;
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
            let (corners, v) = self.highest_first(corners_of(a, b));
            let Some(strip) = strip(v) else { continue };
            if let Some(words) = self.triangles.get_mut(self.triangle_at(kept)..).and_then(<[u32]>::first_chunk_mut) {
                *words = triangle_words(corners, face);
            }
            self.append(strip, kept);
            kept += 1;
        }
        self.count = kept;
    }

    /// Puts a triangle at the end of a strip's list.
    #[inline(always)]
    pub(super) fn append(&mut self, strip: usize, number: u16) {
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
    pub(crate) fn replay_each<T: DrawTriangles>(&mut self, end: i32, to: &mut TriangleRecord, draw: &mut T) -> bool {
        loop {
            let number = self.layout.next;
            if u32::from(number) >= self.layout.last {
                return false;
            }
            let Some([a, b, face, ..]) = self.triangles.get(self.triangle_at(number)..) else { return false };
            let [k, next]: [u16; 2] = bytemuck::cast(*b);
            *to = TriangleRecord { corners: corners_of(*a, *b), face: *face };
            self.layout.next = next;
            if T::CARRIES
                && k == NONE
                && let Some(goes_on) = self.go_on(number, to, draw)
            {
                if goes_on {
                    self.move_on(number);
                }
                continue;
            }
            let v = self.positions_inlined(to.corners);
            // The first vertex is not below the others.
            let moves_on = (end - (v[1][1] as i32 >> 8)) | (end - (v[2][1] as i32 >> 8)) < 0;
            if moves_on {
                self.move_on(number);
            }
            if draw.draw(self, to, v) == SmallResult::Large {
                return true;
            }
            if T::CARRIES && moves_on {
                self.keep(number, to, draw.take_state());
            }
        }
    }

    /// Leaves out the triangles of the draw in this strip. Those that reach beyond `end` move on to the next strip, as
    /// [`replay_each`](Self::replay_each) makes them.
    #[inline(never)]
    pub(crate) fn skip_each<const CARRIES: bool>(&mut self, end: i32) {
        loop {
            let number = self.layout.next;
            if u32::from(number) >= self.layout.last {
                return;
            }
            let Some([a, b, face, ..]) = self.triangles.get(self.triangle_at(number)..) else { return };
            let [k, next]: [u16; 2] = bytemuck::cast(*b);
            let mut record = TriangleRecord { corners: corners_of(*a, *b), face: *face };
            self.layout.next = next;
            if CARRIES && k == NONE {
                // The next strip sets it up again.
                self.give_back(number, &mut record);
            }
            let [_, b, c] = self.positions_of(record.corners);
            if (end - (b[1] as i32 >> 8)) | (end - (c[1] as i32 >> 8)) < 0 {
                self.move_on(number);
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
        draw: &mut impl DrawTriangles,
    ) -> bool {
        let waiting = self.triangle_at(self.count).wrapping_add(TRIANGLE)
            ..self.triangle_at(self.layout.next).wrapping_add(TRIANGLE);
        let mut words: &[u32] = self.triangles.get(waiting).unwrap_or_default();
        while let Some((rest, [a, b, face])) = words.split_last_chunk() {
            words = rest;
            let (corners, v) = self.highest_first(corners_of(*a, *b));
            *to = TriangleRecord { corners, face: *face };
            match draw.draw(self, to, v) {
                SmallResult::Drawn => {}
                SmallResult::Empty => *empty += 1,
                SmallResult::Outside => *outside += 1,
                SmallResult::Large => {
                    let left = third(words.len());
                    self.layout.next = self.count - left as u16;
                    return true;
                }
            }
        }
        false
    }

    /// Finds the vertices of a triangle of the mesh, and turns them so that the highest one is the first.
    #[inline(always)]
    fn highest_first(&self, [i, j, k]: [u16; 3]) -> ([u16; 3], [&'r [u32; 2]; 3]) {
        let at = |index: u16| self.positions.get(usize::from(index));
        let (Some(a), Some(b), Some(c)) = (at(i), at(j), at(k)) else {
            return ([i, j, k], [&PackedVertex::NONE_WORDS; 3]);
        };
        let [y, y_b, y_c] = [a[1] as i32, b[1] as i32, c[1] as i32];
        if y_b < y {
            if y_b <= y_c {
                return ([j, k, i], [b, c, a]);
            }
        } else if y <= y_c {
            return ([i, j, k], [a, b, c]);
        }
        ([k, i, j], [c, a, b])
    }

    /// Reads the vertices of a triangle.
    #[inline(never)]
    pub(crate) fn vertices_of(&self, triangle: &TriangleRecord, to: &mut [ScreenVertex; 3]) {
        for (to, index) in to.iter_mut().zip(triangle.corners) {
            *to = PackedVertex(*self.position(index)).screen();
        }
    }

    /// Returns the words of three vertices' [`PackedVertex`]s, out of line.
    #[inline(never)]
    pub(crate) fn positions_of(&self, corners: [u16; 3]) -> [&'r [u32; 2]; 3] {
        self.positions_inlined(corners)
    }

    /// Returns the words of three vertices' [`PackedVertex`]s.
    #[inline(always)]
    fn positions_inlined(&self, corners: [u16; 3]) -> [&'r [u32; 2]; 3] {
        let [i, j, k] = corners;
        let at = |index: u16| self.positions.get(usize::from(index));
        match (at(i), at(j), at(k)) {
            (Some(a), Some(b), Some(c)) => [a, b, c],
            _ => [self.position(i), self.position(j), self.position(k)],
        }
    }

    /// Returns the words of a vertex's [`PackedVertex`], which the clipper may have added.
    #[inline(never)]
    fn position(&self, index: u16) -> &'r [u32; 2] {
        if let Some(words) = self.positions.get(usize::from(index)) {
            return words;
        }
        let words = self.vertices.get(self.layout.stride * usize::from(index)..);
        words.and_then(|words| words.first_chunk()).unwrap_or(&PackedVertex::NONE.0)
    }

    /// Returns the largest y that vertices of a triangle can have if the triangle ends above `row`.
    pub(crate) const fn end_of(row: i32, samples: usize) -> i32 {
        // The largest coordinate at which the range of `sampled` ends there.
        row * 256 + if samples == 1 { 128 } else { 16 }
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
    pub(super) fn triangle_at(&self, number: u16) -> usize {
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
