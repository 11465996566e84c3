//! A glass pot between coloured panes, and a fountain of sparks: blending in three ways.
//!
//! ```text
//! cargo run --release --example glass -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use scenes::light::Glass;
use zstrip::color::Dithered;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::target::WithDepth;

struct Demonstration;

impl Demo for Demonstration {
    type Format = Dithered<Rgb565>;
    const NAME: &'static str = "glass";
    const ABOUT: &'static str = "A glass pot between coloured panes, and a fountain of sparks.";
    const BACKGROUND: Rgb565 = Rgb565::BLACK;
    const RECORDS: usize = 64 * 1024;

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Self::Format, WithDepth> {
        Box::new(Glass::new(shot.screen, shot.turn()))
    }
}

fn main() -> std::process::ExitCode {
    show(Demonstration)
}
