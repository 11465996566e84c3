//! Several samples of a pixel → the pixel.
//!
//! The plain loop:
//!
//! ```text
//! for each pixel: pixel = mean of its samples
//! ```
//! The departures from it:
//!
//! 1. **Pixels whose samples are equal stay as they are.** Most lie inside of triangles.
//! 2. **Eight pixels are compared at a time**, as words, with all of their further samples before one branch.
//! 3. **In eight pixels that differ, each is compared again.** Most of them are equal, and a mean takes longer.

use super::format::PixelFormat;
use super::mean::{MeanOfCodes, PixelSum};
use bytemuck::bytes_of;

/// Pixels that are compared at a time.
const GROUP: usize = 8;

/// Makes each pixel the mean of its samples. `pixels` has sample 0 of each, and `samples` the others, one sample after
/// the other: `FURTHER` of them, which are 1, 3 or 7. Channels are rounded to nearest.
#[inline(never)]
pub(crate) fn resolve<P: PixelFormat, const FURTHER: usize>(pixels: &mut [P::Raw], samples: &[P::Raw]) {
    let length = pixels.len();
    let sample = |number: usize| samples.get(number.wrapping_mul(length)..).and_then(|rest| rest.get(..length));
    let sample = |number: usize| sample(number).unwrap_or_default();
    let whole = length - length % GROUP;
    let groups = |number: usize| in_groups(sample(number).get(..whole).unwrap_or_default());
    for number in whole..length {
        let Some(pixel) = pixels.get_mut(number) else { return };
        let (mut own, mut further) = ([*pixel; GROUP], [[*pixel; GROUP]; FURTHER]);
        for (k, other) in further.iter_mut().enumerate() {
            *other = [sample(k).get(number).copied().unwrap_or(*pixel); GROUP];
        }
        means::<P, FURTHER>(&mut own, further.each_ref());
        [*pixel, ..] = own;
    }
    let Some(pixels) = pixels.get_mut(..whole).and_then(|pixels| bytemuck::try_cast_slice_mut(pixels).ok()) else {
        return;
    };
    // One counter for all of them: their lengths are compared once.
    let all = pixels.iter_mut().zip(groups(0));
    match FURTHER {
        1 => all.for_each(|(own, a)| group::<P, 1>(own, [a])),
        3 => all.zip(groups(1)).zip(groups(2)).for_each(|(((own, a), b), c)| group::<P, 3>(own, [a, b, c])),
        _ => all
            .zip(groups(1))
            .zip(groups(2))
            .zip(groups(3))
            .zip(groups(4))
            .zip(groups(5))
            .zip(groups(6))
            .for_each(|(((((((own, a), b), c), d), e), f), g)| group::<P, 7>(own, [a, b, c, d, e, f, g])),
    }
}

/// Returns pixels in groups. Their number is a multiple of a group's.
fn in_groups<R: bytemuck::Pod>(pixels: &[R]) -> &[[R; GROUP]] {
    bytemuck::try_cast_slice(pixels).unwrap_or_default()
}

/// Makes the pixels of a group the means of their samples.
#[inline(always)]
fn group<P: PixelFormat, const FURTHER: usize>(own: &mut [P::Raw; GROUP], further: [&[P::Raw; GROUP]; FURTHER]) {
    if !are_equal(own, &further) {
        means::<P, FURTHER>(own, further);
    }
}

/// Returns whether pixels are equal to all of the others, word by word if they are words.
#[inline(always)]
fn are_equal<R: bytemuck::Pod, const FURTHER: usize>(own: &[R; GROUP], further: &[&[R; GROUP]; FURTHER]) -> bool {
    fn words<R: bytemuck::Pod>(pixels: &[R; GROUP]) -> Option<&[u32; 4]> {
        bytemuck::try_from_bytes(bytes_of(pixels)).ok()
    }
    let mut difference = 0;
    for other in further {
        match (words(own), words(other)) {
            (Some([a, b, c, d]), Some([e, f, g, h])) => difference |= (a ^ e) | (b ^ f) | (c ^ g) | (d ^ h),
            _ if bytes_of(own) == bytes_of(*other) => {}
            _ => return false,
        }
    }
    difference == 0
}

/// Makes the pixels of a group the means of their samples, one by one, where these differ.
#[inline(never)]
fn means<P: PixelFormat, const FURTHER: usize>(own: &mut [P::Raw; GROUP], further: [&[P::Raw; GROUP]; FURTHER]) {
    // Unrolled by hand: at `opt-level = "s"`, a loop over samples would go through an array on the stack.
    macro_rules! means {
        ($($sample:ident)*) => {
            if let [$($sample),*] = further[..] {
                for number in 0..GROUP {
                    let own = &mut own[number];
                    let ($($sample,)*) = ($($sample[number],)*);
                    if $(bytes_of(&$sample) == bytes_of(own))&&* {
                        continue;
                    }
                    let mut sum = PixelSum::<P, MeanOfCodes>::new();
                    sum.add(*own);
                    $(sum.add($sample);)*
                    *own = sum.mean(FURTHER as u32 + 1);
                }
            }
        };
    }
    means!(a);
    means!(a b c);
    means!(a b c d e f g);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use core::fmt::Debug;
    use embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888};
    use std::vec::Vec;

    /// Compares pixels with the means of their samples, one by one.
    fn compare<P: PixelFormat<Raw: PartialEq + Debug>, const FURTHER: usize>(seed: u64) {
        let mut rng = Rng::new(seed);
        let mut differ = 0;
        for case in 0..600 {
            let length = case % 61;
            let mut random = || P::pack([(); 3].map(|()| rng.below(256) as u8));
            let mut pixels: Vec<P::Raw> = (0..length).map(|_| random()).collect();
            let colors = [random(), random()];
            let mut samples: Vec<P::Raw> = (0..FURTHER).flat_map(|_| pixels.clone()).collect();
            for sample in &mut samples {
                if rng.one_in([2, 10, 200][case % 3]) {
                    *sample = rng.pick(&colors);
                }
            }
            let mean = |number: usize| {
                let mut sum = PixelSum::<P, MeanOfCodes>::new();
                sum.add(pixels[number]);
                (0..FURTHER).for_each(|sample| sum.add(samples[sample * length + number]));
                sum.mean(FURTHER as u32 + 1)
            };
            let expected: Vec<P::Raw> = (0..length).map(mean).collect();
            differ += expected.iter().zip(&pixels).filter(|(a, b)| a != b).count();
            resolve::<P, FURTHER>(&mut pixels, &samples);
            assert_eq!(pixels, expected, "seed {seed}, case {case}, {FURTHER} further samples");
        }
        assert!(differ > 3000, "{differ} pixels differ from sample 0");
    }

    #[test]
    fn pixels_are_the_means_of_their_samples() {
        compare::<Rgb565, 1>(1);
        compare::<Rgb565, 3>(2);
        compare::<Rgb565, 7>(3);
        compare::<Gray8, 3>(4);
        compare::<Rgb888, 7>(5);
    }
}
