//! A model in a container, to be counted: on a host it writes the words that firmware finds it in, and prints hashes of
//! its pictures. `ci/model MODEL.zstm` runs both and prints the table.
//!
//! ```text
//! cargo run --release --example container -- MODEL.zstm MODEL.bin WIDTH HEIGHT ROWS ZOOM
//! ```
//! As firmware it finds the words in memory, where QEMU has loaded them. Both print
//! `stage number ticks hash vertices triangles drawn`: SysTick's ticks over a stage of a frame, which are instructions
//! on RISC-V and 0 on the host. The stages are `check`, which is `Model::from_bytes`, `clear`, a frame without a model,
//! and for each frame of a turntable's show `pose` (of models with clips), `place` and `draw`.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "firmware/count.rs"]
mod count;
#[cfg(not(target_os = "none"))]
mod count {
    /// A host counts nothing.
    pub fn ticks_of<T>(call: impl FnOnce() -> T) -> u32 {
        _ = call();
        0
    }
}
#[cfg(target_os = "none")]
mod firmware;
#[path = "workloads/hash.rs"]
mod hash;
#[cfg(target_os = "none")]
#[path = "firmware/ticks.rs"]
mod ticks;
mod turntable;

use core::hint::black_box;
use hash::Hash;
#[cfg(target_os = "none")]
use semihosting::println;
use turntable::{BACKGROUND, Panel, Turntable};
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::light::Sunlit;
use zstrip::model::{Model, Place, Placed};
use zstrip::prelude::*;
use zstrip::target::{Stats, Strip, WithDepth, WithRecords};

/// First word of what firmware finds; the panel follows, and the container.
const MAGIC: u32 = u32::from_le_bytes(*b"SHOW");
/// Words before the container.
const HEAD: usize = 8;

/// Pixels of a strip, draws, words of records and of a pose: at most.
const PIXELS: usize = 320 * 320;
const DRAWS: usize = 256;
const RECORDS: usize = 400 * 1024;
const POSE: usize = 192 * 1024;

struct Memory<'m> {
    color: &'m mut [u16],
    depth: &'m mut [u16],
    records: &'m mut [u32],
    pose: &'m mut [u32],
}

type Places = [Option<Place<Sunlit>>; DRAWS];

/// Colours, depths and records of a frame.
type Buffers<'b> = (&'b mut [u16], &'b mut [u16], &'b mut [u32]);

/// The closure of a frame, called through a pointer.
type DrawScene<'d> = dyn FnMut(&mut Scene<'_, Strip<'_, Rgb565, WithDepth, WithRecords>>) + 'd;

/// Draws a frame in strips.
#[inline(never)]
fn frame(panel: &Panel, buffers: Buffers<'_>, sink: &mut dyn FnMut(&[u16]), draw: &mut DrawScene<'_>) -> Stats {
    let (color, depth, records) = buffers;
    let Ok(renderer) = Renderer::new(panel.screen()).and_then(|renderer| renderer.with_depth(depth)) else {
        return Stats::default();
    };
    let mut renderer = renderer.with_records(records);
    let mut frame = renderer.begin(BACKGROUND);
    while let Ok(Some(strip)) = frame.next_strip(color, &mut *draw) {
        sink(strip.pixels());
    }
    frame.stats()
}

/// Reads the panel and the container.
fn parse(words: &[u32]) -> Result<(Panel, &[u8]), &'static str> {
    let Some((&[magic, width, height, rows, zoom, ..], container)) = words.split_first_chunk::<HEAD>() else {
        return Err("there are no words");
    };
    if magic != MAGIC {
        return Err("the words are not those of a show");
    }
    if (width as usize).saturating_mul(rows as usize) > PIXELS {
        return Err("a strip has too many pixels");
    }
    Ok((Panel { width, height, rows, zoom }, zstrip::bytemuck::cast_slice(container)))
}

/// Prints a stage of a frame: its ticks, and what was drawn.
fn report(stage: &str, number: u32, ticks: u32, stats: &Stats, hash: &Hash) {
    println!("{stage} {number} {ticks} {:08x} {} {} {}", hash.0, stats.vertices, stats.triangles, stats.drawn);
}

/// Counts a frame, and draws it once more for its hash.
fn report_frame(stage: &str, number: u32, mut draw: impl FnMut(&mut dyn FnMut(&[u16])) -> Stats) {
    let ticks = count::ticks_of(|| draw(&mut |strip| _ = black_box(strip)));
    let mut hash = Hash::NEW;
    let stats = draw(&mut |strip| hash.add(strip));
    report(stage, number, ticks, &stats, &hash);
}

/// Counts all stages of a show.
fn show(words: &[u32], memory: Memory<'_>, places: &mut Places) -> Result<(), &'static str> {
    let none = Stats::default();
    let (panel, bytes) = parse(words)?;
    let mut model = None;
    let ticks = count::ticks_of(|| model = Model::from_bytes(bytes).ok());
    report("check", 0, ticks, &none, &Hash::NEW);
    let model = model.ok_or("the container is wrong")?;
    let table = Turntable::new(&model, &panel).map_err(|_| "the model is out of the range of numbers")?;
    let pixels = (panel.width * panel.rows) as usize;
    let Memory { color, depth, records, pose: pose_words } = memory;
    let (color, depth) = (&mut color[..pixels], &mut depth[..pixels]);
    let mut draw = |stage: &str, number: u32, placed: Option<&Placed<'_, Sunlit>>| {
        report_frame(stage, number, |sink| {
            frame(&panel, (&mut *color, &mut *depth, &mut *records), sink, &mut |scene| {
                if let Some(placed) = placed {
                    placed.draw(scene);
                }
            })
        });
    };
    draw("clear", 0, None);
    for number in 0..turntable::steps(&model) {
        let step = turntable::step(&model, number);
        let world = table.world(step.turn);
        let mut pose = None;
        if let Some(motion) = step.motion {
            let mut at_rest = model.pose(&mut *pose_words).map_err(|_| "the pose takes too many words")?;
            let ticks = count::ticks_of(|| at_rest.play(motion));
            report("pose", number, ticks, &none, &Hash::NEW);
            pose = Some(at_rest);
        }
        let mut placed = None;
        let ticks = count::ticks_of(|| {
            placed = match &pose {
                Some(pose) => pose.place(&world, &table.camera, &table.sun, &mut *places),
                None => model.place(&world, &table.camera, &table.sun, &mut *places),
            }
            .ok();
        });
        report("place", number, ticks, &none, &Hash::NEW);
        draw("draw", number, Some(&placed.ok_or("the model has too many draws")?));
    }
    Ok(())
}

#[cfg(target_os = "none")]
fn run() {
    /// Where QEMU puts the words: PSRAM of the MPS2 boards, RAM of `virt` behind that of `memory.x`.
    const WORDS_AT: usize = if cfg!(target_arch = "arm") { 0x2100_0000 } else { 0x8100_0000 };
    /// As many as there is memory for on both.
    const WORDS: usize = 1 << 21;

    struct Static {
        color: [u16; PIXELS],
        depth: [u16; PIXELS],
        records: [u32; RECORDS],
        pose: [u32; POSE],
        places: Places,
    }
    static mut MEMORY: Static =
        Static { color: [0; _], depth: [0; _], records: [0; _], pose: [0; _], places: [None; _] };

    let memory = &raw mut MEMORY;
    // SAFETY: `run` is called once; this is the only reference.
    let Static { color, depth, records, pose, places } = unsafe { &mut *memory };
    let memory = Memory { color, depth, records, pose };
    // SAFETY: there is memory, and nothing else uses it.
    let words = unsafe { core::slice::from_raw_parts(WORDS_AT as *const u32, WORDS) };
    if !count::start() {
        return;
    }
    if let Err(error) = show(words, memory, places) {
        println!("{error}");
        semihosting::process::exit(1);
    }
}

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    match counted() {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("container: {error}");
            std::process::ExitCode::FAILURE
        }
    }
}

/// Writes the words, and prints the lines.
#[cfg(not(target_os = "none"))]
fn counted() -> Result<(), String> {
    let args: Vec<_> = std::env::args().skip(1).collect();
    let [from, to, numbers @ ..] = &args[..] else { return Err(USAGE.to_owned()) };
    let number = |text: &String| text.parse::<u32>().map_err(|error| format!("{text}: {error}"));
    let numbers = numbers.iter().map(number).collect::<Result<Vec<_>, _>>()?;
    let [width, height, rows, zoom] = numbers[..] else { return Err(USAGE.to_owned()) };
    let bytes = std::fs::read(from).map_err(|error| format!("{from}: {error}"))?;
    let mut words = vec![0; HEAD + bytes.len().div_ceil(4)];
    words[..5].copy_from_slice(&[MAGIC, width, height, rows, zoom]);
    zstrip::bytemuck::cast_slice_mut(&mut words[HEAD..])[..bytes.len()].copy_from_slice(&bytes);
    Model::from_bytes(zstrip::bytemuck::cast_slice(&words[HEAD..])).map_err(|error| format!("{from}: {error}"))?;
    let file: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    std::fs::write(to, file).map_err(|error| format!("{to}: {error}"))?;
    let (mut color, mut depth) = (vec![0; PIXELS], vec![0; PIXELS]);
    let (mut records, mut pose) = (vec![0; RECORDS], vec![0; POSE]);
    let memory = Memory { color: &mut color, depth: &mut depth, records: &mut records, pose: &mut pose };
    show(&words, memory, &mut [None; DRAWS]).map_err(|error| format!("{from}: {error}"))
}

#[cfg(not(target_os = "none"))]
const USAGE: &str = "usage: container MODEL.zstm MODEL.bin WIDTH HEIGHT ROWS ZOOM, as ci/model calls it";
