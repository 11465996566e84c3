//! Places of the samples of a pixel.
//!
//! A sample is covered by a triangle where the pixel's centre is covered by that triangle, moved so that the sample
//! comes to lie on the centre. So each sample of a picture is an ordinary picture of moved triangles: coverage and
//! depth at samples need no rules of their own.

use core::ops::Range;

/// Moves, in 1/256 px to the right and down, that bring each sample to the centre of its pixel.
pub type Moves = &'static [(i32, i32)];

/// Returns the move of a sample at a place in its pixel, 1/16 px from the top left corner.
const fn to_centre((x, y): (i32, i32)) -> (i32, i32) {
    (128 - 16 * x, 128 - 16 * y)
}

static ONE: [(i32, i32); 1] = [(0, 0)];
static TWO: [(i32, i32); 2] = [to_centre((12, 12)), to_centre((4, 4))];
static FOUR: [(i32, i32); 4] = [to_centre((6, 2)), to_centre((14, 6)), to_centre((2, 10)), to_centre((10, 14))];
static EIGHT: [(i32, i32); 8] = [
    to_centre((9, 5)),
    to_centre((7, 11)),
    to_centre((13, 9)),
    to_centre((5, 3)),
    to_centre((3, 13)),
    to_centre((1, 7)),
    to_centre((11, 15)),
    to_centre((15, 1)),
];

/// Returns the moves of the samples of a pixel: those at the standard places of Direct3D and Vulkan for 2, 4 and 8
/// samples. Any other number has the centre as its only sample.
pub const fn moves(samples: usize) -> Moves {
    match samples {
        2 => &TWO,
        4 => &FOUR,
        8 => &EIGHT,
        _ => &ONE,
    }
}

/// Returns the first pixel whose centre is at or after a 24.8 coordinate.
#[inline]
pub const fn first_centre(coordinate: i32) -> i32 {
    (coordinate + 127) >> 8
}

/// Returns the columns, or rows, between two coordinates in 24.8 that have a centre there or, with several samples, may
/// have a sample there: no sample is nearer than 1/16 px to the border of its pixel.
#[inline(always)]
pub const fn sampled(least: i32, most: i32, samples: usize) -> Range<i32> {
    if samples == 1 { first_centre(least)..first_centre(most) } else { (least + 15) >> 8..(most + 239) >> 8 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All that Direct3D and Vulkan say of the places: no two samples have a row or a column in common, and they lie
    /// evenly around the centre.
    #[test]
    fn samples_are_spread_evenly() {
        for samples in [1, 2, 4, 8] {
            let moves = moves(samples);
            assert_eq!(moves.len(), samples);
            for (k, (x, y)) in moves.iter().enumerate() {
                assert!(x.abs() < 128 && y.abs() < 128);
                assert!(moves.iter().skip(k + 1).all(|(other_x, other_y)| x != other_x && y != other_y));
            }
        }
    }

    #[test]
    fn no_sample_is_missed() {
        for samples in [1, 2, 4, 8] {
            for (least, most) in (-600..600).flat_map(|least| (least..least + 700).map(move |most| (least, most))) {
                let range = sampled(least, most, samples);
                for pixel in -4..8 {
                    let covered = moves(samples).iter().any(|(x, _)| (least..most).contains(&(256 * pixel + 128 - x)));
                    assert!(!covered || range.contains(&pixel), "{least}..{most}, {samples} samples, {pixel}");
                }
            }
        }
    }
}
