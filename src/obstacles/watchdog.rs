//! Watchdog: whether a frame can be trusted at all.

use super::config::ObstacleConfig;
use crate::imaging::{CameraHealth, PairMonitor};
use crate::units::PixelFlags;

/// Why nothing can be said, within the frame that it happens in.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
#[repr(u8)]
pub enum BlindReason {
    /// No finished frame: none since the start, or the next one is under way.
    // From 1 on, so that no reason is a zero byte: a new finder is all zeros.
    NoFrame = 1,
    /// Too many rows were lost or are damaged.
    RowsLost,
    /// Too few cells have an answer: darkness, a covered lens, a white wall.
    FewAnswers,
    /// A camera's picture is black, saturated, flat or repeating.
    Camera,
    /// The left and the right camera are swapped.
    Swapped,
    /// A ground was to be searched and is not found.
    NoGround,
    /// Too little of the ground that is driven on next is seen.
    Unseen,
}

/// Counts of a frame and what the camera monitor said.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watchdog {
    /// Rows that did not come, or came damaged.
    pub(super) lost: u32,
    /// Cells with an answer.
    pub(super) answered: u32,
    cameras: Option<BlindReason>,
}

impl Watchdog {
    pub(super) const NEW: Self = Self { lost: 0, answered: 0, cameras: None };

    /// Takes what the monitor of the cameras says of this frame.
    pub(super) fn cameras(&mut self, monitor: &PairMonitor) {
        let bad = monitor.health().iter().any(|health| *health != CameraHealth::Good);
        self.cameras = if bad {
            Some(BlindReason::Camera)
        } else {
            monitor.are_swapped().then_some(BlindReason::Swapped)
        };
    }

    /// Takes all flags that a pixel of a row has: a row is damaged if any of its pixels is.
    pub(super) fn row(&mut self, flags: PixelFlags) {
        self.lost += u32::from(flags.contains(PixelFlags::DAMAGED));
    }

    /// The judgement of a frame of so many rows of pixels and so many cells.
    pub(super) fn judge(&self, config: &ObstacleConfig, rows: u32, cells: u32) -> Option<BlindReason> {
        if self.cameras.is_some() {
            return self.cameras;
        }
        if 100 * u64::from(self.lost) > u64::from(config.most_lost) * u64::from(rows) {
            return Some(BlindReason::RowsLost);
        }
        let few = 100 * u64::from(self.answered) < u64::from(config.least_answered) * u64::from(cells);
        few.then_some(BlindReason::FewAnswers)
    }
}
