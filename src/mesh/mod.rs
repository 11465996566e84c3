//! Meshes, lines and points, borrowed from flash or RAM and checked once, with their bounds and edges, and the order
//! of draws. A program meets [`Mesh`] first, made of a [`MeshData`]; [`Lines`] and [`Points`] are made of
//! [`Vertices`].

mod bounds;
mod edges;
mod lines;
mod mesh;
mod order;

pub use bounds::{Bounds, BoundsNode};
pub use edges::{EdgesError, edges};
pub use lines::{LineTopology, Lines, Points, Vertices};
#[cfg(test)]
pub(crate) use mesh::LOOKED_UP;
pub use mesh::{Mesh, MeshData, MeshError, Positions, Topology};
pub use order::{sort_back_to_front, view_depth};
