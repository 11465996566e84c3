//! `zstrip-assets`: converts models on the command line.

mod arguments;

use std::io::{IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;

use arguments::{Arguments, Command, HELP};
use zstrip_assets::{Import, Progress, Report, import_with_progress, save, write, write_rust};

/// A file could not be read, converted or written.
const FAILED: u8 = 1;
/// The command line is wrong.
const USAGE: u8 = 2;

fn main() -> ExitCode {
    let arguments = match Arguments::parse(lexopt::Parser::from_env()) {
        Ok(Command::Help) => {
            print!("{HELP}");
            return ExitCode::SUCCESS;
        }
        Ok(Command::Run(arguments)) => arguments,
        Err(error) => {
            eprintln!("zstrip-assets: {error}\nTry: zstrip-assets --help");
            return ExitCode::from(USAGE);
        }
    };
    match run(&arguments) {
        Ok(text) => {
            // A reader that has seen enough is no error.
            std::io::stdout().write_all(text.as_bytes()).ok();
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("zstrip-assets: {error}");
            ExitCode::from(FAILED)
        }
    }
}

/// Does what was asked for, and returns the report.
fn run(arguments: &Arguments) -> Result<String, String> {
    let (import, report) = read(arguments)?;
    let in_file = |error: &dyn std::fmt::Display| format!("{}: {error}", arguments.file.display());
    if arguments.info_only {
        let written = write(&import, &arguments.write).map_err(|error| in_file(&error))?;
        return Ok(format!("{report}{}", written.report));
    }
    let output = &arguments.output;
    let to = |path: &Path, bytes: &[u8]| save(path, bytes).map_err(|error| format!("{}: {error}", path.display()));
    let written = if arguments.rust {
        let container = output.with_extension("zstm");
        let name = output.file_stem().unwrap_or_default().to_string_lossy();
        let beside = container.file_name().unwrap_or_default().to_string_lossy();
        let (source, written) =
            write_rust(&import, &name, &beside, &arguments.write).map_err(|error| in_file(&error))?;
        to(&container, &written.bytes)?;
        to(output, source.as_bytes())?;
        written
    } else {
        let written = write(&import, &arguments.write).map_err(|error| in_file(&error))?;
        to(output, &written.bytes)?;
        written
    };
    Ok(format!("{report}{}written: {}\n", written.report, output.display()))
}

/// Imports the file, and shows progress where somebody looks at it.
fn read(arguments: &Arguments) -> Result<(Import, Report), String> {
    let shows = std::io::stderr().is_terminal();
    let mut progress = |stage| {
        if shows {
            match stage {
                Progress::Reading => eprint!("\rreading"),
                Progress::Mesh { number, count } => eprint!("\rmesh {number} of {count}  "),
            }
        }
    };
    let result = import_with_progress(&arguments.file, &arguments.import, &mut progress);
    if shows {
        eprint!("\r                              \r");
    }
    result.map_err(|error| error.to_string())
}
