//! Edges in depth of a focus map, naively: which side is in front, what it covers, and what it hides.

use super::focus::Peak;

/// Answers by column and row; `None` outside of the map too.
struct Map<'a> {
    columns: usize,
    peaks: &'a [Option<Peak>],
}

impl Map<'_> {
    fn at(&self, x: i64, y: i64) -> Option<Peak> {
        let rows = (self.peaks.len() / self.columns) as i64;
        let is_inside = (0..self.columns as i64).contains(&x) && (0..rows).contains(&y);
        is_inside.then(|| self.peaks[y as usize * self.columns + x as usize]).flatten()
    }

    fn places(&self) -> impl Iterator<Item = (i64, i64)> {
        let columns = self.columns;
        (0..self.peaks.len()).map(move |i| ((i % columns) as i64, (i / columns) as i64))
    }
}

/// A twelfth of the width of a peak, frames / 256: its deviation without noise.
fn width_12th(peak: Peak) -> f64 {
    (peak[1] - peak[2]).max(0) as f64
}

/// Whether two answers are farther apart than so many twelfths of their mean width, at least a quarter of a
/// frame, and three deviations of their noise.
fn differ(a: Peak, b: Peak, twelfths: f64) -> bool {
    let most = (twelfths * (width_12th(a) + width_12th(b)) / 2.0).floor().max(64.0);
    let beyond = ((a[0] - b[0]).abs() as f64 - most).max(0.0);
    beyond * beyond > 9.0 * (a[2] * a[2] + b[2] * b[2]) as f64
}

fn is_edge(a: Peak, b: Peak) -> bool {
    differ(a, b, 3.0)
}

/// Whether `a` is in front of `b` where later frames are nearer, or earlier ones.
fn is_before(a: Peak, b: Peak, later_is_nearer: bool) -> bool {
    is_edge(a, b) && if later_is_nearer { a[0] > b[0] } else { a[0] < b[0] }
}

/// How far answers beside edges are drawn across them, upwards on the lower side less downwards on the higher
/// one, frames / 256, for each edge along a row or a column that has eleven answers of one surface on either
/// side.
pub fn pulls(columns: usize, peaks: &[Option<Peak>]) -> Vec<f64> {
    let map = Map { columns, peaks };
    let rows = (peaks.len() / columns) as i64;
    let along = (0..rows).map(|y| (0..columns as i64).map(|x| map.at(x, y)).collect::<Vec<_>>());
    let down = (0..columns as i64).map(|x| (0..rows).map(|y| map.at(x, y)).collect::<Vec<_>>());
    let mut all = Vec::new();
    for line in along.chain(down) {
        for both in line.windows(22) {
            let Some(both) = both.iter().copied().collect::<Option<Vec<_>>>() else { continue };
            let edges: Vec<_> = (0..21).filter(|&i| is_edge(both[i], both[i + 1])).collect();
            if edges == [10] {
                let before: Vec<_> = both[..11].iter().rev().map(|peak| peak[0] as f64).collect();
                let after: Vec<_> = both[11..].iter().map(|peak| peak[0] as f64).collect();
                all.push(pull(&before) + pull(&after));
            }
        }
    }
    all
}

/// The mean of cells 1 to 3 from an edge less what the straight line through cells 5 to 10, by least squares,
/// has in cell 2.
fn pull(side: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let far: Vec<_> = (5..11).map(f64::from).collect();
    let (place, level) = (mean(&far), mean(&side[5..11]));
    let rise: f64 = far.iter().zip(&side[5..11]).map(|(x, value)| (x - place) * (value - level)).sum();
    let square: f64 = far.iter().map(|x| (x - place) * (x - place)).sum();
    mean(&side[1..4]) - (level + rise / square * (2.0 - place))
}

/// Answers with those at the rim of what is in front replaced by the farthest beside them, of equal ones by
/// the last of above, left, right and below.
pub fn uncovered(columns: usize, peaks: &[Option<Peak>], later_is_nearer: bool) -> Vec<Option<Peak>> {
    let map = Map { columns, peaks };
    let own = |(x, y): (i64, i64)| {
        let own = map.at(x, y)?;
        let mut farthest = own;
        for beside in [map.at(x, y - 1), map.at(x - 1, y), map.at(x + 1, y), map.at(x, y + 1)] {
            if let Some(beside) = beside.filter(|&beside| is_before(own, beside, later_is_nearer)) {
                let farther = (beside[0] - own[0]).abs() >= (farthest[0] - own[0]).abs();
                farthest = if farther { beside } else { farthest };
            }
        }
        Some(farthest)
    };
    map.places().map(own).collect()
}

/// Which cells have something in front of them within four cells.
pub fn partly_hidden(columns: usize, peaks: &[Option<Peak>], later_is_nearer: bool) -> Vec<bool> {
    let map = Map { columns, peaks };
    let is_hidden = |(x, y): (i64, i64)| {
        let near = map.places().filter(|&(u, v)| ((u - x) as f64).hypot((v - y) as f64) <= 4.0);
        let Some(own) = map.at(x, y) else { return false };
        near.filter_map(|(u, v)| map.at(u, v)).any(|near| is_before(near, own, later_is_nearer))
    };
    map.places().map(is_hidden).collect()
}

/// Places of answers, those that are hidden on the plane through twelve or more answers that are not, up to
/// ten columns and rows away, and differ by at most five twelfths of a width; from the first frame to `last`.
pub fn extended(columns: usize, peaks: &[Option<Peak>], is_hidden: &[bool], last: f64) -> Vec<Option<f64>> {
    use nalgebra::{Matrix3, Vector3};
    let map = Map { columns, peaks };
    let value = |((x, y), &is_own_hidden): ((i64, i64), &bool)| {
        let own = map.at(x, y)?;
        let near = map.places().zip(is_hidden).filter_map(|((u, v), &is_hidden)| {
            let peak = map.at(u, v)?;
            let is_near = (u - x).abs() <= 10 && (v - y).abs() <= 10;
            (is_near && !is_hidden && !differ(own, peak, 5.0)).then_some(((u - x, v - y), peak))
        });
        let near: Vec<_> = near.collect();
        if !is_own_hidden || near.len() < 12 {
            return Some(own[0] as f64);
        }
        let weights: Vec<_> =
            near.iter().map(|(_, p)| 38.0 * 38.0 / (38.0 * 38.0 + (p[2] * p[2]) as f64)).collect();
        let all: f64 = weights.iter().sum();
        let mean = |of: &dyn Fn(usize) -> f64| (0..near.len()).map(|i| weights[i] * of(i)).sum::<f64>() / all;
        let middle = [mean(&|i| near[i].0.0 as f64), mean(&|i| near[i].0.1 as f64)];
        let (mut squares, mut values) = (Matrix3::<f64>::zeros(), Vector3::<f64>::zeros());
        for (((dx, dy), peak), weight) in near.iter().zip(&weights) {
            let unknowns = Vector3::new(1.0, *dx as f64 - middle[0], *dy as f64 - middle[1]);
            squares += *weight * unknowns * unknowns.transpose();
            values += *weight * (peak[0] - own[0]) as f64 * unknowns;
        }
        squares += Matrix3::from_diagonal(&Vector3::new(0.0, 0.5 * all, 0.5 * all));
        let plane = squares.lu().solve(&values).expect("a ridge");
        let place = own[0] as f64 + plane.dot(&Vector3::new(1.0, -middle[0], -middle[1]));
        Some(place.clamp(0.0, last))
    };
    map.places().zip(is_hidden).map(value).collect()
}
