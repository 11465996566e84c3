//! Screen primitive → spans: exact edges walked row by row, the plane equations of what is interpolated, and the pixels of
//! lines and points.

mod along;
mod direction;
mod edge;
mod gradient;
mod line;
mod perspective;
mod point;
mod triangle;

pub use along::Along;
pub(crate) use direction::unit;
pub use gradient::{Gradients, PlaneEquation};
pub use line::{Line, LinePixels};
pub use perspective::{homogenize, widen};
pub use point::square;
pub use triangle::{Outline, PixelRect, Spans, pixel_rect, spans};
