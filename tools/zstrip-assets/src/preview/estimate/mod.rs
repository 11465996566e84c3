//! What a model costs before it is flashed: work is counted on the host, and multiplied by costs that were counted on
//! emulated cores.

mod costs;
mod pose_work;
mod table;
mod work;

use super::turntable::{Step, TURN};
use super::{PreviewError, Stage};
use crate::write::SECTION_NAMES;
use costs::{Costs, LARGE, SHADED, SMALL, TERMS, Table, VERTEX};
use pose_work::{COLUMNS, NODE, PoseTerms};
use std::ops::Range;
use work::{DrawWork, Material};
use zstrip::embedded_graphics_core::pixelcolor::Gray8;
use zstrip::frame::RamBudget;
use zstrip::light::Sunlit;
use zstrip::model::container;
use zstrip::model::{Model, Place, Pose};
use zstrip::target::records_len;

/// A core, and a chip that has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Core {
    /// Name of the core.
    pub name: &'static str,
    /// A chip, or nothing.
    pub chip: &'static str,
    /// Name of the core in the tables, which may be another core with nearly the same instructions.
    pub counted_on: &'static str,
    /// Clock in Hz.
    pub hertz: f64,
}

/// The cores of an estimate. The clock of the third one is an option, because chips with a Cortex-M4 differ.
pub const CORES: [Core; 4] = [
    Core { name: "Cortex-M0+", chip: "RP2040", counted_on: "m0+", hertz: 125e6 },
    Core { name: "Cortex-M33", chip: "RP2350", counted_on: "m4", hertz: 150e6 },
    Core { name: "Cortex-M4", chip: "", counted_on: "m4", hertz: 168e6 },
    Core { name: "RV32IMC", chip: "ESP32-C3, C6", counted_on: "rv32imc", hertz: 160e6 },
];

/// The mean of all frames, and the frame that takes most.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Amount {
    /// The mean.
    pub mean: f64,
    /// The largest.
    pub worst: f64,
}

/// An estimate for a core.
#[derive(Clone, Copy, Debug)]
pub struct CoreEstimate {
    /// The core.
    pub core: Core,
    /// Instructions of a pose.
    pub pose: Amount,
    /// Instructions of placing a model or a pose.
    pub place: Amount,
    /// Instructions of drawing, with clearing.
    pub draw: Amount,
    /// Instructions of all of a frame.
    pub frame: Amount,
    /// Cycles of all of a frame with memory that never waits; `None` where only instructions were counted.
    pub cycles: Option<Amount>,
    /// The largest errors of the tables that were used, in percent, each by its part of a frame.
    pub error_percent: f64,
}

impl CoreEstimate {
    /// Returns frames per second, of the mean and of the worst frame. Where cycles are not known, an instruction counts
    /// as one.
    #[must_use]
    pub fn frames_per_second(&self) -> Amount {
        let Amount { mean, worst } = self.cycles.unwrap_or(self.frame);
        Amount { mean: self.core.hertz / mean, worst: self.core.hertz / worst }
    }
}

/// Bytes of a container.
#[derive(Clone, Debug)]
pub struct Flash {
    /// All of it.
    pub total: usize,
    /// Names of the sections that are there, and their bytes.
    pub sections: Vec<(String, usize)>,
}

/// Bytes of RAM that a frame is drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ram {
    /// Colours of a strip.
    pub color: usize,
    /// Depths of a strip.
    pub depth: usize,
    /// Records, so that every frame is recorded once.
    pub records: usize,
    /// Memory of a pose.
    pub pose: usize,
    /// Places of draws.
    pub places: usize,
}

impl Ram {
    /// Returns the sum.
    #[must_use]
    pub const fn total(&self) -> usize {
        self.color + self.depth + self.records + self.pose + self.places
    }
}

/// The cost of a model on a panel.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Width, height and rows of a strip.
    pub panel: [u32; 3],
    /// Format of pixels.
    pub format: &'static str,
    /// Number of frames that were counted.
    pub frames: u32,
    /// Vertices of the parts whose boxes are seen. Each is projected once.
    pub vertices: Amount,
    /// Vertices of triangles that are drawn: those whose colours are computed.
    pub shaded: Amount,
    /// Triangles.
    pub triangles: Amount,
    /// Triangles that are drawn.
    pub drawn: Amount,
    /// Rows of triangles that are drawn.
    pub rows: Amount,
    /// Pixels of triangles that are drawn, hidden ones too, by material.
    pub pixels: Vec<(&'static str, Amount)>,
    /// Vertices that joints move.
    pub skinned: usize,
    /// Flash.
    pub flash: Flash,
    /// RAM.
    pub ram: Ram,
    /// Estimates by core.
    pub cores: Vec<CoreEstimate>,
    /// Things to know about the estimate.
    pub notes: Vec<String>,
}

/// Work of a frame.
struct FrameWork {
    draws: Vec<DrawWork>,
    pose: PoseTerms,
}

/// Counts a model's work in the frames of a turn, and of its clips, and tells what that costs. `m4_hertz` is the clock
/// of the Cortex-M4.
///
/// # Errors
///
/// [`PreviewError::Clock`] if the clock is not from 1 kHz to 10 GHz, and those of [`Stage::picture`].
pub fn estimate(stage: &Stage<'_>, m4_hertz: f64) -> Result<Estimate, PreviewError> {
    if !(1e3..=1e10).contains(&m4_hertz) {
        return Err(PreviewError::Clock(m4_hertz));
    }
    let frames = (0..stage.steps())
        .map(|number| {
            let step: Step = stage.step(number);
            Ok(FrameWork { draws: work::count(stage, &step)?, pose: pose_work::count(stage, &step, number / TURN) })
        })
        .collect::<Result<Vec<_>, PreviewError>>()?;
    let table = Table::built_in();
    let cores = CORES.map(|core| match core.name {
        "Cortex-M4" => Core { hertz: m4_hertz, ..core },
        _ => core,
    });
    let format = super::Format::ALL.iter().find(|(format, ..)| *format == stage.format).map_or("", |(.., name)| name);
    let strips = stage.panel.height.div_ceil(stage.panel.rows);
    let sum = |of: &dyn Fn(&DrawWork) -> f64| amount(frames.iter().map(|frame| frame.draws.iter().map(of).sum()));
    let is_used = |material| frames.iter().flat_map(|frame| &frame.draws).any(|draw| draw.material == material);
    let materials = Material::ALL.into_iter().filter(|material| is_used(*material));
    let record_words = frames.iter().map(|frame| {
        frame.draws.iter().fold(strips as usize, |words, draw| {
            let drawn = draw.terms[SMALL] + draw.terms[LARGE];
            let vertices = draw.terms[VERTEX] as usize;
            words.saturating_add(records_len(0, 1, vertices, draw.material.words(), drawn.ceil() as usize))
        })
    });
    let budget = RamBudget::new::<Gray8>(stage.panel.width, stage.panel.rows);
    let has_clips = stage.model.clips().next().is_some();
    let estimates = cores.iter().filter_map(|core| of_core(&table, *core, format, stage, &frames)).collect();
    let influences = stage.items::<container::Influence>(container::SectionKind::Influences).len();
    Ok(Estimate {
        panel: [stage.panel.width, stage.panel.height, stage.panel.rows],
        format,
        frames: stage.steps(),
        vertices: sum(&|draw| draw.terms[VERTEX]),
        shaded: sum(&|draw| draw.terms[SHADED]),
        triangles: sum(&|draw| draw.terms[costs::TRIANGLE]),
        drawn: sum(&|draw| draw.terms[SMALL] + draw.terms[LARGE]),
        rows: sum(&|draw| draw.terms[SMALL + 1] + draw.terms[LARGE + 1]),
        pixels: materials
            .map(|material| {
                let pixels = |draw: &DrawWork| {
                    if draw.material == material { draw.terms[SMALL + 2] + draw.terms[LARGE + 2] } else { 0.0 }
                };
                (material.name(), sum(&pixels))
            })
            .collect(),
        skinned: influences,
        flash: flash(stage),
        ram: Ram {
            color: budget.color * stage.format.bytes(),
            depth: budget.depth,
            records: 4 * record_words.max().unwrap_or(0),
            pose: if has_clips { 4 * Pose::words(stage.bytes) } else { 0 },
            places: size_of::<Option<Place<Sunlit>>>() * Model::draws(stage.bytes),
        },
        cores: estimates,
        notes: notes(&frames),
    })
}

/// Returns the mean and the largest number.
fn amount(numbers: impl Iterator<Item = f64>) -> Amount {
    let (mut sum, mut worst, mut count) = (0.0, 0.0_f64, 0.0);
    for number in numbers {
        (sum, worst, count) = (sum + number, worst.max(number), count + 1.0);
    }
    Amount { mean: if count > 0.0 { sum / count } else { 0.0 }, worst }
}

/// Returns the estimate for a core; `None` if the tables do not have it.
fn of_core(
    table: &Table<'_>,
    core: Core,
    format: &str,
    stage: &Stage<'_>,
    frames: &[FrameWork],
) -> Option<CoreEstimate> {
    let (mut draw_error, mut pose_errors) = (0.0_f64, 0.0_f64);
    let mut of_unit = |unit: &str| {
        let strips = stage.panel.height.div_ceil(stage.panel.rows);
        let (pixel, strip) = table.clear(core.counted_on, unit, format)?;
        let clear = pixel * f64::from(stage.panel.width) * f64::from(stage.panel.height) + strip * f64::from(strips);
        let (pose_costs, pose_error) = pose_work::costs(core.counted_on, unit)?;
        let key = [core.counted_on, unit, format];
        let costs = |material: Material| table.material(key, material.name(), material.in_formats(), strips);
        let mut stages = vec![];
        for frame in frames {
            let sum = |columns: Range<usize>| columns.map(|k| frame.pose[k] * pose_costs[k]).sum::<f64>();
            let mut drawn = clear;
            for draw in &frame.draws {
                let of = costs(draw.material)?;
                draw_error = draw_error.max(of.worst_percent);
                drawn += of_draw(draw, &of);
            }
            stages.push([sum(NODE..COLUMNS), sum(0..NODE), drawn]);
        }
        pose_errors = pose_errors.max(pose_error);
        let stage = |k: usize| amount(stages.iter().map(|stage| stage[k]));
        Some([stage(0), stage(1), stage(2), amount(stages.iter().map(|stage| stage.iter().sum()))])
    };
    let [pose, place, draw, frame] = of_unit("instructions")?;
    let cycles = of_unit("cycles").map(|[.., cycles]| cycles);
    // Each part of a frame has the error of its table.
    let error_percent = (draw.mean * draw_error + (pose.mean + place.mean) * pose_errors) / frame.mean.max(1.0);
    Some(CoreEstimate { core, pose, place, draw, frame, cycles, error_percent })
}

/// Returns the sum of a draw's costs.
fn of_draw(draw: &DrawWork, costs: &Costs<TERMS>) -> f64 {
    draw.terms.iter().zip(costs.terms).map(|(count, cost)| count * cost).sum()
}

/// Work of a draw: the name of its material, and the numbers of [`DRAW_TERMS`].
pub type DrawCounts = (&'static str, [f64; TERMS]);

/// Names of what a draw has to do, as the columns of benches/model_costs.csv.
pub const DRAW_TERMS: [&str; TERMS] = costs::NAMES;

/// Names of what placing and posing has to do, as the columns of benches/pose_costs.csv: placing before `node`.
pub const POSE_TERMS: [&str; COLUMNS] = pose_work::NAMES;

/// Work of a frame: that of each draw, and the numbers of [`POSE_TERMS`].
pub type FrameCounts = (Vec<DrawCounts>, [f64; COLUMNS]);

/// Counts the work of a frame, for programs that fit costs. `None` stands for frames that are not fitted, because
/// triangles are clipped in them.
///
/// # Errors
///
/// Those of [`Stage::picture`].
pub fn work_of(stage: &Stage<'_>, number: u32) -> Result<Option<FrameCounts>, PreviewError> {
    let step = stage.step(number);
    let draws = work::count(stage, &step)?;
    if draws.iter().any(|draw| draw.clips) {
        return Ok(None);
    }
    let draws = draws.iter().map(|draw| (draw.material.name(), draw.terms)).collect();
    Ok(Some((draws, pose_work::count(stage, &step, number / TURN))))
}

fn flash(stage: &Stage<'_>) -> Flash {
    let header = stage.header();
    let head = size_of::<container::Header>();
    let mut sections = vec![("head".to_owned(), head)];
    let mut ends: Vec<_> = header.table.iter().map(|section| section.offset as usize).collect();
    ends.push(header.length as usize);
    ends.sort_unstable();
    for (kind, section) in SECTION_NAMES.iter().zip(&header.table) {
        // A section reaches to the next one; an empty one to nowhere.
        let start = section.offset as usize;
        let end = ends.iter().copied().find(|end| *end > start).unwrap_or(start);
        if section.count > 0 {
            sections.push(((*kind).to_owned(), end - start));
        }
    }
    Flash { total: header.length as usize, sections }
}

fn notes(frames: &[FrameWork]) -> Vec<String> {
    let mut notes = vec![
        "Cycles are those of memory that never waits. Flash without a cache adds to them, an instruction per cycle of \
         RV32IMC is assumed, and sending strips to the panel is not counted."
            .to_owned(),
        "Cortex-M33 is estimated by the counts of a Cortex-M4.".to_owned(),
    ];
    if frames.iter().flat_map(|frame| &frame.draws).any(|draw| draw.is_like) {
        notes.push(
            "The tables do not have all of the model's materials: some textures are foretold by those of another \
             format."
                .to_owned(),
        );
    }
    if frames.iter().flat_map(|frame| &frame.draws).any(|draw| draw.clips) {
        notes.push("Triangles are clipped in some frames, which takes more than is foretold here.".to_owned());
    }
    notes
}
