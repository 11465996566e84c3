//! Checks single numbers: each is in its range, or the error says which range that is.

use super::container::{NONE, SectionKind};
use super::error::ModelError;
use core::ops::RangeInclusive;

/// Returns an error if a number is out of range.
pub(super) fn in_range(
    section: Option<SectionKind>,
    item: usize,
    field: &'static str,
    found: i64,
    range: RangeInclusive<i64>,
) -> Result<(), ModelError> {
    if range.contains(&found) {
        return Ok(());
    }
    Err(ModelError::Number { section, item, field, found, least: *range.start(), most: *range.end() })
}

/// Returns an error if a number is out of range, and does not stand for "none".
pub(super) fn number_or_none(
    section: Option<SectionKind>,
    item: usize,
    field: &'static str,
    found: u16,
    range: RangeInclusive<i64>,
) -> Result<(), ModelError> {
    if found == NONE {
        return Ok(());
    }
    // Where there is no number, "none" is the one that is left.
    in_range(section, item, field, found.into(), if range.is_empty() { exactly(NONE.into()) } else { range })
}

/// Returns an error if `count` items from `first` on end past the last of `length` items.
pub(super) fn within(
    section: Option<SectionKind>,
    item: usize,
    field: &'static str,
    first: u32,
    count: u64,
    length: usize,
) -> Result<(), ModelError> {
    if u64::from(first).saturating_add(count) <= length as u64 {
        return Ok(());
    }
    Err(ModelError::Items { section, item, field, first, count, length })
}

/// Returns the range of one number.
pub(super) fn exactly(number: u64) -> RangeInclusive<i64> {
    number as i64..=number as i64
}

/// Returns the range of the numbers of that many items.
pub(super) fn below(count: usize) -> RangeInclusive<i64> {
    0..=count as i64 - 1
}
