//! Models from containers, turning: Spot the cow with its texture, and the teapot.
//!
//! ```text
//! cargo run --release --example model -- --help
//! ```
mod host;
mod models;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use models::{SPOT, Still, TEAPOT};
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::{Angle16, Vec3};
use zstrip::target::WithDepth;

struct Models([Still; 2]);

impl Demo for Models {
    type Format = Rgb565;
    const NAME: &'static str = "model";
    const ABOUT: &'static str = "Models from containers: a textured cow and a teapot.";
    const BACKGROUND: Rgb565 = models::BACKGROUND;
    const MODES: &'static [&'static str] = &["spot", "teapot"];
    const RECORDS: usize = 32 * 1024;

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Rgb565, WithDepth> {
        // Spot's face is on the side of -z.
        let turn = shot.turn() + Angle16::from_degrees(if shot.mode == 0 { 180 } else { 0 });
        let placed = self.0[shot.mode].place(shot.screen, Vec3::from_ints(0, 1, 3), turn);
        Box::new(placed.expect("a screen of at least a pixel"))
    }
}

fn main() -> std::process::ExitCode {
    show(Models([SPOT, TEAPOT].map(|file| Still::new(file).expect("a container that is checked in"))))
}
