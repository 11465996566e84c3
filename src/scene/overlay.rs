//! 2-D drawing among the 3-D by embedded-graphics: targets over the strip at hand, and where on the screen a point of the world is.

use super::scene::Scene;
use super::state::State;
use crate::math::{Projective, Vec3};
use crate::mesh::{Mesh, MeshData, Positions};
use crate::span::{DepthDyn, DepthLess, DepthOff, DepthState, DepthTest};
use crate::target::{Framebuffer, Overlay};
use crate::vertex::{Projected, ScreenVertex, Transform};

/// What a transform of 16.16 positions is made for.
static POINTS: Mesh<'static> = Mesh::constant(MeshData::new(Positions::Exact(&[])));

impl<F: Framebuffer> Scene<'_, F> {
    /// An embedded-graphics target for the whole screen: what is drawn on it covers what has been drawn before, whatever
    /// the depth is, and leaves depths as they are.
    ///
    /// Drawing on it takes its turn among the draws of meshes. Like them it must be the same each time the closure is called,
    /// though nothing checks that; it is not counted in [`Stats`](crate::target::Stats).
    pub fn overlay(&mut self) -> Overlay<'_, F, DepthOff> {
        self.target_at(0, DepthOff)
    }

    /// The same at a depth: pixels are drawn where that is nearer than what is there, and leave it.
    ///
    /// [`project`](Self::project) tells the depth of a point. Without a depth buffer this is an overlay.
    pub fn at_depth(&mut self, z: u16) -> Overlay<'_, F, DepthLess> {
        self.target_at(z, DepthLess)
    }

    /// The same with a depth test of one's own.
    pub fn at_depth_with(&mut self, z: u16, state: DepthState) -> Overlay<'_, F, DepthDyn> {
        self.target_at(z, DepthDyn::new(state))
    }

    fn target_at<D: DepthTest>(&mut self, z: u16, test: D) -> Overlay<'_, F, D> {
        let recording = self.is_recording();
        let target = &mut self.target;
        let target = (!recording).then(|| (&mut *target.framebuffer, &mut *target.depth, target.rows.clone()));
        Overlay::new(target, self.screen, z, test)
    }

    /// Where a point is on the screen, bit for bit where a vertex there would be, with its depth; `None` if it is in front of
    /// the near plane, beyond the far plane or farther off the screen than 32,767 px.
    ///
    /// The answer is the same each time the closure is called.
    pub fn project(&self, point: Vec3, mvp: &Projective) -> Option<ScreenVertex> {
        self.project_with(State::DEFAULT, point, mvp)
    }

    /// The same with the depth that [`State::depth_scale`] leads to. Neither [`State::range`] nor [`State::bias`] counts.
    #[inline(never)]
    pub fn project_with(&self, state: State, point: Vec3, mvp: &Projective) -> Option<ScreenVertex> {
        let mut transform = Transform::new(mvp, &self.viewport, &POINTS, false);
        transform.set_depth_scale(state.depth_scale);
        match transform.project_clip_vertex(&transform.point(point)) {
            Projected::OnScreen(vertex) => Some(vertex),
            Projected::NeedsClip(_) => None,
        }
    }
}
