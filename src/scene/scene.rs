//! The one place that calls every stage, in order: here the frame's calls, in `assembly` stages 2 to 7 (2 and 5 to 7 in `scan`, for
//! all shaders alike), in `triangle` the rest; `lines` and `stroke` do the same for lines and points, `canvas` for what is given
//! on the screen.
//!
//! A frame is drawn by a closure that calls [`Scene::draw`]. The closure runs in one of three phases: it *records* a band
//! of strips (stages 1 to 7), it *replays* the records of one strip (stages 8 to 11), or, where the records are too
//! small even for one strip, it draws that strip *directly* (all stages at once).

use super::state::State;
use crate::math::Projective;
use crate::mesh::{Bounds, BoundsNode, Mesh, Positions};
use crate::raster::PixelRect;
use crate::target::{Framebuffer, Records, Stats, StripRows};
use crate::vertex::{DepthRange, DepthScale, ScreenMatrix, Transform, Viewport};
use core::ops::Range;

/// What the closure's calls do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    Record,
    Replay,
    Direct,
}

/// Where pixels go while a strip is drawn.
#[derive(Debug)]
pub(crate) struct Target<'a, F> {
    pub(crate) framebuffer: &'a mut F,
    /// Depths of the strip's rows, one after the other.
    pub(crate) depth: &'a mut [u16],
    /// Rows of the strip.
    pub(crate) rows: Range<i32>,
}

/// What a frame is drawn through; see [`Renderer::frame`](crate::frame::Renderer::frame).
#[derive(Debug)]
pub struct Scene<'a, F> {
    pub(crate) screen: (u16, u16),
    pub(crate) viewport: Viewport,
    pub(crate) phase: Phase,
    pub(crate) records: Records<'a>,
    pub(crate) strips: &'a StripRows,
    /// Rows of the band that is recorded, replayed or drawn.
    pub(crate) band: Range<i32>,
    pub(crate) target: Target<'a, F>,
    pub(crate) stats: &'a mut Stats,
    /// Number of the next draw, and the first that differed from what was recorded.
    pub(crate) draws: u16,
    pub(crate) changed: Option<u16>,
}

/// Vertices of a mesh up to which it is not worth a test of its bounds.
const FEW_VERTICES: usize = 4;

impl<'a, F: Framebuffer> Scene<'a, F> {
    /// Whether something with these bounds may be seen in the part of the screen that is being drawn; what is not can be
    /// left out, with everything inside of it: a hierarchy of objects.
    ///
    /// The answer is the same in all calls of the closure that must draw the same. It counts near and far plane as borders,
    /// whatever [`State::range`] says of what lies beyond them.
    #[inline(never)]
    pub fn is_visible(&self, bounds: &Bounds, mvp: &Projective) -> bool {
        let mut view = ScreenMatrix::EMPTY;
        view.set_from(mvp, &self.viewport);
        self.sees(&view, bounds, DepthRange::Clip)
    }

    /// Maps clip space to a part of the screen from here on; nothing outside of it is touched. Each call of the closure
    /// starts with the whole screen.
    pub const fn set_viewport(&mut self, viewport: Viewport) {
        self.viewport = viewport;
    }

    /// Width and height of the screen.
    pub const fn screen(&self) -> (u16, u16) {
        self.screen
    }

    /// The pixels that may be drawn, in `rows` of the screen.
    #[inline(never)]
    pub(super) fn clip_rect(&self, rows: &Range<i32>) -> PixelRect {
        let (x, y) = (i32::from(self.viewport.x()), i32::from(self.viewport.y()));
        let viewport =
            PixelRect { x: x..x + i32::from(self.viewport.width()), y: y..y + i32::from(self.viewport.height()) };
        viewport.intersection(&PixelRect { x: 0..i32::from(self.screen.0), y: rows.clone() })
    }

    /// Whether something may be seen in the band.
    fn sees(&self, view: &ScreenMatrix, bounds: &Bounds, range: DepthRange) -> bool {
        let rect = self.clip_rect(&self.band);
        view.sees(bounds, &rect.x, &rect.y, range.clamped())
    }

    /// Which of 32 nodes of a hierarchy can be seen, from `next` on, a bit each, the lowest for the first; `next` moves on behind
    /// them. In a function of its own, so that what it takes has left the stack when they are drawn.
    #[inline(never)]
    pub(super) fn visible_nodes(
        &mut self,
        state: &State,
        nodes: &[BoundsNode],
        mvp: &Projective,
        next: &mut usize,
    ) -> u32 {
        let mut view = ScreenMatrix::EMPTY;
        view.set_from(mvp, &self.viewport);
        let (first, mut visible) = (*next, 0);
        while let (Some(node), Some(bit)) = (nodes.get(*next), 1_u32.checked_shl((*next - first) as u32)) {
            if self.sees(&view, &node.bounds, state.range) {
                visible |= bit;
                *next += 1;
            } else {
                self.stats.culled = self.stats.culled.wrapping_add(1);
                *next = usize::from(node.skip);
            }
        }
        visible
    }

    /// Starts recording a draw, or drawing it directly: makes the vertex transform, if there is anything to do.
    #[inline(never)]
    pub(super) fn begin_draw(
        &mut self,
        state: &State,
        mesh: &Mesh<'_>,
        mvp: &Projective,
        stride: usize,
        displaced: bool,
        transform: &mut Transform,
    ) -> bool {
        self.count_draw();
        let recording = self.is_recording();
        if self.overflowed() {
            return false;
        }
        let mut view = ScreenMatrix::EMPTY;
        view.set_from(mvp, &self.viewport);
        // A test takes as long as a few vertices do.
        let bounded = mesh.vertex_count() > FEW_VERTICES
            && !displaced
            && !matches!(mesh.data().positions, Positions::Homogeneous(_));
        let culled = bounded && !self.sees(&view, mesh.bounds(), state.range);
        if recording {
            // What is out of view leaves a header without vertices.
            let vertices = if culled { 0 } else { mesh.vertex_count() };
            self.records.begin_draw(fingerprint(state, mesh, mvp, &self.viewport, stride), vertices, stride);
            if self.overflowed() {
                return false;
            }
        }
        if culled {
            self.stats.culled = self.stats.culled.wrapping_add(1);
            self.end_draw();
            return false;
        }
        if F::RECORDS && !recording {
            self.records.begin_direct(mesh.vertex_count(), stride);
        }
        transform.set_from(&view, mesh, displaced);
        true
    }

    pub(super) fn end_draw(&mut self) {
        if self.is_recording() {
            self.records.end_draw();
        }
    }

    pub(super) fn is_recording(&self) -> bool {
        F::RECORDS && self.phase == Phase::Record
    }

    /// Whether the records are full, so that a walk is in vain.
    pub(crate) fn overflowed(&self) -> bool {
        F::RECORDS && self.records.overflowed()
    }

    /// Whether there is a place for each vertex of the current draw.
    pub(super) fn has_vertices(&self) -> bool {
        F::RECORDS && self.records.has_vertices()
    }

    /// Finds the records of a draw; `false` if they are not those of this one.
    #[inline(never)]
    pub(super) fn find_draw(&mut self, print: u32, vertices: usize, stride: usize) -> bool {
        let draw = self.count_draw();
        let found = self.changed.is_none() && self.records.replay_draw(print, vertices, stride);
        if !found {
            self.changed = self.changed.or(Some(draw));
        }
        found
    }

    pub(super) fn count_draw(&mut self) -> u16 {
        let draw = self.draws;
        self.draws = draw.saturating_add(1);
        self.stats.draws = self.stats.draws.wrapping_add(1);
        draw
    }
}

/// A word that differs, almost surely, between draws that would not leave the same records.
#[inline(never)]
pub(super) fn fingerprint(state: &State, mesh: &Mesh<'_>, mvp: &Projective, viewport: &Viewport, stride: usize) -> u32 {
    let ([ax, ay, az], [bx, by, bz]) = (mesh.bounds().center.to_bits(), mesh.bounds().half.to_bits());
    let rest = [
        viewport.x() as u32 ^ (viewport.y() as u32) << 16,
        u32::from(viewport.width()) | u32::from(viewport.height()) << 16,
        mesh.vertex_count() as u32 | (mesh.triangle_count() as u32) << 16,
        ax as u32,
        ay as u32,
        az as u32,
        bx as u32,
        by as u32,
        bz as u32,
        stride as u32 | (state.cull as u32) << 16 | (state.range as u32) << 20 | (state.front as u32) << 24,
        state.depth.compare as u32 | u32::from(state.depth.write) << 8 | (state.bias.constant as u32) << 16,
        state.bias.slope.to_bits() as u32,
        match state.depth_scale {
            DepthScale::Perspective => 0,
            DepthScale::Uniform { far } => far.to_bits() as u32,
        },
    ];
    // FNV-1a over words instead of bytes, two of them at once where there are many.
    let step = |hash: u32, word: u32| (hash ^ word).wrapping_mul(0x0100_0193).rotate_left(11);
    let entries = mvp.rows().as_flattened().iter();
    let hash = entries.fold(0x811C_9DC5, |hash, entry| step(step(hash, *entry as u32), (*entry >> 32) as u32));
    rest.iter().fold(hash, |hash, word| step(hash, *word))
}
