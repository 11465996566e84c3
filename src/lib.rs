//! Draws 3-D on microcontroller displays, without a framebuffer.
//!
//! Meshes go in; finished strips of pixels come out, each depth-tested with 16 bits while it was drawn. There is no
//! allocator, no float and no `unsafe`. A frame of 320×240 pixels takes 20 KB of RAM, or less, instead of 300.
//!
//! # A first picture
//!
//! ```
//! use zstrip::prelude::*;
//!
//! // A mesh borrows its slices, which may lie in flash. The front is where corners go counter-clockwise.
//! static CORNERS: [Vec3; 3] = [Vec3::from_ints(-1, -1, 0), Vec3::from_ints(1, -1, 0), Vec3::from_ints(0, 1, 0)];
//! static TRIANGLE: Mesh<'static> = Mesh::constant(MeshData::new(Positions::Exact(&CORNERS)));
//! const SCREEN: Size = Size::new(320, 240);
//!
//! // The caller owns the memory. These buffers hold strips of 16 rows. Records may be few, or none.
//! let (mut color, mut depth, mut records) = ([0; 320 * 16], [0; 320 * 16], [0; 64]);
//! let mut renderer = Renderer::<Rgb565Be>::new(SCREEN)?.with_depth(&mut depth)?.with_records(&mut records);
//!
//! let lens = Projective::perspective(Angle16::from_degrees(60), SCREEN, Scalar::ONE, Scalar::from_num(100))?;
//! let model = Affine::translation(Vec3::from_ints(0, 0, -3)) * Affine::rotation_z(Angle16::from_degrees(15));
//! // Matrices and shaders are made outside of the closure, because it runs at least once per strip.
//! let (mvp, shader) = (lens * model, Flat::unlit(Rgb888::CSS_ORANGE));
//!
//! # let mut sent = 0;
//! # let mut spi_write = |bytes: &[u8]| sent += bytes.len();
//! let mut frame = renderer.begin(Rgb888::BLACK);
//! while let Some(strip) = frame.next_strip(&mut color, |scene| scene.draw(&TRIANGLE, &mvp, &shader))? {
//!     spi_write(strip.bytes());
//! }
//! assert_eq!(frame.stats().drawn, 1);
//! # assert_eq!(sent, 320 * 240 * 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Where to go from here
//!
//! | to | see |
//! |---|---|
//! | send strips while others are drawn, by DMA or async code | [`frame::Frame`] |
//! | draw on an embedded-graphics display, or into a sink | [`Renderer::frame`], [`Renderer::frame_to`] |
//! | draw into a framebuffer, without strips | [`frame::FramebufferRenderer`] |
//! | know how much RAM that takes, at compile time | [`frame::RamBudget`] |
//! | draw in strips of a few rows | [`Renderer::with_carried_state`] |
//! | make edges smooth | [`Renderer::with_samples`], [`frame::Supersampled`] |
//! | leave out what is hidden | [`Renderer::with_occlusion`], [`Scene::is_visible_with`] |
//! | bring in a mesh, lines, points | [`mesh`] |
//! | draw a model with its materials, textures and animation from one file | [`model`] |
//! | place a camera, move things | [`math`] |
//! | light them, and choose a shader | [`light`], [`shader`] |
//! | put textures on them | [`texture`] |
//! | write a shader of one's own | [`span::Shader`] |
//! | draw text, images and shapes among meshes | [`Scene::overlay`], [`Scene::at_depth`], [`Scene::canvas`] |
//! | draw shapes with smooth edges, gauges, sprites | [`shape`], [`Canvas::fill`] |
//! | find a point of the world on the screen, and back | [`Scene::project`], [`Scene::unproject`] |
//! | choose the format of pixels, or dither | [`color`], [`target::Packer`] |
//! | know how exact positions, depths, colours and light are | `docs/accuracy.md`: bounds and worst errors seen |
//!
//! # The pipeline
//!
//! A frame's closure is called several times. A call works in one of three phases: it *records* a band of strips, it
//! *replays* the records of one strip, or, where a frame has one strip or the records have no room for two, it draws a
//! strip *directly*.
//!
//! | | stage | in | out | file | phase |
//! |---|---|---|---|---|---|
//! | 1 | bounds | a mesh, lines or points; a matrix | nothing, if the box is out of view; a vertex transform | `scene/scene.rs`, `vertex/transform.rs` | record, direct |
//! | 2 | vertices | vertex numbers | packed vertices: place on the screen, or outcode; varyings | `scene/vertex_stage.rs`, `vertex/{transform, project, shader}.rs` | record, direct |
//! | 3 | primitive assembly | indices | triangles on the screen, or triangles to be clipped | `scene/scan.rs`, `mesh/mesh.rs` | record, direct |
//! | 4 | clipping | a triangle with outcodes | a fan of triangles on the screen | `scene/assembly.rs`, `vertex/{clip, clip_distance}.rs` | record, direct |
//! | 5 | culling | a triangle on the screen | nothing, if it shows the wrong side or covers no pixel | `scene/{cull, scan}.rs` | record, direct |
//! | 6 | recording | a triangle on the screen | three words in the list of the first strip it touches | `target/{records, triangles}.rs` | record |
//! | 7 | faces | a triangle of the mesh | one word for all of its fragments, such as a lit colour | `scene/program.rs`, `vertex/shader.rs` | record, direct |
//! | 8 | set-up | a triangle on the screen, its varyings | plane equations of depth and varyings | `scene/painter.rs`, `span/small.rs`, `raster/gradient.rs` | replay, direct |
//! | 9 | spans | three edges | runs of pixels, row by row | `scene/painter.rs`, `span/small.rs`, `raster/{triangle, edge, small}.rs` | replay, direct |
//! | 10 | depth test | depths of a span | pixels that are in front | `span/depth.rs` | replay, direct |
//! | 11 | fragments | varyings at a pixel, the face's word | a pixel | `span/`, `shader/` | replay, direct |
//! | 12 | output | a strip of pixels | bytes for a display | `frame/frame.rs`, `target/` | after each strip |
//!
//! One function in `scene/draw.rs` calls stages 1 to 7, and one in `scene/replay.rs` calls stages 8 to 11. A triangle
//! that is clipped goes through stages 5 to 7 after stage 4; all others skip stage 4. Lines and points share stages 1
//! and 2, and 9 to 11. In between, `scene/lines.rs` goes over all of them in each strip, and records only their
//! vertices. Shapes of a [`Canvas`] enter at stage 8.
//!
//! # The floors
//!
//! | folder | what it holds |
//! |---|---|
//! | [`math`] | numbers: fixed-point formats, binary angles, vectors, matrices, reciprocals |
//! | [`color`] | what a pixel is: formats, packed channels, ordered dither, fills |
//! | [`texture`] | images in flash, texel formats, sampling |
//! | [`mesh`] | meshes, lines, points, their bounds and edges, and the order of draws |
//! | [`light`] | lights and materials |
//! | [`vertex`] | what a vertex shader sees and returns; transform, clip, project |
//! | `raster` | screen primitives → spans, plane equations |
//! | [`span`] | the [`Shader`](span::Shader) seam, the depth test, the loops over pixels |
//! | [`shader`] | the ready-made shaders, ordinary users of that seam |
//! | [`target`] | framebuffers, strips, sinks, packers, embedded-graphics targets, records |
//! | [`scene`] | the one place that calls every stage, in order: [`Scene`] |
//! | [`shape`] | shapes with smooth edges: paths, circles, thick lines, gradients, sprites |
//! | [`model`] | models in containers: nodes, materials, animation; an ordinary user of all floors below |
//! | [`frame`] | bands and strips, renderers, views, RAM budgets |
//!
//! A folder imports only from those above it in this table, and no two files import each other: `tests/floors.rs`
//! checks both.
//!
//! # Conventions
//!
//! - **Spaces.** The world is right-handed, y up; a camera looks along -z. Matrices apply to column vectors: `a * b`
//!   does `b` first. Clip space is -w ≤ x, y ≤ w, 0 ≤ z ≤ w, as in Direct3D, Vulkan and wgpu. On the screen, x points
//!   right and y down, in pixels from the top left corner. The centre of a pixel is at .5.
//! - **Numbers.** [`Scalar`](math::Scalar) is 16.16, an entry of a [`Projective`](math::Projective) matrix is 32.32,
//!   and a position on the screen, [`Pixels`](math::Pixels), is 24.8. Normals are 2.14. Vectors and transforms
//!   saturate. A `Scalar`'s own operators overflow as integers do: they panic in debug builds and wrap in release
//!   builds. [`SaturatingScalar`](math::SaturatingScalar) does neither.
//! - **Colours** have 8 bits per channel, in every scene and for every format. Functions take whatever turns into
//!   `Rgb888`. Meshes and textures in flash hold bytes.
//! - **Angles** are binary: 65,536 make one turn.
//! - **Depth** is 16-bit, 0 at the near plane, 65,535 at the far plane, and linear on the screen. Strips are cleared to
//!   65,535. A fragment is drawn where it is nearer than the stored depth. [`DepthState`](span::DepthState) has the
//!   other seven comparisons and the write mask.
//! - **Faces.** A face shows its front where its corners go counter-clockwise, with y up. Back faces are culled unless
//!   [`State`] says otherwise.
//! - **Fill rule.** A pixel is covered if its centre is inside of the triangle, or on a left or top edge. So triangles
//!   that share an edge leave no gap and draw no pixel twice. That also holds for the parts of a clipped triangle.
//! - **Textures.** u points right, v down. Centres of texels are at .5.
//! - **Errors** come from constructors and carry the number that was wrong and the one that was needed. A frame fails
//!   only with the display's own error, or because its closure drew two different things, or because a buffer was too
//!   short. What was culled or clipped is counted in [`Stats`](target::Stats).
//!
//! # Features
//!
//! - `micromath`: converts its vectors, its quaternions and `f32` matrices to fixed-point ones.
//! - `defmt`: implements `Format` for errors and statistics.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[cfg(test)]
extern crate std;

pub mod color;
pub mod frame;
pub mod light;
pub mod math;
pub mod mesh;
pub mod model;
mod raster;
pub mod scene;
pub mod shader;
pub mod shape;
pub mod span;
pub mod target;
pub mod texture;
pub mod vertex;

#[doc(hidden)]
pub mod internals;
pub mod prelude;

// The crates whose types stand in signatures.
pub use bytemuck;
pub use embedded_graphics_core;
pub use fixed;
#[cfg(feature = "micromath")]
pub use micromath;

pub use frame::Renderer;
pub use scene::{Canvas, Cull, Dashed, Scene, ScreenPoint, Smooth, State, Stroke, Thick, Thin, Winding};
pub use target::Framebuffer;

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
        logged::<crate::mesh::MeshError>();
        logged::<crate::model::ModelError>();
        logged::<crate::model::MemoryError>();
        logged::<crate::vertex::SortError>();
        logged::<crate::vertex::ViewportError>();
        logged::<crate::math::PrecisionError>();
        logged::<crate::math::ProjectionError>();
        logged::<crate::target::FramebufferError>();
        logged::<crate::shader::FogError>();
        logged::<crate::frame::RendererError>();
        logged::<crate::target::PackerError>();
        logged::<crate::frame::FrameError>();
        logged::<crate::target::Stats>();
        #[cfg(feature = "micromath")]
        logged::<crate::math::FloatError>();
    }
}
