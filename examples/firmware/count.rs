//! Counts what a call takes, between two instructions that mark it for a counting plugin.

use super::ticks;
use core::arch::asm;
use core::hint::black_box;

/// The instructions that a counting plugin looks for. QEMU may not show the first two instructions after a timer was
/// read to plugins, so these do nothing.
#[cfg(target_arch = "arm")]
macro_rules! marker {
    (begin) => {
        "nop\nnop\nmov r10, r10"
    };
    (end) => {
        "mov r11, r11"
    };
}
#[cfg(target_arch = "riscv32")]
macro_rules! marker {
    ($which:ident) => {
        "nop"
    };
}

/// Starts the timer; `false` if somebody has it already.
pub fn start() -> bool {
    #[cfg(target_arch = "arm")]
    match cortex_m::Peripherals::take() {
        Some(mut peripherals) => ticks::start(&mut peripherals.SYST),
        None => return false,
    }
    true
}

/// Returns the ticks that a call takes.
#[inline(never)]
pub fn ticks_of<T>(call: impl FnOnce() -> T) -> u32 {
    let start = ticks::now();
    // SAFETY: copies a register to itself.
    unsafe { asm!(marker!(begin)) };
    let result = call();
    // SAFETY: as above.
    unsafe { asm!(marker!(end)) };
    let end = ticks::now();
    black_box(result);
    end.wrapping_sub(start)
}
