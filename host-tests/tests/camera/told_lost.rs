//! Interleaved streams that say which of their lines are lost.

use super::formats::Memory;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, Interleaved, LineFault, LineFormat, LineSource, LineStart,
    PixelFormat, StereoSource,
};

/// A stream that says which of its lines are lost.
struct Telling {
    stream: Memory,
    lost: Vec<u16>,
}

impl ErrorType for Telling {
    type Error = core::convert::Infallible;
}

impl LineSource for Telling {
    fn format(&self) -> LineFormat {
        self.stream.format()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        self.stream.start_frame()
    }

    fn next_line(&mut self, line: &mut [u8]) -> Result<LineStart, CameraError<Self::Error>> {
        let start = self.stream.next_line(line)?;
        if self.lost.contains(&start.row) { Err(CameraError::LineLost(LineFault::Torn)) } else { Ok(start) }
    }
}

/// Whichever lines a stream says are lost, the row of each is told once and every other row comes.
#[test]
fn lines_that_are_told_to_be_lost_lose_each_row_once() {
    for lost in 0..1u16 << 8 {
        let stream = Memory::new(2, 8, PixelFormat::Grey8, (0..8).flat_map(|row| [row; 2]).collect());
        let lost: Vec<_> = (0..8).filter(|line| lost >> line & 1 == 1).collect();
        let mut source = Interleaved::new(Telling { stream, lost: lost.clone() }, 0).expect("an even height");
        source.start_frame().expect("memory");
        let (mut left, mut right) = ([0; 2], [0; 2]);
        for row in 0..4u16 {
            let is_lost = lost.iter().any(|line| line / 2 == row);
            match source.next_lines(&mut left, &mut right) {
                Ok(start) => {
                    assert!(!is_lost && start.row == row, "{lost:?}: {row}");
                    assert_eq!((left, right), ([2 * row as u8; 2], [2 * row as u8 + 1; 2]));
                }
                Err(e) => assert!(is_lost && e == CameraError::LineLost(LineFault::Torn), "{lost:?}: {row}"),
            }
        }
        assert_eq!(source.next_lines(&mut left, &mut right), Err(CameraError::NoLineLeft), "{lost:?}");
    }
}
