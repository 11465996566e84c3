//! Runs targets on files and on random bytes, without libFuzzer: `replay <folder> <count> [target]...`.

// Instrumented code calls functions of libFuzzer.
#[cfg(feature = "libfuzzer")]
use libfuzzer_sys as _;
use std::process::ExitCode;

fn main() -> ExitCode {
    zstrip_fuzz::replay::run(&zstrip_fuzz::TARGETS)
}
