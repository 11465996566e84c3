//! Fills of pixels with one value.
//!
//! The plain loop:
//!
//! ```text
//! for each pixel:
//!     pixel = value
//! ```
//! The departures from it, with what each gained on a Cortex-M0+ and a Cortex-M4 when it was made. Gains are
//! instructions per pixel of W1, a quad that fills the screen.
//!
//! 1. **Whole words** of two or four pixels are stored, four words at a time and out of line: W1 2.5 → 2.0 and 2.8 →
//!    1.3.
//! 2. **One instruction stores four words**, from registers with ascending numbers: W1 1.85 → 1.78 and 1.24 → 1.17,
//!    clearing 1.39 → 0.89 and 0.88 → 0.63 per pixel.
//! 3. **Values are handed over as arguments**, which are in such registers from the start. On larger cores eight words
//!    are stored at a time, and an overlapping first store takes the place of a tail: W1 1.53 → 1.34 and 0.96 → 0.82.
//! 4. **Small cores store five words at a time** in whole buffers. Four words suit rows, whose widths are often
//!    multiples of four words; a whole buffer is one long stretch.

use crate::math::SMALL_CORE;
use bytemuck::Pod;

/// Least number of half words for which stores of whole words pay: 17 half words hold 8 whole words, wherever they
/// begin.
const SHORT: usize = 17;

/// Sets all pixels to `value`. Does as `slice::fill`, which the compiler would leave a loop over single pixels.
#[inline]
pub fn fill<R: Pod>(pixels: &mut [R], value: R) {
    match size_of::<R>() {
        1 if pixels.len() > 2 * SHORT => {
            let (head, halves, tail) = bytemuck::pod_align_to_mut::<R, u16>(pixels);
            head.fill(value);
            fill_halves(halves, bytemuck::cast([value; 4].map(low_byte)));
            tail.fill(value);
        }
        2 if pixels.len() >= SHORT => match bytemuck::try_cast_slice_mut(pixels) {
            Ok(halves) => fill_halves(halves, bytemuck::cast([value; 2].map(half_word))),
            Err(_) => pixels.fill(value),
        },
        _ => pixels.fill(value),
    }
}

/// Sets all pixels of a whole buffer to `value`, out of line.
#[inline(never)]
pub fn clear<R: Pod>(pixels: &mut [R], value: R) {
    if SMALL_CORE && size_of::<R>() == 2 {
        for part in pixels.chunks_mut(LONGEST) {
            clear_by_fives(part, value);
        }
    } else {
        fill(pixels, value);
    }
}

/// Most pixels of two bytes that are cleared by fives at once: 65,535 words.
const LONGEST: usize = 131_070;

/// Does as [`clear`] on small cores, five words at a time.
#[inline(always)]
fn clear_by_fives<R: Pod>(pixels: &mut [R], value: R) {
    let [first, ..] = &mut *pixels else { return };
    *first = value;
    let (_, words, _) = bytemuck::pod_align_to_mut::<R, u32>(pixels);
    // A fifth of the number of words, rounded down. That is exact up to 65,535 words, 256 KB.
    let fives = ((words.len() & 0xFFFF) * 0xCCCD) >> 18;
    let Some(words) = words.get_mut(..5 * fives) else { return };
    let Ok(blocks) = bytemuck::try_cast_slice_mut(words) else { return };
    let word = bytemuck::cast([value; 2].map(half_word));
    by_fives(word, word, word, word, blocks);
    for pixel in pixels.get_mut(10 * fives..).unwrap_or_default() {
        *pixel = value;
    }
}

/// Sets both half words of all words to `half`.
pub fn clear_words(words: &mut [u32], half: u16) {
    clear(bytemuck::cast_slice_mut::<u32, u16>(words), half);
}

fn low_byte<R: Pod>(value: R) -> u8 {
    bytemuck::bytes_of(&value).first().copied().unwrap_or(0)
}

fn half_word<R: Pod>(value: R) -> u16 {
    match bytemuck::bytes_of(&value) {
        [a, b] => u16::from_ne_bytes([*a, *b]),
        _ => 0,
    }
}

/// Sets at least [`SHORT`] half words; `word` holds the value twice.
#[inline(always)]
fn fill_halves(halves: &mut [u16], word: u32) {
    if SMALL_CORE { by_fours(word, word, word, halves) } else { by_eights(word, word, word, word, halves) }
}

/// Stores the value of `a`, `b` and `c`, which are equal, four words at a time.
///
/// Out of line, because a compiler that sees how the word was made stores its halves one by one. And because it cannot
/// see that the arguments are equal, it keeps each in a register of its own. One instruction stores four registers if
/// their numbers ascend: arguments come first, and in order.
#[inline(never)]
fn by_fours(a: u32, b: u32, c: u32, halves: &mut [u16]) {
    let [first, .., last] = &mut *halves else { return };
    (*first, *last) = (a as u16, a as u16);
    let (_, words, _) = bytemuck::pod_align_to_mut::<u16, u32>(halves);
    let block = [a, b, c, a | b];
    let Some((blocks, rest)) = words.split_at_mut_checked(words.len() & !3) else { return };
    let Ok(blocks) = bytemuck::try_cast_slice_mut::<u32, [u32; 4]>(blocks) else { return };
    for place in blocks {
        *place = block;
    }
    for place in rest {
        *place = a;
    }
}

/// Does as [`by_fours`] with five words at a time, for long stretches.
#[inline(never)]
fn by_fives(a: u32, b: u32, c: u32, d: u32, blocks: &mut [[u32; 5]]) {
    let block = [a, b, c, d, a | b];
    for place in blocks {
        *place = block;
    }
}

/// Does as [`by_fours`] with eight words at a time, for larger cores. The first store overlaps the second one, so that
/// no words are left over at the end.
#[inline(never)]
fn by_eights(a: u32, b: u32, c: u32, d: u32, halves: &mut [u16]) {
    let [first, .., last] = &mut *halves else { return };
    (*first, *last) = (a as u16, a as u16);
    let (_, words, _) = bytemuck::pod_align_to_mut::<u16, u32>(halves);
    let block = [a, b, c, d, a | b, a | c, a | d, b | c];
    let Some(place) = words.first_chunk_mut() else { return };
    *place = block;
    let Some(words) = words.get_mut(words.len() & 7..) else { return };
    let Ok(blocks) = bytemuck::try_cast_slice_mut::<u32, [u32; 8]>(words) else { return };
    for place in blocks {
        *place = block;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_length_and_alignment_is_filled_and_nothing_else() {
        for start in 0..5 {
            for end in start..90 {
                let inside = |k| (start..end).contains(&k);
                let is_filled =
                    |halves: &[u16]| halves.iter().enumerate().all(|(k, v)| *v == if inside(k) { 0xABCD } else { 1 });
                let mut halves = [1_u16; 100];
                fill(&mut halves[start..end], 0xABCD);
                assert!(is_filled(&halves), "{start}..{end}");
                if end - start >= SHORT {
                    // The routine of the other kind of core is tested as well.
                    let mut halves = [1_u16; 100];
                    let word = 0xABCD_ABCD;
                    by_fours(word, word, word, &mut halves[start..end]);
                    assert!(is_filled(&halves), "{start}..{end}");
                    let mut halves = [1_u16; 100];
                    by_eights(word, word, word, word, &mut halves[start..end]);
                    assert!(is_filled(&halves), "{start}..{end}");
                }
                let mut halves = [1_u16; 100];
                clear_by_fives(&mut halves[start..end], 0xABCD);
                assert!(is_filled(&halves), "{start}..{end}");
                let mut bytes = [1_u8; 100];
                fill(&mut bytes[start..end], 7);
                assert!(bytes.iter().enumerate().all(|(k, v)| *v == if inside(k) { 7 } else { 1 }));
                let mut triples = [[1_u8; 3]; 100];
                fill(&mut triples[start..end], [7, 8, 9]);
                assert!(triples.iter().enumerate().all(|(k, v)| (*v == [7, 8, 9]) == inside(k)));
                let mut words = [1_u32; 100];
                clear_words(&mut words[start..end], 0xABCD);
                assert!(words.iter().enumerate().all(|(k, v)| *v == if inside(k) { 0xABCD_ABCD } else { 1 }));
            }
        }
    }

    #[test]
    fn long_buffers_are_cleared_to_the_end() {
        for length in [LONGEST - 1, LONGEST, LONGEST + 1, LONGEST + 2, 2 * LONGEST, 2 * LONGEST + 13] {
            for start in [0, 1] {
                let mut halves = std::vec![1_u16; length + 2];
                clear(&mut halves[start..start + length], 0xABCD);
                let is_right = |(k, v): (usize, &u16)| (*v == 0xABCD) == (start..start + length).contains(&k);
                assert!(halves.iter().enumerate().all(is_right), "{length} half words from {start} on");
            }
        }
    }
}
