//! Lost lines where answers are refused as unsure.

use super::changing::{config, frames, reference_of};
use super::faults::{RATES, guarded_by};
use stereopsis::imaging::Noise;
use stereopsis::matching::{Block, Capacity, Checks, Config, Fast, Method, Sgm, Supported};
use stereopsis::pipeline::{Guarded, Pipeline};
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::fault::Fault;

/// Rows that are flagged and keep their answers stand above rows without a flag, which look at what was
/// refused of them as unsure.
#[test]
fn what_is_refused_as_unsure_in_a_flagged_row_is_seen_below_it() {
    let mut refused = 0;
    for noise in [Noise::None, Noise::High] {
        for min_confidence in [60, 95] {
            let least = Config { noise, min_confidence, ..config::<Block>() };
            let least =
                Config { checks: Checks { speckle_pixels: 0, median: false, ..least.checks }, ..least };
            let reference = reference_of::<Block>(&least);
            let flags = reference.iter().flatten().flat_map(|row| &row.flags);
            refused += flags.filter(|flags| flags.contains(PixelFlags::AMBIGUOUS)).count();
            for rate in RATES {
                guarded_by::<Block>(&least, &[Fault::LineDropped], rate, frames(400), &reference);
            }
        }
    }
    assert!(refused > 100, "{refused} answers were unsure");
}

/// What is open is so from the first row down: a lost line may change it for all rows below.
#[test]
fn a_lost_line_reaches_the_last_row_where_open_places_are_looked_for() {
    let with = |checks: Checks| {
        let mut pipeline = Box::new(Guarded::<Fast, 64, 32>::new());
        pipeline
            .start(&Config { checks, ..Config::for_method::<Fast>(64, 48, 32) })
            .expect("a configuration");
        pipeline.reach_down()
    };
    let few = Checks { speckle_pixels: 6, ..Checks::DEFAULT };
    assert!(with(few) < 20);
    assert_eq!(with(Checks { open_run: 5, ..few }), usize::MAX);
    assert_eq!(with(Checks { open_margin: 52, ..few }), usize::MAX);
}

/// Answers and confidences of a noisy plane, of which each camera does not see so many columns in the first
/// row, and fewer below.
fn masked<S: Method>(min_confidence: u8, unseen: [usize; 2]) -> Vec<(Disparity, u8)>
where
    Capacity<16>: Supported,
{
    let grey = |u: usize, v: usize| ((u * 977 + v * 331) as u32).wrapping_mul(0x9e37_79b1).to_be_bytes()[0];
    let mut pipeline = Box::new(Pipeline::<S, 64, 16>::new());
    let config = Config { confidence: true, min_confidence, ..Config::for_method::<S>(64, 40, 16) };
    pipeline.start(&config).expect("a configuration");
    pipeline.begin().expect("a frame");
    let mut out = Vec::new();
    for y in 0.. {
        let left: [u8; 64] = std::array::from_fn(|x| grey(x / 2, y / 2));
        let right: [u8; 64] = std::array::from_fn(|x| {
            let less = if (x / 3 + y / 3) % 3 == 0 { 0 } else { 6 };
            grey((x + 5) / 2, y / 2) ^ (grey(7 * x + 99, 3 * y + 7) >> less)
        });
        let came = if y < 40 { pipeline.push(&left, &right) } else { pipeline.flush() };
        if came.expect("a line that is due").is_none() {
            if y < 40 { continue } else { break }
        }
        pipeline.mask(|row, masks| {
            for (mask, unseen) in masks.into_iter().zip(unseen) {
                mask.fill(1);
                mask[..unseen.saturating_sub(usize::from(row) / 2)].fill(0);
            }
            true
        });
        let row = pipeline.row().expect("a row");
        out.extend(row.disparities().iter().copied().zip(row.confidences().iter().copied()));
    }
    out
}

/// What is refused as unsure and has no partner that was seen is gone for the rows below, too.
#[test]
fn sure_answers_beside_a_mask_are_as_if_the_unsure_ones_were_not_asked_for() {
    fn compare<S: Method>(unseen: [usize; 2])
    where
        Capacity<16>: Supported,
    {
        let all = masked::<S>(0, unseen);
        for least in [60, 90, 120, 140, 160] {
            let sure = |&(answer, confidence): &(Disparity, u8)| {
                if confidence < least { (Disparity::NONE, 0) } else { (answer, confidence) }
            };
            let expected: Vec<_> = all.iter().map(sure).collect();
            assert_eq!(masked::<S>(least, unseen), expected, "{least}, {unseen:?}");
        }
    }
    for unseen in [[0, 0], [30, 0], [0, 30]] {
        compare::<Block>(unseen);
        compare::<Sgm>(unseen);
    }
}
