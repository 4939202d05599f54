//! What a finder keeps from row to row and from frame to frame beside its cells.

use super::ground::CarriedGround;
use super::setup::Setup;
use super::watchdog::{BlindReason, Watchdog};

/// How far an [`Obstacles`](super::Obstacles) is with a frame, and what it carries to the next one.
#[derive(Debug)]
pub struct ObstaclesState {
    pub(super) setup: Setup,
    pub(super) carried: CarriedGround,
    pub(super) watchdog: Watchdog,
    /// Rows of pixels above the horizon.
    pub(super) sky: u16,
    /// The next row of pixels.
    pub(super) next: usize,
    pub(super) is_finished: bool,
    /// What the last finished frame was judged.
    pub(super) blind: Option<BlindReason>,
}

impl ObstaclesState {
    /// The state of a finder that waits for a start. All zeros.
    pub const fn new() -> Self {
        Self {
            setup: Setup::NOT_STARTED,
            carried: CarriedGround::NONE,
            watchdog: Watchdog::NEW,
            sky: 0,
            next: 0,
            is_finished: false,
            blind: None,
        }
    }
}

impl Default for ObstaclesState {
    fn default() -> Self {
        Self::new()
    }
}
