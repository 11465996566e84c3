//! Checks the conformance files of a folder and prints a line for each.
//!
//! `cargo run --release --example conformance -- FOLDER`. The exit code is 0 only if every record that has a check is
//! right.

#[path = "../tests/reference/mod.rs"]
mod reference;

use reference::conformance::{Outcome, check_file};
use std::path::PathBuf;
use std::process::ExitCode;

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
        match check_file(file, &mut reference::subject::Subject::default()) {
            Ok(outcome @ Outcome::Checked { right, total, .. }) => {
                println!("{name}: {right} of {total}");
                all_right &= outcome.is_right();
                if let Outcome::Checked { first_wrong: Some(wrong), .. } = outcome {
                    println!("  first wrong: {wrong}");
                }
            }
            Err(error) => {
                println!("{error}");
                all_right = false;
            }
        }
    }
    if all_right { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
