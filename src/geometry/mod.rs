//! Object → screen primitive: meshes, bounds, the viewport, culling, vertex transform, lighting, clipping, projection.

mod bounds;
mod clip;
mod frustum;
mod light;
mod mesh;
mod project;
mod transform;
mod varyings;
mod vertex;
mod viewport;

pub use bounds::{BoundingBox, BoundingSphere, Bounds, BoundsNode};
pub use clip::{ClipVertex, DepthRange, Outcode, Part, clip_triangle};
pub use frustum::{Containment, Frustum, Plane};
pub use light::{Light, Lit, NORMAL_ONE};
pub use mesh::{Mesh, MeshData, MeshError, Positions, Topology};
pub(crate) use project::small;
pub use project::{ScreenVertex, inverse_w, project, signed_area};
pub use transform::{Placed, Transform, View, place};
pub use varyings::{Correction, Lane, Lanes, Perspective, PerspectiveClass, Varyings, WidePlane};
pub use vertex::{Corner, Face, Side, VertexShader};
pub use viewport::{Viewport, ViewportError};
