//! Decodes PNG, JPEG and BMP.

use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Cursor;

use image::{ImageFormat, ImageReader};

use crate::model::Image;
use crate::options::Limits;

/// Images that were decoded so far.
#[derive(Default)]
pub(crate) struct Images {
    pub list: Vec<Image>,
    /// Numbers of images by file.
    by_file: HashMap<String, Result<usize, String>>,
    texels: u64,
}

impl Images {
    /// Returns the number of a file's image, or why there is none. A file, which `key` stands for, is read and decoded
    /// once.
    pub fn of_file<'b>(
        &mut self,
        key: &str,
        name: &str,
        limits: &Limits,
        read: impl FnOnce() -> Result<Cow<'b, [u8]>, String>,
    ) -> Result<usize, String> {
        if let Some(known) = self.by_file.get(key) {
            return known.clone();
        }
        let found = read().and_then(|bytes| self.decode(name, &bytes, limits));
        self.by_file.insert(key.to_owned(), found.clone());
        found
    }

    /// Decodes an image and returns its number, or why it cannot be decoded.
    fn decode(&mut self, name: &str, bytes: &[u8], limits: &Limits) -> Result<usize, String> {
        let fail = |error: &dyn std::fmt::Display| format!("image {name:?}: {error}");
        let open = || -> Result<_, String> {
            let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| fail(&e))?;
            match reader.format() {
                Some(ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::Bmp) => {}
                Some(other) => return Err(fail(&format!("{other:?} is not read; save it as PNG"))),
                None => return Err(fail(&"neither PNG, JPEG nor BMP; save it as PNG")),
            }
            let mut within = image::Limits::default();
            within.max_image_width = Some(limits.image_side);
            within.max_image_height = Some(limits.image_side);
            // Up to 8 bytes per texel are decoded, and 4 are kept.
            within.max_alloc = Some((limits.texels - self.texels).saturating_mul(16).saturating_add(1 << 20));
            reader.limits(within);
            Ok(reader)
        };
        let (width, height) = open()?.into_dimensions().map_err(|e| fail(&e))?;
        let (most, left) = (limits.image_side, limits.texels - self.texels);
        if width == 0 || height == 0 {
            return Err(fail(&"it has no texels"));
        }
        if width > most || height > most {
            return Err(fail(&format!("{width}×{height} texels, where {most} per side are the limit")));
        }
        let texels = u64::from(width) * u64::from(height);
        if texels > left {
            return Err(fail(&format!("{texels} texels, where {left} of the limit of {} are left", limits.texels)));
        }
        let decoded = open()?.decode().map_err(|e| fail(&e))?.into_rgba8();
        self.texels += texels;
        self.list.push(Image { name: name.to_owned(), width, height, texels: decoded.into_raw() });
        Ok(self.list.len() - 1)
    }
}
