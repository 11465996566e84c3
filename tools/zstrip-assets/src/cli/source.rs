//! A file of any kind comes in; an import, or a container, goes out.

use super::arguments::Conversion;
use super::convert::in_file;
use super::failure::Failure;
use std::fs::File;
use std::io::{IsTerminal, Read};
use std::path::Path;
use zstrip::model::container::MAGIC;
use zstrip_assets::preview::Container;
use zstrip_assets::{Import, Progress, Report, import_with_progress, write};

/// The most bytes of a container that is read.
const MOST_BYTES: u64 = 256 << 20;

/// Imports a file, and shows progress where somebody looks at it.
pub fn read(file: &Path, conversion: &Conversion) -> Result<(Import, Report), Failure> {
    let shows = std::io::stderr().is_terminal();
    let mut progress = |stage| {
        if shows {
            match stage {
                Progress::Reading => eprint!("\rreading"),
                Progress::Mesh { number, count } => eprint!("\rmesh {number} of {count}  "),
            }
        }
    };
    let result = import_with_progress(file, &conversion.import, &mut progress);
    if shows {
        eprint!("\r                              \r");
    }
    result.map_err(|error| Failure::Failed(error.to_string()))
}

/// Returns the container in a file, or that of the model in it, and the report of the conversion.
pub fn container(file: &Path, conversion: &Conversion) -> Result<(Container, String), Failure> {
    if is_container(file).map_err(|error| in_file(file, &error))? {
        if let Some(option) = &conversion.given {
            return Err(Failure::Usage(format!(
                "{option} is for models that are converted, and {} is a container already",
                file.display()
            )));
        }
        let report = format!("{}: a container already, so nothing is lost\n", file.display());
        return Ok((Container::read(file)?, report));
    }
    let (import, report) = read(file, conversion)?;
    let written = write(&import, &conversion.write).map_err(|error| in_file(file, &error))?;
    Ok((Container::new(&written.bytes), format!("{report}{}", written.report)))
}

/// Tells by its first bytes whether a file is a container.
fn is_container(path: &Path) -> std::io::Result<bool> {
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    let mut start = vec![];
    file.by_ref().take(MAGIC.len() as u64).read_to_end(&mut start)?;
    let is = start == MAGIC;
    if is && length > MOST_BYTES {
        return Err(std::io::Error::other(format!("a container of {length} bytes, where {MOST_BYTES} are the most")));
    }
    Ok(is)
}
