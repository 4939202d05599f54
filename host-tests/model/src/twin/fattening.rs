//! Answers refused that spread from a near surface over a place without edges.

use super::Picture;
use stereopsis::imaging::Noise;
use stereopsis::matching::Config;
use stereopsis::units::{Disparity, PixelFlags};

/// Whether a pixel is an edge: by Sobel's gradient along the row, in eighths of a grey level per pixel.
pub(super) fn is_edge(config: &Config, left: &Picture<'_>, x: usize, y: usize) -> bool {
    let (x, y) = (x as isize, y as isize);
    let difference = |y: isize| i32::from(left.at(x + 1, y)) - i32::from(left.at(x - 1, y));
    let gradient = difference(y - 1) + 2 * difference(y) + difference(y + 1);
    gradient.abs() >= least_gradient(config)
}

/// The least gradient of an edge, in eighths of a grey level per pixel.
pub(super) fn least_gradient(config: &Config) -> i32 {
    match config.noise {
        Noise::None => 16,
        Noise::Low => 24,
        Noise::High => 48,
    }
}

/// One pass along the row: its answers in the order of the pass, each with whether an edge is crossed on the
/// way to it. Says which are nearer than one before them by over 2 px and the slope for every pixel.
fn pass(slope: i64, row: impl Iterator<Item = (Disparity, bool)>) -> Vec<bool> {
    let mut since_edge: Vec<(usize, i64)> = Vec::new();
    let mut refused = Vec::new();
    for (i, (answer, crosses_edge)) in row.enumerate() {
        if crosses_edge {
            since_edge.clear();
        }
        let here = i64::from(answer.raw());
        let allowed = |&(from, there): &(usize, i64)| here <= there + 64 + slope * (i - from - 1) as i64;
        refused.push(answer.is_some() && !since_edge.iter().all(allowed));
        if answer.is_some() {
            since_edge.push((i, here));
        }
    }
    refused
}

/// The answers and flags of row `y` without those that either pass refuses.
pub(super) fn refuse(
    config: &Config,
    left: &Picture<'_>,
    y: usize,
    mut answers: Vec<Disparity>,
    mut flags: Vec<PixelFlags>,
) -> (Vec<Disparity>, Vec<PixelFlags>) {
    if config.checks.fattening_slope.is_none() {
        return (answers, flags);
    }
    let slope = i64::from(config.checks.fattening_slope.raw());
    let edges: Vec<bool> = (0..answers.len()).map(|x| is_edge(config, left, x, y)).collect();
    let to_right = pass(slope, answers.iter().copied().zip(edges.iter().copied()));
    // On the way back the edge of the pixel before lies between.
    let before = core::iter::once(false).chain(edges.iter().rev().copied());
    let to_left = pass(slope, answers.iter().rev().copied().zip(before));
    for (x, (right, left)) in to_right.into_iter().zip(to_left.into_iter().rev()).enumerate() {
        if right || left {
            answers[x] = Disparity::NONE;
            flags[x] = flags[x].union(PixelFlags::UNTEXTURED);
        }
    }
    (answers, flags)
}
