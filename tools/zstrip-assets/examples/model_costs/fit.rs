//! Fits costs to what was counted of made-up models.

use super::Show;
use super::least_squares::{Fit, fit, number};
use std::collections::HashMap;
use std::path::Path;
use zstrip_assets::preview::{DRAW_TERMS, Format, POSE_TERMS, Stage, work_of};

const DRAWS: usize = DRAW_TERMS.len();
const POSES: usize = POSE_TERMS.len();
const UNITS: [&str; 2] = ["instructions", "cycles"];

/// The work of a frame, by show and frame.
struct Frame {
    show: usize,
    number: u32,
    rows: u32,
    draws: Vec<(&'static str, [f64; DRAWS])>,
    pose: [f64; POSES],
}

/// Counts of a core, in instructions and cycles, by stage, show and frame.
type Counts = HashMap<(String, usize, u32), [Option<f64>; 2]>;

fn read(path: &Path) -> Result<Counts, String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let line = |line: &str| {
        let mut words = line.split_whitespace();
        let (stage, run) = (words.next()?.to_owned(), words.next()?.split_once('.')?);
        let key = (stage, run.0.parse().ok()?, run.1.parse().ok()?);
        Some((key, [words.next()?.parse().ok(), words.next()?.parse().ok()]))
    };
    Ok(text.lines().filter_map(line).collect())
}

/// Counts the work of all frames that a core has counted.
fn frames(shows: &[Show], counts: &Counts) -> Result<Vec<Frame>, String> {
    let mut frames = vec![];
    let panels = shows.iter().flat_map(|show| show.panels.iter().map(move |panel| (show, panel)));
    for (number, (show, panel)) in panels.enumerate() {
        let fault = |error: &dyn std::fmt::Display| format!("{}: {error}", show.name);
        let stage = Stage::new(&show.container, *panel, Format::Rgb565).map_err(|error| fault(&error))?;
        let mut drawn: Vec<_> =
            counts.keys().filter(|(stage, of, _)| stage == "draw" && *of == number).map(|(.., frame)| *frame).collect();
        drawn.sort_unstable();
        if drawn.is_empty() {
            return Err(fault(&"not counted"));
        }
        for frame in drawn {
            if let Some((draws, pose)) = work_of(&stage, frame).map_err(|error| fault(&error))? {
                frames.push(Frame { show: number, number: frame, rows: panel.rows, draws, pose });
            }
        }
    }
    Ok(frames)
}

fn file(folder: &Path, name: &str, lines: &[String]) -> Result<(), String> {
    let path = folder.join(name);
    std::fs::write(&path, lines.join("\n") + "\n").map_err(|error| format!("{}: {error}", path.display()))
}

/// Returns a count of a frame.
fn count(counts: &Counts, stage: &str, frame: &Frame, unit: usize) -> Option<f64> {
    let number = if stage == "clear" { 0 } else { frame.number };
    counts.get(&(stage.to_owned(), frame.show, number))?[unit]
}

/// Reads the counts of some cores, and writes the costs and tables of tab-separated cells into the folder.
pub fn report(shows: &[Show], folder: &Path, cores: &[&str]) -> Result<(), String> {
    let counts =
        cores.iter().map(|core| read(&folder.join(format!("{core}.models")))).collect::<Result<Vec<_>, _>>()?;
    let first = counts.first().ok_or("no core")?;
    let frames = frames(shows, first)?;
    // A term that no frame has would cost nothing.
    let is_missing = |k: &usize| frames.iter().all(|frame| frame.pose[*k] == 0.0);
    if let Some(k) = (0..POSES).find(is_missing) {
        return Err(format!("no model that is made up has work of the column {}", POSE_TERMS[k]));
    }
    let errors = "worst_error_percent,mean_error_percent";
    let mut models = vec![format!("core,unit,format,material,strips,{},{errors}", DRAW_TERMS.join(","))];
    let mut poses = vec![format!("core,unit,{},{errors}", POSE_TERMS.join(","))];
    let mut materials: Vec<&str> = vec![];
    for (material, _) in frames.iter().flat_map(|frame| &frame.draws) {
        if !materials.contains(material) {
            materials.push(material);
        }
    }
    for (core, counts) in cores.iter().zip(&counts) {
        let headings = ["material"].iter().chain(&DRAW_TERMS).chain(&["largest error", "mean"]);
        let headings = headings.copied().collect::<Vec<_>>().join("\t");
        let mut tables = [15, 1].map(|strips| (strips, vec![headings.clone()]));
        for (unit, unit_name) in UNITS.iter().enumerate() {
            for material in &materials {
                for (strips, table) in &mut tables {
                    let work = frames.iter().filter(|frame| (frame.rows == 16) == (*strips == 15));
                    let work: Vec<_> = work
                        .filter_map(|frame| match &frame.draws[..] {
                            [(of, terms)] if of == material && frame.show < shown(shows) => {
                                let empty = count(counts, "clear", frame, unit)?;
                                Some((*terms, count(counts, "draw", frame, unit)? - empty))
                            }
                            _ => None,
                        })
                        .collect();
                    if work.len() < 2 * DRAWS {
                        continue;
                    }
                    let Fit { costs, worst, mean } = fit(&work);
                    let cells = costs.map(number);
                    let line = cells.join(",");
                    models.push(format!("{core},{unit_name},Rgb565,{material},{strips},{line},{worst:.1},{mean:.1}"));
                    if unit == 0 {
                        table.push(format!("{material}\t{}\t{worst:.1} %\t{mean:.1} %", cells.join("\t")));
                    }
                }
            }
            if let Some((costs, [worst, mean])) = fit_poses(&frames, counts, unit) {
                let cells = costs.map(number).join(",");
                poses.push(format!("{core},{unit_name},{cells},{worst:.1},{mean:.1}"));
            }
        }
        for (strips, table) in &tables {
            file(folder, &format!("{core} models {strips}.table"), table)?;
        }
    }
    // Instructions of each core, beside each other.
    let mut table = vec![format!("core\t{}\tlargest error\tmean", POSE_TERMS.join("\t"))];
    for line in poses.iter().filter(|line| line.contains(",instructions,")) {
        let cells: Vec<_> = line.split(',').collect();
        let [core, _, costs @ .., worst, mean] = &cells[..] else { continue };
        table.push(format!("{core}\t{}\t{worst} %\t{mean} %", costs.join("\t")));
    }
    file(folder, "poses.table", &table)?;
    file(folder, "model_costs.csv", &models)?;
    file(folder, "pose_costs.csv", &poses)
}

/// Returns the number of shows of models that stand still: their draws are fitted, those of models that move are not.
fn shown(shows: &[Show]) -> usize {
    shows.iter().map(|show| show.panels.len()).filter(|panels| *panels > 1).sum()
}

/// Fits the costs of placing and of posing, each to their own counts.
fn fit_poses(frames: &[Frame], counts: &Counts, unit: usize) -> Option<([f64; POSES], [f64; 2])> {
    let node = POSE_TERMS.iter().position(|name| *name == "node")?;
    let of = |stage: &str, is_of: &dyn Fn(usize) -> bool| {
        let work = frames.iter().filter_map(|frame| {
            let terms = std::array::from_fn(|k| if is_of(k) { frame.pose[k] } else { 0.0 });
            Some((terms, count(counts, stage, frame, unit)?))
        });
        work.collect::<Vec<([f64; POSES], f64)>>()
    };
    let (places, poses) = (of("place", &|k| k < node), of("pose", &|k| k >= node));
    if places.is_empty() || poses.is_empty() {
        return None;
    }
    let (place, pose) = (fit(&places), fit(&poses));
    let costs = std::array::from_fn(|k| place.costs[k] + pose.costs[k]);
    Some((costs, [place.worst.max(pose.worst), place.mean.max(pose.mean)]))
}
