//! Object space → clip space: model, camera, viewport and the mesh's quantization folded into one integer matrix.
//!
//! Clip coordinates are homogeneous, so one common scale for all four rows is free. The rows are scaled so that the
//! largest value any vertex can reach just fits the format, and the viewport is folded in: x / w and y / w are screen
//! positions in units of 512 px from the screen's corner, z / w is depth.

use super::clip::{ClipVertex, Outcode};
use super::project::{DepthScale, ScreenVertex, UniformDepth, project, project_short};
use super::{BoundingBox, Mesh, Positions, Viewport};
use crate::math::{Projective, SMALL_CORE, Vec3, leading_zeros};
use core::ops::Range;

/// Model, camera and viewport in one matrix, from object space in 16.16 to the clip space described above, in any scale.
#[derive(Clone, Copy, Debug)]
pub struct View {
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
/// quantized positions q, computes Σ m q / 2¹⁵, with m = 2¹⁵ high + low below 2³⁰, low in -2¹⁴..2¹⁴ but for the last: that
/// entry, for q = 1, is the translation, and its low half has the half that rounds. Cores that multiply to 64 bits have all of m
/// in `high`, and that entry in `translation`.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    high: [i32; 4],
    low: [i32; 4],
    translation: i64,
}

/// Where a vertex is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placed {
    /// On the screen, or at least within the guard band.
    Screen(ScreenVertex),
    /// Outside of the planes in its code.
    Outside(Outcode),
}

/// Outcodes, projection and snapping of a vertex in clip space.
#[inline(never)]
pub fn place(vertex: &ClipVertex) -> Placed {
    let code = Outcode::of(vertex);
    match project(vertex) {
        Some(v) if code.0 == 0 => Placed::Screen(v),
        _ => Placed::Outside(code),
    }
}

/// `value / 2^shift`, rounded to nearest; a negative shift multiplies. 0 for shifts above 62.
#[inline(never)]
fn scale(value: i64, shift: i32) -> i64 {
    match shift {
        ..=0 => value << -shift,
        1..=62 => ((value >> (shift - 1)) + 1) >> 1,
        _ => 0,
    }
}

/// `a b / 2¹⁶`, rounded down, for |a| < 2⁴⁶ and |b| ≤ 2³¹: at most 2⁶¹.
#[inline(never)]
fn times(a: i64, b: i64) -> i64 {
    (a >> 16) * b + (((a & 0xFFFF) * b) >> 16)
}

/// Shifts that bring the largest of `values` below 2^`bits`; negative ones if they are smaller.
#[inline(never)]
fn excess(values: &[i64], bits: i32) -> i32 {
    let all = values.iter().fold(0, |all, v| all | v.unsigned_abs());
    64 - all.leading_zeros() as i32 - bits
}

impl View {
    /// Folds a viewport into the matrix that takes object space to clip space.
    #[inline]
    pub fn new(mvp: &Projective, viewport: &Viewport) -> Self {
        let mut view = Self { rows: [[0; 4]; 4], scale: 0 };
        view.fold(mvp, viewport);
        view
    }

    #[inline(never)]
    fn fold(&mut self, mvp: &Projective, viewport: &Viewport) {
        let entries = mvp.rows();
        // 1. The matrix to 44 bits, so that the viewport's 16 fit beside them.
        let shift = excess(entries.as_flattened(), 44).max(0);
        // 2. The viewport: X px = cx + hw x / w, so X / 512 px = (W x + 2 cx w) / 1024 w; y points down. Below 2⁶⁰.
        let [rx, ry, rz, rw] = &mut self.rows;
        let [mx, my, mz, mw] = entries;
        let axis = |x: i64, w: i64, size: i64, corner: i16| size * x + (2 * i64::from(corner) + size.abs()) * w;
        let (width, height) = (i64::from(viewport.width()), i64::from(viewport.height()));
        for ((((rx, ry), rz), rw), (((mx, my), mz), mw)) in
            rx.iter_mut().zip(ry).zip(rz).zip(rw).zip(mx.iter().zip(my).zip(mz).zip(mw))
        {
            let w = scale(*mw, shift);
            *rx = axis(scale(*mx, shift), w, width, viewport.x());
            *ry = axis(scale(*my, shift), w, -height, viewport.y());
            *rz = scale(*mz, shift) << 10;
            *rw = w << 10;
        }
        let more = excess(self.rows.as_flattened(), 45);
        for entry in self.rows.as_flattened_mut() {
            *entry = scale(*entry, more);
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
    pub fn sees(&self, aabb: &BoundingBox, columns: &Range<i32>, lines: &Range<i32>, clamped: Outcode) -> bool {
        let (center, half) = (aabb.center.to_bits(), aabb.half.to_bits());
        let reach = center.iter().zip(half).fold(0, |all, (c, h)| all | c.unsigned_abs() | h.unsigned_abs());
        let shift = 18_u32.saturating_sub(leading_zeros(reach)).max(2);
        // What the entries may be off by takes part in each plane: 2 units times the coordinates and 1, halved.
        let mut off = (1 << 16 >> shift) + 8;
        for (center, half) in center.iter().zip(half) {
            off += (center >> shift).abs() + (half >> shift);
        }
        let [x, y, z, w] = &self.rows;
        for plane in 0..6 {
            let (row, a, b) = match plane {
                0 => (x, 512, -columns.start),
                1 => (x, -512, columns.end),
                2 => (y, 512, -lines.start),
                3 => (y, -512, lines.end),
                4 if clamped.0 & Outcode::NEAR == 0 => (z, 512, 0),
                5 if clamped.0 & Outcode::FAR == 0 => (z, -512, 512),
                _ => continue,
            };
            let mut entries = [0; 4];
            for ((entry, r), w) in entries.iter_mut().zip(row).zip(w) {
                *entry = r * a + w * i64::from(b);
            }
            let cut = excess(&entries, 15).max(17);
            // The last entry, for a coordinate of 1, which is 2¹⁶ here.
            let mut value = off + (((entries[3] >> cut) as i32) << 15 >> shift);
            for (entry, (center, half)) in entries.iter().zip(center.iter().zip(half)) {
                let entry = (entry >> cut) as i32;
                let size = entry.abs();
                value += ((entry * (center >> shift)) >> 1) + ((size * (half >> shift)) >> 1) + size;
            }
            if value < 0 {
                return false;
            }
        }
        true
    }

    /// The least w in a box.
    ///
    /// # Format
    /// Entries below 2⁴⁵: six products of at most 2⁶⁰.
    #[inline(never)]
    fn least_w(&self, aabb: &BoundingBox) -> i64 {
        let [.., row] = &self.rows;
        let [.., mut least] = *row;
        for ((entry, center), half) in row.iter().zip(aabb.center.to_bits()).zip(aabb.half.to_bits()) {
            least += times(*entry, i64::from(center)) - times(entry.abs(), i64::from(half));
        }
        least
    }
}

impl Transform {
    /// Folds everything that maps a mesh's numbers to the screen into one matrix.
    ///
    /// `displaced` asks for a transform of 16.16 positions whatever the mesh's own format is, for vertex shaders that
    /// move vertices.
    pub fn new(mvp: &Projective, viewport: &Viewport, mesh: &Mesh<'_>, displaced: bool) -> Self {
        let mut transform = Self::default();
        transform.fold(&View::new(mvp, viewport), mesh, displaced);
        transform
    }

    /// Becomes the transform of a mesh, from a matrix that has the viewport in it.
    ///
    /// # Format
    /// Entries keep 40 significant bits relative to the largest value a vertex can reach, so a vertex is off by less
    /// than 2⁻³⁷ of it. Clip coordinates stay below 2⁵⁵ + 2.
    #[inline(never)]
    pub fn fold(&mut self, view: &View, mesh: &Mesh<'_>, displaced: bool) {
        let aabb = &mesh.bounds().aabb;
        // 1. What the mesh makes of its numbers. Positions are p / 2¹⁶, and clip = Σ r p / 2¹⁶ + r3: for all three formats
        //    written as Σ e p' / 2³¹ + t with 32-bit p'. Fractions are p' / 2¹⁶: p = offset + scale p' / 2³¹. Below 2⁶².
        let (mut factor, mut offset, mut quantized, mut homogeneous) = (1 << 31, [0; 3], false, false);
        if !displaced {
            match &mesh.data().positions {
                Positions::Quantized { scale, offset: middle, .. } => {
                    (factor, offset, quantized) = (i64::from(scale.to_bits()), middle.to_bits(), true);
                }
                Positions::Homogeneous(_) => homogeneous = true,
                Positions::Exact(_) => {}
            }
        }
        // A quarter of the largest value that any row can reach.
        let mut reach = 0;
        for (row, r) in self.rows.iter_mut().zip(&view.rows) {
            let [.., last] = r;
            let mut t = if homogeneous { 0 } else { *last };
            for (r, offset) in r.iter().zip(offset) {
                t += times(*r, i64::from(offset));
            }
            row.translation = t;
            let mut sum = t.unsigned_abs() as i64 >> 2;
            for (k, ((high, low), r)) in row.high.iter_mut().zip(&mut row.low).zip(r).enumerate() {
                let e = if k == 3 && !homogeneous { 0 } else { times(*r, factor) };
                // As it is, for now.
                (*high, *low) = ((e >> 32) as i32, e as i32);
                sum += (e.abs() >> 2) + 2;
            }
            reach |= sum;
        }

        // 2. One shift for all, so that the largest reachable value is just below 2⁵⁵.
        let shift = excess(&[reach], 53);
        let least_w = view.least_w(aabb);
        self.short = quantized && scale(least_w, shift) >= Self::SHORT_W;
        for row in &mut self.rows {
            row.translation = scale(row.translation, shift);
            for (high, low) in row.high.iter_mut().zip(&mut row.low) {
                // 16 fractional bits: e / 2³¹ · 2¹⁶.
                let e = scale(i64::from(*high) << 32 | i64::from(*low as u32), shift + 15);
                (*high, *low) = ((e >> 16) as i32, (e & 0xFFFF) as i32);
                if self.short {
                    // m below 2³⁰; low in -2¹⁴..2¹⁴, so that three products with |q| ≤ 2¹⁵ stay below 2³¹.
                    let m = ((e + (1 << 9)) >> 10) as i32;
                    *low = if SMALL_CORE { ((m & 0x7FFF) ^ 0x4000) - 0x4000 } else { 0 };
                    *high = if SMALL_CORE { (m - *low) >> 15 } else { m };
                }
            }
            if self.short {
                let t = (row.translation + (1 << 9)) >> 10;
                row.high[3] = (t >> 15) as i32;
                row.low[3] = (t & 0x7FFF) as i32 + (1 << 14);
                row.translation = t + (1 << 14);
            }
        }
        self.scale = view.scale - shift;
        self.uniform = None;
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
    /// Values of the short path are those of the long one / 2²⁵, below 2³⁰, off by at most 3: half a unit from each of three
    /// entries, half from the constant and one from the cut; 4 are added, so that w is not below 2²⁶ for that. With w ≥ 2²⁶, a screen position, 2¹⁷ x / w in 1/256 px, is
    /// off by at most 2¹⁷ · 3 · (1 + |x / w|) / w: 2⁻⁶ on a screen of 512 px, and below 1/10 as far as |x / w| < 16 lets it
    /// be, which is well inside the guard band.
    const SHORT_W: i64 = (1 << 51) + (4 << 25);

    /// Clip coordinates of a mesh vertex; the origin for an index past the end.
    #[inline(never)]
    pub fn vertex(&self, positions: &Positions<'_>, index: usize) -> ClipVertex {
        match positions {
            Positions::Quantized { points, .. } => {
                let q = points.get(index).copied().unwrap_or_default();
                if self.short {
                    return self.short_vertex(&q);
                }
                self.apply([i32::from(q[0]) << 16, i32::from(q[1]) << 16, i32::from(q[2]) << 16, 0])
            }
            Positions::Exact(points) => self.point(points.get(index).copied().unwrap_or_default()),
            Positions::Homogeneous(points) => {
                let [x, y, z, w] = points.get(index).copied().unwrap_or_default();
                self.apply([x.to_bits(), y.to_bits(), z.to_bits(), w.to_bits()])
            }
        }
    }

    /// Where a mesh vertex is on the screen, or which planes keep it off.
    #[inline]
    pub fn place(&self, positions: &Positions<'_>, index: usize) -> Placed {
        if let (Positions::Quantized { points, .. }, true) = (positions, self.short) {
            let clip = self.apply_short(points.get(index).copied().unwrap_or_default());
            // In the short path's range of w, only the near and the far plane are left to be outside of.
            let [_, _, z, w] = clip;
            return if (z as u32) <= w as u32 {
                Placed::Screen(self.with_depth(project_short(clip), i64::from(z) << 25))
            } else {
                Placed::Outside(Outcode(if z < 0 { Outcode::NEAR } else { Outcode::FAR }))
            };
        }
        self.place_clip(&self.vertex(positions, index))
    }

    /// Where a vertex in clip space is on the screen, or which planes keep it off.
    pub fn place_clip(&self, vertex: &ClipVertex) -> Placed {
        match place(vertex) {
            Placed::Screen(placed) => Placed::Screen(self.with_depth(placed, vertex.z)),
            outside => outside,
        }
    }

    /// Clip coordinates of a 16.16 position, of a transform made for those.
    pub fn point(&self, position: Vec3) -> ClipVertex {
        let [x, y, z] = position.to_bits();
        self.apply([x, y, z, 0])
    }

    /// Whether vertices take the 32-bit path.
    pub const fn is_short(&self) -> bool {
        self.short
    }

    /// The long path.
    ///
    /// # Format
    /// |p| ≤ 2³¹, entries below 2²⁴ whole: products below 2⁵⁵ whose sum was bounded in `of`; fractions below 2¹⁶ · 2³¹.
    #[inline(never)]
    fn apply(&self, p: [i32; 4]) -> ClipVertex {
        let mut clip = [0_i64; 4];
        for (value, row) in clip.iter_mut().zip(&self.rows) {
            let mut fraction = 0_i64;
            *value = row.translation;
            for ((high, low), p) in row.high.iter().zip(&row.low).zip(p) {
                *value += i64::from(*high) * i64::from(p);
                fraction += i64::from(*low) * i64::from(p);
            }
            *value += fraction >> 16;
        }
        let [x, y, z, w] = clip;
        ClipVertex { x, y, z, w }
    }

    /// [`apply_short`](Self::apply_short) for the few vertices that are clipped: a loop.
    #[inline(never)]
    fn short_vertex(&self, q: &[i16; 3]) -> ClipVertex {
        let mut clip = [0; 4];
        for (value, row) in clip.iter_mut().zip(&self.rows) {
            let mut sum = row.translation;
            for ((high, low), q) in row.high.iter().zip(&row.low).zip(q) {
                let m = if SMALL_CORE { (high << 15) + low } else { *high };
                sum += i64::from(m) * i64::from(*q);
            }
            *value = sum >> 15;
        }
        let [x, y, z, w] = clip;
        ClipVertex { x, y, z, w }
    }

    /// The short path; see [`Row`].
    #[inline]
    fn apply_short(&self, q: [i16; 3]) -> [i32; 4] {
        let [x, y, z] = [i32::from(q[0]), i32::from(q[1]), i32::from(q[2])];
        let apply = |row: &Row| {
            if SMALL_CORE {
                let ([hx, hy, hz, ht], [lx, ly, lz, lt]) = (row.high, row.low);
                hx * x + hy * y + hz * z + ht + ((lx * x + ly * y + lz * z + lt) >> 15)
            } else {
                // The same, of whole entries.
                let [mx, my, mz, _] = row.high;
                let product = |m: i32, q: i32| i64::from(m) * i64::from(q);
                ((row.translation + product(mx, x) + product(my, y) + product(mz, z)) >> 15) as i32
            }
        };
        // Spelled out: at `opt-level = "s"`, `map` is a loop through memory.
        let [a, b, c, d] = &self.rows;
        [apply(a), apply(b), apply(c), apply(d)]
    }
}
