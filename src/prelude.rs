//! The names that a first program needs: `use zstrip::prelude::*;`.
//!
//! It may stand beside `use embedded_graphics::prelude::*;`: no name of the one means something else in the other.

#[doc(no_inline)]
pub use crate::{
    color::Rgb565Be,
    frame::Renderer,
    light::{DirectionalLight, Lighting, Material},
    math::{Affine, Angle16, Pixels, Projective, Scalar, Vec3},
    mesh::{LineTopology, Lines, Mesh, MeshData, Points, Positions, Topology, Vertices},
    scene::{Scene, State},
    shader::{Flat, Gouraud, Shaded, Textured},
    target::Framebuffer,
};
#[doc(no_inline)]
pub use embedded_graphics_core::{
    geometry::{Point, Size},
    pixelcolor::{Rgb565, Rgb888, RgbColor, WebColors},
};
