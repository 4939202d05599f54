//! F of scenes in which one plane dominates: found by what is off it, or refused by name.

use crate::views::{Views, mixed, noisy};
use nalgebra::{Point3, Rotation3, Vector3};
use stereopsis::geometry::{
    camera::Pose,
    robust::{RobustConfig, RobustError, robust_fundamental},
    two_view::Correspondence,
};
use stereopsis_host::scene::Random;

/// Seeds of a kind of scene.
const SCENES: u64 = 12;

/// A tilted wall with `share` of the points off it, seen from places 1 m apart that both look at it, with
/// noise of `sigma` px and `tail` of the matches with four times as much; and exact points off the wall
/// besides.
struct Wall {
    seen: Vec<Correspondence<f64>>,
    truth: Vec<Correspondence<f64>>,
}

impl Wall {
    fn new(seed: u64, count: usize, share: f64, (sigma, tail): (f64, f64)) -> Self {
        let mut random = Random::new(seed);
        let mut number = |size: f64| size * (2.0 * random.unit() - 1.0);
        let (middle, tilt) = (Vector3::new(0.0, 0.0, 7.0), [number(0.5), number(0.5)]);
        let turn = Rotation3::new(Vector3::new(number(0.05), -1.0 / 7.0 + number(0.05), number(0.1)));
        let to_the_side = Vector3::new(0.0, number(0.1), number(0.1));
        let pose = Pose::new(*turn.matrix(), middle - turn * middle + to_the_side).expect("a rotation");
        let anywhere = |random: &mut Random| {
            let mut number = |size: f64| size * (2.0 * random.unit() - 1.0);
            Point3::new(number(3.0), number(2.0), 7.0 + number(3.0))
        };
        let on = |random: &mut Random| {
            let p = anywhere(random);
            Point3::new(p.x, p.y, 7.0 + tilt[0] * p.x + tilt[1] * p.y)
        };
        let off = (count as f64 * share).round() as usize;
        let flat = Views::of(&mut random, count - off, pose, on);
        let deep = if off == 0 { Vec::new() } else { Views::of(&mut random, off, pose, anywhere).seen };
        let truth = Views::of(&mut random, 60, pose, anywhere).seen;
        let exact = [flat.seen, deep].concat();
        let far = (tail * count as f64) as usize;
        let views: Vec<_> = noisy(&exact, sigma, seed);
        // Every so many a worse one, on the wall and off it.
        let worse = noisy(&exact, 4.0 * sigma, seed + 1);
        let every = count.checked_div(far).unwrap_or(usize::MAX);
        let picked = views.iter().zip(&worse).enumerate();
        let picked: Vec<_> =
            picked.map(|(at, (s, w))| if at % every == every - 1 { *w } else { *s }).collect();
        let (seen, _): (Vec<_>, Vec<_>) = mixed(&picked, 0.0, 0.3, seed).into_iter().unzip();
        Self { seen, truth }
    }

    /// The mean distance of the exact points off the wall to the lines of the estimate, px.
    fn error(&self, threshold_px: f64) -> Result<f64, RobustError> {
        let mut inliers = vec![false; self.seen.len()];
        let found = robust_fundamental(&self.seen, &RobustConfig::new(threshold_px), &mut inliers)?;
        let sum: f64 = self.truth.iter().map(|s| found.fundamental.symmetric_px(s)).sum();
        Ok(sum / self.truth.len() as f64)
    }
}

/// How many of the scenes have a right F, a wrong one (over 5 px off), and a plane for an answer.
fn counts(count: usize, share: f64, noise: (f64, f64)) -> [usize; 3] {
    let mut counts = [0; 3];
    for seed in 0..SCENES {
        match Wall::new(seed, count, share, noise).error(1.0) {
            Ok(error) => counts[usize::from(error > 5.0)] += 1,
            Err(RobustError::Plane) => counts[2] += 1,
            Err(e) => panic!("seed {seed}: {e}"),
        }
    }
    println!("{count} matches, {share} off the wall, noise {noise:?}: {counts:?} right, wrong, plane");
    counts
}

#[test]
fn a_wall_alone_has_no_f() {
    for noise in [(0.3, 0.0), (0.5, 0.0), (0.4, 0.2)] {
        for count in [60, 170] {
            let [right, wrong, plane] = counts(count, 0.0, noise);
            assert!(right + wrong <= 1 && plane + 1 >= SCENES as usize, "{count} {noise:?}");
        }
    }
}

#[test]
fn what_is_off_a_wall_gives_f_or_the_wall_is_the_answer() {
    // What must be found, of twelve.
    for (share, least) in [(0.05, 4), (0.1, 10), (0.2, 12)] {
        for noise in [(0.3, 0.0), (0.5, 0.0), (0.4, 0.2)] {
            let [right, wrong, _] = counts(170, share, noise);
            assert!(wrong <= 1 && (right >= least || noise.1 > 0.0), "{share} {noise:?}: {right} {wrong}");
        }
    }
}
