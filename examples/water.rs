//! Waving water by a vertex shader of its own, and a crate that floats on it.
//!
//! ```text
//! cargo run --release --example water -- --help
//! ```
#[path = "host/mod.rs"]
mod host;
mod scenes;
#[path = "host/show.rs"]
mod show;

use scenes::water::water;
use show::Show;
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
