//! Names that a first program needs: `use zstrip::prelude::*;`.
//!
//! It may stand beside `use embedded_graphics::prelude::*;`: a name that is in both is one item. Binary angles are
//! called [`Angle16`], since embedded-graphics' prelude has an `Angle`, an `f32`.
//!
//! ```
//! use zstrip::prelude::*;
//!
//! static CORNERS: [Vec3; 3] = [Vec3::from_ints(-1, -1, 0), Vec3::from_ints(1, -1, 0), Vec3::from_ints(0, 1, 0)];
//! static TRIANGLE: Mesh<'static> = Mesh::constant(MeshData::new(Positions::Exact(&CORNERS)));
//! const SCREEN: Size = Size::new(160, 128);
//!
//! fn draw<D: DrawTarget<Color = Rgb565>>(display: &mut D) -> Result<(), FrameError<D::Error>> {
//!     let mut renderer = Renderer::<Rgb565>::new(SCREEN).unwrap();
//!     let (angle, near, far) = (Angle16::from_degrees(60), Scalar::ONE, Scalar::from_num(9));
//!     let lens = Projective::perspective(angle, SCREEN, near, far).unwrap();
//!     let model = Affine::translation(Vec3::from_ints(0, 0, -3));
//!     let (mvp, shader) = (lens * model, Flat::unlit(Rgb888::CSS_ORANGE));
//!     // Strips of 16 rows.
//!     renderer.frame(display, &mut [0; 160 * 16], Rgb888::BLACK, |scene| scene.draw(&TRIANGLE, &mvp, &shader))?;
//!     Ok(())
//! }
//! ```

#[doc(no_inline)]
pub use crate::{
    color::{PixelFormat, Rgb565Be},
    frame::{FrameError, FramebufferRenderer, Renderer},
    light::{DirectionalLight, Lighting, Material, PointLight, Sun, Viewer},
    math::{Affine, Angle16, Pixels, Projective, Scalar, Vec3},
    mesh::{LineTopology, Lines, Mesh, MeshData, Points, Positions, Topology, Vertices},
    scene::{Cull, Scene, Smooth, State, Thick, Thin, Winding},
    shader::{Flat, Gouraud, Phong, Textured},
    target::{Framebuffer, StripPixels, WithCarriedState, WithDepth, WithRecords, WithoutDepth, WithoutRecords},
};
#[doc(no_inline)]
pub use embedded_graphics_core::{
    draw_target::DrawTarget,
    geometry::{Point, Size},
    pixelcolor::{Rgb565, Rgb888, RgbColor, WebColors},
};
