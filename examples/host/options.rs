//! The options of the command line, common to all examples.

use super::program::{Demo, Depth};
use std::error::Error;
use std::path::PathBuf;

/// The settings of a frame.
pub struct Settings {
    pub png: Option<PathBuf>,
    pub strip_rows: u16,
    pub records: usize,
    pub frame: u32,
    pub mode: usize,
    pub size: (u16, u16),
}

/// Returns the text that `--help` prints.
pub fn help<D: Demo<Z>, Z: Depth>() -> String {
    let first = D::MODES.get(D::FIRST);
    let modes = first.map_or_else(String::new, |first| {
        format!("  --mode NAME       what or how to draw ({first}); --scene is the same\n")
    });
    let names = if D::MODES.is_empty() { String::new() } else { format!("\n\nmodes\n  {}", D::MODES.join(", ")) };
    format!(
        "\
{about} Without a display it is written to {name}.png.

usage: {name} [options]

options
  --png FILE        write a picture instead of opening a window
{modes}  --frame N         number of the first frame (0)
  --size WxH        pixels of the screen (320x240)
  --strip-rows N    rows of a strip (16)
  --records N       words of records, of 4 bytes; 0 is allowed ({records})
  --help            this text

keys in the window
  M, 1 to 9         next mode, or one of the first nine, where there are several
  Up, Down          higher and lower strips
  Right, Left       more and fewer records
  Space             pause
  comma, period     a frame back or forth
{keys}  Esc               quit{names}",
        about = D::ABOUT,
        name = D::NAME,
        records = D::RECORDS,
        keys = D::KEYS,
    )
}

/// Returns the settings of the command line, or `None` if help was asked for.
pub fn arguments<D: Demo<Z>, Z: Depth>() -> Result<Option<Settings>, Box<dyn Error>> {
    use lexopt::prelude::*;
    let mut settings =
        Settings { png: None, strip_rows: 16, records: D::RECORDS, frame: 0, mode: D::FIRST, size: (320, 240) };
    let mut parser = lexopt::Parser::from_env();
    while let Some(argument) = parser.next()? {
        match argument {
            Long("png") => settings.png = Some(parser.value()?.into()),
            Long("mode" | "scene") => settings.mode = parser.value()?.parse_with(mode::<D, Z>)?,
            Long("frame") => settings.frame = parser.value()?.parse()?,
            Long("size") => settings.size = parser.value()?.parse_with(size)?,
            Long("strip-rows") => settings.strip_rows = parser.value()?.parse()?,
            Long("records") => settings.records = parser.value()?.parse()?,
            Long("help") | Short('h') => return Ok(None),
            _ => return Err(argument.unexpected().into()),
        }
    }
    if settings.strip_rows == 0 {
        return Err("a strip has at least one row".into());
    }
    if settings.records > 1 << 28 {
        return Err("more than 1 GiB of records".into());
    }
    Ok(Some(settings))
}

fn mode<D: Demo<Z>, Z: Depth>(name: &str) -> Result<usize, String> {
    let found = D::MODES.iter().position(|mode| *mode == name);
    found.ok_or_else(|| match D::MODES {
        [] => "there are no modes".into(),
        modes => format!("the modes are {}", modes.join(", ")),
    })
}

fn size(text: &str) -> Result<(u16, u16), &'static str> {
    let parsed = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    parsed.ok_or("a size is like 320x240")
}
