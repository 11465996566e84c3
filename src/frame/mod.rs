//! Frames: bands and strips, renderers, views, RAM budgets.

mod budget;
mod renderer;
mod view;

pub use budget::RamBudget;
pub use renderer::{Buffers, Frame, FrameError, FramebufferRenderer, Renderer, RendererError};
pub use view::FrameView;
