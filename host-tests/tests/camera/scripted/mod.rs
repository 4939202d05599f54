//! Cameras that do what a test says, and what stands on cameras.
//!
//! * `pair`: two cameras as one source. `grey`: any pixel format as grey. `trigger`: the common trigger pin.

mod grey;
mod pair;
mod trigger;

use stereopsis::camera::{
    CameraError, CameraPair, ErrorType, FrameStart, LineFormat, LineSource, LineStart, PixelFormat,
    StereoSource,
};
use stereopsis_host::scene::Scene;

/// The hardware's error of the cameras here: which line failed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LineFault(u16);

impl std::fmt::Display for LineFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "line {} is lost", self.0)
    }
}

/// A camera that does what a test says.
#[derive(Clone, Debug)]
struct Camera {
    format: LineFormat,
    /// Bytes of the lines, one after the other, the same in every frame.
    lines: Vec<u8>,
    /// Sequence numbers of the coming frames; then they count on.
    sequences: Vec<u32>,
    /// Added to all time stamps.
    late_us: u64,
    /// The line that fails.
    fault: Option<u16>,
    /// The line that says another row than its own.
    wrong_row: Option<u16>,
    starts: usize,
    sequence: u32,
    row: u16,
}

const SMALL: LineFormat = LineFormat { width: 4, height: 3, pixel: PixelFormat::Grey8 };

fn camera(format: LineFormat, lines: Vec<u8>) -> Camera {
    assert_eq!(lines.len(), format.line_bytes() * usize::from(format.height));
    let row = format.height;
    Camera {
        format,
        lines,
        sequences: Vec::new(),
        late_us: 0,
        fault: None,
        wrong_row: None,
        starts: 0,
        sequence: u32::MAX,
        row,
    }
}

/// A small camera whose pixels are `first`, `first + 1`, ...
fn small(first: u8) -> Camera {
    camera(SMALL, (first..first + 12).collect())
}

/// A small camera whose next frames have these sequence numbers.
fn numbered(sequences: &[u32]) -> Camera {
    Camera { sequences: sequences.iter().rev().copied().collect(), ..small(0) }
}

impl ErrorType for Camera {
    type Error = LineFault;
}

impl LineSource for Camera {
    fn format(&self) -> LineFormat {
        self.format
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<LineFault>> {
        self.starts += 1;
        self.row = 0;
        self.sequence = self.sequences.pop().unwrap_or_else(|| self.sequence.wrapping_add(1));
        let timestamp_us = u64::from(self.sequence) * 1000 + self.late_us;
        Ok(FrameStart { sequence: self.sequence, timestamp_us, exposure_us: 7 })
    }

    fn next_line(&mut self, line: &mut [u8]) -> Result<LineStart, CameraError<LineFault>> {
        if self.row >= self.format.height {
            return Err(CameraError::NoLineLeft);
        }
        let needed = self.format.line_bytes();
        let Some(line) = line.get_mut(..needed) else { return Err(CameraError::BufferTooShort { needed }) };
        let row = self.row;
        if self.fault == Some(row) {
            return Err(CameraError::Hardware(LineFault(row)));
        }
        self.row += 1;
        line.copy_from_slice(&self.lines[usize::from(row) * needed..][..needed]);
        let told = if self.wrong_row == Some(row) { row + 1 } else { row };
        Ok(LineStart {
            row: told,
            timestamp_us: u64::from(self.sequence) * 1000 + u64::from(row) + self.late_us,
        })
    }
}

fn pair(left: Camera, right: Camera) -> CameraPair<Camera, Camera> {
    CameraPair::new(left, right, 5).expect("the formats are equal")
}

#[test]
fn a_scene_is_a_camera() {
    let scene = Scene::small(24, 18);
    let mut source = scene.camera();
    let (left, right) = scene.render();
    assert_eq!(source.pictures(), (&left, &right));
    assert_eq!(source.format(), LineFormat { width: 24, height: 18, pixel: PixelFormat::Grey8 });
    assert_eq!(source.max_row_skew_us(), 0);
    let (mut l, mut r) = ([7; 25], [7; 25]);
    assert_eq!(source.next_lines(&mut l, &mut r), Err(CameraError::NoLineLeft), "no frame was started");
    let mut last_us = 0;
    for sequence in 0..3 {
        let start = source.start_frame().expect("a scene does not fail");
        assert_eq!(start.sequence, sequence);
        assert!(sequence == 0 || start.timestamp_us > last_us, "time goes on");
        assert_eq!(source.next_lines(&mut l[..23], &mut r), Err(CameraError::BufferTooShort { needed: 24 }));
        for row in 0..18 {
            let line = source.next_lines(&mut l, &mut r).expect("a scene does not fail");
            assert_eq!(line.row, row);
            assert!(line.timestamp_us >= start.timestamp_us && line.timestamp_us >= last_us);
            last_us = line.timestamp_us;
            assert_eq!(l[..24], left.as_raw()[usize::from(row) * 24..][..24]);
            assert_eq!(r[..24], right.as_raw()[usize::from(row) * 24..][..24]);
            assert_eq!((l[24], r[24]), (7, 7));
        }
        assert_eq!(source.next_lines(&mut l, &mut r), Err(CameraError::NoLineLeft));
    }
}
