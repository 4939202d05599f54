//! Start and end of a program, and the proof that it cannot panic.

use core::panic::PanicInfo;
use semihosting::process;

#[cfg(target_arch = "arm")]
pub use cortex_m_rt::entry;
#[cfg(target_arch = "riscv32")]
pub use riscv_rt::entry;

/// Ends the emulation: with status 0 when all went well, else 1.
pub fn end(well: bool) -> ! {
    process::exit(if well { 0 } else { 1 })
}

/// A fault of the processor, a stack overflow for one, ends the emulation too: with status 2.
#[cfg(target_arch = "arm")]
#[allow(unsafe_code)]
// SAFETY: it touches no state of the program, which may be in any.
#[cortex_m_rt::exception]
unsafe fn HardFault(_frame: &cortex_m_rt::ExceptionFrame) -> ! {
    process::exit(2)
}

/// The same on RISC-V, for every exception.
#[cfg(target_arch = "riscv32")]
#[allow(unsafe_code)]
// SAFETY: the start-up code calls what has this name, and this does not return to it.
#[unsafe(export_name = "ExceptionHandler")]
extern "C" fn exception() -> ! {
    process::exit(2)
}

/// There is no panic: this handler calls a function that does not exist, so that a program with one panic left in it
/// does not link, and the linker's error says who panics.
#[panic_handler]
#[allow(unsafe_code)]
fn panic(_info: &PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn this_firmware_can_panic() -> !;
    }
    // SAFETY: it is never called, because what calls it does not link.
    unsafe { this_firmware_can_panic() }
}
