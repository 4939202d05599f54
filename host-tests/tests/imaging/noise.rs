//! Smoothing and the noise meter against plain ones, and what the meter says of known noise.

use image::{GrayImage, Luma};
use stereopsis::imaging::{LineWindow, Noise, NoiseMeter, smooth};
use stereopsis_host::run::{MemoryPair, measure_noise};
use stereopsis_host::scene::Random;
use stereopsis_host::scene::pattern::Pattern;
use stereopsis_host::twin::Picture;
use stereopsis_host::twin::smooth::Seen;

const WIDEST: usize = 70;

/// Compares all five smoothed lines around every row with the twin's.
fn compare(image: &GrayImage) {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let seen = Seen::new(Picture::new(image), Noise::Low);
    let mut window = LineWindow::<WIDEST>::new();
    window.begin(width);
    let mut lines = image.as_raw().chunks_exact(width);
    for y in 0..height {
        while window.count() < (y + 3).min(height) {
            window.next_line().copy_from_slice(lines.next().expect("a line for every count"));
            window.accept();
        }
        for row in 0..5 {
            // What was in the buffer must not shine through, and what lies behind the line must stay.
            let mut line = [0xa5; WIDEST + 1];
            smooth(&window.around(y), row, &mut line);
            let expected = (0..width).map(|x| seen.at(x as isize, y as isize, row as isize - 2));
            assert!(line[..width].iter().copied().eq(expected), "{width}x{height}, row {y}, line {row}");
            assert!(line[width..].iter().all(|&pixel| pixel == 0xa5), "behind {width} columns");
        }
    }
}

#[test]
fn smoothed_lines_equal_the_twins_at_all_widths_and_heights() {
    for width in 1..=WIDEST as u32 {
        for height in [1, 2, 3, 4, 5, 9] {
            for pattern in [Pattern::Noise, Pattern::Saturated] {
                compare(&pattern.pair(width, height, u64::from(width * height)).0);
            }
        }
    }
}

#[test]
fn lines_and_places_of_unequal_length_are_taken_as_far_as_all_go() {
    let (long, short) = ([200; 40], [200; 21]);
    for (rows, places, written) in
        [([&long[..], &long, &short, &long, &long], 40, 21), ([&long[..]; 5], 9, 9)]
    {
        let mut line = [7; 40];
        smooth(&rows, 1, &mut line[..places]);
        assert!(
            line[..written].iter().all(|&pixel| pixel == 200)
                && line[written..].iter().all(|&pixel| pixel == 7)
        );
    }
    let mut line = [7; 4];
    smooth(&[&[], &[1], &[1], &[1], &[1]], 0, &mut line);
    smooth(&[&[1; 4]; 5], 6, &mut line);
    assert_eq!(line, [7; 4]);
}

/// The meter's estimate by its definition, grey levels, and that of the quarter.
fn plain_sigmas(images: &[&GrayImage]) -> Option<[f64; 2]> {
    let mut sums: Vec<i32> = Vec::new();
    for image in images {
        for line in image.as_raw().chunks_exact(image.width() as usize) {
            let runs = line.len().saturating_sub(4) / 16;
            for pixels in (0..runs).map(|run| &line[16 * run..16 * run + 20]) {
                let masked =
                    |at: &[u8]| [1, -4, 6, -4, 1].iter().zip(at).map(|(m, &p)| m * i32::from(p)).sum::<i32>();
                if pixels.iter().all(|pixel| (1..=254).contains(pixel)) {
                    sums.push(pixels.windows(5).map(|at| masked(at).abs()).sum());
                }
            }
        }
    }
    sums.sort_unstable();
    let last = sums.len().checked_sub(1)?;
    Some([128, 4].map(|share| f64::from(sums[last / share]) / 45.5))
}

/// A slope with noise of that deviation.
fn slope(width: u32, height: u32, sigma: f64, seed: u64) -> GrayImage {
    let mut random = Random::new(seed);
    GrayImage::from_fn(width, height, |x, y| {
        let grey = 60.0 + f64::from(100 * x) / f64::from(width) + f64::from(30 * y) / f64::from(height);
        Luma([(grey + sigma * random.gauss()).round().clamp(0.0, 255.0) as u8])
    })
}

fn meter_of(images: &[&GrayImage]) -> NoiseMeter {
    let mut meter = NoiseMeter::new();
    for image in images {
        image.as_raw().chunks_exact(image.width() as usize).for_each(|line| meter.line(line));
    }
    meter
}

#[test]
fn the_meter_says_what_its_definition_says() {
    for (width, height) in [(20, 1), (35, 7), (36, 7), (96, 64), (333, 50)] {
        for (sigma, seed) in [(0.0, 1), (1.0, 2), (4.0, 3), (12.0, 4)] {
            let images = [slope(width, height, sigma, seed), slope(width, height, sigma, seed + 9)];
            let images = images.each_ref();
            let (said, plain) = (meter_of(&images).sigma_16ths(), plain_sigmas(&images));
            let (said, [plain, _]) = (f64::from(said.expect("a run")) / 16.0, plain.expect("a run"));
            // The last counter holds all sums beyond it.
            let plain = plain.min(359.0 / 16.0);
            // A counter holds sums that differ by up to 15, and the unit is a sixteenth.
            assert!(
                (said - plain).abs() <= 16.0 / 45.5 + 1.0 / 16.0,
                "{width}x{height}, {sigma}: {said}, {plain}"
            );
        }
    }
    for narrow in [Pattern::Noise.pair(19, 9, 1).0, Pattern::Constant(0).pair(90, 9, 1).0] {
        assert_eq!((meter_of(&[&narrow]).sigma_16ths(), plain_sigmas(&[&narrow])), (None, None));
        assert_eq!(meter_of(&[&narrow]).level(), Noise::None);
    }
}

#[test]
fn texture_without_a_quiet_place_is_no_noise() {
    // A tenth of the columns show noise alone, the others texture of so many times its deviation.
    for (times, level) in [(1.0, Noise::High), (1.7, Noise::High), (5.0, Noise::None), (8.0, Noise::None)] {
        let mut random = Random::new(7);
        let picture = GrayImage::from_fn(333, 120, |x, _| {
            let deviation = if x < 33 { 4.0 } else { 4.0 * times };
            Luma([(128.0 + deviation * random.gauss()).round().clamp(1.0, 254.0) as u8])
        });
        let [quiet, quarter] = plain_sigmas(&[&picture]).expect("a run");
        assert!((quarter / quiet - 3.0).abs() > 0.3, "{times}: too near to say, {quiet}, {quarter}");
        assert_eq!(quarter > 3.0 * quiet, level == Noise::None, "{times}: {quiet}, {quarter}");
        assert_eq!(meter_of(&[&picture]).level(), level, "{times}");
    }
}

#[test]
fn known_noise_is_measured_and_gets_its_level() {
    for (sigma, level) in [
        (0.0, Noise::None),
        (1.0, Noise::None),
        (1.5, Noise::None),
        (2.2, Noise::Low),
        (2.6, Noise::Low),
        (4.0, Noise::High),
        (5.0, Noise::High),
        (10.0, Noise::High),
    ] {
        let [left, right] = [1, 2].map(|seed| slope(320, 240, sigma, seed));
        let said = f64::from(meter_of(&[&left, &right]).sigma_16ths().expect("a run")) / 16.0;
        // Rounding to whole grey levels is noise of a third of one.
        let within = if sigma > 0.0 { 0.2 + 0.05 * sigma } else { 0.5 };
        assert!((said - sigma.hypot(0.29)).abs() < within, "{said} said, {sigma} true");
        let mut pair =
            MemoryPair::new(320, left.into_raw(), right.into_raw()).expect("two pictures of one size");
        let meter = measure_noise(&mut pair).expect("a frame");
        assert_eq!(meter.level(), level, "{sigma}");
        // The frame can be had again.
        assert_eq!(measure_noise(&mut pair).expect("a frame").sigma_16ths(), meter.sigma_16ths());
    }
    let mut meter = meter_of(&[&slope(90, 60, 9.0, 1)]);
    meter.clear();
    assert_eq!(meter.sigma_16ths(), None);
}
