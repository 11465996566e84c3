//! Waving water by a vertex shader of its own, and a crate that floats on it.
//!
//! ```text
//! cargo run --release --example water -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use scenes::water::Sea;
use zstrip::color::Dithered;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::target::WithDepth;

struct Demonstration;

impl Demo for Demonstration {
    type Format = Dithered<Rgb565>;
    const NAME: &'static str = "water";
    const ABOUT: &'static str = "Water, waved by a vertex shader, and a crate on it.";
    const BACKGROUND: Rgb565 = Rgb565::BLACK;
    const MODES: &'static [&'static str] = &["breeze", "waves", "gale"];

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Self::Format, WithDepth> {
        Box::new(Sea::new(shot.screen, shot.turn(), [1, 2, 3][shot.mode]))
    }
}

fn main() -> std::process::ExitCode {
    show(Demonstration)
}
