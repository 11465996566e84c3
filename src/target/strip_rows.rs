//! Number of the strip that a row is in, found without a divider.

use crate::math::{divided, leading_zeros_long};
use core::num::NonZeroU32;

/// Rows of a strip, and a division by them without a divider.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StripRows {
    pub(crate) rows: u16,
    factor: u32,
    shift: u32,
}

impl StripRows {
    /// Strips whose height is not known yet.
    pub(crate) const UNSET: Self = Self { rows: 0, factor: 0, shift: 0 };

    /// # Format
    /// row / rows = row factor / 2^shift with factor = ⌈2^shift / rows⌉ ≤ 2¹³. The result is too large by less than
    /// row / 2^shift, which is below 1 / rows, as 2^shift is at least 2¹² rows. So it is exact for rows of the
    /// screen, which are below 2¹².
    ///
    /// Without records there is nothing to divide, and the factor is 0.
    pub(crate) fn new(rows: u16, records: bool) -> Self {
        let rows = rows.max(1);
        if !records {
            return Self { rows, factor: 0, shift: 0 };
        }
        let shift = 12 + 64 - leading_zeros_long(u64::from(rows) - 1);
        Self { rows, factor: (whole_rows((1 << shift) - 1, rows) + 1) as u32, shift }
    }

    /// Returns the number of the strip that a row is in.
    #[inline]
    pub(crate) const fn of(&self, row: u32) -> usize {
        (row.wrapping_mul(self.factor) >> self.shift) as usize
    }
}

/// Counts the whole rows of `width` pixels in `length` pixels. For a screen without width, which is an error of its
/// own, it returns 1.
pub(crate) fn whole_rows(length: usize, width: u16) -> usize {
    let length = u32::try_from(length).unwrap_or(u32::MAX);
    NonZeroU32::new(width.into()).map_or(1, |width| divided(length, width).0 as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vertex::Viewport;

    #[test]
    fn every_row_is_in_its_strip() {
        for rows in 1..=Viewport::MAX_SIZE {
            let strips = StripRows::new(rows, true);
            let wrong =
                (0..u32::from(Viewport::MAX_SIZE)).find(|row| strips.of(*row) != (row / u32::from(rows)) as usize);
            assert_eq!(wrong, None, "strips of {rows} rows");
        }
    }
}
