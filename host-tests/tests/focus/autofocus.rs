//! Autofocus on a simulated lens: seeded scenes, scenes without texture, hardware that fails.

use image::GrayImage;
use stereopsis::focus::{
    ActuatorLimits, Autofocus, AutofocusError, FocusCalibration, FocusCalibrationError, FocusSearch, Focused,
    LensCommand, LensError, LensEvent, Region, RegionSharpness, ThinLens,
};
use stereopsis_host::focus::scene::{FocusScene, Surface, texture};
use stereopsis_host::scene::Random;

const SIDE: usize = 48;
const LIMITS: ActuatorLimits = ActuatorLimits { least: 0, most: 1023, backlash: 0 };
/// One of the 64 steps that the result is exact to.
const STEP: f64 = 1023.0 / 64.0;

/// A lens of 4 mm whose positions go from infinity to 8 cm, before a flat scene.
fn image_m(position: f64) -> f64 {
    4e-3 + 0.21e-3 * position / 1023.0
}

fn flat(seed: u64, textured: bool) -> (FocusScene, f64) {
    let mut random = Random::new(seed);
    let lens = ThinLens::new(4e-3).expect("a lens");
    // Anywhere in the range, also beside its ends, where a peak has one flank.
    let best = (1023.0 * random.unit()).max(0.5);
    let depth = lens.object_distance(image_m(best)).expect("an object");
    let (finest, contrast) =
        (1.5 + 3.0 * random.unit(), if textured { 60.0 + 140.0 * random.unit() } else { 0.0 });
    let grey = texture(SIDE, SIDE, finest, contrast, seed);
    let scene = FocusScene {
        width: SIDE,
        height: SIDE,
        lens,
        aperture_m: 1.5e-3,
        pixel_m: 5e-6,
        reference_m: None,
        noise: 0.5 + 2.5 * random.unit(),
        surfaces: vec![Surface { depth_m: vec![depth; SIDE * SIDE], grey }],
    };
    (scene, best)
}

fn sharpness(frame: &GrayImage) -> u32 {
    let mut meter = RegionSharpness::<SIDE>::new();
    let side = SIDE as u16;
    meter.start(side, side, Region { left: 4, top: 4, width: side - 8, height: side - 8 });
    frame.chunks_exact(SIDE).for_each(|line| meter.push(line).expect("a line that is due"));
    meter.sharpness()
}

/// Follows the commands to the end: with what is measured at a position, and how many moves and frames there
/// were.
fn follow(
    limits: ActuatorLimits,
    most_move: u16,
    start: u16,
    mut measure: impl FnMut(u16) -> u32,
) -> (Result<Focused, AutofocusError>, Vec<u16>) {
    let (mut focus, mut command) = Autofocus::new(limits, most_move, start);
    let (mut at, mut path) = (start, vec![start]);
    for _ in 0..10_000 {
        let event = match command {
            LensCommand::Move(position) => {
                at = position;
                path.push(at);
                LensEvent::Arrived(at)
            }
            LensCommand::Measure => LensEvent::Sharpness(measure(at)),
            LensCommand::Focused(focused) => {
                assert_eq!(focused.position, at);
                return (Ok(focused), path);
            }
            LensCommand::Failed(error) => return (Err(error), path),
        };
        command = focus.event(event);
    }
    panic!("no end");
}

#[test]
fn a_thousand_scenes_come_into_focus_within_twelve_frames() {
    let mut frames = [0; 13];
    let mut worst = 0.0_f64;
    for seed in 0..1000 {
        let (scene, best) = flat(seed, true);
        let mut count = 0;
        let start = Random::new(seed ^ 0x5eed).below(1024) as u16;
        let (focused, _) = follow(LIMITS, 1023, start, |at| {
            count += 1;
            sharpness(&scene.render(image_m(at.into()), seed << 8 | count))
        });
        let focused = focused.unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let off = (f64::from(focused.position) - best).abs();
        assert!(focused.frames <= 12 && u64::from(focused.frames) == count, "seed {seed}: {focused:?}");
        assert!(off <= STEP, "seed {seed}: {off} from {best}, {focused:?}");
        frames[usize::from(focused.frames)] += 1;
        worst = worst.max(off / STEP);
    }
    println!("frames {frames:?}, at most {worst:.2} steps off");
}

#[test]
fn a_scene_without_texture_is_reported() {
    for seed in 0..50 {
        let (scene, _) = flat(seed, false);
        let (result, _) = follow(LIMITS, 1023, 300, |at| {
            sharpness(&scene.render(image_m(at.into()), seed << 12 | u64::from(at)))
        });
        assert_eq!(result, Err(AutofocusError::Untextured), "seed {seed}");
    }
    assert_eq!(follow(LIMITS, 1023, 0, |_| 0).0, Err(AutofocusError::Untextured));
}

/// A smooth peak at 700.
fn peak(at: u16) -> u32 {
    (1e9 / (4e3 + (f64::from(at) - 700.0).powi(2))) as u32
}

#[test]
fn moves_are_bounded_and_come_from_below() {
    let (focused, path) = follow(LIMITS, 50, 1000, peak);
    assert!(f64::from(focused.expect("a focus").position.abs_diff(700)) <= STEP);
    assert!(path.windows(2).all(|pair| pair[0].abs_diff(pair[1]) <= 50), "{path:?}");
    let slack = ActuatorLimits { least: 100, most: 900, backlash: 29 };
    let mut measured = Vec::new();
    let (focused, path) = follow(slack, 1023, 500, |at| {
        measured.push(at);
        peak(at)
    });
    let last = focused.expect("a focus").position;
    assert!(path.iter().skip(1).all(|at| (100..=900).contains(at)), "{path:?}");
    for target in measured.into_iter().chain([last]) {
        let place = path.iter().rposition(|&at| at == target).expect("a place on the way");
        assert!(target == 100 || path[place - 1] < target, "{target} in {path:?}");
    }
}

#[test]
fn a_lens_that_went_too_far_comes_from_below_again() {
    let limits = ActuatorLimits { least: 0, most: 1023, backlash: 20 };
    let (mut focus, mut command) = Autofocus::new(limits, 1023, 0);
    let (mut at, mut moves, mut from, mut spoiled) = (0, 0, 0, 0);
    loop {
        let is_moving = matches!(command, LensCommand::Move(_));
        assert!(is_moving || at == 0 || from <= at, "it came from {from} to {at}");
        let event = match command {
            LensCommand::Move(position) => {
                moves += 1;
                (from, at) = (at, position);
                // Every fifth move ends far above where it was to.
                if moves % 5 == 0 {
                    (at, spoiled) = ((position + 250).min(1023), spoiled + 1);
                }
                LensEvent::Arrived(at)
            }
            LensCommand::Measure => LensEvent::Sharpness(peak(at)),
            LensCommand::Focused(focused) => {
                assert!(focused.position == at && f64::from(at.abs_diff(700)) <= STEP, "{focused:?}");
                break;
            }
            LensCommand::Failed(error) => panic!("{error}"),
        };
        command = focus.event(event);
    }
    assert!(spoiled > 2, "{spoiled} moves went too far");
}

#[test]
fn both_ends_of_the_range_are_found() {
    for (best, at_end) in [(0.0, 0), (1023.0, 1023)] {
        let (focused, _) =
            follow(LIMITS, 1023, 500, |at| (1e9 / (4e3 + (f64::from(at) - best).powi(2))) as u32);
        assert!(f64::from(focused.expect("a focus").position.abs_diff(at_end)) <= STEP);
    }
    let narrow = ActuatorLimits { least: 5, most: 60, backlash: 0 };
    assert_eq!(follow(narrow, 9, 5, peak).0, Err(AutofocusError::Range { needed: 65 }));
    // As many positions as there are steps are one too few, and as many as are said to be needed are enough.
    let of = |positions: u16| ActuatorLimits { least: 0, most: positions - 1, backlash: 0 };
    assert_eq!(follow(of(64), 9, 5, peak).0, Err(AutofocusError::Range { needed: 65 }));
    let (focused, _) = follow(of(65), 9, 5, |at| 1_000_000 / (10 + u32::from(at.abs_diff(30)).pow(2)));
    assert!(focused.expect("a focus").position.abs_diff(30) <= 1);
}

#[test]
fn failures_are_tried_again_three_times() {
    // Every command fails so many times before it works.
    for (failures, works) in [(1, true), (3, true), (4, false)] {
        let (mut focus, mut command) = Autofocus::new(LIMITS, 300, 512);
        let (mut left, mut at) = (failures, 512);
        let mut ends = None;
        for _ in 0..1000 {
            let fails = left > 0;
            left = if fails { left - 1 } else { failures };
            let event = match (command, fails) {
                (LensCommand::Move(_), true) if at % 2 == 0 => LensEvent::MoveFailed,
                // Steps were lost: the lens is elsewhere, and says so.
                (LensCommand::Move(position), true) => {
                    at = position.saturating_add(9).min(1023);
                    if at == position { LensEvent::MoveFailed } else { LensEvent::Arrived(at) }
                }
                (LensCommand::Move(position), false) => {
                    at = position;
                    LensEvent::Arrived(at)
                }
                (LensCommand::Measure, true) => LensEvent::FrameLost,
                (LensCommand::Measure, false) => LensEvent::Sharpness(peak(at)),
                (LensCommand::Focused(focused), _) => {
                    ends = Some(Ok(focused.position));
                    break;
                }
                (LensCommand::Failed(error), _) => {
                    ends = Some(Err(error));
                    break;
                }
            };
            command = focus.event(event);
        }
        match ends.expect("an end") {
            Ok(position) => assert!(works && f64::from(position.abs_diff(700)) <= STEP, "{position}"),
            Err(error) => assert!(!works && error == AutofocusError::Hardware, "{error}"),
        }
    }
    let (mut focus, command) = Autofocus::new(LIMITS, 1023, 0);
    assert_eq!(command, LensCommand::Measure);
    let failed = LensCommand::Failed(AutofocusError::Unexpected);
    assert_eq!([focus.event(LensEvent::Arrived(3)), focus.event(LensEvent::Sharpness(3))], [failed; 2]);
}

#[test]
fn a_lens_that_says_that_it_is_a_little_off_has_arrived() {
    // A step of the search is 15 positions of 1023, and one of 100.
    for (most, off, works) in [(1023, 1, true), (1023, 7, true), (1023, 8, false), (100, 1, false)] {
        for sign in [-1_i32, 1] {
            let limits = ActuatorLimits { least: 0, most, backlash: 0 };
            let (mut focus, mut command) = Autofocus::new(limits, 300, most / 2);
            let mut at = i32::from(most / 2);
            let ends = loop {
                let event = match command {
                    LensCommand::Move(position) => {
                        at = (i32::from(position) + sign * off).clamp(0, most.into());
                        LensEvent::Arrived(at as u16)
                    }
                    LensCommand::Measure => LensEvent::Sharpness(peak(at as u16)),
                    LensCommand::Focused(focused) => break Ok(focused.position),
                    LensCommand::Failed(error) => break Err(error),
                };
                command = focus.event(event);
            };
            match ends {
                Ok(position) => assert!(works && position.abs_diff(700) <= 23, "{off}: {position}"),
                Err(error) => assert_eq!((works, error), (false, AutofocusError::Hardware), "{off}"),
            }
        }
    }
}

#[test]
fn the_search_keeps_its_bound() {
    let mut search = FocusSearch::new(0, u16::MAX);
    for i in 0..40 {
        search.measured(i * 100, u32::from(i) * 9 + 1);
    }
    assert_eq!(search.frames(), FocusSearch::MOST_FRAMES);
}

#[test]
fn calibrations_are_lines() {
    let lens = ThinLens::new(0.004_f32).expect("a lens");
    let true_distance = |position: u16| 0.004 + 0.004 * 0.004 / (0.00002 + 1.5e-7 * f32::from(position));
    let samples: Vec<_> = (0..12).map(|i| (i * 90, true_distance(i * 90))).collect();
    let line = FocusCalibration::fit(lens, &samples).expect("a calibration");
    assert!(line.rms_m() < 1e-8);
    for position in [0, 33, 500, 1000] {
        let distance = line.focus_distance_m(position).expect("a distance");
        assert!((distance / true_distance(position) - 1.0).abs() < 1e-3, "{position}: {distance}");
        assert_eq!(line.position(distance), Ok(position));
        let slope = (true_distance(position + 1) - true_distance(position)).abs();
        let sigma = line.focus_sigma_m(position, 1.0).expect("a deviation");
        assert!((sigma / slope - 1.0).abs() < 0.02, "{position}: {sigma} {slope}");
    }
    assert_eq!(line.position(1e6), Ok(0));
    assert_eq!(line.position(f32::INFINITY), Ok(0));
    for near in [0.00401, 0.004, 0.001, 0.0, -1.0, f32::NEG_INFINITY] {
        assert_eq!(line.position(near), Ok(u16::MAX), "{near} m");
    }
    assert!(line.position(f32::NAN).is_err());
    assert_eq!(FocusCalibration::fit(lens, &samples[..1]), Err(FocusCalibrationError::TooFew));
    assert_eq!(FocusCalibration::fit(lens, &[samples[3], samples[3]]), Err(FocusCalibrationError::TooFew));
    assert_eq!(FocusCalibration::fit(lens, &[(0, 0.1), (100, 0.5)]), Err(FocusCalibrationError::Direction));
    let reason = LensError::ObjectWithinFocus;
    assert_eq!(
        FocusCalibration::fit(lens, &[(0, 1.0), (9, 0.001)]),
        Err(FocusCalibrationError::Distance { index: 1, reason })
    );
}
