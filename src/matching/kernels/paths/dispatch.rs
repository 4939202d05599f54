//! Which groups of bytes a kernel works on, and how many of them are a column: known when the crate is
//! compiled for the usual numbers of disparities, which lets the compiler unroll them and keep them in
//! registers.

#[cfg(target_pointer_width = "64")]
use super::super::groups::{Group, Vector};
#[cfg(target_arch = "x86_64")]
use super::super::groups::{Wide, Widest};
use super::super::{Kernel, Select};
#[cfg(target_pointer_width = "64")]
use super::passes::Groups;
use super::{EdgeWork, Guide, PathWork};
use crate::matching::paths::Along;
use crate::matching::scheme::Around;

/// Words of so many bytes' candidates.
#[cfg(not(any(stereopsis_dsp, stereopsis_vectors)))]
type Words<const CELLS: usize, const ALL: bool> =
    super::passes::Groups<super::super::groups::Word, CELLS, ALL>;
/// The same; that all of them are in use does not help there.
#[cfg(any(stereopsis_dsp, stereopsis_vectors))]
type Words<const CELLS: usize, const ALL: bool> = super::dsp::Words<CELLS, ALL>;

/// Calls a pass with words, of which there is room for so many in a column. Each is a function of its own, so
/// that a firmware is linked without those for numbers of disparities that cannot be asked for.
#[cfg(not(any(stereopsis_dsp, stereopsis_vectors)))]
macro_rules! in_words {
    ($work:ident, $pass:ident, [$($more:tt)?], $($argument:expr),*) => {
        match $work.stride {
            0 => (),
            16 => words::$pass::<Words<4, true>, $($more)?>($work, $($argument),*),
            // Room for as few as will do, and one more: a path's costs stand on the stack, several times.
            ..=64 => words::$pass::<Words<17, false>, $($more)?>($work, $($argument),*),
            ..=128 => words::$pass::<Words<33, false>, $($more)?>($work, $($argument),*),
            _ => words::$pass::<Words<65, false>, $($more)?>($work, $($argument),*),
        }
    };
}

/// The same with Arm's instructions, and whether all of a column is used.
#[cfg(any(stereopsis_dsp, stereopsis_vectors))]
macro_rules! in_words {
    ($work:ident, $pass:ident, [$($more:tt)?], $($argument:expr),*) => {
        match $work.stride {
            0 => (),
            16 => words::$pass::<Words<4, true>, $($more)?>($work, $($argument),*),
            32 => words::$pass::<Words<8, true>, $($more)?>($work, $($argument),*),
            64 => words::$pass::<Words<16, true>, $($more)?>($work, $($argument),*),
            128 => words::$pass::<Words<32, true>, $($more)?>($work, $($argument),*),
            // Room for as few as will do: a path's costs stand on the stack, several times.
            ..64 => words::$pass::<Words<16, false>, $($more)?>($work, $($argument),*),
            ..128 => words::$pass::<Words<32, false>, $($more)?>($work, $($argument),*),
            _ => words::$pass::<Words<64, false>, $($more)?>($work, $($argument),*),
        }
    };
}

mod words {
    use super::super::{EdgeWork, Guide, Passes, PathWork};
    use super::{Along, Around, Select};

    #[inline(never)]
    pub(super) fn enter<P: Passes, S: Along>(
        work: &mut PathWork<'_>,
        is_first: bool,
        lines: [&Around<'_>; 2],
        room: &mut [u8],
    ) {
        super::super::enter::<P, S>(work, is_first, lines, room);
    }

    #[inline(never)]
    pub(super) fn within_edges<P: Passes>(work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
        super::super::within_edges::<P>(work, edges);
    }

    #[inline(never)]
    pub(super) fn select<P: Passes, const ROWS: bool>(
        work: PathWork<'_>,
        guide: Guide<'_>,
        select: Select<'_>,
    ) {
        super::super::select::<P, ROWS>(work, guide, select);
    }
}

/// Groups of the target's own vectors in the widest column; where these are words, one more, for which there
/// must be room.
#[cfg(target_pointer_width = "64")]
const MOST: usize = 256 / Vector::LANES + if Vector::LANES == size_of::<u32>() { 1 } else { 0 };

/// The same in vectors of the compilation's own target.
#[cfg(target_pointer_width = "64")]
macro_rules! in_vectors {
    ($work:ident, $pass:ident, [$($more:tt)?], $($argument:expr),*) => {
        match $work.stride {
            32 => super::$pass::<Groups<Vector, { 32 / Vector::LANES }, true>, $($more)?>($work, $($argument),*),
            64 => super::$pass::<Groups<Vector, { 64 / Vector::LANES }, true>, $($more)?>($work, $($argument),*),
            128 => super::$pass::<Groups<Vector, { 128 / Vector::LANES }, true>, $($more)?>($work, $($argument),*),
            _ => super::$pass::<Groups<Vector, MOST, false>, $($more)?>($work, $($argument),*),
        }
    };
}

/// The same in registers of AVX2.
#[cfg(target_arch = "x86_64")]
macro_rules! in_wide {
    ($work:ident, $pass:ident, [$($more:tt)?], $($argument:expr),*) => {
        match $work.stride {
            32 => super::$pass::<Groups<Wide, 1, true>, $($more)?>($work, $($argument),*),
            64 => super::$pass::<Groups<Wide, 2, true>, $($more)?>($work, $($argument),*),
            128 => super::$pass::<Groups<Wide, 4, true>, $($more)?>($work, $($argument),*),
            stride if stride % 32 == 0 => super::$pass::<Groups<Wide, 8, false>, $($more)?>($work, $($argument),*),
            _ => super::$pass::<Groups<Vector, MOST, false>, $($more)?>($work, $($argument),*),
        }
    };
}

/// The same in registers of AVX-512, where they are full.
#[cfg(target_arch = "x86_64")]
macro_rules! in_widest {
    ($work:ident, $pass:ident, [$($more:tt)?], $($argument:expr),*) => {
        match $work.stride {
            64 => super::$pass::<Groups<Widest, 1, true>, $($more)?>($work, $($argument),*),
            128 => super::$pass::<Groups<Widest, 2, true>, $($more)?>($work, $($argument),*),
            stride if stride % 64 == 0 => super::$pass::<Groups<Widest, 4, false>, $($more)?>($work, $($argument),*),
            32 => super::$pass::<Groups<Wide, 1, true>, $($more)?>($work, $($argument),*),
            stride if stride % 32 == 0 => super::$pass::<Groups<Wide, 8, false>, $($more)?>($work, $($argument),*),
            _ => super::$pass::<Groups<Vector, MOST, false>, $($more)?>($work, $($argument),*),
        }
    };
}

impl Kernel {
    /// Adds a row of both images to the costs of a method along paths, the first row of a frame to none.
    #[inline(always)]
    pub(in crate::matching) fn enter<S: Along>(
        self,
        work: &mut PathWork<'_>,
        is_first: bool,
        lines: [&Around<'_>; 2],
        room: &mut [u8],
    ) {
        match self {
            #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
            Self::Planes => in_words!(work, enter, [S], is_first, lines, room),
            #[cfg(stereopsis_dsp)]
            Self::Bytes => in_words!(work, enter, [S], is_first, lines, room),
            #[cfg(stereopsis_vectors)]
            Self::Lanes => in_words!(work, enter, [S], is_first, lines, room),
            #[cfg(target_pointer_width = "64")]
            Self::Lanes => in_vectors!(work, enter, [S], is_first, lines, room),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2) => avx2.run(
                #[inline(always)]
                || in_wide!(work, enter, [S], is_first, lines, room),
            ),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(avx512) => avx512.run(
                #[inline(always)]
                || in_widest!(work, enter, [S], is_first, lines, room),
            ),
        }
    }

    /// Averages the costs of a row with those around it, within edges.
    #[inline(always)]
    pub(in crate::matching) fn within_edges(self, work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
        match self {
            #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
            Self::Planes => in_words!(work, within_edges, [], edges),
            #[cfg(stereopsis_dsp)]
            Self::Bytes => in_words!(work, within_edges, [], edges),
            #[cfg(stereopsis_vectors)]
            Self::Lanes => in_words!(work, within_edges, [], edges),
            #[cfg(target_pointer_width = "64")]
            Self::Lanes => in_vectors!(work, within_edges, [], edges),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2) => avx2.run(
                #[inline(always)]
                || in_wide!(work, within_edges, [], edges),
            ),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(avx512) => avx512.run(
                #[inline(always)]
                || in_widest!(work, within_edges, [], edges),
            ),
        }
    }

    /// Selects the winners of the row whose costs there are, along paths.
    #[inline(always)]
    pub(in crate::matching) fn select(self, work: PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
        match self {
            #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
            Self::Planes => in_words!(work, select, [false], guide, select),
            #[cfg(stereopsis_dsp)]
            Self::Bytes => in_words!(work, select, [false], guide, select),
            #[cfg(stereopsis_vectors)]
            Self::Lanes => in_words!(work, select, [true], guide, select),
            #[cfg(target_pointer_width = "64")]
            Self::Lanes => in_vectors!(work, select, [true], guide, select),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2) => avx2.run(
                #[inline(always)]
                || in_wide!(work, select, [true], guide, select),
            ),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(avx512) => avx512.run(
                #[inline(always)]
                || in_widest!(work, select, [true], guide, select),
            ),
        }
    }
}
