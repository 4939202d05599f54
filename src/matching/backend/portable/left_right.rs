//! The left-right check and the sub-pixel fit, pixel by pixel.

use super::{consistency, subpixel};
use crate::matching::backend::loops::{fill_row, keep_loop, keep_scalar_loop};
use crate::matching::backend::parameters::MethodParameters;
use crate::matching::backend::work::{AnswerWork, Rules};
use crate::matching::memory::record::WinnerRecord;
use crate::matching::memory::slices::part;
use crate::matching::memory::winners::Winner;
use crate::units::{Disparity, PixelFlags};

/// Makes answers of a row of winners: [`Isa::left_right`](crate::matching::backend::Isa::left_right).
#[inline(always)]
pub(in crate::matching::backend) fn left_right<S: MethodParameters>(work: AnswerWork<'_>) {
    let AnswerWork { winners, right, begin, pixels, rules, answers, flags, .. } = work;
    let winners = part(winners.words(), begin..);
    match pixels {
        Some(pixels) => offer_compared(winners, pixels, right),
        None => offer(winners, right),
    }
    answer::<S>(winners, right, rules, answers, flags);
}

/// [`consistency::offer`] of all winners.
#[inline(never)]
fn offer(winners: &[Winner], right: &mut [u16]) {
    consistency::offer(winners.iter().map(|winner| (winner.key(), winner.disparity() as u8)), right);
}

/// [`offer`] of winners that cost what their pixels differ by as well.
#[inline(never)]
fn offer_compared(winners: &[Winner], [left, of_right]: [&[u8]; 2], right: &mut [u16]) {
    let count = of_right.len().min(right.len());
    let (Some(of_right), Some(right)) = (of_right.get(..count), right.get_mut(..count)) else { return };
    fill_row(right, u16::MAX);
    for (x, (winner, &left)) in winners.iter().zip(left).enumerate() {
        keep_loop();
        let disparity = winner.disparity();
        let partner = x.wrapping_sub(disparity as usize);
        if let (Some(kept), Some(&partner)) = (right.get_mut(partner), of_right.get(partner)) {
            let [_, _, cost, _] = winner.key().to_be_bytes();
            let offer = u32::from(consistency::compared_cost(cost, left, partner)) << 8 | disparity;
            if offer < u32::from(*kept) {
                *kept = offer as u16;
            }
        }
    }
}

/// The answers and flags of the columns that have a candidate.
#[inline(never)]
pub(in crate::matching::backend) fn answer<S: MethodParameters>(
    winners: &[Winner],
    right: &[u16],
    rules: &Rules,
    answers: &mut [Disparity],
    flags: &mut [PixelFlags],
) {
    for (x, ((answer, flags), &winner)) in answers.iter_mut().zip(flags).zip(winners).enumerate() {
        keep_scalar_loop();
        let kept = consistency::kept(x, winner.disparity() as u8, right);
        (*answer, *flags) = answer_of::<S>(winner, kept, *flags, rules);
    }
}

/// The answers and flags of winners that were computed elsewhere, each with what its partner keeps.
#[inline(never)]
pub(in crate::matching) fn answer_records<S: MethodParameters>(
    records: &[WinnerRecord],
    rules: &Rules,
    answers: &mut [Disparity],
    flags: &mut [PixelFlags],
) {
    for ((answer, flags), &record) in answers.iter_mut().zip(flags).zip(records) {
        keep_loop();
        (*answer, *flags) = answer_of::<S>(record.winner(), record.kept(), *flags, rules);
    }
}

/// The answer of a winner whose partner keeps `kept`, and its flags beside those that it has.
#[inline(always)]
fn answer_of<S: MethodParameters>(
    winner: Winner,
    kept: u8,
    flags: PixelFlags,
    rules: &Rules,
) -> (Disparity, PixelFlags) {
    let disparity = winner.disparity() as u8;
    let said = flags
        .union(consistency::mismatch(disparity, kept, rules.tolerance))
        .union(rules.flat.when(winner.rises() == (0, 0)))
        .union(PixelFlags::CEILING.when(disparity == rules.ceiling));
    let none = 0u16.wrapping_sub(u16::from(said.intersects(rules.refused)));
    let answer = subpixel::refine(winner, u32::from(rules.min_disparity), u32::from(S::SLANT_COST));
    (Disparity::from_raw(answer.raw() | none), said)
}
