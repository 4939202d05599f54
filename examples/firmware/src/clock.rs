//! Instructions counted.
//!
//! QEMU started with `-icount shift=0,align=off,sleep=off` lets a nanosecond pass with every instruction. A Cortex-M
//! counts it with SysTick, whose tick is so many instructions long as the processor's clock period has nanoseconds; RISC-V
//! has a register that counts instructions. These are instructions, not cycles.

#[cfg(target_arch = "arm")]
use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};

/// Bits of the counter: it wraps around, so that what is measured in one go must be shorter.
#[cfg(target_arch = "arm")]
const MASK: u32 = 0xFF_FFFF;
#[cfg(target_arch = "riscv32")]
const MASK: u32 = u32::MAX;

/// Starts the counter.
pub fn start() {
    // There is none for a second caller: it runs already.
    #[cfg(target_arch = "arm")]
    if let Some(mut peripherals) = Peripherals::take() {
        peripherals.SYST.set_clock_source(SystClkSource::Core);
        peripherals.SYST.set_reload(MASK);
        peripherals.SYST.clear_current();
        peripherals.SYST.enable_counter();
    }
}

/// The counter, in ticks.
pub fn now() -> u32 {
    #[cfg(target_arch = "arm")]
    // SysTick counts down.
    return MASK - SYST::get_current();
    #[cfg(target_arch = "riscv32")]
    return riscv::register::minstret::read() as u32;
}

/// Ticks since then, at most as many as the counter can tell: 2^24 on a Cortex-M, 2^32 on RISC-V.
pub fn since(start: u32) -> u32 {
    now().wrapping_sub(start) & MASK
}

/// Instructions of [`known_work`].
pub const KNOWN: u32 = 2_000_000;

/// The ticks that [`KNOWN`] instructions take, which says how long a tick is.
pub fn calibrate() -> u32 {
    let start = now();
    known_work();
    since(start)
}

/// Two instructions, a million times.
#[inline(never)]
#[allow(unsafe_code)]
fn known_work() {
    // SAFETY: it counts a register of its own down and touches no memory.
    unsafe {
        #[cfg(target_arch = "arm")]
        core::arch::asm!(
            "2:", "subs {n}, {n}, #1", "bne 2b",
            n = inout(reg) KNOWN / 2 => _,
            options(nomem, nostack)
        );
        #[cfg(target_arch = "riscv32")]
        core::arch::asm!(
            "2:", "addi {n}, {n}, -1", "bnez {n}, 2b",
            n = inout(reg) KNOWN / 2 => _,
            options(nomem, nostack)
        );
    }
}
