//! A frame as an embedded-graphics drawable, to stand among other drawables.

use super::error::FrameError;
use super::renderer::Renderer;
use crate::color::PixelFormat;
use crate::scene::Scene;
use crate::target::{DepthChoice, RecordsChoice, Stats, Strip, WithoutDepth, WithoutRecords};
use core::cell::Cell;
use core::fmt;
use embedded_graphics_core::Drawable;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Dimensions, Point};
use embedded_graphics_core::pixelcolor::Rgb888;
use embedded_graphics_core::primitives::Rectangle;

/// A renderer and its scene as an embedded-graphics `Drawable`: a rectangle with 3-D in it, for any display and for any
/// code that draws or lays out drawables.
///
/// Its `Output` is the [`Stats`] of the frame, or the error that ended it.
///
/// ```
/// # use embedded_graphics::{mock_display::MockDisplay, pixelcolor::{Rgb565, Rgb888}, prelude::*};
/// # use zstrip::shader::Flat;
/// # use zstrip::mesh::{Mesh, MeshData, Positions};
/// # use zstrip::math::{Projective, Vec3};
/// # use zstrip::frame::{FrameView, Renderer};
/// # static CORNERS: [Vec3; 3] = [Vec3::from_ints(-1, -1, 0), Vec3::from_ints(1, -1, 0), Vec3::from_ints(0, 1, 0)];
/// # static TRIANGLE: Mesh<'static> = Mesh::constant(MeshData::new(Positions::Exact(&CORNERS)));
/// # let mut display = MockDisplay::<Rgb565>::new();
/// // A view of 24×16 pixels in strips of 4 rows.
/// let (mut color, mut depth, mut records) = ([0; 24 * 4], [0; 24 * 4], [0; 64]);
/// let mut renderer =
///     Renderer::<Rgb565>::new(Size::new(24, 16))?.with_depth(&mut depth)?.with_records(&mut records);
/// let shader = Flat::unlit(Rgb888::CSS_ORANGE);
/// let view = FrameView::new(&mut renderer, &mut color, Point::new(30, 10), Rgb888::BLACK, |scene| {
///     scene.draw(&TRIANGLE, &Projective::IDENTITY, &shader);
/// });
/// let stats = view.draw(&mut display)??;
/// assert_eq!((stats.strips, stats.drawn), (4, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct FrameView<'v, 'b, P: PixelFormat, F, D: DepthChoice = WithoutDepth, R = WithoutRecords> {
    /// Renderer and buffer, taken out while the view is drawn, as `draw` has only a shared reference.
    tools: Cell<Option<Tools<'v, 'b, P, D, R>>>,
    area: Rectangle,
    background: Rgb888,
    draw: F,
}

/// A renderer and the colour buffer for its strips.
type Tools<'v, 'b, P, D, R> = (&'v mut Renderer<'b, P, D, R>, &'v mut [<P as PixelFormat>::Raw]);

impl<'v, 'b, P: PixelFormat, F, D: DepthChoice, R: RecordsChoice> FrameView<'v, 'b, P, F, D, R>
where
    F: Fn(&mut Scene<'_, Strip<'_, P, D, R>>),
{
    /// Makes a view of the renderer's whole screen, with its corner at `top_left` of the target that it is drawn on.
    pub fn new(
        renderer: &'v mut Renderer<'b, P, D, R>,
        buffer: &'v mut [P::Raw],
        top_left: Point,
        background: impl Into<Rgb888>,
        draw: F,
    ) -> Self {
        let area = Rectangle::new(top_left, renderer.screen());
        Self { tools: Cell::new(Some((renderer, buffer))), area, background: background.into(), draw }
    }
}

impl<P: PixelFormat, F, D: DepthChoice, R> Dimensions for FrameView<'_, '_, P, F, D, R> {
    fn bounding_box(&self) -> Rectangle {
        self.area
    }
}

impl<P: PixelFormat, F, D: DepthChoice, R: RecordsChoice> Drawable for FrameView<'_, '_, P, F, D, R>
where
    F: Fn(&mut Scene<'_, Strip<'_, P, D, R>>),
{
    type Color = P::Color;
    type Output = Result<Stats, FrameError>;

    /// Draws a frame. If a view's closure draws the view itself, that draws nothing.
    fn draw<T: DrawTarget<Color = P::Color>>(&self, target: &mut T) -> Result<Self::Output, T::Error> {
        let Some((renderer, buffer)) = self.tools.take() else {
            return Ok(Ok(Stats::default()));
        };
        let drawn = renderer.frame_at(target, self.area.top_left, buffer, self.background, &self.draw);
        self.tools.set(Some((renderer, buffer)));
        match drawn {
            Ok(stats) => Ok(Ok(stats)),
            Err(FrameError::Sink(error)) => Err(error),
            Err(FrameError::SceneChanged { draw }) => Ok(Err(FrameError::SceneChanged { draw })),
            Err(FrameError::BufferTooShort { pixels, needed }) => {
                Ok(Err(FrameError::BufferTooShort { pixels, needed }))
            }
        }
    }
}

impl<P: PixelFormat, F, D: DepthChoice, R> fmt::Debug for FrameView<'_, '_, P, F, D, R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FrameView").field("area", &self.area).finish_non_exhaustive()
    }
}
