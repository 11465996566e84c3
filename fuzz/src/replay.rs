//! Runs targets on files and on random bytes, without libFuzzer.

use crate::{Hash, Rng, Target};
use std::panic::catch_unwind;
use std::path::Path;
use std::process::ExitCode;

/// Does what the arguments of the program say: `replay <folder> <count> [target]...`.
///
/// Prints a line per target: the number of files, of random inputs, and a hash over all results, to be compared between
/// machines. Names each file, or the seed, that a target fails on, and then exits with 1.
pub fn run(targets: &[Target]) -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let (Some(folder), Some(Ok(count))) = (arguments.next(), arguments.next().map(|count| count.parse::<u64>())) else {
        eprintln!("usage: replay <folder of corpora> <random inputs per target> [target]...");
        return ExitCode::FAILURE;
    };
    let wanted: Vec<String> = arguments.collect();
    let mut failures = 0;
    for (name, run) in targets {
        if !wanted.is_empty() && wanted.iter().all(|wanted| wanted != name) {
            continue;
        }
        let mut hash = Hash::default();
        let files = files(&Path::new(&folder).join(name));
        let seeds = (0..count).map(|seed| (format!("seed {seed}"), random(seed)));
        let number = files.len();
        for (what, input) in files.into_iter().chain(seeds) {
            match catch_unwind(|| run(&input)) {
                Ok(found) => hash.add(found),
                Err(_) => {
                    eprintln!("FINDING {name}: {what}");
                    failures += 1;
                }
            }
        }
        println!("{name:<14}{number:>5} files{count:>9} seeds  {:016x}", hash.0);
    }
    if failures == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The files of a folder in the order of their names.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry of a folder").path()).collect();
    paths.sort();
    let read = |path: std::path::PathBuf| (path.display().to_string(), std::fs::read(&path).expect("a file"));
    paths.into_iter().map(read).collect()
}

/// Returns random bytes, 8 to 2,007 of them. A scene takes 350 to 800: what is missing reads as zero, and draws next to
/// nothing.
fn random(seed: u64) -> Vec<u8> {
    let mut rng = Rng::new(seed);
    let length = 8 + rng.below(2000);
    (0..length).map(|_| rng.next_u32() as u8).collect()
}
