//! Wooden crates on a tiled floor, behind a fence: textures in perspective, with and without mip levels and filtering.
//!
//! ```text
//! cargo run --release --example crates -- --help
//! ```
mod host;
mod scenes;

use host::show::{Show, Variant};
use scenes::textured::{Look, crates};

fn main() -> std::process::ExitCode {
    let show = Show {
        name: "crates",
        about: "Crates on a floor, behind a fence, with and without mip levels and bilinear filtering.",
        variants: &[
            Variant { name: "bilinear", draw: |scene, turn| crates(scene, turn, Look { bilinear: true, mips: true }) },
            Variant { name: "nearest", draw: |scene, turn| crates(scene, turn, Look { bilinear: false, mips: true }) },
            Variant {
                name: "one-level",
                draw: |scene, turn| crates(scene, turn, Look { bilinear: true, mips: false }),
            },
            Variant { name: "pixels", draw: |scene, turn| crates(scene, turn, Look { bilinear: false, mips: false }) },
        ],
    };
    show.main()
}
