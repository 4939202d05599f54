//! The pipeline: line windows and a matcher in one block of memory.

use super::error::begun;
use super::{PipelineError, PushError};
use crate::camera::{FrameStart, LineFormat, PixelFormat, StereoSource};
use crate::imaging::LineWindow;
use crate::matching::{
    Capacity, Config, ConfigError, Kernel, KernelError, MatchError, Matcher, Method, Row, Supported,
};

/// Disparity rows from a stereo source, in fixed-size memory that fits a `static`.
///
/// Row y comes out when line y + [`Pipeline::LATENCY`] is in; the last rows come after the frame's last line.
///
/// Lines are pulled or pushed, with equal results: [`Self::begin_frame`] and [`Self::next_row`] read a camera
/// as needed; with [`Self::begin`], [`Self::push`] and [`Self::flush`] the caller passes lines, from an
/// interrupt's buffer or from C.
#[doc = "```"]
#[doc = "use stereopsis::{matching::{Block, Config}, pipeline::Pipeline};"]
#[doc = "static PIPELINE: Pipeline<Block, 320, 64> = Pipeline::new();"]
#[doc = "assert!(size_of_val(&PIPELINE) < 48_000);"]
#[doc = "assert_eq!(Pipeline::<Block, 320, 64>::LATENCY, 10);"]
#[doc = "```"]
pub struct Pipeline<S: Method, const W: usize, const D: usize> {
    pub(super) left: LineWindow<W>,
    pub(super) right: LineWindow<W>,
    pub(super) matcher: Matcher<S, W, D>,
    /// Number of rows that the matcher took.
    taken: usize,
    height: usize,
}

impl<S: Method, const W: usize, const D: usize> Pipeline<S, W, D> {
    /// Number of lines below a row that its census reads.
    pub(super) const CENSUS_REACH: usize = 2;

    /// Delay in lines: row y comes out when line y + `LATENCY` is in.
    pub const LATENCY: usize = Self::CENSUS_REACH + Matcher::<S, W, D>::DELAY;

    /// Creates a pipeline that awaits [`Self::start`]. All its bytes are zero, so that a static takes no
    /// flash.
    pub const fn new() -> Self
    where
        Capacity<D>: Supported,
    {
        Self {
            left: LineWindow::new(),
            right: LineWindow::new(),
            matcher: Matcher::new(),
            taken: 0,
            height: 0,
        }
    }

    /// Checks the configuration and prepares for the first frame.
    pub fn start(&mut self, config: &Config) -> Result<(), ConfigError> {
        self.matcher.start(config)?;
        self.height = usize::from(config.height);
        self.stop();
        Ok(())
    }

    /// Chooses the kernel from the next frame on; every kernel gives the same bits.
    pub fn set_kernel(&mut self, kernel: Kernel) -> Result<(), KernelError> {
        self.matcher.set_kernel(kernel)
    }

    /// Returns the kernel in use.
    pub fn kernel(&self) -> Kernel {
        self.matcher.kernel()
    }

    /// Waits for the camera's next frame, and drops the one before.
    pub fn begin_frame<C: StereoSource>(
        &mut self,
        camera: &mut C,
    ) -> Result<FrameStart, PipelineError<C::Error>> {
        self.stop();
        let config = *self.matcher.config();
        let needed = LineFormat { width: config.width, height: config.height, pixel: PixelFormat::Grey8 };
        let given = camera.format();
        if self.height == 0 {
            return Err(MatchError::NotStarted.into());
        }
        if given != needed {
            return Err(PipelineError::Format { camera: given, needed });
        }
        let start = camera.start_frame()?;
        self.begin()?;
        Ok(start)
    }

    /// Returns the next row, reading as many lines from the camera as needed; `None` after the frame's last
    /// row. An error ends the frame.
    pub fn next_row<C: StereoSource>(
        &mut self,
        camera: &mut C,
    ) -> Result<Option<Row<'_>>, PipelineError<C::Error>> {
        match self.advance(|pipeline| pipeline.take_lines(camera)) {
            Ok(is_out) => {
                if is_out {
                    self.matcher.mask(|row, masks| camera.mask(row, masks));
                }
                Ok(self.row().filter(|_| is_out))
            }
            Err(e) => {
                if !e.is_pause() {
                    self.stop();
                }
                Err(e)
            }
        }
    }

    /// Begins a frame whose lines are pushed, and drops the one before.
    pub fn begin(&mut self) -> Result<(), MatchError> {
        if self.height == 0 {
            return Err(MatchError::NotStarted);
        }
        self.stop();
        let width = usize::from(self.matcher.config().width);
        self.left.begin(width);
        self.right.begin(width);
        self.matcher.begin_frame();
        self.taken = 0;
        Ok(())
    }

    /// Copies the next line of both cameras, and returns the row that it completes: `None` for the first
    /// [`Self::LATENCY`] lines. After the last line, [`Self::flush`] returns the other rows.
    ///
    /// A line has exactly the width that the pipeline was started for. An error changes nothing: the correct
    /// line may follow.
    pub fn push(&mut self, left: &[u8], right: &[u8]) -> Result<Option<Row<'_>>, PushError> {
        self.begun()?;
        if self.left.count() >= self.height {
            return Err(PushError::NoLineLeft);
        }
        let needed = usize::from(self.matcher.config().width);
        if left.len() != needed || right.len() != needed {
            return Err(PushError::LineLength { needed });
        }
        for (window, line) in [(&mut self.left, left), (&mut self.right, right)] {
            for (to, &from) in window.next_line().iter_mut().zip(line) {
                *to = from;
            }
            window.accept();
        }
        Ok(self.pushed()?)
    }

    /// Pushes a copy of the line above in place of a lost line.
    pub(super) fn push_repeated(&mut self) -> Result<Option<Row<'_>>, PushError> {
        self.begun()?;
        if self.left.count() >= self.height {
            return Err(PushError::NoLineLeft);
        }
        for window in [&mut self.left, &mut self.right] {
            window.repeat();
            window.accept();
        }
        Ok(self.pushed()?)
    }

    /// Returns the row that the newest line completes.
    fn pushed(&mut self) -> Result<Option<Row<'_>>, MatchError> {
        // The image's last line completes up to three rows; `flush` takes all but the first of them.
        if self.lines_needed() <= self.left.count() {
            self.step()?;
        }
        Ok(self.matcher.row())
    }

    /// Returns the next row after the last line was pushed; `None` after the frame's last row.
    pub fn flush(&mut self) -> Result<Option<Row<'_>>, PushError> {
        self.begun()?;
        let missing = self.height.saturating_sub(self.left.count());
        if missing > 0 {
            return Err(PushError::LinesMissing { missing });
        }
        let is_out = self.advance::<PushError>(|_| Ok(()))?;
        Ok(self.row().filter(|_| is_out))
    }

    /// Returns the last row, until the next line goes in; `None` before a frame's first row.
    pub fn row(&self) -> Option<Row<'_>> {
        self.matcher.row()
    }

    /// Removes answers of [`Self::row`] at pixels that a camera did not see ([`Matcher::mask`]), for callers
    /// that push lines; [`Self::next_row`] asks the camera.
    pub fn mask(&mut self, valid: impl FnOnce(u16, [&mut [u8]; 2]) -> bool) {
        self.matcher.mask(valid);
    }

    /// Returns the configuration; all zero before [`Self::start`].
    pub fn config(&self) -> &Config {
        self.matcher.config()
    }

    /// Steps until a row comes out, with `lines` reading the lines for each step; false after the frame's
    /// last row.
    pub(super) fn advance<E: From<MatchError>>(
        &mut self,
        mut lines: impl FnMut(&mut Self) -> Result<(), E>,
    ) -> Result<bool, E> {
        // Every step takes one row, and the first row is out after `DELAY` of them.
        for _ in 0..=Matcher::<S, W, D>::DELAY {
            if self.taken >= self.height + Matcher::<S, W, D>::DELAY {
                return Ok(false);
            }
            lines(self)?;
            self.step()?;
            if self.taken > Matcher::<S, W, D>::DELAY {
                break;
            }
        }
        Ok(true)
    }

    /// Reads the lines up to two below the next row.
    fn take_lines<C: StereoSource>(&mut self, camera: &mut C) -> Result<(), PipelineError<C::Error>> {
        for due in self.left.count()..self.lines_needed() {
            let start = camera.next_lines(self.left.next_line(), self.right.next_line())?;
            if usize::from(start.row) != due {
                return Err(PipelineError::RowOrder { expected: due as u16, given: start.row });
            }
            self.left.accept();
            self.right.accept();
        }
        Ok(())
    }

    /// Passes the next row to the matcher.
    fn step(&mut self) -> Result<(), MatchError> {
        if self.taken < self.height {
            self.matcher.push(&self.left.around(self.taken), &self.right.around(self.taken))?;
        } else {
            self.matcher.flush()?;
        }
        self.taken += 1;
        Ok(())
    }

    /// Number of lines that the next step needs.
    pub(super) fn lines_needed(&self) -> usize {
        self.taken.saturating_add(Self::CENSUS_REACH + 1).min(self.height)
    }

    /// Checks that a frame is under way.
    fn begun(&self) -> Result<(), PushError> {
        begun(self.height, self.taken)
    }

    /// Ends the frame.
    pub(super) fn stop(&mut self) {
        self.taken = usize::MAX;
    }
}

impl<S: Method, const W: usize, const D: usize> Default for Pipeline<S, W, D>
where
    Capacity<D>: Supported,
{
    fn default() -> Self {
        Self::new()
    }
}
