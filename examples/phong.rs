//! A glazed pot under the moon and two lamps, shaded in five ways.
//!
//! ```text
//! cargo run --release --example phong -- --help
//! ```
mod host;
mod scenes;

use host::show::{Show, Variant};
use scenes::light::{Shading, phong};

fn main() -> std::process::ExitCode {
    let show = Show {
        name: "phong",
        about: "A glazed pot under the moon and two lamps, shaded in five ways.",
        variants: &[
            Variant { name: "fragment", draw: |scene, turn| phong(scene, turn, Shading::PerFragmentNear) },
            Variant { name: "vertex", draw: |scene, turn| phong(scene, turn, Shading::PerVertex) },
            Variant { name: "face", draw: |scene, turn| phong(scene, turn, Shading::PerFace) },
            Variant { name: "sun", draw: |scene, turn| phong(scene, turn, Shading::PerFragment) },
            Variant { name: "matcap", draw: |scene, turn| phong(scene, turn, Shading::Matcap) },
        ],
    };
    show.main()
}
