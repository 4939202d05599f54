//! Rims refused: answers of a near surface outside of the edges between which it is.
//!
//! What the right camera does not see, left of a near surface, has no answer of its own by which
//! [`fattening`](super::fattening) could refuse one, nor has a sky. But a near surface begins at an edge:
//! where it follows a farther answer by over 2 px and no edge is near, its rim up to the first edge is
//! refused. Where [open] places ask for a margin, a surface in one also ends at an edge, and columns without
//! answers count as far ones. A surface without an edge close by stays.

use super::open;
use crate::imaging::Noise;
use crate::matching::backend::loops::{KEEPS_LOOPS, keep_loop};
use crate::matching::backend::{FatteningWork, MethodParameters};
use crate::matching::memory::slices::part;
use crate::matching::method::Frame;
use crate::units::{Disparity, PixelFlags};
use core::cell::Cell;
use core::ops::Range;

/// Columns before a surface's first answer in which an edge may be that it begins at.
const BESIDE: usize = 2;
/// Most columns of a rim.
const WIDEST: usize = 32;
/// Columns without answers that count as far ones in an open place.
const EMPTY: u32 = 8;
/// Columns at the end of an open place in which the edge may be that it ends at: its last block, and the one
/// beside it.
const END: usize = 2 * open::BLOCK;
/// Columns at the end of an open place that are gone through.
const REACH: usize = EMPTY as usize + WIDEST + END;

/// Refuses the rims among the answers of `newest`.
pub(super) fn refuse_rims<S: MethodParameters>(frame: &mut Frame<'_>, newest: usize) {
    let checks = &frame.config.checks;
    // Noise hides edges that a surface begins at.
    let asked = S::ALONG_PATHS && checks.fattening_slope.is_some() && frame.config.noise == Noise::None;
    if !asked {
        return;
    }
    let row = Row {
        answers: Cell::from_mut(frame.band.row_mut(newest)).as_slice_of_cells(),
        flags: Cell::from_mut(frame.flags.row_mut(newest)).as_slice_of_cells(),
        edges: frame.edges,
        bit: 1 << S::RADIUS_Y,
    };
    row.refuse_all();
    if checks.open_margin > 0 {
        open::for_columns(frame.blocks, frame.width, &mut |place| row.refuse_at_ends(place));
    }
}

/// What the first answer of a row is compared with: none is nearer, so that it begins no surface.
const FIRST: i32 = u16::MAX as i32;
/// Columns that are looked at together.
const GROUP: usize = 16;

/// The next column to the right: what is added to a column's number.
const RIGHT: usize = 1;
/// The next column to the left.
const LEFT: usize = usize::MAX;

/// A row of answers with the edges in it.
struct Row<'a> {
    answers: &'a [Cell<Disparity>],
    flags: &'a [Cell<PixelFlags>],
    edges: &'a [u8],
    /// Set in the edges of this row.
    bit: u8,
}

impl Row<'_> {
    /// Refuses the rims of surfaces at the ends of an open place.
    fn refuse_at_ends(&self, Range { start, end }: Range<usize>) {
        // A place without an edge at its end has no rim there.
        let is_at_edge = |x, way| self.without_edge(x, way, END + WIDEST) < END + WIDEST;
        if is_at_edge(end.saturating_sub(END), RIGHT) {
            self.refuse(start.max(end.saturating_sub(REACH))..end, RIGHT, EMPTY, FIRST);
        }
        if is_at_edge(end.min(start + END).saturating_sub(1), LEFT) {
            self.refuse(start..end.min(start + REACH), LEFT, EMPTY, FIRST);
        }
    }

    /// Refuses the rims of all surfaces that begin in the row, seen to the right. On a desktop groups of
    /// columns in which none can begin are passed over.
    #[inline(always)]
    fn refuse_all(&self) {
        if KEEPS_LOOPS {
            self.refuse(0..self.answers.len(), RIGHT, u32::MAX, FIRST);
            return;
        }
        let mut nearest = FIRST;
        for begin in (0..self.answers.len()).step_by(GROUP) {
            let columns = begin..self.answers.len().min(begin + GROUP);
            nearest = if self.none_begins(begin) {
                let mut answers = part(self.answers, columns).iter().rev().map(Cell::get);
                answers.find(|answer| answer.is_some()).map_or(nearest, nearest_behind)
            } else {
                self.refuse(columns, RIGHT, u32::MAX, nearest)
            };
        }
    }

    /// Whether no surface begins in a group of columns, as far as the column before each tells: behind a gap
    /// any answer may begin one.
    #[inline(always)]
    fn none_begins(&self, begin: usize) -> bool {
        let before = self.answers.get(begin.wrapping_sub(1)..).and_then(|row| row.first_chunk::<GROUP>());
        let here = self.answers.get(begin..).and_then(|row| row.first_chunk::<GROUP>());
        let edges = self.edges.get(begin..).and_then(|row| row.first_chunk::<GROUP>());
        let (Some(before), Some(here), Some(edges)) = (before, here, edges) else { return false };
        let mut begins = false;
        for i in 0..GROUP {
            // No answer is 0, and every other one more.
            let [before, here] = [before, here].map(|row| row[i].get().raw().wrapping_add(1));
            let is_nearer = here > before.saturating_add(FatteningWork::TOLERANCE);
            begins |= is_nearer & (edges[i] & self.bit == 0);
        }
        !begins
    }

    /// Refuses the rims of surfaces that begin in `columns`, seen one `way` along the row: so many columns
    /// without answers are far ones. The first answer begins a surface if it is nearer than `nearest`; what
    /// the next one behind these columns is compared with is returned.
    #[inline(never)]
    fn refuse(&self, columns: Range<usize>, way: usize, far_when_empty: u32, mut nearest: i32) -> i32 {
        let first = columns.start;
        let answers = part(self.answers, columns);
        let mut x = if way == RIGHT { 0 } else { answers.len().wrapping_add(LEFT) };
        let mut to_far = far_when_empty;
        while let Some(answer) = answers.get(x) {
            keep_loop();
            let here = answer.get();
            if here.is_some() {
                if i32::from(here.raw()) > nearest && !self.has_edge(first + x) {
                    self.refuse_rim(first + x, way);
                }
                (nearest, to_far) = (nearest_behind(here), far_when_empty);
            } else {
                to_far = to_far.wrapping_sub(1);
                nearest = if to_far == 0 { -1 } else { nearest };
            }
            x = x.wrapping_add(way);
        }
        nearest
    }

    #[inline(always)]
    fn has_edge(&self, x: usize) -> bool {
        self.edges.get(x).is_some_and(|edges| edges & self.bit != 0)
    }

    /// Refuses the rim of a surface that begins in column `x`, which has no edge.
    // Surfaces are few: most columns begin none.
    #[inline(never)]
    fn refuse_rim(&self, x: usize, way: usize) {
        let back = way.wrapping_neg();
        if self.without_edge(x.wrapping_add(back), back, BESIDE) < BESIDE {
            return;
        }
        let width = self.without_edge(x, way, WIDEST + 1);
        if width > WIDEST {
            return;
        }
        let mut x = x;
        for _ in 0..width {
            keep_loop();
            if let (Some(answer), Some(flags)) = (self.answers.get(x), self.flags.get(x)) {
                flags.set(flags.get().union(PixelFlags::UNTEXTURED.when(answer.get().is_some())));
                answer.set(Disparity::NONE);
            }
            x = x.wrapping_add(way);
        }
    }

    /// How many columns from `x` on are before an edge: `most` if there is none in so many, or in the row.
    #[inline(never)]
    fn without_edge(&self, mut x: usize, way: usize, most: usize) -> usize {
        for count in 0..most {
            keep_loop();
            match self.edges.get(x) {
                Some(edges) if edges & self.bit == 0 => {}
                Some(_) => return count,
                None => break,
            }
            x = x.wrapping_add(way);
        }
        most
    }
}

/// What an answer behind this one has to be nearer than to begin a surface.
#[inline(always)]
fn nearest_behind(answer: Disparity) -> i32 {
    i32::from(answer.raw()) + i32::from(FatteningWork::TOLERANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: u16 = Disparity::NONE.raw();
    const WIDTH: usize = 60;

    /// What `refuse` does to a row with edges in some columns: it refuses these answers and no others.
    fn check(row: &[u16], at: &[usize], refuse: impl Fn(&Row<'_>), refused: Range<usize>) {
        let mut answers: [_; WIDTH] = core::array::from_fn(|x| Disparity::from_raw(row[x]));
        let mut flags = [PixelFlags::CLEAR; WIDTH];
        let mut edges = [0xfe; WIDTH];
        for &x in at {
            edges[x] |= 1;
        }
        refuse(&Row {
            answers: Cell::from_mut(&mut answers[..]).as_slice_of_cells(),
            flags: Cell::from_mut(&mut flags[..]).as_slice_of_cells(),
            edges: &edges,
            bit: 1,
        });
        for x in 0..WIDTH {
            let gone = refused.contains(&x);
            let expected = (if gone { NONE } else { row[x] }, PixelFlags::UNTEXTURED.when(gone));
            assert_eq!((answers[x].raw(), flags[x]), expected, "{at:?}: {x}");
        }
    }

    /// Refuses the rims in these columns, seen in this way.
    fn rims(columns: Range<usize>, way: usize) -> impl Fn(&Row<'_>) {
        move |row| _ = row.refuse(columns.clone(), way, EMPTY, FIRST)
    }

    #[test]
    fn a_near_surface_begins_and_ends_at_its_edge() {
        // Up to the largest disparities that there are.
        for least in [0, 32_500, 40_000, 65_214] {
            // Far, nothing, near from the seventh column on.
            let row: [u16; WIDTH] = core::array::from_fn(|x| match x {
                0..4 => least,
                4..6 => NONE,
                _ => least + 320,
            });
            let mut mirrored = row;
            mirrored.reverse();
            // The column of the only edge, and how many answers are refused.
            for (edge, refused) in [(3, 0), (4, 0), (6, 0), (7, 1), (9, 3), (38, 32), (39, 0)] {
                check(&row, &[edge], rims(0..60, RIGHT), 6..6 + refused);
                check(&row, &[edge], |row| row.refuse_all(), 6..6 + refused);
                check(&mirrored, &[59 - edge], rims(0..60, LEFT), 54 - refused..54);
                check(&row, &[edge], rims(0..60, LEFT), 0..0);
            }
        }
    }

    #[test]
    fn columns_without_answers_are_far_where_so_many_are() {
        for empty in [7, 8, 9] {
            let row: [u16; WIDTH] =
                core::array::from_fn(|x| if (20..20 + empty).contains(&x) { NONE } else { 320 });
            let (begin, refused) = (20 + empty, if empty < 8 { 0 } else { 4 });
            check(&row, &[begin + 4], rims(0..60, RIGHT), begin..begin + refused);
            check(&row, &[15], rims(0..60, LEFT), 20 - refused..20);
            // Columns outside of the place do not count.
            let refused = if empty < 9 { 0..0 } else { begin..begin + 4 };
            check(&row, &[begin + 4], rims(21..60, RIGHT), refused);
        }
    }

    #[test]
    fn the_ends_of_a_place_are_gone_through() {
        // Nothing, a surface of two columns, nothing.
        let at = |first: usize| -> [u16; WIDTH] {
            core::array::from_fn(|x| if (first..first + 2).contains(&x) { 320 } else { NONE })
        };
        // From the last column, 58, 48 columns are gone through: eight of them are before column 19.
        // The edge of the end is within its last eight columns or in the 32 after them.
        let cases: [(usize, &[usize], usize); 6] = [
            (18, &[21, 51], 0),
            (19, &[22, 51], 2),
            (19, &[51], 2),
            (18, &[51], 0),
            (20, &[51], 2),
            (20, &[50], 0),
        ];
        for (first, edges, refused) in cases {
            check(&at(first), edges, |row| row.refuse_at_ends(1..59), first..first + refused);
            let mut mirrored = at(first);
            mirrored.reverse();
            let edges: [usize; 2] = core::array::from_fn(|place| 59 - edges[place.min(edges.len() - 1)]);
            check(&mirrored, &edges, |row| row.refuse_at_ends(1..59), 60 - first - refused..60 - first);
        }
    }
}
