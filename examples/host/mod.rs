//! What the examples on a desktop share: a picture made of strips, as a PNG file and as a window wants it.
#![allow(dead_code)] // each program uses its part

pub mod show;
pub mod viewer;

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use zstrip::fragment::PixelFormat;
use zstrip::output::StripPixels;

/// A whole frame, as a display would keep it.
pub struct Picture {
    width: u16,
    height: u16,
    pixels: Vec<u16>,
}

/// RGB565 to eight bits a channel, so that the brightest becomes 255.
fn rgb888(pixel: u16) -> [u8; 3] {
    let (r, g, b) = (pixel >> 11, pixel >> 5 & 63, pixel & 31);
    [(r << 3 | r >> 2) as u8, (g << 2 | g >> 4) as u8, (b << 3 | b >> 2) as u8]
}

impl Picture {
    pub fn new((width, height): (u16, u16)) -> Self {
        let pixels = vec![0; usize::from(width) * usize::from(height)];
        Self { width, height, pixels }
    }

    /// Takes a strip of a frame, of RGB565 or a dithered format of it.
    pub fn put<P: PixelFormat<Raw = u16>>(&mut self, strip: &StripPixels<'_, P>) {
        let start = strip.area().top_left.y as usize * usize::from(self.width);
        self.pixels[start..start + strip.pixels().len()].copy_from_slice(strip.pixels());
    }

    /// Pixels as `minifb` takes them: 0RGB.
    pub fn to_0rgb(&self) -> Vec<u32> {
        let to_0rgb = |pixel: &u16| {
            let [r, g, b] = rgb888(*pixel);
            u32::from_be_bytes([0, r, g, b])
        };
        self.pixels.iter().map(to_0rgb).collect()
    }

    pub fn write_png(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let bytes: Vec<u8> = self.pixels.iter().copied().flat_map(rgb888).collect();
        write_png(path, (self.width, self.height), &bytes)
    }
}

/// Writes red, green and blue of each pixel.
pub fn write_png(path: &Path, (width, height): (u16, u16), bytes: &[u8]) -> Result<(), Box<dyn Error>> {
    let named = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let file = File::create(path).map_err(|error| named(&error))?;
    let mut encoder = png::Encoder::new(BufWriter::new(file), width.into(), height.into());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().map_err(|error| named(&error))?;
    writer.write_image_data(bytes).map_err(|error| named(&error))?;
    writer.finish().map_err(|error| named(&error))?;
    Ok(())
}
