//! A model of a user's own, to be counted: on a host it reads an OBJ file and writes the words that firmware draws it
//! from. `ci/bench MODEL.obj` runs both and prints the table.
//!
//! ```text
//! cargo run --release --example obj_bench -- MODEL.obj MODEL.bin
//! ```
//! On the host it prints, for each way to draw the model, `way vertices triangles drawn pixels hash`. As firmware it
//! finds the words in memory, where QEMU has loaded them, and prints `way rows ticks hash`: SysTick's ticks over a
//! frame in strips of some rows (instructions on RISC-V). So one image counts every model.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "firmware/count.rs"]
mod count;
#[cfg(target_os = "none")]
mod firmware;
#[path = "workloads/hash.rs"]
mod hash;
mod obj;
#[cfg(target_os = "none")]
#[path = "firmware/ticks.rs"]
mod ticks;

#[cfg(target_os = "none")]
mod counting {
    use super::count;
    use super::hash::Hash;
    use super::obj::{Buffers, HEIGHT, MOST, MOST_WORDS, Model, RECORDS, WAYS, WIDTH, Way};
    use core::hint::black_box;
    use semihosting::println;
    use zstrip::math::Scalar;

    /// Where QEMU puts the words: PSRAM of the MPS2 boards, RAM of `virt` behind that of `memory.x`.
    const WORDS_AT: usize = if cfg!(target_arch = "arm") { 0x2100_0000 } else { 0x8100_0000 };

    struct Memory {
        color: [u16; WIDTH * HEIGHT],
        depth: [u16; WIDTH * HEIGHT],
        records: [u32; RECORDS],
    }

    static mut MEMORY: Memory = Memory { color: [0; _], depth: [0; _], records: [0; _] };
    static mut UVS: [[Scalar; 2]; MOST] = [[Scalar::ZERO; 2]; _];

    fn lend(memory: &mut Memory, rows: usize) -> Buffers<'_> {
        let pixels = WIDTH * rows;
        let (color, depth) = (&mut memory.color[..pixels], &mut memory.depth[..pixels]);
        Buffers { color, depth, records: &mut memory.records }
    }

    fn report(model: &Model<'_>, memory: &mut Memory, (name, way): (&str, Way), rows: usize) {
        let ticks = count::ticks_of(|| {
            model.draw(way, lend(memory, rows), &mut |strip| {
                black_box(strip);
            })
        });
        let mut hash = Hash::NEW;
        model.draw(way, lend(memory, rows), &mut |strip| hash.add(strip));
        println!("{name} {rows} {ticks} {:08x}", hash.0);
    }

    pub fn run() {
        let (memory, uvs) = (&raw mut MEMORY, &raw mut UVS);
        // SAFETY: `run` is called once; these are the only references.
        let (memory, uvs) = unsafe { (&mut *memory, &mut *uvs) };
        // SAFETY: there is memory, and nothing else uses it.
        let words = unsafe { core::slice::from_raw_parts(WORDS_AT as *const u32, MOST_WORDS) };
        let Some(model) = Model::new(words, uvs) else {
            println!("there is no model");
            semihosting::process::exit(1);
        };
        if !count::start() {
            return;
        }
        for way in WAYS {
            for rows in [HEIGHT, 16] {
                if model.has(way.1) {
                    report(&model, memory, way, rows);
                }
            }
        }
    }
}

#[cfg(target_os = "none")]
use counting::run;

#[cfg(not(target_os = "none"))]
fn main() {
    if let Err(error) = counted() {
        eprintln!("{error}");
        std::process::exit(1);
    }
}

/// Writes the words, and prints the lines.
#[cfg(not(target_os = "none"))]
fn counted() -> Result<(), String> {
    use zstrip::embedded_graphics_core::pixelcolor::IntoStorage;
    let mut args = std::env::args_os().skip(1);
    let (Some(from), Some(to), None) = (args.next(), args.next(), args.next()) else {
        return Err("usage: obj_bench MODEL.obj MODEL.bin".to_owned());
    };
    let words = obj::read::read(from.as_ref())?;
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    std::fs::write(&to, bytes).map_err(|error| format!("{}: {error}", to.display()))?;

    let mut uvs = vec![[zstrip::math::Scalar::ZERO; 2]; obj::MOST];
    let model = obj::Model::new(&words, &mut uvs).ok_or("the words are wrong")?;
    let pixels = obj::WIDTH * obj::HEIGHT;
    let (mut color, mut depth, mut records) = (vec![0; pixels], vec![0; pixels], vec![0; obj::RECORDS]);
    for (name, way) in obj::WAYS {
        if !model.has(way) {
            continue;
        }
        let mut hash = hash::Hash::NEW;
        let buffers = obj::Buffers { color: &mut color, depth: &mut depth, records: &mut records };
        let stats = model.draw(way, buffers, &mut |strip| hash.add(strip));
        let covered = color.iter().filter(|pixel| **pixel != obj::BACKGROUND.into_storage()).count();
        println!("{name} {} {} {} {covered} {:08x}", stats.vertices, stats.triangles, stats.drawn, hash.0);
    }
    Ok(())
}
