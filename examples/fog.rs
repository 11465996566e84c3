//! A flight over hills and a lake in the morning fog.
//!
//! ```text
//! cargo run --release --example fog -- --help
//! ```
mod host;
mod scenes;

use host::show::{Show, Variant};
use scenes::light::{Mist, fog};

fn main() -> std::process::ExitCode {
    let show = Show {
        name: "fog",
        about: "A flight over hills and a lake in the morning fog, which thickens in three ways.",
        variants: &[
            Variant { name: "squared", draw: |scene, turn| fog(scene, turn, Mist::Squared) },
            Variant { name: "exponential", draw: |scene, turn| fog(scene, turn, Mist::Exponential) },
            Variant { name: "linear", draw: |scene, turn| fog(scene, turn, Mist::Linear) },
        ],
    };
    show.main()
}
