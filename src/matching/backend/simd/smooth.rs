//! Pixels side by side: pair by pair, as far as both are still of the surface.

use super::bits::{TOGETHER, each};
use crate::matching::backend::loops::fill_row;
use crate::matching::backend::portable::smooth::{MARGIN, RECIPROCALS, of_one};
use crate::matching::config::Checks;
use crate::matching::memory::slices::{part, part_mut};
use crate::units::Disparity;

/// Pixels worked on at a time.
pub(super) const LANES: usize = 32;
/// Answers of a short surface.
const SHORT: usize = 16;
/// How far the answers around a pixel reach, to each side.
const REACH: usize = MARGIN / 2;

/// Differences of the reciprocals of 3, 5, 7 and so on from the one before, the first from 0; modulo
/// 2^16.
const CHANGES: [u16; REACH] = {
    let mut changes = [RECIPROCALS[1] as u16; REACH];
    let mut reach = 2;
    while reach <= REACH {
        changes[reach - 1] = (RECIPROCALS[reach] as u16).wrapping_sub(RECIPROCALS[reach - 1] as u16);
        reach += 1;
    }
    changes
};

/// [`Isa::smooth`](crate::matching::backend::Isa::smooth) of at least [`LANES`] answers.
#[inline(always)]
pub(super) fn smooth(
    answers: &mut [Disparity],
    lengths: &mut [u16],
    workspace: &mut [u16],
    step: Disparity,
    radius: u8,
) {
    let width = answers.len();
    // The answers as they were, with none outside.
    let Some(before) = workspace.get_mut(..width + MARGIN) else { return };
    before.fill(Disparity::NONE.raw());
    for (before, answer) in part_mut(before, REACH..REACH + width).iter_mut().zip(answers.iter()) {
        *before = answer.raw();
    }
    count(part(before, REACH..REACH + width), lengths, step);
    // The last group is moved back to end with the row.
    let begins = (0..width / LANES).map(|group| group * LANES).chain(width.checked_sub(LANES));
    for begin in begins {
        let around = before.get(begin..).and_then(|b| b.first_chunk::<{ LANES + MARGIN }>());
        let out = answers.get_mut(begin..).and_then(|a| a.first_chunk_mut::<LANES>());
        if let (Some(around), Some(out)) = (around, out) {
            const USUAL: usize = Checks::DEFAULT.smoothing_radius as usize;
            let averages = match usize::from(radius) {
                USUAL => averaged::<USUAL>(around, step, USUAL),
                radius => averaged::<0>(around, step, radius),
            };
            *out = averages.map(Disparity::from_raw);
        }
    }
}

/// The averages of the answers in the middle. `RADIUS` is the radius where it is known when the crate is
/// compiled, which lets the compiler unroll the pairs; 0 where it is not.
#[inline(always)]
fn averaged<const RADIUS: usize>(
    around: &[u16; LANES + MARGIN],
    step: Disparity,
    radius: usize,
) -> [u16; LANES] {
    let at = |place: usize| {
        around.get(place..).and_then(|a| a.first_chunk::<LANES>()).copied().unwrap_or([0; LANES])
    };
    let centre = at(REACH);
    let (mut left, mut right) = (centre, centre);
    // All ones as long as the pair belongs to the surface.
    let mut joined = [u16::MAX; LANES];
    let (mut sum, mut reciprocal) = ([0u16; LANES], [0u16; LANES]);
    for reach in 1..if RADIUS > 0 { RADIUS } else { REACH } + 1 {
        if RADIUS == 0 && reach > radius {
            break;
        }
        let (new_left, new_right) = (at(REACH - reach), at(REACH + reach));
        let change = CHANGES[reach - 1];
        for i in 0..LANES {
            let goes_on = of_one(left[i], new_left[i], step) & of_one(right[i], new_right[i], step);
            joined[i] &= 0u16.wrapping_sub(u16::from(goes_on));
            let pair = new_left[i].wrapping_add(new_right[i]).wrapping_sub(centre[i].wrapping_mul(2));
            sum[i] = sum[i].wrapping_add(joined[i] & pair);
            reciprocal[i] = reciprocal[i].wrapping_add(joined[i] & change);
        }
        (left, right) = (new_left, new_right);
    }
    let mut out = centre;
    for i in 0..LANES {
        // The product's upper half, rounded by its lower one: half-words stay half-words.
        let product = i32::from(sum[i] as i16) * i32::from(reciprocal[i] as i16);
        let steps = ((product >> 16) as u16).wrapping_add(sum[i].wrapping_mul(reciprocal[i]) >> 15);
        out[i] = centre[i].wrapping_add(steps);
    }
    out
}

/// Of a group and the answer before it: a bit for each that is not of one surface with the one before.
#[inline(always)]
fn ends(group: &[u16; TOGETHER + 1], step: Disparity) -> u64 {
    let mut ends = 0;
    if let Some((before, here)) = group.first_chunk::<TOGETHER>().zip(group.last_chunk::<TOGETHER>()) {
        for i in 0..TOGETHER {
            ends |= u64::from(!of_one(here[i], before[i], step)) << i;
        }
    }
    ends
}

/// For every answer how many its surface has: surface by surface.
#[inline(always)]
fn count(answers: &[u16], lengths: &mut [u16], step: Disparity) {
    let mut begin = 0;
    let mut end_at = |x: usize| {
        let length = x - begin;
        let rest = part_mut(lengths, begin..);
        match rest.first_chunk_mut() {
            // Most are short. What is written beyond the end is of later surfaces, which are written later.
            Some(short) if length <= SHORT => *short = [length as u16; SHORT],
            _ => fill_row(part_mut(rest, ..length), length as u16),
        }
        begin = x;
    };
    let mut groups = answers.windows(TOGETHER + 1).step_by(TOGETHER);
    let mut x = 1;
    while let Some(group) = groups.next().and_then(|group| group.first_chunk()) {
        each(ends(group, step), |place| end_at(x + place));
        x += TOGETHER;
    }
    if let Some(group) = answers.last_chunk() {
        // The last group is moved back to end with the row: what is of groups before is known.
        let known = TOGETHER + x - answers.len();
        let new = ends(group, step).checked_shr(known as u32).unwrap_or(0);
        each(new, |place| end_at(x + place));
    } else {
        for (x, pair) in (1..).zip(answers.windows(2)) {
            if !of_one(pair[1], pair[0], step) {
                end_at(x);
            }
        }
    }
    end_at(answers.len());
}
