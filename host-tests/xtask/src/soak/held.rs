//! The rows of a frame with faults beside those of the frame without, and beside what was done to it.

use super::source::ByTurns;
use super::{Sums, config, resident_kb};
use crate::steps::{Failure, Outcome};
use stereopsis::camera::StereoSource;
use stereopsis::matching::{Method, Row};
use stereopsis::pipeline::{Guarded, Pipeline};
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::fault::{Fault, Record};
use stereopsis_host::map::DisparityMap;

/// A row's disparities, flags and confidences.
#[derive(PartialEq)]
pub struct Kept(Vec<Disparity>, Vec<PixelFlags>, Vec<u8>);

impl From<Row<'_>> for Kept {
    fn from(row: Row<'_>) -> Self {
        Self(row.disparities().to_vec(), row.flags().to_vec(), row.confidences().to_vec())
    }
}

impl Kept {
    /// Row `y` of a map.
    pub fn of(map: &DisparityMap, y: usize) -> Self {
        let at = y * map.width..(y + 1) * map.width;
        let row = (&map.disparity[at.clone()], &map.flags[at.clone()], &map.confidence[at]);
        Self(row.0.to_vec(), row.1.to_vec(), row.2.to_vec())
    }

    /// The row beside the one without a fault.
    pub fn beside(&self, right: &Self) -> Came {
        let is_flagged = self.1.iter().all(|flags| flags.contains(PixelFlags::DAMAGED));
        Came { is_flagged, is_right: self == right }
    }
}

/// What became of a row.
#[derive(Clone, Copy, Debug)]
pub struct Came {
    /// Each of its pixels is flagged as damaged.
    pub is_flagged: bool,
    /// It is the row of the frame without a fault, to the bit.
    pub is_right: bool,
}

/// How many rows above and below a lost line are flagged.
#[derive(Clone, Copy)]
pub struct Reach {
    up: usize,
    down: usize,
}

impl Reach {
    /// That of a method.
    pub fn of<S: Method, const W: usize, const D: usize>(guarded: &Guarded<S, W, D>) -> Self {
        Self { up: Pipeline::<S, W, D>::LATENCY, down: guarded.reach_down() }
    }

    fn holds(self, y: usize, line: u16) -> bool {
        let line = usize::from(line);
        y + self.up >= line && y <= line.saturating_add(self.down)
    }
}

impl Sums {
    /// Adds a frame; an error names the first row that is wrong without a flag, flagged without a fault, or
    /// not flagged in spite of one.
    pub fn add(&mut self, rows: &[Came], lines: u16, reach: Reach, record: &Record) -> Result<(), String> {
        let mut flagged = 0;
        for (y, row) in rows.iter().enumerate() {
            let has_cause = record.lost.iter().any(|&(line, _): &(u16, Fault)| reach.holds(y, line));
            if !row.is_flagged && !row.is_right {
                return Err(format!("row {y} is wrong and not flagged: {record:?}"));
            }
            if row.is_flagged && !has_cause {
                return Err(format!("row {y} is flagged without a fault: {record:?}"));
            }
            if !row.is_flagged && has_cause {
                return Err(format!("row {y} is not flagged in spite of a fault: {record:?}"));
            }
            flagged += u64::from(row.is_flagged);
        }
        // A lost line has a row in its place: only a frame that did not begin or was ended lacks some.
        let has_begun = record.frame.is_none_or(|fault| fault == Fault::FrameSkipped);
        if has_begun && record.ended.is_none() && rows.len() != usize::from(lines) {
            return Err(format!("{} rows of a frame that nothing ended: {record:?}", rows.len()));
        }
        self.frames += 1;
        if self.frames == self.due.div_ceil(4) {
            self.settled_kb = resident_kb()?;
        }
        self.rows += rows.len() as u64;
        self.flagged += flagged;
        self.damaged_frames += u64::from(flagged > 0 || rows.len() != usize::from(lines));
        Ok(())
    }
}

/// The rows of the two pairs without a fault, by their turn.
pub fn reference<S: Method>() -> Outcome<[Vec<Kept>; 2]> {
    let mut source = ByTurns::new()?;
    let mut pipeline = Box::new(Pipeline::<S, 320, 32>::new());
    let failed = |e: &dyn std::fmt::Display| Failure::new(format!("{}: {e}", S::NAME));
    pipeline.start(&config::<S>()).map_err(|e| failed(&e))?;
    let mut frame = || {
        pipeline.begin_frame(&mut source).map_err(|e| failed(&e))?;
        let mut rows = Vec::new();
        while let Some(row) = pipeline.next_row(&mut source).map_err(|e| failed(&e))? {
            rows.push(Kept::from(row));
        }
        if rows.len() != usize::from(source.format().height) {
            return Err(failed(&"a frame without a fault lacks rows"));
        }
        Outcome::Ok(rows)
    };
    // The first turn is 1.
    let (odd, even) = (frame()?, frame()?);
    Ok([even, odd])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is said of so many right rows of ten.
    fn said(rows: usize, record: &Record) -> Result<(), String> {
        let lost: Vec<u16> = record.lost.iter().map(|&(line, _)| line).collect();
        let reach = Reach { up: 0, down: 0 };
        let came = |y| Came { is_flagged: lost.contains(&y), is_right: !lost.contains(&y) };
        let rows: Vec<_> = (0..10).map(came).take(rows).collect();
        Sums::new(100).add(&rows, 10, reach, record)
    }

    #[test]
    fn only_a_frame_that_was_ended_or_did_not_begin_lacks_rows() {
        let untouched = Record::default();
        let lost = Record { lost: vec![(4, Fault::LineDropped)], ..Record::default() };
        let skipped = Record { frame: Some(Fault::FrameSkipped), ..Record::default() };
        for record in [&untouched, &lost, &skipped] {
            assert_eq!(said(10, record), Ok(()));
            assert!(said(5, record).is_err_and(|line| line.starts_with("5 rows")), "{record:?}");
        }
        let ended = Record { ended: Some((5, Fault::FrameShort)), ..lost };
        assert_eq!(said(5, &ended), Ok(()));
        for frame in [Fault::FrameStale, Fault::FrameTimesOut, Fault::FrameFails] {
            assert_eq!(said(0, &Record { frame: Some(frame), ..Record::default() }), Ok(()));
        }
    }
}
