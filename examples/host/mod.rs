//! The code that the desktop examples share: a program that shows a demo, and a picture made of strips, for a PNG file
//! and for a window.
#![allow(dead_code)] // each program uses its part

mod options;
pub mod program;

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use zstrip::color::PixelFormat;
use zstrip::target::StripPixels;

/// A whole frame, as a display would keep it: red, green and blue in 8 bits.
pub struct Picture {
    width: u16,
    height: u16,
    pixels: Vec<[u8; 3]>,
}

impl Picture {
    pub fn new((width, height): (u16, u16)) -> Self {
        let pixels = vec![[0; 3]; usize::from(width) * usize::from(height)];
        Self { width, height, pixels }
    }

    /// Takes a strip of a frame.
    pub fn put<P: PixelFormat>(&mut self, strip: &StripPixels<'_, P>) {
        let start = strip.area().top_left.y as usize * usize::from(self.width);
        for (pixel, raw) in self.pixels[start..].iter_mut().zip(strip.pixels()) {
            *pixel = P::unpack(*raw);
        }
    }

    /// Pixels as `minifb` takes them: 0RGB.
    pub fn to_0rgb(&self) -> Vec<u32> {
        self.pixels.iter().map(|[r, g, b]| u32::from_be_bytes([0, *r, *g, *b])).collect()
    }

    pub fn write_png(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        write_png(path, (self.width, self.height), self.pixels.as_flattened())
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
