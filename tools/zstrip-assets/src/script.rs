//! The line of a build script: a file becomes Rust source in the folder of the build.

use std::path::{Path, PathBuf};

use crate::import;
use crate::options::Options;
use crate::save::save;
use crate::source::{identifier, write_rust};
use crate::write::WriteOptions;

/// Converts a model for the program that a build script belongs to. This is all of `build.rs`:
///
/// ```no_run
/// # use zstrip_assets::{Options, build};
/// fn main() {
///     build("assets/spot.obj", &Options::default());
/// }
/// ```
///
/// The program then says `include!(concat!(env!("OUT_DIR"), "/spot.rs"));`, and has a module `spot`: see
/// [`write_rust`]. The script runs again when the model or a file that it uses has changed. Textures are those of
/// [`WriteOptions::default`]; [`build_with`] takes others.
///
/// If there is an error, it is printed, and the process ends with exit code 1: the build fails with that text.
pub fn build(path: impl AsRef<Path>, options: &Options) {
    build_with(path, options, &WriteOptions::default());
}

/// Does what [`build`] does, with options for the container.
pub fn build_with(path: impl AsRef<Path>, options: &Options, write_options: &WriteOptions) {
    let path = path.as_ref();
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={}", path.display());
    let converted = match std::env::var_os("OUT_DIR") {
        Some(folder) => convert(path, Path::new(&folder), options, write_options),
        None => Err("OUT_DIR is not set: call this from build.rs".to_owned()),
    };
    match converted {
        Ok(files) => files.iter().for_each(|file| println!("cargo::rerun-if-changed={}", file.display())),
        Err(error) => {
            println!("cargo::error={}", error.replace('\n', " "));
            std::process::exit(1);
        }
    }
}

/// Writes the container and its source into a folder, and returns the files that were read.
fn convert(
    path: &Path,
    folder: &Path,
    options: &Options,
    write_options: &WriteOptions,
) -> Result<Vec<PathBuf>, String> {
    let (import, report) = import(path, options).map_err(|error| error.to_string())?;
    let name = identifier(&path.file_stem().unwrap_or_default().to_string_lossy());
    let container = format!("{name}.zstm");
    let (source, written) = write_rust(&import, &name, &container, write_options)
        .map_err(|error| format!("{}: {error}", path.display()))?;
    for (file, bytes) in [(container, &written.bytes[..]), (format!("{name}.rs"), source.as_bytes())] {
        let file = folder.join(file);
        save(&file, bytes).map_err(|error| format!("{}: {error}", file.display()))?;
    }
    Ok(report.files)
}
