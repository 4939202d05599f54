//! Raw lines that are lost on the way to a rectified pair.

use super::remap::{QVGA, SLOTS, Table, camera, noise, rectified};
use std::convert::Infallible;
use stereopsis::camera::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, StereoSource};
use stereopsis::geometry::rectify::Crop;
use stereopsis::imaging::{RectifiedPair, RemapPair};
use stereopsis_host::fault::{Fault, Faulty};
use stereopsis_host::run::MemoryPair;
use stereopsis_host::twin::remap as twin;

/// Two pairs of pictures in turns, with time stamps.
struct InTurns {
    pairs: [MemoryPair; 2],
    frames: u32,
}

impl ErrorType for InTurns {
    type Error = Infallible;
}

impl StereoSource for InTurns {
    fn format(&self) -> LineFormat {
        self.pairs[0].format()
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        self.frames += 1;
        self.pairs[self.frames as usize % 2].start_frame()?;
        Ok(FrameStart { sequence: self.frames, timestamp_us: u64::from(self.frames) * 1000, exposure_us: 1 })
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Infallible>> {
        let line = self.pairs[self.frames as usize % 2].next_lines(left, right)?;
        Ok(LineStart { timestamp_us: u64::from(self.frames) * 1000 + u64::from(line.row), ..line })
    }
}

/// Every fault of a line, after which a frame goes on.
const FAULTS: [Fault; 9] = [
    Fault::LineDropped,
    Fault::LinePassedOver,
    Fault::LineRepeated,
    Fault::LineTorn,
    Fault::LineLate,
    Fault::LineStale,
    Fault::Bus,
    Fault::BusBefore,
    Fault::TimesOut,
];

/// A rectified row that needs a lost raw one is reported lost, and every other one is what it would be
/// without the fault.
#[test]
fn a_lost_raw_line_loses_the_rows_that_need_it() {
    let lens = camera(QVGA, 300.0, [-0.1, 0.02, 0.0, 0.0, 0.0]);
    let both = rectified(QVGA, [lens, lens], [0.02, 0.01, 0.02], Crop::Alpha(1.0));
    let tables = both.warps().map(|warp| Table::new(&warp).expect("a table"));
    let raw = [8, 9, 10, 11].map(|seed| noise(QVGA, seed));
    let expected = [0, 1, 2, 3].map(|picture| twin::remap(&tables[picture % 2], &raw[picture]).0);
    let pair = |first: usize| {
        let [left, right] = [0, 1].map(|side| raw[first + side].clone().into_raw());
        MemoryPair::new(QVGA.width, left, right).expect("of one size")
    };
    for (faults, rate) in FAULTS.map(|fault| (vec![fault], 0.03)).into_iter().chain([(FAULTS.to_vec(), 0.1)])
    {
        let mut source = Faulty::new(InTurns { pairs: [pair(0), pair(2)], frames: 0 }, &faults, rate, 5);
        let (mut given, mut lost, mut faulty) = (0, 0, 0);
        for _ in 0..6 {
            let mut remaps = Box::new(RemapPair::<320, 40, SLOTS>::empty());
            remaps.set(&both).expect("enough rows");
            let mut rectified = RectifiedPair::new(&mut source, &mut remaps).expect("enough rows for both");
            rectified.start_frame().expect("a frame");
            let mut rows = Vec::new();
            while rows.len() < QVGA.height.into() {
                let [mut left, mut right] = [[0; 320]; 2];
                match rectified.next_lines(&mut left, &mut right) {
                    Ok(start) => {
                        assert_eq!(usize::from(start.row), rows.len());
                        rows.push(Some([left, right]));
                    }
                    Err(CameraError::LineLost(_)) => rows.push(None),
                    Err(CameraError::Hardware(_) | CameraError::TimedOut) => {}
                    Err(error) => {
                        assert_eq!(error, CameraError::NoLineLeft);
                        break;
                    }
                }
            }
            let record = source.record();
            // Of a bus that fails before the line, the line comes with the next call.
            let gone: Vec<_> = record
                .lost
                .iter()
                .filter(|(_, fault)| *fault != Fault::BusBefore)
                .map(|(row, _)| *row)
                .collect();
            let first = 2 * (source.inner().frames as usize % 2);
            for (row, lines) in rows.iter().enumerate() {
                let mut needs = tables.iter().filter_map(|table| table.raw_rows(row as u16));
                let needs_lost =
                    needs.any(|(first, last)| gone.iter().any(|row| (first..=last).contains(row)));
                assert_eq!(lines.is_none(), needs_lost, "{faults:?}, row {row}, lost {gone:?}");
                for (lines, picture) in lines.iter().flatten().zip(&expected[first..]) {
                    assert_eq!(lines[..], picture.as_raw()[row * 320..][..320], "{faults:?}, row {row}");
                }
            }
            given += rows.iter().flatten().count();
            lost += rows.iter().filter(|row| row.is_none()).count();
            faulty += record.lost.len() + record.repeated as usize;
        }
        assert!(given > 200 && faulty > 20, "{faults:?}: {given} rows, {lost} lost by {faulty} faults");
    }
}
