//! An estimate as text.

use super::{Amount, CoreEstimate, Estimate};
use std::fmt;

/// Returns a number with commas between thousands.
fn commas(number: f64) -> String {
    let digits = format!("{number:.0}");
    let groups: Vec<_> = digits.as_bytes().rchunks(3).rev().map(String::from_utf8_lossy).collect();
    groups.join(",")
}

fn millions(number: f64) -> String {
    format!("{:.3}", number / 1e6)
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height, rows] = self.panel;
        writeln!(f, "{width}x{height}, {}, strips of {rows} rows, {} frames of a turn\n", self.format, self.frames)?;
        writeln!(f, "{:<34}{:>12}{:>12}", "per frame", "mean", "worst")?;
        let mut line = |name: &str, Amount { mean, worst }: Amount| {
            writeln!(f, "{name:<34}{:>12}{:>12}", commas(mean), commas(worst))
        };
        line("vertices", self.vertices)?;
        line("  shaded", self.shaded)?;
        line("triangles", self.triangles)?;
        line("  drawn", self.drawn)?;
        line("  rows of these", self.rows)?;
        for (material, pixels) in &self.pixels {
            line(&format!("  pixels of these, {}", material.replace('_', " ")), *pixels)?;
        }
        if self.skinned > 0 {
            writeln!(f, "{:<34}{:>12}", "vertices that joints move", commas(self.skinned as f64))?;
        }
        writeln!(f, "\n{:<34}{:>12}", "flash, bytes", commas(self.flash.total as f64))?;
        for (name, bytes) in &self.flash.sections {
            writeln!(f, "  {name:<32}{:>12}", commas(*bytes as f64))?;
        }
        writeln!(f, "\n{:<34}{:>12}", "RAM, bytes", commas(self.ram.total() as f64))?;
        for (name, bytes) in [
            ("colours of a strip", self.ram.color),
            ("depths of a strip", self.ram.depth),
            ("records", self.ram.records),
            ("pose", self.ram.pose),
            ("places", self.ram.places),
        ] {
            writeln!(f, "  {name:<32}{:>12}", commas(bytes as f64))?;
        }
        writeln!(
            f,
            "\n{:<22}{:>5} {:>16} {:>16} {:>14} {:>7}",
            "", "MHz", "M instructions", "M cycles", "frames/s", "error"
        )?;
        self.cores.iter().try_for_each(|core| write_core(f, core))?;
        writeln!(f)?;
        self.notes.iter().try_for_each(|note| writeln!(f, "{note}"))
    }
}

fn write_core(f: &mut fmt::Formatter<'_>, of: &CoreEstimate) -> fmt::Result {
    let name =
        if of.core.chip.is_empty() { of.core.name.to_owned() } else { format!("{} ({})", of.core.name, of.core.chip) };
    let both = |Amount { mean, worst }: Amount| format!("{} / {}", millions(mean), millions(worst));
    let cycles = of.cycles.map_or("-".to_owned(), both);
    let Amount { mean, worst } = of.frames_per_second();
    let (fps, frame) = (format!("{mean:.1} / {worst:.1}"), both(of.frame));
    let (mega, error) = (of.core.hertz / 1e6, of.error_percent);
    writeln!(f, "{name:<22}{mega:>5.0} {frame:>16} {cycles:>16} {fps:>14} {error:>5.1} %")
}
