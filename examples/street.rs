//! A street of houses and trees, behind the wall of a room with a small window, or without the room. Draws that are
//! hidden are left out.
//!
//! ```text
//! cargo run --release --example street -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use scenes::street;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::target::WithOcclusion;

struct Street;

impl Demo<WithOcclusion> for Street {
    type Format = Rgb565;
    const NAME: &'static str = "street";
    const ABOUT: &'static str = "A street, most of it hidden by a wall.";
    const BACKGROUND: Rgb565 = scenes::BACKGROUND;
    const MODES: &'static [&'static str] = &["behind_a_wall", "open", "far_first"];
    const FIRST: usize = 0;

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Rgb565, WithOcclusion> {
        let make = [street::Street::behind_a_wall, street::Street::open, street::Street::far_first][shot.mode];
        Box::new(make(shot.screen, shot.turn()))
    }
}

fn main() -> std::process::ExitCode {
    show(Street)
}
