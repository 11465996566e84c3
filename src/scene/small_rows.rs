//! Rows that small triangles are drawn into: those of a strip, cut to the pixels that may be drawn.

use super::scene::Target;
use super::state::{State, Winding};
use crate::color::PixelFormat;
use crate::raster::{PixelRect, first_centre};
use crate::span::{BiasSteps, DepthBias, SmallTarget};
use crate::target::Framebuffer;
use core::ops::Range;

/// A pixel of a framebuffer.
pub(super) type Raw<F> = <<F as Framebuffer>::Format as PixelFormat>::Raw;

/// The places where small triangles are drawn: all rows at once if they lie one after the other, or one row after the
/// other.
pub(super) struct SmallRows<'p> {
    screen: (u16, u16),
    clip: &'p PixelRect,
    clockwise_fronts: bool,
    bias: Option<(BiasSteps, DepthBias)>,
    /// The rows that are left.
    rows: Range<i32>,
}

impl<'p> SmallRows<'p> {
    #[inline(always)]
    pub(super) const fn new(
        screen: (u16, u16),
        clip: &'p PixelRect,
        state: &State,
        bias: Option<(BiasSteps, DepthBias)>,
    ) -> Self {
        Self { screen, clip, clockwise_fronts: matches!(state.front, Winding::Clockwise), bias, rows: 0..0 }
    }

    /// Begins with the first row that a triangle whose vertices have these second words can have pixels in. Its highest
    /// vertex is the first.
    #[inline(never)]
    pub(super) fn begin(&mut self, [a, b, c]: [u32; 3]) {
        let row = |word: u32| first_centre(word as i32 >> 8);
        self.rows = row(a).max(self.clip.y.start)..row(b).max(row(c)).min(self.clip.y.end);
    }

    /// Returns all rows, if they lie one after the other.
    #[inline(never)]
    pub(super) fn all<'t, F: Framebuffer>(&self, target: &'t mut Target<'_, F>) -> Option<SmallTarget<'t, Raw<F>>> {
        let (width, rows) = (usize::from(self.screen.0), &target.rows);
        let color = target.framebuffer.rows(rows.start as u32, width)?;
        if color.len() < width.wrapping_mul((rows.end - rows.start) as usize) {
            return None;
        }
        Some(self.target(color, target.depth, rows.start, self.clip.y.clone()))
    }

    /// Returns the next place.
    #[inline(never)]
    pub(super) fn next<'t, F: Framebuffer>(
        &mut self,
        target: &'t mut Target<'_, F>,
    ) -> Option<SmallTarget<'t, Raw<F>>> {
        let y = self.rows.next()?;
        let (width, first) = (usize::from(self.screen.0), target.rows.start);
        if target
            .framebuffer
            .rows(first as u32, width)
            .is_some_and(|rows| rows.len() >= width.wrapping_mul((target.rows.end - first) as usize))
        {
            self.rows.end = y;
            return self.all(target);
        }
        let at = width.wrapping_mul((y - first) as usize);
        let rows = y.max(self.clip.y.start)..(y + 1).min(self.clip.y.end);
        Some(self.target(target.framebuffer.row(y as u32), target.depth.get_mut(at..).unwrap_or_default(), y, rows))
    }

    fn target<'t, R>(
        &self,
        color: &'t mut [R],
        depth: &'t mut [u16],
        first: i32,
        rows: Range<i32>,
    ) -> SmallTarget<'t, R> {
        let Self { screen, clip, clockwise_fronts, bias, .. } = *self;
        SmallTarget { color, depth, first, columns: clip.x.clone(), rows, screen, clockwise_fronts, bias }
    }
}
