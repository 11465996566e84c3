//! Paths: contours of straight lines through given points, and contours of lines and curves, which may be placed,
//! turned and scaled.

use super::arc::{direction, times};
use super::round::{around_all, pixels, place};
use crate::math::{Angle16, Pixels, Scalar};
use crate::raster::FillRule;
use crate::scene::{Outline, Pen, Place, ScreenPoint};
use embedded_graphics_core::primitives::Rectangle;

/// A polygon of any shape: it may cross itself, have several contours, and holes.
///
/// ```
/// use zstrip::ScreenPoint;
/// use zstrip::shape::{FillRule, Path};
/// let star = [(50, 0), (80, 90), (0, 35), (100, 35), (20, 90)].map(|(x, y)| ScreenPoint::corner(x, y));
/// let contours = [&star[..]];
/// let star = Path::new(&contours);
/// let hollow = Path::new(&contours).with_rule(FillRule::EvenOdd);
/// # let _ = (star, hollow);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Path<'a> {
    contours: &'a [&'a [ScreenPoint]],
    rule: FillRule,
}

impl<'a> Path<'a> {
    /// Makes a path of contours, each of which is closed.
    #[must_use]
    pub const fn new(contours: &'a [&'a [ScreenPoint]]) -> Self {
        Self { contours, rule: FillRule::NonZero }
    }

    /// Returns the path with another fill rule.
    #[must_use]
    pub const fn with_rule(self, rule: FillRule) -> Self {
        Self { rule, ..self }
    }
}

impl Outline for Path<'_> {
    fn trace(&self, pen: &mut Pen<'_, '_>) {
        for contour in self.contours {
            if let Some((first, rest)) = contour.split_first() {
                pen.move_to(*first);
                for point in rest {
                    pen.line_to(*point);
                }
            }
        }
    }

    fn rule(&self) -> FillRule {
        self.rule
    }

    fn bounds(&self) -> Option<Rectangle> {
        around_all(self.contours.iter().flat_map(|contour| contour.iter().copied().map(place)), 0)
    }
}

/// A step of a [`CurvePath`], from where the one before has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathStep {
    /// Closes the contour, and begins another one at a point.
    Move(ScreenPoint),
    /// A straight line to a point.
    Line(ScreenPoint),
    /// A curve of the second degree: its control point, and the point that it goes to. TrueType fonts have these.
    Quad(ScreenPoint, ScreenPoint),
    /// A Bézier curve of the third degree: its two control points, and the point that it goes to. Icons have these.
    Cubic(ScreenPoint, ScreenPoint, ScreenPoint),
}

/// A shape of lines and curves, such as an icon or a glyph: its steps may lie in flash, around a point of their own. It
/// is placed, turned and scaled when it is drawn.
///
/// Curves are drawn as chords, as many as their bend takes on the screen: they are within 1/64 px of the curves, within
/// ±32,767 px.
///
/// ```
/// use zstrip::ScreenPoint;
/// use zstrip::math::{Angle16, Scalar};
/// use zstrip::shape::{CurvePath, PathStep};
/// const fn at(x: i16, y: i16) -> ScreenPoint {
///     ScreenPoint::corner(x, y)
/// }
/// static DROP: [PathStep; 4] = [
///     PathStep::Move(at(0, -20)),
///     PathStep::Quad(at(4, -10), at(9, -4)),
///     PathStep::Cubic(at(24, 18), at(-24, 18), at(-9, -4)),
///     PathStep::Quad(at(-4, -10), at(0, -20)),
/// ];
/// let drop = CurvePath::new(&DROP).at(at(50, 60)).turned(Angle16::from_degrees(30)).scaled(Scalar::from_num(1.5));
/// // canvas.fill(&drop, color, &mut buffer);
/// # let _ = drop;
/// ```
#[derive(Clone, Copy, Debug)]
pub struct CurvePath<'a> {
    steps: &'a [PathStep],
    rule: FillRule,
    at: ScreenPoint,
    angle: Angle16,
    scale: Scalar,
}

/// Largest coordinate of a point that was scaled, 16.16 px.
const FARTHEST: i64 = 1 << 39;

impl<'a> CurvePath<'a> {
    /// Makes a path of steps, around the upper left corner of the screen. Contours close by themselves. Steps before
    /// the first [`PathStep::Move`] go on from the path's point (0, 0).
    #[must_use]
    pub const fn new(steps: &'a [PathStep]) -> Self {
        Self { steps, rule: FillRule::NonZero, at: ScreenPoint::corner(0, 0), angle: Angle16::ZERO, scale: Scalar::ONE }
    }

    /// Returns the path with another fill rule.
    #[must_use]
    pub const fn with_rule(self, rule: FillRule) -> Self {
        Self { rule, ..self }
    }

    /// Returns the path with its point (0, 0) at another place of the screen.
    #[must_use]
    pub const fn at(self, at: ScreenPoint) -> Self {
        Self { at, ..self }
    }

    /// Returns the path turned clockwise around its point (0, 0).
    #[must_use]
    pub const fn turned(self, angle: Angle16) -> Self {
        Self { angle, ..self }
    }

    /// Returns the path at a scale, around its point (0, 0). A negative one turns it by half a turn.
    #[must_use]
    pub const fn scaled(self, scale: Scalar) -> Self {
        Self { scale, ..self }
    }

    /// Hands over the steps, where they are on the screen.
    fn each_step(&self, mut each: impl FnMut(Step)) {
        let center = place(self.at);
        let [cosine, sine] = direction(self.angle);
        // 24.8 times 16.16 is below 2⁶². With both, a place is below 2⁴⁰·⁵.
        let scaled = |c: Pixels| {
            let place = (i64::from(c.to_bits()) * i64::from(self.scale.to_bits())) >> 8;
            place.clamp(-FARTHEST, FARTHEST)
        };
        let is_turned = self.angle != Angle16::ZERO;
        let on_screen = |point: ScreenPoint| {
            let (x, y) = (scaled(point.x()), scaled(point.y()));
            let [x, y] =
                if is_turned { [times(x, cosine) - times(y, sine), times(x, sine) + times(y, cosine)] } else { [x, y] };
            [center[0] + x, center[1] + y]
        };
        if !matches!(self.steps.first(), Some(PathStep::Move(_)) | None) {
            each(Step::Move(center));
        }
        for step in self.steps {
            each(match *step {
                PathStep::Move(to) => Step::Move(on_screen(to)),
                PathStep::Line(to) => Step::Line(on_screen(to)),
                PathStep::Quad(control, to) => Step::Quad(on_screen(control), on_screen(to)),
                PathStep::Cubic(first, second, to) => Step::Cubic(on_screen(first), on_screen(second), on_screen(to)),
            });
        }
    }
}

/// A step in 16.16 px.
enum Step {
    Move(Place),
    Line(Place),
    Quad(Place, Place),
    Cubic(Place, Place, Place),
}

impl Outline for CurvePath<'_> {
    fn trace(&self, pen: &mut Pen<'_, '_>) {
        self.each_step(|step| match step {
            Step::Move(to) => pen.move_to_place(to),
            Step::Line(to) => pen.line_to_place(to),
            Step::Quad(control, to) => pen.quad_to_place(control, to),
            Step::Cubic(first, second, to) => pen.cubic_to_place(first, second, to),
        });
    }

    fn rule(&self) -> FillRule {
        self.rule
    }

    fn bounds(&self) -> Option<Rectangle> {
        // A curve is inside of the polygon of its points.
        let (mut least, mut most) = ([i64::MAX; 2], [i64::MIN; 2]);
        let mut meets = |p: Place| {
            least = [least[0].min(p[0]), least[1].min(p[1])];
            most = [most[0].max(p[0]), most[1].max(p[1])];
        };
        self.each_step(|step| match step {
            Step::Move(to) | Step::Line(to) => meets(to),
            Step::Quad(control, to) => [control, to].into_iter().for_each(&mut meets),
            Step::Cubic(first, second, to) => [first, second, to].into_iter().for_each(&mut meets),
        });
        // No screen is that large.
        let near = |c: i64| c.clamp(-(32_767 << 16), 32_767 << 16);
        if self.steps.is_empty() { None } else { Some(pixels(least.map(near), most.map(near))) }
    }
}
