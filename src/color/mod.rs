//! Pixels: formats of colours, packed channels, ordered dither, fills. A program meets a [`PixelFormat`] first, as the
//! type parameter of its renderer.

mod channels;
mod dither;
mod dithered;
mod fill;
mod format;
mod formats;
mod luma;
mod mean;
mod packed;
mod resolve;
mod rgb565;
mod rgba;

pub(crate) use channels::{channels, packed, round, unpacked};
pub use dither::{Dither, Levels, Tones};
pub use dithered::{DitherWords, Ditherable, Dithered};
pub(crate) use fill::{clear, clear_words, fill};
pub use format::PixelFormat;
pub use formats::{Bgr565Be, Rgb332, Rgb565Be};
pub(crate) use mean::PixelSum;
pub use mean::{Mean, MeanOfCodes, MeanOfLight};
pub(crate) use packed::{load, pack, spread, spread_step, squeeze, store, unsqueeze, word};
pub(crate) use resolve::resolve;
pub(crate) use rgb565::{fold_rgb565, mix_spread_rgb565, pack_rgb565, spread_rgb565, unpack_rgb565};
pub use rgba::Rgba8888;
