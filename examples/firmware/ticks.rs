//! Time in ticks of SysTick, which QEMU's `-icount` drives by instructions; on RISC-V, in instructions.

#[cfg(target_arch = "arm")]
pub use systick::{now, start};

/// Instructions since the start, modulo 2^32.
#[cfg(target_arch = "riscv32")]
pub fn now() -> u32 {
    let count: u32;
    // SAFETY: reads a counter.
    unsafe { core::arch::asm!("csrr {}, minstret", out(reg) count) };
    count
}

#[cfg(target_arch = "arm")]
mod systick {
    use core::sync::atomic::{AtomicU32, Ordering};
    use cortex_m::peripheral::{SYST, syst::SystClkSource};
    use cortex_m_rt::exception;

    /// How often the timer, of 24 bits, has gone round; its handler runs once in 84 million instructions.
    static ROUNDS: AtomicU32 = AtomicU32::new(0);

    #[exception]
    fn SysTick() {
        ROUNDS.store(ROUNDS.load(Ordering::Relaxed) + 1, Ordering::Relaxed);
    }

    /// Starts the timer.
    pub fn start(timer: &mut SYST) {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(0x00FF_FFFF);
        timer.clear_current();
        timer.enable_interrupt();
        timer.enable_counter();
    }

    /// Ticks since the start, modulo 2^32, if the timer does not go round just now.
    pub fn now() -> u32 {
        (ROUNDS.load(Ordering::Relaxed) << 24) + (0x00FF_FFFF - SYST::get_current())
    }
}
