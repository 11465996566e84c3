//! A file of any kind comes in; an import, or a container, goes out.

use super::arguments::{Conversion, Screen};
use super::convert::{in_file, unwritten};
use super::failure::Failure;
use std::fs::File;
use std::io::{IsTerminal, Read};
use std::path::{Path, PathBuf};
use zstrip::model::container::MAGIC;
use zstrip_assets::preview::{Container, PreviewError, Stage};
use zstrip_assets::{Import, Kind, Progress, Report, import_with_progress, write};

/// The most bytes of a container that is read.
const MOST_BYTES: u64 = 256 << 20;

/// Imports a file, and shows progress where somebody looks at it. Refuses outputs that are files of the model.
pub fn read(file: &Path, conversion: &Conversion, outputs: &[&Path]) -> Result<(Import, Report), Failure> {
    if is_container(file).map_err(|error| in_file(file, &error))? {
        let error = "a container already; check, view and bench take it, and convert and info take the model";
        return Err(in_file(file, &error));
    }
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
    let (import, report) = result.map_err(|error| match error.kind {
        Kind::Options => Failure::Usage(error.message),
        _ => Failure::Failed(error.to_string()),
    })?;
    keep(&report.files, outputs)?;
    Ok((import, report))
}

/// Returns the container in a file, or that of the model in it, and the report of the conversion. Refuses outputs that
/// are the file or files of the model.
pub fn container(file: &Path, conversion: &Conversion, outputs: &[&Path]) -> Result<(Container, String), Failure> {
    if is_container(file).map_err(|error| in_file(file, &error))? {
        if let Some(option) = &conversion.given {
            return Err(Failure::Usage(format!(
                "{option} is for models that are converted, and {} is a container already",
                file.display()
            )));
        }
        keep(&[file.to_owned()], outputs)?;
        let report = format!("{}: a container already, so nothing is lost\n", file.display());
        return Ok((Container::read(file)?, report));
    }
    let (import, report) = read(file, conversion, outputs)?;
    let written = write(&import, &conversion.write).map_err(|error| unwritten(file, error))?;
    Ok((Container::new(&written.bytes), format!("{report}{}", written.report)))
}

/// Returns the stage on which a container is shown.
pub fn stage<'m>(file: &Path, container: &'m Container, screen: &Screen) -> Result<Stage<'m>, Failure> {
    Stage::new(container, screen.panel, screen.format).map_err(|error| match error {
        error @ PreviewError::Model(_) => in_file(file, &error),
        error @ PreviewError::Camera(_) => {
            in_file(file, &format!("{error}; convert the model with a smaller --scale, or choose a larger --zoom"))
        }
        error => error.into(),
    })
}

/// Refuses outputs that are files which were read, by whatever path, or one file twice.
fn keep(read: &[PathBuf], outputs: &[&Path]) -> Result<(), Failure> {
    let fault = |output: &Path, why: &str| Err(Failure::Usage(format!("the output {} {why}", output.display())));
    for (k, output) in outputs.iter().enumerate() {
        if outputs[..k].contains(output) {
            return fault(output, "is named twice; choose another name for one of them");
        }
        // An output that is not there yet is none of these.
        let Ok(real) = output.canonicalize() else { continue };
        if read.iter().any(|file| file.canonicalize().is_ok_and(|file| file == real)) {
            return fault(output, "is a file that the model is read from; choose another name");
        }
    }
    Ok(())
}

/// Tells by its first bytes whether a file is a container.
fn is_container(path: &Path) -> std::io::Result<bool> {
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    let mut start = vec![];
    // Devices and pipes are refused by the import.
    if file.metadata()?.is_file() {
        file.by_ref().take(MAGIC.len() as u64).read_to_end(&mut start)?;
    }
    let is = start == MAGIC;
    if is && length > MOST_BYTES {
        return Err(std::io::Error::other(format!("a container of {length} bytes, where {MOST_BYTES} are the most")));
    }
    if !is && path.extension().is_some_and(|name| name == "zstm") {
        return Err(std::io::Error::other("not a container: it does not begin with ZSTM"));
    }
    Ok(is)
}
