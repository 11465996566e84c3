//! A frame in the making: its strips are drawn one by one, each into a buffer of the caller.

use super::engine::{Engine, Progress};
use super::error::FrameError;
use crate::color::{PixelFormat, clear, resolve};
use crate::scene::Scene;
use crate::target::{DepthChoice, Further, RecordsChoice, Stats, Strip, StripPixels, WithoutDepth, WithoutRecords};
use core::marker::PhantomData;
use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};
use embedded_graphics_core::primitives::Rectangle;

/// A frame whose strips are pulled one by one: for DMA, async code, or any loop of one's own.
///
/// The closure draws the whole scene. It is called at least once per strip, and must draw the same each time. So
/// matrices and shaders are made once, in front of the loop, and the closure only borrows them.
///
/// # Blocking
///
/// One buffer is enough: it is drawn into, sent, and drawn into again.
///
/// ```
/// # use zstrip::embedded_graphics_core::{geometry::Size, pixelcolor::{Rgb888, RgbColor}};
/// # use zstrip::{color::Rgb565Be, Renderer};
/// # let mut depth = [0; 64 * 8];
/// # let mut renderer = Renderer::<Rgb565Be>::new(Size::new(64, 60))?.with_depth(&mut depth)?;
/// # let mut sent = 0;
/// # let mut spi_write = |bytes: &[u8]| sent += bytes.len();
/// let mut buffer = [0; 64 * 8];
/// let mut frame = renderer.begin(Rgb888::BLACK);
/// while let Some(strip) = frame.next_strip(&mut buffer, |scene| { /* scene.draw(...) */ })? {
///     spi_write(strip.bytes());
/// }
/// # assert_eq!(sent, 64 * 60 * 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # DMA
///
/// A DMA transfer needs a `'static` buffer of its own, so two of them take turns. The frame only borrows the free one
/// (`&mut *free`). After each call, whether it returned a strip, none or an error, the buffer is the caller's again,
/// and moves into the transfer.
///
/// ```
/// # use zstrip::embedded_graphics_core::{geometry::Size, pixelcolor::{Rgb888, RgbColor}, primitives::Rectangle};
/// # use zstrip::{color::Rgb565Be, frame::RamBudget, Renderer};
/// # let mut depth = [0; 64 * 8];
/// # struct Panel { busy: &'static mut [u16], sent: u32 }
/// # impl Panel {
/// #     fn new(buffer: &'static mut [u16]) -> Self { Self { busy: buffer, sent: 0 } }
/// #     fn send(&mut self, area: Rectangle, buffer: &'static mut [u16]) -> &'static mut [u16] {
/// #         self.sent += area.size.width * area.size.height;
/// #         core::mem::replace(&mut self.busy, buffer)
/// #     }
/// # }
/// # fn buffer() -> &'static mut [u16] { Box::leak(Box::new([0; WIDTH * ROWS])) }
/// const WIDTH: usize = 64;
/// const ROWS: usize = RamBudget::even_rows(60, 8) as usize; // 60 rows make ten strips of 6
/// let mut renderer = Renderer::<Rgb565Be>::new(Size::new(64, 60))?.with_depth(&mut depth)?;
/// let (mut free, other) = (buffer(), buffer()); // on a microcontroller from `static_cell`
/// let mut panel = Panel::new(other);
/// # for _ in 0..2 {
/// let mut frame = renderer.begin(Rgb888::BLACK);
/// while let Some(strip) = frame.next_strip(&mut *free, |scene| { /* scene.draw(...) */ })? {
///     let area = strip.area(); // the last use of `strip`
///     // Waits for the transfer of the other buffer, starts that of this one, and returns the other.
///     free = panel.send(area, free);
/// }
/// # }
/// # assert_eq!(panel.sent, 2 * 64 * 60);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// In a field of a struct, the buffer is drawn into as `&mut *self.free`, and sent as `core::mem::take(&mut
/// self.free)`. An 8-bit transfer takes the pixels as bytes: [`bytemuck::cast_slice_mut`]. After the loop, the last
/// transfer still runs.
///
/// Where the strip height does not divide the screen's, the last strip is shorter than the buffer. It lies at the
/// front, so the transfer sends the first `strip.pixels().len()` pixels. A transfer that can only send whole buffers
/// needs a height that divides: [`RamBudget::even_rows`](super::RamBudget::even_rows) finds one.
///
/// # Async
///
/// The strip takes its buffer along ([`StripPixels::into_pixels`] returns it), so that one strip can be sent while the
/// next one is drawn. Here `join` is that of `embassy-futures`; any other will do.
///
/// ```
/// # use core::{future::Future, pin::pin, task::{Context, Poll, Waker}};
/// # use zstrip::embedded_graphics_core::{geometry::Size, pixelcolor::{Rgb888, RgbColor}};
/// # use zstrip::{color::Rgb565Be, Renderer};
/// # struct Spi(usize);
/// # impl Spi {
/// #     async fn write(&mut self, bytes: &[u8]) -> Result<(), std::io::Error> { self.0 += bytes.len(); Ok(()) }
/// # }
/// # async fn join<A: Future, B: Future>(a: A, b: B) -> (A::Output, B::Output) {
/// #     let (mut a, mut b) = (pin!(a), pin!(b));
/// #     let (mut x, mut y) = (None, None);
/// #     core::future::poll_fn(move |context| {
/// #         if x.is_none() { if let Poll::Ready(value) = a.as_mut().poll(context) { x = Some(value); } }
/// #         if y.is_none() { if let Poll::Ready(value) = b.as_mut().poll(context) { y = Some(value); } }
/// #         if x.is_none() || y.is_none() { return Poll::Pending; }
/// #         Poll::Ready((x.take().unwrap(), y.take().unwrap()))
/// #     }).await
/// # }
/// use core::mem::take;
///
/// async fn show(
///     renderer: &mut Renderer<'_, Rgb565Be>, spi: &mut Spi, a: &mut [u16], mut b: &mut [u16],
/// ) -> Result<(), Box<dyn core::error::Error>> {
///     let mut frame = renderer.begin(Rgb888::BLACK);
///     let mut drawn = frame.next_strip(a, |scene| { /* scene.draw(...) */ })?;
///     while let Some(strip) = drawn {
///         let sending = spi.write(strip.bytes());
///         let drawing = async { frame.next_strip(take(&mut b), |scene| { /* scene.draw(...) */ }) };
///         let (sent, next) = join(sending, drawing).await;
///         sent?;
///         drawn = next?;
///         b = strip.into_pixels();
///     }
///     Ok(())
/// }
/// # let mut renderer = Renderer::<Rgb565Be>::new(Size::new(64, 60))?;
/// # let mut spi = Spi(0);
/// # let (mut a, mut b) = ([0; 64 * 8], [0; 64 * 8]);
/// # for _ in 0..2 {
/// #     let shown = pin!(show(&mut renderer, &mut spi, &mut a, &mut b)).poll(&mut Context::from_waker(Waker::noop()));
/// #     assert!(matches!(shown, Poll::Ready(Ok(()))));
/// # }
/// # assert_eq!(spi.0, 2 * 64 * 60 * 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Hand a buffer over as it is (`a`, `take(&mut b)`) where it comes back by `into_pixels`. Lend it (`&mut *free`) where
/// it must outlast the frame: after the last strip, and after an error, a buffer that was handed over is gone.
#[derive(Debug)]
#[must_use = "a frame draws nothing until its strips are pulled"]
pub struct Frame<'r, 'b, P: PixelFormat, D: DepthChoice = WithoutDepth, R = WithoutRecords> {
    engine: &'r mut Engine<'b>,
    /// Colours of samples 1 and up.
    further: D::Further<'r, P::Raw>,
    background: P::Raw,
    progress: Progress,
    choices: PhantomData<(D, R)>,
}

/// The closure of a frame, called through a pointer, so that the loop around it is linked once.
type DrawScene<'d, P, D, R> = dyn FnMut(&mut Scene<'_, Strip<'_, P, D, R>>) + 'd;

impl<'r, 'b, P: PixelFormat, D: DepthChoice, R: RecordsChoice> Frame<'r, 'b, P, D, R> {
    /// Starts a frame.
    pub(super) fn new(
        engine: &'r mut Engine<'b>,
        further: D::Further<'r, P::Raw>,
        background: impl Into<Rgb888>,
    ) -> Self {
        let color: Rgb888 = background.into();
        let background = P::pack([color.r(), color.g(), color.b()]);
        Self { engine, further, background, progress: Progress::new(), choices: PhantomData }
    }

    /// Draws the next strip into `buffer`. Returns `None` after the last strip.
    ///
    /// The first strip of a frame decides the height of all of them: as many rows as its buffer and the depth buffer
    /// hold. The last strip may have fewer. A buffer may be longer than the strip, and another one for each strip.
    ///
    /// # Errors
    /// [`FrameError::BufferTooShort`] if `buffer` does not hold the strip; the frame can go on with another one.
    /// [`FrameError::SceneChanged`] if `draw` drew something else than before in this frame; the frame is over. That
    /// error says which changes are noticed: only while records are replayed, and not all of them. Otherwise the
    /// picture is torn instead.
    pub fn next_strip<'c>(
        &mut self,
        buffer: &'c mut [P::Raw],
        mut draw: impl FnMut(&mut Scene<'_, Strip<'_, P, D, R>>),
    ) -> Result<Option<StripPixels<'c, P>>, FrameError> {
        self.draw_strip(buffer, &mut draw)
    }

    /// Draws the next strip.
    ///
    /// The closure is called through a pointer, about once per strip. So this function is linked once, however many
    /// closures a program has.
    pub(super) fn draw_strip<'c>(
        &mut self,
        buffer: &'c mut [P::Raw],
        draw: &mut DrawScene<'_, P, D, R>,
    ) -> Result<Option<StripPixels<'c, P>>, FrameError> {
        let Self { engine, further, background, progress, .. } = self;
        let (width, row, held) = (engine.width(), progress.row(), buffer.len());
        if row == 0 {
            let rows = engine.strip_rows(held);
            if rows == 0 {
                return Err(FrameError::BufferTooShort { pixels: held, needed: width });
            }
            engine.set_strip_rows(rows, R::RECORDS);
        }
        let Some(rows) = engine.next_rows(progress) else {
            return Ok(None);
        };
        let needed = width * usize::from(rows);
        let pixels = buffer.get_mut(..needed).ok_or(FrameError::BufferTooShort { pixels: held, needed })?;
        clear(pixels, *background);
        // The renderer has seen to it that the samples are long enough.
        let mut samples = D::first(further, needed * (D::SAMPLES - 1));
        if D::SAMPLES > 1 {
            clear(samples.samples().0, *background);
        }
        {
            let further = D::first(&mut samples, usize::MAX);
            let mut strip = Strip::<P, D, R>::new(&mut *pixels, further, width, u32::from(row));
            engine.next_strip(progress, &mut strip, rows, draw).map_err(|draw| FrameError::SceneChanged { draw })?;
        }
        match D::SAMPLES {
            1 => {}
            2 => resolve::<P, 1>(pixels, samples.samples().0),
            4 => resolve::<P, 3>(pixels, samples.samples().0),
            _ => resolve::<P, 7>(pixels, samples.samples().0),
        }
        let area = Rectangle::new(Point::new(0, i32::from(row)), Size::new(width as u32, u32::from(rows)));
        Ok(Some(StripPixels::new(area, pixels)))
    }

    /// Returns the counters of the work done so far.
    #[must_use]
    pub const fn stats(&self) -> Stats {
        self.progress.stats
    }
}
