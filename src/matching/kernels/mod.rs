//! The work that grows with the number of disparities, behind one seam.
//!
//! In: the census rows that enter and leave the window. Out: a [`Winner`] for every pixel of the row.
//!
//! * `census`: the codes of four pixels at a time in plain 32-bit words, for the next two.
//! * `planes`: bit planes in plain 32-bit words, for cores without vectors.
//! * `bytes`: four bytes in a word, for cores that have Arm's instructions for that.
//! * `groups`: bytes side by side, in the registers of larger processors and in words.
//! * `windows`: sums over windows, for groups. `x86`: the same compiled for AVX2 and for AVX-512, chosen when
//!   the processor has it.
//! * `paths`: costs along paths, for groups, and for Arm's instructions on four bytes.
//! * `helium`: what stages do for a row, in assembly for the vectors of a Cortex-M55.
//! * `winner`: what all of them give.
//!
//! A 32-bit core gets `planes` alone, unless it is compiled with `--cfg stereopsis_dsp`, which says that it
//! has instructions on four bytes (Cortex-M4, M7, M33); then it gets `bytes` alone; or with `--cfg
//! stereopsis_vectors`, which says that its vectors are on (Helium on a Cortex-M55: `-C
//! target-cpu=cortex-m55`); then it gets `helium` alone. Larger processors have `planes`, and
//! `windows` in the vectors that there are.
//!
//! Every kernel gives the same bits. A new one is a variant of [`Kernel`] and an arm in [`Kernel::row`].

#[cfg(stereopsis_dsp)]
pub mod bytes;
#[cfg(not(stereopsis_vectors))]
mod census;
#[cfg(not(any(stereopsis_dsp, stereopsis_vectors)))]
mod groups;
#[cfg(stereopsis_vectors)]
pub mod helium;
mod paths;
#[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
mod planes;
#[cfg(target_pointer_width = "64")]
mod row_codes;
mod scratch;
#[cfg(target_pointer_width = "64")]
mod windows;
mod winner;
#[cfg(target_arch = "x86_64")]
mod x86;

#[cfg(target_pointer_width = "64")]
pub use groups::Group;
pub(super) use paths::{COLUMNS_OFF, EdgeWork, Guide, PathWork};
pub use scratch::{Aligned, Columns, Room, Scratch, Volumes};
pub(super) use scratch::{bytes_mut, bytes_of, bytes_of_halves, halves_mut, read_bytes_of, winners_mut};
pub use winner::Winner;
#[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
pub(super) use winner::WinnerRows;
pub(super) use winner::{Select, Unique};

#[cfg(not(stereopsis_vectors))]
pub(super) use census::codes;

use super::scheme::Around;
use super::window::Windowed;

/// Disparities are worked on in whole groups of this many.
pub const STEP: usize = 16;

/// Which implementation does the work.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Kernel {
    /// Bit planes in 32-bit words.
    #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
    Planes,
    /// Four bytes in a 32-bit word.
    #[cfg(stereopsis_dsp)]
    Bytes,
    /// Vectors of the compilation's own target.
    #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
    Lanes,
    /// 256-bit vectors of x86-64.
    #[cfg(target_arch = "x86_64")]
    Avx2(x86::Avx2),
    /// 512-bit vectors of x86-64.
    #[cfg(target_arch = "x86_64")]
    Avx512(x86::Avx512),
}

impl Kernel {
    /// A kernel that every processor runs, and whose bytes are zero.
    #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
    pub(super) const FIRST: Self = Self::Planes;
    #[cfg(stereopsis_dsp)]
    pub(super) const FIRST: Self = Self::Bytes;
    #[cfg(stereopsis_vectors)]
    pub(super) const FIRST: Self = Self::Lanes;

    /// The fastest that this processor runs.
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(avx512) = x86::Avx512::detect() {
            return Self::Avx512(avx512);
        }
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = x86::Avx2::detect() {
            return Self::Avx2(avx2);
        }
        #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
        return Self::Lanes;
        #[cfg(not(any(target_pointer_width = "64", stereopsis_vectors)))]
        return Self::FIRST;
    }

    /// All that this processor runs, the fastest last.
    pub fn available() -> impl Iterator<Item = Self> {
        let all = [
            #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
            Some(Self::Planes),
            #[cfg(stereopsis_dsp)]
            Some(Self::Bytes),
            #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
            Some(Self::Lanes),
            #[cfg(target_arch = "x86_64")]
            x86::Avx2::detect().map(Self::Avx2),
            #[cfg(target_arch = "x86_64")]
            x86::Avx512::detect().map(Self::Avx512),
        ];
        all.into_iter().flatten()
    }

    /// Its name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
            Self::Planes => "planes",
            #[cfg(stereopsis_dsp)]
            Self::Bytes => "bytes",
            #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
            Self::Lanes => "lanes",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => "avx2",
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => "avx512",
        }
    }

    /// The candidates of a column that it works on for so many `disparities`, of which there is room for
    /// `most`, in whole [`STEP`]s.
    #[inline]
    pub(super) fn candidates(self, disparities: usize, most: usize) -> usize {
        #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
        if self == Self::Planes && most.is_multiple_of(32) {
            // Whole words, in a form that lets the compiler see it: a firmware is linked without what cannot
            // be asked for.
            return disparities.next_multiple_of(32).min(most) & !31;
        }
        #[cfg(any(stereopsis_vectors, stereopsis_dsp))]
        if let Some(group) = [64, 32].into_iter().find(|&group| most.is_multiple_of(group)) {
            // As many as there is assembly for, likewise; never none.
            return (disparities.next_multiple_of(group).min(most) & !(group - 1)).max(group);
        }
        disparities.next_multiple_of(STEP).min(most) & !(STEP - 1)
    }

    /// The census row of five lines in both images, in the form in which [`Self::row`] takes it: two bytes a
    /// pixel.
    #[inline]
    pub(super) fn codes<S: Windowed>(
        self,
        [left, right]: [&Around<'_>; 2],
        min_disparity: usize,
        scratch: &mut [u32],
        out: &mut [u8],
    ) {
        #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
        if self == Self::Planes {
            return planes::codes_of::<S>([left, right], min_disparity, scratch, out);
        }
        #[cfg(stereopsis_dsp)]
        if self == Self::Bytes {
            return bytes::codes_of::<S>([left, right], out);
        }
        let _ = min_disparity;
        let (of_left, of_right) = out.split_at_mut_checked(out.len() / 2).unwrap_or_default();
        #[cfg(stereopsis_vectors)]
        if S::BITS <= 4 {
            for (lines, codes) in [(left, of_left), (right, of_right)] {
                helium::census_plus4(lines, bytes_mut(scratch), codes);
            }
            return;
        }
        let _ = scratch;
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
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(avx512) => avx512.run(work),
            _ => work(),
        }
    }

    /// Moves the window to the next row and selects its winners, unless the row is only gathered (`select` is
    /// `None`).
    // Where there is one kernel it is inlined, so that the compiler sees which numbers of candidates can be
    // asked for, and a firmware is linked without the code for others.
    #[cfg_attr(target_pointer_width = "64", inline)]
    #[cfg_attr(not(target_pointer_width = "64"), inline(always))]
    pub(super) fn row<S: Windowed>(self, work: RowWork<'_>, select: Option<Select<'_>>) {
        match self {
            #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
            Self::Planes => planes::row::<S>(work, select),
            #[cfg(stereopsis_dsp)]
            Self::Bytes => bytes::row::<S>(work, select),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2) if work.stride.is_multiple_of(32) => avx2.row::<S>(work, select),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(avx512) if work.stride.is_multiple_of(32) => avx512.row::<S>(work, select),
            // Of registers that would not be full there is nothing to gain.
            #[cfg(target_pointer_width = "64")]
            _ => windows::in_vectors::<S>(work, select),
            #[cfg(stereopsis_vectors)]
            Self::Lanes => helium::row::<S>(work, select),
        }
    }
}

/// How near a disparity may be to the winner and still be of it: what costs little there does not make it
/// ambiguous.
pub(super) const BESIDE: usize = 2;

/// 256 lanes of ones, then 256 of zero: a slice of it masks the lanes before any one.
#[cfg(not(stereopsis_dsp))]
const MASKS: &[u8; 512] = &{
    let mut masks = [0; 512];
    let mut i = 0;
    while i < 256 {
        masks[i] = u8::MAX;
        i += 1;
    }
    masks
};

/// What a kernel works on.
///
/// Candidate `d` of column `x` is the right image's column `x - min_disparity - d`. Where that lies left of
/// the image, kernels gather the cost against its first column and do not select it.
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
    /// Matching costs summed over the window's height, where a word may stand: `stride` bytes for each of
    /// the image's columns, and for each of [`OUTSIDE`] columns before and after that stay zero.
    pub columns: &'a mut [u8],
    /// Room to work in.
    pub scratch: &'a mut [u32],
}

/// Words that the tables of the kernel in bytes take, where codes have up to four bits, and four that rows
/// are read beyond.
pub const TABLE_WORDS: usize = 2 * 16 * 96 / size_of::<u32>() + 4;

/// Columns of zero sums before the image's first and after its last, to stand for those outside.
pub const OUTSIDE: usize = 5;
