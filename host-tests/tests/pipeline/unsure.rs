//! Lost lines where answers are refused as unsure.

use super::changing::{config, frames, reference_of};
use super::faults::{RATES, guarded_by};
use stereopsis::imaging::Noise;
use stereopsis::matching::{Block, Checks, Config};
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
