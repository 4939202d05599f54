//! Rims refused: answers of a near surface outside of the edges between which it is.

use super::open::Open;
use super::{Cost, Method, Picture, fattening};
use stereopsis::imaging::Noise;
use stereopsis::matching::Config;
use stereopsis::units::{Disparity, PixelFlags};

/// The answers and flags of row `y` without those of rims.
pub(super) fn refuse(
    scheme: &Method,
    config: &Config,
    left: &Picture<'_>,
    open: &Open,
    y: usize,
    mut answers: Vec<Disparity>,
    mut flags: Vec<PixelFlags>,
) -> (Vec<Disparity>, Vec<PixelFlags>) {
    let width = answers.len();
    let asked = matches!(scheme.cost, Cost::Paths { .. })
        && config.checks.fattening_slope.is_some()
        && config.noise == Noise::None;
    if !asked {
        return (answers, flags);
    }
    let edges: Vec<bool> = (0..width).map(|x| fattening::is_edge(config, left, x, y)).collect();
    let mut refuse = |columns: &[usize], beyond: &[usize], counts_empty: bool| {
        for x in rims(&answers, &edges, columns, beyond, counts_empty) {
            flags[x] = flags[x].union(PixelFlags::UNTEXTURED.when(answers[x].is_some()));
            answers[x] = Disparity::NONE;
        }
    };
    let to_right: Vec<usize> = (0..width).collect();
    let to_left: Vec<usize> = (0..width).rev().collect();
    refuse(&to_right, &to_right, false);
    if config.checks.open_margin > 0 {
        let is_near = |x: &usize| open.is_near(y * width + x);
        for place in to_right.split(|x| !is_near(x)).filter(|place| !place.is_empty()) {
            let (start, end) = (place[0], place[place.len() - 1] + 1);
            if edges[end.saturating_sub(8)..width.min(end + 32)].contains(&true) {
                refuse(&place[place.len().saturating_sub(48)..], &to_right, true);
            }
            if edges[start.saturating_sub(32)..width.min(start + 8)].contains(&true) {
                let back: Vec<usize> = place.iter().take(48).rev().copied().collect();
                refuse(&back, &to_left, true);
            }
        }
    }
    (answers, flags)
}

/// The columns of the rims of surfaces that begin in `columns`, in this order. A surface begins over 2 px
/// nearer than the answer before it or, if empty columns count, where eight without answers are before it.
/// Its rim goes up to the first edge of the whole `row`, if that is at most 32 columns on; it has none if an
/// edge is where the surface begins or in the two columns before.
fn rims(
    answers: &[Disparity],
    edges: &[bool],
    columns: &[usize],
    row: &[usize],
    counts_empty: bool,
) -> Vec<usize> {
    let mut refused: Vec<usize> = Vec::new();
    let mut before: Option<i64> = None;
    let mut empty = 0;
    for &x in columns {
        if answers[x].is_none() || refused.contains(&x) {
            empty += 1;
            continue;
        }
        let here = i64::from(answers[x].raw());
        let begins = before.is_some_and(|before| here > before + 64) || counts_empty && empty >= 8;
        (before, empty) = (Some(here), 0);
        let place = row.iter().position(|&column| column == x).unwrap();
        let is_beside = row[place.saturating_sub(2)..=place].iter().any(|&x| edges[x]);
        let on = &row[place..row.len().min(place + 33)];
        if begins
            && !is_beside
            && let Some(rim) = on.iter().position(|&x| edges[x])
        {
            refused.extend(&on[..rim]);
        }
    }
    refused
}
