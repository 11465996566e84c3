//! Reads files, but no more bytes than the limits allow, and none from outside of the model's folder.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};

use crate::error::{Error, Kind, Place};

/// Base64 with or without padding, as exporters write both.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The model's folder, and how many bytes may still be read.
pub(crate) struct Files {
    /// The model's file.
    pub model: PathBuf,
    /// The files that were read.
    pub read: Vec<PathBuf>,
    /// Files that the model names, and that are not there.
    pub missing: Vec<PathBuf>,
    /// The folder, without links in its path; or why there is none.
    folder: Result<PathBuf, String>,
    left: u64,
    limit: u64,
}

impl Files {
    /// Stands in the folder of `model`, and may read `limit` bytes.
    pub fn new(model: &Path, limit: u64) -> Self {
        let folder = model.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = folder.canonicalize().map_err(|error| format!("the folder cannot be opened: {error}"));
        Self { model: model.to_path_buf(), read: Vec::new(), missing: Vec::new(), folder, left: limit, limit }
    }

    /// Reads the model itself.
    pub fn read_model(&mut self) -> Result<Vec<u8>, Error> {
        let path = self.model.clone();
        self.read(&path)
    }

    /// Reads a file that the caller names.
    pub fn read_named(&mut self, path: &Path) -> Result<Vec<u8>, Error> {
        self.read(path)
    }

    /// Reads a file that the model names.
    ///
    /// The name is a path below the folder of the model, with `/` or `\`. A path that leads out of it, by `..`, from
    /// the root or through a link, is an error: a model from elsewhere must not publish files of this machine.
    pub fn read_beside(&mut self, name: &str) -> Result<Vec<u8>, Error> {
        let folder = match &self.folder {
            Ok(folder) => folder,
            Err(message) => return Err(Error::new(&self.model, Place::File, Kind::Io, message.clone())),
        };
        let relative = PathBuf::from(name.trim().replace('\\', "/"));
        let leaves = |path: &Path| {
            let message = format!("{name:?} leads out of the folder of the model; copy that file into the folder");
            Err(Error::new(path, Place::File, Kind::OutsideFolder, message))
        };
        // A letter and a colon begin an absolute path on Windows, wherever the file is read.
        let is_plain = |part| matches!(part, Component::Normal(_) | Component::CurDir);
        if !relative.components().all(is_plain) || name.contains(':') || name.contains('\0') {
            return leaves(&self.model);
        }
        let path = folder.join(&relative);
        match path.canonicalize() {
            Ok(real) if !real.starts_with(folder) => leaves(&self.model),
            Ok(real) => self.read(&real),
            Err(error) => {
                self.missing.push(path);
                let message = format!("{name:?} cannot be opened: {error}");
                Err(Error::new(&self.model, Place::File, Kind::Missing, message))
            }
        }
    }

    /// Reads what a URI of a glTF document stands for: base64 data, or a file beside the document.
    pub fn read_uri(&mut self, uri: &str, place: Place) -> Result<Vec<u8>, Error> {
        let fail = |kind, message: String| Err(Error::new(&self.model, place.clone(), kind, message));
        if let Some(data) = uri.strip_prefix("data:") {
            let Some((_, data)) = data.split_once(";base64,") else {
                return fail(Kind::Unsupported, "a data URI without \";base64,\"; embed data as base64".to_owned());
            };
            return match BASE64.decode(data.trim()) {
                Ok(bytes) => Ok(bytes),
                Err(error) => fail(Kind::Syntax, format!("base64: {error}")),
            };
        }
        match percent_encoding::percent_decode_str(uri).decode_utf8() {
            Ok(name) => self.read_beside(&name).map_err(|error| Error { place, ..error }),
            Err(error) => fail(Kind::Syntax, format!("the URI {uri:?} is not UTF-8: {error}")),
        }
    }

    fn read(&mut self, path: &Path) -> Result<Vec<u8>, Error> {
        let fail = |kind, message: String| Error::new(path, Place::File, kind, message);
        let io = |error: std::io::Error| fail(Kind::Io, error.to_string());
        // A pipe or a device would never end.
        if !fs::metadata(path).map_err(io)?.is_file() {
            return Err(fail(Kind::Io, "not a file".to_owned()));
        }
        let mut bytes = Vec::new();
        File::open(path).map_err(io)?.take(self.left.saturating_add(1)).read_to_end(&mut bytes).map_err(io)?;
        match self.left.checked_sub(bytes.len() as u64) {
            Some(left) => self.left = left,
            None => {
                let message = format!("all files together are larger than the limit of {} bytes", self.limit);
                return Err(fail(Kind::Limit, message));
            }
        }
        self.read.push(path.to_path_buf());
        Ok(bytes)
    }
}
