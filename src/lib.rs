//! x
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[cfg(test)]
extern crate std;

pub mod fragment;
pub mod geometry;
pub mod math;
pub mod output;
mod pipeline;
pub mod raster;

pub use embedded_graphics_core;
pub use output::{Buffers, Framebuffer, Renderer};
pub use pipeline::{Cull, Scene, State};
