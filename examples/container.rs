//! Models in containers, to be counted: firmware that finds them in memory, where QEMU has loaded them.
//! `zstrip-assets bench FILE` makes the words that it finds, runs it, and compares its pictures with those of the host;
//! `ci/costs` counts made-up models with it.
//!
//! The words are shows, one after the other: a head, `turntable::show_head`, and a container. It prints
//! `stage show.number ticks hash vertices triangles drawn`: SysTick's ticks over a stage of a frame, which are
//! instructions on RISC-V. The stages are `check`, which is `Model::from_bytes`, `clear`, a frame without a model, and
//! for each frame of a turntable's show `pose` (of models with clips), `place`, `cull` (of shows with clusters) and
//! `draw`.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "firmware/count.rs"]
mod count;
#[cfg(target_os = "none")]
mod firmware;
#[cfg(target_os = "none")]
#[path = "workloads/hash.rs"]
mod hash;
#[cfg(target_os = "none")]
#[path = "firmware/ticks.rs"]
mod ticks;
#[cfg(target_os = "none")]
mod turntable;

#[cfg(target_os = "none")]
mod counting {
    use super::count;
    use super::hash::Hash;
    use super::turntable::{
        self, BACKGROUND, HEAD, MAGIC, MOST_CLUSTERS, MOST_DRAWS, MOST_POSE, MOST_RECORDS, MOST_STRIP, MOST_WORDS,
        Panel, Turntable, Way,
    };
    use core::hint::black_box;
    use semihosting::println;
    use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
    use zstrip::light::Sunlit;
    use zstrip::mesh::BoundsNode;
    use zstrip::model::{Model, Place, Placed};
    use zstrip::prelude::*;
    use zstrip::target::{Stats, Strip, WithDepth, WithRecords};

    struct Memory {
        color: [u16; MOST_STRIP],
        depth: [u16; MOST_STRIP],
        records: [u32; MOST_RECORDS],
        pose: [u32; MOST_POSE],
        places: [Option<Place<Sunlit>>; MOST_DRAWS],
        nodes: [BoundsNode; MOST_CLUSTERS],
    }

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

    /// A show as its head describes it.
    struct Show<'w> {
        number: u32,
        panel: Panel,
        bytes: &'w [u8],
        frames: u32,
        way: Way,
    }

    impl Show<'_> {
        /// Prints a stage of a frame: its ticks, and what was drawn.
        fn report(&self, stage: &str, number: u32, ticks: u32, stats: &Stats, hash: &Hash) {
            let (show, Stats { vertices, triangles, drawn, .. }) = (self.number, stats);
            println!("{stage} {show}.{number} {ticks} {:08x} {vertices} {triangles} {drawn}", hash.0);
        }

        /// Counts a frame. If all are, draws it once more for its hash.
        fn report_frame(&self, stage: &str, number: u32, mut draw: impl FnMut(&mut dyn FnMut(&[u16])) -> Stats) {
            let (mut hash, mut stats) = (Hash::NEW, Stats::default());
            let ticks = count::ticks_of(|| stats = draw(&mut |strip| _ = black_box(strip)));
            if self.frames == 0 {
                stats = draw(&mut |strip| hash.add(strip));
            }
            self.report(stage, number, ticks, &stats, &hash);
        }

        /// Counts all stages.
        fn run(&self, memory: &mut Memory) -> Result<(), &'static str> {
            let (none, panel) = (Stats::default(), self.panel);
            let mut model = None;
            let ticks = count::ticks_of(|| model = Some(Model::from_bytes(self.bytes)));
            self.report("check", 0, ticks, &none, &Hash::NEW);
            let Some(Ok(model)) = model else { return Err("the container is wrong") };
            let table = Turntable::new(&model, &panel).map_err(|_| "the model is out of the range of numbers")?;
            let pixels = (panel.width as usize).saturating_mul(panel.rows as usize);
            let Memory { color, depth, records, pose: pose_words, places, nodes } = memory;
            let records = if self.way.directly { &mut [] } else { &mut records[..] };
            let (Some(color), Some(depth)) = (color.get_mut(..pixels), depth.get_mut(..pixels)) else {
                return Err("a strip has too many pixels");
            };
            let mut draw = |stage: &str, number: u32, placed: Option<&Placed<'_, Sunlit>>| {
                self.report_frame(stage, number, |sink| {
                    frame(&panel, (&mut *color, &mut *depth, &mut *records), sink, &mut |scene| {
                        if let Some(placed) = placed {
                            placed.draw(scene);
                        }
                    })
                });
            };
            draw("clear", 0, None);
            for number in turntable::numbers(&model, self.frames) {
                let step = turntable::step(&model, number);
                let world = table.world(step.turn);
                let mut pose = None;
                if let Some(motion) = step.motion {
                    let mut at_rest = model.pose(&mut *pose_words).map_err(|_| "the pose takes too many words")?;
                    let ticks = count::ticks_of(|| at_rest.play(motion));
                    self.report("pose", number, ticks, &none, &Hash::NEW);
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
                self.report("place", number, ticks, &none, &Hash::NEW);
                let mut placed = Some(placed.ok_or("the model has too many draws")?);
                if self.way.clusters {
                    let ticks =
                        count::ticks_of(|| placed = placed.take().map(|placed| placed.cull_clusters(&mut *nodes)));
                    self.report("cull", number, ticks, &none, &Hash::NEW);
                }
                draw("draw", number, placed.as_ref());
            }
            Ok(())
        }
    }

    /// Counts all shows that stand in some words.
    fn count_all(mut words: &[u32], memory: &mut Memory) -> Result<(), &'static str> {
        let (mut bytes, mut number): (&[u8], _) = (&[], 0);
        while let Some((&[MAGIC, width, height, rows, zoom, length, frames, way], rest)) =
            words.split_first_chunk::<HEAD>()
        {
            let length = length as usize;
            let Some((container, rest)) = rest.split_at_checked(length.div_ceil(4)) else {
                return Err("the words end before the container");
            };
            if length > 0 {
                bytes = zstrip::bytemuck::cast_slice(container).get(..length).unwrap_or_default();
            }
            let panel = Panel { width, height, rows, zoom };
            Show { number, panel, bytes, frames, way: Way::of(way) }.run(memory)?;
            (words, number) = (rest, number + 1);
        }
        if number == 0 { Err("the words are not those of a show") } else { Ok(()) }
    }

    pub fn run() {
        /// Where QEMU puts the words: PSRAM of the MPS2 boards, RAM of `virt` behind that of `memory.x`.
        const WORDS_AT: usize = if cfg!(target_arch = "arm") { 0x2100_0000 } else { 0x8100_0000 };
        static mut MEMORY: Memory = Memory {
            color: [0; _],
            depth: [0; _],
            records: [0; _],
            pose: [0; _],
            places: [None; _],
            nodes: [BoundsNode::EMPTY; _],
        };

        let memory = &raw mut MEMORY;
        // SAFETY: `run` is called once; this is the only reference.
        let memory = unsafe { &mut *memory };
        // SAFETY: there is memory, and nothing else uses it.
        let words = unsafe { core::slice::from_raw_parts(WORDS_AT as *const u32, MOST_WORDS) };
        if !count::start() {
            return;
        }
        if let Err(error) = count_all(words, memory) {
            println!("error: {error}");
            semihosting::process::exit(1);
        }
    }
}

#[cfg(target_os = "none")]
use counting::run;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("container: this is firmware; zstrip-assets bench FILE builds and runs it");
    std::process::exit(2);
}
