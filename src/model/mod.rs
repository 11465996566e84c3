//! Models in one piece of bytes: meshes, materials, textures, a tree of nodes, skins, morph targets and clips of
//! animation, read where they lie and drawn by ordinary draws.
//!
//! ```
//! use zstrip::frame::FrameError;
//! use zstrip::model::{Camera, Model};
//! use zstrip::prelude::*;
//!
//! const SCREEN: Size = Size::new(240, 320);
//!
//! fn show(file: &[u8], display: &mut impl DrawTarget<Color = Rgb565>) -> Result<(), Box<dyn core::error::Error>> {
//!     // Once: the bytes are checked.
//!     let model = Model::from_bytes(file)?;
//!     let camera = Camera::framing(&model.bounds(), Angle16::from_degrees(40), SCREEN, Vec3::from_ints(2, 1, 4))?;
//!     let sun = Sun::new(Vec3::from_ints(4, 7, 6), Rgb888::CSS_LIGHT_GRAY, Rgb888::CSS_DIM_GRAY);
//!     // Once per frame: matrices and light. Model::draws(file) places are enough.
//!     let mut places = [None; 16];
//!     let turn = Affine::rotation_y(Angle16::from_degrees(30));
//!     let placed = model.place(&turn, &camera, &sun, &mut places)?;
//!     // Once per strip, or more often.
//!     let (mut color, mut depth) = ([0; 240 * 16], [0; 240 * 16]);
//!     let mut renderer = Renderer::<Rgb565>::new(SCREEN)?.with_depth(&mut depth)?;
//!     renderer.frame(display, &mut color, Rgb888::BLACK, |scene| placed.draw(scene)).ok();
//!     Ok(())
//! }
//! ```
//!
//! `file` is what [`include_model`](crate::include_model) makes of a file, or a piece of external flash. The layout is
//! that of [`container`]. An animated model takes a [`Pose`], in memory that the caller lends:
//!
//! ```
//! # use zstrip::model::{Camera, Light, MemoryError, Model, Pose};
//! # use zstrip::prelude::*;
//! # fn frame<'m>(model: &Model<'m>, camera: &Camera, sun: &Sun, memory: &mut [u32]) -> Result<(), MemoryError> {
//! # let (milliseconds, world) = (40, Affine::IDENTITY);
//! let mut pose = model.pose(memory)?; // Pose::words(file) words
//! if let (Some(walk), Some(run)) = (model.clip_named("walk"), model.clip_named("run")) {
//!     pose.play(walk.looped(milliseconds));
//!     pose.blend(walk.looped(milliseconds), run.looped(milliseconds), Scalar::from_num(0.25));
//! }
//! let mut places = [None; 16];
//! let placed = pose.place(&world, camera, sun, &mut places)?;
//! // |scene| placed.draw(scene)
//! # let _ = placed;
//! # Ok(())
//! # }
//! ```

mod aligned;
mod animation_items;
mod camera;
mod check;
mod clusters;
pub mod container;
mod determinant;
mod draw;
mod error;
mod keys;
mod material_items;
mod normal;
mod place;
mod pose;
mod posed;
mod range;
mod read;
mod shader;
mod skin;
mod texels;
mod transform;

pub use aligned::Aligned;
pub use camera::Camera;
pub use error::{MemoryError, ModelError};
pub use keys::{Clip, Motion};
pub use normal::decode_normal;
pub use place::{Place, Placed};
pub use pose::Pose;
pub use read::Model;
pub use shader::Light;
