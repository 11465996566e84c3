//! A glass pot between coloured panes, and a fountain of sparks: blending in three ways.
//!
//! ```text
//! cargo run --release --example glass -- --help
//! ```
mod host;
mod scenes;

use host::show::{Show, Variant};
use scenes::light::glass;

fn main() -> std::process::ExitCode {
    let show = Show {
        name: "glass",
        about: "A glass pot between coloured panes, and a fountain of sparks.",
        variants: &[Variant { name: "all", draw: |scene, turn| glass(scene, turn) }],
    };
    show.main()
}
