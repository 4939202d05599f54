//! Rounds in plain Rust.

use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::quarters::columns::FOUR;
use crate::matching::backend::portable::sgm::quarters::lanes::{
    AGO, NO_SUM, ONES, TOP, average, least_of_four, lesser, over, splat, up_to_top,
};
use crate::matching::backend::portable::sgm::quarters::others::{Costs, Others};
use crate::matching::backend::portable::sgm::quarters::steps::{Change, Steps, beside};
use crate::matching::backend::portable::words::below_tops;
use crate::matching::memory::slices::{chunks_mut, part};
use crate::matching::memory::views::view;
use crate::matching::memory::winners::Found;
use core::cell::Cell;

/// What a pixel of the left image looks like, four times. What is marked is no less than what it is compared
/// with.
struct Pixel {
    along: u32,
    across: u32,
    census: u32,
    brightness: u32,
    most: u32,
}

/// Averages the agreements of the pixels from `x` on into their columns; within edges puts them there. A
/// pixel's `others` begin one after those of the pixel before.
#[inline(always)]
pub fn enter<S: SgmParameters, const WORDS: usize, const ALL: bool>(
    costs: &Costs<'_>,
    x: usize,
    others: &[Others],
    columns: &mut [u32],
) {
    let Costs { left, rounds, most, margin } = *costs;
    let [along, across, census, brightness] =
        [left.along, left.across, left.census, left.brightness].map(|row| part(row, x..));
    let pixels = along.iter().zip(across).zip(census.iter().zip(brightness));
    let columns = chunks_mut(columns, FOUR * rounds);
    for (i, (((&along, &across), (&census, &brightness)), column)) in pixels.zip(columns).enumerate() {
        let pixel = Pixel {
            along: splat(along.into()),
            across: splat(across.into()) | TOP,
            census: splat(census.into()),
            brightness: splat((brightness >> 1).into()) | TOP,
            most,
        };
        let others = part(others, i..i + FOUR * rounds).as_chunks::<FOUR>().0;
        for (cells, others) in column.as_chunks_mut::<FOUR>().0.iter_mut().zip(others) {
            keep_loop();
            for (cell, others) in cells.iter_mut().zip(others) {
                let agreement = agreement(&pixel, others) + margin;
                *cell = if S::WITHIN_EDGES { agreement } else { average(*cell, agreement) };
            }
        }
    }
}

/// By how much four candidates cost less than the most.
#[inline(always)]
fn agreement(pixel: &Pixel, others: &Others) -> u32 {
    let [least, greatest, across, census, brightness] = *others;
    // One of the two is 0: the gradient is below the least or above the greatest, or neither.
    let along = over(least.wrapping_sub(pixel.along)) | over(greatest.wrapping_add(pixel.along));
    // How far numbers are apart is twice what the first is over the second, less their difference.
    let across = pixel.across.wrapping_sub(across);
    let brightness = pixel.brightness.wrapping_sub(brightness);
    let brightness = (over(brightness) << 1).wrapping_sub(brightness).wrapping_add(TOP);
    let twice = along.wrapping_add(over(across));
    let rest = (brightness >> 2 & 0x3f3f_3f3f).wrapping_add(ones(pixel.census ^ census));
    over(pixel.most.wrapping_sub(twice << 1).wrapping_add(across).wrapping_sub(rest))
}

/// How many bits of each byte are set.
#[inline(always)]
fn ones(bits: u32) -> u32 {
    let pairs = bits - (bits >> 1 & 0x5555_5555);
    let fours = (pairs & 0x3333_3333) + (pairs >> 2 & 0x3333_3333);
    (fours + (fours >> 4)) & 0x0f0f_0f0f
}

/// Takes a path along the row: from a column into another one, or into the same, of a pixel that has these
/// costs, where the brightness changes by so much. Returns the least of the path, whose `least` is handed in,
/// and what a jump costs.
#[inline(always)]
pub fn along(
    steps: &Steps,
    (change, least): (u8, u32),
    costs: &[u32],
    from: &[Cell<u32>],
    to: &[Cell<u32>],
) -> (u32, u32) {
    let change = steps.of(change);
    let mut marked = u32::MAX;
    let with = costs.as_chunks().0.iter().zip(to.as_chunks().0);
    let with = with.map(|([a, b, c, d], [e, f, g, h])| [(a, e), (b, f), (c, g), (d, h)]);
    through(steps.far, change, least, from, with, |(cost, to), come| {
        let path = come.wrapping_sub(*cost);
        to.set(path);
        marked = lesser(marked, path);
    });
    // Else the compiler finds the least only where it is needed, of words put away for it.
    (least_of_four(core::hint::black_box(marked)), change.jump)
}

/// Averages two columns into one, which may be one of them. Returns the least of it.
#[inline(always)]
pub fn average_two([one, other]: [&[Cell<u32>]; 2], to: &[Cell<u32>]) -> u32 {
    let mut marked = u32::MAX;
    let fours = one.as_chunks::<FOUR>().0.iter().zip(other.as_chunks::<FOUR>().0);
    for (cells, (one, other)) in to.as_chunks::<FOUR>().0.iter().zip(fours) {
        keep_loop();
        for (cell, (one, other)) in cells.iter().zip(one.iter().zip(other)) {
            let between = average(one.get(), other.get());
            cell.set(between);
            marked = lesser(marked, between);
        }
    }
    least_of_four(marked)
}

/// Takes the path from above, which is there and whose `least` is handed in, to a pixel that has these costs,
/// where the brightness changes by so much, and adds it to the sums.
#[inline(always)]
pub fn down(
    steps: &Steps,
    (change, least): (u8, u32),
    costs: &[u32],
    path: &[Cell<u32>],
    sums: &[Cell<u32>],
) {
    let change = steps.of(change);
    let base = steps.base.wrapping_add(splat(change.jump));
    let with = costs.as_chunks().0.iter().zip(path.as_chunks().0.iter().zip(sums.as_chunks().0));
    let with =
        with.map(|([a, b, c, d], ([e, f, g, h], [i, j, k, l]))| [(a, e, i), (b, f, j), (c, g, k), (d, h, l)]);
    through(steps.far, change, least, path, with, |(cost, to, sum), come| {
        let path = come.wrapping_add(base).wrapping_sub(*cost);
        to.set(path);
        sum.set(sum.get().wrapping_add(path));
    });
}

/// Gives what it costs to come to the candidates of each word of a path's column, with the numbers that are
/// handed on for it: 128 from the least cost by a jump, by as much less as it is to come from near.
#[inline(always)]
fn through<T: Copy>(
    far: u32,
    change: Change,
    least: u32,
    column: &[Cell<u32>],
    with: impl Iterator<Item = [T; FOUR]>,
    mut put: impl FnMut(T, u32),
) {
    let (step, bound) = (change.step, splat(least + change.jump));
    let [mut before, behind] = beside(column, far);
    let mut here = column.first().map_or(0, Cell::get);
    let mut come = |next: u32| {
        let near = lesser(lesser(before, next) + step, here);
        (before, here) = (here | TOP, next);
        up_to_top(near.wrapping_sub(bound))
    };
    let fours = column.as_chunks::<FOUR>().0;
    for (number, ([_, b, c, d], with)) in fours.iter().zip(with).enumerate() {
        keep_loop();
        let [of_a, of_b, of_c, of_d] = with;
        put(of_a, come(b.get()));
        put(of_b, come(c.get()));
        put(of_c, come(d.get()));
        let next = fours.get(number + 1).map_or(behind, |[next, ..]| next.get());
        put(of_d, come(next));
    }
}

/// The even bytes of a word, or of one moved down by a byte the odd ones.
const HALVES: u32 = 0x00ff_00ff;
/// The winner of a path's column and of the sums of the two others, of so many candidates, which stand last;
/// all others cost more. Sums are `more` than what they say of costs. Of equal ones the smallest disparity is
/// taken, which comes last.
#[inline(always)]
pub fn winner(columns: [&[u32]; 2], candidates: usize, more: u32) -> Found {
    // The top bit of each half.
    const TOP: u32 = 0x8000_8000;
    let [path, sums] = columns.map(|column| column.as_chunks::<FOUR>().0);
    let (mut even, mut odd) = (NO_SUM, NO_SUM);
    // The lesser of the least sum so far, which is one word older, and one of this word.
    let lesser = |least: u32, sum: u32| {
        let least = least + ONES;
        let difference = least.wrapping_sub(sum);
        least - (difference & below_tops::<15>(difference & TOP))
    };
    for (path, sums) in path.iter().zip(sums) {
        keep_loop();
        for (&path, &sum) in path.iter().zip(sums) {
            even = lesser(even, ((path & HALVES) + (sum & HALVES)) << AGO);
            odd = lesser(odd, ((path & !HALVES) >> (8 - AGO)) + ((sum & !HALVES) >> (8 - AGO)));
        }
    }
    found([even, odd], columns, candidates, more)
}

/// The winner, given the least sums of the even and of the odd lanes, each above the number of words behind
/// it.
#[inline(always)]
fn found([even, odd]: [u32; 2], columns: [&[u32]; 2], candidates: usize, more: u32) -> Found {
    let [path, sums] = columns.map(view::<u32, u8>);
    let count = columns[0].len();
    // Of equal sums the last lane's is the one of the smallest disparity.
    let (mut least, mut behind) = (odd >> 16, 0);
    for (before, half) in [(1, even >> 16), (2, odd & 0xffff), (3, even & 0xffff)] {
        if half < least & !((1 << AGO) - 1) {
            (least, behind) = (half, before);
        }
    }
    let ago = (least & ((1 << AGO) - 1)) as usize;
    let disparity = behind * count + ago;
    // Where it stands in a column, and how far the next lane's first candidate is from a lane's last.
    let last = count.wrapping_sub(1);
    let place = last.wrapping_sub(ago).wrapping_mul(4).wrapping_add(3 - behind);
    let across = last.wrapping_mul(4).wrapping_sub(1);
    let above = if ago == last { place.wrapping_add(across) } else { place.wrapping_sub(4) };
    let below = if ago == 0 { place.wrapping_sub(across) } else { place.wrapping_add(4) };
    let cost = |sum: u32| (sum.wrapping_sub(more) as i32).min(255) as u8;
    let here = cost(least >> AGO & 0x1ff);
    let at = |place: usize| {
        let [path, sums] = [path, sums].map(|bytes| bytes.get(place).copied().unwrap_or(0));
        cost(u32::from(path) + u32::from(sums))
    };
    let (has_below, has_above) = (disparity > 0, disparity + 1 < candidates);
    let beside = match (has_below, has_above) {
        (true, true) => (at(below), at(above)),
        (false, false) => (here, here),
        (has_below, _) => {
            let one = at(if has_below { below } else { above });
            (one, one)
        }
    };
    Found { disparity: disparity as u8, cost: here, beside }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_of_bytes() {
        for (a, b) in (0..256u32).flat_map(|a| (0..256u32).map(move |b| (a, b))) {
            let expected = a.count_ones() << 24 | b.count_ones() << 16 | 8 << 8;
            assert_eq!(ones(a << 24 | b << 16 | 0xff00), expected, "{a} {b}");
        }
    }

    /// Numbers of seven bits, and gradients that stand between a least and a greatest one.
    #[test]
    fn agreements_are_those_of_the_definition() {
        for (a, b) in (0..128u32).flat_map(|a| (0..128).map(move |b| (a, b))) {
            let [low, high] = [b.min(a ^ 5).min(20), b.clamp(20, 30)];
            let along = a % 41;
            let pixel = Pixel {
                along: splat(along),
                across: splat(a) | TOP,
                census: splat(a),
                brightness: splat(b) | TOP,
                most: splat(127),
            };
            let others = [
                splat(low) | TOP,
                splat(128 - high),
                splat(b) & 0xff | splat(a) & 0xff00 | splat(b) & 0xffff_0000,
                splat(2 * b),
                splat(a),
            ];
            let expected = |across: u32| {
                let rest = low.saturating_sub(along).max(along.saturating_sub(high));
                let cost = 2 * rest + a.abs_diff(across) + a.abs_diff(b) / 4 + (a ^ (2 * b)).count_ones();
                127u32.saturating_sub(cost)
            };
            let [same, other] = [a, b].map(expected);
            let expected = u32::from_le_bytes([other, same, other, other].map(|cost| cost as u8));
            assert_eq!(agreement(&pixel, &others), expected, "{a} {b}");
        }
    }
}
