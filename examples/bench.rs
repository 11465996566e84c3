//! The benchmark's workloads: as firmware they are counted, on the host their pictures are checked. `ci/bench` runs
//! both and prints the table.
//!
//! As firmware it prints, for each run, `name rows ticks hash`: SysTick's ticks over a frame (instructions on RISC-V),
//! between two instructions that mark it for a counting plugin, and a hash of the picture. A frame clears colours and
//! depths; runs of an empty scene tell what that costs. With `--cfg 'ram="records"'` or `--cfg 'ram="bare"'` it draws
//! the Gouraud torus with the buffers such a firmware would have, and prints the RAM that takes. With `--cfg carries`,
//! renderers carry the state of triangles on from strip to strip.
//!
//! On the host it prints `name covered hash` and compares each picture with a reference in double precision.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "firmware/count.rs"]
mod count;
#[cfg(target_os = "none")]
mod firmware;
#[path = "workloads/hash.rs"]
mod hash;
#[cfg(target_os = "none")]
#[path = "firmware/ticks.rs"]
mod ticks;
mod workloads;

use hash::Hash;
use workloads::{HEIGHT, WIDTH, Workload};
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::frame::RamBudget;

const NAMED: [(&str, Workload); 13] = [
    ("empty", Workload::Empty),
    ("w1", Workload::Quad),
    ("w2", Workload::GouraudQuad),
    ("w3", Workload::TexturedQuad),
    ("flat", Workload::FlatQuad),
    ("own_flat", Workload::OwnFlatQuad),
    ("own_gouraud", Workload::OwnGouraudQuad),
    ("w4", Workload::FlatTorus),
    ("w5", Workload::GouraudTorus),
    ("w6", Workload::Tiny),
    ("empty_spot", Workload::EmptySpot),
    ("w9", Workload::TexturedSpot),
    ("w10", Workload::FlatSpot),
];

/// Rows of a strip, and words of records.
const SIZES: (usize, usize) = if cfg!(ram = "records") {
    let budget = RamBudget::new::<Rgb565>(WIDTH as u32, 16);
    (16, budget.with_records(1, HEIGHT as u32, 512, 1, FRONT_FACES).records / 4)
} else if cfg!(ram = "bare") {
    (8, 0)
} else {
    (HEIGHT, 256 * 1024)
};

/// Triangles of the torus that are drawn.
const FRONT_FACES: usize = 458;

#[cfg(target_os = "none")]
mod counting {
    use super::firmware::stack;
    use super::{Hash, NAMED, SIZES, WIDTH, Workload, count, workloads};
    use core::hint::black_box;
    use semihosting::println;

    struct Memory {
        color: [u16; WIDTH * SIZES.0],
        depth: [u16; WIDTH * SIZES.0],
        records: [u32; SIZES.1],
    }

    static mut MEMORY: Memory = Memory { color: [0; _], depth: [0; _], records: [0; _] };

    /// Buffers for strips of some rows.
    fn lend(memory: &mut Memory, width: usize, rows: usize) -> workloads::Buffers<'_> {
        let pixels = width * rows.min(SIZES.0);
        workloads::Buffers {
            color: &mut memory.color[..pixels],
            depth: &mut memory.depth[..pixels],
            records: &mut memory.records,
        }
    }

    pub fn run() {
        let memory = &raw mut MEMORY;
        // SAFETY: `run` is called once; this is the only reference.
        let memory = unsafe { &mut *memory };
        if cfg!(any(ram = "records", ram = "bare")) {
            return report_ram(memory);
        }
        if !count::start() {
            return;
        }
        for rows in [240, 16, 4, 1] {
            // State is carried on from one strip to the next.
            if cfg!(carries) && rows == 240 {
                continue;
            }
            for (name, workload) in NAMED {
                let counted = match workload {
                    Workload::Empty | Workload::FlatTorus => true,
                    Workload::GouraudTorus | Workload::EmptySpot | Workload::TexturedSpot | Workload::FlatSpot => {
                        rows >= 16
                    }
                    _ => rows == 240,
                };
                if counted {
                    let width = workload.width();
                    let ticks = count::ticks_of(|| {
                        workloads::draw(workload, lend(memory, width, rows), |strip| {
                            black_box(strip);
                        })
                    });
                    let mut hash = Hash::NEW;
                    workloads::draw(workload, lend(memory, width, rows), |strip| hash.add(strip));
                    println!("{name} {rows} {ticks} {:08x}", hash.0);
                }
            }
        }
    }

    fn report_ram(memory: &mut Memory) {
        let mut draw = || {
            workloads::draw(Workload::GouraudTorus, lend(memory, WIDTH, SIZES.0), |strip| {
                black_box(strip);
            });
        };
        let peak = stack::peak_of(&mut draw).expect("the stack is too small") + stack::held();
        let statics = stack::static_ram();
        let strip = 4 * WIDTH * SIZES.0;
        let records = 4 * SIZES.1;
        println!("rows {}", SIZES.0);
        println!("strip {strip}");
        println!("records {records}");
        println!("stack {peak}");
        println!("statics {}", statics - strip - records);
        println!("total {}", statics + peak);
    }
}

#[cfg(target_os = "none")]
use counting::run;

/// What a picture may differ by from the reference: pixels that only one of them covers, pixels that show another
/// surface, and 8-bit steps of a channel before it is cut to RGB565.
#[cfg(not(target_os = "none"))]
struct Tolerance {
    coverage: usize,
    surface: usize,
    channel: f64,
}

#[cfg(not(target_os = "none"))]
impl Tolerance {
    /// Positions are rounded to 16 bits and to 1/256 px, depth to 16 bits, and colours run linearly on the screen where
    /// the reference's are perspective-correct.
    const fn of(workload: Workload) -> Self {
        let (coverage, surface, channel) = match workload {
            Workload::Empty | Workload::EmptySpot => (0, 0, 0.0),
            Workload::Quad | Workload::FlatQuad | Workload::OwnFlatQuad => (0, 0, 0.0),
            Workload::GouraudQuad => (0, 0, 1.0),
            Workload::OwnGouraudQuad => (0, 0, 2.0),
            // Texels' borders are within a fraction of a pixel of where they are, one division every 16 pixels.
            Workload::TexturedQuad => (20, 40, 0.0),
            Workload::FlatTorus | Workload::GouraudTorus => (20, 20, 1.5),
            Workload::Tiny => (400, 20, 0.1),
            // Half of the pixels are next to a border of a triangle.
            Workload::TexturedSpot => (20, 40, 2.0),
            Workload::FlatSpot => (20, 40, 2.0),
        };
        Self { coverage, surface, channel }
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    let mut wrong = false;
    for (name, workload) in NAMED {
        let pixels = workload.width() * HEIGHT;
        let (mut color, mut depth) = (vec![0; pixels], vec![0; pixels]);
        let mut records = vec![0; SIZES.1];
        let buffers = workloads::Buffers { color: &mut color, depth: &mut depth, records: &mut records };
        let mut hash = Hash::NEW;
        let stats = workloads::draw(workload, buffers, |strip| hash.add(strip));
        let picture = workloads::reference::draw(workload);
        let background = zstrip::embedded_graphics_core::pixelcolor::IntoStorage::into_storage(workloads::BACKGROUND);

        let (mut covered, mut coverage, mut surface, mut channel) = (0, 0, 0, 0.0_f64);
        for (drawn, expected) in color.iter().zip(&picture.colors) {
            covered += usize::from(*drawn != background);
            match expected {
                Some(expected) if *drawn != background => {
                    let off = distance(*drawn, *expected);
                    // Rounding leaves a surface nearer than that: it is a neighbour's.
                    if off > 2.0 {
                        surface += 1;
                    } else {
                        channel = channel.max(off);
                    }
                }
                None if *drawn == background => {}
                _ => coverage += 1,
            }
        }
        let allowed = Tolerance::of(workload);
        let ok = coverage <= allowed.coverage && surface <= allowed.surface && channel <= allowed.channel;
        wrong |= !ok;
        println!("{name} {covered} {:08x}", hash.0);
        eprintln!(
            "{name}: {} triangles drawn, {covered} px covered; against the reference: coverage of {coverage} px and \
             surface of {surface} px differ, colours by {channel:.2}/255 beyond RGB565{}",
            stats.drawn,
            if ok { "" } else { ": TOO MUCH" }
        );
    }
    if wrong {
        std::process::exit(1);
    }
}

/// How far the colour is, in 8-bit steps, from the range of colours that are cut to this pixel.
#[cfg(not(target_os = "none"))]
fn distance(pixel: u16, color: [f64; 3]) -> f64 {
    let channels = [(pixel >> 11 << 3, 8.0), ((pixel >> 5 & 63) << 2, 4.0), ((pixel & 31) << 3, 8.0)];
    channels.iter().zip(color).fold(0.0, |worst, (&(low, step), value)| {
        let low = f64::from(low);
        worst.max(low - value).max(value - (low + step))
    })
}
