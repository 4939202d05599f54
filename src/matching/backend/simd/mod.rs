//! The dense path in the vectors of 64-bit processors and of WebAssembly.
//!
//! * `sse2`, `avx2`, `avx512`, `neon`, `simd128`: registers, with what they have alike from `registers`;
//!   `half_words`: numbers of two bytes in them.
//! * `windows`, `columns`: sums over windows; `sgm`: costs along paths.
//! * `smooth`, `edges`, `fattening`, `fill`: the filters of answers, pixels side by side; `bits`: those that
//!   are looked at together.
//! * `x86`: code compiled for AVX2 and for AVX-512, chosen when the processor has it.

mod bits;
mod columns;
mod edges;
mod fattening;
mod fill;
mod half_words;
mod row_codes;
mod sgm;
mod smooth;
mod windows;

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "aarch64")]
mod neon;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "wasm32"))]
mod registers;
#[cfg(target_arch = "wasm32")]
mod simd128;
#[cfg(target_arch = "x86_64")]
mod sse2;
#[cfg(target_arch = "x86_64")]
mod x86;
#[cfg(not(target_arch = "x86_64"))]
#[path = "no_x86.rs"]
mod x86;

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "wasm32")))]
use super::portable::words::Word as Vector;
#[cfg(target_arch = "aarch64")]
use neon::Vector;
#[cfg(target_arch = "wasm32")]
use simd128::Vector;
#[cfg(target_arch = "x86_64")]
use sse2::Vector;
use x86::{Avx2, Avx512, Wide, WideByAvx512, Widest};

use super::isa::Isa;
use super::parameters::{MethodParameters, SgmParameters, WindowParameters};
use super::plain;
use super::portable::{self, left_right_rows};
use super::work::{
    AnswerWork, CensusWork, CostWork, EdgeWork, FatteningWork, FillWork, Guide, PathWork, STEP, SmoothWork,
    SpeckleWork, WindowWork,
};
use crate::imaging::{census_plus4, census_ring8};
use crate::matching::kernel::Kernel;
use crate::matching::memory::slices::{part_mut, split_mut};
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::{Select, WinnerRows};
use crate::units::Disparity;

/// The kernels of a 64-bit processor, or of WebAssembly.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::matching) enum Backend {
    /// The portable code.
    Planes,
    /// The vectors that every processor of the target has.
    Lanes,
    /// 256-bit vectors of x86-64.
    Avx2(Avx2),
    /// 512-bit vectors of x86-64.
    Avx512(Avx512),
}

impl Backend {
    /// What a matcher is made with before it is started: its bytes are zero.
    pub(in crate::matching) const FIRST: Self = Self::Planes;

    /// The fastest code that this processor runs.
    pub(in crate::matching) fn detect() -> Self {
        let avx512 = Avx512::detect().map(Self::Avx512);
        avx512.or_else(|| Avx2::detect().map(Self::Avx2)).unwrap_or(Self::Lanes)
    }

    /// The code of a kernel, if this processor runs it.
    pub(in crate::matching) fn of(kernel: Kernel) -> Option<Self> {
        match kernel {
            Kernel::Planes => Some(Self::Planes),
            Kernel::Lanes => Some(Self::Lanes),
            Kernel::Avx2 => Avx2::detect().map(Self::Avx2),
            Kernel::Avx512 => Avx512::detect().map(Self::Avx512),
            Kernel::Dsp | Kernel::Helium | Kernel::Rvv => None,
        }
    }

    /// Does something with the kernel's vectors, if it is inlined.
    #[inline(always)]
    fn in_vectors(self, work: impl FnOnce()) {
        match self {
            Self::Avx2(avx2) => avx2.run(work),
            Self::Avx512(avx512) => avx512.run(work),
            Self::Planes | Self::Lanes => work(),
        }
    }

    /// The disparity that each winner's partner keeps, with room for a byte more a winner.
    fn keep(
        self,
        winners: &WinnerRows<'_>,
        pixels: Option<[&[u8]; 2]>,
        candidates: usize,
        right: &mut [u16],
        room: [&mut [u8]; 2],
    ) {
        match self {
            Self::Avx2(avx2) => avx2.keep(winners, pixels, candidates, right, room),
            Self::Avx512(avx512) => avx512.keep(winners, pixels, candidates, right, room),
            Self::Planes | Self::Lanes => {
                let [kept, _] = room;
                left_right_rows::keep(winners, pixels, right, kept);
            }
        }
    }
}

impl Isa for Backend {
    fn kernel(self) -> Kernel {
        match self {
            Self::Planes => Kernel::Planes,
            Self::Lanes => Kernel::Lanes,
            Self::Avx2(_) => Kernel::Avx2,
            Self::Avx512(_) => Kernel::Avx512,
        }
    }

    #[inline]
    fn candidates(self, disparities: usize, most: usize) -> usize {
        match self {
            Self::Planes => plain::Backend.candidates(disparities, most),
            _ => disparities.next_multiple_of(STEP).min(most) & !(STEP - 1),
        }
    }

    #[inline]
    fn census<P: WindowParameters>(self, work: CensusWork<'_>) {
        if self == Self::Planes {
            return plain::Backend.census::<P>(work);
        }
        let (left, right) = split_mut(work.codes, work.codes.len() / 2);
        self.in_vectors(
            #[inline(always)]
            || {
                for (lines, codes) in work.lines.into_iter().zip([left, right]) {
                    if P::BITS <= 4 { census_plus4(lines, codes) } else { census_ring8(lines, codes) }
                }
            },
        );
    }

    #[inline]
    fn window<P: WindowParameters, const MOST: usize>(
        self,
        work: WindowWork<'_>,
        select: Option<Select<'_>>,
    ) {
        match self {
            Self::Planes => plain::Backend.window::<P, MOST>(work, select),
            Self::Avx2(avx2) if work.stride.is_multiple_of(32) => avx2.row::<P>(work, select),
            Self::Avx512(avx512) if work.stride.is_multiple_of(32) => avx512.row::<P>(work, select),
            // Of registers that would not be full there is nothing to gain.
            _ => windows::in_vectors::<P>(work, select),
        }
    }

    #[inline(always)]
    fn sgm_cost<P: SgmParameters, const MOST: usize>(self, work: &mut PathWork<'_>, row: CostWork<'_>) {
        sgm::cost::<P>(self, work, row);
    }

    #[inline(always)]
    fn sgm_within_edges<const MOST: usize>(self, work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
        sgm::within_edges(self, work, edges);
    }

    #[inline(always)]
    fn sgm_select<const MOST: usize>(self, work: &mut PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
        sgm::select(self, work, guide, select);
    }

    fn left_right<P: MethodParameters>(self, work: AnswerWork<'_>) {
        if self == Self::Planes {
            return plain::Backend.left_right::<P>(work);
        }
        let AnswerWork { winners, right, workspace, begin, pixels, rules, answers, flags } = work;
        let width = winners.width();
        let winners = winners.rows(begin);
        let (kept, fractions) = split_mut(view_mut::<u32, u8>(workspace), width);
        let room = [&mut *kept, &mut *fractions].map(|row| part_mut(row, ..winners.costs.len()));
        self.keep(&winners, pixels, usize::from(rules.ceiling) + 1, right, room);
        self.in_vectors(
            #[inline(always)]
            || left_right_rows::answer::<P>(&winners, kept, rules, fractions, answers, flags),
        );
    }

    fn smooth(self, work: SmoothWork<'_>) {
        if self == Self::Planes || work.answers.len() < smooth::LANES {
            return plain::Backend.smooth(work);
        }
        let SmoothWork { answers, lengths, workspace, step, radius } = work;
        self.in_vectors(
            #[inline(always)]
            || smooth::smooth(answers, lengths.half_words(), workspace, step, radius),
        );
    }

    fn median(self, rows: [&[Disparity]; 3], out: &mut [Disparity]) {
        if self == Self::Planes {
            return plain::Backend.median(rows, out);
        }
        self.in_vectors(
            #[inline(always)]
            || portable::median::median_in_rows(rows, out),
        );
    }

    fn speckle(self, work: SpeckleWork<'_>) {
        self.in_vectors(
            #[inline(always)]
            || portable::speckle::speckle(work),
        );
    }

    fn push_edges(self, edges: &mut [u8], lines: [&[u8]; 3], least: u16) {
        if self == Self::Planes {
            return plain::Backend.push_edges(edges, lines, least);
        }
        self.in_vectors(
            #[inline(always)]
            || edges::push(edges, lines, least),
        );
    }

    fn refuse_fattening(self, work: FatteningWork<'_>) {
        match self {
            Self::Planes => plain::Backend.refuse_fattening(work),
            Self::Lanes => fattening::refuse::<Vector>(work),
            Self::Avx2(avx2) => avx2.run(
                #[inline(always)]
                || fattening::refuse::<Wide>(work),
            ),
            Self::Avx512(avx512) => avx512.run(
                #[inline(always)]
                || fattening::refuse::<Widest>(work),
            ),
        }
    }

    fn fill(self, work: FillWork<'_>) {
        if self == Self::Planes {
            return plain::Backend.fill(work);
        }
        self.in_vectors(
            #[inline(always)]
            || fill::fill(work),
        );
    }

    fn vertical(self, here: &mut [Disparity], above: &[Disparity], below: &[Disparity]) {
        self.in_vectors(
            #[inline(always)]
            || portable::vertical::vertical(here, above, below),
        );
    }
}

/// Whether the two codes of a pixel share a byte where codes have up to four bits.
pub(in crate::matching) const CODES_SHARE_A_BYTE: bool = false;

/// Whether a matcher's capacity chooses the code of its rows, so that a program is linked without the rest.
pub(in crate::matching) const BY_CAPACITY: bool = false;

/// How many bytes before the first line of the cache in a memory where `count` bytes still have their place:
/// vectors as long as a line are then read and written at once. Where there is no such place, none.
pub(in crate::matching) fn columns_begin(memory: &[u8], count: usize) -> u8 {
    const LINE: usize = 64;
    let before = memory.as_ptr().align_offset(LINE);
    if before < LINE && before + count <= memory.len() { before as u8 } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    extern crate std;
    use std::vec;
    use std::vec::Vec;

    #[test]
    fn columns_begin_with_a_line_of_the_cache_where_there_is_room() {
        const LINE: usize = 64;
        let memory = [0; 4 * LINE];
        for (first, count) in (0..2 * LINE).flat_map(|first| (0..2 * LINE).map(move |count| (first, count))) {
            let memory = &memory[first..];
            let begin = usize::from(columns_begin(memory, count));
            let before = memory.as_ptr().addr().next_multiple_of(LINE) - memory.as_ptr().addr();
            let has_room = before + count <= memory.len();
            assert_eq!(begin, if has_room { before } else { 0 }, "{first} {count}");
        }
    }

    #[test]
    fn a_partner_keeps_the_cheapest_and_nearest_winner() {
        let mut state = 1u32;
        let mut chance = |below: usize| {
            state = state.wrapping_mul(0x9e37_79b1).wrapping_add(0x7f4a_7c15);
            (state >> 8) as usize % below
        };
        for width in [1, 2, 31, 63, 64, 65, 100, 127, 128, 129, 300] {
            for candidates in [16, 31, 32, 33, 64, 65, 128, 192, 193, 224, 225, 256] {
                // Few costs, so that many are equal, those that nobody beats among them.
                let costs: Vec<u8> = (0..width).map(|_| [0, 7, 8, 255][chance(4)]).collect();
                let disparities: Vec<u8> = (0..width).map(|x| chance(candidates.min(x + 1)) as u8).collect();
                let [left, of_right] = [(); 2]
                    .map(|()| -> Vec<u8> { (0..width).map(|_| [0, 1, 3, 62, 64, 255][chance(6)]).collect() });
                for pixels in [None, Some([&*left, &*of_right])] {
                    let partner = |x: usize| x - usize::from(disparities[x]);
                    let cost = |x: usize| {
                        let apart = pixels.map_or(0, |[left, right]| left[x].abs_diff(right[partner(x)]));
                        (u16::from(costs[x]) + 4 * u16::from(apart)).min(255)
                    };
                    let kept = |x: usize| {
                        let all = (0..width).filter(|&other| partner(other) == partner(x));
                        let offers = all.map(|other| (cost(other), disparities[other]));
                        offers.min().map(|(_, disparity)| disparity).unwrap()
                    };
                    let expected: Vec<u8> = (0..width).map(kept).collect();
                    for kernel in Kernel::available() {
                        let (mut right, mut found, mut room) =
                            (vec![0; width], vec![0; width], vec![0; width]);
                        let (mut costs, mut disparities) = (costs.clone(), disparities.clone());
                        let (costs, disparities) = (&mut *costs, &mut *disparities);
                        let winners = WinnerRows { below: &mut [], above: &mut [], costs, disparities };
                        let backend = Backend::of(kernel).unwrap();
                        backend.keep(&winners, pixels, candidates, &mut right, [&mut found, &mut room]);
                        let pixels = pixels.is_some();
                        assert_eq!(found, expected, "{kernel:?}: {width} columns, {candidates}, {pixels}");
                    }
                }
            }
        }
    }

    #[test]
    fn kernels_are_chosen_by_name() {
        for kernel in Kernel::available() {
            assert_eq!(Backend::of(kernel).map(Isa::kernel), Some(kernel));
        }
        assert_eq!(Backend::of(Kernel::Dsp), None);
        assert_eq!(Backend::of(Kernel::Helium), None);
        assert_eq!(Kernel::available().last(), Some(Kernel::detect()), "the fastest");
    }

    #[test]
    fn candidates_are_whole_steps_that_there_is_room_for() {
        for (disparities, most) in
            (16..=256usize).flat_map(|d| (16..=256).step_by(16).map(move |most| (d, most)))
        {
            if disparities <= most {
                let steps = disparities.div_ceil(16) * 16;
                assert_eq!(Backend::Lanes.candidates(disparities, most), steps);
                // In words of 32 where the room is whole words.
                let words = disparities.div_ceil(32) * 32;
                let planes = if most % 32 == 0 { words } else { steps };
                assert_eq!(Backend::Planes.candidates(disparities, most), planes, "{disparities} {most}");
            }
        }
    }
}
