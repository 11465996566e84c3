//! What the firmware examples share: an entry point that calls the example's `run`, a panic handler
//! that makes the run fail, and the stack meter.

pub mod stack;

#[cfg(target_arch = "arm")]
use cortex_m as _; // the critical-section implementation
#[cfg(target_arch = "arm")]
use cortex_m_rt::entry;
#[cfg(target_arch = "riscv32")]
use riscv_rt::entry;

#[entry]
fn start() -> ! {
    super::run();
    semihosting::process::exit(0)
}

#[panic_handler]
fn panicked(info: &core::panic::PanicInfo) -> ! {
    semihosting::println!("{info}");
    semihosting::process::exit(101)
}
