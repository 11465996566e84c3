//! Waving water by a vertex shader of its own, and a crate that floats on it.
//!
//! ```text
//! cargo run --release --example water -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, show};
use scenes::water::water;
use zstrip::Scene;
use zstrip::color::Dithered;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::math::Angle16;
use zstrip::target::Strip;
use zstrip::target::{WithDepth, WithRecords};

struct Water;

impl Demo for Water {
    type Format = Dithered<Rgb565>;
    const NAME: &'static str = "water";
    const ABOUT: &'static str = "Water, waved by a vertex shader, and a crate on it.";
    const BACKGROUND: Rgb565 = Rgb565::BLACK;
    const MODES: &'static [&'static str] = &["breeze", "waves", "gale"];

    fn draw(&self, scene: &mut Scene<'_, Strip<'_, Self::Format, WithDepth, WithRecords>>, turn: Angle16, mode: usize) {
        water(scene, turn, [1, 2, 3][mode]);
    }
}

fn main() -> std::process::ExitCode {
    show(Water)
}
