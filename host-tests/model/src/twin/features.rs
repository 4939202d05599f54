//! Features and matches by their definitions, over whole pictures.

use super::Picture;
use image::GrayImage;
use stereopsis::features::{
    Corner, Descriptor, Feature, FeatureConfig, Match, MatchConfig, Orientation, PATTERN,
};

/// The circle of radius 3: (dx, dy), clockwise from above.
const CIRCLE: [(isize, isize); 16] = [
    (0, -3),
    (1, -3),
    (2, -2),
    (3, -1),
    (3, 0),
    (3, 1),
    (2, 2),
    (1, 3),
    (0, 3),
    (-1, 3),
    (-2, 2),
    (-3, 1),
    (-3, 0),
    (-3, -1),
    (-2, -2),
    (-1, -3),
];

/// The score of the pixel (x, y): the greatest difference by which nine in a row on the circle are all
/// brighter, or all darker; 0 where that is not over the threshold.
pub fn fast_score(picture: &Picture<'_>, threshold: u8, x: isize, y: isize) -> u8 {
    let difference = |i: usize| {
        i16::from(picture.at(x + CIRCLE[i % 16].0, y + CIRCLE[i % 16].1)) - i16::from(picture.at(x, y))
    };
    let mut best = 0;
    for start in 0..16 {
        for sign in [-1, 1] {
            let weakest = (start..start + 9).map(|i| sign * difference(i)).min().expect("nine");
            best = best.max(weakest);
        }
    }
    if best > i16::from(threshold) { best as u8 } else { 0 }
}

/// A smoothed pixel: binomial weights over 5 x 5.
fn smooth(picture: &Picture<'_>, x: isize, y: isize) -> u8 {
    const WEIGHTS: [u32; 5] = [1, 4, 6, 4, 1];
    let mut sum = 0;
    for (dy, down) in (-2..).zip(WEIGHTS) {
        for (dx, right) in (-2..).zip(WEIGHTS) {
            sum += down * right * u32::from(picture.at(x + dx, y + dy));
        }
    }
    ((sum + 128) / 256) as u8
}

/// How far the corner lies from the pixel (x, y), in 1/64 px: the pixel of the nine that responds most, and
/// from there the top of a surface through the nine around it.
fn refined(picture: &Picture<'_>, x: isize, y: isize) -> [i8; 2] {
    let response = |x: isize, y: isize| -> i128 {
        let mut sums = [0; 3];
        for (x, y) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy))) {
            let at = |x, y| i128::from(smooth(picture, x, y));
            let g = [at(x + 1, y) - at(x - 1, y), at(x, y + 1) - at(x, y - 1)];
            sums = [sums[0] + g[0] * g[0], sums[1] + g[0] * g[1], sums[2] + g[1] * g[1]];
        }
        sums[0] * sums[2] - sums[1] * sums[1]
    };
    let nine = || (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
    // Of equals the middle one, then the first in reading order.
    let strongest = |&(dx, dy): &(isize, isize)| (response(x + dx, y + dy), (dx, dy) == (0, 0), -3 * dy - dx);
    let (right, down) = nine().max_by_key(strongest).expect("nine");
    let mut values: Vec<i128> = nine().map(|(dx, dy)| response(x + right + dx, y + down + dy)).collect();
    while values.iter().any(|&value| value >= 1 << 22) {
        values.iter_mut().for_each(|value| *value /= 2);
    }
    // Differences along and across, each summed over three with the weights 1 2 1.
    let sum =
        |weights: [i128; 9]| values.iter().zip(weights).map(|(value, weight)| value * weight).sum::<i128>();
    let (fx, fy) = (sum([-1, 0, 1, -2, 0, 2, -1, 0, 1]), sum([-1, -2, -1, 0, 0, 0, 1, 2, 1]));
    let (fxx, fyy) = (sum([1, -2, 1, 2, -4, 2, 1, -2, 1]), sum([1, 2, 1, -2, -4, -2, 1, 2, 1]));
    let fxy = sum([1, 0, -1, 0, 0, 0, -1, 0, 1]);
    let determinant = fxx * fyy - fxy * fxy;
    let part = |above: i128| {
        if fxx >= 0 || determinant <= 0 {
            return 0;
        }
        let nearest = (64 * above.abs() + determinant).div_euclid(2 * determinant) as i64;
        nearest.min(48) * above.signum() as i64
    };
    let place = |whole: isize, above: i128| (64 * whole as i64 + part(above)) as i8;
    [place(right, fxy * fy - fyy * fx), place(down, fxy * fx - fxx * fy)]
}

/// The descriptor of the corner at (x, y).
fn descriptor(picture: &Picture<'_>, orientation: Orientation, x: isize, y: isize) -> Descriptor {
    let at = |dx: i32, dy: i32| smooth(picture, x + dx as isize, y + dy as isize);
    // Cosines and sines of 32 directions, in units of 2^-14.
    let turns = [0.0, 1.0].map(|quarter: f64| {
        let angle = |step: i32| (f64::from(step) / 32.0 * 4.0 - quarter) * core::f64::consts::FRAC_PI_2;
        (0..32).map(|step| (16384.0 * angle(step).cos()).round() as i64).collect::<Vec<_>>()
    });
    let mut turn = 0;
    if orientation == Orientation::Centroid {
        let circle = (-15..=15)
            .flat_map(|dy| (-15..=15).map(move |dx| (dx, dy)))
            .filter(|(x, y)| x * x + y * y <= 225);
        let moments = circle.fold([0, 0], |[right, down], (dx, dy)| {
            let pixel = i64::from(at(dx, dy));
            [right + i64::from(dx) * pixel, down + i64::from(dy) * pixel]
        });
        let along = |step: usize| moments[0] * turns[0][step] + moments[1] * turns[1][step];
        turn = (0..32).rev().max_by_key(|&step| along(step).max(0)).expect("32 steps");
    }
    let (cosine, sine) = (turns[0][turn], turns[1][turn]);
    let turned = |[x, y]: [i8; 2]| {
        let round = |a: i64| (a as f64 / 16384.0 + 0.5).floor() as i32;
        let (x, y) = (i64::from(x), i64::from(y));
        at(round(x * cosine - y * sine), round(x * sine + y * cosine))
    };
    let mut words = [0; 8];
    for (i, [first, second]) in PATTERN.into_iter().enumerate() {
        if turned(first) < turned(second) {
            words[i / 32] |= 1 << (i % 32);
        }
    }
    Descriptor(words)
}

/// All features of a picture in the order in which the detector gives them, and how many corners there are in
/// all.
pub fn features(config: &FeatureConfig, image: &GrayImage) -> (Vec<Feature>, u32) {
    let picture = Picture::new(image);
    let margin = FeatureConfig::MARGIN as isize;
    let (width, height) = (image.width() as isize, image.height() as isize);
    let scores: Vec<_> = (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| fast_score(&picture, config.threshold, x, y))
        .collect();
    let score = |x: isize, y: isize| scores[(y * width + x) as usize];
    let mut corners = Vec::new();
    for (x, y) in (margin..height - margin).flat_map(|y| (margin..width - margin).map(move |x| (x, y))) {
        let around = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
        let here = score(x, y);
        let before = around[..4].iter().all(|(dx, dy)| score(x + dx, y + dy) < here);
        let after = around[4..].iter().all(|(dx, dy)| score(x + dx, y + dy) <= here);
        if here > 0 && before && after {
            let [right, down] = refined(&picture, x, y);
            corners.push(Corner { column: x as u16, row: y as u16, right, down, score: here });
        }
    }
    let cell = |c: &Corner| (c.row / config.cell_px, c.column / config.cell_px);
    let total = corners.len() as u32;
    corners.sort_by_key(|c| (cell(c), core::cmp::Reverse(c.score), c.row, c.column));
    let kept =
        corners.chunk_by(|a, b| cell(a) == cell(b)).flat_map(|c| c.iter().take(config.per_cell.into()));
    let described = kept.map(|c| {
        let descriptor = descriptor(&picture, config.orientation, c.column as isize, c.row as isize);
        Feature::new(c, config.level, descriptor)
    });
    (described.collect(), total)
}

/// The matches of two lists.
pub fn matches(left: &[Feature], right: &[Feature], search: &MatchConfig) -> Vec<Match> {
    let bits = |a: &Feature, b: &Feature| {
        let pairs = a.descriptor.0.into_iter().zip(b.descriptor.0);
        pairs.map(|(a, b)| (0..32).filter(|i| (a >> i & 1) != (b >> i & 1)).count()).sum::<usize>()
    };
    let admitted = |a: &Feature, b: &Feature| {
        let near = (a.x_px - b.x_px).abs() <= search.along_px && (a.y_px - b.y_px).abs() <= search.across_px;
        let on_line = search.epipolar.is_none_or(|e| {
            let f = e.fundamental.matrix().map(f64::from);
            let [ax, ay, bx, by] = [a.x_px, a.y_px, b.x_px, b.y_px].map(f64::from);
            let [l, m, n] = [0, 1, 2].map(|i| f[(0, i)] * ax + f[(1, i)] * ay + f[(2, i)]);
            (l * bx + m * by + n).abs() <= f64::from(e.tolerance_px) * l.hypot(m)
        });
        near && on_line && a.level.abs_diff(b.level) <= search.levels_apart
    };
    // The best partner of `a` among `others`, of equals the first.
    let best =
        |all: &[Feature], is_partner: &dyn Fn(&Feature) -> bool, distance: &dyn Fn(&Feature) -> usize| {
            let partners = (0..all.len()).filter(|&i| is_partner(&all[i]));
            partners.min_by_key(|&i| distance(&all[i]))
        };
    let mut found = Vec::new();
    for (i, a) in left.iter().enumerate() {
        let Some(j) = best(right, &|b| admitted(a, b), &|b| bits(a, b)) else { continue };
        let b = &right[j];
        let apart = |c: &Feature| {
            (c.x_px - b.x_px).abs() >= search.apart_px || (c.y_px - b.y_px).abs() >= search.apart_px
        };
        let others = (0..right.len()).filter(|&k| k != j && admitted(a, &right[k]) && apart(&right[k]));
        let second = others.map(|k| bits(a, &right[k])).min().unwrap_or(128).min(128);
        let clear = 100 * bits(a, b) < usize::from(search.ratio_percent) * second;
        let close = bits(a, b) <= usize::from(search.most_different);
        if clear && close && best(left, &|a| admitted(a, b), &|a| bits(a, b)) == Some(i) {
            found.push(Match { left: i as u16, right: j as u16, different: bits(a, b) as u16 });
        }
    }
    found
}

/// The matches without those that lie less than `apart_px` from one that stays before them, at both ends.
pub fn without_repeats(left: &[Feature], right: &[Feature], matches: &[Match], apart_px: f32) -> Vec<Match> {
    let ends = |m: &Match| {
        let (a, b) = (&left[usize::from(m.left)], &right[usize::from(m.right)]);
        [a.x_px, a.y_px, b.x_px, b.y_px]
    };
    let near = |k: &Match, m: &Match| ends(k).into_iter().zip(ends(m)).all(|(a, b)| (a - b).abs() < apart_px);
    let mut kept: Vec<Match> = Vec::new();
    for m in matches {
        if !kept.iter().any(|k| near(k, m)) {
            kept.push(*m);
        }
    }
    kept
}

/// The picture with `n - 1` pixels of every `n`; of columns that are left over, none, and of rows, all that
/// have one below.
pub fn shrunk(image: &GrayImage, n: u32) -> GrayImage {
    let (columns, rows) = (image.width() / n * (n - 1), image.height() / n * (n - 1));
    GrayImage::from_fn(columns, rows + (image.height() % n).saturating_sub(1), |x, y| {
        let (i, j) = (x % (n - 1), y % (n - 1));
        let (left, top) = (x / (n - 1) * n + i, y / (n - 1) * n + j);
        let at = |dx: u32, dy: u32| u32::from(image.get_pixel(left + dx, top + dy).0[0]);
        let row = |dy: u32| (n - 1 - i) * at(0, dy) + (i + 1) * at(1, dy);
        let sum = (n - 1 - j) * row(0) + (j + 1) * row(1);
        image::Luma([((sum + n * n / 2) / (n * n)) as u8])
    })
}
