//! Several samples of a pixel → the pixel.

use super::format::PixelFormat;

/// Makes each pixel the mean of its samples. `pixels` has sample 0 of each, and `samples` the others, one sample after
/// the other. There are 2, 4 or 8 samples in all.
///
/// Channels are rounded to nearest. Most pixels lie inside of triangles, with equal samples, and stay as they are.
#[inline(never)]
pub(crate) fn resolve<P: PixelFormat>(pixels: &mut [P::Raw], samples: &[P::Raw]) {
    let length = pixels.len();
    for (k, pixel) in pixels.iter_mut().enumerate() {
        let further = || samples.get(k..).unwrap_or_default().iter().step_by(length);
        if further().any(|sample| bytemuck::bytes_of(sample) != bytemuck::bytes_of(&*pixel)) {
            *pixel = mean::<P>(*pixel, further());
        }
    }
}

/// Returns the mean of the samples of a pixel.
#[inline(never)]
fn mean<'s, P: PixelFormat>(first: P::Raw, further: impl Iterator<Item = &'s P::Raw>) -> P::Raw
where
    P::Raw: 's,
{
    let (mut sum, mut count) = (P::unpack(first).map(u32::from), 1_u32);
    for sample in further {
        for (sum, channel) in sum.iter_mut().zip(P::unpack(*sample)) {
            *sum += u32::from(channel);
        }
        count += 1;
    }
    // The count is a power of two.
    let shift = count.trailing_zeros() & 31;
    P::pack(sum.map(|sum| ((sum + (count >> 1)) >> shift) as u8))
}
