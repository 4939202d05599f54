//! What happens to answers after they are chosen: smoothing along the row, the median, the speckle filter,
//! smoothing down the columns, filling, the deviation.

use super::open::Open;
use super::repeats::Repeats;
use super::{Answers, Method};
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

/// Every answer of a row: averaged with pairs of neighbours, as far left as right, of its surface; and how
/// many answers that surface has.
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

/// The fifth of nine answers around each, in order of size; what is none, or outside, counts as the one in
/// the middle.
pub(super) fn medians(width: usize, before: &[Disparity]) -> Vec<Disparity> {
    let height = before.len() / width;
    let median = |i: usize| {
        let (x, y) = (i % width, i / width);
        let mut nine = Vec::new();
        for (row, column) in [y.wrapping_sub(1), y, y + 1]
            .into_iter()
            .flat_map(|row| [x.wrapping_sub(1), x, x + 1].map(|column| (row, column)))
        {
            let inside = row < height && column < width;
            let neighbour = if inside { before[row * width + column] } else { Disparity::NONE };
            nine.push(if neighbour.is_some() { neighbour.raw() } else { before[i].raw() });
        }
        nine.sort_unstable();
        Disparity::from_raw(nine[4])
    };
    (0..before.len()).map(|i| if before[i].is_some() { median(i) } else { Disparity::NONE }).collect()
}

/// The rows after the speckle filter, which judges by the answers `before` the median. `lengths` is that of
/// each answer's surface along its row. An answer needs support: the lengths in its column, as far up as the
/// surface goes, and as far down but for at most four rows; of a row no more than
/// [`Checks::speckle_run`] count, and where it is open of [`Checks::open_run`].
pub(super) fn drop_speckles(
    checks: &Checks,
    before: &[Disparity],
    lengths: &[usize],
    open: &Open,
    mut map: Answers,
) -> Answers {
    let goes_on = |above: usize| {
        let below = above + map.width;
        below < before.len() && of_one_surface(checks, before[above], before[below])
    };
    for i in (0..before.len()).filter(|&i| before[i].is_some()) {
        let counted = |i: usize| {
            let limits = [checks.speckle_run, if open.is_near(i) { checks.open_run } else { 0 }];
            limits
                .into_iter()
                .filter(|&most| most > 0)
                .fold(lengths[i], |length, most| length.min(most.into()))
        };
        let mut support = counted(i);
        let mut up = i;
        while up >= map.width && goes_on(up - map.width) {
            up -= map.width;
            support += counted(up);
        }
        let mut down = i;
        for _ in 0..LOOK_AHEAD {
            if !goes_on(down) {
                break;
            }
            down += map.width;
            support += counted(down);
        }
        if support < usize::from(checks.speckle_pixels) {
            map.disparity[i] = Disparity::NONE;
            map.flags[i] = map.flags[i].union(PixelFlags::SPECKLE);
        }
    }
    map
}

/// The answers moved towards the line through the one above, as it comes out, and the one four rows below, as
/// it was `before`, where both are at most 1 px less and under 1 px more: by 5/32 of four times the
/// difference to the former and once that to the latter, rounded.
pub(super) fn smooth_down(before: &[Disparity], map: &mut Answers) {
    let width = map.width;
    for i in width..before.len().saturating_sub(LOOK_AHEAD * width) {
        let three = [map.disparity[i - width], map.disparity[i], before[i + LOOK_AHEAD * width]];
        if three.iter().any(|d| d.is_none()) {
            continue;
        }
        let [above, x, below] = three.map(|d| f64::from(d.raw()));
        if [above, below].iter().all(|other| (-32.0..32.0).contains(&(other - x))) {
            let change = (4.0 * (above - x) + (below - x)) * 5.0 / 32.0;
            map.disparity[i] = Disparity::from_raw((x + (change + 0.5).floor()) as u16);
        }
    }
}

/// The answers to the left and to the right of a pixel that has none, along its row, when both exist and no
/// more than as many pixels lie between them as are filled, and they differ by no more than they may.
fn sides(checks: &Checks, row: &[Disparity], x: usize) -> Option<[Disparity; 2]> {
    let left = (0..x).rev().find(|&x| row[x].is_some())?;
    let right = (x + 1..row.len()).find(|&x| row[x].is_some())?;
    let fits = right - left - 1 <= usize::from(checks.fill_pixels);
    let agree = row[left].raw().abs_diff(row[right].raw()) <= checks.fill_step.raw();
    (fits && agree).then(|| [row[left], row[right]])
}

/// The map with small gaps along its rows filled, but for pixels near what repeats four rows below them.
pub(super) fn fill_gaps(checks: &Checks, repeats: &Repeats, mut map: Answers) -> Answers {
    let before = map.disparity.clone();
    let last_row = map.width * (map.height - 1);
    let repeated = |i: usize| repeats.is_near((i + LOOK_AHEAD * map.width).min(last_row + i % map.width));
    for i in (0..before.len()).filter(|&i| before[i].is_none() && !repeated(i)) {
        let start = i / map.width * map.width;
        if let Some([left, right]) = sides(checks, &before[start..start + map.width], i - start) {
            map.disparity[i] = Disparity::from_raw(left.raw().min(right.raw()));
            map.flags[i] = map.flags[i].union(PixelFlags::FILLED);
        }
    }
    map
}

/// The deviation of every answer, px: a third of the greatest difference to an answer within four pixels
/// along the row and the column, and never less than the scheme's own. The answers are those `before` median
/// and speckle filter, in rows above those `after`. A filled pixel of the `map` looks at both sides of its
/// gap as well, and has at least 1 px.
pub(super) fn sigmas(
    scheme: &Method,
    config: &Config,
    before: &[Disparity],
    after: &[Disparity],
    map: &Answers,
) -> Vec<Option<f32>> {
    let (width, height) = (usize::from(config.width), usize::from(config.height));
    let mut sigmas = vec![None; after.len()];
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let here = map.disparity[y * width + x];
        if here.is_none() {
            continue;
        }
        let (mut neighbours, mut least_px) = (Vec::new(), scheme.sigma_px);
        if after[y * width + x].is_none() {
            let row = &after[y * width..(y + 1) * width];
            neighbours.extend(sides(&config.checks, row, x).expect("it was filled from there"));
            least_px = least_px.max(1.0);
        }
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
        sigmas[y * width + x] = Some(least_px.max(f32::from(spread) / 32.0 / 3.0));
    }
    sigmas
}
