//! Triangles whose state is carried on from strip to strip. The record of such a triangle has the place of the state in
//! the word of its face, and `NONE` for its third vertex; both are kept in the state.

use super::layout::{NONE, TRIANGLE};
use super::state_pool::Place;
use super::triangles::{DrawTriangles, TriangleRecord, Triangles, halves};
use crate::span::{CARRIED, STATE_UNIT};

impl Triangles<'_> {
    /// Keeps the state of a triangle for the next strip, if there is one and room for it.
    #[inline(never)]
    pub(super) fn keep(&mut self, number: u16, triangle: &TriangleRecord, state: &[u32]) {
        let [_, _, k] = triangle.corners;
        let taken = TRIANGLE * usize::from(self.count);
        let Some(place) = self.layout.pool.take(self.triangles, taken, state.len()) else { return };
        let Some(words) = place.words(self.triangles) else { return };
        for (words, state) in words.chunks_exact_mut(STATE_UNIT).zip(state.chunks_exact(STATE_UNIT)) {
            // Arrays: a copy of slices would link `memcpy`.
            if let (Some(words), Some(state)) = (words.first_chunk_mut::<STATE_UNIT>(), state.first_chunk()) {
                *words = *state;
            }
        }
        if let Some([_, third, .., face]) = words.first_chunk_mut::<CARRIED>() {
            (*third, *face) = (*third & 0xFFFF | u32::from(k) << 16, triangle.face);
        }
        self.set_third(number, NONE, place.word());
    }

    /// Goes on with a triangle whose state was kept, and returns whether it goes on in the next strip again. If `draw`
    /// cannot go on with it, the record becomes that of an ordinary triangle: `None`.
    #[inline(always)]
    pub(super) fn go_on(
        &mut self,
        number: u16,
        triangle: &mut TriangleRecord,
        draw: &mut impl DrawTriangles,
    ) -> Option<bool> {
        let goes_on = draw.go_on(Place::of_word(triangle.face).words(self.triangles)?);
        if goes_on != Some(true) {
            self.give_back(number, triangle);
        }
        goes_on
    }

    /// Gives back the place of a state, and makes the record that of an ordinary triangle again.
    #[inline(never)]
    pub(super) fn give_back(&mut self, number: u16, triangle: &mut TriangleRecord) {
        let place = Place::of_word(triangle.face);
        if let Some([_, third, .., face]) =
            place.words(self.triangles).and_then(|words| words.first_chunk_mut::<CARRIED>())
        {
            (triangle.corners[2], triangle.face) = ((*third >> 16) as u16, *face);
        }
        self.layout.pool.give_back(self.triangles, place);
        self.set_third(number, triangle.corners[2], triangle.face);
    }

    /// Sets the third vertex and the last word of a record.
    fn set_third(&mut self, number: u16, k: u16, word: u32) {
        let at = self.triangle_at(number);
        if let Some([_, b, last]) = self.triangles.get_mut(at..).and_then(<[u32]>::first_chunk_mut) {
            let [third, _] = halves(b);
            (*third, *last) = (k, word);
        }
    }
}
