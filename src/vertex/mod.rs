//! The vertex stage: what a vertex shader sees and returns; transform, clip, project.

mod clip;
mod clip_distance;
mod clip_line;
mod frustum;
mod painters_order;
mod project;
mod shader;
mod transform;
mod varyings;
mod viewport;

pub use clip::{
    CLIPPED_CORNERS, ClipCorner, ClipVertex, DepthRange, DepthSlab, Outcode, Polygon, PolygonCorner, clip_triangle,
    weighted,
};
pub use clip_distance::{DISTANCE_CORNERS, MAX_DISTANCES};
pub use clip_line::clip_line;
pub use frustum::{Containment, Frustum, Plane};
pub use painters_order::{Order, SortError, Sortable, far_to_near, painters_order};
pub(crate) use project::small;
pub use project::{DepthScale, ScreenVertex, inverse_w, project, signed_area};
pub use shader::{Face, Side, VertexRef, VertexShader};
pub use transform::{Projected, ScreenMatrix, Transform, projected};
pub(crate) use varyings::MAX_IN_REGISTERS;
pub use varyings::{Correction, Lane, Lanes, Perspective, PerspectiveClass, Varyings, WidePlane};
pub use viewport::{Viewport, ViewportError};
