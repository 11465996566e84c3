//! The text of a conformance file, taken apart: lines into records, fields into numbers, spans and run-length lists.
//!
//! One record per line, fields split by `,`, items inside a field by spaces, `#` starts a comment line anywhere.
//! Everything that does not fit is an error with its line number, and nothing is guessed.

use std::str::FromStr;

/// One line of a file, split at the commas.
#[derive(Clone, Debug)]
pub struct Record<'a> {
    /// Counted from 1.
    pub line: usize,
    pub fields: Vec<&'a str>,
}

/// A file: its viewport and its records.
#[derive(Clone, Debug)]
pub struct Table<'a> {
    pub width: u32,
    pub height: u32,
    pub records: Vec<Record<'a>>,
}

/// What is wrong, and in which line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadRecord {
    pub line: usize,
    pub reason: String,
}

/// Pixels `(y, x0, x1)` of one row, both ends included.
pub type SpanRow = (u32, u32, u32);

impl<'a> Table<'a> {
    /// Splits `text`; the viewport is the first `WxH` in a comment, or `default` if none tells.
    pub fn parse(text: &'a str, default: (u32, u32)) -> Self {
        let mut size = None;
        let mut records = Vec::new();
        for (line, content) in (1..).zip(text.lines().map(str::trim)) {
            if let Some(comment) = content.strip_prefix('#') {
                size = size.or_else(|| viewport_in(comment));
            } else if !content.is_empty() {
                let fields = content.split(',').map(str::trim).collect();
                records.push(Record { line, fields });
            }
        }
        let (width, height) = size.unwrap_or(default);
        Self { width, height, records }
    }
}

/// The first word of the form `128x64`.
fn viewport_in(comment: &str) -> Option<(u32, u32)> {
    let words = comment.split(|c: char| !c.is_ascii_alphanumeric());
    words.into_iter().find_map(|word| {
        let (width, height) = word.split_once('x')?;
        let size = |text: &str| text.parse().ok().filter(|n| (1..=4096).contains(n));
        Some((size(width)?, size(height)?))
    })
}

impl Record<'_> {
    /// An error about this record.
    pub fn bad(&self, reason: impl Into<String>) -> BadRecord {
        let reason = reason.into();
        BadRecord { line: self.line, reason }
    }

    /// Fails unless there are exactly `count` fields.
    pub fn expect_fields(&self, count: usize) -> Result<(), BadRecord> {
        match self.fields.len() {
            n if n == count => Ok(()),
            n => Err(self.bad(format!("{n} fields instead of {count}"))),
        }
    }

    /// Field `index` as text.
    pub fn text(&self, index: usize) -> Result<&str, BadRecord> {
        let missing = || self.bad(format!("field {} is missing", index + 1));
        self.fields.get(index).copied().ok_or_else(missing)
    }

    fn parse_as<T: FromStr>(&self, index: usize, text: &str) -> Result<T, BadRecord> {
        let wrong = |_| self.bad(format!("field {}: `{text}` is not a number in range", index + 1));
        text.parse().map_err(wrong)
    }

    /// Field `index` as one number.
    pub fn number<T: FromStr>(&self, index: usize) -> Result<T, BadRecord> {
        self.parse_as(index, self.text(index)?)
    }

    /// The `N` fields from `index` as numbers.
    pub fn numbers<T: FromStr + Copy + Default, const N: usize>(&self, index: usize) -> Result<[T; N], BadRecord> {
        let mut result = [T::default(); N];
        for (i, slot) in result.iter_mut().enumerate() {
            *slot = self.number(index + i)?;
        }
        Ok(result)
    }

    /// Three points or vertices of `N` numbers each, from field `index`.
    pub fn triangle<T: FromStr + Copy + Default, const N: usize>(
        &self,
        index: usize,
    ) -> Result<[[T; N]; 3], BadRecord> {
        Ok([self.numbers(index)?, self.numbers(index + N)?, self.numbers(index + 2 * N)?])
    }

    /// Field `index` as a list of numbers split by spaces.
    pub fn list<T: FromStr>(&self, index: usize) -> Result<Vec<T>, BadRecord> {
        let items = self.text(index)?.split_whitespace();
        items.map(|item| self.parse_as(index, item)).collect()
    }

    /// Field `index` as a run-length list (`v*n` or `v`) of exactly `count` values.
    pub fn run_lengths(&self, index: usize, count: usize) -> Result<Vec<u32>, BadRecord> {
        let mut values = Vec::with_capacity(count);
        for item in self.text(index)?.split_whitespace() {
            let (value, times) = item.split_once('*').unwrap_or((item, "1"));
            let times: usize = self.parse_as(index, times)?;
            if times > count - values.len() {
                return Err(self.bad(format!("field {}: more than {count} values", index + 1)));
            }
            values.resize(values.len() + times, self.parse_as(index, value)?);
        }
        match values.len() {
            n if n == count => Ok(values),
            n => Err(self.bad(format!("field {}: {n} values instead of {count}", index + 1))),
        }
    }

    /// Field `index` as a chain of pixels: `-`, or `x.y` and a digit for each step, 0 = (+1, 0), 1 = (+1, +1) and so
    /// on.
    pub fn chain(&self, index: usize) -> Result<Vec<(u32, u32)>, BadRecord> {
        let mut words = self.text(index)?.split_whitespace();
        let wrong = || self.bad(format!("field {}: not a chain of pixels", index + 1));
        let first = words.next().ok_or_else(wrong)?;
        let steps = words.next().unwrap_or("");
        if first == "-" && steps.is_empty() {
            return Ok(Vec::new());
        }
        let (x, y) = first.split_once('.').ok_or_else(wrong)?;
        let mut at: (u32, u32) = (self.parse_as(index, x)?, self.parse_as(index, y)?);
        let mut pixels = vec![at];
        for step in steps.chars() {
            let turn = step.to_digit(8).ok_or_else(wrong)? as usize;
            let by = |k: usize| [1, 1, 0, -1, -1, -1, 0, 1][k % 8];
            let moved = (at.0.checked_add_signed(by(turn)), at.1.checked_add_signed(by(turn + 6)));
            let (Some(x), Some(y)) = moved else { return Err(wrong()) };
            at = (x, y);
            pixels.push(at);
        }
        match words.next() {
            None => Ok(pixels),
            Some(_) => Err(wrong()),
        }
    }

    /// Field `index` as spans: `-`, or `y0` and a token per row, `.` or `a-b;c-d`. They ascend and stay in the
    /// viewport.
    pub fn spans(&self, index: usize, (width, height): (u32, u32)) -> Result<Vec<SpanRow>, BadRecord> {
        let mut result = Vec::new();
        let mut tokens = self.text(index)?.split_whitespace();
        let first = tokens.next().ok_or_else(|| self.bad(format!("field {} is empty", index + 1)))?;
        if first == "-" {
            return match tokens.next() {
                None => Ok(result),
                Some(more) => Err(self.bad(format!("field {}: `{more}` after `-`", index + 1))),
            };
        }
        let y0: u32 = self.parse_as(index, first)?;
        for (y, token) in (u64::from(y0)..).zip(tokens) {
            let wrong = || self.bad(format!("field {}: bad span token `{token}` in row {y}", index + 1));
            let y = u32::try_from(y).ok().filter(|&y| y < height).ok_or_else(wrong)?;
            if token == "." {
                continue;
            }
            let mut free_from = 0;
            for span in token.split(';') {
                let (a, b) = span.split_once('-').ok_or_else(wrong)?;
                let (x0, x1): (u32, u32) = (self.parse_as(index, a)?, self.parse_as(index, b)?);
                if x0 < free_from || x1 < x0 || x1 >= width {
                    return Err(wrong());
                }
                free_from = x1 + 1;
                result.push((y, x0, x1));
            }
        }
        Ok(result)
    }
}

/// How many pixels the spans hold.
pub fn pixel_count(spans: &[SpanRow]) -> usize {
    spans.iter().map(|&(_, x0, x1)| (x1 - x0 + 1) as usize).sum()
}
