//! Containers that the tool writes: read back, drawn, and refused.

#[cfg(feature = "cli")]
mod command;
mod failures;
mod figures;
mod levels;
mod pictures;
#[path = "../../../../tests/reference/mod.rs"]
mod reference;
mod round_trip;
#[allow(dead_code, reason = "these tests use a part of it")]
#[path = "../import/support.rs"]
mod support;
