//! What happens to answers after they are chosen: smoothing along the row, the speckle filter, the deviation.

use super::{Answers, Scheme};
use stereopsis::matching::{Checks, Config};
use stereopsis::units::{Disparity, PixelFlags};

/// Rows below a row that the speckle filter and the deviation look at.
const LOOK_AHEAD: usize = 4;

/// Averages every answer with pairs of neighbours, as far left as right, that lie within 1 px of it.
pub(super) fn smooth_row(row: &[Disparity], radius: u8) -> Vec<Disparity> {
    let mut smooth = row.to_vec();
    for (x, answer) in row.iter().enumerate().filter(|(_, a)| a.is_some()) {
        let difference = |other: Disparity| {
            let steps = i32::from(other.raw()) - i32::from(answer.raw());
            (other.is_some() && steps.abs() <= 32).then_some(steps)
        };
        let (mut sum, mut count) = (0, 1);
        for k in 1..=usize::from(radius) {
            if x < k || x + k >= row.len() {
                break;
            }
            if let (Some(left), Some(right)) = (difference(row[x - k]), difference(row[x + k])) {
                sum += left + right;
                count += 2;
            }
        }
        let mean = (f64::from(sum) / f64::from(count)).round() as i32; // `round` takes halves away from zero.
        smooth[x] = Disparity::from_raw((i32::from(answer.raw()) + mean) as u16);
    }
    smooth
}

/// The rows after the speckle filter. Each row is judged by what is known when it leaves: the rows up to four below it.
pub(super) fn drop_speckles(checks: &Checks, mut map: Answers) -> Answers {
    if checks.speckle_pixels == 0 {
        return map;
    }
    let before = map.disparity.clone();
    let alike = |a: Disparity, b: Disparity| a.distance(b).is_some_and(|steps| steps <= checks.speckle_range.raw());
    for y in 0..map.height {
        let known = &before[..map.height.min(y + LOOK_AHEAD + 1) * map.width];
        let mut seen = vec![false; known.len()];
        for start in y * map.width..(y + 1) * map.width {
            if seen[start] || known[start].is_none() {
                continue;
            }
            let patch = flood(known, map.width, &mut seen, start, alike);
            if patch.len() < usize::from(checks.speckle_pixels) {
                for i in patch.into_iter().filter(|i| i / map.width == y) {
                    map.disparity[i] = Disparity::NONE;
                    map.flags[i] = map.flags[i].union(PixelFlags::SPECKLE);
                }
            }
        }
    }
    map
}

/// The places that are reached from `start` by steps up, down, left and right between answers that are alike.
fn flood(
    known: &[Disparity],
    width: usize,
    seen: &mut [bool],
    start: usize,
    alike: impl Fn(Disparity, Disparity) -> bool,
) -> Vec<usize> {
    let mut patch = vec![start];
    seen[start] = true;
    let mut next = 0;
    while next < patch.len() {
        let here = patch[next];
        next += 1;
        let x = here % width;
        let neighbours = [
            (x > 0).then(|| here - 1),
            (x + 1 < width).then(|| here + 1),
            here.checked_sub(width),
            (here + width < known.len()).then(|| here + width),
        ];
        for there in neighbours.into_iter().flatten() {
            if !seen[there] && alike(known[here], known[there]) {
                seen[there] = true;
                patch.push(there);
            }
        }
    }
    patch
}

/// The deviation of every answer, px: a third of the greatest difference to an answer within four pixels along the row
/// and the column, and never less than the scheme's own.
pub(super) fn sigmas(scheme: &Scheme, config: &Config, before: &[Disparity], after: &[Disparity]) -> Vec<Option<f32>> {
    let (width, height) = (usize::from(config.width), usize::from(config.height));
    let mut sigmas = vec![None; after.len()];
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let here = after[y * width + x];
        if here.is_none() {
            continue;
        }
        let mut neighbours = Vec::new();
        for k in 1..=LOOK_AHEAD {
            if x >= k {
                neighbours.push(before[y * width + x - k]);
            }
            if x + k < width {
                neighbours.push(before[y * width + x + k]);
            }
            if y >= k {
                // A row above has left already: it is known as it left.
                neighbours.push(after[(y - k) * width + x]);
            }
            if y + k < height {
                neighbours.push(before[(y + k) * width + x]);
            }
        }
        let spread = neighbours.into_iter().filter_map(|n| here.distance(n)).max().unwrap_or(0);
        sigmas[y * width + x] = Some(scheme.sigma_px.max(f32::from(spread) / 32.0 / 3.0));
    }
    sigmas
}
