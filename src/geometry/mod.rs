//! Object → screen primitive: meshes, bounds, the viewport, culling, vertex transform, lights and materials, clipping, projection.

mod bounds;
mod clip;
mod frustum;
mod light;
mod lighting;
mod lit_material;
mod local_space;
mod material;
mod mesh;
mod order;
mod project;
mod transform;
mod vertex;
mod viewport;

pub use bounds::{BoundingBox, BoundingSphere, Bounds, BoundsNode};
pub use clip::{ClipVertex, DepthRange, Outcode, Part, clip_triangle};
pub use frustum::{Containment, Frustum, Plane};
pub use light::{Light, Lit, NORMAL_ONE};
pub use lighting::{DirectionalLight, Lighting, PointLight, Viewer};
pub use lit_material::LitMaterial;
pub use local_space::LocalSpace;
pub use material::Material;
pub use mesh::{Mesh, MeshData, MeshError, Positions, Topology};
pub use order::{sort_back_to_front, view_depth};
pub(crate) use project::small;
pub use project::{ScreenVertex, project, signed_area};
pub use transform::{Placed, Transform, View, place};
pub use vertex::{Corner, Face, Side, Varyings, VertexShader};
pub use viewport::{Viewport, ViewportError};
