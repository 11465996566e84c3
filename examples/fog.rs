//! A flight over hills and a lake in the morning fog.
//!
//! ```text
//! cargo run --release --example fog -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, show};
use scenes::light::{Mist, fog};
use zstrip::Scene;
use zstrip::color::Dithered;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::math::Angle16;
use zstrip::target::Strip;
use zstrip::target::{WithDepth, WithRecords};

struct Fog;

impl Demo for Fog {
    type Format = Dithered<Rgb565>;
    const NAME: &'static str = "fog";
    const ABOUT: &'static str = "A flight over hills and a lake in the morning fog, which thickens in three ways.";
    const BACKGROUND: Rgb565 = Rgb565::BLACK;
    const RECORDS: usize = 64 * 1024;
    const MODES: &'static [&'static str] = &["squared", "exponential", "linear"];

    fn draw(&self, scene: &mut Scene<'_, Strip<'_, Self::Format, WithDepth, WithRecords>>, turn: Angle16, mode: usize) {
        fog(scene, turn, [Mist::Squared, Mist::Exponential, Mist::Linear][mode]);
    }
}

fn main() -> std::process::ExitCode {
    show(Fog)
}
