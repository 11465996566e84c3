//! Object space → clip space: model, camera, viewport and the mesh's quantization come in, and are folded into one
//! integer matrix. Vertices of the mesh then come out in clip space or on the screen.
//!
//! Clip coordinates are homogeneous, so one common scale for all four rows may be chosen freely. The rows are scaled so
//! that the largest value that any vertex can reach just fits the format. The viewport is folded in: x / w and y / w
//! are screen positions in units of 512 px from the screen's corner, and z / w is depth.

use super::clip::{ClipVertex, Outcode};
use super::packed::PackedVertex;
use super::project::{
    DepthScale, Projected, ScreenVertex, UniformDepth, inverse_w, inverse_w_short, project, project_short, projected,
};
use super::viewport::Viewport;
use crate::math::{Projective, SMALL_CORE, Vec3, leading_zeros_long, mul_wide};
use crate::mesh::{Bounds, Mesh, Positions};
use core::ops::Range;

/// Model, camera and viewport in one matrix, from object space in 16.16 to the clip space of the module's
/// documentation, in any scale.
#[derive(Clone, Copy, Debug)]
pub struct ScreenMatrix {
    /// Rows x, y, z, w; the largest entry has 45 bits.
    pub(super) rows: [[i64; 4]; 4],
    /// Exponent of the power of two by which the rows exceed the raw 32.32 values of the matrix.
    scale: i32,
}

/// A vertex transform, made once per draw.
#[derive(Clone, Copy, Debug, Default)]
pub struct Transform {
    /// Rows x, y, z, w.
    rows: [Row; 4],
    /// Set if the rows are those of the 32-bit path.
    short: bool,
    /// Exponent of the power of two by which clip coordinates exceed raw 32.32 values.
    scale: i32,
    uniform: Option<UniformDepth>,
}

/// A row of the matrix, with its entries in two parts.
///
/// # Format
/// The long path computes Σ e p / 2¹⁶ + t, with e = 2¹⁶ high + low below 2⁴⁰, low not negative, |t| < 2⁵⁵.
///
/// The short path, for quantized positions q, computes Σ m q / 2¹⁵ + t, rounded to nearest, with |m| < 2³⁰ and
/// |t| < 2³⁰. On small cores, m is 2¹⁵ high + low with low in -2¹⁴..2¹⁴, and t is the last entry, for q = 1. The low
/// part of t has 15 fractional bits and includes the half that rounds. Cores that multiply to 64 bits have 2 m in
/// `low`, and 2³² t in `translation`: the result is the upper word of the sum with Σ 2 m 2¹⁶ q.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    high: [i32; 4],
    low: [i32; 4],
    translation: i64,
}

/// Returns `value / 2^shift`, rounded to nearest; a negative shift multiplies. The result is 0 for shifts above 62.
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

/// Returns `a b / 2¹⁶`, rounded down, for |a| < 2⁴⁶. The result is at most 2⁶¹.
#[cfg_attr(target_has_atomic = "32", inline)]
#[cfg_attr(not(target_has_atomic = "32"), inline(never))]
pub(super) fn times(a: i64, b: i32) -> i64 {
    // The lower half of `a` takes part in two products of 16 bits, below 2³¹ and 2³².
    let (high, low) = ((a >> 16) as i32, a as u32 & 0xFFFF);
    let fraction = low as i32 * (b >> 16) + ((low * (b as u32 & 0xFFFF)) >> 16) as i32;
    mul_wide(high, b) + i64::from(fraction)
}

/// Returns by how many bits the largest of `values` exceeds 2^`bits`; negative if it is smaller.
#[inline(never)]
fn excess(values: &[i64], bits: i32) -> i32 {
    let all = values.iter().fold(0, |all, v| all | v.unsigned_abs());
    64 - leading_zeros_long(all) as i32 - bits
}

/// A plane, cut to 15 bits and a sign.
type ShortPlane = [i32; 4];

/// Returns the plane `a` `row` + `b` `w`.
#[inline(always)]
fn short_plane(row: &[i64; 4], a: i32, w: &[i64; 4], b: i32) -> ShortPlane {
    let entries: [i64; 4] = core::array::from_fn(|k| row[k] * i64::from(a) + w[k] * i64::from(b));
    let cut = excess(&entries, 15).max(17);
    entries.map(|entry| (entry >> cut) as i32)
}

/// The sides of a part of the view volume. See [`ScreenMatrix::set_planes`].
pub struct Planes([[ShortPlane; 2]; 3]);

impl Planes {
    /// Sides that see everything: a place for [`ScreenMatrix::set_planes`] to fill.
    pub const EMPTY: Self = Self([[[0; 4]; 2]; 3]);

    /// Returns whether any part of a box may be visible, as [`ScreenMatrix::sees`] does.
    #[inline(never)]
    pub fn sees(&self, bounds: &Bounds) -> bool {
        let short = ShortBox::new(bounds);
        self.0.as_flattened().iter().all(|plane| short.reaches_plane(plane))
    }
}

/// A bounding box cut to 14 bits, in units of 2^`shift`.
struct ShortBox {
    /// Centre and half size of the box.
    sides: [[i32; 3]; 2],
    shift: u32,
    /// Bound of what a sum of products may be too small by.
    slack: i32,
}

impl ShortBox {
    fn new(bounds: &Bounds) -> Self {
        let mut sides = [bounds.center.to_bits(), bounds.half.to_bits()];
        let reach = sides.as_flattened().iter().fold(0, |all, c| all | c.unsigned_abs());
        let shift = 50_u32.saturating_sub(leading_zeros_long(reach.into())).max(2);
        // The error of the entries takes part in each plane: 2 units times the coordinates and times 1, halved.
        let mut slack = (1 << 16 >> shift) + 8;
        for c in sides.as_flattened_mut() {
            *c >>= shift;
            slack += c.abs();
        }
        Self { sides, shift, slack }
    }

    /// Returns whether `a` `row` + `b` `w` may be positive anywhere in the box.
    #[inline(never)]
    fn reaches(&self, row: &[i64; 4], a: i32, w: &[i64; 4], b: i32) -> bool {
        self.reaches_plane(&short_plane(row, a, w, b))
    }

    /// Returns whether a plane may be positive anywhere in the box.
    #[inline(always)]
    fn reaches_plane(&self, plane: &ShortPlane) -> bool {
        let [.., last] = plane;
        // The last entry belongs to a coordinate of 1, which is 2¹⁶ here.
        let mut value = self.slack + (*last << 15 >> self.shift);
        let [center, half] = &self.sides;
        for (entry, (center, half)) in plane.iter().zip(center.iter().zip(half)) {
            let size = entry.abs();
            value += ((entry * center) >> 1) + ((size * half) >> 1) + size;
        }
        value >= 0
    }
}

impl ScreenMatrix {
    /// The zero matrix: a place for [`set_from`](Self::set_from) to fill.
    pub const EMPTY: Self = Self { rows: [[0; 4]; 4], scale: 0 };

    /// Sets the matrix to the one that takes object space to clip space with a viewport folded in.
    #[inline(never)]
    pub fn set_from(&mut self, mvp: &Projective, viewport: &Viewport) {
        // 1. Cut the matrix to 44 bits, so that the 16 bits of the viewport fit beside them.
        let shift = excess(mvp.rows().as_flattened(), 44).max(0);
        let cut = |entry: i64| if shift == 0 { entry } else { scale(entry, shift) };
        // 2. Fold in the viewport: X px = cx + hw x / w, so X / 512 px = (W x + 2 cx w) / 1024 w; y points down. The
        //    result is below 2⁶⁰.
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

    /// Returns whether any part of a box may be visible in a rectangle of the screen, given in pixels at most 2¹⁶ from
    /// the screen's corner. The depth planes in `clamped` do not count. Errs on the side of `true`.
    ///
    /// # Format
    /// Planes are sums of rows, such as 512 x - left w ≥ 0, below 2⁶² and off by less than 2¹⁶. They are cut to 15 bits
    /// and a sign, by a shift of at least 17, and the box is cut to 14 bits, by a shift of at least 2. So entries are
    /// off by less than 2 units, and coordinates by less than 1. Products are below 2²⁹; all terms are counted in
    /// halves, so that their sum fits.
    #[inline(never)]
    pub fn sees(&self, bounds: &Bounds, columns: &Range<i32>, lines: &Range<i32>, clamped: Outcode) -> bool {
        let short = ShortBox::new(bounds);
        let [.., w] = &self.rows;
        // Depth is handled as a coordinate of 512 px. Of the planes of x and y, none is left out.
        let axes = [(columns, 0), (lines, 0), (&(0..512), clamped.0)];
        self.rows.iter().zip(axes).all(|(row, (range, clamped))| {
            (clamped & Outcode::FAR != 0 || short.reaches(row, -512, w, range.end))
                && (clamped & Outcode::NEAR != 0 || short.reaches(row, 512, w, -range.start))
        })
    }

    /// Sets planes to those that [`sees`](Self::sees) tests, for tests of many boxes: a test by them takes some 380
    /// instructions on a Cortex-M0+, instead of 3,800. A side that does not count is 0, which every box reaches.
    #[inline(never)]
    pub fn set_planes(&self, planes: &mut Planes, columns: &Range<i32>, lines: &Range<i32>, clamped: Outcode) {
        let [.., w] = &self.rows;
        let axes = [(columns, 0), (lines, 0), (&(0..512), clamped.0)];
        for (([end, start], row), (range, clamped)) in planes.0.iter_mut().zip(&self.rows).zip(axes) {
            if clamped & Outcode::FAR == 0 {
                *end = short_plane(row, -512, w, range.end);
            }
            if clamped & Outcode::NEAR == 0 {
                *start = short_plane(row, 512, w, -range.start);
            }
        }
    }

    /// Returns the least w in a box.
    ///
    /// # Format
    /// Entries are below 2⁴⁵: six products of at most 2⁶⁰.
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

/// Relation between the numbers that a mesh stores and its positions.
///
/// # Format
/// Positions are p / 2¹⁶, and clip = Σ r p / 2¹⁶ + r3. For all three formats, this is written as Σ e p' / 2³¹ + t with
/// 32-bit p'. Stored fractions are p' / 2¹⁶, with p = offset + scale p' / 2³¹. Entries are below 2⁶².
struct NumberFormat {
    factor: Option<i32>,
    offset: [i32; 3],
    homogeneous: bool,
}

impl NumberFormat {
    fn of(mesh: &Mesh<'_>, displaced: bool) -> Self {
        let mut format = Self { factor: None, offset: [0; 3], homogeneous: false };
        match &mesh.data().positions {
            _ if displaced => {}
            Positions::Quantized { scale, offset, .. } => {
                format.factor = Some(scale.to_bits());
                format.offset = offset.to_bits();
            }
            Positions::Homogeneous(_) => format.homogeneous = true,
            Positions::Exact(_) => {}
        }
        format
    }

    /// Returns t of a row.
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

    /// Returns the entries e of a row.
    #[inline]
    fn entries(&self, row: &[i64; 4]) -> impl Iterator<Item = i64> {
        row.iter().take(if self.homogeneous { 4 } else { 3 }).map(|r| match self.factor {
            // Many entries are 0.
            _ if *r == 0 => 0,
            Some(factor) => times(*r, factor),
            None => *r << 15,
        })
    }

    /// Returns a quarter of the largest value that a row can reach.
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
                // Rounded, but kept below 2³⁰.
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

/// Splits an entry of the short path in two: 2¹⁵ high + low, low in -2¹⁴..2¹⁴, so that three products with |q| ≤ 2¹⁵
/// stay below 2³¹.
#[inline(always)]
const fn halves(m: i32) -> (i32, i32) {
    let low = ((m & 0x7FFF) ^ 0x4000) - 0x4000;
    ((m - low) >> 15, low)
}

impl Row {
    /// Computes a clip coordinate, by either path.
    ///
    /// # Format
    /// |p| ≤ 2³¹. Whole parts of entries are below 2²⁴: their products are below 2⁵⁵, and their sum was bounded.
    /// Fractions are below 2¹⁶ · 2³¹.
    #[inline(never)]
    fn apply(&self, p: &[i32; 4], short: bool) -> i64 {
        let (mut value, mut fraction) = (self.translation, 0_i64);
        for ((high, low), p) in self.high.iter().zip(&self.low).zip(p) {
            value += mul_wide(*high, *p);
            fraction += mul_wide(*low, *p);
        }
        if short && !SMALL_CORE {
            return (value + fraction) >> 32;
        }
        fraction >>= 15;
        value + if short { fraction } else { fraction >> 1 }
    }

    /// Computes a clip coordinate by the short path.
    ///
    /// # Format
    /// Small cores add up products below 2³⁰. The sums are below 2³¹, because the result is not above 2³⁰ + 1.
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
    /// Folds all steps from a mesh's numbers to the screen into one matrix.
    ///
    /// `displaced` asks for a transform of 16.16 positions, whatever the mesh's own format is. Vertex shaders that move
    /// vertices need it.
    pub fn new(mvp: &Projective, viewport: &Viewport, mesh: &Mesh<'_>, displaced: bool) -> Self {
        let mut transform = Self::default();
        let mut view = ScreenMatrix::EMPTY;
        view.set_from(mvp, viewport);
        transform.set_from(&view, mesh, displaced);
        transform
    }

    /// Sets the transform to that of a mesh, from a matrix that has the viewport in it.
    ///
    /// # Format
    /// Entries keep 40 significant bits relative to the largest value that a vertex can reach, so a vertex is off by
    /// less than 2⁻³⁷ of this value. Clip coordinates stay below 2⁵⁵ + 2.
    #[inline(never)]
    pub fn set_from(&mut self, view: &ScreenMatrix, mesh: &Mesh<'_>, displaced: bool) {
        let format = NumberFormat::of(mesh, displaced);
        // One shift for all rows, so that the largest reachable value is just below 2⁵⁵.
        let shift = excess(&[view.rows.iter().fold(0, |reach, row| reach | format.reach(row))], 53);
        let least_w = view.least_w(mesh.bounds());
        self.short = format.factor.is_some() && scale(least_w, shift) >= Self::SHORT_W;
        (self.scale, self.uniform) = (view.scale - shift, None);
        for (row, from) in self.rows.iter_mut().zip(&view.rows) {
            format.row(from, shift, self.short, row);
        }
    }

    /// Sets the growth of depth with distance.
    pub const fn set_depth_scale(&mut self, depth_scale: DepthScale) {
        self.uniform = match depth_scale {
            DepthScale::Perspective => None,
            DepthScale::Uniform { far } => UniformDepth::new(far, self.scale),
        };
    }

    /// Divides a vertex by w and snaps it; `None` unless w > 0.
    pub fn project(&self, vertex: &ClipVertex) -> Option<ScreenVertex> {
        // One unit of a clip coordinate of the short path is 2²⁵ units of the long path.
        project(vertex).map(|placed| self.with_depth(placed, if self.short { vertex.z << 25 } else { vertex.z }))
    }

    /// Returns a vertex on the screen with its depth, from z of the long path.
    #[inline]
    fn with_depth(&self, vertex: ScreenVertex, z: i64) -> ScreenVertex {
        match &self.uniform {
            Some(uniform) => ScreenVertex { z: uniform.depth(z), ..vertex },
            None => vertex,
        }
    }

    /// The least w, on the scale of the long path, for which quantized positions take the short path.
    ///
    /// # Format
    /// Values of the short path are those of the long path / 2²⁵: below 2³⁰ and a little, and off by at most 3.5 units.
    /// Each of three entries is off by half a unit, one of them may lose another half to stay below 2³⁰, the constant
    /// is off by half, and the cut by one. 4 units are added, so that w does not fall below 2²⁶ because of these
    /// errors. With w ≥ 2²⁶, a screen position, 2¹⁷ x / w in 1/256 px, is off by at most 2¹⁷ · 3.5 · (1 + |x / w|) / w:
    /// by 2⁻⁶ on a screen of 512 px, and by less than 1/8 as long as |x / w| < 16, which is well inside the guard band.
    const SHORT_W: i64 = (1 << 51) + (4 << 25);

    /// Returns the clip coordinates of a mesh vertex; the origin for an index past the end.
    #[inline(never)]
    pub fn vertex(&self, positions: &Positions<'_>, index: usize) -> ClipVertex {
        self.apply(&self.numbers(positions, index))
    }

    /// Returns w of [`vertex`](Self::vertex).
    pub(crate) fn w(&self, positions: &Positions<'_>, index: usize) -> i64 {
        let [.., w] = &self.rows;
        w.apply(&self.numbers(positions, index), self.short)
    }

    /// Returns 1 / w of a mesh vertex, see [`inverse_w`].
    #[inline(always)]
    pub(crate) fn inverse_w(&self, positions: &Positions<'_>, index: usize) -> u32 {
        if let (Positions::Quantized { points, .. }, true) = (positions, self.short) {
            let [.., w] = &self.rows;
            return inverse_w_short(w.apply_short(points.get(index).copied().unwrap_or_default()));
        }
        inverse_w(&ClipVertex { w: self.w(positions, index), ..ClipVertex::default() })
    }

    /// Returns the four numbers of a vertex that the rows are applied to.
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

    /// Returns the position of a mesh vertex on the screen, or the planes that it is outside of.
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

    /// Projects a vertex of a mesh as [`project_vertex`](Self::project_vertex) does, and packs the result. Shares the
    /// loop of [`project_all`](Self::project_all).
    #[inline(never)]
    pub(crate) fn project_packed(&self, positions: &Positions<'_>, index: usize) -> PackedVertex {
        let (Positions::Quantized { points, .. }, true) = (positions, self.short) else {
            return PackedVertex::new(&self.project_clip_vertex(&self.vertex(positions, index)));
        };
        let mut place = [PackedVertex::NONE_WORDS];
        self.project_all(points.get(index..).unwrap_or_default(), &mut place);
        let [place] = place.map(PackedVertex::of);
        match &self.uniform {
            Some(uniform) if place.is_on_screen() => {
                let [_, _, z, _] = &self.rows;
                let depth = uniform.depth(z.apply(&self.numbers(positions, index), true) << 25);
                PackedVertex::new(&Projected::OnScreen(ScreenVertex { z: depth, ..place.screen() }))
            }
            _ => place,
        }
    }

    /// Projects the positions of a mesh by the short path, with perspective depth, to one place each.
    #[inline(never)]
    pub(crate) fn project_all(&self, points: &[[i16; 3]], places: &mut [[u32; 2]]) {
        for (place, point) in places.iter_mut().zip(points) {
            // `black_box` makes the compiler read the transform again per vertex: there are too few registers to hold
            // all of it.
            *place = PackedVertex::new(&core::hint::black_box(self).project_quantized(*point).0).words();
        }
    }

    /// Returns the positions of a mesh, if [`project_vertex`](Self::project_vertex) does nothing more with them than
    /// [`project_quantized`](Self::project_quantized).
    #[inline]
    pub(crate) fn short_points<'p>(&self, positions: &Positions<'p>) -> Option<&'p [[i16; 3]]> {
        match positions {
            Positions::Quantized { points, .. } if self.short && self.uniform.is_none() => Some(points),
            _ => None,
        }
    }

    /// Projects a quantized position as [`project_vertex`](Self::project_vertex) does, by the short path and with
    /// perspective depth whatever the depth scale is. Returns z, too.
    #[inline(always)]
    pub(crate) fn project_quantized(&self, q: [i16; 3]) -> (Projected, i32) {
        let [x, y, z, w] = &self.rows;
        let (w, z) = (w.apply_short(q), z.apply_short(q));
        // With w in the short path's range, a vertex can only be outside of the near and the far plane.
        let placed = if (z as u32) <= w as u32 {
            Projected::OnScreen(project_short([x.apply_short(q), y.apply_short(q), z, w]))
        } else {
            Projected::NeedsClip(Outcode(if z < 0 { Outcode::NEAR } else { Outcode::FAR }))
        };
        (placed, z)
    }

    /// Returns the position of a vertex in clip space on the screen, or the planes that it is outside of.
    pub fn project_clip_vertex(&self, vertex: &ClipVertex) -> Projected {
        match projected(vertex) {
            Projected::OnScreen(placed) => Projected::OnScreen(self.with_depth(placed, vertex.z)),
            outside => outside,
        }
    }

    /// Returns the clip coordinates of a 16.16 position. The transform must be one for such positions.
    pub fn point(&self, position: Vec3) -> ClipVertex {
        let [x, y, z] = position.to_bits();
        self.apply(&[x, y, z, 0])
    }

    /// Returns whether vertices take the 32-bit path.
    pub const fn is_short(&self) -> bool {
        self.short
    }

    /// Computes a clip vertex, coordinate by coordinate, by either path. Of the vertices on the short path, only those
    /// that are clipped come here.
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
            // Entries have 28 bits and a sign; the last one has 15 fractional bits.
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
