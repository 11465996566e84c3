//! An instrument cluster with smooth edges: dials, rings, ticks and turned numbers, needles that turn by parts of a
//! pixel, a plot and dashes, strip by strip and without a depth buffer. `scenes/gauges.rs` draws them.
//!
//! ```text
//! cargo run --release --example gauges -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use minifb::Key;
use scenes::gauges::Gauges;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::Angle16;
use zstrip::target::WithoutDepth;

/// How far the needles were turned by keys.
#[derive(Default)]
struct Demonstration(i32);

impl Demo<WithoutDepth> for Demonstration {
    type Format = Rgb565;
    const NAME: &'static str = "gauges";
    const ABOUT: &'static str = "Instruments with smooth edges, strip by strip and without a depth buffer.";
    const KEYS: &'static str = "  A, D              turns the needles slowly back and on\n";
    const BACKGROUND: Rgb565 = scenes::BACKGROUND;

    fn key(&mut self, key: Key) {
        self.0 += match key {
            Key::A => -8,
            Key::D => 8,
            _ => 0,
        };
    }

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Rgb565, WithoutDepth> {
        Box::new(Gauges::new(shot.turn() + Angle16(self.0 as u16)))
    }
}

fn main() -> std::process::ExitCode {
    show(Demonstration::default())
}
