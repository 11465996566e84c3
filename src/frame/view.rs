//! 3-D among embedded-graphics' own things: a frame as something that can be drawn.

use super::renderer::{FrameError, Renderer};
use crate::color::PixelFormat;
use crate::scene::Scene;
use crate::target::{Stats, Strip};
use core::cell::Cell;
use core::fmt;
use embedded_graphics_core::Drawable;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Dimensions, Point, Size};
use embedded_graphics_core::primitives::Rectangle;

/// A renderer and what it draws as an embedded-graphics `Drawable`: a rectangle with 3-D in it, for any display and for any
/// code that draws or lays out drawables.
///
/// Its `Output` tells [`Stats`], or that the closure drew two different things.
///
/// ```
/// # use embedded_graphics::{mock_display::MockDisplay, pixelcolor::Rgb565, prelude::*};
/// # use zstrip::shader::Flat;
/// # use zstrip::mesh::{Mesh, MeshData, Positions};
/// # use zstrip::math::{Projective, Vec3};
/// # use zstrip::{Buffers, Renderer};
/// # use zstrip::frame::FrameView;
/// # static CORNERS: [Vec3; 3] = [Vec3::from_ints(-1, -1, 0), Vec3::from_ints(1, -1, 0), Vec3::from_ints(0, 1, 0)];
/// # static TRIANGLE: Mesh<'static> = Mesh::constant(MeshData::new(Positions::Exact(&CORNERS)));
/// # let mut display = MockDisplay::<Rgb565>::new();
/// // A view of 24×16 pixels in strips of 4 rows.
/// let (color, depth, records) = (&mut [0; 24 * 4], &mut [0; 24 * 4], &mut [0; 64]);
/// let mut renderer = Renderer::<Rgb565>::new((24, 16), Buffers { color, depth, records })?;
/// let shader = Flat::unlit(embedded_graphics::pixelcolor::Rgb888::CSS_ORANGE);
/// let view = FrameView::new(&mut renderer, Point::new(30, 10), Rgb565::BLACK, |scene| {
///     scene.draw(&TRIANGLE, &Projective::IDENTITY, &shader);
/// });
/// let stats = view.draw(&mut display)??;
/// assert_eq!((stats.strips, stats.drawn), (4, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct FrameView<'v, 'b, P: PixelFormat, F, const DEPTH: bool = true, const RECORDS: bool = true> {
    /// Taken out while it draws: `draw` has only a shared reference.
    renderer: Cell<Option<&'v mut Renderer<'b, P, DEPTH, RECORDS>>>,
    area: Rectangle,
    background: P::Color,
    draw: F,
}

impl<'v, 'b, P: PixelFormat, F, const DEPTH: bool, const RECORDS: bool> FrameView<'v, 'b, P, F, DEPTH, RECORDS>
where
    F: Fn(&mut Scene<'_, Strip<'_, P, DEPTH, RECORDS>>),
{
    /// The renderer's whole screen, with its corner at `top_left` of whatever it is drawn on.
    pub fn new(
        renderer: &'v mut Renderer<'b, P, DEPTH, RECORDS>,
        top_left: Point,
        background: P::Color,
        draw: F,
    ) -> Self {
        let (width, height) = renderer.screen();
        let area = Rectangle::new(top_left, Size::new(u32::from(width), u32::from(height)));
        Self { renderer: Cell::new(Some(renderer)), area, background, draw }
    }
}

impl<P: PixelFormat, F, const DEPTH: bool, const RECORDS: bool> Dimensions for FrameView<'_, '_, P, F, DEPTH, RECORDS> {
    fn bounding_box(&self) -> Rectangle {
        self.area
    }
}

impl<P: PixelFormat, F, const DEPTH: bool, const RECORDS: bool> Drawable for FrameView<'_, '_, P, F, DEPTH, RECORDS>
where
    F: Fn(&mut Scene<'_, Strip<'_, P, DEPTH, RECORDS>>),
{
    type Color = P::Color;
    type Output = Result<Stats, FrameError>;

    /// Draws a frame. A view that its own closure draws draws nothing.
    fn draw<D: DrawTarget<Color = P::Color>>(&self, target: &mut D) -> Result<Self::Output, D::Error> {
        let Some(renderer) = self.renderer.take() else {
            return Ok(Ok(Stats::default()));
        };
        let drawn = renderer.frame_at(target, self.area.top_left, self.background, &self.draw);
        self.renderer.set(Some(renderer));
        match drawn {
            Ok(stats) => Ok(Ok(stats)),
            Err(FrameError::Sink(error)) => Err(error),
            Err(FrameError::SceneChanged(draw)) => Ok(Err(FrameError::SceneChanged(draw))),
        }
    }
}

impl<P: PixelFormat, F, const DEPTH: bool, const RECORDS: bool> fmt::Debug for FrameView<'_, '_, P, F, DEPTH, RECORDS> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FrameView").field("area", &self.area).finish_non_exhaustive()
    }
}
