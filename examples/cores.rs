//! Renders every scene and prints one line `name hash` each: on the host, as firmware on Arm and
//! RISC-V (through semihosting), and as Wasm (through an imported function).
//!
//! `ci/cores` compares the lines. With `--cfg small_ram` the frame fits a chip of 16 KB: thin
//! strips and no records, which must not change a byte.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod firmware;
mod scenes;

#[cfg(target_os = "none")]
use semihosting::println;

/// Wasm has no output of its own: `ci/wasm.mjs` lends it one.
#[cfg(target_family = "wasm")]
macro_rules! println {
    ($($arg:tt)*) => {{
        #[link(wasm_import_module = "host")]
        unsafe extern "C" {
            fn print(text: *const u8, length: usize);
        }
        let line = format!($($arg)*);
        // SAFETY: the host only reads, and only during the call.
        unsafe { print(line.as_ptr(), line.len()) }
    }};
}

const WIDTH: usize = 320;
const ROWS: usize = if cfg!(small_ram) { 4 } else { 16 };
const RECORDS: usize = if cfg!(small_ram) { 0 } else { 16 * 1024 };

struct Buffers {
    color: [u16; WIDTH * ROWS],
    depth: [u16; WIDTH * ROWS],
    records: [u32; RECORDS],
}

static mut BUFFERS: Buffers = Buffers { color: [0; _], depth: [0; _], records: [0; _] };

fn run() {
    let buffers = &raw mut BUFFERS;
    // SAFETY: `run` is called once; this is the only reference.
    let Buffers { color, depth, records } = unsafe { &mut *buffers };
    #[cfg(target_os = "none")]
    let mut peak = 0;
    for (index, scene) in scenes::SCENES.iter().enumerate() {
        let mut hash = 0;
        let mut frame = || hash = scenes::render(index, color, depth, records).hash;
        #[cfg(target_os = "none")]
        {
            peak = peak.max(firmware::stack::peak_of(&mut frame));
        }
        #[cfg(not(target_os = "none"))]
        frame();
        println!("{} {hash:016x}", scene.name);
    }
    #[cfg(target_os = "none")]
    println!(
        "# peak stack of a frame {peak} bytes (its callers {}), static RAM {} bytes",
        firmware::stack::held(),
        firmware::stack::static_ram(),
    );
}

#[cfg(not(target_os = "none"))]
fn main() {
    run();
}
