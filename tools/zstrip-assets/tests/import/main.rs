//! Imports files that the tests write themselves.

mod geometry;
mod gltf;
mod hostile;
mod obj;
mod ply;
mod stl;
mod support;
