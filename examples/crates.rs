//! Wooden crates on a tiled floor, behind a fence: textures in perspective, with and without mip levels and filtering.
//!
//! ```text
//! cargo run --release --example crates -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use scenes::textured::{Crates, Levels};
use zstrip::color::Dithered;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::target::WithDepth;
use zstrip::texture::{Bilinear, Nearest};

struct Demonstration;

impl Demo for Demonstration {
    type Format = Dithered<Rgb565>;
    const NAME: &'static str = "crates";
    const ABOUT: &'static str =
        "Crates on a floor, behind a fence, with and without mip levels and bilinear filtering.";
    const BACKGROUND: Rgb565 = Rgb565::BLACK;
    const MODES: &'static [&'static str] = &["bilinear", "nearest", "one-level", "pixels"];

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Self::Format, WithDepth> {
        let (screen, turn) = (shot.screen, shot.turn());
        let levels = if shot.mode < 2 { Levels::All } else { Levels::First };
        // The filter is part of the shader's type: each has a pixel loop of its own.
        if shot.mode.is_multiple_of(2) {
            Box::new(Crates::new(screen, turn, Bilinear, levels))
        } else {
            Box::new(Crates::new(screen, turn, Nearest, levels))
        }
    }
}

fn main() -> std::process::ExitCode {
    show(Demonstration)
}
