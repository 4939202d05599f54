//! Smoothing of a focus map, naively: medians, and planes through what is around a place.

use super::focus::Peak;

/// Answers replaced by the median place of those around them.
pub fn median(columns: usize, peaks: &[Option<Peak>]) -> Vec<Option<Peak>> {
    let rows = (peaks.len() / columns) as i64;
    let at = |x: i64, y: i64| peaks[y.clamp(0, rows - 1) as usize * columns + x as usize];
    let around = |i: usize| {
        let [_, sigma, noise, confidence] = peaks[i]?;
        let (x, y) = ((i % columns) as i64, (i / columns) as i64);
        let near = (y - 2..=y + 2).flat_map(|v| (x - 2..=x + 2).map(move |u| (u, v)));
        let inside = near.filter(|&(u, _)| (0..columns as i64).contains(&u));
        let mut places: Vec<i64> = inside.filter_map(|(u, v)| at(u, v)).map(|[place, ..]| place).collect();
        places.sort_unstable();
        Some([places[(places.len() - 1) / 2], sigma, noise, confidence])
    };
    (0..peaks.len()).map(around).collect()
}

/// Answers of more than a tenth of a frame of noise replaced by the plane through those around the median, by
/// least squares, if they are as near to it as their noise says. Each with whether that was nearly the other
/// way round, by a thousandth.
pub fn planes(columns: usize, peaks: &[Option<Peak>], medians: &[Option<Peak>]) -> Vec<Option<(f64, bool)>> {
    medians.iter().enumerate().map(|(i, median)| plane(columns, peaks, i, (*median)?)).collect()
}

fn plane(columns: usize, peaks: &[Option<Peak>], i: usize, median: Peak) -> Option<(f64, bool)> {
    use nalgebra::{Matrix3, Vector3};
    let rows = (peaks.len() / columns) as i64;
    let at = |x: i64, y: i64| {
        let is_inside = (0..columns as i64).contains(&x) && (0..rows).contains(&y);
        is_inside.then(|| peaks[y as usize * columns + x as usize]).flatten()
    };
    let [place, _, noise, _] = median.map(|v| v as f64);
    let steps: &[i64] = match median[2] {
        ..26 => &[],
        26..51 => &[1],
        51..102 => &[2, 1],
        _ => &[4, 2, 1],
    };
    let (x, y) = ((i % columns) as i64, (i / columns) as i64);
    let mut is_close = false;
    for &step in steps {
        let near = (-3..=3).flat_map(|dy| (-3..=3).map(move |dx| (dx, dy))).filter_map(|(dx, dy)| {
            let [beside, _, beside_noise, _] = at(x + step * dx, y + step * dy)?.map(|v| v as f64);
            // Whole numbers, of which f64 has the squares exactly: the bound itself is within.
            let beyond = ((beside - place).abs() - 90.0).max(0.0);
            let is_same = beyond * beyond <= 9.0 * (noise * noise + beside_noise * beside_noise);
            is_same.then(|| (Vector3::new(1.0, dx as f64, dy as f64), beside, beside_noise * beside_noise))
        });
        let near: Vec<_> = near.collect();
        let (mut squares, mut values) = (Matrix3::<f64>::zeros(), Vector3::<f64>::zeros());
        let weight = |variance: f64| 38.0 * 38.0 / (variance + 38.0 * 38.0);
        for (unknowns, beside, variance) in &near {
            squares += weight(*variance) * unknowns * unknowns.transpose();
            values += weight(*variance) * (beside - place) * unknowns;
        }
        if near.is_empty() {
            continue;
        }
        // The ridge holds slopes about the mean back.
        let mean = Vector3::new(0.0, squares[(0, 1)], squares[(0, 2)]) / squares[(0, 0)];
        let mut centred = squares - squares[(0, 0)] * mean * mean.transpose();
        centred[(0, 1)] = 0.0;
        centred[(1, 0)] = 0.0;
        centred[(0, 2)] = 0.0;
        centred[(2, 0)] = 0.0;
        let ridge = 1e-3 * squares[(0, 0)];
        centred += Matrix3::from_diagonal(&Vector3::new(0.0, ridge, ridge));
        let level = values[0] / squares[(0, 0)];
        let moments =
            Vector3::new(values[0], values[1] - level * squares[(0, 1)], values[2] - level * squares[(0, 2)]);
        let mut solved = centred.lu().solve(&moments).unwrap_or_default();
        solved[0] = level;
        let (mut off_plane, mut expected) = (0.0, 0.0);
        for (unknowns, beside, variance) in &near {
            let at = unknowns - Vector3::new(0.0, mean[1], mean[2]);
            off_plane += weight(*variance) * (beside - place - solved.dot(&at)).powi(2);
            expected += weight(*variance) * variance;
        }
        // The ridge's part in what sums of squares give.
        off_plane += ridge * (solved[1].powi(2) + solved[2].powi(2));
        is_close |= (off_plane - 2.0 * expected).abs() <= 2e-3 * expected + 1.0;
        if off_plane <= 2.0 * expected {
            let value = place + level - solved[1] * mean[1] - solved[2] * mean[2];
            let all = near.iter().map(|(_, beside, _)| *beside).chain([place]);
            let (low, high) = all.fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
            return Some((value.clamp(low, high), is_close));
        }
    }
    Some((place, is_close))
}
