//! A turning, lit torus in a window, drawn strip by strip as on a small display; a PNG where there is no display.
//!
//! ```text
//! cargo run --release --example torus -- --help
//! ```
mod host;
mod scenes;

use host::viewer::{Program, show};

fn main() -> std::process::ExitCode {
    show(&Program {
        name: "torus",
        about: "A turning, lit torus, drawn strip by strip.",
        scene: "torus_gouraud",
        all: true,
        depth: true,
    })
}
