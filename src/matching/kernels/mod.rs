//! The work that grows with the number of disparities, behind one seam.
//!
//! In: the census rows that enter and leave the window. Out: a [`Winner`] for every pixel of the row.
//!
//! * `planes`: bit planes in plain 32-bit words, for cores without vectors.
//! * `lanes`: safe Rust over fixed lanes, which the compiler turns into the vectors that the target has.
//! * `x86`: the same code compiled for AVX2, chosen when the processor has it.
//!
//! A 32-bit core gets `planes` alone, unless it is compiled with `--cfg stereopsis_vectors`, which says that its vectors
//! are on (Helium on a Cortex-M55: `-C target-cpu=cortex-m55`); then it gets `lanes` alone. Larger processors have both.
//!
//! Every kernel gives the same bits. A new one is a variant of [`Kernel`] and an arm in [`Kernel::row`].

#[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
mod lanes;
#[cfg(not(stereopsis_vectors))]
mod planes;
mod scratch;
#[cfg(target_arch = "x86_64")]
mod x86;

#[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
pub(super) use scratch::bytes_mut;
pub(super) use scratch::halves_mut;
pub use scratch::{Aligned, Columns, Scratch};

#[cfg(not(stereopsis_vectors))]
pub(super) use planes::codes;

use super::scheme::{Around, Scheme};
use crate::units::PixelFlags;

/// Disparities are worked on in whole groups of this many.
pub const STEP: usize = 16;

/// Which implementation does the work.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Kernel {
    /// Bit planes in 32-bit words.
    #[cfg(not(stereopsis_vectors))]
    Planes,
    /// Vectors of the compilation's own target.
    #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
    Lanes,
    /// 256-bit vectors of x86-64.
    #[cfg(target_arch = "x86_64")]
    Avx2(x86::Avx2),
}

impl Kernel {
    /// A kernel that every processor runs, and whose bytes are zero.
    #[cfg(not(stereopsis_vectors))]
    pub(super) const FIRST: Self = Self::Planes;
    #[cfg(stereopsis_vectors)]
    pub(super) const FIRST: Self = Self::Lanes;

    /// The fastest that this processor runs.
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = x86::Avx2::detect() {
            return Self::Avx2(avx2);
        }
        #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
        return Self::Lanes;
        #[cfg(not(any(target_pointer_width = "64", stereopsis_vectors)))]
        return Self::Planes;
    }

    /// All that this processor runs.
    pub fn available() -> impl Iterator<Item = Self> {
        let best = Self::detect();
        let others = [
            #[cfg(not(stereopsis_vectors))]
            Self::Planes,
            #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
            Self::Lanes,
        ];
        others.into_iter().filter(move |&kernel| kernel != best).chain([best])
    }

    /// Its name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            #[cfg(not(stereopsis_vectors))]
            Self::Planes => "planes",
            #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
            Self::Lanes => "lanes",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => "avx2",
        }
    }

    /// The candidates of a column that it works on for so many `disparities`, of which there is room for `most`, in whole
    /// [`STEP`]s.
    #[inline]
    pub(super) fn candidates(self, disparities: usize, most: usize) -> usize {
        #[cfg(not(stereopsis_vectors))]
        if self == Self::Planes && most.is_multiple_of(32) {
            // Whole words, in a form that lets the compiler see it: a firmware is linked without what cannot be asked for.
            return disparities.next_multiple_of(32).min(most) & !31;
        }
        disparities.next_multiple_of(STEP).min(most) & !(STEP - 1)
    }

    /// The census row of five lines in both images, in the form in which [`Self::row`] takes it: two bytes a pixel.
    #[inline]
    pub(super) fn codes<S: Scheme>(
        self,
        [left, right]: [&Around<'_>; 2],
        min_disparity: usize,
        scratch: &mut [u32],
        out: &mut [u8],
    ) {
        #[cfg(not(stereopsis_vectors))]
        if self == Self::Planes {
            return planes::codes_of::<S>([left, right], min_disparity, scratch, out);
        }
        let _ = (min_disparity, scratch);
        let (of_left, of_right) = out.split_at_mut_checked(out.len() / 2).unwrap_or_default();
        S::census(left, of_left);
        S::census(right, of_right);
    }

    /// Whether it works in vectors.
    #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
    pub(super) fn has_vectors(self) -> bool {
        #[cfg(not(stereopsis_vectors))]
        return self != Self::Planes;
        #[cfg(stereopsis_vectors)]
        true
    }

    /// Does something with its vectors, if it is inlined.
    #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
    #[inline(always)]
    pub(super) fn in_vectors(self, work: impl FnOnce()) {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2) => avx2.run(work),
            _ => work(),
        }
    }

    /// Moves the window to the next row and selects its winners, unless the row is only gathered (`select` is `None`).
    // Where there is one kernel it is inlined, so that the compiler sees which numbers of candidates can be asked for, and
    // a firmware is linked without the code for others.
    #[cfg_attr(any(target_pointer_width = "64", stereopsis_vectors), inline)]
    #[cfg_attr(not(any(target_pointer_width = "64", stereopsis_vectors)), inline(always))]
    pub(super) fn row<S: Scheme>(self, work: RowWork<'_>, select: Option<Select<'_>>) {
        match self {
            #[cfg(not(stereopsis_vectors))]
            Self::Planes => planes::row::<S>(work, select),
            #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
            Self::Lanes => lanes::row::<S>(work, select),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2) => avx2.row::<S>(work, select),
        }
    }
}

/// What a kernel works on.
///
/// Candidate `d` of column `x` is the right image's column `x - min_disparity - d`. Where that lies left of the image,
/// kernels gather the cost against its first column and do not select it.
pub(super) struct RowWork<'a> {
    /// Pixels in the row.
    pub width: usize,
    /// Candidates of a column: [`Kernel::candidates`].
    pub stride: usize,
    /// The smallest disparity, px.
    pub min_disparity: usize,
    /// The row of [`Kernel::codes`] that enters the window below, while there is one.
    pub enter: Option<&'a [u8]>,
    /// The row that leaves it above, once there is one.
    pub leave: Option<&'a [u8]>,
    /// Matching costs summed over the window's height, where a word may stand: `stride` bytes for each of the
    /// image's columns, and for each of [`OUTSIDE`] columns before and after that stay zero.
    pub columns: &'a mut [u8],
    /// Room to work in.
    pub scratch: &'a mut [u32],
}

/// What is selected, and where to.
pub(super) struct Select<'a> {
    /// Disparities searched.
    pub disparities: usize,
    /// The best disparity of each pixel; left of the smallest disparity they mean nothing. Kernels in vectors leave them as
    /// [`WinnerRows`].
    pub winners: &'a mut [Winner],
    /// What is asked of the others.
    pub unique: Unique<'a>,
}

/// The flags of pixels whose second best is too near: [`Checks::uniqueness_percent`](super::Checks::uniqueness_percent).
pub(super) struct Unique<'a> {
    percent: u8,
    flags: &'a mut [PixelFlags],
}

impl<'a> Unique<'a> {
    /// Flags the pixels of a row, none of them where no `percent` is asked for.
    pub fn new(percent: Option<u8>, flags: &'a mut [PixelFlags]) -> Self {
        match percent {
            Some(percent) => Self { percent, flags },
            None => Self { percent: 0, flags: &mut [] },
        }
    }

    /// Whether any pixel is flagged.
    #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
    pub fn is_asked(&self) -> bool {
        !self.flags.is_empty()
    }

    /// Flags the pixels from column `begin` on, one after the other: it is given the winner's cost, and what finds the least cost
    /// of the candidates over one px beside it, `u8::MAX` where there is none, which is asked where it is wanted.
    #[inline(always)]
    pub fn starting_at(self, begin: usize) -> impl FnMut(u8, &mut dyn FnMut() -> u8) {
        let share = 100 - u32::from(self.percent.min(99));
        let mut flags = self.flags.get_mut(begin..).unwrap_or_default().iter_mut();
        move |cost, second| {
            if let Some(flags) = flags.next() {
                let second = second();
                let ambiguous = second < u8::MAX && u32::from(second) * share <= u32::from(cost) * 100;
                *flags = flags.union(PixelFlags::AMBIGUOUS.when(ambiguous));
            }
        }
    }
}

/// The best disparity of a pixel, in a word: from the lowest byte up the cost below it, its own, the cost above it, and
/// the disparity.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(transparent)]
pub struct Winner(u32);

impl Winner {
    /// Where there is no candidate.
    pub const NONE: Self = Self(0);

    /// A winner over the smallest disparity, with the costs one below and one above. Where one of these is no candidate,
    /// the other stands for it; where none is, the winner does.
    #[cfg(not(stereopsis_vectors))]
    #[inline(always)]
    pub fn new(cost: u8, disparity: u8, (below, above): (u8, u8)) -> Self {
        Self(u32::from_le_bytes([below, cost, above, disparity]))
    }

    /// The costs one below and one above.
    #[cfg(not(stereopsis_vectors))]
    #[inline(always)]
    pub fn beside(self) -> (u8, u8) {
        (self.0 as u8, (self.0 >> 16) as u8)
    }

    /// The same winner with other costs beside it.
    #[cfg(not(stereopsis_vectors))]
    #[inline(always)]
    pub fn with_beside(self, beside: (u8, u8)) -> Self {
        Self::new(self.cost(), self.disparity() as u8, beside)
    }

    /// Its disparity over the smallest one searched: of those with the least cost the smallest. Means nothing in columns
    /// without a candidate, as all the rest.
    #[inline(always)]
    pub fn disparity(self) -> u32 {
        self.0 >> 24
    }

    /// Its cost.
    #[inline(always)]
    pub fn cost(self) -> u8 {
        (self.0 >> 8) as u8
    }

    /// Its cost above 8 bits of [`Self::disparity`].
    #[inline(always)]
    pub fn key(self) -> u32 {
        self.0 & 0xff00 | self.0 >> 24
    }

    /// How much more the disparities one below and one above cost.
    #[inline(always)]
    pub fn rises(self) -> (u32, u32) {
        // The winner costs least: nothing wraps.
        let cost = u32::from(self.cost());
        ((self.0 & 0xff).wrapping_sub(cost), (self.0 >> 16 & 0xff).wrapping_sub(cost))
    }
}

/// Winners as the kernels in vectors leave them: a row of bytes for each part, one after the other in the same memory.
#[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
pub(super) struct WinnerRows<'a> {
    pub below: &'a mut [u8],
    pub costs: &'a mut [u8],
    pub above: &'a mut [u8],
    pub disparities: &'a mut [u8],
}

#[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
impl<'a> WinnerRows<'a> {
    /// The rows from column `begin` on.
    pub fn of(winners: &'a mut [Winner], begin: usize) -> Self {
        let width = winners.len().max(1);
        let mut rows =
            scratch::bytes_of(winners).chunks_exact_mut(width).map(|row| row.get_mut(begin..).unwrap_or_default());
        let mut row = || rows.next().unwrap_or_default();
        Self { below: row(), costs: row(), above: row(), disparities: row() }
    }
}

/// Columns of zero sums before the image's first and after its last, to stand for those outside.
pub const OUTSIDE: usize = 5;
