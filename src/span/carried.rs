//! Small triangles that go on in the next strip: their edges, their depth and the state of their brush, in words that
//! the records have left. The next strip has nothing to set up again.
//!
//! ```text
//! word   31 .. 16   15 .. 0
//! 0      bend       rows        rows to the bend, where one side gets another edge, negative below it; rows to the
//!                               end, and bit 15 if the bend is on the right
//! 1      vertex     column      number of the third vertex, for the records; the first column
//! 2, 3   left edge              see `ShortEdge`
//! 4, 5   right edge
//! 6, 7   the edge from the bend on
//! 8      depth                  at the first column of the next row, 16.16, with the half that rounds
//! 9, 10  changes of depth       to the right, and down
//! 11     face                   word of the face, for the records
//! 12 ..  brush                  see `BrushRows::save`
//! ```
//! All of this is modulo 2³², or exact, so that a row is the same whether its state was carried there or set up there.

use crate::raster::ShortEdge;
use crate::vertex::Varyings;

/// Words of a triangle's state without its brush.
pub(crate) const CARRIED: usize = 12;
/// Words of a state are a multiple of this.
pub(crate) const STATE_UNIT: usize = 12;
/// Most words of a state.
pub(crate) const MOST_CARRIED: usize = 4 * STATE_UNIT;

/// The state that a triangle has left for the next strip.
pub struct LeftState {
    pub(crate) words: [u32; MOST_CARRIED],
    /// Number of words that it takes; 0 if there is none.
    pub(crate) length: usize,
}

impl LeftState {
    /// No state.
    pub(crate) const NONE: Self = Self { words: [0; MOST_CARRIED], length: 0 };
}

/// Bit of word 0 that is set if the bend is on the right.
const RIGHT: u32 = 1 << 15;

/// Joins two numbers of 16 bits to a word.
#[inline(always)]
const fn pair(low: i32, high: i32) -> u32 {
    (low & 0xFFFF | high << 16) as u32
}

/// A triangle at a row.
pub(crate) struct TriangleAtRow {
    /// The corners on the left and on the right, relative to the highest one, x and y of each, 24.8.
    pub(crate) sides: [i32; 4],
    /// The highest corner, relative to the first column.
    pub(crate) x: i32,
    /// Height of the row's centres below the highest corner.
    pub(crate) p: i32,
    /// The first column.
    pub(crate) column: i32,
    /// The edges on the left and on the right.
    pub(crate) edges: [ShortEdge; 2],
    /// Depth at the first column, and its changes.
    pub(crate) depth: u32,
    pub(crate) dz: (i32, i32),
}

impl TriangleAtRow {
    /// Puts the triangle into words, `down` rows further down. It has rows left there.
    ///
    /// # Format
    /// Columns are below 2¹³, and rows below 2⁵: all halves of words fit.
    #[inline(never)]
    pub(crate) fn store(&self, down: i32, words: &mut [u32; CARRIED]) {
        let Self { sides: [bx, by, cx, cy], x, p, column, edges: [left, right], depth, dz } = *self;
        let p = p + 256 * down;
        let (mut left, mut right) = (left.below(down as u32), right.below(down as u32));
        // Rows from here to a height below the highest corner.
        let rows = |y: i32| (y + 255 - p) >> 8;
        let is_right = cy < by;
        let (ax, ay, dx, dy) = if is_right { (cx, cy, bx - cx, by - cy) } else { (bx, by, cx - bx, cy - by) };
        let mut bend = rows(ay).max(0);
        let second = ShortEdge::outlined(x + ax, dx, dy, p + 256 * bend - ay);
        if bend == 0 {
            *if is_right { &mut right } else { &mut left } = second;
            bend = -1;
        }
        let [counts, first, l, l_step, r, r_step, s, s_step, z, dz_dx, dz_dy, _] = words;
        *counts = pair(rows(by.max(cy)), bend) | if is_right { RIGHT } else { 0 };
        *first = pair(column, 0);
        (*l, *l_step, *r, *r_step) = (left.x, left.step, right.x, right.step);
        (*s, *s_step) = (second.x, second.step);
        (*z, *dz_dx, *dz_dy) = (depth.wrapping_add_signed(dz.1.wrapping_mul(down)), dz.0 as u32, dz.1 as u32);
    }
}

/// Returns the words that a brush of any shader takes: two, and a number of sets of varyings; `None` if that are too
/// many.
pub(crate) const fn words_of<V: Varyings>(sets: usize) -> Option<usize> {
    let words = 2 + sets * V::LEN;
    if CARRIED + words <= MOST_CARRIED { Some(words) } else { None }
}

/// Puts sets of varyings into words.
pub(crate) fn save_varyings<V: Varyings, const N: usize>(sets: [&V; N], words: &mut [u32]) {
    let values = sets.into_iter().flat_map(|set| set.as_ref());
    for (word, value) in words.iter_mut().zip(values) {
        *word = *value as u32;
    }
}

/// Reads sets of varyings from words.
pub(crate) fn load_varyings<V: Varyings, const N: usize>(sets: [&mut V; N], words: &[u32]) {
    let values = sets.into_iter().flat_map(|set| set.as_mut());
    for (word, value) in words.iter().zip(values) {
        *value = *word as i32;
    }
}

/// Returns whether a state has rows left.
#[inline(always)]
pub(crate) fn goes_on(state: &[u32]) -> bool {
    state.first().is_some_and(|counts| *counts & (RIGHT - 1) != 0)
}

/// Returns the face's word in a state.
#[inline(always)]
pub(crate) fn face_of(state: &[u32]) -> u32 {
    state.get(CARRIED - 1).copied().unwrap_or(0)
}

/// Takes up to `most` rows off a state, and returns how many.
#[inline(always)]
pub(crate) const fn take_rows(words: &mut [u32; CARRIED], most: i32) -> i32 {
    let rows = (words[0] & (RIGHT - 1)) as i32;
    let rows = if rows < most { rows } else { most };
    words[0] = words[0].wrapping_sub(rows as u32);
    rows
}

/// Counts a row on the way to the bend.
#[inline(always)]
pub(crate) const fn count_row(words: &mut [u32; CARRIED]) {
    words[0] = words[0].wrapping_sub(1 << 16);
}

/// Returns the edge that begins at the next row, if this is the first one below the bend, and whether it is on the
/// right.
#[inline(always)]
pub(crate) const fn edge_from_bend(words: &[u32; CARRIED]) -> Option<(ShortEdge, bool)> {
    if words[0] >> 16 == 0 { Some((ShortEdge { x: words[6], step: words[7] }, words[0] & RIGHT != 0)) } else { None }
}

/// Returns the edges on the left and on the right, and the depth at the first column of the next row.
#[inline(always)]
pub(crate) const fn edges_and_depth(words: &[u32; CARRIED]) -> (ShortEdge, ShortEdge, u32) {
    (ShortEdge { x: words[2], step: words[3] }, ShortEdge { x: words[4], step: words[5] }, words[8])
}

/// Sets what [`edges_and_depth`] returns.
#[inline(always)]
pub(crate) const fn set_edges_and_depth(words: &mut [u32; CARRIED], left: ShortEdge, right: ShortEdge, depth: u32) {
    let [_, _, l, l_step, r, r_step, _, _, z, ..] = words;
    (*l, *l_step, *r, *r_step, *z) = (left.x, left.step, right.x, right.step, depth);
}

/// Returns the first column of a triangle, and the changes of its depth.
#[inline(always)]
pub(crate) const fn column_and_slopes(words: &[u32; CARRIED]) -> (i32, i32, i32) {
    (words[1] as i16 as i32, words[9] as i32, words[10] as i32)
}
