//! The tables of costs that were counted on emulated cores: `benches/costs.csv` of the library, which docs/costs.md
//! explains, and `pose_costs.csv` beside this file, which has what a model's own stages take.

use std::collections::HashMap;

const COSTS: &str = include_str!("../../../../../benches/costs.csv");

/// Terms of a draw's cost, in the order of the columns of the table.
pub const TERMS: usize = 10;
pub const DRAW: usize = 0;
pub const VERTEX: usize = 1;
pub const TRIANGLE: usize = 2;
pub const SMALL: usize = 3;
pub const LARGE: usize = 6;
pub const STRIP: usize = 9;

/// Costs of a material on a core, and the largest error of the frames that they were fitted to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Costs {
    pub terms: [f64; TERMS],
    pub worst_percent: f64,
}

/// A row's key: core, unit, format, material, strips; 0 for the costs of clearing.
type Key<'t> = (&'t str, &'t str, &'t str, &'t str, u32);

/// A table of costs.
pub struct Table<'t>(HashMap<Key<'t>, Costs>);

impl Table<'static> {
    /// Returns the table that the crate was built with.
    pub fn built_in() -> Self {
        Self::parse(COSTS).unwrap_or_else(|line| unreachable!("a test reads all lines of costs.csv, also {line}"))
    }
}

impl<'t> Table<'t> {
    /// Reads a table. The error is the number of a line that is not as the others.
    pub fn parse(text: &'t str) -> Result<Self, usize> {
        let lines = text.lines().enumerate().skip(1);
        let row = |(number, line)| Self::row(line).ok_or(number + 1);
        lines.map(row).collect::<Result<_, _>>().map(Self)
    }

    fn row(line: &'t str) -> Option<(Key<'t>, Costs)> {
        let cells: Vec<_> = line.split(',').collect();
        let [core, unit, format, material, strips, costs @ ..] = &cells[..] else { return None };
        let number = |cell: &&str| if cell.is_empty() { Some(0.0) } else { cell.parse::<f64>().ok() };
        let numbers = costs.iter().map(number).collect::<Option<Vec<_>>>()?;
        let (terms, errors) = numbers.split_first_chunk::<TERMS>()?;
        let [worst_percent, _] = errors[..] else { return None };
        let strips = if strips.is_empty() { 0 } else { strips.parse().ok()? };
        Some(((core, unit, format, material, strips), Costs { terms: *terms, worst_percent }))
    }

    /// Returns the costs of clearing a frame: of a pixel of the screen, and of a strip.
    pub fn clear(&self, core: &str, unit: &str, format: &str) -> Option<(f64, f64)> {
        let costs = self.0.get(&(core, unit, format, "clear", 0))?;
        Some((costs.terms[LARGE + 2], costs.terms[STRIP]))
    }

    /// Returns the costs of a material in a frame of so many strips.
    ///
    /// The table has one strip and fifteen. A draw's cost grows evenly from the former to the latter. Of formats other
    /// than RGB565 it has one strip only: strips add to them what they add to RGB565.
    pub fn material(&self, core: &str, unit: &str, format: &str, material: &str, strips: u32) -> Option<Costs> {
        let get = |format, strips| self.0.get(&(core, unit, format, material, strips)).copied();
        let one = get(format, 1)?;
        if strips <= 1 {
            return Some(one);
        }
        let many = match get(format, 15) {
            Some(many) => many,
            None => {
                let (from, to) = (get("Rgb565", 1)?, get("Rgb565", 15)?);
                let terms = std::array::from_fn(|k| (one.terms[k] + to.terms[k] - from.terms[k]).max(0.0));
                Costs { terms, worst_percent: one.worst_percent.max(to.worst_percent) }
            }
        };
        let mut terms = many.terms;
        terms[DRAW] = one.terms[DRAW] + (many.terms[DRAW] - one.terms[DRAW]) * f64::from(strips - 1) / 14.0;
        Some(Costs { terms, ..many })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_lines_are_read_and_all_cores_have_all_materials() {
        let table = Table::parse(COSTS).expect("a table");
        assert_eq!(table.0.len(), COSTS.lines().count() - 1, "a key stands there twice");
        for (core, units) in [("m0+", 2), ("m4", 2), ("rv32imc", 1)] {
            for unit in &["instructions", "cycles"][..units] {
                for (_, _, format) in super::super::super::Format::ALL {
                    let (pixel, strip) = table.clear(core, unit, format).expect("costs of clearing");
                    assert!(pixel > 0.1 && strip > 100.0, "{core} {unit} {format}");
                    for material in super::super::work::Material::ALL {
                        let costs = |strips| table.material(core, unit, format, material.name(), strips);
                        let (one, many) = (costs(1).expect("one strip"), costs(15).expect("15 strips"));
                        assert!(one.terms[DRAW] < many.terms[DRAW], "{core} {unit} {format} {material:?}");
                        assert!(one.worst_percent > 0.0 && one.terms[STRIP] == 0.0);
                    }
                }
            }
        }
    }

    #[test]
    fn costs_of_a_draw_lie_between_those_of_one_strip_and_of_fifteen() {
        let table = Table::built_in();
        let draw = |strips| table.material("m4", "instructions", "Rgb565", "flat", strips).expect("costs").terms[DRAW];
        assert_eq!(draw(1), 6369.0);
        assert_eq!(draw(15), 23_043.0);
        assert!((draw(8) - (6369.0 + 23_043.0) / 2.0).abs() < 1.0);
    }

    #[test]
    fn a_line_that_is_cut_is_named() {
        assert_eq!(Table::parse("head\nm4,cycles,Gray8,flat,1,2\n").err(), Some(2));
        assert_eq!(Table::parse("head\nm4,cycles,Gray8,flat,one,1,2,3,4,5,6,7,8,9,10,1,1\n").err(), Some(2));
    }
}
