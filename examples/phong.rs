//! A glazed pot under the moon and two lamps, shaded in five ways.
//!
//! ```text
//! cargo run --release --example phong -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use scenes::light::{Night, copper, glaze, sunlit_glaze};
use zstrip::color::Dithered;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::shader::{Flat, Gouraud, Phong, PhongNear};
use zstrip::target::WithDepth;

struct Demonstration;

impl Demo for Demonstration {
    type Format = Dithered<Rgb565>;
    const NAME: &'static str = "phong";
    const ABOUT: &'static str = "A glazed pot under the moon and two lamps, shaded in five ways.";
    const BACKGROUND: Rgb565 = Rgb565::BLACK;
    const MODES: &'static [&'static str] = &["fragment", "vertex", "face", "sun", "matcap"];

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Self::Format, WithDepth> {
        let (screen, turn) = (shot.screen, shot.turn());
        // How often the pot is lit is part of its shader's type.
        match shot.mode {
            0 => Box::new(Night::new(screen, turn, || PhongNear::new(glaze(turn)))),
            1 => Box::new(Night::new(screen, turn, || Gouraud::new(glaze(turn)))),
            2 => Box::new(Night::new(screen, turn, || Flat::new(glaze(turn)))),
            3 => Box::new(Night::new(screen, turn, || Phong::new(sunlit_glaze(turn)))),
            _ => Box::new(Night::new(screen, turn, || copper(turn))),
        }
    }
}

fn main() -> std::process::ExitCode {
    show(Demonstration)
}
