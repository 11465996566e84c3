//! Draws frames strip by strip.

use super::engine::Engine;
use super::error::{FrameError, RendererError};
use super::frame::Frame;
use crate::color::PixelFormat;
use crate::scene::Scene;
use crate::target::{
    DepthChoice, NoSamples, OnDisplay, RecordsChoice, Stats, Strip, StripSink, WithCarriedState, WithDepth,
    WithOcclusion, WithRecords, WithSamples, WithoutDepth, WithoutRecords,
};
use core::marker::PhantomData;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::pixelcolor::Rgb888;

/// Draws frames in strips of the screen.
///
/// It borrows a depth buffer and memory for records, if it is given them, and its type says which of them it has. It
/// holds no colours: each frame, or each strip, is drawn into a buffer of the caller. The strip is as high as this
/// buffer and the depth buffer allow.
///
/// ```
/// use zstrip::embedded_graphics_core::{geometry::Size, pixelcolor::{Rgb565, Rgb888, RgbColor, WebColors}};
/// use zstrip::shader::Flat;
/// use zstrip::mesh::{Mesh, MeshData, Positions};
/// use zstrip::math::{Projective, Vec3};
/// use zstrip::frame::Renderer;
/// use zstrip::target::StripPixels;
///
/// static CORNERS: [Vec3; 3] = [Vec3::from_ints(-1, -1, 0), Vec3::from_ints(1, -1, 0), Vec3::from_ints(0, 1, 0)];
/// static TRIANGLE: Mesh<'static> = Mesh::constant(MeshData::new(Positions::Exact(&CORNERS)));
///
/// let (mut color, mut depth, mut records) = ([0; 320 * 16], [0; 320 * 16], [0; 64]);
/// let mut renderer =
///     Renderer::<Rgb565>::new(Size::new(320, 240))?.with_depth(&mut depth)?.with_records(&mut records);
/// let shader = Flat::unlit(Rgb888::CSS_ORANGE);
/// let mut strips = 0;
/// let sink = |_: &StripPixels<Rgb565>| Ok::<(), core::convert::Infallible>(strips += 1);
/// let stats = renderer.frame_to(sink, &mut color, Rgb888::BLACK, |scene| {
///     scene.draw(&TRIANGLE, &Projective::IDENTITY, &shader);
/// })?;
/// assert_eq!((strips, stats.drawn), (15, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Renderer<'b, P: PixelFormat, D: DepthChoice = WithoutDepth, R = WithoutRecords> {
    engine: Engine<'b>,
    /// Colours of samples 1 and up.
    further: D::Further<'b, P::Raw>,
    choices: PhantomData<(D, R)>,
}

impl<P: PixelFormat> Renderer<'_, P> {
    /// Makes a renderer for a screen, without depth and records: for embedded-graphics drawings, and pictures of one
    /// convex body.
    ///
    /// # Errors
    /// When the screen is empty or larger than [`Viewport::MAX_SIZE`](crate::vertex::Viewport::MAX_SIZE).
    pub fn new(screen: Size) -> Result<Self, RendererError> {
        Ok(Self { engine: Engine::new(screen)?, further: NoSamples, choices: PhantomData })
    }
}

impl<'b, P: PixelFormat, R> Renderer<'b, P, WithoutDepth, R> {
    /// Lends a depth buffer. Strips get no higher than the whole rows that it holds.
    ///
    /// Without one, every depth test passes, and what is drawn later covers what is there.
    ///
    /// # Errors
    /// When the buffer does not hold one row.
    pub fn with_depth(self, depth: &'b mut [u16]) -> Result<Renderer<'b, P, WithDepth, R>, RendererError> {
        Ok(Renderer { engine: self.engine.with_depth(depth, 1)?, further: NoSamples, choices: PhantomData })
    }

    /// Lends a depth buffer and colours for `N` samples per pixel, which make the edges of triangles smooth: 2, 4 or 8
    /// samples. `depth` has all depths of a strip, `N` per pixel, and `samples` the colours of all samples but one,
    /// `N` - 1 per pixel. The one that is left is in the colour buffer of the strip.
    ///
    /// A triangle covers the samples that lie inside of it, and each sample has a depth of its own. When a strip is
    /// done, each of its pixels becomes the mean of its samples. Lines, points, text and images cover whole pixels.
    /// [`AlphaToCoverage`](crate::shader::AlphaToCoverage) makes the edges within textures smooth, too.
    ///
    /// Strips get no higher than the whole rows that both buffers hold.
    ///
    /// ```
    /// # use zstrip::embedded_graphics_core::{geometry::Size, pixelcolor::{Rgb888, RgbColor}};
    /// use zstrip::{color::Rgb565Be, Renderer};
    ///
    /// // Strips of 4 rows: 20 KB for colours and depths of 4 samples.
    /// let (mut color, mut samples, mut depth) = ([0; 320 * 4], [0; 3 * 320 * 4], [0; 4 * 320 * 4]);
    /// let mut renderer =
    ///     Renderer::<Rgb565Be>::new(Size::new(320, 240))?.with_samples::<4>(&mut depth, &mut samples)?;
    /// let mut frame = renderer.begin(Rgb888::BLACK);
    /// while let Some(strip) = frame.next_strip(&mut color, |scene| { /* scene.draw(...) */ })? {
    ///     // Send it.
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When one of the buffers does not hold the samples of one row.
    pub fn with_samples<const N: usize>(
        self,
        depth: &'b mut [u16],
        samples: &'b mut [P::Raw],
    ) -> Result<Renderer<'b, P, WithSamples<N>, R>, RendererError>
    where
        WithSamples<N>: DepthChoice,
    {
        let engine = self.engine.with_depth(depth, N)?.with_samples(samples.len(), N - 1)?;
        Ok(Renderer { engine, further: WithSamples::<N>::lend(samples), choices: PhantomData })
    }
}

impl<'b, P: PixelFormat, R> Renderer<'b, P, WithDepth, R> {
    /// Leaves out draws that are hidden. The renderer keeps coarse depths for each strip: of blocks of 16 × 16 px, the
    /// farthest depth that is stored. A draw whose nearest depth is behind all blocks that it touches draws nothing
    /// there, and is skipped. The picture is the same, bit by bit. [`Stats::culled`] counts them.
    ///
    /// Coarse depths lie in the depth buffer, after the depths of a strip:
    /// [`occlusion_len`](crate::target::occlusion_len) numbers. If the buffer has no room for them, strips have fewer
    /// rows.
    ///
    /// **What is left out.** With records, draws of meshes in each strip: their pixels are not computed, but their
    /// vertices are, because nothing is known of depths while a band is recorded. A draw takes 2 more words of records.
    /// In strips that are drawn without records: draws of meshes of more than four vertices, by the box around the
    /// mesh, and nodes of its hierarchy, before any vertex is computed; and objects that a program asks for with
    /// [`Scene::is_visible_with`](crate::Scene::is_visible_with).
    ///
    /// **When it pays.** Draw near things first: only what is drawn before can hide what is drawn after. Draw by tests
    /// [`Less`](crate::span::Compare::Less), [`LessEqual`](crate::span::Compare::LessEqual) or
    /// [`Equal`](crate::span::Compare::Equal). Draws by any other test, or with a bias that pulls nearer, are never
    /// left out. A draw that may write farther depths makes the strip forget its coarse depths. `docs/speed.md` has
    /// figures.
    ///
    /// A [`Shader::span`](crate::span::Shader::span) of one's own has to write depths by its test alone, as the
    /// ready-made ones do.
    ///
    /// ```
    /// # use zstrip::embedded_graphics_core::{geometry::Size, pixelcolor::{Rgb565, Rgb888, RgbColor}};
    /// use zstrip::frame::Renderer;
    /// use zstrip::target::occlusion_len;
    ///
    /// // Strips of 16 rows, with coarse depths: 80 bytes more.
    /// let (mut color, mut depth) = ([0; 320 * 16], [0; 320 * 16 + occlusion_len(320, 16)]);
    /// let renderer = Renderer::<Rgb565>::new(Size::new(320, 240))?.with_depth(&mut depth)?;
    /// let mut renderer = renderer.with_occlusion()?;
    /// let mut frame = renderer.begin(Rgb888::BLACK);
    /// while let Some(strip) = frame.next_strip(&mut color, |scene| { /* draw near things, then far ones */ })? {
    ///     // Send it.
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the depth buffer does not hold one row and its coarse depths.
    pub fn with_occlusion(self) -> Result<Renderer<'b, P, WithOcclusion, R>, RendererError> {
        let engine = self.engine.with_occlusion()?;
        Ok(Renderer { engine, further: NoSamples, choices: PhantomData })
    }
}

impl<'b, P: PixelFormat, D: DepthChoice> Renderer<'b, P, D, WithoutRecords> {
    /// Lends memory for records, which keep transformed vertices and visible triangles from strip to strip; see
    /// [`records_len`](crate::target::records_len). It may be of any length: with less, the scene is transformed more
    /// often.
    ///
    /// Without records the scene is transformed once per strip, and a program is some KB smaller than one that lends
    /// empty records.
    #[must_use]
    pub fn with_records(self, records: &'b mut [u32]) -> Renderer<'b, P, D, WithRecords> {
        Renderer { engine: self.engine.with_records(records), further: self.further, choices: PhantomData }
    }
}

impl<'b, P: PixelFormat, D: DepthChoice> Renderer<'b, P, D, WithRecords> {
    /// Carries the state of small triangles on from strip to strip: their edges, their depth and the planes of their
    /// colours or texels. So a strip need not set up again what the strip above has set up. The picture is the same,
    /// bit by bit.
    ///
    /// This pays where strips are low. A torus of 1,024 triangles takes 35 to 45 % less instructions in strips of one
    /// row, and 10 to 15 % less in strips of 4 rows. In strips of 16 rows it takes 3 % less with Gouraud shading, and 1
    /// % more in one colour per triangle. `docs/speed.md` has the figures. A program gets larger by 0.5 to 1 KB per
    /// shader.
    ///
    /// States lie in the words that recording leaves free, 48 bytes for a flat triangle and 96 for others, up to 192
    /// for shaders of one's own. Only as many are there at a time as triangles cross the border of two strips. Without
    /// room, a triangle is set up in each strip. Large triangles are, too, and those of a shader whose
    /// [`Setup`](crate::span::Shader::Setup) is not `()`.
    ///
    /// ```
    /// # use zstrip::embedded_graphics_core::{geometry::Size, pixelcolor::{Rgb565, Rgb888, RgbColor}};
    /// use zstrip::frame::Renderer;
    /// use zstrip::target::records_len;
    ///
    /// // Strips of two rows; room for the records of 300 triangles and for the states of 60.
    /// let (mut color, mut depth) = ([0; 240 * 2], [0; 240 * 2]);
    /// let mut records = [0; records_len(120, 1, 200, 1, 300) + 60 * 12];
    /// let renderer = Renderer::<Rgb565>::new(Size::new(240, 240))?.with_depth(&mut depth)?;
    /// let mut renderer = renderer.with_records(&mut records).with_carried_state();
    /// let mut frame = renderer.begin(Rgb888::BLACK);
    /// while let Some(strip) = frame.next_strip(&mut color, |scene| { /* draw */ })? {
    ///     // Send it.
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_carried_state(self) -> Renderer<'b, P, D, WithCarriedState> {
        Renderer { engine: self.engine, further: self.further, choices: PhantomData }
    }
}

impl<'b, P: PixelFormat, D: DepthChoice, R: RecordsChoice> Renderer<'b, P, D, R> {
    /// Returns the size of the screen.
    #[must_use]
    pub fn screen(&self) -> Size {
        self.engine.screen()
    }

    /// Returns the rows of a strip in a frame whose first colour buffer holds `pixels` pixels; 0 if it does not hold
    /// one row.
    #[must_use]
    pub fn strip_rows(&self, pixels: usize) -> u32 {
        self.engine.strip_rows(pixels).into()
    }

    /// Draws a frame on an embedded-graphics display, strip by strip through `buffer`.
    ///
    /// `draw` draws the whole scene. It is called at least once per strip, and must draw the same each time. So
    /// matrices and shaders are made once, outside of it. Most changes are an error, and
    /// [`FrameError::SceneChanged`] lists those that are not noticed.
    ///
    /// # Errors
    /// The display's own error; [`FrameError::SceneChanged`]; [`FrameError::BufferTooShort`] if `buffer` does not
    /// hold one row. The next frame starts afresh.
    pub fn frame<T: DrawTarget<Color = P::Color>>(
        &mut self,
        display: &mut T,
        buffer: &mut [P::Raw],
        background: impl Into<Rgb888>,
        draw: impl FnMut(&mut Scene<'_, Strip<'_, P, D, R>>),
    ) -> Result<Stats, FrameError<T::Error>> {
        self.frame_to(OnDisplay::new(display), buffer, background, draw)
    }

    /// Draws a frame on a part of an embedded-graphics display, as large as the renderer's screen and with its corner
    /// at `top_left`; the rest of the display is left to others. See also [`FrameView`](crate::frame::FrameView).
    ///
    /// # Errors
    /// Those of [`frame`](Self::frame).
    pub fn frame_at<T: DrawTarget<Color = P::Color>>(
        &mut self,
        display: &mut T,
        top_left: Point,
        buffer: &mut [P::Raw],
        background: impl Into<Rgb888>,
        draw: impl FnMut(&mut Scene<'_, Strip<'_, P, D, R>>),
    ) -> Result<Stats, FrameError<T::Error>> {
        self.frame_to(OnDisplay::at(display, top_left), buffer, background, draw)
    }

    /// Draws a frame, strip by strip through `buffer`, and hands each finished strip to a sink.
    ///
    /// # Errors
    /// The sink's own error; [`FrameError::SceneChanged`]; [`FrameError::BufferTooShort`] if `buffer` does not hold
    /// one row. The next frame starts afresh.
    pub fn frame_to<K: StripSink<P>>(
        &mut self,
        mut sink: K,
        buffer: &mut [P::Raw],
        background: impl Into<Rgb888>,
        mut draw: impl FnMut(&mut Scene<'_, Strip<'_, P, D, R>>),
    ) -> Result<Stats, FrameError<K::Error>> {
        let mut frame = self.begin(background);
        while let Some(strip) = frame.draw_strip(buffer, &mut draw).map_err(FrameError::widen)? {
            sink.strip(&strip).map_err(FrameError::Sink)?;
        }
        Ok(frame.stats())
    }

    /// Starts a frame whose strips the caller pulls.
    pub fn begin(&mut self, background: impl Into<Rgb888>) -> Frame<'_, 'b, P, D, R> {
        Frame::new(&mut self.engine, D::first(&mut self.further, usize::MAX), background)
    }
}
