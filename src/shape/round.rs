//! Round shapes: circles, ellipses, and parts of rings.

use super::arc::{Curve, direction, times};
use crate::math::{Angle16, Pixels};
use crate::scene::{Outline, Pen, Place, ScreenPoint};
use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::primitives::Rectangle;

/// Returns a length in 16.16 px.
pub(super) fn length(length: Pixels) -> i64 {
    i64::from(length.to_bits().max(0)) << 8
}

/// Returns a point in 16.16 px.
pub(super) fn place(point: ScreenPoint) -> Place {
    [point.x(), point.y()].map(|c| i64::from(c.to_bits()) << 8)
}

/// Returns the pixels around places, of which none is farther away than `reach`; `None` without places.
pub(super) fn around_all(places: impl Iterator<Item = Place>, reach: i64) -> Option<Rectangle> {
    let (mut least, mut most) = ([i64::MAX; 2], [i64::MIN; 2]);
    for [x, y] in places {
        least = [least[0].min(x), least[1].min(y)];
        most = [most[0].max(x), most[1].max(y)];
    }
    // No screen is that large.
    let near = |c: i64| c.clamp(-(32_767 << 16), 32_767 << 16);
    let is_any = least[0] <= most[0];
    is_any.then(|| pixels(least.map(|c| near(c - reach)), most.map(|c| near(c + reach))))
}

/// Returns the pixels around a rectangle in 16.16 px, with a pixel more at each side.
pub(super) fn pixels(from: Place, to: Place) -> Rectangle {
    let [x, y] = from.map(|c| (c >> 16) as i32 - 1);
    let [right, bottom] = to.map(|c| (c >> 16) as i32 + 2);
    Rectangle::new(Point::new(x, y), Size::new(right.abs_diff(x), bottom.abs_diff(y)))
}

fn around(center: Place, radii: [i64; 2]) -> Rectangle {
    pixels([center[0] - radii[0], center[1] - radii[1]], [center[0] + radii[0], center[1] + radii[1]])
}

/// A disc of any radius. All round shapes are exact for radii up to 4,096 px, within 1/32 px up to 32,767 px, and
/// angular beyond. Negative radii are 0.
///
/// ```
/// use zstrip::ScreenPoint;
/// use zstrip::math::Pixels;
/// use zstrip::shape::Circle;
/// // 9 px wide, around the corner that four pixels share.
/// let circle = Circle::new(ScreenPoint::corner(20, 30), Pixels::from_num(4.5));
/// # let _ = circle;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Circle {
    center: ScreenPoint,
    radius: Pixels,
}

impl Circle {
    /// Makes a disc.
    #[must_use]
    pub const fn new(center: ScreenPoint, radius: Pixels) -> Self {
        Self { center, radius }
    }
}

impl Outline for Circle {
    fn trace(&self, pen: &mut Pen<'_, '_>) {
        Ellipse::new(self.center, self.radius, self.radius).trace(pen);
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn bounds(&self) -> Option<Rectangle> {
        Ellipse::new(self.center, self.radius, self.radius).bounds()
    }
}

/// An ellipse. Its axes are those of the screen, unless it is turned.
///
/// ```
/// use zstrip::ScreenPoint;
/// use zstrip::math::{Angle16, Pixels};
/// use zstrip::shape::Ellipse;
/// let orbit = Ellipse::new(ScreenPoint::corner(60, 60), Pixels::from_num(50), Pixels::from_num(20));
/// let orbit = orbit.turned(Angle16::from_degrees(-25));
/// # let _ = orbit;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ellipse {
    center: ScreenPoint,
    radii: [Pixels; 2],
    angle: Angle16,
}

/// Distance of an arc's control points from its ends, for a sixteenth of a turn of the circle of radius 1, in 2.30:
/// 4/3 tan(π / 32).
const CONTROL: i32 = 141_005_785;

impl Ellipse {
    /// Makes an ellipse of the radii along x and along y.
    #[must_use]
    pub const fn new(center: ScreenPoint, x: Pixels, y: Pixels) -> Self {
        Self { center, radii: [x, y], angle: Angle16::ZERO }
    }

    /// Returns the ellipse turned clockwise around its centre.
    #[must_use]
    pub const fn turned(self, angle: Angle16) -> Self {
        Self { angle, ..self }
    }

    /// Draws a turned ellipse as 16 curves of the third degree, which are within 1/500 px of it up to a radius of
    /// 16,384 px.
    fn trace_turned(&self, pen: &mut Pen<'_, '_>) {
        let (center, radii, axis) = (place(self.center), self.radii.map(length), direction(self.angle));
        let turned = |x: i64, y: i64| [times(x, axis[0]) - times(y, axis[1]), times(x, axis[1]) + times(y, axis[0])];
        // A point, and its distance from both of its control points.
        let at = |number: u16| {
            let [cosine, sine] = direction(Angle16(number << 12));
            let point = turned(times(radii[0], cosine), times(radii[1], sine));
            let way = turned(times(times(radii[0], -sine), CONTROL), times(times(radii[1], cosine), CONTROL));
            ([center[0] + point[0], center[1] + point[1]], way)
        };
        let (mut from, mut way) = at(0);
        pen.move_to_place(from);
        for number in 1..=16 {
            let (to, last) = at(number & 15);
            pen.cubic_to_place([from[0] + way[0], from[1] + way[1]], [to[0] - last[0], to[1] - last[1]], to);
            (from, way) = (to, last);
        }
    }
}

impl Outline for Ellipse {
    fn trace(&self, pen: &mut Pen<'_, '_>) {
        if self.angle == Angle16::ZERO {
            Curve::new(place(self.center), self.radii.map(length)).whole(pen, true);
        } else {
            self.trace_turned(pen);
        }
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn bounds(&self) -> Option<Rectangle> {
        let radii = self.radii.map(length);
        if self.angle == Angle16::ZERO {
            return Some(around(place(self.center), radii));
        }
        // No farther than the greater radius, nor than the sum of what both radii reach.
        let [cosine, sine] = direction(self.angle).map(i32::abs);
        let most = radii[0].max(radii[1]);
        let reach = |a: i32, b: i32| most.min(times(radii[0], a) + times(radii[1], b) + 2);
        Some(around(place(self.center), [reach(cosine, sine), reach(sine, cosine)]))
    }
}

/// A ring, or a part of one: an arc of some width. With an inner radius of 0, it is a disc or a pie.
///
/// Angles begin at the right and grow clockwise, as those of a clock do: the top is at 270°.
///
/// ```
/// use zstrip::ScreenPoint;
/// use zstrip::math::{Angle16, Pixels};
/// use zstrip::shape::Ring;
/// let center = ScreenPoint::corner(60, 60);
/// // The scale of a gauge, open below, and its lower three quarters with round ends.
/// let scale = Ring::new(center, Pixels::from_num(50), Pixels::from_num(44));
/// let scale = scale.part(Angle16::from_degrees(135), Ring::degrees(270));
/// let value = scale.part(Angle16::from_degrees(135), Ring::degrees(200)).with_round_ends();
/// let pie = Ring::pie(center, Pixels::from_num(30), Angle16::from_degrees(-90), Ring::degrees(120));
/// # let _ = (scale, value, pie);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ring {
    center: ScreenPoint,
    outer: Pixels,
    inner: Pixels,
    from: Angle16,
    /// In 65,536ths of a turn; a whole turn has no ends.
    sweep: i32,
    round: bool,
}

impl Ring {
    /// Sweep of a whole turn.
    pub const TURN: i32 = 1 << 16;

    /// Makes a whole ring between two radii, in either order.
    #[must_use]
    pub const fn new(center: ScreenPoint, outer: Pixels, inner: Pixels) -> Self {
        let (outer, inner) = if outer.to_bits() < inner.to_bits() { (inner, outer) } else { (outer, inner) };
        Self { center, outer, inner, from: Angle16::ZERO, sweep: Self::TURN, round: false }
    }

    /// Makes a pie: a part of a disc between two radii, `sweep` 65,536ths of a turn apart.
    #[must_use]
    pub const fn pie(center: ScreenPoint, radius: Pixels, from: Angle16, sweep: i32) -> Self {
        Self::new(center, radius, Pixels::ZERO).part(from, sweep)
    }

    /// Returns the sweep of a number of degrees, for [`part`](Self::part): up to 360 either way.
    #[must_use]
    pub const fn degrees(degrees: i32) -> i32 {
        let within = if degrees > 360 {
            360
        } else if degrees < -360 {
            -360
        } else {
            degrees
        };
        (within * Self::TURN) / 360
    }

    /// Returns the part of the ring that begins at an angle and goes on clockwise, by a sweep in 65,536ths of a turn.
    /// A negative sweep goes counter-clockwise. One of a turn or more is the whole ring, and one of 0 nothing.
    #[must_use]
    pub const fn part(self, from: Angle16, sweep: i32) -> Self {
        let (from, sweep) = if sweep < 0 {
            (Angle16(from.0.wrapping_add(sweep as u16)), sweep.saturating_neg())
        } else {
            (from, sweep)
        };
        Self { from, sweep: if sweep > Self::TURN { Self::TURN } else { sweep }, ..self }
    }

    /// Returns the ring with half discs at both of its ends.
    #[must_use]
    pub const fn with_round_ends(self) -> Self {
        Self { round: true, ..self }
    }
}

impl Outline for Ring {
    fn trace(&self, pen: &mut Pen<'_, '_>) {
        let (center, outer, inner) = (place(self.center), length(self.outer), length(self.inner));
        let (outside, inside) = (Curve::new(center, [outer; 2]), Curve::new(center, [inner; 2]));
        let sweep = self.sweep as u32;
        if self.sweep >= Self::TURN {
            outside.whole(pen, true);
            if inner > 0 {
                inside.whole(pen, false);
            }
            return;
        }
        if sweep == 0 {
            return;
        }
        let (start, end) = (direction(self.from), direction(Angle16(self.from.0.wrapping_add(sweep as u16))));
        // Half discs at the ends, around the middle of the ring.
        let cap = |at: [i32; 2]| {
            let middle = (outer + inner) >> 1;
            let center = [center[0] + times(middle, at[0]), center[1] + times(middle, at[1])];
            Curve::new(center, [(outer - inner) >> 1; 2])
        };
        let back = |at: [i32; 2]| at.map(|c| -c);
        pen.move_to_place(outside.point(start));
        outside.sweep(pen, self.from, sweep);
        if self.round {
            cap(end).arc(pen, end, back(end));
        }
        pen.line_to_place(inside.point(end));
        if inner > 0 {
            inside.sweep_back(pen, self.from, sweep);
        }
        if self.round {
            cap(start).arc(pen, back(start), start);
        }
    }

    fn is_convex(&self) -> bool {
        self.inner <= Pixels::ZERO && !self.round && (self.sweep <= Self::TURN / 2 || self.sweep >= Self::TURN)
    }

    fn is_apart(&self) -> bool {
        // Seen from the centre, a half disc at an end reaches as far as the angle whose sine is half of the width over
        // the middle radius: up to a quarter of a turn, and up to a twelfth where that is half or less.
        let is_narrow = self.outer.to_bits() >> 2 <= (self.inner.to_bits() >> 2).saturating_mul(3);
        let ends_are_apart = self.sweep <= Self::TURN / 2 || is_narrow && self.sweep <= Self::TURN / 6 * 5;
        !self.round || self.sweep >= Self::TURN || ends_are_apart
    }

    fn bounds(&self) -> Option<Rectangle> {
        Some(around(place(self.center), [length(self.outer); 2]))
    }
}

/// A rectangle whose sides may lie between pixels, with round corners or without.
///
/// ```
/// use zstrip::ScreenPoint;
/// use zstrip::math::Pixels;
/// use zstrip::shape::RoundedRectangle;
/// let sharp = RoundedRectangle::new(ScreenPoint::corner(10, 10), ScreenPoint::corner(90, 40));
/// let button = sharp.with_radius(Pixels::from_num(8));
/// # let _ = button;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RoundedRectangle {
    corners: [ScreenPoint; 2],
    radii: [Pixels; 2],
}

impl RoundedRectangle {
    /// Makes a rectangle with sharp corners, between two opposite ones.
    #[must_use]
    pub const fn new(corner: ScreenPoint, opposite: ScreenPoint) -> Self {
        Self { corners: [corner, opposite], radii: [Pixels::ZERO; 2] }
    }

    /// Returns the rectangle with corners of a radius. One larger than half of a side becomes that.
    #[must_use]
    pub const fn with_radius(self, radius: Pixels) -> Self {
        self.with_radii(radius, radius)
    }

    /// Returns the rectangle with corners of different radii along x and along y.
    #[must_use]
    pub const fn with_radii(self, x: Pixels, y: Pixels) -> Self {
        Self { radii: [x, y], ..self }
    }

    /// Returns the upper left and the lower right corner, in 16.16 px.
    fn box_of(&self) -> (Place, Place) {
        let [a, b] = self.corners.map(place);
        ([a[0].min(b[0]), a[1].min(b[1])], [a[0].max(b[0]), a[1].max(b[1])])
    }
}

impl Outline for RoundedRectangle {
    fn trace(&self, pen: &mut Pen<'_, '_>) {
        let (from, to) = self.box_of();
        let [rx, ry] = self.radii.map(length);
        let radii = [rx.min((to[0] - from[0]) >> 1), ry.min((to[1] - from[1]) >> 1)];
        if radii[0] == 0 || radii[1] == 0 {
            pen.move_to_place(from);
            for corner in [[to[0], from[1]], to, [from[0], to[1]]] {
                pen.line_to_place(corner);
            }
            return;
        }
        // Clockwise, from the end of the upper side on.
        let quarters = [
            (to[0] - radii[0], from[1] + radii[1], 0xC000),
            (to[0] - radii[0], to[1] - radii[1], 0),
            (from[0] + radii[0], to[1] - radii[1], 0x4000),
            (from[0] + radii[0], from[1] + radii[1], 0x8000),
        ];
        for (k, (x, y, angle)) in quarters.into_iter().enumerate() {
            let curve = Curve::new([x, y], radii);
            let start = curve.point(direction(Angle16(angle)));
            if k == 0 {
                pen.move_to_place(start);
            } else {
                pen.line_to_place(start);
            }
            curve.sweep(pen, Angle16(angle), 1 << 14);
        }
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn bounds(&self) -> Option<Rectangle> {
        let (from, to) = self.box_of();
        Some(pixels(from, to))
    }
}
