//! Screen primitive → spans: exact edges walked row by row, and the plane equations of what is interpolated.

mod edge;
mod gradient;
mod perspective;
mod triangle;

pub use edge::Edge;
pub use gradient::{Gradients, PlaneEquation};
pub use perspective::{homogenize, widen};
pub use triangle::{PixelRect, Trapezoids, first_centre, pixel_rect, spans};
