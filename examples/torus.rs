//! A turning, lit torus in a window, drawn strip by strip as on a small display; a PNG file where there is no display.
//! `--mode NAME` shows any other scene of `scenes/mod.rs`.
//!
//! ```text
//! cargo run --release --example torus -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use scenes::SCENES;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::target::WithDepth;

/// The names of the scenes.
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

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Rgb565, WithDepth> {
        (SCENES[shot.mode].make)(shot.screen, shot.turn())
    }
}

fn main() -> std::process::ExitCode {
    show(Torus)
}
