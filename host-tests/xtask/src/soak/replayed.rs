//! A recording that is written while it is played, through what `stereo replay` plays recordings with.

use super::held::{Kept, Reach, reference};
use super::source::{Done, Reporting};
use super::{HEIGHT, RATES, Sums, config};
use crate::steps::{Failure, Outcome};
use std::io::{BufReader, BufWriter};
use std::path::Path;
use std::sync::mpsc::{Receiver, channel, sync_channel};
use std::thread;
use stereopsis::matching::{Config, Method};
use stereopsis::pipeline::{FaultCounters, Guarded};
use stereopsis_host::recording::{Ahead, Playback, Recording, Seen, first_pairs, record};
use stereopsis_host::run::{GuardedFrame, MethodName, run_guarded};

/// Frames that wait to be compared: a recording has no end, and memory has.
const WAITING: usize = 4;

/// Frames at each rate with one method.
pub fn soak<S: Method>(frames: u32) -> Outcome {
    let reference = reference::<S>()?;
    let config = config::<S>();
    let mut guarded = Box::new(Guarded::<S, 320, 32>::new());
    guarded.start(&config).map_err(|e| Failure::new(format!("{}: {e}", S::NAME)))?;
    let reach = Reach::of(&guarded);
    for (seed, rate) in RATES.into_iter().enumerate() {
        let failed = |what: String| Failure::new(format!("replayed, {}, rate {rate}: {what}", S::NAME));
        let (reader, writer) = std::io::pipe().map_err(|e| failed(e.to_string()))?;
        let (to, done) = channel();
        let mut source = Reporting::new(rate, seed as u64 + 100, to)?;
        let (keep, kept) = sync_channel::<GuardedFrame>(WAITING);
        let (sums, counters, recorded) = thread::scope(|scope| {
            let recording = scope.spawn(move || {
                let recorded = record(&mut source, frames, &mut BufWriter::new(writer));
                source.report();
                recorded
            });
            let playing = scope.spawn(|| {
                let keep = keep;
                let recording = Recording::read(Path::new("pipe"), Box::new(BufReader::new(reader)));
                let recording = recording.map_err(|e| e.to_string())?;
                play::<S>(recording, &config, |frame| {
                    // Nobody listens any more when a row was wrong.
                    let _ = keep.send(frame);
                })
            });
            let sums = compare(frames, kept, &done, &reference, reach);
            (sums, playing.join(), recording.join())
        });
        let sums = sums.map_err(failed)?;
        let counters = counters.map_err(|_| failed("playing it panics".into()))?.map_err(failed)?;
        let recorded = recorded.map_err(|_| failed("recording it panics".into()))?;
        recorded.map_err(|e| failed(e.to_string()))?;
        if sums.frames != frames {
            return Err(failed(format!("{} of {frames} frames were played", sums.frames)));
        }
        if u64::from(counters.rows) != sums.rows || u64::from(counters.rows_damaged) != sums.flagged {
            return Err(failed(format!("{counters:?} are not its rows")));
        }
        sums.tell("replay", S::NAME, rate)?;
        sums.is_flat("replay", S::NAME)?;
    }
    Ok(())
}

/// Plays all of it, as `stereo replay` does.
fn play<S: Method>(
    recording: Recording,
    config: &Config,
    keep: impl FnMut(GuardedFrame) + Send,
) -> Result<FaultCounters, String> {
    let method: MethodName = S::NAME.parse().map_err(|_| format!("{} is no method", S::NAME))?;
    let (header, seen) = (recording.header(), Seen::default());
    let (_, records) = first_pairs(recording, 1);
    let mut source = Playback::new(Ahead::new(records, header, false, &seen), header, false);
    let next = |source: &mut Playback<_>| source.has_frame().then_some(*config);
    let counters = run_guarded(method, config, None, &mut source, next, keep).map_err(|e| e.to_string())?;
    match source.failed() {
        Some(e) => Err(e.to_string()),
        None => Ok(counters),
    }
}

/// Each frame beside what was done to it.
fn compare(
    frames: u32,
    kept: Receiver<GuardedFrame>,
    done: &Receiver<Done>,
    reference: &[Vec<Kept>; 2],
    reach: Reach,
) -> Result<Sums, String> {
    let mut sums = Sums::new(frames);
    for frame in kept {
        let (turn, record) = done.recv().map_err(|_| "more frames are played than were recorded")?;
        let row = |(y, right): (usize, &Kept)| Kept::of(&frame.map, y).beside(right);
        let rows: Vec<_> = reference[turn].iter().enumerate().take(frame.rows.into()).map(row).collect();
        let number = sums.frames;
        sums.add(&rows, HEIGHT, reach, &record).map_err(|what| format!("frame {number}: {what}"))?;
    }
    Ok(sums)
}
