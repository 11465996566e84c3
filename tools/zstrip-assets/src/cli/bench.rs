//! `bench`: counts what a model takes, in firmware that runs in QEMU, and compares its pictures with the host's.

use super::arguments::{self, A_COUNT, Conversion, PANEL_OPTIONS, Screen, number, one_of};
use super::emulator::{self, CORES, Core, Counted, Firmware};
use super::failure::Failure;
use super::{help, source};
use lexopt::{Parser, ValueExt};
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Duration;
use zstrip::model::{Model, Pose};
use zstrip_assets::preview::{
    Container, CoreEstimate, Estimate, Format, MOST_CLUSTERS, MOST_DRAWS, MOST_POSE, MOST_RECORDS, MOST_STRIP,
    MOST_WORDS, Stage, Way, estimate, show_head,
};
use zstrip_assets::save;

const BENCH: &str = "\
zstrip-assets bench FILE [options]: counts the instructions of firmware with the model, in QEMU, and compares its
pictures with the host's

  --core m0+|m4|rv32imc   a core; given several times, several cores [default: all three]
  --clusters              counts the model once more with its clusters culled one by one (Placed::cull_clusters), and
                          both ways without records, and compares the four
  --plugin FILE           a plugin of QEMU that counts each instruction of Arm cores, instead of to within five
  --limit SECONDS         stops QEMU after that time on a core [default: 300]
  --zstrip DIR            the copy of zstrip that the firmware is built from [default: where this program was built]
";

/// The copy of zstrip that this program was built in.
const ZSTRIP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// The ways that are compared: the usual one first.
const WAYS: [Way; 4] = [
    Way { directly: false, clusters: false },
    Way { directly: false, clusters: true },
    Way { directly: true, clusters: false },
    Way { directly: true, clusters: true },
];

/// Runs `bench`.
pub fn bench(parser: &mut Parser) -> Result<String, Failure> {
    let (mut conversion, mut screen, mut cores) = (Conversion::default(), Screen::default(), vec![]);
    let mut plugin = std::env::var_os("INSN_COUNT_PLUGIN").filter(|path| !path.is_empty()).map(PathBuf::from);
    let (mut limit, mut zstrip, mut ways) = (300_u32, PathBuf::from(ZSTRIP), &WAYS[..1]);
    let take = &mut |name: &str, parser: &mut Parser| {
        match name {
            "core" => {
                let kinds = CORES.map(|core| (core.name, core));
                cores.push(parser.value()?.parse_with(|text| one_of(text, &kinds))?);
            }
            "clusters" => ways = &WAYS,
            "plugin" => plugin = Some(PathBuf::from(parser.value()?)),
            "limit" => limit = number(name, A_COUNT, parser)?,
            "zstrip" => zstrip = PathBuf::from(parser.value()?),
            _ => return Ok(screen.take(name, parser)? || conversion.take(name, parser)?),
        }
        Ok(true)
    };
    let Some(file) = arguments::read(parser, take)? else { return Ok(help(&format!("{BENCH}\n{PANEL_OPTIONS}"))) };
    if cores.is_empty() {
        cores.extend(CORES);
    }
    if screen.format != Format::Rgb565 {
        return Err(Failure::Usage("bench counts in rgb565 only; check has the other formats".to_owned()));
    }
    let plugin = match plugin {
        Some(path) => Some(path.canonicalize().map_err(|e| Failure::Failed(format!("{}: {e}", path.display())))?),
        None => None,
    };
    let (container, _) = source::container(&file, &conversion, &[])?;
    let stage = source::stage(&file, &container, &screen)?;
    fits(&stage, &container)?;
    if ways.len() > 1 {
        has_clusters(&stage)?;
    }
    let estimate = estimate(&stage, 168e6)?;
    let firmware = Firmware::of(&zstrip)?;
    let folder = Folder::new(&firmware)?;
    let words = write_words(&folder, &stage, &container, ways)?;
    let hashes = hashes(&stage)?;
    let (mut text, mut compared) = (String::from(HEADINGS), String::new());
    for core in &cores {
        let image = firmware.build(core)?;
        let counted = emulator::run(core, &image, &words, plugin.as_deref(), Duration::from_secs(limit.into()))?;
        let foretold = estimate.cores.iter().find(|of| of.core.counted_on == core.name);
        table(&mut text, core, &counted, foretold);
        if ways.len() > 1 {
            _ = write!(compared, "{}", compare_ways(core, ways, &counted));
        }
        compare(core, &counted, &hashes, ways.len())?;
    }
    // Writing to a string does not fail.
    if ways.len() > 1 {
        _ = write!(text, "\n{WAY_HEADINGS}{compared}");
    }
    let all = hashes.len() * ways.len();
    _ = writeln!(text, "\n{all} pictures are those of the host, on each core");
    _ = write!(text, "{}", notes(&estimate, plugin.is_some()));
    Ok(text)
}

/// Refuses a model that the firmware has no memory for.
fn fits(stage: &Stage<'_>, container: &Container) -> Result<(), Failure> {
    let (panel, bytes) = (stage.panel(), container.bytes());
    let head = WAYS.len() * show_head(&panel, 0, 0, WAYS[0]).len();
    for (what, found, most) in [
        ("pixels of a strip", panel.width as usize * panel.rows as usize, MOST_STRIP),
        ("draws", Model::draws(bytes), MOST_DRAWS),
        ("words of a pose", Pose::words(bytes), MOST_POSE),
        ("bytes of the container", bytes.len(), 4 * (MOST_WORDS - head)),
    ] {
        if found > most {
            return Err(Failure::Failed(format!(
                "{what}: {found}, and the firmware that counts has memory for {most}"
            )));
        }
    }
    match Model::draws(bytes) {
        0 => Err(Failure::Failed("the model draws nothing: no node has a mesh".to_owned())),
        _ => Ok(()),
    }
}

/// Refuses a model without clusters, and one that the firmware has too few nodes for.
fn has_clusters(stage: &Stage<'_>) -> Result<(), Failure> {
    match stage.clusters() {
        0 => Err(Failure::Failed(
            "--clusters: the model has none; parts that joints or morph targets move have no clusters".to_owned(),
        )),
        found if found > MOST_CLUSTERS => Err(Failure::Failed(format!(
            "clusters: {found}, and the firmware that counts has memory for {MOST_CLUSTERS}"
        ))),
        _ => Ok(()),
    }
}

/// A folder of this run alone, which goes away with it.
struct Folder(PathBuf);

impl Folder {
    fn new(firmware: &Firmware) -> Result<Self, Failure> {
        let path = firmware.target.join(format!("bench-{}", std::process::id()));
        std::fs::create_dir_all(&path).map_err(|error| Failure::Failed(format!("{}: {error}", path.display())))?;
        Ok(Self(path))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What is left of it disturbs nobody.
        std::fs::remove_dir_all(&self.0).ok();
    }
}

/// Writes the words that the firmware finds in its memory, and returns their file.
fn write_words(folder: &Folder, stage: &Stage<'_>, container: &Container, ways: &[Way]) -> Result<PathBuf, Failure> {
    let file = folder.0.join("model.bin");
    let mut bytes = vec![];
    for (show, way) in ways.iter().enumerate() {
        // Later shows have the container of the first one.
        let container = if show == 0 { container.bytes() } else { &[] };
        let head = show_head(&stage.panel(), container.len() as u32, 0, *way);
        bytes.extend(head.iter().flat_map(|word| word.to_le_bytes()));
        bytes.extend(container);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    save(&file, &bytes).map_err(|error| Failure::Failed(format!("{}: {error}", file.display())))?;
    Ok(file)
}

/// Returns the hashes of the host's frames, that without a model last.
fn hashes(stage: &Stage<'_>) -> Result<Vec<u32>, Failure> {
    let mut hashes = vec![];
    for number in 0..stage.steps() {
        hashes.push(stage.hash(Some(&stage.step(number)))?.0);
    }
    hashes.push(stage.hash(None)?.0);
    Ok(hashes)
}

/// Compares the pictures of the firmware with those of the host, for all shows.
fn compare(core: &Core, counted: &[Counted], hashes: &[u32], shows: usize) -> Result<(), Failure> {
    for show in 0..shows {
        let of_show: Vec<_> = counted.iter().filter(|line| line.show == show).cloned().collect();
        compare_show(core, &of_show, hashes)?;
    }
    Ok(())
}

/// Compares the pictures of a show with those of the host.
fn compare_show(core: &Core, counted: &[Counted], hashes: &[u32]) -> Result<(), Failure> {
    let (empty, frames) = hashes.split_last().unwrap_or((&0, &[]));
    let of = |stage: &'static str| counted.iter().filter(move |line| line.stage == stage);
    let (drawn, clear): (Vec<_>, Vec<_>) = (of("draw").collect(), of("clear").collect());
    if drawn.len() != frames.len() || clear.len() != 1 {
        return Err(Failure::Failed(format!("{}: {} of {} frames were drawn", core.name, drawn.len(), frames.len())));
    }
    let expected = drawn.iter().map(|line| frames.get(line.number as usize)).chain([Some(empty)]);
    let wrong: Vec<_> = drawn
        .iter()
        .chain(&clear)
        .zip(expected)
        .filter(|(line, expected)| *expected != Some(&line.hash))
        .map(|(line, _)| format!("{} {}", line.stage, line.number))
        .collect();
    if wrong.is_empty() {
        return Ok(());
    }
    Err(Failure::Failed(format!("{}: not the picture of the host: {}", core.name, wrong.join(", "))))
}

const HEADINGS: &str = "core     stage    M instructions    largest   foretold    largest  error of the mean\n";

const WAY_HEADINGS: &str =
    "core     records  clusters      place       cull       draw      frame  M instructions, mean of the frames\n";

/// Returns the rows of a core that compare the ways of drawing.
fn compare_ways(core: &Core, ways: &[Way], counted: &[Counted]) -> String {
    let (mut text, mut before) = (String::new(), 0.0);
    for (show, way) in ways.iter().enumerate() {
        let mean = |stage: &str| {
            let counts: Vec<_> = counted
                .iter()
                .filter(|line| line.show == show && line.stage == stage)
                .map(|line| line.instructions as f64 / 1e6)
                .collect();
            // From 0 on: the sum of no floats is -0.
            counts.iter().fold(0.0, |sum, count| sum + count) / counts.len().max(1) as f64
        };
        let [place, cull, draw] = ["place", "cull", "draw"].map(mean);
        let frame = mean("pose") + place + cull + draw;
        let (records, clusters) = (if way.directly { "none" } else { "all" }, if way.clusters { "culled" } else { "" });
        // Writing to a string does not fail.
        _ = write!(
            text,
            "{:<8} {records:<8} {clusters:<8} {place:>10.3} {cull:>10.3} {draw:>10.3} {frame:>10.3}",
            core.name
        );
        if way.clusters {
            _ = write!(text, "  {:+.1} %", 100.0 * (frame / before - 1.0));
        }
        text.push('\n');
        before = frame;
    }
    text
}

/// Writes the rows of a core, for its first show.
fn table(text: &mut String, core: &Core, counted: &[Counted], foretold: Option<&CoreEstimate>) {
    let of = |stage: &str| -> Vec<u64> {
        let counted = counted.iter().filter(|line| line.show == 0 && line.stage == stage);
        counted.map(|line| line.instructions).collect()
    };
    let frames = of("draw").len();
    let mut sums = vec![0; frames];
    for stage in ["pose", "place", "draw"] {
        sums.iter_mut().zip(of(stage)).for_each(|(sum, instructions)| *sum += instructions);
    }
    let rows = [
        ("check", of("check"), None),
        ("clear", of("clear"), None),
        ("pose", of("pose"), foretold.map(|of| of.pose)),
        ("place", of("place"), foretold.map(|of| of.place)),
        ("draw", of("draw"), foretold.map(|of| of.draw)),
        ("frame", sums, foretold.map(|of| of.frame)),
    ];
    for (stage, counts, foretold) in rows {
        let Some(&largest) = counts.iter().max() else { continue };
        let mean = counts.iter().sum::<u64>() as f64 / counts.len() as f64;
        let millions = |count: f64| format!("{:.3}", count / 1e6);
        let (name, mean_text, largest) = (core.name, millions(mean), millions(largest as f64));
        _ = write!(text, "{name:<8} {stage:<8} {mean_text:>14} {largest:>10}");
        if let Some(of) = foretold {
            let error = format!("{:+.1} %", 100.0 * (of.mean / mean - 1.0));
            _ = write!(text, " {:>10} {:>10} {error:>18}", millions(of.mean), millions(of.worst));
        }
        text.push('\n');
    }
}

/// Returns what else there is to know.
fn notes(estimate: &Estimate, exact: bool) -> String {
    let mut text = String::from("draw has clear in it. check is Model::from_bytes, once.\n");
    if !exact {
        text.push_str("Instructions on Arm are counted to within five; --plugin counts them one by one.\n");
    }
    if estimate.ram.records > 4 * MOST_RECORDS {
        text.push_str("The firmware has too few records for the model, and draws some strips once more.\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::made_up::builder;

    #[test]
    fn a_model_without_draws_is_refused() {
        let container = Container::new(builder::Builder::default().build().bytes());
        let Screen { panel, format, .. } = Screen::default();
        let stage = Stage::new(&container, panel, format).expect("a stage");
        let error = fits(&stage, &container).expect_err("nothing to draw").to_string();
        assert!(error.contains("draws nothing"), "{error}");
    }

    #[test]
    fn pictures_that_differ_are_named() {
        let line = |show, stage: &str, number, hash| {
            let stage = stage.to_owned();
            Counted { stage, show, number, instructions: 1, hash }
        };
        let counted = [line(0, "clear", 0, 9), line(0, "draw", 0, 7), line(0, "draw", 1, 8)];
        compare(&CORES[0], &counted, &[7, 8, 9], 1).expect("all equal");
        let error = compare(&CORES[0], &counted, &[7, 5, 9], 1).expect_err("one differs").to_string();
        assert_eq!(error, "m0+: not the picture of the host: draw 1");
        compare(&CORES[0], &counted, &[7, 8, 5], 1).expect_err("the empty frame differs");
        compare(&CORES[0], &counted[..2], &[7, 8, 9], 1).expect_err("a frame is missing");
        compare(&CORES[0], &counted, &[7, 8, 9], 2).expect_err("a show is missing");
        let second = [line(1, "clear", 0, 9), line(1, "draw", 0, 7), line(1, "draw", 1, 5)];
        let error = compare(&CORES[0], &[counted, second].concat(), &[7, 8, 9], 2).expect_err("one differs");
        assert_eq!(error.to_string(), "m0+: not the picture of the host: draw 1");
    }

    #[test]
    fn ways_are_compared_by_the_means_of_their_frames() {
        let line = |show, stage: &str, number, instructions| {
            let stage = stage.to_owned();
            Counted { stage, show, number, instructions, hash: 0 }
        };
        let counted = [
            line(0, "place", 0, 1_000_000),
            line(0, "draw", 0, 2_000_000),
            line(0, "place", 1, 1_000_000),
            line(0, "draw", 1, 4_000_000),
            line(1, "place", 0, 1_000_000),
            line(1, "cull", 0, 500_000),
            line(1, "draw", 0, 1_500_000),
        ];
        let text = compare_ways(&CORES[0], &WAYS[..2], &counted);
        let rows: Vec<_> = text.lines().map(|row| row.split_whitespace().collect::<Vec<_>>()).collect();
        assert_eq!(rows[0], ["m0+", "all", "1.000", "0.000", "3.000", "4.000"]);
        assert_eq!(rows[1], ["m0+", "all", "culled", "1.000", "0.500", "1.500", "3.000", "-25.0", "%"]);
    }
}
