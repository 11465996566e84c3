//! Rows that small triangles are drawn into: those of a strip, cut to the pixels that may be drawn.

use super::scene::Target;
use super::state::{State, Winding};
use crate::color::PixelFormat;
use crate::raster::{PixelRect, sampled};
use crate::span::{BiasSteps, DepthBias, LeftState, Sample, SmallTarget};
use crate::target::Framebuffer;
use crate::vertex::ScreenVertex;
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
}

impl<'p> SmallRows<'p> {
    #[inline(always)]
    pub(super) const fn new(
        screen: (u16, u16),
        clip: &'p PixelRect,
        state: &State,
        bias: Option<(BiasSteps, DepthBias)>,
    ) -> Self {
        Self { screen, clip, clockwise_fronts: matches!(state.front, Winding::Clockwise), bias }
    }

    /// Returns the row after the last one that may be drawn.
    pub(super) const fn end(&self) -> i32 {
        self.clip.y.end
    }

    /// Returns the rows that a triangle with these vertices may have pixels in. Its highest vertex is the first.
    #[inline(never)]
    pub(super) fn of<F: Framebuffer>(&self, [a, b, c]: &[ScreenVertex; 3]) -> Range<i32> {
        let Range { start, end } = sampled(a.y, b.y.max(c.y), F::SAMPLES);
        start.max(self.clip.y.start)..end.min(self.clip.y.end)
    }

    /// Returns all rows, if they lie one after the other; otherwise the given one, if there is one.
    #[inline(never)]
    pub(super) fn place<'t, F: Framebuffer>(
        &self,
        target: &'t mut Target<'_, F>,
        row: Option<i32>,
        state: Option<&'t mut LeftState>,
    ) -> Option<SmallTarget<'t, Raw<F>>> {
        let (width, first) = (usize::from(self.screen.0), target.rows.start);
        let length = width.wrapping_mul((target.rows.end - first) as usize);
        let together =
            F::SAMPLES == 1 && target.framebuffer.rows(first as u32, width).is_some_and(|rows| rows.len() >= length);
        let mut samples: &mut [_] = &mut [];
        let (color, depth, first, rows) = if F::SAMPLES > 1 {
            let [color, further] = target.framebuffer.samples()?;
            samples = further;
            (color, &mut *target.depth, first, self.clip.y.clone())
        } else if together {
            let color = target.framebuffer.rows(first as u32, width).unwrap_or_default();
            (color, &mut *target.depth, first, self.clip.y.clone())
        } else {
            let y = row?;
            let at = width.wrapping_mul((y - first) as usize);
            (target.framebuffer.row(y as u32), target.depth.get_mut(at..).unwrap_or_default(), y, y..y + 1)
        };
        let Self { screen, clip, clockwise_fronts, bias } = *self;
        let (columns, first, sample) = (clip.x.clone(), first as u16, Sample::new(0, F::SAMPLES));
        Some(SmallTarget { color, samples, sample, depth, first, columns, rows, screen, clockwise_fronts, bias, state })
    }
}
