//! Stages 8 to 11: a triangle on the screen → pixels.

use super::{State, Target};
use crate::fragment::{AnyDepth, Compare, DepthState, Fragments, LessWrite, MAX_SPAN, NoDepth, Shader, Steps};
use crate::geometry::{Correction, ScreenVertex, Varyings, signed_area};
use crate::output::Framebuffer;
use crate::raster::{Gradients, PixelRect, Trapezoids, homogenize, widen};

/// What the triangles of a draw are drawn with. Public for [`Draw`](super::stroke::Draw), but nobody can name it.
pub struct Painter<'p, 't, F, S> {
    pub(super) target: &'p mut Target<'t, F>,
    pub(super) screen: (u16, u16),
    /// Pixels that may be drawn: on the screen, and in the strip.
    pub(super) clip: &'p PixelRect,
    pub(super) state: &'p State,
    pub(super) shader: &'p S,
}

impl<F: Framebuffer, S: Shader<F::Format>> Painter<'_, '_, F, S> {
    /// The depth test: without a depth buffer, every fragment passes.
    pub(super) fn test(&self) -> DepthState {
        if self.target.depth.is_empty() { DepthState::OFF } else { self.state.depth }
    }

    /// Draws a triangle.
    #[inline(never)]
    pub(super) fn triangle(&mut self, v: &[ScreenVertex; 3], varyings: &[S::Varyings; 3], face: u32) {
        // 8. Plane equations of depth and varyings; from here on, values are those at the screen's corner.
        let area = signed_area(&v[0], &v[1], &v[2]);
        if area == 0 {
            return;
        }
        let gradients = Gradients::new(v, area, self.screen);
        let mut depth = gradients.plane([i32::from(v[0].z), i32::from(v[1].z), i32::from(v[2].z)], 16);
        if !self.state.bias.is_none() {
            let depths = v[0].z.min(v[1].z).min(v[2].z)..v[0].z.max(v[1].z).max(v[2].z);
            let steps = self.state.bias.steps(depths, depth.dx, depth.dy);
            depth.base = depth.base.wrapping_add((steps as u32) << 16);
        }
        let (mut corner, mut d_dx, mut d_dy) = (S::Varyings::ZERO, S::Varyings::ZERO, S::Varyings::ZERO);
        let level = self.shader.level(varyings, area.unsigned_abs());
        let mut correction = <S::Varyings as Varyings>::Correction::NONE;
        let (mut homogeneous, mut varyings) = (None, varyings);
        if S::Varyings::PERSPECTIVE > 0 {
            let (values, found) = homogenize(varyings, v, self.screen);
            correction = found;
            varyings = homogeneous.insert(values);
        }
        let values = [varyings[0].as_ref(), varyings[1].as_ref(), varyings[2].as_ref()];
        widen(&gradients, &values, &mut correction);
        for (k, ((corner, dx), dy)) in corner.as_mut().iter_mut().zip(d_dx.as_mut()).zip(d_dy.as_mut()).enumerate() {
            let value = |vertex: &[i32]| vertex.get(k).copied().unwrap_or(0) >> S::ZERO_BITS;
            let plane = gradients.plane([value(values[0]), value(values[1]), value(values[2])], S::ZERO_BITS);
            (*corner, *dx, *dy) = (plane.base as i32, plane.dx, plane.dy);
        }
        let words = self.shader.prepare(&mut corner, &d_dx);
        let steps = Steps { dz_dx: depth.dx, d_dx, words, side: self.state.side(area), level, correction };

        // 9. Spans, between two edges from row to row.
        let columns = &self.clip.x;
        let width = usize::from(self.screen.0);
        let test = self.test();
        let framebuffer = &mut *self.target.framebuffer;
        let mut nothing = [(); MAX_SPAN];
        let mut parts = Trapezoids::new(v, area, &self.clip.y);
        while let Some(rows) = parts.next() {
            let mut y = rows.start;
            // Column 0 of the row: where its depths are, and what is there; depth with the half that rounds.
            let mut row = width.wrapping_mul((y - self.target.rows.start) as usize);
            let mut z = depth.base.wrapping_add(1 << 15).wrapping_add_signed(depth.dy.wrapping_mul(y));
            let mut values = corner;
            for (value, dy) in values.as_mut().iter_mut().zip(d_dy.as_ref()) {
                *value = value.wrapping_add(dy.wrapping_mul(y));
            }
            while y < rows.end {
                let start = parts.left.pixel().max(columns.start);
                let length = parts.right.pixel().min(columns.end) - start;
                if length > 0 {
                    let (column, length) = (start as usize, length as usize);
                    let color = framebuffer.span(y as u32, column, length);
                    let mut varyings = values;
                    for (value, dx) in varyings.as_mut().iter_mut().zip(steps.d_dx.as_ref()) {
                        *value = value.wrapping_add(dx.wrapping_mul(start));
                    }
                    let z = z.wrapping_add_signed(steps.dz_dx.wrapping_mul(start));
                    // 10, 11. Depth test and fragments, in a loop of its own for each kind of test.
                    let (steps, position) = (&steps, (start, y));
                    if test == DepthState::OFF {
                        let depth = nothing.get_mut(..color.len()).unwrap_or_default();
                        let span = Fragments { color, depth, z, varyings, steps, position };
                        self.shader.span(face, span, NoDepth);
                    } else {
                        // As many depths as pixels, should the framebuffer be narrower than the screen.
                        let Some(depth) = self.target.depth.get_mut(row + column..) else { return };
                        let Some(depth) = depth.get_mut(..color.len()) else { return };
                        let span = Fragments { color, depth, z, varyings, steps, position };
                        match test {
                            DepthState { compare: Compare::Less, write: true } => {
                                self.shader.span(face, span, LessWrite);
                            }
                            other => self.shader.span(face, span, AnyDepth::new(other)),
                        }
                    }
                }
                parts.left.step();
                parts.right.step();
                y += 1;
                row += width;
                z = z.wrapping_add_signed(depth.dy);
                for (value, dy) in values.as_mut().iter_mut().zip(d_dy.as_ref()) {
                    *value = value.wrapping_add(*dy);
                }
            }
        }
    }
}
