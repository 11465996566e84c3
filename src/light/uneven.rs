//! Models that scale unevenly, shear or flatten a mesh: normals turn otherwise than positions there.
//!
//! A model that rotates, moves and scales evenly leaves angles as they are. So light is brought into the mesh's own
//! space once, and normals stay as they are. Any other model changes angles. So normals and positions are brought into
//! the lights' space instead, one by one: normals by the inverse transpose of the model's matrix, and made unit vectors
//! again.

use super::normal::long;
use crate::math::{Affine, Vec3, unit_vector_of_any_length};
use crate::mesh::Bounds;

/// The inverse transpose of a model's matrix, in any scale: 2.14, with the widest entry in 1/2..=1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NormalMatrix {
    rows: [[i16; 3]; 3],
}

/// Returns a word that has as many bits as the widest of the entries.
const fn widest(rows: &[[i64; 3]; 3]) -> u64 {
    let mut all = 1;
    let mut k = 0;
    while k < 9 {
        all |= rows[k / 3][k % 3].unsigned_abs();
        k += 1;
    }
    all
}

/// Shifts all entries so that the widest has `bits` bits; rounded down.
const fn scaled(rows: &[[i64; 3]; 3], bits: u32) -> [[i64; 3]; 3] {
    let width = 64 - widest(rows).leading_zeros();
    let mut result = [[0; 3]; 3];
    let mut k = 0;
    while k < 9 {
        let entry = rows[k / 3][k % 3];
        result[k / 3][k % 3] = if width > bits { entry >> (width - bits) } else { entry << (bits - width) };
        k += 1;
    }
    result
}

/// Returns whether the columns of a matrix are at right angles and of one length: within 1/256 of the length, and twice
/// the rounding of the entries, whose unit is `unit`.
const fn is_even(rows: &[[i64; 3]; 3], unit: i64) -> bool {
    // Products of columns: below 3 · 2⁵⁸.
    let mut products = [[0_i64; 3]; 3];
    let mut k = 0;
    while k < 27 {
        let (i, j, row) = (k / 9, k / 3 % 3, &rows[k % 3]);
        products[i][j] += row[i] * row[j];
        k += 1;
    }
    let [a, b, c] = [products[0][0], products[1][1], products[2][2]];
    let longest = if a > b && a > c {
        a
    } else if b > c {
        b
    } else {
        c
    };
    let slack = (longest >> 7) + 4 * unit * (1 << 29);
    longest - a <= slack
        && longest - b <= slack
        && longest - c <= slack
        && products[0][1].abs() <= slack
        && products[0][2].abs() <= slack
        && products[1][2].abs() <= slack
}

impl NormalMatrix {
    /// Makes the matrix of a model; `None` if the model scales evenly, so that normals need none.
    ///
    /// A scale that is uneven by less than 1/256 counts as even. It turns a normal by less than 1/512.
    ///
    /// # Format
    /// Entries of the model are scaled to 29 bits, and cofactors are below 2⁵⁹. The inverse transpose is the matrix of
    /// cofactors, divided by the determinant, whose sign is all that counts.
    pub(crate) const fn new(model: &Affine) -> Option<Self> {
        let [x, y, z] = model.to_rows();
        let rows = [
            [x[0] as i64, x[1] as i64, x[2] as i64],
            [y[0] as i64, y[1] as i64, y[2] as i64],
            [z[0] as i64, z[1] as i64, z[2] as i64],
        ];
        let zeros = widest(&rows).leading_zeros();
        let rows = scaled(&rows, 29);
        if is_even(&rows, if zeros > 35 { 1 << (zeros - 35) } else { 1 }) {
            return None;
        }
        let mut cofactors = [[0; 3]; 3];
        let mut k = 0;
        while k < 9 {
            let (i, j) = (k / 3, k % 3);
            let (a, b) = (&rows[(i + 1) % 3], &rows[(i + 2) % 3]);
            let (p, q) = ((j + 1) % 3, (j + 2) % 3);
            cofactors[i][j] = a[p] * b[q] - a[q] * b[p];
            k += 1;
        }
        let large = scaled(&cofactors, 30);
        let mirrored = rows[0][0] * large[0][0] + rows[0][1] * large[0][1] + rows[0][2] * large[0][2] < 0;
        let small = scaled(&cofactors, 14);
        let mut entries = [[0; 3]; 3];
        let mut k = 0;
        while k < 9 {
            let entry = small[k / 3][k % 3] as i16;
            entries[k / 3][k % 3] = if mirrored { -entry } else { entry };
            k += 1;
        }
        Some(Self { rows: entries })
    }

    /// Returns the unit normal in the lights' space, 2.14, for one in the mesh's own space.
    ///
    /// # Format
    /// Sums of products are below 3 · 2²⁹. All their bits count, so that a normal that the model shortens keeps its
    /// direction.
    #[inline(never)]
    pub(crate) fn times(&self, normal: [i16; 3]) -> [i16; 3] {
        let n = long(normal);
        let sum = self.rows.map(|row| {
            let [a, b, c] = long(row);
            a.wrapping_mul(n[0]).wrapping_add(b.wrapping_mul(n[1])).wrapping_add(c.wrapping_mul(n[2]))
        });
        let unit = unit_vector_of_any_length(sum);
        unit.map(|c| c as i16)
    }
}

/// Returns the normal in the space that a matrix leads to.
#[inline(always)]
pub(crate) fn turned(matrix: &Option<NormalMatrix>, normal: [i16; 3]) -> [i16; 3] {
    match matrix {
        None => normal,
        Some(matrix) => matrix.times(normal),
    }
}

/// Returns the box that holds what `model` makes of the box `bounds`.
pub(super) fn moved(bounds: &Bounds, model: &Affine) -> Bounds {
    let [x, y, z] = model.to_rows().map(|row| Vec3::from_bits([row[0], row[1], row[2]].map(i32::saturating_abs)));
    let along = Affine::from_rows(x, y, z, Vec3::ZERO);
    Bounds { center: model.transform_point(bounds.center), half: along.transform_vector(bounds.half) }
}
