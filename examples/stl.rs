//! A part from CAD, turning, from an STL file: smooth where faces meet at less than a crease angle, or face by face.
//!
//! ```text
//! cargo run --release --example stl -- --help
//! ```
mod host;
mod models;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use models::{FLANGE, FLANGE_FACES, Still};
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::Vec3;
use zstrip::target::WithDepth;

struct Part([Still; 2]);

impl Demo for Part {
    type Format = Rgb565;
    const NAME: &'static str = "stl";
    const ABOUT: &'static str =
        "A flange from an STL file: sharp edges by a crease angle of 30 degrees, or flat faces.";
    const BACKGROUND: Rgb565 = models::BACKGROUND;
    const MODES: &'static [&'static str] = &["creases", "faces"];
    const RECORDS: usize = 32 * 1024;

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Rgb565, WithDepth> {
        let placed = self.0[shot.mode].place(shot.screen, Vec3::from_ints(0, 3, 4), shot.turn());
        Box::new(placed.expect("a screen of at least a pixel"))
    }
}

fn main() -> std::process::ExitCode {
    show(Part([FLANGE, FLANGE_FACES].map(|file| Still::new(file).expect("a container that is checked in"))))
}
