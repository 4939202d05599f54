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
pub use lanes::Lane;
pub(super) use scratch::halves_mut;
pub use scratch::{Aligned, Columns, Scratch};

#[cfg(not(stereopsis_vectors))]
pub(super) use planes::codes;

use super::scheme::{Around, Scheme};

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

    /// The census row of five lines.
    #[inline]
    pub(super) fn census<S: Scheme>(self, rows: &Around<'_>, out: &mut [u8]) {
        #[cfg(not(stereopsis_vectors))]
        if self == Self::Planes {
            return planes::census::<S>(rows, out);
        }
        S::census(rows, out);
    }

    /// Brings the census rows of both images into the form in which [`Self::row`] takes them, once for each row.
    #[inline]
    pub(super) fn prepare<S: Scheme>(self, left: &mut [u8], right: &mut [u8], min_disparity: usize) {
        #[cfg(not(stereopsis_vectors))]
        if self == Self::Planes {
            planes::prepare::<S>(left, right, min_disparity);
        }
        let _ = (left, right, min_disparity);
    }

    /// Moves the window to the next row; `found` gets the winners in order of the columns, some at a time,
    /// unless the row is only gathered (`select` is `None`).
    #[inline]
    pub(super) fn row<S: Scheme>(self, work: RowWork<'_>, select: Option<Select>, found: Found<'_>) {
        match self {
            #[cfg(not(stereopsis_vectors))]
            Self::Planes => planes::row::<S>(work, select, found),
            #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
            Self::Lanes => lanes::row::<S>(work, select, found),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2) => avx2.row::<S>(work, select, found),
        }
    }
}

/// Takes winners in order of the columns, some at a time. It is called, not compiled into every kernel.
pub(super) type Found<'a> = &'a mut dyn FnMut(&[Winner]);

/// The census codes of one row in both images, `width` of them each.
#[derive(Clone, Copy)]
pub(super) struct RowCodes<'a> {
    pub left: &'a [u8],
    pub right: &'a [u8],
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
    /// The row that enters the window below, while there is one.
    pub enter: Option<RowCodes<'a>>,
    /// The row that leaves it above, once there is one.
    pub leave: Option<RowCodes<'a>>,
    /// Matching costs summed over the window's height, where a word may stand: `stride` bytes for each of the
    /// image's columns, and for each of [`OUTSIDE`] columns before and after that stay zero.
    pub columns: &'a mut [u8],
    /// Room to work in.
    pub scratch: &'a mut [u32],
}

/// How winners are selected.
#[derive(Clone, Copy)]
pub(super) struct Select {
    /// Disparities searched.
    pub disparities: usize,
    /// Whether [`Winner::second`] is wanted.
    pub second: bool,
}

/// The best disparity of a pixel.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(super) struct Winner {
    /// The cost above 8 bits of the disparity.
    key: u32,
    /// The cost below in the low half, that above in the high one.
    beside: u32,
    /// Least cost of the candidates that are over one px beside the winner; `u32::MAX` where there is none. Not set where
    /// it was not asked for.
    pub second: u32,
}

impl Winner {
    /// Becomes a winner over the smallest disparity, with the costs one below and one above. Where one of these is no
    /// candidate, the other stands for it; where none is, the winner does. [`Self::second`] stays.
    #[inline(always)]
    pub fn set(&mut self, cost: u32, disparity: u32, beside: (u32, u32)) {
        self.key = cost << 8 | disparity;
        self.beside = beside.0 | beside.1 << 16;
    }

    /// Its cost above 8 bits of [`Self::disparity`].
    #[inline(always)]
    pub fn key(&self) -> u32 {
        self.key
    }

    /// Disparity over the smallest one searched: of those with the least cost the smallest. Means nothing in columns
    /// without a candidate, as all the rest.
    #[inline(always)]
    pub fn disparity(&self) -> u32 {
        self.key & 0xff
    }

    /// Its cost.
    #[inline(always)]
    pub fn cost(&self) -> u32 {
        self.key >> 8
    }

    /// How much more the disparities one below and one above cost.
    #[inline(always)]
    pub fn rises(&self) -> (u32, u32) {
        // The winner costs least: nothing wraps.
        ((self.beside & 0xffff).wrapping_sub(self.cost()), (self.beside >> 16).wrapping_sub(self.cost()))
    }
}

/// Columns of zero sums before the image's first and after its last, to stand for those outside.
pub const OUTSIDE: usize = 5;
