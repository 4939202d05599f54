//! Depth from focus, naively: whole pictures, whole stacks.

use image::GrayImage;
use stereopsis::focus::{FocusConfig, Measure};

/// A picture of whole numbers, whose border goes on for ever outside of it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Numbers {
    /// Numbers in a row.
    pub width: usize,
    /// All of them, row by row.
    pub values: Vec<i64>,
}

impl Numbers {
    fn new(width: usize, height: usize, value: impl Fn(i64, i64) -> i64) -> Self {
        let all = (0..width * height).map(|i| value((i % width) as i64, (i / width) as i64));
        Self { width, values: all.collect() }
    }

    fn height(&self) -> usize {
        self.values.len() / self.width
    }

    fn at(&self, x: i64, y: i64) -> i64 {
        let (x, y) = (x.clamp(0, self.width as i64 - 1), y.clamp(0, self.height() as i64 - 1));
        self.values[y as usize * self.width + x as usize]
    }

    fn map(&self, value: impl Fn(i64, i64) -> i64) -> Self {
        Self::new(self.width, self.height(), value)
    }

    /// The sum of those in the square around a place that are inside.
    fn window(&self, x: i64, y: i64, radius: i64, value: impl Fn(i64) -> i64) -> (i64, i64) {
        let (mut sum, mut count) = (0, 0);
        for v in y - radius..=y + radius {
            for u in x - radius..=x + radius {
                if (0..self.width as i64).contains(&u) && (0..self.height() as i64).contains(&v) {
                    sum += value(self.at(u, v));
                    count += 1;
                }
            }
        }
        (sum, count)
    }
}

/// A picture as numbers.
pub fn numbers(picture: &GrayImage) -> Numbers {
    Numbers { width: picture.width() as usize, values: picture.as_raw().iter().map(|&v| v.into()).collect() }
}

/// Smoothed with weights 1, 2, 1 along and across.
pub fn binomial(p: &Numbers) -> Numbers {
    let weight = |i: i64| 2 - i.abs();
    p.map(|x, y| {
        (-1..=1)
            .flat_map(|j| (-1..=1).map(move |i| (i, j)))
            .map(|(i, j)| weight(i) * weight(j) * p.at(x + i, y + j))
            .sum()
    })
}

/// The sizes of the second differences along and across.
pub fn modified_laplacian(p: &Numbers) -> Numbers {
    p.map(|x, y| {
        let twice = 2 * p.at(x, y);
        (twice - p.at(x - 1, y) - p.at(x + 1, y)).abs() + (twice - p.at(x, y - 1) - p.at(x, y + 1)).abs()
    })
}

/// The squared gradient by Sobel's operator.
pub fn tenengrad(p: &Numbers) -> Numbers {
    p.map(|x, y| {
        let gx: i64 = (-1..=1).map(|j: i64| (2 - j.abs()) * (p.at(x + 1, y + j) - p.at(x - 1, y + j))).sum();
        let gy: i64 = (-1..=1).map(|i: i64| (2 - i.abs()) * (p.at(x + i, y + 1) - p.at(x + i, y - 1))).sum();
        gx * gx + gy * gy
    })
}

/// The Laplacian.
pub fn laplacian(p: &Numbers) -> Numbers {
    p.map(|x, y| p.at(x - 1, y) + p.at(x + 1, y) + p.at(x, y - 1) + p.at(x, y + 1) - 4 * p.at(x, y))
}

/// A measure over windows.
pub fn sharpness(picture: &GrayImage, measure: Measure, radius: i64) -> Numbers {
    let p = numbers(picture);
    let points = match measure {
        Measure::Robust => modified_laplacian(&binomial(&p)),
        Measure::ModifiedLaplacian => modified_laplacian(&p),
        Measure::Tenengrad => tenengrad(&p),
        Measure::LaplacianVariance => laplacian(&p),
    };
    points.map(|x, y| {
        let (sum, count) = points.window(x, y, radius, |v| v);
        match measure {
            Measure::LaplacianVariance => count * points.window(x, y, radius, |v| v * v).0 - sum * sum,
            _ => sum,
        }
    })
}

/// The sharpness of each cell of a frame, scaled about its middle, interpolated between pixels.
pub fn cells(config: &FocusConfig, picture: &GrayImage, scale: f32) -> Numbers {
    let points = modified_laplacian(&binomial(&numbers(picture)));
    let (width, height, side) =
        (i64::from(config.width), i64::from(config.height), i64::from(config.cell_px));
    let scale = (scale * 65536.0).round() as i64;
    // (size - 1) / 2 + scale * off, in 1/256, cut off.
    let source = |at: i64, size: i64| {
        let place = ((2 * at - (size - 1)) * scale + (size - 1) * 65536).div_euclid(512);
        place.clamp(0, (size - 1) * 256)
    };
    let seen = |x: i64, y: i64| {
        let (x, y) = (source(x, width), source(y, height));
        let corners = [(0, 0), (0, 1), (1, 0), (1, 1)];
        let part = |at: i64, next: i64| if next == 1 { at % 256 } else { 256 - at % 256 };
        let weighted = corners.map(|(i, j)| part(x, i) * part(y, j) * points.at(x / 256 + i, y / 256 + j));
        (weighted.iter().sum::<i64>() + 32768) / 65536
    };
    let inside = |i: i64, size: i64| i * side..((i + 1) * side).min(size);
    let sums = Numbers::new(config.columns(), config.rows(), |column, row| {
        let pixels = inside(row, height).flat_map(|y| inside(column, width).map(move |x| (x, y)));
        pixels.map(|(x, y)| seen(x, y)).sum()
    });
    let radius = config.radius.into();
    let once = sums.map(|x, y| sums.window(x, y, radius, |v| v).0);
    let side = 2 * radius + 1;
    let floor = 2 * i64::from(config.cell_px).pow(2) * side.pow(4);
    once.map(|x, y| once.window(x, y, radius, |v| v).0 + floor)
}

/// `2^15 log2(1 + step / 64)`, cut off, bit by bit.
fn table(step: u128) -> i64 {
    let mut x = (64 + step) << 25;
    let mut log = (x >> 32) as i64;
    for _ in 0..15 {
        if x >= 1 << 32 {
            x >>= 1;
        }
        x = (x * x) >> 31;
        log = 2 * log + (x >> 32) as i64;
    }
    log
}

/// The logarithm to base 2 of a positive number, in 1/2^11, interpolated between 64 steps an octave.
pub fn log2(value: i64) -> i64 {
    let octave = 63 - value.leading_zeros() as i64;
    // The place in the octave, in 2^22.
    let place = (((value as i128) << 31 >> octave) - (1 << 31)) as i64 / 512;
    let (step, rest) = (place >> 16, place & 0xffff);
    let (low, high) = (table(step as u128), table(step as u128 + 1));
    (octave * 2048 + ((low * 65536 + (high - low) * rest + (1 << 19)) >> 20)).min(65535)
}

/// A peak: its place in 1/256 frame from 0, deviation, what noise has in it, and confidence.
pub type Peak = [i64; 4];

/// The peak of a cell whose sharpness is given for every frame, with what each frame's brightness adds to
/// logarithms.
pub fn peak(sharpness: &[i64], shifts: &[i64]) -> Option<Peak> {
    let logs: Vec<i64> =
        sharpness.iter().zip(shifts).map(|(&s, shift)| (log2(s) + shift).min(65535)).collect();
    let last = logs.len() as i64 - 1;
    let at = |i: i64| logs[i.clamp(0, last) as usize];
    let choice = |i: i64| at(i - 2) + 2 * at(i - 1) + 3 * at(i) + 2 * at(i + 1) + at(i + 2);
    // The first of the largest.
    let candidate = (0..=last).rev().max_by_key(|&i| choice(i))?;
    let bend_of = |i: i64| (at(i - 1) + at(i + 1) - 2 * at(i)).abs();
    // Roughness as far as frames have come when the peak is located: five after the candidate.
    let seen = ((candidate + 6).max(11)).min(last + 1);
    let own: i64 = ((candidate - 2).max(1)..=(candidate + 2).min(seen - 2)).map(bend_of).sum();
    let rough_of = |frames: i64| {
        let sum: i64 = (1..frames - 1).map(bend_of).sum();
        if frames >= 10 { (sum - own.min(65535)).max(0) / (frames - 7) } else { sum / (frames - 2) }
    };
    let (rough, so_far, ends) = (rough_of(last + 1), rough_of(seen), seen - 1);
    let fits: Vec<_> = [(93, 50), (44, 11), (27, 5), (19, 3), (14, 2)]
        .iter()
        .zip(1..=ends / 2)
        .filter_map(|(&(slope, unsure), half)| {
            let (place, bend) = parabola(&at, candidate, half, ends)?;
            let sure = bend - so_far * unsure / 16;
            Some((if sure <= 0 { i64::MAX } else { so_far * slope / sure }, place.max(0), bend, slope))
        })
        .collect();
    let steady = fits.iter().find(|(noise, ..)| *noise < 26);
    // The last of the least.
    let &(_, place, bend, slope) = steady.or_else(|| fits.iter().rev().min_by_key(|(noise, ..)| *noise))?;
    let mean = logs.iter().sum::<i64>() / (last + 1);
    let height = (at(candidate) - mean).max(0);
    let above = (choice(candidate) / 9 - mean).max(0);
    if height < 116 || height < 2048 && 8 * above < 13 * rough {
        return None;
    }
    let bend = bend.max(1);
    let noise = rough * slope / bend;
    if noise > ((last + 1) * 12).max(256) {
        return None;
    }
    let most = (last + 1) * 256;
    let sigma = (noise + ((2048 << 16) / bend).isqrt() / 12).clamp(16, most);
    Some([place, sigma, noise.min(most), height * 255 / (height + 2048)])
}

/// The top of the parabola through the logarithms around a candidate, and its bend.
fn parabola(at: &dyn Fn(i64) -> i64, candidate: i64, half: i64, last: i64) -> Option<(i64, i64)> {
    let centre = candidate.clamp(half, last - half);
    let weights: &[i64] = match half {
        5 => &[4, 4, 4, 3, 2, 1],
        4 => &[4, 4, 3, 2, 1],
        3 => &[3, 3, 2, 1],
        2 => &[2, 2, 1],
        1 => &[1, 1],
        _ => return None,
    };
    let weighted = |power: u32, value: &dyn Fn(i64) -> i64| -> i64 {
        (-half..=half).map(|d| weights[d.unsigned_abs() as usize] * d.pow(power) * value(d)).sum()
    };
    let moment = |power: u32| weighted(power, &|d| at(centre + d));
    // Sums of weights by even powers of the distance, and the parabola m + l d + q d^2 of the normal
    // equations.
    let weight = |power: u32| weighted(power, &|_| 1);
    let (s0, s2, s4) = (weight(0), weight(2), weight(4));
    // -2 q and l as fractions with their denominators.
    let (bend_top, bend_under) = (-2 * (s0 * moment(2) - s2 * moment(0)), s0 * s4 - s2 * s2);
    let (slope_top, slope_under) = (moment(1), s2);
    let most = half * 256;
    let off = if bend_top > 0 {
        let (top, under) = (256 * slope_top * bend_under, slope_under * bend_top);
        (2 * top + under).div_euclid(2 * under).clamp(-most, most)
    } else {
        slope_top.signum() * most
    };
    Some((centre * 256 + off, (bend_top / bend_under).clamp(0, 65535)))
}

/// What each frame's brightness adds to its logarithms.
pub fn shifts(frames: &[GrayImage], exposure_varies: bool) -> Vec<i64> {
    let mean = |frame: &GrayImage| {
        let sum: i64 = frame.as_raw().iter().map(|&v| i64::from(v)).sum();
        let mean = sum * 256 / frame.as_raw().len() as i64;
        if mean == 0 { 0 } else { log2(mean) }
    };
    let means: Vec<_> = frames.iter().map(mean).collect();
    let shift = |&mean: &i64| if exposure_varies { (8192 + means[0] - mean).clamp(0, 16384) } else { 8192 };
    means.iter().map(shift).collect()
}

/// The peaks of all cells of a stack whose frames are scaled.
pub fn peaks(config: &FocusConfig, frames: &[GrayImage], scales: &[f32]) -> Vec<Option<Peak>> {
    let volume: Vec<_> =
        frames.iter().zip(scales).map(|(frame, &scale)| cells(config, frame, scale)).collect();
    let shifts = shifts(frames, config.exposure_varies);
    let of_cell = |i: usize| volume.iter().map(|numbers| numbers.values[i]).collect::<Vec<_>>();
    (0..config.cells()).map(|i| peak(&of_cell(i), &shifts)).collect()
}
