//! Pixels side by side, in loops that the compiler turns into vectors: pair by pair, as far as both are still of the
//! surface.

use super::{MORE, RECIPROCALS, Room, of_one};
use crate::matching::config::Checks;
use crate::units::Disparity;

/// How far the answers around a pixel reach, to each side.
const REACH: usize = MORE / 2;

/// [`super::average`].
#[inline(always)]
pub(super) fn average(answers: &mut [Disparity], lengths: &mut [u16], room: Room<'_>, checks: &Checks) {
    let width = answers.len();
    let step = checks.surface_step;
    // The answers as they were, with none outside.
    let Some(before) = room.large.get_mut(..width + MORE) else { return };
    before.fill(Disparity::NONE.raw());
    for (before, answer) in before.iter_mut().skip(REACH).zip(answers.iter()) {
        *before = answer.raw();
    }
    let from = |place: usize| before.get(place..).unwrap_or(&[]);
    count(from(REACH), lengths, step);
    if checks.smoothing_radius == 0 {
        return;
    }
    let [reaches, sums] = room.small;
    for distance in 1..=usize::from(checks.smoothing_radius).min(REACH) {
        let left = [from(REACH + 1 - distance), from(REACH - distance)];
        let right = [from(REACH - 1 + distance), from(REACH + distance)];
        if distance == 1 {
            add_pairs::<true>(1, left, from(REACH), right, step, reaches, sums);
        } else {
            add_pairs::<false>(distance as u16, left, from(REACH), right, step, reaches, sums);
        }
    }
    divide(answers, reaches, sums);
}

/// By how much the reciprocals of 3, 5, 7 and so on differ from the one before, the first from 0; modulo 2^16.
const CHANGES: [u16; REACH] = {
    let mut changes = [RECIPROCALS[1] as u16; REACH];
    let mut reach = 2;
    while reach <= REACH {
        changes[reach - 1] = (RECIPROCALS[reach] as u16).wrapping_sub(RECIPROCALS[reach - 1] as u16);
        reach += 1;
    }
    changes
};

/// Adds to every answer what it differs by from the average.
#[cfg_attr(stereopsis_vectors, inline(never))]
#[cfg_attr(not(stereopsis_vectors), inline(always))]
fn divide(answers: &mut [Disparity], reaches: &mut [u16], sums: &[u16]) {
    // The reciprocals in a loop of their own, with nothing in it that is no half-word. Of an answer alone the sum is
    // nothing, and so its reciprocal may be.
    for reach in reaches.iter_mut() {
        let mut reciprocal = 0u16;
        for (distance, &change) in (1..).zip(&CHANGES) {
            reciprocal = reciprocal.wrapping_add(change & 0u16.wrapping_sub(u16::from(*reach >= distance)));
        }
        *reach = reciprocal;
    }
    for (answer, (&reciprocal, &sum)) in answers.iter_mut().zip(reaches.iter().zip(sums)) {
        let steps = (i32::from(sum as i16) * i32::from(reciprocal as i16) + (1 << 15)) >> 16;
        *answer = Disparity::from_raw(answer.raw().wrapping_add(steps as u16));
    }
}

/// Adds what the pair at a `distance` differs by from the centre, and one to the reach, where all pairs before are of the
/// surface and this one is; the `FIRST` finds nothing to add to. Of the sides the answers one nearer, and those at the
/// distance.
#[cfg_attr(stereopsis_vectors, inline(never))]
#[cfg_attr(not(stereopsis_vectors), inline(always))]
fn add_pairs<const FIRST: bool>(
    distance: u16,
    left: [&[u16]; 2],
    centre: &[u16],
    right: [&[u16]; 2],
    step: Disparity,
    reaches: &mut [u16],
    sums: &mut [u16],
) {
    let left = left[0].iter().zip(left[1]);
    let right = right[0].iter().zip(right[1]);
    for (((reach, sum), centre), (left, right)) in reaches.iter_mut().zip(sums).zip(centre).zip(left.zip(right)) {
        (*reach, *sum) = if FIRST { (0, 0) } else { (*reach, *sum) };
        let goes_on = of_one(*left.0, *left.1, step) & of_one(*right.0, *right.1, step) & (*reach + 1 == distance);
        let differences = left.1.wrapping_add(*right.1).wrapping_sub(centre.wrapping_mul(2));
        *reach = if goes_on { distance } else { *reach };
        *sum = if goes_on { sum.wrapping_add(differences) } else { *sum };
    }
}

/// For every answer how many its surface has.
#[inline(never)]
fn count(answers: &[u16], lengths: &mut [u16], step: Disparity) {
    let Some((&(mut before), _)) = answers.split_first() else { return };
    let mut length = 0u16;
    for (&here, out) in answers.iter().zip(lengths.iter_mut()) {
        let joined = of_one(here, before, step);
        length = (length & 0u16.wrapping_sub(u16::from(joined))) + 1;
        before = here;
        *out = length;
    }
    // The first of the next surface has the length 1.
    let (mut whole, mut next) = (0, 1);
    for length in lengths.iter_mut().rev() {
        whole = if next > 1 { whole } else { *length };
        next = *length;
        *length = whole;
    }
}
