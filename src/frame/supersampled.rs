//! Supersampling: frames on a finer screen, each strip of which becomes the mean of its pixels.

use super::error::{FrameError, RendererError};
use super::frame::Frame;
use super::renderer::Renderer;
use crate::color::{Mean, MeanOfCodes, PixelFormat, PixelSum};
use crate::scene::Scene;
use crate::target::{DepthChoice, OnDisplay, RecordsChoice, Stats, Strip, StripPixels, StripSink};
use core::fmt;
use core::marker::PhantomData;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::pixelcolor::Rgb888;
use embedded_graphics_core::primitives::Rectangle;

/// Draws on a screen that is `N` times as wide and as high, and makes one pixel of `N` × `N`: 2, 3 or 4. All that can
/// be drawn becomes smooth: triangles, lines, texels, text.
///
/// Whatever is drawn has coordinates on the finer screen: text and shapes in pixels are `N` times as large there.
/// Buffers hold strips of the finer screen: strips of as many rows of the display take `N`² times as much memory, see
/// [`RamBudget::supersampled`](super::RamBudget::supersampled).
///
/// ```
/// # use zstrip::embedded_graphics_core::{geometry::Size, pixelcolor::{Rgb888, RgbColor}};
/// use zstrip::{color::Rgb565Be, frame::Supersampled, Renderer};
///
/// // A display of 320×240 pixels, in strips of 4 rows: 20 KB.
/// let (mut color, mut depth) = ([0; 640 * 8], [0; 640 * 8]);
/// let fine = Renderer::<Rgb565Be>::new(Size::new(640, 480))?.with_depth(&mut depth)?;
/// let mut renderer = Supersampled::<_, _, _, 2>::new(fine)?;
/// let mut frame = renderer.begin(Rgb888::BLACK);
/// while let Some(strip) = frame.next_strip(&mut color, |scene| { /* scene.draw(...) */ })? {
///     assert_eq!(strip.area().size, Size::new(320, 4));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Other numbers do not compile:
///
/// ```compile_fail
/// # use zstrip::{color::Rgb565Be, embedded_graphics_core::geometry::Size, frame::Supersampled, Renderer};
/// let fine = Renderer::<Rgb565Be>::new(Size::new(640, 480)).expect("a renderer");
/// let _ = Supersampled::<_, _, _, 5>::new(fine);
/// ```
pub struct Supersampled<'b, P: PixelFormat, D: DepthChoice, R, const N: usize, M = MeanOfCodes> {
    fine: Renderer<'b, P, D, R>,
    how: PhantomData<M>,
}

impl<'b, P: PixelFormat, D: DepthChoice, R: RecordsChoice, const N: usize> Supersampled<'b, P, D, R, N> {
    /// Makes a renderer of one for the finer screen.
    ///
    /// # Errors
    /// When the size of the screen is not a multiple of `N`, or the depth buffer does not hold `N` rows.
    pub fn new(fine: Renderer<'b, P, D, R>) -> Result<Self, RendererError> {
        const { assert!(N >= 2 && N <= 4, "2, 3 or 4 pixels in each direction become one") };
        let screen = fine.screen();
        if !screen.width.is_multiple_of(N as u32) || !screen.height.is_multiple_of(N as u32) {
            return Err(RendererError::NotAMultiple { screen, scale: N as u32 });
        }
        let rows = fine.strip_rows(usize::MAX) as usize;
        if rows < N {
            let width = screen.width as usize;
            return Err(RendererError::DepthTooShort { pixels: rows * width, needed: N * width });
        }
        Ok(Self { fine, how: PhantomData })
    }
}

impl<'b, P: PixelFormat, D: DepthChoice, R: RecordsChoice, const N: usize, M: Mean> Supersampled<'b, P, D, R, N, M> {
    /// Takes another kind of mean.
    #[must_use]
    pub fn with_mean<L: Mean>(self, mean: L) -> Supersampled<'b, P, D, R, N, L> {
        let _ = mean;
        Supersampled { fine: self.fine, how: PhantomData }
    }

    /// Returns the size of the display.
    #[must_use]
    pub fn screen(&self) -> Size {
        self.fine.screen() / N as u32
    }

    /// Starts a frame whose strips the caller pulls.
    pub fn begin(&mut self, background: impl Into<Rgb888>) -> SupersampledFrame<'_, 'b, P, D, R, N, M> {
        let width = self.fine.screen().width as usize;
        let most = self.fine.strip_rows(usize::MAX) as usize / N * N * width;
        SupersampledFrame { frame: self.fine.begin(background), width, most, how: PhantomData }
    }

    /// Draws a frame, strip by strip through `buffer`, and hands each finished strip to a sink.
    ///
    /// # Errors
    /// Those of [`Renderer::frame_to`].
    pub fn frame_to<K: StripSink<P>>(
        &mut self,
        mut sink: K,
        buffer: &mut [P::Raw],
        background: impl Into<Rgb888>,
        mut draw: impl FnMut(&mut Scene<'_, Strip<'_, P, D, R>>),
    ) -> Result<Stats, FrameError<K::Error>> {
        let mut frame = self.begin(background);
        while let Some(strip) = frame.next_strip(buffer, &mut draw).map_err(FrameError::widen)? {
            sink.strip(&strip).map_err(FrameError::Sink)?;
        }
        Ok(frame.stats())
    }

    /// Draws a frame on an embedded-graphics display, strip by strip through `buffer`.
    ///
    /// # Errors
    /// Those of [`Renderer::frame`].
    pub fn frame<T: DrawTarget<Color = P::Color>>(
        &mut self,
        display: &mut T,
        buffer: &mut [P::Raw],
        background: impl Into<Rgb888>,
        draw: impl FnMut(&mut Scene<'_, Strip<'_, P, D, R>>),
    ) -> Result<Stats, FrameError<T::Error>> {
        self.frame_to(OnDisplay::new(display), buffer, background, draw)
    }
}

impl<P: PixelFormat, D: DepthChoice, R: RecordsChoice, const N: usize, M> fmt::Debug
    for Supersampled<'_, P, D, R, N, M>
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Supersampled").field("screen", &self.fine.screen()).finish_non_exhaustive()
    }
}

/// A frame of [`Supersampled`], whose strips are pulled one by one.
#[must_use = "a frame draws nothing until its strips are pulled"]
pub struct SupersampledFrame<'r, 'b, P: PixelFormat, D: DepthChoice, R, const N: usize, M> {
    frame: Frame<'r, 'b, P, D, R>,
    /// Columns of the finer screen, and most pixels of a strip.
    width: usize,
    most: usize,
    how: PhantomData<M>,
}

impl<P: PixelFormat, D: DepthChoice, R: RecordsChoice, const N: usize, M: Mean>
    SupersampledFrame<'_, '_, P, D, R, N, M>
{
    /// Draws the next strip into `buffer`, and makes it the mean of its pixels: the first of the buffer. Returns `None`
    /// after the last strip.
    ///
    /// The first strip of a frame decides the height of all of them: as many rows of the display as its buffer and the
    /// depth buffer hold `N` rows each of.
    ///
    /// # Errors
    /// Those of [`Frame::next_strip`].
    pub fn next_strip<'c>(
        &mut self,
        buffer: &'c mut [P::Raw],
        draw: impl FnMut(&mut Scene<'_, Strip<'_, P, D, R>>),
    ) -> Result<Option<StripPixels<'c, P>>, FrameError> {
        let unit = N * self.width;
        let whole = buffer.len() - buffer.len().checked_rem(unit).unwrap_or_default();
        if whole == 0 {
            return Err(FrameError::BufferTooShort { pixels: buffer.len(), needed: unit });
        }
        let buffer = buffer.get_mut(..whole.min(self.most)).unwrap_or_default();
        let Some(strip) = self.frame.next_strip(buffer, draw)? else { return Ok(None) };
        let Rectangle { top_left, size } = strip.area();
        let area = Rectangle::new(Point::new(0, top_left.y / N as i32), size / N as u32);
        let pixels = strip.into_pixels();
        let length = pixels.len() / (N * N);
        average::<P, M, N>(pixels, self.width);
        Ok(Some(StripPixels::new(area, pixels.get_mut(..length).unwrap_or_default())))
    }

    /// Returns the counters of the work done so far.
    #[must_use]
    pub const fn stats(&self) -> Stats {
        self.frame.stats()
    }
}

impl<P: PixelFormat, D: DepthChoice, R: RecordsChoice, const N: usize, M> fmt::Debug
    for SupersampledFrame<'_, '_, P, D, R, N, M>
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SupersampledFrame").field("stats", &self.frame.stats()).finish_non_exhaustive()
    }
}

/// Makes the mean of each square of `N` × `N` pixels in rows of `width`, one after the other from the first pixel on.
///
/// Means lie in front of the rows that are still to be read. Those of the first `N` rows lie on them: mean x takes the
/// place of pixel x, when pixels from `N` x on are read.
#[inline(never)]
fn average<P: PixelFormat, M: Mean, const N: usize>(pixels: &mut [P::Raw], width: usize) {
    let (means, rows) = (width / N, N * width);
    for x in 0..means {
        let mut sum = PixelSum::<P, M>::new();
        for y in 0..N {
            let row = pixels.get(y * width + N * x..).and_then(|row| row.first_chunk::<N>());
            row.into_iter().flatten().for_each(|pixel| sum.add(*pixel));
        }
        if let Some(pixel) = pixels.get_mut(x) {
            *pixel = sum.mean((N * N) as u32);
        }
    }
    let (mut to, mut from) = (means, rows);
    while let Some((before, rest)) = pixels.split_at_mut_checked(from)
        && let (Some(before), Some(rest)) = (before.get_mut(to..to + means), rest.get(..rows))
    {
        average_rows::<P, M, N>(before, rest, width);
        (to, from) = (to + means, from + rows);
    }
}

/// Makes the means of the squares in `N` rows.
#[inline(always)]
fn average_rows<P: PixelFormat, M: Mean, const N: usize>(means: &mut [P::Raw], rows: &[P::Raw], width: usize) {
    // Rows that are not there, of two or three, are some others.
    let row = |y: usize| rows.get(y.min(N - 1) * width..).unwrap_or_default().chunks_exact(N);
    let mean = |squares: [&[P::Raw]; 4]| {
        let mut sum = PixelSum::<P, M>::new();
        let [a, b, c, d] = squares;
        add_row::<P, M, N>(&mut sum, a);
        add_row::<P, M, N>(&mut sum, b);
        if N > 2 {
            add_row::<P, M, N>(&mut sum, c);
        }
        if N > 3 {
            add_row::<P, M, N>(&mut sum, d);
        }
        sum.mean((N * N) as u32)
    };
    let to = means.iter_mut().zip(row(0).zip(row(1)));
    if N == 2 {
        to.for_each(|(to, (a, b))| *to = mean([a, b, a, b]));
    } else {
        to.zip(row(2).zip(row(3))).for_each(|((to, (a, b)), (c, d))| *to = mean([a, b, c, d]));
    }
}

/// Adds `N` pixels. Unrolled by hand: at `opt-level = "s"` a loop would stay a loop.
#[inline(always)]
fn add_row<P: PixelFormat, M: Mean, const N: usize>(sum: &mut PixelSum<P, M>, pixels: &[P::Raw]) {
    let Some([a, b, rest @ ..]) = pixels.first_chunk::<N>().map(<[_; N]>::as_slice) else { return };
    sum.add(*a);
    sum.add(*b);
    if let [c, rest @ ..] = rest {
        sum.add(*c);
        if let [d, ..] = rest {
            sum.add(*d);
        }
    }
}
