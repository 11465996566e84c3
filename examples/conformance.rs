//! Checks the conformance files of a folder and prints a line for each. Files of triangles, without depth, have further
//! lines: one for each traversal, which finds their pixels by itself.
//!
//! `cargo run --release --example conformance -- FOLDER`. The exit code is 0 only if every record that has a check is
//! right.

#[path = "../tests/reference/mod.rs"]
mod reference;

use reference::conformance::{Outcome, Rasterizer, check_file};
use reference::subject::Subject;
use reference::traversed::{Traversed, WALKS};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Prints what became of a file, and returns whether all of it is right.
fn report(name: &str, outcome: &Outcome) -> bool {
    let Outcome::Checked { right, total, first_wrong } = outcome;
    println!("{name}: {right} of {total}");
    if let Some(wrong) = first_wrong {
        println!("  first wrong: {wrong}");
    }
    outcome.is_right()
}

/// Returns whether the traversals alone can draw a file.
fn has_triangles(file: &Path) -> bool {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    stem.starts_with("tri_") || stem == "mesh_once" || stem.starts_with("msaa")
}

fn main() -> ExitCode {
    let Some(folder) = std::env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("usage: conformance FOLDER");
        return ExitCode::from(2);
    };
    let mut files: Vec<PathBuf> = match std::fs::read_dir(&folder) {
        Ok(entries) => entries.flatten().map(|entry| entry.path()).collect(),
        Err(error) => {
            eprintln!("{}: {error}", folder.display());
            return ExitCode::from(2);
        }
    };
    files.retain(|file| file.extension().is_some_and(|e| e == "csv"));
    files.sort();
    let mut all_right = !files.is_empty();
    for file in &files {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let by = has_triangles(file).then_some(WALKS).into_iter().flatten();
        let mut subjects: Vec<(String, Box<dyn Rasterizer>)> = vec![(name.to_string(), Box::new(Subject::default()))];
        subjects.extend(by.map(|how| (format!("  by {}", how.0), Box::new(Traversed::new(how)) as Box<_>)));
        for (name, mut subject) in subjects {
            match check_file(file, &mut *subject) {
                Ok(outcome) => all_right &= report(&name, &outcome),
                Err(error) => {
                    println!("{error}");
                    all_right = false;
                }
            }
        }
    }
    if all_right { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
