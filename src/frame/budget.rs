//! The RAM that a frame needs, as constants.

use crate::color::PixelFormat;
use crate::target::records_len;

/// Bytes of the buffers that a frame is drawn with. It is `const`, so that a program can assert that they fit.
///
/// ```
/// use embedded_graphics_core::pixelcolor::Rgb565;
/// use zstrip::frame::RamBudget;
/// const RAM: RamBudget = RamBudget::new::<Rgb565>(320, 16).with_records(1, 240, 512, 1, 480);
/// const _: () = assert!(RAM.total() <= 40 * 1024);
/// assert_eq!(RAM.color + RAM.depth, 20_480);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RamBudget {
    /// Colours of a strip.
    pub color: usize,
    /// Depths of a strip.
    pub depth: usize,
    /// Records.
    pub records: usize,
    rows: u32,
}

impl RamBudget {
    /// Counts a strip of `rows` rows of a screen `width` px wide, without records.
    #[must_use]
    pub const fn new<P: PixelFormat>(width: u32, rows: u32) -> Self {
        let pixels = width as usize * rows as usize;
        Self { color: pixels * size_of::<P::Raw>(), depth: pixels * 2, records: 0, rows }
    }

    /// Leaves out the depth buffer, for scenes drawn from back to front and for 2-D drawing.
    #[must_use]
    pub const fn without_depth(self) -> Self {
        Self { depth: 0, ..self }
    }

    /// Adds room for the records of a scene; see [`records_len`](crate::target::records_len).
    #[must_use]
    pub const fn with_records(
        self,
        draws: usize,
        height: u32,
        vertices: usize,
        varying_words: usize,
        triangles: usize,
    ) -> Self {
        let strips = (height as usize).div_ceil(if self.rows == 0 { 1 } else { self.rows as usize });
        Self { records: 4 * records_len(strips, draws, vertices, varying_words, triangles), ..self }
    }

    /// Adds a number of words of records.
    #[must_use]
    pub const fn with_record_words(self, words: usize) -> Self {
        Self { records: 4 * words, ..self }
    }

    /// Returns the greatest number of rows, up to `most`, that divides a screen's height: with strips of that height
    /// the last strip of a frame is no shorter than the others. DMA that always sends whole buffers needs that.
    ///
    /// ```
    /// use zstrip::frame::RamBudget;
    /// const ROWS: u32 = RamBudget::even_rows(240, 17);
    /// assert_eq!(ROWS, 16);
    /// ```
    #[must_use]
    pub const fn even_rows(height: u32, most: u32) -> u32 {
        let mut rows = if most < height { most } else { height };
        while rows > 1 && !height.is_multiple_of(rows) {
            rows -= 1;
        }
        rows
    }

    /// Returns the bytes of all buffers together.
    #[must_use]
    pub const fn total(&self) -> usize {
        self.color + self.depth + self.records
    }
}
