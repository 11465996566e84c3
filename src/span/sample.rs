//! The samples of a pixel as a shader sees them, and the coverage of samples by alpha.

/// A sample of a pixel: its number, and the number of samples that the pixel has.
///
/// # Format
/// The number of samples is in the lower 4 bits, and the sample's own number in the upper ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample(u8);

/// Order in which alpha covers a pixel's samples, if there are four: the first two lie opposite to each other. Two or
/// eight samples are covered in the order of their numbers, which spreads them as well.
const RANKS: [u8; 4] = [0, 2, 3, 1];

/// Offsets of the threshold at each of 2×2 pixels, in quarters of the step from one sample to the next one.
const STEPS: [[u8; 2]; 2] = [[0, 2], [3, 1]];

impl Sample {
    /// The only sample of a pixel.
    pub const ONLY: Self = Self::new(0, 1);

    /// Makes a sample of its number and the number of samples, which is 1, 2, 4 or 8.
    #[inline(always)]
    pub(crate) const fn new(number: usize, count: usize) -> Self {
        Self((number << 4 | count) as u8)
    }

    /// Returns the number of the sample: 0 to [`count`](Self::count) - 1.
    #[inline(always)]
    #[must_use]
    pub const fn number(self) -> usize {
        (self.0 >> 4) as usize
    }

    /// Returns the number of samples per pixel: 1, 2, 4 or 8.
    #[inline(always)]
    #[must_use]
    pub const fn count(self) -> usize {
        (self.0 & 15) as usize
    }

    /// Returns whether a fragment with an alpha, 255 = opaque, covers the sample. `position` is that of the pixel on
    /// the screen.
    ///
    /// No sample is covered at alpha 0, all are at 255, and a sample that is covered stays so as alpha grows. Steps
    /// between one sample and the next one are spread over 2×2 pixels: of all their samples, the part alpha / 255 is
    /// covered, rounded to the nearest number. A pixel with one sample is covered from alpha 128 on.
    ///
    /// ```
    /// use zstrip::span::Sample;
    /// assert!(!Sample::ONLY.is_covered(127, (3, 4)) && Sample::ONLY.is_covered(128, (3, 4)));
    /// ```
    #[inline]
    #[must_use]
    pub const fn is_covered(self, alpha: u8, (x, y): (i32, i32)) -> bool {
        let (number, count) = (self.number(), self.count() as u32);
        if count == 1 {
            return alpha >= 128;
        }
        let rank = if count == 4 { RANKS[number & 3] as u32 } else { number as u32 };
        // Thresholds are the odd multiples of 255 / (8 · count).
        let step = STEPS[(y & 1) as usize][(x & 1) as usize] as u32;
        alpha as u32 * 8 * count > 255 * (8 * rank + 2 * step + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alpha_covers_its_part_of_the_samples() {
        for count in [1, 2, 4, 8] {
            let covered = |alpha: u8, x: i32, y: i32| {
                (0..count).filter(|number| Sample::new(*number, count).is_covered(alpha, (x, y))).count()
            };
            for alpha in 0..=255 {
                let pixels = [(-2, 8), (-1, 8), (-2, 9), (-1, 9)].map(|(x, y)| covered(alpha, x, y));
                let all = pixels.iter().sum::<usize>() as i32;
                let exact = 4 * count as i32 * i32::from(alpha);
                // With one sample, all pixels are alike.
                let bound = if count == 1 { 2 * 255 } else { 128 };
                assert!((255 * all - exact).abs() <= bound, "alpha {alpha}, {count} samples: {pixels:?}");
                let [least, most] = [pixels.iter().min(), pixels.iter().max()];
                assert!(most <= least.map(|least| least + 1).as_ref(), "alpha {alpha}, {count} samples: {pixels:?}");
                if [0, 255].contains(&alpha) {
                    assert_eq!(pixels, [if alpha == 0 { 0 } else { count }; 4], "alpha {alpha}, {count} samples");
                }
            }
        }
    }

    #[test]
    fn a_covered_sample_stays_covered_as_alpha_grows() {
        for (count, k) in [1, 2, 4, 8].into_iter().flat_map(|count| (0..4 * count).map(move |k| (count, k))) {
            let (sample, position) = (Sample::new(k / 4, count), ((k % 2) as i32, (k / 2 % 2) as i32));
            assert_eq!((sample.number(), sample.count()), (k / 4, count));
            let steps = (1..=255).filter(|a| sample.is_covered(*a, position) != sample.is_covered(a - 1, position));
            assert_eq!(steps.count(), 1, "{sample:?} at {position:?}");
            assert!(!sample.is_covered(0, position), "{sample:?} at {position:?}");
        }
    }
}
