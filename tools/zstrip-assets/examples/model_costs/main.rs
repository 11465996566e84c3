//! Costs of models: makes models up, and fits costs to what the firmware of `examples/container.rs` counted of them.
//! `ci/costs` runs all of it.
//!
//! ```text
//! cargo run --release --example model_costs -- write SHOWS.bin
//! cargo run --release --example model_costs -- fit FOLDER m0+ m4 rv32imc
//! ```
//! `write` writes the words that the firmware finds in its memory. `fit` reads `FOLDER/m0+.models` and so on, lines of
//! `stage show.frame instructions cycles`, and writes `model_costs.csv`, `pose_costs.csv` and tables into the folder.

mod chains;
mod fit;
#[path = "../../../../examples/costs/least_squares.rs"]
mod least_squares;
mod poses;
mod shapes;

use std::path::Path;
use std::process::ExitCode;
use zstrip_assets::preview::{Container, Format, MOST_WORDS, Panel, Stage, Way, show_head};

/// A made-up model, and how it is counted.
pub struct Show {
    pub name: String,
    pub container: Container,
    /// Zooms, and rows of strips.
    pub panels: Vec<Panel>,
}

/// Frames of a show that are counted, about.
const FRAMES: u32 = 2;

/// The screen of docs/costs.md.
pub const fn panel(rows: u32, zoom: u32) -> Panel {
    Panel { width: 320, height: 240, rows, zoom }
}

fn shows() -> Result<Vec<Show>, String> {
    let mut shows = shapes::shows()?;
    shows.extend(poses::shows()?);
    shows.extend(chains::shows()?);
    Ok(shows)
}

fn write(to: &Path) -> Result<(), String> {
    let mut words: Vec<u32> = vec![];
    for show in &shows()? {
        for (k, panel) in show.panels.iter().enumerate() {
            let bytes = if k == 0 { show.container.bytes() } else { &[] };
            words.extend(show_head(panel, bytes.len() as u32, FRAMES, Way::default()));
            words.extend(bytes.chunks(4).map(|chunk| {
                let mut word = [0; 4];
                word[..chunk.len()].copy_from_slice(chunk);
                u32::from_le_bytes(word)
            }));
            Stage::new(&show.container, *panel, Format::Rgb565).map_err(|error| format!("{}: {error}", show.name))?;
        }
    }
    if words.len() > MOST_WORDS {
        return Err(format!("{} words of shows, where {MOST_WORDS} are the most", words.len()));
    }
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    zstrip_assets::save(to, &bytes).map_err(|error| format!("{}: {error}", to.display()))
}

fn main() -> ExitCode {
    let args: Vec<_> = std::env::args().skip(1).collect();
    let args: Vec<_> = args.iter().map(String::as_str).collect();
    let done = match &args[..] {
        ["write", to] => write(to.as_ref()),
        ["fit", folder, cores @ ..] if !cores.is_empty() => {
            shows().and_then(|shows| fit::report(&shows, folder.as_ref(), cores))
        }
        _ => {
            eprintln!("usage: model_costs write FILE | fit FOLDER CORE..., as ci/costs calls it");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("model_costs: {error}");
            ExitCode::FAILURE
        }
    }
}
