//! Costs along paths in vectors: which groups of bytes a pass works on, and how many of them are a column.
//! For the usual numbers of disparities that is known when the crate is compiled, which lets the compiler
//! unroll them and keep them in registers.

use super::{Backend, Vector, Wide, Widest};
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::group::Group;
use crate::matching::backend::portable::sgm;
use crate::matching::backend::portable::sgm::passes::Groups;
use crate::matching::backend::work::{CostWork, EdgeWork, Guide, PathWork};
use crate::matching::memory::winners::Select;

/// Groups of the target's own vectors in the widest column; where these are words, one more, for which there
/// must be room.
const MOST: usize = 256 / Vector::LANES + if Vector::LANES == size_of::<u32>() { 1 } else { 0 };

/// Calls a pass in vectors of the compilation's own target.
macro_rules! in_vectors {
    ($work:ident, $pass:ident, [$($more:tt)?], $($argument:expr),*) => {
        match $work.stride {
            32 => sgm::$pass::<Groups<Vector, { 32 / Vector::LANES }, true>, $($more)?>($work,
            $($argument),*),
            64 => sgm::$pass::<Groups<Vector, { 64 / Vector::LANES }, true>, $($more)?>($work,
            $($argument),*),
            128 => sgm::$pass::<Groups<Vector, { 128 / Vector::LANES }, true>, $($more)?>($work,
            $($argument),*),
            _ => sgm::$pass::<Groups<Vector, MOST, false>, $($more)?>($work, $($argument),*),
        }
    };
}

/// Calls a pass in registers of AVX2.
macro_rules! in_wide {
    ($work:ident, $pass:ident, [$($more:tt)?], $($argument:expr),*) => {
        match $work.stride {
            32 => sgm::$pass::<Groups<Wide, 1, true>, $($more)?>($work, $($argument),*),
            64 => sgm::$pass::<Groups<Wide, 2, true>, $($more)?>($work, $($argument),*),
            128 => sgm::$pass::<Groups<Wide, 4, true>, $($more)?>($work, $($argument),*),
            stride if stride % 32 == 0 => sgm::$pass::<Groups<Wide, 8, false>, $($more)?>($work,
            $($argument),*),
            _ => sgm::$pass::<Groups<Vector, MOST, false>, $($more)?>($work, $($argument),*),
        }
    };
}

/// Calls a pass in registers of AVX-512, where they are full.
macro_rules! in_widest {
    ($work:ident, $pass:ident, [$($more:tt)?], $($argument:expr),*) => {
        match $work.stride {
            64 => sgm::$pass::<Groups<Widest, 1, true>, $($more)?>($work, $($argument),*),
            128 => sgm::$pass::<Groups<Widest, 2, true>, $($more)?>($work, $($argument),*),
            stride if stride % 64 == 0 => sgm::$pass::<Groups<Widest, 4, false>, $($more)?>($work,
            $($argument),*),
            32 => sgm::$pass::<Groups<Wide, 1, true>, $($more)?>($work, $($argument),*),
            stride if stride % 32 == 0 => sgm::$pass::<Groups<Wide, 8, false>, $($more)?>($work,
            $($argument),*),
            _ => sgm::$pass::<Groups<Vector, MOST, false>, $($more)?>($work, $($argument),*),
        }
    };
}

/// [`Isa::sgm_cost`](crate::matching::backend::Isa::sgm_cost) on each of the kernels.
#[inline(always)]
pub(super) fn cost<S: SgmParameters>(backend: Backend, work: &mut PathWork<'_>, row: CostWork<'_>) {
    match backend {
        Backend::Planes => sgm::cost_in_words::<S, 0>(work, row),
        Backend::Lanes => in_vectors!(work, enter, [S], row),
        Backend::Avx2(avx2) => avx2.run(
            #[inline(always)]
            || in_wide!(work, enter, [S], row),
        ),
        Backend::Avx512(avx512) => avx512.run(
            #[inline(always)]
            || in_widest!(work, enter, [S], row),
        ),
    }
}

/// [`Isa::sgm_within_edges`](crate::matching::backend::Isa::sgm_within_edges) on each of the kernels.
#[inline(always)]
pub(super) fn within_edges(backend: Backend, work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
    match backend {
        Backend::Planes => sgm::within_edges_in_words::<0>(work, edges),
        Backend::Lanes => in_vectors!(work, within_edges, [], edges),
        Backend::Avx2(avx2) => avx2.run(
            #[inline(always)]
            || in_wide!(work, within_edges, [], edges),
        ),
        Backend::Avx512(avx512) => avx512.run(
            #[inline(always)]
            || in_widest!(work, within_edges, [], edges),
        ),
    }
}

/// [`Isa::sgm_select`](crate::matching::backend::Isa::sgm_select) on each of the kernels.
#[inline(always)]
pub(super) fn select(backend: Backend, work: &mut PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
    match backend {
        Backend::Planes => sgm::select_in_words::<0>(work, guide, select),
        Backend::Lanes => in_vectors!(work, select, [true], guide, select),
        Backend::Avx2(avx2) => avx2.run(
            #[inline(always)]
            || in_wide!(work, select, [true], guide, select),
        ),
        Backend::Avx512(avx512) => avx512.run(
            #[inline(always)]
            || in_widest!(work, select, [true], guide, select),
        ),
    }
}
