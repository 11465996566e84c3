//! Renders every scene and prints one line `name hash` each: on the host, as firmware on Arm and
//! RISC-V (through semihosting), and as Wasm (through an imported function).
//!
//! `ci/cores` compares the lines. With `--cfg 'small_ram="bare"'` or `--cfg 'small_ram="records"'` the frame fits a
//! chip of 16 KB: thin strips without records, or thinner ones with few, which must not change a byte. Its flash holds
//! the scenes of plain meshes.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod firmware;
mod scenes;

use scenes::formats::{self, FORMATS, FormatInfo, LEAVES, Memory, SMOOTH};
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
/// Rows of a strip, and words of records.
const SIZES: (usize, usize) = if cfg!(small_ram = "bare") {
    (8, 0)
} else if cfg!(small_ram = "records") {
    (2, 2048)
} else {
    (16, 16 * 1024)
};

/// Those that there is room for.
const OTHERS: [&[FormatInfo]; 3] =
    if cfg!(any(small_ram = "bare", small_ram = "records")) { [&[]; 3] } else { [FORMATS, SMOOTH, LEAVES] };

struct Buffers {
    color: [u16; WIDTH * SIZES.0],
    depth: [u16; WIDTH * SIZES.0],
    records: [u32; SIZES.1],
}

static mut BUFFERS: Buffers = Buffers { color: [0; _], depth: [0; _], records: [0; _] };

fn run() {
    let buffers = &raw mut BUFFERS;
    // SAFETY: `run` is called once; this is the only reference.
    let Buffers { color, depth, records } = unsafe { &mut *buffers };
    #[cfg(target_os = "none")]
    let mut peak = 0;
    let scenes = scenes::SCENES.iter().enumerate().map(|(index, scene)| (scene.name, index, None));
    let others = OTHERS.into_iter().flatten().map(|other| (other.name, 0, Some(other)));
    for (name, index, other) in scenes.chain(others) {
        let mut hash = 0;
        let mut frame = || {
            hash = match other {
                Some(other) => formats::hash(other, Memory { color, depth, records }),
                None => scenes::render(index, color, depth, records).hash,
            }
        };
        #[cfg(target_os = "none")]
        {
            peak = peak.max(firmware::stack::peak_of(&mut frame).expect("the stack is too small"));
        }
        #[cfg(not(target_os = "none"))]
        frame();
        println!("{name} {hash:016x}");
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
