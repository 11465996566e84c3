//! How a draw is drawn.

use crate::span::{DepthBias, DepthState};
use crate::vertex::{DepthRange, DepthScale, Side};

/// Which faces are not drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Cull {
    /// Those that show their back.
    #[default]
    Back,
    /// Those that show their front.
    Front,
    /// Every face is drawn.
    None,
}

/// Which way the corners of a front face go round on the screen, with y up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Winding {
    /// Against the clock.
    #[default]
    CounterClockwise,
    /// With the clock: for meshes made that way, and for mirrored models.
    Clockwise,
}

/// How a draw is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct State {
    /// Which faces are left out.
    pub cull: Cull,
    /// Which faces are front faces.
    pub front: Winding,
    /// The depth test.
    pub depth: DepthState,
    /// What happens before the near and beyond the far plane.
    pub range: DepthRange,
    /// What is added to depth.
    pub bias: DepthBias,
    /// How depth grows with distance.
    pub depth_scale: DepthScale,
}

impl State {
    /// The default, for constants: back faces culled, nearer fragments win, clipped at the near and the far plane.
    pub const DEFAULT: Self = Self {
        cull: Cull::Back,
        front: Winding::CounterClockwise,
        depth: DepthState::LESS,
        range: DepthRange::Clip,
        bias: DepthBias::NONE,
        depth_scale: DepthScale::Perspective,
    };
}

/// Which faces are left out.
#[derive(Clone, Copy)]
pub(super) struct Culling {
    /// What the sign of an area is changed by, so that faces that are left out have none.
    flip: i8,
    /// Negative if none are left out.
    keep: i8,
}

impl State {
    /// The side that a triangle of this signed area, which is not 0, shows.
    #[inline]
    pub(super) fn side(&self, area: i64) -> Side {
        // y points down here: a positive area goes with the clock.
        if (area > 0) == (self.front == Winding::CounterClockwise) { Side::Back } else { Side::Front }
    }

    /// Which faces are left out.
    pub(super) fn culling(&self) -> Culling {
        let counter_clockwise = self.front == Winding::CounterClockwise;
        Culling {
            flip: if (self.cull == Cull::Front) == counter_clockwise { -1 } else { 0 },
            keep: if self.cull == Cull::None { -1 } else { 0 },
        }
    }
}

impl Culling {
    /// Whether a face of this area, or of the upper half of it, is left out; the area is not 0.
    #[inline]
    pub(super) fn leaves_out(self, area: i32) -> bool {
        (area ^ i32::from(self.flip)) | i32::from(self.keep) >= 0
    }
}
