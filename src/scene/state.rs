//! The state of a draw: culling, depth test, depth range, bias and depth scale.

use crate::span::{DepthBias, DepthState};
use crate::vertex::{DepthRange, DepthScale, Side};

/// Faces that are not drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Cull {
    /// Faces that show their back are not drawn.
    #[default]
    Back,
    /// Faces that show their front are not drawn.
    Front,
    /// Every face is drawn.
    None,
}

/// Direction in which the corners of a front face go round on the screen, with y up.
///
/// A solid that looks hollow, or lit from the wrong side, is wound the other way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Winding {
    /// Against the clock.
    #[default]
    CounterClockwise,
    /// With the clock: for meshes that are built this way, and for mirrored models.
    Clockwise,
}

/// Rules that a mesh, lines or points are drawn by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct State {
    /// Faces that are left out.
    pub cull: Cull,
    /// Winding of front faces.
    pub front: Winding,
    /// The depth test.
    pub depth: DepthState,
    /// Treatment of geometry in front of the near plane and beyond the far plane.
    pub range: DepthRange,
    /// Offset that is added to depth.
    pub bias: DepthBias,
    /// Growth of depth with distance.
    pub depth_scale: DepthScale,
}

impl State {
    /// The default state as a constant: back faces are culled, nearer fragments win, and geometry is clipped at the
    /// near and the far plane.
    pub const DEFAULT: Self = Self {
        cull: Cull::Back,
        front: Winding::CounterClockwise,
        depth: DepthState::LESS,
        range: DepthRange::Clip,
        bias: DepthBias::NONE,
        depth_scale: DepthScale::Perspective,
    };
}

/// Faces that are left out, as masks for the signs of areas.
#[derive(Clone, Copy)]
pub(super) struct Culling {
    /// XORed with an area, so that faces that are left out become not negative: 0 or -1.
    flip: i8,
    /// ORed to an area, so that no face is left out: -1 if all faces are drawn, otherwise 0.
    keep: i8,
}

impl State {
    /// Returns the side that a triangle of this signed area, which is not 0, shows.
    #[inline]
    pub(super) fn side(&self, area: i64) -> Side {
        // y points down on the screen: a positive area goes with the clock.
        if (area > 0) == (self.front == Winding::CounterClockwise) { Side::Back } else { Side::Front }
    }

    /// Returns the faces that are left out.
    #[inline(never)]
    pub(super) fn culling(&self) -> Culling {
        let counter_clockwise = self.front == Winding::CounterClockwise;
        Culling {
            flip: if (self.cull == Cull::Front) == counter_clockwise { -1 } else { 0 },
            keep: if self.cull == Cull::None { -1 } else { 0 },
        }
    }
}

impl Culling {
    /// Returns whether a face of this area is left out. The upper half of an area has the area's sign, and is enough.
    /// The area is not 0.
    #[inline]
    pub(super) fn leaves_out(self, area: i32) -> bool {
        (area ^ i32::from(self.flip)) | i32::from(self.keep) >= 0
    }
}
