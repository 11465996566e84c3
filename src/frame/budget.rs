//! The RAM that a frame needs, as constants.

use crate::color::PixelFormat;
use crate::target::{occlusion_len, records_len};

/// Bytes of the buffers that a frame is drawn with. It is `const`, so that a program can assert that they fit. A number
/// that is too large for `usize` counts as the largest, so that such an assertion fails.
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
    width: u32,
    rows: u32,
}

impl RamBudget {
    /// Counts a strip of `rows` rows of a screen `width` px wide, without records.
    #[must_use]
    pub const fn new<P: PixelFormat>(width: u32, rows: u32) -> Self {
        let pixels = width as u64 * rows as u64;
        Self { color: bytes(pixels, size_of::<P::Raw>()), depth: bytes(pixels, 2), records: 0, width, rows }
    }

    /// Counts `samples` per pixel: 2, 4 or 8. The colours of all samples, and so those of the strip, are in `color`.
    ///
    /// ```
    /// use embedded_graphics_core::pixelcolor::Rgb565;
    /// use zstrip::frame::RamBudget;
    /// assert_eq!(RamBudget::new::<Rgb565>(320, 4).with_samples(4).total(), 20_480);
    /// ```
    #[must_use]
    pub const fn with_samples(self, samples: usize) -> Self {
        let Self { color, depth, .. } = self;
        Self { color: color.saturating_mul(samples), depth: depth.saturating_mul(samples), ..self }
    }

    /// Counts a screen that is `scale` times as wide and as high, for strips that become as high as these; see
    /// [`Supersampled`](super::Supersampled).
    ///
    /// ```
    /// use embedded_graphics_core::pixelcolor::Rgb565;
    /// use zstrip::frame::RamBudget;
    /// assert_eq!(RamBudget::new::<Rgb565>(320, 4).supersampled(2).total(), 20_480);
    /// ```
    #[must_use]
    pub const fn supersampled(self, scale: usize) -> Self {
        let (width, rows) = (self.width.saturating_mul(scale as u32), self.rows.saturating_mul(scale as u32));
        Self { width, rows, ..self.with_samples(scale * scale) }
    }

    /// Counts coarse depths beside the depths of a strip; see
    /// [`Renderer::with_occlusion`](super::Renderer::with_occlusion).
    ///
    /// ```
    /// use embedded_graphics_core::pixelcolor::Rgb565;
    /// use zstrip::frame::RamBudget;
    /// assert_eq!(RamBudget::new::<Rgb565>(320, 16).with_occlusion().total(), 20_480 + 80);
    /// ```
    #[must_use]
    pub const fn with_occlusion(self) -> Self {
        let coarse = occlusion_len(self.width as usize, self.rows as usize).saturating_mul(2);
        Self { depth: self.depth.saturating_add(coarse), ..self }
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
        let strips = bytes(height.div_ceil(if self.rows == 0 { 1 } else { self.rows }) as u64, 1);
        self.with_record_words(records_len(strips, draws, vertices, varying_words, triangles))
    }

    /// Adds a number of words of records.
    #[must_use]
    pub const fn with_record_words(self, words: usize) -> Self {
        Self { records: words.saturating_mul(4), ..self }
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
        if most >= height {
            return height;
        }
        // Divisors come in pairs, one of them at most the root of the height: 65,536 rounds for any height.
        let (mut best, mut divisor) = (if most == 0 { 0 } else { 1 }, 2);
        while divisor <= height / divisor {
            if height.is_multiple_of(divisor) {
                let pair = height / divisor;
                if divisor <= most && divisor > best {
                    best = divisor;
                }
                if pair <= most && pair > best {
                    best = pair;
                }
            }
            divisor += 1;
        }
        best
    }

    /// Returns the bytes of all buffers together.
    #[must_use]
    pub const fn total(&self) -> usize {
        self.color.saturating_add(self.depth).saturating_add(self.records)
    }
}

/// Returns the bytes of `count` things of `size` bytes; `usize::MAX` if that does not fit.
const fn bytes(count: u64, size: usize) -> usize {
    let bytes = count.saturating_mul(size as u64);
    if bytes > usize::MAX as u64 { usize::MAX } else { bytes as usize }
}
