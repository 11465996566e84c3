//! Waving water by a vertex shader of its own, and a crate that floats on it.
//!
//! ```text
//! cargo run --release --example water -- --help
//! ```
#[path = "host/mod.rs"]
mod host;
#[path = "host/modes.rs"]
mod modes;
mod scenes;

use modes::Show;
use scenes::water::water;
use std::process::ExitCode;

fn main() -> ExitCode {
    let show = Show {
        name: "water",
        about: "Water, waved by a vertex shader, and a crate on it.",
        modes: &["a breeze", "waves", "a gale"],
        background: scenes::BACKGROUND,
        draw: |scene, time, mode| water(scene, time, [1, 2, 3][mode]),
    };
    show.run()
}
