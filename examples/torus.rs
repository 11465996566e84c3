//! A turning, lit torus in a window, drawn strip by strip as on a small display; a PNG where there is no display. All other
//! scenes of the tests can be chosen, too.
//!
//! ```text
//! cargo run --release --example torus -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, show};
use scenes::SCENES;
use zstrip::Scene;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::Angle16;
use zstrip::target::Strip;
use zstrip::target::{WithDepth, WithRecords};

/// The scenes' names.
const NAMES: [&str; SCENES.len()] = {
    let mut names = [""; SCENES.len()];
    let mut k = 0;
    while k < names.len() {
        names[k] = SCENES[k].name;
        k += 1;
    }
    names
};

struct Torus;

impl Demo for Torus {
    type Format = Rgb565;
    const NAME: &'static str = "torus";
    const ABOUT: &'static str = "A turning, lit torus, drawn strip by strip.";
    const BACKGROUND: Rgb565 = scenes::BACKGROUND;
    const MODES: &'static [&'static str] = &NAMES;
    /// Gouraud shaded.
    const FIRST: usize = 1;

    fn draw(&self, scene: &mut Scene<'_, Strip<'_, Rgb565, WithDepth, WithRecords>>, turn: Angle16, mode: usize) {
        (SCENES[mode].draw)(scene, turn);
    }
}

fn main() -> std::process::ExitCode {
    show(Torus)
}
