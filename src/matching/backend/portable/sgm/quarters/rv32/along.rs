//! The paths along the row.

use super::row::{BELOW, CHANGES, JUMPS, Pixels, Row};
use crate::matching::backend::portable::sgm::quarters::columns::words;
use crate::matching::backend::portable::sgm::quarters::lanes::{ONE, TOP};
use crate::matching::backend::work::{Guide, PathWork};
use crate::matching::memory::views::{view, view_mut};
use core::arch::asm;

/// What the word is that was before, less its costs; and the least so far.
macro_rules! put_path {
    ($path:literal, $offset:literal) => {
        concat!(
            at!("lw", "t", $offset, "costs"),
            op!("sub", $path, $path, "t"),
            at!("sw", $path, $offset, "to"),
            lesser!("marked", $path),
        )
    };
}

/// The loop over pixels, through whose columns it goes in `fours` of words or in `eight` at once.
macro_rules! along {
    ($(#[$doc:meta])* $name:ident, $words:ident) => {
        $(#[$doc])*
        #[inline(never)]
        pub(super) unsafe fn $name(row: &Row, pixels: Pixels, count: usize) -> u32 {
            let Pixels { here, kinds, costs, from, to, before, least } = pixels;
            let [edge, edge_of_much] = row.steps.edges;
            let mut marked = least;
            // SAFETY: as the caller says.
            unsafe {
                asm!(
                    "1:",
                    "lbu {u}, 0({here})",
                    "addi {here}, {here}, 1",
                    "sub {t}, {u}, {before}",
                    "mv {before}, {u}",
                    "srai {u}, {t}, 31",
                    "xor {t}, {t}, {u}",
                    "sub {t}, {t}, {u}",
                    kind!("edge", "edge_of_much"),
                    "sb {t}, 0({kinds})",
                    "addi {kinds}, {kinds}, 1",
                    "sub {t}, {row}, {t}",
                    "lw {step}, {changes}({t})",
                    "lw {bound}, {jumps}({t})",
                    "add {bound}, {bound}, {marked}",
                    "mul {bound}, {bound}, {ones}",
                    "lw {b}, 0({from})",
                    "add {end}, {from}, {size}",
                    beside!("far"),
                    "li {marked}, -1",
                    column!($words, "from", put_path, "costs", "to"),
                    least_of_four!("marked"),
                    "sub {from}, {to}, {size}",
                    "addi {count}, {count}, -1",
                    "bnez {count}, 1b",
                    here = inout(reg) here => _, before = inout(reg) u32::from(before) => _,
                    kinds = inout(reg) kinds => _, count = inout(reg) count => _,
                    from = inout(reg) from => _, costs = inout(reg) costs => _, to = inout(reg) to => _,
                    row = in(reg) row, size = in(reg) row.size, far = in(reg) row.steps.far,
                    edge = in(reg) edge, edge_of_much = in(reg) edge_of_much, marked = inout(reg) marked,
                    a = out(reg) _, b = out(reg) _, c = out(reg) _, d = out(reg) _,
                    t = out(reg) _, u = out(reg) _,
                    step = out(reg) _, bound = out(reg) _, behind = out(reg) _, end = out(reg) _,
                    top = in(reg) TOP, ones = in(reg) ONE, below = in(reg) BELOW,
                    changes = const CHANGES, jumps = const JUMPS,
                    options(nostack),
                );
            }
            marked
        }
    };
}

along! {
    /// Takes a path through so many pixels; returns the least of the last one's column. 108 instructions, and
    /// 44 for a pixel.
    ///
    /// # Safety
    /// There are so many pixels, one at least, and of each a column of the row's size of costs, read, and one
    /// written; the one before is read, and may be the first one's.
    along_fours, fours
}
along! {
    /// [`along_fours`] of columns of eight words. 208 instructions in all, and 44 for a pixel.
    ///
    /// # Safety
    /// As of that; a column has eight words.
    along_eight, eight
}

/// Takes the path from the left along the row. The kind of the change on its way into each pixel, times
/// eight, is put in the workspace.
#[inline(never)]
pub(in super::super) fn right<const WORDS: usize, const ALL: bool>(
    row: &Row,
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
) {
    let count = words::<WORDS, ALL>(work);
    let width = work.width;
    let costs = view::<u8, u32>(work.costs);
    let columns = view_mut::<u8, u32>(work.sums);
    let kinds = view_mut::<u32, u8>(work.workspace);
    let lengths = [costs.len() / count.max(1), columns.len() / count.max(1), kinds.len(), guide.here.len()];
    if width == 0 || count > WORDS || lengths.into_iter().any(|length| length < width) {
        return;
    }
    let none = [0u32; WORDS];
    let pixels = Pixels {
        here: guide.here.as_ptr(),
        kinds: kinds.as_mut_ptr(),
        costs: costs.as_ptr(),
        from: none.as_ptr(),
        to: columns.as_mut_ptr(),
        before: 0,
        least: 0,
    };
    // SAFETY: there are as many pixels, kinds and columns.
    unsafe { (row.along)(row, pixels, width) };
}
