//! Fuzz targets. Each takes any bytes, decodes them to something to draw or to compute, and panics where a promise of
//! the crate is broken. It returns a hash of all results, which must be the same on every machine.
//!
//! | target | what is drawn or called | what must hold |
//! |---|---|---|
//! | [`scenes`] | all draws, states, shaders, formats | the same bytes for any strips, records, renderer; repeatable |
//! | [`coverage`] | one triangle | exactly the pixels and, within 1, the depths of the model in integers |
//! | [`clipping`] | triangles in clip space, in every depth range | the pixels of a rasterizer that does not clip |
//! | [`strokes`] | lines in every stroke, and the canvas | thin lines: exactly the model's pixels; all: the same bytes |
//! | [`shapes`] | shapes with smooth edges, gradients, sprites | the same bytes for any strips |
//! | [`constructors`] | constructors and functions on numbers | results in range, the model's where there is one |
//! | [`bytes`] | what reads bytes: images, palettes, packed formats | the model's texels and bits |
//! | [`models`] | containers with changed bytes | an error, or pictures: the same bytes for any strips and records |
//! | [`sinks`] | sinks that fail, frames that are dropped, scenes that change | the next frame is as from a new renderer |
//!
//! `ci/fuzz` runs them.

pub mod bytes;
pub mod clipping;
pub mod constructors;
pub mod coverage;
mod hash;
pub mod models;
mod reference;
pub mod replay;
pub mod scenes;
pub mod shapes;
pub mod sinks;
mod source;
pub mod strokes;
mod things;

pub use hash::Hash;
pub use reference::rng::Rng;

/// A name, and a function from any bytes to a hash of the results.
pub type Target = (&'static str, fn(&[u8]) -> u64);

/// All targets.
pub const TARGETS: [Target; 9] = [
    ("scenes", scenes::run),
    ("coverage", coverage::run),
    ("clipping", clipping::run),
    ("strokes", strokes::run),
    ("shapes", shapes::run),
    ("constructors", constructors::run),
    ("bytes", bytes::run),
    ("models", models::run),
    ("sinks", sinks::run),
];
