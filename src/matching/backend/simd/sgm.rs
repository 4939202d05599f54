//! Costs along paths in vectors: which groups of bytes a pass works on, and how many of them are a column.
//! For the usual numbers of disparities that is known when the crate is compiled, which lets the compiler
//! unroll them and keep them in registers.

use super::{Backend, Vector, Wide, WideByAvx512, Widest};
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::group::Group;
use crate::matching::backend::portable::sgm;
use crate::matching::backend::portable::sgm::passes::Groups;
use crate::matching::backend::work::{CostWork, EdgeWork, Guide, PathWork};
use crate::matching::memory::winners::Select;

/// Groups of the target's own vectors in the widest column; where these are words, one more, for which there
/// must be room.
const MOST: usize = 256 / Vector::LANES + if Vector::LANES == size_of::<u32>() { 1 } else { 0 };

/// Calls a pass on columns of some groups in a function of its own: the compiler's passes take far longer
/// over one function of all numbers of groups.
macro_rules! pass {
    ([$($run:tt)+] $pass:ident [$($more:tt)?] $arguments:tt, $vector:ty, $groups:expr, $all:literal) => {
        $($run)+(#[inline(always)] || sgm::$pass::<Groups<$vector, { $groups }, $all>, $($more)?> $arguments)
    };
}

/// Calls a pass in vectors of the compilation's own target.
macro_rules! in_vectors {
    ($stride:expr, $pass:ident $more:tt $arguments:tt) => {
        match $stride {
            32 => pass!([apart] $pass $more $arguments, Vector, 32 / Vector::LANES, true),
            64 => pass!([apart] $pass $more $arguments, Vector, 64 / Vector::LANES, true),
            128 => pass!([apart] $pass $more $arguments, Vector, 128 / Vector::LANES, true),
            _ => pass!([apart] $pass $more $arguments, Vector, MOST, false),
        }
    };
}

/// Calls a pass in registers of AVX2.
macro_rules! in_wide {
    ($avx2:ident, $stride:expr, $pass:ident $more:tt $arguments:tt) => {
        match $stride {
            32 => pass!([$avx2.run] $pass $more $arguments, Wide, 1, true),
            64 => pass!([$avx2.run] $pass $more $arguments, Wide, 2, true),
            128 => pass!([$avx2.run] $pass $more $arguments, Wide, 4, true),
            stride if stride % 32 == 0 => pass!([$avx2.run] $pass $more $arguments, Wide, 8, false),
            _ => pass!([$avx2.run] $pass $more $arguments, Vector, MOST, false),
        }
    };
}

/// Calls a pass in registers of AVX-512, where they are full.
macro_rules! in_widest {
    ($avx512:ident, $stride:expr, $pass:ident $more:tt $arguments:tt) => {
        match $stride {
            64 => pass!([$avx512.run] $pass $more $arguments, Widest, 1, true),
            128 => pass!([$avx512.run] $pass $more $arguments, Widest, 2, true),
            stride if stride % 64 == 0 => pass!([$avx512.run] $pass $more $arguments, Widest, 4, false),
            32 => pass!([$avx512.run] $pass $more $arguments, WideByAvx512, 1, true),
            stride if stride % 32 == 0 => {
                pass!([$avx512.run] $pass $more $arguments, WideByAvx512, 8, false)
            }
            _ => pass!([$avx512.run] $pass $more $arguments, Vector, MOST, false),
        }
    };
}

/// Does something in a function of its own.
#[inline(never)]
fn apart(work: impl FnOnce()) {
    work();
}

/// [`Isa::sgm_cost`](crate::matching::backend::Isa::sgm_cost) on each of the kernels.
#[inline(always)]
pub(super) fn cost<S: SgmParameters>(backend: Backend, work: &mut PathWork<'_>, row: CostWork<'_>) {
    match backend {
        Backend::Planes => sgm::cost_in_words::<S, 0>(work, row),
        Backend::Lanes => in_vectors!(work.stride, enter[S](work, row)),
        Backend::Avx2(avx2) => in_wide!(avx2, work.stride, enter[S](work, row)),
        Backend::Avx512(avx512) => in_widest!(avx512, work.stride, enter[S](work, row)),
    }
}

/// [`Isa::sgm_within_edges`](crate::matching::backend::Isa::sgm_within_edges) on each of the kernels.
#[inline(always)]
pub(super) fn within_edges(backend: Backend, work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
    match backend {
        Backend::Planes => sgm::within_edges_in_words::<0>(work, edges),
        Backend::Lanes => in_vectors!(work.stride, within_edges [] (work, edges)),
        Backend::Avx2(avx2) => in_wide!(avx2, work.stride, within_edges [] (work, edges)),
        Backend::Avx512(avx512) => in_widest!(avx512, work.stride, within_edges [] (work, edges)),
    }
}

/// [`Isa::sgm_select`](crate::matching::backend::Isa::sgm_select) on each of the kernels.
#[inline(always)]
pub(super) fn select(backend: Backend, work: &mut PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
    match backend {
        Backend::Planes => sgm::select_in_words::<0>(work, guide, select),
        Backend::Lanes => in_vectors!(work.stride, select[true](work, guide, select)),
        Backend::Avx2(avx2) => in_wide!(avx2, work.stride, select[true](work, guide, select)),
        Backend::Avx512(avx512) => in_widest!(avx512, work.stride, select[true](work, guide, select)),
    }
}
