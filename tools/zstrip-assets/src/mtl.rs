//! Reads MTL, the materials of OBJ.

use std::borrow::Cow;
use std::collections::HashMap;

use crate::draft::Context;
use crate::error::{Error, Kind, Place};
use crate::model::{AlphaMode, Material, Texture, Wrap};
use crate::obj::{Lines, numbers};
use crate::report::Note;

/// Materials of the libraries that an OBJ file names.
#[derive(Default)]
pub(crate) struct Library {
    by_name: HashMap<String, Material>,
}

impl Library {
    /// Returns a material, or none if no library has it.
    pub fn get(&self, name: &str) -> Option<&Material> {
        self.by_name.get(name)
    }

    /// Reads one more library. Its materials count only where no earlier one has the same name.
    ///
    /// A library that cannot be read is reported and left out: the shape is good without it.
    pub fn read(&mut self, file: &str, context: &mut Context) {
        let result = context.files.read_beside(file).and_then(|bytes| self.parse(file, &bytes, context));
        if let Err(error) = result {
            context.report.add(Note::MaterialMissing { reason: error.to_string() });
        }
    }

    fn parse(&mut self, file: &str, bytes: &[u8], context: &mut Context) -> Result<(), Error> {
        let mut current: Option<Draft> = None;
        let mut lines = Lines::new(bytes);
        while let Some((number, line)) = lines.next() {
            let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((&line, ""));
            if word == "newmtl" {
                self.finish(current.take(), context);
                let material = Material { name: rest.trim().to_owned(), ..Material::default() };
                current = Some(Draft { material, map: None, alpha_map: None });
                continue;
            }
            let Some(Draft { material, map, alpha_map }) = &mut current else { continue };
            let value = |least: usize| {
                let values = numbers(rest).filter(|values| values.len() >= least);
                values.ok_or_else(|| {
                    let message = format!("{word} with {:?}, where {least} finite numbers are needed", rest.trim());
                    Error::new(file.as_ref(), Place::Line(number), Kind::Syntax, message)
                })
            };
            match word {
                // Kd xyz and Kd spectral are in other colour spaces, and in no file that we have seen.
                "Kd" => material.color[..3].copy_from_slice(&value(3)?[..3]),
                "d" => material.color[3] = value(1)?[0],
                "Tr" => material.color[3] = 1.0 - value(1)?[0],
                // Constant colour, without light.
                "illum" => material.unlit = value(1)?[0] == 0.0,
                "map_Kd" => *map = Some(MapLine::parse(rest, context)),
                "map_d" => *alpha_map = Some(MapLine::parse(rest, context)),
                _ if word.starts_with("map_") || ["bump", "norm", "disp", "decal", "refl"].contains(&word) => {
                    context.ignore(&format!("{word} in materials"));
                }
                _ => {}
            }
        }
        self.finish(current, context);
        if lines.not_utf8 > 0 {
            context.report.add(Note::NotUtf8 { lines: lines.not_utf8 });
        }
        Ok(())
    }

    /// Adds a material whose lines have all been read.
    fn finish(&mut self, draft: Option<Draft>, context: &mut Context) {
        let Some(Draft { mut material, map, alpha_map }) = draft else { return };
        material.color = material.color.map(|x| x.clamp(0.0, 1.0));
        if material.color[3] < 1.0 {
            material.alpha = AlphaMode::Blend;
        }
        if let Some(MapLine { file, wrap }) = map {
            let Context { images, files, options, .. } = context;
            let read = || files.read_beside(&file).map(Cow::Owned).map_err(|error| error.to_string());
            match images.of_file(&file, &file, &options.limits, read) {
                Ok(image) => material.texture = Some(Texture { image, wrap: [wrap; 2], nearest: false }),
                Err(reason) => context.report.add(Note::TextureMissing { reason }),
            }
            if alpha_map.as_ref().is_some_and(|alpha| alpha.file != file) {
                context.ignore("map_d that is not the image of map_Kd");
            } else if alpha_map.is_some() && material.alpha == AlphaMode::Opaque {
                material.alpha = AlphaMode::Mask { cutoff: 0.5 };
            }
        } else if alpha_map.is_some() {
            context.ignore("map_d without map_Kd");
        }
        self.by_name.entry(material.name.clone()).or_insert(material);
    }
}

/// A material of which more lines may come.
struct Draft {
    material: Material,
    map: Option<MapLine>,
    alpha_map: Option<MapLine>,
}

/// The line of a texture: options, then the name of a file, which may hold blanks.
struct MapLine {
    file: String,
    wrap: Wrap,
}

impl MapLine {
    fn parse(text: &str, context: &mut Context) -> Self {
        let mut wrap = Wrap::Repeat;
        let mut rest = text.trim();
        while let Some((option, after)) = rest.split_once(char::is_whitespace).filter(|(word, _)| word.starts_with('-'))
        {
            let (most, is_number) = match option {
                "-blendu" | "-blendv" | "-cc" | "-clamp" | "-imfchan" | "-type" => (1, false),
                "-boost" | "-bm" | "-texres" => (1, true),
                "-mm" => (2, true),
                "-o" | "-s" | "-t" => (3, true),
                _ => break,
            };
            rest = after.trim_start();
            for _ in 0..most {
                let (word, after) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
                if is_number && word.parse::<f32>().is_err() {
                    break;
                }
                if option == "-clamp" && word == "on" {
                    wrap = Wrap::Clamp;
                }
                rest = after.trim_start();
            }
            if option != "-clamp" {
                context.ignore(&format!("option {option} of textures"));
            }
        }
        Self { file: rest.to_owned(), wrap }
    }
}
