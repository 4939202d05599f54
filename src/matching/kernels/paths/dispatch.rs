//! Which groups of bytes a kernel works on, and how many of them are a column: known when the crate is compiled for the
//! usual numbers of disparities, which lets the compiler unroll them and keep them in registers.

use super::super::{Kernel, Select};
use super::{EdgeWork, Guide, PathWork};
use crate::matching::paths::Along;
use crate::matching::scheme::Around;

/// Calls a pass with the groups, how many of them there is room for in a column, and whether all of it is used. Words: each
/// a function of its own, so that a firmware is linked without those for numbers of disparities that cannot be asked for.
macro_rules! in_words {
    ($work:ident, $pass:ident, [$($scheme:tt)?], $($argument:expr),*) => {
        match $work.stride {
            0 => (),
            16 => words::$pass::<$($scheme,)? 4, true>($work, $($argument),*),
            32 => words::$pass::<$($scheme,)? 8, true>($work, $($argument),*),
            64 => words::$pass::<$($scheme,)? 16, true>($work, $($argument),*),
            _ => words::$pass::<$($scheme,)? 64, false>($work, $($argument),*),
        }
    };
}

mod words {
    use super::super::{EdgeWork, Guide, PathWork, Word};
    use super::{Along, Around, Select};

    #[inline(never)]
    pub(super) fn enter<S: Along, const CELLS: usize, const ALL: bool>(
        work: &mut PathWork<'_>,
        lines: [&Around<'_>; 2],
        room: &mut [u8],
    ) {
        super::super::enter::<Word, S, CELLS, ALL>(work, lines, room);
    }

    #[inline(never)]
    pub(super) fn within_edges<const CELLS: usize, const ALL: bool>(work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
        super::super::within_edges::<Word, CELLS, ALL>(work, edges);
    }

    #[inline(never)]
    pub(super) fn select<const ROWS: bool, const CELLS: usize, const ALL: bool>(
        work: PathWork<'_>,
        guide: Guide<'_>,
        select: Select<'_>,
    ) {
        super::super::select::<Word, ROWS, CELLS, ALL>(work, guide, select);
    }
}

/// The same in vectors of the compilation's own target.
#[cfg(target_pointer_width = "64")]
macro_rules! in_vectors {
    ($work:ident, $pass:ident, [$($scheme:tt)?], $($argument:expr),*) => {
        match $work.stride {
            32 => super::$pass::<super::Vector, $($scheme,)? 2, true>($work, $($argument),*),
            64 => super::$pass::<super::Vector, $($scheme,)? 4, true>($work, $($argument),*),
            128 => super::$pass::<super::Vector, $($scheme,)? 8, true>($work, $($argument),*),
            _ => super::$pass::<super::Vector, $($scheme,)? 16, false>($work, $($argument),*),
        }
    };
}

/// The same in registers of AVX2.
#[cfg(target_arch = "x86_64")]
macro_rules! in_wide {
    ($work:ident, $pass:ident, [$($scheme:tt)?], $($argument:expr),*) => {
        match $work.stride {
            32 => super::$pass::<super::Wide, $($scheme,)? 1, true>($work, $($argument),*),
            64 => super::$pass::<super::Wide, $($scheme,)? 2, true>($work, $($argument),*),
            128 => super::$pass::<super::Wide, $($scheme,)? 4, true>($work, $($argument),*),
            stride if stride % 32 == 0 => super::$pass::<super::Wide, $($scheme,)? 8, false>($work, $($argument),*),
            _ => super::$pass::<super::Vector, $($scheme,)? 16, false>($work, $($argument),*),
        }
    };
}

impl Kernel {
    /// Adds a row of both images to the costs of a method along paths.
    #[inline(always)]
    pub(in crate::matching) fn enter<S: Along>(
        self,
        work: &mut PathWork<'_>,
        lines: [&Around<'_>; 2],
        room: &mut [u8],
    ) {
        match self {
            #[cfg(not(stereopsis_vectors))]
            Self::Planes => in_words!(work, enter, [S], lines, room),
            #[cfg(stereopsis_vectors)]
            Self::Lanes => in_words!(work, enter, [S], lines, room),
            #[cfg(target_pointer_width = "64")]
            Self::Lanes => in_vectors!(work, enter, [S], lines, room),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2) => avx2.run(
                #[inline(always)]
                || in_wide!(work, enter, [S], lines, room),
            ),
        }
    }

    /// Averages the costs of a row with those around it, within edges.
    #[inline(always)]
    pub(in crate::matching) fn within_edges(self, work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
        match self {
            #[cfg(not(stereopsis_vectors))]
            Self::Planes => in_words!(work, within_edges, [], edges),
            #[cfg(stereopsis_vectors)]
            Self::Lanes => in_words!(work, within_edges, [], edges),
            #[cfg(target_pointer_width = "64")]
            Self::Lanes => in_vectors!(work, within_edges, [], edges),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2) => avx2.run(
                #[inline(always)]
                || in_wide!(work, within_edges, [], edges),
            ),
        }
    }

    /// Selects the winners of the row whose costs there are, along paths.
    #[inline(always)]
    pub(in crate::matching) fn select(self, work: PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
        match self {
            #[cfg(not(stereopsis_vectors))]
            Self::Planes => in_words!(work, select, [false], guide, select),
            #[cfg(stereopsis_vectors)]
            Self::Lanes => in_words!(work, select, [true], guide, select),
            #[cfg(target_pointer_width = "64")]
            Self::Lanes => in_vectors!(work, select, [true], guide, select),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(avx2) => avx2.run(
                #[inline(always)]
                || in_wide!(work, select, [true], guide, select),
            ),
        }
    }
}
