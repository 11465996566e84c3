//! Wooden crates on a tiled floor, behind a fence: textures in perspective, with and without mip levels and filtering.
//!
//! ```text
//! cargo run --release --example crates -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, show};
use scenes::textured::{Look, crates, fence};
use zstrip::Scene;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::Angle;
use zstrip::output::Strip;

const LOOKS: [Look; 4] = [
    Look { bilinear: true, mips: true },
    Look { bilinear: false, mips: true },
    Look { bilinear: true, mips: false },
    Look { bilinear: false, mips: false },
];

struct Crates;

impl Demo for Crates {
    type Format = Rgb565;
    const NAME: &'static str = "crates";
    const ABOUT: &'static str = "Crates on a floor, behind a fence, with mip levels or one level of the textures.";
    const BACKGROUND: Rgb565 = scenes::BACKGROUND;
    const MODES: &'static [&'static str] = &["bilinear", "nearest", "bilinear-one-level", "nearest-one-level"];

    fn draw(&self, scene: &mut Scene<'_, Strip<'_, Rgb565>>, turn: Angle, mode: usize) {
        crates(scene, turn, LOOKS[mode]);
        fence(scene, turn);
    }
}

fn main() -> std::process::ExitCode {
    show(Crates)
}
