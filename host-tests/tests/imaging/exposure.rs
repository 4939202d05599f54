//! One exposure for two cameras, and what their pictures tell of their health.

use embedded_hal::i2c::{ErrorKind, ErrorType, I2c, Operation};
use image::GrayImage;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt::Debug;
use stereopsis::camera::{ExposureControl, GainSteps, Hm01b0, Mt9v034};
use stereopsis::imaging::{
    AutoExposure, CameraHealth, ExposureCommand, ExposureLimits, Histogram, PairMonitor,
};
use stereopsis_host::scene::Scene;
use stereopsis_host::scene::pattern::Pattern;

const LIMITS: ExposureLimits = ExposureLimits {
    least_us: 30,
    most_us: 15_000,
    most_gain_16ths: 64,
    exposure_step_us: 1,
    gain_steps: GainSteps::Sixteenths,
};

/// What a camera sees of a scene whose brightest point gives `light` grey levels a millisecond.
fn histogram(scene: &GrayImage, light: f64, gain: f64, command: ExposureCommand) -> Histogram {
    let factor =
        light / 255.0 * gain * f64::from(command.exposure_us) / 1000.0 * f64::from(command.gain_16ths) / 16.0;
    let mut histogram = Histogram::new();
    for (row, line) in scene.as_raw().chunks(scene.width() as usize).enumerate() {
        let seen: Vec<u8> = line.iter().map(|&grey| (f64::from(grey) * factor).min(255.0) as u8).collect();
        histogram.line(row, &seen);
    }
    histogram
}

/// Frames under lights by turns: how often the setting changed under each, and where the mean ended.
fn run(lights: &[f64], gains: [f64; 2], delay: usize) -> Vec<(usize, f64)> {
    let (left, right) = Scene::small(80, 60).render();
    let mut auto = AutoExposure::new(LIMITS);
    // A sensor shows a setting so many frames later.
    let mut settings = vec![auto.current(); delay + 1];
    let mut told = Vec::new();
    for &light in lights {
        let (mut changes, mut mean, mut quiet) = (0, 0.0, 0);
        for _ in 0..80 {
            let command = settings.remove(0);
            let histograms =
                [histogram(&left, light, gains[0], command), histogram(&right, light, gains[1], command)];
            mean = f64::from(histograms[0].mean_16ths().max(histograms[1].mean_16ths())) / 16.0;
            let next = auto.frame([&histograms[0], &histograms[1]]);
            let before = settings.last().copied().unwrap_or(command);
            settings.push(next.unwrap_or(before));
            if let Some(next) = next {
                let light = |c: ExposureCommand| f64::from(c.exposure_us) * f64::from(c.gain_16ths);
                let step = light(next) / light(before);
                assert!((0.49..=2.01).contains(&step), "a bounded step: {step}");
                assert!(next.exposure_us <= LIMITS.most_us && next.gain_16ths <= LIMITS.most_gain_16ths);
            }
            changes += usize::from(next.is_some());
            quiet = if next.is_some() { 0 } else { quiet + 1 };
        }
        assert!(quiet >= 30, "it comes to rest: {quiet} quiet frames under {light}");
        told.push((changes, mean));
    }
    told
}

#[test]
fn the_exposure_follows_the_light_and_comes_to_rest() {
    for delay in [0, 1, 2] {
        for (changes, mean) in run(&[30.0, 300.0, 8.0, 60.0, 61.0, 1000.0, 20.0], [1.0, 1.0], delay) {
            assert!(changes <= 12, "{changes} changes");
            let target = f64::from(AutoExposure::TARGET);
            assert!(
                (mean - target).abs() <= f64::from(AutoExposure::DEAD_BAND) + 1.0,
                "the mean ends at {mean}"
            );
        }
    }
}

#[test]
fn the_brighter_camera_is_looked_at() {
    for gains in [[1.0, 1.3], [1.3, 1.0]] {
        let told = run(&[40.0], gains, 2);
        assert!((told[0].1 - f64::from(AutoExposure::TARGET)).abs() <= 13.0, "{told:?}");
    }
}

#[test]
fn where_the_limits_are_reached_nothing_swings() {
    // Too dark for all exposure and gain, and too bright for the least.
    let told = run(&[0.5, 1e6], [1.0, 1.0], 2);
    assert!(told[0].1 < 60.0 && told[1].1 > 200.0, "{told:?}");
}

#[test]
fn limits_that_contradict_themselves_are_put_in_order() {
    let auto = AutoExposure::new(ExposureLimits { least_us: 0, most_us: 0, most_gain_16ths: 0, ..LIMITS });
    assert_eq!(auto.current(), ExposureCommand { exposure_us: 0, gain_16ths: 16 });
    let auto = AutoExposure::new(ExposureLimits { least_us: 9, most_us: 5, most_gain_16ths: 0, ..LIMITS });
    assert_eq!(auto.current(), ExposureCommand { exposure_us: 9, gain_16ths: 16 });
}

fn watched(left: &GrayImage, right: &GrayImage, most: u16) -> PairMonitor {
    let mut monitor = PairMonitor::new(most);
    for _ in 0..2 {
        monitor.begin();
        let width = left.width() as usize;
        for (left, right) in left.as_raw().chunks(width).zip(right.as_raw().chunks(width)) {
            monitor.lines(left, right);
        }
    }
    monitor
}

#[test]
fn pictures_tell_what_is_wrong_with_a_camera() {
    let (good, _) = Pattern::Shifted { most: 20, noise_grey: 2.0 }.pair(160, 96, 3);
    let told = |picture: &GrayImage| watched(&good, picture, 40).health();
    let of = |grey: u8| GrayImage::from_pixel(160, 96, image::Luma([grey]));
    assert_eq!(told(&good), [CameraHealth::Good; 2]);
    assert_eq!(told(&of(1)), [CameraHealth::Good, CameraHealth::Black]);
    assert_eq!(told(&of(255)), [CameraHealth::Good, CameraHealth::Saturated]);
    assert_eq!(told(&of(120)), [CameraHealth::Good, CameraHealth::Flat]);
    let hanging = GrayImage::from_fn(160, 96, |x, _| *good.get_pixel(x, 7));
    assert_eq!(told(&hanging), [CameraHealth::Good, CameraHealth::Repeating]);
}

#[test]
fn swapped_cameras_are_reported_and_others_are_not() {
    let scenes = [Scene::small(160, 96), Scene::small(200, 120)].map(|scene| scene.render());
    let patterns = [1, 2, 3].map(|seed| Pattern::Shifted { most: 24, noise_grey: 3.0 }.pair(160, 96, seed));
    for (i, (left, right)) in scenes.iter().chain(&patterns).enumerate() {
        assert!(!watched(left, right, 40).are_swapped(), "{i}");
        assert!(watched(right, left, 40).are_swapped(), "{i}: {:?}", watched(right, left, 40));
        assert!(!watched(left, left, 40).are_swapped(), "all far away");
    }
    let (blank, noise) = (Pattern::Constant(90).pair(160, 96, 1), Pattern::Noise.pair(160, 96, 1));
    for (left, right) in [blank, noise] {
        assert!(!watched(&left, &right, 40).are_swapped());
    }
}

#[test]
fn the_ratio_of_the_gains_is_measured() {
    let (left, right) = Scene::small(160, 96).render();
    for (gain, ratio) in [(1.0, 256.0), (1.25, 320.0), (0.8, 204.8)] {
        let seen = GrayImage::from_fn(160, 96, |x, y| {
            image::Luma([(f64::from(right.get_pixel(x, y)[0]) * gain).min(255.0) as u8])
        });
        let measured = f64::from(watched(&left, &seen, 40).gain_ratio_256ths());
        assert!((measured / ratio - 1.0).abs() < 0.06, "{gain}: {measured}");
    }
    let dark = GrayImage::new(160, 96);
    assert_eq!(watched(&left, &dark, 40).gain_ratio_256ths(), 256);
}

/// No command leaves the limits, also where they contradict each other or allow no exposure.
#[test]
fn commands_stay_within_the_limits() {
    let bright = [&histogram(&GrayImage::from_pixel(32, 32, image::Luma([250])), 255.0, 1.0, WITH), &dark()];
    for (least_us, most_us, expected) in
        [(0, 0, (0, 0)), (0, 1, (1, 1)), (0, 9, (1, 9)), (5, 5, (5, 5)), (7, 0, (7, 7)), (u32::MAX, 0, LAST)]
    {
        let mut exposure =
            AutoExposure::new(ExposureLimits { least_us, most_us, most_gain_16ths: 16, ..LIMITS });
        let range = expected.0..=expected.1;
        assert!(range.contains(&exposure.current().exposure_us), "{least_us} to {most_us}");
        for frame in 0..40 {
            let pair = if frame < 20 { [bright[0]; 2] } else { [bright[1]; 2] };
            if let Some(command) = exposure.frame(pair) {
                assert!(range.contains(&command.exposure_us), "{least_us} to {most_us}: {command:?}");
            }
        }
    }
}

const WITH: ExposureCommand = ExposureCommand { exposure_us: 1000, gain_16ths: 16 };
const LAST: (u32, u32) = (u32::MAX, u32::MAX);

fn dark() -> Histogram {
    histogram(&GrayImage::from_pixel(32, 32, image::Luma([9])), 255.0, 1.0, WITH)
}

/// Registers of a sensor: what was written last, by address.
#[derive(Default)]
struct Registers(RefCell<BTreeMap<Vec<u8>, Vec<u8>>>);

impl Registers {
    /// The number at an address, whose bytes may be at adjacent ones.
    fn number(&self, addresses: &[&[u8]]) -> u32 {
        let map = self.0.borrow();
        let bytes = addresses.iter().flat_map(|&at| map.get(at).expect("a written register"));
        bytes.fold(0, |number, &byte| 256 * number + u32::from(byte))
    }
}

/// A bus to them, of addresses of so many bytes.
struct Bus<'a>(&'a Registers, usize);

impl ErrorType for Bus<'_> {
    type Error = ErrorKind;
}

impl I2c for Bus<'_> {
    fn transaction(&mut self, _: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        for operation in operations {
            let Operation::Write(bytes) = operation else { return Err(ErrorKind::Bus) };
            let (at, value) = bytes.split_at(self.1);
            self.0.0.borrow_mut().insert(at.to_vec(), value.to_vec());
        }
        Ok(())
    }
}

/// How often the setting changes under a light, of so many grey levels for a line at no gain, and the mean
/// and the exposure where it comes to rest, lines and gain.
fn at_rest<S: ExposureControl<Error: Debug>>(
    mut sensor: S,
    set: impl Fn() -> (u32, f64),
    grey_per_line: f64,
) -> (usize, f64, (u32, f64)) {
    let mut auto = AutoExposure::new(ExposureLimits::of_sensor(&sensor));
    let mut command = Some(auto.current());
    let (mut changes, mut quiet, mut mean) = (0, 0, 0.0);
    for _ in 0..120 {
        if let Some(ExposureCommand { exposure_us, gain_16ths }) = command {
            sensor.set_exposure(exposure_us, gain_16ths).expect("the bus takes it");
            (changes, quiet) = (changes + 1, 0);
        }
        quiet += 1;
        let (lines, gain) = set();
        mean = (grey_per_line * f64::from(lines) * gain).min(255.0);
        let mut histogram = Histogram::new();
        histogram.line(0, &[mean as u8; 64]);
        command = auto.frame([&histogram, &histogram]);
    }
    assert!(quiet > 60, "it comes to rest: {quiet} quiet frames at {:?}, {grey_per_line} a line", set());
    (changes, mean, set())
}

#[test]
fn sensors_come_to_rest_in_their_own_steps() {
    let hm01b0 = |grey_per_line: f64| {
        let registers = Registers::default();
        let set = || {
            let lines = registers.number(&[&[0x02, 0x02], &[0x02, 0x03]]);
            (lines, f64::from(1 << (registers.number(&[&[0x02, 0x05]]) >> 4)))
        };
        at_rest(Hm01b0::new(Bus(&registers, 2), 3_000_000), set, grey_per_line)
    };
    let mt9v034 = |grey_per_line: f64| {
        let registers = Registers::default();
        let set = || (registers.number(&[&[0x0b]]), f64::from(registers.number(&[&[0x35]])) / 16.0);
        at_rest(Mt9v034::new(Bus(&registers, 1), 0x48, 26_600_000), set, grey_per_line)
    };
    // The longest exposure, 258 lines, is half as much again too short.
    let (_, mean, (lines, gain)) = hm01b0(67.0 / 258.0);
    assert!((mean - 100.0).abs() < 13.0 && gain == 2.0 && lines < 258, "{mean} {lines} {gain}");
    // A row is too short, and two are too long.
    let (_, mean, (rows, gain)) = mt9v034(67.0);
    assert!((mean - 100.0).abs() < 13.0 && rows == 1 && gain > 1.0, "{mean} {rows} {gain}");
    // Under all lights, from far too dark to far too bright.
    for tenths in -70..55 {
        let grey_per_line = (f64::from(tenths) / 10.0).exp();
        let (most, (changes, mean, (rows, gain))) = (12, mt9v034(grey_per_line));
        assert!(changes <= most, "{changes} changes");
        // A row at no gain and all rows at all gain are the ends.
        let is_end = rows == 1 && gain == 1.0 || rows >= 522 && gain == 4.0;
        assert!(is_end || (mean - 100.0).abs() <= 13.0, "{grey_per_line}: {mean} of {rows} rows, {gain}");
        let (changes, mean, (lines, gain)) = hm01b0(grey_per_line);
        assert!(changes <= most, "{changes} changes");
        let is_end = lines == 2 || lines == 258 && gain == 8.0;
        // Of two to five lines the steps are wider than the band.
        let least = if lines < 6 { 66.0 } else { 87.0 };
        assert!(
            is_end || (least..=113.0).contains(&mean),
            "{grey_per_line}: {mean} of {lines} lines, {gain}"
        );
    }
}
