//! The search that holds what a pair shows.

use super::agreement::FEWEST;
use super::matches::PairMatches;
use crate::map::{DisparityMap, quantile};
use crate::run::{MemoryPair, MethodName, run};
use image::{GrayImage, imageops};
use stereopsis::matching::{Config, Filter};

/// Width up to which pictures are made smaller to find their range, px.
const SMALL: u32 = 320;

/// A search that holds what a pair shows: the smallest disparity and how many. It is that of the matches that
/// agree with each other, of things that have several in one place, and of a smaller copy of the pair,
/// matched over its whole width, with a margin. `None` where neither has answers.
pub fn search(pictures: [&GrayImage; 2], matches: &PairMatches) -> Option<[u16; 2]> {
    let width = u16::try_from(pictures[0].width()).ok()?;
    let (of_surfaces, of_things) = (matches.surfaces_px(), matches.things_px());
    let range = |sorted: &[f64], ends: [f64; 2]| {
        let at = |share: f64| sorted.get((share * (sorted.len() - 1) as f64).round() as usize).copied();
        if sorted.len() < FEWEST { None } else { Some([at(ends[0])?, at(ends[1])?]) }
    };
    let of_matches = range(&of_surfaces, [0.02, 0.98])
        .map(|[first, last]| [first, of_things.last().map_or(last, |&thing| last.max(thing))]);
    let ranges = [of_matches, small_range(pictures)];
    let most = f64::from(Config::MOST_DISPARITIES.min(width));
    let fits = |range: &[f64; 2]| range[1] - range[0].max(0.0) < most;
    let both = ranges.into_iter().flatten().reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
    // Some matches and some answers are wrong: where one search does not hold both, one of them says more.
    let [first, last] =
        if fits(&both) { both } else { ranges.into_iter().flatten().find(fits).unwrap_or(both) };
    let more = 4.0 + (last - first) / 8.0;
    let end = last + more;
    // From 0 on where that costs little, or at most as much again: what is far has few features, and a wall
    // behind all has none.
    let begin = if first - more < (end / 2.0).max(32.0) { 0.0 } else { (first - more).floor() };
    // The margin before what is farthest is given up before anything that is near.
    let begin = if end - begin > most { begin.max((end - most).min(first).floor()) } else { begin };
    let count = ((end - begin).max(1.0) as u16).next_multiple_of(16);
    let most = Config::MOST_DISPARITIES.min(width.saturating_sub(begin as u16)) & !15;
    Some([begin as u16, count.clamp(Config::FEWEST_DISPARITIES, most.max(Config::FEWEST_DISPARITIES))])
}

/// The range of the disparities in a smaller copy of a pair, in pixels of the pair.
fn small_range(pictures: [&GrayImage; 2]) -> Option<[f64; 2]> {
    let (map, by) = small_map(pictures)?;
    let (found, by) = (map.sorted(), f64::from(by));
    (found.len() >= 16 * FEWEST).then(|| {
        Some([by * f64::from(quantile(&found, 0.001)?), by * (f64::from(quantile(&found, 0.999)?) + 1.0)])
    })?
}

/// The answers of a smaller copy of a pair that is searched over its whole width, and how many times smaller
/// it is.
pub(super) fn small_map(pictures: [&GrayImage; 2]) -> Option<(DisparityMap, u32)> {
    let (width, height) = pictures[0].dimensions();
    let by = width.div_ceil(SMALL);
    let small = |picture: &GrayImage| imageops::thumbnail(picture, width / by, (height / by).max(1));
    let [left, right] = pictures.map(small);
    // Images have at most 4096 columns and rows.
    let (width, height) = (left.width() as u16, left.height() as u16);
    let disparities = Config::MOST_DISPARITIES.min(width) & !15;
    let config =
        MethodName::Block.with_filter(Filter::Strict, MethodName::Block.config(width, height, disparities));
    let mut pair = MemoryPair::new(width, left.into_raw(), right.into_raw())?;
    Some((run(MethodName::Block, &config, &mut pair, |_| ()).ok()?.map, by))
}
