//! Pixels → display: pixel formats, strips and other framebuffers, records, and the loop that makes a frame of strips.

mod budget;
mod dither;
mod dithered;
mod draw_target;
mod frame;
mod frame_view;
mod framebuffer;
mod packed;
mod pixel;
mod record;
mod sink;
mod stats;

pub use budget::RamBudget;
pub use dither::{Dither, Levels, Tones};
pub use dithered::{DitherWords, Ditherable, Dithered};
pub use draw_target::Overlay;
pub(crate) use frame::StripRows;
pub use frame::{Buffers, Frame, FrameError, FramebufferRenderer, Renderer, RendererError};
pub use frame_view::FrameView;
pub use framebuffer::{FrameSlice, Framebuffer, FramebufferError, Strip, WithoutDepth};
pub use packed::{DitheredDisplay, PackedFormat, Packer, PackerError, Pages, Rows, RowsLowFirst};
pub use pixel::{Bgr565Be, Rgb332, Rgb565Be};
#[cfg(test)]
pub(crate) use record::Layout;
pub use record::records_len;
pub(crate) use record::{Records, Slot, TriangleRecord, Triangles, VERTEX as VERTEX_WORDS};
pub use sink::{OnDisplay, StripPixels, StripSink};
pub use stats::Stats;
