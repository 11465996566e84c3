//! The loop that makes a frame: bands of strips, recorded as large as the records allow, replayed strip by strip.

use super::error::RendererError;
use crate::color::clear;
use crate::scene::{Phase, Scene, Target};
use crate::target::{Framebuffer, Layout, Records, Stats, StripRows, occlusion_len, whole_rows};
use crate::vertex::Viewport;
use embedded_graphics_core::geometry::Size;

/// The screen and its strips.
#[derive(Clone, Copy, Debug)]
struct Grid {
    viewport: Viewport,
    /// Rows that the depth buffer holds, or rows of the screen if they are fewer.
    most_rows: u16,
    /// Strips of the frame at hand.
    strips: StripRows,
}

impl Grid {
    fn screen(&self) -> (u16, u16) {
        (self.viewport.width(), self.viewport.height())
    }

    /// Returns the rows of a strip whose colour buffer holds a number of pixels; 0 if it does not hold one row.
    fn strip_rows(&self, pixels: usize) -> u16 {
        let (width, most) = (self.viewport.width(), self.most_rows);
        // At most 2²⁴, which `usize` may not hold.
        let holds_all = usize::try_from(u32::from(width) * u32::from(most)).is_ok_and(|all| pixels >= all);
        if holds_all { most } else { whole_rows(pixels, width) as u16 }
    }

    /// Returns the height of the strip that begins at `row`.
    fn rows_at(&self, row: u16) -> u16 {
        self.strips.rows.min(self.viewport.height() - row)
    }

    /// Counts the strips from `row` on.
    fn strips_from(&self, row: u16) -> u16 {
        self.strips.of(u32::from(self.viewport.height() - row) - 1) as u16 + 1
    }

    /// Returns the first row of a number of strips that begin at `row`, and the row after their last one.
    fn band(&self, row: u16, strips: u16) -> (u16, u16) {
        let end = u32::from(row) + u32::from(strips) * u32::from(self.strips.rows);
        (row, end.min(u32::from(self.viewport.height())) as u16)
    }
}

/// The part that all renderers share: the screen, its strips, depth and records.
#[derive(Debug)]
pub(super) struct Engine<'b> {
    grid: Grid,
    depth: &'b mut [u16],
    records: &'b mut [u32],
}

impl<'b> Engine<'b> {
    /// Makes an engine for a screen, without depth and records.
    #[inline]
    pub(super) fn new(screen: Size) -> Result<Self, RendererError> {
        let viewport = Viewport::full(screen).map_err(RendererError::Screen)?;
        let grid = Grid { viewport, most_rows: viewport.height(), strips: StripRows::UNSET };
        Ok(Self { grid, depth: &mut [], records: &mut [] })
    }

    /// Takes a depth buffer of a number of samples per pixel, whose rows limit the height of strips.
    #[inline]
    pub(super) fn with_depth(mut self, depth: &'b mut [u16], samples: usize) -> Result<Self, RendererError> {
        let rows = self.strip_rows(depth.len() / samples);
        if rows == 0 {
            return Err(RendererError::DepthTooShort { pixels: depth.len(), needed: samples * self.width() });
        }
        self.grid.most_rows = rows;
        self.depth = depth;
        Ok(self)
    }

    /// Takes the number of pixels that the colours of one more sample have, which limits the height of strips, too.
    #[inline]
    pub(super) fn with_samples(mut self, pixels: usize, further: usize) -> Result<Self, RendererError> {
        if further == 0 {
            return Ok(self);
        }
        let rows = self.strip_rows(pixels / further);
        if rows == 0 {
            return Err(RendererError::SamplesTooShort { pixels, needed: further * self.width() });
        }
        self.grid.most_rows = rows;
        Ok(self)
    }

    /// Leaves room for coarse depths after the depths of a strip, which limits the height of strips.
    #[inline]
    pub(super) fn with_occlusion(mut self) -> Result<Self, RendererError> {
        let (width, pixels, mut rows) = (self.width(), self.depth.len(), usize::from(self.grid.most_rows));
        let needed = |rows: usize| width.saturating_mul(rows).saturating_add(occlusion_len(width, rows));
        // Coarse depths take less than a row for every 16 rows that are 32 px wide or wider.
        while needed(rows) > pixels && rows > 0 {
            rows -= 1;
        }
        if rows == 0 {
            return Err(RendererError::DepthTooShort { pixels, needed: needed(1) });
        }
        self.grid.most_rows = rows as u16;
        Ok(self)
    }

    /// Takes memory for records.
    #[inline]
    pub(super) fn with_records(self, records: &'b mut [u32]) -> Self {
        Self { records, ..self }
    }

    /// Returns the size of the screen.
    pub(super) fn screen(&self) -> Size {
        let (width, height) = self.grid.screen();
        Size::new(width.into(), height.into())
    }

    /// Returns the pixels of a row.
    pub(super) fn width(&self) -> usize {
        self.grid.viewport.width().into()
    }

    /// Returns the rows of a strip whose colour buffer holds a number of pixels; 0 if it does not hold one row.
    pub(super) fn strip_rows(&self, pixels: usize) -> u16 {
        self.grid.strip_rows(pixels)
    }

    /// Sets the height of a frame's strips.
    #[inline]
    pub(super) fn set_strip_rows(&mut self, rows: u16, records: bool) {
        if rows != self.grid.strips.rows {
            self.grid.strips = StripRows::new(rows, records);
        }
    }
}

/// The state of a frame: which strip comes next, and which band is in the records.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    /// First row of the next strip.
    row: u16,
    /// Rows of the band in the records; none if it is used up.
    band: (u16, u16),
    /// Strips to try to record at once; 0 to draw the next one directly.
    strips: u16,
    /// Walks that may still be given up in this frame, so that records that are too small cost little.
    tries: u16,
    /// Strips to draw directly before the next try to record a band, and such strips drawn so far.
    patience: u16,
    waited: u16,
    layout: Layout,
    /// Draws in the records.
    draws: u32,
    pub(super) stats: Stats,
}

impl Progress {
    /// Starts a frame.
    pub(super) fn new() -> Self {
        Self {
            row: 0,
            band: (0, 0),
            strips: u16::MAX,
            tries: 0,
            patience: 1,
            waited: 0,
            layout: Layout::default(),
            draws: 0,
            stats: Stats::default(),
        }
    }

    /// Returns the first row of the next strip.
    pub(super) fn row(&self) -> u16 {
        self.row
    }

    /// Goes on to the next strip.
    #[inline]
    fn end_strip(&mut self, rows: u16, phase: Phase) {
        if phase == Phase::Direct {
            self.waited += 1;
            if self.waited == self.patience && self.tries > 0 {
                (self.strips, self.patience, self.waited) = (2, 2 * self.patience, 0);
            }
            self.stats.direct_strips = self.stats.direct_strips.wrapping_add(1);
        }
        self.row += rows;
        self.stats.strips = self.stats.strips.wrapping_add(1);
    }

    /// Gives up a band that did not fit, and goes on to half of it. A band of one strip would save nothing.
    fn halve_band(&mut self) {
        self.band.1 = self.band.0;
        self.strips = if self.strips < 4 || self.tries == 0 { 0 } else { self.strips / 2 };
    }
}

impl Engine<'_> {
    /// Returns the rows of the next strip; `None` after the last.
    pub(super) fn next_rows(&self, progress: &Progress) -> Option<u16> {
        let rows = self.grid.rows_at(progress.row);
        (rows > 0).then_some(rows)
    }

    /// Draws the next strip, which has `rows` rows, into `framebuffer`, which holds the background already. Fails with
    /// the number of the draw that differed.
    ///
    /// If the strip is not in the records, a band that begins with it is recorded first: all the rest of the screen,
    /// or half of the band tried last, until it fits. If not even two strips fit, the strip is drawn directly.
    ///
    /// A walk that records in vain may take as long as a strip that is drawn directly. So a frame gives up two walks,
    /// or one for eight of its strips, at most, and from try to try it draws twice as many strips directly.
    #[inline]
    pub(super) fn next_strip<F: Framebuffer>(
        &mut self,
        progress: &mut Progress,
        framebuffer: &mut F,
        rows: u16,
        draw: &mut dyn FnMut(&mut Scene<'_, F>),
    ) -> Result<(), u32> {
        if F::DEPTH {
            let (width, rows) = (usize::from(self.grid.viewport.width()), usize::from(rows));
            let mut pixels = width * rows * F::SAMPLES;
            if F::OCCLUDES {
                // Coarse depths follow the strip's depths, and begin as far away as these.
                pixels += occlusion_len(width, rows);
            }
            let depth = self.depth.get_mut(..pixels).unwrap_or_default();
            clear(depth, u16::MAX);
        }
        loop {
            let phase = if F::RECORDS { self.begin_walk(progress, rows) } else { Phase::Direct };
            if let Some(draw) = self.walk(progress, framebuffer, rows, phase, draw) {
                // The rest of the records is of no use: the frame is over.
                progress.row = self.grid.viewport.height();
                return Err(draw);
            }
            if phase != Phase::Record {
                progress.end_strip(rows, phase);
                return Ok(());
            }
            if F::CARRIES {
                Records::new(self.records, &mut progress.layout).begin_carrying();
            }
        }
    }

    /// Decides what the next walk does, and makes the records ready for it.
    #[inline(never)]
    fn begin_walk(&mut self, progress: &mut Progress, rows: u16) -> Phase {
        let Progress { row, band, strips, tries, layout, .. } = progress;
        let mut records = Records::new(self.records, layout);
        if *row < band.1 {
            records.begin_replay(self.grid.strips.of(u32::from(*row - band.0)));
            return Phase::Replay;
        }
        let rest = self.grid.strips_from(*row);
        // A band of one strip would save nothing.
        if *strips == 0 || rest == 1 {
            *band = (*row, *row + rows);
            records.clear();
            return Phase::Direct;
        }
        if *strips == u16::MAX {
            *tries = (rest >> 3).max(2);
        }
        *strips = rest.min(*strips);
        *band = self.grid.band(*row, *strips);
        records.begin_band(usize::from(*strips));
        Phase::Record
    }

    /// Walks over the scene once. Returns the number of the draw that differed from the walk before.
    fn walk<F: Framebuffer>(
        &mut self,
        progress: &mut Progress,
        framebuffer: &mut F,
        rows: u16,
        phase: Phase,
        draw: &mut dyn FnMut(&mut Scene<'_, F>),
    ) -> Option<u32> {
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
        // Records too short for the lists have overflowed already, and need no walk.
        let ready = !scene.overflowed();
        if ready {
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
                progress.tries = progress.tries.saturating_sub(ready.into());
                progress.halve_band();
            }
            Phase::Record => progress.draws = draws,
            Phase::Replay if draws != progress.draws => return changed.or(Some(draws.min(progress.draws))),
            Phase::Replay | Phase::Direct => {}
        }
        changed
    }
}
