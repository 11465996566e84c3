//! Gauges, a plot, text and an image: embedded-graphics alone, drawn strip by strip in a tenth of a framebuffer's memory and
//! without a depth buffer. What is drawn is in `scenes/dashboard.rs`.
//!
//! ```text
//! cargo run --release --example dashboard -- --help
//! ```
mod host;
mod scenes;

use host::viewer::{Program, show};

fn main() -> std::process::ExitCode {
    show(&Program {
        name: "dashboard",
        about: "Instruments drawn with embedded-graphics, strip by strip and without a depth buffer.",
        scene: "dashboard",
        all: false,
        depth: false,
    })
}
