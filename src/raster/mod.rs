//! Screen primitive → spans and pixels: vertices on the screen come in. Exact spans of triangles, row by row, the plane
//! equations of interpolated values, and the pixels of lines and points go out.
//!
//! Coverage is exact, as if computed with infinite precision, for vertices within ±32,767 px.

mod along;
mod area;
mod area_cells;
mod area_edge;
mod area_row;
mod bezier;
mod blocks;
mod bounding_box;
mod direction;
mod edge;
mod edge_function;
mod gradient;
mod line;
mod perspective;
mod point;
mod samples;
mod small;
mod triangle;

pub use along::Along;
pub(crate) use area::{AreaMemory, Contours, LEAST_EDGES, Run, area_words};
pub(crate) use area_edge::AreaEdges;
pub use area_row::FillRule;
pub(crate) use bezier::Bezier;
pub use blocks::{Block, blocks};
pub use bounding_box::{bounding_box, covered_samples};
pub(crate) use direction::unit;
pub use gradient::{Gradients, PlaneEquation};
pub(crate) use gradient::{gradients, gradients_inlined, high};
pub use line::{Line, LinePixels};
pub(crate) use perspective::least_and_most;
pub use perspective::{homogenize, straighten, widen, widen_along};
pub use point::{square, wide_square};
pub use samples::moves;
pub(crate) use samples::{first_centre, sampled};
pub(crate) use small::{HEIGHT, SUM, ShortEdge, ShortPlanes, ShortSlope, TALL, WIDTH, edge_at, tall_edges};
pub use triangle::{Outline, PixelRect, Spans, pixel_rect, spans};
