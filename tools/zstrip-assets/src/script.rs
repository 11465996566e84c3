//! The line of a build script: a file becomes Rust source in the folder of the build.

use std::path::Path;

use crate::import;
use crate::options::Options;
use crate::report::{Note, Report};
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
/// [`write_rust`]. The script runs again when the model or a file that it uses has changed, and each time while such a
/// file is missing. Textures and materials that are left out are warnings. The container is that of
/// [`WriteOptions::default`]; [`build_with`] takes other options.
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
        Ok(report) => lines(&report).iter().for_each(|line| println!("{line}")),
        Err(error) => {
            println!("cargo::error={}", error.replace('\n', " "));
            std::process::exit(1);
        }
    }
}

/// Returns the lines that tell cargo which files were read or are missing, and what was left out.
///
/// Cargo runs the script each time while a file is missing, so that it is seen when it comes.
fn lines(report: &Report) -> Vec<String> {
    let files = report.files.iter().chain(&report.missing);
    let files = files.map(|file| format!("cargo::rerun-if-changed={}", file.display()));
    let left_out = report
        .notes
        .iter()
        .filter(|note| matches!(note, Note::TextureMissing { .. } | Note::MaterialMissing { .. }))
        .map(|note| format!("cargo::warning={}", note.to_string().replace('\n', " ")));
    files.chain(left_out).collect()
}

/// Writes the container and its source into a folder, and returns the report of the import.
fn convert(path: &Path, folder: &Path, options: &Options, write_options: &WriteOptions) -> Result<Report, String> {
    let (import, report) = import(path, options).map_err(|error| error.to_string())?;
    let name = identifier(&path.file_stem().unwrap_or_default().to_string_lossy());
    let container = format!("{name}.zstm");
    let (source, written) = write_rust(&import, &name, &container, write_options)
        .map_err(|error| format!("{}: {error}", path.display()))?;
    for (file, bytes) in [(container, &written.bytes[..]), (format!("{name}.rs"), source.as_bytes())] {
        let file = folder.join(file);
        save(&file, bytes).map_err(|error| format!("{}: {error}", file.display()))?;
    }
    Ok(report)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cargo_is_told_of_files_that_are_read_and_of_those_that_are_missing() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.obj");
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
        write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
        write("a.mtl", "newmtl a\nmap_Kd a.png\n");
        let report = convert(&path, folder.path(), &Options::default(), &WriteOptions::default()).expect("a triangle");
        let lines = lines(&report);
        for (k, name) in ["a.obj", "a.mtl", "a.png"].iter().enumerate() {
            assert!(lines[k].starts_with("cargo::rerun-if-changed=") && lines[k].ends_with(name), "{lines:?}");
        }
        assert!(lines[3].starts_with("cargo::warning=texture left out: ") && lines[3].contains("a.png"), "{lines:?}");
        assert_eq!(lines.len(), 4);
        for file in ["a.rs", "a.zstm"] {
            assert!(folder.path().join(file).is_file(), "{file}");
        }
    }
}
