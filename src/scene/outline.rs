//! Outlines of shapes: contours of straight lines and curves, which an [`Outline`] draws with a [`Pen`] each time it is
//! asked.

use super::canvas::ScreenPoint;
use crate::raster::{AreaEdges, Bezier, FillRule};
use core::ops::Range;
use embedded_graphics_core::primitives::Rectangle;

/// A shape that can be filled, as closed contours of straight lines and curves.
///
/// The shapes in [`zstrip::shape`](crate::shape) implement it. A shape of one's own says where its lines are; it is
/// asked once per band of rows, so the same lines have to come each time.
///
/// ```
/// use zstrip::ScreenPoint;
/// use zstrip::scene::{Outline, Pen};
///
/// struct Diamond(ScreenPoint, i16);
///
/// impl Outline for Diamond {
///     fn trace(&self, pen: &mut Pen<'_, '_>) {
///         let Self(center, radius) = *self;
///         let radius = zstrip::math::Pixels::from_num(radius);
///         let at = |x, y| ScreenPoint::new(center.x() + radius * x, center.y() + radius * y);
///         pen.move_to(at(0, -1));
///         [at(1, 0), at(0, 1), at(-1, 0)].map(|corner| pen.line_to(corner));
///     }
/// }
/// ```
pub trait Outline {
    /// Draws all contours with a pen. Contours close by themselves.
    fn trace(&self, pen: &mut Pen<'_, '_>);

    /// Returns the rule by which the contours enclose an area.
    fn rule(&self) -> FillRule {
        FillRule::NonZero
    }

    /// Returns whether the outline is one convex contour. Then rows are filled faster, because its edges are not looked
    /// at for crossings. An outline that says so and is not convex is covered wrongly where it goes to and fro.
    fn is_convex(&self) -> bool {
        false
    }

    /// Returns whether no contour crosses or touches itself or another one, and winding numbers are 0 and 1, or 0 and
    /// -1: holes go round the other way than what they are in, and contours that are not in one another the same way.
    /// Then rows are filled faster, too, and an outline that says so and is not like that is covered wrongly.
    fn is_apart(&self) -> bool {
        false
    }

    /// Returns an area that all covered pixels are in, so that other strips leave the shape out at once; `None` if that
    /// is not known.
    fn bounds(&self) -> Option<Rectangle> {
        None
    }
}

impl<O: Outline + ?Sized> Outline for &O {
    fn trace(&self, pen: &mut Pen<'_, '_>) {
        (**self).trace(pen);
    }

    fn rule(&self) -> FillRule {
        (**self).rule()
    }

    fn is_convex(&self) -> bool {
        (**self).is_convex()
    }

    fn is_apart(&self) -> bool {
        (**self).is_apart()
    }

    fn bounds(&self) -> Option<Rectangle> {
        (**self).bounds()
    }
}

/// A place in 16.16 px.
pub(crate) type Place = [i64; 2];

/// A pen that an [`Outline`] draws its contours with.
///
/// A contour begins with [`move_to`](Self::move_to). It is closed by a straight line where the next one begins.
#[derive(Debug)]
pub struct Pen<'p, 'm> {
    edges: &'p mut AreaEdges<'m>,
    start: Place,
    at: Place,
}

/// Returns a point in 16.16 px.
fn place(point: ScreenPoint) -> Place {
    [point.x(), point.y()].map(|c| i64::from(c.to_bits()) << 8)
}

impl<'p, 'm> Pen<'p, 'm> {
    pub(super) const fn new(edges: &'p mut AreaEdges<'m>) -> Self {
        Self { edges, start: [0; 2], at: [0; 2] }
    }
}

impl Pen<'_, '_> {
    /// Closes the contour, and begins another one.
    pub fn move_to(&mut self, point: ScreenPoint) {
        self.move_to_place(place(point));
    }

    /// Draws a straight line.
    pub fn line_to(&mut self, point: ScreenPoint) {
        self.line_to_place(place(point));
    }

    /// Draws a curve of the second degree, a part of a parabola. It sets out towards the control point, and arrives
    /// from there. Its chords are within 1/64 px of it, for points within ±32,767 px.
    pub fn quad_to(&mut self, control: ScreenPoint, to: ScreenPoint) {
        self.quad_to_place(place(control), place(to));
    }

    /// Draws a Bézier curve of the third degree. It sets out towards the first control point, and arrives from the
    /// second one. Its chords are within 1/64 px of it, for points within ±32,767 px.
    ///
    /// ```
    /// use zstrip::ScreenPoint;
    /// use zstrip::scene::{Outline, Pen};
    ///
    /// /// A leaf between two points of a stem, as wide as two others say.
    /// struct Leaf([ScreenPoint; 4]);
    ///
    /// impl Outline for Leaf {
    ///     fn trace(&self, pen: &mut Pen<'_, '_>) {
    ///         let [root, left, tip, right] = self.0;
    ///         pen.move_to(root);
    ///         pen.cubic_to(left, left, tip);
    ///         pen.quad_to(right, root);
    ///     }
    /// }
    /// ```
    pub fn cubic_to(&mut self, first: ScreenPoint, second: ScreenPoint, to: ScreenPoint) {
        self.cubic_to_place(place(first), place(second), place(to));
    }

    /// Closes the contour by a straight line to its first point.
    pub fn close(&mut self) {
        self.line_to_place(self.start);
    }

    pub(crate) fn move_to_place(&mut self, place: Place) {
        self.close();
        (self.start, self.at) = (place, place);
    }

    #[inline(never)]
    pub(crate) fn line_to_place(&mut self, place: Place) {
        self.edges.line(self.at, place);
        self.at = place;
    }

    pub(crate) fn quad_to_place(&mut self, control: Place, to: Place) {
        self.curve(&Bezier::quadratic(self.at, control, to));
    }

    pub(crate) fn cubic_to_place(&mut self, first: Place, second: Place, to: Place) {
        self.curve(&Bezier::cubic(self.at, first, second, to));
    }

    #[inline(never)]
    fn curve(&mut self, curve: &Bezier) {
        for piece in curve.pieces() {
            let [top, bottom] = piece.heights();
            if !self.misses(top, bottom) {
                for place in piece.chords() {
                    self.line_to_place(place);
                }
            }
            self.line_to_place(piece.end());
        }
    }

    /// Draws chords of a sector of a curve but the last one, from a place. Each takes a `step` of the sector, in 0.16.
    /// Changes from place to place are 16.22, and so are theirs.
    pub(crate) fn chords(&mut self, from: Place, step: u32, mut change: [i32; 2], second: [i32; 2]) {
        let (mut part, mut way) = (step, [0_i32; 2]);
        // Sectors are at most 512 px wide, so near ones stay inside of the guard.
        let is_near = AreaEdges::are_near(self.at, from);
        let (mut at, near) = (self.at.map(|c| c as i32), from.map(|c| c as i32));
        // Roundings of the step leave out no chord, and add none.
        while part + (step >> 1) < 1 << 16 {
            way = [way[0].wrapping_add(change[0]), way[1].wrapping_add(change[1])];
            change = [change[0].wrapping_add(second[0]), change[1].wrapping_add(second[1])];
            if is_near {
                let to = [near[0] + (way[0] >> 6), near[1] + (way[1] >> 6)];
                self.edges.near_line(at, to);
                at = to;
            } else {
                self.line_to_place([from[0] + i64::from(way[0] >> 6), from[1] + i64::from(way[1] >> 6)]);
            }
            part += step;
        }
        if is_near {
            self.at = at.map(i64::from);
        }
    }

    /// Draws an edge that is a part of no contour of the pen. Edges have to make contours all together.
    #[inline(never)]
    pub(crate) fn edge(&mut self, from: Place, to: Place) {
        self.edges.line(from, to);
    }

    /// Goes to a place without a line, and leaves the contour as it is: the lines to come are edges as those of
    /// [`edge`](Self::edge).
    pub(crate) const fn jump(&mut self, place: Place) {
        (self.start, self.at) = (place, place);
    }

    /// Returns whether nothing of a shape between two heights, in 16.16 px, can be in the rows that are drawn now.
    #[inline]
    pub(crate) fn misses(&self, top: i64, bottom: i64) -> bool {
        self.edges.misses(top, bottom)
    }

    /// Returns the columns and rows that are drawn now, in 16.16 px.
    pub(crate) fn area(&self) -> [Range<i64>; 2] {
        self.edges.area()
    }
}
