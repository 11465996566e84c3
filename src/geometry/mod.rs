//! Object → screen primitive: meshes, lines and points, bounds, the viewport, culling, vertex transform, lights and
//! materials, clipping, projection.

mod bounds;
mod clip;
mod clip_distance;
mod clip_line;
mod edges;
mod frustum;
mod light;
mod lighting;
mod lines;
mod lit_material;
mod local_space;
mod material;
mod mesh;
mod order;
mod project;
mod sort;
mod transform;
mod varyings;
mod vertex;
mod viewport;

pub use bounds::{BoundingBox, BoundingSphere, Bounds, BoundsNode};
pub use clip::{
    CLIPPED_CORNERS, ClipCorner, ClipVertex, DepthRange, Outcode, Part, Polygon, PolygonCorner, clip_triangle, weighted,
};
pub use clip_distance::{DISTANCE_CORNERS, MAX_DISTANCES};
pub use clip_line::clip_line;
pub use edges::{EdgesError, edges};
pub use frustum::{Containment, Frustum, Plane};
pub use light::{Light, Lit, NORMAL_ONE};
pub use lighting::{DirectionalLight, Lighting, PointLight, Viewer};
pub use lines::{Joined, Lines, Points};
pub use lit_material::LitMaterial;
pub use local_space::LocalSpace;
pub use material::Material;
pub use mesh::{Mesh, MeshData, MeshError, Positions, Topology};
pub use order::{sort_back_to_front, view_depth};
pub(crate) use project::small;
pub use project::{DepthScale, ScreenVertex, inverse_w, project, signed_area};
pub use sort::{Order, SortError, Sortable, far_to_near, painters_order};
pub use transform::{Placed, Transform, View, place};
pub(crate) use varyings::FEW;
pub use varyings::{Correction, Lane, Lanes, Perspective, PerspectiveClass, Varyings, WidePlane};
pub use vertex::{Corner, Face, Side, VertexShader};
pub use viewport::{Viewport, ViewportError};
