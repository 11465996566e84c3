//! The one place that calls every stage of [the pipeline](crate#the-pipeline), in order. Meshes, lines, points and
//! shapes come in, and pixels of the current strip, or records for the strips of a band, go out.
//!
//! Meshes are drawn in `draw`, lines and points in `lines`, and shapes on the screen in `canvas`.

mod assembly;
mod canvas;
mod clusters;
mod cull;
mod draw;
mod fill;
mod hooks;
mod lines;
mod occlusion;
mod outline;
mod overlay;
mod painter;
mod program;
mod replay;
mod scan;
mod scene;
mod small_rows;
mod state;
mod stroke;
mod vertex_stage;

pub use canvas::{Canvas, ScreenPoint};
pub use fill::{ShapeBuffer, ShapeError};
pub(crate) use outline::Place;
pub use outline::{Outline, Pen};
pub use scene::Scene;
pub(crate) use scene::{Phase, Target};
pub use state::{Cull, State, Winding};
pub use stroke::{Dashed, Smooth, Stroke, Thick, Thin};
