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
    Container, CoreEstimate, Estimate, Format, MOST_DRAWS, MOST_POSE, MOST_RECORDS, MOST_STRIP, MOST_WORDS, Stage,
    estimate, show_head,
};
use zstrip_assets::save;

const BENCH: &str = "\
zstrip-assets bench FILE [options]: counts the instructions of firmware with the model, in QEMU, and compares its
pictures with the host's

  --core m0+|m4|rv32imc   a core; given several times, several cores [default: all three]
  --plugin FILE           a plugin of QEMU that counts each instruction of Arm cores, instead of to within five
  --limit SECONDS         stops QEMU after that time on a core [default: 300]
  --zstrip DIR            the copy of zstrip that the firmware is built from [default: where this program was built]
";

/// The copy of zstrip that this program was built in.
const ZSTRIP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Runs `bench`.
pub fn bench(parser: &mut Parser) -> Result<String, Failure> {
    let (mut conversion, mut screen, mut cores) = (Conversion::default(), Screen::default(), vec![]);
    let mut plugin = std::env::var_os("INSN_COUNT_PLUGIN").filter(|path| !path.is_empty()).map(PathBuf::from);
    let (mut limit, mut zstrip) = (300_u32, PathBuf::from(ZSTRIP));
    let take = &mut |name: &str, parser: &mut Parser| {
        match name {
            "core" => {
                let kinds = CORES.map(|core| (core.name, core));
                cores.push(parser.value()?.parse_with(|text| one_of(text, &kinds))?);
            }
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
    let estimate = estimate(&stage, 168e6)?;
    let firmware = Firmware::of(&zstrip)?;
    let folder = Folder::new(&firmware)?;
    let words = write_words(&folder, &stage, &container)?;
    let hashes = hashes(&stage)?;
    let mut text = String::from(HEADINGS);
    for core in &cores {
        let image = firmware.build(core)?;
        let counted = emulator::run(core, &image, &words, plugin.as_deref(), Duration::from_secs(limit.into()))?;
        let foretold = estimate.cores.iter().find(|of| of.core.counted_on == core.name);
        table(&mut text, core, &counted, foretold);
        compare(core, &counted, &hashes)?;
    }
    // Writing to a string does not fail.
    _ = writeln!(text, "\n{} pictures are those of the host, on each core", hashes.len());
    _ = write!(text, "{}", notes(&estimate, plugin.is_some()));
    Ok(text)
}

/// Refuses a model that the firmware has no memory for.
fn fits(stage: &Stage<'_>, container: &Container) -> Result<(), Failure> {
    let (panel, bytes) = (stage.panel(), container.bytes());
    let head = show_head(&panel, 0, 0).len();
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
fn write_words(folder: &Folder, stage: &Stage<'_>, container: &Container) -> Result<PathBuf, Failure> {
    let file = folder.0.join("model.bin");
    let head = show_head(&stage.panel(), container.bytes().len() as u32, 0);
    let mut bytes: Vec<_> = head.iter().flat_map(|word| word.to_le_bytes()).collect();
    bytes.extend(container.bytes());
    bytes.resize(bytes.len().next_multiple_of(4), 0);
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

/// Compares the pictures of the firmware with those of the host.
fn compare(core: &Core, counted: &[Counted], hashes: &[u32]) -> Result<(), Failure> {
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

/// Writes the rows of a core.
fn table(text: &mut String, core: &Core, counted: &[Counted], foretold: Option<&CoreEstimate>) {
    let of = |stage: &str| -> Vec<u64> {
        counted.iter().filter(|line| line.stage == stage).map(|line| line.instructions).collect()
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
        let line = |stage: &str, number, hash| Counted { stage: stage.to_owned(), number, instructions: 1, hash };
        let counted = [line("clear", 0, 9), line("draw", 0, 7), line("draw", 1, 8)];
        compare(&CORES[0], &counted, &[7, 8, 9]).expect("all equal");
        let error = compare(&CORES[0], &counted, &[7, 5, 9]).expect_err("one differs").to_string();
        assert_eq!(error, "m0+: not the picture of the host: draw 1");
        compare(&CORES[0], &counted, &[7, 8, 5]).expect_err("the empty frame differs");
        compare(&CORES[0], &counted[..2], &[7, 8, 9]).expect_err("a frame is missing");
    }
}
