//! Measures what drawing costs: firmware that counts frames, and a host's program that fits costs to the counts.
//! `ci/costs` runs both.
//!
//! There are two kinds of firmware, as code that several materials share is not inlined: with `--cfg 'costs="pixels"'`
//! it draws pixels, otherwise grids. It prints, for each frame, `name run ticks`: SysTick's ticks (instructions on
//! RISC-V), between two instructions that mark the frame for a counting plugin.
//!
//! | name | run | |
//! |---|---|---|
//! | format`/`material | grid`/`rows of a strip | a grid of triangles, see `costs/grids.rs` |
//! | format`/clear` | rows | an empty frame |
//! | `w4` and so on, `empty`, `empty_spot` | rows | workloads of the benchmark |
//! | `pixel` | number | a material on the whole screen, see `costs/pixels.rs` |
//! | `format/`name, `packer/`name | `pixels` | see `costs/formats.rs` |
//!
//! On a host it takes files of these lines, with instructions and cycles in place of ticks:
//!
//! ```text
//! cargo run --release --example costs -- FOLDER m0+ m4 rv32imc
//! ```
//! reads `FOLDER/m0+.counts` and so on, and writes `costs.csv` and tables into the folder.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
#[path = "costs/calls.rs"]
mod calls;
#[cfg(target_os = "none")]
#[path = "firmware/count.rs"]
mod count;
#[cfg(target_os = "none")]
mod firmware;
#[cfg(not(target_os = "none"))]
#[path = "costs/fit.rs"]
mod fit;
#[path = "costs/formats.rs"]
mod formats;
#[path = "costs/grids.rs"]
mod grids;
#[cfg(not(target_os = "none"))]
#[path = "costs/least_squares.rs"]
mod least_squares;
#[cfg_attr(not(target_os = "none"), allow(dead_code))] // it draws as firmware
#[path = "costs/materials.rs"]
mod materials;
#[cfg_attr(not(target_os = "none"), allow(dead_code))]
#[path = "costs/pixels.rs"]
mod pixels;
#[cfg(target_os = "none")]
#[path = "firmware/ticks.rs"]
mod ticks;
#[cfg(not(target_os = "none"))]
#[path = "costs/work.rs"]
mod work;
mod workloads;

use materials::Kind;
use workloads::price::Priced;

/// Workloads of the benchmark, and the materials whose costs foretell theirs.
const WORKLOADS: [(&str, Priced, Option<Kind>); 6] = [
    ("empty", Priced::Empty, None),
    ("empty_spot", Priced::EmptySpot, None),
    ("w4", Priced::W4, Some(Kind::Flat)),
    ("w5", Priced::W5, Some(Kind::Gouraud)),
    ("w9", Priced::W9, Some(Kind::LitTextured)),
    ("w10", Priced::W10, Some(Kind::Flat)),
];

#[cfg(target_os = "none")]
mod counting {
    use super::grids::{self, GRIDS, HEIGHT, Memory, Parts, ROWS, WIDTH};
    use super::materials::KINDS;
    use super::workloads::Buffers;
    use super::workloads::price::{self, By, Under};
    use super::{WORKLOADS, count, formats, pixels};
    use core::hint::black_box;
    use semihosting::println;
    use zstrip::bytemuck;
    use zstrip::color::{Dithered, PixelFormat, Rgb565Be};
    use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888};

    const PIXELS: usize = WIDTH * HEIGHT;

    pub struct Static {
        pub color: [u32; PIXELS],
        pub depth: [u16; PIXELS],
        pub records: [u32; 96 * 1024],
        pub packed: [u8; PIXELS / 2],
    }

    static mut BUFFERS: Static = Static { color: [0; _], depth: [0; _], records: [0; _], packed: [0; _] };
    static mut PARTS: Parts = Parts::NEW;

    /// Memory of a frame in strips of some rows.
    pub fn lend<P: PixelFormat>(buffers: &mut Static, rows: usize) -> Memory<'_, P> {
        let pixels = WIDTH * rows;
        let color: &mut [u8] = bytemuck::cast_slice_mut(&mut buffers.color);
        Memory {
            color: bytemuck::cast_slice_mut(&mut color[..pixels * size_of::<P::Raw>()]),
            depth: &mut buffers.depth[..pixels],
            records: &mut buffers.records,
        }
    }

    /// Counts the grids of all materials in a format, in strips of these heights.
    fn fit<P: PixelFormat>(name: &str, heights: &[usize], buffers: &mut Static, parts: &mut Parts) {
        for rows in ROWS {
            let ticks = count::ticks_of(|| {
                let empty = grids::frame::<P>(lend(buffers, rows), &mut |strip| _ = black_box(strip), &mut |_| {});
                black_box(empty)
            });
            println!("{name}/clear {rows} {ticks}");
        }
        for number in 0..GRIDS {
            let grid = grids::grid(number);
            let places = &grids::places(grid.draws())[..grid.draws()];
            let mesh = parts.build(&grid).expect("a mesh");
            for (material, kind) in KINDS {
                for &rows in heights {
                    let ticks = count::ticks_of(|| {
                        kind.draw::<P>(lend(buffers, rows), &mut |strip| _ = black_box(strip), &mesh, places)
                    });
                    println!("{name}/{material} {number}/{rows} {ticks}");
                }
            }
        }
    }

    pub fn run() {
        let (buffers, parts) = (&raw mut BUFFERS, &raw mut PARTS);
        // SAFETY: `run` is called once; these are the only references.
        let (buffers, parts) = unsafe { (&mut *buffers, &mut *parts) };
        if !count::start() {
            return;
        }
        if cfg!(costs = "pixels") {
            for (number, (_, draw)) in pixels::ROWS.iter().enumerate() {
                let ticks = count::ticks_of(|| {
                    grids::frame::<Rgb565>(lend(buffers, HEIGHT), &mut |strip| _ = black_box(strip), &mut |s| draw(s))
                });
                println!("pixel {number} {ticks}");
            }
            return formats::count(buffers);
        }
        fit::<Rgb565>("Rgb565", &ROWS, buffers, parts);
        fit::<Rgb565Be>("Rgb565Be", &ROWS[..1], buffers, parts);
        fit::<Rgb888>("Rgb888", &ROWS[..1], buffers, parts);
        fit::<Gray8>("Gray8", &ROWS[..1], buffers, parts);
        fit::<Dithered<Rgb565>>("Dithered<Rgb565>", &ROWS[..1], buffers, parts);
        for (name, workload, _) in WORKLOADS {
            for rows in ROWS {
                let Memory { color, depth, records } = lend::<Rgb565>(buffers, rows);
                let pixels = workload.width() * rows;
                let frame = Buffers { color: &mut color[..pixels], depth: &mut depth[..pixels], records };
                let ticks = count::ticks_of(|| {
                    price::draw(workload, By::Usual, Under::Usual, frame, &mut |strip| _ = black_box(strip))
                });
                println!("{name} {rows} {ticks}");
            }
        }
    }
}

#[cfg(target_os = "none")]
use counting::run;

#[cfg(not(target_os = "none"))]
fn main() {
    let mut args = std::env::args().skip(1);
    let Some(folder) = args.next() else {
        eprintln!("usage: costs FOLDER CORE..., as ci/costs calls it");
        std::process::exit(2);
    };
    if let Err(error) = fit::report(folder.as_ref(), &args.collect::<Vec<_>>()) {
        eprintln!("{error}");
        std::process::exit(1);
    }
}
