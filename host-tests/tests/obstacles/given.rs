//! The plane below a camera of a given pose, beside the equation.

use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use stereopsis::obstacles::{Ground, GroundSource};
use stereopsis_host::scene::Random;
use stereopsis_host::twin::obstacles::{Line, Scene};

/// A plane of the core in the words of the twin.
pub fn in_whole_numbers(ground: Ground) -> Line {
    Line {
        level: ground.level.into(),
        slope: ground.slope.into(),
        lean: ground.lean.into(),
        variance: ground.variance.into(),
        height_mm: ground.height_mm.into(),
        pitch_sigma: ground.pitch_sigma.into(),
    }
}

/// Compares the plane of a given pose at the corners of the picture with the equation, in `f64`.
///
/// The core takes the tangents of pitch and roll to 0.00005, multiplies up to eight numbers in `f32`, and
/// rounds slope and lean.
pub fn compare_pose(scene: &Scene<'_>) -> Result<(), TestCaseError> {
    let GroundSource::Given { pitch_mrad, roll_mrad, height_mm } = scene.config.ground else { return Ok(()) };
    let [pitch, roll] = [pitch_mrad, roll_mrad].map(|mrad| f64::from(mrad) / 1000.0);
    let [level, slope, lean] = Line::of_pose(scene, pitch, roll, height_mm.into());
    let Some(line) = &scene.given else {
        prop_assert!(slope < 1.0 || slope >= f64::from(1 << 29) || height_mm > 60_000);
        return Ok(());
    };
    let focal = scene.focal_16ths as f64 / 16.0;
    let (cx, cy) = (scene.cx_16ths as f64 / 16.0, scene.cy_halves as f64 / 2.0);
    for (u, v) in [(0, 0), (scene.width, 0), (0, scene.height), (scene.width, scene.height)] {
        let (right, v) = (u as f64 - cx, v as f64);
        let expected = level + slope * v + lean * right;
        let found = line.level as f64 + line.slope as f64 * v + line.lean as f64 * right;
        // The level takes off what the rounded slope has down to the principal point.
        let rounding = 0.5 * ((v - cy).abs() + right.abs()) + 1.0;
        let of_tangents = 5e-5 * slope.hypot(lean) * (focal + (v - cy).abs() + right.abs());
        let of_floats = 8.0 * f64::from(f32::EPSILON) * slope.hypot(lean) * (focal + v + cy + right.abs());
        let tolerance = rounding + 1.1 * of_tangents + of_floats;
        prop_assert!((found - expected).abs() <= tolerance, "{} {} {}", found, expected, tolerance);
    }
    prop_assert_eq!((line.variance, line.height_mm, line.pitch_sigma), (1, height_mm.into(), 0));
    Ok(())
}

/// A pose from which a floor is seen, or any that is allowed.
pub fn pose(random: &mut Random) -> (i16, i16, u16) {
    let mut between = |least: i16, most: i16| least + random.below((most - least + 1) as usize) as i16;
    if between(0, 3) > 0 {
        (between(-50, 350), between(-80, 80), between(150, 1150) as u16)
    } else {
        (between(-500, 500), between(-500, 500), 2 * between(1, i16::MAX - 1) as u16)
    }
}
