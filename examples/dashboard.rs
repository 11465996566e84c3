//! Gauges, a plot, text and an image: embedded-graphics alone, drawn strip by strip in a tenth of a framebuffer's memory and
//! without a depth buffer. What is drawn is in `scenes/dashboard.rs`.
//!
//! ```text
//! cargo run --release --example dashboard -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, show};
use zstrip::Scene;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::Angle16;
use zstrip::target::Strip;
use zstrip::target::{WithRecords, WithoutDepth};

struct Dashboard;

impl Demo<WithoutDepth> for Dashboard {
    type Format = Rgb565;
    const NAME: &'static str = "dashboard";
    const ABOUT: &'static str = "Instruments drawn with embedded-graphics, strip by strip and without a depth buffer.";
    const BACKGROUND: Rgb565 = scenes::BACKGROUND;

    fn draw(&self, scene: &mut Scene<'_, Strip<'_, Rgb565, WithoutDepth, WithRecords>>, turn: Angle16, _mode: usize) {
        scenes::dashboard::draw(scene, turn);
    }
}

fn main() -> std::process::ExitCode {
    show(Dashboard)
}
