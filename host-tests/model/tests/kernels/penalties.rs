//! Penalties at the bounds of what a matcher starts with: costs along paths come near what a byte holds.

use super::{Twin, W, compare, long, pipeline};
use image::{GrayImage, Luma};
use stereopsis::matching::{Checks, Config, Penalties, Sgm, SgmEdge, SgmLean};
use stereopsis::pipeline::Pipeline;
use stereopsis_model::scene::Random;

/// Vertical stripes of random widths and brightness on two depths that meet at a column, or at a column that
/// depends on the row.
fn stripes(random: &mut Random) -> (GrayImage, GrayImage) {
    let (width, height) = (64, 20);
    let mut line = Vec::new();
    while line.len() < 128 {
        let grey = random.byte();
        line.extend(std::iter::repeat_n(grey, 1 + random.below(6)));
    }
    let depths = [random.below(32), random.below(32)];
    let (edge, slant) = (random.below(64), *random.pick(&[0, 0, 1, 3]));
    let left = GrayImage::from_fn(width, height, |x, _| Luma([line[x as usize]]));
    let right = GrayImage::from_fn(width, height, |x, y| {
        let is_far = (x as usize) < edge + slant * y as usize;
        Luma([line[x as usize + depths[usize::from(is_far)]]])
    });
    (left, right)
}

/// Penalties that a matcher starts with, and that it would not with one more of the last that is chosen.
fn at_the_bound(random: &mut Random) -> Penalties {
    let cost = 1 + random.below(60) as u8;
    let small = 1 + random.below(12) as u8;
    // cost + step + jump <= 127 and 3 cost + 2 jump <= 254.
    let step = small + random.below(usize::from((127 - cost) / 2 - small).min(30)) as u8;
    let most = (127 - cost - step).min((254 - 3 * cost) / 2);
    let step = step.min(most);
    let jump = [most, *random.pick(&[most, small.min(most), most / 2]).max(&small), most];
    Penalties {
        gradient: 1 + random.below(14) as u8,
        cost,
        step: [step, small.min(step)],
        jump,
        edges: [6, 12],
    }
}

fn stays_equal<S: Twin, const D: usize>(
    pipeline: &mut Pipeline<S, W, D>,
    disparities: u16,
    penalties: impl Fn(&mut Random) -> Penalties,
    seeds: std::ops::Range<u64>,
) {
    for seed in long(seeds, 20) {
        let random = &mut Random::new(seed);
        let config = Config {
            checks: Checks::DENSE,
            penalties: penalties(random),
            ..Config::for_method::<S>(64, 20, disparities)
        };
        if let Err(error) = compare(pipeline, &config, &stripes(random)) {
            panic!("seed {seed}: {error}");
        }
    }
}

/// The costs of two columns that agree on nothing are averaged, and a jump is added to the least of them.
#[test]
fn the_largest_jump_beside_small_steps() {
    let widest =
        |_: &mut Random| Penalties { gradient: 7, cost: 8, step: [8; 2], jump: [111; 3], edges: [6, 12] };
    stays_equal(&mut pipeline::<Sgm>(), 32, widest, 0..300);
    stays_equal(&mut pipeline::<SgmEdge>(), 32, widest, 300..400);
    stays_equal(&mut Pipeline::<Sgm, W, 16>::new(), 16, widest, 400..600);
}

#[test]
fn any_penalties_at_the_bound() {
    stays_equal(&mut pipeline::<Sgm>(), 32, at_the_bound, 0..300);
    stays_equal(&mut pipeline::<SgmLean>(), 33, at_the_bound, 300..400);
    stays_equal(&mut pipeline::<SgmEdge>(), 17, at_the_bound, 400..500);
}

/// One more than a bound is refused.
#[test]
fn penalties_beyond_the_bound_are_refused() {
    let bounds = Penalties { gradient: 7, cost: 8, step: [8; 2], jump: [111; 3], edges: [6, 12] };
    let sums = Penalties { gradient: 7, cost: 50, step: [25; 2], jump: [52; 3], edges: [6, 12] };
    let mut pipeline = pipeline::<Sgm>();
    let mut starts = |penalties| {
        let config = Config { penalties, ..Config::for_method::<Sgm>(64, 20, 32) };
        pipeline.start(&config).is_ok()
    };
    assert!(starts(bounds) && starts(sums));
    for beyond in [
        Penalties { cost: 9, ..bounds },
        Penalties { step: [9, 8], ..bounds },
        Penalties { jump: [112, 111, 111], ..bounds },
        Penalties { jump: [111, 111, 112], ..bounds },
        Penalties { jump: [53, 52, 52], ..sums },
        Penalties { cost: 0, ..bounds },
        Penalties { step: [7, 8], ..bounds },
        Penalties { jump: [7, 111, 111], ..bounds },
        Penalties { jump: [111, 7, 111], ..bounds },
        Penalties { edges: [12, 6], ..bounds },
        Penalties { gradient: 15, ..bounds },
    ] {
        assert!(!starts(beyond), "{beyond:?}");
    }
}
