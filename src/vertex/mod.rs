//! The vertex stage: what a vertex shader reads and returns, and where vertices lie on the screen.
//!
//! Meshes, matrices and a [`Viewport`] come in. Screen positions, clipped polygons and varyings go out. From here on,
//! every vertex lies within ±32,767 px of the screen's corner.
//!
//! A program needs [`Viewport`] to draw in a part of the screen, [`VertexShader`] for a shader of its own, and
//! [`painters_order`] for a scene without a depth buffer.

pub(crate) mod clip;
mod clip_distance;
mod clip_line;
mod extent;
mod packed;
mod packed_corners;
mod painters_order;
pub(crate) mod project;
mod shader;
pub(crate) mod transform;
mod varyings;
mod viewport;
mod wrapper;

pub use clip::DepthRange;
pub(crate) use clip::{CLIPPED_CORNERS, ClipCorner, ClipVertex, Clipping, DepthSlab, Outcode, clip_triangle, weighted};
pub(crate) use clip_distance::DISTANCE_CORNERS;
pub use clip_distance::MAX_DISTANCES;
pub(crate) use clip_line::clip_line;
pub(crate) use extent::{Extent, STEPS};
pub(crate) use packed::{PackedVertex, VERTEX_WORDS, pack};
pub use packed_corners::PackedCorners;
pub use painters_order::{SortError, SortReport, SortScratch, painters_order};
pub use project::{DepthScale, ScreenVertex};
pub(crate) use project::{Projected, inverse_w, project, signed_area, small};
pub use shader::{Face, Side, VertexRef, VertexShader};
pub(crate) use transform::{Planes, ScreenMatrix, Transform};
pub(crate) use varyings::{MAX_IN_REGISTERS, PerspectiveClass, PerspectivePlane, PerspectiveSetup, Plane64};
pub use varyings::{Perspective, Varyings};
pub use viewport::{Viewport, ViewportError};
pub use wrapper::Wrapper;
