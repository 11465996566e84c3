//! Ordered dithering: 8-bit greys become the few levels of a panel, by a matrix of thresholds that is fixed to the
//! screen.
//!
//! The eye takes the mean of neighbouring pixels as *light*, not as numbers. 8-bit greys are sRGB: 128 is a fifth of
//! white's light, not half of it. So each grey is first converted to light: to its share of the way from the light of
//! one level to that of the next. This share is then compared with the threshold at the pixel's position. The result
//! depends on the grey and the position only, so unchanged pixels do not flicker, and borders of strips do not show.

use embedded_graphics_core::pixelcolor::{BinaryColor, Gray2, Gray4, PixelColor};

/// Light of each 8-bit grey in sRGB, 65,535 for white.
///
/// # Format
/// Rounded to nearest. c^2.4 = c² · (c²)^(1/5), with 60 fractional bits and a root of 32.
/// # Source
/// IEC 61966-2-1: c / 12.92 up to 0.04045, ((c + 0.055) / 1.055)^2.4 above.
pub(super) const LIGHT: [u16; 256] = {
    let mut table = [0; 256];
    let mut v = 0;
    while v < 256 {
        table[v] = if v <= 10 {
            ((v * 25_700 + 646) / 1292) as u16
        } else {
            let c = ((v as u128 * 1000 + 14_025) << 60) / 269_025;
            let square = mul_q60(c, c);
            ((mul_q60(square, fifth_root(square)) * 65_535 + (1 << 59)) >> 60) as u16
        };
        v += 1;
    }
    table
};

/// Multiplies two numbers in 4.60.
const fn mul_q60(a: u128, b: u128) -> u128 {
    (a * b) >> 60
}

/// Computes the fifth root of a number in 0.60, cut to 32 bits. It works by bisection, and is used in constants only.
const fn fifth_root(x: u128) -> u128 {
    let mut root = 0;
    let mut bit = 1 << 60;
    while bit > 1 << 28 {
        let r = root | bit;
        let square = mul_q60(r, r);
        if mul_q60(mul_q60(square, square), r) <= x {
            root = r;
        }
        bit >>= 1;
    }
    root
}

/// Thresholds at (x mod 8, y mod 8), row by row.
pub(super) type Matrix = [[u8; 8]; 8];

/// Returns the rank of pixel (x, y): its place in the order in which a cell of 2^`bits` by 2^`bits` pixels is filled.
///
/// # Source
/// Bayer 1973, "An optimum method for two-level rendition of continuous-tone pictures": the bits of x ^ y and of y are
/// interleaved, the lowest bits first.
pub(super) const fn bayer(x: usize, y: usize, bits: u32) -> u8 {
    let mut rank = 0;
    let mut bit = 0;
    while bit < bits {
        rank = rank << 2 | (((x ^ y) >> bit) & 1) << 1 | (y >> bit) & 1;
        bit += 1;
    }
    rank as u8
}

/// Makes thresholds in 1/128. All thresholds of a cell are evenly spaced, and as far from 0 as from 1.
const fn thresholds(bits: u32) -> Matrix {
    let mut matrix = [[0; 8]; 8];
    let mut k = 0;
    while k < 64 {
        let (x, y) = (k % 8, k / 8);
        let steps = 1 << (2 * bits);
        matrix[y][x] = ((2 * bayer(x, y, bits) as usize + 1) * 64 / steps) as u8;
        k += 1;
    }
    matrix
}

/// Makes the largest greys that stay black: those whose light is below the threshold. Greys above them become white.
const fn light_limits(thresholds: &Matrix) -> Matrix {
    let mut matrix = [[0; 8]; 8];
    let mut k = 0;
    while k < 64 {
        let mut grey = 0;
        while (LIGHT[grey] as u32) * 128 < thresholds[k / 8][k % 8] as u32 * 65_535 {
            grey += 1;
        }
        matrix[k / 8][k % 8] = grey as u8 - 1;
        k += 1;
    }
    matrix
}

/// Makes the largest greys that stay black if a grey is compared with the threshold as a number, not by its light.
const fn value_limits(thresholds: &Matrix) -> Matrix {
    let mut matrix = [[0; 8]; 8];
    let mut k = 0;
    while k < 64 {
        matrix[k / 8][k % 8] = ((thresholds[k / 8][k % 8] as u32 * 255).div_ceil(128) - 1) as u8;
        k += 1;
    }
    matrix
}

/// Makes the addends 1 - threshold, in 1/128 of a level. A grey plus the addend, cut to whole levels, is one level
/// higher exactly if the grey's fraction reaches the threshold.
const fn addends(thresholds: &Matrix) -> Matrix {
    let mut matrix = [[0; 8]; 8];
    let mut k = 0;
    while k < 64 {
        matrix[k / 8][k % 8] = 128 - thresholds[k / 8][k % 8];
        k += 1;
    }
    matrix
}

const THRESHOLDS_4: Matrix = thresholds(2);
const THRESHOLDS_8: Matrix = thresholds(3);

static LIGHT_LIMITS_4: Matrix = light_limits(&THRESHOLDS_4);
static LIGHT_LIMITS_8: Matrix = light_limits(&THRESHOLDS_8);
static VALUE_LIMITS_4: Matrix = value_limits(&THRESHOLDS_4);
static VALUE_LIMITS_8: Matrix = value_limits(&THRESHOLDS_8);
static ADDENDS_4: Matrix = addends(&THRESHOLDS_4);
static ADDENDS_8: Matrix = addends(&THRESHOLDS_8);

/// Table of all 256 greys, in 1/128 of a level.
pub type Tones = [u16; 256];

/// Makes the tones for `max` + 1 levels that are sRGB greys themselves.
const fn srgb_tones(max: usize) -> Tones {
    let mut tones = [0; 256];
    let mut v = 0;
    while v < 256 {
        let level = v * max / 255;
        let (from, to) = (LIGHT[255 * level / max], LIGHT[if level < max { 255 * (level + 1) / max } else { 255 }]);
        tones[v] = (128 * level) as u16;
        if to > from {
            let (part, whole) = ((LIGHT[v] - from) as u32, (to - from) as u32);
            tones[v] += ((256 * part + whole) / (2 * whole)) as u16;
        }
        v += 1;
    }
    tones
}

/// Makes the tones for `max` + 1 levels whose light is evenly spaced.
const fn linear_tones(max: u32) -> Tones {
    let mut tones = [0; 256];
    let mut v = 0;
    while v < 256 {
        tones[v] = ((LIGHT[v] as u32 * max * 256 + 65_535) / (2 * 65_535)) as u16;
        v += 1;
    }
    tones
}

static GRAY2_TONES: Tones = srgb_tones(3);
static GRAY2_LINEAR: Tones = linear_tones(3);
static GRAY4_TONES: Tones = srgb_tones(15);
static GRAY4_LINEAR: Tones = linear_tones(15);

/// A colour that is one of a few levels of grey: `BinaryColor`, `Gray2` and `Gray4` of embedded-graphics.
pub trait Levels: PixelColor {
    /// Bits per pixel: 1, 2 or 4.
    const BITS: u32;

    /// Table that places a grey between two levels; `()` if there are only two levels.
    type Tones: Copy + core::fmt::Debug;

    /// Value of [`Dither::NEAREST`].
    const NEAREST: Dither<Self>;
    /// Value of [`Dither::BAYER_4`].
    const BAYER_4: Dither<Self>;
    /// Value of [`Dither::BAYER_8`].
    const BAYER_8: Dither<Self>;

    /// Returns the level, below 2^`BITS`, of a grey at a pixel for which the matrix holds `entry`.
    fn level(tones: Self::Tones, entry: u32, grey: u8) -> u8;

    /// Returns the colour of a level.
    fn from_level(level: u8) -> Self;
}

/// Black and white. An entry of the matrix is the largest grey that stays black at its pixel.
impl Levels for BinaryColor {
    const BITS: u32 = 1;
    type Tones = ();
    const NEAREST: Dither<Self> = Dither { matrix: &[[127; 8]; 8], tones: () };
    const BAYER_4: Dither<Self> = Dither { matrix: &LIGHT_LIMITS_4, tones: () };
    const BAYER_8: Dither<Self> = Dither { matrix: &LIGHT_LIMITS_8, tones: () };

    #[inline(always)]
    fn level((): (), entry: u32, grey: u8) -> u8 {
        // The sign of the difference is the level. A comparison would have to be turned into a number first.
        (entry.wrapping_sub(u32::from(grey)) >> 31) as u8
    }

    fn from_level(level: u8) -> Self {
        if level == 0 { Self::Off } else { Self::On }
    }
}

macro_rules! grey_levels {
    ($color:ident, $bits:literal, $tones:ident, $linear:ident) => {
        /// Levels of grey. An entry of the matrix is added to a grey, both in 1/128 of a level, and the sum is cut.
        impl Levels for $color {
            const BITS: u32 = $bits;
            type Tones = &'static Tones;
            const NEAREST: Dither<Self> = Dither { matrix: &[[64; 8]; 8], tones: &$tones };
            const BAYER_4: Dither<Self> = Dither { matrix: &ADDENDS_4, tones: &$tones };
            const BAYER_8: Dither<Self> = Dither { matrix: &ADDENDS_8, tones: &$tones };

            #[inline(always)]
            fn level(tones: &'static Tones, entry: u32, grey: u8) -> u8 {
                (u32::from(tones[usize::from(grey)]).wrapping_add(entry) >> 7) as u8
            }

            fn from_level(level: u8) -> Self {
                Self::new(level)
            }
        }

        impl Dither<$color> {
            /// Returns this dithering for a panel whose light grows evenly with its levels, as with some controllers
            /// that have no gamma curve set. Otherwise levels count as sRGB greys, which are evenly spaced to the eye.
            #[must_use]
            pub const fn on_linear_panel(self) -> Self {
                Self { tones: &$linear, ..self }
            }
        }
    };
}

grey_levels!(Gray2, 2, GRAY2_TONES, GRAY2_LINEAR);
grey_levels!(Gray4, 4, GRAY4_TONES, GRAY4_LINEAR);

/// Conversion of greys to the levels of `C`: `BinaryColor`, `Gray2` or `Gray4`.
///
/// A grey lies between two levels. The mean light of a cell is that of the grey, up to an error, which is at most this
/// part of the light between the two levels:
///
/// | levels | cells of 8×8 pixels | cells of 4×4 pixels |
/// |---|---|---|
/// | 2 | 1/128 | 1/32 |
/// | 4 or 16 | 1/76 | 1/28 |
///
/// The first row is half of the distance from one threshold to the next. For more than two levels, greys between two
/// levels are also rounded to 1/128 of the distance between them. Black and white stay exact.
///
/// ```
/// use embedded_graphics_core::pixelcolor::BinaryColor;
/// use zstrip::color::Dither;
/// let white = |dither: Dither<BinaryColor>, grey| {
///     (0..64).filter(|k| dither.color(grey, (k % 8, k / 8)) == BinaryColor::On).count()
/// };
/// assert_eq!(white(Dither::BAYER_8, 128), 14); // 128 has 0.216 of white's light
/// assert_eq!(white(Dither::BAYER_8, 188), 32);
/// assert_eq!(white(Dither::NEAREST, 128), 64);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Dither<C: Levels> {
    pub(super) matrix: &'static Matrix,
    pub(crate) tones: C::Tones,
}

impl Dither<BinaryColor> {
    /// [`BAYER_4`](Self::BAYER_4), but mixing numbers instead of light. Mid-tones become brighter than they should be.
    /// This suits dark scenes, and panels whose black dots run into each other.
    pub const BRIGHT_4: Self = Self { matrix: &VALUE_LIMITS_4, tones: () };
    /// [`BAYER_8`](Self::BAYER_8), but mixing numbers instead of light; see [`BRIGHT_4`](Self::BRIGHT_4).
    pub const BRIGHT_8: Self = Self { matrix: &VALUE_LIMITS_8, tones: () };
}

impl<C: Levels> Dither<C> {
    /// No dithering: greys from 128 on become white; of more than two levels, the nearest in light is taken.
    pub const NEAREST: Self = C::NEAREST;
    /// Cells of 4×4 pixels: 16 steps between two levels, in a fine pattern.
    pub const BAYER_4: Self = C::BAYER_4;
    /// Cells of 8×8 pixels: 64 steps between two levels.
    pub const BAYER_8: Self = C::BAYER_8;

    /// Returns the level of a grey at a pixel of the screen.
    #[inline]
    pub fn level(&self, grey: u8, (x, y): (i32, i32)) -> u8 {
        C::level(self.tones, self.row(y)[(x & 7) as usize], grey)
    }

    /// Returns the matrix entries of row `y` of the screen.
    ///
    /// They are hidden from the compiler: if it knew that they are bytes, it would use comparisons, which cost branches
    /// on small cores.
    #[inline(always)]
    pub(crate) fn row(&self, y: i32) -> [u32; 8] {
        let [a, b, c, d, e, f, g, h] = self.matrix[(y & 7) as usize];
        core::hint::black_box([a.into(), b.into(), c.into(), d.into(), e.into(), f.into(), g.into(), h.into()])
    }

    /// Returns the colour of a grey at a pixel of the screen.
    #[inline]
    pub fn color(&self, grey: u8, position: (i32, i32)) -> C {
        C::from_level(self.level(grey, position))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::String;

    /// Returns the light of a grey; white has 1.
    fn light(grey: f64) -> f64 {
        let c = grey / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    }

    #[test]
    fn light_of_all_greys_is_within_half_a_step() {
        for (grey, value) in LIGHT.iter().enumerate() {
            let exact = 65_535.0 * light(grey as f64);
            assert!((f64::from(*value) - exact).abs() <= 0.500_001, "grey {grey}: {value}, {exact}");
        }
    }

    /// Returns the largest error, over all greys, of the mean light of a cell of 64 pixels. The unit is the light
    /// between the two levels around the grey; `levels` holds the light of each level.
    fn worst<C: Levels, const N: usize>(dither: Dither<C>, levels: [f64; N]) -> f64 {
        let error = |grey: u8| {
            let asked = light(f64::from(grey));
            let above = (1..N - 1).find(|level| levels[*level] > asked).unwrap_or(N - 1);
            let places = (0..64).map(|k| dither.level(grey, (k % 8 - 16, k / 8 + 80)));
            let mean = places.map(|level| levels[usize::from(level)]).sum::<f64>() / 64.0;
            (mean - asked).abs() / (levels[above] - levels[above - 1])
        };
        (0..=255).map(error).fold(0.0, f64::max)
    }

    #[test]
    fn mean_light_of_a_cell_is_that_of_the_grey() {
        let two = [0.0, 1.0];
        let four: [f64; 4] = core::array::from_fn(|level| light(level as f64 * 85.0));
        let sixteen: [f64; 16] = core::array::from_fn(|level| light(level as f64 * 17.0));
        let (even_4, even_16) = (core::array::from_fn(|k| k as f64 / 3.0), core::array::from_fn(|k| k as f64 / 15.0));
        let black_and_white = [worst(Dither::<BinaryColor>::BAYER_8, two), worst(Dither::<BinaryColor>::BAYER_4, two)];
        let cells_of_8 = [
            worst::<_, 4>(Dither::<Gray2>::BAYER_8, four),
            worst::<_, 16>(Dither::<Gray4>::BAYER_8, sixteen),
            worst::<_, 4>(Dither::<Gray2>::BAYER_8.on_linear_panel(), even_4),
            worst::<_, 16>(Dither::<Gray4>::BAYER_8.on_linear_panel(), even_16),
        ];
        let cells_of_4 = [
            worst::<_, 4>(Dither::<Gray2>::BAYER_4, four),
            worst::<_, 16>(Dither::<Gray4>::BAYER_4, sixteen),
            worst::<_, 4>(Dither::<Gray2>::BAYER_4.on_linear_panel(), even_4),
            worst::<_, 16>(Dither::<Gray4>::BAYER_4.on_linear_panel(), even_16),
        ];
        let largest = |errors: &[f64]| errors.iter().fold(0.0, |largest: f64, error| largest.max(*error));
        let (eight, four) = (largest(&cells_of_8), largest(&cells_of_4));
        assert!(black_and_white[0] <= 1.0 / 128.0 && black_and_white[1] <= 1.0 / 32.0, "{black_and_white:?}");
        assert!(eight <= 1.0 / 76.0 && four <= 1.0 / 28.0, "{cells_of_8:?} {cells_of_4:?}");
        // The bounds are tight.
        assert!(black_and_white[0] > 1.0 / 130.0 && black_and_white[1] > 1.0 / 33.0, "{black_and_white:?}");
        assert!(eight > 1.0 / 77.0 && four > 1.0 / 29.0, "{cells_of_8:?} {cells_of_4:?}");
    }

    #[test]
    fn bright_dithering_mixes_numbers() {
        for (dither, places) in [(Dither::<BinaryColor>::BRIGHT_4, 16.0), (Dither::<BinaryColor>::BRIGHT_8, 64.0)] {
            for grey in 0..=255_u8 {
                let white = (0..64).filter(|k| dither.level(grey, (k % 8, k / 8)) == 1).count() as f64;
                let error = (white / 64.0 - f64::from(grey) / 255.0).abs();
                assert!(error <= 0.5 / places + 1e-9, "{grey}: {white} of 64");
            }
        }
    }

    #[test]
    fn levels_themselves_are_drawn_without_a_pattern() {
        for k in 0..64 {
            let place = (k % 8, k / 8);
            for dither in
                [Dither::<BinaryColor>::NEAREST, Dither::BAYER_4, Dither::BAYER_8, Dither::BRIGHT_4, Dither::BRIGHT_8]
            {
                assert_eq!((dither.level(0, place), dither.level(255, place)), (0, 1));
            }
            for dither in [Dither::<Gray2>::NEAREST, Dither::<Gray2>::BAYER_4, Dither::BAYER_8] {
                assert!((0..4).all(|level| dither.level(level * 85, place) == level));
            }
            for dither in [Dither::<Gray4>::NEAREST, Dither::<Gray4>::BAYER_4, Dither::BAYER_8] {
                assert!((0..16).all(|level| dither.level(level * 17, place) == level));
            }
        }
    }

    #[test]
    fn brighter_greys_never_become_darker() {
        fn check<C: Levels>(dither: Dither<C>) {
            for place in (0..64).map(|k| (k % 8, k / 8)) {
                for grey in 1..=255 {
                    assert!(dither.level(grey, place) >= dither.level(grey - 1, place), "{grey} at {place:?}");
                }
            }
        }
        check(Dither::<BinaryColor>::BAYER_8);
        check(Dither::<Gray2>::BAYER_4);
        check(Dither::<Gray4>::BAYER_8.on_linear_panel());
    }

    #[test]
    fn cells_are_filled_in_the_order_of_bayer() {
        let order = |bits: u32| {
            let side = 1 << bits;
            (0..side * side).map(|k| std::format!("{} ", bayer(k % side, k / side, bits))).collect::<String>()
        };
        assert_eq!(order(1), "0 2 3 1 ");
        assert_eq!(order(2), "0 8 2 10 12 4 14 6 3 11 1 9 15 7 13 5 ");
        let mut seen = [false; 64];
        (0..64).for_each(|k| seen[usize::from(bayer(k % 8, k / 8, 3))] = true);
        assert!(seen.iter().all(|seen| *seen));
    }
}
