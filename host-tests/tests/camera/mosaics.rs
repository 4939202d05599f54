//! Lost lines of a mosaic, and lines that are not there yet.

use super::formats::Memory;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFault, LineFormat, LineSource, LineStart, PixelFormat,
};
use stereopsis::imaging::BayerLines;

/// The rows and first pixels that a mosaic of rows of 0, 4, 8, ... gives without some of its lines.
fn mosaic(height: u16, missing: &[u16]) -> Vec<Option<(u16, u8)>> {
    let bytes = (0..height as u8).flat_map(|row| [row * 4; 3]).collect();
    let source = Memory::new(3, height, PixelFormat::Bayer8, bytes).without(missing);
    let mut lines = BayerLines::<_, 3, 3>::new(source).expect("room");
    let mut rows = Vec::new();
    // What is left of a frame is nothing to the next one.
    for _ in 0..2 {
        lines.start_frame().expect("memory");
        rows.clear();
        loop {
            let mut out = [0; 3];
            match lines.next_line(&mut out) {
                Ok(start) => rows.push(Some((start.row, out[0]))),
                Err(CameraError::LineLost(LineFault::Dropped)) => rows.push(None),
                Err(_) => break,
            }
        }
    }
    rows
}

#[test]
fn a_mosaics_lost_line_loses_the_rows_that_need_it() {
    // Row 2 has no line below, row 3 none at all.
    assert_eq!(mosaic(6, &[3]), [Some((0, 2)), Some((1, 6)), None, Some((4, 18)), Some((5, 18))]);
    // The last row rests on the line above it.
    assert_eq!(mosaic(6, &[4]), [Some((0, 2)), Some((1, 6)), Some((2, 10)), None, None]);
    assert_eq!(mosaic(4, &[0, 2]), [None, None]);
    assert_eq!(mosaic(2, &[]), [Some((0, 2)), Some((1, 2))]);
    assert_eq!(mosaic(1, &[]), [Some((0, 0))]);
}

/// A source that has nothing yet before every other line.
struct Pausing(Memory, bool);

impl ErrorType for Pausing {
    type Error = <Memory as ErrorType>::Error;
}

impl LineSource for Pausing {
    fn format(&self) -> LineFormat {
        self.0.format()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        self.0.start_frame()
    }

    fn next_line(&mut self, line: &mut [u8]) -> Result<LineStart, CameraError<Self::Error>> {
        self.1 = !self.1;
        if self.1 { Err(CameraError::WouldBlock) } else { self.0.next_line(line) }
    }
}

#[test]
fn a_mosaic_goes_on_where_its_source_had_nothing_yet() {
    let bytes = (0..4).flat_map(|row| [row * 4; 3]).collect();
    let source = Pausing(Memory::new(3, 4, PixelFormat::Bayer8, bytes), false);
    let mut lines = BayerLines::<_, 3, 3>::new(source).expect("room");
    lines.start_frame().expect("memory");
    let (mut rows, mut pauses) = (Vec::new(), 0);
    while rows.len() < 4 {
        let mut out = [0; 3];
        match lines.next_line(&mut out) {
            Err(CameraError::WouldBlock) => pauses += 1,
            start => rows.push((start.expect("a line").row, out[0])),
        }
    }
    assert_eq!((rows, pauses), (vec![(0, 2), (1, 6), (2, 10), (3, 10)], 4));
}
