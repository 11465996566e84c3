//! Fuzz targets. Each takes any bytes, decodes them to something to draw or to compute, and panics where a promise of
//! the crate is broken. It returns a hash of all results, which must be the same on every machine.
//!
//! | target | what is drawn or called | what must hold |
//! |---|---|---|
//! | [`scenes`] | all draws, states, shaders, formats | the same bytes for any strips, records, renderer; repeatable |
//! | [`coverage`] | one triangle | exactly the pixels and, within 1, the depths of the model in integers |
//! | [`clipping`] | triangles in clip space, in every depth range | the pixels of a rasterizer that does not clip |
//! | [`strokes`] | lines in every stroke, and the canvas | thin lines: exactly the model's pixels; all: the same bytes |
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
pub mod models;
mod reference;
pub mod scenes;
pub mod sinks;
mod source;
pub mod strokes;
mod things;

pub use reference::rng::Rng;

/// All targets: a name, and a function from any bytes to a hash of the results.
pub const TARGETS: [(&str, fn(&[u8]) -> u64); 8] = [
    ("scenes", scenes::run),
    ("coverage", coverage::run),
    ("clipping", clipping::run),
    ("strokes", strokes::run),
    ("constructors", constructors::run),
    ("bytes", bytes::run),
    ("models", models::run),
    ("sinks", sinks::run),
];

/// FNV-1a of 64 bits over whatever a target finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hash(pub u64);

impl Default for Hash {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Hash {
    /// Adds a number, eight bytes at a time.
    pub fn add(&mut self, value: u64) {
        self.0 = (self.0 ^ value).wrapping_mul(0x0100_0000_01b3).rotate_left(29);
    }

    /// Adds bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.add(u64::from_le_bytes(word));
        }
    }
}
