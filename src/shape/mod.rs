//! Shapes with smooth edges on the screen's plane: paths, circles and their parts, rectangles, thick lines, gradients
//! to fill them with, and sprites. A program meets a [`ShapeBuffer`](crate::scene::ShapeBuffer) first, the memory that
//! all of them share, and [`Canvas::fill`](crate::scene::Canvas::fill).
//!
//! Curves are flattened so finely that a pixel's covered part is within 1/128 of that of the true shape.

mod arc;
mod gradient;
mod line;
mod path;
mod round;
mod sprite;
mod text;

pub use crate::raster::FillRule;
pub use gradient::{LinearGradient, RadialGradient, Ramp};
pub use line::{Cap, Join, Polyline};
pub use path::Path;
pub use round::{Circle, Ellipse, Ring, RoundedRectangle};
pub use sprite::Sprite;
pub use text::{Stencil, Tinted};
