//! The path from above.

use super::super::columns::words;
use super::super::steps::Steps;
use super::row::{BELOW, CHANGES, JUMPS, Row, has_eight};
use crate::matching::backend::portable::sgm::quarters::lanes::TOP;
use crate::matching::backend::work::{Guide, PathWork};
use crate::matching::memory::layout::COLUMNS_OFF;
use crate::matching::memory::views::{view, view_mut};
use core::arch::asm;
use core::cell::Cell;
use core::mem::offset_of;

/// The pixels that the path goes through, one after the other, and where its columns are.
struct Pixels {
    here: *const u8,
    above: *const u8,
    /// The two columns of the row above that a pixel's is the average of, and where that goes.
    both: [*const u32; 2],
    to: *mut u32,
    costs: *const u32,
    sums: *mut u32,
}

/// A word of the average.
macro_rules! average {
    ($offset:literal) => {
        concat!(
            at!("lw", "a", $offset, "one"),
            at!("lw", "t", $offset, "other"),
            op!("add", "a", "a", "t"),
            by!("srli", "a", "a", "1"),
            op!("and", "a", "a", "low"),
            at!("sw", "a", $offset, "to"),
            lesser!("behind", "a"),
        )
    };
}

/// What the word is that was before, more by the base and less by its costs; and added to the sums.
macro_rules! put_path {
    ($path:literal, $offset:literal) => {
        concat!(
            at!("lw", "t", $offset, "costs"),
            at!("lw", "u", $offset, "sums"),
            op!("add", $path, $path, "base"),
            op!("sub", $path, $path, "t"),
            at!("sw", $path, $offset, "to"),
            op!("add", "u", "u", $path),
            at!("sw", "u", $offset, "sums"),
        )
    };
}

/// The loop over pixels, through whose columns it goes in `fours` of words or in `eight` at once.
macro_rules! go_down {
    ($(#[$doc:meta])* $name:ident, $words:ident) => {
        $(#[$doc])*
        #[inline(never)]
        unsafe fn $name(row: &Row, pixels: Pixels, count: usize) {
            let Pixels { here, above, both: [one, other], to, costs, sums } = pixels;
            // SAFETY: as the caller says.
            unsafe {
                asm!(
                    "1:",
                    "lbu {t}, 0({here})",
                    "lbu {u}, 0({above})",
                    "sub {t}, {t}, {u}",
                    "srai {u}, {t}, 31",
                    "xor {t}, {t}, {u}",
                    "sub {t}, {t}, {u}",
                    kind!("edge", "edge_of_much"),
                    "sub {base}, {row}, {t}",
                    "add {end}, {to}, {size}",
                    "li {behind}, -1",
                    words!($words, average, "to", "one", "other"),
                    least_of_four!("behind"),
                    "lw {step}, {changes}({base})",
                    "lw {base}, {jumps}({base})",
                    "add {bound}, {base}, {behind}",
                    "srli {t}, {top}, 7",
                    "mul {bound}, {bound}, {t}",
                    "mul {base}, {base}, {t}",
                    "lw {t}, {of_base}({row})",
                    "add {base}, {base}, {t}",
                    "sub {to}, {to}, {size}",
                    "lw {b}, 0({to})",
                    "lw {c}, {far}({row})",
                    beside!("c"),
                    column!($words, "to", put_path, "costs", "sums"),
                    "lw {t}, {skip}({row})",
                    "add {one}, {one}, {t}",
                    "add {other}, {other}, {t}",
                    "add {to}, {end}, {t}",
                    "add {costs}, {costs}, {t}",
                    "add {sums}, {sums}, {t}",
                    "lw {t}, {pixel}({row})",
                    "add {here}, {here}, {t}",
                    "add {above}, {above}, {t}",
                    "addi {count}, {count}, -1",
                    "bnez {count}, 1b",
                    here = inout(reg) here => _, above = inout(reg) above => _, count = inout(reg) count => _,
                    one = inout(reg) one => _, other = inout(reg) other => _, to = inout(reg) to => _,
                    costs = inout(reg) costs => _, sums = inout(reg) sums => _, row = in(reg) row,
                    a = out(reg) _, b = out(reg) _, c = out(reg) _, d = out(reg) _,
                    t = out(reg) _, u = out(reg) _,
                    step = out(reg) _, bound = out(reg) _, behind = out(reg) _,
                    base = out(reg) _, end = out(reg) _,
                    top = in(reg) TOP, low = in(reg) !TOP, below = in(reg) BELOW, changes = const CHANGES,
                    jumps = const JUMPS, edge = in(reg) row.steps.edges[0],
                    edge_of_much = in(reg) row.steps.edges[1], size = in(reg) row.size,
                    far = const offset_of!(Steps, far),
                    of_base = const offset_of!(Steps, base),
                    skip = const offset_of!(Row, skip), pixel = const offset_of!(Row, pixel),
                    options(nostack),
                );
            }
        }
    };
}

go_down! {
    /// Moves the path down to so many pixels and adds it to their sums. 48 and 104 instructions, and 54 for a
    /// pixel.
    ///
    /// # Safety
    /// There are so many pixels, one at least, as far apart as the row says, and of each the columns;
    /// the last two kinds are written.
    fours_down, fours
}
go_down! {
    /// [`fours_down`] of columns of eight words. 88 and 200 instructions in all, and 56 for a pixel.
    ///
    /// # Safety
    /// As of that; a column has eight words.
    eight_down, eight
}

/// Moves the path from above down to the row, and adds it to the sums. Where it stands is said in
/// `in_rounds::down`.
#[inline(never)]
pub(in super::super) fn down<const WORDS: usize, const ALL: bool>(
    row: &Row,
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
) {
    let count = words::<WORDS, ALL>(work);
    let width = work.width;
    let costs = view::<u8, u32>(work.costs);
    let tops = Cell::from_mut(view_mut::<u8, u32>(work.top)).as_slice_of_cells();
    let sums = Cell::from_mut(view_mut::<u8, u32>(work.sums)).as_slice_of_cells();
    let above = guide.above.unwrap_or(guide.here);
    let needed = width * count;
    let is_there = costs.len().min(sums.len()) >= needed
        && tops.len() >= needed + COLUMNS_OFF * count
        && guide.here.len().min(above.len()) >= width
        && count <= WORDS;
    if width == 0 || !is_there {
        return;
    }
    let is_odd = !guide.row.is_multiple_of(2);
    let (from, to) = if is_odd { (0, COLUMNS_OFF) } else { (COLUMNS_OFF, 0) };
    let (none, last) = ([0u32; WORDS], width - 1);
    let column = |x: usize| tops.as_ptr().wrapping_add(x * count).cast_mut().cast::<u32>();
    let mut i = 0;
    while i < width {
        let x = if is_odd { last - i } else { i };
        // At the ends of the row one at a time.
        let inside = width.saturating_sub(2 * COLUMNS_OFF);
        let is_run = i == COLUMNS_OFF && inside > 0 && guide.above.is_some();
        let next = if is_run { inside } else { 1 };
        let both = [x.saturating_sub(COLUMNS_OFF), (x + COLUMNS_OFF).min(last)];
        let both = if guide.above.is_some() {
            both.map(|x| column(x + from).cast_const())
        } else {
            [none.as_ptr(); 2]
        };
        let pixels = Pixels {
            here: guide.here.as_ptr().wrapping_add(x),
            above: above.as_ptr().wrapping_add(x),
            both,
            to: column(x + to),
            costs: costs.as_ptr().wrapping_add(x * count),
            sums: sums.as_ptr().wrapping_add(x * count).cast_mut().cast(),
        };
        // SAFETY: there are as many pixels and columns in the way that the row is gone through, and cells may
        // be written.
        unsafe { (if has_eight::<WORDS, ALL>() { eight_down } else { fours_down })(row, pixels, next) };
        i += next;
    }
}
