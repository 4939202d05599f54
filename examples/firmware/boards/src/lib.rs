//! The boards: which core, which memories, which clock. A board of yours is one more entry.
//!
//! `build.rs` tells the linker the addresses, `src/clock.rs` counts with the clock, and the task runner of
//! the repository starts QEMU with the machine's name.
#![no_std]

/// An emulated board.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Board {
    /// The core's short name, as in `STEREO_CORE`.
    pub core: &'static str,
    /// Rust's name of the target.
    pub target: &'static str,
    /// QEMU's name of the machine.
    pub machine: &'static str,
    /// QEMU's name of the processor, with what it has; the machine's own where it is `None`.
    pub cpu: Option<&'static str>,
    /// Where the program is kept, and how many bytes there are.
    pub flash: (u32, u32),
    /// Where the data is kept, and how many bytes there are.
    pub ram: (u32, u32),
    /// Ticks of the counter in a second of the processor's 10^9 instructions, see `src/clock.rs`.
    pub ticks_per_second: u32,
}

const K: u32 = 1024;
const M: u32 = K * K;

/// A micro:bit, 16 KB of RAM.
pub const M0: Board = Board {
    core: "m0",
    target: "thumbv6m-none-eabi",
    machine: "microbit",
    cpu: None,
    flash: (0, 256 * K),
    ram: (0x2000_0000, 16 * K),
    ticks_per_second: 16_000_000,
};

/// A Cortex-M3.
pub const M3: Board = Board {
    core: "m3",
    target: "thumbv7m-none-eabi",
    machine: "mps2-an385",
    cpu: None,
    flash: (0, 4 * M),
    ram: (0x2000_0000, 4 * M),
    ticks_per_second: 25_000_000,
};

/// A Cortex-M4 with its floating-point unit.
pub const M4: Board = Board { core: "m4", target: "thumbv7em-none-eabihf", machine: "mps2-an386", ..M3 };

/// A Cortex-M7.
pub const M7: Board = Board { core: "m7", machine: "mps2-an500", ..M4 };

/// A Cortex-M33 in its secure state.
pub const M33: Board = Board {
    core: "m33",
    target: "thumbv8m.main-none-eabihf",
    machine: "mps2-an505",
    cpu: None,
    flash: (0x1000_0000, 4 * M),
    ram: (0x3800_0000, 4 * M),
    ticks_per_second: 20_000_000,
};

/// A Cortex-M55 with vector instructions, in its secure state.
pub const M55: Board = Board {
    core: "m55",
    target: "thumbv8m.main-none-eabihf",
    machine: "mps3-an547",
    cpu: None,
    flash: (0x1000_0000, 512 * K),
    ram: (0x3100_0000, 2 * M),
    ticks_per_second: 32_000_000,
};

/// A 32-bit RISC-V core without atomic instructions, which runs its program from RAM.
pub const RV32: Board = Board {
    core: "rv32",
    target: "riscv32imc-unknown-none-elf",
    machine: "virt",
    cpu: None,
    flash: (0x8000_0000, 4 * M),
    ram: (0x8040_0000, 4 * M),
    ticks_per_second: 1_000_000_000,
};

/// The same with vectors: the instructions of Zve32x, in registers of 16 bytes. QEMU's core has those of all
/// widths.
pub const RV32V: Board = Board { core: "rv32v", cpu: Some("rv32,v=true,vlen=128,vext_spec=v1.0"), ..RV32 };

/// All of them. Of two with the same target the first is the one that is meant when no core is named.
pub const ALL: [Board; 8] = [M0, M3, M4, M7, M33, M55, RV32, RV32V];
