//! Windows of more candidates than a group of registers holds, in plain Rust, of which the compiler makes
//! vectors.

use super::rows::with_more_before;
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::backend::work::{STEP, WindowWork};
use crate::matching::memory::layout::OUTSIDE;
use crate::matching::memory::slices::{chunks, chunks_mut, part, part_mut};
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::{BESIDE, Select, Winner, beside};

/// [`Isa::window`](crate::matching::backend::Isa::window) for any number of candidates.
#[inline(never)]
pub(super) fn window<P: WindowParameters>(work: WindowWork<'_>, select: Option<Select<'_>>) {
    let WindowWork { width, stride, min_disparity, enter, leave, columns, workspace } = work;
    // At least some, for the compiler to see that no column is empty.
    let stride = stride.max(STEP);
    let room = view_mut::<u32, u8>(workspace);
    for (row, sign) in [(enter, 1), (leave, u8::MAX)] {
        let Some((left, right)) = row.and_then(|row| row.split_at_checked(width)) else { continue };
        let right = with_more_before(right, min_disparity, stride, room).windows(stride);
        let columns = chunks_mut(part_mut(columns, OUTSIDE * stride..), stride);
        for ((column, &code), codes) in columns.zip(left).zip(right) {
            for (sum, other) in column.iter_mut().zip(codes) {
                *sum = sum.wrapping_add(sign.wrapping_mul((code ^ other).count_ones() as u8));
            }
        }
    }
    let Some(Select { disparities, winners, mut unique }) = select else { return };
    let begin = min_disparity.min(width);
    // From the column on that leaves at the first pixel.
    let leaves = || chunks(part(columns, (OUTSIDE + begin - P::RADIUS_X - 1) * stride..), stride);
    let sums = part_mut(room, ..stride);
    sums.fill(0);
    leaves().take(2 * P::RADIUS_X + 1).for_each(|column| add::<P>(sums, column, 1));
    let ends = leaves().skip(2 * P::RADIUS_X + 1).zip(leaves());
    for ((x, winner), (enters, leaves)) in winners.words().iter_mut().enumerate().skip(begin).zip(ends) {
        add::<P>(sums, enters, 1);
        add::<P>(sums, leaves, u8::MAX);
        let candidates = disparities.min(x + 1 - begin);
        let first = stride - candidates;
        let searched = part(sums, first..);
        let cost = searched.iter().copied().fold(u8::MAX, u8::min);
        let lane = first + searched.iter().rposition(|&sum| sum == cost).unwrap_or(0);
        let disparity = (stride - 1 - lane) as u8;
        let at = |lane: usize| sums.get(lane).copied().unwrap_or(u8::MAX);
        *winner = Winner::new(cost, disparity, beside(stride, disparity, candidates, at));
        unique.check(x, cost, || {
            let before = part(sums, first..lane.saturating_sub(BESIDE).max(first));
            let behind = part(sums, (lane + BESIDE + 1).min(stride)..);
            before.iter().chain(behind).copied().fold(u8::MAX, u8::min)
        });
    }
}

/// Adds what a window takes of a column, or a multiple of it modulo 256.
fn add<P: WindowParameters>(sums: &mut [u8], column: &[u8], times: u8) {
    for (sum, column) in sums.iter_mut().zip(column) {
        *sum = sum.wrapping_add(times.wrapping_mul(column >> P::COLUMN_SHIFT));
    }
}
