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
//! and therefore at every pixel.

use super::along::Along;
use super::gradient::Gradients;
use super::line::{Line, LinePixels};
use crate::math::mul_high_signed;
use crate::vertex::{PerspectiveClass, PerspectivePlane, PerspectiveSetup, Plane64, ScreenVertex, Varyings};

/// Replaces perspective-correct varyings by d q (or by d, where perspective is too weak to be seen), and 1 / w by q.
/// `screen` is the screen's size.
#[inline]
pub fn homogenize<V: Varyings>(
    varyings: &mut [V; 3],
    v: &[ScreenVertex; 3],
    screen: (u16, u16),
    perspective: &mut V::PerspectiveSetup,
) {
    if let Some((class, _, planes)) = perspective.parts_mut() {
        let [a, b, c] = varyings;
        *class = convert([a.as_mut(), b.as_mut(), c.as_mut()], planes, extent(v, screen));
    }
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

/// Replaces the values at three vertices as [`homogenize`] does, and returns the amount of perspective.
///
/// # Format
/// Planes in 32 bits are off by less than extent + 64 units (see [`Gradients`](crate::raster::Gradients)). So are q and
/// d q, which makes h, of 28 bits, wrong by some 2³¹ (extent + 64) / q. [`Planes32`](PerspectiveClass::Planes32) keeps
/// this error below 2¹⁵ units, 2⁻¹³ of the largest difference. Where q differs by less than 2⁻¹⁴, h bends by a quarter
/// of that, 2⁻¹⁶. Equal q, whatever they are, are no perspective.
#[inline(never)]
fn convert(values: [&mut [i32]; 3], planes: &mut [PerspectivePlane], extent: u32) -> PerspectiveClass {
    let [a, b, c] = values;
    let ([.., wa], [.., wb], [.., wc]) = (&mut *a, &mut *b, &mut *c) else {
        return PerspectiveClass::Affine;
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
    for (((plane, a), b), c) in planes.iter_mut().zip(a).zip(b).zip(c) {
        plane.base = *a;
        let (db, dc) = (b.wrapping_sub(*a), c.wrapping_sub(*a));
        let zeros = db.unsigned_abs().max(dc.unsigned_abs()).leading_zeros();
        plane.shift = zeros.saturating_sub(4);
        (*a, *b, *c) = (0, db << plane.shift, dc << plane.shift);
        if class != PerspectiveClass::Affine {
            (*b, *c) = (mul_high_signed(*b, qb << 1), mul_high_signed(*c, qc << 1));
        }
    }
    class
}

/// Returns numbers in the ratio of 1 / w, from the words of [`inverse_w`](crate::vertex::inverse_w): the largest is in
/// 2³⁰..2³¹, and none is below 1.
fn weights(words: [u32; 3]) -> [u32; 3] {
    let [a, b, c] = words;
    let most = (a & 63).max(b & 63).max(c & 63);
    let weight = |word: u32| ((word & !63) >> 1 >> (most - (word & 63)).min(31)).max(1);
    [weight(a), weight(b), weight(c)]
}
