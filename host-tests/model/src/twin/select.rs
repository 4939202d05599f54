//! Which disparity wins at a pixel, and what is to be said about it.

use super::cost::Volume;
use super::{Cost, Method, Picture};
use stereopsis::imaging::Noise;
use stereopsis::matching::{Checks, Config, WinnerRecord};
use stereopsis::units::{Disparity, PixelFlags};

/// The best candidate of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Winner {
    /// Disparity less the smallest one searched, px.
    d: usize,
    /// Its cost.
    cost: u16,
}

/// The answers and flags of row `y`, before smoothing and the speckle filter, and the margins of its winners.
pub(super) fn select_row(
    scheme: &Method,
    config: &Config,
    pair: [&Picture<'_>; 2],
    sums: &Volume,
    y: usize,
) -> (Vec<Disparity>, Vec<PixelFlags>, Vec<u16>) {
    let smallest = usize::from(config.min_disparity);
    let checks = &config.checks;
    // Candidates are the disparities whose partner lies inside the right picture.
    let candidates = |x: usize| {
        let most = if x >= smallest { (x - smallest + 1).min(sums.disparities) } else { 0 };
        &sums.at(x, y)[..most]
    };
    let winners: Vec<Option<Winner>> = (0..sums.width).map(|x| winner(candidates(x))).collect();
    let held =
        held_by_right_columns(&winners, |x, winner| offer(scheme, config, pair, (x, y), winner), smallest);

    let mut disparities = vec![Disparity::NONE; sums.width];
    let mut flags = vec![PixelFlags::CLEAR; sums.width];
    let mut margins = vec![0; sums.width];
    for x in 0..sums.width {
        let Some(best) = winners[x] else {
            flags[x] = PixelFlags::OUTSIDE;
            continue;
        };
        margins[x] = margin(candidates(x), best);
        let mut refused = false;
        let mut say = |flag: PixelFlags, refuses: bool| {
            flags[x] = flags[x].union(flag);
            refused |= refuses;
        };
        if best.d + 1 == sums.disparities {
            say(PixelFlags::CEILING, checks.refuse_ceiling);
        }
        if checks.uniqueness_percent.is_some_and(|percent| ambiguous(candidates(x), best, percent)) {
            say(PixelFlags::AMBIGUOUS, true);
        }
        if untextured(scheme, checks, pair[0], x, y) || checks.refuse_flat && flat(candidates(x), best) {
            say(PixelFlags::UNTEXTURED, true);
        }
        if let Some(most) = checks.left_right_px {
            let kept = held[x - smallest - best.d].expect("this pixel has offered itself");
            if kept.d.abs_diff(best.d) > usize::from(most) {
                say(PixelFlags::MISMATCH, true);
            }
        }
        // An end of the candidates, too, because the right picture ends there.
        if !refused && x - smallest == best.d {
            flags[x] = flags[x].union(PixelFlags::CEILING);
            refused |= checks.refuse_ceiling;
        }
        if !refused {
            let steps = (smallest + best.d) as i32 * 32 + fraction(scheme, candidates(x), best);
            disparities[x] = Disparity::from_raw(steps as u16);
        }
    }
    (disparities, flags, margins)
}

/// The winners of row `y` as records, with what their partners keep; zero where there is no candidate.
pub(super) fn records(
    scheme: &Method,
    config: &Config,
    pair: [&Picture<'_>; 2],
    sums: &Volume,
    y: usize,
) -> Vec<WinnerRecord> {
    let smallest = usize::from(config.min_disparity);
    let candidates = |x: usize| {
        let most = if x >= smallest { (x - smallest + 1).min(sums.disparities) } else { 0 };
        &sums.at(x, y)[..most]
    };
    let winners: Vec<Option<Winner>> = (0..sums.width).map(|x| winner(candidates(x))).collect();
    let held =
        held_by_right_columns(&winners, |x, winner| offer(scheme, config, pair, (x, y), winner), smallest);
    let record = |(x, winner): (usize, &Option<Winner>)| {
        let Some(best) = winner else { return WinnerRecord::ZERO.sealed(y as u16) };
        let costs = candidates(x);
        let [below, above] = [best.d.checked_sub(1), Some(best.d + 1)].map(|d| Some(*costs.get(d?)?));
        let beside = [below.or(above), above.or(below)].map(|cost| cost.unwrap_or(best.cost) as u8);
        let others = costs.iter().enumerate().filter(|&(d, _)| d.abs_diff(best.d) > 2);
        let second = others.map(|(_, &cost)| cost).min().unwrap_or(255);
        let kept = held[x - smallest - best.d].expect("this pixel has offered itself");
        let record = WinnerRecord::new(best.d as u8, best.cost as u8, beside);
        record.with_kept(kept.d as u8).with_second(second as u8).sealed(y as u16)
    };
    winners.iter().enumerate().map(record).collect()
}

/// The cheapest candidate; the smallest disparity among equals.
fn winner(candidates: &[u16]) -> Option<Winner> {
    let cost = *candidates.iter().min()?;
    let d = candidates.iter().position(|&c| c == cost)?;
    Some(Winner { d, cost })
}

/// What the winner of the pixel (x, y) offers its partner: its cost, and of a method along paths four times
/// what the two pixels differ by, as long as a row below tells both; at most 255.
fn offer(
    scheme: &Method,
    config: &Config,
    pair: [&Picture<'_>; 2],
    (x, y): (usize, usize),
    winner: Winner,
) -> u16 {
    let [left, right] = pair;
    let smallest = usize::from(config.min_disparity);
    let is_quiet = config.noise == Noise::None;
    let is_compared =
        is_quiet && matches!(scheme.cost, Cost::Paths { .. }) && y + scheme.radius_y < left.height;
    let partner = x - smallest - winner.d;
    let apart = left.at(x as isize, y as isize).abs_diff(right.at(partner as isize, y as isize));
    if is_compared { (winner.cost + 4 * u16::from(apart)).min(255) } else { winner.cost }
}

/// What every right column holds after the left pixels, in order, have offered their winners: the cheapest
/// offer, the first among equals.
fn held_by_right_columns(
    winners: &[Option<Winner>],
    offer: impl Fn(usize, Winner) -> u16,
    smallest: usize,
) -> Vec<Option<Winner>> {
    let mut held: Vec<Option<(u16, Winner)>> = vec![None; winners.len()];
    for (x, winner) in winners.iter().enumerate() {
        if let Some(winner) = *winner {
            let cost = offer(x, winner);
            let holder = &mut held[x - smallest - winner.d];
            if holder.is_none_or(|(held, _)| cost < held) {
                *holder = Some((cost, winner));
            }
        }
    }
    held.into_iter().map(|held| Some(held?.1)).collect()
}

/// Steps of 1/32 px from the winner to the tip of the two equally steep lines through its cost and its
/// neighbours'.
fn fraction(scheme: &Method, candidates: &[u16], best: Winner) -> i32 {
    if best.d == 0 || best.d + 1 >= candidates.len() {
        return 0;
    }
    let before = i32::from(candidates[best.d - 1]) - i32::from(best.cost);
    let after = i32::from(candidates[best.d + 1]) - i32::from(best.cost);
    let steepest = (before.max(after) - scheme.step).max((before - after).abs());
    if steepest == 0 {
        return 0;
    }
    let magnitude = ((before - after).abs() * 16 + steepest / 2) / steepest;
    if before > after { magnitude } else { -magnitude }
}

/// Whether a candidate more than 2 px from the winner costs no more than the winner and the margin allow.
/// What is cut off at 255 may cost any more.
fn ambiguous(candidates: &[u16], best: Winner, percent: u8) -> bool {
    let others = candidates.iter().enumerate().filter(|&(d, _)| d.abs_diff(best.d) > 2);
    let second = others.map(|(_, &cost)| u32::from(cost)).filter(|&cost| cost < 255).min();
    second.is_some_and(|second| second * (100 - u32::from(percent)) <= u32::from(best.cost) * 100)
}

/// How much more the cheapest of the candidates over 2 px from the winner costs; 0 where there are so few of
/// them that there might be none.
fn margin(candidates: &[u16], best: Winner) -> u16 {
    if candidates.len() <= 5 {
        return 0;
    }
    let others = candidates.iter().enumerate().filter(|&(d, _)| d.abs_diff(best.d) > 2);
    others.map(|(_, &cost)| cost).min().expect("of six one is over 2 px away") - best.cost
}

/// Whether the candidates beside the winner, as far as there are any, cost no more than the winner.
fn flat(candidates: &[u16], best: Winner) -> bool {
    let beside = best.d.saturating_sub(1)..candidates.len().min(best.d + 2);
    candidates[beside].iter().all(|&cost| cost == best.cost)
}

/// Whether too few pixels of the window have a gradient along the row.
fn untextured(scheme: &Method, checks: &Checks, left: &Picture<'_>, x: usize, y: usize) -> bool {
    if checks.texture_pixels == 0 {
        return false;
    }
    let mut textured = 0;
    for row in y.saturating_sub(scheme.radius_y)..left.height.min(y + scheme.radius_y + 1) {
        for column in x.saturating_sub(scheme.radius_x)..left.width.min(x + scheme.radius_x + 1) {
            let (row, column) = (row as isize, column as isize);
            if left.at(column + 1, row).abs_diff(left.at(column - 1, row)) >= checks.texture_gradient {
                textured += 1;
            }
        }
    }
    textured < u32::from(checks.texture_pixels)
}
