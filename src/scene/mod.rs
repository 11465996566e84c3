//! The one place that calls every stage, in order.

mod assembly;
mod canvas;
mod draw;
mod lines;
mod overlay;
mod painter;
mod scan;
mod scene;
mod state;
mod stroke;

pub use canvas::{Canvas, ScreenPoint};
pub use scene::Scene;
pub(crate) use scene::{Phase, Target};
pub use state::{Cull, State, Winding};
pub use stroke::{Dashed, Smooth, Stroke, Thick, Thin};
