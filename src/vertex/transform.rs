//! Object space → clip space: model, camera, viewport and the mesh's quantization folded into one integer matrix.
//!
//! Clip coordinates are homogeneous, so one common scale for all four rows is free. The rows are scaled so that the
//! largest value any vertex can reach just fits the format, and the viewport is folded in: x / w and y / w are screen
//! positions in units of 512 px from the screen's corner, z / w is depth.

use super::clip::{ClipVertex, Outcode};
use super::project::{DepthScale, ScreenVertex, UniformDepth, project, project_short};
use super::viewport::Viewport;
use crate::math::{Projective, SMALL_CORE, Vec3, leading_zeros_long, product};
use crate::mesh::{Bounds, Mesh, Positions};
use core::ops::Range;

/// Model, camera and viewport in one matrix, from object space in 16.16 to the clip space described above, in any scale.
#[derive(Clone, Copy, Debug)]
pub struct ScreenMatrix {
    /// Rows x, y, z, w; the largest entry has 45 bits.
    rows: [[i64; 4]; 4],
    /// Power of two that they are too large by, compared with the raw 32.32 of the matrix.
    scale: i32,
}

/// A vertex transform, made once a draw.
#[derive(Clone, Copy, Debug, Default)]
pub struct Transform {
    /// Rows x, y, z, w.
    rows: [Row; 4],
    /// Whether they are those of the 32-bit path.
    short: bool,
    /// Power of two that clip coordinates are too large by, compared with raw 32.32.
    scale: i32,
    uniform: Option<UniformDepth>,
}

/// A row of the matrix, its entries in two parts.
///
/// # Format
/// The long path computes Σ e p / 2¹⁶ + t, with e = 2¹⁶ high + low below 2⁴⁰, low not negative, |t| < 2⁵⁵. The short path, for
/// quantized positions q, computes Σ m q / 2¹⁵ + t, rounded to nearest, with |m| < 2³⁰ and |t| < 2³⁰. On small cores, m is
/// 2¹⁵ high + low with low in -2¹⁴..2¹⁴, and t is the last entry, for q = 1: its low part has 15 fractional bits and the half that
/// rounds. Cores that multiply to 64 bits have 2 m in `low` and 2³² t in `translation`: the upper word of the sum with
/// Σ 2 m 2¹⁶ q is what is asked for.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    high: [i32; 4],
    low: [i32; 4],
    translation: i64,
}

/// Where a vertex is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projected {
    /// On the screen, or at least within the guard band.
    OnScreen(ScreenVertex),
    /// Outside of the planes in its code.
    NeedsClip(Outcode),
}

/// Outcodes, projection and snapping of a vertex in clip space.
pub fn projected(vertex: &ClipVertex) -> Projected {
    let code = Outcode::of(vertex);
    let placed = if code.0 == 0 { project(vertex) } else { None };
    placed.map_or(Projected::NeedsClip(code), Projected::OnScreen)
}

/// `value / 2^shift`, rounded to nearest; a negative shift multiplies. 0 for shifts above 62.
#[inline(never)]
fn scale(value: i64, shift: i32) -> i64 {
    match shift {
        // Many entries of matrices are 0.
        _ if value == 0 => 0,
        0 => value,
        ..0 => value << -shift,
        1..=62 => ((value >> (shift - 1)) + 1) >> 1,
        _ => 0,
    }
}

/// `a b / 2¹⁶`, rounded down, for |a| < 2⁴⁶: at most 2⁶¹.
#[cfg_attr(target_has_atomic = "32", inline)]
#[cfg_attr(not(target_has_atomic = "32"), inline(never))]
fn times(a: i64, b: i32) -> i64 {
    // The lower half of `a` in two products of 16 bits, below 2³¹ and 2³².
    let (high, low) = ((a >> 16) as i32, a as u32 & 0xFFFF);
    let fraction = low as i32 * (b >> 16) + ((low * (b as u32 & 0xFFFF)) >> 16) as i32;
    product(high, b) + i64::from(fraction)
}

/// Shifts that bring the largest of `values` below 2^`bits`; negative ones if they are smaller.
#[inline(never)]
fn excess(values: &[i64], bits: i32) -> i32 {
    let all = values.iter().fold(0, |all, v| all | v.unsigned_abs());
    64 - leading_zeros_long(all) as i32 - bits
}

/// A bounding box cut to 14 bits, in units of 2^`shift`.
struct ShortBox {
    /// Centre and half size.
    sides: [[i32; 3]; 2],
    shift: u32,
    /// What a sum of products may be too small by.
    off: i32,
}

impl ShortBox {
    fn new(bounds: &Bounds) -> Self {
        let mut sides = [bounds.center.to_bits(), bounds.half.to_bits()];
        let reach = sides.as_flattened().iter().fold(0, |all, c| all | c.unsigned_abs());
        let shift = 50_u32.saturating_sub(leading_zeros_long(reach.into())).max(2);
        // What the entries may be off by takes part in each plane: 2 units times the coordinates and 1, halved.
        let mut off = (1 << 16 >> shift) + 8;
        for c in sides.as_flattened_mut() {
            *c >>= shift;
            off += c.abs();
        }
        Self { sides, shift, off }
    }

    /// Whether `a` `row` + `b` `w` may be positive in it.
    #[inline(never)]
    fn reaches(&self, row: &[i64; 4], a: i32, w: &[i64; 4], b: i32) -> bool {
        let entries: [i64; 4] = core::array::from_fn(|k| row[k] * i64::from(a) + w[k] * i64::from(b));
        let cut = excess(&entries, 15).max(17);
        // The last entry, for a coordinate of 1, which is 2¹⁶ here.
        let mut value = self.off + (((entries[3] >> cut) as i32) << 15 >> self.shift);
        let [center, half] = &self.sides;
        for (entry, (center, half)) in entries.iter().zip(center.iter().zip(half)) {
            let entry = (entry >> cut) as i32;
            let size = entry.abs();
            value += ((entry * center) >> 1) + ((size * half) >> 1) + size;
        }
        value >= 0
    }
}

impl ScreenMatrix {
    /// Of nothing yet.
    pub const EMPTY: Self = Self { rows: [[0; 4]; 4], scale: 0 };

    /// Becomes the matrix that takes object space to clip space with a viewport folded in.
    #[inline(never)]
    pub fn set_from(&mut self, mvp: &Projective, viewport: &Viewport) {
        // 1. The matrix to 44 bits, so that the viewport's 16 fit beside them.
        let shift = excess(mvp.rows().as_flattened(), 44).max(0);
        let cut = |entry: i64| if shift == 0 { entry } else { scale(entry, shift) };
        // 2. The viewport: X px = cx + hw x / w, so X / 512 px = (W x + 2 cx w) / 1024 w; y points down. Below 2⁶⁰.
        let [.., w] = mvp.rows();
        let (width, height) = (i32::from(viewport.width()), i32::from(viewport.height()));
        let (x, y) = (2 * i32::from(viewport.x()) + width, 2 * i32::from(viewport.y()) + height);
        let factors = [(width, x), (-height, y), (1 << 10, 0), (1 << 10, 0)];
        for ((to, row), (size, offset)) in self.rows.iter_mut().zip(mvp.rows()).zip(&factors) {
            for ((to, r), w) in to.iter_mut().zip(row).zip(w) {
                *to = i64::from(*size) * cut(*r);
                if *offset != 0 {
                    *to += i64::from(*offset) * cut(*w);
                }
            }
        }
        let more = excess(self.rows.as_flattened(), 45);
        for entry in self.rows.as_flattened_mut() {
            if *entry != 0 {
                *entry = scale(*entry, more);
            }
        }
        self.scale = 10 - shift - more;
    }

    /// Whether any of a box may be seen in a rectangle of the screen, in pixels at most 2¹⁶ from its corner. The depth
    /// planes in `clamped` do not count. Errs on the side of `true`.
    ///
    /// # Format
    /// Planes are sums of rows, such as 512 x - left w ≥ 0, below 2⁶² and off by less than 2¹⁶. They are cut to 15 bits and a sign,
    /// by a shift of at least 17, and the box to 14 bits, by a shift of at least 2. So entries are off by less than 2 units,
    /// coordinates by less than 1. Products are below 2²⁹; all is counted in halves, so that their sum fits.
    #[inline(never)]
    pub fn sees(&self, bounds: &Bounds, columns: &Range<i32>, lines: &Range<i32>, clamped: Outcode) -> bool {
        let short = ShortBox::new(bounds);
        let [.., w] = &self.rows;
        // Depth is as a coordinate of 512 px, and of the others no plane is left out.
        let axes = [(columns, 0), (lines, 0), (&(0..512), clamped.0)];
        self.rows.iter().zip(axes).all(|(row, (range, clamped))| {
            (clamped & Outcode::FAR != 0 || short.reaches(row, -512, w, range.end))
                && (clamped & Outcode::NEAR != 0 || short.reaches(row, 512, w, -range.start))
        })
    }

    /// The least w in a box.
    ///
    /// # Format
    /// Entries below 2⁴⁵: six products of at most 2⁶⁰.
    #[inline(never)]
    fn least_w(&self, bounds: &Bounds) -> i64 {
        let [.., row] = &self.rows;
        let [.., mut least] = *row;
        let (center, half) = (bounds.center.to_bits(), bounds.half.to_bits());
        for ((entry, center), half) in row.iter().zip(&center).zip(&half) {
            if *entry != 0 {
                least += times(*entry, *center) - times(entry.abs(), *half);
            }
        }
        least
    }
}

/// What a mesh makes of its numbers.
///
/// # Format
/// Positions are p / 2¹⁶, and clip = Σ r p / 2¹⁶ + r3: for all three formats written as Σ e p' / 2³¹ + t with 32-bit p'. Fractions
/// are p' / 2¹⁶: p = offset + scale p' / 2³¹. Below 2⁶².
struct Numbers {
    factor: Option<i32>,
    offset: [i32; 3],
    homogeneous: bool,
}

impl Numbers {
    fn of(mesh: &Mesh<'_>, displaced: bool) -> Self {
        let mut numbers = Self { factor: None, offset: [0; 3], homogeneous: false };
        match &mesh.data().positions {
            _ if displaced => {}
            Positions::Quantized { scale, offset, .. } => {
                numbers.factor = Some(scale.to_bits());
                numbers.offset = offset.to_bits();
            }
            Positions::Homogeneous(_) => numbers.homogeneous = true,
            Positions::Exact(_) => {}
        }
        numbers
    }

    /// t of a row.
    #[inline(never)]
    fn translation(&self, row: &[i64; 4]) -> i64 {
        let mut t = if self.homogeneous { 0 } else { row[3] };
        if self.factor.is_some() {
            for (r, offset) in row.iter().zip(&self.offset) {
                if *offset != 0 {
                    t += times(*r, *offset);
                }
            }
        }
        t
    }

    /// The entries e of a row.
    #[inline]
    fn entries(&self, row: &[i64; 4]) -> impl Iterator<Item = i64> {
        row.iter().take(if self.homogeneous { 4 } else { 3 }).map(|r| match self.factor {
            // As many are.
            _ if *r == 0 => 0,
            Some(factor) => times(*r, factor),
            None => *r << 15,
        })
    }

    /// A quarter of the largest value that a row can reach.
    fn reach(&self, row: &[i64; 4]) -> i64 {
        let t = self.translation(row).unsigned_abs() as i64 >> 2;
        self.entries(row).fold(t, |sum, e| sum + (e.abs() >> 2) + 2)
    }

    /// Makes a row of the transform, cut by `shift` bits.
    fn row(&self, row: &[i64; 4], shift: i32, short: bool, to: &mut Row) {
        to.translation = scale(self.translation(row), shift);
        (to.high[3], to.low[3]) = (0, 0);
        for ((high, low), e) in to.high.iter_mut().zip(&mut to.low).zip(self.entries(row)) {
            // 16 fractional bits: e / 2³¹ · 2¹⁶.
            let e = scale(e, shift + 15);
            (*high, *low) = if !short {
                ((e >> 16) as i32, (e & 0xFFFF) as i32)
            } else {
                // Rounded, but below 2³⁰.
                let m = (((e + (1 << 9)) >> 10) as i32).min((1 << 30) - 1);
                if SMALL_CORE { halves(m) } else { (0, 2 * m) }
            };
        }
        if short {
            let t = (to.translation + (1 << 9)) >> 10;
            if SMALL_CORE {
                (to.high[3], to.low[3]) = ((t >> 15) as i32, (t & 0x7FFF) as i32 + (1 << 14));
                to.translation = 0;
            } else {
                to.translation = (t + (1 << 14)) << 17;
            }
        }
    }
}

/// An entry of the short path in two: 2¹⁵ high + low, low in -2¹⁴..2¹⁴, so that three products with |q| ≤ 2¹⁵ stay below 2³¹.
#[inline(always)]
const fn halves(m: i32) -> (i32, i32) {
    let low = ((m & 0x7FFF) ^ 0x4000) - 0x4000;
    ((m - low) >> 15, low)
}

impl Row {
    /// A clip coordinate, by either path.
    ///
    /// # Format
    /// |p| ≤ 2³¹, entries below 2²⁴ whole: products below 2⁵⁵ whose sum was bounded; fractions below 2¹⁶ · 2³¹.
    #[inline(never)]
    fn apply(&self, p: &[i32; 4], short: bool) -> i64 {
        let (mut value, mut fraction) = (self.translation, 0_i64);
        for ((high, low), p) in self.high.iter().zip(&self.low).zip(p) {
            value += product(*high, *p);
            fraction += product(*low, *p);
        }
        if short && !SMALL_CORE {
            return (value + fraction) >> 32;
        }
        fraction >>= 15;
        value + if short { fraction } else { fraction >> 1 }
    }

    /// The short path.
    ///
    /// # Format
    /// Small cores add up products below 2³⁰, to sums that are below 2³¹ as the result is not above 2³⁰ + 1.
    #[inline(always)]
    fn apply_short(&self, q: [i16; 3]) -> i32 {
        let q = [i32::from(q[0]), i32::from(q[1]), i32::from(q[2])];
        if SMALL_CORE { self.short_by_halves(q) } else { self.short_by_words(q) }
    }

    #[inline(always)]
    fn short_by_halves(&self, [x, y, z]: [i32; 3]) -> i32 {
        let [lx, ly, lz, lt] = self.low;
        let [hx, hy, hz, t] = self.high;
        hx * x + hy * y + hz * z + t + ((lx * x + ly * y + lz * z + lt) >> 15)
    }

    #[inline(always)]
    fn short_by_words(&self, [x, y, z]: [i32; 3]) -> i32 {
        let [lx, ly, lz, _] = self.low;
        let product = |m: i32, q: i32| i64::from(m) * i64::from(q << 16);
        ((self.translation + product(lx, x) + product(ly, y) + product(lz, z)) >> 32) as i32
    }
}

impl Transform {
    /// Folds everything that maps a mesh's numbers to the screen into one matrix.
    ///
    /// `displaced` asks for a transform of 16.16 positions whatever the mesh's own format is, for vertex shaders that
    /// move vertices.
    pub fn new(mvp: &Projective, viewport: &Viewport, mesh: &Mesh<'_>, displaced: bool) -> Self {
        let mut transform = Self::default();
        let mut view = ScreenMatrix::EMPTY;
        view.set_from(mvp, viewport);
        transform.set_from(&view, mesh, displaced);
        transform
    }

    /// Becomes the transform of a mesh, from a matrix that has the viewport in it.
    ///
    /// # Format
    /// Entries keep 40 significant bits relative to the largest value a vertex can reach, so a vertex is off by less
    /// than 2⁻³⁷ of it. Clip coordinates stay below 2⁵⁵ + 2.
    #[inline(never)]
    pub fn set_from(&mut self, view: &ScreenMatrix, mesh: &Mesh<'_>, displaced: bool) {
        let numbers = Numbers::of(mesh, displaced);
        // One shift for all, so that the largest reachable value is just below 2⁵⁵.
        let shift = excess(&[view.rows.iter().fold(0, |reach, row| reach | numbers.reach(row))], 53);
        let least_w = view.least_w(mesh.bounds());
        self.short = numbers.factor.is_some() && scale(least_w, shift) >= Self::SHORT_W;
        (self.scale, self.uniform) = (view.scale - shift, None);
        for (row, from) in self.rows.iter_mut().zip(&view.rows) {
            numbers.row(from, shift, self.short, row);
        }
    }

    /// Sets how depth grows with distance.
    pub const fn set_depth_scale(&mut self, depth_scale: DepthScale) {
        self.uniform = match depth_scale {
            DepthScale::Perspective => None,
            DepthScale::Uniform { far } => UniformDepth::new(far, self.scale),
        };
    }

    /// Divides by w and snaps; `None` unless w > 0.
    pub fn project(&self, vertex: &ClipVertex) -> Option<ScreenVertex> {
        // Clip coordinates of the short path are 2²⁵ units of the long one's.
        project(vertex).map(|placed| self.with_depth(placed, if self.short { vertex.z << 25 } else { vertex.z }))
    }

    /// A vertex on the screen with its depth, from z of the long path.
    #[inline]
    fn with_depth(&self, vertex: ScreenVertex, z: i64) -> ScreenVertex {
        match &self.uniform {
            Some(uniform) => ScreenVertex { z: uniform.depth(z), ..vertex },
            None => vertex,
        }
    }

    /// The least w, on the scale of the long path, for which quantized positions take the short one.
    ///
    /// # Format
    /// Values of the short path are those of the long one / 2²⁵, below 2³⁰ and a little, off by at most 3.5: half a unit from each of
    /// three entries, of which one may lose another half to stay below 2³⁰, half from the constant and one from the cut; 4 are
    /// added, so that w is not below 2²⁶ for that. With w ≥ 2²⁶, a screen position, 2¹⁷ x / w in 1/256 px, is off by at most
    /// 2¹⁷ · 3.5 · (1 + |x / w|) / w: 2⁻⁶ on a screen of 512 px, and below 1/8 as far as |x / w| < 16 lets it be, which is well
    /// inside the guard band.
    const SHORT_W: i64 = (1 << 51) + (4 << 25);

    /// Clip coordinates of a mesh vertex; the origin for an index past the end.
    #[inline(never)]
    pub fn vertex(&self, positions: &Positions<'_>, index: usize) -> ClipVertex {
        self.apply(&self.numbers(positions, index))
    }

    /// w of [`vertex`](Self::vertex).
    pub(crate) fn w(&self, positions: &Positions<'_>, index: usize) -> i64 {
        let [.., w] = &self.rows;
        w.apply(&self.numbers(positions, index), self.short)
    }

    /// What the rows are applied to.
    #[inline]
    fn numbers(&self, positions: &Positions<'_>, index: usize) -> [i32; 4] {
        let mut p = positions.numbers(index);
        if self.short && SMALL_CORE {
            p[3] = 1;
        } else if let Positions::Quantized { .. } = positions {
            for c in &mut p {
                *c <<= 16;
            }
        }
        p
    }

    /// Where a mesh vertex is on the screen, or which planes keep it off.
    #[inline]
    pub fn project_vertex(&self, positions: &Positions<'_>, index: usize) -> Projected {
        if let (Positions::Quantized { points, .. }, true) = (positions, self.short) {
            return match self.project_quantized(points.get(index).copied().unwrap_or_default()) {
                (Projected::OnScreen(placed), z) => Projected::OnScreen(self.with_depth(placed, i64::from(z) << 25)),
                (outside, _) => outside,
            };
        }
        self.project_clip_vertex(&self.vertex(positions, index))
    }

    /// The positions of a mesh if all that [`project_vertex`](Self::project_vertex) does with them is [`project_quantized`](Self::project_quantized).
    #[inline]
    pub(crate) fn short_points<'p>(&self, positions: &Positions<'p>) -> Option<&'p [[i16; 3]]> {
        match positions {
            Positions::Quantized { points, .. } if self.short && self.uniform.is_none() => Some(points),
            _ => None,
        }
    }

    /// [`project_vertex`](Self::project_vertex) by the short path, perspective depth for all depth scales; and z.
    #[inline(always)]
    pub(crate) fn project_quantized(&self, q: [i16; 3]) -> (Projected, i32) {
        let [x, y, z, w] = &self.rows;
        let (w, z) = (w.apply_short(q), z.apply_short(q));
        // In the short path's range of w, only the near and the far plane are left to be outside of.
        let placed = if (z as u32) <= w as u32 {
            Projected::OnScreen(project_short([x.apply_short(q), y.apply_short(q), z, w]))
        } else {
            Projected::NeedsClip(Outcode(if z < 0 { Outcode::NEAR } else { Outcode::FAR }))
        };
        (placed, z)
    }

    /// Where a vertex in clip space is on the screen, or which planes keep it off.
    pub fn project_clip_vertex(&self, vertex: &ClipVertex) -> Projected {
        match projected(vertex) {
            Projected::OnScreen(placed) => Projected::OnScreen(self.with_depth(placed, vertex.z)),
            outside => outside,
        }
    }

    /// Clip coordinates of a 16.16 position, of a transform made for those.
    pub fn point(&self, position: Vec3) -> ClipVertex {
        let [x, y, z] = position.to_bits();
        self.apply(&[x, y, z, 0])
    }

    /// Whether vertices take the 32-bit path.
    pub const fn is_short(&self) -> bool {
        self.short
    }

    /// Both paths, coordinate by coordinate: the long one, and the short one for the few vertices that are clipped.
    #[inline(never)]
    fn apply(&self, p: &[i32; 4]) -> ClipVertex {
        let [x, y, z, w] = core::array::from_fn(|k| self.rows[k].apply(p, self.short));
        ClipVertex { x, y, z, w }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    #[test]
    fn short_rows_are_rounded_sums_of_products() {
        let mut rng = Rng::new(1);
        let mut random = |bits: u32| rng.signed_bits(bits) as i32;
        for _ in 0..100_000 {
            // Entries of 28 bits and a sign, the last with 15 fractional bits.
            let m = [random(29), random(29), random(29)];
            let t = i64::from(random(29)) << 15 | i64::from(random(16) & 0x7FFF);
            let q = [random(16) as i16, random(16) as i16, random(16) as i16];
            let sum = (0..3).fold(t + (1 << 14), |sum, k| sum + i64::from(m[k]) * i64::from(q[k])) >> 15;
            let [a, b, c] = m;
            let row = Row { high: [0; 4], low: [2 * a, 2 * b, 2 * c, 0], translation: (t + (1 << 14)) << 17 };
            let numbers = q.map(i32::from);
            assert_eq!(i64::from(row.short_by_words(numbers)), sum, "{m:?} {t} {q:?}");
            let ((ah, al), (bh, bl), (ch, cl)) = (halves(a), halves(b), halves(c));
            let (high, low) = ([ah, bh, ch, (t >> 15) as i32], [al, bl, cl, (t & 0x7FFF) as i32 + (1 << 14)]);
            let small = Row { high, low, translation: 0 };
            assert_eq!(i64::from(small.short_by_halves(numbers)), sum, "{m:?} {t} {q:?}");
            let [x, y, z] = q.map(|q| i32::from(q) << 16);
            assert_eq!(row.apply(&[x, y, z, 0], true), sum, "{m:?} {t} {q:?}");
        }
    }

    #[test]
    fn times_is_a_product_rounded_down() {
        let mut rng = Rng::new(1);
        let mut next = || rng.next_u64() as i64;
        for _ in 0..200_000 {
            let (a, b) = (next() >> (18 + (next() & 31)), (next() >> (32 + (next() & 31))) as i32);
            for b in [b, i32::MIN, i32::MAX] {
                let exact = i128::from(a) * i128::from(b);
                assert_eq!(i128::from(times(a, b)), exact >> 16, "{a} {b}");
            }
        }
    }
}
