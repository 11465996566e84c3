//! A flight over hills and a lake in the morning fog.
//!
//! ```text
//! cargo run --release --example fog -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use scenes::light::{Fog, Mist};
use zstrip::color::Dithered;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::target::WithDepth;

struct Demonstration;

impl Demo for Demonstration {
    type Format = Dithered<Rgb565>;
    const NAME: &'static str = "fog";
    const ABOUT: &'static str = "A flight over hills and a lake in the morning fog, which thickens in three ways.";
    const BACKGROUND: Rgb565 = Rgb565::BLACK;
    const RECORDS: usize = 64 * 1024;
    const MODES: &'static [&'static str] = &["squared", "exponential", "linear"];

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Self::Format, WithDepth> {
        let mist = [Mist::Squared, Mist::Exponential, Mist::Linear][shot.mode];
        Box::new(Fog::new(shot.screen, shot.turn(), mist))
    }
}

fn main() -> std::process::ExitCode {
    show(Demonstration)
}
