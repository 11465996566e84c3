//! Shapes with smooth edges on the screen's plane: paths, curves, circles and their parts, rectangles, thick lines,
//! gradients to fill them with, and sprites. A program meets a [`ShapeBuffer`](crate::scene::ShapeBuffer) first, the
//! memory that all of them share, and [`Canvas::fill`](crate::scene::Canvas::fill).
//!
//! Round shapes are flattened so finely that a pixel's covered part is within 1/128 of that of the true shape. Curves
//! of paths, and ellipses that are turned, are drawn within 1/64 px of the true ones.

mod arc;
mod dashes;
mod gradient;
mod line;
mod path;
mod round;
mod sprite;
mod stroker;
mod text;

pub use crate::raster::FillRule;
pub use gradient::{LinearGradient, RadialGradient, Ramp};
pub use line::Polyline;
pub use path::{CurvePath, Path, PathStep};
pub use round::{Circle, Ellipse, Ring, RoundedRectangle};
pub use sprite::Sprite;
pub use stroker::{Cap, Join};
pub use text::{Stencil, Tinted};
