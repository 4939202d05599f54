//! The path from the right, and the winners of the paths' sums.

use super::along::Along;
use super::columns::{FOUR, words};
use super::lanes::before;
use super::steps::{Steps, most};
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::work::{Guide, PathWork};
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::views::{view, view_mut};
use crate::matching::memory::winners::{BESIDE, Found, Unique};
use core::cell::Cell;

/// Takes the path from the right along the row, and selects the winner of every pixel that has a candidate,
/// by the sum of its three paths.
#[inline(always)]
pub(super) fn left<const WORDS: usize, const ALL: bool, Put: FnMut(usize, Found)>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    unique: &mut Unique<'_>,
    put: &mut Put,
) {
    let steps = Steps::new(work.penalties);
    let PathWork { width, disparities, min_disparity, .. } = *work;
    let count = words::<WORDS, ALL>(work);
    // What the sums of two paths along the row have more than their costs, and twice what jumps cost.
    let more = 2 * (128 - i32::from(most(work.penalties)));
    let mut path = Along::new(work, &steps, count);
    let mut room = [[0; WORDS]; 2];
    let [cells, open] = room.each_mut().map(|room| part_mut(room, ..count));
    let cells = Cell::from_mut(cells).as_slice_of_cells();
    let costs = part(view::<u8, u32>(work.costs), ..width * count);
    let sums = part_mut(view_mut::<u8, u32>(work.sums), ..width * count);
    let jumps = &*view_mut::<u32, u8>(work.workspace);
    let mut after = 0;
    let mut columns = rchunks(costs, count).zip(rchunks_mut(sums, count));
    let pixels = part(guide.here, ..width).iter().zip(jumps).enumerate();
    for (x, (&here, &jump)) in pixels.skip(min_disparity).rev() {
        let Some((costs, sums)) = columns.next() else { return };
        let change = steps.between(here, after);
        after = here;
        path.advance(change, costs, cells, cells);
        let more = more - i32::from(jump) - change.jump as i32;
        // The first pixels have fewer candidates than there are lanes.
        let candidates = disparities.min(x + 1 - min_disparity);
        let closed = 4 * count - candidates;
        let mut columns = Sums { path: cells, sums };
        if closed > 0 {
            for (word, ((open, path), sum)) in open.iter_mut().zip(cells).zip(&mut *columns.sums).enumerate()
            {
                let lanes = before(closed, word, count);
                (*open, *sum) = (path.get() | lanes, *sum | lanes);
            }
            columns.path = Cell::from_mut(&mut *open).as_slice_of_cells();
        }
        let (total, disparity) = columns.least(count);
        let cost = byte(total, more);
        let at = |disparity: usize| byte(columns.total(disparity, count), more);
        let [mut below, mut above] = [cost; 2];
        let has_above = disparity + 1 < candidates;
        if has_above {
            above = at(disparity + 1);
            below = above;
        }
        if disparity > 0 {
            below = at(disparity - 1);
            if !has_above {
                above = below;
            }
        }
        put(x, Found { disparity: disparity as u8, cost, beside: (below, above) });
        unique.check(
            x,
            cost,
            #[inline(always)]
            || second(cells, sums, open, (closed, 4 * count - 1 - disparity), more),
        );
    }
}

/// A sum of moved costs as a cost: 255 where it is more.
#[inline(always)]
fn byte(total: u32, more: i32) -> u8 {
    (total as i32 - more).min(255) as u8
}

/// The least cost of the candidates that are neither before the first one nor beside a winner.
#[inline(never)]
fn second(
    path: &[Cell<u32>],
    sums: &mut [u32],
    open: &mut [u32],
    (closed, winner): (usize, usize),
    more: i32,
) -> u8 {
    // It is rarely asked for: its loops are not unrolled, whatever is known of the column where it is.
    let sums = core::hint::black_box(sums);
    let count = sums.len();
    for (word, ((open, path), sum)) in open.iter_mut().zip(path).zip(&mut *sums).enumerate() {
        let around =
            before(winner + BESIDE + 1, word, count) & !before(winner.saturating_sub(BESIDE), word, count);
        let lanes = before(closed, word, count) | around;
        (*open, *sum) = (path.get() | lanes, *sum | lanes);
    }
    byte(Sums { path: Cell::from_mut(open).as_slice_of_cells(), sums }.least(count).0, more)
}

/// The sums at a pixel: those of two paths, and what the third one adds. A candidate that is none has 255 for
/// both, which is more than any other has.
struct Sums<'a> {
    path: &'a [Cell<u32>],
    sums: &'a mut [u32],
}

/// The even bytes of a word, or of one moved down by a byte the odd ones.
const HALVES: u32 = 0x00ff_00ff;
/// The top bit of each half.
const TOP: u32 = 0x8000_8000;
/// How many bits of a half say which word it is of.
const PLACE: u32 = 6;

impl Sums<'_> {
    /// The least sum, and of the candidates that have it the one of the smallest disparity, which comes last.
    #[inline(always)]
    fn least(&self, count: usize) -> (u32, usize) {
        // A sum of nine bits above the number of its word, counted down, and one bit to spare.
        let (mut even, mut odd) = (u32::MAX, u32::MAX);
        let mut place = (count as u32).wrapping_mul(0x0001_0001);
        let lesser = |marked: u32, key: u32| {
            let difference = marked.wrapping_sub(key);
            let top = difference & TOP;
            marked - (difference & (top - (top >> 15)))
        };
        let fours = self.path.as_chunks::<FOUR>().0.iter().zip(self.sums.as_chunks::<FOUR>().0);
        for (path, sums) in fours {
            keep_loop();
            for (path, &sum) in path.iter().zip(sums) {
                let path = path.get();
                place = place.wrapping_sub(0x0001_0001);
                even = lesser(even, (((path & HALVES) + (sum & HALVES)) << PLACE) + place);
                odd = lesser(odd, (((path >> 8 & HALVES) + (sum >> 8 & HALVES)) << PLACE) + place);
            }
        }
        // The sums above the disparities.
        let (mut best, mut behind) = (u32::MAX, 4 * count as u32);
        for half in [even, odd, even >> 16, odd >> 16] {
            behind = behind.wrapping_sub(count as u32);
            best = best.min((half & 0x7fc0) << 10 | ((half & 0x3f) + behind));
        }
        (best >> 16, (best & 0xff) as usize)
    }

    /// The sum of a disparity.
    #[inline(always)]
    fn total(&self, disparity: usize, count: usize) -> u32 {
        let place = (4 * count - 1).wrapping_sub(disparity);
        let count = count.max(1);
        let (lane, word) = (8 * (place / count) as u32, place % count);
        let at = |word: u32| word.unbounded_shr(lane) & 0xff;
        at(self.path.get(word).map_or(0, Cell::get)) + at(self.sums.get(word).copied().unwrap_or(0))
    }
}

/// The columns of a volume, the last first.
#[inline(always)]
fn rchunks<T>(slice: &[T], count: usize) -> impl Iterator<Item = &[T]> {
    let mut rest = slice;
    core::iter::from_fn(move || {
        let (before, chunk) = rest.split_at_checked(rest.len().wrapping_sub(count))?;
        rest = before;
        Some(chunk)
    })
}

/// Mutable access to what [`rchunks`] gives.
#[inline(always)]
fn rchunks_mut<T>(slice: &mut [T], count: usize) -> impl Iterator<Item = &mut [T]> {
    let mut rest = slice;
    core::iter::from_fn(move || {
        let place = rest.len().wrapping_sub(count);
        let (before, chunk) = core::mem::take(&mut rest).split_at_mut_checked(place)?;
        rest = before;
        Some(chunk)
    })
}
