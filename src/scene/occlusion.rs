//! What is hidden: draws, nodes of hierarchies and objects that lie behind all that has been drawn in their pixels of
//! the strip are left out. See [`Renderer::with_occlusion`](crate::frame::Renderer::with_occlusion).

use super::scene::{Draw, Phase, Scene};
use super::state::State;
use crate::math::Projective;
use crate::mesh::Bounds;
use crate::span::{Compare, DepthState};
use crate::target::{Coarse, Framebuffer};
use crate::vertex::{DepthScale, Extent, STEPS, ScreenMatrix, ScreenVertex};

/// Returns the greatest number for which stored depths below it hide fragments at a depth of `nearest` or farther; 0 if
/// nothing hides them.
fn limit(state: &State, nearest: u16) -> u32 {
    // A bias that pushes back, by whatever it comes to, leaves no pixel nearer than its triangle's vertices.
    if state.bias.constant < 0 || state.bias.slope < 0 {
        return 0;
    }
    match state.depth.compare {
        Compare::Less => u32::from(nearest) + 1,
        Compare::LessEqual | Compare::Equal => nearest.into(),
        _ => 0,
    }
}

impl<F: Framebuffer> Scene<'_, F> {
    /// Returns whether objects with these bounds may be visible, as [`is_visible`](Self::is_visible) does. A renderer
    /// with [occlusion](crate::frame::Renderer::with_occlusion) also answers `false` where it knows that all of the box
    /// lies behind what has been drawn, while strips are drawn without records.
    ///
    /// `state` is the state that the objects are drawn with: its depth test, bias and depth scale decide whether they
    /// can be hidden. Objects of several states are asked for one by one. All that is left out has to be drawn with
    /// this state, and to lie in the box: text at no depth, for example, would be left out although nothing hides it.
    ///
    /// While records are made or replayed, the answer is that of [`is_visible`](Self::is_visible), because it has to be
    /// the same for all strips. Hidden draws are left out there, too, one by one.
    #[must_use]
    pub fn is_visible_with(&mut self, state: State, bounds: &Bounds, mvp: &Projective) -> bool {
        let mut screen = ScreenMatrix::EMPTY;
        screen.set_from(mvp, &self.viewport);
        self.sees(&screen, bounds, 0, state.range) && !(F::OCCLUDES && self.hides_bounds(&state, &screen, bounds))
    }

    /// Returns the coarse depths of the strip.
    fn coarse(&mut self) -> Coarse<'_> {
        let rows = self.target.rows.end - self.target.rows.start;
        Coarse::new(self.target.depth, self.screen.0.into(), rows as usize)
    }

    /// Notes that something is drawn by a depth test. It may write depths that are farther than those that are there.
    #[inline]
    pub(super) fn note_test(&mut self, depth: DepthState) {
        let nearer = matches!(depth.compare, Compare::Never | Compare::Less | Compare::LessEqual | Compare::Equal);
        if F::OCCLUDES && depth.write && !nearer {
            self.coarse().forget();
        }
    }

    /// Returns whether a draw in the records is hidden in this strip.
    #[inline(never)]
    pub(super) fn hides_recorded(&mut self, state: &State) -> bool {
        let extent = self.records.extent();
        let hidden = self.hides(state, &extent);
        self.stats.culled = self.stats.culled.wrapping_add(hidden.into());
        hidden
    }

    /// Returns whether a draw that is about to be drawn at once is hidden.
    #[inline(never)]
    pub(super) fn hides_draw(&mut self, draw: &Draw<'_>, screen: &ScreenMatrix) -> bool {
        let hidden = draw.is_filled() && self.hides_bounds(draw.state, screen, draw.mesh.bounds());
        self.stats.culled = self.stats.culled.wrapping_add(hidden.into());
        hidden
    }

    /// Returns whether everything in a box is hidden in the strip that is drawn without records. In other phases
    /// nothing is, because all strips have to agree.
    #[inline(never)]
    pub(super) fn hides_bounds(&mut self, state: &State, screen: &ScreenMatrix, bounds: &Bounds) -> bool {
        // An extent takes time. It is of no use if its depth is on another scale.
        self.phase == Phase::Direct
            && state.depth_scale == DepthScale::Perspective
            && limit(state, u16::MAX) > 0
            && screen
                .extent(bounds, |center| self.may_hide(state, &center))
                .is_some_and(|extent| self.hides(state, &extent))
    }

    /// Returns whether an object whose centre is at a position may be hidden. It is not if a part of it is seen there.
    fn may_hide(&mut self, state: &State, center: &ScreenVertex) -> bool {
        // Off the pixels that may be drawn, nothing is hidden and nothing is seen: the extent decides.
        let mut extent = Extent::EMPTY;
        extent.widen(center.x, center.y, center.z.saturating_add(STEPS));
        self.hides(state, &extent.to_pixels())
    }

    /// Returns whether all that has an extent is hidden in this strip.
    fn hides(&mut self, state: &State, extent: &Extent) -> bool {
        let limit = limit(state, extent.nearest);
        let (clip, first) = (self.clip_rect(&self.target.rows), self.target.rows.start);
        limit > 0 && self.coarse().hides(limit, extent, (&clip.x, &clip.y), first)
    }
}
