//! Edge functions of a triangle: three vertices on the screen come in. Three numbers at a pixel go out, which say
//! whether its centre is covered, and their changes per column and row. The traversals that step them,
//! [`bounding_box`](super::bounding_box) and [`blocks`](super::blocks), multiply nothing in their loops.
//!
//! The edge function of a -> b at p is twice the area of a b p: dx (p.y - a.y) - dy (p.x - a.x). Corners are taken in
//! the order in which all three functions are positive inside. There, with y down, a left edge goes up and a top edge
//! goes right. These two own the points on them; from any other edge's function, 1 is subtracted. So a centre is
//! covered if no function is negative: the top-left rule, for either winding.
//!
//! The source is Pineda 1988, "A Parallel Algorithm for Polygon Rasterization".

use super::triangle::{PixelRect, pixel_rect};
use crate::vertex::ScreenVertex;

/// Largest extent of a triangle whose edge functions fit 32 bits, 24.8.
///
/// At a place up to 8 px outside of the bounding box, a function is below 2 · 120 · 128 · 2¹⁶ < 2³¹.
const SHORT: i32 = 120 << 8;

/// Numbers that edge functions are computed in: `i32` for triangles of up to 120 px, otherwise `i64`.
pub(super) trait Number: Copy {
    /// Number 0.
    const ZERO: Self;

    /// Converts a factor of an edge function.
    fn of(value: i32) -> Self;

    /// Returns the sum. It may wrap only where it is not looked at: after the last column or row.
    fn plus(self, other: Self) -> Self;

    /// Returns the product. Only set-up multiplies.
    fn times(self, other: Self) -> Self;

    /// Returns a number that is negative if one of both is.
    fn or(self, other: Self) -> Self;

    /// Returns whether the number is negative.
    fn is_negative(self) -> bool;

    /// Returns the lesser one of both.
    fn least(self, other: Self) -> Self;

    /// Returns the greater one of both.
    fn most(self, other: Self) -> Self;
}

macro_rules! number {
    ($type:ty) => {
        impl Number for $type {
            const ZERO: Self = 0;

            #[inline(always)]
            fn of(value: i32) -> Self {
                Self::from(value)
            }

            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                self.wrapping_add(other)
            }

            #[inline(always)]
            fn times(self, other: Self) -> Self {
                self.wrapping_mul(other)
            }

            #[inline(always)]
            fn or(self, other: Self) -> Self {
                self | other
            }

            #[inline(always)]
            fn is_negative(self) -> bool {
                self < 0
            }

            #[inline(always)]
            fn least(self, other: Self) -> Self {
                self.min(other)
            }

            #[inline(always)]
            fn most(self, other: Self) -> Self {
                self.max(other)
            }
        }
    };
}

number!(i32);
number!(i64);

/// Three edge functions at a place, or their changes from one place to another.
#[derive(Clone, Copy)]
pub(super) struct Three<T>(pub(super) [T; 3]);

impl<T: Number> Three<T> {
    /// Adds numbers to each.
    #[inline(always)]
    pub(super) fn add(&mut self, Self([da, db, dc]): &Self) {
        let Self([a, b, c]) = *self;
        *self = Self([a.plus(*da), b.plus(*db), c.plus(*dc)]);
    }

    /// Returns the sums of each.
    #[inline(always)]
    pub(super) fn plus(mut self, other: &Self) -> Self {
        self.add(other);
        self
    }

    /// Returns each times a factor.
    pub(super) fn times(self, factor: i32) -> Self {
        Self(self.0.map(|value| value.times(T::of(factor))))
    }

    /// Returns the numbers for which a test holds, and 0 for the others.
    pub(super) fn only(self, test: impl Fn(T) -> bool) -> Self {
        Self(self.0.map(|value| if test(value) { value } else { T::ZERO }))
    }

    /// Returns the lesser ones of each.
    pub(super) fn least(self, other: &Self) -> Self {
        let (Self([a, b, c]), Self([d, e, f])) = (self, *other);
        Self([a.least(d), b.least(e), c.least(f)])
    }

    /// Returns the greater ones of each.
    pub(super) fn most(self, other: &Self) -> Self {
        let (Self([a, b, c]), Self([d, e, f])) = (self, *other);
        Self([a.most(d), b.most(e), c.most(f)])
    }

    /// Returns whether none is negative.
    #[inline(always)]
    pub(super) fn covers(&self) -> bool {
        let Self([a, b, c]) = *self;
        !a.or(b).or(c).is_negative()
    }
}

/// The edge functions of a triangle: their values at the centre of a pixel, and their changes.
pub(super) struct EdgeFunctions<T> {
    pub(super) at: Three<T>,
    /// Changes from a column, and from a row, to the next.
    pub(super) right: Three<T>,
    pub(super) down: Three<T>,
    /// Changes over 1/256 px to the right and down.
    pub(super) fine: [Three<T>; 2],
}

impl<T: Number> EdgeFunctions<T> {
    /// Computes the edge functions at a pixel. `clockwise` says that the area is positive.
    ///
    /// # Format
    /// Values are in units of 2⁻¹⁶ px². In 64 bits, coordinates are within ±32,767 px and the pixel is within 8 px of
    /// them: differences are below 2²⁴ + 2¹¹, products below 2⁴⁹, and values below 2⁵⁰. In 32 bits, see [`SHORT`].
    pub(super) fn new([a, b, c]: &[ScreenVertex; 3], clockwise: bool, (column, row): (i32, i32)) -> Self {
        let (b, c) = if clockwise { (b, c) } else { (c, b) };
        let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| (from, to.x - from.x, to.y - from.y));
        let at = |(from, dx, dy): (&ScreenVertex, i32, i32)| {
            let (x, y) = (256 * column + 128 - from.x, 256 * row + 128 - from.y);
            let owns = dy < 0 || dy == 0 && dx > 0;
            let minus = T::of(dy).times(T::of(-x));
            T::of(dx).times(T::of(y)).plus(minus).plus(T::of(if owns { 0 } else { -1 }))
        };
        let fine = [Three(sides.map(|(_, _, dy)| T::of(-dy))), Three(sides.map(|(_, dx, _)| T::of(dx)))];
        let [right, down] = fine.map(|change| change.times(256));
        Self { at: Three(sides.map(at)), right, down, fine }
    }
}

/// Returns the pixels that a traversal looks at: those of the bounding box that are in `clip`. There are none if the
/// triangle has no area.
pub(super) fn looked_at(v: &[ScreenVertex; 3], area: i64, samples: usize, clip: &PixelRect) -> Option<PixelRect> {
    let rect = pixel_rect(v, samples).intersection(clip);
    if area == 0 || rect.is_empty() { None } else { Some(rect) }
}

/// Returns whether the edge functions of a triangle fit 32 bits.
pub(super) fn is_short([a, b, c]: &[ScreenVertex; 3]) -> bool {
    let extent = |a: i32, b: i32, c: i32| a.max(b).max(c) - a.min(b).min(c);
    extent(a.x, b.x, c.x) <= SHORT && extent(a.y, b.y, c.y) <= SHORT
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use crate::vertex::signed_area;

    /// Compares values in 32 and in 64 bits with exact ones, at the box's corners and up to 8 px outside of it, for
    /// triangles of the largest extent.
    #[test]
    fn functions_of_short_triangles_fit_32_bits() {
        let mut rng = Rng::new(3);
        for case in 0..50_000 {
            let size = [600, SHORT][case % 2];
            let at = [rng.between(-9000, 9000), rng.between(-9000, 9000)];
            let mut coordinate = |k: usize| at[k] + [0, size, rng.between(0, size)][rng.below(3) as usize];
            let v = [(); 3].map(|()| ScreenVertex::new(coordinate(0), coordinate(1), 0));
            assert!(is_short(&v));
            let clockwise = signed_area(&v[0], &v[1], &v[2]) > 0;
            let near = |k: usize, rng: &mut Rng| (at[k] >> 8) + [-8, 0, (size >> 8) + 8][rng.below(3) as usize];
            let pixel = (near(0, &mut rng), near(1, &mut rng));
            let short = EdgeFunctions::<i32>::new(&v, clockwise, pixel);
            let long = EdgeFunctions::<i64>::new(&v, clockwise, pixel);
            for (short, long) in [(short.at, long.at), (short.right, long.right), (short.down, long.down)] {
                assert_eq!(short.0.map(i64::from), long.0, "case {case}: {v:?} at {pixel:?}");
            }
        }
    }

    #[test]
    fn functions_of_the_largest_triangles_fit_64_bits() {
        let far = (1 << 23) - 1;
        for mask in 0..64 {
            let coordinate = |k: u32| if mask >> k & 1 == 0 { -far } else { far };
            let v = [0, 2, 4].map(|k| ScreenVertex::new(coordinate(k), coordinate(k + 1), 0));
            let corners = [-(1 << 15) - 8, (1 << 15) + 7];
            for pixel in corners.into_iter().flat_map(|x| corners.map(|y| (x, y))) {
                let functions = EdgeFunctions::<i64>::new(&v, true, pixel);
                for (value, (a, b)) in functions.at.0.into_iter().zip([(0, 1), (1, 2), (2, 0)]) {
                    let [dx, dy, x, y] =
                        [v[b].x - v[a].x, v[b].y - v[a].y, 256 * pixel.0 + 128 - v[a].x, 256 * pixel.1 + 128 - v[a].y]
                            .map(i128::from);
                    let exact = dx * y - dy * x;
                    assert!(exact.abs() < 1 << 50 && (exact - i128::from(value)) >> 1 == 0, "{v:?} at {pixel:?}");
                }
            }
        }
    }
}
