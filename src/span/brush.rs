//! Brushes: what draws the spans of small triangles, and what it is handed.

use super::carried::LeftState;
use super::depth::DepthTest;
use super::depth_bias::{BiasSteps, DepthBias};
use super::sample::Sample;
use crate::color::PixelFormat;
use crate::raster::ShortPlanes;
use core::ops::Range;

/// Pixels that small triangles are drawn into: rows that lie one after the other in memory.
pub struct SmallTarget<'a, R> {
    /// Colours and depths, from column 0 of the first row on.
    pub(crate) color: &'a mut [R],
    pub(crate) depth: &'a mut [u16],
    /// Colours of samples 1 and up, one sample after the other. Depths of all samples are together.
    pub(crate) samples: &'a mut [R],
    /// The sample that is drawn, or sample 0 if all are drawn. It tells their number, too.
    pub(crate) sample: Sample,
    /// The first row.
    pub(crate) first: u16,
    /// Columns that all of a triangle has to be in, and rows that may be drawn.
    pub(crate) columns: Range<i32>,
    pub(crate) rows: Range<i32>,
    pub(crate) screen: (u16, u16),
    /// Set if triangles that go with the clock, with y up, show their front.
    pub(crate) clockwise_fronts: bool,
    /// Depth bias, if there may be one, and how it is computed.
    pub(crate) bias: Option<(BiasSteps, DepthBias)>,
    /// Words in which a triangle leaves its state for the next strip; `None` if it is not to.
    pub(crate) state: Option<&'a mut LeftState>,
}

/// A triangle that may be small, as [`Shader::small`](crate::span::Shader::small) gets it: its target, and its corners,
/// with the highest one first.
pub struct SmallTriangle<'t, 'a, P: PixelFormat, D: DepthTest> {
    pub(crate) target: &'t mut SmallTarget<'a, P::Raw>,
    /// Words of [`PackedVertex`]s.
    pub(crate) v: [&'t [u32; 2]; 3],
    /// The state of a triangle from the strip above, which goes on here.
    pub(crate) state: Option<&'t mut [u32]>,
    pub(crate) test: D,
}

/// Results of drawing a triangle that may be small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SmallResult {
    /// The triangle is small, and drawn.
    Drawn,
    /// The triangle is small, and its bounding box holds no centre of a pixel.
    Empty,
    /// The triangle is small, and in none of the rows that may be drawn.
    Outside,
    /// The triangle is not small, or has to be drawn like triangles that are not.
    Large,
}

/// Draws small triangles.
pub(crate) trait Brush<P: PixelFormat, D: DepthTest> {
    /// Set if the brush has planes besides depth.
    const PLANES: bool;
    /// Set if tall triangles are small, too. They take their code once more, which pays where the way of large ones is
    /// long.
    const TALL: bool = false;

    /// Set if rows can be shaded beside the centres of pixels. Then pixels of several samples are set up once.
    const SHIFTS: bool = true;

    /// Draws the spans of a triangle.
    type Rows: BrushRows<P, D>;

    /// Sets up a triangle, of which (`column`, `row`) is the first pixel: spans are counted from there. `swapped` says
    /// that the last two corners have changed places in `planes`. Returns `None` if the brush cannot draw it.
    fn set_up(&self, planes: &ShortPlanes, swapped: bool, place: (i32, i32), dz_dx: i32) -> Option<Self::Rows>;

    /// Goes on with the spans of a triangle, from words that [`BrushRows::save`] has filled in. (`column`, `row`) is
    /// the first pixel from now on.
    fn resume(&self, words: &[u32], place: (i32, i32)) -> Self::Rows;
}

/// Draws the spans of a small triangle, from the top to the bottom.
pub(crate) trait BrushRows<P: PixelFormat, D: DepthTest> {
    /// Number of words of the state; `None` if it is not carried on to the next strip.
    const WORDS: Option<usize>;
    /// Set if all pixels get one colour, wherever they are shaded.
    const IS_FLAT: bool = false;

    /// Set if pixels can be shaded by themselves, by [`shade`](Self::shade): none is transparent, and none depends on
    /// what is there.
    const SHADES: bool = false;

    /// Colours pixels from `column` pixels to the right of the first pixel on, whatever their depth is. Only asked for
    /// if the brush [shades](Self::SHADES).
    #[inline(always)]
    fn shade(&self, color: &mut [P::Raw], column: i32) {
        let _ = (color, column);
    }

    /// Puts the state into words, as it is a number of rows further down.
    fn save(&self, down: u32, words: &mut [u32]);

    /// Goes on to the next row.
    fn next_row(&mut self);

    /// Returns rows whose pixels are shaded this far to the right of and below their centres, 24.8: less than 1/2 px.
    /// Only asked for if the brush [shifts](Brush::SHIFTS).
    fn beside(&self, by: (i32, i32)) -> Self;

    /// Draws a span that begins `column` pixels to the right of the first pixel.
    fn span(&self, color: &mut [P::Raw], depth: &mut [D::Depth], z: u32, dz_dx: i32, column: i32, test: D);

    /// Draws a span of a sample of each pixel: by [`span`](Self::span), unless the brush tells samples apart.
    #[inline(always)]
    fn span_at(
        &self,
        sample: Sample,
        color: &mut [P::Raw],
        depth: &mut [D::Depth],
        (z, dz_dx): (u32, i32),
        column: i32,
        test: D,
    ) {
        let _ = sample;
        self.span(color, depth, z, dz_dx, column, test);
    }
}

/// Returns `length` elements from `start` on, if there are as many. Two steps check this with one comparison each; a
/// range is checked at both ends at once, which costs twice as much.
#[inline(always)]
pub(crate) fn subslice<T>(slice: &mut [T], start: usize, length: usize) -> Option<&mut [T]> {
    slice.get_mut(start..)?.get_mut(..length)
}
