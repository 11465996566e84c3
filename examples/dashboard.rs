//! Gauges, a plot, text and an image: embedded-graphics alone, drawn strip by strip in a tenth of a framebuffer's
//! memory and without a depth buffer. `scenes/dashboard.rs` draws them.
//!
//! ```text
//! cargo run --release --example dashboard -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use scenes::dashboard::Dashboard;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::target::WithoutDepth;

struct Demonstration;

impl Demo<WithoutDepth> for Demonstration {
    type Format = Rgb565;
    const NAME: &'static str = "dashboard";
    const ABOUT: &'static str = "Instruments drawn with embedded-graphics, strip by strip and without a depth buffer.";
    const BACKGROUND: Rgb565 = scenes::BACKGROUND;

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Rgb565, WithoutDepth> {
        Box::new(Dashboard::new(shot.turn()))
    }
}

fn main() -> std::process::ExitCode {
    show(Demonstration)
}
