//! Firmware whose only user code is frames, for `ci/proofs` to look into. Built seven times:
//! `--cfg 'proof="empty"'` draws nothing, the baseline; `proof="w4"` draws the flat torus of the
//! benchmark without records, `proof="w1-w6"` all six workloads; `proof="all"` draws every scene but one,
//! `proof="shapes"` that one, with smooth shapes, `proof="formats"` those in other pixel formats, and
//! `proof="smooth"` those with several samples per pixel.
//!
//! It prints the peak stack of a frame, the largest of all, as eight hexadecimal digits, one by one: formatting would
//! link the panics that the image must not contain.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "firmware/stack.rs"]
mod stack;

#[cfg(target_os = "none")]
#[cfg_attr(proof = "empty", allow(dead_code))]
mod scenes;
#[cfg(target_os = "none")]
mod workloads;

#[cfg(target_os = "none")]
mod image {
    use super::{scenes, stack, workloads};
    use core::hint::black_box;
    #[cfg(target_arch = "arm")]
    use cortex_m_rt::entry;
    #[cfg(target_arch = "riscv32")]
    use riscv_rt::entry;
    use semihosting::sys::arm_compat::sys_writec;
    use zstrip::target::Stats;

    const WIDTH: usize = 320;
    const HEIGHT: usize = 240;
    const ROWS: usize = 8;
    const RECORDS: usize = if cfg!(proof = "w4") { 0 } else { 4 * 1024 };

    struct Memory {
        color: [u16; WIDTH * ROWS],
        depth: [u16; WIDTH * ROWS],
        records: [u32; RECORDS],
    }

    static mut MEMORY: Memory = Memory { color: [0; _], depth: [0; _], records: [0; _] };

    #[entry]
    fn start() -> ! {
        let memory = &raw mut MEMORY;
        // SAFETY: `start` runs once; this is the only reference.
        let memory = unsafe { &mut *memory };
        let mut peak = 0;
        for index in 0..FRAMES {
            peak = peak.max(stack::peak_of(|| frame(black_box(&mut *memory), index)).unwrap_or(usize::MAX));
        }
        for i in (0..8).rev() {
            let digit = (peak >> (4 * i) & 15) as u8;
            sys_writec(if digit < 10 { b'0' + digit } else { b'a' - 10 + digit });
        }
        sys_writec(b'\n');
        semihosting::process::exit(0)
    }

    /// How many frames there are to draw.
    const FRAMES: usize = if cfg!(proof = "w1-w6") {
        6
    } else if cfg!(any(proof = "all", proof = "shapes")) {
        scenes::SCENES.len()
    } else if cfg!(proof = "formats") {
        scenes::formats::FORMATS.len()
    } else if cfg!(proof = "smooth") {
        scenes::formats::SMOOTH.len()
    } else if cfg!(proof = "leaves") {
        scenes::formats::LEAVES.len()
    } else {
        1
    };

    #[inline(never)]
    fn frame(memory: &mut Memory, index: usize) {
        let Memory { color, depth, records } = memory;
        if cfg!(proof = "w4") {
            // Directly, not through the table of scenes, so that no scene is linked.
            workloads::flat_torus_without_records(color, depth, send);
        } else if cfg!(proof = "w1-w6") {
            type Draw = fn(workloads::Buffers<'_>, fn(&[u16])) -> Stats;
            use workloads::{flat_torus, gouraud_quad, gouraud_torus, quad, textured_quad, tiny};
            let all: [Draw; 6] = [quad, gouraud_quad, textured_quad, flat_torus, gouraud_torus, tiny];
            if let Some(draw) = all.get(index) {
                draw(workloads::Buffers { color, depth, records }, send);
            }
        } else if cfg!(any(proof = "smooth", proof = "leaves")) {
            use scenes::formats::{LEAVES, SMOOTH};
            let memory = scenes::formats::Memory { color, depth, records };
            let all = if cfg!(proof = "leaves") { LEAVES } else { SMOOTH };
            if let Some(scene) = all.get(index) {
                (scene.draw)(memory, &mut |bytes| {
                    black_box(bytes);
                });
            }
        } else if cfg!(proof = "formats") {
            let memory = scenes::formats::Memory { color, depth, records };
            if let Some(format) = scenes::formats::FORMATS.get(index) {
                (format.draw)(memory, &mut |bytes| {
                    black_box(bytes);
                });
            }
        } else if cfg!(any(proof = "all", proof = "shapes")) {
            scenes::draw(index, 0, [WIDTH, HEIGHT], color, depth, records, |_, strip| {
                black_box(strip);
            });
        }
    }

    fn send(strip: &[u16]) {
        black_box(strip);
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo) -> ! {
        panic_is_reachable()
    }

    /// In the image exactly when something can panic: every panic ends here.
    #[inline(never)]
    #[unsafe(no_mangle)]
    extern "C" fn panic_is_reachable() -> ! {
        loop {
            core::hint::spin_loop();
        }
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this example is firmware: ci/proofs builds it");
}
