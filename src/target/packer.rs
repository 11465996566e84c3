//! Packing of strips: pixels of full precision come in, and go out as dithered bytes for panels with less than a byte
//! per pixel, or as dithered colours for displays.
//!
//! A strip is drawn in a format of full precision, such as [`Gray8`]. Two pixels that share a byte cannot be drawn
//! one by one without reading that byte back, and blending wants more than two greys.

use super::sink::{StripPixels, StripSink};
use crate::color::{Dither, Levels, PixelFormat};
use core::fmt;
use core::marker::PhantomData;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::Size;
use embedded_graphics_core::pixelcolor::BinaryColor;

/// A way for pixels to share bytes.
pub trait PackedFormat {
    /// The colours that a pixel can have.
    type Color: Levels;

    /// Rows that share a byte: strips begin at multiples of this number.
    const ROWS: u16;

    /// Counts the bytes of `rows` rows of `width` pixels.
    fn bytes(width: u16, rows: u16) -> usize;

    /// Packs whole rows of `width` pixels, the first one row `y` of the screen.
    fn pack<P: PixelFormat>(dither: &Dither<Self::Color>, pixels: &[P::Raw], width: usize, y: i32, bytes: &mut [u8]);
}

/// Bytes of eight rows and one pixel, the lowest bit on top. They go from left to right, and in pages of eight rows
/// from top to bottom, as monochrome OLED and LCD controllers want them (SSD1306, SH1106, ST7565, PCD8544).
#[derive(Clone, Copy, Debug)]
pub struct Pages;

/// Rows of bytes, the leftmost pixel in their highest bits: e-paper and ST7920 with `BinaryColor`, SSD0323 with
/// `Gray4`. Each row begins a new byte.
#[derive(Clone, Copy, Debug)]
pub struct Rows<C>(PhantomData<C>);

/// Rows of bytes, the leftmost pixel in their lowest bits: Sharp's memory displays, whose bus takes the lowest bit
/// first, and controllers told so. Each row begins a new byte.
#[derive(Clone, Copy, Debug)]
pub struct RowsLowFirst<C>(PhantomData<C>);

impl PackedFormat for Pages {
    type Color = BinaryColor;

    const ROWS: u16 = 8;

    fn bytes(width: u16, rows: u16) -> usize {
        usize::from(width).saturating_mul(usize::from(rows.div_ceil(8)))
    }

    fn pack<P: PixelFormat>(dither: &Dither<BinaryColor>, pixels: &[P::Raw], width: usize, y: i32, bytes: &mut [u8]) {
        if width == 0 {
            return;
        }
        let mut first = y;
        for (page, bytes) in pixels.chunks(width.saturating_mul(8)).zip(bytes.chunks_exact_mut(width)) {
            bytes.fill(0);
            let mut y = first.wrapping_add((page.len() / width) as i32);
            first = y;
            // Rows go in from the bottom up: each row moves the bits of the rows below it up by one.
            for row in page.chunks_exact(width).rev() {
                y = y.wrapping_sub(1);
                push_row::<P>(&dither.row(y), row, bytes);
            }
        }
    }
}

/// Puts a row of pixels into a page: one bit per byte, from below.
#[inline(never)]
fn push_row<P: PixelFormat>(entries: &[u32; 8], row: &[P::Raw], bytes: &mut [u8]) {
    let push = |byte: &mut u8, raw: &P::Raw, entry: u32| {
        *byte = *byte << 1 | BinaryColor::level((), entry, P::luma(*raw));
    };
    let (mut pixels, mut bytes) = (row.chunks_exact(8), bytes.chunks_exact_mut(8));
    for (pixels, bytes) in (&mut pixels).zip(&mut bytes) {
        // The eight steps are spelled out, since at `opt-level = "s"` a loop would stay a loop.
        let ([p0, p1, p2, p3, p4, p5, p6, p7], [b0, b1, b2, b3, b4, b5, b6, b7]) = (pixels, bytes) else { return };
        push(b0, p0, entries[0]);
        push(b1, p1, entries[1]);
        push(b2, p2, entries[2]);
        push(b3, p3, entries[3]);
        push(b4, p4, entries[4]);
        push(b5, p5, entries[5]);
        push(b6, p6, entries[6]);
        push(b7, p7, entries[7]);
    }
    for ((pixel, byte), entry) in pixels.remainder().iter().zip(bytes.into_remainder()).zip(entries) {
        push(byte, pixel, *entry);
    }
}

impl<C: Levels> PackedFormat for Rows<C> {
    type Color = C;

    const ROWS: u16 = 1;

    fn bytes(width: u16, rows: u16) -> usize {
        row_bytes::<C>(usize::from(width)).saturating_mul(usize::from(rows))
    }

    fn pack<P: PixelFormat>(dither: &Dither<C>, pixels: &[P::Raw], width: usize, y: i32, bytes: &mut [u8]) {
        pack_rows::<P, C, true>(dither, pixels, width, y, bytes);
    }
}

impl<C: Levels> PackedFormat for RowsLowFirst<C> {
    type Color = C;

    const ROWS: u16 = 1;

    fn bytes(width: u16, rows: u16) -> usize {
        row_bytes::<C>(usize::from(width)).saturating_mul(usize::from(rows))
    }

    fn pack<P: PixelFormat>(dither: &Dither<C>, pixels: &[P::Raw], width: usize, y: i32, bytes: &mut [u8]) {
        pack_rows::<P, C, false>(dither, pixels, width, y, bytes);
    }
}

/// Counts the bytes of a row of `width` pixels.
const fn row_bytes<C: Levels>(width: usize) -> usize {
    const { assert!(matches!(C::BITS, 1 | 2 | 4), "levels have 1, 2 or 4 bits") };
    // Without a product that may not fit.
    let per_byte = 8 / C::BITS as usize;
    width.div_ceil(per_byte)
}

fn pack_rows<P: PixelFormat, C: Levels, const HIGH_FIRST: bool>(
    dither: &Dither<C>,
    pixels: &[P::Raw],
    width: usize,
    y: i32,
    bytes: &mut [u8],
) {
    let row_bytes = row_bytes::<C>(width);
    if width == 0 || row_bytes == 0 {
        return;
    }
    let rows = pixels.chunks_exact(width).zip(bytes.chunks_exact_mut(row_bytes));
    let mut y = y;
    for (row, bytes) in rows {
        pack_row::<P, C, HIGH_FIRST>(&dither.row(y), dither.tones, row, bytes);
        y = y.wrapping_add(1);
    }
}

/// Packs each eight pixels into a word, and the word into one, two or four bytes.
#[inline(never)]
fn pack_row<P: PixelFormat, C: Levels, const HIGH_FIRST: bool>(
    entries: &[u32; 8],
    tones: C::Tones,
    row: &[P::Raw],
    bytes: &mut [u8],
) {
    let push = |word: u32, raw: P::Raw, entry: u32| {
        let level = u32::from(C::level(tones, entry, P::luma(raw)));
        if HIGH_FIRST { word << C::BITS | level } else { word >> C::BITS | level << (32 - C::BITS) }
    };
    let Some((bytes, last)) = bytes.split_at_mut_checked(row.len() / 8 * C::BITS as usize) else { return };
    let mut pixels = row.chunks_exact(8);
    for (pixels, bytes) in (&mut pixels).zip(bytes.chunks_exact_mut(C::BITS as usize)) {
        let [p0, p1, p2, p3, p4, p5, p6, p7] = pixels else { return };
        let word = push(0, *p0, entries[0]);
        let word = push(word, *p1, entries[1]);
        let word = push(word, *p2, entries[2]);
        let word = push(word, *p3, entries[3]);
        let word = push(word, *p4, entries[4]);
        let word = push(word, *p5, entries[5]);
        let word = push(word, *p6, entries[6]);
        let word = push(word, *p7, entries[7]);
        // Now the pixels are in the word's last bytes if it was filled from below. If it was filled from above, they
        // are in all of its bytes, or in its last ones.
        match (bytes, if HIGH_FIRST { word.to_be_bytes() } else { word.to_le_bytes() }) {
            ([a], [.., w]) => *a = w,
            ([a, b], [.., v, w]) => (*a, *b) = (v, w),
            ([a, b, c, d], [t, u, v, w]) => (*a, *b, *c, *d) = (t, u, v, w),
            _ => {}
        }
    }
    // The pixels left over at the end of the row are filled up with black.
    let mut word = 0;
    let rest = pixels.remainder();
    for (k, entry) in entries.iter().enumerate() {
        word = match rest.get(k) {
            Some(raw) => push(word, *raw, *entry),
            None if HIGH_FIRST => word << C::BITS,
            None => word >> C::BITS,
        };
    }
    let word = if HIGH_FIRST { word.to_be_bytes() } else { word.to_le_bytes() };
    for (byte, value) in last.iter_mut().zip(word.iter().skip(4 - C::BITS as usize)) {
        *byte = *value;
    }
}

/// The error of a packer that could not be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PackerError {
    /// The buffer does not hold a packed strip.
    TooShort {
        /// Bytes that the buffer holds.
        bytes: usize,
        /// Bytes of a packed strip.
        needed: usize,
    },
    /// Strips do not end where bytes do.
    PartialPages {
        /// Rows of a strip.
        rows: u32,
        /// Rows that share a byte: those of a strip must be a multiple.
        page: u16,
    },
}

impl fmt::Display for PackerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TooShort { bytes, needed } => write!(f, "buffer of {bytes} bytes, a packed strip has {needed}"),
            Self::PartialPages { rows, page } => write!(f, "strips of {rows} rows, but {page} rows share a byte"),
        }
    }
}

impl core::error::Error for PackerError {}

/// Packs strips into the bytes of a panel.
///
/// ```
/// use embedded_graphics_core::pixelcolor::{Gray8, GrayColor};
/// use zstrip::color::Dither;
/// use zstrip::embedded_graphics_core::geometry::Size;
/// use zstrip::frame::Renderer;
/// use zstrip::target::{Packer, Pages};
/// let (screen, mut color, mut depth) = (Size::new(128, 64), [0; 128 * 16], [0; 128 * 16]);
/// let mut renderer = Renderer::<Gray8>::new(screen)?.with_depth(&mut depth)?;
/// let mut bytes = [0; 128 * 16 / 8];
/// let mut packer = Packer::<Pages>::new(screen, 16, Dither::BAYER_8, &mut bytes)?;
/// # let mut sent = 0;
/// # let mut i2c_write = |bytes: &[u8]| sent += bytes.len();
/// let mut frame = renderer.begin(Gray8::BLACK);
/// while let Some(strip) = frame.next_strip(&mut color, |scene| { /* scene.draw(...) */ })? {
///     i2c_write(packer.pack(&strip));
/// }
/// # assert_eq!(sent, 128 * 64 / 8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Packer<'b, F: PackedFormat> {
    dither: Dither<F::Color>,
    bytes: &'b mut [u8],
}

impl<'b, F: PackedFormat> Packer<'b, F> {
    /// Makes a packer for strips of `strip_rows` rows of a screen.
    ///
    /// # Errors
    /// When a strip's bytes do not fit, or a strip does not end where bytes do and another follows.
    pub fn new(
        screen: Size,
        strip_rows: u32,
        dither: Dither<F::Color>,
        bytes: &'b mut [u8],
    ) -> Result<Self, PackerError> {
        let rows = strip_rows.min(screen.height);
        if rows < screen.height && !rows.is_multiple_of(F::ROWS.into()) {
            return Err(PackerError::PartialPages { rows: strip_rows, page: F::ROWS });
        }
        let side = |pixels: u32| u16::try_from(pixels).unwrap_or(u16::MAX);
        let needed = F::bytes(side(screen.width), side(rows));
        if bytes.len() < needed {
            return Err(PackerError::TooShort { bytes: bytes.len(), needed });
        }
        Ok(Self { dither, bytes })
    }

    /// Packs a strip. Returns its bytes, for the part of the panel that the strip covers.
    ///
    /// A strip larger than those the packer was made for is cut at the end of its buffer.
    pub fn pack<P: PixelFormat>(&mut self, strip: &StripPixels<'_, P>) -> &[u8] {
        let area = strip.area();
        let (width, rows) = (area.size.width as u16, area.size.height as u16);
        F::pack::<P>(&self.dither, strip.pixels(), usize::from(width), area.top_left.y, self.bytes);
        let length = F::bytes(width, rows).min(self.bytes.len());
        self.bytes.get(..length).unwrap_or_default()
    }
}

/// A display of few levels (`BinaryColor`, `Gray2`, `Gray4`) as a sink for strips of full precision: dithered, they
/// arrive through `fill_contiguous`.
#[derive(Debug)]
pub struct DitheredDisplay<'d, D: DrawTarget<Color: Levels>> {
    display: &'d mut D,
    dither: Dither<D::Color>,
}

impl<'d, D: DrawTarget<Color: Levels>> DitheredDisplay<'d, D> {
    /// Makes a sink that draws on `display`.
    pub const fn new(display: &'d mut D, dither: Dither<D::Color>) -> Self {
        Self { display, dither }
    }
}

impl<P: PixelFormat, D: DrawTarget<Color: Levels>> StripSink<P> for DitheredDisplay<'_, D> {
    type Error = D::Error;

    fn strip(&mut self, strip: &StripPixels<'_, P>) -> Result<(), D::Error> {
        let area = strip.area();
        let dither = self.dither;
        let rows = strip.pixels().chunks((area.size.width as usize).max(1)).zip(area.top_left.y..);
        let colors = rows.flat_map(|(row, y)| {
            let entries = dither.row(y);
            row.iter()
                .enumerate()
                .map(move |(x, raw)| D::Color::from_level(D::Color::level(dither.tones, entries[x & 7], P::luma(*raw))))
        });
        self.display.fill_contiguous(&area, colors)
    }
}
