//! Independent references: slow, plain models of what the crate must draw.
//!
//! Nothing here uses the crate. Each model reaches the answer by another road than the library's.
//!
//! | module | what it is | arithmetic |
//! |---|---|---|
//! | [`diamonds`] | lines by the diamond-exit rule | integers, exact |
//! | [`exact`] | coverage, depth and attributes of one snapped triangle | integers, exact |
//! | [`homogeneous`] | clip space to pixels with no clipper (Olano & Greer) | f64 |
//! | [`interpolation`] | perspective-correct values of triangles and lines, from clip space | f64 |
//! | [`snapped`] | depth-tested frames from snapped vertices | exact coverage and depth, f64 colour |
//! | [`ray`], [`camera`], [`surface`] | image-order ray caster for triangles and quadrics | f64 |
//! | [`frame`] | the picture those three renderers produce, and its comparison | f64 |
//! | [`conformance`] | reads the conformance files and checks a rasterizer against them | integers |
//! | [`model`], [`mistakes`] | the rasterizers, right and wrong, that the checker is checked with | |
//! | [`rng`], [`scenes`], [`meshes`] | seeded random scenes for property tests | integers |
//!
//! In all of them: screen y down, pixel centres at .5, front is counter-clockwise seen with y up.
#![allow(dead_code, unused_imports, reason = "the example uses only part of the references")]

pub mod camera;
pub mod conformance;
pub mod diamonds;
pub mod exact;
pub mod frame;
pub mod homogeneous;
pub mod interpolation;
pub mod meshes;
pub mod mistakes;
pub mod model;
pub mod ray;
pub mod rng;
pub mod scenes;
pub mod snapped;
pub mod subject;
pub mod surface;
pub mod traversed;
