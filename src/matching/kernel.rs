//! The kernels by name: which instructions the dense path runs on.

/// An implementation of the dense path. All give the same bits; which of them there are depends on the target
/// that the crate is compiled for and on the processor that it runs on ([`Kernel::available`]).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Kernel {
    /// Bit planes in plain 32-bit words: on every core without another kernel, and wherever
    /// [`Lanes`](Self::Lanes) are.
    Planes,
    /// Arm's instructions on four bytes in a word (Cortex-M4 and M7; M33 with `-C target-cpu`).
    Dsp,
    /// The vectors of a Cortex-M55 (with `-C target-cpu`).
    Helium,
    /// The vectors of a 32-bit RISC-V core (Zve32x with Zvl128b, by `-C target-feature`).
    Rvv,
    /// The vectors that every processor of a target has: SSE2, NEON, or SIMD128 of WebAssembly (with
    /// `-C target-feature=+simd128`). On other 64-bit processors the same loops run in plain 32-bit words.
    Lanes,
    /// 256-bit vectors of x86-64.
    Avx2,
    /// 512-bit vectors of x86-64.
    Avx512,
}

impl Kernel {
    /// Every kernel of the crate, whether it is available or not.
    pub const ALL: [Self; 7] =
        [Self::Planes, Self::Dsp, Self::Helium, Self::Rvv, Self::Lanes, Self::Avx2, Self::Avx512];

    /// The kernel's name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Planes => "planes",
            Self::Dsp => "dsp",
            Self::Helium => "helium",
            Self::Rvv => "rvv",
            Self::Lanes => "lanes",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }
}

/// Why a kernel cannot be chosen.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum KernelError {
    /// The crate was compiled for another target, or the processor lacks the instructions.
    Unavailable(Kernel),
}

error_text!(KernelError {
    Self::Unavailable(kernel) => "kernel {}: this processor does not run it" (kernel.name()),
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kernel_has_its_name() {
        let names = ["planes", "dsp", "helium", "rvv", "lanes", "avx2", "avx512"];
        assert_eq!(Kernel::ALL.map(Kernel::name), names);
    }
}
