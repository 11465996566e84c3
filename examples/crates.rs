//! Wooden crates on a tiled floor, behind a fence: textures in perspective, with and without mip levels and filtering.
//!
//! ```text
//! cargo run --release --example crates -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, show};
use scenes::textured::{Look, crates};
use zstrip::Scene;
use zstrip::color::Dithered;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::math::Angle16;
use zstrip::target::Strip;
use zstrip::target::{WithDepth, WithRecords};

const LOOKS: [Look; 4] = [
    Look { bilinear: true, mips: true },
    Look { bilinear: false, mips: true },
    Look { bilinear: true, mips: false },
    Look { bilinear: false, mips: false },
];

struct Crates;

impl Demo for Crates {
    type Format = Dithered<Rgb565>;
    const NAME: &'static str = "crates";
    const ABOUT: &'static str =
        "Crates on a floor, behind a fence, with and without mip levels and bilinear filtering.";
    const BACKGROUND: Rgb565 = Rgb565::BLACK;
    const MODES: &'static [&'static str] = &["bilinear", "nearest", "one-level", "pixels"];

    fn draw(&self, scene: &mut Scene<'_, Strip<'_, Self::Format, WithDepth, WithRecords>>, turn: Angle16, mode: usize) {
        crates(scene, turn, LOOKS[mode]);
    }
}

fn main() -> std::process::ExitCode {
    show(Crates)
}
