//! A torus with axes and names in its space: text that is hidden by what is in front of it. What is drawn is in
//! `scenes/labels.rs`.
//!
//! ```text
//! cargo run --release --example labels -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, show};
use zstrip::Scene;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::Angle16;
use zstrip::target::Strip;
use zstrip::target::{WithDepth, WithRecords};

struct Labels;

impl Demo for Labels {
    type Format = Rgb565;
    const NAME: &'static str = "labels";
    const ABOUT: &'static str = "A torus with labels in its space, hidden by what is in front of them.";
    const BACKGROUND: Rgb565 = scenes::BACKGROUND;

    fn draw(&self, scene: &mut Scene<'_, Strip<'_, Rgb565, WithDepth, WithRecords>>, turn: Angle16, _mode: usize) {
        scenes::labels::draw(scene, turn);
    }
}

fn main() -> std::process::ExitCode {
    show(Labels)
}
