//! What several samples per pixel, and supersampling, cost: firmware that counts. `ci/samples` runs it and prints what
//! it takes.
//!
//! It prints, for each run, `workload how/rows ticks drawn hash`. How is the number of samples, or `2x2` for
//! supersampling; rows are those of a strip; ticks are SysTick's over a frame (instructions on RISC-V). Triangles drawn
//! and a hash of the picture follow.
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
mod workloads;

#[cfg(target_os = "none")]
mod counting {
    use super::count;
    use super::hash::Hash;
    use super::workloads::price::{Priced, supersampled, with_samples};
    use super::workloads::{HEIGHT, WIDTH};
    use core::hint::black_box;
    use semihosting::println;
    use zstrip::target::{DepthChoice, Stats, WithSamples};

    /// Most samples that are counted.
    const MOST: usize = 4;
    const WORKLOADS: [(&str, Priced); 6] = [
        ("empty", Priced::Empty),
        ("empty_spot", Priced::EmptySpot),
        ("w4", Priced::W4),
        ("w5", Priced::W5),
        ("w9", Priced::W9),
        ("w10", Priced::W10),
    ];

    struct Memory {
        color: [u16; MOST * WIDTH * HEIGHT],
        samples: [u16; (MOST - 1) * WIDTH * HEIGHT],
        depth: [u16; MOST * WIDTH * HEIGHT],
        records: [u32; 256 * 1024],
    }

    static mut MEMORY: Memory = Memory { color: [0; _], samples: [0; _], depth: [0; _], records: [0; _] };

    fn report<const N: usize>(memory: &mut Memory, workload: (&str, Priced), rows: usize)
    where
        WithSamples<N>: DepthChoice,
    {
        let how = ["", "1", "2", "", "4"][N];
        count(memory, workload, (how, rows), |workload, memory, sink| {
            let pixels = workload.width() * rows;
            let Memory { color, samples, depth, records } = memory;
            let (samples, depth) = (&mut samples[..(N - 1) * pixels], &mut depth[..N * pixels]);
            with_samples::<N>(workload, (&mut color[..pixels], samples, depth, records), sink)
        });
    }

    fn report_supersampled(memory: &mut Memory, workload: (&str, Priced), rows: usize) {
        count(memory, workload, ("2x2", rows), |workload, memory, sink| {
            let pixels = 4 * workload.width() * rows;
            let Memory { color, depth, records, .. } = memory;
            supersampled(workload, (&mut color[..pixels], &mut depth[..pixels], records), sink)
        });
    }

    fn count(
        memory: &mut Memory,
        (name, workload): (&str, Priced),
        (how, rows): (&str, usize),
        draw: impl Fn(Priced, &mut Memory, &mut dyn FnMut(&[u16])) -> Stats,
    ) {
        let mut draw = |sink: &mut dyn FnMut(&[u16])| draw(workload, memory, sink);
        let ticks = count::ticks_of(|| {
            draw(&mut |strip| {
                black_box(strip);
            })
        });
        let mut hash = Hash::NEW;
        let drawn = draw(&mut |strip| hash.add(strip)).drawn;
        println!("{name} {how}/{rows} {ticks} {drawn} {:08x}", hash.0);
    }

    pub fn run() {
        let memory = &raw mut MEMORY;
        // SAFETY: `run` is called once; this is the only reference.
        let memory = unsafe { &mut *memory };
        if !count::start() {
            return;
        }
        for workload in WORKLOADS {
            for rows in [HEIGHT, 4] {
                report::<1>(memory, workload, rows);
                report::<2>(memory, workload, rows);
                report::<4>(memory, workload, rows);
                report_supersampled(memory, workload, rows);
            }
        }
    }
}

#[cfg(target_os = "none")]
use counting::run;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this example is firmware: ci/samples builds it");
}
