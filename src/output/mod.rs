//! Pixels → display: pixel formats, strips and other framebuffers, records, and the loop that makes a frame of strips.

mod budget;
mod frame;
mod framebuffer;
mod pixel;
mod record;
mod sink;
mod stats;

pub use budget::RamBudget;
pub(crate) use frame::StripRows;
pub use frame::{Buffers, Frame, FrameError, FramebufferRenderer, Renderer, RendererError};
pub use framebuffer::{FrameSlice, Framebuffer, FramebufferError, Strip};
pub use pixel::Rgb565Be;
pub use record::records_len;
pub(crate) use record::{Records, Slot, VERTEX as VERTEX_WORDS};
pub use sink::{OnDisplay, StripPixels, StripSink};
pub use stats::Stats;
