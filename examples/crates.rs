//! Wooden crates on a tiled floor, behind a fence: textures in perspective, with and without mip levels and filtering.
//!
//! ```text
//! cargo run --release --example crates -- --help
//! ```
#[path = "host/mod.rs"]
mod host;
#[path = "host/modes.rs"]
mod modes;
mod scenes;

use modes::Show;
use scenes::textured::{Look, crates, fence};
use std::process::ExitCode;

const LOOKS: [Look; 4] = [
    Look { bilinear: true, mips: true },
    Look { bilinear: false, mips: true },
    Look { bilinear: true, mips: false },
    Look { bilinear: false, mips: false },
];

fn main() -> ExitCode {
    let show = Show {
        name: "crates",
        about: "Crates on a floor, behind a fence.",
        modes: &["bilinear, mip levels", "nearest, mip levels", "bilinear, one level", "nearest, one level"],
        background: scenes::BACKGROUND,
        draw: |scene, turn, mode| {
            crates(scene, turn, LOOKS[mode]);
            fence(scene, turn);
        },
    };
    show.run()
}
