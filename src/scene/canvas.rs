//! Drawing on the screen's plane: shapes come in by their positions on the screen, and go through the pipeline's set-up
//! and spans at once. Nothing is recorded.

use super::painter::RasterHooks;
use super::scene::Scene;
use super::state::{Cull, State};
use super::stroke::{Stroke, Thin, block};
use crate::color::{channels, packed};
use crate::math::Pixels;
use crate::raster::{PixelRect, pixel_rect, wide_square};
use crate::shader::{Flat, Gouraud};
use crate::span::{DepthState, Shader};
use crate::target::Framebuffer;
use crate::vertex::{
    ClipCorner, ClipVertex, DepthSlab, Outcode, ScreenVertex, Varyings, clip_line, clip_triangle, project, weighted,
};
use embedded_graphics_core::geometry::Point;
use embedded_graphics_core::pixelcolor::Rgb888;
use embedded_graphics_core::primitives::Rectangle;
use heapless::Vec;

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
    /// Makes a point from coordinates. It may be as far off the screen as [`Pixels`] can tell: shapes are cut along
    /// their edges, within 1/256 px, where they leave ±32,767 px.
    #[must_use]
    pub const fn new(x: Pixels, y: Pixels) -> Self {
        Self { x: x.to_bits(), y: y.to_bits() }
    }

    /// Returns the top left corner of pixel (x, y): the place where a shape of whole pixels begins or ends.
    #[must_use]
    pub const fn corner(x: i16, y: i16) -> Self {
        Self { x: 256 * x as i32, y: 256 * y as i32 }
    }

    /// Returns the centre of pixel (x, y): the place where a line begins or ends. A thin line does not draw the pixel
    /// that it ends in, see [`Thin`].
    #[must_use]
    pub const fn center(x: i16, y: i16) -> Self {
        Self { x: 256 * x as i32 + 128, y: 256 * y as i32 + 128 }
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

/// Takes the centre of a pixel. Coordinates beyond ±8,388,607 px, the largest [`Pixels`], are clamped.
impl From<Point> for ScreenPoint {
    fn from(pixel: Point) -> Self {
        let center = |c: i32| c.clamp(-(1 << 23), (1 << 23) - 1) * 256 + 128;
        Self { x: center(pixel.x), y: center(pixel.y) }
    }
}

/// Takes the position of a vertex, for shapes that are drawn about it.
impl From<ScreenVertex> for ScreenPoint {
    fn from(vertex: ScreenVertex) -> Self {
        Self { x: vertex.x, y: vertex.y }
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

impl ScreenPoint {
    /// Returns the point as a vertex, for points inside of the guard band.
    pub(super) const fn vertex(self, z: u16) -> ScreenVertex {
        ScreenVertex::new(self.x, self.y, z)
    }

    /// Returns the point in clip space, where shapes are cut at the guard band as triangles of meshes are.
    ///
    /// # Format
    /// Clip space counts in units of 512 px, 2¹⁷ in 24.8. With a w of 2⁴⁰, coordinates are at most 2⁵⁴.
    const fn clip_vertex(self) -> ClipVertex {
        ClipVertex { x: (self.x as i64) << 23, y: (self.y as i64) << 23, z: 0, w: 1 << 40 }
    }

    /// Returns the sides of the guard band that the point is outside of.
    #[inline]
    pub(super) fn outcode(self) -> Outcode {
        // Nearly all points are inside. The guard band ends at 2²³ - 2.
        if self.x.unsigned_abs().max(self.y.unsigned_abs()) < (1 << 23) - 2 {
            return Outcode(0);
        }
        Outcode::of(&self.clip_vertex())
    }
}

/// A corner of a shape that was cut, and the weights of the original corners.
type CutCorner = (ScreenVertex, [i32; 3]);

/// Returns a corner of a shape that was cut, at a depth.
fn cut_corner(corner: &ClipCorner, z: u16) -> Option<CutCorner> {
    let ScreenVertex { x, y, .. } = project(&corner.vertex)?;
    Some((ScreenVertex::new(x, y, z), corner.weights))
}

/// Number of corners of a triangle that was cut by the four sides of the guard band.
const CUT_CORNERS: usize = 7;

/// Cuts a triangle at the guard band. Out of line, so that its polygon is not on the stack while pixels are drawn.
#[inline(never)]
fn cut_triangle(points: [ScreenPoint; 3], codes: Outcode, z: u16) -> Vec<CutCorner, CUT_CORNERS> {
    let mut corners = Vec::new();
    clip_triangle(points.map(ScreenPoint::clip_vertex), codes, DepthSlab::Inside, |corner| {
        if let Some(corner) = cut_corner(corner, z) {
            let _ = corners.push(corner);
        }
    });
    corners
}

/// A drawing surface on the screen's plane, see [`Scene::canvas`].
///
/// Coverage follows the rules that hold in space: shapes that share an edge leave no gap and draw no pixel twice.
/// Nothing is kept in the records: each call draws its shape, in each strip anew, and rejects it by its rows if it lies
/// outside of the strip.
#[derive(Debug)]
pub struct Canvas<'c, 'a, F> {
    pub(super) scene: &'c mut Scene<'a, F>,
    /// Pixels of the strip that may be drawn; none while a band is recorded.
    pub(super) clip: PixelRect,
    /// Pixels that may be drawn without a scissor.
    all: PixelRect,
    pub(super) state: State,
    pub(super) z: u16,
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

    /// Returns a canvas at a depth. A shape's pixel is drawn where nothing is nearer than this depth, and the depth
    /// buffer then takes this depth. So shapes at one depth cover each other in their order.
    ///
    /// [`project`](Self::project) tells the depth of a point. Without a depth buffer, this is [`canvas`](Self::canvas).
    pub fn canvas_at(&mut self, z: u16) -> Canvas<'_, 'a, F> {
        self.canvas_with(z, DepthState::LESS_EQUAL)
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
        self.clip = area.map_or(self.all.clone(), |area| self.all.intersection(&PixelRect::of_area(area)));
    }

    /// Fills a rectangle of pixels.
    pub fn rectangle(&mut self, area: &Rectangle, color: impl Into<Rgb888>) {
        self.block(&PixelRect::of_area(area), color.into());
    }

    /// Draws a square with sides of `size`, as a marker.
    pub fn point(&mut self, center: ScreenPoint, size: Pixels, color: impl Into<Rgb888>) {
        self.block(&wide_square((center.x, center.y), size.to_bits().max(0) as u32), color.into());
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
    /// corners, and `face` is its face word, see [`VertexShader::shape`](crate::vertex::VertexShader::shape).
    ///
    /// All corners are at one depth, so [`Perspective`](crate::vertex::Perspective) varyings are linear on the screen.
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
        let mut corners = corners.iter().map(corner);
        let face = shader.shape(face);
        let (Some(first), Some(mut last)) = (corners.next(), corners.next()) else { return };
        for next in corners {
            let [a, b, c] = [first.0, last.0, next.0];
            let codes = [a, b, c].map(|point| point.outcode().0);
            let varyings = [first.1, last.1, next.1];
            if codes == [0; 3] {
                self.triangle(&[a.vertex(self.z), b.vertex(self.z), c.vertex(self.z)], &varyings, shader, face);
            } else if codes[0] & codes[1] & codes[2] == 0 {
                self.far_triangle([a, b, c], Outcode(codes[0] | codes[1] | codes[2]), &varyings, shader, face);
            }
            last = next;
        }
    }

    /// Draws a triangle whose corners are inside of the guard band.
    fn triangle<S: Shader<F::Format>>(
        &mut self,
        v: &[ScreenVertex; 3],
        varyings: &[S::Varyings; 3],
        shader: &S,
        face: u32,
    ) {
        let Self { scene, clip, state, .. } = self;
        if !pixel_rect(v, F::SAMPLES).intersection(clip).is_empty() {
            let mut varyings = varyings.map(level);
            scene.painter(clip, state, &const { RasterHooks::ANY }, shader).triangle(
                &mut v.clone(),
                &mut varyings,
                face,
            );
        }
    }

    /// Draws a triangle with corners outside of the guard band: the polygon that is left of it, as a fan.
    #[inline(never)]
    fn far_triangle<S: Shader<F::Format>>(
        &mut self,
        points: [ScreenPoint; 3],
        codes: Outcode,
        varyings: &[S::Varyings; 3],
        shader: &S,
        face: u32,
    ) {
        let cut = cut_triangle(points, codes, self.z);
        let mut corners = cut.iter();
        let (Some(a), Some(mut b)) = (corners.next(), corners.next()) else { return };
        for c in corners {
            let varyings = [a, b, c].map(|(_, weights)| weighted(weights, varyings));
            self.triangle(&[a.0, b.0, c.0], &varyings, shader, face);
            b = c;
        }
    }

    /// Draws a line of one pixel's width, by the diamond-exit rule: without the pixel that it ends in. See [`Thin`].
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

    /// Draws lines from point to point. Thin lines draw the pixel of each joint once, and not that of the last point.
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

    /// Draws a line with a shader, and with any stroke. The shader's vertex stage is not called: its varyings are given
    /// at the ends, and `face` is its face word, as in [`polygon_with`](Self::polygon_with).
    pub fn shaded_line<S: Shader<F::Format>>(
        &mut self,
        ends: &[(ScreenPoint, S::Varyings); 2],
        shader: &S,
        face: u32,
        stroke: &impl Stroke,
    ) {
        self.segment(ends, shader, face, stroke);
    }

    #[inline(never)]
    fn segment<S: Shader<F::Format>, K: Stroke>(
        &mut self,
        ends: &[(ScreenPoint, S::Varyings); 2],
        shader: &S,
        face: u32,
        stroke: &K,
    ) {
        let [(a, from), (b, to)] = *ends;
        let face = shader.shape(face);
        let codes = [a, b].map(|point| point.outcode().0);
        if codes == [0; 2] {
            self.near_segment(&[(a.vertex(self.z), from), (b.vertex(self.z), to)], shader, face, stroke);
        } else if codes[0] & codes[1] == 0 {
            let vertices = [a.clip_vertex(), b.clip_vertex()];
            let Some([start, end]) = clip_line(vertices, Outcode(codes[0] | codes[1]), DepthSlab::Inside) else {
                return;
            };
            let (Some(start), Some(end)) = (cut_corner(&start, self.z), cut_corner(&end, self.z)) else { return };
            // Pixels of the line, along its longer axis, up to the cut.
            let steep = b.y.abs_diff(a.y) > b.x.abs_diff(a.x);
            let (from_pixel, to_pixel) = if steep { (a.y >> 8, start.0.y >> 8) } else { (a.x >> 8, start.0.x >> 8) };
            let stroke = stroke.after(to_pixel.abs_diff(from_pixel));
            let ends = [start, end].map(|(vertex, weights)| (vertex, weighted(&weights, &[from, to, to])));
            self.near_segment(&ends, shader, face, &stroke);
        }
    }

    /// Draws a line whose ends are inside of the guard band.
    fn near_segment<S: Shader<F::Format>, K: Stroke>(
        &mut self,
        ends: &[(ScreenVertex, S::Varyings); 2],
        shader: &S,
        face: u32,
        stroke: &K,
    ) {
        let Self { scene, clip, state, .. } = self;
        let [(a, from), (b, to)] = ends;
        let reach = stroke.reach();
        let near = PixelRect {
            x: (a.x.min(b.x) >> 8) - reach..(a.x.max(b.x) >> 8) + reach + 1,
            y: (a.y.min(b.y) >> 8) - reach..(a.y.max(b.y) >> 8) + reach + 1,
        };
        if !near.intersection(clip).is_empty() {
            let ends = [(*a, level(*from)), (*b, level(*to))];
            stroke.draw(&mut scene.painter(clip, state, &const { RasterHooks::ANY }, shader), &ends, face);
        }
    }
}

/// Gives varyings the 1 / w that all points of a canvas have.
#[inline]
pub(super) fn level<V: Varyings>(mut varyings: V) -> V {
    varyings.set_inverse_w(1 << 31);
    varyings
}
