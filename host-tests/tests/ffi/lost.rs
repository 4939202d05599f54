//! Lines that were lost, told from C, are those of a guarded pipeline.

use super::*;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFault, LineFormat, LineStart, PixelFormat, StereoSource,
};
use stereopsis::ffi::{CCounters, STEREOPSIS_LOST_LATE, STEREOPSIS_NOISE_HIGH};
use stereopsis::pipeline::Guarded;

/// A source that loses some lines and says so.
struct Losing<'a> {
    lines: [&'a [Vec<u8>]; 2],
    lost: &'a [usize],
    next: usize,
}

impl ErrorType for Losing<'_> {
    type Error = std::convert::Infallible;
}

impl StereoSource for Losing<'_> {
    fn format(&self) -> LineFormat {
        let size = |n: usize| u16::try_from(n).expect("small");
        LineFormat {
            width: size(self.lines[0][0].len()),
            height: size(self.lines[0].len()),
            pixel: PixelFormat::Grey8,
        }
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        self.next = 0;
        Ok(FrameStart::default())
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>> {
        let row = self.next;
        self.next += 1;
        if self.lost.contains(&row) {
            return Err(CameraError::LineLost(LineFault::Late));
        }
        for (to, from) in [left, right].into_iter().zip(self.lines) {
            to.copy_from_slice(&from[row]);
        }
        Ok(LineStart { row: row as u16, ..LineStart::default() })
    }
}

#[test]
fn lost_lines_are_those_of_a_guarded_pipeline() {
    let (width, height) = (50, 40);
    let [left, right] = lines(width, height);
    for lost in [&[][..], &[0], &[39], &[7, 8, 20], &[3, 31, 32, 33, 38]] {
        let mut guarded = Box::new(Guarded::<Block, WIDTH, DISPARITIES>::new());
        guarded
            .start(&matching::Config::for_method::<matching::Block>(width, height, 32))
            .expect("the configuration is valid");
        let mut source = Losing { lines: [&left, &right], lost, next: 0 };
        guarded.begin_frame(&mut source).expect("a frame");
        let mut expected = Vec::new();
        while let Some(row) = guarded.next_row(&mut source).expect("no line ends it") {
            let raw: Vec<u16> = row.disparities().iter().map(|d| d.raw()).collect();
            expected.push((row.index(), raw, row.flags().iter().map(|f| f.bits()).collect::<Vec<_>>()));
        }

        let mut memory = memory();
        let (_, handle) = init(&mut memory, 0, stereopsis_size());
        let config = config(width, height, 32);
        let mut found = Vec::new();
        let mut counters = CCounters::default();
        // SAFETY: the handle is from `init`, lines have their length, and rows are read before the next call.
        unsafe {
            assert_eq!(stereopsis_start(handle, &raw const config), Status::Ok);
            assert_eq!(stereopsis_begin_frame(handle), Status::Ok);
            let mut row = NO_ROW;
            let mut due = 0..usize::from(height);
            loop {
                let status = match due.next() {
                    Some(y) if lost.contains(&y) => {
                        stereopsis_push_lost(handle, STEREOPSIS_LOST_LATE, &raw mut row)
                    }
                    Some(y) => stereopsis_push(
                        handle,
                        left[y].as_ptr(),
                        right[y].as_ptr(),
                        width.into(),
                        &raw mut row,
                    ),
                    None => stereopsis_flush(handle, &raw mut row),
                };
                match status {
                    Status::NoRowYet => continue,
                    Status::FrameDone => break,
                    status => assert_eq!(status, Status::Ok),
                }
                let disparities = std::slice::from_raw_parts(row.disparities, row.width.into()).to_vec();
                found.push((
                    row.index,
                    disparities,
                    std::slice::from_raw_parts(row.flags, row.width.into()).to_vec(),
                ));
            }
            assert_eq!(stereopsis_counters(handle, &raw mut counters), Status::Ok);
            // Another configuration leaves them, and begins no frame.
            let (noisy, mut after) =
                (CConfig { noise: STEREOPSIS_NOISE_HIGH, ..config }, CCounters::default());
            assert_eq!(stereopsis_restart(handle, &raw const noisy), Status::Ok);
            assert_eq!(stereopsis_flush(handle, &raw mut row), Status::NotBegun);
            assert_eq!(stereopsis_counters(handle, &raw mut after), Status::Ok);
            assert_eq!(after, counters);
            assert_eq!(stereopsis_start(handle, &raw const noisy), Status::Ok);
            assert_eq!(stereopsis_counters(handle, &raw mut after), Status::Ok);
            assert_eq!(after, CCounters::default());
            assert_eq!(stereopsis_deinit(handle), Status::Ok);
        }
        assert!(found == expected, "{lost:?}");
        assert_eq!(counters, CCounters::from(guarded.counters()), "{lost:?}");
        assert_eq!(counters.lines_late as usize, lost.len());
    }
}
