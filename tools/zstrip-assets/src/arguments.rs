//! The command line.

use std::ffi::OsString;
use std::path::PathBuf;

use lexopt::prelude::{Long, Short, Value};
use lexopt::{Error, Parser, ValueExt};
use zstrip_assets::{Center, Normals, Options, TextureKind, UpAxis, UvSize, Winding, WriteOptions};

/// The text of `--help`.
pub const HELP: &str = "\
Converts OBJ, STL, PLY, glTF and GLB files for zstrip.

  zstrip-assets convert FILE [-o OUT] [options]   writes a container, FILE.zstm beside FILE unless -o says otherwise
  zstrip-assets info FILE [options]               prints the report of a conversion, and writes nothing

Output:
  -o, --output OUT        the file to write
  --rust                  writes Rust source, OUT.rs, and the container beside it

Geometry:
  --up y|z                the axis that points up; z for STL, y for all others
  --scale FACTOR          a factor of all lengths
  --center keep|middle|ground   what comes to the origin
  --flip                  the front is where corners go clockwise
  --fix-winding           turns triangles over whose normals point to their back
  --normals keep|smooth|flat    where normals come from
  --crease DEGREES        the largest angle between faces that looks smooth; 50
  --weld DISTANCE         joins vertices that are as close as that
  --budget TRIANGLES      simplifies the model to so many triangles

Textures:
  --texture FILE          an image for materials without one, as for OBJ without MTL
  --textures rgb565|palette|palette16|gray|mask   the format; rgb565
  --max-texture N         the most texels per side; 256
  --no-mips               no smaller levels of textures
  --uvs fitting|8|16      bits of texture coordinates; 8 where they are exact

Animation:
  --key-error PART        how far leaving out keys may move something, as a part of the model's size; 0.0005

Exit codes: 0 done, 1 the file cannot be converted, 2 the command line is wrong.
";

/// The thing to do.
pub enum Command {
    Help,
    Run(Box<Arguments>),
}

/// A conversion, or the report of one.
pub struct Arguments {
    pub info_only: bool,
    pub file: PathBuf,
    pub output: PathBuf,
    pub rust: bool,
    pub import: Options,
    pub write: WriteOptions,
}

impl Arguments {
    pub fn parse(mut parser: Parser) -> Result<Command, Error> {
        let (mut command, mut file, mut output, mut rust) = (None, None, None::<OsString>, false);
        let (mut import, mut write) = (Options::default(), WriteOptions::default());
        while let Some(argument) = parser.next()? {
            match argument {
                Short('h') | Long("help") => return Ok(Command::Help),
                Short('o') | Long("output") => output = Some(parser.value()?),
                Long("rust") => rust = true,
                Long("up") => {
                    import.up =
                        Some(parser.value()?.parse_with(|text| one_of(text, &[("y", UpAxis::Y), ("z", UpAxis::Z)]))?)
                }
                Long("scale") => import.scale = parser.value()?.parse()?,
                Long("center") => {
                    let kinds = [("keep", Center::Keep), ("middle", Center::Middle), ("ground", Center::Ground)];
                    import.center = parser.value()?.parse_with(|text| one_of(text, &kinds))?;
                }
                Long("flip") => import.winding = Winding::Flip,
                Long("fix-winding") => import.winding = Winding::FromNormals,
                Long("normals") => {
                    let kinds = [("keep", Normals::Keep), ("smooth", Normals::Smooth), ("flat", Normals::Flat)];
                    import.normals = parser.value()?.parse_with(|text| one_of(text, &kinds))?;
                }
                Long("crease") => import.crease_angle = parser.value()?.parse()?,
                Long("weld") => import.weld_distance = parser.value()?.parse()?,
                Long("budget") => import.max_triangles = Some(parser.value()?.parse()?),
                Long("texture") => import.texture = Some(parser.value()?.into()),
                Long("textures") => {
                    let kinds = [
                        ("rgb565", TextureKind::Rgb565),
                        ("palette", TextureKind::Palette),
                        ("palette16", TextureKind::Palette16),
                        ("gray", TextureKind::Gray),
                        ("mask", TextureKind::Mask),
                    ];
                    write.textures = parser.value()?.parse_with(|text| one_of(text, &kinds))?;
                }
                Long("max-texture") => write.max_texture = parser.value()?.parse()?,
                Long("no-mips") => write.mips = false,
                Long("uvs") => {
                    let kinds = [("fitting", UvSize::Fitting), ("8", UvSize::Bits8), ("16", UvSize::Bits16)];
                    write.uvs = parser.value()?.parse_with(|text| one_of(text, &kinds))?;
                }
                Long("key-error") => write.key_error = parser.value()?.parse()?,
                Value(value) if command.is_none() => {
                    command = Some(value.parse_with(|text| one_of(text, &[("convert", false), ("info", true)]))?);
                }
                Value(value) if file.is_none() => file = Some(PathBuf::from(value)),
                other => return Err(other.unexpected()),
            }
        }
        let info_only = command.ok_or("convert or info, and a file, are missing")?;
        let file = file.ok_or("the file is missing")?;
        let ending = if rust { "rs" } else { "zstm" };
        let output = output.map_or_else(|| file.with_extension(ending), PathBuf::from);
        if output == file || rust && output.with_extension("zstm") == output {
            return Err(format!("the output {} must have another name, as OUT.{ending}", output.display()).into());
        }
        Ok(Command::Run(Box::new(Self { info_only, file, output, rust, import, write })))
    }
}

/// Returns the choice of a name.
fn one_of<T: Copy>(text: &str, choices: &[(&str, T)]) -> Result<T, String> {
    let found = choices.iter().find(|(name, _)| *name == text).map(|(_, choice)| *choice);
    found.ok_or_else(|| choices.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ") + " are the choices")
}
