//! Lost lines where answers are refused as unsure.

use super::changing::{config, frames, reference_of};
use super::faults::{RATES, guarded_by};
use stereopsis::imaging::Noise;
use stereopsis::matching::{Block, Checks, Config, Fast};
use stereopsis::pipeline::Guarded;
use stereopsis::units::PixelFlags;
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
