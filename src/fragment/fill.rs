//! Fills with one value, two or four pixels a word.

use crate::math::SMALL_CORE;
use bytemuck::Pod;

/// Pixels below which words do not pay.
const SHORT: usize = 16;

/// Sets all pixels to `value`: like `slice::fill`, which the compiler leaves a loop of single pixels.
#[inline]
pub fn fill<R: Pod>(pixels: &mut [R], value: R) {
    match size_of::<R>() {
        _ if pixels.len() < SHORT => pixels.fill(value),
        1 => fill_words(pixels, value, bytemuck::cast([value; 4].map(low_byte))),
        2 => fill_words(pixels, value, bytemuck::cast([value; 2].map(half_word))),
        _ => pixels.fill(value),
    }
}

/// [`fill`], out of line: for whole buffers.
#[inline(never)]
pub fn clear<R: Pod>(pixels: &mut [R], value: R) {
    fill(pixels, value);
}

/// Sets all words.
pub fn clear_words(words: &mut [u32], word: u32) {
    store(word, word, word, word, words);
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

#[inline]
fn fill_words<R: Pod>(pixels: &mut [R], value: R, word: u32) {
    let (head, words, tail) = bytemuck::pod_align_to_mut::<R, u32>(pixels);
    head.fill(value);
    store(word, word, word, word, words);
    tail.fill(value);
}

/// Stores a word, given four times, everywhere: four of them by one instruction.
///
/// Out of line: a compiler that sees how the words were made stores their halves one by one. It does not see either that
/// they are the same, and so keeps each in a register of its own.
#[inline(never)]
fn store(a: u32, b: u32, c: u32, d: u32, words: &mut [u32]) {
    if !SMALL_CORE {
        let block = [a, b, c, d, a, b, c, d, a, b, c, d, a, b, c, d];
        if let Some(last) = words.last_chunk_mut::<16>() {
            // At the end, where it overlaps others: no rest is left.
            *last = block;
            for words in words.chunks_exact_mut(16) {
                let Ok(words) = <&mut [u32; 16]>::try_from(words) else { return };
                *words = block;
            }
            return;
        }
    }
    let mut blocks = words.chunks_exact_mut(16);
    for block in &mut blocks {
        let Ok(block) = <&mut [u32; 16]>::try_from(block) else { return };
        *block = [a, b, c, d, a, b, c, d, a, b, c, d, a, b, c, d];
    }
    let mut blocks = blocks.into_remainder().chunks_exact_mut(4);
    for block in &mut blocks {
        let Ok(block) = <&mut [u32; 4]>::try_from(block) else { return };
        *block = [a, b, c, d];
    }
    for place in blocks.into_remainder() {
        *place = a;
    }
}

#[cfg(test)]
mod tests {
    use super::fill;

    #[test]
    fn every_length_and_alignment_is_filled_and_nothing_else() {
        for start in 0..5 {
            for end in start..90 {
                let mut halves = [1_u16; 100];
                fill(&mut halves[start..end], 0xABCD);
                assert!(
                    halves.iter().enumerate().all(|(k, v)| *v == if (start..end).contains(&k) { 0xABCD } else { 1 })
                );
                let mut bytes = [1_u8; 100];
                fill(&mut bytes[start..end], 7);
                assert!(bytes.iter().enumerate().all(|(k, v)| *v == if (start..end).contains(&k) { 7 } else { 1 }));
                let mut triples = [[1_u8; 3]; 100];
                fill(&mut triples[start..end], [7, 8, 9]);
                assert!(triples.iter().enumerate().all(|(k, v)| (*v == [7, 8, 9]) == (start..end).contains(&k)));
            }
        }
    }
}
