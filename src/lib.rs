//! 3-D for microcontroller displays: meshes go in, finished strips of pixels come out, each with 16-bit depth tested while
//! it was drawn. No allocator, no floats, no `unsafe`; a frame of 320×240 takes some KB of RAM instead of 300.
//!
//! ```
//! use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor, WebColors};
//! use zstrip::fragment::Flat;
//! use zstrip::geometry::{Mesh, MeshData, Positions};
//! use zstrip::math::{Affine, Angle, Projective, Scalar, Vec3};
//! use zstrip::output::Rgb565Be;
//! use zstrip::{Buffers, Renderer};
//!
//! // A mesh borrows its slices, which may lie in flash. Counter-clockwise is the front.
//! static CORNERS: [Vec3; 3] = [Vec3::from_ints(-1, -1, 0), Vec3::from_ints(1, -1, 0), Vec3::from_ints(0, 1, 0)];
//! static TRIANGLE: Mesh<'static> = Mesh::constant(MeshData::new(Positions::Exact(&CORNERS)));
//!
//! // The caller owns the memory; its size makes the strip's height: 16 rows. Records may be few, or none.
//! let (color, depth, records) = (&mut [0; 320 * 16], &mut [0; 320 * 16], &mut [0; 64]);
//! let mut renderer = Renderer::<Rgb565Be>::new((320, 240), Buffers { color, depth, records })?;
//!
//! let camera = Projective::perspective(Angle::from_degrees(60), (320, 240), Scalar::ONE, Scalar::from_num(100))?;
//! let model = Affine::translation(Vec3::from_ints(0, 0, -3)) * Affine::rotation_z(Angle::from_degrees(15));
//!
//! # let mut sent = 0;
//! # let mut spi_write = |bytes: &[u8]| sent += bytes.len();
//! let mut frame = renderer.begin(Rgb565::BLACK);
//! // The closure draws the whole scene; it is called for each strip and must draw the same each time.
//! while let Some(strip) = frame.next_strip(|scene| {
//!     scene.draw(&TRIANGLE, &(camera * model), &Flat::unlit(Rgb888::CSS_ORANGE));
//! })? {
//!     spi_write(strip.bytes());
//! }
//! assert_eq!(frame.stats().drawn, 1);
//! # assert_eq!(sent, 320 * 240 * 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//! Text, images and shapes of embedded-graphics are drawn in the same closure: [`Scene::overlay`], [`Scene::at_depth`].
//! [`Renderer::frame`] does the loop, for an embedded-graphics display; [`Renderer::frame_to`] for a
//! [sink](output::StripSink) or a closure; [`FramebufferRenderer`](output::FramebufferRenderer) draws without strips.
//!
//! # The way from a vertex to the display
//!
//! | folder | takes | hands on | |
//! |---|---|---|---|
//! | [`math`] | | | numbers: fixed-point formats, binary angles, vectors, matrices, reciprocals |
//! | [`geometry`] | meshes, matrices, lights | vertices on the screen | cull, transform, clip, project, snap |
//! | [`raster`] | triangles on the screen | spans, plane equations | exact edges, gradients |
//! | [`fragment`] | spans | colours and depths | depth test, shaders: the loops over pixels |
//! | [`output`] | colours | strips on the display | pixel formats, records, frames, sinks |
//!
//! A folder uses those above it, never those below. One file outside of them, `pipeline.rs`, calls them all, in order:
//! it holds [`Scene`], through which a frame is drawn.
//!
//! # Conventions
//!
//! - **Spaces.** The world is right-handed, y up; a camera looks along -z. Matrices apply to column vectors: `a * b` does
//!   `b` first. Clip space is -w ≤ x, y ≤ w, 0 ≤ z ≤ w, as in Direct3D, Vulkan and wgpu. On the screen x points right and y
//!   down, in pixels from the top left corner; the centre of a pixel is at .5.
//! - **Numbers.** [`Scalar`](math::Scalar) is 16.16, an entry of a [`Projective`](math::Projective) matrix 32.32, a
//!   position on the screen 24.8. Vectors and affine transforms saturate. Normals are 2.14, colours 8 bits a channel.
//! - **Angles** are binary: 65,536 make a turn.
//! - **Depth** is 16-bit, 0 at the near plane, 65,535 at the far plane, and linear on the screen. Strips are cleared to
//!   65,535. A fragment is drawn where it is nearer than what is there; [`DepthState`](fragment::DepthState) knows the other
//!   seven comparisons and the write mask.
//! - **Faces.** Counter-clockwise, with y up, is the front. The back is culled unless [`State`] says otherwise.
//! - **Fill rule.** A pixel is covered if its centre is inside, or on a left or top edge: triangles that share an edge
//!   leave no gap and draw no pixel twice. The same goes for the pixels of a clipped triangle.
//! - **Textures.** u points right, v down; centres of texels at .5.
//! - **Errors** come from constructors and say what was wrong. Drawing fails only with the display's own error, or
//!   because a frame's closure drew two different things; what was culled or clipped is counted in
//!   [`Stats`](output::Stats).
//!
//! # Features
//!
//! `micromath`: vectors, quaternions and `f32` matrices become fixed-point ones. `defmt`: `Format` for errors and statistics.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[cfg(test)]
extern crate std;

pub mod fragment;
pub mod geometry;
pub mod math;
pub mod output;
mod pipeline;
pub mod raster;

pub use embedded_graphics_core;
pub use output::{Buffers, Framebuffer, Renderer};
pub use pipeline::{Canvas, Cull, Dashed, Scene, ScreenPoint, Smooth, State, Stroke, Thick, Thin, Winding};

/// The README's program compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(all(test, feature = "defmt"))]
mod tests {
    /// Compiles only if every error, and what a frame reports, can be logged.
    #[test]
    fn errors_and_statistics_can_be_logged() {
        fn logged<T: defmt::Format>() {}
        logged::<crate::geometry::MeshError>();
        logged::<crate::geometry::SortError>();
        logged::<crate::geometry::ViewportError>();
        logged::<crate::math::PrecisionError>();
        logged::<crate::math::ProjectionError>();
        logged::<crate::output::FramebufferError>();
        logged::<crate::output::RendererError>();
        logged::<crate::output::PackerError>();
        logged::<crate::output::FrameError>();
        logged::<crate::output::Stats>();
        #[cfg(feature = "micromath")]
        logged::<crate::math::FloatError>();
    }
}
