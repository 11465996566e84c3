//! A torus with axes and names in its space: text that is hidden by objects in front of it. `scenes/labels.rs` draws
//! it.
//!
//! ```text
//! cargo run --release --example labels -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use scenes::labels::Labels;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::target::WithDepth;

struct Demonstration;

impl Demo for Demonstration {
    type Format = Rgb565;
    const NAME: &'static str = "labels";
    const ABOUT: &'static str = "A torus with labels in its space, hidden by what is in front of them.";
    const BACKGROUND: Rgb565 = scenes::BACKGROUND;

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Rgb565, WithDepth> {
        Box::new(Labels::new(shot.screen, shot.turn()))
    }
}

fn main() -> std::process::ExitCode {
    show(Demonstration)
}
