//! The exact models of the crate's tests.
#![allow(dead_code, reason = "the targets use only part of the models")]

#[path = "../../tests/reference/diamonds.rs"]
pub mod diamonds;
#[path = "../../tests/reference/exact.rs"]
pub mod exact;
#[path = "../../tests/reference/frame.rs"]
pub mod frame;
#[path = "../../tests/reference/homogeneous.rs"]
pub mod homogeneous;
#[path = "../../tests/reference/rng.rs"]
pub mod rng;
