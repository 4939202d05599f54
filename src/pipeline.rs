//! The live path, row by row: camera, line windows, census, matching.

use crate::camera::{CameraError, FrameStart, LineFormat, PixelFormat, StereoSource};
use crate::imaging::LineWindow;
use crate::matching::{Config, ConfigError, Kernel, MatchError, Matcher, Row, Scheme};
use core::fmt;

/// Rows of disparities from a stereo source, in memory of its own and of fixed size: it fits a `static`.
///
/// The row that comes out is [`Pipeline::LATENCY`] lines behind the line that goes in; the last rows come when the
/// frame's lines are over.
#[doc = "```"]
#[doc = "use stereopsis::{matching::{Block, Config}, pipeline::Pipeline};"]
#[doc = "static PIPELINE: Pipeline<Block, 320, 64> = Pipeline::new();"]
#[doc = "assert!(size_of_val(&PIPELINE) < 46_000);"]
#[doc = "assert_eq!(Pipeline::<Block, 320, 64>::LATENCY, 10);"]
#[doc = "```"]
pub struct Pipeline<S: Scheme, const W: usize, const D: usize> {
    left: LineWindow<W>,
    right: LineWindow<W>,
    matcher: Matcher<S, W, D>,
    /// Rows whose five lines went into the matcher.
    taken: usize,
    height: usize,
}

/// Why there is no row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PipelineError<E> {
    /// The camera failed; its own error is inside. The frame is lost, the next one may be begun.
    Camera(CameraError<E>),
    /// The camera's frames are not of the size that the pipeline was started for, or not [`PixelFormat::Grey8`].
    Format {
        /// What the camera gives.
        camera: LineFormat,
        /// What the pipeline takes.
        needed: LineFormat,
    },
    /// The camera gave another row than the next one.
    RowOrder {
        /// The row that was due.
        expected: u16,
        /// The row that came.
        given: u16,
    },
    /// No frame was begun.
    Matcher(MatchError),
}

impl<E: fmt::Display> fmt::Display for PipelineError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Camera(e) => write!(f, "{e}"),
            Self::Format { camera, needed } => write!(
                f,
                "the camera gives {}x{} in {:?}; needed is {}x{} in {:?}",
                camera.width, camera.height, camera.pixel, needed.width, needed.height, needed.pixel
            ),
            Self::RowOrder { expected, given } => {
                write!(f, "row {given} came from the camera where {expected} was due")
            }
            Self::Matcher(e) => write!(f, "{e}"),
        }
    }
}

impl<E: fmt::Display + fmt::Debug> core::error::Error for PipelineError<E> {}

impl<E> From<CameraError<E>> for PipelineError<E> {
    fn from(e: CameraError<E>) -> Self {
        Self::Camera(e)
    }
}

impl<E> From<MatchError> for PipelineError<E> {
    fn from(e: MatchError) -> Self {
        Self::Matcher(e)
    }
}

impl<S: Scheme, const W: usize, const D: usize> Pipeline<S, W, D> {
    /// Lines below a census code that it looks at.
    const CENSUS_REACH: usize = 2;

    /// Row y comes out when line y + `LATENCY` is in.
    pub const LATENCY: usize = Self::CENSUS_REACH + Matcher::<S, W, D>::DELAY;

    /// A pipeline that waits for [`Self::start`]. Every byte of it is zero: a static of it takes RAM and no flash.
    pub const fn new() -> Self {
        Self { left: LineWindow::new(), right: LineWindow::new(), matcher: Matcher::new(), taken: 0, height: 0 }
    }

    /// Checks the configuration and gets ready for the first frame.
    pub fn start(&mut self, config: &Config) -> Result<(), ConfigError> {
        self.matcher.start(config)?;
        self.height = usize::from(config.height);
        self.stop();
        Ok(())
    }

    /// Chooses the kernel; every kernel gives the same bits.
    pub fn set_kernel(&mut self, kernel: Kernel) {
        self.matcher.set_kernel(kernel);
    }

    /// The kernel in use.
    pub fn kernel(&self) -> Kernel {
        self.matcher.kernel()
    }

    /// Waits for the camera's next frame and forgets the one before.
    pub fn begin_frame<C: StereoSource>(&mut self, camera: &mut C) -> Result<FrameStart, PipelineError<C::Error>> {
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
        self.left.begin(usize::from(config.width));
        self.right.begin(usize::from(config.width));
        self.matcher.begin_frame();
        self.taken = 0;
        Ok(start)
    }

    /// The next row of disparities, taking as many lines from the camera as it needs; `None` when all rows of the
    /// frame are out. After an error the frame is over.
    pub fn next_row<C: StereoSource>(&mut self, camera: &mut C) -> Result<Option<Row<'_>>, PipelineError<C::Error>> {
        // Every step takes one row, and the first row is out after `DELAY` of them.
        for _ in 0..=Matcher::<S, W, D>::DELAY {
            if self.taken >= self.height + Matcher::<S, W, D>::DELAY {
                return Ok(None);
            }
            if let Err(e) = self.step(camera) {
                self.stop();
                return Err(e);
            }
            if self.taken > Matcher::<S, W, D>::DELAY {
                break;
            }
        }
        Ok(self.matcher.row())
    }

    /// Takes the lines up to two below the next row, then that row through the matcher.
    fn step<C: StereoSource>(&mut self, camera: &mut C) -> Result<(), PipelineError<C::Error>> {
        let lines = (self.taken + Self::CENSUS_REACH + 1).min(self.height);
        for due in self.left.count()..lines {
            let start = camera.next_lines(self.left.next_line(), self.right.next_line())?;
            if usize::from(start.row) != due {
                return Err(PipelineError::RowOrder { expected: due as u16, given: start.row });
            }
            self.left.accept();
            self.right.accept();
        }
        if self.taken < self.height {
            self.matcher.push(&self.left.around(self.taken), &self.right.around(self.taken))?;
        } else {
            self.matcher.flush()?;
        }
        self.taken += 1;
        Ok(())
    }

    /// No rows until the next frame.
    fn stop(&mut self) {
        self.taken = usize::MAX;
    }
}

impl<S: Scheme, const W: usize, const D: usize> Default for Pipeline<S, W, D> {
    fn default() -> Self {
        Self::new()
    }
}
