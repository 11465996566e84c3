//! Meshes, lines and points in flash, their bounds and edges, and the order of draws.

mod bounds;
mod edges;
mod lines;
mod mesh;
mod order;

pub use bounds::{Bounds, BoundsNode};
pub use edges::{EdgesError, edges};
pub use lines::{LineTopology, Lines, Points, Vertices};
pub use mesh::{Mesh, MeshData, MeshError, Positions, Topology};
pub use order::{sort_back_to_front, view_depth};
