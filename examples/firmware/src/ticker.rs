//! A timer that interrupts: SysTick, which `src/clock.rs` counts with, is one or the other.

#[cfg(target_arch = "arm")]
use cortex_m::peripheral::{Peripherals, SYST};

/// The timer. There is none on RISC-V, and nothing interrupts.
pub struct Ticker {
    #[cfg(target_arch = "arm")]
    timer: SYST,
}

impl Ticker {
    /// Takes the clock's counter, which counts no more.
    pub fn take(clock: crate::clock::Clock) -> Self {
        // It borrows nothing: that it is given up is what counts.
        let _ = clock;
        Self {
            #[cfg(target_arch = "arm")]
            timer: systick(),
        }
    }

    /// Interrupts every so many ticks, the next time after as many.
    pub fn every(&mut self, ticks: u32) {
        #[cfg(target_arch = "arm")]
        {
            self.timer.set_reload(ticks.saturating_sub(1) & 0xff_ffff);
            self.timer.clear_current();
            self.timer.enable_interrupt();
        }
        #[cfg(target_arch = "riscv32")]
        let _ = ticks;
    }

    /// Interrupts no more.
    pub fn stop(&mut self) {
        #[cfg(target_arch = "arm")]
        self.timer.disable_interrupt();
    }
}

#[cfg(target_arch = "arm")]
#[allow(unsafe_code)]
fn systick() -> SYST {
    // SAFETY: the clock took the peripherals, and was given up: nobody else uses SysTick.
    unsafe { Peripherals::steal() }.SYST
}
