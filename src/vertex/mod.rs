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
    CLIPPED_CORNERS, ClipCorner, ClipVertex, DepthRange, Outcode, Part, Polygon, PolygonCorner, clip_triangle, weighted,
};
pub use clip_distance::{DISTANCE_CORNERS, MAX_DISTANCES};
pub use clip_line::clip_line;
pub use frustum::{Containment, Frustum, Plane};
pub use painters_order::{Order, SortError, Sortable, far_to_near, painters_order};
pub(crate) use project::small;
pub use project::{DepthScale, ScreenVertex, inverse_w, project, signed_area};
pub use shader::{Corner, Face, Side, VertexShader};
pub use transform::{Placed, Transform, View, place};
pub(crate) use varyings::FEW;
pub use varyings::{Correction, Lane, Lanes, Perspective, PerspectiveClass, Varyings, WidePlane};
pub use viewport::{Viewport, ViewportError};
