//! Object space → clip space: model, camera, viewport and the mesh's quantization folded into one integer matrix.
//!
//! Clip coordinates are homogeneous, so one common scale for all four rows is free. The rows are scaled so that the
//! largest value any vertex can reach just fits the format, and the viewport is folded in: x / w and y / w are screen
//! positions in units of 512 px from the screen's corner, z / w is depth.

use super::clip::{ClipVertex, Outcode};
use super::project::{ScreenVertex, project, project_short};
use super::{BoundingBox, Mesh, Positions, Viewport};
use crate::math::{Projective, Vec3};

/// A vertex transform, made once a draw.
#[derive(Clone, Copy, Debug)]
pub struct Transform {
    /// Entries with 16 fractional bits, below 2⁴⁰ (rows x, y, z, w).
    entries: [[i64; 4]; 4],
    /// What the constant 1 contributes; below 2⁵⁵.
    translation: [i64; 4],
    /// The 32-bit path, where its error stays within the promise.
    short: Option<Short>,
}

/// Rows for 32-bit arithmetic on quantized positions: c = (Σ mᵢ qᵢ + t) / 2¹⁵ with mᵢ = 2¹⁵ high + low.
#[derive(Clone, Copy, Debug, Default)]
struct Short {
    rows: [ShortRow; 4],
}

#[derive(Clone, Copy, Debug, Default)]
struct ShortRow {
    high: [i32; 3],
    low: [i32; 3],
    translation_high: i32,
    translation_low: i32,
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
#[inline]
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

/// `a b / 2¹⁶`, rounded down, for |a| < 2⁴⁶: below 2⁶¹.
#[inline(never)]
fn times(a: i64, b: i32) -> i64 {
    (a >> 16) * i64::from(b) + (((a & 0xFFFF) * i64::from(b)) >> 16)
}

/// Shifts that bring the largest of `values` below 2^`bits`; negative ones if they are smaller.
fn excess<'v>(values: impl Iterator<Item = &'v i64>, bits: i32) -> i32 {
    let all = values.fold(0, |all, v| all | v.unsigned_abs());
    64 - all.leading_zeros() as i32 - bits
}

/// The least w in a box, from the row of w; on the scale of that row's last entry.
fn least_w(row: &[i64; 4], aabb: &BoundingBox) -> i64 {
    let mut least = row[3];
    for ((r, center), half) in row.iter().zip(aabb.center.to_bits()).zip(aabb.half.to_bits()) {
        least += times(*r, center) - times(r.abs(), half);
    }
    least
}

impl Transform {
    /// Folds everything that maps a mesh's numbers to the screen into one matrix.
    ///
    /// `displaced` asks for a transform of 16.16 positions whatever the mesh's own format is, for vertex shaders that
    /// move vertices.
    ///
    /// # Format
    /// Entries keep 40 significant bits relative to the largest value a vertex can reach, so a vertex is off by less
    /// than 2⁻³⁷ of it. Clip coordinates stay below 2⁵⁵ + 2.
    #[inline(never)]
    pub fn new(mvp: &Projective, viewport: &Viewport, mesh: &Mesh<'_>, displaced: bool) -> Self {
        let positions = &mesh.data().positions;
        // All in one matrix, in place: r first, e in the end.
        let mut result = Self { entries: mvp.to_rows(), translation: [0; 4], short: None };
        let Self { entries: r, translation: t, .. } = &mut result;

        // 1. The matrix to 44 bits, so that the viewport's 16 fit beside them.
        let shift = excess(r.iter().flatten(), 44).max(0);
        // 2. The viewport: X px = cx + hw x / w, so X / 512 px = (W x + 2 cx w) / 1024 w; y points down. Below 2⁶⁰.
        let (width, height) = (i64::from(viewport.width()), i64::from(viewport.height()));
        let (cx2, cy2) = (2 * i64::from(viewport.x()) + width, 2 * i64::from(viewport.y()) + height);
        let [rx, ry, rz, rw] = &mut *r;
        for (((rx, ry), rz), rw) in rx.iter_mut().zip(ry).zip(rz).zip(rw) {
            let (x, y, z, w) = (scale(*rx, shift), scale(*ry, shift), scale(*rz, shift), scale(*rw, shift));
            *rx = width * x + cx2 * w;
            *ry = cy2 * w - height * y;
            *rz = z << 10;
            *rw = w << 10;
        }
        let shift = excess(r.iter().flatten(), 45);
        for entry in r.iter_mut().flatten() {
            *entry = scale(*entry, shift);
        }

        // 3. What the mesh makes of its numbers. Positions are p / 2¹⁶, and clip = Σ r p / 2¹⁶ + r3: for all three formats
        //    written as Σ e p' / 2³¹ + t with 32-bit p'. Fractions are p' / 2¹⁶: p = offset + scale p' / 2³¹. Below 2⁶².
        let least_w = least_w(&r[3], &mesh.bounds().aabb);
        for (r, t) in r.iter_mut().zip(t.iter_mut()) {
            match positions {
                Positions::Quantized { scale, offset, .. } if !displaced => {
                    *t = r[3];
                    for (r, offset) in r.iter_mut().zip(offset.to_bits()) {
                        *t += times(*r, offset);
                        *r = times(*r, scale.to_bits());
                    }
                    r[3] = 0;
                }
                _ => {
                    if displaced || !matches!(positions, Positions::Homogeneous(_)) {
                        *t = r[3];
                        r[3] = 0;
                    }
                    r.iter_mut().for_each(|r| *r <<= 15);
                }
            }
        }

        // 4. One shift for all, so that the largest reachable value is just below 2⁵⁵; a quarter of it is summed up here.
        let mut reach = [0_i64; 4];
        for (reach, (e, t)) in reach.iter_mut().zip(r.iter().zip(t.iter())) {
            *reach = e.iter().chain([t]).fold(0, |sum, v| sum + (v.unsigned_abs() >> 2) as i64 + 1);
        }
        let shift = excess(reach.iter(), 53);
        // 16 fractional bits: e / 2³¹ · 2¹⁶.
        r.iter_mut().flatten().for_each(|e| *e = scale(*e, shift + 15));
        t.iter_mut().for_each(|t| *t = scale(*t, shift));
        if let (Positions::Quantized { .. }, false) = (positions, displaced) {
            result.short = Short::new(r, t, scale(least_w, shift));
        }
        result
    }

    /// Clip coordinates of a mesh vertex; the origin for an index past the end.
    #[inline]
    pub fn vertex(&self, positions: &Positions<'_>, index: usize) -> ClipVertex {
        match positions {
            Positions::Quantized { points, .. } => {
                let q = points.get(index).copied().unwrap_or_default();
                match &self.short {
                    Some(short) => {
                        let [x, y, z, w] = short.apply(q).map(i64::from);
                        ClipVertex { x, y, z, w }
                    }
                    None => self.apply([i32::from(q[0]) << 16, i32::from(q[1]) << 16, i32::from(q[2]) << 16, 0]),
                }
            }
            Positions::Exact(points) => self.point(points.get(index).copied().unwrap_or_default()),
            Positions::Homogeneous(points) => {
                self.apply(points.get(index).copied().unwrap_or_default().map(|c| c.to_bits()))
            }
        }
    }

    /// Where a mesh vertex is on the screen, or which planes keep it off.
    #[inline]
    pub fn place(&self, positions: &Positions<'_>, index: usize) -> Placed {
        if let (Positions::Quantized { points, .. }, Some(short)) = (positions, &self.short) {
            let clip = short.apply(points.get(index).copied().unwrap_or_default());
            // In `Short::new`'s range of w, only the near and the far plane are left to be outside of.
            let [_, _, z, w] = clip;
            return if (z as u32) <= w as u32 {
                Placed::Screen(project_short(clip))
            } else {
                Placed::Outside(Outcode(if z < 0 { Outcode::NEAR } else { Outcode::FAR }))
            };
        }
        place(&self.vertex(positions, index))
    }

    /// Clip coordinates of a 16.16 position, of a transform made for those.
    pub fn point(&self, position: Vec3) -> ClipVertex {
        let [x, y, z] = position.to_bits();
        self.apply([x, y, z, 0])
    }

    /// Whether vertices take the 32-bit path.
    pub const fn is_short(&self) -> bool {
        self.short.is_some()
    }

    /// # Format
    /// |p| ≤ 2³¹, entries below 2²⁴ whole: products below 2⁵⁵ whose sum was bounded in `new`; fractions below 2¹⁶ · 2³¹.
    #[inline(never)]
    fn apply(&self, p: [i32; 4]) -> ClipVertex {
        let row = |entries: &[i64; 4], translation: i64| {
            let mut whole = 0_i64;
            let mut fraction = 0_i64;
            for (e, p) in entries.iter().zip(p) {
                whole += (e >> 16) * i64::from(p);
                fraction += (e & 0xFFFF) * i64::from(p);
            }
            translation + whole + (fraction >> 16)
        };
        let ([x, y, z, w], [tx, ty, tz, tw]) = (&self.entries, self.translation);
        ClipVertex { x: row(x, tx), y: row(y, ty), z: row(z, tz), w: row(w, tw) }
    }
}

impl Short {
    /// The 32-bit path, if w stays large enough for it in the whole of the mesh.
    ///
    /// # Format
    /// Values are those of the long path / 2²⁵, below 2³⁰, off by at most 3: half a unit from each of three entries,
    /// half from the constant and one from the cut. With w ≥ 2²⁶, a screen position, 2¹⁷ x / w in 1/256 px, is off by at
    /// most 2¹⁷ · 3 · (1 + |x / w|) / w: 2⁻⁶ on a screen of 512 px, and below 1/10 as far as |x / w| < 16 lets it be,
    /// which is well inside the guard band.
    fn new(entries: &[[i64; 4]; 4], translation: &[i64; 4], least_w: i64) -> Option<Self> {
        if least_w < 1 << 51 {
            return None;
        }
        let mut short = Self::default();
        for (row, (entries, translation)) in short.rows.iter_mut().zip(entries.iter().zip(translation)) {
            for ((high, low), entry) in row.high.iter_mut().zip(&mut row.low).zip(entries) {
                // m below 2³⁰; low in -2¹⁴..2¹⁴, so that three products with |q| ≤ 2¹⁵ stay below 2³¹.
                let m = ((entry + (1 << 9)) >> 10) as i32;
                *low = ((m & 0x7FFF) ^ 0x4000) - 0x4000;
                *high = (m - *low) >> 15;
            }
            let t = (translation + (1 << 9)) >> 10;
            row.translation_high = (t >> 15) as i32;
            row.translation_low = (t & 0x7FFF) as i32 + (1 << 14);
        }
        Some(short)
    }

    #[inline]
    fn apply(&self, q: [i16; 3]) -> [i32; 4] {
        let [x, y, z] = [i32::from(q[0]), i32::from(q[1]), i32::from(q[2])];
        let apply = |row: &ShortRow| {
            let ([hx, hy, hz], [lx, ly, lz]) = (row.high, row.low);
            let low = lx * x + ly * y + lz * z + row.translation_low;
            hx * x + hy * y + hz * z + row.translation_high + (low >> 15)
        };
        // Spelled out: at `opt-level = "s"`, `map` is a loop through memory.
        let [a, b, c, d] = &self.rows;
        [apply(a), apply(b), apply(c), apply(d)]
    }
}
