//! Surfaces by flooding.

use super::stixels::{Column, Kind, Segment, Standing};
use super::{Line, Scene};
use std::ops::RangeInclusive;

/// What stands in each column: the nearest segment that belongs to a surface of enough pixels, where a speck
/// makes room for the next segment behind it twice.
pub fn stixels(scene: &Scene<'_>, cells: &[Option<i128>], ground: Option<Line>) -> Vec<Standing> {
    let [columns, _] = scene.size();
    let mut seen = Vec::new();
    let all: Vec<_> = (0..columns)
        .map(|x| {
            let column = Column::new(scene, cells, ground, x);
            let labels = column.labels();
            let mut segments = column.segments(&labels);
            segments.retain(|segment| segment.parallax > 0);
            // Of equals the upper one.
            segments.sort_by_key(|segment| (-segment.parallax, segment.top));
            seen.push(column.seen(&labels));
            let whole = segments.iter().map(|segment| column.whole(segment, &labels));
            (whole.collect::<Vec<_>>(), column)
        })
        .collect();
    let mut chosen: Vec<Option<Segment>> = all.iter().map(|(found, ..)| found.first().cloned()).collect();
    let area = usize::from(scene.config.cell_width) * usize::from(scene.config.cell_height);
    let (mut surfaces, largest) = (vec![0; columns], usize::from(scene.largest));
    for tried in 1..=3 {
        let stands: Vec<_> =
            (0..columns).map(|x| chosen[x].as_ref().is_some_and(|found| all[x].1.stands(found))).collect();
        let flood = |x: usize| flooded(&chosen, x, all[x].1.same_surface());
        let supported = |x: usize| {
            let cells = |x: usize| chosen[x].as_ref().map_or(0, |found| found.cells);
            // Within the largest disparity of the left edge, fewer can be searched: a cell counts half.
            let narrow = |x: usize| (x + 1) * usize::from(scene.config.cell_width) * 32 <= largest;
            let halves = |x: usize| cells(x) * if narrow(x) { 1 } else { 2 };
            let sum: usize = flood(x).map(halves).sum();
            let standing: usize = flood(x).filter(|&x| stands[x]).map(halves).sum();
            let enough = sum.max(2 * standing) * area >= 2 * usize::from(scene.config.min_pixels);
            if enough { flood(x).map(cells).sum() } else { 0 }
        };
        surfaces = (0..columns).map(supported).collect();
        let specks: Vec<_> = (0..columns).filter(|&x| chosen[x].is_some() && surfaces[x] == 0).collect();
        for x in specks {
            let Some(speck) = chosen[x].take() else { continue };
            if all[x].1.touches(&speck) {
                seen[x] = seen[x].max(speck.base + 1);
            }
            let next = all[x].0.iter().find(|segment| segment.parallax < speck.parallax);
            chosen[x] = next.filter(|_| tried < 3).cloned();
        }
    }
    (0..columns).map(|x| Standing { found: chosen[x].clone(), seen: seen[x], surface: surfaces[x] }).collect()
}

/// Columns of the surface that column `x` belongs to, by going left and right as long as columns are
/// connected.
fn flooded(chosen: &[Option<Segment>], x: usize, same_surface: i128) -> RangeInclusive<usize> {
    let connected = |a: &Option<Segment>, b: &Option<Segment>| match (a, b) {
        (Some(a), Some(b)) => {
            let edges_apart = a.base.abs_diff(b.base);
            a.kind == b.kind
                && ((a.parallax - b.parallax).abs() <= same_surface
                    || a.kind == Kind::Drop && edges_apart <= 1)
                && a.top <= b.base + 1
                && b.top <= a.base + 1
        }
        _ => false,
    };
    let (mut first, mut last) = (x, x);
    while first > 0 && connected(&chosen[first - 1], &chosen[first]) {
        first -= 1;
    }
    while last + 1 < chosen.len() && connected(&chosen[last], &chosen[last + 1]) {
        last += 1;
    }
    first..=last
}
