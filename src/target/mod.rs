//! Where pixels go: framebuffers, strips, sinks, packers, embedded-graphics targets. A program meets [`StripPixels`]
//! first, a finished strip; [`StripSink`] takes them, [`Packer`] packs them for panels of less than a byte per pixel.

mod carried;
mod choice;
mod coarse;
mod draw_target;
mod framebuffer;
mod layout;
mod packer;
mod records;
mod sink;
mod state_pool;
mod stats;
mod strip_rows;
mod triangles;

pub use choice::{
    DepthChoice, Further, NoSamples, RecordsChoice, Samples, WithCarriedState, WithDepth, WithOcclusion, WithRecords,
    WithSamples, WithoutDepth, WithoutRecords,
};
pub(crate) use coarse::Coarse;
pub use coarse::occlusion_len;
pub use draw_target::Overlay;
pub(crate) use draw_target::OverlayTarget;
pub use framebuffer::{Depthless, FrameSlice, Framebuffer, FramebufferError, Strip};
pub(crate) use layout::Layout;
pub use packer::{DitheredDisplay, PackedFormat, Packer, PackerError, Pages, Rows, RowsLowFirst};
pub(crate) use records::Records;
pub use records::records_len;
pub use sink::{OnDisplay, StripPixels, StripSink};
pub use stats::Stats;
pub(crate) use strip_rows::{StripRows, whole_rows};
pub(crate) use triangles::{
    DrawTriangles, Room, TriangleRecord, Triangles, Unshaded, corners_of, third, triangle_words, turns,
};
