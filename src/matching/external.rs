//! Rows of winners that something else computed, taken by a matcher.

use super::error::MatchError;
use super::matcher::Matcher;
use super::memory::record::WinnerRecord;
use super::memory::views::view_mut;
use super::memory::{Memory, Rows5};
use super::method::{External, Method, Steps};

impl<S: Method, const W: usize, const D: usize> Matcher<External<S>, W, D>
where
    External<S>: Method,
{
    /// Number of rows by which the winners that go in with a line lag behind that line.
    pub const WINNERS_ABOVE: usize = S::RADIUS_Y;

    /// Whether the checks that were configured look at the left image: for texture, for edges, or along paths
    /// for patterns that repeat.
    pub fn needs_lines(&self) -> bool {
        let checks = &self.config().checks;
        checks.texture_pixels > 0 || checks.look_for_edges() || (S::ALONG_PATHS && checks.refuse_repeats)
    }

    /// Whether the checks that were configured look at the [second best](WinnerRecord::second).
    pub fn needs_second_best(&self) -> bool {
        self.config().needs_margins() || self.config().checks.uniqueness_percent.is_some()
    }

    /// The row whose winners the next call of [`Self::push_winners`] or [`Self::flush_winners`] takes, if it
    /// takes any.
    pub fn winners_due(&self) -> Option<u16> {
        let row = self.taken.checked_sub(Self::WINNERS_ABOVE)?;
        (row < usize::from(self.config().height)).then_some(row as u16)
    }

    /// Takes the next row of the image: the five lines around it in the left camera, which may be left out
    /// unless [`Self::needs_lines`], and the winners of [`Self::winners_due`], where there are any due.
    ///
    /// An error changes nothing: the row may follow that is right.
    pub fn push_winners(
        &mut self,
        left: Option<&[&[u8]; 5]>,
        winners: &[WinnerRecord],
    ) -> Result<(), MatchError> {
        let needed = usize::from(self.config().width);
        let is_short = match left {
            Some(lines) => lines.iter().any(|line| line.len() < needed),
            None => self.needs_lines(),
        };
        if self.taken < usize::from(self.config().height) && is_short {
            return Err(MatchError::LineTooShort { needed });
        }
        self.step_winners(left, true, winners)
    }

    /// The winners of a line's pixels, if there are as many and the search can have each of them.
    pub(crate) fn check_winners<'w>(
        &self,
        winners: &'w [WinnerRecord],
    ) -> Result<&'w [WinnerRecord], MatchError> {
        let config = self.config();
        let (width, least) = (usize::from(config.width), usize::from(config.min_disparity));
        let given = winners.get(..width).ok_or(MatchError::Winners { needed: width })?;
        let disparities = usize::from(config.disparities);
        for (x, winner) in given.iter().enumerate().skip(least) {
            if !winner.is_possible((x - least + 1).min(disparities)) {
                return Err(MatchError::WinnerRefused { column: x as u16 });
            }
        }
        Ok(given)
    }

    /// Goes on below the image's last row, until the last results are out. Before the last row went in, and
    /// after the last result, it is [`MatchError::FrameDone`].
    pub fn flush_winners(&mut self, winners: &[WinnerRecord]) -> Result<(), MatchError> {
        self.step_winners(None, false, winners)
    }

    fn step_winners(
        &mut self,
        left: Option<&Rows5<'_>>,
        is_inside: bool,
        winners: &[WinnerRecord],
    ) -> Result<(), MatchError> {
        let config = *self.config();
        let (width, height) = (usize::from(config.width), usize::from(config.height));
        if height == 0 {
            return Err(MatchError::NotStarted);
        }
        let y = self.taken;
        if y >= height + Self::DELAY || is_inside != (y < height) {
            return Err(MatchError::FrameDone);
        }
        if self.winners_due().is_some() {
            let given = self.check_winners(winners)?;
            let records = view_mut::<u8, WinnerRecord>(self.memory.parts(width).codes);
            for (to, from) in records.iter_mut().zip(given) {
                *to = *from;
            }
        }
        self.taken += 1;
        External::<S>::step_for(D)(self.frame(), y, left.map(|left| [left, left]));
        Ok(())
    }
}
