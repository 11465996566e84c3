//! One scene in all pixel formats and ditherings, side by side in a picture.
//!
//! ```text
//! cargo run --release --example formats -- --png formats.png
//! ```

mod host;
mod scenes;

use core::convert::Infallible;
use scenes::Draw;
use zstrip::color::{Dither, Dithered, PixelFormat, Rgb332};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{BinaryColor, Gray2, Gray4, Gray8, Rgb565, Rgb888};
use zstrip::frame::Renderer;
use zstrip::math::Angle16;
use zstrip::target::{Packer, Rows, StripPixels};

/// Size of one picture, and of all beside each other.
mod sheet {
    use super::*;
    use scenes::Room;
    use zstrip::color::Levels;

    pub const CELL: (usize, usize) = (160, 120);
    const COLUMNS: usize = 5;
    const GAP: usize = 4;

    /// The scene in a format, in red, green and blue.
    fn colors<P: PixelFormat>() -> Vec<[u8; 3]> {
        let pixels = CELL.0 * CELL.1;
        let (mut color, mut depth) = (vec![P::pack([0; 3]); pixels], vec![0; pixels]);
        let renderer = Renderer::<P>::new(Size::new(CELL.0 as u32, CELL.1 as u32))
            .expect("rows fit")
            .with_depth(&mut depth)
            .expect("rows fit");
        let mut records = [0; 16_384];
        let mut renderer = renderer.with_records(&mut records);
        let mut picture = Vec::new();
        let sink = |strip: &StripPixels<'_, P>| {
            picture.extend(strip.pixels().iter().map(|raw| P::unpack(*raw)));
            Ok::<(), Infallible>(())
        };
        let room = Room::new(Size::new(CELL.0 as u32, CELL.1 as u32), Angle16(0));
        renderer.frame_to(sink, &mut color, Rgb888::new(24, 28, 24), |scene| room.draw(scene)).expect("a frame");
        picture
    }

    /// The scene in few greys, as a panel shows its bytes.
    fn greys<C: Levels>(dither: Dither<C>) -> Vec<[u8; 3]> {
        let pixels = CELL.0 * CELL.1;
        let (mut color, mut depth) = (vec![0; pixels], vec![0; pixels]);
        let screen = Size::new(CELL.0 as u32, CELL.1 as u32);
        let renderer = Renderer::<Gray8>::new(screen).expect("a screen").with_depth(&mut depth).expect("rows fit");
        let mut records = [0; 16_384];
        let mut renderer = renderer.with_records(&mut records);
        let mut bytes = vec![0; pixels / 2];
        let mut packer = Packer::<Rows<C>>::new(screen, screen.height, dither, &mut bytes).expect("strips fit");
        let mut picture = Vec::new();
        let sink = |strip: &StripPixels<'_, Gray8>| {
            let (bits, white) = (C::BITS, (1_u32 << C::BITS) - 1);
            for byte in packer.pack(strip) {
                let levels = (0..8 / bits).map(|k| u32::from(*byte) >> (8 - bits * (k + 1)) & white);
                picture.extend(levels.map(|level| [(level * 255 / white) as u8; 3]));
            }
            Ok::<(), Infallible>(())
        };
        let room = Room::new(Size::new(CELL.0 as u32, CELL.1 as u32), Angle16(0));
        renderer.frame_to(sink, &mut color, Gray8::new(26), |scene| room.draw(scene)).expect("a frame");
        picture
    }

    /// All pictures, with their names.
    pub fn cells() -> Vec<(&'static str, Vec<[u8; 3]>)> {
        vec![
            ("Rgb888", colors::<Rgb888>()),
            ("Rgb565", colors::<Rgb565>()),
            ("Dithered<Rgb565>", colors::<Dithered<Rgb565>>()),
            ("Rgb332", colors::<Rgb332>()),
            ("Dithered<Rgb332>", colors::<Dithered<Rgb332>>()),
            ("Gray8", colors::<Gray8>()),
            ("Gray4, NEAREST", greys::<Gray4>(Dither::NEAREST)),
            ("Gray4, BAYER_8", greys::<Gray4>(Dither::BAYER_8)),
            ("Gray2, NEAREST", greys::<Gray2>(Dither::NEAREST)),
            ("Gray2, BAYER_8", greys::<Gray2>(Dither::BAYER_8)),
            ("BinaryColor, NEAREST", greys::<BinaryColor>(Dither::NEAREST)),
            ("BinaryColor, BAYER_8", greys::<BinaryColor>(Dither::BAYER_8)),
            ("BinaryColor, BRIGHT_8", greys::<BinaryColor>(Dither::BRIGHT_8)),
            ("Gray2, BAYER_4", greys::<Gray2>(Dither::BAYER_4)),
            ("Gray4, BAYER_4", greys::<Gray4>(Dither::BAYER_4)),
        ]
    }

    /// Rows of pictures, and their size in pixels.
    pub fn assembled(cells: &[Vec<[u8; 3]>]) -> ((u16, u16), Vec<u8>) {
        let (width, height) = (COLUMNS * (CELL.0 + GAP) + GAP, cells.len().div_ceil(COLUMNS) * (CELL.1 + GAP) + GAP);
        let mut bytes = vec![255; width * height * 3];
        for (k, cell) in cells.iter().enumerate() {
            let (left, top) = (GAP + k % COLUMNS * (CELL.0 + GAP), GAP + k / COLUMNS * (CELL.1 + GAP));
            for (y, row) in cell.chunks(CELL.0).enumerate() {
                let start = ((top + y) * width + left) * 3;
                bytes[start..start + CELL.0 * 3].copy_from_slice(row.as_flattened());
            }
        }
        ((width as u16, height as u16), bytes)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let path = match (args.next().as_deref(), args.next()) {
        (None, _) => "formats.png".to_owned(),
        (Some("--png"), Some(path)) => path,
        _ => return Err("usage: formats [--png FILE]".into()),
    };
    let (names, cells): (Vec<_>, Vec<_>) = sheet::cells().into_iter().unzip();
    let (size, bytes) = sheet::assembled(&cells);
    host::write_png(path.as_ref(), size, &bytes)?;
    println!("{}\nwrote {path}", names.join("\n"));
    Ok(())
}
