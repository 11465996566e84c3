//! The loop that makes a frame: bands of strips, recorded as large as the records allow, replayed strip by strip.

use crate::color::{PixelFormat, clear};
use crate::scene::{Phase, Scene, Target};
use crate::target::{
    Framebuffer, Layout, OnDisplay, Records, Stats, Strip, StripPixels, StripRows, StripSink, whole_rows,
};
use crate::vertex::{Viewport, ViewportError};
use core::fmt;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::primitives::Rectangle;

/// The memory a renderer works with, lent by the caller.
#[derive(Debug)]
pub struct Buffers<'b, P: PixelFormat> {
    /// Colours of a strip: as many whole rows as fit make its height, which `depth` limits as well.
    pub color: &'b mut [P::Raw],
    /// Depths of a strip.
    pub depth: &'b mut [u16],
    /// Records; may be empty. See [`records_len`](crate::target::records_len).
    pub records: &'b mut [u32],
}

/// Why a renderer could not be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RendererError {
    /// The screen is empty or too large.
    Screen(ViewportError),
    /// The colour buffer does not hold one row: how many pixels it has, and how many a row has.
    ColorTooShort(usize, u16),
    /// The depth buffer does not hold one row: how many pixels it has, and how many a row has.
    DepthTooShort(usize, u16),
}

impl fmt::Display for RendererError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Screen(error) => write!(f, "screen: {error}"),
            Self::ColorTooShort(has, width) => write!(f, "colour buffer of {has} pixels, one row has {width}"),
            Self::DepthTooShort(has, width) => write!(f, "depth buffer of {has} pixels, one row has {width}"),
        }
    }
}

impl core::error::Error for RendererError {}

/// Why a frame ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FrameError<E = core::convert::Infallible> {
    /// The sink, or the display, failed.
    Sink(E),
    /// The closure drew something else than in its call before: the number of the first draw that differed.
    SceneChanged(u16),
}

impl<E: fmt::Display> fmt::Display for FrameError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sink(error) => write!(f, "display: {error}"),
            Self::SceneChanged(draw) => write!(f, "draw {draw} differs from the call before in the same frame"),
        }
    }
}

impl<E: fmt::Debug + fmt::Display> core::error::Error for FrameError<E> {}

/// The screen and its strips.
#[derive(Clone, Copy, Debug)]
struct Grid {
    viewport: Viewport,
    strips: StripRows,
}

impl Grid {
    fn screen(&self) -> (u16, u16) {
        (self.viewport.width(), self.viewport.height())
    }

    /// Height of the strip that begins at `row`.
    fn rows_at(&self, row: u16) -> u16 {
        self.strips.rows.min(self.viewport.height() - row)
    }

    /// Strips from `row` on.
    fn strips_from(&self, row: u16) -> u16 {
        self.strips.of(u32::from(self.viewport.height() - row) - 1) as u16 + 1
    }

    /// The rows of so many strips that begin at `row`.
    fn band(&self, row: u16, strips: u16) -> (u16, u16) {
        let end = u32::from(row) + u32::from(strips) * u32::from(self.strips.rows);
        (row, end.min(u32::from(self.viewport.height())) as u16)
    }
}

/// What all renderers share: the screen, its strips, depth and records.
#[derive(Debug)]
struct Engine<'b> {
    grid: Grid,
    depth: &'b mut [u16],
    records: &'b mut [u32],
}

impl<'b> Engine<'b> {
    #[inline]
    fn new<const RECORDS: bool>(
        screen: (u16, u16),
        mut rows: usize,
        depth: Option<&'b mut [u16]>,
        records: &'b mut [u32],
    ) -> Result<Self, RendererError> {
        let viewport = Viewport::full(Size::new(screen.0.into(), screen.1.into())).map_err(RendererError::Screen)?;
        if let Some(depth) = &depth {
            rows = rows.min(whole_rows(depth.len(), screen.0));
            if rows == 0 {
                return Err(RendererError::DepthTooShort(depth.len(), screen.0));
            }
        }
        let (strip_rows, depth) = (rows.min(usize::from(screen.1)) as u16, depth.unwrap_or_default());
        Ok(Self { grid: Grid { viewport, strips: StripRows::new(strip_rows, RECORDS) }, depth, records })
    }
}

/// Where a frame is: which strip comes next, and which band is in the records.
#[derive(Clone, Copy, Debug)]
struct Progress {
    /// First row of the next strip.
    row: u16,
    /// Rows of the band in the records; none if it is used up.
    band: (u16, u16),
    /// Strips to try to record at once; 0 to draw the next one directly.
    strips: u16,
    layout: Layout,
    /// Draws in the records.
    draws: u16,
    stats: Stats,
}

impl Progress {
    fn new() -> Self {
        Self { row: 0, band: (0, 0), strips: u16::MAX, layout: Layout::default(), draws: 0, stats: Stats::default() }
    }
}

impl Progress {
    /// Goes on to the next strip.
    #[inline]
    fn end_strip(&mut self, rows: u16, phase: Phase) {
        if phase == Phase::Direct {
            self.strips = 1;
            self.stats.direct_strips = self.stats.direct_strips.wrapping_add(1);
        }
        self.row += rows;
        self.stats.strips = self.stats.strips.wrapping_add(1);
    }
}

impl Engine<'_> {
    /// Draws the next strip of so many rows, of which there must be one, into rows of `framebuffer`, which hold the background already;
    /// the number of the draw that differed is an error.
    ///
    /// If it is not in the records, a band that begins with it is recorded first: all the rest of the screen, or half of
    /// what was tried last, until it fits. Where not even one strip does, it is drawn directly.
    #[inline]
    fn next_strip<F: Framebuffer>(
        &mut self,
        progress: &mut Progress,
        framebuffer: &mut F,
        rows: u16,
        draw: &mut dyn FnMut(&mut Scene<'_, F>),
    ) -> Result<(), u16> {
        if F::DEPTH {
            let pixels = usize::from(self.grid.viewport.width()) * usize::from(rows);
            clear(self.depth.get_mut(..pixels).unwrap_or_default(), u16::MAX);
        }
        loop {
            let phase = if F::RECORDS { self.begin_walk(progress, rows) } else { Phase::Direct };
            if let Some(draw) = self.walk(progress, framebuffer, rows, phase, draw) {
                // What is left in the records is of no use: the frame is over.
                progress.row = self.grid.viewport.height();
                return Err(draw);
            }
            if phase != Phase::Record {
                progress.end_strip(rows, phase);
                return Ok(());
            }
        }
    }

    /// What the next walk does, with the records made ready for it.
    #[inline(never)]
    fn begin_walk(&mut self, progress: &mut Progress, rows: u16) -> Phase {
        let Progress { row, band, strips, layout, .. } = progress;
        let mut records = Records::new(self.records, layout);
        if *row < band.1 {
            records.begin_replay(self.grid.strips.of(u32::from(*row - band.0)));
            return Phase::Replay;
        }
        if *strips == 0 {
            *band = (*row, *row + rows);
            records.clear();
            return Phase::Direct;
        }
        *strips = self.grid.strips_from(*row).min(*strips);
        *band = self.grid.band(*row, *strips);
        records.begin_band(usize::from(*strips));
        Phase::Record
    }

    /// A walk over the scene; the number of the draw that differed from the walk before.
    fn walk<F: Framebuffer>(
        &mut self,
        progress: &mut Progress,
        framebuffer: &mut F,
        rows: u16,
        phase: Phase,
        draw: &mut dyn FnMut(&mut Scene<'_, F>),
    ) -> Option<u16> {
        let rows = i32::from(progress.row)..i32::from(progress.row + rows);
        let mut scene = Scene {
            screen: self.grid.screen(),
            viewport: self.grid.viewport,
            phase,
            records: Records::new(self.records, &mut progress.layout),
            strips: &self.grid.strips,
            band: if F::RECORDS { i32::from(progress.band.0)..i32::from(progress.band.1) } else { rows.clone() },
            target: Target { framebuffer, depth: self.depth, rows },
            stats: &mut progress.stats,
            draws: 0,
            changed: None,
        };
        // Records that cannot even hold the lists need no walk to overflow.
        if !scene.overflowed() {
            scene.stats.walks = scene.stats.walks.wrapping_add(1);
            draw(&mut scene);
        }
        if !F::RECORDS {
            return None;
        }
        let (draws, changed) = (scene.draws, scene.changed);
        match scene.phase {
            Phase::Record if scene.overflowed() => {
                scene.stats.overflows = scene.stats.overflows.wrapping_add(1);
                progress.strips /= 2;
                progress.band.1 = progress.band.0;
            }
            Phase::Record => progress.draws = draws,
            Phase::Replay if draws != progress.draws => return changed.or(Some(draws.min(progress.draws))),
            Phase::Replay | Phase::Direct => {}
        }
        changed
    }
}

/// Draws frames into strips.
///
/// ```
/// use embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor, WebColors};
/// use zstrip::shader::Flat;
/// use zstrip::mesh::{Mesh, MeshData, Positions};
/// use zstrip::math::{Projective, Vec3};
/// use zstrip::frame::{Buffers, Renderer};
/// use zstrip::target::StripPixels;
///
/// static CORNERS: [Vec3; 3] = [Vec3::from_ints(-1, -1, 0), Vec3::from_ints(1, -1, 0), Vec3::from_ints(0, 1, 0)];
/// static TRIANGLE: Mesh<'static> = Mesh::constant(MeshData::new(Positions::Exact(&CORNERS)));
///
/// let (mut color, mut depth, mut records) = ([0; 320 * 16], [0; 320 * 16], [0; 64]);
/// let buffers = Buffers { color: &mut color, depth: &mut depth, records: &mut records };
/// let mut renderer = Renderer::<Rgb565>::new((320, 240), buffers)?;
/// let mut strips = 0;
/// let sink = |_: &StripPixels<Rgb565>| Ok::<(), core::convert::Infallible>(strips += 1);
/// let stats = renderer.frame_to(sink, Rgb565::BLACK, |scene| {
///     scene.draw(&TRIANGLE, &Projective::IDENTITY, &Flat::unlit(Rgb888::CSS_ORANGE));
/// }).unwrap();
/// assert_eq!((strips, stats.drawn), (15, 1));
/// # Ok::<(), zstrip::frame::RendererError>(())
/// ```
#[derive(Debug)]
pub struct Renderer<'b, P: PixelFormat, const DEPTH: bool = true, const RECORDS: bool = true> {
    engine: Engine<'b>,
    color: &'b mut [P::Raw],
}

impl<'b, P: PixelFormat> Renderer<'b, P> {
    /// For a screen of `(width, height)` pixels; the strip is as high as the buffers allow.
    ///
    /// # Errors
    /// When the screen is empty or larger than [`Viewport::MAX_SIZE`], or a buffer does not hold one row.
    pub fn new(screen: (u16, u16), buffers: Buffers<'b, P>) -> Result<Self, RendererError> {
        Self::with_buffers(screen, buffers)
    }
}

impl<'b, P: PixelFormat> Renderer<'b, P, true, false> {
    /// The same without records: every strip takes a walk over the scene, and a program is some KB smaller than one that lends
    /// empty records.
    ///
    /// # Errors
    /// As [`new`](Renderer::new).
    pub fn without_records(
        screen: (u16, u16),
        color: &'b mut [P::Raw],
        depth: &'b mut [u16],
    ) -> Result<Self, RendererError> {
        Self::with_buffers(screen, Buffers { color, depth, records: &mut [] })
    }
}

impl<'b, P: PixelFormat> Renderer<'b, P, false> {
    /// The same without depth: every depth test passes, and what is drawn later covers what is there. Records may be empty.
    ///
    /// # Errors
    /// As [`new`](Renderer::new).
    pub fn without_depth(
        screen: (u16, u16),
        color: &'b mut [P::Raw],
        records: &'b mut [u32],
    ) -> Result<Self, RendererError> {
        Self::with_buffers(screen, Buffers { color, depth: &mut [], records })
    }
}

impl<'b, P: PixelFormat> Renderer<'b, P, false, false> {
    /// The same with neither: for embedded-graphics drawings, and pictures of one convex body.
    ///
    /// # Errors
    /// As [`new`](Renderer::new).
    pub fn color_only(screen: (u16, u16), color: &'b mut [P::Raw]) -> Result<Self, RendererError> {
        Self::with_buffers(screen, Buffers { color, depth: &mut [], records: &mut [] })
    }
}

impl<'b, P: PixelFormat, const DEPTH: bool, const RECORDS: bool> Renderer<'b, P, DEPTH, RECORDS> {
    /// [`new`](Renderer::new) for renderers of all kinds; buffers that one does not have may be empty.
    ///
    /// # Errors
    /// As [`new`](Renderer::new).
    pub fn with_buffers(screen: (u16, u16), buffers: Buffers<'b, P>) -> Result<Self, RendererError> {
        let Buffers { color, depth, records } = buffers;
        let rows = whole_rows(color.len(), screen.0);
        if rows == 0 {
            return Err(RendererError::ColorTooShort(color.len(), screen.0));
        }
        Ok(Self { engine: Engine::new::<RECORDS>(screen, rows, DEPTH.then_some(depth), records)?, color })
    }

    /// Width and height of the screen.
    pub fn screen(&self) -> (u16, u16) {
        self.engine.grid.screen()
    }

    /// Rows of a strip; the last one may have fewer.
    pub const fn strip_rows(&self) -> u16 {
        self.engine.grid.strips.rows
    }

    /// Draws a frame on an embedded-graphics display.
    ///
    /// `draw` draws the whole scene. It is called several times a frame, and must draw the same each time.
    ///
    /// # Errors
    /// The display's own, or [`FrameError::SceneChanged`]. The next frame starts afresh.
    pub fn frame<D: DrawTarget<Color = P::Color>>(
        &mut self,
        display: &mut D,
        background: P::Color,
        draw: impl FnMut(&mut Scene<'_, Strip<'_, P, DEPTH, RECORDS>>),
    ) -> Result<Stats, FrameError<D::Error>> {
        self.frame_to(OnDisplay::new(display), background, draw)
    }

    /// Draws a frame on a part of an embedded-graphics display, as large as the renderer's screen and with its corner at
    /// `top_left`; the rest of the display is left to others. See also [`FrameView`](crate::frame::FrameView).
    ///
    /// # Errors
    /// As [`frame`](Self::frame).
    pub fn frame_at<D: DrawTarget<Color = P::Color>>(
        &mut self,
        display: &mut D,
        top_left: Point,
        background: P::Color,
        draw: impl FnMut(&mut Scene<'_, Strip<'_, P, DEPTH, RECORDS>>),
    ) -> Result<Stats, FrameError<D::Error>> {
        self.frame_to(OnDisplay::at(display, top_left), background, draw)
    }

    /// Draws a frame, each finished strip going to a sink.
    ///
    /// # Errors
    /// The sink's own, or [`FrameError::SceneChanged`]. The next frame starts afresh.
    pub fn frame_to<K: StripSink<P>>(
        &mut self,
        mut sink: K,
        background: P::Color,
        mut draw: impl FnMut(&mut Scene<'_, Strip<'_, P, DEPTH, RECORDS>>),
    ) -> Result<Stats, FrameError<K::Error>> {
        let Frame { renderer: Self { engine, color }, background, mut progress } = self.begin(background);
        loop {
            match next_strip(engine, &mut progress, color, background, &mut draw) {
                Ok(Some(strip)) => sink.strip(&strip).map_err(FrameError::Sink)?,
                Ok(None) => return Ok(progress.stats),
                Err(FrameError::SceneChanged(draw)) => return Err(FrameError::SceneChanged(draw)),
                Err(FrameError::Sink(never)) => match never {},
            }
        }
    }

    /// Starts a frame whose strips the caller pulls.
    pub fn begin(&mut self, background: P::Color) -> Frame<'_, 'b, P, DEPTH, RECORDS> {
        Frame { renderer: self, background: P::from_color(background), progress: Progress::new() }
    }
}

/// A frame whose strips are pulled one by one: for DMA, async code, or any loop of one's own.
///
/// ```
/// # use embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
/// # use zstrip::color::Rgb565Be;
/// # use zstrip::frame::{Buffers, Renderer};
/// # let (mut color, mut depth) = ([0; 64 * 8], [0; 64 * 8]);
/// # let buffers = Buffers { color: &mut color, depth: &mut depth, records: &mut [] };
/// # let mut renderer = Renderer::<Rgb565Be>::new((64, 64), buffers)?;
/// # let mut sent = 0;
/// # let mut spi_write = |bytes: &[u8]| sent += bytes.len();
/// let mut frame = renderer.begin(Rgb565::BLACK);
/// while let Some(strip) = frame.next_strip(|scene| { /* scene.draw(...) */ })? {
///     spi_write(strip.bytes());
/// }
/// # assert_eq!(sent, 64 * 64 * 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Frame<'r, 'b, P: PixelFormat, const DEPTH: bool = true, const RECORDS: bool = true> {
    renderer: &'r mut Renderer<'b, P, DEPTH, RECORDS>,
    background: P::Raw,
    progress: Progress,
}

impl<P: PixelFormat, const DEPTH: bool, const RECORDS: bool> Frame<'_, '_, P, DEPTH, RECORDS> {
    /// Draws the next strip; `None` after the last.
    ///
    /// # Errors
    /// [`FrameError::SceneChanged`] if `draw` drew something else than before in this frame.
    pub fn next_strip(
        &mut self,
        mut draw: impl FnMut(&mut Scene<'_, Strip<'_, P, DEPTH, RECORDS>>),
    ) -> Result<Option<StripPixels<'_, P>>, FrameError> {
        let Renderer { engine, color } = &mut *self.renderer;
        next_strip(engine, &mut self.progress, color, self.background, &mut draw)
    }

    /// The same into a buffer of the caller's, so that one strip can be drawn while another is on its way.
    ///
    /// # Errors
    /// As [`next_strip`](Self::next_strip). A buffer shorter than the renderer's own strip gets no pixels behind its end,
    /// and the strip says how many there are.
    pub fn next_strip_in<'c>(
        &mut self,
        color: &'c mut [P::Raw],
        mut draw: impl FnMut(&mut Scene<'_, Strip<'_, P, DEPTH, RECORDS>>),
    ) -> Result<Option<StripPixels<'c, P>>, FrameError> {
        next_strip(&mut self.renderer.engine, &mut self.progress, color, self.background, &mut draw)
    }

    /// What was done so far.
    pub const fn stats(&self) -> Stats {
        self.progress.stats
    }
}

/// Draws the next strip of a frame into `color`, if there is one.
///
/// The closure is called through a pointer, once a strip or so: whatever many frames draw, this is linked once.
fn next_strip<'c, P: PixelFormat, const DEPTH: bool, const RECORDS: bool>(
    engine: &mut Engine<'_>,
    progress: &mut Progress,
    color: &'c mut [P::Raw],
    background: P::Raw,
    draw: &mut dyn FnMut(&mut Scene<'_, Strip<'_, P, DEPTH, RECORDS>>),
) -> Result<Option<StripPixels<'c, P>>, FrameError> {
    let (width, row) = (engine.grid.viewport.width(), progress.row);
    if row >= engine.grid.viewport.height() {
        return Ok(None);
    }
    let rows = engine.grid.rows_at(row);
    let length = (usize::from(width) * usize::from(rows)).min(color.len());
    let color = color.get_mut(..length).unwrap_or_default();
    clear(color, background);
    let mut strip = Strip::<P, DEPTH, RECORDS>::new(&mut *color, width, u32::from(row));
    engine.next_strip(progress, &mut strip, rows, draw).map_err(FrameError::SceneChanged)?;
    let area = Rectangle::new(Point::new(0, i32::from(row)), Size::new(u32::from(width), u32::from(rows)));
    Ok(Some(StripPixels::new(area, color)))
}

/// Draws frames straight into a framebuffer, with a depth buffer as high as the screen, or only a strip of it, or none.
#[derive(Debug)]
pub struct FramebufferRenderer<'b, const DEPTH: bool = true> {
    engine: Engine<'b>,
}

impl<'b> FramebufferRenderer<'b> {
    /// For a screen of `(width, height)` pixels; as many rows as `depth` holds are drawn at a time.
    ///
    /// # Errors
    /// When the screen is empty or larger than [`Viewport::MAX_SIZE`], or `depth` does not hold one row.
    pub fn new(screen: (u16, u16), depth: &'b mut [u16], records: &'b mut [u32]) -> Result<Self, RendererError> {
        Ok(Self { engine: Engine::new::<true>(screen, usize::MAX, Some(depth), records)? })
    }
}

impl<'b> FramebufferRenderer<'b, false> {
    /// For framebuffers without depth, such as [`WithoutDepth`](crate::target::WithoutDepth).
    ///
    /// # Errors
    /// When the screen is empty or larger than [`Viewport::MAX_SIZE`].
    pub fn without_depth(screen: (u16, u16), records: &'b mut [u32]) -> Result<Self, RendererError> {
        Ok(Self { engine: Engine::new::<true>(screen, usize::MAX, None, records)? })
    }
}

impl<const DEPTH: bool> FramebufferRenderer<'_, DEPTH> {
    /// Draws a frame over `background`, or over what is there. The framebuffer must be one with or without depth
    /// ([`Framebuffer::DEPTH`]) as the renderer is; another does not compile:
    ///
    /// ```compile_fail
    /// # use embedded_graphics_core::pixelcolor::Rgb565;
    /// # use zstrip::frame::FramebufferRenderer;
    /// # use zstrip::target::FrameSlice;
    /// # let mut pixels = [0; 64];
    /// let mut framebuffer = FrameSlice::<Rgb565>::new(&mut pixels, 8, 8).expect("a framebuffer");
    /// let mut renderer = FramebufferRenderer::without_depth((8, 8), &mut []).expect("a renderer");
    /// let _ = renderer.frame(&mut framebuffer, None, |_| {});
    /// ```
    ///
    /// # Errors
    /// [`FrameError::SceneChanged`] if `draw` draws something else in a later call.
    pub fn frame<F: Framebuffer>(
        &mut self,
        framebuffer: &mut F,
        background: Option<<F::Format as PixelFormat>::Color>,
        mut draw: impl FnMut(&mut Scene<'_, F>),
    ) -> Result<Stats, FrameError> {
        const { assert!(F::DEPTH == DEPTH, "renderer and framebuffer are not alike: one is without depth") };
        let (width, height) = self.engine.grid.screen();
        if let Some(color) = background {
            for y in 0..height {
                let row = framebuffer.row(u32::from(y));
                let length = row.len().min(usize::from(width));
                clear(row.get_mut(..length).unwrap_or_default(), F::Format::from_color(color));
            }
        }
        let mut progress = Progress::new();
        while progress.row < height {
            let rows = self.engine.grid.rows_at(progress.row);
            self.engine.next_strip(&mut progress, framebuffer, rows, &mut draw).map_err(FrameError::SceneChanged)?;
        }
        Ok(progress.stats)
    }
}
