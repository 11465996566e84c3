//! `check`: what a conversion loses, and what the model costs.

use super::arguments::{self, A_NUMBER, Conversion, PANEL_OPTIONS, Screen, number};
use super::failure::Failure;
use super::{help, source};
use lexopt::Parser;
use std::fmt::Write;
use std::path::PathBuf;
use zstrip_assets::preview::{CORES, LevelUse, contact_sheet, estimate};

const CHECK: &str = "\
zstrip-assets check FILE [options]: prints what a conversion loses, and what the model takes, before it is flashed

  --sheet FILE            writes a contact sheet, a PNG file: eight views of the model, or eight poses of each clip
  --m4-clock MHZ          clock of the Cortex-M4 [default: 168]
  --tsv                   prints only lines of core, stage, and mean and largest number of instructions, between tabs
";

/// Returns the levels of detail, if there are any, and those that the frames of a turn draw.
fn levels(levels: &[LevelUse]) -> String {
    if levels.len() < 2 {
        return String::new();
    }
    let all: usize = levels.iter().map(|level| level.draws).sum();
    let mut text = String::from("\nlevels of detail   triangles   vertices      error   draws of a turn\n");
    for (k, LevelUse { vertices, triangles, error, draws }) in levels.iter().enumerate() {
        let name = if k == 0 { "the model".to_owned() } else { format!("level {k}") };
        // Writing to a string does not fail.
        _ = writeln!(text, "  {name:<16} {triangles:>9} {vertices:>10} {error:>10.5}   {draws} of {all}");
    }
    text.push_str("The coarsest level is drawn whose error is below a pixel.\n");
    text
}

/// Runs `check`.
pub fn check(parser: &mut Parser) -> Result<String, Failure> {
    let (mut conversion, mut screen) = (Conversion::default(), Screen::default());
    let (mut megahertz, mut sheet, mut tsv): (f64, Option<PathBuf>, _) = (CORES[2].hertz / 1e6, None, false);
    let take = &mut |name: &str, parser: &mut Parser| {
        match name {
            "m4-clock" => megahertz = number(name, A_NUMBER, parser)?,
            "sheet" => sheet = Some(PathBuf::from(parser.value()?)),
            "tsv" => tsv = true,
            _ => return Ok(screen.take(name, parser)? || conversion.take(name, parser)?),
        }
        Ok(true)
    };
    let Some(file) = arguments::read(parser, take)? else { return Ok(help(&format!("{CHECK}\n{PANEL_OPTIONS}"))) };
    let outputs = sheet.as_deref().into_iter().collect::<Vec<_>>();
    let (container, mut text) = source::container(&file, &conversion, &outputs)?;
    let stage = source::stage(&file, &container, &screen)?;
    let estimate = estimate(&stage, megahertz * 1e6)?;
    if tsv {
        text = String::new();
        for of in estimate.cores.iter().filter(|of| of.core.name != "Cortex-M33") {
            for (stage, amount) in [("pose", of.pose), ("place", of.place), ("draw", of.draw), ("frame", of.frame)] {
                // Writing to a string does not fail.
                _ = writeln!(text, "{}\t{stage}\t{:.0}\t{:.0}", of.core.counted_on, amount.mean, amount.worst);
            }
        }
    } else {
        _ = write!(text, "\n{estimate}{}", levels(&stage.levels()?));
    }
    if let Some(path) = sheet {
        contact_sheet(&stage)?.write_png(&path)?;
        _ = writeln!(text, "\nwrote {}", path.display());
    }
    Ok(text)
}
