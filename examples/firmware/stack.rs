//! Peak stack by painting, and static RAM by the linker's symbols.
//!
//! ```text
//!  __sdata         __sheap                         sp        _stack_start
//!     | .data .bss    | paint paint paint used used | callers |
//!     |<- static RAM->|                   |<- peak->|
//! ```
#![allow(dead_code)] // each example uses its part

use core::arch::asm;

const PAINT: u32 = 0x57AC_57AC;

unsafe extern "C" {
    static mut __sdata: u32;
    static mut __sheap: u32;
    static mut _stack_start: u32;
}

/// Runs `work` and returns the most stack it used, in bytes, with its callers left out; `None` if that was all there
/// is, so that it may have run into the statics.
#[inline(never)]
pub fn peak_of(work: impl FnOnce()) -> Option<usize> {
    let bottom = &raw mut __sheap;
    let top = pointer();
    let words = (top as usize - bottom as usize) / 4;
    // SAFETY: from the end of the statics to the stack pointer nothing is alive; a volatile store
    // through a pointer needs no stack of its own below `top`.
    for i in 0..words {
        unsafe { bottom.add(i).write_volatile(PAINT) };
    }
    on_its_own_frame(work);
    // SAFETY: as above.
    let unused = (0..words).take_while(|&i| unsafe { bottom.add(i).read_volatile() } == PAINT).count();
    (unused > 0).then_some((words - unused) * 4)
}

/// Inlined, the work would use the stack of `peak_of`, above the paint.
#[inline(never)]
fn on_its_own_frame(work: impl FnOnce()) {
    work();
}

/// Bytes in use above the point of the call: what the callers of a frame hold.
#[inline(never)]
pub fn held() -> usize {
    &raw const _stack_start as usize - pointer() as usize
}

/// Bytes of `.data`, `.bss` and `.uninit`.
pub fn static_ram() -> usize {
    &raw const __sheap as usize - &raw const __sdata as usize
}

#[inline(always)]
fn pointer() -> *mut u32 {
    let pointer: *mut u32;
    // SAFETY: reads a register.
    unsafe {
        #[cfg(target_arch = "arm")]
        asm!("mov {}, sp", out(reg) pointer, options(nomem, nostack, preserves_flags));
        #[cfg(target_arch = "riscv32")]
        asm!("mv {}, sp", out(reg) pointer, options(nomem, nostack, preserves_flags));
    }
    pointer
}
