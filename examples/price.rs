//! Workloads of the benchmark drawn by shaders of a user's own, and in other states than the default: firmware that
//! counts. `ci/bench --price` runs it and prints the prices; `tests/price.rs` compares the pictures.
//!
//! It prints, for each run, `workload way ticks drawn hash`: SysTick's ticks over a frame in one strip (instructions on
//! RISC-V), triangles drawn, and a hash of the picture. The first way of each workload is the benchmark's. Two empty
//! workloads tell what it costs to clear colours and depths.
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
    use super::workloads::price::{self, By, PRICED, Priced, Under, WAYS};
    use super::workloads::{Buffers, HEIGHT, WIDTH};
    use core::hint::black_box;
    use semihosting::println;

    struct Memory {
        color: [u16; WIDTH * HEIGHT],
        depth: [u16; WIDTH * HEIGHT],
        records: [u32; 256 * 1024],
    }

    static mut MEMORY: Memory = Memory { color: [0; _], depth: [0; _], records: [0; _] };

    fn report(memory: &mut Memory, workload: (&str, Priced), way: (&str, By, Under)) {
        let ((name, workload), (way, by, under)) = (workload, way);
        let mut draw = |sink: &mut dyn FnMut(&[u16])| {
            let pixels = workload.width() * HEIGHT;
            let (color, depth) = (&mut memory.color[..pixels], &mut memory.depth[..pixels]);
            let buffers = Buffers { color, depth, records: &mut memory.records };
            price::draw(workload, by, under, buffers, sink)
        };
        let ticks = count::ticks_of(|| {
            draw(&mut |strip| {
                black_box(strip);
            })
        });
        let mut hash = Hash::NEW;
        let drawn = draw(&mut |strip| hash.add(strip)).drawn;
        println!("{name} {way} {ticks} {drawn} {:08x}", hash.0);
    }

    pub fn run() {
        let memory = &raw mut MEMORY;
        // SAFETY: `run` is called once; this is the only reference.
        let memory = unsafe { &mut *memory };
        if !count::start() {
            return;
        }
        let [usual, ..] = WAYS;
        report(memory, ("empty", Priced::Empty), usual);
        report(memory, ("empty_spot", Priced::EmptySpot), usual);
        for workload in PRICED {
            for way in WAYS {
                report(memory, workload, way);
            }
        }
    }
}

#[cfg(target_os = "none")]
use counting::run;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this example is firmware: ci/bench --price builds it");
}
