//! The work that grows with the number of disparities, behind one seam.
//!
//! In: the census rows that enter and leave the window. Out: a [`Winner`] for every pixel of the row.
//!
//! * `portable`: safe Rust over fixed lanes, which the compiler turns into what the target has. The reference.
//! * `x86`: the same code compiled for AVX2, chosen when the processor has it.
//!
//! Every kernel gives the same bits. A new one is a variant of [`Kernel`] and an arm in [`Kernel::row`].

mod lane;
mod portable;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use lane::Lane;

use super::scheme::Scheme;

/// Which implementation does the work.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Kernel {
    /// Safe Rust for the compilation's own target.
    Portable,
    /// 256-bit vectors of x86-64.
    #[cfg(target_arch = "x86_64")]
    Avx2(x86::Avx2),
}

impl Kernel {
    /// The fastest that this processor runs.
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = x86::Avx2::detect() {
            return Self::Avx2(avx2);
        }
        Self::Portable
    }

    /// All that this processor runs.
    pub fn available() -> impl Iterator<Item = Self> {
        let best = Self::detect();
        core::iter::once(Self::Portable).chain((best != Self::Portable).then_some(best))
    }

    /// Its name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => "avx2",
        }
    }

    /// Moves the window to the next row; `found` gets the winners in order of the columns, some at a time with
    /// the column of the first, unless the row is only gathered (`select` is `None`).
    #[inline]
    pub(super) fn row<S: Scheme>(
        self,
        work: RowWork<'_, S>,
        select: Option<Select>,
        found: impl FnMut(usize, &[Winner]),
    ) {
        match self {
            Self::Portable => portable::row::<S>(work, select, found),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2) => avx2.row::<S>(work, select, found),
        }
    }
}

/// The census codes of one row in both images.
#[derive(Clone, Copy)]
pub(super) struct RowCodes<'a> {
    /// The left image's, `width` of them.
    pub left: &'a [u8],
    /// The right image's from right to left, moved by the smallest disparity, and its first column's repeated at the
    /// end: the candidates of column x begin at `width - 1 - x` and follow in order of disparity.
    pub right: &'a [u8],
}

/// What a kernel works on.
pub(super) struct RowWork<'a, S: Scheme> {
    /// Pixels in the row.
    pub width: usize,
    /// Lanes of a column: the disparities, rounded up to whole [`lane::STEP`]s.
    pub stride: usize,
    /// The row that enters the window below, while there is one.
    pub enter: Option<RowCodes<'a>>,
    /// The row that leaves it above, once there is one.
    pub leave: Option<RowCodes<'a>>,
    /// Matching costs summed over the window's height: `stride` sums for each column.
    pub columns: &'a mut [u8],
    /// Costs summed over the window: `stride` lanes, room to work in.
    pub sums: &'a mut [S::Sum],
    /// The same with lanes that are no candidates raised: `stride` lanes, room to work in.
    pub masked: &'a mut [S::Sum],
}

/// How winners are selected.
#[derive(Clone, Copy)]
pub(super) struct Select {
    /// Disparities searched.
    pub disparities: usize,
    /// The smallest one, px: columns left of it have no candidate.
    pub min_disparity: usize,
    /// Whether [`Winner::second`] is wanted.
    pub second: bool,
}

impl Select {
    /// How many candidates column `x` has inside the right image.
    #[inline(always)]
    fn candidates(self, x: usize) -> usize {
        (x + 1).saturating_sub(self.min_disparity).min(self.disparities)
    }
}

/// The best disparity of a pixel.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(super) struct Winner {
    /// Candidates that were compared; 0: there is no winner, and nothing below means anything.
    pub candidates: u16,
    /// Disparity over the smallest one searched: the smallest with the least cost.
    pub disparity: u16,
    /// Its cost.
    pub cost: u16,
    /// Costs of the disparities one below and one above; where one is no candidate, both are `cost`.
    pub beside: (u16, u16),
    /// Least cost of the candidates that are over one px beside the winner; `u16::MAX` where there is none or it
    /// was not asked for.
    pub second: u16,
}
