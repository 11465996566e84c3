//! `check` and, with the feature `view`, `view`: see the README's chapter on what a model costs.
//!
//! ```text
//! cargo run --release --example preview -- check MODEL.zstm --sheet sheet.png
//! cargo run --release --features view --example preview -- view MODEL.zstm
//! ```
use std::process::ExitCode;
use zstrip_assets::preview::{PreviewError, command};

fn main() -> ExitCode {
    let mut parser = lexopt::Parser::from_env();
    match run(&mut parser) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("preview: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(parser: &mut lexopt::Parser) -> Result<(), PreviewError> {
    let command = parser.next()?;
    match &command {
        Some(lexopt::Arg::Value(name)) if name == "check" => command::check(parser),
        #[cfg(feature = "view")]
        Some(lexopt::Arg::Value(name)) if name == "view" => zstrip_assets::preview::view::view(parser),
        _ => {
            println!("{}", command::CHECK);
            #[cfg(feature = "view")]
            println!("\n{}", zstrip_assets::preview::view::VIEW);
            Ok(())
        }
    }
}
