//! Pictures: what a panel would show, and several of them on a sheet.

use super::{PreviewError, Stage};
use crate::save;
use std::io::Cursor;
use std::path::Path;
use zstrip::math::Angle16;

/// Red, green and blue of a panel's pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    width: u32,
    height: u32,
    pixels: Vec<[u8; 3]>,
}

/// Pictures on a contact sheet, and those of a row.
const SHOTS: u32 = 8;
const COLUMNS: u32 = 4;
/// Pixels between pictures.
const GAP: u32 = 4;
const GREY: [u8; 3] = [96; 3];

impl Picture {
    /// Makes a black picture.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![[0; 3]; width as usize * height as usize] }
    }

    /// Returns the width and the height.
    #[must_use]
    pub const fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Returns the pixels, row by row.
    #[must_use]
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// Takes the pixels of a strip.
    pub(super) fn put(&mut self, first_row: u32, pixels: &mut dyn Iterator<Item = [u8; 3]>) {
        let rows = self.pixels.iter_mut().skip(first_row as usize * self.width as usize);
        rows.zip(pixels).for_each(|(to, from)| *to = from);
    }

    /// Copies a picture to a place in this one. What sticks out is left out.
    fn paste(&mut self, from: &Self, column: u32, row: u32) {
        for (k, pixel) in from.pixels.iter().enumerate() {
            let (x, y) = (column + k as u32 % from.width, row + k as u32 / from.width);
            if x < self.width && y < self.height {
                self.pixels[y as usize * self.width as usize + x as usize] = *pixel;
            }
        }
    }

    /// Writes a PNG file. A file is there as a whole, or not at all.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_png(&self, path: &Path) -> Result<(), PreviewError> {
        let mut file = Cursor::new(Vec::new());
        let (bytes, color) = (self.pixels.as_flattened(), image::ColorType::Rgb8);
        image::write_buffer_with_format(&mut file, bytes, self.width, self.height, color, image::ImageFormat::Png)
            .map_err(|error| PreviewError::Image(path.to_owned(), error.to_string()))?;
        save(path, file.get_ref()).map_err(|error| PreviewError::Io(path.to_owned(), error))
    }
}

/// Draws the model from eight sides; a model with clips in eight poses of each of them.
///
/// # Errors
///
/// [`PreviewError::Sheet`] if it has more than 2²⁶ pixels, and those of [`Stage::picture`].
pub fn contact_sheet(stage: &Stage<'_>) -> Result<Picture, PreviewError> {
    let (width, height) = (stage.panel.width + GAP, stage.panel.height + GAP);
    let clips = stage.model.clips().count() as u32;
    let rows = SHOTS / COLUMNS * clips.clamp(1, MOST_CLIPS);
    let size = (COLUMNS * width + GAP, rows * height + GAP);
    if u64::from(size.0) * u64::from(size.1) > MOST_SHEET {
        return Err(PreviewError::Sheet(size.0, size.1));
    }
    let mut sheet = Picture::new(size.0, size.1);
    sheet.pixels.fill(GREY);
    for shot in 0..rows * COLUMNS {
        let (clip, at) = (shot / SHOTS, shot % SHOTS);
        let mut step = stage.step(0);
        match stage.model.clip(clip as usize) {
            Some(clip) => {
                // A model that moves is looked at from an angle.
                step.turn = Angle16::from_degrees(40);
                step.motion = Some(clip.once((u64::from(clip.duration()) * u64::from(at) / u64::from(SHOTS)) as u32));
            }
            None => step.turn = Angle16((65_536 / SHOTS * at) as u16),
        }
        let (picture, _) = stage.picture(&step)?;
        sheet.paste(&picture, GAP + shot % COLUMNS * width, GAP + shot / COLUMNS * height);
    }
    Ok(sheet)
}

/// Clips on a contact sheet, and its pixels, so that its size stays bounded.
const MOST_CLIPS: u32 = 8;
pub(super) const MOST_SHEET: u64 = 1 << 26;
