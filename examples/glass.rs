//! A glass pot between coloured panes, and a fountain of sparks: blending in three ways.
//!
//! ```text
//! cargo run --release --example glass -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, show};
use zstrip::Scene;
use zstrip::color::Dithered;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::math::Angle16;
use zstrip::target::Strip;
use zstrip::target::{WithDepth, WithRecords};

struct Glass;

impl Demo for Glass {
    type Format = Dithered<Rgb565>;
    const NAME: &'static str = "glass";
    const ABOUT: &'static str = "A glass pot between coloured panes, and a fountain of sparks.";
    const BACKGROUND: Rgb565 = Rgb565::BLACK;
    const RECORDS: usize = 64 * 1024;

    fn draw(
        &self,
        scene: &mut Scene<'_, Strip<'_, Self::Format, WithDepth, WithRecords>>,
        turn: Angle16,
        _mode: usize,
    ) {
        scenes::light::glass(scene, turn);
    }
}

fn main() -> std::process::ExitCode {
    show(Glass)
}
