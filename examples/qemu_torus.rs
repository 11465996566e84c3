//! One frame of the torus on an emulated Cortex-M3, its hash and statistics through semihosting:
//!
//! ```text
//! cargo run --release --example qemu_torus --target thumbv7m-none-eabi
//! ```
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod firmware;
#[cfg(target_os = "none")]
mod scenes;

#[cfg(target_os = "none")]
fn run() {
    use semihosting::println;

    struct Buffers {
        color: [u16; 320 * 16],
        depth: [u16; 320 * 16],
        records: [u32; 8 * 1024],
    }
    static mut BUFFERS: Buffers = Buffers { color: [0; _], depth: [0; _], records: [0; _] };
    let buffers = &raw mut BUFFERS;
    // SAFETY: `run` is called once; this is the only reference.
    let Buffers { color, depth, records } = unsafe { &mut *buffers };

    let mut report = None;
    let peak = firmware::stack::peak_of(|| report = Some(scenes::render(0, color, depth, records)));
    let peak = peak.expect("the stack is too small");
    let Some(report) = report else { return };
    println!("{}: hash {:016x}", scenes::SCENES[0].name, report.hash);
    println!("{:#?}", report.stats);
    println!("peak stack {peak} bytes, static RAM {} bytes", firmware::stack::static_ram());
}

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this example is firmware: add --target thumbv7m-none-eabi");
}
