//! A figure that stands, walks and runs: a skin of joints with smooth weights, whose clips are blended by keys.
//!
//! ```text
//! cargo run --release --example character -- --help
//! ```
mod host;
mod models;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use minifb::Key;
use models::{Walker, Walking, Way};
use scenes::Draw;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::{Angle16, Scalar};
use zstrip::target::WithDepth;
use zstrip::{Framebuffer, Scene};

/// Milliseconds of a frame.
const FRAME: u32 = 17;

struct Character {
    walker: Walker,
    way: Way,
    /// The frame that was shown last.
    last: u32,
    mode: usize,
}

impl<F: Framebuffer> Draw<F> for Walking<'_> {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        Walking::draw(self, scene);
    }
}

impl Demo for Character {
    type Format = Rgb565;
    const NAME: &'static str = "character";
    const ABOUT: &'static str = "A figure with a skeleton, whose clips are blended: it stands, walks and runs.";
    const BACKGROUND: Rgb565 = models::BACKGROUND;
    const MODES: &'static [&'static str] = &["stand", "walk", "run"];
    const FIRST: usize = 1;
    const KEYS: &'static str = "  W, S              faster and slower\n";

    fn key(&mut self, key: Key) {
        let faster = match key {
            Key::W => 1 << 10,
            Key::S => -(1 << 10),
            _ => 0,
        };
        self.way.pace = Scalar::from_bits((self.way.pace.to_bits() + faster).clamp(0, 2 << 16));
    }

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Rgb565, WithDepth> {
        if shot.mode != self.mode {
            (self.mode, self.way.pace) = (shot.mode, Scalar::from_num(shot.mode));
        }
        // Frames back stand still.
        let frames = shot.number.saturating_sub(self.last);
        self.way.advance(frames.wrapping_mul(FRAME));
        self.last = shot.number;
        let turn = Angle16(shot.turn().0 / 4) + Angle16::from_degrees(40);
        Box::new(self.walker.place(shot.screen, &self.way, turn).expect("a screen of at least a pixel"))
    }
}

fn main() -> std::process::ExitCode {
    // Kept until the program ends.
    let memory = vec![0; Walker::WORDS].leak();
    let walker = Walker::new(memory).expect("a container that is checked in");
    show(Character { walker, way: Way::at(Scalar::ONE), last: 0, mode: Character::FIRST })
}
