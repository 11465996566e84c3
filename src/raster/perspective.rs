//! Perspective-correct varyings, at the vertices: varyings and 1 / w come in. Values that are linear on the screen, and
//! the amount of perspective, go out.
//!
//! A varying that is linear in space is not a plane on the screen, but v / w and 1 / w are. With d = v - v₀, scaled to
//! 28 bits, and q = 1 / w, scaled so that the largest q of a triangle has 31 bits,
//!
//! ```text
//! v = v₀ + Σ bᵢ (dᵢ qᵢ) / Σ bᵢ qᵢ            bᵢ: a pixel's barycentric coordinates on the screen
//! ```
//! so a pixel takes the planes of d q and of q, and one reciprocal. |d| q is at most an eighth of q at the vertices,
//! and therefore at every pixel. Where values are divided every few pixels only, d is scaled to 26 bits, so that |d| q
//! is a thirty-second of q: the columns at which they are divided may lie outside of the triangle.

use super::along::Along;
use super::gradient::Gradients;
use super::line::{Line, LinePixels};
use crate::math::mul_high_signed;
use crate::vertex::{
    PerspectiveClass, PerspectivePlane, PerspectiveSetup, Plane64, ScreenVertex, Varyings, signed_area,
};

/// Replaces perspective-correct varyings by d q (or by d, where perspective is too weak to be seen), and 1 / w by q.
/// `screen` is the screen's size. Varyings are to be divided at every `step`-th column, if the triangle allows it.
#[inline]
pub fn homogenize<V: Varyings>(
    varyings: &mut [V; 3],
    v: &[ScreenVertex; 3],
    screen: (u16, u16),
    step: usize,
    perspective: &mut V::PerspectiveSetup,
) {
    let wide = step > 1 && !is_narrow(v);
    if let Some((class, _, planes)) = perspective.parts_mut() {
        let [a, b, c] = varyings;
        let values = [a.as_mut(), b.as_mut(), c.as_mut()];
        let (found, moderate) = convert(values, planes, extent(v, screen), if wide { STEPPED_SPARE } else { 0 });
        *class = found;
        // The rest is known when there are planes.
        perspective.set_least_straight(if wide && moderate { 0 } else { u32::MAX });
    }
}

/// Bits that differences leave free where varyings are divided outside of the triangle.
const STEPPED_SPARE: u32 = 2;

/// Returns whether a triangle is so narrow that varyings are divided at each of its pixels. Columns that are divided
/// would lie far outside of it, where planes of a small triangle are not exact enough. All other triangles are at least
/// 8 px wide at their widest.
///
/// # Format
/// A value that differs by less than D from the one at vertex 0 changes by at most D 256 (|y₁| + |y₂|) / area from
/// column to column, with y relative to vertex 0. This is at most D / 8 in all other triangles, so no plane changes by
/// more from column to column than a number holds. Sums of |y| are below 2²⁶.
#[inline(never)]
fn is_narrow([a, b, c]: &[ScreenVertex; 3]) -> bool {
    let heights = u64::from((b.y - a.y).unsigned_abs() + (c.y - a.y).unsigned_abs());
    signed_area(a, b, c).unsigned_abs() < heights << 11
}

/// Finds where varyings may be taken as linear between columns that are 1 << `log_step` pixels apart, from the changes
/// per column of all values. There, q and each d q change by at most an eighth of q over these columns.
///
/// # Format
/// With a ratio r ≤ 9/8 of q, a varying is off by at most (√r - 1) / (√r + 1), 1/34, of its change. Within the triangle
/// |d q| is at most q / 32, so it is below 3/16 q at both columns, even if one lies outside. Changes above 2²⁸ in all
/// are straight nowhere.
#[inline(never)]
pub fn straighten<C: PerspectiveSetup>(d_dx: &[i32], log_step: u32, perspective: &mut C) {
    if perspective.least_straight() != 0 {
        return;
    }
    let planes = perspective.planes();
    let most = if perspective.class() == PerspectiveClass::Planes64 {
        let changes = planes.iter().map(|plane| plane.wide.dx).chain([perspective.inverse_w64().dx]);
        changes.fold(0, |most: u32, change| most.max((change.unsigned_abs() >> 32) as u32 + 1))
    } else {
        let changes = d_dx.iter().take(planes.len()).chain(d_dx.last());
        changes.fold(0, |most: u32, change| most.max(change.unsigned_abs()))
    };
    let up = log_step + 3;
    perspective.set_least_straight(if most >> (31 - up) == 0 { most << up } else { u32::MAX });
}

/// Computes the planes of d q and q in 64 bits, where 32 are too few.
#[inline]
pub fn widen<C: PerspectiveSetup>(gradients: &Gradients, values: &[&[i32]; 3], perspective: &mut C) {
    if let Some((PerspectiveClass::Planes64, inverse_w64, planes)) = perspective.parts_mut() {
        planes_in_64_bits(gradients, values, inverse_w64, planes);
    }
}

#[inline(never)]
fn planes_in_64_bits(
    gradients: &Gradients,
    values: &[&[i32]; 3],
    inverse_w64: &mut Plane64,
    planes: &mut [PerspectivePlane],
) {
    let [a, b, c] = *values;
    for (((plane, a), b), c) in planes.iter_mut().zip(a).zip(b).zip(c) {
        gradients.plane_wide([*a, *b, *c], &mut plane.wide);
    }
    if let ([.., a], [.., b], [.., c]) = (a, b, c) {
        gradients.plane_wide([*a, *b, *c], inverse_w64);
    }
}

/// Computes the planes of d q and q along a line in 64 bits, where 32 are too few. They change along the line's longer
/// axis only. `pixel` is the first pixel that is drawn, `on` pixels after the pixel `origin` of `along`.
#[inline]
pub fn widen_along<C: PerspectiveSetup>(
    (line, along): (&Line, &Along),
    values: &[&[i32]; 2],
    (pixel, on): (&LinePixels, i32),
    perspective: &mut C,
) {
    let Some((PerspectiveClass::Planes64, inverse_w64, planes)) = perspective.parts_mut() else { return };
    let plane = |from: i32, to: i32| {
        let (start, step) = along.wide(line, from, to);
        let ((x, y), straight) = (pixel.position, pixel.straight);
        let mut plane = Plane64 { base: 0, dx: step * i64::from(straight.0), dy: step * i64::from(straight.1) };
        plane.base = start.wrapping_add(step.wrapping_mul(on.into())).wrapping_sub(plane.at((x, y)));
        plane
    };
    let [a, b] = *values;
    for ((to, a), b) in planes.iter_mut().zip(a).zip(b) {
        to.wide = plane(*a, *b);
    }
    if let ([.., a], [.., b]) = (a, b) {
        *inverse_w64 = plane(*a, *b);
    }
}

/// Returns the number of columns and rows that a plane's value may have to be carried over.
fn extent(v: &[ScreenVertex; 3], (width, height): (u16, u16)) -> u32 {
    let [a, b, c] = v;
    let columns = a.x.max(b.x).max(c.x) - a.x.min(b.x).min(c.x);
    let rows = a.y.max(b.y).max(c.y) - a.y.min(b.y).min(c.y);
    (columns as u32 >> 8).min(width.into()) + (rows as u32 >> 8).min(height.into())
}

/// Replaces the values at three vertices as [`homogenize`] does. Returns the amount of perspective, and whether all
/// differences leave `spare` bits free.
///
/// # Format
/// Planes in 32 bits are off by less than extent + 64 units (see [`Gradients`](crate::raster::Gradients)). So are q and
/// d q, which makes h, of 28 bits, wrong by some 2³¹ (extent + 64) / q. [`Planes32`](PerspectiveClass::Planes32) keeps
/// this error below 2¹⁵ units, 2⁻¹³ of the largest difference. Where q differs by less than 2⁻¹⁴, h bends by a quarter
/// of that, 2⁻¹⁶. Equal q, whatever they are, are no perspective. Spare bits are taken from these bounds: with two of
/// them it is 2⁻¹¹.
#[inline(never)]
fn convert(
    values: [&mut [i32]; 3],
    planes: &mut [PerspectivePlane],
    extent: u32,
    spare: u32,
) -> (PerspectiveClass, bool) {
    let [a, b, c] = values;
    let ([.., wa], [.., wb], [.., wc]) = (&mut *a, &mut *b, &mut *c) else {
        return (PerspectiveClass::Affine, false);
    };
    let q = weights([*wa as u32, *wb as u32, *wc as u32]);
    let [qa, qb, qc] = q;
    (*wa, *wb, *wc) = (qa as i32, qb as i32, qc as i32);
    let (least, most) = (qa.min(qb).min(qc), qa.max(qb).max(qc));
    let class = match () {
        () if most - least <= most >> 14 => PerspectiveClass::Affine,
        () if (extent + 64).saturating_mul(most >> 14) <= least => PerspectiveClass::Planes32,
        () => PerspectiveClass::Planes64,
    };
    let mut moderate = true;
    for (((plane, a), b), c) in planes.iter_mut().zip(a).zip(b).zip(c) {
        plane.base = *a;
        let (db, dc) = (b.wrapping_sub(*a), c.wrapping_sub(*a));
        let zeros = db.unsigned_abs().max(dc.unsigned_abs()).leading_zeros();
        plane.shift = zeros.saturating_sub(4 + spare);
        moderate &= zeros >= 4 + spare;
        (*a, *b, *c) = (0, db << plane.shift, dc << plane.shift);
        if class != PerspectiveClass::Affine {
            (*b, *c) = (mul_high_signed(*b, qb << 1), mul_high_signed(*c, qc << 1));
        }
    }
    (class, moderate)
}

/// Returns the least and the largest of three [`weights`], in 26 bits, from the words of
/// [`inverse_w`](crate::vertex::inverse_w).
#[inline(always)]
pub(crate) fn least_and_most(words: [u32; 3]) -> (u32, u32) {
    let [a, b, c] = weights(words);
    (a.min(b).min(c) >> 5, a.max(b).max(c) >> 5)
}

/// Returns numbers in the ratio of 1 / w, from the words of [`inverse_w`](crate::vertex::inverse_w): the largest is in
/// 2³⁰..2³¹, and none is below 1.
fn weights(words: [u32; 3]) -> [u32; 3] {
    let [a, b, c] = words;
    let most = (a & 63).max(b & 63).max(c & 63);
    let weight = |word: u32| ((word & !63) >> 1 >> (most - (word & 63)).min(31)).max(1);
    [weight(a), weight(b), weight(c)]
}
