//! Traversal of a triangle's bounding box: three vertices on the screen come in, and spans, or pixels with the samples
//! that are covered, go out, row by row from the top.
//!
//! ```text
//! for each row of the bounding box:
//!     for each column of it:
//!         if no edge function is negative: the pixel is covered
//!         edge functions += their changes to the right
//!     edge functions at the row's beginning += their changes down
//! ```
//! A triangle's pixels in a row are next to each other, so a row is left after its last one.

use super::edge_function::{EdgeFunctions, Number, Three, is_short, looked_at};
use super::samples::moves;
use super::triangle::PixelRect;
use crate::vertex::ScreenVertex;
use core::ops::Range;

/// Finds the spans of a triangle inside of a rectangle, by its edge functions at the pixels of its bounding box, and
/// calls `span(y, columns)` for each span that is not empty.
///
/// Takes the parameters of [`spans`](super::spans), and finds its spans in its order.
///
/// ```
/// use zstrip::vertex::ScreenVertex;
/// use zstrip::internals::{PixelRect, bounding_box, signed_area};
/// let [a, b, c] = [[0, 0], [0, 2], [2, 0]].map(|[x, y]| ScreenVertex::new(x * 256, y * 256, 0));
/// let mut found = Vec::new();
/// bounding_box(&[a, b, c], signed_area(&a, &b, &c), &PixelRect { x: 0..8, y: 0..8 }, |y, x| found.push((y, x)));
/// assert_eq!(found, [(0, 0..1)]);
/// ```
#[inline]
pub fn bounding_box(v: &[ScreenVertex; 3], area: i64, clip: &PixelRect, mut span: impl FnMut(i32, Range<i32>)) {
    let Some(rect) = looked_at(v, area, 1, clip) else { return };
    if is_short(v) {
        walk::<i32>(v, area, &rect, &mut span);
    } else {
        walk::<i64>(v, area, &rect, &mut span);
    }
}

#[inline(always)]
fn walk<T: Number>(v: &[ScreenVertex; 3], area: i64, rect: &PixelRect, span: &mut impl FnMut(i32, Range<i32>)) {
    let EdgeFunctions { mut at, right, down, .. } = EdgeFunctions::<T>::new(v, area > 0, (rect.x.start, rect.y.start));
    for y in rect.y.clone() {
        let (mut pixel, mut x) = (at, rect.x.start);
        while x < rect.x.end && !pixel.covers() {
            pixel.add(&right);
            x += 1;
        }
        let start = x;
        while x < rect.x.end && pixel.covers() {
            pixel.add(&right);
            x += 1;
        }
        if start < x {
            span(y, start..x);
        }
        at.add(&down);
    }
}

/// Most samples of a pixel.
const MOST: usize = 8;

/// Finds the pixels inside of a rectangle in which a triangle covers samples, by its edge functions at the pixels of
/// its bounding box, and calls `pixel(x, y, covered)` for each of them, row by row. Bit k of `covered` stands for
/// sample k of `samples`, which are 1, 2, 4 or 8.
///
/// Other parameters are those of [`spans`](super::spans). A sample is covered where `spans` finds the pixel in the
/// triangle, moved so that the sample is at the pixel's centre.
///
/// Edge functions at a sample are those at the centre plus a constant. A pixel whose functions plus their least
/// constants are not negative has all samples. One with a function that is negative plus its greatest constant has
/// none. Samples are looked at one by one in the others.
///
/// ```
/// use zstrip::vertex::ScreenVertex;
/// use zstrip::internals::{PixelRect, covered_samples, signed_area};
/// let [a, b, c] = [[0, 0], [0, 4], [4, 0]].map(|[x, y]| ScreenVertex::new(x * 256, y * 256, 0));
/// let (area, clip) = (signed_area(&a, &b, &c), PixelRect { x: 0..8, y: 0..1 });
/// let mut found = Vec::new();
/// covered_samples(&[a, b, c], area, 4, &clip, |x, _, covered| found.push((x, covered)));
/// assert_eq!(found, [(0, 0b1111), (1, 0b1111), (2, 0b1111), (3, 0b101)]);
/// ```
#[inline]
pub fn covered_samples(
    v: &[ScreenVertex; 3],
    area: i64,
    samples: usize,
    clip: &PixelRect,
    mut pixel: impl FnMut(i32, i32, u8),
) {
    let Some(rect) = looked_at(v, area, samples, clip) else { return };
    if is_short(v) {
        walk_samples::<i32>(v, area, samples, &rect, &mut pixel);
    } else {
        walk_samples::<i64>(v, area, samples, &rect, &mut pixel);
    }
}

#[inline(always)]
fn walk_samples<T: Number>(
    v: &[ScreenVertex; 3],
    area: i64,
    samples: usize,
    rect: &PixelRect,
    pixel: &mut impl FnMut(i32, i32, u8),
) {
    let EdgeFunctions { mut at, right, down, fine: [fine_right, fine_down] } =
        EdgeFunctions::<T>::new(v, area > 0, (rect.x.start, rect.y.start));
    // Changes of the edge functions from the centre to each sample, and the least and the greatest of each function.
    let moves = moves(samples);
    let mut beside = [Three([T::ZERO; 3]); MOST];
    let mut least = Three([T::ZERO; 3]);
    let mut most = Three([T::ZERO; 3]);
    for (k, (beside, (x, y))) in beside.iter_mut().zip(moves).enumerate() {
        *beside = fine_right.times(-x).plus(&fine_down.times(-y));
        if k == 0 {
            (least, most) = (*beside, *beside);
        }
        least = least.least(beside);
        most = most.most(beside);
    }
    let all = ((1_u32 << moves.len()) - 1) as u8;
    for y in rect.y.clone() {
        let (mut here, mut any) = (at, false);
        for x in rect.x.clone() {
            if here.plus(&most).covers() {
                let mut covered = all;
                if !here.plus(&least).covers() {
                    covered = 0;
                    for (k, beside) in beside.iter().take(moves.len()).enumerate() {
                        covered |= u8::from(here.plus(beside).covers()) << k;
                    }
                }
                if covered != 0 {
                    pixel(x, y, covered);
                }
                any = true;
            } else if any {
                // The pixels that are not rejected are next to each other.
                break;
            }
            here.add(&right);
        }
        at.add(&down);
    }
}
