//! Options that several commands have.

use super::failure::Failure;
use lexopt::prelude::*;
use lexopt::{Error, Parser};
use std::path::PathBuf;
use std::str::FromStr;
use zstrip_assets::preview::{Format, Panel};
use zstrip_assets::{Center, Normals, Options, TextureKind, UpAxis, UvSize, Winding, WriteOptions};

/// Help for the options of a conversion.
pub const MODEL_OPTIONS: &str = "\
Geometry:
  --up y|z                the axis that points up [default: z for STL, y for all others]
  --scale FACTOR          multiplies all lengths [default: 1]
  --center keep|middle|ground
                          the point that comes to the origin: the file's own origin, the middle of the model, or the
                          middle of its bottom [default: keep]
  --flip                  the front of a triangle is where its corners go clockwise
  --fix-winding           turns over triangles whose normals point to their back
  --normals keep|smooth|flat
                          keeps the file's normals and makes those that are missing, or makes all of them anew
                          [default: keep]
  --crease DEGREES        the largest angle between faces at which normals that are made look smooth [default: 50]
  --weld DISTANCE         joins vertices up to that far apart, in units of the file [default: 0]
  --budget TRIANGLES      simplifies the model to about so many triangles
  --lods N                makes N levels of detail of each mesh, which are drawn where it is small [default: 0]
  --lod-ratio PART        the part of a level's triangles that the next one has [default: 0.5]

Textures:
  --texture FILE          an image for materials without one, as for OBJ without MTL
  --textures rgb565|palette|palette16|gray|mask
                          the format of textures [default: rgb565]
  --max-texture N         the most texels per side; larger images are shrunk [default: 256]
  --no-mips               leaves out smaller levels of textures, which models that are far away are drawn with
  --uvs fitting|8|16      bits of texture coordinates; fitting is 8 where those are exact, and 16 elsewhere
                          [default: fitting]

Animation:
  --key-error PART        leaves out keys that move nothing by more than this part of the model's size [default: 0.0005]
";

/// Options of a conversion.
#[derive(Default)]
pub struct Conversion {
    pub import: Options,
    pub write: WriteOptions,
    /// The last option that was given, if any.
    pub given: Option<String>,
}

impl Conversion {
    /// Takes the value of an option; `false` if the option is none of a conversion.
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, Error> {
        let Self { import, write, .. } = self;
        match name {
            "up" => {
                let kinds = [("y", UpAxis::Y), ("z", UpAxis::Z)];
                import.up = Some(parser.value()?.parse_with(|text| one_of(text, &kinds))?);
            }
            "scale" => import.scale = number(name, A_NUMBER, parser)?,
            "center" => {
                let kinds = [("keep", Center::Keep), ("middle", Center::Middle), ("ground", Center::Ground)];
                import.center = parser.value()?.parse_with(|text| one_of(text, &kinds))?;
            }
            "flip" => import.winding = Winding::Flip,
            "fix-winding" => import.winding = Winding::FromNormals,
            "normals" => {
                let kinds = [("keep", Normals::Keep), ("smooth", Normals::Smooth), ("flat", Normals::Flat)];
                import.normals = parser.value()?.parse_with(|text| one_of(text, &kinds))?;
            }
            "crease" => import.crease_angle = number(name, A_NUMBER, parser)?,
            "weld" => import.weld_distance = number(name, A_NUMBER, parser)?,
            "lods" => import.lods = number(name, A_COUNT, parser)?,
            "lod-ratio" => import.lod_ratio = number(name, A_NUMBER, parser)?,
            "budget" => import.max_triangles = Some(number(name, A_COUNT, parser)?),
            "texture" => import.texture = Some(parser.value()?.into()),
            "textures" => {
                let kinds = [
                    ("rgb565", TextureKind::Rgb565),
                    ("palette", TextureKind::Palette),
                    ("palette16", TextureKind::Palette16),
                    ("gray", TextureKind::Gray),
                    ("mask", TextureKind::Mask),
                ];
                write.textures = parser.value()?.parse_with(|text| one_of(text, &kinds))?;
            }
            "max-texture" => write.max_texture = number(name, A_COUNT, parser)?,
            "no-mips" => write.mips = false,
            "uvs" => {
                let kinds = [("fitting", UvSize::Fitting), ("8", UvSize::Bits8), ("16", UvSize::Bits16)];
                write.uvs = parser.value()?.parse_with(|text| one_of(text, &kinds))?;
            }
            "key-error" => write.key_error = number(name, A_NUMBER, parser)?,
            _ => return Ok(false),
        }
        self.given = Some(format!("--{name}"));
        Ok(true)
    }
}

/// Help for the options of a panel.
pub const PANEL_OPTIONS: &str = "\
Panel:
  --screen WxH            pixels of the panel [default: 240x320]
  --rows N                rows of a strip [default: 16, or all of a lower screen]
  --format NAME           rgb565, rgb565be, rgb888, gray8, or dithered, which is dithered rgb565 [default: rgb565]
  --zoom PERCENT          size of the model; at 100, all of a turn is on the screen [default: 100]
";

/// A panel, and the format of its pixels.
#[derive(Clone, Copy)]
pub struct Screen {
    pub panel: Panel,
    pub format: Format,
    /// True if the option of rows was given.
    pub has_rows: bool,
}

/// Rows of a strip.
const ROWS: u32 = 16;

impl Default for Screen {
    fn default() -> Self {
        let panel = Panel { width: 240, height: 320, rows: ROWS, zoom: 100 };
        Self { panel, format: Format::Rgb565, has_rows: false }
    }
}

impl Screen {
    /// Takes the value of an option; `false` if the option is none of a panel.
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, Error> {
        match name {
            "screen" => {
                (self.panel.width, self.panel.height) = parser.value()?.parse_with(size)?;
                if !self.has_rows {
                    self.panel.rows = ROWS.min(self.panel.height);
                }
            }
            "rows" => (self.panel.rows, self.has_rows) = (number(name, A_COUNT, parser)?, true),
            "zoom" => self.panel.zoom = number(name, A_COUNT, parser)?,
            "format" => {
                let kinds = Format::ALL.map(|(format, name, _)| (name, format));
                self.format = parser.value()?.parse_with(|text| one_of(text, &kinds))?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}

/// Reads a size such as 240x320.
fn size(text: &str) -> Result<(u32, u32), String> {
    let size = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    size.ok_or_else(|| "a size is written as 240x320".to_owned())
}

/// Takes the value of an option by its name; `false` if there is none of that name.
type TakeOption<'o> = dyn FnMut(&str, &mut Parser) -> Result<bool, Failure> + 'o;

/// Reads a command's options, and returns its file; `None` if there is to be help instead.
pub fn read(parser: &mut Parser, take: &mut TakeOption<'_>) -> Result<Option<PathBuf>, Failure> {
    let mut file = None;
    while let Some(argument) = parser.next()? {
        let name = match argument {
            Short('h') | Long("help") => return Ok(None),
            Short('o') => "output".to_owned(),
            Long(name) => name.to_owned(),
            Value(value) if file.is_none() => {
                file = Some(PathBuf::from(value));
                continue;
            }
            other => return Err(other.unexpected().into()),
        };
        if !take(&name, parser)? {
            return Err(Failure::Usage(format!("there is no option --{name} here")));
        }
    }
    file.map(Some).ok_or_else(|| Failure::Usage("the file is missing".to_owned()))
}

/// Kinds of numbers, for [`number`].
pub const A_NUMBER: &str = "a number";
pub const A_COUNT: &str = "a whole number from 0 to 4294967295";
pub const A_WHOLE: &str = "a whole number";

/// Reads the value of an option that takes a number of some kind.
pub fn number<T: FromStr>(name: &str, kind: &str, parser: &mut Parser) -> Result<T, Error> {
    parser.value()?.parse_with(|text| text.parse().map_err(|_| format!("--{name} takes {kind}")))
}

/// Returns the choice of a name.
pub fn one_of<T: Copy>(text: &str, choices: &[(&str, T)]) -> Result<T, String> {
    let found = choices.iter().find(|(name, _)| *name == text).map(|(_, choice)| *choice);
    found.ok_or_else(|| choices.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ") + " are the choices")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_tells_the_defaults_that_options_have() {
        let (import, write) = (Options::default(), WriteOptions::default());
        let Panel { width, height, rows, zoom } = Screen::default().panel;
        for (option, default) in [
            ("--scale", import.scale.to_string()),
            ("--crease", import.crease_angle.to_string()),
            ("--weld", import.weld_distance.to_string()),
            ("--lods", import.lods.to_string()),
            ("--lod-ratio", import.lod_ratio.to_string()),
            ("--max-texture", write.max_texture.to_string()),
            ("--key-error", write.key_error.to_string()),
            ("--screen", format!("{width}x{height}")),
            ("--rows", format!("{rows}, or all of a lower screen")),
            ("--zoom", zoom.to_string()),
        ] {
            let mut lines = MODEL_OPTIONS.lines().chain(PANEL_OPTIONS.lines());
            let line = lines.find(|line| line.trim_start().starts_with(&format!("{option} "))).expect("a line of help");
            assert!(line.ends_with(&format!("[default: {default}]")), "{line}: {default}");
            assert!(line.len() <= 120, "{line}");
        }
    }
}
