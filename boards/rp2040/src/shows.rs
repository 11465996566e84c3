//! The frames of `model`, `character` and `part`, one after the other: models from zstrip's own examples.
//!
//! Like `scene`, it knows nothing of the board, so that a host can draw the pictures that the board's are compared
//! with.
#![allow(dead_code)] // each program uses its part

#[path = "../../../examples/models/mod.rs"]
mod models;

use models::{FLANGE, SPOT, Still, Walker, Walking, Way};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::light::Sunlit;
use zstrip::math::{Angle16, Scalar, Vec3};
use zstrip::model::Placed;

/// The screen.
pub const SIZE: Size = Size::new(240, 240);

/// The colour where nothing is drawn.
pub const BACKGROUND: Rgb565 = models::BACKGROUND;

/// Angle by which models turn from one frame to the next, in 65,536ths of a turn.
const TURN: u16 = 1024;

/// Time from one frame to the next.
const MILLISECONDS: u32 = 80;

/// A model that turns.
pub struct Turning {
    still: Still,
    towards_viewer: Vec3,
    turn: Angle16,
}

impl Turning {
    /// Returns the cow, her face to the viewer.
    pub fn cow() -> Self {
        Self::new(SPOT, Vec3::from_ints(0, 1, 3), Angle16::from_degrees(200))
    }

    /// Returns the flange, seen from above.
    pub fn part() -> Self {
        Self::new(FLANGE, Vec3::from_ints(0, 3, 4), Angle16(0))
    }

    fn new(file: &'static [u8], towards_viewer: Vec3, turn: Angle16) -> Self {
        Self { still: Still::new(file).expect("a container that is checked in"), towards_viewer, turn }
    }

    /// Makes a frame, outside of the closure that draws.
    pub fn next_frame(&mut self) -> Placed<'_, Sunlit> {
        self.turn += Angle16(TURN);
        self.still.place(SIZE, self.towards_viewer, self.turn).expect("a camera for the screen")
    }
}

/// The figure, which goes from walking to running, and then slower until it stands.
pub struct Going {
    walker: Walker,
    way: Way,
    turn: Angle16,
}

impl Going {
    /// Words of memory that the figure takes.
    pub const WORDS: usize = Walker::WORDS;

    /// Takes memory for the figure.
    pub fn new(memory: &'static mut [u32]) -> Self {
        let walker = Walker::new(memory).expect("memory, and a container that is checked in");
        Self { walker, way: Way::at(Scalar::ONE), turn: Angle16::from_degrees(40) }
    }

    /// Makes a frame, outside of the closure that draws.
    pub fn next_frame(&mut self) -> Walking<'_> {
        self.way.advance(MILLISECONDS);
        self.turn += Angle16(TURN / 8);
        // Up and down within eight seconds.
        self.way.pace = Scalar::ONE + Angle16((self.way.milliseconds() * 8) as u16).sin();
        self.walker.place(SIZE, &self.way, self.turn).expect("a camera for the screen")
    }
}
