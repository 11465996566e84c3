//! 2-D drawing among the 3-D: canvases over the strip at hand, and where on the screen a point of the world is.

use super::Scene;
use crate::fragment::{AnyDepth, DepthState, DepthTest, LessWrite, NoDepth};
use crate::geometry::{Mesh, MeshData, Placed, Positions, ScreenVertex, Transform, place};
use crate::math::{Projective, Vec3};
use crate::output::{Canvas, Framebuffer};

/// What a transform of 16.16 positions is made for.
static POINTS: Mesh<'static> = Mesh::constant(MeshData::new(Positions::Exact(&[])));

impl<F: Framebuffer> Scene<'_, F> {
    /// An embedded-graphics target for the whole screen: what is drawn on it covers what has been drawn before, whatever
    /// the depth is, and leaves depths as they are.
    ///
    /// Drawing on it takes its turn among the draws of meshes. Like them it must be the same each time the closure is called,
    /// though nothing checks that; it is not counted in [`Stats`](crate::output::Stats).
    pub fn overlay(&mut self) -> Canvas<'_, F, NoDepth> {
        self.canvas(0, NoDepth)
    }

    /// The same at a depth: pixels are drawn where that is nearer than what is there, and leave it.
    ///
    /// [`project`](Self::project) tells the depth of a point. Without a depth buffer this is an overlay.
    pub fn at_depth(&mut self, z: u16) -> Canvas<'_, F, LessWrite> {
        self.canvas(z, LessWrite)
    }

    /// The same with a depth test of one's own.
    pub fn at_depth_with(&mut self, z: u16, state: DepthState) -> Canvas<'_, F, AnyDepth> {
        self.canvas(z, AnyDepth::new(state))
    }

    fn canvas<D: DepthTest>(&mut self, z: u16, test: D) -> Canvas<'_, F, D> {
        let target = self.target.as_mut().map(|t| (&mut *t.framebuffer, &mut *t.depth, t.rows.clone()));
        Canvas::new(target, self.screen, z, test)
    }

    /// Where a point is on the screen, bit for bit where a vertex there would be, with its depth; `None` if it is in front of
    /// the near plane, beyond the far plane or farther off the screen than 32,767 px.
    ///
    /// The answer is the same each time the closure is called.
    #[inline(never)]
    pub fn project(&self, point: Vec3, mvp: &Projective) -> Option<ScreenVertex> {
        match place(&Transform::new(mvp, &self.viewport, &POINTS, false).point(point)) {
            Placed::Screen(vertex) => Some(vertex),
            Placed::Outside(_) => None,
        }
    }
}
