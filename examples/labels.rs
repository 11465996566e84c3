//! A torus with axes and names in its space: text that is hidden by what is in front of it. What is drawn is in
//! `scenes/labels.rs`.
//!
//! ```text
//! cargo run --release --example labels -- --help
//! ```
mod host;
mod scenes;

use host::viewer::{Program, show};

fn main() -> std::process::ExitCode {
    show(&Program {
        name: "labels",
        about: "A torus with labels in its space, hidden by what is in front of them.",
        scene: "labels",
        all: false,
        depth: true,
    })
}
