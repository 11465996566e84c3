//! Paths: contours of straight lines through given points.

use crate::raster::FillRule;
use crate::scene::{Outline, Pen, ScreenPoint};

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
}
