//! What happens to answers after they are chosen: smoothing along the row, the speckle filter, the deviation.

use super::{Answers, Scheme};
use std::ops::Range;
use stereopsis::matching::{Checks, Config};
use stereopsis::units::{Disparity, PixelFlags};

/// Rows below a row that the speckle filter and the deviation look at.
const LOOK_AHEAD: usize = 4;

/// Whether two answers are of one surface.
fn of_one_surface(checks: &Checks, a: Disparity, b: Disparity) -> bool {
    a.distance(b).is_some_and(|steps| steps <= checks.surface_step.raw())
}

/// The answers of the surface around an answer, along its row: from the first to the one behind the last.
fn surface(checks: &Checks, row: &[Disparity], x: usize) -> Range<usize> {
    let (mut first, mut end) = (x, x + 1);
    while first > 0 && of_one_surface(checks, row[first - 1], row[first]) {
        first -= 1;
    }
    while end < row.len() && of_one_surface(checks, row[end - 1], row[end]) {
        end += 1;
    }
    first..end
}

/// Every answer of a row: averaged with pairs of neighbours, as far left as right, of its surface; and how many answers
/// that surface has.
pub(super) fn smooth_row(checks: &Checks, row: &[Disparity]) -> (Vec<Disparity>, Vec<usize>) {
    let (mut smooth, mut lengths) = (row.to_vec(), vec![0; row.len()]);
    for x in (0..row.len()).filter(|&x| row[x].is_some()) {
        let surface = surface(checks, row, x);
        lengths[x] = surface.len();
        let reach = usize::from(checks.smoothing_radius).min(x - surface.start).min(surface.end - 1 - x);
        let around = &row[x - reach..=x + reach];
        let mean = around.iter().map(|d| f64::from(d.raw())).sum::<f64>() / around.len() as f64;
        smooth[x] = Disparity::from_raw(mean.round() as u16);
    }
    (smooth, lengths)
}

/// The rows after the speckle filter. `lengths` is that of each answer's surface along its row. An answer needs support:
/// the lengths in its column, as far up as the surface goes, and as far down but for at most four rows.
pub(super) fn drop_speckles(checks: &Checks, lengths: &[usize], mut map: Answers) -> Answers {
    let before = map.disparity.clone();
    let goes_on = |above: usize| {
        let below = above + map.width;
        below < before.len() && of_one_surface(checks, before[above], before[below])
    };
    for i in (0..before.len()).filter(|&i| before[i].is_some()) {
        let mut support = lengths[i];
        let mut up = i;
        while up >= map.width && goes_on(up - map.width) {
            up -= map.width;
            support += lengths[up];
        }
        let mut down = i;
        for _ in 0..LOOK_AHEAD {
            if !goes_on(down) {
                break;
            }
            down += map.width;
            support += lengths[down];
        }
        if support < usize::from(checks.speckle_pixels) {
            map.disparity[i] = Disparity::NONE;
            map.flags[i] = map.flags[i].union(PixelFlags::SPECKLE);
        }
    }
    map
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
