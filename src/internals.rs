//! Parts of the crate that its own tests, examples and measurements use. They are not part of its interface, and
//! change without notice.

pub use crate::raster::{Block, Line, PixelRect, blocks, bounding_box, covered_samples, moves, spans, square};
pub use crate::vertex::clip::{ClipVertex, DepthSlab, Outcode, clip_triangle, weighted};
pub use crate::vertex::project::{Projected, project, projected, signed_area};
pub use crate::vertex::transform::{Planes, ScreenMatrix, Transform};
