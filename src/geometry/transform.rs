//! Object space → clip space: model, camera, viewport and the mesh's quantization folded into one integer matrix.
//!
//! Clip coordinates are homogeneous, so one common scale for all four rows is free. The rows are scaled so that the
//! largest value any vertex can reach just fits the format, and the viewport is folded in: x / w and y / w are screen
//! positions in units of 512 px from the screen's corner, z / w is depth.

use super::clip::{ClipVertex, Outcode};
use super::project::{ScreenVertex, project, project_short};
use super::{Positions, Viewport};
use crate::math::{Projective, Vec3};

/// A vertex transform, made once a draw.
#[derive(Clone, Copy, Debug)]
pub struct Transform {
    /// Whole parts of the entries, below 2²⁴ (rows x, y, z, w).
    whole: [[i32; 4]; 4],
    /// Fractions of the entries, 0.16.
    fraction: [[u16; 4]; 4],
    /// What the constant 1 contributes; below 2⁵⁵.
    translation: [i64; 4],
    /// The 32-bit path, where its error stays within the promise.
    short: Option<Short>,
}

/// Rows for 32-bit arithmetic on quantized positions: c = (Σ mᵢ qᵢ + t) / 2¹⁵ with mᵢ = 2¹⁵ high + low.
#[derive(Clone, Copy, Debug)]
struct Short {
    high: [[i32; 3]; 4],
    low: [[i32; 3]; 4],
    translation_high: [i32; 4],
    translation_low: [i32; 4],
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

/// What a vertex transform yields: clip coordinates in the transform's own scale.
pub type Transformed = ClipVertex;

/// `value / 2^shift`, rounded to nearest; a negative shift multiplies.
fn scale(value: i128, shift: i32) -> i128 {
    if shift > 0 {
        (value + (1 << (shift - 1))) >> shift
    } else {
        value << -shift
    }
}

impl Transform {
    /// Folds everything that maps a mesh's numbers to the screen into one matrix.
    ///
    /// `displaced` asks for a transform of 16.16 positions whatever the mesh's own format is, for vertex shaders that
    /// move vertices.
    ///
    /// # Format
    /// Entries keep 40 significant bits relative to the largest value a vertex can reach, so a vertex is off by less
    /// than 2⁻³⁸ of it. Clip coordinates stay below 2⁵⁵ + 2.
    pub fn new(mvp: &Projective, viewport: &Viewport, positions: &Positions<'_>, displaced: bool) -> Self {
        // 1. The matrix to 44 significant bits, so that what follows fits 128.
        let rows = mvp.to_rows();
        let largest = rows.iter().flatten().fold(0, |m, v| v.unsigned_abs() | m);
        let shift = (64 - largest.leading_zeros() as i32 - 44).max(0);
        let r = rows.map(|row| row.map(|v| scale(i128::from(v), shift)));

        // 2. Entries for 32-bit inputs p, and the constant: 16.16 positions are p / 2¹⁶, fractions q are p / 2¹⁶ too.
        //    Below 2⁷⁵ and 2¹⁰⁹.
        let (entries, constant) = match positions {
            Positions::Quantized { scale: s, offset, .. } if !displaced => {
                let o = offset.to_bits().map(i128::from);
                let s = i128::from(s.to_bits());
                let moved = r.map(|row| (row[0] * o[0] + row[1] * o[1] + row[2] * o[2] + (row[3] << 16)) << 31);
                (r.map(|row| [row[0] * s, row[1] * s, row[2] * s, 0]), moved)
            }
            Positions::Homogeneous(_) if !displaced => (r, [0; 4]),
            _ => (r.map(|row| [row[0], row[1], row[2], 0]), r.map(|row| row[3] << 16)),
        };

        // 3. The viewport: X px = cx + hw x / w, so 1024 X / 512 px = (W x + 2 cx w) / w; y points down. Below 2¹²⁶.
        let (width, height) = (i128::from(viewport.width()), i128::from(viewport.height()));
        let (cx2, cy2) = (
            2 * i128::from(viewport.x()) + width,
            2 * i128::from(viewport.y()) + height,
        );
        let fold = |x: i128, y: i128, z: i128, w: i128| [width * x + cx2 * w, cy2 * w - height * y, z << 10, w << 10];
        let mut folded = [[0_i128; 4]; 4];
        for j in 0..4 {
            let column = fold(entries[0][j], entries[1][j], entries[2][j], entries[3][j]);
            for (row, value) in folded.iter_mut().zip(column) {
                row[j] = value;
            }
        }
        let constant = fold(constant[0], constant[1], constant[2], constant[3]);

        // 4. One shift for all, so that the largest reachable value is just below 2⁵⁵.
        let mut reach = 0_u128;
        for (row, t) in folded.iter().zip(constant) {
            let sum = row.iter().fold(0_u128, |sum, e| sum + e.unsigned_abs());
            reach |= (sum << 31) + t.unsigned_abs();
        }
        let shift = 128 - reach.leading_zeros() as i32 - 55;
        let mut result = Self {
            whole: [[0; 4]; 4],
            fraction: [[0; 4]; 4],
            translation: [0; 4],
            short: None,
        };
        let mut entries = [[0_i64; 4]; 4];
        for i in 0..4 {
            for j in 0..4 {
                let entry = scale(folded[i][j], shift - 16) as i64;
                entries[i][j] = entry;
                result.whole[i][j] = (entry >> 16) as i32;
                result.fraction[i][j] = entry as u16;
            }
            result.translation[i] = scale(constant[i], shift) as i64;
        }
        if let (Positions::Quantized { .. }, false) = (positions, displaced) {
            result.short = Short::new(&entries, &result.translation);
        }
        result
    }

    /// Clip coordinates of a mesh vertex; the origin for an index past the end.
    #[inline]
    pub fn vertex(&self, positions: &Positions<'_>, index: usize) -> Transformed {
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
    pub fn point(&self, position: Vec3) -> Transformed {
        let [x, y, z] = position.to_bits();
        self.apply([x, y, z, 0])
    }

    /// Whether vertices take the 32-bit path.
    pub const fn is_short(&self) -> bool {
        self.short.is_some()
    }

    /// # Format
    /// |p| ≤ 2³¹, entries below 2²⁴ whole: products below 2⁵⁵ whose sum was bounded in `new`; fractions below 2¹⁶ · 2³¹.
    fn apply(&self, p: [i32; 4]) -> Transformed {
        let row = |i: usize| {
            let (w, f) = (&self.whole[i], &self.fraction[i]);
            let mut whole = self.translation[i];
            let mut fraction = 0_i64;
            for j in 0..4 {
                whole += i64::from(w[j]) * i64::from(p[j]);
                fraction += i64::from(f[j]) * i64::from(p[j]);
            }
            whole + (fraction >> 16)
        };
        ClipVertex {
            x: row(0),
            y: row(1),
            z: row(2),
            w: row(3),
        }
    }
}

impl Short {
    /// The 32-bit path, if w stays large enough for it in the whole cube of positions.
    ///
    /// # Format
    /// Values are those of the long path / 2²⁵, below 2³⁰, off by at most 3: half a unit from each of three entries,
    /// half from the constant and one from the cut. With w ≥ 2²⁶, a screen position, 2¹⁷ x / w in 1/256 px, is off by at
    /// most 2¹⁷ · 3 · (1 + |x / w|) / w: 2⁻⁶ on a screen of 512 px, and below 1/10 as far as |x / w| < 16 lets it be,
    /// which is well inside the guard band.
    fn new(entries: &[[i64; 4]; 4], translation: &[i64; 4]) -> Option<Self> {
        let w = &entries[3];
        let swing = (w[0].unsigned_abs() + w[1].unsigned_abs() + w[2].unsigned_abs()) << 15;
        if translation[3] - (swing as i64) < 1 << 51 {
            return None;
        }
        let mut short = Self {
            high: [[0; 3]; 4],
            low: [[0; 3]; 4],
            translation_high: [0; 4],
            translation_low: [0; 4],
        };
        for i in 0..4 {
            for j in 0..3 {
                // m below 2³⁰; low in -2¹⁴..2¹⁴, so that three products with |q| ≤ 2¹⁵ stay below 2³¹.
                let m = ((entries[i][j] + (1 << 9)) >> 10) as i32;
                let low = ((m & 0x7FFF) ^ 0x4000) - 0x4000;
                short.low[i][j] = low;
                short.high[i][j] = (m - low) >> 15;
            }
            let t = (translation[i] + (1 << 9)) >> 10;
            short.translation_high[i] = (t >> 15) as i32;
            short.translation_low[i] = (t & 0x7FFF) as i32 + (1 << 14);
        }
        Some(short)
    }

    #[inline]
    fn apply(&self, q: [i16; 3]) -> [i32; 4] {
        let q = q.map(i32::from);
        let row = |i: usize| {
            let (h, l) = (&self.high[i], &self.low[i]);
            let low = l[0] * q[0] + l[1] * q[1] + l[2] * q[2] + self.translation_low[i];
            h[0] * q[0] + h[1] * q[1] + h[2] * q[2] + self.translation_high[i] + (low >> 15)
        };
        [row(0), row(1), row(2), row(3)]
    }
}
