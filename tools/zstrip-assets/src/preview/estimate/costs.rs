//! The tables of costs that were counted on emulated cores, which docs/costs.md explains: `benches/model_costs.csv` has
//! the materials of models in RGB565, and `benches/costs.csv` what other formats take beside that.

use std::collections::HashMap;

const MODELS: &str = include_str!("../../../../../benches/model_costs.csv");
const FORMATS: &str = include_str!("../../../../../benches/costs.csv");

/// Terms of a draw's cost, in the order of the columns of the table of models.
pub const NAMES: [&str; TERMS] = [
    "draw",
    "vertex",
    "triangle",
    "small_drawn",
    "small_row",
    "small_pixel",
    "large_drawn",
    "large_row",
    "large_pixel",
    "strip",
    "shaded",
];
pub const TERMS: usize = 11;
pub const DRAW: usize = 0;
pub const VERTEX: usize = 1;
pub const TRIANGLE: usize = 2;
pub const SMALL: usize = 3;
pub const LARGE: usize = 6;
pub const STRIP: usize = 9;
/// Vertices whose colours and texture coordinates are asked for: those of triangles that are drawn. The table of
/// formats ends before it.
pub const SHADED: usize = 10;

/// Costs of a material on a core, and the largest error of the frames that they were fitted to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Costs<const N: usize> {
    pub terms: [f64; N],
    pub worst_percent: f64,
}

/// A row's key: core, unit, format, material, strips; 0 for the costs of clearing.
type Key<'t> = (&'t str, &'t str, &'t str, &'t str, u32);

/// Rows of a table.
type Rows<'t, const N: usize> = HashMap<Key<'t>, Costs<N>>;

/// The tables of costs.
pub struct Table<'t> {
    models: Rows<'t, TERMS>,
    formats: Rows<'t, SHADED>,
}

impl Table<'static> {
    /// Returns the tables that the crate was built with.
    pub fn built_in() -> Self {
        Self::parse(MODELS, FORMATS).unwrap_or_else(|line| unreachable!("a test reads all lines, also {line}"))
    }
}

impl<'t> Table<'t> {
    /// Reads the tables. The error is the number of a line that is not as the others.
    pub fn parse(models: &'t str, formats: &'t str) -> Result<Self, usize> {
        Ok(Self { models: rows(models)?, formats: rows(formats)? })
    }

    /// Returns the costs of clearing a frame: of a pixel of the screen, and of a strip.
    pub fn clear(&self, core: &str, unit: &str, format: &str) -> Option<(f64, f64)> {
        let costs = self.formats.get(&(core, unit, format, "clear", 0))?;
        Some((costs.terms[LARGE + 2], costs.terms[STRIP]))
    }

    /// Returns the costs of a material of models in a frame of so many strips.
    ///
    /// The table has one strip and fifteen. A draw's cost grows evenly from the former to the latter. To costs of
    /// formats other than RGB565 is added what `in_formats`, the nearest material of the table of formats, takes more
    /// there.
    pub fn material(
        &self,
        [core, unit, format]: [&str; 3],
        material: &str,
        in_formats: &str,
        strips: u32,
    ) -> Option<Costs<TERMS>> {
        let get = |strips| self.models.get(&(core, unit, "Rgb565", material, strips)).copied();
        let one = get(1)?;
        let mut costs = one;
        if strips > 1 {
            costs = get(15)?;
            costs.terms[DRAW] = one.terms[DRAW] + (costs.terms[DRAW] - one.terms[DRAW]) * f64::from(strips - 1) / 14.0;
        }
        if format != "Rgb565" {
            let of = |format| self.formats.get(&(core, unit, format, in_formats, 1));
            let (from, to) = (of("Rgb565")?, of(format)?);
            for ((cost, from), to) in costs.terms.iter_mut().zip(from.terms).zip(to.terms) {
                *cost = (*cost + to - from).max(0.0);
            }
            costs.worst_percent = costs.worst_percent.max(to.worst_percent);
        }
        Some(costs)
    }
}

fn rows<const N: usize>(text: &str) -> Result<Rows<'_, N>, usize> {
    let lines = text.lines().enumerate().skip(1);
    lines.map(|(number, line)| row(line).ok_or(number + 1)).collect()
}

fn row<const N: usize>(line: &str) -> Option<(Key<'_>, Costs<N>)> {
    let cells: Vec<_> = line.split(',').collect();
    let [core, unit, format, material, strips, costs @ ..] = &cells[..] else { return None };
    let number = |cell: &&str| if cell.is_empty() { Some(0.0) } else { cell.parse::<f64>().ok() };
    let numbers = costs.iter().map(number).collect::<Option<Vec<_>>>()?;
    let (terms, errors) = numbers.split_first_chunk::<N>()?;
    let [worst_percent, _] = errors[..] else { return None };
    let strips = if strips.is_empty() { 0 } else { strips.parse().ok()? };
    Some(((core, unit, format, material, strips), Costs { terms: *terms, worst_percent }))
}

#[cfg(test)]
mod tests {
    use super::super::work::Material;
    use super::*;

    #[test]
    fn all_lines_are_read_and_all_cores_have_all_materials() {
        let table = Table::parse(MODELS, FORMATS).expect("tables");
        assert_eq!(table.formats.len(), FORMATS.lines().count() - 1, "a key stands there twice");
        assert_eq!(table.models.len(), MODELS.lines().count() - 1, "a key stands there twice");
        for (core, units) in [("m0+", 2), ("m4", 2), ("rv32imc", 1)] {
            for unit in &["instructions", "cycles"][..units] {
                for (_, _, format) in super::super::super::Format::ALL {
                    let (pixel, strip) = table.clear(core, unit, format).expect("costs of clearing");
                    assert!(pixel > 0.1 && strip > 100.0, "{core} {unit} {format}");
                    for material in Material::ALL {
                        let key = [core, unit, format];
                        let costs = |strips| table.material(key, material.name(), material.in_formats(), strips);
                        let (one, many) = (costs(1).expect("one strip"), costs(15).expect("15 strips"));
                        assert!(one.terms[DRAW] <= many.terms[DRAW], "{core} {unit} {format} {material:?}");
                        assert!(one.worst_percent > 0.0, "{core} {unit} {format} {material:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn costs_of_a_draw_lie_between_those_of_one_strip_and_of_fifteen() {
        let table = Table::built_in();
        let key = ["m4", "instructions", "Rgb565"];
        let draw = |strips| table.material(key, "flat", "flat", strips).expect("costs").terms[DRAW];
        assert!((draw(8) - (draw(1) + draw(15)) / 2.0).abs() < 1.0 && draw(1) < draw(15));
    }

    #[test]
    fn texels_that_take_more_work_cost_more() {
        let table = Table::built_in();
        for core in ["m0+", "m4", "rv32imc"] {
            let pixel = |material| {
                let costs = table.material([core, "instructions", "Rgb565"], material, "lit_textured", 15);
                costs.expect("costs").terms[SMALL + 2]
            };
            assert!(pixel("textured") < pixel("palette"), "{core}");
            assert!(pixel("palette") < pixel("glass_palette"), "{core}");
        }
    }

    #[test]
    fn a_line_that_is_cut_is_named() {
        let error = |formats| Table::parse("head\n", formats).err();
        assert_eq!(error("head\nm4,cycles,Gray8,flat,1,2\n"), Some(2));
        assert_eq!(error("head\nm4,cycles,Gray8,flat,one,1,2,3,4,5,6,7,8,9,10,1,1\n"), Some(2));
    }
}
