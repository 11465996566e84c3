//! `zstrip-assets`: converts, checks, shows and counts models on the command line.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run(lexopt::Parser::from_env())
}
