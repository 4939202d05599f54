//! The least sums of three paths.
#![allow(unsafe_code)]

use super::blocks;
use crate::matching::backend::work::PathWork;
use crate::matching::memory::slices::part_mut;
use crate::matching::memory::winners::BESIDE;
use crate::matching::memory::winners::{Found, Unique};

/// Selects the winner of every pixel that has a candidate. A column has `stride` bytes, a multiple of 16 and
/// 256 at the most.
#[inline(always)]
pub(super) fn select(
    work: &mut PathWork<'_>,
    stride: usize,
    mut unique: Unique<'_>,
    mut put: impl FnMut(usize, Found),
) {
    let (begin, fours) = (work.min_disparity.min(work.width), stride / 16);
    let mut columns = part_mut(work.sums, begin * stride..);
    for x in begin..work.width {
        let Some((sums, rest)) = columns.split_at_mut_checked(stride) else { return };
        columns = rest;
        // The first pixels have fewer candidates than there are lanes.
        let candidates = work.disparities.min(x + 1 - begin);
        if candidates < stride {
            part_mut(sums, ..stride - candidates).fill(u8::MAX);
        }
        // SAFETY: that many words are the sums, and they stand where words may.
        let least = |sums: &[u8]| unsafe { blocks::least(sums.as_ptr().cast(), fours) };
        let (cost, lane) = least(sums);
        let at = |lane: usize| sums.get(lane.min(stride - 1)).copied().unwrap_or(0);
        let (below, above) = (at(lane + 1), at(lane.saturating_sub(1)));
        let disparity = (stride - 1).wrapping_sub(lane);
        let (is_below, is_above) = (disparity > 0, disparity + 1 < candidates);
        // At an end the one beside it that there is; beside an only candidate, itself (which `below` is
        // then).
        let beside =
            (if is_below || !is_above { below } else { above }, if is_above { above } else { below });
        put(x, Found { disparity: disparity as u8, cost, beside });
        unique.check(
            x,
            cost,
            #[inline(always)]
            || {
                let beside = lane.saturating_sub(BESIDE)..(lane + BESIDE + 1).min(stride);
                part_mut(sums, beside).fill(u8::MAX);
                least(sums).0
            },
        );
    }
}
