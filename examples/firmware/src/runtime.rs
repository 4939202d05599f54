//! Start and end of a program, and the proof that it cannot panic.

use crate::console::Console;
use crate::{log, stack};
use core::panic::PanicInfo;
use semihosting::process;
use static_cell::ConstStaticCell;

#[cfg(target_arch = "arm")]
pub use cortex_m_rt::entry;
#[cfg(target_arch = "riscv32")]
pub use riscv_rt::entry;

/// A program from start to end: paints the stack, does the work in the memory that stands in a static, and
/// says in the log and on the console why it failed, if it did.
// Inlined: a call of its own would be on the stack that is measured.
#[inline(always)]
pub fn run<M, F: defmt::Format>(
    memory: &'static ConstStaticCell<M>,
    work: impl FnOnce(&'static mut M) -> Result<(), F>,
) -> ! {
    stack::paint();
    log::start();
    // Only the first call gets it; there is no second one.
    let Some(memory) = memory.try_take() else { end(false) };
    let done = work(memory);
    if let Err(failure) = &done {
        defmt::error!("{}", failure);
        Console::open().text("error: log.defmt says why\n");
    }
    end(done.is_ok())
}

/// What the start-up code calls first, with no memory yet.
#[cfg(target_arch = "riscv32")]
#[allow(unsafe_code)]
mod before_main {
    // Lets instructions on vectors run, which a hart that has some does not until `mstatus` says so.
    // SAFETY: it changes no other bit, and no register that is kept.
    core::arch::global_asm!(
        ".section .init.pre_init, \"ax\"",
        ".global __pre_init",
        "__pre_init:",
        "li t0, {both_bits}",
        "csrs mstatus, t0",
        "ret",
        both_bits = const 3 << 9,
    );
}

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

/// There is no panic: this handler calls a function that does not exist, so that a program with one panic
/// left in it does not link, and the linker's error says who panics.
#[panic_handler]
#[allow(unsafe_code)]
fn panic(_info: &PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn this_firmware_can_panic() -> !;
    }
    // SAFETY: it is never called, because what calls it does not link.
    unsafe { this_firmware_can_panic() }
}

/// What defmt's own macros for panics would call: nobody uses them, and without this they would panic.
#[defmt::panic_handler]
fn defmt_panic() -> ! {
    process::exit(2)
}
