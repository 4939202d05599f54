//! The camera before the pipeline.

use super::held::{Came, Kept, Reach, reference};
use super::source::ByTurns;
use super::{HEIGHT, RATES, Sums, config};
use crate::steps::{Failure, Outcome};
use stereopsis::matching::Method;
use stereopsis::pipeline::Guarded;
use stereopsis_host::fault::{Fault, Faulty};

/// Frames at each rate with one method.
pub fn soak<S: Method>(frames: u32) -> Outcome {
    let reference = reference::<S>()?;
    for (seed, rate) in RATES.into_iter().enumerate() {
        let mut source = Faulty::new(ByTurns::new()?, &Fault::ALL, rate, seed as u64 + 1);
        let mut guarded = Box::new(Guarded::<S, 320, 32>::new());
        guarded.start(&config::<S>()).map_err(|e| Failure::new(format!("{}: {e}", S::NAME)))?;
        let reach = Reach::of(&guarded);
        let mut sums = Sums::new(frames);
        for number in 0..frames {
            let rows = frame(&mut guarded, &mut source, &reference);
            let added = sums.add(&rows, HEIGHT, reach, source.record());
            added
                .map_err(|what| Failure::new(format!("{}, rate {rate}, frame {number}: {what}", S::NAME)))?;
        }
        let counters = guarded.counters();
        if u64::from(counters.rows) != sums.rows || u64::from(counters.rows_damaged) != sums.flagged {
            return Err(Failure::new(format!("{}, rate {rate}: {counters:?} are not its rows", S::NAME)));
        }
        sums.tell("camera", S::NAME, rate)?;
        sums.is_flat("camera", S::NAME)?;
    }
    Ok(())
}

/// The rows of one frame.
fn frame<S: Method>(
    guarded: &mut Guarded<S, 320, 32>,
    source: &mut Faulty<ByTurns>,
    reference: &[Vec<Kept>; 2],
) -> Vec<Came> {
    let mut rows = Vec::new();
    if guarded.begin_frame(source).is_err() {
        return rows;
    }
    let right = &reference[source.inner().turn()];
    while let Ok(Some(row)) = guarded.next_row(source) {
        rows.push(Kept::from(row).beside(&right[rows.len()]));
    }
    rows
}
