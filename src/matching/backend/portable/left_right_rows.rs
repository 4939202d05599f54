//! The left-right check and the sub-pixel fit, pixels side by side, in loops that the compiler turns into
//! vectors: bytes as long as possible.

use super::consistency;
use crate::matching::backend::parameters::MethodParameters;
use crate::matching::backend::work::Rules;
use crate::matching::memory::winners::WinnerRows;
use crate::units::{Disparity, PixelFlags};

/// [`consistency::offer`] of all winners.
#[inline(never)]
pub(in crate::matching::backend) fn offer(costs: &[u8], disparities: &[u8], right: &mut [u16]) {
    let keys = costs.iter().zip(disparities).map(|(&cost, &d)| (u32::from(cost) << 8 | u32::from(d), d));
    consistency::offer(keys, right);
}

/// The pixels of the right image's row that are partners, one for each winner.
#[inline(never)]
pub(in crate::matching::backend) fn partners(disparities: &[u8], of_right: &[u8], partners: &mut [u8]) {
    for (x, (partner, &disparity)) in partners.iter_mut().zip(disparities).enumerate() {
        *partner = of_right.get(x.wrapping_sub(usize::from(disparity))).copied().unwrap_or_default();
    }
}

/// Makes offers of the pixels that are their partners: [`consistency::compared_cost`].
#[inline(always)]
pub(in crate::matching::backend) fn compare(costs: &[u8], left: &[u8], partners: &mut [u8]) {
    for ((partner, &cost), &left) in partners.iter_mut().zip(costs).zip(left) {
        *partner = consistency::compared_cost(cost, left, *partner);
    }
}

/// The disparity that each winner's partner keeps of all offers.
#[inline(never)]
pub(in crate::matching::backend) fn keep(
    winners: &WinnerRows<'_>,
    pixels: Option<[&[u8]; 2]>,
    right: &mut [u16],
    kept: &mut [u8],
) {
    let (costs, disparities) = (&*winners.costs, &*winners.disparities);
    match pixels {
        Some([left, of_right]) => {
            partners(disparities, of_right, kept);
            compare(costs, left, kept);
            offer(kept, disparities, right);
        }
        None => offer(costs, disparities, right),
    }
    for (x, (kept, &disparity)) in kept.iter_mut().zip(disparities).enumerate() {
        *kept = consistency::kept(x, disparity, right);
    }
}

/// The answers and flags of the columns that have a candidate. `fractions` is room for a byte a pixel.
#[inline(always)]
pub(in crate::matching::backend) fn answer<S: MethodParameters>(
    winners: &WinnerRows<'_>,
    kept: &[u8],
    rules: &Rules,
    fractions: &mut [u8],
    answers: &mut [Disparity],
    flags: &mut [PixelFlags],
) {
    let sides = winners.below.iter().zip(&*winners.costs).zip(&*winners.above);
    for (fraction, ((&below, &cost), &above)) in fractions.iter_mut().zip(sides) {
        *fraction = signed_fraction(below - cost, above - cost, S::SLANT_COST);
    }
    let [below, costs, above, disparities] =
        [&*winners.below, &*winners.costs, &*winners.above, &*winners.disparities];
    // Two byte loops: one with all of these rows has more of them than there are registers.
    let partners = disparities.iter().zip(kept);
    let rises = below.iter().zip(costs).zip(above);
    for ((flags, (&disparity, &kept)), ((&below, &cost), &above)) in flags.iter_mut().zip(partners).zip(rises)
    {
        *flags = flags
            .union(consistency::mismatch(disparity, kept, rules.tolerance))
            .union(rules.flat.when((below == cost) & (above == cost)))
            .union(PixelFlags::CEILING.when(disparity == rules.ceiling));
    }
    let parts = disparities.iter().zip(fractions.iter()).zip(flags.iter());
    for (answer, ((&disparity, &fraction), flags)) in answers.iter_mut().zip(parts) {
        let whole = (rules.min_disparity + u16::from(disparity)).wrapping_mul(Disparity::ONE);
        let none = 0u16.wrapping_sub(u16::from(flags.intersects(rules.refused)));
        *answer = Disparity::from_raw(whole.wrapping_add(i16::from(fraction as i8) as u16) | none);
    }
}

/// The fraction of [`super::subpixel::refine`] with its sign, from the rises below and above: a division bit
/// by bit.
#[inline(always)]
fn signed_fraction(below: u8, above: u8, step: u8) -> u8 {
    const { assert!(Disparity::ONE == 32, "half a pixel is four bits and the one for all of it") };
    let steepest = below.max(above).saturating_sub(step).max(below.abs_diff(above)).max(1);
    // The rest is less than what it is divided by, and so is twice the rest less it.
    let mut rest = below.abs_diff(above);
    let all = rest >= steepest;
    let mut fraction = u8::from(all);
    rest = if all { 0 } else { rest };
    for _ in 0..4 {
        let lacks = steepest - rest;
        let enough = rest >= lacks;
        rest = if enough { rest - lacks } else { rest + rest };
        fraction = fraction + fraction + u8::from(enough);
    }
    fraction += u8::from(rest >= steepest - steepest / 2);
    if below < above { 0u8.wrapping_sub(fraction) } else { fraction }
}

#[cfg(test)]
mod tests {
    use super::super::subpixel::refine;
    use super::*;
    use crate::matching::memory::winners::Winner;

    #[test]
    fn all_rises_give_the_fraction_of_the_other_form() {
        for (below, above) in (0..=252).flat_map(|below| (0..=252).map(move |above| (below, above))) {
            for step in [0, 1, 24, 200] {
                let refined = refine(Winner::new(0, 10, (below, above)), 0, u32::from(step)).raw();
                let fraction = i32::from(signed_fraction(below, above, step) as i8);
                assert_eq!(320 + fraction, i32::from(refined), "{below} {above} {step}");
            }
        }
    }
}
