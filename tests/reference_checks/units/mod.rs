//! The references against hand-made cases and against each other, module by module.

mod exact;
mod frame;
mod hits;
mod homogeneous;
mod meshes;
mod ray;
mod records;
mod rng;
mod scenes;
mod snapped;
