//! Several samples of a pixel → the pixel.

use super::format::PixelFormat;
use super::mean::{MeanOfCodes, mean};

/// Makes each pixel the mean of its samples. `pixels` has sample 0 of each, and `samples` the others, one sample after
/// the other. There are 2, 4 or 8 samples in all. Channels are rounded to nearest.
///
/// Most pixels lie inside of triangles and have equal samples: these are compared word by word, and stay as they are.
pub(crate) fn resolve<P: PixelFormat>(pixels: &mut [P::Raw], samples: &[P::Raw]) {
    let length = pixels.len();
    let mut k = 0;
    while k < length {
        // Four words, if there are as many.
        let all = k..length.min(k + 16 / size_of::<P::Raw>());
        k = all.end;
        let equal = |sample: &[P::Raw]| {
            let (a, b) = (pixels.get(all.clone()), sample.get(all.clone()));
            is_equal(bytemuck::cast_slice(a.unwrap_or_default()), bytemuck::cast_slice(b.unwrap_or_default()))
        };
        if !samples.chunks(length).all(equal) {
            means::<P>(pixels, samples, all);
        }
    }
}

/// Returns whether bytes are equal: 16 of them, as words, or any other number.
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
    for k in range {
        let further = || samples.get(k..).unwrap_or_default().iter().step_by(length);
        if let Some(pixel) = pixels.get_mut(k)
            && further().any(|sample| bytemuck::bytes_of(sample) != bytemuck::bytes_of(&*pixel))
        {
            let count = 1 + further().len() as u32;
            let shift = count.trailing_zeros() & 31;
            let all = core::iter::once(*pixel).chain(further().copied());
            *pixel = mean::<P, MeanOfCodes>(all, count, |sum| sum >> shift);
        }
    }
}
