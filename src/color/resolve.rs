//! Several samples of a pixel → the pixel.

use super::format::PixelFormat;
use super::mean::{MeanOfCodes, PixelSum};

/// Pixels that are compared at a time.
const GROUP: usize = 8;

/// Makes each pixel the mean of its samples. `pixels` has sample 0 of each, and `samples` the others, one sample after
/// the other. There are 2, 4 or 8 samples in all. Channels are rounded to nearest.
///
/// Most pixels lie inside of triangles and have equal samples: they stay as they are.
#[inline(never)]
pub(crate) fn resolve<P: PixelFormat>(pixels: &mut [P::Raw], samples: &[P::Raw]) {
    let (length, mut start) = (pixels.len(), 0);
    while start < length {
        let end = length.min(start + GROUP);
        let group = pixels.get(start..end).unwrap_or_default();
        let mut at = start;
        while let Some(sample) = samples.get(at..at + (end - start)) {
            if !is_equal(bytemuck::cast_slice(group), bytemuck::cast_slice(sample)) {
                means::<P>(pixels, samples, start..end);
                break;
            }
            at += length;
        }
        start = end;
    }
}

/// Returns whether bytes are equal, word by word if they are words.
#[inline(always)]
fn is_equal(a: &[u8], b: &[u8]) -> bool {
    let words = |bytes| bytemuck::try_from_bytes::<[u32; 4]>(bytes).ok();
    match (words(a), words(b)) {
        (Some([a, b, c, d]), Some([e, f, g, h])) => (a ^ e) | (b ^ f) | (c ^ g) | (d ^ h) == 0,
        _ => a == b,
    }
}

/// Makes some pixels the means of their samples.
#[inline(never)]
fn means<P: PixelFormat>(pixels: &mut [P::Raw], samples: &[P::Raw], range: core::ops::Range<usize>) {
    let length = pixels.len();
    for (number, pixel) in pixels.iter_mut().enumerate().take(range.end).skip(range.start) {
        let (mut sum, mut count, mut at) = (PixelSum::<P, MeanOfCodes>::new(), 1, number);
        sum.add(*pixel);
        while let Some(sample) = samples.get(at) {
            sum.add(*sample);
            (count, at) = (count + 1, at + length);
        }
        *pixel = sum.mean(count);
    }
}
