//! 2-D drawing among 3-D: embedded-graphics targets over the current strip, and conversions between points in space and
//! positions on the screen.

use super::canvas::ScreenPoint;
use super::scene::{Scene, Target};
use super::state::State;
use crate::math::{Pixels, Projective, Vec3};
use crate::mesh::{Mesh, MeshData, Positions};
use crate::span::{DepthDyn, DepthLessEqual, DepthOff, DepthState, DepthTest};
use crate::target::{Framebuffer, Overlay, OverlayTarget};
use crate::vertex::{Projected, ScreenVertex, Transform};

/// A mesh without vertices, for transforms of 16.16 positions.
static POINTS: Mesh<'static> = Mesh::constant(MeshData::new(Positions::Exact(&[])));

impl<F: Framebuffer> Scene<'_, F> {
    /// Returns an embedded-graphics target for the whole screen. Drawings on it cover everything that was drawn before,
    /// whatever its depth is, and leave depths unchanged.
    ///
    /// Drawing on the target takes its turn among the draws of meshes. Like them, it must be identical each time the
    /// closure is called, though nothing checks this. It is not counted in [`Stats`](crate::target::Stats).
    pub fn overlay(&mut self) -> Overlay<'_, F, DepthOff> {
        self.target_at(0, DepthOff)
    }

    /// Returns an embedded-graphics target at a depth. A pixel is drawn where nothing is nearer than this depth, and
    /// the depth buffer then takes this depth. So drawings at one depth cover each other in their order, as a letter
    /// covers its background.
    ///
    /// [`project`](Self::project) tells the depth of a point. Without a depth buffer, this is
    /// [`overlay`](Self::overlay).
    pub fn at_depth(&mut self, z: u16) -> Overlay<'_, F, DepthLessEqual> {
        self.target_at(z, DepthLessEqual)
    }

    /// Returns an embedded-graphics target at a depth, with any depth test.
    pub fn at_depth_with(&mut self, z: u16, state: DepthState) -> Overlay<'_, F, DepthDyn> {
        if F::OCCLUDES {
            self.note_test(state);
        }
        self.target_at(z, DepthDyn::new(state))
    }

    fn target_at<D: DepthTest>(&mut self, z: u16, test: D) -> Overlay<'_, F, D> {
        let clip = self.clip_rect(&self.target.rows);
        let drawn = !self.is_recording() && !clip.is_empty();
        let Target { framebuffer, depth, rows } = &mut self.target;
        let target =
            drawn.then_some(OverlayTarget { framebuffer: &mut **framebuffer, depth, first_row: rows.start, clip });
        Overlay::new(target, self.screen, z, test)
    }

    /// Returns the position of a point on the screen and its depth: bit for bit the position of a vertex at this point.
    /// `None` if the point is in front of the near plane, beyond the far plane or farther off the screen than 32,767
    /// px.
    ///
    /// The result is the same each time the closure is called.
    #[must_use]
    pub fn project(&self, point: Vec3, mvp: &Projective) -> Option<ScreenVertex> {
        self.project_with(State::DEFAULT, point, mvp)
    }

    /// Returns the position of a point on the screen, with the depth that [`State::depth_scale`] leads to.
    /// [`State::range`] and [`State::bias`] have no effect.
    #[inline(never)]
    #[must_use]
    pub fn project_with(&self, state: State, point: Vec3, mvp: &Projective) -> Option<ScreenVertex> {
        let mut transform = Transform::new(mvp, &self.viewport, &POINTS, false);
        transform.set_depth_scale(state.depth_scale);
        match transform.project_clip_vertex(&transform.point(point)) {
            Projected::OnScreen(vertex) => Some(vertex),
            Projected::NeedsClip(_) => None,
        }
    }

    /// Returns the point of object space that is drawn at a position on the screen and at a depth: for example, the
    /// point under a finger. This inverts [`project`](Self::project). `None` if `mvp` has no inverse, or the point is
    /// out of range.
    ///
    /// A depth stands for all points that are rounded to it. [`DepthPrecision`](crate::math::DepthPrecision) tells how
    /// far apart they are.
    ///
    /// # Format
    /// Clip coordinates are computed in 32.32, and rounded down; the sums have 128 bits.
    #[inline(never)]
    pub fn unproject(&self, at: ScreenPoint, z: u16, mvp: &Projective) -> Option<Vec3> {
        let inverse = mvp.inverse()?;
        // Positions are in 24.8. x of clip space is 2 (X - left) / width - 1.
        let across = |at: Pixels, start: i16, size: u16| {
            let from_start = i64::from(at.to_bits()) - 256 * i64::from(start);
            ((from_start << 25).checked_div(size.into())).map(|fraction| i128::from(fraction - (1 << 32)))
        };
        let x = across(at.x(), self.viewport.x(), self.viewport.width())?;
        let y = -across(at.y(), self.viewport.y(), self.viewport.height())?;
        let z = (i128::from(z) << 32) / 65_535;
        let sum = |[a, b, c, d]: &[i64; 4]| {
            // Products of 64 bits and fewer than 48 bits.
            (i128::from(*a) * x + i128::from(*b) * y + i128::from(*c) * z + (i128::from(*d) << 32)) >> 32
        };
        let [rx, ry, rz, rw] = inverse.rows();
        let w = sum(rw);
        let coordinate = |row| (sum(row) << 16).checked_div(w).and_then(|bits| i32::try_from(bits).ok());
        Some(Vec3::from_bits([coordinate(rx)?, coordinate(ry)?, coordinate(rz)?]))
    }
}
