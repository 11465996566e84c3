//! The commands `check` and `view` of the command line.

use super::{CORES, Container, Format, Panel, PreviewError, Stage, contact_sheet, estimate};
use lexopt::prelude::*;
use std::path::PathBuf;

/// The help for [`check`].
pub const CHECK: &str = "\
check MODEL.zstm [options]: what a model costs, before it is flashed

  --screen WxH      pixels of the panel (240x320)
  --rows N          rows of a strip (16)
  --format NAME     rgb565, rgb565be, rgb888, gray8 or dithered (rgb565)
  --zoom PERCENT    size of the model; at 100, all of a turn is on the screen (100)
  --m4-clock MHZ    clock of the Cortex-M4 (168)
  --sheet FILE      writes a contact sheet, a PNG
  --tsv             prints core, stage, and mean and largest number of instructions only";

/// Settings that all commands share.
pub(super) struct Settings {
    pub file: PathBuf,
    pub panel: Panel,
    pub format: Format,
}

/// Reads arguments: those that all commands share here, the others by `other`, which returns `false` for one that it
/// does not know.
pub(super) fn settings(
    parser: &mut lexopt::Parser,
    other: &mut dyn FnMut(&str, &mut lexopt::Parser) -> Result<bool, PreviewError>,
) -> Result<Settings, PreviewError> {
    let mut file = None;
    let mut panel = Panel { width: 240, height: 320, rows: 16, zoom: 100 };
    let mut format = Format::Rgb565;
    while let Some(argument) = parser.next()? {
        match argument {
            Value(value) if file.is_none() => file = Some(PathBuf::from(value)),
            Long("screen") => {
                let text = parser.value()?.string()?;
                let size = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
                (panel.width, panel.height) = size
                    .ok_or_else(|| PreviewError::Usage(format!("--screen {text}: it takes a size such as 240x320")))?;
            }
            Long("rows") => panel.rows = parser.value()?.parse()?,
            Long("zoom") => panel.zoom = parser.value()?.parse()?,
            Long("format") => {
                let text = parser.value()?.string()?;
                let known = Format::ALL.iter().find(|(_, name, _)| *name == text);
                let names = Format::ALL.map(|(_, name, _)| name).join(", ");
                format = known.ok_or_else(|| PreviewError::Usage(format!("--format {text}: it is one of {names}")))?.0;
            }
            Long(name) => {
                let name = name.to_owned();
                if !other(&name, parser)? {
                    return Err(PreviewError::Usage(format!("there is no option --{name}")));
                }
            }
            argument => return Err(argument.unexpected().into()),
        }
    }
    let file = file.ok_or_else(|| PreviewError::Usage("which file? It is a container of a model".to_owned()))?;
    Ok(Settings { file, panel, format })
}

/// Runs `check`: prints an estimate, and writes a contact sheet if there is to be one.
///
/// # Errors
///
/// If the command line is wrong, the file is no container, or the sheet cannot be written.
pub fn check(parser: &mut lexopt::Parser) -> Result<(), PreviewError> {
    let (mut megahertz, mut sheet, mut tsv) = (CORES[2].hertz / 1e6, None, false);
    let settings = settings(parser, &mut |name, parser| {
        match name {
            "m4-clock" => megahertz = parser.value()?.parse::<f64>()?,
            "sheet" => sheet = Some(PathBuf::from(parser.value()?)),
            "tsv" => tsv = true,
            _ => return Ok(false),
        }
        Ok(true)
    })?;
    let container = Container::read(&settings.file)?;
    let stage = Stage::new(&container, settings.panel, settings.format)?;
    let estimate = estimate(&stage, megahertz * 1e6)?;
    if tsv {
        for of in estimate.cores.iter().filter(|of| of.core.name != "Cortex-M33") {
            for (stage, amount) in [("pose", of.pose), ("place", of.place), ("draw", of.draw), ("frame", of.frame)] {
                println!("{}\t{stage}\t{:.0}\t{:.0}", of.core.counted_on, amount.mean, amount.worst);
            }
        }
    } else {
        print!("{estimate}");
    }
    if let Some(path) = sheet {
        contact_sheet(&stage)?.write_png(&path)?;
    }
    Ok(())
}
