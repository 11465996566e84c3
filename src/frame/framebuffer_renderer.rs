//! Draws frames straight into a framebuffer.

use super::engine::{Engine, Progress};
use super::error::{FrameError, RendererError};
use crate::color::{PixelFormat, clear};
use crate::scene::Scene;
use crate::target::{DepthChoice, Framebuffer, Stats, WithDepth, WithoutDepth};
use core::marker::PhantomData;
use embedded_graphics_core::geometry::Size;
use embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};

/// Draws frames straight into a framebuffer, with a depth buffer as high as the screen, or only a strip of it, or none.
///
/// ```
/// use zstrip::embedded_graphics_core::{geometry::Size, pixelcolor::{Rgb565, Rgb888, RgbColor}};
/// use zstrip::frame::FramebufferRenderer;
/// use zstrip::target::FrameSlice;
/// let (size, mut pixels, mut depth) = (Size::new(64, 48), [0; 64 * 48], [0; 64 * 16]);
/// let mut framebuffer = FrameSlice::<Rgb565>::new(&mut pixels, size)?;
/// let mut renderer = FramebufferRenderer::new(size)?.with_depth(&mut depth)?; // depth of 16 rows at a time
/// renderer.frame(&mut framebuffer, Rgb888::BLACK, |scene| { /* scene.draw(...) */ })?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct FramebufferRenderer<'b, D = WithoutDepth> {
    engine: Engine<'b>,
    choice: PhantomData<D>,
}

impl FramebufferRenderer<'_> {
    /// Makes a renderer for framebuffers without depth, such as [`Depthless`](crate::target::Depthless).
    ///
    /// # Errors
    /// When the screen is empty or larger than [`Viewport::MAX_SIZE`](crate::vertex::Viewport::MAX_SIZE).
    pub fn new(screen: Size) -> Result<Self, RendererError> {
        Ok(Self { engine: Engine::new(screen)?, choice: PhantomData })
    }
}

impl<'b> FramebufferRenderer<'b> {
    /// Lends a depth buffer: as many rows as it holds are drawn at a time.
    ///
    /// # Errors
    /// When the buffer does not hold one row.
    pub fn with_depth(self, depth: &'b mut [u16]) -> Result<FramebufferRenderer<'b, WithDepth>, RendererError> {
        Ok(FramebufferRenderer { engine: self.engine.with_depth(depth, 1)?, choice: PhantomData })
    }
}

impl<'b, D: DepthChoice> FramebufferRenderer<'b, D> {
    /// Lends memory for records; see [`records_len`](crate::target::records_len). They only matter if the depth
    /// buffer is shorter than the screen, so that the frame is drawn in strips. The framebuffer's type says if they
    /// are used: [`Framebuffer::RECORDS`].
    #[must_use]
    pub fn with_records(self, records: &'b mut [u32]) -> Self {
        Self { engine: self.engine.with_records(records), choice: PhantomData }
    }

    /// Draws a frame over `background`. The framebuffer's type ([`Framebuffer::DEPTH`]) and the renderer must agree
    /// on whether there is depth. If they do not, the call does not compile:
    ///
    /// ```compile_fail
    /// # use zstrip::embedded_graphics_core::{geometry::Size, pixelcolor::{Rgb565, Rgb888, RgbColor}};
    /// # use zstrip::frame::FramebufferRenderer;
    /// # use zstrip::target::FrameSlice;
    /// # let (size, mut pixels) = (Size::new(8, 8), [0; 64]);
    /// let mut framebuffer = FrameSlice::<Rgb565>::new(&mut pixels, size).expect("a framebuffer");
    /// let mut renderer = FramebufferRenderer::new(size).expect("a renderer");
    /// let _ = renderer.frame(&mut framebuffer, Rgb888::BLACK, |_| {});
    /// ```
    ///
    /// # Errors
    /// [`FrameError::SceneChanged`] if `draw` draws something else in a later call, and it is noticed.
    pub fn frame<F: Framebuffer>(
        &mut self,
        framebuffer: &mut F,
        background: impl Into<Rgb888>,
        draw: impl FnMut(&mut Scene<'_, F>),
    ) -> Result<Stats, FrameError> {
        let color: Rgb888 = background.into();
        let value = F::Format::pack([color.r(), color.g(), color.b()]);
        let width = self.engine.width();
        for y in 0..self.engine.screen().height {
            let row = framebuffer.row(y);
            let length = row.len().min(width);
            clear(row.get_mut(..length).unwrap_or_default(), value);
        }
        self.frame_over(framebuffer, draw)
    }

    /// Draws a frame over the pixels that are there.
    ///
    /// # Errors
    /// Those of [`frame`](Self::frame).
    pub fn frame_over<F: Framebuffer>(
        &mut self,
        framebuffer: &mut F,
        mut draw: impl FnMut(&mut Scene<'_, F>),
    ) -> Result<Stats, FrameError> {
        const { assert!(F::SAMPLES == D::SAMPLES, "renderer and framebuffer are not alike in their samples") };
        const { assert!(F::DEPTH == D::DEPTH, "renderer and framebuffer are not alike: one is without depth") };
        let Self { engine, .. } = self;
        engine.set_strip_rows(engine.strip_rows(usize::MAX), F::RECORDS);
        let mut progress = Progress::new();
        while let Some(rows) = engine.next_rows(&progress) {
            engine
                .next_strip(&mut progress, framebuffer, rows, &mut draw)
                .map_err(|draw| FrameError::SceneChanged { draw })?;
        }
        Ok(progress.stats)
    }
}
