//! Sampling: from texture coordinates to a colour, by the nearest texel or bilinearly.
//!
//! Coordinates are 16.16. The texture covers 0..1 in both directions; a [`Wrap`] says what lies beyond.

use super::image::Texture;
use super::texel::OPAQUE;
use crate::color::{PixelFormat, fold_rgb565, mix_spread_rgb565, pack_rgb565, spread_rgb565};
use crate::math::{leading_zeros, mul_high, reciprocal};
use embedded_graphics_core::geometry::Size;

/// Rule for coordinates outside of the texture.
pub trait Wrap: Copy {
    /// Set if only the fraction of a coordinate counts.
    const REPEATS: bool = false;

    /// Converts a coordinate in 16.16 to a position in the texture, in 0.16.
    fn fraction(coordinate: i32) -> u32;

    /// Converts a column or row from -1 to `size`, both included, to one in the texture.
    fn texel(number: i32, size: u32) -> u32;
}

/// Repeats the texture.
#[derive(Clone, Copy, Debug, Default)]
pub struct Repeat;

impl Wrap for Repeat {
    const REPEATS: bool = true;

    #[inline(always)]
    fn fraction(coordinate: i32) -> u32 {
        coordinate as u32 & 0xFFFF
    }

    #[inline(always)]
    fn texel(number: i32, size: u32) -> u32 {
        match number {
            -1 => size.wrapping_sub(1),
            n if n == size as i32 => 0,
            n => n as u32,
        }
    }
}

/// Repeats the texture, every other time as its mirror image.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mirror;

impl Wrap for Mirror {
    #[inline(always)]
    fn fraction(coordinate: i32) -> u32 {
        // In odd repetitions all bits are inverted: the fraction becomes 1 - 2⁻¹⁶ - fraction.
        let odd = coordinate << 15 >> 31;
        (coordinate ^ odd) as u32 & 0xFFFF
    }

    #[inline(always)]
    fn texel(number: i32, size: u32) -> u32 {
        Clamp::texel(number, size)
    }
}

/// Continues the texels at the border.
#[derive(Clone, Copy, Debug, Default)]
pub struct Clamp;

impl Wrap for Clamp {
    #[inline(always)]
    fn fraction(coordinate: i32) -> u32 {
        coordinate.clamp(0, 0xFFFF) as u32
    }

    #[inline(always)]
    fn texel(number: i32, size: u32) -> u32 {
        number.max(0).min(size.wrapping_sub(1) as i32) as u32
    }
}

/// Rule by which texels become a colour.
pub trait Filter: Copy {
    /// Set if the colour is that of the nearest texel.
    const NEAREST: bool = false;

    /// Returns red, green, blue and alpha at coordinates in 16.16.
    fn rgba<T: Texture, W: Wrap>(texture: &T, uv: [i32; 2]) -> [u8; 4];

    /// Returns the pixel at coordinates in 16.16; `None` if it is transparent.
    fn pixel<P: PixelFormat, T: Texture, W: Wrap>(texture: &T, uv: [i32; 2]) -> Option<P::Raw>;

    /// Returns the colour at coordinates in 16.16 as RGB565.
    #[inline]
    fn rgb565<T: Texture, W: Wrap>(texture: &T, uv: [i32; 2]) -> u16 {
        let [r, g, b, _] = Self::rgba::<T, W>(texture, uv);
        pack_rgb565([r, g, b])
    }
}

/// Takes the texel that the coordinates lie in.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nearest;

impl Nearest {
    #[inline(always)]
    fn texel<T: Texture, W: Wrap>(texture: &T, [u, v]: [i32; 2]) -> (u32, u32) {
        let Size { width, height } = texture.size();
        (W::fraction(u).wrapping_mul(width) >> 16, W::fraction(v).wrapping_mul(height) >> 16)
    }
}

impl Filter for Nearest {
    const NEAREST: bool = true;

    #[inline]
    fn rgba<T: Texture, W: Wrap>(texture: &T, uv: [i32; 2]) -> [u8; 4] {
        let (x, y) = Self::texel::<T, W>(texture, uv);
        texture.rgba(x, y)
    }

    #[inline]
    fn pixel<P: PixelFormat, T: Texture, W: Wrap>(texture: &T, uv: [i32; 2]) -> Option<P::Raw> {
        let (x, y) = Self::texel::<T, W>(texture, uv);
        texture.pixel::<P>(x, y)
    }

    #[inline(always)]
    fn rgb565<T: Texture, W: Wrap>(texture: &T, uv: [i32; 2]) -> u16 {
        let (x, y) = Self::texel::<T, W>(texture, uv);
        texture.rgb565(x, y)
    }
}

/// Mixes the four texels whose centres surround the coordinates, with weights by their distances. Weights are 1/256 for
/// 8 bits per channel, and 1/32 for RGB565, whose three channels are mixed in one word.
///
/// Alpha is mixed like a channel. A texel's part in the colour is its weight times its alpha, so that the hidden
/// colours of transparent texels do not show, at any alpha: the result is not premultiplied.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bilinear;

/// Finds the two columns or rows around a coordinate, and how far the coordinate is from the centre of the first one to
/// that of the second one, in 0.8.
#[inline(always)]
fn pair<W: Wrap>(coordinate: i32, size: u32) -> (u32, u32, u32) {
    // The distance from the centre of the first texel, in texels, 16.16: at least -1/2 and below `size`, which takes 64
    // bits.
    let place = i64::from(W::fraction(coordinate).wrapping_mul(size)) - (1 << 15);
    let first = (place >> 16) as i32;
    (W::texel(first, size), W::texel(first + 1, size), (place as u32 >> 8) & 0xFF)
}

/// Computes `a` + (`b` - `a`) t, with t in 1/256, rounded to nearest, for two channels at once.
#[inline(always)]
const fn mix(a: u32, b: u32, t: u32) -> u32 {
    ((a * (256 - t) + b * t + 0x0080_0080) >> 8) & 0x00FF_00FF
}

/// Weights of two columns or rows, in 1/256; see [`pair`].
type Weights = [u32; 2];

/// Mixes four texels of which some are not opaque: each colour counts as much as its alpha and its weight say.
///
/// # Format
/// The sum of weight · alpha is at most 2¹⁶ · 255, and that of weight · alpha · channel at most 2¹⁶ · 255², which is
/// below 2³². A channel is the quotient of both, rounded to nearest, from a reciprocal whose error is below 2⁻²⁰ of a
/// step.
#[inline(never)]
fn mix_by_alpha(texels: [[u8; 4]; 4], [left, right]: Weights, [above, below]: Weights) -> [u8; 4] {
    let weights = [above * left, above * right, below * left, below * right];
    let (mut sums, mut all) = ([0_u32; 3], 0);
    for ([r, g, b, a], weight) in texels.into_iter().zip(weights) {
        let weight = weight * u32::from(a);
        all += weight;
        for (sum, channel) in sums.iter_mut().zip([r, g, b]) {
            *sum += weight * u32::from(channel);
        }
    }
    if all == 0 {
        return [0; 4];
    }
    // `all` is below 2²⁴, so the shift is 8 at least, and a sum of at most 255 `all` can be shifted by 8 less.
    let shift = leading_zeros(all) & 31;
    let inverse = reciprocal(all << shift);
    let [r, g, b] = sums.map(|sum| ((mul_high(sum << (shift - 8), inverse) + (1 << 22)) >> 23) as u8);
    [r, g, b, ((all + (1 << 15)) >> 16) as u8]
}

impl Filter for Bilinear {
    #[inline]
    fn rgba<T: Texture, W: Wrap>(texture: &T, [u, v]: [i32; 2]) -> [u8; 4] {
        let Size { width, height } = texture.size();
        let (x0, x1, tx) = pair::<W>(u, width);
        let (y0, y1, ty) = pair::<W>(v, height);
        let texels = [texture.rgba(x0, y0), texture.rgba(x1, y0), texture.rgba(x0, y1), texture.rgba(x1, y1)];
        let [a, b, c, d] = texels.map(u32::from_le_bytes);
        if a & b & c & d < 0xFF00_0000 {
            return mix_by_alpha(texels, [256 - tx, tx], [256 - ty, ty]);
        }
        // Red and blue go into one word, green and alpha into the other.
        let row = |a: u32, b: u32| {
            let half = |shift: u32| mix(a >> shift & 0x00FF_00FF, b >> shift & 0x00FF_00FF, tx);
            (half(0), half(8))
        };
        let (above, below) = (row(a, b), row(c, d));
        (mix(above.0, below.0, ty) | mix(above.1, below.1, ty) << 8).to_le_bytes()
    }

    #[inline]
    fn pixel<P: PixelFormat, T: Texture, W: Wrap>(texture: &T, [u, v]: [i32; 2]) -> Option<P::Raw> {
        if T::IS_RGB565 {
            let Size { width, height } = texture.size();
            let (x0, x1, tx) = pair::<W>(u, width);
            let (y0, y1, ty) = pair::<W>(v, height);
            let (tx, ty) = ((tx + 4) >> 3, (ty + 4) >> 3);
            let at = |x: u32, y: u32| spread_rgb565(texture.rgb565(x, y));
            let above = mix_spread_rgb565(at(x1, y0), at(x0, y0), tx);
            let below = mix_spread_rgb565(at(x1, y1), at(x0, y1), tx);
            let mixed = mix_spread_rgb565(below, above, ty);
            return Some(P::from_rgb565(fold_rgb565(mixed)));
        }
        let [r, g, b, a] = Self::rgba::<T, W>(texture, [u, v]);
        if a >= OPAQUE { Some(P::pack([r, g, b])) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::super::image::Image;
    use super::super::texel::{Keyed, PaletteTexel, Rgb565Texel, Rgb888Texel};
    use super::*;
    use crate::math::random::Rng;
    use embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
    use std::println;
    use std::vec::Vec;

    #[derive(Clone, Copy, Debug)]
    enum Mode {
        Repeat,
        Mirror,
        Clamp,
    }

    /// Computes the texel for any column or row.
    fn wrapped(mode: Mode, n: i64, size: i64) -> u32 {
        let place = match mode {
            Mode::Repeat => n.rem_euclid(size),
            Mode::Clamp => n.clamp(0, size - 1),
            Mode::Mirror => {
                let m = n.rem_euclid(2 * size);
                if m < size { m } else { 2 * size - 1 - m }
            }
        };
        place as u32
    }

    fn random(seed: u64) -> impl FnMut() -> u32 {
        let mut rng = Rng::new(seed);
        move || rng.next_u32()
    }

    fn nearest_agrees<W: Wrap>(mode: Mode) {
        let mut random = random(7);
        for size in [(1, 1), (8, 8), (5, 9), (64, 3)] {
            let bytes: Vec<u8> = (0..size.0 * size.1).flat_map(|k: u16| [0, (k >> 8) as u8, k as u8]).collect();
            let image = Image::new(&bytes, Size::new(size.0.into(), size.1.into()), Rgb888Texel).expect("an image");
            for _ in 0..3000 {
                let uv = [random() as i32 >> 12, random() as i32 >> 12];
                let [x, y] = [0, 1].map(|k: usize| {
                    let size = i64::from([size.0, size.1][k]);
                    wrapped(mode, (f64::from(uv[k]) / 65_536.0 * size as f64).floor() as i64, size)
                });
                // An odd mirror image is inverted bit by bit, which moves borders of texels by 2⁻¹⁶.
                let fraction = |k: usize, size: u16| (f64::from(uv[k]) / 65_536.0 * f64::from(size)).fract() == 0.0;
                if fraction(0, size.0) || fraction(1, size.1) {
                    continue;
                }
                let expected = (y * u32::from(size.0) + x) as u16;
                let [_, high, low, _] = Nearest::rgba::<_, W>(&image, uv);
                assert_eq!(u16::from_be_bytes([high, low]), expected, "{mode:?} {size:?} {uv:?}");
            }
        }
    }

    #[test]
    fn nearest_texels_are_those_of_f64() {
        nearest_agrees::<Repeat>(Mode::Repeat);
        nearest_agrees::<Mirror>(Mode::Mirror);
        nearest_agrees::<Clamp>(Mode::Clamp);
    }

    /// Filters one channel bilinearly, in f64.
    fn filtered(mode: Mode, uv: [i32; 2], size: (u16, u16), at: impl Fn(u32, u32) -> f64) -> f64 {
        let place = |c: i32, size: u16| {
            let c = f64::from(c) / 65_536.0 * f64::from(size);
            // A clamped coordinate stays half a texel away from the first centre beyond the border.
            let c = if let Mode::Clamp = mode { c.clamp(0.0, f64::from(size)) } else { c };
            (c - 0.5).floor() as i64
        };
        let part = |c: i32, size: u16| {
            let c = f64::from(c) / 65_536.0 * f64::from(size);
            let c = if let Mode::Clamp = mode { c.clamp(0.0, f64::from(size)) } else { c };
            (c - 0.5).rem_euclid(1.0)
        };
        let (x, y) = (place(uv[0], size.0), place(uv[1], size.1));
        let (tx, ty) = (part(uv[0], size.0), part(uv[1], size.1));
        let texel = |x: i64, y: i64| at(wrapped(mode, x, size.0.into()), wrapped(mode, y, size.1.into()));
        let row = |y: i64| texel(x, y) * (1.0 - tx) + texel(x + 1, y) * tx;
        row(y) * (1.0 - ty) + row(y + 1) * ty
    }

    /// Returns the worst and the mean error per channel, in 1/255, for 8 bits per channel and for RGB565.
    fn bilinear_errors<W: Wrap>(mode: Mode) -> [[f64; 2]; 2] {
        let mut random = random(3);
        let (mut errors, mut count) = ([[0.0_f64; 2]; 2], 0.0);
        for size in [(8_u16, 8_u16), (5, 9), (64, 3), (1, 1)] {
            let bytes: Vec<u8> = (0..3 * usize::from(size.0 * size.1)).map(|_| random() as u8).collect();
            let image = Image::new(&bytes, Size::new(size.0.into(), size.1.into()), Rgb888Texel).expect("an image");
            let packed = Image::new(&bytes[..2 * bytes.len() / 3], image.size(), Rgb565Texel).expect("an image");
            for _ in 0..3000 {
                let uv = [random() as i32 >> 13, random() as i32 >> 13];
                let found = Bilinear::rgba::<_, W>(&image, uv);
                let raw = Bilinear::pixel::<Rgb565, _, W>(&packed, uv).expect("nothing is transparent");
                let raw = [raw >> 11, raw >> 5 & 63, raw & 31];
                for channel in 0..3 {
                    let exact = filtered(mode, uv, size, |x, y| image.rgba(x, y)[channel].into());
                    let exact565 = filtered(mode, uv, size, |x, y| {
                        let raw = packed.rgb565(x, y);
                        [raw >> 11, raw >> 5 & 63, raw & 31][channel].into()
                    });
                    let unit = 255.0 / [31.0, 63.0, 31.0][channel];
                    let error =
                        [(f64::from(found[channel]) - exact).abs(), (f64::from(raw[channel]) - exact565).abs() * unit];
                    for (errors, error) in errors.iter_mut().zip(error) {
                        errors[0] = errors[0].max(error);
                        errors[1] += error;
                    }
                    count += 1.0;
                }
            }
        }
        errors.map(|[worst, sum]| [worst, sum / count])
    }

    #[test]
    fn bilinear_colours_are_close_to_those_of_f64() {
        let all = [
            (Mode::Repeat, bilinear_errors::<Repeat>(Mode::Repeat)),
            (Mode::Mirror, bilinear_errors::<Mirror>(Mode::Mirror)),
            (Mode::Clamp, bilinear_errors::<Clamp>(Mode::Clamp)),
        ];
        for (mode, [[worst, mean], [worst565, mean565]]) in all {
            println!(
                "{mode:?}: 8 bits: worst {worst:.2}, mean {mean:.2}; RGB565: worst {worst565:.1}, mean {mean565:.2}"
            );
            // Weights are off by 1/256 at most in both directions, and two roundings add half a step each.
            assert!(worst <= 3.0 && mean <= 0.7, "{mode:?}");
            // In RGB565 weights are off by 1/64, and two roundings add half of 255/31 each.
            assert!(worst565 <= 16.5 && mean565 <= 4.0, "{mode:?}");
        }
    }

    /// Four texels of red, green, blue and alpha.
    struct Four([[u8; 4]; 4]);

    impl Texture for Four {
        fn size(&self) -> Size {
            Size::new(2, 2)
        }

        fn rgba(&self, x: u32, y: u32) -> [u8; 4] {
            self.0[(2 * y + x) as usize]
        }

        fn pixel<P: PixelFormat>(&self, x: u32, y: u32) -> Option<P::Raw> {
            Some(P::pack_rgba(self.rgba(x, y), (0, 0)))
        }
    }

    #[test]
    fn colours_at_any_alpha_are_the_mean_of_texels_weighted_by_alpha() {
        const SEED: u64 = 11;
        println!("seed {SEED}");
        let mut random = random(SEED);
        let mut worst = [0.0_f64; 2];
        for case in 0..60_000_u32 {
            let alpha = (case / 4 % 256) as u8;
            let mut texel = |k: u32| {
                let [r, g, b, a] = random().to_le_bytes();
                // One alpha for all, transparent neighbours, faint ones, or anything.
                [r, g, b, [alpha, if k.is_multiple_of(2) { alpha } else { 0 }, a % 8, a][(case % 4) as usize]]
            };
            let texture = Four([0, 1, 2, 3].map(&mut texel));
            let uv = [random() as i32 >> 14, random() as i32 >> 14];
            let at = |f: &dyn Fn([u8; 4]) -> f64| filtered(Mode::Clamp, uv, (2, 2), |x, y| f(texture.rgba(x, y)));
            let found = Bilinear::rgba::<_, Clamp>(&texture, uv).map(f64::from);
            let alpha = at(&|[.., a]| a.into());
            worst[1] = worst[1].max((found[3] - alpha).abs());
            // Weights are off by 1/256, so where there is hardly any alpha the colour is one of the texels' still.
            for channel in 0..3 {
                let of = |[r, g, b, _]: [u8; 4]| f64::from([r, g, b][channel]);
                if texture.0.iter().all(|texel| texel[3] == texture.0[0][3]) && texture.0[0][3] > 0 {
                    worst[0] = worst[0].max((found[channel] - at(&|texel| of(texel))).abs());
                }
                let seen = || texture.0.iter().filter(|texel| texel[3] > 0).map(|texel| of(*texel));
                let (least, most) = (seen().fold(255.0, f64::min), seen().fold(0.0, f64::max));
                if found[3] > 0.0 {
                    let range = least..=most;
                    assert!(range.contains(&found[channel]), "{:?} at {uv:?}: {found:?}", texture.0);
                }
            }
        }
        println!("worst colour {:.2}, worst alpha {:.2} of 255", worst[0], worst[1]);
        // Weights are off by 1/256 in both directions.
        assert!(worst[0] <= 2.6 && worst[1] <= 2.6, "{worst:?}");
    }

    #[test]
    fn transparent_texels_do_not_tint_their_neighbours() {
        let palette = [[255, 0, 255], [200, 100, 50]];
        let format = Keyed { format: PaletteTexel::<8>(&palette), key: 0 };
        let image = Image::new(&[1, 0, 1, 1], Size::new(2, 2), format).expect("an image");
        let mut seen = [0, 0];
        for k in 0..1024 {
            let uv = [(k % 32) * 2048 + 1000, (k / 32) * 2048 + 1000];
            let [r, g, b, a] = Bilinear::rgba::<_, Clamp>(&image, uv);
            let pixel = Bilinear::pixel::<Rgb888, _, Clamp>(&image, uv);
            seen[usize::from(pixel.is_some())] += 1;
            assert_eq!(pixel.is_some(), a >= OPAQUE);
            if a >= OPAQUE {
                let off = [r.abs_diff(200), g.abs_diff(100), b.abs_diff(50)];
                assert!(off.iter().all(|off| *off <= 5), "{:?} at {uv:?}", [r, g, b, a]);
            }
        }
        assert!(seen[0] > 100 && seen[1] > 500, "{seen:?}");
    }
}
