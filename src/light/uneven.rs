//! Models that scale unevenly, shear or flatten a mesh: normals turn otherwise than positions there.
//!
//! A model that rotates, moves and scales evenly leaves angles as they are. So light is brought into the mesh's own
//! space once, and normals stay as they are. Any other model changes angles. So normals and positions are brought into
//! the lights' space instead, one by one: normals by the inverse transpose of the model's matrix, and made unit vectors
//! again.

use super::normal::long;
use crate::math::{Affine, Vec3, mul_wide, unit_vector_of_any_length};
use crate::mesh::Bounds;

/// The inverse transpose of a model's matrix, in any scale: 2.14, with the widest entry in 1/2..=1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NormalMatrix {
    rows: [[i16; 3]; 3],
}

macro_rules! scaling {
    ($name:ident, $entry:ty) => {
        /// Shifts all entries so that the widest has `bits` bits, rounded down. Returns the number of bits it had.
        const fn $name(rows: &mut [[$entry; 3]; 3], bits: u32) -> u32 {
            let (mut all, mut k) = (1, 0);
            while k < 9 {
                all |= rows[k / 3][k % 3].unsigned_abs();
                k += 1;
            }
            let width = <$entry>::BITS - all.leading_zeros();
            while k > 0 {
                k -= 1;
                let entry = &mut rows[k / 3][k % 3];
                *entry = if width > bits { *entry >> (width - bits) } else { *entry << (bits - width) };
            }
            width
        }
    };
}

scaling!(scale, i32);
scaling!(scale_wide, i64);

/// Returns the product of two columns: below 3 · 2⁵⁸.
#[inline(never)]
const fn product([x, y, z]: &[[i32; 3]; 3], i: usize, j: usize) -> i64 {
    mul_wide(x[i], x[j]) + mul_wide(y[i], y[j]) + mul_wide(z[i], z[j])
}

/// Returns whether the columns of a matrix are at right angles and of one length: within 1/256 of the length, and twice
/// the rounding of the entries, whose unit is `unit`.
#[inline(never)]
const fn is_even(rows: &[[i32; 3]; 3], unit: i64) -> bool {
    let [a, b, c] = [product(rows, 0, 0), product(rows, 1, 1), product(rows, 2, 2)];
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
        && product(rows, 0, 1).abs() <= slack
        && product(rows, 0, 2).abs() <= slack
        && product(rows, 1, 2).abs() <= slack
}

impl NormalMatrix {
    /// Makes the matrix of a model; `None` if the model scales evenly, so that normals need none.
    ///
    /// A scale that is uneven by less than 1/256 counts as even. It turns a normal by less than 1/512.
    ///
    /// # Format
    /// Entries of the model are scaled to 29 bits, and cofactors are below 2⁵⁹. The inverse transpose is the matrix of
    /// cofactors, divided by the determinant, whose sign is all that counts.
    #[inline(never)]
    pub(crate) const fn new(model: &Affine) -> Option<Self> {
        let [x, y, z] = model.to_rows();
        let mut rows = [[x[0], x[1], x[2]], [y[0], y[1], y[2]], [z[0], z[1], z[2]]];
        let width = scale(&mut rows, 29);
        // What was the last bit.
        let unit = 1 << 29_u32.saturating_sub(width);
        if is_even(&rows, unit) { None } else { Some(Self::inverse_transpose(&rows)) }
    }

    /// Makes the matrix from a model's matrix. Out of line, because its frame is large, and most models are even.
    #[inline(never)]
    const fn inverse_transpose(rows: &[[i32; 3]; 3]) -> Self {
        let mut cofactors = [[0; 3]; 3];
        let mut k = 0;
        while k < 9 {
            let (i, j) = (k / 3, k % 3);
            let (a, b) = (&rows[(i + 1) % 3], &rows[(i + 2) % 3]);
            let (p, q) = ((j + 1) % 3, (j + 2) % 3);
            cofactors[i][j] = mul_wide(a[p], b[q]) - mul_wide(a[q], b[p]);
            k += 1;
        }
        scale_wide(&mut cofactors, 30);
        let ([x, ..], [first, ..]) = (rows, &cofactors);
        let mirrored = x[0] as i64 * first[0] + x[1] as i64 * first[1] + x[2] as i64 * first[2] < 0;
        scale_wide(&mut cofactors, 14);
        let mut entries = [[0; 3]; 3];
        let mut k = 0;
        while k < 9 {
            let entry = cofactors[k / 3][k % 3] as i16;
            entries[k / 3][k % 3] = if mirrored { -entry } else { entry };
            k += 1;
        }
        Self { rows: entries }
    }

    /// Returns the unit normal in the lights' space, 2.14, for one in the mesh's own space.
    ///
    /// # Format
    /// Sums of products are below 3 · 2²⁹. All their bits count, so that a normal that the model shortens keeps its
    /// direction.
    #[inline(never)]
    pub(crate) fn times(&self, normal: [i16; 3]) -> [i16; 3] {
        let n = long(normal);
        // In place: an array of rows by value would be copied by a call.
        let mut sum = [0; 3];
        for (sum, row) in sum.iter_mut().zip(&self.rows) {
            let [a, b, c] = long(*row);
            *sum = a.wrapping_mul(n[0]).wrapping_add(b.wrapping_mul(n[1])).wrapping_add(c.wrapping_mul(n[2]));
        }
        let [x, y, z] = unit_vector_of_any_length(sum);
        [x as i16, y as i16, z as i16]
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
#[inline(never)]
pub(super) fn moved(bounds: &Bounds, model: &Affine) -> Bounds {
    let [x, y, z] = model.to_rows().map(|row| Vec3::from_bits([row[0], row[1], row[2]].map(i32::saturating_abs)));
    let along = Affine::from_rows(x, y, z, Vec3::ZERO);
    Bounds { center: model.transform_point(bounds.center), half: along.transform_vector(bounds.half) }
}
