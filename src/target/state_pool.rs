//! Places for the states of triangles, in words that the records have left. Places have one of four sizes; one that is
//! given back is the first of its size to be taken again.

use crate::span::{MOST_CARRIED, STATE_UNIT};

/// Number of sizes of places, which are the multiples of [`STATE_UNIT`].
const SIZES: usize = MOST_CARRIED / STATE_UNIT;

/// The place of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// Number of words from its beginning to the end of all, which is never 0.
    from_end: u32,
    /// One less than its size, in units.
    size: usize,
}

impl Place {
    /// Returns the place that a word tells.
    pub(super) const fn of_word(word: u32) -> Self {
        Self { from_end: word >> 2, size: word as usize & (SIZES - 1) }
    }

    /// Returns a word that tells the place. There are fewer than 2³⁰ words.
    pub(super) const fn word(self) -> u32 {
        self.from_end << 2 | self.size as u32
    }

    /// Returns the words at the place. All words may have been cut at their beginning.
    #[inline(always)]
    pub(super) fn words(self, all: &mut [u32]) -> Option<&mut [u32]> {
        let at = all.len().wrapping_sub(self.from_end as usize);
        all.get_mut(at..)?.get_mut(..STATE_UNIT * (self.size + 1))
    }
}

/// The places that are free: a part of the records' layout.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StatePool {
    /// The first word that was never taken, as [`Place`]s have it.
    front: u32,
    /// The first free place of each size; 0 if there is none. The first word of a free place tells the next one.
    free: [u32; SIZES],
}

impl StatePool {
    /// Makes a pool of free words, which begin so many words before the end of all.
    pub(super) const fn new(front: usize) -> Self {
        Self { front: front as u32, free: [0; SIZES] }
    }

    /// Takes a place for a number of words, a multiple of [`STATE_UNIT`], if there is one. The last `taken` words are
    /// not free.
    pub(super) fn take(&mut self, all: &mut [u32], taken: usize, words: usize) -> Option<Place> {
        let size = (words / STATE_UNIT).checked_sub(1)?;
        let free = self.free.get_mut(size)?;
        if *free != 0 {
            let place = Place { from_end: *free, size };
            *free = *place.words(all)?.first()?;
            return Some(place);
        }
        let front = self.front.min(all.len() as u32);
        if front < (taken + words) as u32 {
            return None;
        }
        self.front = front - words as u32;
        Some(Place { from_end: front, size })
    }

    /// Gives a place back.
    pub(super) fn give_back(&mut self, all: &mut [u32], place: Place) {
        if let (Some([word, ..]), Some(free)) = (place.words(all), self.free.get_mut(place.size)) {
            *word = core::mem::replace(free, place.from_end);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use std::vec;
    use std::vec::Vec;

    /// Places are taken and given back at random: no two of them share a word, none leaves the free words, and when all
    /// have been given back, as many can be taken as at first.
    #[test]
    fn places_are_apart() {
        let mut rng = Rng::new(1);
        for case in 0..200 {
            let (before, free, after) = (rng.below(50) as usize, rng.below(600) as usize, rng.below(50) as usize);
            let mut all = vec![0; before + free + after];
            let mut pool = StatePool::new(free + after);
            let mut taken: Vec<(Place, u32)> = Vec::new();
            for number in 1..300 {
                if rng.below(3) == 0 && !taken.is_empty() {
                    let (place, number) = taken.swap_remove(rng.below(taken.len() as u64) as usize);
                    assert!(place.words(&mut all).expect("words").iter().all(|word| *word == number), "case {case}");
                    pool.give_back(&mut all, place);
                } else if let Some(place) =
                    pool.take(&mut all, after, STATE_UNIT * (1 + rng.below(SIZES as u64) as usize))
                {
                    assert_eq!(Place::of_word(place.word()), place);
                    place.words(&mut all).expect("words").fill(number);
                    taken.push((place, number));
                }
            }
            for (place, number) in taken.drain(..) {
                assert!(place.words(&mut all).expect("words").iter().all(|word| *word == number), "case {case}");
                pool.give_back(&mut all, place);
            }
            assert!(all[..before].iter().chain(&all[before + free..]).all(|word| *word == 0), "case {case}");
        }
    }

    /// All places that fit can be taken, again and again. Words may be missing at the beginning.
    #[test]
    fn all_words_are_used() {
        for missing in [0, 5] {
            let mut all = vec![0; 10 * STATE_UNIT + 7 - missing];
            let mut pool = StatePool::new(10 * STATE_UNIT + 7);
            for _ in 0..3 {
                let places: Vec<_> = core::iter::from_fn(|| pool.take(&mut all, 7, STATE_UNIT)).collect();
                assert_eq!(places.len(), if missing > 0 { 9 } else { 10 });
                places.into_iter().for_each(|place| pool.give_back(&mut all, place));
            }
        }
        assert_eq!(StatePool::new(0).take(&mut [], 0, 0), None);
    }
}
