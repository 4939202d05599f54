//! Instructions counted.
//!
//! QEMU started with `-icount shift=0,align=off,sleep=off` lets a nanosecond pass with every instruction. A
//! Cortex-M counts it with SysTick, whose tick is so many instructions long as the processor's clock period
//! has nanoseconds; RISC-V has a register that counts instructions. These are instructions, not cycles.

use core::cell::Cell;
#[cfg(target_arch = "arm")]
use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};

/// Bits of the counter: 2^24 ticks of SysTick and it begins anew, 2^32 on RISC-V.
#[cfg(target_arch = "arm")]
const MASK: u32 = 0xFF_FFFF;
#[cfg(target_arch = "riscv32")]
const MASK: u32 = u32::MAX;

/// Instructions of the work that [`Clock::calibrate`] measures.
pub const KNOWN: u32 = 2_000_000;

/// The counter, and how far it has come: it has to be read more often than it begins anew.
pub struct Clock {
    last: Cell<u32>,
    ticks: Cell<u64>,
}

impl Clock {
    /// Starts the counter.
    pub fn start() -> Self {
        // A second caller gets none: the counter runs already.
        #[cfg(target_arch = "arm")]
        if let Some(mut peripherals) = Peripherals::take() {
            peripherals.SYST.set_clock_source(SystClkSource::Core);
            peripherals.SYST.set_reload(MASK);
            peripherals.SYST.clear_current();
            peripherals.SYST.enable_counter();
        }
        Self { last: Cell::new(counter()), ticks: Cell::new(0) }
    }

    /// Ticks since the start.
    pub fn now(&self) -> u64 {
        let last = self.last.replace(counter());
        let passed = self.last.get().wrapping_sub(last) & MASK;
        let ticks = self.ticks.get() + u64::from(passed);
        self.ticks.set(ticks);
        ticks
    }

    /// The ticks that [`KNOWN`] instructions take, which says how long a tick is.
    pub fn calibrate(&self) -> u64 {
        let start = self.now();
        known_work();
        self.now() - start
    }
}

/// The counter's own bits, counting up.
fn counter() -> u32 {
    #[cfg(target_arch = "arm")]
    // SysTick counts down.
    return MASK - SYST::get_current();
    #[cfg(target_arch = "riscv32")]
    return riscv::register::minstret::read() as u32;
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
