//! Streams that say which of their lines are lost: interleaved, and two as a pair.

use super::formats::Memory;
use stereopsis::camera::{
    CameraError, CameraPair, ErrorType, FrameStart, Interleaved, LineFault, LineFormat, LineSource,
    LineStart, PairError, PixelFormat, StereoSource,
};

/// A stream that says which of its lines are lost.
struct Telling {
    stream: Memory,
    lost: Vec<u16>,
    /// Lines that never come, and of which nothing is said.
    dropped: Vec<u16>,
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
        let mut start = self.stream.next_line(line)?;
        while self.dropped.contains(&start.row) {
            start = self.stream.next_line(line)?;
        }
        if self.lost.contains(&start.row) { Err(CameraError::LineLost(LineFault::Torn)) } else { Ok(start) }
    }
}

/// Whichever lines a stream says are lost, the row of each is told once and every other row comes.
#[test]
fn lines_that_are_told_to_be_lost_lose_each_row_once() {
    for lost in 0..1u16 << 8 {
        let stream = Memory::new(2, 8, PixelFormat::Grey8, (0..8).flat_map(|row| [row; 2]).collect());
        let lost: Vec<_> = (0..8).filter(|line| lost >> line & 1 == 1).collect();
        let stream = Telling { stream, lost: lost.clone(), dropped: Vec::new() };
        let mut source = Interleaved::new(stream, 0).expect("an even height");
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

/// The camera that is behind skips as many lines as it is, though one of them is lost.
#[test]
fn a_pair_fails_once_for_lines_that_one_camera_lost() {
    for lost in [vec![], vec![4], vec![5], vec![4, 5]] {
        let camera = |lost: &[u16], dropped: &[u16]| Telling {
            stream: Memory::new(2, 8, PixelFormat::Grey8, (0..8).flat_map(|row| [row; 2]).collect()),
            lost: lost.to_vec(),
            dropped: dropped.to_vec(),
        };
        let mut source = CameraPair::new(camera(&lost, &[]), camera(&[], &[3, 4]), 0).expect("one format");
        source.start_frame().expect("memory");
        let (mut left, mut right) = ([0; 2], [0; 2]);
        for row in [Some(0), Some(1), Some(2), None, Some(6), Some(7)] {
            let told = source.next_lines(&mut left, &mut right).map(|start| start.row);
            let apart = CameraError::Hardware(PairError::Rows { left: 3, right: 5 });
            assert_eq!(told, row.ok_or(apart), "{lost:?}");
            assert!(row.is_none_or(|row| left == [row as u8; 2] && left == right), "{lost:?}: {row:?}");
        }
    }
}
