//! Waving water by a vertex shader of its own, and a crate that floats on it.
//!
//! ```text
//! cargo run --release --example water -- --help
//! ```
mod host;
mod scenes;

use host::show::{Show, Variant};
use scenes::water::water;

fn main() -> std::process::ExitCode {
    let show = Show {
        name: "water",
        about: "Water, waved by a vertex shader, and a crate on it.",
        variants: &[
            Variant { name: "breeze", draw: |scene, time| water(scene, time, 1) },
            Variant { name: "waves", draw: |scene, time| water(scene, time, 2) },
            Variant { name: "gale", draw: |scene, time| water(scene, time, 3) },
        ],
    };
    show.main()
}
