//! What a rasterizer drew for one conformance record, and its comparison with what it should have drawn.
//!
//! In: the pixels reported, one by one. Out: a [`Verdict`] that names the first wrong pixel, or a hash of the spans.

use super::records::{BadRecord, Record, SpanRow, Table, pixel_count};

/// A record's verdict: nothing, or what is wrong.
pub type Verdict = Result<(), String>;

/// How often each pixel was hit by one or more triangles.
pub struct Hits {
    width: u32,
    pub counts: Vec<u32>,
    /// The last triangle (1-based) that hit the pixel.
    pub last: Vec<u32>,
    outside: Option<(u32, u32)>,
}

impl Hits {
    /// Nothing hit yet, in the viewport of `table`.
    pub fn new(table: &Table) -> Self {
        let count = table.width as usize * table.height as usize;
        Self { width: table.width, counts: vec![0; count], last: vec![0; count], outside: None }
    }

    /// Notes that `triangle` (1-based) hit a pixel.
    pub fn add(&mut self, triangle: u32, x: u32, y: u32) {
        let index = u64::from(y) * u64::from(self.width) + u64::from(x);
        match self.counts.get_mut(index as usize) {
            Some(count) if x < self.width => {
                *count += 1;
                self.last[index as usize] = triangle;
            }
            _ => self.outside = self.outside.or(Some((x, y))),
        }
    }

    /// Every pixel must be hit as often as `allowed(index)` says, lowest and highest.
    pub fn verdict(&self, allowed: impl Fn(usize) -> (u32, u32)) -> Verdict {
        if let Some((x, y)) = self.outside {
            return Err(format!("pixel ({x}, {y}) is outside the viewport"));
        }
        let is_wrong = |&(i, &count): &(usize, &u32)| count < allowed(i).0 || count > allowed(i).1;
        let mut wrong = self.counts.iter().enumerate().filter(is_wrong);
        match wrong.next() {
            None => Ok(()),
            Some((i, count)) => {
                let ((x, y), (low, high)) = (self.position(i), allowed(i));
                let expected = if low == high { low.to_string() } else { format!("{low} to {high}") };
                let more = wrong.count();
                Err(format!("pixel ({x}, {y}) hit {count} times, expected {expected}; {more} more pixels wrong"))
            }
        }
    }

    /// Column and row of a place in the buffers.
    pub fn position(&self, index: usize) -> (u32, u32) {
        ((index as u32) % self.width, (index as u32) / self.width)
    }

    /// FNV-1a 64 over y, first x, last x of every span in ascending order, each as two bytes, low one first.
    pub fn hash(&self) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        for (y, row) in (0..).zip(self.counts.chunks(self.width as usize)) {
            for span in row.iter().enumerate().collect::<Vec<_>>().chunk_by(|a, b| a.1 == b.1) {
                let ((x0, count), (x1, _)) = (span[0], span[span.len() - 1]);
                if *count > 0 {
                    for byte in [y, x0, x1].into_iter().flat_map(|v: usize| (v as u16).to_le_bytes()) {
                        hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
                    }
                }
            }
        }
        hash
    }
}

/// Fills a mask with spans, and fails unless they hold `count` pixels.
pub fn mask_of(record: &Record, table: &Table, spans: &[SpanRow], count: usize) -> Result<Vec<bool>, BadRecord> {
    if pixel_count(spans) != count {
        return Err(record.bad(format!("{} pixels in the spans, {count} announced", pixel_count(spans))));
    }
    let mut mask = vec![false; table.width as usize * table.height as usize];
    for &(y, x0, x1) in spans {
        let row = y as usize * table.width as usize;
        mask[row + x0 as usize..=row + x1 as usize].fill(true);
    }
    Ok(mask)
}
