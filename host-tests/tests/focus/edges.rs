//! Edges in depth of a focus map equal their naive twin: bit for bit, and planes within rounding.

use super::twins::{Peaks, plain};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::focus::{FocusOrder, FocusPeak, NoFocus, extend_row, partly_hidden_row, uncover_row};
use stereopsis_host::scene::Random;
use stereopsis_host::twin::focus_edges as twin;

/// Answers for a slope with a box before or behind it, drawn towards each other beside the edges, with noise
/// and holes.
fn two_surfaces(columns: usize, rows: usize, jump: i64, seed: u64) -> Peaks {
    let mut random = Random::new(seed);
    let slope = [random.unit() * 60.0 - 30.0, random.unit() * 60.0 - 30.0];
    let (left, top) = (columns as f64 * random.unit(), rows as f64 * random.unit() * 0.5);
    let (pull, noise, width) =
        (random.unit() * 300.0 - 150.0, random.below(60) as u32, random.below(120) as u32);
    let holes = random.below(2) * 40;
    let peak = |i: usize| {
        let (x, y) = ((i % columns) as f64, (i / columns) as f64);
        let is_box = x >= left && y >= top;
        let near = (0.2 * (x - left).abs()).min(0.2 * (y - top).abs());
        let bend = pull * (1.0 - near).max(0.0) * if is_box { -0.3 } else { 1.0 };
        let jump = if is_box { jump as f64 } else { 0.0 };
        let jitter = random.gauss() * f64::from(noise) * 0.3;
        let place = 6000.0 + slope[0] * x + slope[1] * y + jump + bend + jitter;
        if holes > 0 && random.below(holes) == 0 {
            return Err(NoFocus::Broad);
        }
        let noise_q8 = noise / 2 + random.below(20) as u32;
        let sigma_q8 = noise_q8 + width / 2 + random.below(40) as u32;
        Ok(FocusPeak { position_q8: place.max(0.0) as u32, sigma_q8, noise_q8, confidence: 200 })
    };
    (0..columns * rows).map(peak).collect()
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        rng_seed: RngSeed::Fixed(6),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn edges_in_depth_are_their_twins(
        (columns, rows) in (1..40_usize, 1..36_usize), jump in -4000..4000_i64, later_is_nearer: bool,
            frames in 10..40_u32, seed: u64,
    ) {
        let peaks = two_surfaces(columns, rows, jump, seed);
        let numbers: Vec<_> = peaks.iter().map(plain).collect();
        let pulls = twin::pulls(columns, &numbers);
        let (sum, squares) = pulls.iter().fold((0.0, 0.0), |(sum, squares), p| (sum + p, squares + p * p));
        let bound = 2.0 * f64::sqrt(squares);
        // The core cuts both sides of a pull to whole numbers.
        if (f64::abs(sum) - bound).abs() > 6.0 * pulls.len() as f64 + 2.0 {
            let expected = (f64::abs(sum) > bound)
                .then_some(if sum > 0.0 { FocusOrder::FarToNear } else { FocusOrder::NearToFar });
            prop_assert_eq!(FocusOrder::of_answers(&peaks, columns), expected, "{} of {}", sum, bound);
        }

        let order = if later_is_nearer { FocusOrder::FarToNear } else { FocusOrder::NearToFar };
        let mut uncovered = peaks.clone();
        let mut is_hidden = vec![false; peaks.len()];
        for (y, out) in uncovered.chunks_exact_mut(columns).enumerate() {
            uncover_row(&peaks, columns, y, order, out);
        }
        let expected = twin::uncovered(columns, &numbers, later_is_nearer);
        prop_assert_eq!(uncovered.iter().map(plain).collect::<Vec<_>>(), expected.clone());
        for (y, out) in is_hidden.chunks_exact_mut(columns).enumerate() {
            partly_hidden_row(&uncovered, columns, y, order, out);
        }
        prop_assert_eq!(&is_hidden, &twin::partly_hidden(columns, &expected, later_is_nearer));
        let last = f64::from(frames - 1) * 256.0;
        let mut extended = uncovered.clone();
        for (y, out) in extended.chunks_exact_mut(columns).enumerate() {
            extend_row(&uncovered, &is_hidden, columns, y, frames, out);
        }
        for (found, exact) in extended.iter().zip(twin::extended(columns, &expected, &is_hidden, last)) {
            // Rounding to 1/256, and that of 441 sums of 24 bits whose condition the ridge bounds by 200.
            let is_near = match (found.ok(), exact) {
                (Some(found), Some(exact)) => (f64::from(found.position_q8) - exact).abs() <= 1.0,
                (found, exact) => found.is_none() && exact.is_none(),
            };
            prop_assert!(is_near, "{:?} {:?}", found, exact);
        }
    }
}
