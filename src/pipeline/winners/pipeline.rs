//! Rows of winners into rows of disparities.

use super::error::WinnerPipelineError;
use super::source::{WinnerSearch, WinnerSource};
use crate::imaging::LineWindow;
use crate::matching::{
    Capacity, Config, External, MatchError, Matcher, Method, Row, Supported, WinnerRecord,
};
use crate::pipeline::PushError;
use crate::pipeline::error::begun;
use crate::pipeline::reach::reach_down;

/// The rows of the method `S`, of winners that a [`WinnerSource`] computes, in memory that grows with the
/// width alone.
///
/// Lines are pushed, [`Self::push`], and rows come out a line later than from a
/// [`Pipeline`](crate::pipeline::Pipeline): the device has a line in hand while it computes.
///
/// Up to [`Self::set_most_lost`] rows of a frame may be late, short or damaged; by default the first ends it.
/// Such a row has no answers, and [`DAMAGED`](crate::units::PixelFlags::DAMAGED) on every pixel. Rows that it
/// can affect through checks keep their answers and have the flag: four above it, and below it four, one for
/// the [median](crate::matching::Checks::median), and one for each answer that the speckle filter asks for
/// ([`speckle_pixels`](crate::matching::Checks::speckle_pixels)); along paths, and where open places are
/// looked for, the rest of the frame.
/// Every other row is bit-equal.
pub struct WinnerPipeline<S: Method, const W: usize, const D: usize>
where
    External<S>: Method,
{
    left: LineWindow<W>,
    matcher: Matcher<External<S>, W, D>,
    winners: [WinnerRecord; W],
    /// Rows that the matcher took, and lines that came.
    taken: usize,
    lines: usize,
    height: usize,
    most_lost: u16,
    lost: u16,
    /// Of the last rows of winners, the newest in the lowest bit, whether they were lost; and the last one.
    lost_rows: u8,
    last_lost: Option<usize>,
}

/// Rows below a row that its answers rest on.
const LOOK_AHEAD: usize = 4;

impl<S: Method, const W: usize, const D: usize> WinnerPipeline<S, W, D>
where
    External<S>: Method,
{
    /// Delay in lines: row y comes out when line y + `LATENCY` is in.
    pub const LATENCY: usize = 3 + Matcher::<External<S>, W, D>::DELAY;

    /// Creates a pipeline that awaits [`Self::start`]. All its bytes are zero: a static takes no flash.
    pub const fn new() -> Self
    where
        Capacity<D>: Supported,
    {
        Self {
            left: LineWindow::new(),
            matcher: Matcher::new(),
            winners: [WinnerRecord::ZERO; W],
            taken: 0,
            lines: 0,
            height: 0,
            most_lost: 0,
            lost: 0,
            lost_rows: 0,
            last_lost: None,
        }
    }

    /// Checks the configuration and starts the device.
    pub fn start<R: WinnerSource>(
        &mut self,
        config: &Config,
        source: &mut R,
    ) -> Result<(), WinnerPipelineError<R::Error>> {
        self.height = 0;
        self.matcher.start(config).map_err(WinnerPipelineError::Config)?;
        source.start(&WinnerSearch {
            method: S::NAME,
            width: config.width,
            height: config.height,
            disparities: config.disparities,
            min_disparity: config.min_disparity,
            noise: config.noise,
            penalties: config.penalties,
            second_best: self.matcher.needs_second_best(),
        })?;
        self.height = usize::from(config.height);
        self.taken = usize::MAX;
        Ok(())
    }

    /// Sets how many rows of a frame may be lost before it ends with an error.
    pub fn set_most_lost(&mut self, rows: u16) {
        self.most_lost = rows;
    }

    /// Returns the number of rows of this frame whose winners were lost.
    pub fn lost(&self) -> u16 {
        self.lost
    }

    /// Returns the configuration; all zero before [`Self::start`].
    pub fn config(&self) -> &Config {
        self.matcher.config()
    }

    /// Begins a frame, and drops the one before.
    pub fn begin_frame<R: WinnerSource>(
        &mut self,
        source: &mut R,
    ) -> Result<(), WinnerPipelineError<R::Error>> {
        if self.height == 0 {
            return Err(MatchError::NotStarted.into());
        }
        self.taken = usize::MAX;
        source.begin_frame()?;
        self.left.begin(usize::from(self.matcher.config().width));
        self.matcher.begin_frame();
        (self.taken, self.lines, self.lost, self.lost_rows, self.last_lost) = (0, 0, 0, 0, None);
        Ok(())
    }

    /// Hands the next line of both cameras on, and returns the row that it completes: `None` for the first
    /// [`Self::LATENCY`] lines. After the last line, [`Self::flush`] returns the other rows.
    ///
    /// A line has exactly the width that the pipeline was started for.
    pub fn push<R: WinnerSource>(
        &mut self,
        left: &[u8],
        right: &[u8],
        source: &mut R,
    ) -> Result<Option<Row<'_>>, WinnerPipelineError<R::Error>> {
        self.begun()?;
        if self.lines >= self.height {
            return Err(PushError::NoLineLeft.into());
        }
        let needed = usize::from(self.matcher.config().width);
        if left.len() != needed || right.len() != needed {
            return Err(PushError::LineLength { needed }.into());
        }
        source.push_lines(left, right)?;
        Ok(if self.take_line(left, source)? { self.matcher.row() } else { None })
    }

    /// Takes a line of the left camera, empty where no check looks at it and the winners due.
    pub(crate) fn take_line<R: WinnerSource>(
        &mut self,
        left: &[u8],
        source: &mut R,
    ) -> Result<bool, WinnerPipelineError<R::Error>> {
        self.begun()?;
        if self.lines >= self.height {
            return Err(PushError::NoLineLeft.into());
        }
        // A step behind: the row's last winners come when the device has this line, which the window does not
        // need to have.
        let is_due = self.lines >= self.taken.saturating_add(3);
        if is_due {
            self.step(source)?;
        }
        for (to, &from) in self.left.next_line().iter_mut().zip(left) {
            *to = from;
        }
        self.left.accept();
        self.lines += 1;
        Ok(is_due)
    }

    /// Returns the next row after the last line was pushed; `None` after the frame's last row.
    pub fn flush<R: WinnerSource>(
        &mut self,
        source: &mut R,
    ) -> Result<Option<Row<'_>>, WinnerPipelineError<R::Error>> {
        // Every step takes one row, and the first row is out after `DELAY` of them.
        for _ in 0..=Matcher::<External<S>, W, D>::DELAY {
            if !self.advance(source)? {
                return Ok(None);
            }
            if self.taken > Matcher::<External<S>, W, D>::DELAY {
                break;
            }
        }
        Ok(self.matcher.row())
    }

    /// Goes on by a row below the last line, and says whether there was one.
    pub(crate) fn advance<R: WinnerSource>(
        &mut self,
        source: &mut R,
    ) -> Result<bool, WinnerPipelineError<R::Error>> {
        self.begun()?;
        let missing = self.height.saturating_sub(self.lines);
        if missing > 0 {
            return Err(PushError::LinesMissing { missing }.into());
        }
        let goes_on = self.taken < self.height + Matcher::<External<S>, W, D>::DELAY;
        if goes_on {
            self.step(source)?;
        }
        Ok(goes_on)
    }

    /// Returns the row whose winners the next line takes, or a step after the last; `None` where it
    /// takes none.
    pub fn winners_due(&self) -> Result<Option<u16>, PushError> {
        self.begun()?;
        let is_behind = self.lines < self.height && self.lines < self.taken.saturating_add(3);
        Ok(if is_behind { None } else { self.matcher.winners_due() })
    }

    /// Returns the matcher behind the winners.
    pub fn matcher(&self) -> &Matcher<External<S>, W, D> {
        &self.matcher
    }

    /// Passes the next row to the matcher, with the winners that are due with it.
    fn step<R: WinnerSource>(&mut self, source: &mut R) -> Result<(), WinnerPipelineError<R::Error>> {
        let width = usize::from(self.matcher.config().width);
        let due = self.matcher.winners_due();
        let given = match due {
            Some(row) => source.next_row(row, self.winners.get_mut(..width).unwrap_or_default()),
            None => Ok(()),
        };
        let outcome = match given {
            Ok(()) => self.pass(),
            Err(e) => Err(e.into()),
        };
        if let Err(e) = outcome {
            let is_of_one_row = match &e {
                WinnerPipelineError::Source(e) => e.is_of_one_row(),
                WinnerPipelineError::Push(PushError::Matcher(MatchError::WinnerRefused { .. })) => true,
                _ => false,
            };
            if !is_of_one_row || self.lost >= self.most_lost {
                self.taken = usize::MAX;
                return Err(e);
            }
            self.lost += 1;
            self.last_lost = due.map(usize::from);
            // What stands in for the row: its answers go.
            self.winners.fill(WinnerRecord::ZERO);
            self.pass()?;
            self.lost_rows = self.lost_rows << 1 | 1;
        } else if due.is_some() {
            self.lost_rows <<= 1;
        }
        self.taken += 1;
        self.mark();
        Ok(())
    }

    /// Passes the lines around the next row, and the winners, to the matcher.
    fn pass<E>(&mut self) -> Result<(), WinnerPipelineError<E>> {
        if self.taken < self.height {
            let lines = self.left.around(self.taken);
            self.matcher.push_winners(Some(&lines), &self.winners)?;
        } else {
            self.matcher.flush_winners(&self.winners)?;
        }
        Ok(())
    }

    /// Flags the row that came out if it rests on one that was lost.
    fn mark(&mut self) {
        let (Some(row), Some(last)) = (self.matcher.row(), self.last_lost) else { return };
        let row = usize::from(row.index());
        // Uncertainty and confidence look back at as many finished rows as an answer rests on below it.
        let reach = LOOK_AHEAD.saturating_add(reach_down::<S>(&self.matcher.config().checks));
        // The rows of winners between this one and the newest, which there are fewer of below the image.
        let newest = (self.taken - 1).saturating_sub(S::RADIUS_Y).min(self.height - 1);
        let is_lost = self.lost_rows >> (newest - row).min(7) & 1 != 0;
        if last.saturating_add(reach) >= row && last <= row + LOOK_AHEAD {
            self.matcher.mark_damaged(!is_lost);
        }
    }

    /// Checks that a frame is under way.
    fn begun(&self) -> Result<(), PushError> {
        begun(self.height, self.taken)
    }
}

impl<S: Method, const W: usize, const D: usize> Default for WinnerPipeline<S, W, D>
where
    External<S>: Method,
    Capacity<D>: Supported,
{
    fn default() -> Self {
        Self::new()
    }
}
