//! Fits costs to counts, and writes them as a file and as tables.

use super::grids::{GRIDS, HEIGHT, ROWS, WIDTH};
use super::least_squares::{Fit, dot, fit, number};
use super::materials::{KINDS, Kind};
use super::work::{self, LARGE, STRIP, TERMS, Work};
use super::{WORKLOADS, formats, pixels};
use std::collections::HashMap;
use std::path::Path;

const FORMATS: [&str; 5] = ["Rgb565", "Rgb565Be", "Rgb888", "Gray8", "Dithered<Rgb565>"];
const PIXELS: f64 = 320.0 * 240.0;

/// Counts of a core: instructions and cycles of each run.
struct Counts(HashMap<(String, String), [Option<f64>; 2]>);

impl Counts {
    fn read(path: &Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
        let line = |line: &str| {
            let mut words = line.split_whitespace();
            let (name, run) = (words.next()?.to_owned(), words.next()?.to_owned());
            Some(((name, run), [words.next()?.parse().ok(), words.next()?.parse().ok()]))
        };
        Ok(Self(text.lines().filter_map(line).collect()))
    }

    fn get(&self, unit: usize, name: &str, run: &str) -> Option<f64> {
        self.0.get(&(name.to_owned(), run.to_owned())).and_then(|counts| counts[unit])
    }
}

/// The work of all grids, of each of [`Kind::COUNTED`].
type Works = [[[Work; ROWS.len()]; GRIDS]; Kind::COUNTED.len()];

/// Tables of tab-separated cells, by name.
struct Tables(HashMap<String, Vec<String>>);

impl Tables {
    /// Adds a row to a table, which begins with these headings.
    fn add(&mut self, table: &str, headings: &[&str], cells: &[String]) {
        let rows = self.0.entry(table.to_owned()).or_insert_with(|| vec![headings.join("\t")]);
        rows.push(cells.join("\t"));
    }
}

/// Headings of the terms in tables.
const HEADINGS: [&str; TERMS.len()] =
    ["draw", "vertex", "triangle", "small: drawn", "row", "pixel", "large: drawn", "row", "pixel", "strip"];

/// Reads the counts of some cores, and writes `costs.csv` and tables of tab-separated cells into the folder.
pub fn report(folder: &Path, cores: &[String]) -> Result<(), String> {
    let counts: Vec<_> = cores.iter().map(|core| Counts::read(&folder.join(format!("{core}.counts")))).collect();
    let counts = counts.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut tables = Tables(HashMap::new());
    let mut csv =
        vec![format!("core,unit,format,material,strips,{},worst_error_percent,mean_error_percent", TERMS.join(","))];
    let works = Kind::COUNTED.map(work::of_grids);
    for (core, counts) in cores.iter().zip(&counts) {
        for (unit, unit_name) in ["instructions", "cycles"].into_iter().enumerate() {
            for format in FORMATS {
                let row = format!("{core},{unit_name},{format}");
                fit_format(counts, &works, unit, format, &mut |material, strips, cells, errors| {
                    let [worst, mean] =
                        errors.map(|error| if error >= 0.0 { format!("{error:.1}") } else { String::new() });
                    csv.push(format!("{row},{material},{strips},{},{worst},{mean}", cells.join(",")));
                    if unit_name == "instructions" && format == "Rgb565" && material != "clear" {
                        let headings: Vec<_> =
                            ["material"].into_iter().chain(HEADINGS).chain(["largest error", "mean"]).collect();
                        let mut line = vec![material.to_owned()];
                        line.extend_from_slice(cells);
                        line.extend(errors.map(|error| format!("{error:.1} %")));
                        tables.add(&format!("{core} {strips}"), &headings, &line);
                    }
                });
            }
        }
    }
    pixel_tables(cores, &counts, &mut tables);
    foretold(cores, &counts, &works, &mut tables);
    for (name, rows) in tables.0 {
        let path = folder.join(format!("{name}.table"));
        std::fs::write(&path, rows.join("\n") + "\n").map_err(|error| format!("{}: {error}", path.display()))?;
    }
    std::fs::write(folder.join("costs.csv"), csv.join("\n") + "\n").map_err(|error| error.to_string())
}

/// Takes a material, strips, costs, and the largest and the mean error.
type Found<'f> = dyn FnMut(&str, &str, &[String], [f64; 2]) + 'f;

/// Fits the costs of each material in a format, and hands them on. The first material is none, `clear`: its pixels are
/// those of the screen, and it has no errors.
fn fit_format(counts: &Counts, works: &Works, unit: usize, format: &str, found: &mut Found<'_>) {
    let clears = ROWS.map(|rows| counts.get(unit, &format!("{format}/clear"), &rows.to_string()));
    let [Some(one), Some(many)] = clears else { return };
    let strip = (many - one) / ((HEIGHT / ROWS[1]) as f64 - 1.0);
    let mut cells: [String; TERMS.len()] = Default::default();
    (cells[LARGE + 2], cells[STRIP]) = (format!("{:.2}", (one - strip) / PIXELS), number(strip));
    found("clear", "", &cells, [-1.0; 2]);
    for (material, kind) in KINDS {
        for (k, rows) in ROWS.into_iter().enumerate() {
            if let Some(frames) = frames(counts, works, unit, format, (material, kind), k) {
                let Fit { costs, worst, mean } = fit(&frames);
                found(material, &(HEIGHT / rows).to_string(), &costs.map(number), [worst, mean]);
            }
        }
    }
}

/// Makes the table of what the costs foretell of the benchmark's workloads.
fn foretold(cores: &[String], counts: &[Counts], works: &Works, tables: &mut Tables) {
    let headings = ["core", "workload", "material", "strips", "foretold, M insns", "counted", "error"];
    for (core, counts) in cores.iter().zip(counts) {
        for (name, workload, kind) in WORKLOADS {
            let Some(&(material, kind)) = KINDS.iter().find(|(_, material)| Some(*material) == kind) else { continue };
            let empty = if workload.width() == WIDTH { "empty" } else { "empty_spot" };
            for ((k, rows), work) in ROWS.into_iter().enumerate().zip(work::of_workload(workload)) {
                let run = rows.to_string();
                let (Some(count), Some(empty)) = (counts.get(0, name, &run), counts.get(0, empty, &run)) else {
                    continue;
                };
                let Some(frames) = frames(counts, works, 0, "Rgb565", (material, kind), k) else { continue };
                let (foretold, counted) = (dot(&work, &fit(&frames).costs), count - empty);
                let mut cells = [core, &name.to_uppercase(), material].map(str::to_owned).to_vec();
                cells.push((HEIGHT / rows).to_string());
                cells.extend([foretold, counted].map(|count| format!("{:.3}", count / 1e6)));
                cells.push(format!("{:+.1} %", 100.0 * (foretold / counted - 1.0)));
                tables.add("foretold", &headings, &cells);
            }
        }
    }
}

/// Returns the work of each grid, in strips of the `k`-th height, and the count of a material. `None` if not all were
/// counted.
fn frames(
    counts: &Counts,
    works: &Works,
    unit: usize,
    format: &str,
    (material, kind): (&str, Kind),
    k: usize,
) -> Option<Vec<(Work, f64)>> {
    let rows = ROWS[k];
    let empty = counts.get(unit, &format!("{format}/clear"), &rows.to_string())?;
    let frame = |(grid, work): (usize, &[Work; ROWS.len()])| {
        Some((work[k], counts.get(unit, &format!("{format}/{material}"), &format!("{grid}/{rows}"))? - empty))
    };
    works[kind.counted()].iter().enumerate().map(frame).collect()
}

/// Makes the tables of pixels of all materials, of formats, and of packers.
fn pixel_tables(cores: &[String], counts: &[Counts], tables: &mut Tables) {
    let headings: Vec<_> = ["instructions per pixel"].into_iter().chain(cores.iter().map(String::as_str)).collect();
    let row = |name: &str, count: &dyn Fn(&Counts) -> Option<f64>| -> Vec<String> {
        let cell = |counts| count(counts).map_or("-".to_owned(), |count| format!("{:.0}", count / PIXELS));
        [name.to_owned()].into_iter().chain(counts.iter().map(cell)).collect()
    };
    for (number, (name, _)) in pixels::ROWS.iter().enumerate().skip(1) {
        let count = |counts: &Counts| Some(counts.get(0, "pixel", &number.to_string())? - counts.get(0, "pixel", "0")?);
        tables.add("pixels", &headings, &row(name, &count));
    }
    for name in formats::FORMATS {
        let count = |counts: &Counts| {
            Some(
                counts.get(0, &format!("format/{name}"), "pixels")?
                    - counts.get(0, &format!("empty/{name}"), "pixels")?,
            )
        };
        tables.add("formats", &headings, &row(&format!("`{name}`"), &count));
    }
    for name in formats::PACKERS {
        let count = |counts: &Counts| counts.get(0, &format!("packer/{name}"), "pixels");
        tables.add("packers", &headings, &row(&format!("`{name}`"), &count));
    }
}
