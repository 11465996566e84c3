//! Writes the containers of `examples/models`, which the library's examples and boards include.
//!
//! ```text
//! cargo run --example gallery
//! ```
//! The sources that the project makes itself, figure.glb and flange.stl, are left in `target/gallery`.

mod containers;
mod figure;
mod flange;

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let made = package.join("target/gallery");
    std::fs::create_dir_all(&made)?;
    for name in containers::NAMES {
        let written = containers::convert(name, &made)?;
        std::fs::write(containers::path(name), &written.bytes)?;
        println!("{name}.zstm\n{}", written.report);
    }
    Ok(())
}
