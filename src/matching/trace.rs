//! Trace of the dense path: rows after each stage, to compare another implementation stage by stage.

use super::memory::record::WinnerRecord;
use crate::units::{Disparity, PixelFlags};

/// A stage that leaves a row of answers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum TracedStage {
    /// Answers to a fraction of a pixel, of those that the left-right check leaves, and the flags of all.
    Subpixel,
    /// Answers averaged along the row, without those that fattening refuses, and flags.
    Smoothed,
    /// Answers after the median, the speckle filter and the filter down the columns, and flags.
    Checked,
}

/// Takes the rows of stages while a frame goes through a [`Matcher`](super::Matcher). What comes before the
/// winners stands in no row that targets have alike.
pub trait StageTrace {
    /// Takes the winner of a pixel, column by column from the smallest disparity on, and what its partner
    /// keeps. The second best is not told: it is 255, as where none was sought.
    fn winner(&mut self, row: usize, column: usize, winner: WinnerRecord);

    /// Takes a row of the frame as `stage` leaves it, an answer and flags for each of its pixels. Where
    /// confidences are asked for, the flags of [`TracedStage::Smoothed`] are empty: their place holds what
    /// confidences are made of.
    fn row(&mut self, stage: TracedStage, row: usize, answers: &[Disparity], flags: &[PixelFlags]);
}
