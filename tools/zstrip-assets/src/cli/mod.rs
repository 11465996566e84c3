//! The command line: each command is a file, and reads its own options.
//!
//! | file | |
//! |---|---|
//! | `convert.rs` | `convert` and `info` |
//! | `check.rs` | `check`: what is lost, and what the model costs |
//! | `view.rs`, `animation.rs` | `view`: a window, PNG and GIF files |
//! | `bench.rs`, `emulator.rs` | `bench`: firmware with the model, counted in QEMU |
//! | `arguments.rs` | options of several commands |
//! | `source.rs` | a file of any kind comes in, a container goes out |

mod animation;
mod arguments;
mod bench;
mod check;
mod convert;
mod emulator;
mod failure;
/// Models that the library's tests make up.
#[cfg(test)]
#[allow(dead_code)]
#[path = "../../../../tests/model"]
mod made_up {
    pub mod builder;
    pub mod figures;
}
mod source;
mod view;

use arguments::MODEL_OPTIONS;
use failure::Failure;
use lexopt::{Arg, Parser};
use std::io::Write;
use std::process::ExitCode;

/// The text of `--help`; options of models follow.
const HELP: &str = "\
Brings OBJ, STL, PLY, glTF and GLB files to zstrip.

  zstrip-assets convert FILE [options]   writes a container, FILE.zstm beside FILE unless -o says otherwise
  zstrip-assets info FILE [options]      prints what a conversion finds and loses, and writes nothing
  zstrip-assets check FILE [options]     prints what a conversion loses, and what the model takes: flash, RAM, time
  zstrip-assets view FILE [options]      shows the model turning, as firmware draws it: in a window, in PNG and GIF files
  zstrip-assets bench FILE [options]     counts the instructions of firmware with the model, in QEMU

FILE is a model. check, view and bench also take a container. zstrip-assets COMMAND --help lists all options of a
command, zstrip-assets --version prints the version.

";

const EXIT_CODES: &str = "
Exit codes: 0 done, 1 it cannot be done, 2 the command line is wrong.
";

/// Does what the command line says.
pub fn run(mut parser: Parser) -> ExitCode {
    match command(&mut parser) {
        Ok(text) => {
            // A reader that has seen enough is no error.
            std::io::stdout().write_all(text.as_bytes()).ok();
            ExitCode::SUCCESS
        }
        Err(failure) => {
            eprintln!("zstrip-assets: {failure}");
            failure.code()
        }
    }
}

/// Runs the command, and returns what it prints.
fn command(parser: &mut Parser) -> Result<String, Failure> {
    let name = match parser.next()? {
        Some(Arg::Short('h') | Arg::Long("help")) => return Ok(format!("{HELP}{MODEL_OPTIONS}{EXIT_CODES}")),
        Some(Arg::Short('V') | Arg::Long("version")) => {
            return Ok(format!("zstrip-assets {}\n", env!("CARGO_PKG_VERSION")));
        }
        Some(Arg::Value(name)) => name,
        Some(other) => return Err(other.unexpected().into()),
        None => return Err(Failure::Usage(format!("a command is missing: {COMMANDS}"))),
    };
    match name.to_str() {
        Some("convert") => convert::convert(parser),
        Some("info") => convert::info(parser),
        Some("check") => check::check(parser),
        Some("view") => view::view(parser),
        Some("bench") => bench::bench(parser),
        _ => Err(Failure::Usage(format!("{}: there is no such command: {COMMANDS}", name.to_string_lossy()))),
    }
}

const COMMANDS: &str = "convert, info, check, view and bench are known";

/// Returns the help of a command.
fn help(usage: &str) -> String {
    format!("{usage}\n{MODEL_OPTIONS}{EXIT_CODES}")
}
