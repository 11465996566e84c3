//! Meshes, lines and points, borrowed from flash or RAM and checked once, with their bounds and edges, and the order
//! of draws. A program meets [`Mesh`] first, made of a [`MeshData`]; [`Lines`] and [`Points`] are made of
//! [`Vertices`].

mod bounds;
mod data;
mod edges;
mod error;
mod extent;
mod lines;
mod mesh;
mod order;

pub use bounds::{Bounds, BoundsNode};
#[cfg(test)]
pub(crate) use data::LOOKED_UP;
pub use data::{MeshData, Positions, Topology};
pub use edges::{EdgesError, edges};
pub use error::MeshError;
pub use lines::{LineTopology, Lines, Points, Vertices};
pub use mesh::Mesh;
pub use order::{sort_back_to_front, view_depth};
