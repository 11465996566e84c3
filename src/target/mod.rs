//! Where pixels go: framebuffers, strips, sinks, packers, embedded-graphics targets, and the records of a band.

mod draw_target;
mod framebuffer;
mod packer;
mod records;
mod sink;
mod stats;
mod strip_rows;

pub use draw_target::Overlay;
pub use framebuffer::{FrameSlice, Framebuffer, FramebufferError, Strip, WithoutDepth};
pub use packer::{DitheredDisplay, PackedFormat, Packer, PackerError, Pages, Rows, RowsLowFirst};
pub use records::records_len;
pub(crate) use records::{Layout, PackedVertex, Records, TriangleRecord, Triangles, VERTEX_WORDS};
pub use sink::{OnDisplay, StripPixels, StripSink};
pub use stats::Stats;
pub(crate) use strip_rows::{StripRows, whole_rows};
