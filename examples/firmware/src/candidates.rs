//! What a pixel's candidates cost, and what a path brings to the next pixel: the equations of `docs/bits.md`,
//! column by column.

use crate::choice::{DISPARITIES, METHOD, NOISE, ROOM};
use stereopsis::imaging::Noise;
use stereopsis::matching::Penalties;

pub(crate) const LANES: usize = DISPARITIES as usize;
/// A byte for each candidate of a column.
pub(crate) type Column = [u8; LANES];
/// Five lines around a row.
pub(crate) type Lines<'a> = [&'a [u8]; 5];

pub(crate) const NAME: &[u8] = METHOD.as_bytes();
pub(crate) const ALONG_PATHS: bool = NAME[0] == b's';
pub(crate) const BETWEEN_PIXELS: bool = NAME.len() != 8 || NAME[4] != b'l';
/// Columns that have more than a code.
pub(crate) const WALKED: usize = if ALONG_PATHS { ROOM } else { 1 };

/// What methods along paths compare beside codes.
#[derive(Clone, Copy)]
pub(crate) struct Feature {
    pub(crate) along: u8,
    pub(crate) across: u8,
    pub(crate) bright: u8,
}

/// A row's codes and features.
pub(crate) struct Looks {
    pub(crate) codes: [u8; ROOM],
    pub(crate) features: [Feature; WALKED],
}

pub(crate) const NOTHING: Feature = Feature { along: 0, across: 0, bright: 0 };
pub(crate) const NO_LOOKS: Looks = Looks { codes: [0; ROOM], features: [NOTHING; WALKED] };

/// The pixel in column `x` of a line, or the nearest one inside it.
pub(crate) fn pixel(line: &[u8], x: usize, width: usize) -> u8 {
    line.get(x.min(width - 1)).copied().unwrap_or(0)
}

pub(crate) fn at(column: &Column, d: usize) -> u8 {
    column.get(d).copied().unwrap_or(u8::MAX)
}

pub(crate) fn sum(a: &Column, b: &Column) -> Column {
    core::array::from_fn(|d| at(a, d).saturating_add(at(b, d)))
}

/// Sobel's gradients along and across the line, shifted by the noise, cut off and counted from 0; and half
/// the brightness.
pub(crate) fn feature(lines: &Lines<'_>, x: usize, width: usize, most: u8) -> Feature {
    let most = i16::from(most);
    let shift = match NOISE {
        Noise::None => 0,
        Noise::Low => 1,
        Noise::High => 2,
    };
    let cut = |gradient: i16| ((gradient >> shift).clamp(-most, most) + most) as u8;
    let [_, above, here, below, _] = lines;
    let of = |line: &[u8], x: usize| i16::from(pixel(line, x, width));
    let (before, after) = (x.saturating_sub(1), x + 1);
    let down = |x: usize| of(above, x) + 2 * of(here, x) + of(below, x);
    let along = |line: &[u8]| of(line, before) + 2 * of(line, x) + of(line, after);
    Feature {
        along: cut(down(after) - down(before)),
        across: cut(along(below) - along(above)),
        bright: pixel(here, x, width) / 2,
    }
}

/// What each candidate of column `x` costs by itself.
pub(crate) fn costs(looks: Option<&[Looks; 2]>, x: usize, width: usize, penalties: &Penalties) -> Column {
    let Some([left, right]) = looks else { return [0; LANES] };
    let of = |looks: &Looks, x: usize| looks.features.get(x.min(width - 1)).copied().unwrap_or(NOTHING);
    let here = of(left, x);
    core::array::from_fn(|d| {
        let partner = x.saturating_sub(d);
        let bits = pixel(&left.codes, x, width) ^ pixel(&right.codes, partner, width);
        let bits = bits.count_ones() as u8;
        if !ALONG_PATHS {
            return bits;
        }
        let there = of(right, partner);
        let along = if BETWEEN_PIXELS {
            let beside = [partner.saturating_sub(1), partner + 1];
            let [before, after] = beside.map(|x| of(right, x).along.midpoint(there.along));
            let (least, most) = (before.min(after).min(there.along), before.max(after).max(there.along));
            here.along.saturating_sub(most).max(least.saturating_sub(here.along))
        } else {
            here.along.abs_diff(there.along)
        };
        let rest = here.across.abs_diff(there.across) + here.bright.abs_diff(there.bright) / 4 + bits;
        penalties.cost.min(2 * along + rest)
    })
}

/// What a path with these costs brings to the next pixel, where the brightness changes so much.
pub(crate) fn message(path: &Column, change: u8, penalties: &Penalties) -> Column {
    let Penalties { step: [step, small_step], jump: [little, more, much], edges: [edge, large_edge], .. } =
        *penalties;
    let (step, jump) = match change {
        change if change < edge => (step, little),
        change if change < large_edge => (small_step, more),
        _ => (small_step, much),
    };
    let least = path.iter().copied().min().unwrap_or(0);
    core::array::from_fn(|d| {
        let beside = at(path, d.wrapping_sub(1)).min(at(path, d + 1)).saturating_add(step);
        at(path, d).min(beside).min(least.saturating_add(jump)).saturating_sub(least)
    })
}
