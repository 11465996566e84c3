//! `convert` and `info`.

use super::arguments::{self, Conversion};
use super::failure::Failure;
use super::{help, source};
use lexopt::Parser;
use std::path::{Path, PathBuf};
use zstrip_assets::{WriteError, save, write, write_rust};

const CONVERT: &str = "\
zstrip-assets convert FILE [options]: writes a container

Output:
  -o, --output OUT        the file to write [default: FILE.zstm beside FILE; FILE.rs with --rust]
  --rust                  writes Rust source, OUT.rs, and the container beside it
";

const INFO: &str = "\
zstrip-assets info FILE [options]: prints what a conversion finds and loses, and writes nothing
";

/// Runs `info`.
pub fn info(parser: &mut Parser) -> Result<String, Failure> {
    let mut conversion = Conversion::default();
    let take = &mut |name: &str, parser: &mut Parser| Ok(conversion.take(name, parser)?);
    let Some(file) = arguments::read(parser, take)? else { return Ok(help(INFO)) };
    let (import, report) = source::read(&file, &conversion, &[])?;
    let written = write(&import, &conversion.write).map_err(|error| unwritten(&file, error))?;
    Ok(format!("{report}{}", written.report))
}

/// Runs `convert`.
pub fn convert(parser: &mut Parser) -> Result<String, Failure> {
    let (mut conversion, mut output, mut rust) = (Conversion::default(), None, false);
    let take = &mut |name: &str, parser: &mut Parser| {
        match name {
            "output" => output = Some(PathBuf::from(parser.value()?)),
            "rust" => rust = true,
            _ => return Ok(conversion.take(name, parser)?),
        }
        Ok(true)
    };
    let Some(file) = arguments::read(parser, take)? else { return Ok(help(CONVERT)) };
    let ending = if rust { "rs" } else { "zstm" };
    let output = output.unwrap_or_else(|| file.with_extension(ending));
    let container = output.with_extension("zstm");
    if rust && container == output {
        return Err(Failure::Usage(format!("the output {} must have another name, as OUT.{ending}", output.display())));
    }
    let outputs = if rust { &[&output, &container][..] } else { &[&output] };
    let outputs = outputs.iter().map(|path| path.as_path()).collect::<Vec<_>>();
    let (import, report) = source::read(&file, &conversion, &outputs)?;
    let to = |path: &Path, bytes: &[u8]| {
        save(path, bytes).map_err(|error| Failure::Failed(format!("{}: {error}", path.display())))
    };
    let written = if rust {
        let name = output.file_stem().unwrap_or_default().to_string_lossy();
        let beside = container.file_name().unwrap_or_default().to_string_lossy();
        let (source, written) =
            write_rust(&import, &name, &beside, &conversion.write).map_err(|error| unwritten(&file, error))?;
        to(&container, &written.bytes)?;
        to(&output, source.as_bytes())?;
        written
    } else {
        let written = write(&import, &conversion.write).map_err(|error| unwritten(&file, error))?;
        to(&output, &written.bytes)?;
        written
    };
    Ok(format!("{report}{}written: {}\n", written.report, output.display()))
}

/// Returns the reason why a model was not written.
pub fn unwritten(file: &Path, error: WriteError) -> Failure {
    match error {
        WriteError::Options(fault) => Failure::Usage(fault),
        error => in_file(file, &error),
    }
}

/// Returns an error of a file.
pub fn in_file(file: &Path, error: &dyn std::fmt::Display) -> Failure {
    Failure::Failed(format!("{}: {error}", file.display()))
}
