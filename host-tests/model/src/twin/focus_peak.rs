//! The peak of a cell of a focus map, naively: from the sharpness of all frames at once.

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
    // A candidate is fitted as soon as it has seen five frames after it, and eleven in all.
    let seen = (last + 1).min((candidate + 6).max(11));
    let fitted_noise = noise_of_logs(&logs[..seen as usize]);
    let sharpest =
        (candidate - 1..=candidate + 1).filter(|i| (0..=last).contains(i)).max_by_key(|&i| at(i))?;
    let mut chosen: Option<(i64, i64, i64, i64)> = None;
    for (half, gain, enough) in [(1, 181, 8), (2, 85, 26), (3, 53, 26), (5, 28, 0)] {
        let half = ((seen - 1) / 2).min(half);
        let (place, bend) = parabola(&at, if half == 1 { sharpest } else { candidate }, half, seen - 1)?;
        let place = place.max(0);
        if chosen.is_some_and(|(before, _, _, noise)| (place - before).abs() > 4 * noise) {
            break;
        }
        let noise = fitted_noise * gain / bend.max(1);
        chosen = Some((place, bend.max(1), gain, noise));
        if noise < enough {
            break;
        }
    }
    let (place, bend, gain, _) = chosen?;
    let mean = logs.iter().sum::<i64>() / (last + 1);
    let height = (at(candidate) - mean).max(0);
    let noise_of_logs = noise_of_logs(&logs);
    let smooth = (choice(candidate) / 9 - mean).max(0);
    if height < 116 || height < 2048 && 5 * smooth < 7 * noise_of_logs {
        return None;
    }
    let noise = noise_of_logs * gain / bend;
    if noise > ((last + 1) * 48).max(1024) {
        return None;
    }
    let most = (last + 1) * 256;
    let sigma = (noise + ((2048 << 16) / bend).isqrt() / 12).clamp(16, most);
    // A candidate's fit ends with the frames that it has seen.
    let place = place.min((seen - 1) * 256);
    Some([place, sigma, noise.min(most), height * 255 / (height + 2048)])
}

/// The deviation of logarithms by noise, in 1/2^11, from the geometric mean of their third differences.
fn noise_of_logs(logs: &[i64]) -> i64 {
    let sizes = logs.windows(4).map(|w| (w[3] - 3 * w[2] + 3 * w[1] - w[0]).abs());
    let sizes: Vec<i64> = sizes.map(|size| if size == 0 { 0 } else { log2(size) }).collect();
    if sizes.is_empty() {
        return 512;
    }
    let mean = (sizes.iter().sum::<i64>() / sizes.len() as i64 - 2550).max(0);
    // On the line between the powers of two around it.
    let (low, part) = (1_i64 << (mean / 2048), mean % 2048);
    low + low * part / 2048
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
