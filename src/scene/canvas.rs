//! Drawing on the screen's plane: shapes come in by their positions on the screen, and go through the pipeline's set-up
//! and spans at once. Nothing is recorded.

use super::painter::RasterHooks;
use super::scene::Scene;
use super::state::{Cull, State};
use super::stroke::{Stroke, Thin, block};
use crate::color::{channels, packed};
use crate::math::Pixels;
use crate::raster::{PixelRect, pixel_rect, square};
use crate::shader::{Flat, Gouraud};
use crate::span::{DepthState, Shader};
use crate::target::Framebuffer;
use crate::vertex::ScreenVertex;
use embedded_graphics_core::geometry::Point;
use embedded_graphics_core::pixelcolor::Rgb888;
use embedded_graphics_core::primitives::Rectangle;

/// A point on the screen: x to the right and y down from the top left corner. The centre of a pixel is at .5.
///
/// ```
/// use zstrip::ScreenPoint;
/// use zstrip::embedded_graphics_core::geometry::Point;
/// use zstrip::math::Pixels;
/// assert_eq!(ScreenPoint::from(Point::new(3, 4)), ScreenPoint::center(3, 4));
/// assert_eq!(ScreenPoint::new(Pixels::from_num(3.5), Pixels::from_num(4.5)), ScreenPoint::center(3, 4));
/// assert_eq!(Point::from(ScreenPoint::corner(3, 4)), Point::new(3, 4));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScreenPoint {
    // Both coordinates are raw 24.8 px.
    x: i32,
    y: i32,
}

impl ScreenPoint {
    /// Makes a point from coordinates. Coordinates beyond ±32,767 px are clamped.
    #[must_use]
    pub const fn new(x: Pixels, y: Pixels) -> Self {
        Self::from_raw(x.to_bits(), y.to_bits())
    }

    /// Makes a point from raw 24.8 bits, clamped as in [`new`](Self::new).
    const fn from_raw(x: i32, y: i32) -> Self {
        const fn stop(c: i32) -> i32 {
            const LIMIT: i32 = (1 << 23) - 1;
            if c > LIMIT {
                LIMIT
            } else if c < -LIMIT {
                -LIMIT
            } else {
                c
            }
        }
        Self { x: stop(x), y: stop(y) }
    }

    /// Returns the top left corner of pixel (x, y): the place where a shape of whole pixels begins or ends.
    #[must_use]
    pub const fn corner(x: i16, y: i16) -> Self {
        Self::from_raw(256 * x as i32, 256 * y as i32)
    }

    /// Returns the centre of pixel (x, y): the place where a line begins or ends.
    #[must_use]
    pub const fn center(x: i16, y: i16) -> Self {
        Self::from_raw(256 * x as i32 + 128, 256 * y as i32 + 128)
    }

    /// Returns the distance from the left edge of the screen.
    #[must_use]
    pub const fn x(self) -> Pixels {
        Pixels::from_bits(self.x)
    }

    /// Returns the distance from the top edge of the screen.
    #[must_use]
    pub const fn y(self) -> Pixels {
        Pixels::from_bits(self.y)
    }
}

/// Takes the centre of a pixel. Coordinates beyond ±32,767 px are clamped.
impl From<Point> for ScreenPoint {
    fn from(pixel: Point) -> Self {
        let center = |c: i32| c.clamp(-(1 << 15), 1 << 15) * 256 + 128;
        Self::from_raw(center(pixel.x), center(pixel.y))
    }
}

/// Takes the position of a vertex, for shapes that are drawn about it.
impl From<ScreenVertex> for ScreenPoint {
    fn from(vertex: ScreenVertex) -> Self {
        Self::from_raw(vertex.x, vertex.y)
    }
}

/// Takes the pixel that a point lies in.
impl From<ScreenPoint> for Point {
    fn from(point: ScreenPoint) -> Self {
        Self::new(point.x >> 8, point.y >> 8)
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for ScreenPoint {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "({}, {})/256 px", self.x, self.y);
    }
}

/// A drawing surface on the screen's plane, see [`Scene::canvas`].
///
/// Coverage follows the rules that hold in space: shapes that share an edge leave no gap and draw no pixel twice.
/// Nothing is kept in the records: each call draws its shape, in each strip anew, and rejects it by its rows if it lies
/// outside of the strip.
#[derive(Debug)]
pub struct Canvas<'c, 'a, F> {
    scene: &'c mut Scene<'a, F>,
    /// Pixels of the strip that may be drawn; none while a band is recorded.
    clip: PixelRect,
    /// Pixels that may be drawn without a scissor.
    all: PixelRect,
    state: State,
    z: u16,
}

/// State in which neither depth nor winding matters.
const PAINTED: State = State { cull: Cull::None, depth: DepthState::OFF, ..State::DEFAULT };

impl<'a, F: Framebuffer> Scene<'a, F> {
    /// Returns a canvas to draw shapes on, over everything that was drawn before.
    ///
    /// ```
    /// # use embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
    /// # use zstrip::embedded_graphics_core::geometry::Size;
    /// # use zstrip::frame::Renderer;
    /// # use zstrip::target::StripPixels;
    /// use zstrip::{ScreenPoint, Smooth};
    /// # let mut color = [0; 64 * 8];
    /// # let mut renderer = Renderer::<Rgb565>::new(Size::new(64, 64))?;
    /// # let sink = |_: &StripPixels<Rgb565>| Ok::<(), core::convert::Infallible>(());
    /// renderer.frame_to(sink, &mut color, Rgb888::BLACK, |scene| {
    ///     let mut canvas = scene.canvas();
    ///     canvas.polygon(&[(4, 4), (60, 10), (30, 60)].map(|(x, y)| ScreenPoint::corner(x, y)), Rgb888::BLUE);
    ///     canvas.line_with(ScreenPoint::center(0, 0), ScreenPoint::center(50, 63), Rgb888::WHITE, &Smooth::px(3));
    /// }).unwrap();
    /// # Ok::<(), zstrip::frame::RendererError>(())
    /// ```
    pub fn canvas(&mut self) -> Canvas<'_, 'a, F> {
        self.canvas_with(0, DepthState::OFF)
    }

    /// Returns a canvas at a depth. A shape's pixel is drawn where this depth is nearer than the depth buffer's depth,
    /// and the depth buffer then takes this depth.
    ///
    /// [`project`](Self::project) tells the depth of a point. Without a depth buffer, this is [`canvas`](Self::canvas).
    pub fn canvas_at(&mut self, z: u16) -> Canvas<'_, 'a, F> {
        self.canvas_with(z, DepthState::LESS)
    }

    /// Returns a canvas at a depth, with any depth test.
    pub fn canvas_with(&mut self, z: u16, depth: DepthState) -> Canvas<'_, 'a, F> {
        let rows = if self.is_recording() { 0..0 } else { self.target.rows.clone() };
        let clip = self.clip_rect(&rows);
        Canvas { clip: clip.clone(), all: clip, scene: self, state: State { depth, ..PAINTED }, z }
    }
}

impl<F: Framebuffer> Canvas<'_, '_, F> {
    /// Sets another depth and another depth test for all that follows. The scissor stays.
    pub const fn set_depth(&mut self, z: u16, depth: DepthState) {
        self.z = z;
        self.state.depth = depth;
    }

    /// Limits all that follows to a rectangle, or removes the limit.
    pub fn set_scissor(&mut self, area: Option<&Rectangle>) {
        self.clip = area.map_or(self.all.clone(), |area| self.all.intersection(&pixels(area)));
    }

    /// Fills a rectangle of pixels.
    pub fn rectangle(&mut self, area: &Rectangle, color: impl Into<Rgb888>) {
        self.block(&pixels(area), color.into());
    }

    /// Draws a square with sides of `size`, as a marker.
    pub fn point(&mut self, center: ScreenPoint, size: Pixels, color: impl Into<Rgb888>) {
        self.block(&square((center.x, center.y), size.to_bits().max(0) as u32), color.into());
    }

    fn block(&mut self, rect: &PixelRect, color: Rgb888) {
        if rect.intersection(&self.clip).is_empty() {
            return;
        }
        let Self { scene, clip, state, z, .. } = self;
        let shader = Flat::unlit(color);
        block(
            &mut scene.painter(clip, state, &const { RasterHooks::ANY }, &shader),
            rect,
            *z,
            &[],
            packed(channels(color)),
        );
    }

    /// Fills a convex polygon, whose corners may go round either way.
    pub fn polygon(&mut self, corners: &[ScreenPoint], color: impl Into<Rgb888>) {
        let color = color.into();
        self.fan(corners, |corner| (*corner, []), &Flat::unlit(color), packed(channels(color)));
    }

    /// Fills a convex polygon with the colours of its corners. A polygon with more than three corners is drawn as a fan
    /// of triangles about the first corner.
    pub fn gradient(&mut self, corners: &[(ScreenPoint, Rgb888)]) {
        self.fan(corners, |(corner, color)| (*corner, Gouraud::varyings(*color)), &Gouraud::vertex_colors(), 0);
    }

    /// Fills a convex polygon with a shader. The shader's vertex stage is not called: its varyings are given at the
    /// corners, and `face` is its face word.
    pub fn polygon_with<S: Shader<F::Format>>(
        &mut self,
        corners: &[(ScreenPoint, S::Varyings)],
        shader: &S,
        face: u32,
    ) {
        self.fan(corners, |corner| *corner, shader, face);
    }

    #[inline(never)]
    fn fan<S: Shader<F::Format>, C>(
        &mut self,
        corners: &[C],
        corner: impl Fn(&C) -> (ScreenPoint, S::Varyings),
        shader: &S,
        face: u32,
    ) {
        let Self { scene, clip, state, z, .. } = self;
        let mut corners = corners.iter().map(|c| {
            let (at, varyings) = corner(c);
            (ScreenVertex::new(at.x, at.y, *z), varyings)
        });
        let (Some(first), Some(mut last)) = (corners.next(), corners.next()) else { return };
        for next in corners {
            let v = [first.0, last.0, next.0];
            if !pixel_rect(&v).intersection(clip).is_empty() {
                scene.painter(clip, state, &const { RasterHooks::ANY }, shader).triangle(
                    &v,
                    &[first.1, last.1, next.1],
                    face,
                );
            }
            last = next;
        }
    }

    /// Draws a line of one pixel's width, by the diamond-exit rule.
    pub fn line(&mut self, a: ScreenPoint, b: ScreenPoint, color: impl Into<Rgb888>) {
        self.line_with(a, b, color, &Thin);
    }

    /// Draws a line with any stroke.
    pub fn line_with(&mut self, a: ScreenPoint, b: ScreenPoint, color: impl Into<Rgb888>, stroke: &impl Stroke) {
        let color = color.into();
        self.segment(&[(a, []), (b, [])], &Flat::unlit(color), packed(channels(color)), stroke);
    }

    /// Draws a line that goes from one colour to another.
    pub fn gradient_line(&mut self, a: (ScreenPoint, Rgb888), b: (ScreenPoint, Rgb888), stroke: &impl Stroke) {
        let ends = [(a.0, Gouraud::varyings(a.1)), (b.0, Gouraud::varyings(b.1))];
        self.segment(&ends, &Gouraud::vertex_colors(), 0, stroke);
    }

    /// Draws lines from point to point. Thin lines draw the pixel of each joint once.
    pub fn polyline(&mut self, points: &[ScreenPoint], color: impl Into<Rgb888>, stroke: &impl Stroke) {
        let color = color.into();
        for (a, b) in points.iter().zip(points.get(1..).unwrap_or_default()) {
            self.line_with(*a, *b, color, stroke);
        }
    }

    /// Draws lines from point to point, and one from the last point to the first.
    pub fn outline(&mut self, points: &[ScreenPoint], color: impl Into<Rgb888>, stroke: &impl Stroke) {
        let color = color.into();
        self.polyline(points, color, stroke);
        if let (Some(first), Some(last)) = (points.first(), points.last()) {
            self.line_with(*last, *first, color, stroke);
        }
    }

    #[inline(never)]
    fn segment<S: Shader<F::Format>, K: Stroke>(
        &mut self,
        ends: &[(ScreenPoint, S::Varyings); 2],
        shader: &S,
        face: u32,
        stroke: &K,
    ) {
        let Self { scene, clip, state, z, .. } = self;
        let [(a, from), (b, to)] = ends;
        let reach = stroke.reach();
        let near = PixelRect {
            x: (a.x.min(b.x) >> 8) - reach..(a.x.max(b.x) >> 8) + reach + 1,
            y: (a.y.min(b.y) >> 8) - reach..(a.y.max(b.y) >> 8) + reach + 1,
        };
        if near.intersection(clip).is_empty() {
            return;
        }
        let ends = [(ScreenVertex::new(a.x, a.y, *z), *from), (ScreenVertex::new(b.x, b.y, *z), *to)];
        stroke.draw(&mut scene.painter(clip, state, &const { RasterHooks::ANY }, shader), &ends, face);
    }
}

/// Converts a rectangle of embedded-graphics. Parts beyond the largest possible screen are cut off.
fn pixels(area: &Rectangle) -> PixelRect {
    let side = |start: i32, size: u32| {
        let start = start.clamp(-65_536, 65_536);
        start..start + size.min(131_072) as i32
    };
    let Point { x, y } = area.top_left;
    PixelRect { x: side(x, area.size.width), y: side(y, area.size.height) }
}
