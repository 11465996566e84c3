//! Surfaces that no light changes.

use crate::color::channels;
use embedded_graphics_core::pixelcolor::Rgb888;

/// A surface that looks alike under any light: of one colour, or of the colours of the mesh's vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unlit {
    /// Red, green and blue; `None` for the colours of the vertices.
    color: Option<[u8; 3]>,
}

impl Unlit {
    /// Returns the surface of one colour.
    #[must_use]
    pub fn new(color: impl Into<Rgb888>) -> Self {
        Self { color: Some(channels(color.into())) }
    }

    /// Returns the surface that has the colours of the mesh's vertices.
    #[must_use]
    pub const fn vertex_colors() -> Self {
        Self { color: None }
    }

    /// Returns the one colour, if there is one.
    #[inline(always)]
    pub(crate) const fn color(&self) -> Option<[u8; 3]> {
        self.color
    }
}
