//! What reads bytes: images in every texel format, masks of alpha, palettes; and what writes them: packed formats and
//! strips as bytes. Texels and bits are those of a plain model.

use crate::Hash;
use crate::source::Source;
use core::convert::Infallible;
use zstrip::color::{Dither, Levels, PixelFormat, Rgb565Be};
use zstrip::embedded_graphics_core::draw_target::DrawTarget;
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{BinaryColor, Gray2, Gray4, Gray8, Rgb565, Rgb888};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::frame::Renderer;
use zstrip::target::{PackedFormat, Packer, Pages, Rows, RowsLowFirst, StripPixels};
use zstrip::texture::{
    Bilinear, Clamp, Filter, Gray8Texel, Image, Keyed, MaskTexel, Mirror, Nearest, PaletteTexel, Repeat, Rgb565LeTexel,
    Rgb565Texel, Rgb888Texel, TexelFormat, Texture, WithAlpha, Wrap,
};

pub fn run(input: &[u8]) -> u64 {
    let mut source = Source::new(input);
    let mut hash = Hash::default();
    match source.below(4) {
        0 => pack(&mut source, &mut hash),
        _ => image(&mut source, &mut hash),
    }
    hash.0
}

fn image(source: &mut Source<'_>, hash: &mut Hash) {
    let kind = source.u8();
    let palette: [[u8; 3]; 3] = core::array::from_fn(|_| [source.u8(), source.u8(), source.u8()]);
    let palette = &palette[..source.below(4)];
    match kind % 10 {
        0 => read(source, Rgb565Texel, hash),
        1 => read(source, Rgb565LeTexel, hash),
        2 => read(source, Rgb888Texel, hash),
        3 => read(source, Gray8Texel, hash),
        4 => read(source, PaletteTexel::<1>(palette), hash),
        5 => read(source, PaletteTexel::<2>(palette), hash),
        6 => read(source, PaletteTexel::<4>(palette), hash),
        7 => read(source, PaletteTexel::<8>(palette), hash),
        8 => read(source, MaskTexel([1, 2, 3]), hash),
        _ => {
            let key = u32::from(source.u8() & 15);
            read(source, Keyed { format: PaletteTexel::<4>(palette), key }, hash);
        }
    }
}

/// A texel by the definition: rows of whole bytes, first texel in the highest bits, bytes with the highest first.
fn texel<F: TexelFormat>(data: &[u8], width: u32, x: u32, y: u32) -> u32 {
    let bits = F::BITS;
    let row = (width as usize * bits).div_ceil(8) * y as usize;
    let mut texel = 0;
    for bit in x as usize * bits..(x as usize + 1) * bits {
        texel = texel << 1 | u32::from(data[row + bit / 8] >> (7 - bit % 8) & 1);
    }
    texel
}

fn read<F: TexelFormat>(source: &mut Source<'_>, format: F, hash: &mut Hash) {
    let size = if source.below(8) == 0 {
        Size::new(source.size(), source.size())
    } else {
        Size::new(source.below(20) as u32, source.below(20) as u32)
    };
    let (uv, alpha) = ([source.int(), source.int()], source.slice(8));
    let data = source.rest();
    // Exactly, too long, or as it comes.
    let row = (u128::from(size.width) * F::BITS as u128).div_ceil(8);
    let needed = row * u128::from(size.height);
    let data = match usize::try_from(needed) {
        Ok(needed) if alpha.first().is_none_or(|b| b & 1 == 0) => data.get(..needed).unwrap_or(data),
        _ => data,
    };
    let Ok(image) = Image::new(data, size, format) else {
        hash.add(1);
        return;
    };
    assert!(size.width > 0 && size.height > 0, "an image of {size:?} is accepted");
    assert_eq!(data.len() as u128, needed, "an image of {size:?}, {} bits", F::BITS);
    assert_eq!(image.size(), size);
    for (x, y) in [(0, 0), (size.width - 1, size.height - 1), (size.width / 2, size.height / 3)] {
        let expected = format.rgba(texel::<F>(data, size.width, x, y));
        assert_eq!(image.rgba(x, y), expected, "texel ({x}, {y}) of {size:?}");
        assert_eq!(
            image.pixel::<Rgb888>(x, y).is_some(),
            format.pixel::<Rgb888>(texel::<F>(data, size.width, x, y)).is_some()
        );
        hash.bytes(&expected);
    }
    if size.width <= 4096 && size.height <= 4096 {
        sample::<_, Repeat>(&image, uv, hash);
        sample::<_, Mirror>(&image, uv, hash);
        sample::<_, Clamp>(&image, uv, hash);
    }
    if let Ok(leaf) = WithAlpha::new(image, alpha) {
        sample::<_, Clamp>(&leaf, uv, hash);
    }
}

fn sample<T: Texture, W: Wrap>(texture: &T, uv: [i32; 2], hash: &mut Hash) {
    hash.bytes(&Nearest::rgba::<T, W>(texture, uv));
    hash.bytes(&Bilinear::rgba::<T, W>(texture, uv));
    hash.add(Nearest::pixel::<Rgb565, T, W>(texture, uv).map_or(u64::MAX, u64::from));
    hash.add(Bilinear::pixel::<Rgb565Be, T, W>(texture, uv).map_or(u64::MAX, u64::from));
    hash.add(Nearest::pixel::<Gray8, T, W>(texture, uv).map_or(u64::MAX, u64::from));
}

fn pack(source: &mut Source<'_>, hash: &mut Hash) {
    let kind = source.u8();
    match kind % 6 {
        0 => packed::<Pages>(source, Dither::BAYER_8, Place::Pages, hash),
        1 => packed::<Rows<BinaryColor>>(source, Dither::BRIGHT_4, Place::HighFirst, hash),
        2 => packed::<RowsLowFirst<BinaryColor>>(source, Dither::NEAREST, Place::LowFirst, hash),
        3 => packed::<Rows<Gray2>>(source, Dither::BAYER_4, Place::HighFirst, hash),
        4 => packed::<Rows<Gray4>>(source, Dither::BAYER_8, Place::HighFirst, hash),
        _ => packed::<RowsLowFirst<Gray4>>(source, Dither::NEAREST, Place::LowFirst, hash),
    }
}

/// Where the pixels of a byte are.
#[derive(Clone, Copy)]
enum Place {
    /// Eight rows of one column, the topmost in the lowest bit.
    Pages,
    /// One row, the leftmost pixel in the highest bits, or in the lowest.
    HighFirst,
    LowFirst,
}

/// A byte by the definition of its format. Pixels outside of the strip are 0.
fn packed_byte<C: Levels>(
    place: Place,
    number: usize,
    width: usize,
    area: Rectangle,
    dither: &Dither<C>,
    grey: &impl Fn(i32, i32) -> u8,
) -> u8 {
    let bits = C::BITS as usize;
    let row_bytes = (width * bits).div_ceil(8);
    let pixels = 8 / bits;
    (0..pixels).fold(0, |byte, k| {
        let (x, y, shift) = match place {
            Place::Pages => (number % width, number / width * 8 + k, k),
            Place::HighFirst => (number % row_bytes * pixels + k, number / row_bytes, 8 - bits * (k + 1)),
            Place::LowFirst => (number % row_bytes * pixels + k, number / row_bytes, bits * k),
        };
        if x >= width || y >= area.size.height as usize {
            return byte;
        }
        let at = (x as i32, y as i32 + area.top_left.y);
        byte | dither.level(grey(at.0, at.1), at) << shift
    })
}

/// Packs strips of any greys, in any width: each pixel is the dithered level of its grey, at its place.
fn packed<F: PackedFormat>(source: &mut Source<'_>, dither: Dither<F::Color>, place: Place, hash: &mut Hash) {
    let (width, height) = (1 + source.below(40) as u16, 1 + source.below(24) as u16);
    let rows = 1 + source.below(24) as u16;
    let rows = rows.min(height);
    let length = source.below(256);
    let mut bytes = vec![0xA5; length];
    let screen = Size::new(width.into(), height.into());
    let greys = source.rest();
    let grey = |x: i32, y: i32| match greys.len() {
        0 => 0,
        length => greys[(y as usize * usize::from(width) + x as usize) % length],
    };
    let mut renderer = Renderer::<Gray8>::new(screen).expect("a renderer");
    let mut buffer = vec![0; usize::from(width) * usize::from(rows)];
    let Ok(mut packer) = Packer::<F>::new(screen, rows.into(), dither, &mut bytes) else {
        assert!(length < F::bytes(width, rows) || rows % F::ROWS != 0, "{width}x{rows} fits {length} bytes");
        hash.add(2);
        return;
    };
    let sink = |strip: &StripPixels<'_, Gray8>| {
        let (area, bytes) = (strip.area(), packer.pack(strip));
        assert_eq!(bytes.len(), F::bytes(width, area.size.height as u16));
        for (k, byte) in bytes.iter().enumerate() {
            let expected = packed_byte(place, k, usize::from(width), area, &dither, &grey);
            assert_eq!(*byte, expected, "byte {k} of {area:?} in {screen:?}");
        }
        hash.bytes(bytes);
        Ok::<(), Infallible>(())
    };
    renderer
        .frame_to(sink, &mut buffer, Rgb888::new(9, 9, 9), |scene| {
            let all = Rectangle::new(Point::zero(), screen);
            let colors = (0..i32::from(height)).flat_map(|y| (0..i32::from(width)).map(move |x| (x, y)));
            let colors = colors.map(|(x, y)| Gray8::to_color(grey(x, y)));
            let mut overlay = scene.overlay();
            let Ok(()) = overlay.fill_contiguous(&all, colors);
        })
        .expect("the same scene");
}
