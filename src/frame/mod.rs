//! Frames, drawn strip by strip. A program meets [`Renderer`] first. [`FramebufferRenderer`] draws without strips,
//! [`Supersampled`] makes one pixel of several, [`FrameView`] is an embedded-graphics `Drawable`, [`RamBudget`] counts
//! bytes in constants.

mod budget;
mod engine;
mod error;
mod frame;
mod framebuffer_renderer;
mod renderer;
mod supersampled;
mod view;

pub use budget::RamBudget;
pub use error::{FrameError, RendererError};
pub use frame::Frame;
pub use framebuffer_renderer::FramebufferRenderer;
pub use renderer::Renderer;
pub use supersampled::{Supersampled, SupersampledFrame};
pub use view::FrameView;
