//! A recording on an emulated Cortex-M4: what the board tells of each row is what the host tells, to the bit,
//! and the host's rows are held to the frames without a fault.

use super::held::{Came, Reach};
use super::source::{ByTurns, Done, Reporting};
use super::{RATES, Sums};
use crate::firmware::{Optimised, Ran};
use crate::setup;
use crate::steps::{Failure, Outcome};
use firmware_boards::M4;
use firmware_scenes::soak::{HEIGHT, Soaked, Told, counts, frame, start};
use std::io::Cursor;
use std::path::Path;
use std::sync::mpsc::channel;
use stereopsis_host::recording::{Playback, Recording, record};

/// Frames at each rate.
pub fn soak(frames: u32) -> Outcome {
    setup::firmware(&[M4.target])?;
    let clean = reference()?;
    // Memory is the host's, which holds a recording at a time.
    for (seed, rate) in RATES.into_iter().enumerate() {
        let failed = |what: String| Failure::new(format!("on an M4, rate {rate}: {what}"));
        let (to, done) = channel();
        let mut source = Reporting::new(rate, seed as u64 + 200, to)?;
        let mut recording = Vec::new();
        record(&mut source, frames, &mut recording).map_err(|e| failed(e.to_string()))?;
        source.report();
        drop(source);
        let (told, sums) = of_host(frames, &recording, done.iter(), &clean).map_err(failed)?;
        let ran = Ran::with(M4, "soak", Optimised::Speed, &[("soak.lines", &recording)], &told)?;
        for (name, of_host) in [("frames", u64::from(sums.frames)), ("rows", sums.rows)] {
            if ran.figure(name)? != of_host {
                return Err(failed(format!("{} {name}, the host has {of_host}", ran.figure(name)?)));
            }
        }
        if ran.figure("rows_damaged")? != sums.flagged {
            return Err(failed("its counters are not its rows".into()));
        }
        sums.tell(M4.core, "fast", rate)?;
    }
    Ok(())
}

/// What is told of the two pairs' frames without a fault, by their turn.
fn reference() -> Outcome<[Vec<Told>; 2]> {
    let (mut source, mut pipeline) = (ByTurns::new()?, Box::new(Soaked::new()));
    start(&mut pipeline).map_err(|e| Failure::new(e.to_string()))?;
    let mut next = || {
        let mut rows = Vec::new();
        frame(&mut pipeline, &mut source, |told| rows.push(told));
        rows
    };
    // The first turn is 1.
    let (odd, even) = (next(), next());
    Ok([even, odd])
}

/// The bytes of `soak.bin`, and what came of the frames.
fn of_host(
    frames: u32,
    recording: &[u8],
    mut done: impl Iterator<Item = Done>,
    clean: &[Vec<Told>; 2],
) -> Result<(Vec<u8>, Sums), String> {
    let recording = Recording::read(Path::new("recording"), Box::new(Cursor::new(recording.to_vec())));
    let recording = recording.map_err(|e| e.to_string())?;
    let header = recording.header();
    let mut source = Playback::new(recording, header, false);
    let mut pipeline = Box::new(Soaked::new());
    start(&mut pipeline).map_err(|e| e.to_string())?;
    let reach = Reach::of(&pipeline);
    let (mut bytes, mut sums) = (Vec::new(), Sums::new(frames));
    while source.has_frame() {
        let (turn, record) = done.next().ok_or("more frames are played than were recorded")?;
        let mut rows = Vec::new();
        frame(&mut pipeline, &mut source, |told| {
            bytes.extend(told.bytes());
            if let Told::Row(_, is_flagged) = told {
                rows.push(Came { is_flagged, is_right: clean[turn].get(rows.len()) == Some(&told) });
            }
        });
        let number = sums.frames;
        sums.add(&rows, HEIGHT, reach, &record).map_err(|what| format!("frame {number}: {what}"))?;
    }
    bytes.extend(counts(pipeline.counters()).into_iter().flat_map(u32::to_le_bytes));
    Ok((bytes, sums))
}
